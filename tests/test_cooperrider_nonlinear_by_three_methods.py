"""Nonlinear critical speed and amplitudes of the Cooperrider bogie, each found in two ways.

Continuation of periodic orbits, quasi-static descent by simulation and plain long simulation know
nothing of each other; where they agree the number belongs to the model.
"""

import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from exudyn_wheelset.catalogue.cooperrider_bogie import STATE_NAMES
from exudyn_wheelset.catalogue.cooperrider_reference import cooperrider_reference_system
from exudyn_wheelset.stability.hunting.nonlinear import nonlinear_critical_speed

SCRIPT = Path(__file__).parents[1] / "models" / "cooperrider_bogie.py"


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("cooperrider_bogie_script", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def result(script):
    return script.run(cooperrider_reference_system())


def test_the_straight_run_loses_stability_subcritically(result):
    numbers, _, branch = result
    assert numbers["hopf"] == pytest.approx(68.64, abs=0.02)
    assert numbers["fold"] < numbers["hopf"] - 1.0
    assert not branch.stable[0]
    assert branch.stable[-1]


def test_descent_meets_the_fold(result):
    """Within 0.05 m/s of the fold of continuation, from simulated motion alone."""
    numbers, hopf, _ = result
    descent = nonlinear_critical_speed(cooperrider_reference_system(), "descent", hopf=hopf)
    assert float(descent) == pytest.approx(numbers["fold"], abs=0.05)


@pytest.mark.parametrize("speed", [70.0, 75.0])
def test_amplitudes_of_long_simulations(result, speed):
    """From 12 mm through 40 s: multipliers below 0.5 a period of 0.25 s leave no transient."""
    system = cooperrider_reference_system()
    start = np.zeros(14)
    start[0] = 12e-3
    solution = solve_ivp(
        lambda _, x: system.derivative(x, speed),
        (0.0, 20.0),
        start,
        method="DOP853",
        t_eval=np.linspace(19.0, 20.0, 20001),
        rtol=1e-8,
        atol=1e-11,
        max_step=2e-3,
    )
    amplitude = 0.5e3 * np.ptp(solution.y[0])
    # The collocated orbit is smooth across the flange's corner: 1e-4 with 80 intervals.
    assert result[0]["amplitude_mm"][f"{speed:g}"] == pytest.approx(amplitude, rel=2e-4)


def test_below_the_fold_hunting_dies_out(result):
    system = cooperrider_reference_system()
    speed = result[0]["fold"] - 0.3
    start = np.zeros(14)
    start[0] = 12e-3
    states = system.simulate(start, speed, np.linspace(0.0, 60.0, 6001))
    assert np.abs(states[-100:, 0]).max() < 1e-4


def test_the_unstable_branch_is_the_edge_of_the_basin(result):
    """From 0.97 and 1.03 of the unstable cycle the bogie comes to rest and to hunting."""
    _, _, branch = result
    index = int(np.argmin(np.abs(branch.speed - 67.8) + 1e3 * branch.stable))
    orbit, system = branch.orbit(index), cooperrider_reference_system()
    times = np.linspace(0.0, 40.0, 4001)
    small = system.simulate(0.97 * orbit.states[0], orbit.speed, times)[-100:, 0]
    large = system.simulate(1.03 * orbit.states[0], orbit.speed, times)[-100:, 0]
    column = branch.amplitude[STATE_NAMES[0]]
    assert np.abs(small).max() < 0.5 * column[index]
    assert np.abs(large).max() > 9e-3


def test_the_script_in_exudyn_agrees_with_the_reference_equations(script, result, tmp_path, capsys):
    numbers = script.main(["--json", "--out", str(tmp_path)])
    assert json.loads(capsys.readouterr().out) == numbers
    assert json.loads((tmp_path / "cooperrider_bogie.json").read_text())["numbers"] == numbers
    assert (tmp_path / "cooperrider_bogie.png").stat().st_size > 10000
    expected = result[0]
    # The creep law has |xi| xi in it, where central differences are of first order: 1e-6 relative.
    assert numbers["hopf"] == pytest.approx(expected["hopf"], abs=2e-4)
    assert numbers["fold"] == pytest.approx(expected["fold"], abs=1e-3)
    for speed in ("70", "75"):
        assert numbers["amplitude_mm"][speed] == pytest.approx(
            expected["amplitude_mm"][speed], rel=1e-4
        )
