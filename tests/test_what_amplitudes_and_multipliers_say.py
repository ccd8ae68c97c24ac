"""What a descent reads from amplitudes, and a branch from multipliers, where the answer is known.

Amplitudes are those of the radial equation of an averaged oscillation, x' = f(x), solved in closed
form at equal times: leaving an unstable limit cycle, decaying to rest, approaching a stable cycle.
Multipliers cross the unit circle where they are put.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.descent import quasi_static_descent
from exudyn_wheelset.stability.hunting.disturbance import GROWTH, _grows, _shrinks
from exudyn_wheelset.stability.hunting.floquet import Multipliers
from exudyn_wheelset.stability.hunting.limit_cycles import _stability_changes
from exudyn_wheelset.stability.hunting.settling import (
    FAR_DOWN,
    SHAKEN,
    SHOWN,
    TREND,
    Settling,
    WatchedMotion,
    _falls_away,
    _falls_steadily,
    _judge,
)
from exudyn_wheelset.systems.function_system import FunctionSystem

BLOCKS = np.arange(40)


def leaving_an_unstable_cycle(start=0.97, rate=0.15):
    """x' = -rate x (1 - x^2)/2: x^2/(1 - x^2) = C exp(-rate t), the cycle of amplitude 1 repels."""
    constant = start**2 / (1.0 - start**2)
    square = constant * np.exp(-rate * BLOCKS)
    return np.sqrt(square / (1.0 + square))


def approaching_a_stable_cycle(start=1.0, end=0.3, rate=0.15):
    """x' = rate (end - x)."""
    return end + (start - end) * np.exp(-rate * BLOCKS)


def test_a_fall_that_speeds_up_leaves_an_unstable_cycle():
    """As long as it does: far below the cycle the fall is steady."""
    means = list(leaving_an_unstable_cycle())
    fast = np.flatnonzero(np.array(means) > 0.5)[-1]
    assert fast > 2 * TREND
    for count in range(TREND + 1, fast):
        assert _falls_away(means[:count])
    assert not _falls_away(means[:TREND])


def test_a_fall_that_slows_down_goes_to_a_stable_cycle():
    means = list(approaching_a_stable_cycle())
    for count in range(TREND + 1, len(means)):
        assert not _falls_away(means[:count])
    assert not _falls_away(means[::-1])
    assert not _falls_away([1.0] * 20)


def test_amplitudes_are_judged_by_where_they_go():
    settled = _judge(list(approaching_a_stable_cycle()), rest=1e-3, tolerance=0.01)
    assert settled is Ending.SETTLED
    early = _judge(list(approaching_a_stable_cycle()[:8]), rest=1e-3, tolerance=0.01)
    assert early is Ending.UNDECIDED
    # A steady decay, once it is far down, is the end of it; so is an amplitude below rest.
    decay = np.exp(-0.2 * BLOCKS)
    far = int(np.flatnonzero(decay < FAR_DOWN)[0])
    assert _judge(list(decay[: far - 1]), rest=1e-9, tolerance=0.01) is Ending.UNDECIDED
    assert _judge(list(decay[: far + 1]), rest=1e-9, tolerance=0.01) is Ending.DIED_OUT
    assert _judge(list(decay[:20]), rest=0.05, tolerance=0.01) is Ending.DIED_OUT
    growth = list(decay[:20][::-1])
    assert _judge(growth, rest=1e-9, tolerance=0.01) is Ending.UNDECIDED


def test_a_motion_that_begins_below_rest_dies_out_at_a_fifth_of_its_beginning():
    assert _judge([0.010, 0.011], rest=0.02, tolerance=0.01) is Ending.UNDECIDED
    assert _judge([0.010, 0.0021], rest=0.02, tolerance=0.01) is Ending.UNDECIDED
    assert _judge([0.010, 0.0019], rest=0.02, tolerance=0.01) is Ending.DIED_OUT


def test_a_steady_fall_is_one_over_the_whole_second_half():
    """x = exp(-k t): nine blocks fall by 4 k in the second half, towards zero."""
    for fall, falls in ((1.02 * SHOWN, True), (0.98 * SHOWN, False)):
        means = list(np.exp(-0.25 * fall * np.arange(9)))
        assert _falls_steadily(means) is falls
    # A fall to 0.9 of the amplitude does not go towards less than half.
    assert not _falls_steadily(list(approaching_a_stable_cycle(end=0.9)[:17]))


