"""models/bifurcation.py and the catalogue: its numbers against known ones, its options, its files.

Sources: Hopf point of the paper's set 1 (Table 2: 38.8 m/s for the profiled model, within the 6 %
that a free spin and the reconstructed wheel change), Cooperrider's bogie after Kaas-Petersen
(68.64 m/s), and the analyses called without the script.
"""

import importlib.util
import json
import sys
from pathlib import Path

import numpy as np
import pytest

from exudyn_wheelset.catalogue.by_name import CATALOGUE, vehicle, vehicle_system
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.diagrams import draw_diagram
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.diagram import Diagram, branch_from, disturbed_speeds
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.linear.crossings import hopf_points
from exudyn_wheelset.systems.system import as_system

SCRIPT = Path(__file__).parents[1] / "models" / "bifurcation.py"


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("bifurcation", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    sys.modules["bifurcation"] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def bogie(tmp_path_factory):
    """Folder and printed numbers of a run for the bogie that stops before the flange."""
    folder = tmp_path_factory.mktemp("bogie")
    system = vehicle_system("cooperrider")
    (hopf,) = hopf_points(system, 60.0, 75.0)
    branch = branch_from(system, hopf, (65.0, 72.0), intervals=12)
    return folder, system, hopf, branch


def run(script, capsys, *arguments):
    """Exit status, standard output and error of the script."""
    status = script.main([str(argument) for argument in arguments])
    captured = capsys.readouterr()
    return status, captured.out, captured.err


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_name_gives_a_vehicle_for_the_analyses(name):
    system = as_system(vehicle(name))
    state = system.equilibrium(20.0)
    assert np.all(np.isfinite(system.derivative(state, 20.0)))


def test_unknown_names_and_changes_are_refused_with_the_nearest():
    with pytest.raises(WheelsetError, match="'s1002'"):
        vehicle("s102")
    with pytest.raises(WheelsetError, match="cooperrider has no gauge"):
        vehicle("cooperrider", gauge=1.44)
    with pytest.raises(WheelsetError, match="not both"):
        vehicle("s1002", wheel="S1002", conicity=0.1)
    with pytest.raises(WheelsetError, match="friction = 7"):
        vehicle("s1002", friction=7)
    with pytest.raises(WheelsetError, match="polach"):
        vehicle_system("paper-1", creep="polack")


def test_changes_arrive_in_the_vehicle():
    changed = vehicle("s1002", friction=0.4, gauge=1.437, inclination=0.05, damping=2.0)
    assert changed.contact["friction"] == 0.4 and changed.contact["damping"] == 2.0
    assert changed.track.gauge == 1.437 and changed.track.inclination == 0.05
    lateral = vehicle("paper-lateral-2", friction=0.2, conicity=0.1)
    assert lateral.parameters.friction == 0.2
    assert lateral.wheelset.wheel.slope(0.0) == pytest.approx(0.1, abs=1e-9)
    # The source: a friction of 0.15 goes with 10 kN a wheel.
    bogie = vehicle("cooperrider", friction=0.3)
    assert bogie.friction_force == pytest.approx(20.0e3)


def test_conicity_moves_the_linear_critical_speed_as_klingel_says():
    """Wavelength and so critical speed fall with the root of conicity, for little else changes."""
    speeds = [
        float(hopf_points(vehicle("paper-lateral-1", conicity=taper), 10.0, 80.0)[0])
        for taper in (0.05, 0.1)
    ]
    # Klingel: V = 2 pi f sqrt(r0 e/(2 gamma)) at the nearly fixed frequency on the springs.
    assert speeds[0] / speeds[1] == pytest.approx(np.sqrt(2.0), rel=0.03)


def test_json_holds_the_numbers_and_nothing_else(script, capsys, tmp_path):
    arguments = ("--vehicle", "paper-lateral-1", "--points", "4", "--json", "--out", tmp_path)
    status, out, _ = run(script, capsys, *arguments)
    numbers = json.loads(out)
    assert status == 0
    assert set(numbers) == {
        "hopf",
        "folds",
        "nonlinear_critical_speed",
        "method",
        "points",
        "seconds",
        "reason",
    }
    assert numbers["hopf"][0] == pytest.approx(38.8, rel=0.06)
    assert numbers["method"] == "continuation" and numbers["points"] == 4
    assert numbers["reason"] == "the maximum of points was reached: 4"
    assert (tmp_path / "bifurcation_paper-lateral-1.png").stat().st_size > 1e4
    record = json.loads((tmp_path / "bifurcation_paper-lateral-1.json").read_text())
    assert record["numbers"] == numbers
    assert record["system"]["parameters"]["axle_load"] == 150.0e3
    assert record["versions"]["exudyn_wheelset"]


def test_the_branch_is_that_of_the_analysis_and_carries_its_settings(bogie):
    _, system, hopf, branch = bogie
    direct = limit_cycles(system, hopf, (65.0, 72.0), intervals=12)
    np.testing.assert_array_equal(branch.speed, direct.speed)
    assert branch.record["settings"]["intervals"] == 12
    assert branch.record["parameters"]["conicity"] == 0.05
    assert hopf.speed == pytest.approx(68.64, abs=0.02)


def test_a_file_is_drawn_again_and_gives_the_same_numbers(script, bogie, capsys):
    folder, _, hopf, branch = bogie
    path = branch.save(folder / "kept.npz")
    status, out, _ = run(script, capsys, "--redraw", path, "--json", "--out", folder / "again")
    numbers = json.loads(out)
    assert status == 0
    assert numbers["hopf"] == [hopf.speed]
    assert numbers["folds"] == [float(fold) for fold in branch.folds]
    assert numbers["points"] == len(branch) and numbers["reason"] == branch.reason
    assert numbers["nonlinear_critical_speed"] == branch.lowest_stable()[0]
    assert (folder / "again" / "kept.png").stat().st_size > 1e4


def test_stable_pieces_are_drawn_solid_and_unstable_ones_dashed(bogie):
    _, _, hopf, branch = bogie
    _, axes = new_figure(4.0, 3.0)
    draw_diagram(axes[0, 0], Diagram([branch]))
    drawn = {"-": [], "--": []}
    for line in axes[0, 0].lines:
        if line.get_linestyle() in drawn and len(line.get_xdata()):
            drawn[line.get_linestyle()].append(line.get_xydata())
    fold = branch.folds[0]
    (dashed,), (solid,) = drawn["--"], drawn["-"]
    # The unstable branch joins the Hopf point at rest to the fold, in millimetres.
    np.testing.assert_allclose(dashed[0], [hopf.speed, 0.0])
    name = branch.amplitude.names[0]
    np.testing.assert_allclose(dashed[-1], [fold.speed, 1e3 * fold.amplitude[name]])
    np.testing.assert_allclose(solid[0], dashed[-1])
    texts = [text.get_text() for text in axes[0, 0].texts]
    assert f"Hopf {hopf.speed:.2f} m/s" in texts and f"fold {fold.speed:.2f} m/s" in texts


def test_disturbed_speeds_lie_where_both_motions_are_stable(bogie):
    branch = bogie[3]
    speeds = disturbed_speeds(branch)
    assert np.all((branch.folds[0].speed < speeds) & (speeds < branch.hopf[0]))


@pytest.mark.slow
def test_descent_and_blows_agree_with_the_branch(script, bogie, capsys, tmp_path):
    """Three methods on the bogie: fold against jump, unstable branch against parting motions."""
    arguments = ["--vehicle", "cooperrider", "--speeds", "66", "70", "--step", "1", "--descent"]
    arguments += ["--disturbance", "68", "--intervals", "20", "--json", "--out", tmp_path]
    status, out, _ = run(script, capsys, *arguments)
    numbers = json.loads(out)
    assert status == 0
    # The descent's own tolerance and what a motion lingers beyond the fold.
    assert numbers["descent"]["speed"] == pytest.approx(numbers["folds"][0], abs=0.06)
    stem = tmp_path / "bifurcation_cooperrider"
    branch = Branch.load(stem.with_suffix(".npz"))
    diagram = Diagram.load([stem.with_name(f"{stem.name}_disturbance.npz")])
    name = branch.amplitude.names[0]
    (edge,) = branch.amplitudes_at(68.0, name, stable=False)
    # Where two motions part, the one has left the edge by up to a fifth.
    assert diagram.disturbances[0].edge[0] == pytest.approx(edge, rel=0.1)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--vehicle", "s102"], "'s1002'"),
        (["--vehicle", "cooperrider", "--gauge", "1.43"], "gauge"),
        (["--vehicle", "paper-lateral-1", "--speeds", "40", "30"], "lower one first"),
        (["--vehicle", "paper-lateral-1", "--searched", "5", "10"], "--searched"),
        (["--redraw", "no_such_file.npz"], "no such file"),
    ],
)
def test_wrong_arguments_end_with_status_2_and_one_line(script, capsys, tmp_path, arguments, word):
    status, out, err = run(script, capsys, *arguments, "--json", "--out", tmp_path / "out")
    assert status == 2 and out == ""
    assert word in err and len(err.strip().splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_speeds_that_leave_the_hopf_point_out_are_told_and_the_hopf_point_kept(
    script, capsys, tmp_path
):
    arguments = ("--vehicle", "paper-lateral-1", "--speeds", "50", "60", "--json")
    status, out, _ = run(script, capsys, *arguments, "--out", tmp_path)
    numbers = json.loads(out)
    assert status == 0 and numbers["points"] == 0 and len(numbers["hopf"]) == 1
    assert "widen the range" in numbers["reason"]


def test_a_file_that_is_no_result_is_refused(script, capsys, tmp_path):
    path = tmp_path / "other.npz"
    np.savez(path, x=np.zeros(3))
    status, out, err = run(script, capsys, "--redraw", path, "--json", "--out", tmp_path)
    assert status == 2 and out == "" and "not a result" in err
