"""The rails' wrench on a wheelset as two Exudyn loads, a force and a torque on its centre.

Exudyn calls the user function of each load at every evaluation. Both share one contact
evaluation: whichever is called first computes and keeps force and torque with the coordinates
they belong to; the other takes them only if its coordinates are the same to the last bit. During
numerical Jacobians, where loads are evaluated one by one at shifted states, each computes anew.

The body has a node of NodeType.RotationRotationVector: coordinates are its displacement and the
rotation vector theta (R = exp(theta)), velocities the global velocity and the angular velocity in
body axes (measured, and tested in test_coupling_against_kernel.py). The axle is the body's y axis,
the reference orientation the identity.

A model may run over the ground, its wheelsets moving at V, or stand in a frame that moves at V
while the rails run backwards (`rail_speed`): the laws of motion are the same, and a spring to the
moving frame is a spring to Exudyn's ground.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact import layout as kernel
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.contact.forces import wheelset_forces
from exudyn_wheelset.contact.layout import Axle, Velocity, side_of
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.contact.wheelset_contact import ContactForces, read_result
from exudyn_wheelset.coupling.addresses import address_of, integers_at, numbers_at
from exudyn_wheelset.coupling.elastic_rails import RailElasticity, elastic_forces
from exudyn_wheelset.coupling.guidance import Guidance, guidance
from exudyn_wheelset.coupling.wheel_forces import WHEEL_VALUES, wheel_values

_CURRENT = exu.ConfigurationType.Current
Irregularity = Callable[[float], Any]


# Everything of a contact that changes stands in one array, for unpacking an array costs a call from
# Python a good part of what a patch costs: the coordinates a result belongs to, the body's
# reference position, the rails' motion, the parameters, the result.
_MEMORY = slice(0, 12)
_REFERENCE = slice(12, 15)
_RAIL_MOTION = slice(15, 27)
_ELASTICITY = slice(27, 31)
_SHIFTS = slice(31, 35)
_RATES = slice(35, 39)
_PARAMETERS = slice(39, 39 + kernel.PARAMETER_COUNT)
_RESULT = slice(39 + kernel.PARAMETER_COUNT, None)
# Shifts and slopes among the rails' motion.
_SHAPE = [0, 1, 2, 3, 8, 9, 10, 11]


@compiled(inline="always")
def _axle(tx, ty, tz):
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


@compiled
def body_wrench(q, v, first, table, state, part):
    """Return part 0 (force [N]) or 1 (torque [N m]) of the wrench at system coordinates q, v.

    first: index of the body's six coordinates in q; state: the contact's array (see above).
    """
    memory = state[_MEMORY]
    result = state[_RESULT]
    same = True
    for k in range(6):
        if memory[k] != q[first + k] or memory[6 + k] != v[first + k]:
            same = False
    if not same:
        for k in range(6):
            memory[k] = q[first + k]
            memory[6 + k] = v[first + k]
        tx, ty, tz = q[first + 3], q[first + 4], q[first + 5]
        s, c, lx, ly, lz = _axle(tx, ty, tz)
        wx, wy, wz = v[first + 3], v[first + 4], v[first + 5]
        # R w = w + s theta x w + c theta x (theta x w)
        ux = ty * wz - tz * wy
        uy = tz * wx - tx * wz
        uz = tx * wy - ty * wx
        reference = state[_REFERENCE]
        y = reference[1] + q[first + 1]
        z = reference[2] + q[first + 2] - side_of(table, 0).radius
        axle = Axle(y, z, lx, ly, lz)
        velocity = Velocity(
            v[first], v[first + 1], v[first + 2],
            wx + s * ux + c * (ty * uz - tz * uy),
            wy + s * uy + c * (tz * ux - tx * uz),
            wz + s * uz + c * (tx * uy - ty * ux),
        )  # fmt: skip
        motion = state[_RAIL_MOTION]
        parameters = state[_PARAMETERS]
        elasticity = state[_ELASTICITY]
        if elasticity[0] > 0.0:
            elastic_forces(
                table, axle, velocity, motion, parameters, result,
                elasticity, state[_SHIFTS], state[_RATES],
            )  # fmt: skip
        else:
            wheelset_forces(table, axle, velocity, motion, parameters, result)
    base = 3 * part
    return result[base], result[base + 1], result[base + 2]


@compiled
def wheel_history(coordinates, velocities, first, table, state, motions, shifts, values):
    """Fill values (m, 2, 14) of both wheels at m states, in the order of WHEEL_VALUES.

    coordinates, velocities (m, nq) of the system; motions (m, 12) and shifts (m, 4) of the rails.
    """
    memory, motion, shift = state[_MEMORY], state[_RAIL_MOTION], state[_SHIFTS]
    for row in range(len(coordinates)):
        memory[0] = np.nan
        motion[:] = motions[row]
        shift[:] = shifts[row]
        body_wrench(coordinates[row], velocities[row], first, table, state, 0)
        for hand in range(2):
            wheel_values(state[_RESULT], hand, values[row, hand])


@compiled
def stance(table, state, place):
    """Fill place (7) with where the wheelset stood at the last evaluation of its loads.

    Lateral shift [m] against the left and the right rail; rise [m] of the left and the right
    wheel's tape circle above its rail's top; patches on the left and the right; speed [m/s] over
    the rails.
    """
    q = state[_MEMORY]
    reference, motion, shifts = state[_REFERENCE], state[_RAIL_MOTION], state[_SHIFTS]
    _, _, lx, ly, lz = _axle(q[3], q[4], q[5])
    result = state[_RESULT].view(kernel.RESULT)[0]
    for hand in range(2):
        side = side_of(table, hand)
        sign = 1.0 - 2.0 * hand
        place[hand] = reference[1] + q[1] - motion[2 * hand] - shifts[2 * hand]
        rail = motion[2 * hand + 1] + shifts[2 * hand + 1]
        centre = reference[2] + q[2] + sign * side.tape * lz
        place[2 + hand] = centre - side.radius * math.hypot(lx, ly) - rail
        place[4 + hand] = result.count[hand]
    place[6] = q[6] + state[_PARAMETERS].view(kernel.PARAMETERS)[0].rail_speed


@compiled
def wrench_at(block):
    """As `body_wrench`, all arguments in the block of integers at this address.

    Addresses of q, v, table and state, their lengths (q and v have the same), first, part.
    """
    q, v, table, state, size, table_size, state_size, first, part = integers_at(block, 9)
    return body_wrench(
        numbers_at(q, size),
        numbers_at(v, size),
        first,
        numbers_at(table, table_size),
        numbers_at(state, state_size),
        part,
    )


@dataclass(eq=False)
class WheelRailContact:
    """Contact of one wheelset in an Exudyn model: its state between evaluations.

    wheelset, track: descriptions; parameters: array of `contact_parameters`; rail_speed [m/s]:
    speed of the moving frame the model stands in, 0 for a model that runs over the ground;
    irregularity: function of the station [m] that returns the shape (8) of rails at rest: shifts
    y, z of the left and of the right rail [m], then their slopes along the track [-]; or None;
    elasticity: springs under each rail, or None for rails that do not give way; name: of the
    wheelset.
    """

    wheelset: Wheelset
    track: Track
    parameters: np.ndarray
    rail_speed: float = 0.0
    irregularity: Irregularity | None = None
    elasticity: RailElasticity | None = None
    name: str = "wheelset"

    def __post_init__(self) -> None:
        self.table = contact_tables(self.wheelset, self.track)
        result = kernel.new_result()
        self._state = np.zeros(_RESULT.start + len(result))
        self._state[_PARAMETERS] = self.parameters
        self.parameters = self._state[_PARAMETERS]
        self.reference = self._state[_REFERENCE]
        self.rail_motion = self._state[_RAIL_MOTION]
        self._memory = self._state[_MEMORY]
        self._shifts = self._state[_SHIFTS]
        if self.elasticity is not None:
            self._state[_ELASTICITY] = self.elasticity.numbers()
        self._rail_object: Any = None
        self._rail_place = slice(0, 0)
        self.forget()
        self._sensor_state = self._state.copy()
        self._data: Any = None
        self.first = -1
        self.node = -1
        self._wrench = self.load_function(0)
        self.set_speed(self.rail_speed)

    def set_speed(self, speed: float) -> None:
        """Set the speed [m/s] of the moving frame the model stands in."""
        self.rail_speed = float(speed)
        self.parameters.view(kernel.PARAMETERS)["rail_speed"] = self.rail_speed
        self.forget()

    @property
    def arrays(self) -> tuple[np.ndarray, np.ndarray]:
        """Table and state that `body_wrench` works on; they stay where they are."""
        return self.table, self._state

    def forget(self) -> None:
        """Drop the kept evaluation, after a parameter has changed."""
        self._memory[0] = np.nan

    def attach(self, mbs: Any, node: int) -> None:
        """Bind to the body's node; its place in the system is looked up at the first call."""
        self.node = node
        self.reference[:] = mbs.GetNodeParameter(node, "referenceCoordinates")[:3]
        self.first = -1

    def place(self, mbs: Any) -> None:
        """Look up where the body stands in the assembled system."""
        self._data = mbs.systemData
        indices = self._data.GetNodeLTGODE2(self.node)
        self.first = int(indices[0])
        if self._rail_object is not None:
            start = int(self._data.GetObjectLTGODE1(self._rail_object)[0])
            self._rail_place = slice(start, start + 4)

    def load_function(self, part: int) -> Callable[[Any, float, Any], tuple[float, float, float]]:
        """User function of the force load (part 0) or the torque load (part 1), global axes.

        A closure, because every attribute looked up here is looked up at each evaluation. Exudyn
        keeps its current coordinates where they are from one Assemble to the next (in its explicit
        and implicit solvers, their Jacobians by differences included); an Assemble after items
        have been added moves them, and changes their number.
        """
        table, state = self.table, self._state
        block = np.array([0, 0, 0, 0, 0, len(table), len(state), -1, part], dtype=np.int64)
        block[2:4] = address_of(table), address_of(state)
        address = address_of(block)
        known = -1
        count: Callable[[], int]
        moving = self.irregularity is not None or self.elasticity is not None

        def wrench(mbs: Any, t: float, load: Any) -> tuple[float, float, float]:
            nonlocal known, count
            if known < 0 or count() != known:
                self.place(mbs)
                count = self._data.ODE2Size
                known = count()
                q = self._data.GetODE2Coordinates(_CURRENT, False)
                v = self._data.GetODE2Coordinates_t(_CURRENT, False)
                block[:2] = address_of(q), address_of(v)
                block[4], block[7] = known, self.first
            if moving:
                self._move_rails(t)
            return wrench_at(address)

        return wrench

    def attach_rails(self, rail_object: Any) -> None:
        """Bind the four first-order coordinates of the elastic rails' shifts."""
        self._rail_object = rail_object

    def rail_rates(self, mbs: Any, t: float) -> list[float]:
        """Rates [m/s] of the elastic rails' shifts: left y, z, right y, z."""
        self._wrench(mbs, t, None)
        return self._state[_RATES].tolist()

    def _move_rails(self, t: float) -> None:
        if self.irregularity is not None:
            q = self._data.GetODE2Coordinates(_CURRENT, False)
            station = self.reference[0] + q[self.first] + self.rail_speed * t
            shape = np.asarray(self.irregularity(station), dtype=float)
            if not np.array_equal(shape, self.rail_motion[_SHAPE]):
                self.rail_motion[_SHAPE] = shape
                self.forget()
        if self.elasticity is not None:
            shifts = self._data.GetODE1Coordinates()[self._rail_place]
            if not np.array_equal(shifts, self._shifts):
                self._shifts[:] = shifts
                self.forget()

    def current(self, mbs: Any, configuration: Any = None) -> ContactForces:
        """Patches and wrench at the current state of the system (or another configuration)."""
        self.evaluate(mbs, configuration)
        return read_result(self._sensor_state[_RESULT])

    def evaluate(self, mbs: Any, configuration: Any = None) -> np.ndarray:
        """Result array at the system's state, kept apart from the solver's."""
        if self.first < 0:
            self.place(mbs)
        arguments = () if configuration is None else (configuration,)
        data = mbs.systemData
        state = self._sensor_state
        state[_PARAMETERS] = self.parameters
        state[_REFERENCE] = self.reference
        state[_RAIL_MOTION] = self.rail_motion
        state[_ELASTICITY] = self._state[_ELASTICITY]
        state[_RATES] = self._state[_RATES]
        if self.elasticity is not None:
            state[_SHIFTS] = data.GetODE1Coordinates(*arguments)[self._rail_place]
        state[_MEMORY] = np.nan
        body_wrench(
            data.GetODE2Coordinates(*arguments),
            data.GetODE2Coordinates_t(*arguments),
            self.first,
            self.table,
            state,
            0,
        )
        return state[_RESULT]

    def history(
        self, mbs: Any, times: np.ndarray, coordinates: np.ndarray, velocities: np.ndarray,
        first_order: np.ndarray,
    ) -> np.ndarray:  # fmt: skip
        """Values (m, 2, 14) of the left and the right wheel at m states, as WHEEL_VALUES says.

        times (m,) [s]; coordinates, velocities (m, nq), first_order (m, n1) of the system.
        """
        self.place(mbs)
        state = self._state.copy()
        motions, shifts = np.zeros((len(coordinates), 12)), np.zeros((len(coordinates), 4))
        if self.irregularity is not None:
            stations = self.reference[0] + coordinates[:, self.first] + self.rail_speed * times
            motions[:, _SHAPE] = [self.irregularity(station) for station in stations]
        if self.elasticity is not None:
            shifts[:] = first_order[:, self._rail_place]
        values = np.empty((len(coordinates), 2, len(WHEEL_VALUES)))
        wheel_history(
            coordinates, velocities, self.first, self.table, state, motions, shifts, values
        )
        return values

    def elastic_energy(self, mbs: Any) -> float:
        """Energy [J] stored in all patches at the current state."""
        forces = self.current(mbs)
        return sum(patch.energy for patch in (*forces.left, *forces.right))

    @cached_property
    def guidance(self) -> Guidance:
        """How far the wheelset may go and still be guided by its rails."""
        return guidance(self.wheelset, self.track)

    def stance(self) -> np.ndarray:
        """Where the wheelset stood when its loads were last asked for, as `stance` fills it."""
        place = np.empty(7)
        stance(self.table, self._state, place)
        return place
