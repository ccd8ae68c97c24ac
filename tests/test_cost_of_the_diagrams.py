"""What the shipped bifurcation diagrams cost, in counts that no machine changes.

The counts are a budget, not a truth: whoever moves one by more than 2 % has made a diagram dearer
or cheaper, and says so in the changelog with the new number here. Rounding differs between
processors and compilations and may cost a Newton step more or less, below 1 % for the bogie; on
flange impacts of profiled wheels it moved the counts by 2 to 6 %, so they have 6 %.
"""

import importlib.util
import sys
from pathlib import Path

import pytest

from exudyn_wheelset.catalogue import entry, vehicle_system
from exudyn_wheelset.catalogue.cooperrider_bogie import SCALES, STATE_NAMES, CooperriderBogie
from exudyn_wheelset.catalogue.cooperrider_reference import cooperrider_reference_system
from exudyn_wheelset.stability.hunting.diagram import branch_from, first_hopf_point
from exudyn_wheelset.systems.system import DynamicSystem

MODELS = Path(__file__).parents[1] / "models"
BOGIE = {"right_hand_sides": 85_732, "jacobians": 14_384, "newton_steps": 307}
S1002 = {"right_hand_sides": 72_600, "jacobians": 11_000, "newton_steps": 608}


def load(name):
    spec = importlib.util.spec_from_file_location(name, MODELS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def cost_of(branch):
    return {name: branch.record["cost"][name] for name in BOGIE}


@pytest.fixture(scope="module")
def bogie():
    """Cost of models/cooperrider_bogie.py: its equations without Jacobians, and with them."""
    script = load("cooperrider_bogie")
    systems = Plain(), cooperrider_reference_system()
    return [cost_of(script.run(system)[2]) for system in systems]


class Plain(DynamicSystem):
    """The bogie without Jacobians of its own."""

    name, state_names, scales = "plain bogie", STATE_NAMES, SCALES
    displacement_indices = tuple(range(7))
    bogie = CooperriderBogie()

    def derivative(self, state, speed):
        return self.bogie.derivatives(state[None], speed)[0]

    def derivatives(self, states, speed):
        return self.bogie.derivatives(states, speed)


def test_the_bogie_stays_in_its_budget(bogie):
    assert bogie[1] == pytest.approx(BOGIE, rel=0.02)


def test_differences_cost_one_right_hand_side_a_state_and_jacobian(bogie):
    """Fourteen states, 160 points a Newton step."""
    plain, written = bogie
    assert plain["jacobians"] == pytest.approx(written["jacobians"], rel=0.02)
    more_steps = plain["newton_steps"] - written["newton_steps"]
    expected = written["right_hand_sides"] + 14 * plain["jacobians"] + 160 * more_steps
    assert plain["right_hand_sides"] == pytest.approx(expected, rel=0.005)


@pytest.mark.slow
def test_the_s1002_wheelset_stays_in_its_budget():
    """models/bifurcation.py with its defaults."""
    system = vehicle_system("s1002")
    hopf, _ = first_hopf_point(system, *entry("s1002").searched)
    assert cost_of(branch_from(system, hopf)) == pytest.approx(S1002, rel=0.06)
