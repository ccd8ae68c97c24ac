"""All connections of a vehicle in one compiled call: forces on its bodies, rates of its dampers.

Track frame (x forward, y left, z up). A connection joins a point P0 of a lower body to a point P1
of an upper one, and has axes A: those of one of the two bodies, those half way between both, or
those of the track. What it feels is

    d = A^T (P1 - P0) - d0,   theta = log(A0^T A1) - theta0,   d' = A^T (v1 - v0 - w_A x (P1 - P0)),

zero in the drawn position; theta is the rotation vector of the upper body against the lower one,
the same in the axes of both. A spring with the potential U = e^T K e/2, e = (d, theta), then gives
by virtual work, with g = dU/de,

    force on the upper body      -A g_d, at the end of the other body than the axes' one,
    moment on the upper body     -A J^-T g_theta,
                                 J^-T v = v +- theta x v/2 + theta x (theta x v)/12,
    on the lower body            the opposite, at the same point.

The sign in J is + for axes of the lower body, - for the upper one's, and the term is 0 half way
between both, where the force acts in the middle of P0 and P1. Dampers take g = D (d', w1 - w0) in
the same way, so their power is -e'^T D e'. A preload is a pair of forces that keep their direction
in the track and act each at its own end, a potential as well; its moments turn with the axes, and
so does the preload of a connection whose axes are those half way.

A wheelset takes part with the frame that yaws and rolls with it and does not spin: yaw psi about
z, roll phi about x. Rotation by the spin moves none of its points here, so of a moment m in that
frame it feels (m_x, 0, m_z + m_y tan phi).
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.vehicles.frames import (
    middle_axes,
    place_frames,
    push,
    rotation_between,
    turn,
    turn_back,
)
from exudyn_wheelset.vehicles.friction_kernel import friction_law
from exudyn_wheelset.vehicles.layout import (
    AXES,
    BLOW_OFF,
    BODY,
    DIRECTED,
    F_AXES,
    F_MOMENT,
    F_SPINNING,
    F_TAN,
    FIRST,
    FRAME,
    FRICTION,
    H_BODIES,
    H_BODY_ROWS,
    H_ENERGY,
    H_FIRST_STATE,
    H_FORCES,
    H_FRAMES,
    H_LAW_ROWS,
    H_LAWS,
    H_MEMORY,
    H_POOL,
    H_POWER,
    H_RATES,
    H_STATES,
    KIND,
    LENGTH,
    LOWER,
    OF_LOWER,
    OF_MIDDLE,
    OF_TRACK,
    OF_UPPER,
    POOL,
    ROD,
    ROW,
    SPINS,
    SPRING,
    STATE,
    STOP,
    TENSION,
    UPPER,
)


@compiled
def curve_value(pool, start, x):
    """Value, and integral from zero, of a piecewise cubic at x; straight beyond its ends.

    At `start`: number n of pieces, then n + 1 abscissae, then rows of four coefficients (of
    (x - x_i)^0 to ^3) and the integral up to x_i.
    """
    count = int(pool[start])
    nodes = start + 1
    rows = nodes + count + 1
    piece = 0
    while piece < count - 1 and x > pool[nodes + piece + 1]:
        piece += 1
    inside = min(max(x, pool[nodes]), pool[nodes + count])
    u = inside - pool[nodes + piece]
    row = rows + 5 * piece
    c0, c1, c2, c3 = pool[row], pool[row + 1], pool[row + 2], pool[row + 3]
    value = c0 + u * (c1 + u * (c2 + u * c3))
    area = pool[row + 4] + u * (c0 + u * (c1 / 2.0 + u * (c2 / 3.0 + u * c3 / 4.0)))
    beyond = x - inside
    if beyond != 0.0:
        slope = c1 + u * (2.0 * c2 + u * 3.0 * c3)
        area += beyond * (value + 0.5 * beyond * slope)
        value += beyond * slope
    return value, area


@compiled
def connection_forces(q, v, states, block):
    """Forces on the bodies, rates of the states, stored energy and power taken, into the block.

    q, v: second-order coordinates of the system and their velocities; states: its first-order
    ones. The block keeps the coordinates that its results belong to: a second call with the same
    ones returns at once.
    """
    count = int(block[H_BODIES])
    laws = int(block[H_LAWS])
    own_states = int(block[H_STATES])
    first_state = int(block[H_FIRST_STATE])
    start = int(block[H_BODY_ROWS])
    bodies = block[start : start + count * BODY].reshape(count, BODY)
    start = int(block[H_MEMORY])
    memory = block[start : start + 12 * count + own_states + 1]
    same = memory[0] == memory[0]
    memory[0] = 0.0
    for b in range(count):
        first = int(bodies[b, FIRST])
        place = 1 + 12 * b
        for k in range(6):
            if memory[place + k] != q[first + k] or memory[place + 6 + k] != v[first + k]:
                same = False
                memory[place + k] = q[first + k]
                memory[place + 6 + k] = v[first + k]
    for k in range(own_states):
        if memory[1 + 12 * count + k] != states[first_state + k]:
            same = False
            memory[1 + 12 * count + k] = states[first_state + k]
    if same:
        return
    start = int(block[H_LAW_ROWS])
    rows = block[start : start + laws * ROW].reshape(laws, ROW)
    pool_start = int(block[H_POOL])
    start = int(block[H_FRAMES])
    frames = block[start : start + (count + 1) * FRAME].reshape(count + 1, FRAME)
    start = int(block[H_RATES])
    rates = block[start : start + own_states]
    place_frames(q, v, bodies, frames)
    energy = 0.0
    power = 0.0
    theta = np.zeros(3)
    between = np.zeros(9)
    g = np.zeros(6)
    drag = np.zeros(6)
    for law in range(laws):
        row = rows[law]
        kind = int(row[KIND])
        lower = frames[int(row[LOWER])]
        upper = frames[int(row[UPPER])]
        x, y, z = turn(lower[F_AXES], row[4], row[5], row[6])
        p0x, p0y, p0z = lower[9] + x, lower[10] + y, lower[11] + z
        ox, oy, oz = lower[15], lower[16], lower[17]
        v0x = lower[12] + oy * z - oz * y
        v0y = lower[13] + oz * x - ox * z
        v0z = lower[14] + ox * y - oy * x
        x, y, z = turn(upper[F_AXES], row[7], row[8], row[9])
        p1x, p1y, p1z = upper[9] + x, upper[10] + y, upper[11] + z
        ox, oy, oz = upper[15], upper[16], upper[17]
        gx, gy, gz = p1x - p0x, p1y - p0y, p1z - p0z
        ux = upper[12] + oy * z - oz * y - v0x
        uy = upper[13] + oz * x - ox * z - v0y
        uz = upper[14] + ox * y - oy * x - v0z
        if kind == ROD:
            length = math.sqrt(gx * gx + gy * gy + gz * gz)
            nx, ny, nz = gx / length, gy / length, gz / length
            rate = nx * ux + ny * uy + nz * uz
            longer = length - row[LENGTH]
            tension = row[TENSION] + row[23] * longer
            energy += longer * (row[TENSION] + 0.5 * row[23] * longer)
            power += row[26] * rate * rate
            tension += row[26] * rate
            push(upper, p1x, p1y, p1z, -tension * nx, -tension * ny, -tension * nz)
            push(lower, p0x, p0y, p0z, tension * nx, tension * ny, tension * nz)
            continue
        whose = int(row[AXES])
        a = lower[F_AXES]
        wx, wy, wz = lower[15], lower[16], lower[17]
        if whose == OF_UPPER:
            a = upper[F_AXES]
            wx, wy, wz = ox, oy, oz
        elif whose == OF_MIDDLE:
            rotation_between(lower[F_AXES], upper[F_AXES], theta)
            middle_axes(lower[F_AXES], theta, between)
            a = between
            wx, wy, wz = 0.5 * (wx + ox), 0.5 * (wy + oy), 0.5 * (wz + oz)
        elif whose == OF_TRACK:
            a = frames[count][F_AXES]
            wx, wy, wz = 0.0, 0.0, 0.0
        dx, dy, dz = turn_back(a, gx, gy, gz)
        dx -= row[16]
        dy -= row[17]
        dz -= row[18]
        ux -= wy * gz - wz * gy
        uy -= wz * gx - wx * gz
        uz -= wx * gy - wy * gx
        ex, ey, ez = turn_back(a, ux, uy, uz)
        if kind == SPRING:
            fx = -row[23] * dx
            fy = -row[24] * dy
            fz = -row[25] * dz
            energy -= 0.5 * (fx * dx + fy * dy + fz * dz)
            cx, cy, cz = row[26] * ex, row[27] * ey, row[28] * ez
            power += cx * ex + cy * ey + cz * ez
            fx -= cx
            fy -= cy
            fz -= cz
        elif kind == DIRECTED:
            nx, ny, nz = row[29], row[30], row[31]
            along = nx * dx + ny * dy + nz * dz
            rate = nx * ex + ny * ey + nz * ez
            pull = 0.0
            state = int(row[STATE])
            blow_off = int(row[BLOW_OFF])
            if state >= 0:
                stretch = along - states[first_state + state]
                pull = row[23] * stretch
                energy += 0.5 * pull * stretch
                if blow_off >= 0:
                    speed, _ = curve_value(block, pool_start + blow_off, pull)
                else:
                    speed = pull / row[26]
                rates[state] = speed
                power += pull * speed
            else:
                pull = row[23] * along
                energy += 0.5 * pull * along
                if blow_off >= 0:
                    resisting, _ = curve_value(block, pool_start + blow_off, rate)
                else:
                    resisting = row[26] * rate
                pull += resisting
                power += resisting * rate
            stop = int(row[STOP])
            if stop >= 0:
                stopping, stored = curve_value(block, pool_start + stop, along)
                pull += stopping
                energy += stored
            fx, fy, fz = -pull * nx, -pull * ny, -pull * nz
        else:
            if whose != OF_MIDDLE:
                rotation_between(lower[F_AXES], upper[F_AXES], theta)
            sx, sy, sz = turn_back(
                a, upper[15] - lower[15], upper[16] - lower[16], upper[17] - lower[17]
            )
            strain = (dx, dy, dz, theta[0] - row[19], theta[1] - row[20], theta[2] - row[21])
            speeds = (ex, ey, ez, sx, sy, sz)
            data = pool_start + int(row[POOL])
            if kind == FRICTION:
                own = int(row[STATE])
                stored, taken = friction_law(
                    block, data, strain, speeds, states, first_state + own, rates, own, g, drag
                )
                energy += stored
                power += taken
            else:
                for i in range(6):
                    g[i] = 0.0
                    drag[i] = 0.0
                    for j in range(6):
                        g[i] += block[data + 6 * i + j] * strain[j]
                        drag[i] += block[data + 36 + 6 * i + j] * speeds[j]
                    energy += 0.5 * g[i] * strain[i]
                    power += drag[i] * speeds[i]
            for i in range(3):
                energy -= row[13 + i] * strain[3 + i]
                g[3 + i] -= row[13 + i]
            if whose == OF_MIDDLE:
                for i in range(3):
                    energy -= row[10 + i] * strain[i]
                    g[i] -= row[10 + i]
            fx, fy, fz = -(g[0] + drag[0]), -(g[1] + drag[1]), -(g[2] + drag[2])
            half = 0.5
            if whose == OF_UPPER:
                half = -0.5
            elif whose != OF_LOWER:
                half = 0.0
            tx, ty, tz = theta[0], theta[1], theta[2]
            mx, my, mz = g[3], g[4], g[5]
            bx, by, bz = ty * mz - tz * my, tz * mx - tx * mz, tx * my - ty * mx
            mx += half * bx + (ty * bz - tz * by) / 12.0
            my += half * by + (tz * bx - tx * bz) / 12.0
            mz += half * bz + (tx * by - ty * bx) / 12.0
            mx, my, mz = turn(a, -mx - drag[3], -my - drag[4], -mz - drag[5])
            moment = upper[F_MOMENT]
            moment[0] += mx
            moment[1] += my
            moment[2] += mz
            moment = lower[F_MOMENT]
            moment[0] -= mx
            moment[1] -= my
            moment[2] -= mz
        fx, fy, fz = turn(a, fx, fy, fz)
        if whose == OF_UPPER:
            x, y, z = p0x, p0y, p0z
        elif whose == OF_MIDDLE:
            x, y, z = 0.5 * (p0x + p1x), 0.5 * (p0y + p1y), 0.5 * (p0z + p1z)
        else:
            x, y, z = p1x, p1y, p1z
        push(upper, x, y, z, fx, fy, fz)
        if whose == OF_TRACK:
            x, y, z = p0x, p0y, p0z
        push(lower, x, y, z, -fx, -fy, -fz)
        if whose != OF_MIDDLE:
            fx, fy, fz = row[10], row[11], row[12]
            energy -= fx * gx + fy * gy + fz * gz
            push(upper, p1x, p1y, p1z, fx, fy, fz)
            push(lower, p0x, p0y, p0z, -fx, -fy, -fz)
    block[H_ENERGY] = energy
    block[H_POWER] = power
    start = int(block[H_FORCES])
    for b in range(count):
        frame = frames[b]
        force = block[start + 6 * b : start + 6 * b + 6]
        force[0], force[1], force[2] = frame[28], frame[29], frame[30]
        mx, my, mz = frame[31], frame[32], frame[33]
        if bodies[b, SPINS] > 0.0:
            a = frame[F_AXES]
            mx, my, mz = turn_back(a, mx, my, mz)
            mx, my, mz = turn(a, mx, 0.0, mz + my * frame[F_TAN])
        mx, my, mz = turn_back(frame[F_SPINNING], mx, my, mz)
        force[3], force[4], force[5] = mx, my, mz
