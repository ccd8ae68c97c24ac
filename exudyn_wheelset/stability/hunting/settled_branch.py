"""A branch of stable limit cycles by simulation, where Newton's method does not serve.

Some models jump: a contact point changes place on a worn or unlike pair of profiles, and the
right-hand side with it. A motion passes such a jump without harm, a polynomial through it does not.
There the stable part of the branch is followed by settled motions: from one speed to the next each
begins with the last state of its neighbour, down to the speed at which hunting dies out, which is
bisected, and up to the end of the range. Unstable cycles and multipliers are beyond it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.results.columns import NamedColumns
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.stability.hunting.branch import Branch, Fold
from exudyn_wheelset.stability.hunting.orbit import Orbit
from exudyn_wheelset.stability.hunting.settled_orbit import orbit_of, settled_motion
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion
from exudyn_wheelset.systems.system import DynamicSystem

# Steps to either end of the range of speeds, and the width of a jump's bracket relative to the
# speed: beside the fold a motion lingers for hundreds of cycles.
STEPS = 8
RESOLUTION = 1e-3
# A motion that has fallen to this share of its neighbour's amplitude has left the branch.
JUMPED = 0.5


def settled_branch(
    system: DynamicSystem,
    state: Array,
    speed: float,
    speeds: tuple[float, float],
    why: str,
    report: Callable[[float], None] | None = None,
) -> Branch:
    """Stable cycles over `speeds` = (low, high) [m/s] from a state (n,) that hunts at `speed`.

    `why` is the reason for simulating, for the record. Raises AnalysisError if it does not hunt.
    """
    settling = Settling(tolerance=2e-3, cycles=150)
    first = settled_motion(system.rough(), state, speed, settling=settling)
    down, lower = _one_way(first, speeds[0], settling, report)
    up, upper = _one_way(first, speeds[1], settling, report)
    orbits = [*reversed(down), orbit_of(first), *up]
    indices = list(system.displacement_indices)
    names = [system.state_names[index] for index in indices]
    amplitudes = np.array([orbit.half_peak_to_peak()[indices] for orbit in orbits])
    folds = []
    for edge, index, side in ((lower, 0, "lowest"), (upper, len(orbits) - 1, "highest")):
        if edge is not None:
            sizes = dict(zip(names, map(float, amplitudes[index]), strict=True))
            folds.append(Fold(edge, sizes, float(orbits[index].period), index, side))  # type: ignore[arg-type]
    count = len(orbits)
    return Branch(
        speed=np.array([orbit.speed for orbit in orbits]),
        period=np.array([orbit.period for orbit in orbits]),
        amplitude=NamedColumns(amplitudes, names),
        stable=np.ones(count, dtype=bool),
        uncertain=np.zeros(count, dtype=bool),
        multipliers=np.full((count, 1), np.nan + 0j),
        trivial_error=np.full(count, np.nan),
        folds=folds,
        changes=[],
        hopf=None,
        outcome=_outcome(upper, speeds[1], Ending.UPPER_END),
        orbits=orbits,
        first_outcome=_outcome(lower, speeds[0], Ending.LOWER_END),
        method="settled motions",
        record={"why": why, "speeds": list(speeds)},
    )


class _Neighbour(WatchedMotion):
    """The motion at a speed from the state of a settled one beside it; over once it has fallen."""

    def __init__(self, last: WatchedMotion, speed: float, settling: Settling) -> None:
        state = last.system.carry_over(last.state, last.speed, speed)
        super().__init__(last.system, speed, state, last.period, last.watched, settling)
        self.least = JUMPED * last.means[-1]

    def advance(self) -> Ending:
        verdict = super().advance()
        lost = verdict is Ending.CONTACT_LOST
        return verdict if lost or self.means[-1] > self.least else Ending.DIED_OUT


def _one_way(
    first: WatchedMotion,
    end: float,
    settling: Settling,
    report: Callable[[float], None] | None,
) -> tuple[list[Orbit], float | None]:
    """Orbits from the first motion towards `end`, and the speed of the jump if there is one."""
    step = (end - first.speed) / STEPS
    if step == 0.0:
        return [], None
    found: list[Orbit] = []
    last, dead = first, None
    tolerance = RESOLUTION * abs(first.speed)
    while True:
        speed = last.speed + step if dead is None else 0.5 * (last.speed + dead)
        if (end - speed) * step < 0.0:
            speed = end
        motion = _Neighbour(last, speed, settling)
        jumped = motion.decide() in (Ending.DIED_OUT, Ending.CONTACT_LOST)
        jumped = jumped or motion.means[-1] > last.means[-1] / JUMPED
        if jumped:
            dead = speed
        else:
            last = motion
            found.append(orbit_of(motion))
            if report is not None:
                report(speed)
        if dead is not None and abs(dead - last.speed) < tolerance:
            return found, 0.5 * (dead + last.speed)
        if dead is None and last.speed == end:
            return found, None


def _outcome(edge: float | None, end: float, left: Ending) -> Outcome:
    if edge is None:
        return Outcome(left, f"{end:g} m/s")
    return Outcome(Ending.JUMP_FOUND, f"{edge:.4f} m/s")
