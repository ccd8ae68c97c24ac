"""Polach's creep law of 2005: adhesion that falls at large slip.

Source: O. Polach, Creep forces in simulations of traction vehicles running on adhesion limit,
Wear 258 (2005). With eps of Polach 1999 (exudyn_wheelset.creep.polach):
    F = (2 Q f/pi) (k_A eps/(1 + (k_A eps)^2) + atan(k_S eps)),       k_S <= k_A <= 1
    f = mu_0 ((1 - A) exp(-B w) + A),     w = V hypot(s_x, s_y) [m/s].
`friction` is mu_0, friction at no slip. The speed V [m/s] is a parameter; at V = 0 friction does
not fall: a contact lets it fall before it asks the law (contact/friction.py). Spin acts as in 1999,
its linear stiffness reduced by (k_A + k_S)/2 as that of the creepage is. Typical values: dry
k_A 1.0, k_S 0.4, mu_0 0.55, A 0.4, B 0.6 s/m (the defaults but for mu_0); wet 0.3, 0.1, 0.3, 0.4,
0.2.
"""

from __future__ import annotations

import math

from numpy.typing import NDArray

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.law import SPIN_MOMENT, CreepLaw, CreepParameter
from exudyn_wheelset.creep.polach import WHEN_LINEARISED, polach_force
from exudyn_wheelset.creep.saturation import LEAST_FRICTION_FORCE, bounded, saturated_spin_moment

LAW = CreepLaw(
    "polach-2005",
    4,
    "Polach 2005",
    (
        SPIN_MOMENT,
        CreepParameter("adhesion_reduction", 1.0, 1e-6, 1.0, "k_A, for the adhesion zone"),
        CreepParameter("slip_reduction", 0.4, 1e-6, 1.0, "k_S, for the slip zone, <= k_A"),
        CreepParameter("friction_ratio", 0.4, 0.0, 1.0, "A, friction at infinite slip over mu_0"),
        CreepParameter("friction_decay", 0.6, 0.0, 1e6, "B, decay over slip velocity [s/m]"),
        CreepParameter("speed", 0.0, 0.0, 1e6, "V, speed of rolling [m/s]"),
    ),
    when_linearised=WHEN_LINEARISED,
)


@compiled
def polach_2005(
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
    """Give (F_x, F_y, M_z) on the wheel by Polach 2005.

    parameters: [spin_moment, adhesion_reduction, slip_reduction, friction_ratio, friction_decay,
    speed], with friction as mu_0.
    """
    creep_x, creep_y, spin = bounded(creep_x), bounded(creep_y), bounded(spin)
    ratio = parameters[3]
    slip_velocity = parameters[5] * math.sqrt(creep_x * creep_x + creep_y * creep_y)
    fall = (1.0 - ratio) * math.exp(-parameters[4] * slip_velocity) + ratio
    limit = friction * fall * normal_force
    if not (limit > LEAST_FRICTION_FORCE and a > 0.0 and b > 0.0):
        return 0.0, 0.0, 0.0
    force_x, force_y = polach_force(
        creep_x, creep_y, spin, a, b, limit, shear_modulus, poisson, parameters[1], parameters[2]
    )
    moment = 0.0
    if parameters[0] > 0.5:
        moment = saturated_spin_moment(creep_x, creep_y, spin, a, b, limit, shear_modulus, poisson)
    return force_x, force_y, moment
