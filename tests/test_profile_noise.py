"""Noise of profiles against the noise that was put on; automatic smoothing against the clean shape.

White noise of known deviation is added normal to formulas and to wheels worn and smoothed by
others; so the truth of every number here is known.
"""

import time
import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from exudyn_wheelset import (
    Track,
    Wheelset,
    WheelsetWarning,
    contact_geometry,
    equivalent_conicity,
    piecewise_geometry,
)
from exudyn_wheelset.profiles import Profile, load_profile, save_profile
from exudyn_wheelset.profiles.noise import noise_by_spacing, normal_noise

REFERENCE = Path(__file__).resolve().parents[2] / "shared" / "reference" / "profiles"
needs_worn = pytest.mark.skipif(not REFERENCE.is_dir(), reason="needs the measured profiles")
SHIFTS = np.linspace(-5e-3, 5e-3, 401)


def points_of(profile):
    return np.column_stack((profile.y, profile.z))


def with_noise(clean, deviation, spacing, seed, correlation=0):
    """Points of a profile, off by a normal deviate [m] across its curve; y growing.

    correlation: width of a moving mean over that many points, its deviation restored.
    """
    profile = clean.resampled(spacing)
    error = np.random.default_rng(seed).normal(0.0, deviation, len(profile.y) + 200)
    if correlation:
        error = np.convolve(error, np.ones(correlation) / np.sqrt(correlation), "same")
    error = error[100 : 100 + len(profile.y)]
    angle = np.arctan(clean.slope(np.clip(profile.y, *clean.span)))
    y, z = profile.y - np.sin(angle) * error, profile.z + np.cos(angle) * error
    keep = np.concatenate(([True], y[1:] > np.maximum.accumulate(y)[:-1] + 1e-8))
    return Profile("noisy", clean.kind, y[keep], z[keep])


def conicity(wheel, track):
    wheelset = Wheelset(1500.0, (800.0, 110.0, 800.0), 0.46, wheel)
    contact = contact_geometry(wheelset, track, SHIFTS)
    y = contact.y + 0.46 * contact.roll
    return equivalent_conicity(y, contact.rolling_radius_difference, [1e-3, 3e-3])


@pytest.fixture(scope="module")
def wheel():
    return load_profile("S1002")


class TestEstimate:
    @pytest.mark.parametrize("name", ["S1002", "UIC60", "AAR_1_20"])
    @pytest.mark.parametrize("spacing", [5e-5, 1e-4, 2.5e-4, 5e-4])
    @pytest.mark.parametrize("deviation", [2e-6, 1e-5, 5e-5])
    def test_white_noise_to_20_percent(self, name, spacing, deviation):
        """From 300 to 3000 points: its own standard error is 1.2/sqrt(n), 7 % at most."""
        found = with_noise(load_profile(name), deviation, spacing, seed=3).noise
        assert found == pytest.approx(deviation, rel=0.2)

    @pytest.mark.parametrize("deviation", [5e-6, 2e-5])
    def test_noise_in_height_alone(self, wheel, deviation):
        """Where wheels run it is noise normal to the curve, less a cosine of 5 % on average."""
        error = np.random.default_rng(7).normal(0.0, deviation, len(wheel.z))
        found = Profile("noisy", "wheel", wheel.y, wheel.z + error).noise
        assert found == pytest.approx(0.95 * deviation, rel=0.15)

    @pytest.mark.parametrize("name", ["S1002", "UIC60", "AAR_1_20", "cone_1_20"])
    def test_formulas_have_none(self, name):
        """The files' last digit is 1e-11 m; steps of curvature and of S1002's coefficients, 0.1
        micrometres, are a few points of many."""
        profile = load_profile(name)
        assert profile.noise < 1e-9
        assert profile.curvature_noise < 0.01
        assert profile.smoothed("auto").smoothing == 0.0

    @pytest.mark.parametrize("digits", [1e-5, 1e-6])
    def test_rounding_to_a_digit(self, wheel, digits):
        """Rounding is uniform noise in y and z: of the digit over sqrt(12), in any direction."""
        profile = wheel.resampled(5e-4)
        y, z = digits * np.round(profile.y / digits), digits * np.round(profile.z / digits)
        found = Profile("rounded", "wheel", y, z).noise
        assert found == pytest.approx(digits / np.sqrt(12.0), rel=0.2)

    def test_outliers_do_not_count(self, wheel):
        noisy = with_noise(wheel, 5e-6, 2.5e-4, seed=1)
        z = noisy.z.copy()
        z[50::60] += 2e-4
        assert Profile("spiky", "wheel", noisy.y, z).noise == pytest.approx(5e-6, rel=0.2)

    def test_mirror_image_and_turn_change_nothing(self, wheel):
        noisy = points_of(with_noise(wheel, 5e-6, 2.5e-4, seed=1))
        expected = normal_noise(noisy)
        assert normal_noise(noisy[::-1] * [-1.0, 1.0]) == pytest.approx(expected, rel=1e-9)
        turn = np.array([[np.cos(0.1), -np.sin(0.1)], [np.sin(0.1), np.cos(0.1)]])
        assert normal_noise(noisy @ turn.T) == pytest.approx(expected, rel=0.02)

    def test_correlated_noise_is_told_from_white(self, wheel):
        """A mean over 4 points hides from neighbours and shows in every fourth point."""
        white = noise_by_spacing(points_of(with_noise(wheel, 1e-5, 1e-4, seed=2)))
        assert max(white.values()) < 1.2 * min(white.values())
        alike = noise_by_spacing(points_of(with_noise(wheel, 1e-5, 1e-4, 2, correlation=4)))
        assert alike[4] > 2.0 * alike[1]
        assert alike[4] == pytest.approx(1e-5, rel=0.25)


