"""States of a spinning axisymmetric body in the frame that does not spin with it.

A body with the rotation R = Rz(yaw) Rx(roll) Ry(pitch) and the angular velocity w in the
intermediate frame Rz(yaw) Rx(roll) has

    yaw' = w_z / cos(roll),   roll' = w_x,   pitch' = w_y - w_z tan(roll).

If it is axisymmetric about its own y axis (the axle), its equations of motion do not depend on
the pitch angle, the spin, which is cyclic and left out of the state. The multibody code is asked
at pitch = 0, where the body frame is the intermediate frame, and gives the rate of the angular
velocity in body components; the intermediate frame lags behind the body by the spin about e_y, so
the rate of the intermediate components is

    w' = w'_body + pitch' (e_y x w).

Without the last term a linearisation perturbs the velocities in the spinning frame and is wrong.
Bodies that do not spin keep their pitch as a state and their angular velocity in body components.

Layout of a state: positions in the order of the second-order coordinates (cyclic ones and spin
angles left out; each rotation vector replaced by yaw, roll and, without spin, pitch), all
velocities in that order, first-order coordinates. Track frame (x forward, y left, z up), SI.
"""

from __future__ import annotations

import math

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.compilation import compiled

# What `position_of` says of a coordinate that is not one entry of the state.
CYCLIC = -1
ROTATION = -2


@compiled
def expand_state(
    state: Array,
    position_of: Array,
    rotations: Array,
    reference: Array,
    coordinates: Array,
    velocities: Array,
    first_order: Array,
) -> None:
    """Coordinates and velocities of the multibody system from a state, written in place.

    position_of  (nq) index in the state of each second-order coordinate, CYCLIC or ROTATION
    rotations    (k, 3) for each rotation vector: first coordinate, index of yaw, 1 if it spins
    reference    (k, 3) rotation vectors of the reference configuration [rad]
    """
    size = position_of.shape[0]
    first_velocity = state.shape[0] - size - first_order.shape[0]
    for i in range(size):
        if position_of[i] >= 0:
            coordinates[i] = state[position_of[i]]
        elif position_of[i] == CYCLIC:
            coordinates[i] = 0.0
        velocities[i] = state[first_velocity + i]
    for i in range(first_order.shape[0]):
        first_order[i] = state[first_velocity + size + i]
    for k in range(rotations.shape[0]):
        start, yaw_index, spins = rotations[k, 0], rotations[k, 1], rotations[k, 2]
        half_yaw = 0.5 * state[yaw_index]
        half_roll = 0.5 * state[yaw_index + 1]
        half_pitch = 0.0 if spins else 0.5 * state[yaw_index + 2]
        cy, sy = math.cos(half_yaw), math.sin(half_yaw)
        cr, sr = math.cos(half_roll), math.sin(half_roll)
        cp, sp = math.cos(half_pitch), math.sin(half_pitch)
        # Unit quaternion of Rz Rx Ry.
        e0 = cy * cr * cp - sy * sr * sp
        e1 = cy * sr * cp - sy * cr * sp
        e2 = cy * cr * sp + sy * sr * cp
        e3 = cy * sr * sp + sy * cr * cp
        sine = math.sqrt(e1 * e1 + e2 * e2 + e3 * e3)
        factor = 2.0 * math.atan2(sine, e0) / sine if sine > 1e-12 else 2.0
        coordinates[start] = factor * e1 - reference[k, 0]
        coordinates[start + 1] = factor * e2 - reference[k, 1]
        coordinates[start + 2] = factor * e3 - reference[k, 2]


