"""A bifurcation diagram: what is known of the hunting of one vehicle over its speed.

Three methods, each a result with a file of its own: the branch of limit cycles that leaves a Hopf
point (continuation), hunting simulated at falling speed down to its jump (descent), and the
smallest disturbance that leads to hunting (disturbance runs), which shows the unstable branch from
both sides. The latter two begin from the branch.

Speeds in m/s, amplitudes are half of peak to peak in m or rad.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.columns import column_index
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.continuation_settings import ContinuationSettings
from exudyn_wheelset.stability.hunting.descent import quasi_static_descent
from exudyn_wheelset.stability.hunting.descent_result import Descent
from exudyn_wheelset.stability.hunting.disturbance import CriticalDisturbances, critical_disturbance
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.watching import watched_index
from exudyn_wheelset.stability.linear.crossings import CriticalPoint, hopf_points
from exudyn_wheelset.systems.system import DynamicSystem

# Ends of a diagram, in Hopf speeds.
RANGE = (0.5, 1.3)
# A descent begins and a disturbance ends beyond the largest orbit of the branch by these.
START, LARGEST = 1.05, 1.5


@dataclass(frozen=True, eq=False)
class Diagram:
    """Results of one vehicle that belong on one figure; any part may be missing.

    displacement: name of the state that is drawn; default that of the results.
    """

    branches: Sequence[Branch] = ()
    descents: Sequence[Descent] = ()
    disturbances: Sequence[CriticalDisturbances] = ()
    displacement: str | None = None

    @property
    def watched(self) -> str:
        """Full name of the displacement that is drawn, its unit in brackets."""
        parts: list[Branch | Descent] = [*self.branches, *self.descents]
        if parts:
            names, record = parts[0].amplitude.names, parts[0].record
            wanted = self.displacement or record.get("displacement") or names[0]
            return names[column_index(names, wanted)]
        for runs in self.disturbances:
            return str(runs.record["settings"]["watch"])
        raise AnalysisError("there is nothing to draw: give a branch, a descent or disturbances")

    @property
    def record(self) -> dict[str, Any]:
        """System, parameters, settings and versions of the first result."""
        parts: list[Any] = [*self.branches, *self.descents, *self.disturbances]
        return dict(parts[0].record) if parts else {}

    def numbers(self) -> dict[str, Any]:
        """Numbers of the first branch, see `diagram_numbers`; without one, why a result ends."""
        if not self.branches:
            parts: list[Any] = [*self.descents, *self.disturbances]
            return {"reason": parts[0].reason}
        branch = self.branches[0]
        hopf = branch.record.get("hopf_points") or ([branch.hopf[0]] if branch.hopf else [])
        return diagram_numbers(hopf, branch, branch.record["cost"]["seconds"])

    @classmethod
    def load(cls, files: Sequence[str | Path]) -> Diagram:
        """The diagram of data files, each a branch, a descent or disturbance runs.

        Raises AnalysisError for a file that is none of them.
        """
        found: dict[Any, list[Any]] = {Branch: [], Descent: [], CriticalDisturbances: []}
        for path in files:
            failures = []
            for kind, members in found.items():
                try:
                    members.append(kind.load(path))
                    break
                except AnalysisError as error:
                    failures.append(str(error))
            else:
                raise AnalysisError(failures[0])
        return cls(found[Branch], found[Descent], found[CriticalDisturbances])


def first_hopf_point(
    system: DynamicSystem, low: float, high: float
) -> tuple[CriticalPoint, list[CriticalPoint]]:
    """The first speed in [low, high] m/s that loses stability, and all Hopf points there.

    Raises AnalysisError if none does.
    """
    points = hopf_points(system, low, high)
    for point in points:
        if point.direction == "loses stability":
            return point, points
    raise AnalysisError(
        f"{system.name} does not lose stability to an oscillation between {low:g} and "
        f"{high:g} m/s: search another range (scripts: --searched LOW HIGH)"
    )


def branch_from(
    system: DynamicSystem,
    hopf: CriticalPoint,
    speeds: tuple[float, float] | None = None,
    *,
    progress: bool = False,
    about: dict[str, Any] | None = None,
    **settings: Any,
) -> Branch:
    """The branch from a Hopf point inside `speeds` [m/s], default 0.5 and 1.3 times the point's.

    Where Newton's method fails on the default number of intervals, the branch is followed once
    more on half as many again, and the longer one is kept. about: what else is to stand in the
    branch's record; settings: of ContinuationSettings.
    """
    low, high = speeds or drawn_speeds(hopf)
    branch = limit_cycles(system, hopf, (low, high), progress=progress, **settings)
    if branch.outcome.ending is Ending.ORBIT_LOST and "intervals" not in settings:
        finer = {**settings, "intervals": 3 * ContinuationSettings().intervals // 2}
        other = limit_cycles(system, hopf, (low, high), progress=progress, **finer)
        branch = max(branch, other, key=len)
    shown = system.state_names[watched_index(system)]
    return replace(branch, record={**branch.record, "displacement": shown, **(about or {})})


def drawn_speeds(hopf: CriticalPoint) -> tuple[float, float]:
    """Ends [m/s] of a diagram about a Hopf point."""
    return RANGE[0] * hopf.speed, RANGE[1] * hopf.speed


def descent_from(
    system: DynamicSystem,
    hopf: CriticalPoint,
    branch: Branch,
    speeds: tuple[float, float] | None = None,
    *,
    step: float | None = None,
    state_file: str | Path | None = None,
    progress: bool = False,
) -> Descent:
    """Quasi-static descent through `speeds` [m/s], from hunting larger than all of a branch.

    step [m/s]: default 0.5 % of the Hopf point's speed. What is finished stands in state_file.
    """
    low, high = speeds or drawn_speeds(hopf)
    return quasi_static_descent(
        system,
        high,
        low,
        step=step or 0.005 * hopf.speed,
        state=system.equilibrium(high)
        + START * _largest(system, branch) * mode_at_peak(system, hopf),
        state_file=state_file,
        progress=progress,
    )


def disturbances_beside(
    system: DynamicSystem,
    hopf: CriticalPoint,
    branch: Branch,
    speeds: Sequence[float] | Array | None = None,
    *,
    direction: Literal["blow", "mode"] | str = "blow",
    progress: bool = False,
) -> CriticalDisturbances | None:
    """Smallest disturbance that hunts, at `speeds` [m/s], by default where it has to.

    direction: "blow", a lateral velocity [m/s] of the watched displacement, or "mode", the shape of
    the least damped mode in units of its scale. None where there is no speed to look at.
    """
    chosen = disturbed_speeds(branch) if speeds is None else np.asarray(speeds, dtype=float)
    if not len(chosen):
        return None
    watched = watched_index(system)
    largest = START * _largest(system, branch)
    state: str | int = direction
    size = LARGEST * largest / system.scales[watched]
    if direction == "blow":
        state = rate_of(system, watched, hopf.speed)
        size = 4.0 * 2.0 * np.pi * hopf.frequency * largest
    return critical_disturbance(
        system, chosen, size, direction=state, tolerance=0.005, progress=progress
    )


def disturbed_speeds(branch: Branch, count: int = 4) -> Array:
    """Speeds [m/s] inside the range where straight run and hunting are both stable, or none.

    The range begins at the lowest fold beside which an orbit is not unstable for certain.
    """
    if branch.hopf is None or not np.any(branch.stable):
        return np.empty(0)
    lasting = branch.stable | branch.uncertain
    folds = [
        float(fold)
        for fold in branch.folds
        if fold.side == "lowest" and np.any(lasting[max(0, fold.index - 1) : fold.index + 2])
    ]
    low, high = min([branch.lowest_stable()[0], *folds]), branch.hopf[0]
    # Small limit cycles beside the Hopf point are not what a disturbance leads to.
    turns = [fold.index for fold in branch.folds if fold.side == "highest"]
    first = turns[0] if turns else (branch.folds[0].index if branch.folds else len(branch))
    if np.any(lasting[:first]) and branch.speed[:first].min() > low:
        high = min(high, float(branch.speed[:first].min()))
    if high - low < 1e-3 * high:
        return np.empty(0)
    return low + (high - low) * (np.arange(count) + 0.5) / count


def mode_at_peak(system: DynamicSystem, hopf: CriticalPoint) -> Array:
    """The shape (n,) of hunting at a Hopf point when its watched displacement is at its peak of 1.

    A disturbance of this shape, times an amplitude in m, is a hunting motion from the start.
    """
    mode = np.asarray(hopf.mode)
    return np.real(mode / mode[watched_index(system)])


def rate_of(system: DynamicSystem, displacement: int, speed: float) -> int:
    """Index of the state that is the rate of a displacement, at a speed [m/s]."""
    return int(np.argmax(system.jacobian(system.equilibrium(speed), speed)[displacement]))


def diagram_numbers(
    hopf: Sequence[CriticalPoint | float], branch: Branch | None, seconds: float, reason: str = ""
) -> dict[str, Any]:
    """The numbers of a diagram for people and programs.

    hopf and folds [m/s]; nonlinear_critical_speed [m/s], the lowest with a stable limit cycle, None
    if there is none; method; points, orbits on the branch; seconds of the continuation; reason why
    the branch ends, or why there is none.
    """
    lowest = None
    if branch is not None and np.any(branch.stable):
        lowest = branch.lowest_stable()[0]
    return {
        "hopf": [float(point) for point in hopf],
        "folds": [float(fold) for fold in branch.folds] if branch else [],
        "nonlinear_critical_speed": lowest,
        "method": "continuation",
        "points": len(branch) if branch else 0,
        "seconds": seconds,
        "reason": branch.reason if branch else reason,
    }


def disturbance_numbers(runs: CriticalDisturbances | None) -> dict[str, Any]:
    """Speeds [m/s] and critical disturbances, None where nothing hunts; empty without runs."""
    if runs is None:
        return {"speeds": [], "critical": []}
    sizes = [float(size) if np.isfinite(size) else None for size in runs.critical]
    return {"of": runs.direction, "speeds": runs.speeds, "critical": sizes}


def _largest(system: DynamicSystem, branch: Branch) -> float:
    """Largest amplitude of the watched displacement on a branch."""
    return float(branch.amplitude[system.state_names[watched_index(system)]].max())
