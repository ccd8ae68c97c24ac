"""A vehicle's compiled equations are Exudyn's: rates to rounding, Jacobians to differences.

Both work on one vehicle: Exudyn's own right-hand side (all loads and objects of the model) against
the compiled one, at states of millimetres, milliradians and centimetres per second beside rest.
"""

from dataclasses import replace

import numpy as np
import pytest

from exudyn_wheelset import (
    AnalysisError,
    Contact,
    FrictionWedge,
    Spring,
    WheelsetError,
    catalogue,
    limit_cycles,
)
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.system import DynamicSystem, SimulationError, as_system

NAMES = ("cooperrider_bogie_3d", "three_axle_truck", "dtu_car", "manchester_coach")


def driven_truck():
    """A three-axle truck whose last axle is driven: a drive and a drawbar come in."""
    truck = catalogue.three_axle_truck()
    axles = list(truck.wheelsets)
    axles[-1] = replace(axles[-1], driven=True)
    return replace(truck, wheelsets=tuple(axles))


VEHICLES = {name: lambda name=name: catalogue.vehicle(name) for name in NAMES}


def truck_on_wedges():
    """A truck whose vertical springs have friction wedges beside them: several states a law."""
    truck = catalogue.three_axle_truck()
    wedge = FrictionWedge(angle=32.0, friction=0.4, column_force=2.0e4, spring=6e5)
    first, second = [one for one in truck.connections if isinstance(one.element, Spring)][:2]
    wedges = (replace(first, element=wedge, name="a"), replace(second, element=wedge, name="b"))
    return replace(truck, connections=(*truck.connections, *wedges))


VEHICLES |= {
    "truck on wedges": truck_on_wedges,
    "driven truck": driven_truck,
    "own law of the truck": lambda: replace(
        catalogue.vehicle("three_axle_truck"), contact=Contact(creep="fastsim", friction=0.3)
    ),
}


@pytest.fixture(scope="module", params=sorted(VEHICLES))
def system(request):
    found = as_system(VEHICLES[request.param]())
    assert found.compiled is not None
    return found


def states_near_rest(system, speed):
    random = np.random.default_rng(3)
    start = system.initial_state(speed)
    return [start + 0.5 * system.scales * random.standard_normal(system.size) for _ in range(3)]


@pytest.mark.parametrize("speed", [15.0, 40.0])
def test_rates_are_those_of_exudyn(system, speed):
    """The same functions on the same numbers: 1e-12 leaves the order of the sums."""
    states = states_near_rest(system, speed)
    for state, row in zip(states, system.derivatives(np.array(states), speed), strict=True):
        exudyn = ExudynSystem.derivative(system, state, speed)
        ours = system.derivative(state, speed)
        np.testing.assert_array_equal(ours, row)
        np.testing.assert_allclose(ours, exudyn, rtol=1e-12, atol=1e-12 * np.abs(exudyn).max())


def test_jacobian_of_the_bodies_is_that_of_the_whole(system):
    """The dense differences of Exudyn's rates have the same steps: only rounding is left.

    A rate of 1e5 scales/s has a rounding of 1e-11, over the step of 6e-6 that is 1e-6 of it; the
    dense columns subtract it from the forces of all other bodies, so 1e-6 of the largest entry.
    """
    speed = 30.0
    state = states_near_rest(system, speed)[0]
    dense = np.empty((system.size, system.size))
    scales = system.scales
    for column in range(system.size):
        shift = np.zeros(system.size)
        shift[column] = 6.0e-6 * scales[column]
        upper = ExudynSystem.derivative(system, state + shift, speed)
        dense[:, column] = (upper - ExudynSystem.derivative(system, state - shift, speed)) / (
            2.0 * shift[column]
        )
    difference = (system.jacobian(state, speed) - dense) * scales[None, :] / scales[:, None]
    whole = dense * scales[None, :] / scales[:, None]
    assert np.abs(difference).max() < 1e-6 * np.abs(whole).max()
    general = DynamicSystem.jacobian(system, state, speed)
    np.testing.assert_allclose(
        system.jacobians(np.array([state]), speed)[0] * scales / scales[:, None],
        general * scales / scales[:, None],
        atol=1e-9 * np.abs(whole).max(),
    )


@pytest.mark.parametrize("name", ["three_axle_truck", "cooperrider_bogie_3d"])
def test_motion_is_that_of_exudyn_s_solver(name):
    """Both are classical Runge-Kutta methods, in other coordinates of rotation.

    They differ by their errors, which fall with the fourth power of the step where forces are
    smooth; the creep table's slope is continuous, its curvature not, which leaves at least the
    second power (a fourth at half the step).
    """
    vehicle = catalogue.vehicle(name)
    times = np.linspace(0.0, 0.4, 101)
    apart = []
    for step in (4.0e-4, 2.0e-4):
        ours = as_system(vehicle, step=step)
        exudyn = as_system(vehicle, step=step, solver_type="RK44")
        assert ours.compiled_motion and not exudyn.compiled_motion
        start = ours.initial_state(30.0)
        start[list(ours.lateral_indices)] += 2e-3
        motions = [one.simulate(start, 30.0, times) for one in (ours, exudyn)]
        apart.append(np.abs((motions[0] - motions[1]) / ours.scales).max())
    assert apart[1] < apart[0] / 4.0
    assert apart[1] < 5e-3


def test_a_derailed_vehicle_ends_the_compiled_motion():
    """Pushed off its rails sideways it ends like every motion, with what was computed before."""
    system = as_system(catalogue.three_axle_truck())
    start = system.initial_state(20.0)
    rates = [k for k, name in enumerate(system.state_names) if name.endswith("vy [m/s]")]
    start[rates] += 6.0
    with pytest.raises(SimulationError) as caught:
        system.simulate(start, 20.0, np.linspace(0.0, 2.0, 1001))
    assert caught.value.outcome.ending in (Ending.WHEEL_CLIMB, Ending.LOST_GAUGE, Ending.LIFT_OFF)
    assert 2 <= len(caught.value.states) == len(caught.value.times) < 1001
    assert np.all(np.isfinite(caught.value.states))


def test_an_element_that_adds_its_own_items_is_left_to_exudyn():
    """Nothing of it is known to the compiled equations, so they are not used."""

    class Own:
        def __init__(self, element):
            self.places = element.places
            self.static_stiffness = element.static_stiffness

        def create(self, mbs, ends, preload):
            return ()

    truck = catalogue.three_axle_truck()
    first, *others = truck.connections
    changed = replace(truck, connections=(replace(first, element=Own(first.element)), *others))
    assert as_system(changed).compiled is None


@pytest.mark.parametrize("numbers", [3, 200])
def test_a_state_of_another_size_is_refused_before_the_kernels_read_it(numbers):
    """The kernels know addresses only: beyond the end of a state lies other memory."""
    system = as_system(catalogue.three_axle_truck())
    wrong = np.zeros(numbers)
    for ask in (system.derivatives, system.jacobians):
        with pytest.raises(AnalysisError, match=rf"give \(m, {system.size}\)"):
            ask(wrong[None, :], 20.0)
    with pytest.raises(AnalysisError, match=rf"give \(m, {system.size}\)"):
        system.jacobian(wrong, 20.0)
    with pytest.raises(WheelsetError, match=f"give {system.size} numbers"):
        limit_cycles(system, wrong, (20.0, 40.0))
