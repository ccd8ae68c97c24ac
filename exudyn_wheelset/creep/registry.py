"""The creep laws by name, one compiled entry for all of them, and the public `creep_force`.

A law is added by a module with a kernel of the common signature and its `LAW`, one entry in
`CREEP_LAWS` and one branch in `creep_kernel` (a chain over whole numbers, because compiled code
that calls functions by reference cannot be cached on disk).
"""

from __future__ import annotations

import difflib
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.fastsim import LAW as FASTSIM
from exudyn_wheelset.creep.fastsim import fastsim
from exudyn_wheelset.creep.law import CreepLaw
from exudyn_wheelset.creep.linear import LAW as LINEAR
from exudyn_wheelset.creep.linear import linear
from exudyn_wheelset.creep.polach import LAW as POLACH
from exudyn_wheelset.creep.polach import polach
from exudyn_wheelset.creep.polach_2005 import LAW as POLACH_2005
from exudyn_wheelset.creep.polach_2005 import polach_2005
from exudyn_wheelset.creep.polach_kalker import LAW as POLACH_KALKER
from exudyn_wheelset.creep.polach_kalker import polach_kalker
from exudyn_wheelset.creep.shen_hedrick_elkins import LAW as SHEN_HEDRICK_ELKINS
from exudyn_wheelset.creep.shen_hedrick_elkins import shen_hedrick_elkins
from exudyn_wheelset.creep.vermeulen_johnson import LAW as VERMEULEN_JOHNSON
from exudyn_wheelset.creep.vermeulen_johnson import vermeulen_johnson
from exudyn_wheelset.errors import WheelsetError

CREEP_LAWS: dict[str, CreepLaw] = {
    law.name: law
    for law in (
        LINEAR,
        VERMEULEN_JOHNSON,
        SHEN_HEDRICK_ELKINS,
        POLACH,
        POLACH_2005,
        FASTSIM,
        POLACH_KALKER,
    )
}

_LINEAR = LINEAR.number
_VERMEULEN_JOHNSON = VERMEULEN_JOHNSON.number
_SHEN_HEDRICK_ELKINS = SHEN_HEDRICK_ELKINS.number
_POLACH = POLACH.number
_POLACH_2005 = POLACH_2005.number
_POLACH_KALKER = POLACH_KALKER.number


@compiled
def creep_kernel(
    law_number: int,
    creep_x: float,
    creep_y: float,
    spin: float,
    a: float,
    b: float,
    normal_force: float,
    friction: float,
    shear_modulus: float,
    poisson: float,
    parameters: NDArray,
) -> tuple[float, float, float]:
    """Give (F_x, F_y, M_z) on the wheel by the law of that number, for compiled callers.

    Creepages [-] and spin [1/m] as (wheel - rail)/V; semi-axes a along rolling and b lateral [m];
    normal_force [N]; shear_modulus [Pa]; parameters: float64 array from `creep_parameters`.
    Forces [N] and moment about the contact normal [N m]. Zero without load, friction or patch;
    finite for every finite input. Nothing is checked here.
    """
    if law_number == _POLACH:
        return polach(
            creep_x,
            creep_y,
            spin,
            a,
            b,
            normal_force,
            friction,
            shear_modulus,
            poisson,
            parameters,
        )
    if law_number == _LINEAR:
        return linear(
            creep_x,
            creep_y,
            spin,
            a,
            b,
            normal_force,
            friction,
            shear_modulus,
            poisson,
            parameters,
        )
    if law_number == _VERMEULEN_JOHNSON:
        return vermeulen_johnson(
            creep_x,
            creep_y,
            spin,
            a,
            b,
            normal_force,
            friction,
            shear_modulus,
            poisson,
            parameters,
        )
    if law_number == _SHEN_HEDRICK_ELKINS:
        return shen_hedrick_elkins(
            creep_x,
            creep_y,
            spin,
            a,
            b,
            normal_force,
            friction,
            shear_modulus,
            poisson,
            parameters,
        )
    if law_number == _POLACH_2005:
        return polach_2005(
            creep_x,
            creep_y,
            spin,
            a,
            b,
            normal_force,
            friction,
            shear_modulus,
            poisson,
            parameters,
        )
    if law_number == _POLACH_KALKER:
        return polach_kalker(
            creep_x,
            creep_y,
            spin,
            a,
            b,
            normal_force,
            friction,
            shear_modulus,
            poisson,
            parameters,
        )
    return fastsim(
        creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson, parameters
    )


@compiled
def _creep_force_rows(law_number: int, states: NDArray, parameters: NDArray) -> NDArray:
    """Run `creep_kernel` over states (n, 9) and parameters (n, p) or (1, p); gives (n, 3)."""
    forces = np.empty((states.shape[0], 3))
    last = parameters.shape[0] - 1
    for i in range(states.shape[0]):
        row = states[i]
        force_x, force_y, moment = creep_kernel(
            law_number,
            row[0],
            row[1],
            row[2],
            row[3],
            row[4],
            row[5],
            row[6],
            row[7],
            row[8],
            parameters[min(i, last)],
        )
        forces[i, 0] = force_x
        forces[i, 1] = force_y
        forces[i, 2] = moment
    return forces