class TestAutomaticSmoothing:
    @pytest.mark.parametrize(
        "deviation, spacing, seed",
        [(5e-6, 2.5e-4, 0), (1e-5, 1e-4, 1), (1e-5, 2.5e-4, 2), (2e-5, 5e-5, 3), (2e-5, 1e-4, 4)],
    )
    def test_conicity_of_S1002(self, wheel, deviation, spacing, seed):
        """Within 0.02 at 1 mm (0.368 without noise) and 0.01 at 3 mm (0.181)."""
        track = Track("UIC60")
        smooth = with_noise(wheel, deviation, spacing, seed).smoothed("auto")
        error = np.abs(conicity(smooth, track) - conicity(wheel, track))
        assert error[0] < 0.02 and error[1] < 0.01
        assert smooth.smoothing == pytest.approx(deviation, rel=0.15)

    @pytest.mark.parametrize("seed", [0, 1, 2])
    def test_conicity_with_noise_on_the_rail(self, wheel, seed):
        """UIC60's curvature steps from 3.3 to 12.5 1/m where S1002 runs; 5 micrometres, 0.1 mm."""
        rail = load_profile("UIC60")
        smooth = with_noise(rail, 5e-6, 1e-4, seed).smoothed("auto")
        error = np.abs(conicity(wheel, Track(smooth)) - conicity(wheel, Track(rail)))
        assert error[0] < 0.02 and error[1] < 0.01

    @needs_worn
    @pytest.mark.parametrize("deviation", [5e-6, 1e-5, 2e-5])
    @pytest.mark.parametrize("name", ["worn7216.prw", "worn7813.prw"])
    def test_conicity_of_worn_wheels(self, name, deviation):
        clean = load_profile(REFERENCE / name)
        track = Track(load_profile(REFERENCE / "siteb.prr"), inclination=0.0)
        smooth = with_noise(clean, deviation, 2.5e-4, 5).smoothed("auto")
        error = np.abs(conicity(smooth, track) - conicity(clean, track))
        assert error[0] < 0.02 and error[1] < 0.01

    def test_radii_of_arcs_are_kept(self):
        """UIC60's R80 and R13 come back under 10 micrometres: what is penalised is their change."""
        smooth = with_noise(load_profile("UIC60"), 1e-5, 1e-4, 4).smoothed("auto")
        for low, high, radius in ((-0.0225, -0.014, 0.080), (-0.0338, -0.0285, 0.013)):
            curvature = smooth.curvature(np.linspace(low, high, 100))
            assert np.mean(curvature) == pytest.approx(-1.0 / radius, rel=0.1)

    @pytest.mark.parametrize("seed", [0, 1, 2])
    def test_errors_alike_over_half_a_millimetre_are_smoothed_too(self, wheel, seed):
        """An instrument that smooths over 0.2 mm: the tread's curvature, 3 1/m, is found to 1 1/m.

        Cross validation alone takes such errors for shape and is off by 7 to 50 1/m.
        """
        clean = wheel.resampled(2.5e-4)
        error = np.random.default_rng(seed).normal(0.0, 1.0, len(clean.y))
        error = gaussian_filter1d(error, 0.8)
        noisy = Profile("smoothed by the instrument", "wheel", clean.y, clean.z + 5e-6 * error)
        smooth = noisy.smoothed("auto")
        assert "alike over" in smooth.remarks[-1]
        y = np.linspace(-0.01, 0.03, 400)
        difference = smooth.curvature(y) - wheel.curvature(y)
        assert np.sqrt(np.mean(difference**2)) < 1.0

    def test_it_survives_mirror_image_and_shift(self, wheel):
        smooth = with_noise(wheel, 1e-5, 2.5e-4, 0).smoothed("auto")
        mirrored = smooth.mirrored()
        assert mirrored.smoothing == pytest.approx(smooth.smoothing, rel=1e-6)
        y = np.linspace(-0.03, 0.05, 50)
        assert mirrored.height(-y) == pytest.approx(smooth.height(y), abs=1e-8)
        assert smooth.smoothed(0.0).is_automatic is False

    def test_spikes_are_left_out(self, wheel, tmp_path):
        noisy = with_noise(wheel, 3e-6, 2.5e-4, 0)
        z = noisy.z.copy()
        z[[200, 300, 400]] += 3e-4
        path = save_profile(Profile("spiky", "wheel", noisy.y, z), tmp_path / "spiky.txt")
        found = load_profile(path, smoothing="auto")
        assert any("3 single points" in remark for remark in found.remarks)
        y = np.linspace(-0.01, 0.03, 300)
        assert np.max(np.abs(found.height(y) - wheel.height(y))) < 5e-6


