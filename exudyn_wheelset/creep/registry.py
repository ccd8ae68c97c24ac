"""The creep laws by name, and the public `creep_force`.

A law is added to the package by a module with a kernel of the common signature and its `LAW`, one
entry in `CREEP_LAWS` and one branch in `law_force`; outside the package by `register_creep_law`,
or by giving the compiled function where a name is asked for.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from exudyn_wheelset.creep.arguments import (
    check_names,
    check_patch,
    check_together,
    checked,
    finite,
    unknown,
)
from exudyn_wheelset.creep.exact import LAW as EXACT
from exudyn_wheelset.creep.exact_apart import EXACT_LAW
from exudyn_wheelset.creep.exact_table import LAW as EXACT_TABLE
from exudyn_wheelset.creep.fastsim import LAW as FASTSIM
from exudyn_wheelset.creep.kernel_apart import CREEP, creep_force_rows
from exudyn_wheelset.creep.law import CreepLaw, CreepParameter
from exudyn_wheelset.creep.linear import LAW as LINEAR
from exudyn_wheelset.creep.own import OWN_LAW, address_of, law_at
from exudyn_wheelset.creep.polach import LAW as POLACH
from exudyn_wheelset.creep.polach_2005 import LAW as POLACH_2005
from exudyn_wheelset.creep.polach_kalker import LAW as POLACH_KALKER
from exudyn_wheelset.creep.shen_hedrick_elkins import LAW as SHEN_HEDRICK_ELKINS
from exudyn_wheelset.creep.vermeulen_johnson import LAW as VERMEULEN_JOHNSON
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt

CREEP_LAWS: dict[str, CreepLaw] = {
    law.name: law
    for law in (
        LINEAR,
        VERMEULEN_JOHNSON,
        SHEN_HEDRICK_ELKINS,
        POLACH,
        POLACH_2005,
        FASTSIM,
        EXACT,
        EXACT_TABLE,
        POLACH_KALKER,
    )
}

# A law has eight places in the kernels' arrays, the address of one's own takes the first.
MOST_OWN_PARAMETERS = 7
_ARGUMENTS = {
    *("creep_x", "creep_y", "spin", "a", "b", "normal_force", "friction", "shear_modulus"),
    *("poisson", "law", "normal", "creep", "damping", "contact", "law_parameters"),
    *("friction_ratio", "friction_decay", "right_friction", "flange_friction", "top_friction"),
    *("right_flange_friction", "right_top_friction"),
}


def creep_law(law: Any) -> CreepLaw:
    """Give the description of a creep law by its name or by the compiled function of one's own.

    Raises WheelsetError for an unknown name; the message lists the names and the nearest one.
    """
    if isinstance(law, CreepLaw):
        return law
    if isinstance(law, str):
        if law not in CREEP_LAWS:
            raise WheelsetError(unknown("creep law", law, list(CREEP_LAWS)))
        return CREEP_LAWS[law]
    for known in CREEP_LAWS.values():
        if known.function is not None and known.function == law:
            return known
    if not callable(law):
        raise WheelsetError(
            f"creep law {law!r}: give the name of a law or a function compiled by numba.njit"
        )
    address_of(law)
    return CreepLaw(
        getattr(law, "__name__", repr(law)), OWN_LAW, "a law of one's own", function=law
    )


def law_of_kernel(number: int, values: NDArray) -> tuple[CreepLaw, dict[str, float]]:
    """Give the law of a number and its parameters by name, from its array as compiled code has it.

    Raises WheelsetError where the number is none of a law, or the address none of this process.
    """
    number = int(number)
    if number == OWN_LAW:
        function = law_at(int(values[0]))
        law = None if function is None else creep_law(function)
        values = values[1:]
    else:
        law = next((known for known in CREEP_LAWS.values() if known.number == number), None)
    if law is None:
        raise WheelsetError(f"no creep law of this process has the number {number}")
    return law, {p.name: float(v) for p, v in zip(law.parameters, values, strict=False)}


@spelt
def register_creep_law(
    name: str,
    function: Any,
    parameters: Mapping[str, float] | Iterable[CreepParameter] = (),
    source: str = "a law of one's own",
) -> CreepLaw:
    """Give a compiled function a name that works wherever a creep law is asked for.

    function(creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson,
    parameters) -> (force_x, force_y, moment), compiled by numba.njit (or a numba.cfunc): arguments
    and results as those of `creep_force`, numbers but for `parameters`, a float64 array of the
    law's own parameters (at most 7): a mapping of names to defaults, or CreepParameter with range
    and meaning. The function must be defined, and registered, in every process that uses the name.
    Raises WheelsetError for a name that is taken by a law of the package, for names of parameters
    that are arguments already and for a function that cannot be compiled.

    Examples
    --------
    >>> from numba import njit
    >>> from exudyn_wheelset import creep_force, register_creep_law
    >>> @njit
    ... def dry(creep_x, creep_y, spin, a, b, normal_force, friction, modulus, poisson, own):
    ...     size = max((creep_x**2 + creep_y**2) ** 0.5, own[0])
    ...     pull = -friction * normal_force / size
    ...     return pull * creep_x, pull * creep_y, 0.0
    ...
    >>> law = register_creep_law("dry", dry, {"smallest": 1e-4})
    >>> creep_force("dry", 1e-3, 0, 0, 5e-3, 5e-3, 80e3, 0.25, 82e9, 0.28)[0]
    -20000.0
    """
    if not isinstance(name, str) or not name:
        raise WheelsetError(f"name = {name!r} of a creep law: give a word")
    if name in CREEP_LAWS and CREEP_LAWS[name].function is None:
        raise WheelsetError(f"creep law {name!r} belongs to the package: give another name")
    if isinstance(parameters, Mapping):
        parameters = [
            CreepParameter(own, float(default), -math.inf, math.inf, "a parameter of one's own")
            for own, default in parameters.items()
        ]
    own_parameters = tuple(parameters)
    if len(own_parameters) > MOST_OWN_PARAMETERS:
        raise WheelsetError(
            f"creep law {name!r} has {len(own_parameters)} parameters: a law of one's own may have "
            f"{MOST_OWN_PARAMETERS}; put what does not change into the function"
        )
    for parameter in own_parameters:
        if parameter.name in _ARGUMENTS:
            raise WheelsetError(
                f"parameter {parameter.name!r} of creep law {name!r} is an argument of every law "
                "or an option of the contact: give it another name"
            )
    address_of(function)
    law = CreepLaw(name, OWN_LAW, source, own_parameters, function=function)
    CREEP_LAWS[name] = law
    return law


def creep_parameters(law: Any, **parameters: float) -> NDArray:
    """Give the parameter array of a law for `creep_kernel`: its defaults with changes by name.

    float64, in the order of `creep_law(law).parameters`; a law of one's own has the address of its
    function in front, which holds in this process only. Raises WheelsetError for an unknown law, an
    unknown parameter or a value outside its range.
    """
    description = creep_law(law)
    parameters = description.expand(parameters)
    check_names(description, parameters)
    values = np.array([p.default for p in description.parameters])
    for name, value in parameters.items():
        values[description.index(name)] = checked(description, name, np.asarray(value))
    check_together(description, values)
    return np.concatenate([_address(description), values])


def _address(description: CreepLaw) -> list[float]:
    """What stands in front of a law's own parameters."""
    return [] if description.function is None else [float(address_of(description.function))]


