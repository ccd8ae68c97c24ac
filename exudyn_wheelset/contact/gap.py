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

import numpy as np

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.layout import (
    GAP_ARC,
    GAP_DEPTH,
    LINE_BEND,
    LINE_TANGENT_Y,
    LINE_TANGENT_Z,
    LINE_Y,
    LINE_Z,
    block_row,
)


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
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


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _curve_rows(table, curve):
    """Coefficients of a curve (segments, 8)."""
    start = curve.offset
    return table[start : start + 8 * curve.segments].reshape((curve.segments, 8))


@compiled(fastmath=AS_REAL_NUMBERS, noalias=True)
def _gaps(
    rows, spacing, lateral, heights, tangents_y, tangents_z, bends, arc, step, radius, tape, axle,
    depths, arcs,
):  # fmt: skip
    """Fill depths and arcs as `gap_on_normal` does; arc: the guess at the first place."""
    cy, cz, lx, ly, lz = axle
    per = 1.0 / spacing
    last = len(rows) - 1.0
    square = lx * lx
    rest = 1.0 - square
    per_rest = 1.0 / rest
    for k in range(len(depths)):
        guess = arc + step * k
        index = np.uintp(min(max(guess * per, 0.0), last))
        from_start = guess - np.float64(np.int64(index)) * spacing
        u = min(max(from_start, 0.0), spacing)
        beyond = from_start - u
        a0, a1, a2, a3, c0, c1, c2, c3 = (
            rows[index, 0], rows[index, 1], rows[index, 2], rows[index, 3],
            rows[index, 4], rows[index, 5], rows[index, 6], rows[index, 7],
        )  # fmt: skip
        y1 = a1 + u * (2.0 * a2 + 3.0 * u * a3)
        z1 = c1 + u * (2.0 * c2 + 3.0 * u * c3)
        y = a0 + u * (a1 + u * (a2 + u * a3)) + beyond * y1
        z = c0 + u * (c1 + u * (c2 + u * c3)) + beyond * z1
        bent = 2.0 if beyond == 0.0 else 0.0
        y2 = bent * (a2 + 3.0 * u * a3)
        z2 = bent * (c2 + 3.0 * u * c3)
        r = radius - z
        t = -z1 / y1
        under = max(rest - square * t * t, 1.0e-6)
        root = math.sqrt(under)
        along = -square * t * per_rest
        ey = along * ly + root * per_rest * lz
        ez = along * lz - root * per_rest * ly
        w = tape + y
        off_y = cy + w * ly + r * ey - lateral[k]
        off_z = cz + w * lz + r * ez - heights[k]
        r1 = tangents_y[k]
        q1 = tangents_z[k]
        ny = ey * y1 + z1 * ly
        nz = ez * y1 + z1 * lz
        bend = y1 * z2 - z1 * y2
        speed = (rest - square * (-z1 * t - r * bend * (1.0 + t * t)) / y1) / root
        speed = max(speed, 0.2)
        cosine = max(ny * q1 - nz * r1, 0.2)
        slope = (ny * r1 + nz * q1) / cosine
        secant = math.sqrt(1.0 + slope * slope)
        aside = off_y * r1 + off_z * q1
        height = off_z * r1 - off_y * q1
        bent_by = bend / (root * speed) * secant * secant * secant
        height += aside * (0.5 * bent_by * aside - slope)
        depths[k] = -height
        arcs[k] = guess - aside * secant / speed


@compiled
def sample_gap(table, side, lobe, first, end, axle, gap):
    """Fill GAP_DEPTH and GAP_ARC of `gap` from node `first` to before `end`.

    The wheel's arc is guessed from the lobe's: beside a contact its lead over the rail's hardly
    changes.
    """
    spacing = side.line_spacing
    lines = side.lines
    lead = lobe.arc - lobe.foot
    _gaps(
        _curve_rows(table, side.wheel), side.wheel.spacing,
        block_row(table, lines, LINE_Y)[first:end], block_row(table, lines, LINE_Z)[first:end],
        block_row(table, lines, LINE_TANGENT_Y)[first:end],
        block_row(table, lines, LINE_TANGENT_Z)[first:end],
        block_row(table, lines, LINE_BEND)[first:end],
        side.line_start + first * spacing + lead, spacing, side.radius, side.tape, axle,
        gap[GAP_DEPTH, first:end], gap[GAP_ARC, first:end],
    )  # fmt: skip


@compiled(fastmath=AS_REAL_NUMBERS, noalias=True)
def _push(rows, spacing, tangents_y, tangents_z, arcs, weights, radius, tape, axle, wrench):
    """Add weighted lines of force to the wrench, as `line_of_force` says."""
    _, _, lx, ly, lz = axle
    per = 1.0 / spacing
    last = len(rows) - 1.0
    square = lx * lx
    rest = 1.0 - square
    per_rest = 1.0 / rest
    force_y = force_z = moment_x = moment_y = moment_z = 0.0
    for k in range(len(weights)):
        arc = arcs[k]
        index = np.uintp(min(max(arc * per, 0.0), last))
        from_start = arc - np.float64(np.int64(index)) * spacing
        u = min(max(from_start, 0.0), spacing)
        beyond = from_start - u
        a0, a1, a2, a3, c0, c1, c2, c3 = (
            rows[index, 0], rows[index, 1], rows[index, 2], rows[index, 3],
            rows[index, 4], rows[index, 5], rows[index, 6], rows[index, 7],
        )  # fmt: skip
        y1 = a1 + u * (2.0 * a2 + 3.0 * u * a3)
        z1 = c1 + u * (2.0 * c2 + 3.0 * u * c3)
        y = a0 + u * (a1 + u * (a2 + u * a3)) + beyond * y1
        z = c0 + u * (c1 + u * (c2 + u * c3)) + beyond * z1
        r = radius - z
        t = -z1 / y1
        along = -square * t * per_rest
        root = math.sqrt(max(rest - square * t * t, 1.0e-6)) * per_rest
        ey = along * ly + root * lz
        ez = along * lz - root * ly
        ny = -(ey * y1 + z1 * ly)
        nz = -(ez * y1 + z1 * lz)
        scale = weights[k] / max(nz * tangents_y[k] - ny * tangents_z[k], 0.2)
        fy = ny * scale
        fz = nz * scale
        w = tape + y
        px = w * lx + r * t * lx
        py = w * ly + r * ey
        pz = w * lz + r * ez
        force_y += fy
        force_z += fz
        moment_x += py * fz - pz * fy
        moment_y -= px * fz
        moment_z += px * fy
    wrench[0] = force_y
    wrench[1] = force_z
    wrench[2] = moment_x
    wrench[3] = moment_y
    wrench[4] = moment_z


@compiled
def push_on_lines(table, side, first, weights, axle, gap, wrench):
    """Wrench (force y, z, moment x, y, z) of parts `weights` of a unit load on nodes from `first`.

    The nodes have been sampled, so that their arcs of the wheel are at hand.
    """
    end = first + len(weights)
    lines = side.lines
    _push(
        _curve_rows(table, side.wheel), side.wheel.spacing,
        block_row(table, lines, LINE_TANGENT_Y)[first:end],
        block_row(table, lines, LINE_TANGENT_Z)[first:end],
        gap[GAP_ARC, first:end], weights, side.radius, side.tape, axle, wrench,
    )  # fmt: skip
