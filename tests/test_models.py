"""Every model script: its numbers against sources, its options, its output.

Sources: the paper (Table 1, Table 2, section 2.2), rigid contact solved by CONTACT (S1002 on
UIC60), the closed form of a cone on a round rail head, equilibrium of forces, and the eigenvalues
as second method beside simulated growth. Table 2, conicity and the Cooperrider bogie have files of
their own; of these scripts only the handling of options is checked here.
"""

from __future__ import annotations

import csv
import importlib.util
import json
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from exudyn_wheelset.coupling.derailment import DerailmentWatch
from exudyn_wheelset.errors import AnalysisError, FileError, WheelsetError
from exudyn_wheelset.front.settings import changed_settings, load_settings
from exudyn_wheelset.geometry.rigid import contact_geometry
from exudyn_wheelset.results.files import write_atomically
from exudyn_wheelset.results.growth import measure_growth

ROOT = Path(__file__).resolve().parents[1]
SCRIPTS = sorted(path.stem for path in (ROOT / "models").glob("*.py"))
WITH_SETTINGS = [
    name
    for name in SCRIPTS
    if "settings=False" not in (ROOT / "models" / f"{name}.py").read_text(encoding="utf-8")
]
# Kaas-Petersen's bogie is cones on lines.
WITHOUT_PROFILES = ("cooperrider_bogie",)
SETTINGS = sorted((ROOT / "runs").glob("*.json"))


def load(name: str) -> ModuleType:
    """Import a script by its path."""
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, ROOT / "models" / f"{name}.py")
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
    return sys.modules[name]


def call(name: str, *arguments: str) -> int:
    """Exit status of a script's `main`."""
    try:
        status = load(name).main(list(arguments))
    except SystemExit as leaving:
        status = leaving.code
    return status if isinstance(status, int) else 0


def printed_numbers(capsys: pytest.CaptureFixture[str]) -> dict:
    """What --json printed: one JSON object and nothing else."""
    return json.loads(capsys.readouterr().out)


def table_of(path: Path) -> dict[str, np.ndarray]:
    """Columns of a CSV file."""
    lines = path.read_text(encoding="utf-8").splitlines()
    rows = np.array([line.split(",") for line in lines[1:]], dtype=float)
    return dict(zip(lines[0].split(","), rows.T, strict=True))


# Options of all scripts


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


def test_files_appear_whole_or_not_at_all(tmp_path):
    path = tmp_path / "kept.txt"
    path.write_text("before")

    def fails(part: Path) -> None:
        part.write_text("half")
        raise OSError("disk full")

    with pytest.raises(FileError, match=r"kept\.txt cannot be written: disk full"):
        write_atomically(path, fails)
    assert path.read_text() == "before"
    assert [file.name for file in tmp_path.iterdir()] == ["kept.txt"]


# Contact geometry


def test_contact_geometry_against_CONTACT(tmp_path, capsys):
    """The script's CSV at the rows of CONTACT, which are exact to 2e-6 (4e-6 m at y = 0)."""
    assert call("contact_geometry", "--wheel=S1002", "--json", f"--out={tmp_path}") == 0
    numbers = printed_numbers(capsys)["S1002 on UIC60"]
    table = table_of(tmp_path / "contact_geometry_S1002_UIC60.csv")
    reference = ROOT / "tests" / "reference" / "contact_geometry_S1002_UIC60.csv"
    compared = 0
    with reference.open(encoding="utf-8") as lines:
        for row in csv.DictReader(lines):
            y = float(row["y_m"])
            at = int(np.argmin(np.abs(table["y"] - y)))
            if abs(table["y"][at] - y) > 1e-9:
                continue
            compared += 1
            side, position = row["side"], 1e-4 if y == 0.0 else 2e-5
            assert table["roll"][at] == pytest.approx(float(row["roll_rad"]), abs=2e-6)
            assert table["z"][at] == pytest.approx(float(row["z_m"]), abs=2e-6)
            assert table[f"{side}_wheel_y"][at] == pytest.approx(
                float(row["wheel_y_m"]), abs=position
            )
            assert table[f"{side}_rail_y"][at] == pytest.approx(
                float(row["rail_y_m"]), abs=position
            )
            assert table[f"{side}_radius"][at] == pytest.approx(
                float(row["rolling_radius_m"]), abs=4e-5
            )
    assert compared >= 10
    assert numbers["height_at_rest"] == pytest.approx(-1.821662e-4, abs=2e-6)
    # The two methods look for the same root; Nelder-Mead stops at 1e-12 rad.
    assert numbers["methods"]["largest_roll_difference"] < 1e-9
    # The polynomials keep the tolerance they were asked for: 2e-6 m and rad, and a hundred times
    # that for angles and places.
    residuals = numbers["polynomials"]["residuals"]
    for name in ("roll", "z", "left_radius", "right_radius"):
        assert max(residuals[name]) <= 2e-6
    assert max(residuals["left_angle"] + residuals["right_angle"]) <= 2e-4
    names = {file.name for file in tmp_path.iterdir()}
    assert names == {
        "contact_geometry.json",
        "contact_geometry_S1002_UIC60.csv",
        "contact_geometry_S1002_UIC60.png",
        "contact_geometry_S1002_UIC60_profiles.png",
    }


