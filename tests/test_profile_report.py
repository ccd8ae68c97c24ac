"""The report on a profile: its numbers against what was put on, its figure against its panels."""

import pytest
from test_profile_noise import with_noise

from exudyn_wheelset import WheelsetError, profile_report
from exudyn_wheelset.profiles import load_profile


@pytest.fixture(scope="module")
def wheel():
    return load_profile("S1002")


def test_a_formula_has_nothing_to_report(wheel):
    """Both curves are the points: no residual, one conicity (0.18 at 3 mm, CONTACT's geometry)."""
    figure, numbers, text = profile_report(wheel)
    assert len(figure.axes) == 4
    assert numbers["noise"] < 1e-9 and numbers["residual_largest"] < 1e-9
    assert numbers["automatic_smoothing"] == 0.0
    assert numbers["conicity_3mm"] == pytest.approx(0.181, abs=2e-3)
    assert numbers["automatic_conicity_3mm"] == numbers["conicity_3mm"]
    assert numbers["spread_3mm"] is None
    assert "Conicity on UIC60 at 3 mm: 0.18" in text


def test_noise_is_found_and_what_it_does_to_conicity(wheel, tmp_path):
    noisy = with_noise(wheel, 1e-5, 2.5e-4, 0)
    report = profile_report(noisy, samples=3)
    numbers = report.numbers
    assert numbers["noise"] == pytest.approx(1e-5, rel=0.2)
    assert numbers["residual_rms"] == pytest.approx(1e-5, rel=0.2)
    # sqrt(6) 1e-5/0.25e-3^2
    assert numbers["curvature_noise"] == pytest.approx(392.0, rel=0.25)
    truth = profile_report(wheel, samples=0).numbers["conicity_3mm"]
    assert abs(numbers["automatic_conicity_3mm"] - truth) < 0.01
    assert 0.0 < numbers["spread_3mm"] < 0.01
    assert f"{1e6 * noisy.noise:.2g} micrometres off" in report.text
    report.figure.savefig(tmp_path / "report.png")
    assert (tmp_path / "report.png").stat().st_size > 10_000
    lines = report.figure.axes[0].lines
    assert len(lines[0].get_xdata()) == len(noisy.y)


def test_a_rail_is_paired_with_a_wheel():
    numbers = profile_report(load_profile("UIC60"), samples=0).numbers
    assert numbers["conicity_3mm"] == pytest.approx(0.181, abs=2e-3)
    with pytest.raises(WheelsetError, match="give a pair"):
        profile_report(load_profile("UIC60"), "UIC60")


def test_without_contact_it_says_so(wheel):
    """UIC60's flanks reach 35 mm down."""
    report = profile_report(wheel, gauge_depth=0.045, samples=0)
    assert report.numbers["conicity_3mm"] is None
    assert "check gauge" in report.text
