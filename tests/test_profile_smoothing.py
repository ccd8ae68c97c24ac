"""Smoothed profiles against scipy's smoothing spline and against the profile under the noise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import make_smoothing_spline
from scipy.optimize import brentq

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles import Profile, load_profile, shapes
from exudyn_wheelset.profiles.curve import chord_length, smoothed_points

TREAD = np.linspace(-0.02, 0.03, 400)


def noisy_wheel(deviation, seed=0, spacing=2e-4):
    """S1002 with points off by a normal deviate [m] across the profile's curve."""
    clean = shapes.s1002().resampled(spacing)
    error = np.random.default_rng(seed).normal(0.0, deviation, len(clean.y))
    angle = np.arctan(clean.slope(clean.y))
    y, z = clean.y - np.sin(angle) * error, clean.z + np.cos(angle) * error
    keep = np.concatenate(([True], y[1:] > np.maximum.accumulate(y)[:-1] + 1e-7))
    return Profile("noisy", "wheel", y[keep], z[keep])


@pytest.mark.parametrize("distance", [1e-6, 1e-5, 5e-5])
def test_against_scipys_smoothing_spline(distance):
    """The same curve as scipy's, at the weight where scipy's has this distance to the points."""
    profile = noisy_wheel(1e-5, spacing=1e-3)
    points = np.column_stack((profile.y, profile.z))
    t = chord_length(points)

    def of_scipy(log_weight):
        # scipy's own solution loses digits with lengths in metres; in millimetres it does not.
        weight = np.exp(log_weight)
        columns = [make_smoothing_spline(1e3 * t, 1e3 * p, lam=weight)(1e3 * t) for p in points.T]
        return 1e-3 * np.column_stack(columns)

    def excess(log_weight):
        rms = np.sqrt(np.mean(np.sum((of_scipy(log_weight) - points) ** 2, axis=1)))
        return np.log(rms / distance)

    theirs = of_scipy(brentq(excess, -25.0, 15.0, xtol=1e-7))
    ours = smoothed_points(t, points, distance)
    # 1e-4 in the logarithm of the weight moves the points by at most that part of the distance.
    assert ours == pytest.approx(theirs, abs=2e-3 * distance)


@settings(deadline=None, max_examples=25)
@given(
    deviation=st.floats(1e-7, 3e-5),
    ratio=st.floats(0.1, 5.0),
    seed=st.integers(0, 1000),
)
def test_points_lie_within_the_stated_distance(deviation, ratio, seed):
    """For any noise and any tolerance; nearest points of the curve are nearer still."""
    profile = noisy_wheel(deviation, seed, 5e-4)
    points = np.column_stack((profile.y, profile.z))
    tolerance = ratio * deviation
    smooth = smoothed_points(chord_length(points), points, tolerance)
    rms = np.sqrt(np.mean(np.sum((smooth - points) ** 2, axis=1)))
    assert rms <= tolerance * (1.0 + 1e-3)
    assert rms >= 0.99 * tolerance


def test_smoothing_restores_height_slope_and_curvature():
    """At a tolerance of the noise, 10 micrometres: far better than the points themselves."""
    clean = load_profile("S1002")
    curve = noisy_wheel(1e-5).smoothed(1.05e-5)
    assert np.max(np.abs(curve.height(TREAD) - clean.height(TREAD))) < 1e-5
    assert np.max(np.abs(curve.slope(TREAD) - clean.slope(TREAD))) < 5e-3
    error = np.sqrt(np.mean((curve.curvature(TREAD) - clean.curvature(TREAD)) ** 2))
    rough = np.sqrt(np.mean((noisy_wheel(1e-5).curvature(TREAD)) ** 2))
    assert error < 3.0 and rough > 100.0 * error


def test_no_smoothing_passes_through_the_points():
    profile = noisy_wheel(1e-5, spacing=1e-3)
    # At the upright flange back, y = -70 mm, noise lets a curve run back between two points.
    assert profile.height(profile.y[5:]) == pytest.approx(profile.z[5:], abs=1e-14)


def test_a_straight_line_is_not_bent():
    cone = shapes.cone(0.05)
    assert cone.smoothed(1e-4).height(0.02) == pytest.approx(0.001, abs=1e-15)


def test_tolerance_out_of_range():
    with pytest.raises(ProfileError, match="1e-5"):
        shapes.uic60().smoothed(0.01)


class TestProfile:
    """What a Profile refuses when it is made."""

    @pytest.mark.parametrize(
        "change, mend",
        [
            (lambda y, z: (y[:5], z[:5]), "at least 8"),
            (lambda y, z: (y, z[:-1]), "give pairs"),
            (lambda y, z: (np.where(y == y[9], np.nan, y), z), "point 10 is nan"),
            (lambda y, z: (y, np.where(y == y[9], np.inf, z)), "point 10 is inf"),
            (lambda y, z: (y[::-1], z), "sort the points"),
            (lambda y, z: (np.where(y == y[9], y[8], y), z), "remove double ones"),
            (lambda y, z: (1e3 * y, 1e3 * z), "look like mm"),
            (lambda y, z: (1e-3 * y, 1e-3 * z), "look like metres"),
            (lambda y, z: (y / 0.0254, z / 0.0254), "look like inch"),
            (lambda y, z: (y + 0.2, z), "tape circle"),
            (lambda y, z: (y, z + 0.02), "shift z"),
            (lambda y, z: (y, -z), "turn the sign of z"),
            (lambda y, z: (-y[::-1], z[::-1]), "mirror y"),
            (lambda y, z: (np.column_stack((y, z)), z), "one row of numbers"),
            (lambda y, z: (["a"] * 20, z), "not a row of numbers"),
        ],
    )
    def test_wheel(self, change, mend):
        wheel = shapes.s1002().resampled(1e-3)
        with pytest.raises(ProfileError, match=mend):
            Profile("w", "wheel", *change(wheel.y, wheel.z))

    @pytest.mark.parametrize(
        "change, mend",
        [
            (lambda y, z: (y, -z), "turn its sign"),
            (lambda y, z: (y, z + 0.02), "shift z"),
            (lambda y, z: (y + 0.1, z), "shift y"),
            (lambda y, z: (y[y > 0.0], z[y > 0.0]), "falls to both sides"),
        ],
    )
    def test_rail(self, change, mend):
        rail = shapes.uic60().resampled(1e-3)
        with pytest.raises(ProfileError, match=mend):
            Profile("r", "rail", *change(rail.y, rail.z))

    def test_one_for_the_other(self):
        wheel, rail = shapes.s1002(), shapes.uic60()
        with pytest.raises(ProfileError, match="say kind='rail'"):
            Profile("r", "wheel", rail.y, rail.z)
        with pytest.raises(ProfileError, match="say kind='wheel'"):
            Profile("w", "rail", wheel.y, wheel.z)
        with pytest.raises(ProfileError, match="'wheel' or 'rail'"):
            Profile("w", "tram", wheel.y, wheel.z)

    def test_its_points_cannot_be_changed(self):
        profile = shapes.uic60()
        with pytest.raises(ValueError, match="read-only"):
            profile.z[0] = 1.0

    def test_it_does_not_share_the_callers_array(self):
        y, z = np.array(shapes.uic60().y), np.array(shapes.uic60().z)
        profile = Profile("r", "rail", y, z)
        z[:] = 0.0
        assert np.min(profile.z) < -0.03
