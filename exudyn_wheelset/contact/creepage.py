"""Creepages from the exact velocity of the wheel's particle at a point of contact.

v = v_C + omega x (P - C) minus the rail's; creep_x = v_x/V, creep_y = v.t/V with t = n x e_x, and
spin = omega.n/V (Petersen and Hoffmann 2003; no small angles). Track frame, left side.
"""

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
        (normal_y * slip.about_y + normal_z * slip.about_z) / slip.speed,
    )
