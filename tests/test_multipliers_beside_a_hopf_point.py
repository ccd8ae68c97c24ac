"""Multipliers of a truck's small orbits against what simulated motion does beside them.

On a branch that leans back from its Hopf point to speeds at which straight running is stable the
orbits part straight running from larger motion: none of them is stable (exchange of stability,
Crandall and Rabinowitz, Arch. Rational Mech. Anal. 52 (1973) 161). With Hertz's patches the forces
have small steps that no Jacobian holds, and multipliers say stable there at the per cent level;
with forces that are the gradient of one energy they do not.
"""

from dataclasses import replace

import numpy as np
import pytest

from exudyn_wheelset import hopf_points, limit_cycles
from exudyn_wheelset.catalogue.by_name import vehicle
from exudyn_wheelset.systems.system import as_system

PERIODS = 8


@pytest.fixture(scope="module", params=["hertz", "energy"])
def small_orbits(request):
    truck = vehicle("truck", creep="shen-hedrick-elkins")
    truck = replace(truck, contact={**truck.contact, "normal": request.param})
    system = as_system(truck)
    hopf = next(p for p in hopf_points(system, 15.0, 150.0) if p.direction == "loses stability")
    speeds = (0.96 * hopf.speed, 1.04 * hopf.speed)
    return system, limit_cycles(system, hopf, speeds, maximum_points=10), request.param


def test_no_orbit_on_the_part_that_leans_back_is_called_stable(small_orbits):
    _, branch, _ = small_orbits
    turn = int(np.argmin(branch.speed))
    before = branch.speed[:turn] < branch.hopf[0] - 0.01
    assert not np.any(branch.stable[:turn][before & (np.diff(branch.speed[: turn + 1]) < 0.0)])


def test_decided_stability_is_what_motion_does(small_orbits):
    """Disturbed by 1 % of its own velocities, the amplitude grows or falls as it says."""
    system, branch, normal = small_orbits
    watched = system.lateral_indices[0]
    checked = 0
    for index in range(0, len(branch), 2):
        leading = branch.multipliers[index][0]
        if branch.stability[index] is None or abs(leading.imag) > 1e-9:
            continue
        orbit = branch.orbits[index]
        rest = system.equilibrium(orbit.speed)
        times = orbit.period * np.linspace(0.0, PERIODS, 60 * PERIODS + 1)
        sizes = []
        for factor in (0.99, 1.01):
            start = rest + factor * (orbit.states[0] - rest)
            motion = system.simulate(start, orbit.speed, times)[:-1, watched]
            sizes.append(np.ptp(motion.reshape(PERIODS, 60), axis=1))
        apart = sizes[1] - sizes[0]
        growth = (apart[-1] / apart[3]) ** (1.0 / (PERIODS - 4))
        if abs(growth - 1.0) > 3e-3:
            checked += 1
            assert bool(growth < 1.0) == bool(branch.stable[index])
    assert checked > 0 or normal == "hertz"


def test_multiplier_of_the_first_orbit_with_forces_from_an_energy(small_orbits):
    """By Jacobians and by motion, within what a measured growth of five periods decides."""
    system, branch, normal = small_orbits
    if normal != "energy":
        pytest.skip("Hertz's forces have steps")
    from exudyn_wheelset.stability.hunting.aligned import Point
    from exudyn_wheelset.stability.hunting.floquet import Multipliers
    from exudyn_wheelset.stability.hunting.measured_growth import DECIDED, measured_growth

    point = Point(branch.orbits[0], Multipliers(branch.multipliers[0], 0.0, 0), 1.0)
    leading = branch.multipliers[0][0]
    assert measured_growth(system, point) == pytest.approx(leading.real, abs=DECIDED)
