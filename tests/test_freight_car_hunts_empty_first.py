"""Flange to flange an empty freight car hunts at a speed at which the loaded one does not.

So do three-piece trucks: they hunt at 50 to 55 mph empty and at 90 to 100 mph loaded (Proc. ASME
Joint Rail Conference 2010, volume 49071, page 273). The order of the linear speeds is the other way
round (docs/vehicles.md).
"""

import numpy as np
import pytest

from exudyn_wheelset import catalogue
from exudyn_wheelset.systems.starts import shifted_state
from exudyn_wheelset.systems.system import as_system

SPEED = 40.0


def amplitude_after_coming_down(loaded, first, seconds=4.0):
    """Of the leading wheelset [m] in the last second at SPEED, hunting at `first` before."""
    system = as_system(catalogue.freight_car(loaded))
    lateral = system.lateral_indices[0]
    state, before = shifted_state(system, first, 8e-3), first
    for speed in (first, 0.5 * (first + SPEED), SPEED):
        times = np.arange(0.0, seconds, 4e-3)
        motion = system.simulate(system.carry_over(state, before, speed), speed, times)
        state, before = system.held(motion[-250:], speed), speed
        if speed > SPEED:
            assert 0.5 * np.ptp(motion[-250:, lateral]) > 9e-3
    return 0.5 * np.ptp(motion[-250:, lateral])


@pytest.mark.slow
def test_the_empty_car_still_hunts_where_the_loaded_one_has_stopped():
    assert amplitude_after_coming_down(False, 50.6) > 9e-3
    assert amplitude_after_coming_down(True, 75.0) < 3e-3
