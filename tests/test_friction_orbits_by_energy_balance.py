"""Limit cycles with dry friction against the balance of energy: continuation through the kinks.

A weakly damped oscillator, y'' + w^2 y = c(V) y' - F h/m, h' = (v - |v| h)/delta, moves nearly as
a sine: negative damping gives pi c w A^2 a cycle, friction takes 4 F A - 4 F delta
tanh(A/delta) (per mass). Both are equal on the orbits: a stable one that begins at c = 0 and a
larger, unstable one, which meet where the loss over A^2 is greatest. Friction is weak here, so
that the sine is good to the tolerance asked: the stiffness of the hold is 4 % of the spring's.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from exudyn_wheelset import (
    FunctionSystem,
    catalogue,
    hopf_points,
    limit_cycles,
    linear_critical_speed,
)
from exudyn_wheelset.stability.hunting.descent import mode_disturbance
from exudyn_wheelset.systems.system import as_system

FREQUENCY, SLIP, PRESLIDING, RATE, FIRST = 10.0, 4.0e-3, 1.0e-3, 2.0e-3, 20.0


def rates(state, speed):
    """Oscillator with negative damping RATE (V - FIRST) and friction."""
    y, v, hold = state
    driven = RATE * (speed - FIRST) * v
    slipping = (v - abs(v) * hold) / PRESLIDING
    return np.array([v, -(FREQUENCY**2) * y + driven - SLIP * hold, slipping])


def loss(amplitude):
    """Work of friction a cycle, per mass."""
    return 4.0 * SLIP * (amplitude - PRESLIDING * np.tanh(amplitude / PRESLIDING))


@pytest.fixture(scope="module")
def branch():
    system = FunctionSystem(
        "oscillator with dry friction",
        rates,
        ["y [m]", "vy [m/s]", "friction hold [-]"],
        [1e-3, 1e-2, 0.1],
        displacement_indices=[0],
    )
    (hopf,) = hopf_points(system, 10.0, 40.0)
    assert hopf.speed == pytest.approx(FIRST, abs=1e-6)
    assert hopf.frequency * 2.0 * np.pi == pytest.approx(
        np.sqrt(FREQUENCY**2 + SLIP / PRESLIDING), rel=1e-9
    )
    return limit_cycles(system, hopf, (10.0, 200.0), intervals=30, maximum_points=45)


def test_orbits_balance_their_energy(branch):
    amplitudes = np.asarray(branch.amplitude)[:, 0]
    given = np.pi * RATE * (branch.speed - FIRST) * (2.0 * np.pi / branch.period) * amplitudes**2
    large = amplitudes > 0.01 * PRESLIDING
    assert np.count_nonzero(large) > 10
    assert given[large] == pytest.approx(loss(amplitudes[large]), rel=0.01)


def test_stable_and_unstable_orbit_meet_where_the_loss_is_greatest(branch):
    """The greatest negative damping that friction bounds: max of the loss over pi w A^2."""
    best = minimize_scalar(
        lambda a: -loss(a) / a**2, bounds=(0.1 * PRESLIDING, 10.0 * PRESLIDING), method="bounded"
    )
    place = int(np.argmax(branch.speed))
    frequency = 2.0 * np.pi / branch.period[place]
    expected = FIRST - best.fun / (np.pi * frequency * RATE)
    assert len(branch.folds) == 1
    assert branch.folds[0].speed == pytest.approx(expected, rel=0.01)
    assert np.all(np.asarray(branch.stable[1 : place - 1], dtype=bool))
    assert not np.any(np.asarray(branch.stable[place + 2 :], dtype=bool))


def test_what_friction_holds_beside_an_orbit_is_neutral():
    """A second mass, stuck: its hold may be strained by anything, a multiplier 1 of every orbit."""

    def beside(state, speed):
        _, v, hold = state[3:]
        slipping = (v - abs(v) * hold) / PRESLIDING
        return np.array([*rates(state[:3], speed), v, -SLIP * (hold + 0.3 * slipping), slipping])

    def system(function, count):
        names = [f"{n}{k}" for k in range(count) for n in ("y [m] ", "vy [m/s] ", "hold [-] ")]
        names = [f"body {n[-1]}: {n[:-2].strip()}" for n in names]
        scales = [1e-3, 1e-2, 0.1] * count
        return FunctionSystem("oscillator", function, names, scales, displacement_indices=[0])

    found = []
    for one in (system(rates, 1), system(beside, 2)):
        hopf = min(hopf_points(one, 10.0, 40.0))
        found.append(limit_cycles(one, hopf, (10.0, 200.0), intervals=20, maximum_points=12))
    alone, both = found
    assert np.all(np.asarray(both.stable[1:8], dtype=bool))
    np.testing.assert_allclose(
        np.abs(both.multipliers[5]).max(), np.abs(alone.multipliers[5]).max(), atol=0.02
    )


def test_friction_bounds_the_hunting_of_a_wagon_and_simulation_keeps_its_orbit():
    """From the stuck wagon's Hopf point a stable branch of small orbits.

    Five periods by Runge-Kutta from one of them keep its amplitude.
    """
    system = as_system(catalogue.two_axle_wagon())
    hopf = linear_critical_speed(system, 15.0, 40.0, points=12)
    branch = limit_cycles(system, hopf, (20.0, 27.0), intervals=20)
    sway = branch.amplitude["body: y"]
    assert np.all(np.asarray(branch.stable, dtype=bool))
    assert np.all(np.diff(sway) > 0.0)
    assert 5e-5 < sway[-1] < 1e-3
    orbit = branch.orbits[-1]
    times = np.linspace(0.0, 5.0 * orbit.period, 501)
    motion = system.simulate(orbit.states[0], orbit.speed, times)
    body = system.state_names.index("body: y [m]")
    for cycle in (motion[:101, body], motion[-101:, body]):
        assert 0.5 * np.ptp(cycle) == pytest.approx(sway[-1], rel=0.02)


@pytest.mark.slow
def test_the_branch_of_the_loaded_freight_car_goes_on_through_slipping_wedges():
    """From a sway of the loaded car at 44 m/s, wedges near slipping, up and down in speed.

    Its orbits are stable but for what friction holds, and simulation stays on them.
    """
    system = as_system(catalogue.freight_car())
    start = mode_disturbance(system, 44.0, 1.1)
    swaying = system.simulate(start, 44.0, np.arange(0.0, 12.0, 4e-3))[-1]
    branch = limit_cycles(
        system, swaying, (43.0, 44.6), start_speed=44.0, intervals=20, maximum_points=6
    )
    assert len(branch) >= 4
    assert np.all(np.asarray(branch.stable, dtype=bool))
    assert np.all(np.diff(branch.amplitude["body: y"][np.argsort(branch.speed)]) > 0.0)
    orbit = branch.orbits[int(np.argmax(branch.speed))]
    times = np.linspace(0.0, 5.0 * orbit.period, 501)
    motion = system.simulate(orbit.states[0], orbit.speed, times)
    holds = [k for k, name in enumerate(system.state_names) if "wedge" in name]
    assert np.abs(motion[:, holds]).max() > 0.5
    body = system.state_names.index("body: y [m]")
    expected = orbit.half_peak_to_peak()[list(system.displacement_indices).index(body)]
    for cycle in (motion[:101, body], motion[-101:, body]):
        assert 0.5 * np.ptp(cycle) == pytest.approx(expected, rel=0.01)
