"""The rails' wrench on a wheelset of an Exudyn model, compiled: coordinates to force and torque.

The wheelset lives in a frame that travels along the track (track_kernel.py), Exudyn's ground. It
meets the track at its own station: axle, position, velocity and angular velocity, all over the
ground, are put into the axes of the track there, and the wrench back into the frame's. On straight
track both frames are one. Of a particle of the body at r in the frame, with the velocity v and the
body's angular velocity w relative to it, and W the frame's angular velocity,

    velocity over the ground = V e_x + W x r + v,    angular velocity = W + w.

The rails are crooked there as the track says (irregularity, widening): contact/forces.py.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_wheelset.addresses import integers_at, numbers_at
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact import layout as kernel
from exudyn_wheelset.contact.forces_apart import wheelset_forces
from exudyn_wheelset.contact.layout import Axle, Velocity, side_of
from exudyn_wheelset.coupling.changing_rails import changing_forces
from exudyn_wheelset.coupling.elastic_apart import elastic_forces
from exudyn_wheelset.coupling.track_kernel import (
    CURVED,
    KNOTS,
    LIVE,
    START,
    frame_beside,
    frame_turning,
    rail_shape,
)
from exudyn_wheelset.coupling.wheel_forces import wheel_values

# Everything of a contact that changes stands in one array, for unpacking an array costs a call from
# Python a good part of what a patch costs: coordinates and time that a result belongs to, the
# body's reference position, the rails' motion, by what and how elastic rails give way, where the
# wheelset stands on the track and how the track lies there, the parameters, the result.
MEMORY = slice(0, 13)
REFERENCE = slice(13, 16)
RAIL_MOTION = slice(16, 28)
ELASTICITY = slice(28, 32)
SHIFTS = slice(32, 36)
RATES = slice(36, 40)
SLOPES = slice(40, 48)
PLACE = slice(48, 56)
TRACK_POSE = slice(56, 68)
# Address and length of what changing_rails.py of this folder holds, 0 for rails of one profile.
SECTIONS = slice(68, 70)
PARAMETERS = slice(70, 70 + kernel.PARAMETER_COUNT)
RESULT = slice(70 + kernel.PARAMETER_COUNT, None)
# In the track's own frame at the wheelset: y, z [m] of its centre, the axle's direction, speed
# over the rails [m/s], station [m].
Y, Z, LX, LY, LZ, FORWARD, STATION = range(7)


@compiled(inline="always")
def axle_direction(tx, ty, tz):
    """Factors s, c of R = 1 + s (theta x) + c (theta x theta x), and the axle's direction R e_y."""
    square = tx * tx + ty * ty + tz * tz
    if square > 1.0e-10:
        angle = math.sqrt(square)
        s = math.sin(angle) / angle
        c = (1.0 - math.cos(angle)) / square
    else:
        s = 1.0 - square / 6.0
        c = 0.5 - square / 24.0
    return s, c, -s * tz + c * tx * ty, 1.0 - c * (tx * tx + tz * tz), s * tx + c * ty * tz


@compiled(inline="always")
def _into_track(pose, x, y, z):
    """Components along the track at the wheelset of a vector in the frame's axes."""
    return (
        pose[0] * x + pose[3] * y + pose[6] * z,
        pose[1] * x + pose[4] * y + pose[7] * z,
        pose[2] * x + pose[5] * y + pose[8] * z,
    )


