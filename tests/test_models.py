"""All model scripts: the same options, numbers as JSON alone, wrong input in one line."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest
from model_scripts import ROOT, SCRIPTS, call

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
