"""Penetration on the rail's normals: the function p(s) of which the stored energy is a functional.

At arc length s of the rail the normal meets the outline of the wheel, the contact locus seen along
the track (locus.py), at a depth p(s) below the rail's surface: the deepest over x, because there
the wheel's normal m has no component along x. By the envelope theorem a rigid motion of the wheel
that gives its particle at that point P the velocity v changes p at that s by

    dp/dt = -(m.v)/(m.n),   m the wheel's normal (from rail into wheel), n the rail's:

a unit of load on that line pushes the wheel with m/(m.n) at P. Surfaces of revolution have normals
through their axis, so no pose gives a torque about the axle.

The outline is parallel to the wheel's profile only at yaw zero. With lx = l.e_x, t = dr/dw and
u = 1 - lx^2 (1 + t^2), an arc length ds_w of the profile is a length v ds_w of the outline,
    v = (1 - lx^2 (r' t + r t')/((1 - lx^2) w'))/(sqrt(u)/(1 - lx^2)),
and its curvature is that of the profile over v sqrt(u) (primes: d/ds_w).

Frame: track frame, left side; lengths in metres. The named tuple `axle`: layout.py.
"""

import math

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.curve import curve_point


@compiled(inline="always")
def gap_on_normal(table, side, place, arc, axle):
    """Penetration on the rail's normal at `place`: (p, dp/ds, d2p/ds2, arc).

    arc: of the wheel, a near guess going in, nearer coming out; p is right to third order in the
    guess's error.
    """
    ry, r1, r2, rz, q1, q2 = curve_point(table, side.rail, place)
    y, y1, y2, z, z1, z2 = curve_point(table, side.wheel, arc)
    r = side.radius - z
    t = -z1 / y1
    lx, ly, lz = axle.lx, axle.ly, axle.lz
    square = lx * lx
    rest = 1.0 - square
    under = max(rest - square * t * t, 1.0e-6)
    root = math.sqrt(under)
    along = -square * t / rest
    ey = along * ly + root / rest * lz
    ez = along * lz - root / rest * ly
    w = side.tape + y
    off_y = axle.y + w * ly + r * ey - ry
    off_z = axle.z + w * lz + r * ez - rz
    ny = ey * y1 + z1 * ly
    nz = ez * y1 + z1 * lz
    bend = y1 * z2 - z1 * y2
    speed = (rest - square * (-z1 * t - r * bend * (1.0 + t * t)) / y1) / root
    speed = max(speed, 0.2)
    cosine = max(ny * q1 - nz * r1, 0.2)
    slope = (ny * r1 + nz * q1) / cosine
    secant = math.sqrt(1.0 + slope * slope)
    bend /= root * speed
    aside = off_y * r1 + off_z * q1
    height = off_z * r1 - off_y * q1
    height += aside * (0.5 * bend * aside * secant * secant * secant - slope)
    rail_bend = r1 * q2 - q1 * r2
    stretch = 1.0 - rail_bend * height
    first = -slope * stretch
    second = (rail_bend - bend * stretch * secant) * secant * secant * stretch
    return -height, first, second - slope * rail_bend * first, arc - aside * secant / speed


@compiled
def line_of_force(table, side, place, arc, axle):
    """What a unit of load on the rail's normal at `place` does to the wheel.

    Returns (force_y, force_z, moment_x, moment_y, moment_z) about the axle's centre; arc: the
    wheel's, as `gap_on_normal` left it when it had converged.
    """
    _, r1, _, _, q1, _ = curve_point(table, side.rail, place)
    y, y1, _, z, z1, _ = curve_point(table, side.wheel, arc)
    r = side.radius - z
    t = -z1 / y1
    lx, ly, lz = axle.lx, axle.ly, axle.lz
    square = lx * lx
    rest = 1.0 - square
    along = -square * t / rest
    root = math.sqrt(max(rest - square * t * t, 1.0e-6)) / rest
    ey = along * ly + root * lz
    ez = along * lz - root * ly
    ny = -(ey * y1 + z1 * ly)
    nz = -(ez * y1 + z1 * lz)
    scale = 1.0 / max(nz * r1 - ny * q1, 0.2)
    fy = ny * scale
    fz = nz * scale
    w = side.tape + y
    px = w * lx + r * t * lx
    py = w * ly + r * ey
    pz = w * lz + r * ez
    return fy, fz, py * fz - pz * fy, -px * fz, px * fy