def test_contact_geometry_of_the_papers_pair():
    """AAR 1:20 on UIC60 at 1432 mm: a cone on a round head until the flange, as in Figure 3."""
    script = load("contact_geometry")
    pair = script.default_pairs()[0]
    numbers = script.examine(pair).numbers
    cone, head = 0.05, 0.3
    assert numbers["contact_angle_at_rest"] == pytest.approx(np.arctan(cone), abs=1e-5)
    # Effective conicity of a cone with the roll it causes: d (g + R d)/(g - r0 d).
    half_distance = pair.wheelset.tape_half_distance + numbers["wheel_contact_at_rest"]
    radius = pair.wheelset.radius
    effective = cone * (half_distance + head * cone) / (half_distance - radius * cone)
    assert numbers["half_slope_of_radius_difference_at_rest"] == pytest.approx(effective, rel=2e-3)
    # "No double-point contact ... tread as well as flange regimes": one jump on either side.
    jumps = np.array(numbers["jumps"])
    assert len(jumps) >= 2 and np.all(np.abs(jumps) > 5e-3)
    assert jumps == pytest.approx(-jumps[::-1], abs=1e-6)


# Single wheelset


@pytest.fixture(scope="module")
def released() -> dict:
    """Set 1 with settings at hand, 4 s below and 8 s above the critical speed."""
    script = load("single_wheelset")
    settings = load_settings(ROOT / "runs" / "rk44.json")
    return script.run(settings=settings)[0]


def test_single_wheelset_critical_speed(released):
    """Table 2, profiled, set 1: 38.8 m/s within the 6 % that the left-out parameters leave open."""
    assert released["critical_speed"] == pytest.approx(38.8, rel=0.06)


def test_single_wheelset_growth(released):
    """Simulated growth beside the eigenvalue's: 2 % of the frequency's scale is asked for."""
    below, above = released["runs"]
    assert below["growth_rate_eigenvalue"] < 0.0 < above["growth_rate_eigenvalue"]
    for run in (below, above):
        scale = 2.0 * np.pi * run["frequency_eigenvalue"]
        assert run["event"] is None
        assert run["growth_rate_simulated"] == pytest.approx(
            run["growth_rate_eigenvalue"], abs=0.002 * scale
        )
        assert run["frequency_simulated"] == pytest.approx(run["frequency_eigenvalue"], rel=0.002)


def test_single_wheelset_hunts_between_its_flanges(released):
    """Below it comes to rest, above it hunts with the clearance to the flange as amplitude."""
    below, above = released["runs"]
    assert below["maximum_y"] == pytest.approx(released["offset"], rel=1e-6)
    assert below["final_amplitude"] < 0.3 * released["offset"]
    model = load("single_wheelset").vehicle()
    # The rigid wheelset's flange meets the rail where its rolling radius jumps.
    y = np.linspace(5e-3, 12e-3, 701)
    radius = contact_geometry(model.wheelset, model.track, y).left.radius
    clearance = y[int(np.argmax(np.diff(radius)))]
    assert above["final_amplitude"] == pytest.approx(clearance, rel=0.05)


