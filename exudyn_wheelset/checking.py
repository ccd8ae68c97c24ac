"""Checks of what users give: every refusal names the value, its unit, the range and the mend."""

from __future__ import annotations

import difflib
import inspect
import math
import sys
import warnings
from collections.abc import Callable, Iterable, Sequence
from numbers import Integral, Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.errors import WheelsetError, WheelsetWarning

_PACKAGE = f"{__name__.partition('.')[0]}."
# A car body of 26 m has some 8 m.
_WIDEST_GYRATION = 15.0


def number(
    what: str,
    value: Any,
    unit: str,
    low: float = -math.inf,
    high: float = math.inf,
    mend: str = "",
) -> float:
    """`value` as a float, if it is a finite number from `low` to `high` in `unit`.

    `mend` is added to the message where it lies outside. Raises WheelsetError; a string is
    refused even where it spells a number, and so are True and False.
    """
    shown = "" if unit in ("", "-") else f" {unit}"
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, Real):
        raise WheelsetError(
            f"{what} = {value!r} is no number: give a number{f' in {unit}' if shown else ''}"
        )
    result = float(value)
    if not math.isfinite(result) or not low <= result <= high:
        raise WheelsetError(
            f"{what} = {value!r}{shown}: give {_range(low, high, unit if shown else '')}"
            + (f"; {mend}" if mend else "")
        )
    return result


def positive(what: str, value: Any, unit: str, high: float = math.inf, mend: str = "") -> float:
    """`value` as a float, if it is a number above 0 and up to `high`; raises as `number` does."""
    result = number(what, value, unit)
    if result <= 0.0:
        raise WheelsetError(f"{what} = {value!r} {unit}: give a positive number in {unit}")
    if result > high:
        raise WheelsetError(
            f"{what} = {value!r} {unit} is out of proportion: the largest accepted is "
            f"{high:g} {unit}; {mend or f'is it given in {unit}?'}"
        )
    return result


def whole(what: str, value: Any, low: int = 0, high: float = math.inf) -> int:
    """`value` as an int, if it is a whole number from `low` to `high`; raises WheelsetError."""
    is_whole = isinstance(value, Integral) and not isinstance(value, bool)
    if not is_whole or not low <= int(value) <= high:
        limits = f"of at least {low}" if math.isinf(high) else f"from {low} to {high:g}"
        raise WheelsetError(f"{what} = {value!r}: give a whole number {limits}")
    return int(value)


def numbers(
    what: str,
    values: Any,
    count: int,
    unit: str,
    low: float = -math.inf,
    high: float = math.inf,
    mend: str = "",
) -> tuple[float, ...]:
    """`values` as `count` floats, each checked as `number` does; raises WheelsetError."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise WheelsetError(f"{what} = {values!r}: give {count} numbers [{unit}]")
    given = list(values)
    if len(given) != count:
        raise WheelsetError(
            f"{what} = {given!r} has {len(given)} entries: give {count} numbers [{unit}]"
        )
    return tuple(
        number(f"{what}[{place}]", value, unit, low, high, mend)
        for place, value in enumerate(given)
    )


def finite_array(what: str, values: Any, unit: str, mend: str = "") -> NDArray[np.float64]:
    """`values`, a number or any shape of numbers in `unit`, as a new array of finite floats.

    Raises WheelsetError; texts are refused even where they spell numbers, True and False as well.
    """
    shown = "" if unit in ("", "-") else f" in {unit}"
    try:
        given = np.asarray(values)
        if given.dtype.kind in "USb":
            raise TypeError("texts, True and False are none")
        result = np.array(given, dtype=float)
    except (TypeError, ValueError) as error:
        raise WheelsetError(f"{what} = {values!r}: give numbers{shown} ({error})") from None
    if not np.isfinite(result).all():
        mend = f"; {mend}" if mend else ""
        raise WheelsetError(f"{what} = {values!r}: give finite numbers{shown}{mend}")
    return result


def moments_of_inertia(what: str, values: Any, mass: float) -> tuple[float, float, float]:
    """Moments of inertia (Ix, Iy, Iz) [kg m^2] that a body of `mass` [kg] can have.

    Raises WheelsetError for one that is not positive or is more than the sum of the other two;
    warns of a radius of gyration that no part of a vehicle has, as where the mass is in tonnes.
    """
    x, y, z = numbers(f"{what} (Ix, Iy, Iz)", values, 3, "kg m^2")
    for axis, value in zip("xyz", (x, y, z), strict=True):
        positive(f"{what} I{axis}", value, "kg m^2", 1e9)
        others = x + y + z - value
        if value > others * (1.0 + 1e-9):
            raise WheelsetError(
                f"{what} I{axis} = {value:g} kg m^2 is more than the sum {others:g} kg m^2 of the "
                "other two, which no body has: check the three numbers (Ix, Iy, Iz)"
            )
    gyration = math.sqrt(max(x, y, z) / mass)
    if gyration > _WIDEST_GYRATION:
        warn(
            f"{what} = {max(x, y, z):g} kg m^2 of a mass of {mass:g} kg is a radius of gyration of "
            f"{gyration:.3g} m (usual: up to {_WIDEST_GYRATION:g} m): are they in kg and kg m^2?"
        )
    return x, y, z


def warn(warning: str | WheelsetWarning) -> None:
    """Warn of the user's line: the first one above this call that is not the package's."""
    level = 2
    frame = sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").startswith(_PACKAGE):
        frame = frame.f_back
        level += 1
    warnings.warn(warning, None if isinstance(warning, Warning) else WheelsetWarning, level)


def unknown(kind: str, name: Any, known: Sequence[str]) -> WheelsetError:
    """The error for a name that is not among `known`; it offers the nearest one."""
    listed = ", ".join(known) or "none"
    spelt = {one.lower(): one for one in known}
    near = difflib.get_close_matches(str(name).lower(), spelt, n=1, cutoff=0.5)
    offer = f"; did you mean {spelt[near[0]]!r}?" if near else ""
    return WheelsetError(f"unknown {kind} {name!r}; known are {listed}{offer}")


def _range(low: float, high: float, unit: str) -> str:
    if math.isinf(low) and math.isinf(high):
        return "a finite number" + (f" in {unit}" if unit else "")
    if math.isinf(high):
        limits = f"of at least {low:g}"
    elif math.isinf(low):
        limits = f"of at most {high:g}"
    else:
        limits = f"from {low:g} to {high:g}"
    return f"a number {limits}" + (f" {unit}" if unit else "")


def refuse_options(function: Callable[..., Any], given: Iterable[str]) -> None:
    """Raise WheelsetError for the first of the options that `function` does not have."""
    known = [
        name
        for name, parameter in inspect.signature(function).parameters.items()
        if parameter.kind is not inspect.Parameter.VAR_KEYWORD and name not in ("self", "cls")
    ]
    for name in given:
        raise unknown("option", name, known)
