"""Irregularity against its spectra, its points and its formulas."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import chi2

from exudyn_wheelset import Irregularity, WheelsetError
from exudyn_wheelset.track.spectra import KINDS, SPECTRA, spectra


@pytest.mark.parametrize("name", SPECTRA)
@pytest.mark.parametrize("kind", KINDS)
def test_variance_is_the_integral_of_the_density(name, kind):
    spectrum = SPECTRA[name][kind]
    low, high = 2 * math.pi / 70.0, 2 * math.pi / 3.0
    known, _ = quad(spectrum.density, low, high, epsabs=0.0, epsrel=1e-10)
    assert spectrum.variance(low, high) == pytest.approx(known, rel=1e-9)


def test_erri_rms_of_the_whole_spectrum_and_of_3_to_25_m():
    """Root mean squares in mm: A O_c pi/(2 O_r (O_r + O_c)), and three codes' band of 3 to 25 m."""
    band = 2 * math.pi / 25.0, 2 * math.pi / 3.0
    for name, vertical, alignment, short_vertical, short_alignment in (
        ("ERRI B176 low", 5.477, 3.970, 0.984, 0.714),
        ("ERRI B176 high", 8.964, 6.750, 1.611, 1.213),
    ):
        own = spectra(name)
        for kind, whole, part in (
            ("vertical", vertical, short_vertical),
            ("alignment", alignment, short_alignment),
        ):
            assert 1e3 * math.sqrt(own[kind].variance()) == pytest.approx(whole, abs=1e-3)
            assert 1e3 * math.sqrt(own[kind].variance(*band)) == pytest.approx(part, abs=1e-3)


def test_erri_high_is_that_of_gensys():
    """Points of ORE B176 high level in the documentation of GENSYS's program TRC_IPSD, m^2/(1/m).

    At 1/m of 0.02, 0.1 and 0.2, with five digits; one-sided in cycles, so 2 pi times as much.
    """
    waves = np.array([0.02, 0.1, 0.2])
    for kind, known in (
        ("alignment", [2.3194e-4, 6.1608e-6, 7.3333e-7]),
        ("vertical", [4.0897e-4, 1.0863e-5, 1.2931e-6]),
    ):
        density = 2.0 * np.pi * spectra("ERRI B176 high")[kind].density(2.0 * np.pi * waves)
        np.testing.assert_allclose(density, known, rtol=1e-4)


def test_fra_spectra_by_their_formula():
    """k A O_c^2/(O^2 (O^2 + O_c^2)), class 5, A of 0.0762 and 0.2095 cm^2 rad/m."""
    frequency = np.array([0.1, 0.5, 2.0])
    for kind, amplitude in (("alignment", 0.0762e-4), ("vertical", 0.2095e-4)):
        known = 0.25 * amplitude * 0.8245**2 / (frequency**2 * (frequency**2 + 0.8245**2))
        assert spectra("AAR 5")[kind].density(frequency) == pytest.approx(known, rel=1e-12)
    with pytest.raises(WheelsetError, match="no finite variance down to 0"):
        spectra("fra class 6")["vertical"].variance()


def columns(rough):
    left_y, left_z, right_y, right_z = rough.shifts.T
    return {
        "alignment": 0.5 * (left_y + right_y),
        "vertical": 0.5 * (left_z + right_z),
        "cross_level": left_z - right_z,
        "gauge": left_y - right_y,
    }


@pytest.mark.parametrize("name", ["ERRI B176 low", "FRA class 5"])
def test_estimated_density_of_20_km_lies_in_the_estimator_s_confidence_band(name):
    """Welch's estimate over n segments is chi-squared with 2 n/1.06 degrees (Hann, no overlap)."""
    spacing, segments = 0.25, 80
    rough = Irregularity.from_psd(name, 11, length=20000.0, spacing=spacing, fade_in=0.0)
    count = int(20000.0 / spacing / segments)
    window = np.hanning(count)
    frequency = 2 * math.pi * np.fft.rfftfreq(count, spacing)
    inside = (frequency > 2 * math.pi / 40.0) & (frequency < 2 * math.pi / 4.0)
    for kind, signal in columns(rough).items():
        parts = signal[: count * segments].reshape(segments, count) * window
        power = np.abs(np.fft.rfft(parts, axis=1)) ** 2 * spacing / (math.pi * (window**2).sum())
        ratio = power.mean(axis=0)[inside] / spectra(name)[kind].density(frequency[inside])
        low, high = chi2.ppf([0.005, 0.995], 2 * segments) / (2 * segments)
        # Of 99 % of the frequencies asked for; 3 % may miss.
        assert np.mean((ratio < low) | (ratio > high)) < 0.03
        assert ratio.mean() == pytest.approx(1.0, abs=0.02)


