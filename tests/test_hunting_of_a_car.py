"""Hunting of a whole car, truck by truck: simulated from two places of the basin, and by Newton.

Above 41.4 m/s both trucks of the DTU car hunt in step, so that a periodic orbit shows it.
"""

import numpy as np
import pytest

from exudyn_wheelset.catalogue.by_name import vehicle_system
from exudyn_wheelset.stability.hunting.descent import mode_disturbance
from exudyn_wheelset.stability.hunting.large_starts import large_starts
from exudyn_wheelset.stability.hunting.settled_orbit import orbit_near
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion
from exudyn_wheelset.stability.hunting.watching import watched_trucks

SPEED = 44.0


@pytest.mark.slow
def test_amplitude_of_each_truck_from_two_starts_and_by_newton():
    system = vehicle_system("dtu_car")
    watched = watched_trucks(system)
    assert set(watched) == {"front", "rear"}
    blow = next(state for words, state in large_starts(system, SPEED) if "blow" in words)
    found = []
    for start in (mode_disturbance(system, SPEED, 5.0), blow):
        motion = WatchedMotion(system, SPEED, start, 0.203, watched, Settling(cycles=250))
        motion.decide()
        found.append(np.array([motion.truck_amplitudes()[name] for name in watched]))
    np.testing.assert_allclose(found[1], found[0], rtol=0.01)
    orbit = orbit_near(system, motion.state, SPEED, motion.period)
    by_newton = orbit.half_peak_to_peak()[list(watched.values())]
    np.testing.assert_allclose(by_newton, found[0], rtol=5e-3)
