"""Probability of hunting against a basin in closed form, intervals against their definition.

r' = (mu + r^2 - r^4) r (Strogatz, Nonlinear Dynamics and Chaos, section 8.2): for mu in (-1/4, 0)
what begins beyond r^2 = 1/2 - sqrt(1/4 + mu) goes to the cycle, the rest dies out. With x and y
drawn from normal distributions of spread s, r^2/s^2 is chi-squared with two degrees of freedom:
P(r > a) = exp(-a^2/(2 s^2)).
"""

import numpy as np
import pytest
from scipy.stats import binom, uniform

from exudyn_wheelset import AnalysisError, WheelsetError, basin
from exudyn_wheelset.stability.maps.basins import interval_of
from exudyn_wheelset.systems.function_system import FunctionSystem


def normal_form():
    def rate(state, mu):
        x, y = state
        square = x * x + y * y
        growth = mu + square - square * square
        return np.array([growth * x - 6.0 * y, 6.0 * x + growth * y])

    return FunctionSystem(
        "normal form", rate, ("y [m]", "x [m]"), (1.0, 1.0), displacement_indices=(0,)
    )


def edge(mu):
    return np.sqrt(0.5 - np.sqrt(0.25 + mu))


def test_probability_of_a_known_basin():
    system = normal_form()
    found = basin(system, [-0.2, -0.1], {"y": 0.5, "x": 0.5}, samples=20, seed=2)
    radius = np.hypot(*found.disturbances.T)
    for speed, hunts in zip(found.speeds, found.hunts, strict=True):
        # Within 2 % of the edge a motion needs longer than it is given.
        sure = np.abs(radius / edge(speed) - 1.0) > 0.02
        np.testing.assert_array_equal(hunts[sure], (radius > edge(speed))[sure])
    expected = np.exp(-(edge(found.speeds) ** 2) / (2.0 * 0.5**2))
    assert np.all((found.interval[:, 0] < expected) & (expected < found.interval[:, 1]))
    np.testing.assert_array_equal(found.probability, found.hunts.mean(axis=1))
    again = basin(system, [-0.1], {"y": 0.5, "x": 0.5}, samples=20, seed=2)
    np.testing.assert_array_equal(again.hunts[0], found.hunts[1])


def test_intervals_hold_the_probability_in_95_of_100_seeds():
    # The draws of `basin` with the closed form in place of the simulation: 1000 seeds.
    speed, spread, samples = -0.1, 0.5, 100
    expected = np.exp(-(edge(speed) ** 2) / (2.0 * spread**2))
    held = {"wilson": 0, "clopper-pearson": 0}
    for seed in range(1000):
        random = np.random.default_rng(seed)
        points = np.column_stack([random.normal(0.0, spread, samples) for _ in range(2)])
        count = int(np.count_nonzero(np.hypot(*points.T) > edge(speed)))
        for method in held:
            low, high = interval_of(count, samples, 0.95, method)
            held[method] += low <= expected <= high
    # Wilson covers 0.95 on average over probabilities; 1000 draws blur that by 0.007.
    assert held["wilson"] > 930
    assert held["clopper-pearson"] > 940


@pytest.mark.parametrize("count", [0, 3, 10])
def test_clopper_pearson_by_its_definition(count):
    low, high = interval_of(count, 10, 0.9, "clopper-pearson")
    if count:
        assert binom.sf(count - 1, 10, low) == pytest.approx(0.05)
    if count < 10:
        assert binom.cdf(count, 10, high) == pytest.approx(0.05)
    assert (low == 0.0) == (count == 0) and (high == 1.0) == (count == 10)


def test_wilson_by_its_definition():
    # |p_hat - p| = z sqrt(p (1 - p)/n) at both ends.
    for count in (1, 30):
        for p in interval_of(count, 50):
            assert (count / 50 - p) ** 2 == pytest.approx(1.959964**2 * p * (1 - p) / 50, rel=1e-5)


def test_ways_to_give_a_disturbance():
    system = normal_form()
    small = basin(system, -0.1, {"y": (0.0, 0.1)}, samples=3)
    assert small.probability.tolist() == [0.0] and np.all(small.disturbances[:, 1] == 0.0)
    large = basin(system, -0.1, {"y": uniform(0.6, 0.1)}, samples=3)
    assert large.probability.tolist() == [1.0]
    own = basin(system, -0.1, lambda random: np.array([0.0, 0.7]), samples=2)
    assert own.probability.tolist() == [1.0]
    assert basin(system, -0.1, 1e-3, samples=2).probability.tolist() == [0.0]
    with pytest.raises(AnalysisError, match="2 states"):
        basin(system, -0.1, lambda random: np.zeros(3), samples=2)
    with pytest.raises(AnalysisError, match="is not one of"):
        basin(system, -0.1, {"roll": 1.0}, samples=2)
    with pytest.raises(WheelsetError, match="whole number of at least 1"):
        basin(system, -0.1, 1.0, samples=0)
