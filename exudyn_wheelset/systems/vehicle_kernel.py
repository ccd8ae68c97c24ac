"""All equations of a vehicle in one compiled call: x' = f(x; V), and its Jacobian body by body.

Exudyn's equations of a rigid body with NodeType.RotationRotationVector are, with the global
velocity v, the angular velocity w in body axes and the inertia J about the centre of mass,

    m v' = F,   J w' = R^T M - w x J w.                                               (1)

F and M are those of the connections (vehicles/kernel.py), of the rails (coupling/wheel_rail.py),
of the weight, of the frame's own motion where the track is not straight (coupling/moving_frame.py),
and of what keeps a driven vehicle going: a torque c (V/r0 - w_y) on an axle and a
soft drawbar. These are the very functions that Exudyn's loads and objects call, so the rates
are Exudyn's own to rounding; what is saved is the way there, some 30 us a call.

A body feels the rails and the connections that end on it, and nothing else. When one state of body
b is shifted, only forces of these change, so that a column of the Jacobian is the central
difference of the rates with their part alone,

    (x'(x + h e_j; G_b) - x'(x - h e_j; G_b))/(2 h),   G_b: laws that end on b, its rails, weight,

for all others cancel. A car's Jacobian costs some ten evaluations instead of two for each state.

States and their reduction: see `reduction`. SI units.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exudyn_wheelset.addresses import integers_at, numbers_at
from exudyn_wheelset.arrays import Array
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.coupling.moving_frame import BODY as FRAME_ROW
from exudyn_wheelset.coupling.moving_frame import add_body_loads, frame_motion
from exudyn_wheelset.coupling.track_kernel import CURVED
from exudyn_wheelset.coupling.wheelset_kernel import body_wrench
from exudyn_wheelset.systems.reduction import expand_state, rate_of_state
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.kernel import connection_forces

# Row of a body: weight [N], principal inertias [kg m^2], damping [N m s/rad] of a driven axle and
# the radius [m] that goes with it, pull [N], stiffness and damping of the drawbar.
WEIGHT, INERTIA, DRIVE, DRIVE_RADIUS, PULL, DRAWBAR_STIFFNESS, DRAWBAR_DAMPING = 0, 1, 4, 5, 6, 7, 8
BODY_ROW = 9
# Row of a wheelset's contact: addresses and lengths of its table and its state.
TABLE, TABLE_SIZE, CONTACT, CONTACT_SIZE = range(4)
CONTACT_ROW = 4


class Model(NamedTuple):
    """What the kernel works on; n states, nq = 6 nb coordinates of nb bodies, nw wheelsets first.

    coordinates, velocities (nq), strokes (n1): room for them
    forces (nq + n1)         room for generalised forces and rates of the strokes
    position_of, rotations, reference   tables of `reduction`; row k of rotations is that of body k
    inverse_masses (nq)      of (1)
    bodies (nb, BODY_ROW), contacts (nw, CONTACT_ROW)
    blocks (nb + 1, 2)       address and length of the connections' block, of all laws (last row)
                             and of those that end on each body
    owners (n)               body whose laws feel each state
    scales (n)
    speed (3) [m/s], time [s], gravity [m/s^2]
    track                    array of the frame that the vehicle stands in
    motion (9)               of that frame
    frame_rows (nb, FRAME_ROW)
    """

    coordinates: Array
    velocities: Array
    strokes: Array
    forces: Array
    position_of: Array
    rotations: Array
    reference: Array
    inverse_masses: Array
    bodies: Array
    contacts: Array
    blocks: Array
    owners: Array
    scales: Array
    speed: Array
    track: Array
    motion: Array
    frame_rows: Array


# A plan: n, nq, n1, nb, nw, length of the track's array, then the addresses of the model's arrays.
_PLAN_SIZE = 6 + len(Model._fields)


@compiled
def _own_forces(body, model):
    """Add weight, gyroscopic moment, drive, drawbar and rails of a body to its forces."""
    first = model.rotations[body, 0] - 3
    force = model.forces[first : first + 6]
    row = model.bodies[body]
    q, v = model.coordinates, model.velocities
    wx, wy, wz = v[first + 3], v[first + 4], v[first + 5]
    jx, jy, jz = row[INERTIA], row[INERTIA + 1], row[INERTIA + 2]
    force[0] += row[PULL] - row[DRAWBAR_STIFFNESS] * q[first] - row[DRAWBAR_DAMPING] * v[first]
    force[2] -= row[WEIGHT]
    force[3] -= (jz - jy) * wy * wz
    force[4] -= (jx - jz) * wz * wx
    force[5] -= (jy - jx) * wx * wy
    if row[DRIVE] > 0.0:
        force[4] += row[DRIVE] * (model.speed[0] / row[DRIVE_RADIUS] - wy)
    if model.track[CURVED] != 0.0:
        add_body_loads(model.motion, model.frame_rows[body], q, v, first, force)
    if body >= model.contacts.shape[0]:
        return
    time = model.speed[1]
    contact = model.contacts[body]
    table = numbers_at(contact[TABLE], contact[TABLE_SIZE])
    state = numbers_at(contact[CONTACT], contact[CONTACT_SIZE])
    x, y, z = body_wrench(q, v, first, table, state, model.track, time, 0)
    force[0] += x
    force[1] += y
    force[2] += z
    x, y, z = body_wrench(q, v, first, table, state, model.track, time, 1)
    # R^T m = m - s theta x m + c theta x (theta x m), as in wheel_rail.
    tx, ty, tz = q[first + 3], q[first + 4], q[first + 5]
    square = tx * tx + ty * ty + tz * tz
    if square > 1.0e-10:
        angle = np.sqrt(square)
        s, c = np.sin(angle) / angle, (1.0 - np.cos(angle)) / square
    else:
        s, c = 1.0 - square / 6.0, 0.5 - square / 24.0
    ux, uy, uz = ty * z - tz * y, tz * x - tx * z, tx * y - ty * x
    force[3] += x - s * ux + c * (ty * uz - tz * uy)
    force[4] += y - s * uy + c * (tz * ux - tx * uz)
    force[5] += z - s * uz + c * (tx * uy - ty * ux)


@compiled
def _connections(which, model):
    """Set the forces to those of a block of connections: of one body's laws, or of all (last)."""
    block = numbers_at(model.blocks[which, 0], model.blocks[which, 1])
    connection_forces(model.coordinates, model.velocities, model.strokes, block)
    size = model.coordinates.shape[0]
    start = int(block[layout.H_FORCES])
    for body in range(model.rotations.shape[0]):
        first = model.rotations[body, 0] - 3
        for k in range(6):
            model.forces[first + k] = block[start + 6 * body + k]
    start = int(block[layout.H_RATES])
    for k in range(int(block[layout.H_STATES])):
        model.forces[size + k] = block[start + k]


