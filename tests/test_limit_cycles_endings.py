"""How analyses end: every reason is stated, nothing found is lost, files bring it back.

The systems are the normal form of `test_normal_form_hopf_fold.py` with an edge built in.
"""

import json

import numpy as np
import pytest

from exudyn_wheelset.errors import AnalysisError, ContactError
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting import nonlinear
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.continuation import ContinuationSettings
from exudyn_wheelset.stability.hunting.descent import Descent, quasi_static_descent
from exudyn_wheelset.stability.hunting.diagram import drawn_speeds
from exudyn_wheelset.stability.hunting.disturbance import CriticalDisturbances, critical_disturbance
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.nonlinear import NoLimitCycleError, nonlinear_critical_speed
from exudyn_wheelset.stability.hunting.settling import Settling
from exudyn_wheelset.stability.linear.crossings import CriticalPoint, hopf_points
from exudyn_wheelset.systems.function_system import FunctionSystem


def normal_form(edge=np.inf, at_edge=None, calls_left=None, name="normal form"):
    """r' = (mu + r^2 - r^4) r; at r > edge `at_edge()` is raised or returned."""
    counter = {"left": calls_left}

    def derivatives(states, mu):
        if counter["left"] is not None:
            counter["left"] -= 1
            if counter["left"] < 0:
                raise KeyboardInterrupt
        x, y = states.T
        square = x**2 + y**2
        if np.any(square > edge**2):
            return at_edge(states)
        growth = mu + square - square**2
        return np.stack([growth * x - y, x + growth * y], axis=1)

    return FunctionSystem(
        name,
        lambda state, mu: derivatives(state[None], mu)[0],
        ("x [m]", "y [m]"),
        [1.0, 1.0],
        displacement_indices=(0, 1),
        derivatives_function=derivatives,
        parameters={"edge": edge},
    )


def raise_contact_error(states):
    raise ContactError("the wheel left the rail at y = 12 mm")


def follow(system, **settings):
    hopf = hopf_points(normal_form(), -0.45, 0.5)[0]
    return limit_cycles(system, hopf, (-0.45, 0.5), **settings)


@pytest.mark.parametrize(
    "at_edge", [raise_contact_error, lambda states: np.full_like(states, np.nan)]
)
def test_lost_contact_keeps_what_was_found(at_edge):
    branch = follow(normal_form(edge=0.9, at_edge=at_edge))
    assert branch.outcome.ending is Ending.CONTACT_LOST
    assert branch.folds[0] == pytest.approx(-0.25, abs=1e-6)
    # Up to a step of 1e-4 of the largest one before the edge.
    assert 0.89 < branch.amplitude["x"].max() < 0.9
    if at_edge is raise_contact_error:
        assert "y = 12 mm" in branch.reason


def test_amplitude_limit():
    branch = follow(normal_form(), amplitude_limits=(("x [m]", 0.9),))
    assert branch.reason.startswith("the amplitude limit was passed: x [m]")
    assert branch.amplitude["x"][-2] < 0.9 < branch.amplitude["x"][-1]


def test_maximum_of_points():
    branch = follow(normal_form(), maximum_points=7)
    assert len(branch) == 7
    assert branch.reason == "the maximum of points was reached: 7"
    with pytest.raises(AnalysisError, match="no limit cycle of the branch is stable"):
        branch.lowest_stable()


def test_speed_range_left_at_the_lower_end():
    hopf = hopf_points(normal_form(), -0.45, 0.5)[0]
    branch = limit_cycles(normal_form(), hopf, (-0.1, 0.5))
    assert branch.reason == "the speed range was left at its lower end: -0.1 m/s"
    assert branch.speed[-1] == pytest.approx(-0.1, abs=1e-12)
    with pytest.raises(NoLimitCycleError) as caught:
        nonlinear_critical_speed(normal_form(), low=-0.1, high=0.5, hopf=hopf)
    assert len(caught.value.branch) == len(branch)


def test_no_convergence_at_the_smallest_step():
    def jump(states):
        return np.random.default_rng(int(1e9 * states[0, 0] % 1e9)).normal(size=states.shape)

    branch = follow(normal_form(edge=0.8, at_edge=jump))
    assert branch.outcome.ending is Ending.ORBIT_LOST
    assert branch.folds and branch.amplitude["x"].max() < 0.8


def test_interrupted_branch_is_kept():
    branch = follow(normal_form(calls_left=4_000))
    assert branch.outcome.ending is Ending.INTERRUPTED
    assert 3 < len(branch) < 25


