"""Periodic orbits against van der Pol's oscillator x'' - mu (1 - x^2) x' + x = 0.

The period at mu = 1 is 6.6632868593... (Andersen and Geer, SIAM J. Appl. Math. 42 (1982) 678, by
series); here it is computed anew by an integration of order 8 to a return to the section x' = 0.
The multiplier is exp of the integral of the divergence mu (1 - x^2) over a period (Liouville).
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.corrector import solve_orbit, speed_row
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.orbit import balanced_mesh, orbit_from_samples
from exudyn_wheelset.systems.function_system import FunctionSystem


def _derivatives(states, mu):
    x, v = states.T
    return np.stack([v, mu * (1 - x**2) * v - x], axis=1)


SYSTEM = FunctionSystem(
    "van der Pol",
    lambda state, mu: _derivatives(state[None], mu)[0],
    ("x", "v"),
    [1.0, 1.0],
    derivatives_function=_derivatives,
)


def reference(mu):
    """Period, amplitude of x and multiplier by DOP853 at 1e-13."""

    def equations(_, state):
        x, v, _ = state
        return [v, mu * (1 - x**2) * v - x, mu * (1 - x**2)]

    def section(_, state):
        return state[1]

    section.direction = -1.0
    start = [2.0, 0.0, 0.0]
    for _ in range(4):
        run = solve_ivp(equations, (0, 60), start, "DOP853", rtol=1e-13, atol=1e-14, events=section)
        start = [run.y_events[0][-1][0], 0.0, 0.0]
    run = solve_ivp(equations, (0, 40), start, "DOP853", rtol=1e-13, atol=1e-14, events=section)
    late = run.t_events[0] > 0.1
    return run.t_events[0][late][0], start[0], np.exp(run.y_events[0][late][0][2])


def solved(mu, intervals, tolerance=1e-11, adapt=True):
    period, amplitude, _ = reference(mu)
    times = np.linspace(0.0, period, 4 * intervals + 1)
    samples = SYSTEM.simulate(np.array([amplitude, 0.0]), mu, times)
    orbit = orbit_from_samples(samples, 1.01 * period, mu, intervals)
    equations = Collocation(SYSTEM, period, 1.0)
    row = speed_row(orbit, 2)
    orbit = solve_orbit(equations, orbit, row, tolerance=tolerance).orbit
    if adapt:
        orbit = orbit.on_mesh(balanced_mesh(orbit, SYSTEM.scales))
        orbit = solve_orbit(equations, orbit, row, tolerance=tolerance).orbit
    return equations, orbit


def test_published_period():
    assert reference(1.0)[0] == pytest.approx(6.663286859323, abs=1e-10)


@pytest.mark.parametrize("mu", [0.5, 1.0, 3.0])
def test_period_amplitude_and_multiplier(mu):
    period, amplitude, multiplier = reference(mu)
    equations, orbit = solved(mu, 60)
    assert orbit.period == pytest.approx(period, abs=1e-8)
    # Parabolas through samples a 960th of a period apart.
    assert orbit.half_peak_to_peak()[0] == pytest.approx(amplitude, rel=1e-5)
    found = equations.multipliers(orbit, equations.condense(orbit))
    assert found.values[0] == pytest.approx(multiplier, abs=1e-6)
    assert found.error < 1e-6


def test_order_of_convergence():
    """Degree 4: the period's error falls with h^8 on even meshes, at least with h^7 measured."""
    period = reference(1.0)[0]
    errors = [abs(solved(1.0, n, adapt=False)[1].period - period) for n in (20, 40)]
    assert np.log2(errors[0] / errors[1]) > 7.0


def test_adapted_mesh_is_better_than_an_even_one():
    period = reference(3.0)[0]
    even, adapted = (abs(solved(3.0, 30, adapt=a)[1].period - period) for a in (False, True))
    assert adapted < 0.1 * even


def test_branch_over_mu_from_a_state():
    branch = limit_cycles(SYSTEM, [2.0, 0.0], (0.5, 3.0), start_speed=1.0, intervals=60)
    assert branch.folds == []
    assert np.all(branch.stable)
    assert branch.speed[0] == pytest.approx(0.5) and branch.speed[-1] == pytest.approx(3.0)
    assert branch.period[0] == pytest.approx(reference(0.5)[0], abs=1e-7)
    assert branch.period[-1] == pytest.approx(reference(3.0)[0], abs=1e-6)
