"""Basins: how probable it is that a disturbance leads to hunting, over speed.

At each speed disturbances are drawn from a distribution, the vehicle is simulated from each, and
counted is what hunts (a wheelset that leaves the rails counts as well). The same disturbances are
taken at all speeds, so that the curve over speed is not roughened by the draw. The interval of the
probability p from k of n is Wilson's at the confidence asked for (E. B. Wilson, J. Am. Stat. Assoc.
22 (1927) 209), or that of Clopper and Pearson (Biometrika 26 (1934) 404), which never covers less:

    Wilson:  (k + z^2/2 -+ z sqrt(k (n - k)/n + z^2/4))/(n + z^2),   z the normal quantile
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from scipy.stats import beta, norm
from tqdm import tqdm

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import finite_array, number, numbers, positive, whole
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.results.columns import column_index
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.results.records import describe
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion
from exudyn_wheelset.stability.hunting.watching import typical_period, watched_index, watched_trucks
from exudyn_wheelset.stability.subject import as_system
from exudyn_wheelset.systems.speeds import checked_speed
from exudyn_wheelset.systems.system import DynamicSystem

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Interval = Literal["wilson", "clopper-pearson"]
# A disturbance: one spread, by state, or a function that draws one.
Disturbance = float | Mapping[str, Any] | Callable[[np.random.Generator], Array]
DEFAULT = Settling(block=3, cycles=150, tolerance=5e-3)


@brief
@dataclass(frozen=True, eq=False)
class Basin:
    """Probability of hunting after a disturbance.

    speeds       (m,) [m/s]
    probability  (m,) share of the disturbances that lead to hunting
    interval     (m, 2) its confidence interval
    hunts        (m, samples) what each did
    disturbances (samples, n) offsets from the equilibrium
    confidence   of the interval
    """

    speeds: Array
    probability: Array
    interval: Array
    hunts: Array
    disturbances: Array
    confidence: float
    record: dict[str, Any] = field(default_factory=dict)

    def plot(self, ax: Axes | None = None, **style: Any) -> Axes:
        """Draw the probability over speed with its interval; returns the axes."""
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.subplots()[1]
        (line,) = ax.plot(self.speeds, self.probability, **{"marker": "o", **style})
        ax.fill_between(self.speeds, *self.interval.T, alpha=0.2, color=line.get_color())
        ax.set_xlabel("forward speed [m/s]")
        ax.set_ylabel("probability of hunting")
        return ax


@spelt
def basin(
    vehicle: Any,
    speeds: float | Sequence[float] | Array,
    disturbance: Disturbance,
    samples: int = 100,
    seed: int = 0,
    *,
    confidence: float = 0.95,
    method: Interval = "wilson",
    settling: Settling | None = None,
    progress: bool = False,
) -> Basin:
    """Probability that a disturbance leads to hunting, at each of `speeds` [m/s].

    disturbance  a number: standard deviation of the first wheelset's lateral displacement [m]; a
                 mapping of state names to standard deviations, to (low, high) between which all
                 values are alike, or to frozen distributions of scipy.stats; or a function of a
                 numpy Generator that gives an offset (n,) from the equilibrium
    samples      disturbances; seed: of their draw, the same seed gives the same ones
    confidence   that the interval, by `method`, holds the probability
    settling     criterion by which a motion hunts or has died out

    Raises AnalysisError for what is not a disturbance of the vehicle.

    Examples
    --------
    >>> from exudyn_wheelset import basin
    >>> found = basin("cooperrider", 60.0, {"q1": 1e-3}, samples=2, seed=1)
    >>> found.probability
    array([0.])
    """
    system = as_system(vehicle)
    values = np.atleast_1d(finite_array("speeds", speeds, "m/s"))
    if values.ndim > 1:
        raise AnalysisError(f"speeds of the shape {values.shape}: give one number or a list [m/s]")
    for speed in values:
        checked_speed(system, "one of speeds", float(speed))
    whole("samples", samples, 1)
    whole("seed", seed)
    if not 0.0 < number("confidence", confidence, "-") < 1.0:
        raise AnalysisError(
            f"confidence = {confidence!r}: give a number between 0 and 1, such as 0.95"
        )
    offsets = _drawn(system, disturbance, samples, np.random.default_rng(seed))
    settling = settling or DEFAULT
    hunts = np.zeros((len(values), samples), dtype=bool)
    with tqdm(total=hunts.size, disable=not progress, unit="motion", desc="basin") as bar:
        for row, speed in enumerate(values):
            rest, period = system.equilibrium(speed), typical_period(system, speed)
            for column, offset in enumerate(offsets):
                hunts[row, column] = _hunts(system, speed, rest + offset, period, settling)
                bar.update()
    counts = hunts.sum(axis=1)
    settings = {"samples": samples, "seed": seed, "confidence": confidence, "method": method}
    return Basin(
        values,
        counts / samples,
        np.array([interval_of(int(k), samples, confidence, method) for k in counts]),
        hunts,
        offsets,
        confidence,
        describe(system, "basin", settings),
    )


def interval_of(
    count: int, samples: int, confidence: float = 0.95, method: Interval = "wilson"
) -> tuple[float, float]:
    """Confidence interval of a probability from `count` hits among `samples`."""
    if method == "wilson":
        z = float(norm.ppf(0.5 + 0.5 * confidence))
        middle = count + 0.5 * z**2
        width = z * np.sqrt(count * (samples - count) / samples + 0.25 * z**2)
        low, high = (middle - width) / (samples + z**2), (middle + width) / (samples + z**2)
        return max(0.0, float(low)), min(1.0, float(high))
    if method == "clopper-pearson":
        rest = 0.5 * (1.0 - confidence)
        low = beta.ppf(rest, count, samples - count + 1) if count else 0.0
        high = beta.ppf(1.0 - rest, count + 1, samples - count) if count < samples else 1.0
        return float(low), float(high)
    raise AnalysisError(f"method = {method!r}: give 'wilson' or 'clopper-pearson'")


def _drawn(
    system: DynamicSystem, disturbance: Any, samples: int, random: np.random.Generator
) -> Array:
    """Offsets (samples, n) from the equilibrium."""
    size = system.size
    if callable(disturbance):
        offsets = np.array([disturbance(random) for _ in range(samples)], dtype=float)
        if offsets.shape != (samples, size):
            raise AnalysisError(
                f"the disturbance has shape {offsets.shape[1:]}, the system {size} states: "
                f"{', '.join(system.state_names)}"
            )
        return offsets
    if not isinstance(disturbance, Mapping):
        spread = positive("disturbance", disturbance, "m")
        disturbance = {system.state_names[watched_index(system)]: spread}
    offsets = np.zeros((samples, size))
    for name, spread in disturbance.items():
        column = column_index(system.state_names, name)
        if hasattr(spread, "rvs"):
            offsets[:, column] = spread.rvs(size=samples, random_state=random)
        elif isinstance(spread, tuple | list):
            low, high = numbers(f"disturbance of {name}", spread, 2, "-")
            if not low < high:
                raise AnalysisError(
                    f"disturbance of {name} = {spread!r}: give (low, high), low below high"
                )
            offsets[:, column] = random.uniform(low, high, size=samples)
        else:
            deviation = number(f"disturbance of {name}", spread, "-", 0.0)
            offsets[:, column] = random.normal(0.0, deviation, size=samples)
    return offsets


def _hunts(
    system: DynamicSystem, speed: float, state: Array, period: float, settling: Settling
) -> bool:
    """Whether a motion hunts, or leaves the rails, which must not happen either."""
    motion = WatchedMotion(system, speed, state, period, watched_trucks(system), settling)
    verdict = motion.decide()
    return verdict is not Ending.DIED_OUT
