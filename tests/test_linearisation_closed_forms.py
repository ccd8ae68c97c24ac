"""Critical speeds, root loci and equilibria of systems whose eigenvalues are written by hand."""

import json
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.crossings import (
    divergence_points,
    hopf_points,
    stability_changes,
)
from exudyn_wheelset.stability.linear.linearisation import linearise, root_locus
from exudyn_wheelset.systems.function_system import FunctionSystem
from exudyn_wheelset.systems.system import SimulationError, as_system


def linear_system(*blocks, name="blocks"):
    """A system x' = A(speed) x; each block gives (real part, frequency) or a real rate by speed."""

    def matrix(speed):
        size = sum(len(np.atleast_1d(block(speed))) for block in blocks)
        result, first = np.zeros((size, size)), 0
        for block in blocks:
            value = np.atleast_1d(block(speed))
            if len(value) == 1:
                result[first, first] = value[0]
            else:
                growth, frequency = value
                result[first : first + 2, first : first + 2] = [
                    [growth, -frequency],
                    [frequency, growth],
                ]
            first += len(value)
        return result

    size = len(matrix(1.0))
    return FunctionSystem(
        name,
        lambda state, speed: matrix(speed) @ state,
        [f"x{i} [m]" for i in range(size)],
        np.ones(size),
    )


def hunting(speed):
    return 0.1 * (speed - 30.0), 7.0


def body_hunting(speed):
    return 0.2 * (12.0 - speed), 3.0


def neutral(speed):
    return 0.0, 900.0


def diverging(speed):
    return 0.01 * (speed - 50.0)


def test_crossings_with_direction_and_frequency():
    system = linear_system(neutral, hunting, body_hunting, diverging, lambda speed: 0.0)
    changes = stability_changes(system, 5.0, 80.0)
    assert [float(change) for change in changes] == pytest.approx([12.0, 30.0, 50.0], abs=1e-5)
    assert [change.kind for change in changes] == ["hopf", "hopf", "divergence"]
    assert [change.direction for change in changes] == [
        "gains stability",
        "loses stability",
        "loses stability",
    ]
    assert [change.slope for change in changes] == pytest.approx([-0.2, 0.1, 0.01], rel=1e-4)
    assert changes[0].frequency == pytest.approx(3.0 / (2.0 * np.pi))
    assert changes[1].eigenvalue == pytest.approx(7.0j, abs=1e-6)
    # The mode of the second block: its first entry leads, one scale in size and phase zero.
    np.testing.assert_allclose(np.abs(changes[1].mode[2:4]), 1.0, rtol=1e-8)
    np.testing.assert_allclose(np.abs(changes[1].mode[[0, 1, 4, 5, 6]]), 0.0, atol=1e-8)
    assert [float(point) for point in divergence_points(system, 5.0, 80.0)] == [changes[2].speed]
    assert len(hopf_points(system, 5.0, 80.0)) == 2


def test_the_lowest_loss_of_stability_is_the_critical_speed():
    system = linear_system(hunting, body_hunting)
    assert linear_critical_speed(system, 5.0, 80.0).speed == pytest.approx(30.0, abs=1e-6)


def test_two_modes_may_change_places():
    """The least damped pair below the crossing is not the one that crosses."""
    system = linear_system(lambda speed: (-0.5 + 0.001 * speed, 20.0), hunting)
    assert linear_critical_speed(system, 1.0, 80.0).frequency == pytest.approx(7 / (2 * np.pi))


@settings(deadline=None, max_examples=50)
@given(
    critical=st.floats(5.0, 95.0),
    frequency=st.floats(0.5, 50.0),
    slope=st.floats(0.01, 1.0),
    guess=st.floats(-4.0, 4.0),
)
def test_any_crossing_is_found_from_the_scan_and_from_a_guess(critical, frequency, slope, guess):
    system = linear_system(lambda speed: (slope * (speed**2 - critical**2) / 100.0, frequency))
    found = linear_critical_speed(system, 1.0, 100.0)
    assert found.speed == pytest.approx(critical, abs=2e-6)
    near = linear_critical_speed(system, 1.0, 100.0, guess=critical + guess)
    assert near.speed == pytest.approx(critical, abs=2e-6)


def test_a_critical_speed_is_a_number():
    found = linear_critical_speed(linear_system(hunting), 1.0, 80.0)
    assert abs(found - 30.0) < 1e-6
    assert found > 29.9
    assert f"{found:.2f}" == "30.00"
    assert json.loads(json.dumps(found)) == found.speed
    copy = pickle.loads(pickle.dumps(found))
    assert copy.speed == found.speed and copy.frequency == found.frequency
    assert "30.0000 m/s (1.114 Hz, loses stability)" in str(found)
    with pytest.raises(AttributeError):
        found.speed = 3.0


@pytest.mark.parametrize(
    ("low", "high", "words"),
    [
        (1.0, 20.0, "every lateral oscillation is damped.*-2.9.* at 1 m/s.*-1 1/s at 20 m/s"),
        (40.0, 60.0, "grows at every speed.*lower the lower speed"),
        (60.0, 40.0, "must rise"),
    ],
)
def test_no_critical_speed_says_why(low, high, words):
    with pytest.raises(AnalysisError, match=words):
        linear_critical_speed(linear_system(hunting), low, high)


def test_root_locus_follows_roots_through_a_meeting():
    """Two pairs whose frequencies cross at 25 m/s keep their columns."""
    system = linear_system(
        lambda speed: (-1.0, 5.0 + 0.1 * (speed - 25.0)), lambda speed: (-1.02, 5.0)
    )
    locus = root_locus(system, np.linspace(0.0, 50.0, 41))
    for column in locus.eigenvalues.T:
        assert np.ptp(column.real) < 1e-6


