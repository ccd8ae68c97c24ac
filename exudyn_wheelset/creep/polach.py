"""Polach's creep law of 1999, spin included.

Source: O. Polach, A fast wheel-rail forces calculation computer code, Vehicle System Dynamics
Supplement 33 (1999). Q normal force, f friction, psi spin, s = (s_x, s_y) creepage:
    s_yc = s_y + psi a where that is larger in magnitude, else s_y;     s_c = hypot(s_x, s_yc)
    c_jj = sqrt((C11 s_x/s)^2 + (C22 s_y/s)^2),       eps = G pi a b c_jj s_c/(4 Q f)
    F = (2 Q f/pi) (eps/(1 + eps^2) + atan(eps))
    B = 1 + 6.3 (1 - exp(-a/b)),      eps_s = (8/3) G b sqrt(a b) C23 |s_yc|/(Q f B)
    d = (eps_s^2 - 1)/(eps_s^2 + 1),  K_M = eps_s (d^3/3 - d^2/2 + 1/6) - (1 - d^2)^(3/2)/3
    F_ys = -(9/16) a Q f K_M B
    F_x = -F s_x/s_c,                 F_y = -(F s_y + F_ys psi)/s_c.
Here |F| is cut to Q f, which the formula alone exceeds when spin and lateral creepage act
together. Without spin: monotonic, F = Q f at infinite creepage; both linear limits are Kalker's.

Smoothness. Continuous everywhere: where s_yc switches, |s_y + psi a| = |s_y| and only the
magnitude enters. Slopes jump there, at s_y = -psi a/2 and where the cut begins. At s = 0 with
spin present the law is homogeneous of degree one in s but not linear, because c_jj depends on
the direction of s: derivatives along x and along y exist, are the same on both sides and equal
-G a b C11 and about -G a b C22, so central differences along the axes give a well defined
linearisation; along a slanted direction it is off by at most |C22 - C11|/(C22 + C11).
The moment is zero unless `spin_moment` asks for one. Frames and signs as in
exudyn_wheelset.creep.kalker.
"""

from __future__ import annotations

import math

from numpy.typing import NDArray

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.kalker import kalker_coefficients
from exudyn_wheelset.creep.law import SPIN_MOMENT, CreepLaw
from exudyn_wheelset.creep.saturation import LEAST_FRICTION_FORCE, bounded, saturated_spin_moment

WHEN_LINEARISED = (
    "It has no derivative at zero creepage with spin: 'linear' means the slopes along x and along "
    "y, each taken alone; in slanted creepage, which hunting is, the force is not their sum, "
    "however small the motion."
)
LAW = CreepLaw("polach", 3, "Polach 1999", (SPIN_MOMENT,), when_linearised=WHEN_LINEARISED)

_EPS_LIMIT = 1e50


@compiled
def spin_force(
    lateral: float,
    spin: float,
    a: float,
    b: float,
    limit: float,
    shear_modulus: float,
    c23: float,
    reduction: float,
) -> float:
    """Give -F_ys psi [N] of the equations in the header, with s_yc = lateral and limit = Q f > 0.

    reduction multiplies eps_s (1 in 1999).
    """
    widening = 1.0 + 6.3 * (1.0 - math.exp(-a / b))
    eps_s = 8.0 / 3.0 * shear_modulus * b * math.sqrt(a * b) * c23 * abs(lateral)
    eps_s = min(reduction * eps_s / (limit * widening), _EPS_LIMIT)
    # q = 1 - d keeps the digits that d -> 1 loses
    q = 2.0 / (1.0 + eps_s * eps_s)
    root = math.sqrt(q * (2.0 - q))
    k_m = eps_s * q * q * (0.5 - q / 3.0) - root * root * root / 3.0
    return 9.0 / 16.0 * a * limit * k_m * widening * spin


@compiled
def polach_force(
    creep_x: float,
    creep_y: float,
    spin: float,
    a: float,
    b: float,
    limit: float,
    shear_modulus: float,
    poisson: float,
    adhesion: float,
    slip: float,
) -> tuple[float, float]:
    """Give (F_x, F_y) of the equations in the header with limit = Q f > 0 [N].

    adhesion and slip multiply eps in the first and the second term of F (both 1 in 1999), their
    mean multiplies eps_s.
    """
    turned = creep_y + spin * a
    lateral = turned if abs(turned) > abs(creep_y) else creep_y
    creep_c = math.sqrt(creep_x * creep_x + lateral * lateral)
    if creep_c == 0.0:
        return 0.0, 0.0
    c11, c22, c23, _ = kalker_coefficients(a, b, poisson)
    creep = math.sqrt(creep_x * creep_x + creep_y * creep_y)
    c_jj = c22
    if creep > 0.0:
        along, across = c11 * creep_x / creep, c22 * creep_y / creep
        c_jj = math.sqrt(along * along + across * across)
    eps = 0.25 * math.pi * shear_modulus * a * b * c_jj * creep_c / limit
    eps_adhesion = adhesion * eps
    force = 2.0 / math.pi * limit / creep_c
    force *= 1.0 / (1.0 / eps_adhesion + eps_adhesion) + math.atan(slip * eps)
    force_x = -force * creep_x
    force_y = -force * creep_y
    if spin != 0.0:
        reduction = 0.5 * (adhesion + slip)
        push = spin_force(lateral, spin, a, b, limit, shear_modulus, c23, reduction)
        force_y += push / creep_c
    total = math.sqrt(force_x * force_x + force_y * force_y)
    if total > limit:
        force_x *= limit / total
        force_y *= limit / total
    return force_x, force_y


@compiled
def polach(
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
    """Give (F_x, F_y, M_z) on the wheel by Polach 1999; parameters: [spin_moment]."""
    limit = friction * normal_force
    if not (limit > LEAST_FRICTION_FORCE and a > 0.0 and b > 0.0):
        return 0.0, 0.0, 0.0
    creep_x, creep_y, spin = bounded(creep_x), bounded(creep_y), bounded(spin)
    force_x, force_y = polach_force(
        creep_x, creep_y, spin, a, b, limit, shear_modulus, poisson, 1.0, 1.0
    )
    moment = 0.0
    if parameters[0] > 0.5:
        moment = saturated_spin_moment(creep_x, creep_y, spin, a, b, limit, shear_modulus, poisson)
    return force_x, force_y, moment
