"""Vehicles at rest: residuals of the simulation's own kernels, free lengths, shares, lopsided ones.

Every load is computed here from weights and levers.
"""

from __future__ import annotations

import re

import exudyn as exu
import numpy as np
import pytest
from test_random_vehicles import random_vehicle

from exudyn_wheelset import (
    AirSpring,
    AxleBox,
    BumpStop,
    CoilSpring,
    Contact,
    Damper,
    MaxwellDamper,
    Spring,
    Track,
    VehicleBuilder,
    Wheelset,
    WheelsetWarning,
    catalogue,
    static_equilibrium,
    with_free_lengths,
)
from exudyn_wheelset.systems.vehicle_system import vehicle_system

NAMES = ("dtu_car", "manchester_coach", "cooperrider_bogie_3d", "three_axle_truck")
AXLE = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
PRIMARY = Spring(stiffness=(31.391e6, 3.884e6, 1.22e6), damping=(15e3, 2e3, 4e3))
GRAVITY = 9.81
# The spin moments of tapered wheels brake: a vehicle that is pulled along carries some newtons more
# on one axle. Loads by weights and levers are those of a law without spin moment.
NO_SPIN_MOMENT = Contact(creep="polach-kalker", friction=0.3)


def wagon(centre=(0.0, 0.0, 1.5), elements=(PRIMARY,), axles=(4.0, -4.0), **options):
    """A body of 20 t on some wheelsets."""
    made = VehicleBuilder("wagon", Track("UIC60"), NO_SPIN_MOMENT, **options)
    body = made.body("body", mass=20e3, inertia=(20e3, 80e3, 80e3), centre=centre)
    for number, x in enumerate(axles):
        axle = made.wheelset(f"axle {number}", AXLE, x=x)
        for y in (1.0, -1.0):
            for element in elements:
                made.connect(element, axle, body, at=(x, y, axle.z))
    return made.finish()


@pytest.mark.parametrize("name", NAMES)
def test_every_vehicle_stands_and_settles_to_the_same_place(name):
    vehicle = catalogue.vehicle(name)
    drawn = static_equilibrium(vehicle)
    settled = static_equilibrium(with_free_lengths(vehicle))
    assert drawn.residual < 1e-6
    assert settled.residual < 1e-6
    for part, place in drawn.positions.items():
        assert settled.positions[part] == pytest.approx(place, abs=1e-6)


@pytest.mark.parametrize("name", NAMES)
def test_what_is_built_in_exudyn_stands_at_any_speed(name):
    system = vehicle_system(catalogue.vehicle(name))
    for speed in (10.0, 60.0):
        rate = system.derivative(system.initial_state(speed), speed)
        assert np.abs(rate).max() < 1e-6


def test_a_vehicle_drawn_without_load_sinks_onto_its_springs():
    """Free lengths: 20 t on four springs of 1.22e6 N/m sink by m g/(4 k), 40.2 mm."""
    found = static_equilibrium(wagon(preload="free"))
    sunk = 20e3 * GRAVITY / (4 * 1.22e6)
    assert found.positions["body"] == pytest.approx((0.0, 0.0, 1.5 - sunk), abs=1e-9)
    assert found.residual < 1e-6
    for loads in found.wheel_loads.values():
        assert loads == pytest.approx([(20e3 + 2 * 1813) * GRAVITY / 4] * 2, rel=1e-9)


def test_what_has_settled_stands_with_relaxed_dampers():
    """Strokes of dampers in series start where they do not pull, on springs that have sunk."""
    damper = MaxwellDamper((0.0, 0.3, 1.0), 2e6, 2e4)
    table = Damper((0, 0, 1), table=((0, 0), (0.1, 2e3), (0.4, 4e3)), series_stiffness=3e6)
    vehicle = wagon(elements=(PRIMARY, damper, table), preload="free")
    system = vehicle_system(vehicle)
    state = system.initial_state(25.0)
    strokes = [k for k, name in enumerate(system.state_names) if name.endswith("stroke [m]")]
    assert len(strokes) == 8
    # Along z by the sunk springs, along the inclined one by its share of that.
    sunk = 20e3 * GRAVITY / (4 * 1.22e6)
    assert np.sort(state[strokes]) == pytest.approx([-sunk] * 4 + [-sunk / np.hypot(0.3, 1)] * 4)
    assert np.abs(system.derivative(state, 25.0)).max() < 1e-6


