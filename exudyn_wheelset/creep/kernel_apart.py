"""All creep laws, as compiled code calls them: apart, so that they are compiled once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.apart import Apart
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.kernel import force_at

CREEP = Apart(force_at, "i" + "fffffffff" + "ii", results=3)
_call = CREEP.call


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
    return _call((
        law_number, creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson,
        parameters.ctypes.data, parameters.size,
    ))  # fmt: skip


@compiled
def creep_force_rows(law_number: int, states: NDArray, parameters: NDArray) -> NDArray:
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