def test_closed_branch():
    """r^2 = 1 + 0.5 cos a, mu = 0.3 sin a: an isola, (mu/0.3)^2 + ((r^2 - 1)/0.5)^2 = 1."""

    def derivatives(states, mu):
        x, y = states.T
        square = x**2 + y**2
        growth = 1.0 - (mu / 0.3) ** 2 - ((square - 1.0) / 0.5) ** 2
        return np.stack([growth * x - y, x + growth * y], axis=1)

    system = FunctionSystem(
        "isola",
        lambda state, mu: derivatives(state[None], mu)[0],
        ("x", "y"),
        [1.0, 1.0],
        displacement_indices=(0, 1),
        derivatives_function=derivatives,
    )
    branch = limit_cycles(system, [1.2, 0.0], (-1.0, 1.0), start_speed=0.0)
    assert branch.outcome.ending is Ending.CLOSED
    assert sorted(map(float, branch.folds)) == pytest.approx([-0.3, 0.3], abs=1e-6)
    assert {fold.side for fold in branch.folds} == {"lowest", "highest"}


def test_no_orbit_to_begin_with():
    with pytest.raises(AnalysisError, match="died out"):
        limit_cycles(normal_form(), [0.1, 0.0], (-0.45, 0.5), start_speed=-0.2)
    hopf = hopf_points(normal_form(), -0.45, 0.5)[0]
    with pytest.raises(AnalysisError, match="widen the range"):
        limit_cycles(normal_form(), hopf, (0.2, 0.5))
    with pytest.raises(AnalysisError, match="low below high"):
        limit_cycles(normal_form(), hopf, (0.5, 0.2))
    with pytest.raises(AnalysisError, match="no Hopf point"):
        nonlinear_critical_speed(normal_form(), low=0.2, high=0.4)
    with pytest.raises(AnalysisError, match="at least 4 intervals"):
        ContinuationSettings(intervals=2)


def test_branch_comes_back_from_its_file(tmp_path):
    branch = follow(normal_form())
    path = branch.save(tmp_path / "diagram")
    loaded = Branch.load(path)
    for name in ("speed", "period", "amplitude", "stable", "multipliers", "states"):
        np.testing.assert_array_equal(getattr(loaded, name), getattr(branch, name))
    assert (loaded.reason, loaded.method, loaded.hopf) == (
        branch.reason,
        "continuation",
        branch.hopf,
    )
    assert loaded.folds == branch.folds
    assert loaded.folds[0].amplitude == branch.folds[0].amplitude
    assert loaded.amplitude.names == ("x [m]", "y [m]")
    for key in ("system", "parameters", "versions", "settings", "method", "cost"):
        assert key in loaded.record
    assert loaded.record["settings"]["speeds"] == [-0.45, 0.5]
    assert json.loads(str(np.load(path)["record"]))["kind"] == "branch of limit cycles"
    assert sorted(tmp_path.iterdir()) == [path]


def test_branch_continues_from_its_file(tmp_path):
    first = limit_cycles(normal_form(), hopf_points(normal_form(), -0.45, 0.5)[0], (-0.45, 0.1))
    loaded = Branch.load(first.save(tmp_path / "part.npz"))
    more = limit_cycles(normal_form(), loaded.orbits[-1], (0.05, 0.5))
    square = np.sum(more.states**2, axis=1)
    np.testing.assert_allclose(more.speed, square**2 - square, atol=1e-7)
    assert more.speed.max() == pytest.approx(0.5)


def test_plot_shows_stable_and_unstable_parts(tmp_path):
    figure = pytest.importorskip("matplotlib.figure").Figure()
    axes = figure.subplots()
    branch = Branch.load(follow(normal_form()).save(tmp_path / "diagram.npz"))
    branch.plot(axes, "x", label="normal form")
    styles = [line.get_linestyle() for line in axes.lines]
    assert "--" in styles and "-" in styles
    texts = {text.get_text() for text in axes.texts}
    assert {text.replace("-0.00", "0.00") for text in texts} == {"Hopf 0.00 m/s", "fold -0.25 m/s"}
    dashed = next(line for line in axes.lines if line.get_linestyle() == "--")
    # From the Hopf point to the fold, in order.
    assert dashed.get_xdata()[0] == pytest.approx(0.0, abs=1e-8)
    assert dashed.get_xdata()[-1] == pytest.approx(-0.25, abs=1e-6)


def test_files_that_are_not_results(tmp_path):
    (tmp_path / "text.npz").write_text("no archive")
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    for name in ("text.npz", "other.npz", "missing.npz"):
        with pytest.raises(AnalysisError, match=name):
            Branch.load(tmp_path / name)
    path = quasi_static_descent(normal_form(), 0.2, 0.1, step=0.1).save(tmp_path / "descent.npz")
    with pytest.raises(AnalysisError, match="quasi-static descent"):
        Branch.load(path)


