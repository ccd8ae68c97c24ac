"""A vehicle as a system for the analyses: built in Exudyn, alone in its model."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from itertools import pairwise
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.coupling.derailment import DerailmentWatch
from exudyn_wheelset.coupling.running import CHECK_INTERVAL
from exudyn_wheelset.profiles import Profile
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.systems.compiled_vehicle import CompiledVehicle
from exudyn_wheelset.systems.constraints import JointedLayout
from exudyn_wheelset.systems.curving import curve_equilibrium
from exudyn_wheelset.systems.exudyn_running import DEFAULT_STEP
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.system import SimulationError
from exudyn_wheelset.vehicles import layout as places
from exudyn_wheelset.vehicles.assemble import VehicleItems, add_vehicle
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.spin_drive import DRIVEN_STEP

_FIRST_SPEED = 20.0
# RK44 is stable to a step of 2.78 over the rate of a real root; at 2 it still follows it.
RK44_REACH = 2.0
# Faces of a suspension slide no faster [m/s]: 25 mm at 3 Hz is 0.47 m/s.
FASTEST_SLIDING = 0.5
# Below it [s] a run takes minutes: so stiff a damper is a joint, and better without its spring.
SHORTEST_STEP = 5.0e-6


class VehicleSystem(ExudynSystem):
    """The system of a vehicle, with the item numbers of its parts by name.

    Rates and Jacobians come from the compiled equations (`vehicle_kernel`), and so does the motion
    at equal times unless a solver or settings of Exudyn were asked for: by the classical
    Runge-Kutta method at the same step as Exudyn's RK44, with the same endings. Elements that add
    Exudyn items of their own are known to Exudyn alone, which then computes everything.
    """

    vehicle_items: VehicleItems
    compiled: CompiledVehicle | None = None
    compiled_motion = False
    _coarseness = 1.0
    # How far [m, rad] a motion chatters about the steady state of a curve, 0 for an equilibrium.
    unsteadiness = 0.0
    # For which speed it is known; for none at first: vehicles run backwards too.
    _stable_step: tuple[float, float] = (np.nan, 0.0)

    def compile(self, vehicle: Vehicle, items: VehicleItems) -> None:
        """Let rates and Jacobians come from the compiled equations where they know all forces."""
        self.vehicle_items = items
        if not items.connections:
            self.compiled = CompiledVehicle(vehicle, items, self.layout, self.scales)

    @property
    def centres(self) -> Array:
        """Reference positions (nb, 3) [m] of the wheelsets and bodies."""
        block = self.vehicle_items.connectors.block
        start, count = int(block[places.H_BODY_ROWS]), len(self.layout.rotations)
        rows = block[start : start + count * places.BODY].reshape(count, places.BODY)
        return np.asarray(rows[:, places.POSITION])

    def derivative(self, state: Array, speed: float) -> Array:
        """Rate of change of a state (n,) at a forward speed [m/s]; shape (n,)."""
        if self.compiled is None:
            return super().derivative(state, speed)
        self._place(speed)
        return self.compiled.rate(state)

    def derivatives(self, states: Array, speed: float) -> Array:
        """Rates of change (m, n) of m states (m, n)."""
        if self.compiled is None:
            return super().derivatives(states, speed)
        self._place(speed)
        return self.compiled.rates(states)

    def jacobian(self, state: Array, speed: float) -> Array:
        """Jacobian (n, n) at a state (n,)."""
        if self.compiled is None:
            return super().jacobian(state, speed)
        return np.asarray(self.jacobians(np.array([state], dtype=float), speed)[0])

    def jacobians(self, states: Array, speed: float) -> Array:
        """Jacobians (m, n, n) at m states (m, n)."""
        if self.compiled is None:
            return super().jacobians(states, speed)
        self._place(speed)
        return self.compiled.jacobians(states)

    @property
    def step(self) -> float:
        """Largest time step of `simulate` [s]."""
        return self._coarseness * super().step

    @contextmanager
    def coarser(self, factor: float) -> Iterator[bool]:
        """Within it the time step of `simulate` is `factor` times as long.

        Gives whether it is: Exudyn's solver keeps its own.
        """
        kept = self._coarseness
        self._coarseness = factor * kept if self.compiled_motion else kept
        try:
            yield self.compiled_motion
        finally:
            self._coarseness = kept

    def held(self, states: Array, speed: float) -> Array:
        """The last of the states (m, n) of a motion, its mean speed over them made `speed` [m/s].

        All bodies and the spins of the wheelsets are shifted together, so that no creepage changes.
        """
        layout = self.layout
        if isinstance(layout, JointedLayout):
            return super().held(states, speed)
        forward = layout.positions + layout.rotations[:, 0] - 3
        rolling = forward[layout.rotations[:, 2] > 0]
        gained = float(np.mean(states[:, rolling])) if len(rolling) else 0.0
        state = self.carry_over(states[-1], speed + gained, speed)
        state[forward] -= gained
        return state

    def simulate(self, state: Array, speed: float, times: Array) -> Array:
        """Motion from `state` (n,) at times[0], at `times` (m,) [s]; shape (m, n).

        Raises SimulationError, which keeps the samples before, if it ends early.
        """
        times = np.asarray(times, dtype=float)
        equal = times.ndim == 1 and len(times) > 1 and times[1] > times[0]
        if not (
            self.compiled_motion and equal and np.allclose(np.diff(times), times[1] - times[0])
        ):
            return super().simulate(state, speed, times)
        samples, outcome = self.carry_on(state, speed, times)
        if outcome.ending is Ending.INTERRUPTED:
            raise KeyboardInterrupt(str(outcome))
        if outcome.ending is Ending.FINISHED:
            return samples
        done = len(samples)
        raise SimulationError(
            f"{self.name}: the motion at {speed:g} m/s ended after {times[done - 1]:.6g} s: "
            f"{outcome}",
            times[:done],
            samples,
            outcome,
        )

    def carry_on(
        self, state: Array, speed: float, times: Array, bar: Any = None
    ) -> tuple[Array, Outcome]:
        """Samples (m, n) of the compiled equations' motion from a state (n,), and how it ended.

        times: at equal distances; what was computed before an early end is kept. The wheelsets are
        looked at as often as in a run of Exudyn's solver; bar: told of the simulated seconds.
        """
        compiled = self.compiled
        assert compiled is not None
        self._place(speed)
        state = np.array(state, dtype=float)
        interval = float(times[-1] - times[0]) / (len(times) - 1)
        step = min(self.step, self._stable_at(state, speed))
        steps = max(1, int(np.ceil(interval / step - 1e-9)))
        together = max(1, int(CHECK_INTERVAL / interval))
        samples = np.empty((len(times), self.size))
        samples[0] = state
        watch = DerailmentWatch(self.contacts)
        watch.begin(float(times[0]))
        done, outcome = 1, None
        try:
            while outcome is None and done < len(times):
                rows = samples[done : done + together]
                time = float(times[0]) + (done - 1) * interval
                finite = compiled.run(state, time, interval / steps, rows, steps)
                done += finite
                if bar is not None:
                    bar.update(finite * interval)
                if finite < len(rows):
                    outcome = Outcome(Ending.NOT_FINITE)
                else:
                    outcome = watch.look(float(times[done - 1]))
        except KeyboardInterrupt:
            outcome = Outcome(Ending.INTERRUPTED, f"at {times[done - 1]:.3f} s")
        return samples[:done], outcome or Outcome(Ending.FINISHED)

    def _stable_at(self, state: Array, speed: float) -> float:
        """Time step [s] that follows every root of the motion near a state (n,).

        Creep damps a wheelset at f/(m V): below 15 m/s faster than a step of 0.5 ms holds.
        """
        if self._stable_step[0] != speed:
            scaled = self.jacobian(state, speed) * self.scales[None, :] / self.scales[:, None]
            fastest = 0.0
            if np.all(np.isfinite(scaled)):
                fastest = float(np.abs(np.linalg.eigvals(scaled)).max())
            step = RK44_REACH / max(fastest, 1e-9)
            self._stable_step = (speed, max(step, SHORTEST_STEP))
        return self._stable_step[1]

    def equilibrium(self, speed: float, guess: Array | None = None) -> Array:
        """Steady state (n,) at a speed [m/s]; in a curve by continuation from straight track."""
        frame = self.vehicle_items.frame
        if guess is not None or not np.any(frame.frozen):
            return super().equilibrium(speed, guess)
        self.use_speed(speed)
        return curve_equilibrium(self, frame, speed)

    def _place(self, speed: float) -> None:
        self.use_speed(speed)
        assert self.compiled is not None
        self.compiled.use_speed(speed)


def vehicle_system(vehicle: Vehicle, **options: Any) -> VehicleSystem:
    """The vehicle alone in an Exudyn model; options are those of ExudynSystem.

    The time step, if it is not given, is one that Exudyn's RK44 follows: shorter than its usual one
    where a driven axle or a stiff damper in series is faster. With `solver_type` or `settings`
    given the system's motion is that of Exudyn's solver, else that of the compiled equations.
    """
    asked = any(options.get(name) is not None for name in ("settings", "solver_type"))
    if options.get("settings") is None and options.get("step") is None:
        options["step"] = followed_step(vehicle)
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    items = add_vehicle(mbs, vehicle, _FIRST_SPEED, show=False, sensors=False)
    options.setdefault("spinning_nodes", dict(items.radii))
    options.setdefault("name", vehicle.name)
    options.setdefault("parameters", numbers_of(vehicle))
    system = VehicleSystem(mbs, container, **options)
    system.compile(vehicle, items)
    system.compiled_motion = system.compiled is not None and not asked
    return system


def has_friction(vehicle: Vehicle) -> bool:
    """Whether dry friction holds bodies of a vehicle where they have come to."""
    return any(
        law.friction is not None
        for one in vehicle.connections
        if hasattr(one.element, "laws")
        for law in one.element.laws()
    )


def followed_step(vehicle: Vehicle) -> float:
    """Time step [s] of RK44 that follows the vehicle's drives, dampers in series and friction."""
    step = DEFAULT_STEP
    if any(axle.driven for axle in vehicle.wheelsets):
        step = DRIVEN_STEP
    for one in vehicle.connections:
        for law in one.element.laws() if hasattr(one.element, "laws") else ():
            if law.friction is not None:
                # A hold relaxes at |u|/presliding.
                shortest = min(sliding.presliding for sliding in law.friction.slidings)
                step = min(step, RK44_REACH * shortest / FASTEST_SLIDING)
            if law.state is None:
                continue
            # The stroke relaxes at k ds'/dF, k/c for a linear damper.
            yielding = 1.0 / law.damping[0] if law.damping[0] else 0.0
            if law.blow_off is not None:
                points = law.blow_off.points
                yielding = max((b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(points))
            step = min(step, RK44_REACH / (law.stiffness[0] * yielding))
    return max(step, SHORTEST_STEP)


def numbers_of(description: Any) -> Any:
    """A description as plain dictionaries, lists and numbers, for records; profiles by name."""
    if isinstance(description, Profile):
        return description.name
    if is_dataclass(description) and not isinstance(description, type):
        entries = [entry for entry in fields(description) if not entry.name.startswith("_")]
        content = {entry.name: numbers_of(getattr(description, entry.name)) for entry in entries}
        return {"kind": type(description).__name__, **content}
    if isinstance(description, tuple | list):
        return [numbers_of(entry) for entry in description]
    return description