def test_least_damped_root_comes_first():
    linear = linearise(linear_system(body_hunting, hunting), 20.0)
    assert linear.growth_rate == pytest.approx(-1.0, abs=1e-8)
    np.testing.assert_allclose(linear.eigenvalues.real, [-1.0, -1.0, -1.6, -1.6], atol=1e-8)
    np.testing.assert_allclose(
        linear.jacobian @ linear.eigenvectors,
        linear.eigenvectors * linear.eigenvalues,
        atol=1e-9,
    )


def test_equilibrium_moves_with_speed_and_leaves_free_states_alone():
    """x = atan(V/10) is the steady state; z is free and stays where the guess puts it."""
    system = FunctionSystem(
        "turning",
        lambda x, speed: np.array([speed / 10.0 - np.tan(x[0]), 0.0]),
        ["x [rad]", "z [m]"],
        [1e-3, 1e-3],
    )
    np.testing.assert_allclose(
        system.equilibrium(9.0, [0.3, 0.7]), [np.arctan(0.9), 0.7], atol=1e-11
    )
    with pytest.raises(AnalysisError, match="no equilibrium at 3 m/s"):
        FunctionSystem("none", lambda x, v: 1.0 + x**2, ["x [m]"], [1.0]).equilibrium(3.0, [0.5])
    with pytest.raises(AnalysisError, match="no finite value at the guess"):
        FunctionSystem("none", lambda x, v: x * np.nan, ["x [m]"], [1.0]).equilibrium(3.0)


def test_simulate_keeps_what_was_computed():
    """x' = x^2 from 1 is 1/(1 - t): it leaves the numbers at t = 1."""
    system = FunctionSystem("blow-up", lambda x, speed: x**2, ["x [m]"], [1.0])
    times = np.linspace(0.0, 2.0, 41)
    with pytest.raises(SimulationError) as caught:
        system.simulate(np.array([1.0]), 1.0, times)
    kept = caught.value.times
    assert 0.8 < kept[-1] <= 1.0
    np.testing.assert_allclose(caught.value.states[:-1, 0], 1.0 / (1.0 - kept[:-1]), rtol=1e-4)


def test_what_can_be_analysed():
    system = linear_system(hunting)

    class Vehicle:
        def dynamic_system(self):
            return system

    assert as_system(Vehicle()) is system
    assert linear_critical_speed(Vehicle(), 1.0, 80.0) == pytest.approx(30.0)
    with pytest.raises(AnalysisError, match="dict cannot be analysed"):
        as_system({})
    with pytest.raises(AnalysisError, match="scales must be 2 positive"):
        FunctionSystem("wrong", lambda x, v: x, ["a", "b"], [1.0, 0.0])


def test_roots_that_cross_are_followed_straight_on():
    """Two frequencies that pass each other between two speeds, which are not equally spaced.

    The nearest root to the last one would be the other one's; the extrapolated one is its own.
    """
    system = linear_system(
        lambda speed: (-1.0, 7.0 + 0.2 * (speed - 30.0)),
        lambda speed: (-1.0, 7.0 - 0.2 * (speed - 30.0)),
    )
    speeds = np.array([20.0, 24.0, 27.5, 32.5, 34.0, 40.0])
    locus = root_locus(system, speeds)
    slopes = np.diff(locus.eigenvalues.imag, axis=0) / np.diff(speeds)[:, None]
    np.testing.assert_allclose(slopes, np.tile(slopes[0], (len(speeds) - 1, 1)), atol=1e-6)
    assert sorted(np.round(slopes[0], 6)) == [-0.2, -0.2, 0.2, 0.2]


def test_what_is_worse_is_named_with_its_frequency():
    """body_hunting, 3 rad/s, grows below 12 m/s, from the lower end on."""
    found = linear_critical_speed(linear_system(hunting, body_hunting), 5.0, 80.0)
    assert any("(0.477 Hz) grows already at the lower end" in remark for remark in found.remarks)


def test_nothing_that_oscillates_has_no_growth_of_hunting():
    linear = linearise(linear_system(lambda speed: -0.3), 20.0)
    assert linear.growth_rate == -np.inf


def test_a_mode_is_one_scale_large_where_it_is_largest_in_scales():
    """(1, 5) in metres with scales of 1 and 10 m: the first displacement leads, phase zero."""
    system = FunctionSystem(
        "ellipse",
        lambda x, speed: np.array(
            [
                0.1 * (speed - 30.0) * x[0] - 1.4 * x[1],
                35.0 * x[0] + 0.1 * (speed - 30.0) * x[1],
            ]
        ),
        ["x [m]", "y [m]"],
        [1.0, 10.0],
    )
    system.displacement_indices = (0, 1)
    (point,) = hopf_points(system, 5.0, 80.0)
    np.testing.assert_allclose(point.mode, [1.0, -5.0j], atol=1e-6)
    assert point.eigenvalue == pytest.approx(7.0j, abs=1e-6)


def test_a_hopf_point_is_named_by_its_frequency():
    """A wheelset that bounces at 66 Hz does so on its contact: springs hold it below 60 Hz."""
    rate = 2.0 * np.pi * 66.0

    def derivative(x, speed):
        growth = 0.1 * (speed - 30.0)
        return np.array(
            [growth * x[0] - rate * x[1], rate * x[0] + growth * x[1], -x[2], -2.0 * x[3]]
        )

    names = ["axle: z [m]", "axle: roll [rad]", "axle: y [m]", "axle: yaw [rad]"]
    system = FunctionSystem("bouncing", derivative, names, np.ones(4))
    system.wheelset_names = ("axle",)
    (point,) = hopf_points(system, 5.0, 80.0)
    assert point.mode_name == "contact bounce"
