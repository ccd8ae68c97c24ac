"""Where a wheel of revolution can touch a prismatic rail: the contact locus under yaw and roll.

Source: the locus of points of a surface of revolution whose normal has no component along the
rail (Wang 1984; Petersen and Hoffmann 2003 use the same condition). With the axle's unit vector
l = (lx, ly, lz), a profile point at distance w along the axle, rolling radius r and t = dr/dw, the
radial unit vector e of the contact point satisfies e.l = 0, |e| = 1 and, for the surface normal
e - t l to be free of x, e_x = t lx. Hence

    (e_y, e_z) = -lx^2 t/(1 - lx^2) (ly, lz) + sqrt(1 - lx^2 (1 + t^2))/(1 - lx^2) (lz, -ly)

and the point is P = C + w l + r e. Its x is the lead (or lag) of a flange contact. The outward
normal (from wheel into rail) is (e - t l)/sqrt(1 + t^2), which lies in the y-z plane.

Frame: track frame; both sides are computed as the left one (the right one is mirrored before).
Records and the named tuple `axle`: layout.py.
"""

import math

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.curve import curve_point


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def locus_point(w, r, t, cx, cy, cz, lx, ly, lz):
    """Return (x, y, z, normal_y, normal_z) of the contact locus, the normal into the rail."""
    q = 1.0 - lx * lx
    root = math.sqrt(max(q - lx * lx * t * t, 1.0e-6)) / q
    along = -lx * lx * t / q
    ey = along * ly + root * lz
    ez = along * lz - root * ly
    scale = 1.0 / math.sqrt(1.0 + t * t)
    return (
        cx + w * lx + r * t * lx,
        cy + w * ly + r * ey,
        cz + w * lz + r * ez,
        (ey - t * ly) * scale,
        (ez - t * lz) * scale,
    )


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def wheel_section(table, side, arc, axle):
    """Contact-locus point at the wheel's arc length in the y-z plane: (y, z, ny, nz, curvature).

    curvature [1/m] of the profile, z up, negative where the wheel is concave (throat). The arc's
    tangent (y', z') is of unit length, so y' = 1/sqrt(1 + t^2).
    """
    y, y1, y2, z, z1, z2 = curve_point(table, side.wheel, arc)
    r = side.radius - z
    t = -z1 / y1
    ly = axle.ly
    lz = axle.lz
    square = axle.lx * axle.lx
    q = 1.0 / (1.0 - square)
    along = -square * t * q
    root = math.sqrt(max(1.0 - square - square * t * t, 1.0e-6)) * q
    ey = along * ly + root * lz
    ez = along * lz - root * ly
    w = side.tape + y
    return (
        axle.y + w * ly + r * ey,
        axle.z + w * lz + r * ez,
        ey * y1 + z1 * ly,
        ez * y1 + z1 * lz,
        y1 * z2 - z1 * y2,
    )


@compiled(fastmath=AS_REAL_NUMBERS)
def wheel_point(table, side, arc, axle):
    """Contact-locus point with all about it: (x, y, z, ny, nz, radius, wheel_y, curvature).

    x is relative to the axle's centre; radius [m] is the rolling radius r sqrt(1 - (t lx)^2), the
    arm of the spin: the lead takes the rest of r out of the direction of travel.
    """
    y, y1, y2, z, z1, z2 = curve_point(table, side.wheel, arc)
    radius = side.radius - z
    slope = -z1 / y1
    x, py, pz, ny, nz = locus_point(
        side.tape + y, radius, slope, 0.0, axle.y, axle.z, axle.lx, axle.ly, axle.lz
    )
    arm = radius * math.sqrt(max(1.0 - slope * slope * axle.lx * axle.lx, 0.0))
    return x, py, pz, ny, nz, arm, y, y1 * z2 - z1 * y2


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def rail_foot(table, side, py, pz, arc):
    """Foot of the perpendicular from (py, pz) on the rail, from a near guess of its arc length.

    Returns (arc, tangent_y, tangent_z, curvature, height); height [m] is the signed distance of
    the point above the rail, curvature [1/m] is negative on a convex head. The guess is corrected
    by a Taylor step along the curve, whose error is of third order in the guess's.
    """
    y, y1, y2, z, z1, z2 = curve_point(table, side.rail, arc)
    curvature = y1 * z2 - z1 * y2
    height = (pz - z) * y1 - (py - y) * z1
    along = (py - y) * y1 + (pz - z) * z1
    bend = curvature * along
    return arc + along, y1 - bend * z1, z1 + bend * y1, curvature, height - 0.5 * bend * along