@compiled
def _on_the_track(track, t, x, axle, velocity, height, speed, place, pose):
    """Axle and velocity in the track's frame at the wheelset, which is `height` above the rails.

    x [m]: of the centre in the frame; speed [m/s]: of the frame. Fills pose and the station.
    """
    here = track[START]
    if track[LIVE] != 0.0:
        here += speed * t
    if track[CURVED] == 0.0:
        place[STATION] = here + x
        return axle, velocity
    z = height + axle.z
    place[STATION] = frame_beside(track, here, x, axle.y, z, pose)
    ax, ay, az, _, _, _, _, _, _ = frame_turning(track, here)
    ax, ay, az = speed * ax, speed * ay, speed * az
    vx, vy, vz = _into_track(
        pose,
        velocity.x + ay * z - az * axle.y,
        velocity.y + az * x - ax * z,
        velocity.z + ax * axle.y - ay * x,
    )
    wx, wy, wz = _into_track(
        pose, velocity.about_x + ax, velocity.about_y + ay, velocity.about_z + az
    )
    lx, ly, lz = _into_track(pose, axle.lx, axle.ly, axle.lz)
    _, ty, tz = _into_track(pose, x - pose[9], axle.y - pose[10], z - pose[11])
    # The frame's own speed, along e_x, is added to the forward velocity by the kernel.
    turned = Velocity(
        vx + speed * (pose[0] - 1.0), vy + speed * pose[1], vz + speed * pose[2], wx, wy, wz
    )
    return Axle(ty, tz - height, lx, ly, lz), turned


@compiled(inline="always")
def _out_of_track(pose, vector):
    """Turn a vector (3) of the track's frame at the wheelset into the frame's axes, in place."""
    x, y, z = vector[0], vector[1], vector[2]
    for i in range(3):
        vector[i] = pose[3 * i] * x + pose[3 * i + 1] * y + pose[3 * i + 2] * z


@compiled
def body_wrench(q, v, first, table, state, track, t, part):
    """Return part 0 (force [N]) or 1 (torque [N m]) of the wrench at system coordinates q, v.

    first: index of the body's six coordinates in q; state: the contact's array (see above); track:
    the frame's array (track_kernel.py); t [s].
    """
    memory = state[MEMORY]
    result = state[RESULT]
    same = memory[12] == t
    for k in range(6):
        if memory[k] != q[first + k] or memory[6 + k] != v[first + k]:
            same = False
    if not same:
        for k in range(6):
            memory[k] = q[first + k]
            memory[6 + k] = v[first + k]
        memory[12] = t
        tx, ty, tz = q[first + 3], q[first + 4], q[first + 5]
        s, c, lx, ly, lz = axle_direction(tx, ty, tz)
        wx, wy, wz = v[first + 3], v[first + 4], v[first + 5]
        # R w = w + s theta x w + c theta x (theta x w)
        ux = ty * wz - tz * wy
        uy = tz * wx - tx * wz
        uz = tx * wy - ty * wx
        reference = state[REFERENCE]
        height = side_of(table, 0).radius
        y = reference[1] + q[first + 1]
        z = reference[2] + q[first + 2] - height
        axle = Axle(y, z, lx, ly, lz)
        velocity = Velocity(
            v[first], v[first + 1], v[first + 2],
            wx + s * ux + c * (ty * uz - tz * uy),
            wy + s * uy + c * (tz * ux - tx * uz),
            wz + s * uz + c * (tx * uy - ty * ux),
        )  # fmt: skip
        motion = state[RAIL_MOTION]
        parameters = state[PARAMETERS]
        place = state[PLACE]
        pose = state[TRACK_POSE]
        speed = parameters.view(kernel.PARAMETERS)[0].rail_speed
        sections = state[SECTIONS]
        uneven = track[CURVED] != 0.0 or track[KNOTS] > 0.0
        if uneven or sections[0] != 0.0:
            x = reference[0] + q[first]
            axle, velocity = _on_the_track(track, t, x, axle, velocity, height, speed, place, pose)
        if uneven:
            rail_shape(track, place[STATION], motion)
        place[Y] = axle.y
        place[Z] = height + axle.z
        place[LX] = axle.lx
        place[LY] = axle.ly
        place[LZ] = axle.lz
        place[FORWARD] = velocity.x + speed
        elasticity = state[ELASTICITY]
        if elasticity[0] > 0.0:
            elastic_forces(
                table, axle, velocity, motion, parameters, result,
                elasticity, state[SHIFTS], state[RATES], state[SLOPES],
            )  # fmt: skip
        elif sections[0] != 0.0:
            changing_forces(sections, place[STATION], axle, velocity, motion, parameters, result)
        else:
            wheelset_forces(table, axle, velocity, motion, parameters, result)
        if track[CURVED] != 0.0:
            _out_of_track(pose, result[0:3])
            _out_of_track(pose, result[3:6])
    base = 3 * part
    return result[base], result[base + 1], result[base + 2]


