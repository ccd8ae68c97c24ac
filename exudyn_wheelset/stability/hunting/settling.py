"""When has a simulated motion settled to a limit cycle, and when is it dying out?

One displacement is watched. Each passage through its middle, upward, begins a cycle; the cycle's
amplitude is half of the distance from its lowest to its highest peak. Cycles are averaged in
blocks, and three block means A1, A2, A3 decide. If their differences shrink by the ratio
r = (A3 - A2)/(A2 - A1), the geometric series puts the rest of the way at (A3 - A2) r/(1 - r):

- settled     if that rest is below `tolerance` A3 and the last step is small too;
- dying out   if A3 is below `rest` (and a fifth of where it began), if log A falls steadily and A
              is half of its largest, or if log A falls ever faster over eight blocks;
- undecided   otherwise, e.g. in the slow passage past a fold, where r is about 1.

Amplitudes in m or rad, times in s.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.results.columns import column_index
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.corrector import solve_orbit, speed_row
from exudyn_wheelset.stability.hunting.orbit import DEGREE, INTERVALS, Orbit, orbit_from_samples
from exudyn_wheelset.stability.linear.linearisation import hunting_mode, linearised
from exudyn_wheelset.systems.system import Array, DynamicSystem

SAMPLES = 64
TREND = 8


@dataclass(frozen=True)
class Settling:
    """The criterion.

    tolerance   rest of the way to the limit cycle, relative to the amplitude
    rest        amplitude below which the motion has died out, in the displacement's scale
    block       cycles in a block
    cycles      after so many cycles an undecided motion is taken as it is
    """

    tolerance: float = 1e-3
    rest: float = 0.02
    block: int = 5
    cycles: int = 400

    def __post_init__(self) -> None:
        if not (self.tolerance > 0.0 and self.rest > 0.0):
            raise AnalysisError(
                f"tolerance = {self.tolerance!r} and rest = {self.rest!r} must be positive"
            )
        if self.block < 1 or self.cycles < 3 * self.block:
            raise AnalysisError(
                f"cycles = {self.cycles} must hold at least three blocks of {self.block}"
            )


class Motion:
    """A motion that is simulated on until it is decided.

    state        (n,) at the end of what was simulated
    time         simulated so far [s]
    period       of the last cycles [s]
    means        amplitude of each block [m or rad]
    amplitudes   half of peak to peak of all displacements over the last block (d,)
    """

    def __init__(
        self,
        system: DynamicSystem,
        speed: float,
        state: Array,
        period: float,
        watch: int,
        settling: Settling,
    ) -> None:
        self.system = system
        self.speed = speed
        self.state = np.array(state, dtype=float)
        self.period = period
        self.watch = watch
        self.settling = settling
        self.time = 0.0
        self.cycles = 0
        self.means: list[float] = []
        self.amplitudes = np.zeros(len(system.displacement_indices))
        self.failure = ""

    def advance(self) -> Ending:
        """Simulate one block and judge."""
        settling = self.settling
        span = (settling.block + 1) * self.period
        times = np.linspace(0.0, span, SAMPLES * (settling.block + 1) + 1)
        try:
            states = self.system.simulate(self.state, self.speed, times)
        except WheelsetError as error:
            self.failure = str(error)
            return Ending.CONTACT_LOST
        if not np.all(np.isfinite(states)):
            self.failure = f"the motion at {self.speed:g} m/s is no longer finite"
            return Ending.CONTACT_LOST
        self.state = states[-1].copy()
        self.time += span
        self.cycles += settling.block
        moved = states[:, list(self.system.displacement_indices)]
        self.amplitudes = 0.5 * (moved.max(axis=0) - moved.min(axis=0))
        amplitudes, period = cycle_amplitudes(times, states[:, self.watch])
        if len(amplitudes) == 0:
            signal = states[:, self.watch]
            amplitudes = np.array([0.5 * (signal.max() - signal.min())])
        elif np.isfinite(period):
            self.period = float(np.clip(period, 0.5 * self.period, 2.0 * self.period))
        self.means.append(float(np.mean(amplitudes)))
        return self._judge()

    def decide(self) -> Ending:
        """Simulate until decided, at most the number of cycles allowed."""
        while True:
            verdict = self.advance()
            if verdict is not Ending.UNDECIDED or self.cycles >= self.settling.cycles:
                return verdict

    def _judge(self) -> Ending:
        settling = self.settling
        # A motion that began smaller than the threshold of rest is measured by its beginning.
        rest = settling.rest * self.system.scales[self.watch]
        if self.means[-1] < min(rest, 0.2 * self.means[0]):
            return Ending.DIED_OUT
        if len(self.means) < 4:
            return Ending.UNDECIDED
        first, second, third, fourth = self.means[-4:]
        steps = second - first, third - second, fourth - third
        allowed = settling.tolerance * fourth
        ratios = [abs(b) / max(abs(a), 1e-3 * allowed) for a, b in pairwise(steps)]
        ratio = max(ratios)
        if ratio < 0.98 and abs(steps[2]) * max(1.0, ratio / (1.0 - ratio)) < allowed:
            return Ending.SETTLED
        if max(abs(step) for step in steps) < 0.03 * allowed:
            return Ending.SETTLED
        logs = np.diff(np.log(self.means[-4:]))
        steady = np.all(logs < -0.02) and np.ptp(logs) < 0.05 * abs(logs[2])
        if (steady and fourth < 0.5 * max(self.means)) or self._falls_away():
            return Ending.DIED_OUT
        return Ending.UNDECIDED

    def _falls_away(self) -> bool:
        """Whether the amplitude has fallen over TREND blocks, the faster the lower it is.

        That is how a motion leaves an unstable limit cycle, or the place where a fold has been;
        on the way down to a stable one the fall slows down.
        """
        if len(self.means) < TREND + 1:
            return False
        logs = np.diff(np.log(self.means[-TREND - 1 :]))
        first, second = np.sum(logs[: TREND // 2]), np.sum(logs[TREND // 2 :])
        return bool(np.all(logs < 0.0) and second < 1.1 * first and first + second < -0.01)


def watched_index(system: DynamicSystem, watch: str | int | None = None) -> int:
    """State whose peaks are watched: by name or index; else the first lateral displacement.

    That is the first wheelset's where the system knows its wheelsets. Elsewhere lateral means a
    name that begins with y (after the body's name and a colon); without one it is the first
    displacement.
    """
    if isinstance(watch, str):
        return column_index(system.state_names, watch)
    if watch is not None:
        return int(watch)
    if system.lateral_indices:
        return system.lateral_indices[0]
    for index in system.displacement_indices:
        name = system.state_names[index].split(": ")[-1].split(" [")[0]
        if name == "y" or name.startswith("y_"):
            return index
    return system.displacement_indices[0]


def cycle_amplitudes(times: Array, signal: Array) -> tuple[Array, float]:
    """Amplitude of each whole cycle of a signal (m,), and the mean period [s] (nan if none).

    Cycles run between upward passages of the middle of the signal. Peaks are those of the
    parabola through the highest sample and its neighbours.
    """
    middle = 0.5 * (signal.max() + signal.min())
    above = signal > middle
    upward = np.flatnonzero(~above[:-1] & above[1:])
    if len(upward) < 2:
        return np.empty(0), np.nan
    amplitudes = []
    for start, end in pairwise(upward):
        piece = slice(start, end + 2)
        amplitudes.append(0.5 * (_peak(signal[piece]) + _peak(-signal[piece])))
    fraction = (middle - signal[upward]) / (signal[upward + 1] - signal[upward])
    passages = times[upward] + fraction * (times[upward + 1] - times[upward])
    return np.array(amplitudes), float((passages[-1] - passages[0]) / (len(passages) - 1))


def orbit_near(
    system: DynamicSystem,
    state: Array,
    speed: float,
    period: float | None = None,
    watch: str | int | None = None,
    settling: Settling | None = None,
    intervals: int = INTERVALS,
    degree: int = DEGREE,
) -> Orbit:
    """The limit cycle that the motion from a state (n,) settles to, to Newton's accuracy.

    `period` [s] is a rough guess, taken from the least damped mode if left out. Raises
    AnalysisError if the motion dies out or leaves the model, or if Newton does not converge.
    """
    index = watched_index(system, watch)
    period = period or typical_period(system, speed)
    motion = Motion(system, speed, state, period, index, settling or Settling())
    verdict = motion.decide()
    if verdict in (Ending.DIED_OUT, Ending.CONTACT_LOST):
        raise AnalysisError(
            f"no limit cycle at {speed:g} m/s from this state: {verdict.sentence} after "
            f"{motion.time:.3g} s{': ' + motion.failure if motion.failure else ''}; start from "
            "a larger disturbance or another speed"
        )
    times = np.linspace(0.0, 2.2 * motion.period, 1 + round(2.2 * 400))
    states = system.simulate(motion.state, speed, times)
    signal = states[:, index]
    middle = 0.5 * (signal.max() + signal.min())
    start = int(np.flatnonzero((signal[:-1] <= middle) & (signal[1:] > middle))[0])
    # The period is where the motion comes closest to a state on the cycle.
    apart = np.linalg.norm((states[start:] - states[start]) / system.scales, axis=1)
    low, high = np.searchsorted(times, times[start] + np.array([0.7, 1.3]) * motion.period) - start
    back = low + int(np.argmin(apart[low:high]))
    count = intervals * degree
    cycle = system.simulate(
        states[start], speed, np.linspace(0.0, times[start + back] - times[start], count + 1)
    )
    length = times[start + back] - times[start]
    guess = orbit_from_samples(cycle, length, speed, intervals, degree)
    equations = Collocation(system, length, max(1.0, abs(speed)))
    row = speed_row(guess, len(system.scales))
    return solve_orbit(equations, guess, row, tolerance=1e-8, iterations=40).orbit


def typical_period(system: DynamicSystem, speed: float) -> float:
    """Period [s] of the least damped hunting mode about the equilibrium at a speed [m/s].

    Of the least damped oscillation where no mode hunts. Raises AnalysisError if nothing oscillates.
    """
    return 2.0 * np.pi / abs(hunting_mode(linearised(system, speed))[0].imag)


def _peak(values: Array) -> float:
    index = int(np.argmax(values))
    if index in (0, len(values) - 1):
        return float(values[index])
    below, middle, above = values[index - 1 : index + 2]
    curvature = below - 2.0 * middle + above
    return float(middle - 0.125 * (above - below) ** 2 / curvature) if curvature else float(middle)
