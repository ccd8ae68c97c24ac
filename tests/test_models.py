"""All model scripts: the same options, numbers as JSON alone, wrong input in one line."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest
from model_scripts import ROOT, SCRIPTS, call, load

from exudyn_wheelset.front.settings import changed_settings, load_settings

WITH_SETTINGS = [
    name
    for name in SCRIPTS
    if "settings=False" not in (ROOT / "models" / f"{name}.py").read_text(encoding="utf-8")
]
# Kaas-Petersen's bogie is cones on lines; the shifts of derailment.py are those of S1002's flange;
# a study takes folders of profiles.
WITHOUT_PROFILES = ("cooperrider_bogie", "derailment", "profile_study")
SETTINGS = sorted((ROOT / "runs").glob("*.json"))


@pytest.mark.parametrize("name", SCRIPTS)
def test_help(name, capsys):
    assert call(name, "--help") == 0
    text = capsys.readouterr().out
    assert "--json" in text and "--out" in text


@pytest.mark.parametrize("name", [name for name in SCRIPTS if name not in WITHOUT_PROFILES])
def test_all_scripts_on_profiles_take_the_same_options(name, capsys):
    assert call(name, "--help") == 0
    text = capsys.readouterr().out
    for option in ("wheel", "rail", "gauge", "gauge-depth", "inclination", "smoothing"):
        assert f"--{option} " in text


@pytest.mark.parametrize("name", SCRIPTS)
def test_unknown_option(name, capsys):
    assert call(name, "--no-such-option") == 2
    captured = capsys.readouterr()
    assert captured.out == "" and "--no-such-option" in captured.err


@pytest.mark.parametrize("name", WITH_SETTINGS)
def test_wrong_settings_name_gives_the_nearest(name, tmp_path, capsys):
    path = tmp_path / "wrong.json"
    path.write_text('{"timeIntegration": {"numberOfStep": 10}}')
    assert call(name, "--json", "--settings", str(path), "--out", str(tmp_path / "out")) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "timeIntegration.numberOfSteps" in captured.err and str(path) in captured.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", WITH_SETTINGS)
def test_missing_settings_file(name, tmp_path, capsys):
    assert call(name, "--settings", str(tmp_path / "none.json"), "--out", str(tmp_path)) == 2
    assert "no such settings file" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "arguments", "word"),
    [
        ("contact_geometry", ["--wheel", "S1003"], "S1002"),
        ("contact_geometry", ["--wheel", "UIC60"], "wheel"),
        ("contact_geometry", ["--gauge", "1.43"], "--wheel"),
        ("contact_geometry", ["--rail", "UIC60"], "--wheel"),
        ("conicity", ["--wheel", "S1002", "--gauge-depth", "0.5"], "gauge_depth"),
        ("single_wheelset", ["--wheel", "S1003"], "S1002"),
        ("simple_truck", ["--rail", "UIC61"], "UIC60"),
        ("bifurcation", ["--wheel", "S1003"], "S1002"),
        ("table2", ["--wheel", "S1003"], "S1002"),
        ("contact_geometry", ["--wheel", "S1002", "--half-range", "8"], "metres"),
        ("contact_geometry", ["--wheel", "S1002", "--gauge", "1435"], "in m"),
        ("single_wheelset", ["--offset", "1"], "metres"),
        ("single_wheelset", ["--speed", "-3"], "m/s"),
        ("single_wheelset", ["--creep", "polak"], "polach"),
        ("single_wheelset", ["--duration", "0"], "0.01"),
        ("profile_study", ["--wheels", "here"], "--rails FOLDER"),
        ("curving", ["--vehicle", "manchester_coch"], "manchester_coach"),
        ("simple_truck", ["--amplitude", "-1"], "metres"),
        ("simple_truck", ["--friction", "9"], "friction"),
    ],
)
def test_impossible_values_end_with_status_2(name, arguments, word, tmp_path, capsys):
    assert call(name, *arguments, "--json", "--out", str(tmp_path)) == 2
    captured = capsys.readouterr()
    assert captured.out == "" and word in captured.err
    assert len(captured.err.strip().splitlines()) == 1


# A short way through each script: options, constants of the script, keys its header promises.
SHORT = {
    "bifurcation": (
        ["--vehicle", "cooperrider", "--speeds", "68.2", "69", "--intervals", "12"],
        {},
        "hopf folds nonlinear_critical_speed method points seconds reason",
    ),
    "car": (
        ["--vehicle", "three_axle_truck", "--no-descent"],
        {},
        "linear_critical_speed frequency_hz mode_name damping hopf by_truck wheel_loads",
    ),
    "conicity": (["--amplitudes-mm", "3"], {}, "conicity shift"),
    "contact_geometry": (["--wheel=S1002", "--half-range=0.001"], {}, "S1002_on_UIC60"),
    "cooperrider_bogie": (
        ["--reference", "--speeds", "70"],
        {"INTERVALS": 20, "BRANCH_SPEEDS": (66.0, 70.0)},
        "hopf fold amplitude_mm",
    ),
    "curving": (
        [],
        {"STRAIGHT": 25.0, "TRANSITION": 15.0, "CURVE": 20.0},
        "steady limits greatest difference outcome",
    ),
    "derailment": (
        [],
        {"FRICTIONS": (0.3,), "ATTACKS": (40.0,)},
        "flange_angle friction attack",
    ),
    "freight_car": (
        [],
        {"HUNT": 0.05, "FRICTIONS": ()},
        "wheel_loads modes neutral critical hunt",
    ),
    "profile_study": (["--smoothing=0", "--processes=1"], {}, "pairs ranked"),
    "rough_track": (["--duration", "5.2"], {}, "60 160"),
    "simple_truck": (
        ["--duration=0.3"],
        {},
        "wheel_loads critical_speed frequency mode runs weight amplitude",
    ),
    "single_wheelset": (
        ["--speed=30", "--duration=0.3"],
        {},
        "critical_speed frequency offset runs",
    ),
    "table2": (["--rows", "mohan"], {}, "mohan assumed"),
}


def test_every_script_has_a_short_way():
    assert sorted(SHORT) == SCRIPTS


@pytest.mark.filterwarnings("ignore::exudyn_wheelset.WheelsetWarning")
@pytest.mark.parametrize("name", SHORT)
def test_json_prints_the_numbers_and_writes_nothing(name, tmp_path, monkeypatch, capsys):
    words, constants, promised = SHORT[name]
    if name == "profile_study":
        for kind in ("wheels", "rails"):
            folder = tmp_path / kind
            folder.mkdir()
            (folder / "broken.txt").write_text("no profile\n")
            words = [*words, f"--{kind}={folder}"]
    for constant, value in constants.items():
        monkeypatch.setattr(load(name), constant, value)
    folder = tmp_path / "empty"
    folder.mkdir()
    monkeypatch.chdir(folder)
    assert call(name, "--json", *words) == 0
    printed = json.loads(capsys.readouterr().out)
    assert set(promised.split()) <= {key.replace(" ", "_") for key in printed}
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("path", SETTINGS, ids=lambda path: path.stem)
def test_settings_files_hold_only_what_differs(path):
    """A settings file names its solver, and beyond that only what differs from the default."""
    changed = set(changed_settings(load_settings(path))) | {"timeIntegration.solverType"}
    entries = json.loads(path.read_text(encoding="utf-8"))
    names = set()
    for name, value in entries.items():
        names |= {f"{name}.{inner}" for inner in value} if isinstance(value, dict) else {name}
    assert names == changed


def test_command_line_prints_only_json(tmp_path):
    """In a process of its own: stdout is one JSON object, whatever libraries print."""
    done = subprocess.run(
        [
            sys.executable,
            str(ROOT / "models" / "contact_geometry.py"),
            "--wheel=S1002",
            "--half-range=0.001",
            "--json",
            f"--out={tmp_path}",
        ],
        capture_output=True,
        text=True,
        check=True,
    )
    assert list(json.loads(done.stdout)) == ["S1002 on UIC60"]


def test_the_script_of_the_page_runs(tmp_path, capsys):
    """docs/contributing.md shows a whole script; the paper's Table 2 has 38.8 m/s for set 1."""
    page = (ROOT / "docs" / "contributing.md").read_text(encoding="utf-8")
    script = {"__name__": "page"}
    exec(page.split("```python\n")[1].split("```")[0], script)
    words = ["--vehicle", "paper-lateral-1", "--json", "--out", str(tmp_path)]
    assert script["main"](words) == 0
    assert json.loads(capsys.readouterr().out)["speed"] == pytest.approx(38.8, rel=0.06)
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["roots_paper-lateral-1.json", "roots_paper-lateral-1.png"]
