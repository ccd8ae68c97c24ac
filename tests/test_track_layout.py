"""Layouts: shapes of transitions by their formulas, continuity, files, and what is refused."""

import math

import numpy as np
import pytest

from exudyn_wheelset import Curve, Layout, Straight, Transition, WheelsetError
from exudyn_wheelset.track.transitions import SHAPES


def through(shape, length=60.0, radius=-300.0, cant=0.12):
    return Layout(
        [Straight(50), Transition(length, shape), Curve(radius, 100, cant, widening=0.01)],
    )


FORMULAS = {
    "clothoid": lambda t: t,
    "bloss": lambda t: 3 * t**2 - 2 * t**3,
    "helmert": lambda t: np.where(t < 0.5, 2 * t**2, 1 - 2 * (1 - t) ** 2),
}


@pytest.mark.parametrize("shape", FORMULAS)
def test_curvature_follows_the_formula_of_the_shape(shape):
    layout = through(shape)
    t = np.linspace(0.0, 1.0, 301)
    assert layout.curvature(50 + 60 * t) == pytest.approx(FORMULAS[shape](t) / -300.0, abs=1e-15)


def test_the_cubic_parabola_is_one():
    """Points of the line whose curvature the layout gives lie on y = c x^3."""
    layout = through("cubic", radius=300.0)
    s = np.linspace(50.0, 110.0, 6001)
    heading = np.append(
        0.0, np.cumsum(0.5 * np.diff(s) * (layout.curvature(s[1:]) + layout.curvature(s[:-1])))
    )
    x = np.append(0.0, np.cumsum(np.diff(s) * np.cos(0.5 * (heading[1:] + heading[:-1]))))
    y = np.append(0.0, np.cumsum(np.diff(s) * np.sin(0.5 * (heading[1:] + heading[:-1]))))
    factor = y[-1] / x[-1] ** 3
    # Sums of 1 cm: 1e-6 of 2 m.
    assert y == pytest.approx(factor * x**3, abs=2e-6)
    assert layout.curvature(110.0) == pytest.approx(1 / 300.0, rel=1e-12)


@pytest.mark.parametrize("shape", SHAPES)
def test_curvature_is_continuous_and_the_frame_does_not_kick(shape):
    layout = Layout(
        [
            Straight(30),
            Transition(50, shape),
            Curve(-300, 80, 0.12),
            Transition(60, shape),
            Curve(400, 50, 0.1),
            Transition(50, shape),
        ],
        gradient=[(0, 0.0), (60, 0.0), (120, 0.02), (200, -0.01)],
    )
    step = 1e-3
    s = np.arange(-10.0, layout.length + 10.0, step)
    # Twice the largest slope of any shape, 2/L of a jump of 1/300 + 1/400.
    assert np.abs(np.diff(layout.curvature(s))).max() < 4.0 / 50.0 * (1 / 300 + 1 / 400) * step
    for function in (layout.roll, layout.gradient_at):
        slope = np.diff(function(s)) / step
        # Rounded over 5 m: the slope changes by at most 0.01/5 a metre.
        assert np.abs(np.diff(slope)).max() < 0.02 * step
    assert layout.cant(100.0) == pytest.approx(-0.12) and layout.cant(240.0) == pytest.approx(0.1)
    # The outer rail of a right curve is the left one.
    assert layout.roll(100.0) == pytest.approx(math.asin(0.12 / 1.5))
    assert layout.gradient_at(90.0) == pytest.approx(0.01)


def test_widening_moves_the_inner_rail():
    assert through("bloss").widening(150.0) == pytest.approx(-0.01)
    assert through("bloss", radius=300.0).widening(150.0) == pytest.approx(0.01)


def test_layouts_come_back_from_their_files(tmp_path):
    layout = Layout(
        [Straight(50, start=0.0), Transition(60, "helmert"), Curve(-300, 100.5, 0.12, 0.01)],
        gradient=[(0, 0.0), (60, 0.015)], base=1.51, rounding=3.0,
    )  # fmt: skip
    path = layout.save(tmp_path / "line.toml")
    assert Layout.load(path) == layout
    assert hash(Layout.load(path)) == hash(layout)
    assert layout.mirrored().mirrored() == layout
    path.write_text('[[element]]\nkind = "curve"\nlength = 5\n')
    with pytest.raises(WheelsetError, match=r"line.toml: element 0 \(curve\) has no radius"):
        Layout.load(path)
    path.write_text('[[element]]\nkind = "strait"\nlength = 5\n')
    with pytest.raises(WheelsetError, match="did you mean 'straight'"):
        Layout.load(path)


@pytest.mark.parametrize(
    ("elements", "words"),
    [
        ([], "no element"),
        ([Straight(50), Curve(300, 10)], r"curvature jumps from 0 to 0.00333333 1/m at 50 m: put"),
        ([Curve(300, 10, 0.1), Curve(300, 10, 0.05)], "cant jumps from 0.1 to 0.05 m at 10 m"),
        ([Straight(50), Transition(10), Transition(10)], "two transitions meet at 60 m"),
        ([Straight(50), Straight(50, start=55.0)], "a gap of 5 m; mend the lengths"),
        ([Straight(50), Straight(50, start=45.0)], "an overlap of 5 m"),
        ([Straight(9), Transition(200, "cubic"), Curve(60, 9)], "cannot change the curvature by"),
        ([50.0], "give Straight, Transition or Curve"),
    ],
)
def test_layouts_that_no_track_has_are_refused(elements, words):
    with pytest.raises(WheelsetError, match=words):
        Layout(elements).table  # noqa: B018


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Curve(5.0, 10.0), "at least 20 m"),
        (lambda: Curve(300.0, 10.0, cant=120.0), "metres are asked"),
        (lambda: Straight(-1.0), "length = -1"),
        (lambda: Transition(10.0, "blos"), "did you mean 'bloss'"),
        (lambda: Layout([Straight(9)], gradient=[(5, 0.0), (5, 0.01)]), "station 5 m follows 5 m"),
        (lambda: Layout([Straight(9)], gradient=[(5, 25.0)]), "0.025 for 25 ‰"),
    ],
)
def test_impossible_numbers_are_refused(make, words):
    with pytest.raises(WheelsetError, match=words):
        make()