@compiled
def _expand(state, model):
    expand_state(
        state,
        model.position_of,
        model.rotations,
        model.reference,
        model.coordinates,
        model.velocities,
        model.strokes,
    )


@compiled
def _rates(state, model, rate):
    """Rates of a state whose coordinates and forces are in the model."""
    for k in range(model.coordinates.shape[0]):
        model.forces[k] *= model.inverse_masses[k]
    rate_of_state(state, model.forces, model.position_of, model.rotations, rate)


@compiled
def _rate(state, model, rate):
    bodies = model.rotations.shape[0]
    frame_motion(model.track, model.speed[1], model.speed[2], model.motion)
    _expand(state, model)
    _connections(bodies, model)
    for body in range(bodies):
        _own_forces(body, model)
    _rates(state, model, rate)


@compiled
def _jacobian(state, model, relative_step, upper, lower, matrix):
    frame_motion(model.track, model.speed[1], model.speed[2], model.motion)
    for column in range(state.shape[0]):
        body = model.owners[column]
        step = relative_step * model.scales[column]
        kept = state[column]
        state[column] = kept + step
        _expand(state, model)
        _connections(body, model)
        _own_forces(body, model)
        _rates(state, model, upper)
        state[column] = kept - step
        _expand(state, model)
        _connections(body, model)
        _own_forces(body, model)
        _rates(state, model, lower)
        state[column] = kept
        for row in range(state.shape[0]):
            matrix[row, column] = (upper[row] - lower[row]) / (2.0 * step)


