"""Disturbance runs: how large must a one-off lateral disturbance be to set off hunting?

Below the linear critical speed the straight run and the limit cycle may both be stable. At each
speed the vehicle starts from its equilibrium with one displacement, velocity or mode disturbed,
and is simulated until the peaks of a watched displacement say whether it hunts or dies out. The
amplitude between the two is found by bisection. Two motions from either side of the edge stay
together near the unstable limit cycle before one grows and one dies; their peaks where they part
are a second, simulated value of the unstable branch.

Speeds in m/s; disturbances in the unit of the disturbed state.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
from tqdm import tqdm

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import finite_array, number, positive
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.results.columns import column_index
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.results.records import describe, read_record, write_record
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.hunting.descent import mode_disturbance
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion
from exudyn_wheelset.stability.hunting.watching import typical_period, watched_index, watched_trucks
from exudyn_wheelset.stability.subject import as_system
from exudyn_wheelset.systems.speeds import checked_speed
from exudyn_wheelset.systems.system import DynamicSystem

KIND = "disturbance runs"
Fate = Literal["hunts", "dies out", "lost contact"]

# Growth of the block means over three blocks that decides for hunting before it has settled.
GROWTH = 0.15


@brief
@dataclass(frozen=True, eq=False)
class CriticalDisturbances:
    """Smallest disturbance that leads to hunting, over speed.

    speeds      (k,) [m/s]
    critical    (k,) disturbance between the bracket's ends, in the unit of the disturbed state;
                inf if the largest and seven smaller ones (steps of 0.7) die out, 0 if even
                the smallest hunts
    bracket     (k, 2) largest that died out and smallest that hunted
    edge        (k,) amplitude (half of peak to peak) of the watched displacement where the two
                motions of the bracket part: the unstable limit cycle; nan if unknown
    runs        number of simulations
    time        simulated in total [s]
    direction   what was disturbed
    outcome     how it ended; `reason` says it in words
    method      "disturbance runs"
    record      system, parameters, versions, settings
    """

    speeds: Array
    critical: Array
    bracket: Array
    edge: Array
    runs: int
    time: float
    direction: str
    outcome: Outcome
    method: str = "disturbance runs"
    record: dict[str, Any] = field(default_factory=dict)

    @property
    def reason(self) -> str:
        """Why it ended, in words."""
        return str(self.outcome)

    def save(self, path: str | Path) -> Path:
        """Write to one .npz file, atomically; returns the path."""
        record = {
            **self.record,
            "kind": KIND,
            "outcome": self.outcome.record(),
            **{name: getattr(self, name) for name in ("runs", "time", "direction")},
        }
        arrays = {name: getattr(self, name) for name in _ARRAYS}
        return write_record(path, arrays, record)

    @classmethod
    def load(cls, path: str | Path) -> CriticalDisturbances:
        """The runs of a file; raises AnalysisError if it does not hold any."""
        arrays, record = read_record(path, KIND)
        fields: dict[str, Any] = {name: arrays[name] for name in _ARRAYS}
        fields |= {name: record[name] for name in ("runs", "time", "direction")}
        return cls(**fields, outcome=Outcome.read(record["outcome"]), record=record)

    def plot(self, ax: Any, factor: float = 1.0, **style: Any) -> Any:
        """Draw the amplitudes at the edge as crosses; returns the axes."""
        style = {"marker": "x", "linestyle": "none", "label": "disturbance runs", **style}
        ax.plot(self.speeds, factor * self.edge, **style)
        return ax


_ARRAYS = ("speeds", "critical", "bracket", "edge")


@spelt
def critical_disturbance(
    vehicle: Any,
    speeds: float | Sequence[float] | Array,
    largest: float,
    *,
    smallest: float | None = None,
    direction: str | int | Sequence[float] | Array | None = None,
    tolerance: float = 0.01,
    watch: str | int | None = None,
    settling: Settling | None = None,
    progress: bool = False,
) -> CriticalDisturbances:
    """Critical amplitude of a one-off disturbance at each of `speeds` [m/s], by bisection.

    direction   the disturbed state, by name or index (an offset or a velocity; default the first
                lateral displacement); "mode" for the least damped mode (amplitude in units of
                its largest displacement's scale); or a vector (n,) that the amplitude multiplies
    largest     disturbance tried [unit of the disturbed state]
    smallest    disturbance tried; default `largest`/1000
    tolerance   relative width of the bracket in the end
    watch       displacement whose peaks decide

    Loss of contact or derailment counts as hunting: it is what must not happen. A keyboard
    interrupt ends it with the speeds that are finished. Raises AnalysisError for a direction that
    the system does not have.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_wheelset import FunctionSystem, critical_disturbance
    >>> def fold(state, speed):  # hunts from 1 m/s, and down to 0.75 m/s after a disturbance
    ...     x, y = state
    ...     growth = speed - 1 + (x * x + y * y) - (x * x + y * y) ** 2
    ...     return np.array([growth * x - 6 * y, 6 * x + growth * y])
    ...
    >>> system = FunctionSystem("fold", fold, ["x [m]", "y [m]"], [1e-2, 1e-2])
    >>> runs = critical_disturbance(system, 0.9, largest=1.0, direction=0, tolerance=0.05)
    >>> runs.critical.round(1)  # the unstable cycle: x^2 = (1 - sqrt(0.6))/2
    array([0.3])
    """
    system = as_system(vehicle)
    values = np.atleast_1d(finite_array("speeds", speeds, "m/s"))
    if values.ndim > 1:
        raise AnalysisError(f"speeds of the shape {values.shape}: give one number or a list [m/s]")
    for speed in values:
        checked_speed(system, "one of speeds", float(speed))
    largest = positive("largest", largest, "(unit of the disturbed state)")
    if smallest is None:
        smallest = 1e-3 * largest
    smallest = number("smallest", smallest, "(unit of the disturbed state)")
    tolerance = number("tolerance", tolerance, "-")
    if not 0.0 < smallest < largest or not 0.0 < tolerance < 1.0:
        raise AnalysisError(
            f"smallest = {smallest:g} must lie between 0 and largest = {largest:g}, tolerance = "
            f"{tolerance:g} between 0 and 1"
        )
    settling = settling or Settling(block=3)
    watched = watched_trucks(system, watch)
    label = _label(system, direction)
    rows: list[tuple[float, float, float, float]] = []
    runs, time, outcome = 0, 0.0, Outcome(Ending.FINISHED)
    try:
        for speed in tqdm(values, disable=not progress, unit="speed", desc="disturbances"):
            search = _Search(system, float(speed), direction, watched, settling)
            rows.append(search.bisect(smallest, largest, tolerance))
            runs, time = runs + search.runs, time + search.time
    except KeyboardInterrupt:
        outcome = Outcome(Ending.INTERRUPTED)
    table = np.array(rows).reshape(-1, 4)
    settings = {
        **asdict(settling),
        "watch": [system.state_names[index] for index in watched.values()],
        "smallest": smallest,
        "largest": largest,
        "bisection_tolerance": tolerance,
    }
    return CriticalDisturbances(
        speeds=values[: len(table)],
        critical=table[:, 0],
        bracket=table[:, 1:3],
        edge=table[:, 3],
        runs=runs,
        time=time,
        direction=label,
        outcome=outcome,
        record=describe(system, KIND, settings),
    )


class _Search:
    def __init__(
        self,
        system: DynamicSystem,
        speed: float,
        direction: Any,
        watched: Mapping[str, int],
        settling: Settling,
    ) -> None:
        self.system, self.speed = system, speed
        self.watched, self.settling = watched, settling
        self.period = typical_period(system, speed)
        first = next(iter(watched.values()))
        self.rest, self.direction = _disturbance(system, speed, direction, first)
        self.runs, self.time = 0, 0.0

    def bisect(
        self, smallest: float, largest: float, tolerance: float
    ) -> tuple[float, float, float, float]:
        """Critical amplitude, bracket and amplitude at the edge."""
        # A very large disturbance may die out where a smaller one hunts.
        trials = largest * 0.7 ** np.arange(8)
        trials = trials[trials > smallest]
        for high in map(float, trials):
            fate, hunting = self.run(high)
            if fate != "dies out":
                break
        else:
            return np.inf, largest, np.inf, np.nan
        fate, dying = self.run(smallest)
        if fate != "dies out":
            return 0.0, 0.0, smallest, np.nan
        low = smallest
        while high - low > tolerance * high:
            middle = float(np.sqrt(low * high)) if high > 4.0 * low else 0.5 * (low + high)
            fate, means = self.run(middle)
            if fate == "dies out":
                low, dying = middle, means
            else:
                high, hunting = middle, means
        return 0.5 * (low + high), low, high, _parting(dying, hunting)

    def run(self, amplitude: float) -> tuple[Fate, list[float]]:
        """What becomes of one disturbance, and the amplitudes of the watched motion by blocks."""
        self.runs += 1
        motion = WatchedMotion(
            self.system,
            self.speed,
            self.rest + amplitude * self.direction,
            self.period,
            self.watched,
            self.settling,
        )
        while True:
            verdict = motion.advance()
            ended = motion.cycles >= self.settling.cycles
            if verdict is Ending.UNDECIDED and not ended and not _grows(motion.means):
                continue
            fate: Fate = "hunts"
            if verdict is Ending.CONTACT_LOST:
                fate = "lost contact"
            elif verdict is Ending.DIED_OUT or (
                verdict is Ending.UNDECIDED and _shrinks(motion.means)
            ):
                fate = "dies out"
            self.time += motion.time
            return fate, motion.means


def _grows(means: list[float]) -> bool:
    """Whether the amplitude has grown, ever faster or by much, over the last blocks.

    The first block is left out: it holds the transient of the disturbance itself.
    """
    if len(means) < 5:
        return False
    logs = np.diff(np.log(means[-4:]))
    return bool(np.all(logs > 0.0) and np.sum(logs) > GROWTH)


def _shrinks(means: list[float]) -> bool:
    """Whether the amplitude has fallen over the second half of the motion, in each quarter."""
    quarter = max(1, len(means) // 4)
    return means[-1] < means[-1 - quarter] < means[-1 - 2 * quarter] if len(means) > 2 else False


def _parting(dying: list[float], hunting: list[float]) -> float:
    """Geometric mean of two motions in the last block in which they differ by less than 20 %."""
    count = min(len(dying), len(hunting))
    low, high = np.array(dying[:count]), np.array(hunting[:count])
    together = np.flatnonzero(np.abs(np.log(high / low)) < 0.2)
    if len(together) == 0:
        return np.nan
    return float(np.sqrt(low[together[-1]] * high[together[-1]]))


def _disturbance(
    system: DynamicSystem, speed: float, direction: Any, watched: int
) -> tuple[Array, Array]:
    """Equilibrium (n,) and what the amplitude multiplies (n,)."""
    rest = system.equilibrium(speed)
    if isinstance(direction, str) and direction == "mode":
        return rest, mode_disturbance(system, speed, 1.0) - rest
    if direction is None or isinstance(direction, (str, int, np.integer)):
        index = watched
        if isinstance(direction, str):
            index = column_index(system.state_names, direction)
        elif direction is not None:
            index = int(direction)
        unit = np.zeros(system.size)
        unit[index] = 1.0
        return rest, unit
    vector = np.asarray(direction, dtype=float)
    if vector.shape != (system.size,):
        raise AnalysisError(
            f"the direction has shape {vector.shape}, the system {system.size} states: "
            f"{', '.join(system.state_names)}"
        )
    return rest, vector


def _label(system: DynamicSystem, direction: Any) -> str:
    if direction is None:
        return system.state_names[watched_index(system)]
    if isinstance(direction, str):
        return direction
    if isinstance(direction, (int, np.integer)):
        return system.state_names[int(direction)]
    return f"vector {np.asarray(direction).tolist()}"
