"""Limit cycles of Cooperrider's bogie: continuation, descent and plain simulation agree.

The bogie is Kaas-Petersen's (Acta Mechanica 61 (1986) 89), written out in
`catalogue/cooperrider_reference.py`. The three methods share nothing but the right-hand side.
"""

from dataclasses import replace

import numpy as np
import pytest

from exudyn_wheelset.catalogue.cooperrider_bogie import cooperrider_system
from exudyn_wheelset.catalogue.cooperrider_reference import cooperrider_reference_system
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.corrector import solve_orbit, speed_row
from exudyn_wheelset.stability.hunting.descent import quasi_static_descent
from exudyn_wheelset.stability.hunting.disturbance import critical_disturbance
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.nonlinear import nonlinear_critical_speed
from exudyn_wheelset.stability.hunting.symmetry import mirror_of_mode
from exudyn_wheelset.stability.linear.crossings import hopf_points

SYSTEM = cooperrider_reference_system()


@pytest.fixture(scope="module")
def hopf():
    (point,) = hopf_points(SYSTEM, 50.0, 90.0)
    return point


@pytest.fixture(scope="module")
def branch(hopf):
    return limit_cycles(SYSTEM, hopf, (60.0, 80.0))


@pytest.fixture(scope="module")
def simulated():
    """Speed to (half of peak to peak of q1, period): 40 s of motion, the last 4 s measured."""
    found = {}
    state = np.zeros(14)
    state[7] = 0.5
    for speed in (70.0, 75.0):
        state = SYSTEM.simulate(state, speed, np.linspace(0.0, 40.0, 41))[-1]
        times = np.linspace(0.0, 4.0, 8001)
        signal = SYSTEM.simulate(state, speed, times)[:, 0]
        upward = np.flatnonzero((signal[:-1] < 0.0) & (signal[1:] >= 0.0))
        passages = times[upward] - signal[upward] * 5e-4 / (signal[upward + 1] - signal[upward])
        period = (passages[-1] - passages[0]) / (len(passages) - 1)
        found[speed] = 0.5 * (signal.max() - signal.min()), period
    return found


def test_diagram(branch, hopf):
    assert hopf.speed == pytest.approx(68.64, abs=0.02)
    assert branch.hopf == (hopf.speed, hopf.frequency)
    assert branch.reason == "the speed range was left at its upper end: 80 m/s"
    (fold,) = branch.folds
    assert not np.any(branch.stable[: fold.index + 1])
    assert np.all(branch.stable[fold.index + 1 :])
    assert np.all(np.diff(branch.amplitude["q1"]) > 0.0)
    # The flange takes part: the fold is where the wheelset passes its clearance of 9.1 mm.
    assert 9.1e-3 < branch.amplitude["q1"][fold.index] < 9.6e-3


@pytest.mark.parametrize("speed", [70.0, 75.0])
def test_amplitude_and_period_against_simulation(branch, simulated, speed):
    amplitude, period = simulated[speed]
    # Interpolated between points 0.8 m/s apart, on 30 intervals with corners of f inside.
    (followed,) = branch.amplitudes_at(speed, "q1")
    assert followed == pytest.approx(amplitude, rel=1e-3)
    index = int(np.argmin(np.abs(branch.speed - speed) + 100.0 * ~branch.stable))
    equations = Collocation(SYSTEM, period, 1.0)
    orbit = branch.orbits[index]
    near = type(orbit)(orbit.mesh, orbit.states, orbit.period, speed)
    exact = solve_orbit(equations, near, speed_row(near, 14)).orbit
    assert exact.half_peak_to_peak()[0] == pytest.approx(amplitude, rel=1e-3)
    assert exact.period == pytest.approx(period, rel=2e-4)


def test_the_orbit_closes_when_it_is_simulated(branch):
    index = int(np.argmin(np.abs(branch.speed - 72.0) + 100.0 * ~branch.stable))
    orbit = branch.orbits[index]
    times = orbit.period * np.linspace(0.0, 1.0, 101)
    states = SYSTEM.simulate(orbit.states[0], orbit.speed, times)
    size = np.ptp(states, axis=0)
    np.testing.assert_allclose(states[-1] / size, states[0] / size, atol=3e-3)
    np.testing.assert_allclose(
        orbit.evaluate(times / orbit.period) / size, states / size, atol=3e-3
    )


def test_multipliers_against_simulated_neighbours(branch):
    """Before the flange is reached f is smooth: the monodromy matrix by differences of motions."""
    index = int(np.argmin(np.abs(branch.amplitude["q1"] - 5e-3)))
    orbit = branch.orbits[index]
    times = np.array([0.0, orbit.period])
    columns = []
    for column in range(14):
        step = np.zeros(14)
        step[column] = 1e-4 * SYSTEM.scales[column]
        ends = [
            SYSTEM.simulate(orbit.states[0] + sign * step, orbit.speed, times)[-1]
            for sign in (1.0, -1.0)
        ]
        columns.append((ends[0] - ends[1]) / (2 * step[column]))
    values = np.linalg.eigvals(np.array(columns).T)
    values = values[np.argsort(-np.abs(values))]
    trivial = int(np.argmin(np.abs(values - 1.0)))
    # LSODA's 1e-8 over the difference step of 1e-4 leaves 1e-4.
    assert abs(values[trivial] - 1.0) < 1e-3
    others = np.delete(values, trivial)
    np.testing.assert_allclose(np.abs(branch.multipliers[index][:4]), np.abs(others[:4]), atol=2e-3)


