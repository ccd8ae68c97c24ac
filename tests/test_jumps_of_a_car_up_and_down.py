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
def branch(car):
    """Orbits on which the rear truck hunts, through one that is simulated below the Hopf points."""
    speed = 41.3
    state = car.equilibrium(speed)
    for which in ("leading", "trailing"):
        state[car.state_names.index(f"rear {which}: y [m]")] += 3e-3
    settling = Settling(tolerance=0.03, cycles=60)
    guess = orbit_of(settled_motion(car, state, speed, 0.21, settling=settling))
    equations = Collocation(car, guess.period, 1.0)
    row = speed_row(guess, car.size)
    orbit = solve_orbit(equations, guess, row, tolerance=1e-8, iterations=40).orbit
    return limit_cycles(car, orbit, (40.6, 42.2), speed_steps=5, maximum_points=9)


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
def test_the_rear_truck_stops_at_the_lowest_fold(car, branch):
    fold = min(float(fold) for fold in branch.folds if fold.side == "lowest")
    orbit = near(branch, fold + 0.4)
    above, below = (carried_on(car, orbit, fold + side * BESIDE, 12.0) for side in (1.0, -1.0))
    assert above["rear"] > 1e-3 > below["rear"]


@pytest.mark.slow
def test_the_front_truck_joins_in_where_the_rear_one_s_branch_turns(car, branch):
    """The turn is a corner of the model (a contact that jumps): its highest speed is meant."""
    turn = max(orbit.speed for orbit in branch.orbits)
    assert 0 < np.argmax([orbit.speed for orbit in branch.orbits]) < len(branch) - 1
    orbit = near(branch, turn - 0.4)
    below, above = (carried_on(car, orbit, turn + side * BESIDE, 25.0) for side in (-1.0, 1.0))
    assert below["front"] < 0.3e-3 and above["front"] > 1e-3
    assert min(below["rear"], above["rear"]) > 1e-3


def near(branch, speed):
    """The orbit nearest to a speed on the part where the rear truck's hunting is large."""
    large = [orbit for orbit in branch.orbits if orbit.half_peak_to_peak().max() > 1.45e-3]
    return min(large, key=lambda orbit: abs(orbit.speed - speed))