def test_growth_leaves_out_the_first_block_and_fall_looks_at_both_quarters():
    faster = list(0.1 * np.exp((GROWTH + 0.01) / 3.0 * np.arange(5)))
    assert _grows(faster) and not _grows(faster[1:]) and not _grows(faster[::-1])
    falling = [1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3]
    assert _shrinks(falling) and not _shrinks(falling[::-1])
    # Down in the third quarter and up in the last one, and the other way round.
    assert not _shrinks([1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.6, 0.65])
    assert not _shrinks([1.0, 0.9, 0.8, 0.4, 0.6, 0.7, 0.6, 0.5])


def watched(period, rate=2.0 * np.pi, sizes=(0.0, 0.0)):
    """A motion of two oscillators of 1 s with the amplitudes `sizes`, one to a truck."""

    def derivative(state, speed):
        return rate * np.array([-state[1], state[0], -state[3], state[2]])

    names = ["y [m]", "a [m]", "z [m]", "b [m]"]
    system = FunctionSystem("oscillators", derivative, names, np.ones(4))
    start = [sizes[0], 0.0, sizes[1], 0.0]
    return WatchedMotion(system, 1.0, start, period, {"front": 0, "rear": 2}, Settling())


def test_the_period_follows_the_motion_by_no_more_than_twofold_at_a_time():
    motion = watched(0.3, sizes=(1.0, 0.5))
    motion.advance()
    assert motion.period == pytest.approx(0.6)
    for _ in range(3):
        motion.advance()
    # Passages by lines between samples.
    assert motion.period == pytest.approx(1.0, rel=1e-3)
    motion = watched(7.0, sizes=(1.0, 0.5))
    motion.advance()
    assert motion.period == pytest.approx(3.5)


def test_a_truck_is_shaken_below_rest_and_a_tenth_of_another():
    """Rest is 0.02 of the scale. Two alike below it move by themselves."""
    for sizes, hunting in (
        ((0.015, 0.015), {"front": True, "rear": True}),
        ((0.3, 1.1 * SHAKEN * 0.3), {"front": True, "rear": True}),
        ((0.15, 0.9 * SHAKEN * 0.15), {"front": True, "rear": False}),
        ((0.3, 0.019), {"front": True, "rear": False}),
    ):
        motion = watched(1.0, sizes=sizes)
        motion.advance()
        assert motion.hunting == hunting, sizes


@pytest.mark.parametrize(
    ("kind", "crossing"),
    [("torus", np.exp(0.8j)), ("period doubling", -1.0), ("branch point", 1.0)],
)
def test_stability_changes_are_named_by_the_multiplier_that_crosses(kind, crossing):
    """Between 50 and 54 m/s it grows from 0.94 to 1.02 in size: it crosses at 53 m/s."""

    def point(speed, size):
        pair = [crossing] if np.isreal(crossing) else [crossing, np.conj(crossing)]
        values = np.array([*(size * np.array(pair)), 0.3, -0.2], dtype=complex)
        return SimpleNamespace(
            is_fold=False,
            orbit=SimpleNamespace(speed=speed),
            multipliers=Multipliers(values, error=1e-9, neutral=0),
        )

    points = [point(46.0, 0.86), point(50.0, 0.94), point(54.0, 1.02), point(58.0, 1.1)]
    changes = _stability_changes(points, 1e-4)
    assert [change.kind for change in changes] == [kind]
    assert changes[0].speed == pytest.approx(53.0)
    assert _stability_changes(points[2:], 1e-4) == []


def bautin(state, speed):
    """r' = r (eps + r^2 - r^4), one turn a second; eps = (speed - 100)/100."""
    x, y = state
    square = x * x + y * y
    growth = 0.01 * (speed - 100.0) + square - square**2
    return np.array([growth * x - 2.0 * np.pi * y, 2.0 * np.pi * x + growth * y])


def test_a_descent_starts_as_large_as_it_is_told():
    """At 90 m/s an unstable cycle of radius 0.336 parts rest from hunting: eps = -0.1."""
    system = FunctionSystem("bautin", bautin, ["x [m]", "y [m]"], [0.1, 0.1])
    # The mode's two displacements are equal: 4.5 scales of each are a radius of 0.45 or more.
    descent = quasi_static_descent(system, 90.0, 70.0, step=4.0, tolerance=1.0, disturbance=4.5)
    # The fold, where both cycles end, is at eps = -1/4.
    low, high = descent.bracket
    assert low - 1.0 < 75.0 < high + 1.0
    with pytest.raises(AnalysisError, match="hunt"):
        quasi_static_descent(system, 90.0, 70.0, disturbance=2.2)