@compiled
def wheel_history(
    coordinates, velocities, times, first, table, state, track, shifts, values, places
):
    """Fill values (m, 2, 17) of both wheels at m states, and where the wheelset stood (m, 4).

    values in the order of WHEEL_VALUES; places: y [m], yaw, roll [rad] in the track's own frame
    at the wheelset, station [m]; coordinates, velocities (m, nq) of the system at times (m,) [s];
    shifts (m, 4) of elastic rails.
    """
    memory, shift, place = state[MEMORY], state[SHIFTS], state[PLACE]
    for row in range(len(coordinates)):
        memory[0] = np.nan
        shift[:] = shifts[row]
        body_wrench(coordinates[row], velocities[row], first, table, state, track, times[row], 0)
        for hand in range(2):
            wheel_values(state[RESULT], hand, values[row, hand])
        places[row, 0] = place[Y]
        places[row, 1] = math.atan2(-place[LX], place[LY])
        places[row, 2] = math.asin(place[LZ])
        places[row, 3] = place[STATION]


@compiled
def stance(table, state, place):
    """Fill place (7) with where the wheelset stood at the last evaluation of its loads.

    Lateral shift [m] against the left and the right rail; rise [m] of the left and the right
    wheel's tape circle above its rail's top; patches on the left and the right; speed [m/s] over
    the rails.
    """
    here, motion, shifts = state[PLACE], state[RAIL_MOTION], state[SHIFTS]
    result = state[RESULT].view(kernel.RESULT)[0]
    for hand in range(2):
        side = side_of(table, hand)
        sign = 1.0 - 2.0 * hand
        place[hand] = here[Y] - motion[2 * hand] - shifts[2 * hand]
        rail = motion[2 * hand + 1] + shifts[2 * hand + 1]
        centre = here[Z] + sign * side.tape * here[LZ]
        place[2 + hand] = centre - side.radius * math.hypot(here[LX], here[LY]) - rail
        place[4 + hand] = result.count[hand]
    place[6] = here[FORWARD]


@compiled(inline="always")
def move_rails(shifts, state):
    """Take over the shifts (4) [m] of elastic rails; what was computed at others is forgotten."""
    known = state[SHIFTS]
    for k in range(4):
        if known[k] != shifts[k]:
            known[k] = shifts[k]
            state[0] = np.nan


@compiled
def wrench_at(block, t):
    """As `body_wrench` at time t [s], its other arguments in the block of integers at this address.

    Addresses of q, v, table, state and track, their lengths (q and v have the same), first, part,
    address of the shifts of elastic rails, or 0.
    """
    q, v, table, state, track, size, table_size, state_size, track_size, first, part, shifts = (
        integers_at(block, 12)
    )
    own = numbers_at(state, state_size)
    if shifts != 0:
        move_rails(numbers_at(shifts, 4), own)
    return body_wrench(
        numbers_at(q, size),
        numbers_at(v, size),
        first,
        numbers_at(table, table_size),
        own,
        numbers_at(track, track_size),
        t,
        part,
    )


@compiled
def rail_rates_at(block, t):
    """Rates [m/s] of the shifts of elastic rails, left y, z, right y, z, as `wrench_at`."""
    wrench_at(block, t)
    head = integers_at(block, 12)
    rates = numbers_at(head[3], head[7])[RATES]
    return rates[0], rates[1], rates[2], rates[3]
