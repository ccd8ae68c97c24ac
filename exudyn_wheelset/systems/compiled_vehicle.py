"""The compiled equations of a vehicle that stands alone in an Exudyn model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from exudyn_wheelset.addresses import address_of
from exudyn_wheelset.arrays import Array
from exudyn_wheelset.coupling.moving_frame import BODY, CENTRE, INERTIA, MASS, MOTION
from exudyn_wheelset.coupling.track_frame import TrackFrame
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.systems import vehicle_kernel as kernel
from exudyn_wheelset.systems.exudyn_layout import Layout
from exudyn_wheelset.systems.system import DIFFERENCE_STEP
from exudyn_wheelset.vehicles import layout as places
from exudyn_wheelset.vehicles.assemble import Connectors
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.drawbar import Drawbar
from exudyn_wheelset.vehicles.spin_drive import DRIVE_DAMPING


class Parts(Protocol):
    """What of a vehicle's items the compiled equations are made from (see `VehicleItems`)."""

    @property
    def contacts(self) -> Sequence[WheelRailContact]: ...

    @property
    def connectors(self) -> Connectors: ...

    @property
    def frame(self) -> TrackFrame: ...

    @property
    def drawbar(self) -> Drawbar | None: ...


class CompiledVehicle:
    """Rates and Jacobians of a vehicle as `vehicle_kernel` computes them.

    It works on the arrays of the contacts and connections in the Exudyn model itself, so that
    what is changed there (a speed, a parameter) is changed here.
    """

    def __init__(self, vehicle: Vehicle, items: Parts, states: Layout, scales: Array) -> None:
        count = len(states.rotations)
        size = len(states.position_of)
        strokes = len(states.names) - states.positions - size
        block = items.connectors.block
        self._speed = np.array([0.0, 0.0, vehicle.gravity])
        track = items.frame.array
        bodies, inverse_masses = _bodies(vehicle, items)
        contacts = np.zeros((len(items.contacts), kernel.CONTACT_ROW), dtype=np.int64)
        blocks = [*(_laws_on(block, body) for body in range(count)), block]
        self._kept: list[Any] = [items, blocks]
        for row, contact in zip(contacts, items.contacts, strict=True):
            table, state, _ = contact.arrays
            row[:] = address_of(table), len(table), address_of(state), len(state)
        arrays = [
            np.zeros(size),
            np.zeros(size),
            np.zeros(strokes),
            np.zeros(size + strokes),
            np.ascontiguousarray(states.position_of, dtype=np.int64),
            np.ascontiguousarray(states.rotations, dtype=np.int64),
            np.ascontiguousarray(states.reference, dtype=float),
            inverse_masses,
            bodies,
            contacts,
            np.array([(address_of(one), len(one)) for one in blocks], dtype=np.int64),
            _owners(states, block, count),
            np.array(scales, dtype=float),
            self._speed,
            track,
            np.zeros(MOTION),
            _frame_rows(vehicle, items),
        ]
        self._kept += arrays
        sizes = [len(states.names), size, strokes, count, len(contacts), len(track)]
        self._plan = np.array([*sizes, *map(address_of, arrays)], dtype=np.int64)
        self._address = address_of(self._plan)
        self._state, self._rate = np.zeros(sizes[0]), np.zeros(sizes[0])
        self._ends = address_of(self._state), address_of(self._rate)

    def use_speed(self, speed: float) -> None:
        """Take over a forward speed [m/s] that the contacts have already."""
        self._speed[0] = speed

    def rate(self, state: Array) -> Array:
        """Rate (n,) of a state (n,)."""
        self._state[:] = state
        kernel.rate_at(self._address, *self._ends)
        return self._rate.copy()

    def rates(self, states: Array) -> Array:
        """Rates (m, n) of states (m, n)."""
        states = self._checked(states)
        rates = np.empty_like(states)
        kernel.rates_at(self._address, states, rates)
        return rates

    def jacobians(self, states: Array) -> Array:
        """Jacobians (m, n, n) at states (m, n), by central differences of the bodies' own laws."""
        states = self._checked(states)
        matrices = np.empty((*states.shape, states.shape[1]))
        kernel.jacobians_at(self._address, states, DIFFERENCE_STEP, matrices)
        return matrices

    def _checked(self, states: Array) -> Array:
        """States (m, n) as the kernels read them: beyond their end there is other memory."""
        states = np.ascontiguousarray(states, dtype=float)
        if states.ndim != 2 or states.shape[1] != len(self._state):
            raise AnalysisError(
                f"states of the shape {states.shape}: give (m, {len(self._state)}), one row a state"
            )
        return states

    def run(self, state: Array, time: float, step: float, samples: Array, steps: int) -> int:
        """Carry a state (n,) on from a time [s], in place, by Runge-Kutta steps [s]; a row of
        samples (m, n) after each `steps` of them. Returns the number of finite rows."""
        self._checked(state[None, :])
        finite = int(kernel.run_at(self._address, state, float(time), step, samples, steps))
        self._speed[1] = 0.0
        return finite


