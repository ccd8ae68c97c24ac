"""The lateral model's compiled motion against the generic one by LSODA, which is another method.

Both keep 1e-8 a step; over ten periods of a motion that grows or strikes the flange the difference
of two such methods stays below 1e-4 of the scales (1 mm, 1 mrad).
"""

import numpy as np
import pytest

from exudyn_wheelset import LateralWheelset, paper_parameters
from exudyn_wheelset.catalogue.by_name import vehicle_system
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.systems.system import DynamicSystem, SimulationError


@pytest.mark.parametrize(
    ("system", "start", "speed"),
    [
        (lambda: vehicle_system("paper-lateral-1"), [9.5e-3, 0.0, 0.05, 0.0], 36.75),
        (lambda: vehicle_system("paper-lateral-1", wheel="S1002"), [3e-3, 1e-3, 0.0, 0.0], 20.0),
        (lambda: LateralWheelset("idealized"), [3e-3, 0.0, 0.0, 0.0], 50.0),
        (lambda: LateralWheelset("mohan"), [3e-3, 0.0, 0.0, 0.0], 40.0),
    ],
)
def test_motion(system, start, speed):
    made = system()
    times = np.linspace(0.0, 3.0, 151)
    one, other = (
        made.simulate(start, speed, times),
        DynamicSystem.simulate(made, start, speed, times),
    )
    np.testing.assert_allclose(one / made.scales, other / made.scales, atol=1e-4)
    each = DynamicSystem.derivatives(made, one, speed)
    np.testing.assert_array_equal(made.derivatives(one, speed), each)


def test_it_ends_where_the_gauge_is_lost():
    system = LateralWheelset("mohan")
    with pytest.raises(SimulationError, match=r"\|y\| = ") as caught:
        system.simulate([3e-3, 0.0, 0.0, 0.0], 80.0, np.linspace(0.0, 30.0, 601))
    assert caught.value.outcome.ending is Ending.LOST_GAUGE
    kept = caught.value.states
    assert 0 < len(kept) < 601
    assert np.abs(kept[:, 0]).max() <= system.lateral_limit


@pytest.mark.parametrize(("creep", "speed"), [("polach-kalker", 20.0), ("polach", 21.0)])
def test_rough_motion_settles_to_the_same_cycle(creep, speed):
    """Another method at 2e-5 a step: amplitude and period of the cycle to 1e-3."""
    accurate = LateralWheelset(
        "profiled", paper_parameters(1), creep=creep, free_spin=True, wheel="S1002"
    )
    times = np.linspace(0.0, 18.0, 3601)
    found = []
    for system in (accurate, accurate.rough()):
        y = system.simulate([2.6e-3, 0.0, 0.0, 0.0], speed, times)[2400:, 0]
        upward = np.flatnonzero((y[:-1] < 0.0) & (y[1:] >= 0.0))
        at = upward - y[upward] / (y[upward + 1] - y[upward])
        found.append((0.5 * np.ptp(y), (at[-1] - at[0]) / (len(at) - 1)))
    assert found[0][0] > 1e-3
    np.testing.assert_allclose(*found, rtol=1e-3)