def test_a_given_preload_counts_once_for_an_element_of_several_laws():
    """An air spring of two laws that carries 40 kN of a car that is left out.

    The creep law has no spin moment, which would brake the truck and shift the loads.
    """
    made = VehicleBuilder("truck", Track("UIC60"), Contact(creep="polach-kalker"))
    frame = made.body("frame", mass=3e3, inertia=(2e3, 2e3, 3e3), centre=(0, 0, 0.6))
    for name, x in (("leading", 1.2), ("trailing", -1.2)):
        axle = made.wheelset(name, AXLE, x=x)
        for y in (1.0, -1.0):
            made.connect(PRIMARY, axle, frame, at=(x, y, axle.z))
    for y in (1.0, -1.0):
        air = AirSpring((1e5, 1e5, 3e5), 5e5, 1e4)
        made.connect(air, frame, made.ground, at=(0, y, 0.9), preload=(0, 0, 40e3))
    found = static_equilibrium(made.finish())
    even = (2 * 40e3 + (3e3 + 2 * AXLE.mass) * GRAVITY) / 4
    # The residual below is, of half a frame and a wheelset, 3 mN on each of these wheels.
    assert found.wheel_loads["leading"] == pytest.approx((even, even), abs=3e-3)
    assert found.residual < 1e-6


def test_loads_that_balance_leaves_open_are_shared_by_stiffness():
    """A third axle in the middle of a stiff body, on half the stiffness, carries half the share."""
    made = VehicleBuilder("wagon", Track("UIC60"))
    body = made.body("body", mass=20e3, inertia=(20e3, 80e3, 80e3), centre=(0, 0, 1.5))
    for name, x, factor in (("a", 4.0, 1.0), ("b", 0.0, 0.5), ("c", -4.0, 1.0)):
        axle = made.wheelset(name, AXLE, x=x)
        spring = Spring(tuple(factor * value for value in PRIMARY.stiffness))
        for y in (1.0, -1.0):
            made.connect(spring, axle, body, at=(x, y, axle.z))
    loads = static_equilibrium(made.finish()).wheel_loads
    own = 0.5 * AXLE.mass * GRAVITY
    wheels = 1.0 / (1.0 / 1.22e6 + 1.0 / 1e9), 1.0 / (1.0 / 0.61e6 + 1.0 / 1e9)
    share = 0.5 * 20e3 * GRAVITY / (2.0 * wheels[0] + wheels[1])
    # A wheel's rail counts as a spring of 1e9 N/m beside that of its box, at another width.
    assert loads["b"].left == pytest.approx(own + wheels[1] * share, rel=1e-3)
    assert loads["a"].left == pytest.approx(own + wheels[0] * share, rel=1e-3)


def test_a_lopsided_vehicle_rolls_on_shifted_wheelsets():
    """The body's centre 0.1 m to the left: loads by the lever of the wheels, residual nothing.

    The contact points are some 0.75 m from the centre; that they shift by 2 mm under the whole load
    of 116 kN takes 2 % of the moment.
    """
    found = static_equilibrium(wagon(centre=(0.0, 0.1, 1.5)))
    left, right = found.wheel_loads["axle 0"]
    assert left + right == pytest.approx((20e3 + 2 * 1813) * GRAVITY / 2, rel=1e-6)
    every = sum(sum(loads) for loads in found.wheel_loads.values())
    assert every == pytest.approx((20e3 + 2 * 1813) * GRAVITY, rel=1e-9)
    assert left - right == pytest.approx(20e3 * GRAVITY / 2 * 0.1 / 0.75, rel=0.03)
    assert found.positions["axle 0"][1] != 0.0
    # Wheelsets that steer creep, and brake the 23.6 t by a fraction of a newton.
    assert found.residual < 1e-4
    mirrored = static_equilibrium(wagon(centre=(0.0, -0.1, 1.5)))
    assert mirrored.wheel_loads["axle 0"].right == pytest.approx(left, rel=1e-9)
    assert mirrored.positions["axle 0"][1] == pytest.approx(-found.positions["axle 0"][1], rel=1e-6)


