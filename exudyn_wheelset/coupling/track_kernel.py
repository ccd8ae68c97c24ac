"""Where the track lies, compiled: its frame at a station, and the rails' shape there.

The frame at arc length s has x along the centre line and z along the canted normal; against level
ground it is turned by Rz(heading) Ry(-slope) Rx(roll) (track/layout.py). With the curvature k, the
slope c and the roll p as functions of s, its angular velocity is V times the rate by arc length

    W = Rx(p)^T (k sin c, -c', k cos c) + p' e_x          in its own axes,

its origin moves with V e_x and is accelerated by V^2 W x e_x, and the rate of the angular velocity
in its axes is V^2 dW/ds, at constant V. The vertical of the ground has the components
(sin c, sin p cos c, cos p cos c).

From a to b the direction turns by the integral of k, and the way is that of the direction: closed
where curvature and gradient are constant, Gauss' rule with five points over pieces of at most 8 m
elsewhere. Nothing is summed up from the beginning of the track: arc lengths may be 1000 km.

Everything stands in one array of numbers, shared by all wheelsets and bodies of a vehicle: places
of its entries below. While it is not live, the track is for ever what it is at one station, without
irregularity, so that a vehicle in a curve is autonomous. SI, radians.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_wheelset.compilation import compiled

# live: whether stations count; curved: whether the frame turns anywhere; at the start [m] at time
# zero with the speed [m/s]; base: what the track is while not live; counts and places of the pieces
# of the layout and of the points of the irregularity.
LIVE, CURVED, START, SPEED = 0, 1, 2, 3
FROZEN = slice(4, 8)
PIECES, KNOTS, KNOTS_AT = 8, 9, 10
HEADER = 12
# A piece: first station, whether it is a circle (constant in all), four cubics: curvature [1/m],
# sin(roll), gradient [-], signed widening [m].
FIRST, CIRCLE, CUBICS = 0, 1, 2
PIECE = 18

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)
NODES = tuple(float(x) for x in 0.5 * (1.0 + _NODES))
WEIGHTS = tuple(float(x) for x in 0.5 * _WEIGHTS)


@compiled(inline="always")
def _cubic(track, at, x):
    """Value of the cubic at a place of the array and its first two derivatives."""
    c1, c2, c3 = track[at + 1], track[at + 2], track[at + 3]
    return (
        track[at] + x * (c1 + x * (c2 + x * c3)),
        c1 + x * (2.0 * c2 + x * 3.0 * c3),
        2.0 * c2 + 6.0 * c3 * x,
    )


@compiled
def piece_at(track, s):
    """Number of the piece that a station lies in, the first or last one beyond the ends."""
    low, high = 0, int(track[PIECES]) - 1
    while low < high:
        middle = (low + high + 1) // 2
        if track[HEADER + middle * PIECE + FIRST] <= s:
            low = middle
        else:
            high = middle - 1
    return low


@compiled
def track_at(track, s):
    """Curvature k, k', u = sin(roll), u', u'', gradient g, g', g'', signed widening w, w' at s."""
    if track[LIVE] == 0.0:
        return track[4], 0.0, track[5], 0.0, 0.0, track[6], 0.0, 0.0, track[7], 0.0
    at = HEADER + piece_at(track, s) * PIECE
    x = s - track[at + FIRST]
    at += CUBICS
    k, k1, _ = _cubic(track, at, x)
    u, u1, u2 = _cubic(track, at + 4, x)
    g, g1, g2 = _cubic(track, at + 8, x)
    w, w1, _ = _cubic(track, at + 12, x)
    return k, k1, u, u1, u2, g, g1, g2, w, w1


@compiled
def frame_turning(track, s):
    """W (3) and dW/ds (3) [1/m, 1/m^2] and the ground's vertical (3), all in the frame's axes."""
    k, k1, u, u1, u2, g, g1, g2, _, _ = track_at(track, s)
    cc = 1.0 / math.sqrt(1.0 + g * g)
    sc = g * cc
    c1 = g1 * cc * cc
    c2 = g2 * cc * cc - 2.0 * g * c1 * c1
    cp = math.sqrt(1.0 - u * u)
    p1 = u1 / cp
    p2 = u2 / cp + u * p1 * p1 / cp
    y, z = -c1, k * cc
    y1, z1 = -c2, k1 * cc - k * sc * c1
    return (
        k * sc + p1,
        cp * y + u * z,
        cp * z - u * y,
        k1 * sc + k * cc * c1 + p2,
        p1 * (cp * z - u * y) + cp * y1 + u * z1,
        -p1 * (cp * y + u * z) + cp * z1 - u * y1,
        sc,
        u * cc,
        cp * cc,
    )


@compiled(inline="always")
def _slopes(g, u):
    """cos and sin of the slope, cos and sin of the roll."""
    cc = 1.0 / math.sqrt(1.0 + g * g)
    return cc, g * cc, math.sqrt(1.0 - u * u), u


@compiled
def _way(track, a, b):
    """From a to b: turn of the heading [rad] and way (x, y, z) [m], in level axes.

    Level axes at a: x along the plan of the track, z up.
    """
    turned = x = y = z = 0.0
    here = a
    last = int(track[PIECES]) - 1
    live = track[LIVE] != 0.0
    number = piece_at(track, a) if live else 0
    ahead = b >= a
    if live and not ahead and number > 0 and track[HEADER + number * PIECE + FIRST] == a:
        number -= 1
    while True:
        there = b
        circle = True
        k, g = track[4], track[6]
        at = HEADER + number * PIECE
        if live:
            if ahead and number < last:
                there = min(b, track[at + PIECE + FIRST])
            elif not ahead and number > 0:
                there = max(b, track[at + FIRST])
            circle = track[at + CIRCLE] != 0.0
            k, g = track[at + CUBICS], track[at + CUBICS + 8]
        length = there - here
        if circle:
            cc = 1.0 / math.sqrt(1.0 + g * g)
            half = 0.5 * k * length
            square = half * half
            chord = length * (1.0 - square / 6.0 * (1.0 - square / 20.0))
            if square > 1.0e-4:
                chord = length * math.sin(half) / half
            x += cc * chord * math.cos(turned + half)
            y += cc * chord * math.sin(turned + half)
            z += g * cc * length
            turned += 2.0 * half
        else:
            x0 = here - track[at + FIRST]
            c0, c1, c2, c3 = (
                track[at + CUBICS], track[at + CUBICS + 1], track[at + CUBICS + 2],
                track[at + CUBICS + 3],
            )  # fmt: skip
            before = x0 * (c0 + x0 * (c1 / 2.0 + x0 * (c2 / 3.0 + x0 * c3 / 4.0)))
            for n in range(5):
                xn = x0 + NODES[n] * length
                angle = xn * (c0 + xn * (c1 / 2.0 + xn * (c2 / 3.0 + xn * c3 / 4.0))) - before
                gn, _, _ = _cubic(track, at + CUBICS + 8, xn)
                cc = 1.0 / math.sqrt(1.0 + gn * gn)
                weight = WEIGHTS[n] * length
                x += weight * cc * math.cos(turned + angle)
                y += weight * cc * math.sin(turned + angle)
                z += weight * cc * gn
            xn = x0 + length
            turned += xn * (c0 + xn * (c1 / 2.0 + xn * (c2 / 3.0 + xn * c3 / 4.0))) - before
        here = there
        if here == b:
            return turned, x, y, z
        number += 1 if ahead else -1


@compiled
def relative_pose(track, a, b, pose):
    """Fill pose (12): axes of the frame at b in those at a, row by row, and its origin [m]."""
    turned, x, y, z = _way(track, a, b)
    _, _, ua, _, _, ga, _, _, _, _ = track_at(track, a)
    _, _, ub, _, _, gb, _, _, _, _ = track_at(track, b)
    ca, sa, cp, sp = _slopes(ga, ua)
    cb, sb, cq, sq = _slopes(gb, ub)
    ct, st = math.cos(turned), math.sin(turned)
    # Columns of Rz(turned) Ry(-slope_b) Rx(roll_b), and the way.
    columns = (
        (ct * cb, st * cb, sb),
        (-ct * sb * sq - st * cq, ct * cq - st * sb * sq, cb * sq),
        (st * sq - ct * sb * cq, -st * sb * cq - ct * sq, cb * cq),
        (x, y, z),
    )
    for j in range(4):
        vx, vy, vz = columns[j]
        # Into the axes at a: Rx(roll_a)^T Ry(-slope_a)^T.
        along, up = ca * vx + sa * vz, ca * vz - sa * vx
        across, normal = cp * vy + sp * up, cp * up - sp * vy
        if j < 3:
            pose[j] = along
            pose[3 + j] = across
            pose[6 + j] = normal
        else:
            pose[9] = along
            pose[10] = across
            pose[11] = normal


@compiled
def frame_beside(track, s, x, y, z, pose):
    """Station of a point (x, y, z) [m] of the frame at s: where the frame's plane x = 0 holds it.

    Fills pose (12) with that frame, as `relative_pose` does.
    """
    station = s + x
    relative_pose(track, s, station, pose)
    for _ in range(2):
        dx, dy, dz = x - pose[9], y - pose[10], z - pose[11]
        ahead = pose[0] * dx + pose[3] * dy + pose[6] * dz
        # A millionth of a metre turns the frame by less than 1e-8 rad.
        if abs(ahead) < 1.0e-7:
            break
        aside = pose[1] * dx + pose[4] * dy + pose[7] * dz
        station += ahead / (1.0 - track_at(track, station)[0] * aside)
        relative_pose(track, s, station, pose)
    return station


@compiled
def _interval(track, s):
    """Number of the irregularity's interval that holds a station within its ends."""
    at, last = int(track[KNOTS_AT]), int(track[KNOTS]) - 2
    first = track[at]
    width = track[at + last + 1] - first
    guess = min(max(int((s - first) / width * (last + 1)), 0), last)
    if track[at + guess] <= s <= track[at + guess + 1]:
        return guess
    low, high = 0, last
    while low < high:
        middle = (low + high + 1) // 2
        if track[at + middle] <= s:
            low = middle
        else:
            high = middle - 1
    return low


@compiled
def rail_shape(track, s, motion):
    """Put shifts and slopes of both rails at a station into motion (12) (contact/forces.py)."""
    for k in range(4):
        motion[k] = 0.0
        motion[8 + k] = 0.0
    _, _, _, _, _, _, _, _, wide, widening = track_at(track, s)
    hand = 0 if wide > 0.0 or (wide == 0.0 and widening > 0.0) else 1
    motion[2 * hand] = wide
    motion[8 + 2 * hand] = widening
    count = int(track[KNOTS])
    if count == 0 or track[LIVE] == 0.0:
        return
    at = int(track[KNOTS_AT])
    first, last = track[at], track[at + count - 1]
    inside = min(max(s, first), last)
    row = _interval(track, inside)
    x = inside - track[at + row]
    place = at + count + 16 * row
    for k in range(4):
        value, slope, _ = _cubic(track, place + 4 * k, x)
        motion[k] += value
        if s == inside:
            motion[8 + k] += slope