def _bodies(vehicle: Vehicle, items: Parts) -> tuple[Array, Array]:
    """Rows (nb, BODY_ROW) of the bodies, and the inverse masses (6 nb)."""
    count = len(vehicle.parts)
    rows = np.zeros((count, kernel.BODY_ROW))
    inverse = np.empty(6 * count)
    for k, part in enumerate(vehicle.parts):
        body: Any = getattr(part, "wheelset", part)
        rows[k, kernel.WEIGHT] = body.mass * vehicle.gravity
        rows[k, kernel.INERTIA : kernel.INERTIA + 3] = body.inertia
        inverse[6 * k : 6 * k + 6] = 1.0 / np.array([*3 * [body.mass], *body.inertia])
    for k, axle in enumerate(vehicle.wheelsets):
        if axle.driven:
            rows[k, kernel.DRIVE] = DRIVE_DAMPING
            rows[k, kernel.DRIVE_RADIUS] = axle.wheelset.radius
    if items.drawbar is not None:
        bar = items.drawbar
        row = rows[bar.part]
        row[kernel.PULL] = bar.pull
        row[kernel.DRAWBAR_STIFFNESS], row[kernel.DRAWBAR_DAMPING] = bar.stiffness, bar.damping
    return rows, inverse


def _frame_rows(vehicle: Vehicle, items: Parts) -> Array:
    """Rows (nb, BODY) of the bodies for the loads of their frame's motion."""
    rows = np.zeros((len(vehicle.parts), BODY))
    block = items.connectors.block
    start = int(block[places.H_BODY_ROWS])
    own = block[start : start + len(rows) * places.BODY].reshape(len(rows), places.BODY)
    for row, part, centre in zip(rows, vehicle.parts, own[:, places.POSITION], strict=True):
        body: Any = getattr(part, "wheelset", part)
        row[MASS], row[INERTIA : INERTIA + 3], row[CENTRE:] = body.mass, body.inertia, centre
    return rows


def _law_rows(block: Array) -> Array:
    """The block's rows of laws (m, ROW), a view."""
    start, laws = int(block[places.H_LAW_ROWS]), int(block[places.H_LAWS])
    return block[start : start + laws * places.ROW].reshape(laws, places.ROW)


def _laws_on(block: Array, body: int) -> Array:
    """A block with the laws that end on a body alone."""
    own = block.copy()
    rows = _law_rows(block)
    chosen = rows[(rows[:, places.LOWER] == body) | (rows[:, places.UPPER] == body)]
    own[places.H_LAWS] = len(chosen)
    start = int(block[places.H_LAW_ROWS])
    own[start : start + chosen.size] = chosen.ravel()
    places.forget(own)
    return own


def _owners(states: Layout, block: Array, count: int) -> Array:
    """Body whose laws feel each state (n)."""
    owners = np.zeros(len(states.names), dtype=np.int64)
    body_of = np.zeros(len(states.position_of), dtype=np.int64)
    for body, (start, yaw, spins) in enumerate(states.rotations):
        first = start - 3
        body_of[first : first + 6] = body
        owners[yaw : yaw + 3 - spins] = body
    for coordinate, position in enumerate(states.position_of):
        if position >= 0:
            owners[position] = body_of[coordinate]
    end = states.positions + len(body_of)
    owners[states.positions : end] = body_of
    # The states of a law follow one another, and those of the laws the order of the rows.
    for row in _law_rows(block):
        if row[places.STATE] >= 0:
            ends = [int(row[places.LOWER]), int(row[places.UPPER])]
            owners[end + int(row[places.STATE]) :] = min(ends)
    assert np.all(owners < count)
    return owners