SETTLING = Settling(tolerance=1e-3, block=4)


def descend(system, path=None):
    return quasi_static_descent(
        system,
        0.21,
        -0.45,
        step=0.1,
        tolerance=0.02,
        state=[0.9, 0.0],
        settling=SETTLING,
        state_file=path,
    )


def test_interrupted_descent_goes_on_where_it_was(tmp_path):
    whole = descend(normal_form())
    path = tmp_path / "descent.npz"
    finished = [0]
    for calls in (9_000, 12_000, 15_000, 18_000):
        part = descend(normal_form(calls_left=calls), path)
        if part.outcome.ending is not Ending.INTERRUPTED:
            break
        assert len(part.speeds) >= finished[-1]
        finished.append(len(part.speeds))
        kept = Descent.load(path)
        np.testing.assert_array_equal(kept.speeds, part.speeds)
    else:
        part = descend(normal_form(), path)
    assert len(finished) > 2
    np.testing.assert_allclose(part.speeds, whole.speeds, atol=1e-12)
    np.testing.assert_allclose(part.amplitude, whole.amplitude, rtol=1e-6)
    assert part.bracket == pytest.approx(whole.bracket)
    assert part.reason == whole.reason
    # A finished run answers from its file alone.
    again = descend(normal_form(calls_left=0), path)
    assert again.speed == part.speed


def test_descent_refuses_the_file_of_another_run(tmp_path):
    path = tmp_path / "descent.npz"
    descend(normal_form(), path)
    with pytest.raises(AnalysisError, match="other settings"):
        quasi_static_descent(normal_form(), 0.3, -0.45, state_file=path)
    with pytest.raises(AnalysisError, match="other parameters"):
        descend(normal_form(edge=5.0, at_edge=raise_contact_error), path)


def test_descent_ends():
    with pytest.raises(AnalysisError, match="does not hunt"):
        quasi_static_descent(normal_form(), -0.1, -0.2, state=[0.1, 0.0])
    system = normal_form(edge=1.0, at_edge=raise_contact_error)
    with pytest.raises(AnalysisError, match="y = 12 mm"):
        quasi_static_descent(system, 0.3, -0.3, state=[0.9, 0.0])
    ended = quasi_static_descent(normal_form(), 0.2, 0.0, step=0.1, state=[0.9, 0.0])
    assert ended.reason == "still hunting at the lower end: 0 m/s"
    assert np.isnan(ended.speed) and len(ended.speeds) == 3


def test_disturbance_runs_come_back_from_their_file(tmp_path):
    runs = critical_disturbance(normal_form(), [-0.2, -0.1], 1.5, tolerance=0.05)
    loaded = CriticalDisturbances.load(runs.save(tmp_path / "runs.npz"))
    np.testing.assert_array_equal(loaded.critical, runs.critical)
    np.testing.assert_array_equal(loaded.edge, runs.edge)
    assert (loaded.direction, loaded.runs) == ("y [m]", runs.runs)


def test_lost_contact_counts_as_a_critical_disturbance():
    system = normal_form(edge=0.8, at_edge=raise_contact_error)
    runs = critical_disturbance(system, -0.2, 0.79, tolerance=0.02)
    assert runs.critical[0] == pytest.approx(np.sqrt(0.5 - np.sqrt(0.05)), rel=0.02)
    with pytest.raises(AnalysisError, match="is not one of"):
        critical_disturbance(system, -0.2, 0.79, direction="roll")


@pytest.mark.parametrize(
    ("method", "ends"), [("continuation", (0.4, 1.3)), ("descent", (0.4, 1.1))]
)
def test_ranges_and_steps_that_the_documentation_names(monkeypatch, method, ends):
    """In Hopf speeds, by continuation and by descent; a descent goes by one per cent."""
    asked = {}

    def stop(system, *speeds, step=None, **_):
        asked.update(speeds=speeds, step=step)
        raise InterruptedError

    monkeypatch.setattr(nonlinear, "quasi_static_descent", stop)
    monkeypatch.setattr(
        nonlinear, "_by_continuation", lambda system, hopf, speeds, *_: stop(system, *speeds)
    )
    hopf = CriticalPoint(50.0, 1.0, 1j, np.ones(2), np.zeros(2), 1.0, "hopf", ("x", "y"), 0)
    with pytest.raises(InterruptedError):
        nonlinear_critical_speed(normal_form(), method, hopf=hopf)
    assert sorted(asked["speeds"]) == pytest.approx([50.0 * end for end in ends])
    assert asked["step"] == (0.5 if method == "descent" else None)
    assert drawn_speeds(hopf) == pytest.approx((25.0, 65.0))