def test_single_wheelset_by_another_solver():
    """Generalised-alpha gives the growth rate of RK44: they share nothing but the equations."""
    script = load("single_wheelset")
    model = script.vehicle()
    rates = []
    for name in ("rk44", "generalized_alpha"):
        settings = load_settings(ROOT / "runs" / f"{name}.json")
        rates.append(script.release(model, 42.0, 1e-3, settings, 3.0)[0])
    first, second = rates
    # Numerical damping of the implicit solver is below 1e-3 of the frequency at this step.
    scale = 2e-3 * np.pi * first["frequency_simulated"]
    assert second["growth_rate_simulated"] == pytest.approx(
        first["growth_rate_simulated"], abs=scale
    )
    assert second["frequency_simulated"] == pytest.approx(first["frequency_simulated"], rel=1e-3)


def test_single_wheelset_derails_with_an_event(tmp_path, capsys):
    """Thrown against the flange far above the critical speed: a clear end, and what was before."""
    arguments = ["--speed", "120", "--offset", "0.0115", "--friction", "0.6", "--duration", "3"]
    assert call("single_wheelset", *arguments, "--json", "--out", str(tmp_path)) == 0
    (run,) = printed_numbers(capsys)["runs"]
    assert "derailment" in run["event"]
    assert 0.0 < run["simulated_time"] < 3.0
    table = table_of(tmp_path / "single_wheelset_120.00.csv")
    assert np.all(np.isfinite(table["wheelset: y [m]"]))
    assert table["t [s]"][-1] == pytest.approx(run["simulated_time"], abs=1e-9)
    assert run["ending"] in {"WHEEL_CLIMB", "LIFT_OFF", "LOST_GAUGE"}
    assert (tmp_path / "single_wheelset.png").stat().st_size > 10_000


def test_single_wheelset_interrupted_keeps_its_results(tmp_path, capsys, monkeypatch):
    """Ctrl-C in the first run: exit status 130, its first second is on disk."""
    look = DerailmentWatch.look

    def interrupt(self, time):
        if time > 1.0:
            signal.raise_signal(signal.SIGINT)
        return look(self, time)

    monkeypatch.setattr(DerailmentWatch, "look", interrupt)
    handler = signal.getsignal(signal.SIGINT)
    assert call("single_wheelset", "--json", "--out", str(tmp_path)) == 130
    captured = capsys.readouterr()
    assert captured.out == "" and "interrupted" in captured.err
    assert signal.getsignal(signal.SIGINT) is handler
    (run,) = json.loads((tmp_path / "single_wheelset.json").read_text())["numbers"]["runs"]
    assert run["event"].startswith("interrupted")
    assert 1.0 < run["simulated_time"] < 1.1