class TestWarnings:
    def test_noise_without_smoothing_is_warned_about(self, wheel, tmp_path):
        """Its curvature is off by sqrt(6) 10e-6/0.25e-3^2 = 392 1/m."""
        path = save_profile(with_noise(wheel, 1e-5, 2.5e-4, 0), tmp_path / "noisy.txt")
        with pytest.warns(WheelsetWarning, match=r"smoothing='auto'") as caught:
            load_profile(path)
        said = str(caught[0].message)
        assert "micrometres" in said and "1/m" in said
        assert caught[0].filename == __file__
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            load_profile(path, smoothing="auto")
            load_profile("S1002")

    @pytest.mark.parametrize("spacing", [1e-4, 2e-4, 5e-4])
    def test_contact_of_a_noisy_pair_is_quick_and_says_why_it_is_rough(self, wheel, spacing):
        noisy = with_noise(wheel, 1e-5, spacing, 0)
        wheelset = Wheelset(1500.0, (800.0, 110.0, 800.0), 0.46, noisy)
        track = Track("UIC60")
        begin = time.process_time()
        with pytest.warns(WheelsetWarning, match=r"contact jumps \d+ times .*'noisy'.*'auto'"):
            contact_geometry(wheelset, track, SHIFTS)
        with pytest.warns(WheelsetWarning, match=r"contact jumps \d+ times .*'noisy'.*'auto'"):
            found = piecewise_geometry(wheelset, track)
        assert time.process_time() - begin < 5.0
        # Between the jumps the lines are the searched contact to the residual they state.
        y = np.linspace(-0.004, 0.004, 37)
        with pytest.warns(WheelsetWarning):
            exact = contact_geometry(wheelset, track, y)
        far = np.min(np.abs(y[:, None] - found.jumps), axis=1) > 1e-4
        worst = np.max(found.residuals[:, 1])
        assert np.max(np.abs(found(y)[far, 1] - exact.z[far])) <= worst

    def test_a_smooth_pair_is_not_warned_about(self, wheel):
        wheelset = Wheelset(1500.0, (800.0, 110.0, 800.0), 0.46, wheel)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            contact_geometry(wheelset, Track("UIC60"), SHIFTS)
