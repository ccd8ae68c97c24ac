"""Where a straight tread makes motion nearly linear: slow steady decay is the end of hunting.

Closed forms: r' = r (e mu - wall(r)), phase' = 2 pi, with a wall at r = 10: below mu = 0 every
motion falls at the rate e mu, however slowly, and above it one goes to r = 10 + sqrt(e mu). With
the term d/(1 + r^2) a small cycle r^2 = -d/(e mu) - 1 lives down to mu = -d/e.

The AAR wheelset of the paper (set 1, lateral model): continuation finds the fold at 36.719 m/s;
simulated at fixed speeds by a plain Runge-Kutta method, motions of 3 to 10 mm, thrown against the
flange or not, fall at 36.70 m/s and below at every size, and grow at 36.75 m/s.
"""

import numpy as np
import pytest

from exudyn_wheelset.catalogue.by_name import vehicle_system
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.descent import quasi_static_descent
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion
from exudyn_wheelset.systems.function_system import FunctionSystem

RATE = 0.2
SHORT = Settling(cycles=100)


def tread(small=0.0):
    def derivative(state, mu):
        x, y = state
        radius = np.hypot(x, y)
        wall = 100.0 * max(radius - 10.0, 0.0) ** 2
        growth = RATE * mu + small / (1.0 + radius**2) - wall
        return np.array([growth * x - 2.0 * np.pi * y, growth * y + 2.0 * np.pi * x])

    return FunctionSystem("tread", derivative, ("x [m]", "y [m]"), np.ones(2))


def test_slow_decay_ends_a_descent_where_growth_changes_sign():
    descent = quasi_static_descent(
        tread(), 0.11, -0.5, step=0.1, tolerance=0.02, disturbance=9.0, settling=SHORT
    )
    low, high = descent.bracket
    assert descent.outcome.ending is Ending.JUMP_FOUND
    # 300 cycles (PATIENCE) show a fall of 3 % (SHOWN) over their second half at |mu| > 0.001.
    assert low == pytest.approx(0.0, abs=0.02)
    assert -0.003 < high <= low + 0.02 * (1.0 + 1e-9)
    assert np.min(np.asarray(descent.amplitude)) > 9.0


def test_a_motion_that_falls_to_a_small_cycle_is_followed_there():
    system, mu = tread(small=0.01), -0.025
    motion = WatchedMotion(system, mu, np.array([9.0, 0.0]), 1.0, {"": 0}, SHORT)
    assert motion.decide() is not Ending.DIED_OUT
    # growth: RATE mu + 0.01/(1 + r^2) = 0 at r = 1, neared from below by exp(-0.005 t)
    assert motion.means[-2] < motion.means[-1] < 1.0
    assert motion.means[-1] > 0.5


@pytest.mark.parametrize(("speed", "fate"), [(36.5, "falls"), (36.8, "hunts")])
def test_aar_wheelset_on_either_side_of_its_fold(speed, fate):
    system = vehicle_system("paper-lateral-1")
    settling = Settling(cycles=120)
    motion = WatchedMotion(system, speed, [0.0098, 0.0, 0.0, 0.0], 0.39, {"": 0}, settling)
    assert motion.decide() is (Ending.DIED_OUT if fate == "falls" else Ending.SETTLED)
