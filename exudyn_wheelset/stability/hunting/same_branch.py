"""Whether an orbit lies on a branch that is known already.

On a branch an orbit has the amplitudes, the period and the symmetry that the branch has where it
passes the orbit's speed. Amplitudes go by cubics along the branch: near folds its points are far
apart in speed, or two passages near to one another.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.orbit import Orbit
from exudyn_wheelset.stability.hunting.symmetry import mirror_of_orbit
from exudyn_wheelset.systems.system import DynamicSystem

# Amplitudes and periods are the same to these shares.
SAME, SAME_PERIOD = 0.02, 0.2
# So are the ratios of amplitudes before the first orbit of a branch.
SAME_SHAPE = 0.1
# Orbits of a branch that are looked at, as shares of its length.
LOOKED_AT = (0.35, 0.5, 0.75, 0.95)


def lies_on(system: DynamicSystem, branch: Branch, orbit: Orbit) -> bool:
    """Whether an orbit, or its mirror image, lies on a branch."""
    near = int(np.argmin(np.abs(branch.speed - orbit.speed)))
    if not abs(orbit.period / branch.period[near] - 1.0) < SAME_PERIOD:
        return False
    sizes = orbit.half_peak_to_peak()[list(system.displacement_indices)]
    if branch.hopf is not None and _before_the_first(branch, orbit.speed, sizes):
        return True
    names = branch.amplitude.names
    passages = [branch.amplitudes_at(orbit.speed, name) for name in names]
    count = min(map(len, passages))
    expected = np.array([column[:count] for column in passages])
    if not count:
        return False
    apart = np.abs(sizes[:, None] - expected).max(axis=0) / np.maximum(
        np.abs(expected).max(axis=0), 1e-300
    )
    if not np.any(apart < SAME):
        return False
    symmetric = mirror_of_orbit(system, orbit) is not None
    return symmetric == (mirror_of_orbit(system, branch.orbits[near]) is not None)


def _before_the_first(branch: Branch, speed: float, sizes: Array) -> bool:
    """Whether an orbit of these amplitudes lies between the Hopf point and the first orbit."""
    assert branch.hopf is not None
    first = np.asarray(branch.amplitude[0])
    low, high = sorted((branch.hopf[0], float(branch.speed[0])))
    share = float(sizes @ first / (first @ first))
    shape = np.abs(sizes - share * first).max() / max(float(sizes.max()), 1e-300)
    return low <= speed <= high and share < 1.0 and bool(shape < SAME_SHAPE)


def is_known(system: DynamicSystem, branches: Sequence[Branch], other: Branch) -> bool:
    """Whether a branch runs along ones that are known, its beginning left out."""
    last = len(other) - 1
    orbits = [other.orbits[round(share * last)] for share in LOOKED_AT]
    return all(any(lies_on(system, one, orbit) for one in branches) for orbit in orbits)
