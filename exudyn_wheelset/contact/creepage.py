"""Creepages from the exact velocity of the wheel's particle at a point of contact.

v = v_C + omega x (P - C) minus the rail's; creep_x = v_x/V, creep_y = v.t/V with t = n x e_x, and
spin = omega.n/V (Petersen and Hoffmann 2003; no small angles). Track frame, left side.

Creep laws are written for a wheel that runs forwards. One that runs backwards, mirrored in x, runs
forwards: v_x, omega_y, omega_z and F_x, M_y, M_z change their signs. With the symmetries of laws in
y and of all signs at once this leaves (F_x, F_y) of the creepages over |V| and the spin over the
signed V, and the moment of the law with its sign changed (`direction`): camber thrust is to the
same side whichever way a wheel rolls.
"""

import math

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.layout import Creepage


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def slip_velocity(slip, x, y, z):
    """Velocity [m/s] over the rail of the wheel's particle at (x, y, z) [m] from the centre."""
    return (
        slip.x + slip.about_y * z - slip.about_z * y,
        slip.y + slip.about_z * x - slip.about_x * z,
        slip.z + slip.about_x * y - slip.about_y * x,
    )


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def creepage_at(slip, x, y, z, normal_y, normal_z):
    """Creepage of the wheel's particle at (x, y, z) [m] from the centre, in a normal's triad."""
    slip_x, slip_y, slip_z = slip_velocity(slip, x, y, z)
    return Creepage(
        slip_x / slip.speed,
        (normal_z * slip_y - normal_y * slip_z) / slip.speed,
        (normal_y * slip.about_y + normal_z * slip.about_z) / math.copysign(slip.speed, slip.x),
    )


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def direction(slip):
    """1 of a wheel that runs forwards, -1 backwards."""
    return math.copysign(1.0, slip.x)
