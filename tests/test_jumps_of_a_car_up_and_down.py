"""Where a car's hunting begins on the way up and ends on the way down: each jump by two methods.

The DTU car has no one jump. The straight run is left at the linear critical speed; the rear truck
hunts alone until the branch of that motion turns back, where the front truck joins in; on the way
down the rear truck stops at the branch's lowest fold. Eigenvalues and folds of the continuation on
one side, motion simulated 0.5 m/s beside them on the other.
"""

import numpy as np
import pytest

from exudyn_wheelset import catalogue, hopf_points, limit_cycles
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.corrector import solve_orbit, speed_row
from exudyn_wheelset.stability.hunting.descent import mode_disturbance
from exudyn_wheelset.stability.hunting.settled_orbit import orbit_of, settled_motion
from exudyn_wheelset.stability.hunting.settling import Settling
from exudyn_wheelset.stability.hunting.watching import watched_trucks
from exudyn_wheelset.systems.system import as_system

BESIDE = 0.5  # [m/s]


@pytest.fixture(scope="module")
def car():
    return as_system(catalogue.dtu_car(normal="hertz"))


@pytest.fixture(scope="module")
def critical(car):
    return hopf_points(car, 30.0, 60.0)[0]


@pytest.fixture(scope="module")
def rear_alone(car):
    """Speed and state of the rear truck's hunting below the linear critical speed."""
    speed = 41.3
    state = car.equilibrium(speed)
    state[[car.state_names.index(f"rear {which}: y [m]") for which in ("leading", "trailing")]] += (
        3e-3
    )
    return speed, car.simulate(state, speed, np.linspace(0.0, 12.0, 25))[-1]


def followed(car, start, at, speeds):
    """The branch through the cycle that a motion is near, brought from its speed to another one."""
    state = car.carry_over(start[1], start[0], at)
    near = settled_motion(car, state, at, 0.21, settling=Settling(tolerance=0.03, cycles=40))
    orbit = orbit_of(near)
    equations = Collocation(car, orbit.period, speeds[1] - speeds[0])
    row = speed_row(orbit, car.size)
    orbit = solve_orbit(equations, orbit, row, tolerance=1e-8, iterations=40).orbit
    return limit_cycles(car, orbit, speeds)


def carried_on(car, orbit, speed, duration):
    """Half of peak to peak [m] of each truck over two seconds after a motion from an orbit."""
    return last_of(car, car.carry_over(orbit.states[0], orbit.speed, speed), speed, duration)[1]


def last_of(car, state, speed, duration):
    """Half of peak to peak [m] of each truck, in the first and in the last two seconds."""
    times = np.linspace(0.0, duration, round(50 * duration) + 1)
    states = car.simulate(state, speed, times)
    watched = watched_trucks(car)
    return tuple(
        {name: float(0.5 * np.ptp(part[:, place])) for name, place in watched.items()}
        for part in (states[:101], states[-101:])
    )


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_straight_run_is_left_at_the_linear_critical_speed(car, critical, side):
    speed = critical.speed + side * BESIDE
    first, last = last_of(car, mode_disturbance(car, speed, 0.05), speed, 6.0)
    assert (last["rear"] > first["rear"]) == (side > 0.0)
    assert last["rear"] < 0.3e-3


@pytest.mark.slow
def test_the_rear_truck_stops_at_the_lowest_fold(car, rear_alone):
    branch = followed(car, rear_alone, rear_alone[0], (40.78, 41.31))
    fold = next(fold for fold in branch.folds if fold.side == "lowest")
    orbit = max(branch.orbits, key=lambda one: one.half_peak_to_peak().max())
    above, below = (carried_on(car, orbit, fold.speed + s * BESIDE, 12.0) for s in (1.0, -1.0))
    assert above["rear"] > 1e-3 > below["rear"]


@pytest.mark.slow
def test_the_front_truck_joins_in_where_the_rear_one_s_branch_turns(car, rear_alone):
    branch = followed(car, rear_alone, 41.9, (41.88, 42.2))
    fold = next(fold for fold in branch.folds if fold.side == "highest")
    front = watched_trucks(car)["front"]
    orbit = min(branch.orbits, key=lambda one: one.half_peak_to_peak()[front])
    below, above = (carried_on(car, orbit, fold.speed + s * BESIDE, 20.0) for s in (-1.0, 1.0))
    assert below["front"] < 0.3e-3 and above["front"] > 1e-3
    assert min(below["rear"], above["rear"]) > 1e-3
