"""Continuation against the normal form of a subcritical Hopf point with a fold.

    r' = (mu + r^2 - r^4) r,   theta' = 1 + c (r^2 - 1/2)

written in Cartesian coordinates (Strogatz, Nonlinear Dynamics and Chaos, section 8.2). Limit
cycles lie on mu = r^4 - r^2: born at mu = 0, fold at mu = -1/4 with r^2 = 1/2. The period is
2 pi/(1 + c (r^2 - 1/2)); a disturbance of r grows with mu + 3 r^2 - 5 r^4 = 2 r^2 - 4 r^4, so the
multiplier is exp(T (2 r^2 - 4 r^4)) whatever c is. A third state z' = -s z adds exp(-s T).
"""

from dataclasses import replace

import numpy as np
import pytest

from exudyn_wheelset.stability.hunting.aligned import Point
from exudyn_wheelset.stability.hunting.continuation import ContinuationSettings
from exudyn_wheelset.stability.hunting.disturbance import critical_disturbance
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.measured_growth import measured_growth
from exudyn_wheelset.stability.hunting.nonlinear import nonlinear_critical_speed
from exudyn_wheelset.stability.hunting.orbit import Orbit
from exudyn_wheelset.stability.hunting.simulated_stability import simulated_fold
from exudyn_wheelset.stability.linear.crossings import hopf_points
from exudyn_wheelset.systems.function_system import FunctionSystem

DECAY = 0.3


def normal_form(twist=0.0, sign=1.0, scale=1.0):
    """The normal form; sign = -1 makes the Hopf point supercritical (r' = mu r - r^3 - r^5)."""

    def derivatives(states, mu):
        x, y, z = (states / scale).T
        square = x**2 + y**2
        growth = mu + sign * square - square**2
        turn = 1.0 + twist * (square - 0.5)
        return scale * np.stack([growth * x - turn * y, turn * x + growth * y, -DECAY * z], axis=1)

    return FunctionSystem(
        "normal form",
        lambda state, mu: derivatives(state[None], mu)[0],
        ("x", "y", "z"),
        np.full(3, scale),
        displacement_indices=(0, 1),
        derivatives_function=derivatives,
        parameters={"twist": twist, "sign": sign},
    )


@pytest.fixture(scope="module", params=[(0.0, 1.0), (0.7, 1.0), (-0.5, 1e-3)])
def branch(request):
    twist, scale = request.param
    system = normal_form(twist, scale=scale)
    hopf = hopf_points(system, -0.45, 0.5)[0]
    return limit_cycles(system, hopf, (-0.5, 0.4)), twist, scale


def test_every_cycle_lies_on_the_curve(branch):
    branch, twist, scale = branch
    square = np.sum((branch.states / scale) ** 2, axis=1)
    # Newton stops at 1e-8 of the orbit; collocation of a circle on 30 intervals adds less.
    np.testing.assert_allclose(branch.speed, square**2 - square, atol=1e-7)
    np.testing.assert_allclose(branch.period, 2 * np.pi / (1 + twist * (square - 0.5)), rtol=1e-7)
    # The peak of a cosine from samples a hundredth of a period apart, by parabolas: 1e-6.
    np.testing.assert_allclose(branch.amplitude["x"], scale * np.sqrt(square), rtol=2e-6)
    assert branch.reason == "the speed range was left at its upper end: 0.4 m/s"
    assert branch.speed[-1] == pytest.approx(0.4, abs=1e-12)


def test_fold(branch):
    branch, _twist, scale = branch
    (fold,) = branch.folds
    assert fold == pytest.approx(-0.25, abs=1e-6)
    assert fold.side == "lowest"
    square = float(np.sum((branch.states[fold.index] / scale) ** 2))
    assert square == pytest.approx(0.5, abs=1e-6)
    assert fold.period == pytest.approx(2 * np.pi, rel=1e-6)
    assert fold.amplitude["x"] == pytest.approx(scale * np.sqrt(0.5), rel=2e-6)


def test_multipliers_and_stability(branch):
    branch, _, scale = branch
    square = np.sum((branch.states / scale) ** 2, axis=1)
    expected = np.stack(
        [np.exp(branch.period * (2 * square - 4 * square**2)), np.exp(-DECAY * branch.period)]
    ).T
    expected = np.take_along_axis(expected, np.argsort(-expected, axis=1), axis=1)
    np.testing.assert_allclose(branch.multipliers.real, expected, atol=1e-6)
    fold = branch.folds[0].index
    # Two multipliers are 1 at the fold, and feel the root of an error of 1e-9.
    assert np.all(np.delete(branch.trivial_error, fold) < 1e-6)
    assert branch.trivial_error[fold] < 1e-4
    assert not np.any(branch.stable[: fold + 1])
    assert np.all(branch.stable[fold + 1 :])
    assert branch.changes == []


def test_branch_begins_at_the_hopf_point(branch):
    branch, twist, _ = branch
    assert branch.hopf == pytest.approx((0.0, (1 - 0.5 * twist) / (2 * np.pi)), abs=1e-8)
    assert branch.amplitude["x"][0] < 0.1 * branch.amplitude["x"].max()


def test_from_a_simulated_state_both_ends_are_found():
    system = normal_form(0.7)
    branch = limit_cycles(system, [1.2, 0.0, 0.1], (-0.5, 0.4), start_speed=0.2)
    assert branch.hopf is None
    assert branch.folds[0] == pytest.approx(-0.25, abs=1e-6)
    first, last = branch.reason.split("; ")
    assert "Hopf point" in first and "upper end" in last
    square = np.sum(branch.states**2, axis=1)
    np.testing.assert_allclose(branch.speed, square**2 - square, atol=1e-7)


