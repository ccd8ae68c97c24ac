"""The limit cycle that a simulated motion has settled to, to Newton's accuracy.

A motion that hunts steadily comes back near a state after a period; the piece between the two,
closed by Newton's method, is a point of a branch. It is the way onto branches that no Hopf point
of the straight run leads to.
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.corrector import solve_orbit, speed_row
from exudyn_wheelset.stability.hunting.orbit import DEGREE, INTERVALS, Orbit, orbit_from_samples
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion
from exudyn_wheelset.stability.hunting.watching import typical_period, watched_trucks
from exudyn_wheelset.systems.system import DynamicSystem


def orbit_near(
    system: DynamicSystem,
    state: Array,
    speed: float,
    period: float | None = None,
    watch: str | int | None = None,
    settling: Settling | None = None,
    intervals: int = INTERVALS,
    degree: int = DEGREE,
) -> Orbit:
    """The limit cycle that the motion from a state (n,) settles to, to Newton's accuracy.

    `period` [s] is a rough guess, taken from the least damped mode if left out. Raises
    AnalysisError if the motion dies out or leaves the model, or if Newton does not converge.
    """
    motion = settled_motion(system, state, speed, period, watch, settling)
    guess = orbit_of(motion, intervals, degree)
    equations = Collocation(system, guess.period, max(1.0, abs(speed)))
    row = speed_row(guess, len(system.scales))
    return solve_orbit(equations, guess, row, tolerance=1e-8, iterations=40).orbit


def settled_motion(
    system: DynamicSystem,
    state: Array,
    speed: float,
    period: float | None = None,
    watch: str | int | None = None,
    settling: Settling | None = None,
) -> WatchedMotion:
    """The motion from a state (n,), simulated until it hunts steadily.

    Raises AnalysisError if it dies out or leaves the model.
    """
    watched = watched_trucks(system, watch)
    period = period or typical_period(system, speed)
    motion = WatchedMotion(system, speed, state, period, watched, settling or Settling())
    verdict = motion.decide()
    if verdict in (Ending.DIED_OUT, Ending.CONTACT_LOST):
        raise AnalysisError(
            f"no limit cycle at {speed:g} m/s from this state: {verdict.sentence} after "
            f"{motion.time:.3g} s{': ' + motion.failure if motion.failure else ''}; start from "
            "a larger disturbance or another speed"
        )
    return motion


def orbit_of(motion: WatchedMotion, intervals: int = INTERVALS, degree: int = DEGREE) -> Orbit:
    """The cycle that a settled motion is on, as simulated: closed to what it has settled to."""
    system, speed = motion.system, motion.speed
    times = np.linspace(0.0, 2.2 * motion.period, 1 + round(2.2 * 400))
    states = system.simulate(motion.state, speed, times)
    sizes = motion.truck_amplitudes()
    signal = states[:, motion.watched[max(sizes, key=lambda name: sizes[name])]]
    middle = 0.5 * (signal.max() + signal.min())
    start = int(np.flatnonzero((signal[:-1] <= middle) & (signal[1:] > middle))[0])
    # The period is where the motion comes closest to a state on the cycle.
    apart = np.linalg.norm((states[start:] - states[start]) / system.scales, axis=1)
    low, high = np.searchsorted(times, times[start] + np.array([0.7, 1.3]) * motion.period) - start
    length = times[start + low + int(np.argmin(apart[low:high]))] - times[start]
    count = intervals * degree
    cycle = system.simulate(states[start], speed, np.linspace(0.0, length, count + 1))
    return orbit_from_samples(cycle, length, speed, intervals, degree)
