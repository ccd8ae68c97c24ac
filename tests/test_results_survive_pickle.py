"""Results go through pickle with their names and numbers, and say in a line what they are."""

import pickle

import numpy as np
import pytest

from exudyn_wheelset import (
    AnalysisError,
    Track,
    Wheelset,
    contact_forces,
    contact_geometry,
    limit_cycles,
    linear_critical_speed,
    linearise,
    nonlinear_critical_speed,
    quasi_static_descent,
    root_locus,
)
from exudyn_wheelset.catalogue.cooperrider_bogie import cooperrider_system

NAMES = (
    "critical",
    "branch",
    "orbit",
    "fold",
    "linearisation",
    "locus",
    "descent",
    "nonlinear",
    "geometry",
    "forces",
    "amplitude",
)


@pytest.fixture(scope="module")
def results():
    system = cooperrider_system()
    critical = linear_critical_speed(system, 50, 80)
    branch = limit_cycles(system, critical, (60, 75))
    wheelset, track = Wheelset(1e3, (500, 100, 500), 0.46, "S1002"), Track("UIC60")
    pose, velocity = (0, 1e-3, -2e-4, 0, 0, 0), (20, 0, 0, 0, 43, 0)
    found = (
        critical,
        branch,
        branch.orbits[0],
        branch.folds[0],
        linearise(system, 60.0),
        root_locus(system, [50.0, 60.0]),
        quasi_static_descent(system, 75.0, 66.0, step=3.0, tolerance=1.0),
        nonlinear_critical_speed(system, low=60, high=75),
        contact_geometry(wheelset, track, [0.0, 1e-3]),
        contact_forces(wheelset, track, pose, velocity),
        branch.amplitude,
    )
    return dict(zip(NAMES, found, strict=True))


def same(one, other):
    assert type(one) is type(other)
    if isinstance(one, np.ndarray):
        assert one.tobytes() == other.tobytes()
    elif isinstance(one, dict):
        assert one.keys() == other.keys()
        for key, value in one.items():
            same(value, other[key])
    elif isinstance(one, tuple | list):
        assert len(one) == len(other)
        for a, b in zip(one, other, strict=True):
            same(a, b)
    elif hasattr(one, "__dataclass_fields__"):
        for name in one.__dataclass_fields__:
            if name != "system":
                same(getattr(one, name), getattr(other, name))
    else:
        assert one == other or one != one


@pytest.mark.parametrize("name", NAMES)
def test_a_result_comes_back_whole(results, name):
    given = results[name]
    back = pickle.loads(pickle.dumps(given))
    same(given, back)
    if isinstance(given, float):
        assert float(back) == float(given)


def test_columns_and_modes_keep_their_names(results):
    branch = pickle.loads(pickle.dumps(results["branch"]))
    assert branch.amplitude.names == results["branch"].amplitude.names
    assert np.array_equal(branch.amplitude["q1"], results["branch"].amplitude["q1"])
    linear = pickle.loads(pickle.dumps(results["linearisation"]))
    assert linear.mode_names == results["linearisation"].mode_names
    with pytest.raises(AnalysisError, match="stored without its model; build the model again"):
        linear.system.derivative(linear.state, 60.0)
    again = pickle.loads(pickle.dumps(linear))
    assert again.system.measures() == results["linearisation"].system.measures()


@pytest.mark.parametrize("name", NAMES)
def test_a_result_is_one_short_line(results, name):
    words = repr(results[name])
    assert len(words) <= 400
    assert "\n" not in words
