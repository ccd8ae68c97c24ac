"""Vermeulen-Johnson creep law: cubic saturation of the linear force, spin left out of the force.

Source: P. J. Vermeulen and K. L. Johnson, Contact of nonspherical elastic bodies transmitting
tangential forces, 1964. Their linear stiffness is replaced by Kalker's C11 and C22, as is usual
today. With u = |F_linear|/(mu N): |F| = mu N (u - u^2/3 + u^3/27) for u < 3, mu N beyond,
along the linear force. Frames and signs as in exudyn_wheelset.creep.kalker.
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

LAW = CreepLaw(
    "vermeulen-johnson", 1, "Vermeulen and Johnson 1964, with Kalker's coefficients", (SPIN_MOMENT,)
)


@compiled
def vermeulen_johnson(
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
    """Give (F_x, F_y, M_z) on the wheel by Vermeulen and Johnson; parameters: [spin_moment].

    Spin has no part in the forces.
    """
    limit = friction * normal_force
    if not (limit > LEAST_FRICTION_FORCE and a > 0.0 and b > 0.0):
        return 0.0, 0.0, 0.0
    creep_x, creep_y, spin = bounded(creep_x), bounded(creep_y), bounded(spin)
    force_x, force_y = linear_force(creep_x, creep_y, 0.0, a, b, shear_modulus, poisson)
    share = cubic_share(math.sqrt(force_x * force_x + force_y * force_y) / limit)
    moment = 0.0
    if parameters[0] > 0.5:
        moment = saturated_spin_moment(creep_x, creep_y, spin, a, b, limit, shear_modulus, poisson)
    return share * force_x, share * force_y, moment
