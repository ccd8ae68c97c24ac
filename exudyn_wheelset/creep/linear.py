"""Kalker's linear creep law: full adhesion, forces proportional to creepage and spin.

Source: J. J. Kalker 1967 and 1990; equations and signs in exudyn_wheelset.creep.kalker. It knows
no friction limit, so its force exceeds mu N at large creepage unless `cap` is 1, which shortens
the force vector (not the moment) to mu N. For eigenvalues and for comparison.
"""

from __future__ import annotations

import math

from numpy.typing import NDArray

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.law import CreepLaw, CreepParameter
from exudyn_wheelset.creep.saturation import bounded, linear_force, linear_spin_moment

LAW = CreepLaw(
    "linear",
    0,
    "Kalker 1990, linear theory",
    (CreepParameter("cap", 0.0, 0.0, 1.0, "1: cut the force to mu N, 0: do not", whole=True),),
)


@compiled
def linear(
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
    """Give (F_x, F_y, M_z) on the wheel by Kalker's linear theory; parameters: [cap]."""
    if not (normal_force > 0.0 and a > 0.0 and b > 0.0):
        return 0.0, 0.0, 0.0
    creep_x, creep_y, spin = bounded(creep_x), bounded(creep_y), bounded(spin)
    force_x, force_y = linear_force(creep_x, creep_y, spin, a, b, shear_modulus, poisson)
    if parameters[0] > 0.5:
        force = math.sqrt(force_x * force_x + force_y * force_y)
        limit = max(friction, 0.0) * normal_force
        if force > limit:
            force_x *= limit / force
            force_y *= limit / force
    moment = linear_spin_moment(creep_y, spin, a, b, shear_modulus, poisson)
    return force_x, force_y, moment
