"""The rails' wrench on a wheelset as two Exudyn loads, a force and a torque on its centre.

Exudyn calls the user function of each load at every evaluation. Both share one contact
evaluation: whichever is called first computes and keeps force and torque with the coordinates and
the time they belong to; the other takes them only if these are the same to the last bit. During
numerical Jacobians, where loads are evaluated one by one at shifted states, each computes anew.

The body has a node of NodeType.RotationRotationVector: coordinates are its displacement and the
rotation vector theta (R = exp(theta)), velocities the global velocity and the angular velocity in
body axes (measured, and tested in test_coupling_against_kernel.py). The axle is the body's y axis,
the reference orientation the identity.

A model may run over the ground, its wheelsets moving at V, or stand in a frame that moves at V
while the rails run backwards (`rail_speed`): on straight track the laws of motion are the same, and
a spring to the moving frame is a spring to Exudyn's ground. What the frame does to its bodies where
it turns is in moving_frame.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_wheelset.addresses import address_of
from exudyn_wheelset.contact import layout as kernel
from exudyn_wheelset.contact.changing_rails import rails_change
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.contact.wheelset_contact import ContactForces, read_result
from exudyn_wheelset.coupling.changing_rails import ChangingRails
from exudyn_wheelset.coupling.elastic_apart import ELASTIC
from exudyn_wheelset.coupling.elastic_rails import RailElasticity
from exudyn_wheelset.coupling.guidance import Guidance, guidance
from exudyn_wheelset.coupling.track_frame import TrackFrame
from exudyn_wheelset.coupling.wheel_forces import WHEEL_VALUES
from exudyn_wheelset.coupling.wheelset_kernel import (
    ELASTICITY,
    MEMORY,
    PARAMETERS,
    PLACE,
    RAIL_MOTION,
    RATES,
    REFERENCE,
    RESULT,
    SECTIONS,
    SHIFTS,
    SLOPES,
    STATION,
    body_wrench,
    rail_rates_at,
    stance,
    wheel_history,
    wrench_at,
)
from exudyn_wheelset.spelling import spelt_class

_CURRENT = exu.ConfigurationType.Current


@spelt_class
@dataclass(eq=False)
class WheelRailContact:
    """Contact of one wheelset in an Exudyn model: its state between evaluations.

    wheelset, track: descriptions; parameters: array of `contact_parameters`; rail_speed [m/s]:
    speed of the moving frame the model stands in, 0 for a model that runs over the ground; frame:
    how it goes along the track, shared by all wheelsets of a vehicle (None: one of its own);
    elasticity: springs under each rail, or None for rails that do not give way; name: of the
    wheelset.

    Examples
    --------
    >>> import exudyn as exu
    >>> from exudyn_wheelset import Track, Wheelset, create_wheelset
    >>> mbs = exu.SystemContainer().AddSystem()
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    >>> contact = create_wheelset(mbs, axle, Track("UIC60"), speed=40, moving_frame=True).contact
    >>> contact.rail_speed
    40.0
    """

    wheelset: Wheelset
    track: Track
    parameters: np.ndarray
    rail_speed: float = 0.0
    frame: TrackFrame | None = None
    elasticity: RailElasticity | None = None
    name: str = "wheelset"

    def __post_init__(self) -> None:
        self.table = contact_tables(self.wheelset, self.track)
        result = kernel.new_result()
        self._state = np.zeros(RESULT.start + len(result))
        self._state[PARAMETERS] = self.parameters
        self.parameters = self._state[PARAMETERS]
        self.reference = self._state[REFERENCE]
        self.rail_motion = self._state[RAIL_MOTION]
        self._memory = self._state[MEMORY]
        if self.elasticity is not None:
            self._state[ELASTICITY] = self.elasticity.numbers()
            ELASTIC.ready()
        if rails_change(self.track):
            self._sections = ChangingRails(self.wheelset, self.track)
            self._state[SECTIONS] = self._sections.numbers()
        self.track_frame = self.frame or TrackFrame.of(self.track)
        self._rail_object: Any = None
        self._rail_place = slice(0, 0)
        self.forget()
        self._sensor_state = self._state.copy()
        self._data: Any = None
        self.first = -1
        self.node = -1
        self.set_speed(self.rail_speed)

    def set_speed(self, speed: float) -> None:
        """Set the speed [m/s] of the moving frame the model stands in."""
        self.rail_speed = float(speed)
        self.parameters.view(kernel.PARAMETERS)["rail_speed"] = self.rail_speed
        self.track_frame.set_speed(self.rail_speed)
        self.forget()

    @property
    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Table, state and track that `body_wrench` works on; they stay where they are."""
        return self.table, self._state, self.track_frame.array

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
        return self._function(wrench_at, part)

    def rail_function(self) -> Callable[[Any, float, Any, Any], tuple[float, ...]]:
        """User function of the rates [m/s] of elastic rails' shifts: left y, z, right y, z."""
        return self._function(rail_rates_at, 0)

    def _function(self, of_block: Any, part: int) -> Callable[..., Any]:
        table, state, track = self.table, self._state, self.track_frame.array
        sizes = (len(table), len(state), len(track))
        block = np.array([0, 0, 0, 0, 0, 0, *sizes, -1, part, 0], dtype=np.int64)
        block[2:5] = address_of(table), address_of(state), address_of(track)
        address = address_of(block)
        known = -1
        count: Callable[[], int]

        def computed(mbs: Any, t: float, item: Any, shifts: Any = None) -> Any:
            nonlocal known, count
            if known < 0 or count() != known:
                self.place(mbs)
                count = self._data.ODE2Size
                known = count()
                q = self._data.GetODE2Coordinates(_CURRENT, False)
                v = self._data.GetODE2Coordinates_t(_CURRENT, False)
                block[:2] = address_of(q), address_of(v)
                block[5], block[9] = known, self.first
                if self.elasticity is not None:
                    strokes = self._data.GetODE1Coordinates(_CURRENT, False)
                    block[11] = address_of(strokes[self._rail_place])
            found: tuple[float, float, float] = of_block(address, t)
            return found

        return computed

    def attach_rails(self, rail_object: Any) -> None:
        """Bind the four first-order coordinates of the elastic rails' shifts."""
        self._rail_object = rail_object

    def current(self, mbs: Any, configuration: Any = None) -> ContactForces:
        """Patches and wrench at the current state of the system (or another configuration)."""
        self.evaluate(mbs, configuration)
        return read_result(self._sensor_state[RESULT])

    def evaluate(self, mbs: Any, configuration: Any = None) -> np.ndarray:
        """Result array at the system's state, kept apart from the solver's."""
        if self.first < 0:
            self.place(mbs)
        arguments = () if configuration is None else (configuration,)
        data = mbs.systemData
        state = self._sensor_state
        state[PARAMETERS] = self.parameters
        state[REFERENCE] = self.reference
        state[RAIL_MOTION] = self.rail_motion
        state[ELASTICITY] = self._state[ELASTICITY]
        state[RATES], state[SLOPES] = self._state[RATES], self._state[SLOPES]
        if self.elasticity is not None:
            state[SHIFTS] = data.GetODE1Coordinates(*arguments)[self._rail_place]
        state[MEMORY] = np.nan
        body_wrench(
            data.GetODE2Coordinates(*arguments),
            data.GetODE2Coordinates_t(*arguments),
            self.first,
            self.table,
            state,
            self.track_frame.array,
            data.GetTime(),
            0,
        )
        return state[RESULT]

    def history(
        self, mbs: Any, times: np.ndarray, coordinates: np.ndarray, velocities: np.ndarray,
        first_order: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
        """Values (m, 2, 17) of the left and the right wheel at m states, as WHEEL_VALUES says, and
        places (m, 4) of the wheelset: y [m], yaw, roll [rad] on its track, station [m].

        times (m,) [s]; coordinates, velocities (m, nq), first_order (m, n1) of the system.
        """
        self.place(mbs)
        state = self._state.copy()
        shifts = np.zeros((len(coordinates), 4))
        if self.elasticity is not None:
            shifts[:] = first_order[:, self._rail_place]
        values = np.empty((len(coordinates), 2, len(WHEEL_VALUES)))
        places = np.empty((len(coordinates), 4))
        wheel_history(
            coordinates, velocities, np.asarray(times, dtype=float), self.first, self.table, state,
            self.track_frame.array, shifts, values, places,
        )  # fmt: skip
        return values, places

    def elastic_energy(self, mbs: Any) -> float:
        """Energy [J] stored in all patches at the current state."""
        forces = self.current(mbs)
        return sum(patch.energy for patch in (*forces.left, *forces.right))

    @cached_property
    def guidance(self) -> Guidance:
        """How far the wheelset may go and still be guided by its rails."""
        return guidance(self.wheelset, self.track)

    def station(self, time: float) -> float:
        """Where along the track [m] the wheelset stood when its loads were last asked for, at a
        time [s]."""
        if not self.track_frame.is_plain:
            return float(self._state[PLACE][STATION])
        return float(self.reference[0] + self._memory[0] + self.rail_speed * time)

    def stance(self) -> np.ndarray:
        """Where the wheelset stood when its loads were last asked for, as `stance` fills it."""
        place = np.empty(7)
        stance(self.table, self._state, place)
        return place
