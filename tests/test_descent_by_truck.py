"""Descent of a vehicle whose trucks stop hunting at different, known speeds.

Two independent normal forms r' = r (v - v_k + 2 r^2 - r^4), phase' = w_k, stand for two trucks:
each has a stable cycle r^2 = 1 + sqrt(1 + v - v_k) down to its fold at v_k - 1.
"""

import numpy as np
import pytest

from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.descent import Descent, quasi_static_descent
from exudyn_wheelset.stability.hunting.settling import Settling, cycle_amplitudes
from exudyn_wheelset.systems.function_system import FunctionSystem

HOPF = {"front": 21.0, "rear": 20.0}
FREQUENCY = {"front": 6.0, "rear": 6.4}


def two_trucks(coupling=0.0):
    def derivative(state, speed):
        rates = []
        for k, name in enumerate(HOPF):
            x, y = state[2 * k : 2 * k + 2]
            square = x * x + y * y
            growth = speed - HOPF[name] + 2.0 * square - square**2
            rates += [growth * x - FREQUENCY[name] * y, growth * y + FREQUENCY[name] * x]
        rates[0] += coupling * (state[2] - state[0])
        rates[2] += coupling * (state[0] - state[2])
        return np.array(rates)

    names = (
        "front axle: y [m]",
        "front axle: yaw [rad]",
        "rear axle: y [m]",
        "rear axle: yaw [rad]",
    )
    system = FunctionSystem("two trucks", derivative, names, np.full(4, 1.0))
    system.displacement_indices = (0, 2)
    system.wheelset_names = ("front axle", "rear axle")
    system.trucks = {"front": ("front axle",), "rear": ("rear axle",)}
    return system


@pytest.fixture(scope="module")
def descent():
    start = [1.4, 0.0, 1.4, 0.0]
    return quasi_static_descent(two_trucks(), 21.5, 18.0, step=0.4, tolerance=0.02, state=start)


def test_each_truck_stops_at_its_own_fold(descent):
    assert descent.outcome.ending is Ending.JUMP_FOUND
    assert descent.by_truck["front"] == pytest.approx(20.0, abs=0.03)
    assert descent.by_truck["rear"] == pytest.approx(19.0, abs=0.03)
    assert descent.speed == pytest.approx(19.0, abs=0.03)


def test_amplitudes_of_each_truck_are_those_of_its_cycle(descent):
    for name in HOPF:
        hunting = np.asarray(descent.trucks[name]) > 0.0
        speeds = descent.speeds[hunting]
        expected = np.sqrt(1.0 + np.sqrt(np.maximum(1.0 + speeds - HOPF[name], 0.0)))
        np.testing.assert_allclose(descent.trucks[name][hunting], expected, rtol=5e-3)
    beside = descent.speeds < 19.9
    assert np.all(descent.trucks["front"][beside] == 0.0)


def test_a_file_brings_back_what_each_truck_did(descent, tmp_path):
    again = Descent.load(descent.save(tmp_path / "two.npz"))
    assert again.stops == descent.stops and again.trucks.names == ("front", "rear")
    np.testing.assert_array_equal(again.trucks, descent.trucks)


def test_a_beat_is_a_way_to_have_settled():
    """Coupled weakly, both cycles stay and modulate each other: no amplitude settles."""
    found = quasi_static_descent(
        two_trucks(0.15), 21.5, 21.2, step=0.3, state=[1.4, 0.0, 1.4, 0.0],
        settling=Settling(block=3, cycles=300),
    )  # fmt: skip
    assert np.all(found.settled)
    times = np.linspace(0.0, 200.0, 20001)
    states = two_trucks(0.15).simulate(found.states[0], float(found.speeds[0]), times)
    amplitudes = cycle_amplitudes(times, states[:, 2])[0]
    assert np.ptp(amplitudes) > 5e-3 * np.mean(amplitudes)
    assert found.trucks["rear"][0] == pytest.approx(np.mean(amplitudes), rel=1e-2)
