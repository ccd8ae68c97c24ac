"""Frames of a vehicle's bodies: where they are, how they turn, what pushes them.

Axes are nine numbers, row by row, that turn components in the axes into those along the track. The
frame of a wheelset yaws and rolls with it, psi about z and phi about x, and does not spin: its
angular velocity in its own axes is (w_x, w_z tan phi, w_z).
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.vehicles.layout import (
    F_AXES,
    F_CENTRE,
    F_FORCE,
    F_MOMENT,
    F_OMEGA,
    F_SPINNING,
    F_TAN,
    F_VELOCITY,
    FIRST,
    SPINS,
)


@compiled
def place_frames(q, v, bodies, frames):
    """Fill the frames of all bodies and of the track (last row) from system coordinates."""
    count = bodies.shape[0]
    for b in range(count):
        first = int(bodies[b, FIRST])
        frame = frames[b]
        tx, ty, tz = q[first + 3], q[first + 4], q[first + 5]
        square = tx * tx + ty * ty + tz * tz
        if square > 1.0e-10:
            angle = math.sqrt(square)
            s = math.sin(angle) / angle
            c = (1.0 - math.cos(angle)) / square
        else:
            s = 1.0 - square / 6.0
            c = 0.5 - square / 24.0
        r = frame[F_SPINNING]
        r[0] = 1.0 - c * (ty * ty + tz * tz)
        r[1] = c * tx * ty - s * tz
        r[2] = c * tx * tz + s * ty
        r[3] = c * tx * ty + s * tz
        r[4] = 1.0 - c * (tx * tx + tz * tz)
        r[5] = c * ty * tz - s * tx
        r[6] = c * tx * tz - s * ty
        r[7] = c * ty * tz + s * tx
        r[8] = 1.0 - c * (tx * tx + ty * ty)
        for k in range(3):
            frame[F_CENTRE][k] = bodies[b, 2 + k] + q[first + k]
            frame[F_VELOCITY][k] = v[first + k]
            frame[F_FORCE][k] = 0.0
            frame[F_MOMENT][k] = 0.0
        wx, wy, wz = v[first + 3], v[first + 4], v[first + 5]
        ox = r[0] * wx + r[1] * wy + r[2] * wz
        oy = r[3] * wx + r[4] * wy + r[5] * wz
        oz = r[6] * wx + r[7] * wy + r[8] * wz
        a = frame[F_AXES]
        if bodies[b, SPINS] > 0.0:
            lx, ly, lz = r[1], r[4], r[7]
            level = math.sqrt(lx * lx + ly * ly)
            cosine, sine = ly / level, -lx / level
            a[0], a[3], a[6] = cosine, sine, 0.0
            a[1], a[4], a[7] = lx, ly, lz
            a[2], a[5], a[8] = sine * lz, -cosine * lz, level
            tangent = lz / level
            along = cosine * ox + sine * oy
            up = a[2] * ox + a[5] * oy + a[8] * oz
            ox = a[0] * along + a[1] * up * tangent + a[2] * up
            oy = a[3] * along + a[4] * up * tangent + a[5] * up
            oz = a[6] * along + a[7] * up * tangent + a[8] * up
            frame[F_TAN] = tangent
        else:
            for k in range(9):
                a[k] = r[k]
        frame[F_OMEGA][0] = ox
        frame[F_OMEGA][1] = oy
        frame[F_OMEGA][2] = oz
    track = frames[count]
    track[:] = 0.0
    track[0] = track[4] = track[8] = 1.0


@compiled(inline="always")
def turn(a, x, y, z):
    """Components along the track of a vector given in axes a (9)."""
    return (
        a[0] * x + a[1] * y + a[2] * z,
        a[3] * x + a[4] * y + a[5] * z,
        a[6] * x + a[7] * y + a[8] * z,
    )


@compiled(inline="always")
def turn_back(a, x, y, z):
    """Components in axes a (9) of a vector given along the track."""
    return (
        a[0] * x + a[3] * y + a[6] * z,
        a[1] * x + a[4] * y + a[7] * z,
        a[2] * x + a[5] * y + a[8] * z,
    )


@compiled(inline="always")
def push(frame, px, py, pz, fx, fy, fz):
    """Add a force at a point to a body."""
    centre, force, moment = frame[F_CENTRE], frame[F_FORCE], frame[F_MOMENT]
    rx, ry, rz = px - centre[0], py - centre[1], pz - centre[2]
    force[0] += fx
    force[1] += fy
    force[2] += fz
    moment[0] += ry * fz - rz * fy
    moment[1] += rz * fx - rx * fz
    moment[2] += rx * fy - ry * fx


@compiled
def rotation_between(lower, upper, theta):
    """Rotation vector [rad] of the axes `upper` against `lower` (9 numbers each), into theta."""
    r = np.empty(9)
    for i in range(3):
        for j in range(3):
            r[3 * i + j] = (
                lower[i] * upper[j] + lower[3 + i] * upper[3 + j] + lower[6 + i] * upper[6 + j]
            )
    x, y, z = 0.5 * (r[7] - r[5]), 0.5 * (r[2] - r[6]), 0.5 * (r[3] - r[1])
    sine = math.sqrt(x * x + y * y + z * z)
    factor = 1.0
    if sine > 1e-9:
        factor = math.atan2(sine, 0.5 * (r[0] + r[4] + r[8] - 1.0)) / sine
    theta[0], theta[1], theta[2] = factor * x, factor * y, factor * z


@compiled
def middle_axes(lower, theta, a):
    """Axes turned from `lower` by theta/2."""
    x, y, z = 0.5 * theta[0], 0.5 * theta[1], 0.5 * theta[2]
    square = x * x + y * y + z * z
    s, c = 1.0 - square / 6.0, 0.5 - square / 24.0
    e = np.empty(9)
    e[0], e[1], e[2] = 1.0 - c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y
    e[3], e[4], e[5] = c * x * y + s * z, 1.0 - c * (x * x + z * z), c * y * z - s * x
    e[6], e[7], e[8] = c * x * z - s * y, c * y * z + s * x, 1.0 - c * (x * x + y * y)
    for i in range(3):
        for j in range(3):
            a[3 * i + j] = (
                lower[3 * i] * e[j] + lower[3 * i + 1] * e[3 + j] + lower[3 * i + 2] * e[6 + j]
            )