@compiled
def _model_at(plan):
    """The model of the plan at an address."""
    head = integers_at(plan, _PLAN_SIZE)
    n, nq, n1, nb, nw, track = head[0], head[1], head[2], head[3], head[4], head[5]
    return Model(
        numbers_at(head[6], nq),
        numbers_at(head[7], nq),
        numbers_at(head[8], n1),
        numbers_at(head[9], nq + n1),
        integers_at(head[10], nq),
        integers_at(head[11], 3 * nb).reshape(nb, 3),
        numbers_at(head[12], 3 * nb).reshape(nb, 3),
        numbers_at(head[13], nq),
        numbers_at(head[14], BODY_ROW * nb).reshape(nb, BODY_ROW),
        integers_at(head[15], CONTACT_ROW * nw).reshape(nw, CONTACT_ROW),
        integers_at(head[16], 2 * (nb + 1)).reshape(nb + 1, 2),
        integers_at(head[17], n),
        numbers_at(head[18], n),
        numbers_at(head[19], 3),
        numbers_at(head[20], track),
        numbers_at(head[21], 9),
        numbers_at(head[22], FRAME_ROW * nb).reshape(nb, FRAME_ROW),
    )


@compiled
def rates_at(plan, states, rates):
    """Fill rates (m, n) of states (m, n) of the model at the address `plan`."""
    model = _model_at(plan)
    for row in range(states.shape[0]):
        _rate(states[row], model, rates[row])


@compiled
def rate_at(plan, state, rate):
    """Fill rate from a state, both addresses of (n,) numbers, of the model at `plan`."""
    size = integers_at(plan, 1)[0]
    _rate(numbers_at(state, size), _model_at(plan), numbers_at(rate, size))


@compiled
def jacobians_at(plan, states, relative_step, matrices):
    """Fill matrices (m, n, n) of the Jacobians at states (m, n), steps in units of the scales."""
    model = _model_at(plan)
    upper, lower = np.empty(states.shape[1]), np.empty(states.shape[1])
    for row in range(states.shape[0]):
        _jacobian(states[row].copy(), model, relative_step, upper, lower, matrices[row])


@compiled
def run_at(plan, state, time, step, samples, steps):
    """Carry a state (n,) on from a time [s] by the classical Runge-Kutta method, in place.

    After each `steps` steps [s] a row of samples (m, n) is filled; returns how many are finite.
    """
    model = _model_at(plan)
    size = state.shape[0]
    one, two, three, four = np.empty(size), np.empty(size), np.empty(size), np.empty(size)
    between = np.empty(size)
    for row in range(samples.shape[0]):
        for number in range(steps):
            now = time + step * (row * steps + number)
            model.speed[1] = now
            _rate(state, model, one)
            model.speed[1] = now + 0.5 * step
            for k in range(size):
                between[k] = state[k] + 0.5 * step * one[k]
            _rate(between, model, two)
            for k in range(size):
                between[k] = state[k] + 0.5 * step * two[k]
            _rate(between, model, three)
            for k in range(size):
                between[k] = state[k] + step * three[k]
            model.speed[1] = now + step
            _rate(between, model, four)
            for k in range(size):
                state[k] += step / 6.0 * (one[k] + 2.0 * (two[k] + three[k]) + four[k])
        for k in range(size):
            samples[row, k] = state[k]
            if not np.isfinite(state[k]):
                return row
    return samples.shape[0]