@spelt
def creep_force(
    law: Any,
    creep_x: ArrayLike,
    creep_y: ArrayLike,
    spin: ArrayLike,
    a: ArrayLike,
    b: ArrayLike,
    normal_force: ArrayLike,
    friction: ArrayLike,
    shear_modulus: ArrayLike,
    poisson: ArrayLike,
    **parameters: ArrayLike,
) -> tuple[Any, Any, Any]:
    """Give the creep forces and the spin moment (Fx, Fy, Mz) on the wheel.

    law: its name, or a compiled function of one's own (`register_creep_law`). Every other argument
    is a number or an array, broadcast together; the results are floats or arrays of the common
    shape. creep_x, creep_y [-] and spin [1/m] are (wheel - rail)/V in the contact frame (x rolling,
    y lateral tangent to the left, z from rail into wheel); a along rolling and b lateral are the
    semi-axes of the patch [m], > 0; normal_force [N] (none below zero); friction >= 0;
    shear_modulus [Pa] > 0; poisson from 0 to 0.5. Fx, Fy [N] oppose the creep, Mz [N m] about z.
    `parameters` are those of the law, `creep_law(law).parameters`.
    Raises WheelsetError for an unknown law or parameter and for values out of range or not finite.

    Examples
    --------
    >>> from exudyn_wheelset import creep_force
    >>> patch = dict(a=5.5e-3, b=5.5e-3, normal_force=80e3, friction=0.3)
    >>> fx, fy, mz = creep_force("polach", 1e-3, 0, 0, **patch, shear_modulus=82e9, poisson=0.28)
    >>> round(fx / 1e3, 1)  # [kN], against the creep
    -9.7
    """
    description = creep_law(law)
    parameters = description.expand(parameters)
    check_names(description, parameters)
    given = {
        "creep_x": creep_x,
        "creep_y": creep_y,
        "spin": spin,
        "a": a,
        "b": b,
        "normal_force": normal_force,
        "friction": friction,
        "shear_modulus": shear_modulus,
        "poisson": poisson,
    }
    arrays = [finite(name, value) for name, value in given.items()]
    check_patch(dict(zip(given, arrays, strict=True)))
    own = [
        checked(description, p.name, np.asarray(parameters.get(p.name, p.default)))
        for p in description.parameters
    ]
    try:
        broadcast = np.broadcast_arrays(*arrays, *own)
    except ValueError:
        shapes = {n: a.shape for n, a in zip(given, arrays, strict=True) if a.shape != ()}
        raise WheelsetError(
            f"arguments of the shapes {shapes} do not go together: give numbers, or arrays of one "
            "shape"
        ) from None
    shape = broadcast[0].shape
    table = np.stack([np.ravel(column) for column in broadcast], axis=-1)
    states = np.ascontiguousarray(table[:, : len(arrays)])
    laws_own = np.ascontiguousarray(table[:, len(arrays) :])
    for row in laws_own[: len(laws_own) if any(np.ndim(v) for v in own) else 1]:
        check_together(description, row)
    if description.function is not None:
        address = np.full((len(laws_own), 1), address_of(description.function), dtype=float)
        laws_own = np.hstack([address, laws_own])
    CREEP.ready()
    if description.number == EXACT.number:
        EXACT_LAW.ready()
    forces = creep_force_rows(description.number, states, laws_own)
    if shape == ():
        return float(forces[0, 0]), float(forces[0, 1]), float(forces[0, 2])
    return tuple(forces[:, i].reshape(shape) for i in range(3))  # type: ignore[return-value]
