"""Endings: every member says its own sentence, survives files and pickle, and is carried along."""

import json
import pickle

import numpy as np
import pytest

from exudyn_wheelset import FunctionSystem
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.systems.system import SimulationError


def test_no_two_endings_say_the_same():
    # Members of an enum with equal values would silently be one.
    assert len({ending.sentence for ending in Ending}) == len(Ending.__members__)


@pytest.mark.parametrize("ending", list(Ending))
def test_an_outcome_comes_back_from_a_file_and_from_pickle(ending):
    outcome = Outcome(ending, "wheelset 2 at 3.1 s")
    assert Outcome.read(json.loads(json.dumps(outcome.record()))) == outcome
    assert pickle.loads(pickle.dumps(outcome)) == outcome
    assert str(outcome) == f"{ending.value}: wheelset 2 at 3.1 s"


def test_only_what_left_the_rails_is_derailed():
    derailed = {ending.name for ending in Ending if ending.derailed}
    assert derailed == {"WHEEL_CLIMB", "LIFT_OFF", "LOST_GAUGE"}


def test_a_motion_that_runs_away_says_so_and_keeps_what_was_computed():
    """x' = x^2 from 1 m ends at 1 s: x = 1/(1 - t)."""
    system = FunctionSystem("blow-up", lambda x, _: x**2, ["x [m]"], [1.0])
    times = np.linspace(0.0, 2.0, 201)
    with pytest.raises(SimulationError) as caught:
        system.simulate(np.array([1.0]), 1.0, times)
    for error in (caught.value, pickle.loads(pickle.dumps(caught.value))):
        assert error.outcome.ending is Ending.RAN_AWAY
        assert error.times[-1] == pytest.approx(0.99)
        # A shift of the blow-up by dt changes x by x^2 dt: the solver's 1e-8 grows to some 1e-4.
        assert error.states[:, 0] == pytest.approx(1.0 / (1.0 - error.times), rel=1e-4)
