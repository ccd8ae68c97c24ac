"""models/curving.py, rough_track.py and derailment.py through their numbers."""

import math

import pytest
from model_scripts import load

curving, rough_track, derailment = load("curving"), load("rough_track"), load("derailment")


@pytest.fixture(scope="module")
def curve(tmp_path_factory):
    out = tmp_path_factory.mktemp("curving")
    return curving.run(out=out), out


@pytest.mark.slow
def test_a_coach_comes_through_the_curve_on_its_leading_outer_flange(curve):
    numbers, out = curve
    assert "planned end" in numbers["outcome"]
    for truck in ("front", "rear"):
        leading = numbers["steady"][f"{truck} leading"]
        trailing = numbers["steady"][f"{truck} trailing"]
        assert leading["y_mm"] < -5.0 and abs(trailing["y_mm"]) < 4.0
        assert leading["angle_of_attack_mrad"] < -5.0
    # Steady curve and the end of the simulated one.
    assert numbers["difference"]["y_mm"] < 0.01 and numbers["difference"]["Q"] < 2e-3
    assert numbers["greatest"]["Y/Q"] < numbers["limits"]["nadal"]
    assert {"curving.png", "curving.csv", "curving.json"} <= {path.name for path in out.iterdir()}


@pytest.mark.slow
def test_a_coach_shakes_more_at_160_than_at_60_kmh():
    numbers = rough_track.run(duration=6.0)
    slow, fast = numbers["60"], numbers["160"]
    assert fast["Q_kN"] > slow["Q_kN"] and fast["N_MV"] > slow["N_MV"]
    assert fast["sum_of_y_kN"] < fast["limit_kN"]
    low, middle, high = fast["percentiles_kN"]
    assert low < middle < high


def test_limits_of_flange_climb_are_nadals():
    """At 40 mrad slip is almost straight up the flank; at small angles it is not."""
    numbers = derailment.run()
    assert numbers["flange_angle"] == pytest.approx(math.radians(70.0), abs=0.01)
    for pair in numbers["friction"].values():
        assert pair["limit"] == pytest.approx(pair["nadal"], rel=0.03)
    limits = list(numbers["attack"].values())
    assert limits == sorted(limits, reverse=True)
