"""The command `exudyn-wheelset`: its numbers against sources, its files, and how it fails.

Numbers are compared with what does not come from the command: Kaas-Petersen's bogie by AUTO-07p
(Hopf point 68.6444 m/s, fold 66.6604 m/s on 40 x 4 collocation), Kalker's linear theory, cones,
weights. Everything that goes wrong is one line on standard error and exit status 2.
"""

import json
import math
import os
import resource
import subprocess
import sys

import pytest

from exudyn_wheelset.front import command
from exudyn_wheelset.front.command import TASKS, main

HOPF, FOLD = 68.6444, 66.6604


def run(capsys, *words):
    """Numbers that a task printed with --json."""
    assert main([*map(str, words), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def refusal(capsys, *words):
    """The line that a task which cannot be done has left."""
    try:
        status = main([*map(str, words)])
    except SystemExit as leaving:
        status = leaving.code
    said = capsys.readouterr()
    assert status == 2, said
    assert said.out == ""
    lines = [line for line in said.err.splitlines() if line.startswith("exudyn-wheelset")]
    assert len(lines) == 1, said.err
    assert "Traceback" not in said.err
    return lines[0]


@pytest.mark.parametrize("task", TASKS)
def test_help_has_examples(task, capsys):
    with pytest.raises(SystemExit) as leaving:
        main([task, "--help"])
    text = capsys.readouterr().out
    assert leaving.value.code == 0
    assert f"exudyn-wheelset {task}" in text.partition("examples:")[2]


def test_every_example_is_understood():
    """Options of the examples are those of their tasks; files in them need not be there."""
    import shlex

    for task in TASKS:
        for line in command._module(task).EXAMPLES:
            name, *words = shlex.split(line)
            assert name == task
            if "*" not in line:
                command.task_parser(task).parse_args(words)


def test_help_without_a_task_and_version(capsys):
    assert main([]) == 2
    assert "stability" in capsys.readouterr().out
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("exudyn-wheelset ")


def test_conicity_of_a_cone(capsys):
    """Taper g of a cone on a round head of radius R: rolling by g y/b moves the contact by R g y/b
    on the head, so g (1 + R g/b) with R = 0.3 m of UIC60's top and b = 0.75 m, to first order."""
    expected = 0.05 * (1.0 + 0.3 * 0.05 / 0.75)
    found = run(capsys, "conicity", "--wheel", "cone_0.05", "--amplitudes-mm", 2, 5)
    assert found["conicity"]["2"] == pytest.approx(expected, rel=1e-3)
    assert found["conicity"]["5"] == pytest.approx(expected, rel=1e-3)


def test_geometry_of_a_pair(capsys, tmp_path):
    """At rest, S1002 on UIC60 touches by both wheels alike (EN 13715's wheel is symmetric)."""
    found = run(capsys, "geometry", "--half-range", 0.002, "--out", tmp_path)
    (numbers,) = found.values()
    assert numbers["gauge"] == 1.435
    assert {path.suffix for path in tmp_path.iterdir()} == {".png", ".csv", ".json"}


def test_creep_of_the_linear_law(capsys):
    """F_x = -G a b C11 xi_x, C11 = 4.12 for a circle at nu = 0.25 (Kalker's table)."""
    words = ("--a", 5e-3, "--b", 5e-3, "--shear-modulus", 8e10, "--poisson", 0.25)
    found = run(capsys, "creep", "--creep", "linear", "--creep-x", "0:1e-3:3", *words)
    forces = found["laws"]["linear"]["force_x"]
    assert found["creep_x"] == [0.0, 5e-4, 1e-3]
    assert forces[2] == pytest.approx(-8e10 * 25e-6 * 4.12 * 1e-3, rel=3e-3)
    assert forces[1] == pytest.approx(0.5 * forces[2], rel=1e-9)


def test_parameters_of_a_creep_law(capsys):
    """Polach 2005 at full slip w = V: friction mu_0 ((1 - A) exp(-B w) + A), times N."""
    words = [f"polach-2005:friction_ratio=0.5,friction_decay=0.1,speed={v}" for v in (0, 10)]
    words = ("--creep", words[0], "--creep", words[1], "--friction", 0.4)
    found = run(capsys, "creep", *words, "--creep-x", 1.0, "--normal-force", 1e5)
    standing, moving = (of["force_x"][0] for of in found["laws"].values())
    assert standing == pytest.approx(-0.4 * 1e5, rel=0.01)
    assert moving / standing == pytest.approx(0.5 * math.exp(-1.0) + 0.5, rel=0.01)


def test_stability_and_hunting_of_a_bogie(capsys, tmp_path):
    stable = run(capsys, "stability", "--vehicle", "cooperrider", "--out", tmp_path)
    assert stable["linear_critical_speed"] == pytest.approx(HOPF, abs=1e-3)
    assert any(path.suffix == ".png" for path in tmp_path.iterdir())
    hunting = run(capsys, "hunt", "--vehicle", "cooperrider")
    assert hunting["hopf"][0] == pytest.approx(HOPF, abs=1e-3)
    assert hunting["nonlinear_critical_speed"] == pytest.approx(FOLD, abs=5e-3)


def test_a_number_set_by_its_path(capsys):
    """The bogie with twice its friction force: linear analysis does not see friction."""
    words = ("--vehicle", "cooperrider", "--set", "friction_force=20e3")
    found = run(capsys, "stability", *words)
    assert found["linear_critical_speed"] == pytest.approx(HOPF, abs=1e-3)
    found = run(capsys, "stability", "--vehicle", "cooperrider", "--set", "conicity=0.1")
    assert found["linear_critical_speed"] < HOPF - 10.0


def test_map_and_study_agree(capsys, tmp_path):
    """Hopf speeds of the study's cases lie on the map's curve."""
    words = ("--vehicle", "cooperrider", "--over", "conicity=0.04:0.06", "--no-folds")
    curves = run(capsys, "map", *words, "--points", 5)["hopf"]
    words = ("--vehicle", "cooperrider", "--vary", "conicity=0.04,0.05,0.06", "--processes", 1)
    rows = run(capsys, "study", *words, "--out", tmp_path)["rows"]
    assert rows[1]["linear"] == pytest.approx(HOPF, abs=1e-3)
    for row in rows[::2]:
        ends = [
            speed
            for curve in curves
            for at, speed in zip(curve["parameter"], curve["speed"], strict=True)
            if at == pytest.approx(row["conicity"], abs=1e-9)
        ]
        assert min(abs(speed - row["linear"]) for speed in ends) < 1e-2
    assert {path.suffix for path in tmp_path.iterdir()} == {".csv", ".jsonl"}


def test_simulation_carries_the_weight(capsys, tmp_path):
    """Steady running of one wheelset: Q of both wheels is its load, every sample alike."""
    settings = tmp_path / "run.json"
    settings.write_text(
        '{"timeIntegration": {"endTime": 0.1, "numberOfSteps": 200, "solverType": "RK44"}}'
    )
    words = ("--vehicle", "s1002", "--speed", 20, "--initial", 0, "--settings", settings)
    found = run(capsys, "simulate", *words, "--out", tmp_path / "out")
    assert found["duration"] == pytest.approx(0.1)
    from exudyn_wheelset import catalogue

    load = catalogue.vehicle("s1002").axle_load
    assert sum(of["largest_q"] for of in found["wheels"].values()) == pytest.approx(load, rel=1e-3)
    assert len(list((tmp_path / "out").iterdir())) == 3


def test_picture_and_film(capsys, tmp_path):
    words = ("--vehicle", "s1002", "--size", 64, 48, "--out", tmp_path)
    (picture,) = run(capsys, "film", "--picture", *words)["files"]
    words = (*words, "--duration", 0.1, "--format", "gif", "--rate", 10)
    (film,) = run(capsys, "film", *words)["files"]
    with open(picture, "rb") as drawn, open(film, "rb") as moving:
        assert drawn.read(4) == b"\x89PNG" and moving.read(4) == b"GIF8"


def test_info_of_all_kinds(capsys):
    names = run(capsys, "info")
    assert {"dtu_car", "s1002"} <= set(names["vehicles"])
    assert "exact-table" in names["creep_laws"]
    car = run(capsys, "info", "dtu_car")
    # Car, two frames, four wheelsets: reference/README.md.
    assert car["mass"] == pytest.approx(44388 + 2 * 2918.9 + 4 * 1022, rel=1e-3)
    assert "contact.friction" in car["numbers"]
    assert set(run(capsys, "info", "fastsim")["parameters"]) >= {"cells_along"}
    assert run(capsys, "info", "S1002")["kind"] == "wheel"
    assert run(capsys, "warm-up")["seconds"] >= 0.0


def test_remarks_are_told_when_asked_for(capsys, tmp_path):
    """A file in inches is remarked on at INFO: told with --verbose, and only then."""
    from exudyn_wheelset import load_profile, save_profile

    path = save_profile(load_profile("S1002"), tmp_path / "wheel.prw")
    words = ["conicity", "--wheel", str(path), "--amplitudes-mm", "3"]
    assert main(words) == 0
    assert capsys.readouterr().err == ""
    assert main([*words, "--verbose"]) == 0
    said = capsys.readouterr().err
    assert said.startswith("exudyn-wheelset conicity: ") and str(path) in said


def test_nothing_is_written_without_out(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run(capsys, "conicity", "--amplitudes-mm", 3)
    run(capsys, "simulate", "--vehicle", "s1002", "--speed", 20, "--duration", 0.02)
    run(capsys, "stability", "--vehicle", "s1002")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["fly"], "invalid choice"),
        (["conicity", "--settings", "run.json"], "unrecognized arguments"),
        (["stability", "--settings", "run.json"], "unrecognized arguments"),
        (["hunt", "--vehicle", "s1002", "--settings", "{rk44}"], "simulates nothing"),
        (["film", "--picture", "--settings", "{rk44}", "--out", "."], "no effect"),
        (["film"], "--out FOLDER"),
        (["map"], "--over conicity"),
        (["study"], "--vary friction"),
        (["conicity", "--out", "/dev/null/figures"], "cannot be written"),
        (["conicity", "--wheel", "/"], "/"),
        (["info", "dtu_cat"], "did you mean 'dtu_car'"),
        (["simulate", "--settings", "/"], "cannot be read"),
        (["stability", "--vehicle", "s1002", "--set", "track.gage=1.4"], "gauge"),
        (
            ["stability", "--vehicle", "s1002", "--creep", "polach-2005:slip_reduction=3"],
            "slip_reduction",
        ),
    ],
)
def test_what_cannot_be_done_is_one_line(words, said, capsys, tmp_path):
    settings = tmp_path / "rk44.json"
    settings.write_text('{"timeIntegration.solverType": "RK44"}')
    assert said in refusal(capsys, *(word.format(rk44=settings) for word in words))


