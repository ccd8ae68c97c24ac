"""What descents begin with, and what a continuation's answer is checked from.

r' = r (V - 1 + r^2 - r^4), 6 rad/s: stable cycles of r^2 = 1/2 + sqrt(V - 3/4) down to the fold at
V = 3/4, the Hopf point at V = 1; below it the straight run draws in what is smaller than
r^2 = 1/2 - sqrt(V - 3/4).
"""

from dataclasses import replace

import numpy as np
import pytest

from exudyn_wheelset import (
    AnalysisError,
    FunctionSystem,
    hopf_points,
    limit_cycles,
    nonlinear_critical_speed,
)
from exudyn_wheelset.stability.hunting.large_starts import hunting_at
from exudyn_wheelset.stability.hunting.simulated_stability import SHORT, simulated_below

FOLD, HOPF = 0.75, 1.0


def fold_system(scale, reach=np.inf):
    """The equations; a motion farther out than `reach` is lost, as one that leaves its rails."""

    def rate(state, speed):
        x, y = state
        square = x * x + y * y
        if square > reach**2:
            return np.full(2, np.nan)
        growth = speed - 1.0 + square - square**2
        return np.array([growth * x - 6.0 * y, 6.0 * x + growth * y])

    return FunctionSystem("fold", rate, ["x [m]", "y [m]"], [scale, scale])


def descent(system):
    (hopf,) = hopf_points(system, 0.9, 1.2)
    assert hopf.speed == pytest.approx(HOPF, abs=1e-5)
    return nonlinear_critical_speed(system, "descent", hopf=hopf, low=0.5, tolerance=0.01)


def test_a_descent_begins_smaller_where_large_motions_are_lost():
    found = descent(fold_system(1.0, reach=2.0))
    assert found.speed == pytest.approx(FOLD, abs=0.01)


def test_a_descent_that_is_lost_at_every_size_says_what_may_help():
    with pytest.raises(AnalysisError, match="lower speed or with a smaller disturbance"):
        descent(fold_system(1.0, reach=0.9))


def test_hunting_is_looked_for_from_orbits_that_are_known_above():
    """Starts of 5 and 10 scales, 0.05 and 0.1, die out below the Hopf point; the orbit does not."""
    system = fold_system(1e-2)
    branch = limit_cycles(system, [1.2, 0.0], (0.7, 1.05), start_speed=0.95)
    orbit = branch.orbits[int(np.argmin(np.where(branch.stable, np.abs(branch.speed - 0.9), 9.0)))]
    assert hunting_at(system, 0.85, SHORT, 0.1) is None
    words, motion = hunting_at(system, 0.85, SHORT, 0.1, [orbit])
    assert words == f"the orbit at {orbit.speed:.4g} m/s"
    radius = np.sqrt(0.5 + np.sqrt(0.85 - FOLD))
    assert motion.means[-1] == pytest.approx(radius, rel=5e-3)
    assert hunting_at(system, 0.7, SHORT, 0.1, [orbit]) is None


def test_starts_that_are_lost_are_told_of():
    lost = []
    assert hunting_at(fold_system(1e-2, reach=0.08), 0.85, SHORT, 0.1, (), lost) is None
    assert [words.split(" ends in ")[0] for words in lost] == ["the hunting mode, 10 scales large"]
    assert "derailment at 0.85 m/s" in lost[0]


def test_motion_decides_where_the_stability_of_orbits_is_uncertain():
    """Upper orbits are stable and lower ones are not, by the equations above."""
    system = fold_system(1e-2)
    branch = limit_cycles(system, [1.2, 0.0], (0.7, 0.99), start_speed=0.95)
    upper = np.hypot(*branch.states.T) > np.sqrt(0.5)
    between = (branch.speed > 0.8) & (branch.speed < 0.95)
    open_ones = replace(branch, stable=branch.stable & ~between, uncertain=between)
    lowest = branch.speed[upper & between].min()
    speed, what = simulated_below(system, open_ones, 0.96, 0.1)
    assert speed == lowest and "on which simulated motion stays" in what
    only_lower = replace(open_ones, uncertain=between & ~upper)
    assert only_lower.uncertain.any() and simulated_below(system, only_lower, 0.96, 0.1) is None


def test_the_search_begins_where_it_is_told_to_below_the_usual_speeds_too():
    found = nonlinear_critical_speed(fold_system(1e-2), low=0.5, check=False)
    assert found.speed == pytest.approx(FOLD, abs=1e-4)
    assert found.hopf.speed == pytest.approx(HOPF, abs=1e-4)
