"""Polach's creep law of 1999 with magnitude and direction taken from Kalker's vector.

Source: O. Polach (1999), see exudyn_wheelset.creep.polach, with one change. There the direction of
the force is that of the creepage and one stiffness c_jj, a mean of C11 and C22 over the direction,
serves both components: in slanted creepage the linear limit is off, and with spin present the law
has no derivative at zero creepage. Here both come from Kalker's linear force of the creepage:
    s_yc = s_y + psi a where that is larger in magnitude, else s_y,    h = hypot(C11 s_x, C22 s_yc)
    eps = G pi a b h/(4 Q f),         F = (2 Q f/pi) (eps/(1 + eps^2) + atan(eps))
    F_x = -F C11 s_x/h,               F_y = -F C22 s_y/h - F_ys psi/s_c
with F_ys and s_c = hypot(s_x, s_yc) as published; s_yc enters the magnitude only, as there. F_x and
F_y are those of 1999 where the creepage lies along x or y without spin, and for spin alone.

Linear limits: (2 Q f/pi) 2 eps = G a b h, so F -> -G a b (C11 s_x, C22 s_y) in every direction of
the creepage, with a relative error of (2/3) eps^2; and -G (a b)^(3/2) C23 psi for spin alone.
|F| is cut to Q f, which the sum may exceed.

Where it has a derivative. F/h is an even, analytic function of h, so without spin the forces are
smooth over all creepages, zero included. With spin they are smooth at and around zero creepage,
where s_yc = s_y + psi a is not zero, for every psi but 0. There is none (a kink; the forces are
continuous)
  - at s_y = -psi a/2, where |s_y + psi a| = |s_y|: s_yc changes its sign and the slopes jump;
  - where the cut begins;
  - over (s_x, s_y, psi) together at the point where all three are zero: the spin term is
    -G (a b)^(3/2) C23 psi |s_yc|/s_c there, homogeneous of degree one but not linear. A patch of a
    wheelset at rest between its rails has psi = -sin(contact angle)/r, which is zero for
    cylindrical wheels only.
Frames and signs as in exudyn_wheelset.creep.kalker; the moment is zero unless `spin_moment` asks
for one.
"""

from __future__ import annotations

import math

from numpy.typing import NDArray

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.kalker import kalker_coefficients
from exudyn_wheelset.creep.law import SPIN_MOMENT, CreepLaw
from exudyn_wheelset.creep.polach import spin_force
from exudyn_wheelset.creep.saturation import LEAST_FRICTION_FORCE, bounded, saturated_spin_moment

LAW = CreepLaw("polach-kalker", 8, "Polach 1999 along Kalker's vector", (SPIN_MOMENT,))


@compiled
def polach_kalker(
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
    """Give (F_x, F_y, M_z) on the wheel by the equations above; parameters: [spin_moment]."""
    limit = friction * normal_force
    if not (limit > LEAST_FRICTION_FORCE and a > 0.0 and b > 0.0):
        return 0.0, 0.0, 0.0
    creep_x, creep_y, spin = bounded(creep_x), bounded(creep_y), bounded(spin)
    turned = creep_y + spin * a
    lateral = turned if abs(turned) > abs(creep_y) else creep_y
    creep_c = math.sqrt(creep_x * creep_x + lateral * lateral)
    if creep_c == 0.0:
        return 0.0, 0.0, 0.0
    c11, c22, c23, _ = kalker_coefficients(a, b, poisson)
    along, across = c11 * creep_x, c22 * lateral
    pull = math.sqrt(along * along + across * across)
    eps = 0.25 * math.pi * shear_modulus * a * b * pull / limit
    # eps/(1 + eps^2) without the square that overflows
    per_pull = -2.0 / math.pi * limit / pull * (1.0 / (1.0 / eps + eps) + math.atan(eps))
    force_x = per_pull * along
    force_y = per_pull * c22 * creep_y
    if spin != 0.0:
        force_y += spin_force(lateral, spin, a, b, limit, shear_modulus, c23, 1.0) / creep_c
    total = math.sqrt(force_x * force_x + force_y * force_y)
    if total > limit:
        force_x *= limit / total
        force_y *= limit / total
    moment = 0.0
    if parameters[0] > 0.5:
        moment = saturated_spin_moment(creep_x, creep_y, spin, a, b, limit, shear_modulus, poisson)
    return force_x, force_y, moment
