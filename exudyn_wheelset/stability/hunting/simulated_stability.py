"""Where multipliers leave the stability of an orbit open, simulated motion from it decides.

Beside a fold a multiplier is near 1, and on contacts that jump all have errors: such orbits are
neither stable nor unstable for certain, and a branch of them would have its lowest stable cycle too
high up. A motion that begins beside the orbit and settles at its size is drawn to it.

Speeds in m/s.
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion
from exudyn_wheelset.stability.hunting.watching import watched_trucks
from exudyn_wheelset.systems.system import DynamicSystem

# Criterion of the large starts and of the simulated checks.
SHORT = Settling(tolerance=5e-3, cycles=150)
# Of orbits of uncertain stability so many are simulated.
TRIED = 4
# A motion that settles at this share of an orbit's size and more, or its inverse and less, has
# stayed on it.
STAYS = 0.8
# It begins by this share of the orbit inside it: on an unstable orbit itself, known to 1e-6, it
# would stay for a dozen cycles.
NUDGE = 0.01


def simulated_fold(system: DynamicSystem, branch: Branch, speed: float) -> float | None:
    """The lowest fold below `speed` beside which simulated motion stays on a cycle.

    Multipliers may leave the stability next to a fold open; a motion from the orbit decides.
    """
    watched = watched_trucks(system)
    for fold in sorted(branch.folds):
        if fold >= speed or fold.side != "lowest":
            continue
        for index in (fold.index + 1, fold.index - 1):
            if not 0 <= index < len(branch) or not branch.uncertain[index]:
                continue
            if _stays_on(system, branch, index, watched):
                return float(fold)
    return None


def simulated_below(
    system: DynamicSystem, branch: Branch, speed: float, smallest: float
) -> tuple[float, str] | None:
    """Lowest orbit below `speed` of uncertain stability on which simulated motion stays; its words.

    Where that is the first of a branch that begins at the Hopf point, it is that point. Cycles of
    less than `smallest` scales count there only.
    """
    watched = watched_trucks(system)
    places = list(watched.values())
    columns = [list(system.displacement_indices).index(place) for place in places]
    sizes = (np.asarray(branch.amplitude)[:, columns] / system.scales[places]).max(axis=1)
    begins = branch.hopf is not None and branch.speed[0] > branch.hopf[0] * (1.0 - 2e-3)
    below = [
        index
        for index in map(int, np.flatnonzero(branch.uncertain))
        if branch.speed[index] < speed - 1e-9
        and (sizes[index] >= smallest or (begins and not index))
    ]
    below.sort(key=lambda index: float(branch.speed[index]))
    for index in below[:TRIED]:
        if not _stays_on(system, branch, index, watched):
            continue
        if begins and not index and branch.hopf is not None:
            found = min(float(branch.speed[0]), branch.hopf[0])
            return found, "the Hopf point, beside which simulated motion stays on a small cycle"
        return float(branch.speed[index]), "an orbit of the branch on which simulated motion stays"
    return None


def _stays_on(system: DynamicSystem, branch: Branch, index: int, watched: dict[str, int]) -> bool:
    """Whether a motion that begins a little inside an orbit of the branch settles on it."""
    orbit = branch.orbits[index]
    rest = system.equilibrium(orbit.speed)
    start = rest + (1.0 - NUDGE) * (orbit.states[0] - rest)
    motion = WatchedMotion(system, orbit.speed, start, orbit.period, watched, SHORT)
    before = max(float(orbit.half_peak_to_peak()[place]) for place in watched.values())
    return motion.decide() is Ending.SETTLED and STAYS < motion.means[-1] / before < 1.0 / STAYS