def test_single_wheelset_picture_and_film(tmp_path, capsys):
    arguments = ["--speed", "30", "--duration", "0.3", "--picture", "--film", "--json"]
    assert call("single_wheelset", *arguments, "--out", str(tmp_path)) == 0
    printed_numbers(capsys)
    assert (tmp_path / "single_wheelset_picture.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "single_wheelset.gif").read_bytes().startswith(b"GIF8")


def test_picture_shows_left_on_the_left():
    """Seen along the track, a wheelset moved to the left stands farther left in the picture."""
    from exudyn_wheelset.front.animation import Camera, render_motion

    container, mbs, _ = load("single_wheelset").vehicle().build(20.0, sensors=False)
    mbs.Assemble()
    camera = Camera(azimuth=0.0, elevation=0.2, centre=(0.0, 0.0, 0.3), zoom=2.5, perspective=0.0)
    poses = np.zeros((3, 6))
    poses[:, 1] = 0.0, 0.4, -0.4
    pictures = render_motion(container, mbs, poses, camera, size=(120, 80))
    middles = []
    for picture in pictures:
        drawn = np.abs(picture.astype(float) - picture[0, 0]).sum(axis=2) > 60.0
        middles.append(float(np.nonzero(drawn)[1].mean()))
    centred, left, right = middles
    assert centred == pytest.approx(59.5, abs=1.0)
    # 0.4 m of a height of 2.5 m in 80 pixels are 12.8 pixels.
    assert centred - left == pytest.approx(12.8, abs=1.0)
    assert right - centred == pytest.approx(12.8, abs=1.0)


# Truck


@pytest.fixture(scope="module")
def truck_numbers() -> dict:
    return load("simple_truck").run()[0]


def test_simple_truck_wheel_loads(truck_numbers):
    """All weight on the rails, a quarter on each wheel: 66.6 kN, as the DTU car is given."""
    loads = dict(truck_numbers["wheel_loads"])
    total = loads.pop("sum")
    assert total == pytest.approx(truck_numbers["weight"], rel=1e-6)
    assert len(loads) == 4
    assert list(loads.values()) == pytest.approx([66.66e3] * 4, rel=2e-3)


def test_simple_truck_growth(truck_numbers):
    """Simulated growth beside the eigenvalue's, on both sides of the critical speed."""
    below, above = truck_numbers["runs"]
    assert below["growth_rate_eigenvalue"] < 0.0 < above["growth_rate_eigenvalue"]
    for run in (below, above):
        scale = 2.0 * np.pi * run["frequency_eigenvalue"]
        assert run["event"] is None
        assert run["growth_rate_simulated"] == pytest.approx(
            run["growth_rate_eigenvalue"], abs=0.002 * scale
        )
        assert run["frequency_simulated"] == pytest.approx(run["frequency_eigenvalue"], rel=0.002)


def test_simple_truck_critical_speed_is_below_that_of_its_wheelsets(truck_numbers):
    """The frame that swings on soft secondary springs guides less than one that stands still."""
    alone = truck_numbers["critical_speed_of_a_wheelset_on_a_fixed_frame"]
    assert 15.0 < truck_numbers["critical_speed"] < alone


def test_simple_truck_output(tmp_path, capsys):
    assert call("simple_truck", "--duration=0.6", "--json", f"--out={tmp_path}") == 0
    numbers = printed_numbers(capsys)
    names = {file.name for file in tmp_path.iterdir()}
    speeds = [f"simple_truck_{run['speed']:.2f}.csv" for run in numbers["runs"]]
    assert names == {
        "simple_truck.json",
        "simple_truck.png",
        *speeds,
    }
    record = json.loads((tmp_path / "simple_truck.json").read_text())
    assert record["numbers"] == numbers
    assert record["settings"]["timeIntegration.solverType"] == "RK44"
    assert "exudyn" in record["versions"]


# Growth of known motions


@pytest.mark.parametrize("rate", [-0.9, -0.05, 0.0, 0.4, 3.0])
@pytest.mark.parametrize("size", [1e-7, 1.0])
def test_measured_growth_of_a_known_motion(rate, size):
    """A sinusoid that grows by a known rate about a known centre, of any size."""
    t = np.linspace(1.0, 4.0, 1501)
    y = size * (np.exp(rate * t) * np.cos(2.0 * np.pi * 3.1 * t + 0.7) + 0.3)
    growth = measure_growth(t, y)
    assert growth.rate == pytest.approx(rate, abs=1e-5)
    assert growth.frequency == pytest.approx(3.1, rel=1e-6)
    assert growth.residual < 1e-5


@pytest.mark.parametrize("samples", [0, 1, 5, 400])
def test_growth_needs_two_periods(samples):
    t = np.linspace(0.0, 0.2, samples)
    with pytest.raises(AnalysisError, match="two periods"):
        measure_growth(t, np.cos(2.0 * np.pi * 3.0 * t))


def test_vehicle_takes_a_users_profiles(tmp_path):
    """A two-column file in millimetres stands in for a name."""
    script = load("single_wheelset")
    given = script.vehicle().wheelset.wheel
    path = tmp_path / "mine.txt"
    rows = [f"{y * 1e3:.6f} {z * 1e3:.6f}" for y, z in zip(given.y, given.z, strict=True)]
    path.write_text("# kind: wheel\n# unit: mm\n" + "\n".join(rows) + "\n")
    model = script.vehicle(wheel=path, gauge=1.435)
    assert model.wheelset.mass == script.vehicle().wheelset.mass
    assert model.track.gauge == 1.435
    assert contact_geometry(model.wheelset, model.track, [1e-3]).left.angle[0] == pytest.approx(
        np.arctan(0.05), abs=1e-3
    )
    with pytest.raises(WheelsetError, match="axle_load"):
        replace(model, axle_load=1.0)
