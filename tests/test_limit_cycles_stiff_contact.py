"""Limit cycles beside an undamped oscillation fifty times as fast, as a wheel's bounce on its
contact is beside hunting: the cycle must be that of the slow motion alone, as theory has it."""

import numpy as np
import pytest

from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.linear.crossings import hopf_points
from exudyn_wheelset.systems.function_system import FunctionSystem

FAST = 50.0


def equations(state, speed):
    """x'' = (speed - x^2) x' - x + z with z'' = -FAST^2 (z - x^3/4): a slow cycle drives z."""
    x, v, z, w = state
    return np.array([v, (speed - x * x) * v - x + z, w, -(FAST**2) * (z - 0.25 * x**3)])


def slaved(state, speed):
    """The same with z = x^3/4, the limit of an infinitely fast, quiet z."""
    x, v = state
    return np.array([v, (speed - x * x) * v - x + 0.25 * x**3])


def cycles(function, names, stiff):
    scales = np.array([1.0, 1.0, 1.0, FAST][: len(names)])
    system = FunctionSystem("fast and slow", function, names, scales, displacement_indices=[0])
    system.stiff = stiff
    hopf = hopf_points(system, -0.5, 0.5)[0]
    return limit_cycles(system, hopf, (-0.1, 0.6), intervals=20, mirror=False)


def test_a_fast_oscillation_that_the_mesh_does_not_resolve_leaves_the_cycle_alone():
    whole = cycles(equations, ("x [m]", "v [m/s]", "z [m]", "w [m/s]"), stiff=True)
    slow = cycles(slaved, ("x [m]", "v [m/s]"), stiff=False)
    assert whole.outcome.ending is Ending.UPPER_END
    # z follows x^3/4 up to its inertia, (slow/fast)^2 of it, with the third harmonic at 9/FAST^2.
    for speed in (0.1, 0.3, 0.55):
        there = slow.amplitudes_at(speed, "x [m]")
        assert whole.amplitudes_at(speed, "x [m]") == pytest.approx(there, rel=5e-3)
    assert np.all(whole.stable) and np.all(slow.stable)
    assert np.max(whole.trivial_error) < 1e-2
