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

# Kinds of laws.
SPRING, MATRIX, DIRECTED, ROD = 0, 1, 2, 3
# Whose axes a connection has.
OF_LOWER, OF_UPPER, OF_MIDDLE, OF_TRACK = 0, 1, 2, 3

# Places in the row of a law.
KIND, LOWER, UPPER, AXES = 0, 1, 2, 3
POINT_LOWER, POINT_UPPER = slice(4, 7), slice(7, 10)
FORCE, MOMENT = slice(10, 13), slice(13, 16)
REFERENCE = slice(16, 22)
STATE = 22
STIFFNESS, DAMPING = slice(23, 26), slice(26, 29)
DIRECTION = slice(29, 32)
LENGTH, TENSION = 32, 33
POOL = 34
STOP, BLOW_OFF = 35, 36
ROW = 40

# Places in the row of a body: first coordinate in the system, whether it spins, reference position.
FIRST, SPINS, POSITION = 0, 1, slice(2, 5)
BODY = 5

# Places in the row of a frame: axes (row by row), centre, velocity, angular velocity of the axes,
# tan(roll), the axes that spin, then force and moment on the body.
F_AXES, F_CENTRE, F_VELOCITY, F_OMEGA = slice(0, 9), slice(9, 12), slice(12, 15), slice(15, 18)
F_TAN, F_SPINNING, F_FORCE, F_MOMENT = 18, slice(19, 28), slice(28, 31), slice(31, 34)
FRAME = 34

# Header of a vehicle's block, which holds everything.
(
    H_BODIES,
    H_LAWS,
    H_STATES,
    H_FIRST_STATE,
    H_BODY_ROWS,
    H_LAW_ROWS,
    H_POOL,
    H_FRAMES,
    H_MEMORY,
    H_FORCES,
    H_RATES,
    H_ENERGY,
    H_POWER,
) = range(13)
HEADER = 16


def new_block(bodies: np.ndarray, laws: np.ndarray, pool: np.ndarray, states: int) -> np.ndarray:
    """Return the block of a vehicle: header, tables and room for the kernel's results.

    bodies (n, BODY); laws (m, ROW); pool: what the rows point at; states: number of first-order
    coordinates, whose place in the system is put in as H_FIRST_STATE later.
    """
    count = len(bodies)
    sizes = {
        H_BODY_ROWS: bodies.size,
        H_LAW_ROWS: laws.size,
        H_POOL: len(pool),
        H_FRAMES: FRAME * (count + 1),
        H_MEMORY: 12 * count + states + 1,
        H_FORCES: 6 * count,
        H_RATES: states,
    }
    block = np.zeros(HEADER + sum(sizes.values()))
    block[[H_BODIES, H_LAWS, H_STATES]] = count, len(laws), states
    start = HEADER
    for place, size in sizes.items():
        block[place] = start
        start += size
    for place, content in ((H_BODY_ROWS, bodies), (H_LAW_ROWS, laws), (H_POOL, pool)):
        first = int(block[place])
        block[first : first + content.size] = content.ravel()
    forget(block)
    return block


def forget(block: np.ndarray) -> None:
    """Drop the kept evaluation, after a number of the block has changed."""
    block[int(block[H_MEMORY])] = np.nan


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
def _turn(a, x, y, z):
    return (
        a[0] * x + a[1] * y + a[2] * z,
        a[3] * x + a[4] * y + a[5] * z,
        a[6] * x + a[7] * y + a[8] * z,
    )


@compiled(inline="always")
def _turn_back(a, x, y, z):
    return (
        a[0] * x + a[3] * y + a[6] * z,
        a[1] * x + a[4] * y + a[7] * z,
        a[2] * x + a[5] * y + a[8] * z,
    )