def test_fold_converges_with_the_mesh(branch, hopf):
    fine = limit_cycles(SYSTEM, hopf, (60.0, 69.0), intervals=80)
    # Corners of f inside the intervals leave errors that fall with the square of their width.
    assert branch.folds[0] == pytest.approx(fine.folds[0], abs=5e-3)


def test_continuation_and_descent_agree(branch, hopf):
    followed = nonlinear_critical_speed(SYSTEM, hopf=hopf, low=60.0, high=72.0)
    assert followed.method == "continuation" and "fold" in followed.how
    descended = nonlinear_critical_speed(
        SYSTEM, "descent", hopf=hopf, low=60.0, high=71.0, tolerance=0.04
    )
    assert descended.method == "descent"
    assert descended == pytest.approx(followed, abs=0.05)
    lower, upper = descended.bracket
    assert upper - lower <= 0.04
    for speed, amplitude in zip(
        descended.branch.speeds, descended.branch.amplitude["q1"], strict=True
    ):
        (expected,) = branch.amplitudes_at(max(speed, branch.folds[0]), "q1", stable=True)
        assert amplitude == pytest.approx(expected, rel=5e-3)


def test_disturbance_runs_find_the_unstable_branch(branch):
    runs = critical_disturbance(SYSTEM, [66.0, 68.0], 10.0, direction="mode", tolerance=0.02)
    assert np.isinf(runs.critical[0])
    (unstable,) = branch.amplitudes_at(68.0, "q1", stable=False)
    # Peaks averaged over three cycles while the motion leaves the unstable orbit.
    assert runs.edge[1] == pytest.approx(unstable, rel=0.1)


def test_the_exudyn_model_gives_the_same_branch(branch):
    system = cooperrider_system()
    (hopf,) = hopf_points(system, 60.0, 80.0)
    built = limit_cycles(system, hopf, (60.0, 70.0))
    assert built.folds[0] == pytest.approx(branch.folds[0], abs=5e-3)
    for stable in (True, False):
        np.testing.assert_allclose(
            built.amplitudes_at(68.0, "q1", stable=stable),
            branch.amplitudes_at(68.0, "q1", stable=stable),
            rtol=2e-3,
        )


def test_descent_from_the_branch_is_on_it(branch):
    index = int(np.argmin(np.abs(branch.speed - 70.0) + 100.0 * ~branch.stable))
    orbit = branch.orbits[index]
    descent = quasi_static_descent(
        SYSTEM, float(orbit.speed), float(orbit.speed) - 0.5, step=0.5, state=orbit.states[0]
    )
    assert descent.reason.startswith("still hunting at the lower end")
    assert descent.amplitude["q1"][0] == pytest.approx(branch.amplitude["q1"][index], rel=2e-3)


def test_half_of_a_symmetric_orbit_tells_all(branch, hopf):
    whole = limit_cycles(SYSTEM, hopf, (60.0, 80.0), mirror=False)
    assert branch.record["cost"]["mirror_image"] and not whole.record["cost"]["mirror_image"]
    cost = [part.record["cost"]["right_hand_sides"] for part in (branch, whole)]
    assert cost[0] < 0.6 * cost[1]
    # The meshes differ: the error of 30 intervals in each.
    assert branch.folds[0] == pytest.approx(whole.folds[0], abs=5e-3)
    index = 10
    near = int(np.argmin(np.abs(whole.speed[:15] - branch.speed[index])))
    start = branch.orbits[index]
    equations = Collocation(SYSTEM, start.period, 1.0)
    at = replace(whole.orbits[near], speed=start.speed)
    orbit = solve_orbit(equations, at, speed_row(at, 14)).orbit
    multipliers = equations.multipliers(orbit, equations.condense(orbit)).values
    expected = np.abs(branch.multipliers[index][:5])
    np.testing.assert_allclose(np.abs(multipliers[:5]), expected, atol=1e-3)
    assert orbit.period == pytest.approx(start.period, rel=1e-6)


def test_an_asymmetric_vehicle_is_not_halved():
    class Shifted(type(SYSTEM)):
        def derivative(self, state, speed):
            rate = np.array(super().derivative(state, speed))
            rate[7] += 0.02 * state[0] ** 2 / 1e-3
            return rate

    asymmetric = cooperrider_reference_system()
    asymmetric.__class__ = Shifted
    (hopf,) = hopf_points(asymmetric, 60.0, 80.0)
    assert mirror_of_mode(asymmetric, hopf.state, hopf.mode, hopf.speed) is None
    signs = mirror_of_mode(SYSTEM, hopf.state, hopf.mode, hopf.speed)
    np.testing.assert_array_equal(signs, -np.ones(14))