def test_variance_of_a_signal_is_that_of_its_band_whatever_the_seed():
    limits = (3.0, 70.0)
    for seed in (1, 2):
        rough = Irregularity.from_psd(
            "ERRI B176 high", seed, length=7000.0, wavelengths=limits, fade_in=0.0
        )
        for kind, signal in columns(rough).items():
            known = spectra("ERRI B176 high")[kind].variance(
                *(2 * math.pi / limit for limit in reversed(limits))
            )
            # Sums over 7 km instead of the integral.
            assert signal[:-1].var() == pytest.approx(known, rel=2e-2)


def test_one_seed_repeats_to_the_bit_two_differ():
    one, same, other = (Irregularity.from_psd("FRA class 4", seed) for seed in (3, 3, 4))
    assert np.array_equal(one.shifts, same.shifts) and one == same and hash(one) == hash(same)
    assert np.abs(one.shifts - other.shifts).max() > 1e-3
    alone = Irregularity.from_psd("FRA class 4", 3, kinds=("alignment",))
    assert columns(alone)["alignment"] == pytest.approx(columns(one)["alignment"], abs=1e-12)
    assert np.all(columns(alone)["vertical"] == 0.0)


def test_it_grows_from_nothing_over_the_fade_in():
    rough = Irregularity.from_psd("ERRI B176 low", 3, fade_in=50.0, start=100.0)
    shifts, slopes = rough.shape(np.array([90.0, 100.0]))
    assert np.all(shifts == 0.0) and np.abs(slopes).max() < 1e-7
    # 10 t^3 of 10 mm at t = 1 m/50 m.
    assert np.abs(rough.shape(np.linspace(100, 101, 50))[0]).max() < 1e-6
    assert np.abs(rough.shifts).max() > 3e-3


def test_points_pass_through_at_unequal_distances():
    distance = np.cumsum(np.random.default_rng(1).uniform(0.1, 0.6, 300))
    values = {kind: 1e-3 * np.sin(0.3 * (k + 1) * distance) for k, kind in enumerate(KINDS)}
    rough = Irregularity.from_points(distance, **values)
    shifts, _ = rough.shape(distance)
    assert shifts == pytest.approx(rough.shifts, abs=1e-18)
    for kind, column in columns(rough).items():
        assert column == pytest.approx(values[kind], abs=1e-18)
    between = 0.5 * (distance[20:-20][1:] + distance[20:-20][:-1])
    alignment = 0.5 * (rough.shape(between)[0][:, 0] + rough.shape(between)[0][:, 2])
    # Cubic splines: (h^4/384) of the fourth derivative.
    assert alignment == pytest.approx(1e-3 * np.sin(0.3 * between), abs=1e-8)


def test_two_functions_and_files(tmp_path):
    rough = Irregularity.from_functions(
        lambda s: (1e-3 * np.sin(s), 0.0), lambda s: (0.0, 2e-3 * np.cos(s)), 20.0
    )
    shifts, slopes = rough.shape(np.array([3.0]))
    assert shifts[0] == pytest.approx([1e-3 * math.sin(3), 0, 0, 2e-3 * math.cos(3)], abs=1e-9)
    assert slopes[0] == pytest.approx([1e-3 * math.cos(3), 0, 0, -2e-3 * math.sin(3)], abs=1e-7)
    path = tmp_path / "recorded.csv"
    path.write_text("Distance [m],cross level [mm],Alignment [mm]\n0,1,2\n0.5,3,4\n1.5,5,6\n")
    read = Irregularity.load(path)
    assert columns(read)["cross_level"] == pytest.approx([1e-3, 3e-3, 5e-3])
    assert columns(read)["alignment"] == pytest.approx([2e-3, 4e-3, 6e-3])
    path.write_text("distance,alignment\n0,1e-3\n1,\n")
    with pytest.raises(WheelsetError, match="line 3: no number under alignment"):
        Irregularity.load(path)
    path.write_text("distance,alignment\n0,0\n2,0\n1,0\n")
    with pytest.raises(WheelsetError, match=r"recorded.csv: .*1 m follows 2 m in row 2"):
        Irregularity.load(path)
    path.write_text("x,alignment\n0,0\n")
    with pytest.raises(WheelsetError, match="name a column distance"):
        Irregularity.load(path)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Irregularity.from_points([0, 1, 1], 0.0), "1 m follows 1 m in row 2"),
        (lambda: Irregularity.from_points([0, np.nan, 2], 0.0), "row 1 is missing"),
        (lambda: Irregularity.from_points([0, 1, 2], [0, np.nan, 0]), "row 1 at 1 m holds no"),
        (lambda: Irregularity.from_points([0, 1], [0, 1, 2]), "3 values for 2 distances"),
        (lambda: Irregularity.from_points([0, 1], [0, 3.0]), "3 m off at 1 m .* give metres"),
        (lambda: Irregularity.from_psd("ERRI low", 1, spacing=1.0), "at most 0.75 m"),
        (lambda: Irregularity.from_psd("ERRI lowest", 1), "known are ERRI B176 low"),
        (lambda: Irregularity.from_psd("FRA class 5", 1.5), "give a whole number"),
    ],
)
def test_impossible_irregularities_are_refused(make, words):
    with pytest.raises(WheelsetError, match=words):
        make()