@compiled(inline="always")
def _push(frame, px, py, pz, fx, fy, fz):
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
def _middle_axes(lower, theta, a):
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
        x, y, z = _turn(lower[F_AXES], row[4], row[5], row[6])
        p0x, p0y, p0z = lower[9] + x, lower[10] + y, lower[11] + z
        ox, oy, oz = lower[15], lower[16], lower[17]
        v0x = lower[12] + oy * z - oz * y
        v0y = lower[13] + oz * x - ox * z
        v0z = lower[14] + ox * y - oy * x
        x, y, z = _turn(upper[F_AXES], row[7], row[8], row[9])
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
            _push(upper, p1x, p1y, p1z, -tension * nx, -tension * ny, -tension * nz)
            _push(lower, p0x, p0y, p0z, tension * nx, tension * ny, tension * nz)
            continue
        whose = int(row[AXES])
        a = lower[F_AXES]
        wx, wy, wz = lower[15], lower[16], lower[17]
        if whose == OF_UPPER:
            a = upper[F_AXES]
            wx, wy, wz = ox, oy, oz
        elif whose == OF_MIDDLE:
            rotation_between(lower[F_AXES], upper[F_AXES], theta)
            _middle_axes(lower[F_AXES], theta, between)
            a = between
            wx, wy, wz = 0.5 * (wx + ox), 0.5 * (wy + oy), 0.5 * (wz + oz)
        elif whose == OF_TRACK:
            a = frames[count][F_AXES]
            wx, wy, wz = 0.0, 0.0, 0.0
        dx, dy, dz = _turn_back(a, gx, gy, gz)
        dx -= row[16]
        dy -= row[17]
        dz -= row[18]
        ux -= wy * gz - wz * gy
        uy -= wz * gx - wx * gz
        uz -= wx * gy - wy * gx
        ex, ey, ez = _turn_back(a, ux, uy, uz)
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
                push, stored = curve_value(block, pool_start + stop, along)
                pull += push
                energy += stored
            fx, fy, fz = -pull * nx, -pull * ny, -pull * nz
        else:
            if whose != OF_MIDDLE:
                rotation_between(lower[F_AXES], upper[F_AXES], theta)
            sx, sy, sz = _turn_back(
                a, upper[15] - lower[15], upper[16] - lower[16], upper[17] - lower[17]
            )
            strain = (dx, dy, dz, theta[0] - row[19], theta[1] - row[20], theta[2] - row[21])
            speeds = (ex, ey, ez, sx, sy, sz)
            matrices = pool_start + int(row[POOL])
            for i in range(6):
                g[i] = 0.0
                drag[i] = 0.0
                for j in range(6):
                    g[i] += block[matrices + 6 * i + j] * strain[j]
                    drag[i] += block[matrices + 36 + 6 * i + j] * speeds[j]
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
            mx, my, mz = _turn(a, -mx - drag[3], -my - drag[4], -mz - drag[5])
            moment = upper[F_MOMENT]
            moment[0] += mx
            moment[1] += my
            moment[2] += mz
            moment = lower[F_MOMENT]
            moment[0] -= mx
            moment[1] -= my
            moment[2] -= mz
        fx, fy, fz = _turn(a, fx, fy, fz)
        if whose == OF_UPPER:
            x, y, z = p0x, p0y, p0z
        elif whose == OF_MIDDLE:
            x, y, z = 0.5 * (p0x + p1x), 0.5 * (p0y + p1y), 0.5 * (p0z + p1z)
        else:
            x, y, z = p1x, p1y, p1z
        _push(upper, x, y, z, fx, fy, fz)
        if whose == OF_TRACK:
            x, y, z = p0x, p0y, p0z
        _push(lower, x, y, z, -fx, -fy, -fz)
        if whose != OF_MIDDLE:
            fx, fy, fz = row[10], row[11], row[12]
            energy -= fx * gx + fy * gy + fz * gz
            _push(upper, p1x, p1y, p1z, fx, fy, fz)
            _push(lower, p0x, p0y, p0z, -fx, -fy, -fz)
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
            mx, my, mz = _turn_back(a, mx, my, mz)
            mx, my, mz = _turn(a, mx, 0.0, mz + my * frame[F_TAN])
        mx, my, mz = _turn_back(frame[F_SPINNING], mx, my, mz)
        force[3], force[4], force[5] = mx, my, mz