def outside(*words, **options):
    """The command as a process of its own, with as little in its way as a user has."""
    call = [sys.executable, "-m", "exudyn_wheelset.front.command", *words]
    environment = {**os.environ, "MPLBACKEND": "Agg"}
    return subprocess.run(call, text=True, env=environment, timeout=120, **options)


def test_exit_status_of_a_process(tmp_path):
    """A number; a disk that is full (no file may grow); standard output that takes nothing."""
    piped = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    done = outside("conicity", "--amplitudes-mm", "3", "--json", **piped)
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["wheel"] == "S1002"

    def full_disk():
        resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

    done = outside("conicity", "--out", str(tmp_path), preexec_fn=full_disk, **piped)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1 and "cannot be written" in done.stderr
    assert not any(path.name.endswith(".png") for path in tmp_path.iterdir())
    reading, writing = os.pipe()
    os.close(reading)
    done = outside("info", stdout=writing, stderr=subprocess.PIPE)
    os.close(writing)
    assert (done.returncode, done.stderr) == (0, ""), "who reads may stop before the end"
    if os.path.exists("/dev/full"):
        with open("/dev/full", "w") as full:
            done = outside("info", stdout=full, stderr=subprocess.PIPE)
        assert done.returncode == 2
        assert done.stderr == "exudyn-wheelset info: No space left on device\n"
