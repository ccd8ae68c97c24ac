"""What several creep laws share: linear forces, their cubic saturation, a saturated spin moment.

Cubic saturation (P. J. Vermeulen and K. L. Johnson, 1964): a linear force of u mu N becomes
mu N (u - u^2/3 + u^3/27) = mu N (1 - (1 - u/3)^3) for u < 3 and mu N beyond.

Spin moment for laws that have none: Kalker's linear moment, saturated. Its two parts fade
differently. The part of the lateral creepage comes from the lead of the slip zone over the
adhesion zone and goes with the share of the force that friction still has left, (1 - u/3)^3; the
part of the spin goes with 1 - u/3 + u^2/27 towards the moment of full turning slip,
(3 pi/16) mu N sqrt(a b) (exact for a = b under Hertz pressure). u is taken from the linear
force and the linear turning moment together. It is a heuristic: docs/creep.md has its distance
from CONTACT. Frames and signs as in exudyn_wheelset.creep.kalker.
"""

from __future__ import annotations

import math

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.kalker import kalker_coefficients

CREEP_LIMIT = 1e50
LEAST_FRICTION_FORCE = 1e-100
FULL_TURNING_SLIP = 3.0 * math.pi / 16.0


@compiled
def bounded(creep: float) -> float:
    """Keep a creepage or spin so small that no square of a force in this package overflows."""
    return min(max(creep, -CREEP_LIMIT), CREEP_LIMIT)


@compiled
def linear_force(
    creep_x: float,
    creep_y: float,
    spin: float,
    a: float,
    b: float,
    shear_modulus: float,
    poisson: float,
) -> tuple[float, float]:
    """Give Kalker's linear creep forces (F_x, F_y) [N] on the wheel; spin [1/m]."""
    c11, c22, c23, _ = kalker_coefficients(a, b, poisson)
    stiffness = shear_modulus * a * b
    force_x = -stiffness * c11 * creep_x
    force_y = -stiffness * (c22 * creep_y + math.sqrt(a * b) * c23 * spin)
    return force_x, force_y


@compiled
def cubic_share(u: float) -> float:
    """Give the saturated force as a share of the linear force, which is u times mu N."""
    if u < 3.0:
        return 1.0 - u / 3.0 + u * u / 27.0
    return 1.0 / u


@compiled
def linear_spin_moment(
    creep_y: float, spin: float, a: float, b: float, shear_modulus: float, poisson: float
) -> float:
    """Give Kalker's linear moment [N m] on the wheel about the contact normal."""
    _, _, c23, c33 = kalker_coefficients(a, b, poisson)
    area = a * b
    return shear_modulus * area * (math.sqrt(area) * c23 * creep_y - area * c33 * spin)


@compiled
def saturated_spin_moment(
    creep_x: float,
    creep_y: float,
    spin: float,
    a: float,
    b: float,
    friction_force: float,
    shear_modulus: float,
    poisson: float,
) -> float:
    """Give the saturated spin moment [N m] on the wheel; friction_force = mu N > 0 [N]."""
    c11, c22, c23, c33 = kalker_coefficients(a, b, poisson)
    area = a * b
    length = math.sqrt(area)
    stiffness = shear_modulus * area
    u_x = stiffness * c11 * creep_x / friction_force
    u_y = stiffness * (c22 * creep_y + length * c23 * spin) / friction_force
    turning = stiffness * area * c33 * spin
    u_turn = turning / (FULL_TURNING_SLIP * friction_force * length)
    u = math.sqrt(u_x * u_x + u_y * u_y + u_turn * u_turn)
    moment = -turning * cubic_share(u)
    if u < 3.0:
        moment += stiffness * length * c23 * creep_y * (1.0 - u / 3.0) ** 3
    return moment
