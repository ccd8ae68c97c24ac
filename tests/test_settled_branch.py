"""The branch by settled motions against closed forms: a normal form with a fold, r^2 = 1/2 +
sqrt(1/4 + mu) on its stable part, down to the fold at mu = -1/4, and with a step in it that no
polynomial takes."""

import numpy as np
import pytest

from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.settled_branch import settled_branch
from exudyn_wheelset.systems.function_system import FunctionSystem


def normal_form(step=0.0):
    """r' = r (mu + r^2 - r^4), phase' = 1; `step` jumps in the phase velocity at x = 0.3."""

    def derivative(state, mu):
        x, y = state
        square = x * x + y * y
        growth = mu + square - square**2
        turn = 1.0 + (step if x > 0.3 else 0.0)
        return np.array([growth * x - turn * y, growth * y + turn * x])

    return FunctionSystem("normal form", derivative, ("x [m]", "y [m]"), np.ones(2))


def test_stable_cycles_and_the_fold_below_them():
    branch = settled_branch(normal_form(), np.array([1.0, 0.0]), 0.1, (-0.4, 0.2), "a test")
    assert branch.method == "settled motions"
    expected = np.sqrt(0.5 + np.sqrt(0.25 + branch.speed))
    # Near the fold the amplitude lags by the tolerance of settling over the slow approach.
    np.testing.assert_allclose(branch.amplitude["x"], expected, rtol=0.02)
    np.testing.assert_allclose(
        branch.amplitude["x"][branch.speed > -0.2], expected[branch.speed > -0.2], rtol=3e-3
    )
    assert branch.folds[0] == pytest.approx(-0.25, abs=2e-3)
    assert branch.lowest_stable()[0] == pytest.approx(-0.25, abs=2e-3)
    assert branch.outcome.ending is Ending.UPPER_END
    assert branch.first_outcome.ending is Ending.JUMP_FOUND


def test_a_model_that_jumps_has_a_branch_from_a_motion():
    """The radius does not feel the step in the phase velocity: the same closed form holds."""
    branch = limit_cycles(normal_form(step=0.5), [1.0, 0.0], (-0.4, 0.2), start_speed=0.1)
    square = np.asarray(branch.amplitude["x"]) ** 2
    np.testing.assert_allclose(branch.speed, square**2 - square, atol=3e-3)
    assert min(branch.folds) == pytest.approx(-0.25, abs=2e-3)
