"""When has a simulated motion settled to hunting, and when is it dying out?

A displacement is watched for each truck. Each passage through its middle, upward, begins a cycle;
the cycle's amplitude is half of the distance from its lowest to its highest peak. Cycles are
averaged in blocks, and block means A1, A2, A3 decide. If their differences shrink by the ratio
r = (A3 - A2)/(A2 - A1), the geometric series puts the rest of the way at (A3 - A2) r/(1 - r):

- settled     if that rest is below `tolerance` A3 and the last step is small too, or if the means
              go up and down (trucks that hunt at different frequencies beat) and neither their
              average nor their range over BEAT blocks differs from that of the BEAT blocks before;
- dying out   if A3 is below `rest` (and a fifth of where it began), or if A is below FAR_DOWN of
              its largest and log A falls steadily, or ever faster over eight blocks: a motion
              that leaves a large cycle may yet settle on a small one;
- undecided   otherwise, e.g. in the slow passage past a fold, where r is about 1.

On a straight tread motion is nearly linear, and below the critical speed a large one falls for
hundreds of cycles at one steady rate. What is undecided after all its cycles and falls so is
probed: its deviation from the equilibrium is cut to LEAP of it, again and again. If it falls at
every size down to rest it dies out; if a smaller one grows or settles, it goes to that cycle.

The vehicle has settled when every truck has settled or died out, one of them hunting, and it has
died out when all trucks have. Amplitudes in m or rad, times in s.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.systems.system import DynamicSystem

SAMPLES = 64
TREND = 8
# Blocks over which a beating amplitude is averaged, and what its averages and ranges may differ by.
BEAT = 10
BEAT_MEAN, BEAT_RANGE = 0.01, 0.2
# Share of the largest amplitude below which no smaller cycle is expected: wheelsets on S1002 have
# cycles of 2.4 and 0.06 mm at one speed.
FAR_DOWN = 0.01
# A falling motion is cut to this share of itself to see whether it falls there too, and watched for
# so many blocks; the first still hold what the cut itself has stirred.
LEAP, LEAP_BLOCKS, STIRRED = 0.3, 12, 3
# Least fall over the second half of a motion that says where it goes.
SHOWN = 0.03
# Share of the amplitude of rest that is no motion but the integrator's error.
ROUNDING = 1e-4
# A motion that falls when its cycles are over is followed for so many times them.
PATIENCE = 3
# Least fall over TREND blocks, relative.
FALLEN = 2e-3
# A truck below the amplitude of rest and this share of another's does not hunt by itself.
SHAKEN = 0.1


@spelt_class
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


class WatchedMotion:
    """A motion that is simulated on until it is decided.

    state        (n,) at the end of what was simulated
    time         simulated so far [s]
    period       of the last cycles [s]
    means        amplitude of each block [m or rad] of the truck that moves most
    by_truck     amplitude of each block [m or rad] by truck
    hunting      whether each truck hunts, once decided
    amplitudes   half of peak to peak of all displacements over the last block (d,)
    floors       amplitude [m or rad] below which a truck does not hunt, where it stays there for
                 two blocks; it need not settle then
    """

    def __init__(
        self,
        system: DynamicSystem,
        speed: float,
        state: Array,
        period: float,
        watched: Mapping[str, int],
        settling: Settling,
        floors: Mapping[str, float] | None = None,
    ) -> None:
        self.system = system
        self.speed = speed
        self.state = np.array(state, dtype=float)
        self.period = period
        self.watched = dict(watched)
        self.settling = settling
        self.floors = dict(floors or {})
        self.time = 0.0
        self.cycles = 0
        self.by_truck: dict[str, list[float]] = {name: [] for name in watched}
        self.hunting: dict[str, bool] = dict.fromkeys(watched, True)
        self.amplitudes = np.zeros(len(system.displacement_indices))
        self.failure = ""

    @property
    def means(self) -> list[float]:
        """Amplitude of each block of the truck that moves most in the last one."""
        return max(self.by_truck.values(), key=lambda means: means[-1] if means else 0.0)

    def advance(self) -> Ending:
        """Simulate one block and judge."""
        settling = self.settling
        times = self._times((settling.block + 1) * self.period)
        try:
            states = self.system.simulate(self.state, self.speed, times)
        except WheelsetError as error:
            self.failure = str(error)
            return Ending.CONTACT_LOST
        if not np.all(np.isfinite(states)):
            self.failure = f"the motion at {self.speed:g} m/s is no longer finite"
            return Ending.CONTACT_LOST
        self.state = self.system.held(states, self.speed)
        self.time += float(times[-1])
        self.cycles += settling.block
        moved = states[:, list(self.system.displacement_indices)]
        self.amplitudes = 0.5 * (moved.max(axis=0) - moved.min(axis=0))
        largest = 0.0
        for name, index in self.watched.items():
            signal = states[:, index]
            amplitudes, period = cycle_amplitudes(times, signal)
            if not len(amplitudes):
                amplitudes = np.array([0.5 * (signal.max() - signal.min())])
            self.by_truck[name].append(float(np.mean(amplitudes)))
            if self.by_truck[name][-1] > largest and np.isfinite(period):
                largest = self.by_truck[name][-1]
                following = float(np.clip(period, 0.5 * self.period, 2.0 * self.period))
        if largest > 0.0:
            self.period = following
        return self._judge()

    def _times(self, span: float) -> Array:
        """Equal sample times from 0 over a span [s], at whole time steps where they are short."""
        interval, step = self.period / SAMPLES, self.system.step
        if 0.0 < step < interval:
            interval = step * np.floor(interval / step * (1.0 + 1e-9))
        return interval * np.arange(int(np.ceil(span / interval - 1e-9)) + 1)

    def decide(self, needed: Collection[str] = ()) -> Ending:
        """Simulate until decided, at most the number of cycles allowed.

        needed: trucks without which the rest is not of interest; it is undecided as soon as one of
        them does not hunt.
        """
        while True:
            verdict = self.advance()
            if verdict is not Ending.UNDECIDED:
                return verdict
            if not all(self.hunting[name] for name in needed):
                return verdict
            if self.cycles < self.settling.cycles:
                continue
            falling = [means for name, means in self.by_truck.items() if self.hunting[name]]
            # A fall may end on a cycle further down: it is followed while it goes on.
            if self.cycles < PATIENCE * self.settling.cycles and all(map(_falls, falling)):
                continue
            if all(map(_falls_away, self.by_truck.values())):
                return Ending.DIED_OUT
            return self._probe() if all(map(_falls_steadily, falling)) else verdict

    def _probe(self) -> Ending:
        """Whether a motion that falls steadily falls at all smaller sizes too.

        It becomes the smaller motion where that does not fall.
        """
        system, speed = self.system, self.speed
        rest = system.equilibrium(speed)
        state, period, time = self.state, self.period, self.time
        while True:
            smaller = rest + LEAP * (state - rest)
            probe = WatchedMotion(system, speed, smaller, period, self.watched, self.settling)
            for _ in range(LEAP_BLOCKS):
                verdict = probe.advance()
                if verdict is not Ending.UNDECIDED:
                    break
            time += probe.time
            if verdict is Ending.CONTACT_LOST:
                return Ending.UNDECIDED
            fell = all(
                means[-1] < means[min(STIRRED, len(means) - 1)] for means in probe.by_truck.values()
            )
            low = all(
                means[-1] < self.settling.rest * system.scales[self.watched[name]]
                for name, means in probe.by_truck.items()
            )
            if verdict is Ending.DIED_OUT or (verdict is Ending.UNDECIDED and fell and low):
                self.time = time
                return Ending.DIED_OUT
            if verdict is Ending.UNDECIDED and fell:
                state, period = probe.state, probe.period
                continue
            while verdict is Ending.UNDECIDED and probe.cycles < self.settling.cycles:
                before, verdict = probe.time, probe.advance()
                time += probe.time - before
            if verdict is Ending.CONTACT_LOST:
                return Ending.UNDECIDED
            self.__dict__.update(probe.__dict__ | {"floors": self.floors, "time": time})
            return verdict

    def truck_amplitudes(self) -> dict[str, float]:
        """Mean amplitude [m or rad] of each truck, over the beat if it beats."""
        found = {}
        for name, means in self.by_truck.items():
            late = means[-BEAT:] if _beats(means) else means[-1:]
            found[name] = float(np.mean(late))
        return found

    def _judge(self) -> Ending:
        verdicts = {}
        largest = self.means[-1]
        for name, means in self.by_truck.items():
            rest = self.settling.rest * self.system.scales[self.watched[name]]
            verdicts[name] = _judge(means, rest, self.settling.tolerance)
            # A truck that another one shakes a little does not hunt.
            shaken = means[-1] < min(rest, SHAKEN * largest)
            low = len(means) > 1 and max(means[-2:]) < self.floors.get(name, 0.0)
            self.hunting[name] = verdicts[name] is not Ending.DIED_OUT and not (shaken or low)
        if not any(self.hunting.values()):
            return Ending.DIED_OUT
        if any(
            verdict is Ending.UNDECIDED and self.hunting[name] for name, verdict in verdicts.items()
        ):
            return Ending.UNDECIDED
        return Ending.SETTLED


def _judge(means: list[float], rest: float, tolerance: float) -> Ending:
    """What the block means of one truck say; rest: the amplitude that counts as none."""
    # A motion that began smaller than the threshold of rest is measured by its beginning; what
    # simulations leave of rest, by the threshold.
    if means[-1] < min(rest, max(0.2 * means[0], ROUNDING * rest)):
        return Ending.DIED_OUT
    if len(means) < 4:
        return Ending.UNDECIDED
    first, second, third, fourth = means[-4:]
    steps = second - first, third - second, fourth - third
    allowed = tolerance * fourth
    ratios = [abs(b) / max(abs(a), 1e-3 * allowed) for a, b in pairwise(steps)]
    ratio = max(ratios)
    if ratio < 0.98 and abs(steps[2]) * max(1.0, ratio / (1.0 - ratio)) < allowed:
        return Ending.SETTLED
    if max(abs(step) for step in steps) < 0.03 * allowed or _beats(means):
        return Ending.SETTLED
    logs = np.diff(np.log(means[-4:]))
    steady = np.all(logs < -0.02) and np.ptp(logs) < 0.05 * abs(logs[2])
    if fourth < FAR_DOWN * max(means) and (steady or _falls_away(means)):
        return Ending.DIED_OUT
    return Ending.UNDECIDED


def _beats(means: list[float]) -> bool:
    """Whether the amplitude goes up and down about a level that stays."""
    if len(means) < 2 * BEAT:
        return False
    before, after = np.array(means[-2 * BEAT : -BEAT]), np.array(means[-BEAT:])
    steps = np.diff(means[-2 * BEAT :])
    level = float(np.mean(after))
    turns = np.count_nonzero(steps[:-1] * steps[1:] < 0.0)
    same_level = abs(level - float(np.mean(before))) < BEAT_MEAN * level
    ranges = float(np.ptp(before)), float(np.ptp(after))
    return bool(turns >= 2 and same_level and abs(ranges[1] - ranges[0]) < BEAT_RANGE * max(ranges))


def _falls(means: list[float]) -> bool:
    """Whether the amplitude has fallen in each of the last TREND steps, by more than rounding."""
    if len(means) < TREND + 1:
        return False
    logs = np.diff(np.log(means[-TREND - 1 :]))
    return bool(np.all(logs < 0.0) and np.sum(logs) < -FALLEN)


def _falls_away(means: list[float]) -> bool:
    """Whether the amplitude has fallen over TREND blocks, the faster the lower it is.

    That is how a motion leaves an unstable limit cycle, or the place where a fold has been; on the
    way down to a stable one the fall slows down.
    """
    if len(means) < TREND + 1:
        return False
    logs = np.diff(np.log(means[-TREND - 1 :]))
    first, second = np.sum(logs[: TREND // 2]), np.sum(logs[TREND // 2 :])
    return bool(np.all(logs < 0.0) and second < 1.1 * first and first + second < -0.01)


def _falls_steadily(means: list[float]) -> bool:
    """Whether the amplitude falls in every block of the second half, towards less than half.

    With dA/dt = -k (A - A*) the rates of log A at two amplitudes give A*: at A* = A2/2 their ratio
    is 0.5/(1 - 0.5 A2/A1). The amplitudes are those in the middle of the third and last quarter.
    """
    quarter = len(means) // 4
    if quarter < 2:
        return False
    logs = np.log(means[-2 * quarter - 1 :])
    if np.any(np.diff(logs) >= 0.0) or logs[0] - logs[-1] < SHOWN:
        return False
    first, second = logs[0] - logs[quarter], logs[quarter] - logs[-1]
    share = float(np.exp(-0.5 * (first + second)))
    return bool(second / first > 0.5 / (1.0 - 0.5 * share))


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


def _peak(values: Array) -> float:
    index = int(np.argmax(values))
    if index in (0, len(values) - 1):
        return float(values[index])
    below, middle, above = values[index - 1 : index + 2]
    curvature = below - 2.0 * middle + above
    return float(middle - 0.125 * (above - below) ** 2 / curvature) if curvature else float(middle)
