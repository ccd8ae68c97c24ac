"""How joints are closed, against the closed form of a hinged bar and against linear algebra."""

from types import SimpleNamespace

import numpy as np
import pytest
from test_joints import pendulum

from exudyn_wheelset.systems.constraints import Joints, _spanning


def test_a_hinged_bar_is_closed_as_far_as_numbers_go(monkeypatch):
    """Centre at (sin, 1 - cos)/2 under an angle.

    The first guess follows the joint's tangent: what it leaves open is of second order. Newton's
    method goes on to rounding, a hundredth of which would show in differences of forces.
    """
    layout, angle = pendulum().layout, 2e-5
    exact = np.array([0.0, 0.5 * np.sin(angle), np.sin(0.5 * angle) ** 2, angle, 0.0, 0.0])
    state = layout.reduce(exact[None], np.zeros((1, 6)), np.zeros((1, 0)))[0]
    asked, residual = [], layout.joints._residual
    monkeypatch.setattr(
        layout.joints, "_residual", lambda q: asked.append(residual(q)) or asked[-1]
    )
    found = layout.expand(state)[0]
    assert np.abs(asked[0]).max() < angle**2
    assert found == pytest.approx(exact, abs=2e-13)


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("wanted", [(1.0, 1.0), (1.0, 1e-4)])
def test_independent_columns_span_in_any_unit_and_any_order_of_wishes(unit, wanted):
    assert _spanning(unit * np.eye(2), np.array(wanted), 2).tolist() == [0, 1]


def test_of_two_like_columns_the_wanted_one_stands_for_both():
    assert _spanning(np.ones((2, 2)), np.array([1e-4, 1.0]), 2).tolist() == [1]


def test_a_spinning_body_has_three_velocities_before_its_three_rates_of_turn():
    rotations = np.array([[3, 3, 0], [9, 9, 1]])
    joints = SimpleNamespace(_whole=SimpleNamespace(rotations=rotations))
    assert Joints._spinning(joints) == {6, 7, 8, 9, 10, 11}