def test_all_kinds_of_connections_carry():
    """Coils, air springs, stops, dampers; boxes of their own: 20 t and the boxes on four wheels."""
    made = VehicleBuilder("wagon", Track("UIC60"), NO_SPIN_MOMENT)
    body = made.body("body", mass=20e3, inertia=(20e3, 80e3, 80e3), centre=(0, 0, 1.5))
    for number, x in enumerate((4.0, -4.0)):
        axle = made.wheelset(f"axle {number}", AXLE, x=x)
        for side, y in (("left", 1.0), ("right", -1.0)):
            box = made.body(f"box {number} {side}", 150, (6, 9, 6), (x, y, axle.z))
            made.connect(AxleBox(), axle, box, at=(x, y, axle.z))
            made.connect(CoilSpring((2e6, 2e6, 1e6), bending=2e4), box, body, at=(x, y, 0.75))
            made.connect(AirSpring((1e5, 1e5, 2e5), 4e5, 1e4), box, body, at=(x, y, 0.8))
            made.connect(BumpStop((0, 1, 0), ((0, 0), (0.02, 2e4)), 0.01), box, body, (x, y, 0.8))
            made.connect(MaxwellDamper((0, 1, 0), 5e6, 2e4), box, body, at=(x, y, 0.8))
            made.connect(Damper((0, 0, 1), 1e4), box, body, at=(x, y, 0.8))
            # What keeps the box from turning about the axle.
            made.connect(Spring((1e6, 0, 0)), box, body, at=(x, y, 0.9))
    vehicle = made.finish()
    found = static_equilibrium(vehicle)
    assert found.residual < 1e-6
    even = (20e3 + 4 * 150 + 2 * AXLE.mass) * GRAVITY / 4
    assert found.wheel_loads["axle 0"] == pytest.approx((even, even), rel=1e-9)
    # Side by side they share by stiffness.
    coil = found.preloads["box 0 left coil spring"][2]
    assert coil == pytest.approx(20e3 * GRAVITY / 4 * 1e6 / 1.2e6, rel=1e-6)
    settled = static_equilibrium(with_free_lengths(vehicle))
    assert settled.positions["body"] == pytest.approx(found.positions["body"], abs=1e-6)


def test_several_vehicles_in_one_system_have_names_of_their_own():
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    vehicle = wagon()
    one = vehicle.create(mbs, 20.0)
    other = vehicle.create(mbs, 20.0, position=(30.0, 0.0))
    assert one.name == "wagon" and other.name == "wagon 2"
    mbs.Assemble()
    nodes = [mbs.GetNode(k)["name"] for k in range(mbs.systemData.NumberOfNodes())]
    named = [name for name in nodes if name]
    assert len(set(named)) == len(named)
    distance = [
        mbs.GetNodeParameter(items.node("axle 0"), "referenceCoordinates")[0]
        for items in (one, other)
    ]
    assert distance[1] - distance[0] == pytest.approx(30.0)


@pytest.mark.parametrize("seed", [66, 233])
def test_a_vehicle_that_finds_no_rest_is_told_with_its_largest_acceleration(seed):
    """A body beside the middle on cones, flanges without play (tests/test_random_vehicles.py)."""
    with pytest.warns(WheelsetWarning, match="no place of rest was found nearby") as told:
        rest = static_equilibrium(random_vehicle(seed))
    assert rest.residual > 1e-3
    said = re.search(r"is left with (\S+) m/s", str(told[0].message))
    assert float(said[1]) == pytest.approx(rest.residual, rel=1e-2)
