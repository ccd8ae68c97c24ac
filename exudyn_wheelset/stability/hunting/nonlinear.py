"""Nonlinear critical speed: the lowest speed at which a vehicle can go on hunting.

It is the lowest speed with a stable limit cycle: the fold of the branch where the linear critical
speed is a subcritical Hopf point, the Hopf point itself where it is supercritical. Below it every
disturbance dies out. Two methods give it: `continuation` follows the limit cycles through the
fold, `descent` simulates down to the jump; each result says which made the number and how.

Cycles may coexist on branches that no Hopf point leads to (a small one on the tread and a large
one at the flange). So what continuation finds is checked at speeds below it from large starts of
several kinds (see `large_starts`): where one goes on hunting, its motion is made an orbit, the
branch through it is followed, and the lowest speed of all branches is the answer. Cycles of less
than `smallest` are not called hunting: on S1002 a ripple of 0.05 mm lives at speeds at which
nothing else does. Vehicles with several trucks have several Hopf points close together and beat
when all hunt; descent is their default.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from exudyn_wheelset.checking import positive
from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.hunting.aligned import sensitivity_near
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.continuation_settings import ContinuationSettings
from exudyn_wheelset.stability.hunting.descent import quasi_static_descent
from exudyn_wheelset.stability.hunting.descent_result import Descent
from exudyn_wheelset.stability.hunting.large_starts import hunting_at
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.nonlinear_result import (
    Method,
    NoLimitCycleError,
    NonlinearCriticalSpeed,
)
from exudyn_wheelset.stability.hunting.orbit import Orbit
from exudyn_wheelset.stability.hunting.settling import Settling
from exudyn_wheelset.stability.hunting.simulated_stability import (
    SHORT,
    simulated_below,
    simulated_fold,
)
from exudyn_wheelset.stability.hunting.watching import watched_trucks
from exudyn_wheelset.stability.linear.crossings import CriticalPoint, hopf_points
from exudyn_wheelset.stability.linear.modes import ALONE, truck_motion
from exudyn_wheelset.stability.subject import as_system
from exudyn_wheelset.systems.speeds import checked_speed
from exudyn_wheelset.systems.system import DynamicSystem

if TYPE_CHECKING:
    pass

# Ranges of speed [m/s] searched in turn for the Hopf point if none is given.
SEARCH = ((5.0, 60.0), (60.0, 120.0), (120.0, 240.0), (240.0, 480.0))


# A branch may rise to this multiple of the Hopf point's speed before it turns back to the flange
# and to its lowest fold: that of the S1002 wheelset rises to 1.26. What lies behind a later turn
# is found from large starts.
REACH = 1.3
# Large disturbances: the hunting mode with so many scales (millimetres) of lateral displacement, on
# the flange and short of it. A motion on the flange may hunt where a smaller one does not.
LARGE = (10.0, 5.0)
# Where such motions derail a descent begins with this many scales, or at this multiple of the Hopf
# point's speed.
SMALL, CLOSE = 1.0, 1.03
# Speeds of the large starts that check a continuation, as shares of its answer; no more than so
# many branches are added.
CHECKED, MOST_BRANCHES = (0.985, 0.93, 0.85), 3
# Orbits up to this multiple of the answer are slowed down to those speeds.
NEAR = 1.05
# Of starts that derail so many are told.
TOLD = 3
# Amplitude, in scales (millimetres), from which a cycle is called hunting.
SMALLEST = 0.1


@spelt
def nonlinear_critical_speed(
    vehicle: Any,
    method: Method | None = None,
    *,
    low: float | None = None,
    high: float | None = None,
    hopf: CriticalPoint | None = None,
    check: bool = True,
    smallest: float = SMALLEST,
    step: float | None = None,
    tolerance: float = 0.02,
    watch: str | int | None = None,
    settings: ContinuationSettings | None = None,
    settling: Settling | None = None,
    state_file: str | Path | None = None,
    progress: bool = False,
) -> NonlinearCriticalSpeed:
    """Lowest speed [m/s] at which the vehicle has a stable limit cycle.

    method      "continuation" or "descent"; default descent for a vehicle with several trucks
    low, high   range of speeds looked at [m/s]; default 0.4 and 1.3 times the Hopf point's by
                continuation, 0.4 and 1.1 times by descent
    hopf        where to begin; default the lowest speed at which a pair loses stability
    check       of the continuation: whether hunting is looked for below its answer, from large
                starts
    smallest    amplitude of a watched displacement, in its scale (millimetres), from which a cycle
                is called hunting; a branch that begins stably at the Hopf point counts from there
    settings    of the continuation
    step, tolerance, watch, settling, state_file   of the descent: steps of the speed [m/s]
                (default 1 % of the Hopf point's), width of the final bracket [m/s], ...

    Raises NoLimitCycleError, which keeps the branch, if no cycle in the range is stable, and
    AnalysisError if there is no Hopf point.

    Examples
    --------
    >>> from exudyn_wheelset import nonlinear_critical_speed
    >>> found = nonlinear_critical_speed("cooperrider", low=60, high=75, check=False)
    >>> round(found.speed, 1)  # [m/s]
    66.7
    """
    system = as_system(vehicle)
    if method is None:
        method = "descent" if len(system.trucks) > 1 else "continuation"
    if method not in ("continuation", "descent"):
        raise AnalysisError(f"method = {method!r} is not one of 'continuation', 'descent'")
    for what, value in (("low", low), ("high", high)):
        if value is not None:
            checked_speed(system, what, value)
    smallest = positive("smallest", smallest, "times the scale")
    tolerance = positive("tolerance", tolerance, "m/s")
    if step is not None:
        positive("step", step, "m/s")
    watched_trucks(system, watch)
    if hopf is None:
        hopf = _first_hopf(system, low, high)
    low = 0.4 * hopf.speed if low is None else float(low)
    if high is None:
        high = (REACH if method == "continuation" else 1.1) * hopf.speed
    high = float(high)
    if method == "continuation":
        return _by_continuation(system, hopf, (low, high), check, smallest, settings, progress)
    options: dict[str, Any] = {
        "step": 0.01 * hopf.speed if step is None else step,
        "tolerance": tolerance,
        "watch": watch,
        "settling": settling,
        "state_file": state_file,
        "progress": progress,
    }
    descent = _descent_from_hunting(system, hopf, high, low, options)
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
        f"{descent.speeds[0]:g} m/s ({descent.time:.0f} s of motion simulated); {_linear(hopf)}"
    )
    by_truck = {name: speed for name, speed in descent.by_truck.items() if name}
    return NonlinearCriticalSpeed(
        descent.speed, method, how, descent.bracket, hopf, descent, by_truck
    )


def _descent_from_hunting(
    system: DynamicSystem, hopf: CriticalPoint, high: float, low: float, options: dict[str, Any]
) -> Descent:
    """A descent from the first of several starts that goes on hunting.

    A motion that is too large for the play of its flanges, or too far above the Hopf point,
    derails; a smaller one, or one that begins nearer to it, may not.
    """
    nearer = CLOSE * hopf.speed
    starts = [(high, size) for size in (*LARGE, SMALL)]
    if low < nearer < high:
        starts += [(nearer, size) for size in (LARGE[1], SMALL)]
    for begin, size in starts[:-1]:
        try:
            return quasi_static_descent(system, begin, low, disturbance=size, **options)
        except AnalysisError:
            continue
    begin, size = starts[-1]
    return quasi_static_descent(system, begin, low, disturbance=size, **options)


def _by_continuation(
    system: DynamicSystem,
    hopf: CriticalPoint,
    speeds: tuple[float, float],
    check: bool,
    smallest: float,
    settings: ContinuationSettings | None,
    progress: bool,
) -> NonlinearCriticalSpeed:
    branches = [limit_cycles(system, hopf, speeds, settings=settings, progress=progress)]
    remarks: list[str] = []
    for _ in range(MOST_BRANCHES if check else 0):
        found = _lowest(system, branches, smallest)
        answer = found[0] if found else speeds[1]
        added, said = _hunting_below(
            system, answer, _orbits_above(branches, answer), speeds, smallest, settings
        )
        remarks += said
        if added is None:
            break
        branches.append(added)
    found = _lowest(system, branches, smallest)
    if found is None:
        message = f"no limit cycle is stable for certain; {branches[0].reason}"
        raise NoLimitCycleError("; ".join([message, *remarks]), branches[0])
    speed, what, branch = found
    if speed <= speeds[0] + 1e-6 * (speeds[1] - speeds[0]):
        message = f"hunting has no lowest speed within {speeds[0]:g} to {speeds[1]:g} m/s"
        raise NoLimitCycleError("; ".join([message, *remarks]), branches[0])
    fold = simulated_fold(system, branch, speed)
    if fold is not None:
        speed, what = fold, "the fold of the limit cycle, beside which simulated motion stays"
    kept = _sensitive(system, branch, speed)
    stays = simulated_below(system, branch, speed, smallest)
    if stays is not None:
        speed, what = stays
    place = "from the Hopf point" if branch is branches[0] else "from a motion that hunts"
    means = "collocation and pseudo-arclength continuation"
    if branch.method != "continuation":
        means = f"{branch.method} ({branch.record.get('why', 'Newton does not serve')})"
    how = (
        f"{speed:.4f} m/s is {what}, on a branch of {len(branch)} periodic orbits followed by "
        f"{means} {place}; {_linear(hopf)}; the branch ends because {branch.reason}"
    )
    ripple = _lowest(system, branches, 0.0)
    if ripple is not None and ripple[0] < speed - 1e-9:
        how += (
            f"; a cycle smaller than {smallest:g} scales, which is not called hunting, lives down "
            f"to {ripple[0]:.4f} m/s"
        )
    if branch.uncertain.any():
        how += f"; of {np.count_nonzero(branch.uncertain)} orbits the stability is uncertain"
    return NonlinearCriticalSpeed(
        speed,
        "continuation",
        "; ".join([how, *remarks]),
        (speed, speed),
        hopf,
        kept,
        dict.fromkeys(_trucks_at(system, branch, speed), speed),
        tuple(other for other in branches if other is not branch),
    )


def _sensitive(system: DynamicSystem, branch: Branch, speed: float) -> Branch:
    """The branch, its fold at a speed [m/s] with what a gradient asks for."""
    folds = list(branch.folds)
    for place, fold in enumerate(folds):
        if fold.speed == speed and fold.sensitivity is None and fold.orbit is not None:
            try:
                found = sensitivity_near(system, fold.orbit, fold.side)
            except WheelsetError:
                continue
            folds[place] = replace(fold, sensitivity=found)
    return replace(branch, folds=folds)


def _lowest(
    system: DynamicSystem, branches: list[Branch], smallest: float
) -> tuple[float, str, Branch] | None:
    """Lowest speed with a stable cycle over branches, what bounds it, and its branch.

    Cycles below `smallest` scales count only where they begin at a Hopf point.
    """
    found = []
    places = list(watched_trucks(system).values())
    columns = [list(system.displacement_indices).index(place) for place in places]
    for branch in branches:
        relative = np.asarray(branch.amplitude)[:, columns] / system.scales[places]
        large = relative.max(axis=1) >= smallest
        try:
            found.append((*branch.lowest_stable(large), branch))
        except AnalysisError:
            continue
    return min(found, key=lambda entry: entry[0]) if found else None


def _hunting_below(
    system: DynamicSystem,
    answer: float,
    orbits: Sequence[Orbit],
    speeds: tuple[float, float],
    smallest: float,
    settings: ContinuationSettings | None,
) -> tuple[Branch | None, list[str]]:
    """The branch through a motion that hunts below the answer [m/s], if any; what was checked."""
    tried: list[str] = []
    lost: list[str] = []
    for share in CHECKED:
        speed = speeds[0] + share * (answer - speeds[0]) if answer <= 0.0 else share * answer
        if not speeds[0] < speed < answer:
            continue
        tried.append(f"{speed:.4g}")
        hunting = hunting_at(system, speed, SHORT, smallest, orbits, lost)
        if hunting is None:
            continue
        words, motion = hunting
        said = f"a motion from {words} hunts at {speed:.4g} m/s"
        try:
            branch = limit_cycles(
                system, motion.state, speeds, start_speed=speed, settings=settings
            )
        except AnalysisError as error:
            return None, [f"{said}; it could not be made an orbit: {error}"]
        return branch, [said]
    where = f"{', '.join(tried)} m/s" if tried else "no speed: the range ends there"
    remarks = [f"checked from large starts at {where}: none hunts"]
    if lost:
        more = f", and {len(lost) - TOLD} others" if len(lost) > TOLD else ""
        remarks.append(f"{', '.join(lost[:TOLD])}{more}")
    return None, remarks


def _orbits_above(branches: Sequence[Branch], answer: float) -> list[Orbit]:
    """Of each branch the orbit next above the answer [m/s], and the one it ends with.

    Not those that are unstable for certain, which lead away.
    """
    found = []
    for branch in branches:
        above = [
            k
            for k in map(int, np.flatnonzero(branch.stable | branch.uncertain))
            if answer - 1e-9 <= branch.speed[k] < NEAR * answer
        ]
        if above:
            nearest = min(above, key=lambda k: float(branch.speed[k]))
            found += [branch.orbits[k] for k in {nearest, above[-1]}]
    return found


def _trucks_at(system: DynamicSystem, branch: Branch, speed: float) -> tuple[str, ...]:
    """Trucks that hunt on the cycle of a branch nearest to a speed [m/s]."""
    orbit = branch.orbits[int(np.argmin(np.abs(branch.speed - speed)))]
    moving = truck_motion(system, orbit.half_peak_to_peak())
    largest = max(moving.values(), default=0.0)
    return tuple(name for name, size in moving.items() if size >= ALONE * largest)


def _linear(hopf: CriticalPoint) -> str:
    return f"the linear critical speed is {hopf.speed:.4f} m/s at {hopf.frequency:.3f} Hz"


def _first_hopf(system: Any, low: float | None, high: float | None) -> CriticalPoint:
    """Lowest Hopf point in the range, or in the usual ones, at which stability is lost."""
    ranges: tuple[tuple[float, float], ...] = SEARCH
    if high is not None:
        ranges = ((5.0 if low is None else low, high),)
    elif low is not None:
        # From `low` itself, below the usual speeds and beyond them too.
        ends = [low, *(b for _, b in SEARCH if b > low)]
        ranges = tuple(pairwise(ends)) or ((low, 2.0 * low),)
    for first, last in ranges:
        for point in hopf_points(system, first, last):
            if point.direction == "loses stability":
                return point
    raise AnalysisError(
        f"no Hopf point between {ranges[0][0]:g} and {ranges[-1][1]:g} m/s: the straight run of "
        f"{system.name} does not lose stability to an oscillation there; give a wider range, or "
        "follow a motion that hunts with limit_cycles(vehicle, start=state, ...)"
    )
