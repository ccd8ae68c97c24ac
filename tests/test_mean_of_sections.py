"""Several sections of one wheel: noise falls with the root of their number, places do not matter.

Source of truth: the clean shape the sections were made from, and the statistics of means.
"""

import numpy as np
import pytest

from exudyn_wheelset import ProfileError, Track, Wheelset, mean_profile
from exudyn_wheelset.geometry.conicity import equivalent_conicity
from exudyn_wheelset.geometry.rolling_radius import rolling_radius_curve
from exudyn_wheelset.profiles import Profile, load_profile, shapes

pytestmark = pytest.mark.filterwarnings("ignore::exudyn_wheelset.errors.WheelsetWarning")
NOISE, SPACING = 2e-5, 5e-4


def section(clean, seed, noise=NOISE, spacing=SPACING, place=(1e-4, 1e-4, 5e-4)):
    """Points with noise normal to the shape, seen by an instrument that does not sit right."""
    random = np.random.default_rng(seed)
    points = clean.resampled(spacing * (1.0 + 0.1 * random.random()))
    angle = np.arctan(clean.slope(np.clip(points.y, *clean.span)))
    error = random.normal(0.0, noise, len(points.y))
    dy, dz, turn = np.array(place) * random.uniform(-1, 1, 3)
    y, z = points.y - np.sin(angle) * error, points.z + np.cos(angle) * error
    y, z = np.cos(turn) * y - np.sin(turn) * z + dy, np.sin(turn) * y + np.cos(turn) * z + dz
    keep = np.concatenate(([True], y[1:] > np.maximum.accumulate(y)[:-1] + 1e-7))
    return Profile(f"section {seed}", clean.kind, y[keep], z[keep])


def conicity(wheel):
    wheelset = Wheelset(1000.0, (600.0, 100.0, 600.0), 0.46, wheel)
    curve = rolling_radius_curve(wheelset, Track("UIC60"), 7e-3, 5e-5)
    forward = np.concatenate(([True], np.diff(np.maximum.accumulate(curve.y)) > 0.0))
    return equivalent_conicity(
        curve.y[forward], curve.rolling_radius_difference[forward], np.array([1e-3, 3e-3])
    )


@pytest.mark.parametrize("clean", [shapes.s1002(), shapes.uic60()], ids=["wheel", "rail"])
def test_sections_that_differ_by_place_alone(clean):
    """They are one curve, at the mean of their places."""
    sections = [section(clean, seed, noise=0.0, spacing=2e-4) for seed in range(4)]
    mean = mean_profile(sections, smoothing=0.0)
    y = np.linspace(-0.03, 0.03, 200)
    expected = np.mean([s.height(y) for s in sections], axis=0)
    apart = np.ptp([s.height(y) for s in sections], axis=0)
    assert np.max(apart) > 1e-4
    offset = mean.height(y) - expected
    # means of neighbours cut the 13 mm arcs at the rail's corners by less than h^2/(8 R)
    assert np.max(np.abs(offset - np.mean(offset))) < 1e-6


def test_noise_falls_with_the_root_of_their_number():
    clean = shapes.s1002()
    one = section(clean, 0)
    nine = mean_profile([section(clean, seed) for seed in range(9)])
    assert one.noise == pytest.approx(NOISE, rel=0.2)
    assert nine.noise == pytest.approx(NOISE / 3.0, rel=0.2)


def test_conicity_of_nine_sections():
    """S1002 at 0.5 mm with 20 um, where one section cannot give 0.02 at 1 mm (its bound is 0.041).

    A third of that bound is 0.014; the error of nine sections stays within twice it.
    """
    clean = load_profile("S1002")
    exact = conicity(clean)
    error = conicity(mean_profile([section(clean, seed) for seed in range(9)])) - exact
    assert abs(error[0]) < 2.0 * 0.041 / 3.0
    assert abs(error[1]) < 0.01


def test_what_is_no_set_of_sections_is_refused():
    wheel, rail = shapes.s1002(), shapes.uic60()
    with pytest.raises(ProfileError, match="two or more"):
        mean_profile([wheel])
    with pytest.raises(ProfileError, match=r"is a rail and .* a wheel"):
        mean_profile([wheel, rail])
    with pytest.raises(ProfileError, match="other side"):
        mean_profile([wheel, wheel.mirrored()])
