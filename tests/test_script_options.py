"""The options of a script against the descriptions that they name."""

import argparse
import warnings

import pytest

from exudyn_wheelset.errors import ProfileError, WheelsetWarning
from exudyn_wheelset.front.script import (
    add_profile_options,
    profiles_from,
    run_script,
    script_parser,
)
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
