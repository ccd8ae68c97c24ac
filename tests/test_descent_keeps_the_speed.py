"""A descent is about a speed: what coasts in it is kept there, and follows when it is lowered.

A vehicle that runs free along the track and hunts loses the power P of its creep: its speed falls
by P/(m V). On the way down its wheels must not keep the spin of the speed above: the spins I w/r
give m + sum(I/r^2) only that share of the step back.
"""

import numpy as np
import pytest

from exudyn_wheelset import catalogue, quasi_static_descent
from exudyn_wheelset.stability.hunting.descent import mode_disturbance
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion
from exudyn_wheelset.stability.hunting.watching import watched_trucks
from exudyn_wheelset.systems.system import as_system

SPEED = 45.0


@pytest.fixture(scope="module")
def hunting():
    system = as_system(catalogue.dtu_car())
    watched = watched_trucks(system)
    start = mode_disturbance(system, SPEED, 3.0)
    motion = WatchedMotion(system, SPEED, start, 0.2, watched, Settling())
    for _ in range(3):
        motion.advance()
    return system, motion


def along_the_track(system):
    names = np.array(system.state_names)
    speeds = np.flatnonzero([name.endswith("vx [m/s]") for name in names])
    spins = [k for k, name in enumerate(names) if "ing: wy" in name]
    return speeds, np.array(spins)


def test_what_runs_free_loses_speed_and_watched_motion_does_not(hunting):
    system, motion = hunting
    speeds, spins = along_the_track(system)
    times = np.arange(0.0, 4.0, 4e-3)
    free = system.simulate(motion.state, SPEED, times)
    seconds = free[:, speeds].mean(axis=1).reshape(4, -1).mean(axis=1)
    lost = seconds[-1] - seconds[0]
    assert lost < -5e-4
    assert abs(seconds[0]) < 0.5 * abs(lost)
    # Shifted together, speed and spin leave the creepage as it was; nothing else moves.
    shift = free[-1] - system.held(free, SPEED)
    np.testing.assert_allclose(shift[speeds], np.mean(seconds), rtol=0.1)
    np.testing.assert_allclose(shift[speeds][0] / shift[spins], 0.425, rtol=2e-3)
    assert set(np.flatnonzero(shift)) == {*speeds, *spins}


def test_the_spin_follows_the_speed_on_the_way_down():
    system = as_system(catalogue.dtu_car())
    start = mode_disturbance(system, SPEED, 3.0)
    short = Settling(cycles=15)
    found = quasi_static_descent(system, SPEED, SPEED - 1.0, step=1.0, state=start, settling=short)
    speeds, spins = along_the_track(system)
    for speed, state in zip(found.speeds, found.states, strict=True):
        assert abs(state[speeds].mean()) < 3e-3
        assert state[spins].mean() * 0.425 == pytest.approx(speed, abs=0.05)
    assert found.speeds.tolist() == [SPEED, SPEED - 1.0]


def test_coarser_steps_are_steps_of_the_same_motion(hunting):
    system, motion = hunting
    times, step = np.arange(0.0, 0.5, 3e-3), system.step
    fine = system.simulate(motion.state, SPEED, times)
    with system.coarser(2.0) as chosen:
        assert chosen and system.step == 2.0 * step
        coarse = system.simulate(motion.state, SPEED, times)
    assert system.step == step and not np.array_equal(fine, coarse)
    np.testing.assert_allclose(coarse[:, 1], fine[:, 1], atol=1e-4 * np.abs(fine[:, 1]).max())
