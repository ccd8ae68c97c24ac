"""One way to simulate: a vehicle, an Exudyn model or any system, from a start, into a Motion.

    motion = simulate(coach, speed=60.0, duration=5.0, initial=2e-3)
    motion["front leading: y"], motion.wheel("front leading", "left")["Q [N]"]
    motion = simulate(coach.on(Track("UIC60", layout=layout)), 20.0, 30.0, start=0.0)
    motion.distance, motion.y, motion.Q

A vehicle runs by its compiled equations, everything else by Exudyn's own solver, both with RK44 at
0.5 ms unless said otherwise. The run ends before
its time where a wheelset leaves the rails, where the solver gives up and on Ctrl-C; the motion
keeps what was computed and says how it ended (`motion.outcome`). Wheel forces are computed from the
recorded states, by the same compiled contact that drove them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from numbers import Real
from typing import Any

import exudyn as exu
import numpy as np
from scipy.spatial.transform import Rotation

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import finite_array, number, positive, refuse_options
from exudyn_wheelset.coupling.registration import WheelsetItems, wheelsets_of
from exudyn_wheelset.coupling.running import progress_bar
from exudyn_wheelset.coupling.wheel_forces import WHEEL_VALUES
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.columns import column_index
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.results.records import describe
from exudyn_wheelset.systems.constraints import JointedLayout
from exudyn_wheelset.systems.curving import check_run, follow_rails, frames_of, stand_at
from exudyn_wheelset.systems.exudyn_layout import Layout, lay_out
from exudyn_wheelset.systems.exudyn_running import Runner, sampled
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.exudyn_wheelsets import rolling_radii
from exudyn_wheelset.systems.fitting import check_curves
from exudyn_wheelset.systems.speeds import checked_speed
from exudyn_wheelset.systems.starts import shifted_state
from exudyn_wheelset.systems.system import DynamicSystem, SimulationError, as_system
from exudyn_wheelset.systems.vehicle_system import VehicleSystem

Start = (
    float | Mapping[str, float] | Sequence[float] | Array | Callable[[DynamicSystem, float], Array]
)

_NAMES = [name for name, _ in WHEEL_VALUES]
_FORCES_FIRST = sorted(range(len(_NAMES)), key=lambda k: _NAMES[k] not in ("Q", "Y"))
# Where a wheelset stands in the frame of the track at its own station.
PLACES = (("track y", "m"), ("track yaw", "rad"), ("track roll", "rad"), ("station", "m"))


def simulate(
    vehicle: Any,
    speed: float,
    duration: float,
    settings: exu.SimulationSettings | None = None,
    start: float | Start | None = 0.0,
    *,
    initial: Start | None = None,
    interval: float = 2.0e-3,
    solver_type: exu.DynamicSolverType | str | None = None,
    step: float | None = None,
    progress: bool = False,
    description: str | None = None,
    **others: Any,
) -> Motion:
    """Motion of a vehicle at `speed` [m/s] over `duration` [s], sampled every `interval` [s].

    vehicle  a Vehicle, an ExudynSystem or another DynamicSystem, Exudyn's `mbs`, or, by the
             `simulate` of the package, a name of the catalogue
    start    station [m] at time zero of the vehicle's own origin, on a track with a layout or an
             irregularity; on plain straight track, where all stations are alike, it may be what
             `initial` is
    initial  None: steady running as the track lies at the start, for `mbs` its initial values; a
             number: steady running, all wheelsets moved to the left by so much [m], both wheels on
             their rails; a mapping: steady running, the named states moved by so much; (n,): a
             state of the system; a function of system and speed that returns one
    settings, solver_type, step  of Exudyn's solver, for vehicles and `mbs`; a system has its own.
             Without settings and solver a vehicle runs by its compiled equations
    progress shows a bar with the time left, under `description`

    Bodies keep what they do in the model: `mbs` may have joints, memory and wheelsets that run over
    the ground, whose speed is that of their creation. Raises WheelsetError for impossible values.

    Examples
    --------
    >>> from exudyn_wheelset import catalogue, simulate
    >>> motion = simulate(catalogue.vehicle("s1002"), speed=20, duration=0.5, initial=2e-3)
    >>> round(float(motion.time[-1]), 3), str(motion.outcome)
    (0.5, 'the planned end was reached')
    """
    refuse_options(simulate, others)
    if not isinstance(settings, exu.SimulationSettings | None):
        raise AnalysisError(
            f"settings = {settings!r}: give exudyn.SimulationSettings(), or load_settings(...); "
            "what a motion begins from is initial=..., where on the track start=..."
        )
    speed = number("speed", speed, "m/s", -200.0, 200.0)
    duration = positive("duration", duration, "s", 1e5)
    interval = positive("interval", interval, "s", duration)
    samples = max(1, round(duration / interval))
    times = np.linspace(0.0, duration, samples + 1)
    options = {"settings": settings, "solver_type": solver_type, "step": step}
    given = {name: value for name, value in options.items() if value is not None}
    if isinstance(vehicle, exu.MainSystem):
        station, initial = _station(wheelsets_of(vehicle), start, initial)
        return _simulate_model(
            vehicle, speed, times, station, initial, given, progress, description
        )
    if isinstance(vehicle, DynamicSystem) and given:
        raise AnalysisError(
            f"{vehicle.name}: {', '.join(given)}: a system has a solver and a step of its own; "
            "give them where it is made"
        )
    system = as_system(vehicle, **given)
    if not isinstance(system, ExudynSystem):
        speed = checked_speed(system, "speed", speed)
    wheelsets = system.wheelsets if isinstance(system, ExudynSystem) else ()
    station, initial = _station(wheelsets, start, initial)
    if isinstance(system, ExudynSystem):
        check_run(wheelsets, speed, station, duration, system.step)
        check_curves(system.name, wheelsets)
        stand_at(wheelsets, station, False)
    state = _start_state(system, speed, initial)
    if isinstance(system, ExudynSystem) and not isinstance(initial, np.ndarray):
        state = follow_rails(system, state, speed, station)
    settings_record = {"duration": duration, "interval": times[1], "speed": speed}
    record = describe(system, "simulation", settings_record)
    if not isinstance(system, ExudynSystem):
        return _simulate_equations(system, speed, times, state, record)
    system.use_speed(speed)
    described = description or f"{system.name}, {speed:g} m/s"
    stand_at(wheelsets, station, True)
    compiled = isinstance(system, VehicleSystem) and system.compiled_motion
    try:
        if isinstance(system, VehicleSystem) and system.compiled_motion:
            outcome, raw = _run_compiled(system, state, speed, times, progress, described)
        else:
            begin = system.layout.expand(state)
            outcome, raw = _run(system.runner, begin, times, progress, described)
        motion = motion_of(system, times, raw, outcome, speed, station, record)
        if compiled:
            turned = _spun(system.layout, motion.time, motion.coordinates, raw[1])
            motion = replace(motion, coordinates=turned)
        return motion
    finally:
        stand_at(wheelsets, station, False)


def motion_of(
    system: ExudynSystem,
    times: Array,
    raw: tuple[Array, ...],
    outcome: Outcome,
    speed: float,
    station: float,
    record: Mapping[str, Any],
) -> Motion:
    """Motion of a system from coordinates, velocities (m, nq) and first-order ones (m, n1)."""
    if isinstance(system, VehicleSystem):
        loads = {name: list(pair) for name, pair in system.vehicle_items.loads.items()}
        record = {**record, "static_loads": loads}
    layout: Any = system.layout
    names = system.state_names
    if isinstance(layout, JointedLayout):
        # What depends on others moves too.
        layout, names = layout.whole, layout.whole.names
    return _motion(
        system.mbs, times, raw, layout, names, system.wheelsets, outcome, speed, station, record
    )


def _station(
    wheelsets: Sequence[WheelsetItems], start: Any, initial: Start | None
) -> tuple[float, Start | None]:
    """Station [m] of a run and what it begins from."""
    plain = all(frame.is_plain for frame in frames_of(wheelsets))
    if isinstance(start, Real) and not isinstance(start, bool) and (not plain or start == 0.0):
        return number("start (station)", start, "m"), initial
    if start is None:
        return 0.0, initial
    if initial is not None:
        raise AnalysisError(f"start = {start!r} beside initial: give a station [m] as start")
    return 0.0, start


class _Model:
    """An Exudyn model that is simulated as it is, with its joints and memory."""

    name = "Exudyn model"

    def __init__(self, mbs: Any, options: Mapping[str, Any]) -> None:
        self.wheelsets = wheelsets_of(mbs)
        self.runner = Runner(
            mbs,
            self.name,
            options.get("settings"),
            options.get("solver_type"),
            options.get("step"),
            memory=True,
        )
        mbs.Assemble()
        radii = rolling_radii(self.wheelsets)
        self.layout = lay_out(mbs, self.runner.nodes, radii, {}, self.name)

    def measures(self) -> dict[str, Any]:
        return {
            "system": self.name,
            "state_names": list(self.layout.names),
            "solver": str(self.runner.solver_type).split(".")[-1],
            "step": self.runner.step,
        }


def _simulate_model(
    mbs: Any,
    speed: float,
    times: Array,
    station: float,
    initial_state: Start | None,
    options: Mapping[str, Any],
    progress: bool,
    description: str | None,
) -> Motion:
    if initial_state is not None:
        system = ExudynSystem(mbs, name=_Model.name, **options)
        motion = simulate(
            system, speed, times[-1], start=station, initial=initial_state, interval=times[1],
            progress=progress, description=description,
        )  # fmt: skip
        return motion
    model = _Model(mbs, options)
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    begin = (
        np.array(data.GetODE2Coordinates(initial)),
        np.array(data.GetODE2Coordinates_t(initial)),
        np.array(data.GetODE1Coordinates(initial)),
    )
    check_run(model.wheelsets, speed, station, float(times[-1]), model.runner.step)
    for items in model.wheelsets:
        first = int(data.GetNodeLTGODE2(items.node)[0])
        _set_speed(items, begin[1], first, speed)
    record = describe(
        model, "simulation", {"duration": times[-1], "interval": times[1], "speed": speed}
    )
    described = description or f"{speed:g} m/s"
    stand_at(model.wheelsets, station, True)
    try:
        outcome, raw = _run(model.runner, begin, times, progress, described)
        return _motion(
            mbs, times, raw, model.layout, model.layout.names, model.wheelsets, outcome, speed,
            station, record,
        )  # fmt: skip
    finally:
        stand_at(model.wheelsets, station, False)


def _set_speed(items: WheelsetItems, velocities: Array, first: int, speed: float) -> None:
    """Let a wheelset of a moving frame roll at the speed; one over the ground must have it."""
    if items.moving_frame:
        before = items.contact.rail_speed
        if before:
            velocities[first + 3 : first + 6] *= speed / before
        items.contact.set_speed(speed)
    elif abs(velocities[first] - speed) > 1e-6 * max(1.0, abs(speed)):
        raise AnalysisError(
            f"{items.name} runs over the ground at {velocities[first]:g} m/s, not at "
            f"{speed:g} m/s: create it with speed={speed:g}, or simulate at the speed it has"
        )


def _start_state(system: DynamicSystem, speed: float, start: Start | None) -> Array:
    if callable(start):
        state = np.array(start(system, speed), dtype=float)
    elif start is None:
        state = np.array(system.equilibrium(speed))
    elif isinstance(start, Mapping):
        state = np.array(system.equilibrium(speed))
        for name, value in start.items():
            index = column_index(system.state_names, name)
            state[index] += number(f"start of {name}", value, "SI")
    elif isinstance(start, str) or not isinstance(start, Sequence | np.ndarray):
        state = shifted_state(system, speed, number("start (lateral shift)", start, "m"))
    else:
        state = finite_array("start", start, "SI units")
    if state.shape != (system.size,) or not np.all(np.isfinite(state)):
        raise AnalysisError(
            f"{system.name}: the start has the shape {state.shape} or numbers that are not finite; "
            f"give {system.size} numbers: {', '.join(system.state_names)}"
        )
    return state


def _run(
    runner: Runner,
    start: tuple[Array, Array, Array],
    times: Array,
    progress: bool,
    description: str,
) -> tuple[Outcome, tuple[Array, Array, Array]]:
    """Outcome and recorded coordinates at as many of the times as were reached."""
    each = max(1, int(np.ceil(times[1] / runner.step - 1e-9)))
    outcome = runner.run(start, each * (len(times) - 1), float(times[-1]), progress, description)
    stored, values = runner.recorded()
    widths = np.cumsum([part.shape[1] for part in values])
    samples = sampled(stored, np.hstack(values), times)
    if len(samples) < len(times) and outcome.ending is Ending.FINISHED:
        outcome = Outcome(Ending.NOT_FINITE)
    coordinates, velocities, first_order, _ = np.split(samples, widths, axis=1)
    return outcome, (coordinates, velocities, first_order)


def _run_compiled(
    system: VehicleSystem,
    state: Array,
    speed: float,
    times: Array,
    progress: bool,
    description: str,
) -> tuple[Outcome, tuple[Array, Array, Array]]:
    """As `_run`, by the compiled equations."""
    with progress_bar(float(times[-1]), progress, description) as bar:
        states, outcome = system.carry_on(state, speed, times, bar)
    rows = [system.layout.expand(row) for row in states]
    coordinates, velocities, first_order = (
        np.array([row[k] for row in rows]).reshape(len(rows), -1) for k in range(3)
    )
    return outcome, (coordinates, velocities, first_order)


def _spun(layout: Layout, times: Array, coordinates: Array, velocities: Array) -> Array:
    """Coordinates with wheelsets turned by the angle that their spin has come to."""
    turned = coordinates.copy()
    for first, _, spins in layout.rotations:
        if spins and len(times) > 1:
            place = slice(first, first + 3)
            rates = velocities[:, first + 1]
            angle = np.append(0.0, np.cumsum(0.5 * np.diff(times) * (rates[1:] + rates[:-1])))
            frame = Rotation.from_rotvec(coordinates[:, place])
            turned[:, place] = (
                frame * Rotation.from_rotvec(np.outer(angle, [0.0, 1.0, 0.0]))
            ).as_rotvec()
    return turned


def _motion(
    mbs: Any,
    times: Array,
    raw: tuple[Array, ...],
    layout: Layout,
    names: Sequence[str],
    wheelsets: Sequence[WheelsetItems],
    outcome: Outcome,
    speed: float,
    station: float,
    record: Mapping[str, Any],
) -> Motion:
    coordinates, velocities, first_order = (np.ascontiguousarray(values) for values in raw)
    reached = times[: len(coordinates)]
    # The only body of a model has no name before its states.
    alone = f"{wheelsets[0].name}: " if len(wheelsets) == 1 else ""
    columns = {
        name if ": " in name else alone + name: values
        for name, values in zip(
            names, layout.reduce(coordinates, velocities, first_order).T, strict=True
        )
    }
    for items in wheelsets:
        history, places = items.contact.history(mbs, reached, coordinates, velocities, first_order)
        for k, (name, unit) in enumerate(PLACES):
            columns[f"{items.name}: {name} [{unit}]"] = places[:, k].copy()
        for hand, side in enumerate(("left", "right")):
            # Q and Y first.
            for k in _FORCES_FIRST:
                name, unit = WHEEL_VALUES[k]
                columns[f"{items.name} {side}: {name} [{unit}]"] = history[:, hand, k].copy()
    return Motion(reached, columns, outcome, speed, record, coordinates, station)


def _simulate_equations(
    system: DynamicSystem, speed: float, times: Array, state: Array, record: Mapping[str, Any]
) -> Motion:
    outcome = Outcome(Ending.FINISHED)
    try:
        states = system.simulate(state, speed, times)
    except SimulationError as error:
        states, outcome = error.states, error.outcome
    columns = dict(zip(system.state_names, np.asarray(states).T, strict=True))
    return Motion(times[: len(states)], columns, outcome, speed, record)
