"""Quasi-static descent: the lowest speed at which hunting survives, by simulation alone.

From a speed above the linear critical one, where the vehicle hunts, the speed falls in small
steps. Each run starts from the last state of the one before and is simulated until its peaks have
settled (see `settling`). The first speed at which the motion of a truck dies out lies beyond its
jump, the fold of the limit cycle; the interval between it and the last speed at which that truck
hunted is bisected, each time from the last state that hunted. Where others still hunt the descent
goes on. It is the way a test on a roller rig finds the same number, and independent of collocation
and continuation. Spins and speed of a vehicle follow the speed, and what it loses by hunting is
made up for (`DynamicSystem.carry_over`, `held`).

Only stable motion is seen, and only the one that the first state leads to. Just below the fold a
motion lingers before it dies out, so the criterion of settling sets what can be resolved.

Speeds in m/s; amplitudes are half of peak to peak in m or rad.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import finite_array, positive
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.columns import NamedColumns
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.results.records import describe
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.hunting.descent_result import Descent
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion
from exudyn_wheelset.stability.hunting.watching import typical_period, watched_trucks
from exudyn_wheelset.stability.linear.linearisation import hunting_mode, linearised
from exudyn_wheelset.stability.subject import as_system
from exudyn_wheelset.systems.speeds import checked_speed
from exudyn_wheelset.systems.system import DynamicSystem

# A fall to less than a third, to less than a tenth of the scale (0.1 mm), is the end of hunting:
# wheelsets on S1002 have a ripple of 0.05 mm where nothing else lives.
FALL, RIPPLE = 1.0 / 3.0, 0.1
# Steps this many times as long are taken where a block of cycles shows a difference of less than
# this part of the tolerance of settling.
COARSER, STEP_SHARE = 2.0, 0.1


@spelt
def quasi_static_descent(
    vehicle: Any,
    high: float,
    low: float,
    *,
    step: float = 0.5,
    tolerance: float = 0.05,
    state: Sequence[float] | Array | None = None,
    disturbance: float = 2.0,
    watch: str | int | None = None,
    settling: Settling | None = None,
    state_file: str | Path | None = None,
    progress: bool = False,
) -> Descent:
    """Follow hunting down from `high` to its jump, not below `low` [m/s].

    step         of the speed before the jump [m/s]
    tolerance    width of the interval that holds the jump in the end [m/s]
    state        (n,) to start from; else the equilibrium at `high` and the least damped mode,
                 `disturbance` times its scale large
    watch        displacement whose peaks decide (name or index; default the lateral displacement
                 of each truck's first wheelset)
    settling     criterion on the peaks
    state_file   kept up to date after each finished speed; if it exists, the run goes on from it

    A keyboard interrupt ends the run with what is finished. Raises AnalysisError if the vehicle
    does not hunt at `high`, or if the state file belongs to another run.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_wheelset import FunctionSystem, quasi_static_descent
    >>> def fold(state, speed):  # hunts from 1 m/s, and down to 0.75 m/s after a disturbance
    ...     x, y = state
    ...     growth = speed - 1 + (x * x + y * y) - (x * x + y * y) ** 2
    ...     return np.array([growth * x - 6 * y, 6 * x + growth * y])
    ...
    >>> system = FunctionSystem("fold", fold, ["x [m]", "y [m]"], [1e-2, 1e-2])
    >>> descent = quasi_static_descent(system, 0.9, 0.6, step=0.05, disturbance=100)
    >>> abs(descent.speed - 0.75) < 0.05
    True
    """
    system = as_system(vehicle)
    high, low = checked_speed(system, "high", high), checked_speed(system, "low", low)
    step, tolerance = positive("step", step, "m/s"), positive("tolerance", tolerance, "m/s")
    if not low < high:
        raise AnalysisError(
            f"high = {high:g} m/s, low = {low:g} m/s: the speed falls, give a high above the low"
        )
    disturbance = positive("disturbance", disturbance, "times the scale of the mode")
    if state is not None:
        state = finite_array("state", state, "SI units")
        if state.shape != (len(system.state_names),):
            raise AnalysisError(
                f"state of the shape {state.shape}: give the {len(system.state_names)} states of "
                f"{system.name}"
            )
    if not isinstance(settling, Settling | None):
        raise AnalysisError(f"settling = {settling!r}: give a Settling(...) or leave it out")
    settling = settling or Settling()
    watched = watched_trucks(system, watch)
    run = _Run(system, watched, settling, high, low, step, tolerance)
    if state_file is not None and Path(state_file).with_suffix(".npz").exists():
        run.resume(Path(state_file).with_suffix(".npz"))
    with tqdm(disable=not progress, unit="speed", desc="descent", initial=len(run)) as bar:
        try:
            if not len(run):
                run.begin(state, disturbance)
                run.write(state_file)
            while run.outcome is None:
                bar.set_postfix_str(run.progress())
                run.advance()
                run.write(state_file)
                bar.update()
        except KeyboardInterrupt:
            if not len(run):
                raise
            run.outcome = Outcome(Ending.INTERRUPTED, "run again with the same state file to go on")
    return run.result()


class _Run:
    def __init__(
        self,
        system: DynamicSystem,
        watched: dict[str, int],
        settling: Settling,
        high: float,
        low: float,
        step: float,
        tolerance: float,
    ) -> None:
        self.system, self.watched, self.settling = system, watched, settling
        self.coarseness = 1.0
        self.high, self.low, self.step, self.tolerance = high, low, step, tolerance
        self.settings = {
            **asdict(settling),
            "watch": [system.state_names[index] for index in watched.values()],
            "high": high,
            "low": low,
            "step": step,
            "descent_tolerance": tolerance,
        }
        self.record = describe(system, "descent", self.settings)
        self.speeds: list[float] = []
        self.amplitudes: list[Array] = []
        self.trucks: list[list[float]] = []
        self.periods: list[float] = []
        self.settled: list[bool] = []
        self.states: list[Array] = []
        self.stops: dict[str, tuple[float, float]] = {}
        self.jumped = np.nan
        self.time = 0.0
        self.outcome: Outcome | None = None

    def __len__(self) -> int:
        return len(self.speeds)

    def begin(self, state: Sequence[float] | Array | None, disturbance: float) -> None:
        system, speed = self.system, self.high
        if state is None:
            state = mode_disturbance(system, speed, disturbance)
        start = np.asarray(state, dtype=float)
        motion = self._motion(speed, start, typical_period(system, speed))
        verdict = motion.decide()
        if verdict in (Ending.DIED_OUT, Ending.CONTACT_LOST):
            died = verdict is Ending.DIED_OUT
            mend = "higher speed or with a larger" if died else "lower speed or with a smaller"
            raise AnalysisError(
                f"{system.name} does not hunt at {speed:g} m/s: {verdict.sentence} after "
                f"{motion.time:.3g} s{': ' + motion.failure if motion.failure else ''}; begin at a "
                f"{mend} disturbance"
            )
        self._keep(speed, motion, verdict is Ending.SETTLED)
        self._choose_step(0)

    def advance(self) -> None:
        """Run the next speed, of the descent or of a bisection."""
        last = self._last(self._hunting())
        above = self.speeds[last]
        speed = above - self.step if np.isnan(self.below) else 0.5 * (above + self.below)
        speed = max(speed, self.low)
        state = self.system.carry_over(self.states[last], above, speed)
        begins = np.isnan(self.below)
        motion = self._motion(speed, state, self.periods[last], self.trucks[last])
        # Within a bracket one truck's verdict is all that is asked.
        needed = frozenset[str]() if begins else self._hunting()
        with self.system.coarser(self.coarseness):
            verdict = motion.decide(needed)
        if verdict is Ending.CONTACT_LOST:
            self.time += motion.time
            self.outcome = Outcome(Ending.CONTACT_LOST, f"at {speed:.4f} m/s: {motion.failure}")
            return
        sizes = motion.truck_amplitudes()
        for name, floor in motion.floors.items():
            motion.hunting[name] = motion.hunting[name] and sizes[name] >= floor
        if begins and not all(motion.hunting[name] for name in self._hunting()):
            used = self.coarseness
            self._choose_step(last)
            if self.coarseness < used:
                return
        if verdict is Ending.DIED_OUT or not any(motion.hunting.values()):
            self.time += motion.time
            self.jumped = speed
        else:
            self._keep(speed, motion, verdict is Ending.SETTLED)
        self._finish()

    def progress(self) -> str:
        if np.isnan(self.below):
            return f"hunting at {min(self.speeds):.2f} m/s"
        return f"jump between {self.below:.3f} and {self._above():.3f} m/s"

    @property
    def below(self) -> float:
        """Highest speed known at which a truck of those that hunt has died out; nan if none."""
        alive = self._hunting()
        others = [
            speed
            for speed, row in zip(self.speeds, self.trucks, strict=True)
            if self._alive(row) != alive and speed < self._above()
        ]
        known = [*others, *([] if np.isnan(self.jumped) else [self.jumped])]
        return max(known) if known else np.nan

    def result(self) -> Descent:
        names = [self.system.state_names[index] for index in self.system.displacement_indices]
        return Descent(
            speeds=np.array(self.speeds),
            amplitude=NamedColumns(np.array(self.amplitudes), names),
            trucks=NamedColumns(np.array(self.trucks), list(self.watched)),
            period=np.array(self.periods),
            settled=np.array(self.settled, dtype=bool),
            states=np.array(self.states),
            stops=dict(self.stops),
            jumped=float(self.jumped),
            time=self.time,
            outcome=self.outcome or Outcome(Ending.UNDECIDED, "the descent goes on"),
            record=self.record,
        )

    def write(self, path: str | Path | None) -> None:
        if path is not None:
            self.result().save(Path(path).with_suffix(".npz"))

    def resume(self, path: Path) -> None:
        """Take over what a file holds; a run to a finer tolerance may go on from a coarser one."""
        kept = Descent.load(path)
        known = {**kept.record.get("settings", {}), "descent_tolerance": self.tolerance}
        if kept.record.get("system") != self.system.name or known != _as_stored(self.settings):
            raise AnalysisError(
                f"{path}: belongs to {kept.record.get('system')!r} with other settings; give "
                "another state file or remove it"
            )
        parameters = _as_stored(self.record).get("parameters")
        if kept.record.get("parameters") != parameters:
            raise AnalysisError(
                f"{path}: belongs to a vehicle with other parameters; give another state file"
            )
        self.speeds = kept.speeds.tolist()
        self.amplitudes = list(np.asarray(kept.amplitude))
        self.trucks = np.asarray(kept.trucks).tolist()
        self.periods = kept.period.tolist()
        self.settled = kept.settled.tolist()
        self.states = list(kept.states)
        self.jumped, self.time = kept.jumped, kept.time
        self._finish()
        if self.outcome is None:
            self._choose_step(len(self) - 1)

    def _motion(
        self, speed: float, state: Array, period: float, before: Sequence[float] = ()
    ) -> WatchedMotion:
        """The motion at a speed; before: amplitude of each truck in the run that it begins from.

        A truck that falls from a cycle to a ripple does not hunt, nor one that did not before and
        moves no more than that.
        """
        floors = {}
        for (name, index), size in zip(self.watched.items(), before, strict=False):
            ripple = RIPPLE * float(self.system.scales[index])
            floors[name] = min(ripple, FALL * size) if size > 0.0 else ripple
        return WatchedMotion(self.system, speed, state, period, self.watched, self.settling, floors)

    def _choose_step(self, run: int) -> None:
        """Take longer time steps if they show the motion of a run the same, else the usual ones."""
        sizes = []
        for factor in (1.0, COARSER):
            with self.system.coarser(factor) as chosen:
                if not chosen:
                    return
                motion = self._motion(self.speeds[run], self.states[run], self.periods[run])
                self.coarseness = 1.0
                if motion.advance() is Ending.CONTACT_LOST:
                    return
            sizes.append(np.array([means[-1] for means in motion.by_truck.values()]))
        allowed = STEP_SHARE * self.settling.tolerance * float(np.max(sizes[0]))
        if float(np.max(np.abs(sizes[1] - sizes[0]))) < allowed:
            self.coarseness = COARSER

    def _keep(self, speed: float, motion: WatchedMotion, settled: bool) -> None:
        self.speeds.append(speed)
        self.amplitudes.append(motion.amplitudes)
        sizes = motion.truck_amplitudes()
        self.trucks.append([sizes[name] if motion.hunting[name] else 0.0 for name in self.watched])
        self.periods.append(motion.period)
        self.settled.append(settled)
        self.states.append(motion.state)
        self.time += motion.time

    def _alive(self, row: list[float]) -> frozenset[str]:
        return frozenset(
            name for name, amplitude in zip(self.watched, row, strict=True) if amplitude > 0.0
        )

    def _hunting(self) -> frozenset[str]:
        """Trucks that hunt and have not been found to stop yet."""
        return self._alive(self.trucks[0]) - frozenset(self.stops)

    def _last(self, alive: frozenset[str]) -> int:
        """The run at the lowest speed at which these trucks hunt."""
        runs = [k for k, row in enumerate(self.trucks) if alive <= self._alive(row)]
        return min(runs, key=lambda k: self.speeds[k])

    def _above(self) -> float:
        return self.speeds[self._last(self._hunting())]

    def _finish(self) -> None:
        """Note the trucks that are found to stop, and the end."""
        while True:
            above, below = self._above(), self.below
            if np.isnan(below):
                if above <= self.low:
                    self.outcome = Outcome(Ending.STILL_HUNTING, f"{self.low:g} m/s")
                return
            if above - below > self.tolerance * (1.0 + 1e-9):
                return
            left = frozenset[str]()
            if below in self.speeds:
                left = self._alive(self.trucks[self.speeds.index(below)]) & self._hunting()
            for name in self._hunting() - left:
                self.stops[name] = (below, above)
            if not left:
                self.outcome = Outcome(
                    Ending.JUMP_FOUND, f"between {below:.4f} and {above:.4f} m/s"
                )
                return


def mode_disturbance(system: DynamicSystem, speed: float, size: float) -> Array:
    """State (n,): equilibrium plus the least damped hunting mode, `size` times its scale."""
    linear = linearised(system, speed)
    _, mode = hunting_mode(linear)
    displacements = list(system.displacement_indices)
    relative = np.abs(mode / system.scales)[displacements]
    leading = displacements[int(np.argmax(relative))]
    mode = mode * (system.scales[leading] / mode[leading])
    return np.asarray(linear.state + size * mode.real)


def _as_stored(values: Any) -> Any:
    """Values as they come back from a file: tuples as lists, keys as text."""
    return json.loads(json.dumps(values, default=str))
