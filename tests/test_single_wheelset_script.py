"""models/single_wheelset.py against Table 2, eigenvalues, another solver and the rigid flange.

Also what it does when a run derails or is interrupted, its picture and its film.
"""

from __future__ import annotations

import json
import signal
from dataclasses import replace

import numpy as np
import pytest
from model_scripts import ROOT, call, load, printed_numbers, table_of

from exudyn_wheelset.coupling.derailment import DerailmentWatch
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.settings import load_settings
from exudyn_wheelset.geometry.rigid import contact_geometry


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
        rates += script.run(model, [42.0], 1e-3, settings, 3.0)[0]["runs"]
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
