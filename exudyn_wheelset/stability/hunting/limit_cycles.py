"""The branch of limit cycles of a vehicle: bifurcation diagram of its hunting motion.

`limit_cycles` follows the periodic orbits (see `collocation`, `continuation`) from a Hopf point or
from a state that hunts, through folds, to the ends of a range of speeds, and gathers them into a
`Branch`. Where linear stability is lost subcritically, the branch first runs back to lower speeds
(unstable: the edge of the basin of attraction of the straight run) and turns at the fold, below
which the vehicle does not hunt at all.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from tqdm import tqdm

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import number, numbers
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.columns import NamedColumns
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.results.records import describe
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.hunting.aligned import Point
from exudyn_wheelset.stability.hunting.branch import Branch, Fold, StabilityChange
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.continuation import follow, hopf_start
from exudyn_wheelset.stability.hunting.continuation_settings import ContinuationSettings
from exudyn_wheelset.stability.hunting.corrector import solve_orbit, speed_row
from exudyn_wheelset.stability.hunting.measured_growth import checked
from exudyn_wheelset.stability.hunting.orbit import Orbit, OrbitError
from exudyn_wheelset.stability.hunting.settled_branch import settled_branch
from exudyn_wheelset.stability.hunting.settled_orbit import orbit_near
from exudyn_wheelset.stability.hunting.symmetry import mirror_of_mode, mirror_of_orbit
from exudyn_wheelset.stability.hunting.watching import watched_index
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.stability.subject import as_system
from exudyn_wheelset.systems.speeds import checked_range
from exudyn_wheelset.systems.system import DynamicSystem


@spelt
def limit_cycles(
    vehicle: Any,
    start: CriticalPoint | Orbit | Sequence[float] | Array,
    speeds: tuple[float, float],
    *,
    start_speed: float | None = None,
    settings: ContinuationSettings | None = None,
    progress: bool = False,
    **changes: Any,
) -> Branch:
    """Branch of limit cycles through `start`, inside `speeds` = (low, high) [m/s].

    `start` is a Hopf point of `hopf_points`; an `Orbit`; or a state (n,) at `start_speed` [m/s]
    (default: the upper end of `speeds`), from which the vehicle is simulated until it hunts
    steadily; where Newton's method cannot close that motion to an orbit, because the model jumps,
    its stable part is followed by settled motions (`method` says so). From a Hopf point the branch
    is followed one way, from elsewhere both ways.
    Settings are those of `ContinuationSettings`, whole or one by one (`intervals=40`).

    A branch says how it ends (`outcome`, in words `reason`) and keeps what was found. Raises
    AnalysisError if there is no orbit to begin with.

    Examples
    --------
    >>> from exudyn_wheelset import hopf_points, limit_cycles
    >>> (hopf, *_) = hopf_points("cooperrider", 60, 75)
    >>> branch = limit_cycles("cooperrider", hopf, (60, 75))
    >>> round(branch.lowest_stable()[0], 1)  # [m/s]
    66.7
    """
    system = as_system(vehicle)
    low, high = numbers("speeds (low, high)", speeds, 2, "m/s")
    if not low < high:
        raise AnalysisError(f"speeds = ({low:g}, {high:g}) m/s must be (low, high), low below high")
    checked_range(system, low, high)
    settings = replace(settings or ContinuationSettings(), **changes)
    begun = time.perf_counter()
    with tqdm(disable=not progress, unit="orbit", desc="limit cycles") as bar:
        report = _reporter(system, bar)
        if isinstance(start, CriticalPoint):
            if not low <= start.speed <= high:
                raise AnalysisError(
                    f"the Hopf point at {start.speed:.4f} m/s lies outside of speeds = "
                    f"({low:g}, {high:g}) m/s; widen the range"
                )
            mirror = None
            if settings.mirror:
                mirror = mirror_of_mode(system, start.state, start.mode, start.speed)
            equations = Collocation(system, 1.0 / start.frequency, high - low, mirror)
            orbit, _, heading = hopf_start(equations, start, settings)
            points, outcome = follow(equations, orbit, heading, (low, high), settings, report)
            first = None
            hopf: tuple[float, float] | None = (start.speed, start.frequency)
        else:
            if isinstance(start, Orbit):
                orbit = start
            else:
                at = high if start_speed is None else number("start_speed", start_speed, "m/s")
                state = np.array(numbers("start, a state,", start, system.size, "SI"))
                try:
                    orbit = orbit_near(
                        system, state, at, intervals=settings.intervals, degree=settings.degree
                    )
                except OrbitError as error:
                    return settled_branch(system, state, at, (low, high), str(error))
            mirror = mirror_of_orbit(system, orbit) if settings.mirror else None
            orbit = orbit.whole() if mirror is None else orbit.halved(mirror)
            equations = Collocation(system, orbit.period, high - low, mirror)
            if mirror is not None:
                row = speed_row(orbit, system.size)
                orbit = solve_orbit(equations, orbit, row, tolerance=settings.tolerance).orbit
            points, first, outcome = _both_ways(equations, orbit, (low, high), settings, report)
            hopf = None
    cost: dict[str, Any] = {
        "mirror_image": equations.mirror is not None,
        "right_hand_sides": equations.evaluations,
        "jacobians": equations.jacobians,
        "newton_steps": equations.newton_steps,
        "seconds": time.perf_counter() - begun,
    }
    record = describe(system, "continuation", {**settings.record(), "speeds": [low, high]})
    return gather(system, points, hopf, (first, outcome), settings, {**record, "cost": cost})


def gather(
    system: DynamicSystem,
    points: list[Point],
    hopf: tuple[float, float] | None,
    outcomes: tuple[Outcome | None, Outcome],
    settings: ContinuationSettings,
    record: dict[str, Any],
) -> Branch:
    """The Branch of a list of points; stability near 1 is checked by simulated motion."""
    points = [checked(system, point, settings.stability_margin) for point in points]
    indices = list(system.displacement_indices)
    names = [system.state_names[index] for index in indices]
    amplitudes = np.array([point.orbit.half_peak_to_peak()[indices] for point in points])
    multipliers = _table([point.multipliers.values for point in points])
    verdicts = [point.multipliers.stable(settings.stability_margin) for point in points]
    # A fold is stable from one side only, which is not stable.
    stable = np.array([v is True and not p.is_fold for v, p in zip(verdicts, points, strict=True)])
    uncertain = np.array(
        [v is None and not p.is_fold for v, p in zip(verdicts, points, strict=True)]
    )
    orbits = [point.orbit.whole() for point in points]
    folds: list[Fold] = []
    for index, point in enumerate(points):
        if point.is_fold:
            around = points[max(0, index - 1) : index + 2]
            near = np.array([other.orbit.speed for other in around])
            beside = near[np.argmax(np.abs(near - point.orbit.speed))]
            folds.append(
                Fold(
                    float(point.orbit.speed),
                    dict(zip(names, map(float, amplitudes[index]), strict=True)),
                    float(point.orbit.period),
                    index,
                    "lowest" if beside > point.orbit.speed else "highest",
                    orbits[index],
                    system.source,
                    point.sensitivity,
                )
            )
    return Branch(
        speed=np.array([point.orbit.speed for point in points]),
        period=np.array([point.orbit.period for point in points]),
        amplitude=NamedColumns(amplitudes, names),
        stable=stable,
        uncertain=uncertain,
        multipliers=multipliers,
        trivial_error=np.array([point.multipliers.error for point in points]),
        folds=folds,
        changes=_stability_changes(points, settings.stability_margin),
        hopf=hopf,
        outcome=outcomes[1],
        first_outcome=outcomes[0],
        orbits=orbits,
        record=record,
    )


def _table(rows: list[Array]) -> Array:
    """Multipliers (points, k), complex; rows with fewer (neutral ones left out) end in zeros."""
    table = np.zeros((len(rows), max(map(len, rows))), dtype=complex)
    for row, values in zip(table, rows, strict=True):
        row[: len(values)] = values
    return table


def _both_ways(
    equations: Collocation,
    orbit: Orbit,
    speeds: tuple[float, float],
    settings: ContinuationSettings,
    report: Callable[[Point], None],
) -> tuple[list[Point], Outcome | None, Outcome]:
    down, first = follow(equations, orbit, -1.0, speeds, settings, report)
    if first.ending in (Ending.CLOSED, Ending.INTERRUPTED):
        return down, None, first
    up, last = follow(equations, orbit, 1.0, speeds, settings, report)
    return [*down[:0:-1], *up], first, last


def _stability_changes(points: list[Point], margin: float) -> list[StabilityChange]:
    """Points between which the number of unstable multipliers changes without a fold."""
    found: list[StabilityChange] = []
    for index in range(1, len(points)):
        before, after = points[index - 1], points[index]
        if before.is_fold or after.is_fold:
            continue
        if None in (before.multipliers.stable(margin), after.multipliers.stable(margin)):
            continue
        counts = [int(np.sum(np.abs(p.multipliers.values) > 1.0 + margin)) for p in (before, after)]
        if counts[0] == counts[1]:
            continue
        position = min(counts)
        pair = [np.abs(p.multipliers.values)[position] - 1.0 for p in (before, after)]
        fraction = pair[0] / (pair[0] - pair[1])
        speed = before.orbit.speed + fraction * (after.orbit.speed - before.orbit.speed)
        crossing = (before if abs(pair[0]) < abs(pair[1]) else after).multipliers.values[position]
        if abs(crossing.imag) > 1e-3:
            found.append(StabilityChange(float(speed), "torus", index))
        elif crossing.real > 0.0:
            found.append(StabilityChange(float(speed), "branch point", index))
        else:
            found.append(StabilityChange(float(speed), "period doubling", index))
    return found


def _reporter(system: DynamicSystem, bar: Any) -> Callable[[Point], None]:
    watched = watched_index(system)
    name = system.state_names[watched].split(" [")[0]

    def report(point: Point) -> None:
        bar.update()
        amplitude = point.orbit.half_peak_to_peak()[watched]
        bar.set_postfix_str(f"{point.orbit.speed:.2f} m/s, {name} {amplitude:.3g}")

    return report