def test_supercritical_branch_has_no_fold_and_starts_stable():
    system = normal_form(sign=-1.0)
    hopf = hopf_points(system, -0.45, 0.5)[0]
    result = nonlinear_critical_speed(system, low=-0.45, high=0.5, hopf=hopf)
    assert result == pytest.approx(0.0, abs=1e-6)
    assert "supercritical" in result.how
    assert result.branch.folds == []
    square = np.sum(result.branch.states**2, axis=1)
    np.testing.assert_allclose(result.branch.speed, square + square**2, atol=1e-7)
    assert np.all(result.branch.stable)


def test_continuation_and_descent_agree():
    system = normal_form(0.7)
    hopf = hopf_points(system, -0.45, 0.5)[0]
    followed = nonlinear_critical_speed(system, low=-0.45, high=0.4, hopf=hopf)
    assert followed.method == "continuation"
    assert followed == pytest.approx(-0.25, abs=1e-6)
    descended = nonlinear_critical_speed(
        system, "descent", low=-0.45, high=0.21, hopf=hopf, step=0.05, tolerance=2e-3
    )
    assert descended.method == "descent"
    # Half the bracket, and the slow passage just past the fold: within two brackets.
    assert descended == pytest.approx(-0.25, abs=4e-3)
    branch = descended.branch
    # Above the fold, where the amplitude has no infinite slope; it settles to 1e-3.
    chosen = branch.speeds > -0.245
    assert np.all(branch.settled[chosen])
    square = 0.5 + np.sqrt(0.25 + branch.speeds[chosen])
    np.testing.assert_allclose(branch.amplitude["x"][chosen] ** 2, square, rtol=4e-3)


@pytest.mark.parametrize("square", [0.0005, 0.0015])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_measured_growth_is_the_multiplier(square, sign):
    """exp(2 pi (2 sign r^2 - 4 r^4)) beside a Hopf point, where motion checks the multipliers.

    Sizes 2 % off the orbit change the growth by their square.
    """
    phases = 2.0 * np.pi * np.arange(121) / 120
    states = np.sqrt(square) * np.stack([np.cos(phases), np.sin(phases), 0.0 * phases], axis=1)
    speed = square**2 - sign * square
    orbit = Orbit(np.linspace(0.0, 1.0, 41), states, 2.0 * np.pi, speed)
    growth = measured_growth(normal_form(sign=sign), Point(orbit, None, 1.0))
    expected = 2.0 * np.pi * (2.0 * sign * square - 4.0 * square**2)
    assert np.log(growth) == pytest.approx(expected, rel=1e-2)


def test_motion_decides_beside_a_fold_on_either_side_of_it():
    """Where the orbit above the fold alone has an uncertain stability, whichever way it is met."""
    system = normal_form()
    found = limit_cycles(system, hopf_points(system, -0.45, 0.5)[0], (-0.5, 0.4))
    for order in (1, -1):
        branch = Orbits(found.orbits[::order])
        (fold,) = found.folds
        index = fold.index if order == 1 else len(found) - 1 - fold.index
        branch.folds = (replace(fold, index=index),)
        branch.uncertain[index + order] = True
        assert simulated_fold(system, branch, 0.0) == fold == pytest.approx(-0.25, abs=1e-6)
        assert simulated_fold(system, branch, -0.3) is None
        branch.uncertain[:] = False
        assert simulated_fold(system, branch, 0.0) is None


class Orbits:
    """What `simulated_fold` asks of a branch."""

    def __init__(self, orbits):
        self.orbits, self.uncertain, self.folds = orbits, np.zeros(len(orbits), dtype=bool), ()

    def __len__(self):
        return len(self.orbits)


def test_critical_disturbance_is_the_unstable_branch():
    speeds = [-0.3, -0.2, -0.1, 0.05]
    runs = critical_disturbance(normal_form(), speeds, 1.5, direction="x", tolerance=2e-3)
    unstable = np.sqrt(0.5 - np.sqrt(0.25 + np.array(speeds[1:3])))
    assert np.isinf(runs.critical[0])
    np.testing.assert_allclose(runs.critical[1:3], unstable, rtol=2e-3)
    np.testing.assert_allclose(runs.edge[1:3], unstable, rtol=0.05)
    assert runs.critical[3] == 0.0


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_order_of_the_period(degree):
    """The period superconverges with h^(2 m) (de Boor and Swartz 1973) on even meshes."""
    system = normal_form(0.7)
    hopf = hopf_points(system, -0.45, 0.5)[0]
    errors = []
    counts = (6, 12)
    for intervals in counts:
        settings = ContinuationSettings(
            intervals=intervals, degree=degree, tolerance=1e-11, adapt_every=1000
        )
        branch = limit_cycles(system, hopf, (-0.5, 0.1), settings=settings)
        # At the end the speed is exact, so the period is known: r^2 from mu = 0.1.
        square = 0.5 + np.sqrt(0.25 + 0.1)
        errors.append(abs(branch.period[-1] - 2 * np.pi / (1 + 0.7 * (square - 0.5))))
    order = np.log(errors[0] / errors[1]) / np.log(counts[1] / counts[0])
    assert order > 2 * degree - 0.5
