"""Stability maps against curves in closed form, and against separate diagrams.

Normal forms in polar coordinates, r' = (mu - G(r^2; p)) r: limit cycles lie on mu = G, the Hopf
curve on mu = G(0; p), folds where dG/d(r^2) vanishes (Kuznetsov, Elements of Applied Bifurcation
Theory, sections 8.2 and 8.3).
"""

import pickle

import numpy as np
import pytest

from exudyn_wheelset import AnalysisError, nonlinear_critical_speed, stability_map
from exudyn_wheelset.stability.linear.crossings import hopf_points
from exudyn_wheelset.stability.maps.curves import DISTURBED, HUNTS, STRAIGHT
from exudyn_wheelset.stability.subject import changed, description_of
from exudyn_wheelset.systems.function_system import FunctionSystem


def form(speed_of_square, twist=0.3):
    """System whose cycles of radius r are at the speed speed_of_square(r^2)."""

    def rates(states, speed):
        x, y = states.T
        square = x**2 + y**2
        growth = speed - speed_of_square(square)
        turn = 4.0 + twist * square
        return np.stack([growth * x - turn * y, turn * x + growth * y], axis=1)

    return FunctionSystem(
        "normal form",
        lambda state, speed: rates(state[None], speed)[0],
        ("y [m]", "yaw [rad]"),
        (1.0, 1.0),
        displacement_indices=(0, 1),
        derivatives_function=rates,
    )


def bautin(p):
    # The Hopf point at 10 is subcritical for p > 0, with a fold at 10 - p^2/4 and r^2 = p/2.
    return form(lambda square: 10.0 - p * square + square**2)


def cusp(p):
    # Folds at r^2 = 1 +- sqrt(p/3), speed 10 -+ 2 (p/3)^1.5; they meet and vanish at p = 0.
    return form(lambda square: 10.0 + (square - 1.0) ** 3 - p * (square - 1.0))


def test_bautin_point():
    found = stability_map(bautin, "speed", "p", (-1.0, 2.0), speeds=(5.0, 14.0))
    (hopf,), (fold,) = found.hopf, found.folds
    np.testing.assert_allclose(hopf.speed, 10.0, atol=1e-4)
    np.testing.assert_allclose(hopf.frequency, 4.0 / (2.0 * np.pi), rtol=1e-6)
    assert hopf.parameter[[0, -1]].tolist() == [-1.0, 2.0] and hopf.loses.all()
    # Corrections leave at most 1e-3 in speed.
    np.testing.assert_allclose(fold.speed, 10.0 - fold.parameter**2 / 4.0, atol=1e-3)
    assert fold.parameter.max() == 2.0 and fold.loses.all()
    # Off the fold by 1e-3 in speed r^2 is off by the root of that.
    square = fold.amplitude**2
    np.testing.assert_allclose(square, fold.parameter / 2.0, atol=0.04)
    ((speed, parameter),) = found.bautin_points
    assert parameter == pytest.approx(0.0, abs=0.1) and speed == pytest.approx(10.0, abs=3e-3)
    regions = found.regions
    assert regions.at(9.5, 1.0) == STRAIGHT and regions.at(9.9, 1.0) == DISTURBED
    assert regions.at(9.9, -0.5) == STRAIGHT and regions.at(10.1, -0.5) == HUNTS
    assert list(regions) == [STRAIGHT, DISTURBED, HUNTS] and regions[HUNTS].shape[1] == 2


def test_cusp():
    # With a bar, as from the command line.
    found = stability_map(cusp, "speed", "p", (-0.5, 1.0), speeds=(6.0, 13.0), progress=True)
    (hopf,), (fold,) = found.hopf, found.folds
    np.testing.assert_allclose(hopf.speed, 9.0 + hopf.parameter, atol=1e-4)
    # Both folds are one curve, from the end of the range through the cusp and back.
    assert fold.parameter[0] == fold.parameter[-1] == 1.0
    assert fold.parameter.min() == pytest.approx(0.0, abs=0.01)
    (row,) = fold.cusps
    assert fold.speed[row] == pytest.approx(10.0, abs=2e-3)
    upper = np.sign(fold.speed - 10.0) * np.maximum(fold.speed * 0.0, fold.parameter / 3.0) ** 1.5
    np.testing.assert_allclose(fold.speed, 10.0 + 2.0 * upper, atol=3e-3)
    amplitudes = np.sort(fold.amplitude[[0, -1]] ** 2)
    np.testing.assert_allclose(amplitudes, 1.0 + np.array([-1.0, 1.0]) * 3.0**-0.5, atol=0.03)
    copy = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(copy.folds[0].speed, fold.speed)


def test_what_a_map_refuses():
    with pytest.raises(AnalysisError, match="the first parameter of a map is 'speed'"):
        stability_map(bautin, "p", "speed", (0.0, 1.0))
    with pytest.raises(AnalysisError, match="low below high"):
        stability_map(bautin, "speed", "p", (1.0, 0.0))
    with pytest.raises(AnalysisError, match="no Hopf point"):
        stability_map(bautin, "speed", "p", (0.0, 1.0), speeds=(20.0, 30.0))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("parameter", "limits", "values"),
    [("conicity", (0.02, 0.2), (0.037, 0.15)), ("friction", (0.05, 0.4), (0.11, 0.31))],
)
def test_bogie_against_separate_diagrams(parameter, limits, values):
    found = stability_map("cooperrider", "speed", parameter, limits, starts=1, points=30)
    bogie = description_of("cooperrider")
    for wanted in values:
        # Points of the curve itself: between them it is interpolated.
        value = min((p for c in found.folds for p in c.parameter), key=lambda p: abs(p - wanted))
        other = changed(bogie, parameter, value)
        first = min(hopf_points(other, *found.speeds))
        assert found.hopf[0].speeds_at(value) == pytest.approx([first.speed], abs=0.005)
        separate = nonlinear_critical_speed(other, check=False).speed
        nearest = min(abs(s - separate) for c in found.folds for s in c.speeds_at(value))
        assert nearest < 0.02
        assert found.regions.at(separate - 0.05, value) == STRAIGHT
        assert found.regions.at(separate + 0.05, value) == DISTURBED


def test_drawing_and_xarray():
    import matplotlib.pyplot as plt

    found = stability_map(bautin, "speed", "p", (0.5, 1.0), speeds=(5.0, 14.0), points=6, starts=1)
    axes = found.plot()
    assert axes.get_ylabel() == "forward speed [m/s]"
    plt.close("all")
    pytest.importorskip("xarray")
    data = found.to_xarray()
    count = len(found.hopf[0]) + len(found.folds[0])
    assert data["speed"].shape == (count,) and set(data["kind"].values) == {"hopf", "fold"}
