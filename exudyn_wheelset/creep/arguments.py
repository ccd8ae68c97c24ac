"""Checks of what `creep_force` and `creep_parameters` are given, with value, range and mend."""

from __future__ import annotations

import difflib
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from exudyn_wheelset.checking import warn
from exudyn_wheelset.creep.law import CreepLaw
from exudyn_wheelset.creep.polach_2005 import LAW as POLACH_2005
from exudyn_wheelset.errors import WheelsetError

LEAST = 1e-60
LARGEST_PATCH = 1e9
LARGEST_FORCE = 1e60
LARGEST_FRICTION = 1e6
LARGEST_SHEAR_MODULUS = 1e24


def unknown(kind: str, name: object, known: list[str]) -> str:
    """Message for a name that is not among `known`, with the nearest one."""
    message = f"unknown {kind} {name!r}; known are {', '.join(known) or 'none'}"
    near = difflib.get_close_matches(str(name).lower(), known, n=1, cutoff=0.3)
    return f"{message}; did you mean {near[0]!r}?" if near else message


def check_names(description: CreepLaw, parameters: dict[str, Any]) -> None:
    """Raise WheelsetError for a parameter that the law does not have."""
    known = [p.name for p in description.parameters]
    for name in parameters:
        if name not in known:
            raise WheelsetError(
                unknown(
                    f"parameter of creep law {description.name!r}",
                    name,
                    [*known, *description.shorthands],
                )
            )


def finite(name: str, value: ArrayLike) -> NDArray:
    """Give a number or an array as an array of floats; WheelsetError unless all are finite."""
    try:
        array = np.asarray(value)
        if array.dtype.kind in "USb":
            raise TypeError
        array = np.asarray(array, dtype=float)
    except (TypeError, ValueError):
        raise WheelsetError(f"{name} must be a number or an array, not {value!r}") from None
    if not np.all(np.isfinite(array)):
        raise WheelsetError(f"{name} must be finite, has {array[~np.isfinite(array)].flat[0]}")
    return array


def checked(description: CreepLaw, name: str, value: NDArray) -> NDArray:
    """Give the values of a law's parameter as floats; WheelsetError outside its range."""
    parameter = description.parameters[description.index(name)]
    array = finite(name, value)
    wrong = (array < parameter.low) | (array > parameter.high)
    if parameter.whole:
        wrong |= array != np.round(array)
    if np.any(wrong):
        kind = "a whole number" if parameter.whole else "a number"
        raise WheelsetError(
            f"{name} of creep law {description.name!r} is {array[wrong].flat[0]:g}; it must be "
            f"{kind} from {parameter.low:g} to {parameter.high:g} ({parameter.meaning})"
        )
    return array


def check_together(description: CreepLaw, values: NDArray) -> None:
    """Raise WheelsetError where parameters, each in its range, contradict each other."""
    if description.number == POLACH_2005.number:
        adhesion = values[description.index("adhesion_reduction")]
        slip = values[description.index("slip_reduction")]
        if slip > adhesion:
            raise WheelsetError(
                f"slip_reduction {slip:g} is above adhesion_reduction {adhesion:g}; Polach 2005 "
                "asks for k_S <= k_A: lower slip_reduction"
            )


# Beyond these a patch or a material is none of wheel and rail, only of scaled numbers.
USUAL_PATCH = 0.1
USUAL_SHEAR_MODULUS = 1e6


def check_patch(values: dict[str, NDArray]) -> None:
    """Raise WheelsetError for a patch or a material that cannot be.

    The ends are far beyond any real one, so that no law's squares and products overflow.
    """
    limits = {
        "a": ("m", LEAST, LARGEST_PATCH),
        "b": ("m", LEAST, LARGEST_PATCH),
        "normal_force": ("N", -math.inf, LARGEST_FORCE),
        "friction": ("-", 0.0, LARGEST_FRICTION),
        "shear_modulus": ("Pa", LEAST, LARGEST_SHEAR_MODULUS),
        "poisson": ("-", 0.0, 0.5),
    }
    for name, (unit, low, high) in limits.items():
        wrong = (values[name] < low) | (values[name] > high)
        if np.any(wrong):
            ask = f"from {low:g} to {high:g}" if low > -math.inf else f"at most {high:g}"
            if low > 0.0:
                ask = f"positive, {ask}"
            raise WheelsetError(
                f"{name} = {values[name][wrong].flat[0]:g} [{unit}]; it must be {ask}"
            )
    for name in ("a", "b"):
        if np.any(values[name] > USUAL_PATCH):
            warn(
                f"{name} = {values[name].max():g} m is no patch of wheel and rail (usual: 1e-3 to "
                f"2e-2 m, warned of from {USUAL_PATCH:g} m): is it given in m?"
            )
    if np.any(values["shear_modulus"] < USUAL_SHEAR_MODULUS):
        warn(
            f"shear_modulus = {values['shear_modulus'].min():g} Pa is that of no solid (steel: "
            f"82e9 Pa, warned of below {USUAL_SHEAR_MODULUS:g} Pa): is it given in Pa?"
        )
