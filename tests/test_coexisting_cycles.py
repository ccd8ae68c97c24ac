"""Where a small and a large cycle coexist, the nonlinear critical speed is that of the large one.

Judge: motion simulated at fixed speeds on either side of the answer, from starts of its own. The
paper's lateral model on S1002 (gauge 1432 mm) has a ripple of 0.05 mm down to 18.7 m/s and a cycle
of 1.5 to 5 mm; the S1002 wheelset on its soft springs a cycle at the flange far below the fold of
its tread (continuation through both: 52.05 m/s, docs/hunting.md).
"""

import numpy as np
import pytest

from exudyn_wheelset import (
    LateralWheelset,
    limit_cycles,
    nonlinear_critical_speed,
    paper_parameters,
)
from exudyn_wheelset.catalogue.by_name import vehicle_system
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion


def lateral(creep, free_spin=True):
    return LateralWheelset(
        "profiled", paper_parameters(1), creep=creep, free_spin=free_spin, wheel="S1002"
    )


def amplitude_after(system, start, speed, duration=150.0):
    """Half of peak to peak of y [m] over the last 4 s of a motion."""
    motion = system.simulate(start, speed, np.arange(0.0, duration, 0.02))
    return 0.5 * np.ptp(motion[-200:, 0])


@pytest.mark.slow
def test_fold_of_the_large_cycle_of_the_lateral_model():
    """Newton cannot close it (contact jumps on the tread); settled motions follow it instead."""
    system = lateral("polach-kalker")
    found = nonlinear_critical_speed(system, low=17.0, high=23.0)
    assert found.branch.method == "settled motions"
    assert found.branch.amplitude["y"].min() > 1e-3
    start = [3e-3, 0.0, 0.0, 0.0]
    # A motion that passes the place of a fold 0.15 m/s above lingers for a minute.
    assert amplitude_after(system, start, found.speed - 0.15) < 0.1e-3
    assert amplitude_after(system, start, found.speed + 0.05) > 1.0e-3


def test_what_is_left_of_rest_does_not_hunt():
    """At 20 m/s a wheelset dragged by its spin comes to rest, to the integrator's 1e-12 m."""
    system = lateral("polach", free_spin=False)
    state = system.simulate([3e-3, 0.0, 0.0, 0.0], 20.0, np.linspace(0.0, 40.0, 401))[-1]
    assert np.abs(state[0]) < 1e-9
    with pytest.raises(AnalysisError, match="no limit cycle at 20 m/s from this state"):
        limit_cycles(system, state, (16.0, 24.0), start_speed=20.0)


def test_large_starts_find_the_cycle_at_the_flange():
    """Branches are followed to 1.1 times the Hopf speed, short of their turn at 1.26 times it."""
    system = vehicle_system("s1002")
    found = nonlinear_critical_speed(system, low=40.0, high=59.3)
    assert found.speed == pytest.approx(52.05, abs=0.02)
    assert "a motion from a blow of" in found.how
    # Newton's orbit beside the fold, and simulated motion a little above and below it.
    orbit = found.branch.orbits[found.branch.folds[0].index]
    for speed, hunts in ((52.4, True), (51.7, False)):
        state = system.carry_over(orbit.states[0], orbit.speed, speed)
        motion = WatchedMotion(system, speed, state, orbit.period, {"": 1}, Settling(cycles=60))
        motion.decide()
        assert (motion.means[-1] > 4e-3) is hunts
