"""The options of a script against the descriptions that they name."""

import argparse
import warnings

import pytest

from exudyn_wheelset.catalogue import Changes, dtu_car, entry
from exudyn_wheelset.errors import ProfileError, WheelsetWarning
from exudyn_wheelset.front.script import (
    add_profile_options,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.front.vehicle_options import add_vehicle_options, chosen_vehicle
from exudyn_wheelset.profiles import load_profile, save_profile, shapes


def parsed(*words, **defaults):
    parser = argparse.ArgumentParser()
    add_profile_options(parser, **defaults)
    return profiles_from(parser.parse_args(list(words)))


def test_defaults_are_those_of_the_track():
    found = parsed()
    assert found.wheel.name == load_profile("S1002").name
    assert found.track.rail.name == load_profile("UIC60").name
    assert (found.track.gauge, found.track.gauge_depth) == (1.435, 0.014)
    assert found.track.inclination == pytest.approx(1 / 40)


def test_what_is_given_arrives(tmp_path):
    path = save_profile(shapes.uic60(), tmp_path / "rail.prr")
    found = parsed(
        *("--wheel", "cone_0.05", "--rail", str(path), "--gauge", "1.43", "--gauge-depth", "0.016"),
        *("--inclination", "0.05", "--smoothing", "1e-6"),
    )
    assert found.wheel.slope(0.01) == pytest.approx(0.05)
    assert found.rail.smoothing == 1e-6
    assert found.wheel.smoothing == 0.0
    track = found.track
    assert (track.gauge, track.gauge_depth, track.inclination) == (1.43, 0.016, 0.05)


def test_none_leaves_the_choice_to_the_script():
    found = parsed(wheel=None, rail=None, gauge=None, gauge_depth=None, inclination=None)
    assert found.wheel is None and found.rail is None and found.gauge is None
    assert found.track.gauge == 1.435


def test_wrong_words_are_refused(capsys):
    with pytest.raises(SystemExit):
        parsed("--smoothing", "much")
    assert "'auto' or metres" in capsys.readouterr().err
    with pytest.raises(ProfileError, match="is a rail"):
        parsed("--wheel", "UIC60")


def test_warnings_are_one_line_of_the_script(capsys):
    parser = script_parser("a script")
    parser.prog = "truck.py"

    def run(_):
        for word in ("stiff", "soft"):
            warnings.warn(f"the law is too {word}", WheelsetWarning, stacklevel=1)
        return {"speed": 41.7}

    assert run_script(run, parser, ["--json"]) == 0
    captured = capsys.readouterr()
    assert captured.out == '{"speed": 41.7}\n'
    assert captured.err == "truck.py: the law is too stiff\n"


def test_what_is_changed_of_a_vehicle_arrives_and_names_its_files():
    parser = script_parser("a script")
    add_vehicle_options(parser, "dtu_car")
    words = ["--friction", "0.25", "--wheel", "cone_0.05", "--gauge", "1.437"]
    chosen = chosen_vehicle(parser.parse_args(words))
    car = chosen.vehicle()
    assert chosen.searched == entry("dtu_car").searched
    assert chosen.stem("car") == "car_dtu_car_friction_0.25_gauge_1.437_wheel_cone_0.05"
    assert (car.contact.friction, car.track.gauge) == (0.25, 1.437)
    for axle in car.wheelsets:
        assert axle.wheelset.wheel.slope(0.01) == pytest.approx(0.05)


def test_changes_of_a_description_leave_the_rest_alone():
    """What `Changes` sets on a finished vehicle is what was asked for, and nothing else."""
    car = dtu_car()
    changes = Changes(friction=0.25, creep="fastsim", gauge=1.437, conicity=0.05, radius=0.43)
    changed = changes.applied_to(car)
    assert (changed.contact.friction, changed.contact.creep) == (0.25, "fastsim")
    assert changed.contact.shear_modulus == car.contact.shear_modulus
    assert (changed.track.gauge, changed.track.inclination) == (1.437, car.track.inclination)
    for old, new in zip(car.wheelsets, changed.wheelsets, strict=True):
        assert (new.wheelset.radius, new.wheelset.mass) == (0.43, old.wheelset.mass)
        assert new.wheelset.wheel.slope(0.0) == pytest.approx(0.05, abs=1e-9)
    assert changed.bodies == car.bodies
    assert Changes().applied_to(car) == car
