"""All branches of limit cycles that lead on from what is known of a vehicle, on one diagram.

1. from every Hopf point at which an oscillation loses stability: on a car one of each truck;
2. from where those lose symmetry or double their period (see `branch_switching`);
3. from motions that hunt where none of these passes: isolated branches, to which no Hopf point
   leads. They are looked for from large starts at the speeds asked for, or begun from states.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.branch_switching import switch_branch
from exudyn_wheelset.stability.hunting.continuation_settings import ContinuationSettings
from exudyn_wheelset.stability.hunting.diagram import Diagram
from exudyn_wheelset.stability.hunting.large_starts import hunting_at
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.same_branch import is_known, lies_on
from exudyn_wheelset.stability.hunting.settled_orbit import orbit_near
from exudyn_wheelset.stability.hunting.simulated_stability import SHORT
from exudyn_wheelset.stability.linear.crossings import hopf_points
from exudyn_wheelset.stability.linear.modes import is_lateral
from exudyn_wheelset.stability.subject import as_system
from exudyn_wheelset.systems.system import DynamicSystem

# Motions smaller than this, in scales, are not called hunting.
SMALLEST = 0.1


@spelt
def all_branches(
    vehicle: Any,
    speeds: tuple[float, float],
    *,
    starts: Sequence[tuple[float, Array]] = (),
    large_starts_at: Sequence[float] = (),
    switch: bool = True,
    settings: ContinuationSettings | None = None,
    **changes: Any,
) -> Diagram:
    """Every branch of limit cycles within `speeds` = (low, high) [m/s] that was found.

    starts           (speed [m/s], state (n,)) of motions that hunt
    large_starts_at  speeds [m/s] at which large disturbances are tried for hunting that lies on
                     no branch yet
    switch           whether branches that leave others are followed
    settings         as for `limit_cycles`

    The branches' records say where they come from (`begins`). Raises AnalysisError where there is
    none.

    >>> import numpy as np
    >>> from exudyn_wheelset import FunctionSystem, all_branches
    >>> def isola(x, speed):
    ...     square = x[0] ** 2 + x[1] ** 2
    ...     growth = 0.25 - speed**2 - (square - 1.0) ** 2
    ...     return np.array([growth * x[0] - 3.0 * x[1], 3.0 * x[0] + growth * x[1]])
    >>> system = FunctionSystem("isola", isola, ("y", "v"), (1.0, 1.0))
    >>> found = all_branches(system, (-0.9, 0.9), starts=[(0.0, np.array([1.2, 0.0]))])
    >>> sorted(round(float(fold), 3) for fold in found.branches[0].folds)
    [-0.5, 0.5]
    """
    system = as_system(vehicle)
    settings = replace(settings or ContinuationSettings(), **changes)
    branches: list[Branch] = []
    failures: list[str] = []
    for point in hopf_points(system, *speeds):
        if point.direction != "loses stability" or not _counts(system, point.mode):
            continue
        try:
            branch = limit_cycles(system, point, speeds, settings=settings)
        except WheelsetError as error:
            failures.append(f"from {point.speed:.4f} m/s: {error}")
            continue
        if not is_known(system, branches, branch):
            branches.append(_named(branch, f"Hopf point at {point.speed:.4f} m/s"))
    for branch in list(branches) if switch else ():
        for change in branch.changes:
            if change.kind == "torus":
                continue
            try:
                other = switch_branch(system, branch, change, speeds, settings=settings)
            except WheelsetError as error:
                failures.append(f"{change.kind} at {change.speed:.4f} m/s: {error}")
                continue
            if not is_known(system, branches, other):
                branches.append(_named(other, f"{change.kind} at {other.record['leaves_at']:.4f}"))
    hunting = [(float(speed), np.asarray(state, dtype=float)) for speed, state in starts]
    for speed in large_starts_at:
        found = hunting_at(system, float(speed), SHORT, SMALLEST)
        if found is not None:
            hunting.append((float(speed), found[1].state))
    for speed, state in hunting:
        try:
            orbit = orbit_near(system, state, speed)
            if any(lies_on(system, known, orbit) for known in branches):
                continue
            branch = limit_cycles(system, state, speeds, start_speed=speed, settings=settings)
        except WheelsetError as error:
            failures.append(f"a motion at {speed:.4f} m/s: {error}")
            continue
        branches.append(_named(branch, f"a motion that hunts at {speed:.4f} m/s"))
    if not branches:
        raise AnalysisError(
            f"{system.name}: no branch of limit cycles between {speeds[0]:g} and {speeds[1]:g} m/s"
            + (f" ({'; '.join(failures)})" if failures else "; give starts or another range")
        )
    if failures:
        branches[0] = replace(branches[0], record={**branches[0].record, "failures": failures})
    return Diagram(branches)


def _counts(system: DynamicSystem, mode: Array) -> bool:
    """Whether a mode is one of hunting; of a system without wheelsets every one is."""
    return not system.wheelset_names or bool(is_lateral(system, mode))


def _named(branch: Branch, begins: str) -> Branch:
    return replace(branch, record={**branch.record, "begins": begins})