def creep_law(name: str) -> CreepLaw:
    """Give the description of a creep law.

    Raises WheelsetError for an unknown name; the message lists the names and the nearest one.
    """
    try:
        return CREEP_LAWS[name]
    except (KeyError, TypeError):
        raise WheelsetError(_unknown("creep law", name, list(CREEP_LAWS))) from None


def creep_parameters(law: str, **parameters: float) -> NDArray:
    """Give the parameter array of a law for `creep_kernel`: its defaults with changes by name.

    float64, in the order of `creep_law(law).parameters`. Raises WheelsetError for an unknown law,
    an unknown parameter or a value outside its range.
    """
    description = creep_law(law)
    parameters = description.expand(parameters)
    _check_names(description, parameters)
    values = np.array([p.default for p in description.parameters])
    for name, value in parameters.items():
        values[description.index(name)] = _checked(description, name, np.asarray(value))
    _check_together(description, values)
    return values


def creep_force(
    law: str,
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

    Every argument is a number or an array, broadcast together; the results are floats or arrays
    of the common shape. creep_x, creep_y [-] and spin [1/m] are (wheel - rail)/V in the contact
    frame (x rolling, y lateral tangent to the left, z from rail into wheel); a along rolling and
    b lateral are the semi-axes of the patch [m], > 0; normal_force [N] (none below zero);
    friction >= 0; shear_modulus [Pa] > 0; poisson from 0 to 0.5. Fx, Fy [N] oppose the creep, Mz
    [N m] about z. `parameters` are those of the law, `creep_law(law).parameters`.
    Raises WheelsetError for an unknown law or parameter and for values out of range or not finite.
    """
    description = creep_law(law)
    parameters = description.expand(parameters)
    _check_names(description, parameters)
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
    arrays = [_finite(name, value) for name, value in given.items()]
    _check_patch(dict(zip(given, arrays, strict=True)))
    own = [
        _checked(description, p.name, np.asarray(parameters.get(p.name, p.default)))
        for p in description.parameters
    ]
    broadcast = np.broadcast_arrays(*arrays, *own)
    shape = broadcast[0].shape
    table = np.stack([np.ravel(column) for column in broadcast], axis=-1)
    states = np.ascontiguousarray(table[:, : len(arrays)])
    laws_own = np.ascontiguousarray(table[:, len(arrays) :])
    for row in laws_own[: len(laws_own) if any(np.ndim(v) for v in own) else 1]:
        _check_together(description, row)
    forces = _creep_force_rows(description.number, states, laws_own)
    if shape == ():
        return float(forces[0, 0]), float(forces[0, 1]), float(forces[0, 2])
    return tuple(forces[:, i].reshape(shape) for i in range(3))  # type: ignore[return-value]


def _unknown(kind: str, name: object, known: list[str]) -> str:
    message = f"unknown {kind} {name!r}; known are {', '.join(known) or 'none'}"
    near = difflib.get_close_matches(str(name).lower(), known, n=1, cutoff=0.3)
    return f"{message}; did you mean {near[0]!r}?" if near else message


def _check_names(description: CreepLaw, parameters: dict[str, Any]) -> None:
    known = [p.name for p in description.parameters]
    for name in parameters:
        if name not in known:
            raise WheelsetError(
                _unknown(f"parameter of creep law {description.name!r}", name, known)
            )


def _finite(name: str, value: ArrayLike) -> NDArray:
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise WheelsetError(f"{name} must be a number or an array, not {value!r}") from None
    if not np.all(np.isfinite(array)):
        raise WheelsetError(f"{name} must be finite, has {array[~np.isfinite(array)].flat[0]}")
    return array


def _checked(description: CreepLaw, name: str, value: NDArray) -> NDArray:
    parameter = description.parameters[description.index(name)]
    array = _finite(name, value)
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


def _check_together(description: CreepLaw, values: NDArray) -> None:
    if description.number == _POLACH_2005:
        adhesion = values[description.index("adhesion_reduction")]
        slip = values[description.index("slip_reduction")]
        if slip > adhesion:
            raise WheelsetError(
                f"slip_reduction {slip:g} is above adhesion_reduction {adhesion:g}; Polach 2005 "
                "asks for k_S <= k_A: lower slip_reduction"
            )


def _check_patch(values: dict[str, NDArray]) -> None:
    limits = {
        "a": ("m", math.ulp(0.0), math.inf),
        "b": ("m", math.ulp(0.0), math.inf),
        "friction": ("-", 0.0, math.inf),
        "shear_modulus": ("Pa", math.ulp(0.0), math.inf),
        "poisson": ("-", 0.0, 0.5),
    }
    for name, (unit, low, high) in limits.items():
        wrong = (values[name] < low) | (values[name] > high)
        if np.any(wrong):
            ask = "positive" if high == math.inf and low > 0.0 else "at least 0"
            if high < math.inf:
                ask = f"from {low:g} to {high:g}"
            raise WheelsetError(
                f"{name} = {values[name][wrong].flat[0]:g} [{unit}]; it must be {ask}"
            )
