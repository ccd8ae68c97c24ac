"""Measured profiles against what experts made of the same measurements.

The files are read where they are, beside the repository; four of them exist smoothed and resampled
by others (worn7216.prw from Car7216_0001r.whl, low2.prr from avg_low2.ban, siteb.prr from
site_b_hr.prr).
"""

from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from exudyn_wheelset import Track, Wheelset, contact_geometry, equivalent_conicity
from exudyn_wheelset.profiles import load_profile

REFERENCE = Path(__file__).resolve().parents[2] / "shared" / "reference" / "profiles"
FILES = sorted(path.name for path in REFERENCE.glob("*")) if REFERENCE.is_dir() else []
measured = pytest.mark.skipif(not FILES, reason="needs the measured profiles")
pytestmark = pytest.mark.filterwarnings("ignore::exudyn_wheelset.errors.WheelsetWarning")


@lru_cache
def smoothed(name):
    return load_profile(REFERENCE / name, smoothing="auto")


def conicity(wheel, rail, inclination=0.0, depth=0.014):
    """At 1 and 3 mm, y at rail level."""
    wheelset = Wheelset(1500.0, (800.0, 110.0, 800.0), 0.46, wheel)
    track = Track(rail, inclination=inclination, gauge_depth=depth)
    contact = contact_geometry(wheelset, track, np.linspace(-5e-3, 5e-3, 401))
    y = contact.y + 0.46 * contact.roll
    return equivalent_conicity(y, contact.rolling_radius_difference, [1e-3, 3e-3])


@measured
@pytest.mark.parametrize("name", FILES)
class TestMeasured:
    def test_it_loads_as_what_it_is(self, name):
        found = load_profile(REFERENCE / name)
        assert found.kind == ("wheel" if name.lower().endswith(("whl", "prw")) else "rail")
        assert found.span[1] - found.span[0] > (0.017 if name == "fr_ol.csv" else 0.055)
        if found.kind == "wheel":
            assert -0.031 < np.min(found.z) < -0.026, "a flange is 26 to 31 mm high"

    def test_its_curvature_makes_sense(self, name):
        """Where wheels run, no radius below 30 mm: worn heads and treads have none."""
        found = smoothed(name)
        if found.kind == "wheel":
            y = np.linspace(-0.010, 0.040, 300)
        else:
            half = 0.006 if name == "fr_ol.csv" else 0.010
            y = np.mean(found.span) + np.linspace(-half, half, 200)
        assert np.max(np.abs(found.curvature(y))) < 33.0

    def test_it_carries_a_wheelset(self, name):
        found = smoothed(name)
        partner = load_profile(
            REFERENCE / ("siteb.prr" if found.kind == "wheel" else "worn7813.prw")
        )
        wheel, rail = (found, partner) if found.kind == "wheel" else (partner, found)
        depth = {"fr_ol.csv": 0.0014, "low2.prr": 0.011}.get(name, 0.014)
        small, _ = conicity(wheel, rail, depth=depth)
        assert 0.02 < small < (0.08 if name != "fr_ol.csv" else 1.0)


@measured
class TestAgainstExperts:
    """Smoothing "auto" of what was measured against what others made of it."""

    @pytest.mark.parametrize(
        "raw, smooth, low, high",
        [
            ("Car7216_0001r.whl", "worn7216.prw", -0.030, 0.045),
            ("avg_low2.ban", "low2.prr", -0.018, 0.040),
            ("site_b_hr.prr", "siteb.prr", -0.030, 0.030),
        ],
    )
    def test_shape(self, raw, smooth, low, high):
        ours = smoothed(raw)
        theirs = load_profile(REFERENCE / smooth)
        y = np.linspace(low, high, 400)
        # Alignment is theirs: their files are moved and turned a little, which is taken off.
        difference = ours.height(y) - theirs.height(y)
        straight = np.polynomial.Polynomial.fit(y, difference, 1)(y)
        # Both sides are some 10 micrometres (rms) off the raw points.
        assert np.sqrt(np.mean((difference - straight) ** 2)) < 2e-5

    def test_conicity_of_a_wheel_with_correlated_errors(self):
        """Unsmoothed 0.139 and 0.053 at 1 and 3 mm; made smooth by experts 0.035 and 0.035."""
        rail = load_profile(REFERENCE / "siteb.prr")
        ours = conicity(smoothed("Car7216_0001r.whl"), rail)
        theirs = conicity(load_profile(REFERENCE / "worn7216.prw"), rail)
        assert ours == pytest.approx(theirs, abs=0.015)

    def test_undercut_face_is_cut_where_they_cut_it(self):
        """low2.prr ends 11.47 mm below the top at y = -25.55 mm, before the lip recedes."""
        found = load_profile(REFERENCE / "avg_low2.ban")
        assert found.ends_at_gauge_face
        assert found.span[0] == pytest.approx(-0.02555, abs=1e-4)
        assert found.z.max() - found.z[0] == pytest.approx(0.01147, abs=4e-4)
        assert "recede" in " ".join(found.remarks)
