"""Mirror symmetry of a vehicle, and of its hunting.

A vehicle whose left and right sides are alike moves the same way after reflection in the vertical
plane of the track. With signs S (1 for what the reflection keeps, x, z, pitch; -1 for what it turns
round, y, yaw, roll) this is f(S x; V) = S f(x; V). A hunting motion that starts at a Hopf point of
a lateral mode is its own mirror image half a period later, x(t + T/2) = S x(t), until the symmetry
breaks at a branch point: half of it tells all.

Signs are not asked for: they are read from a mode or an orbit, and tried on the equations.
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.stability.hunting.orbit import Orbit
from exudyn_wheelset.systems.system import DynamicSystem

# Relative to the largest: components of a mode or deviations of f below it are rounding.
NEGLIGIBLE = 1e-6
# States tried, and their distance from rest in scales.
TRIALS = (0.3, 1.0, 3.0)


def mirror_of_mode(system: DynamicSystem, rest: Array, mode: Array, speed: float) -> Array | None:
    """Signs (n,) of the symmetry under which a mode about `rest` is odd; None if there is none."""
    sizes = np.abs(np.asarray(mode)) / system.scales
    return _confirmed(system, rest, sizes > NEGLIGIBLE * sizes.max(), speed)


def mirror_of_orbit(system: DynamicSystem, orbit: Orbit) -> Array | None:
    """Signs (n,) of the symmetry that takes each half of an orbit to the other; None if none."""
    phases = np.arange(64) / 128.0
    early, late = orbit.evaluate(phases), orbit.evaluate(phases + 0.5)
    sums = np.abs(early + late).max(axis=0) / system.scales
    differences = np.abs(early - late).max(axis=0) / system.scales
    odd = sums < differences
    size = float(np.max(np.ptp(np.vstack([early, late]), axis=0) / system.scales))
    if np.any(np.minimum(sums, differences) > 1e-2 * size):
        return None
    return _confirmed(system, np.where(odd, 0.0, early[0]), odd, orbit.speed)


def _confirmed(system: DynamicSystem, rest: Array, odd: Array, speed: float) -> Array | None:
    """The signs, if f(S x) = S f(x) holds at trial states about rest."""
    signs = np.where(odd, -1.0, 1.0)
    if np.any(np.abs(rest[odd]) > NEGLIGIBLE * system.scales[odd]):
        return None
    random = np.random.default_rng(1)
    for size in TRIALS:
        state = rest + size * system.scales * random.uniform(-1.0, 1.0, len(rest))
        try:
            rate = np.asarray(system.derivative(state, speed)).copy()
            image = np.asarray(system.derivative(signs * state, speed))
        except WheelsetError:
            return None
        level = np.abs(rate / system.scales).max()
        apart = np.abs((image - signs * rate) / system.scales).max()
        if not apart <= NEGLIGIBLE * level:
            return None
    return signs