@compiled
def reduce_coordinates(
    coordinates: Array,
    velocities: Array,
    first_order: Array,
    position_of: Array,
    rotations: Array,
    reference: Array,
    state: Array,
) -> None:
    """State from coordinates and velocities, the inverse of `expand_state`, written in place.

    Any spin angle is taken out: the velocities come out in the frame that does not spin.
    """
    size = position_of.shape[0]
    first_velocity = state.shape[0] - size - first_order.shape[0]
    for i in range(size):
        if position_of[i] >= 0:
            state[position_of[i]] = coordinates[i]
        state[first_velocity + i] = velocities[i]
    for i in range(first_order.shape[0]):
        state[first_velocity + size + i] = first_order[i]
    for k in range(rotations.shape[0]):
        start, yaw_index, spins = rotations[k, 0], rotations[k, 1], rotations[k, 2]
        r1 = coordinates[start] + reference[k, 0]
        r2 = coordinates[start + 1] + reference[k, 1]
        r3 = coordinates[start + 2] + reference[k, 2]
        angle = math.sqrt(r1 * r1 + r2 * r2 + r3 * r3)
        factor = math.sin(0.5 * angle) / angle if angle > 1e-12 else 0.5
        e0, e1, e2, e3 = math.cos(0.5 * angle), factor * r1, factor * r2, factor * r3
        # R e_y = (-sin yaw cos roll, cos yaw cos roll, sin roll) is the direction of the axle.
        axle_x = 2.0 * (e1 * e2 - e0 * e3)
        axle_y = 1.0 - 2.0 * (e1 * e1 + e3 * e3)
        axle_z = 2.0 * (e2 * e3 + e0 * e1)
        state[yaw_index] = math.atan2(-axle_x, axle_y)
        state[yaw_index + 1] = math.atan2(axle_z, math.hypot(axle_x, axle_y))
        # The third row of R begins and ends with -cos(roll) sin(pitch), cos(roll) cos(pitch).
        pitch = math.atan2(-2.0 * (e1 * e3 - e0 * e2), 1.0 - 2.0 * (e1 * e1 + e2 * e2))
        if spins:
            c, s = math.cos(pitch), math.sin(pitch)
            wx, wz = velocities[start], velocities[start + 2]
            state[first_velocity + start] = c * wx + s * wz
            state[first_velocity + start + 2] = c * wz - s * wx
        else:
            state[yaw_index + 2] = pitch


@compiled
def state_rate(
    state: Array,
    force: Array,
    inverse_mass: Array,
    position_of: Array,
    rotations: Array,
    rate: Array,
) -> None:
    """Rate of a state from the generalised forces, written in place.

    force         (nq + n1) right-hand sides: forces on the nq second-order coordinates, then the
                  rates of the n1 first-order ones
    inverse_mass  (nq, nq) inverse of the mass matrix
    """
    size = position_of.shape[0]
    accelerations = force.copy()
    for i in range(size):
        acceleration = 0.0
        for j in range(size):
            acceleration += inverse_mass[i, j] * force[j]
        accelerations[i] = acceleration
    rate_of_state(state, accelerations, position_of, rotations, rate)


@compiled
def rate_of_state(
    state: Array, accelerations: Array, position_of: Array, rotations: Array, rate: Array
) -> None:
    """Rate of a state from the accelerations, written in place.

    accelerations (nq + n1) of the nq second-order coordinates, as the multibody code has them, then
    the rates of the n1 first-order ones.
    """
    size = position_of.shape[0]
    first_order = accelerations.shape[0] - size
    first_velocity = state.shape[0] - size - first_order
    for i in range(size):
        if position_of[i] >= 0:
            rate[position_of[i]] = state[first_velocity + i]
    for i in range(accelerations.shape[0]):
        rate[first_velocity + i] = accelerations[i]
    for k in range(rotations.shape[0]):
        start, yaw_index, spins = rotations[k, 0], rotations[k, 1], rotations[k, 2]
        roll = state[yaw_index + 1]
        wx = state[first_velocity + start]
        wy = state[first_velocity + start + 1]
        wz = state[first_velocity + start + 2]
        if not spins:
            pitch = state[yaw_index + 2]
            c, s = math.cos(pitch), math.sin(pitch)
            wx, wz = c * wx + s * wz, c * wz - s * wx
        pitch_rate = wy - wz * math.tan(roll)
        rate[yaw_index] = wz / math.cos(roll)
        rate[yaw_index + 1] = wx
        if spins:
            rate[first_velocity + start] += pitch_rate * wz
            rate[first_velocity + start + 2] -= pitch_rate * wx
        else:
            rate[yaw_index + 2] = pitch_rate
