"""Shen-Hedrick-Elkins creep law: cubic saturation of the linear force, spin included.

Source: Z. Y. Shen, J. K. Hedrick and J. A. Elkins, A comparison of alternative creep force models
for rail vehicle dynamic analysis, 1983 (the heuristic nonlinear law). With the linear forces of
Kalker, spin included, and u = |F_linear|/(mu N): |F| = mu N (u - u^2/3 + u^3/27) for u < 3,
mu N beyond, along the linear force. Made for small spin: the force of spin does not fall again
when spin is large. Frames and signs as in exudyn_wheelset.creep.kalker.
"""

from __future__ import annotations

import math

from numpy.typing import NDArray

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.law import SPIN_MOMENT, CreepLaw
from exudyn_wheelset.creep.saturation import (
    LEAST_FRICTION_FORCE,
    bounded,
    cubic_share,
    linear_force,
    saturated_spin_moment,
)

LAW = CreepLaw("shen-hedrick-elkins", 2, "Shen, Hedrick and Elkins 1983", (SPIN_MOMENT,))


@compiled
def shen_hedrick_elkins(
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
    """Give (F_x, F_y, M_z) on the wheel by Shen, Hedrick and Elkins; parameters: [spin_moment]."""
    limit = friction * normal_force
    if not (limit > LEAST_FRICTION_FORCE and a > 0.0 and b > 0.0):
        return 0.0, 0.0, 0.0
    creep_x, creep_y, spin = bounded(creep_x), bounded(creep_y), bounded(spin)
    force_x, force_y = linear_force(creep_x, creep_y, spin, a, b, shear_modulus, poisson)
    share = cubic_share(math.sqrt(force_x * force_x + force_y * force_y) / limit)
    moment = 0.0
    if parameters[0] > 0.5:
        moment = saturated_spin_moment(creep_x, creep_y, spin, a, b, limit, shear_modulus, poisson)
    return share * force_x, share * force_y, moment
