"""Nonlinear critical speed: the lowest speed at which a vehicle can go on hunting.

It is the lowest speed with a stable limit cycle: the fold of the branch where the linear critical
speed is a subcritical Hopf point, the Hopf point itself where it is supercritical. Below it every
disturbance dies out. Two methods give it: `continuation` follows the limit cycles through the
fold, `descent` simulates down to the jump; each result says which made the number and how.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.continuation import ContinuationSettings
from exudyn_wheelset.stability.hunting.descent import Descent, quasi_static_descent
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.settling import Settling
from exudyn_wheelset.stability.linear.crossings import CriticalPoint, hopf_points
from exudyn_wheelset.systems.system import as_system

Method = Literal["continuation", "descent"]

# Ranges of speed [m/s] searched in turn for the Hopf point if none is given.
SEARCH = ((5.0, 60.0), (60.0, 120.0), (120.0, 240.0), (240.0, 480.0))


class NoLimitCycleError(AnalysisError):
    """No stable limit cycle was found; `branch` holds what was."""

    def __init__(self, message: str, branch: Branch | Descent) -> None:
        super().__init__(message)
        self.branch = branch


@brief
@dataclass(frozen=True, eq=False)
class NonlinearCriticalSpeed(float):
    """The lowest speed of stable hunting; a float, the speed itself [m/s].

    speed     [m/s]
    method    "continuation" or "descent"
    how       one sentence on what the number is and what it was found from
    bracket   speeds [m/s] between which it lies by the method
    hopf      the Hopf point that the search began with
    branch    the Branch or Descent behind it
    """

    speed: float
    method: Method
    how: str
    bracket: tuple[float, float]
    hopf: CriticalPoint
    branch: Branch | Descent

    def __new__(cls, speed: float, *_: Any, **__: Any) -> NonlinearCriticalSpeed:
        return super().__new__(cls, speed)


def nonlinear_critical_speed(
    vehicle: Any,
    method: Method = "continuation",
    *,
    low: float | None = None,
    high: float | None = None,
    hopf: CriticalPoint | None = None,
    step: float | None = None,
    tolerance: float = 0.02,
    watch: str | int | None = None,
    settings: ContinuationSettings | None = None,
    settling: Settling | None = None,
    state_file: str | Path | None = None,
    progress: bool = False,
) -> NonlinearCriticalSpeed:
    """Lowest speed [m/s] at which the vehicle has a stable limit cycle.

    method      "continuation" or "descent"
    low, high   range of speeds looked at [m/s]; default 0.4 and 1.1 times the Hopf point's
    hopf        where to begin; default the lowest speed at which a pair loses stability
    settings    of the continuation
    step, tolerance, watch, settling, state_file   of the descent: steps of the speed [m/s]
                (default 1 % of the Hopf point's), width of the final bracket [m/s], ...

    Raises NoLimitCycleError, which keeps the branch, if no cycle in the range is stable, and
    AnalysisError if there is no Hopf point.
    """
    system = as_system(vehicle)
    if method not in ("continuation", "descent"):
        raise AnalysisError(f"method = {method!r} is not one of 'continuation', 'descent'")
    if hopf is None:
        hopf = _first_hopf(system, low, high)
    low = 0.4 * hopf.speed if low is None else float(low)
    high = 1.1 * hopf.speed if high is None else float(high)
    linear = f"the linear critical speed is {hopf.speed:.4f} m/s at {hopf.frequency:.3f} Hz"
    if method == "continuation":
        branch = limit_cycles(system, hopf, (low, high), settings=settings, progress=progress)
        try:
            speed, what = branch.lowest_stable()
        except AnalysisError as error:
            raise NoLimitCycleError(str(error), branch) from error
        how = (
            f"{speed:.4f} m/s is {what}, on a branch of {len(branch)} periodic orbits followed by "
            f"collocation and pseudo-arclength continuation from the Hopf point; {linear}; the "
            f"branch ends because {branch.reason}"
        )
        return NonlinearCriticalSpeed(speed, method, how, (speed, speed), hopf, branch)
    descent = quasi_static_descent(
        system,
        high,
        low,
        step=0.01 * hopf.speed if step is None else step,
        tolerance=tolerance,
        watch=watch,
        settling=settling,
        state_file=state_file,
        progress=progress,
    )
    if descent.outcome.ending is Ending.INTERRUPTED:
        raise KeyboardInterrupt(descent.reason)
    if np.isnan(descent.jumped):
        raise NoLimitCycleError(
            f"hunting has no lowest speed within {low:g} to {high:g} m/s: {descent.reason}", descent
        )
    lower, upper = descent.bracket
    how = (
        f"{descent.speed:.4f} m/s is the middle of the interval from {lower:.4f} m/s, where "
        f"hunting died out, to {upper:.4f} m/s, where it settled, by quasi-static descent from "
        f"{high:g} m/s ({descent.time:.0f} s of motion simulated); {linear}"
    )
    return NonlinearCriticalSpeed(descent.speed, method, how, descent.bracket, hopf, descent)


def _first_hopf(system: Any, low: float | None, high: float | None) -> CriticalPoint:
    """Lowest Hopf point in the range, or in the usual ones, at which stability is lost."""
    ranges: tuple[tuple[float, float], ...] = SEARCH
    if high is not None:
        ranges = ((5.0 if low is None else low, high),)
    elif low is not None:
        ranges = tuple((max(a, low), b) for a, b in SEARCH if b > low)
    for first, last in ranges:
        for point in hopf_points(system, first, last):
            if point.direction == "loses stability":
                return point
    raise AnalysisError(
        f"no Hopf point between {ranges[0][0]:g} and {ranges[-1][1]:g} m/s: the straight run of "
        f"{system.name} does not lose stability to an oscillation there; give a wider range, or "
        "follow a motion that hunts with limit_cycles(vehicle, start=state, ...)"
    )
