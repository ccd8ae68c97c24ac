"""The lateral model's compiled motion against the generic one by LSODA, which is another method.

Both keep 1e-8 a step; over ten periods of a motion that grows or strikes the flange the difference
of two such methods stays below 1e-4 of the scales (1 mm, 1 mrad).
"""

import numpy as np
import pytest

from exudyn_wheelset import LateralWheelset
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
