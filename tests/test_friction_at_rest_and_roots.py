"""Friction in vehicles: rest without creep, equilibria as a set, the roots of the stuck car and its
limits, the energy of a cycle.

The stuck car is that with springs of the holds' stiffness k = mu N/presliding in the place of
friction; without friction it is that with the wedges' own springs alone; both are built here from
other elements.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from driven_element import DrivenElement

from exudyn_wheelset import (
    Bushing,
    CentrePlate,
    Contact,
    ExudynSystem,
    FrictionWedge,
    SideBearer,
    Spring,
    Track,
    VehicleBuilder,
    Wheelset,
    catalogue,
    linear_critical_speed,
    linearise,
    static_equilibrium,
    with_free_lengths,
)
from exudyn_wheelset.stability.linear.linearisation import hunting_mode
from exudyn_wheelset.systems.vehicle_system import followed_step, vehicle_system
from exudyn_wheelset.vehicles.description import Load
from exudyn_wheelset.vehicles.rest import find_rest

CARS = {
    (name, loaded): catalogue.vehicle(name, loaded=loaded)
    for name in ("freight_car", "two_axle_wagon")
    for loaded in (True, False)
}
HIGHEST = 2.0 * np.pi * 15.0


def settled(element, stiffness, mass, state, seconds, step):
    """State (place (3), rate (3), holds) of a body on springs and an element, by RK4."""
    driven = DrivenElement(element)
    at_rest = driven.force(np.zeros(6), np.zeros(6))[0][:3].copy()

    def rate(x):
        place, speed = np.zeros(6), np.zeros(6)
        place[:3], speed[:3] = x[:3], x[3:6]
        force, holds = driven.force(place, speed, x[6:])
        return np.concatenate([x[3:6], (force[:3] - at_rest - stiffness * x[:3]) / mass, holds])

    for _ in range(round(seconds / step)):
        k1 = rate(state)
        k2 = rate(state + step / 2 * k1)
        k3 = rate(state + step / 2 * k2)
        k4 = rate(state + step * k3)
        state = state + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return state


def test_a_body_on_wedges_comes_to_rest_inside_the_band_and_does_not_creep():
    """Pushed by 6 mm sideways and 8 mm down; asked: less than 1e-6 m in 100 s.

    No damper helps: what is left of the motion dies in the hold alone. Where it rests the springs
    are not relaxed, friction holds them, at less than it could.
    """
    wedge = FrictionWedge(32.0, 0.4, 2.0e4, spring=6e5)
    stiffness = np.array([2e6, 1e6, 2e6])
    start = np.array([0.0, 6e-3, -8e-3, *np.zeros(5)])
    rested = settled(wedge, stiffness, 10e3, start, 20.0, 1e-3)
    assert np.abs(rested[3:6]).max() < 1e-7
    assert 0.05 < np.hypot(*rested[6:]) < 1.0
    assert stiffness[1] * abs(rested[1]) > 500.0
    later = settled(wedge, stiffness, 10e3, rested, 100.0, 2e-3)
    assert np.abs(later[:3] - rested[:3]).max() < 1e-6


@pytest.mark.parametrize(("name", "loaded"), CARS)
def test_cars_carry_their_weight_with_relaxed_friction(name, loaded):
    """The loads of all wheels are the weight; each car stands as it is drawn, holds at zero."""
    car = CARS[name, loaded]
    found = static_equilibrium(car)
    assert found.residual < 1e-6
    total = sum(sum(loads) for loads in found.wheel_loads.values())
    assert total == pytest.approx(9.81 * car.mass, rel=1e-6)
    loads = [load for pair in found.wheel_loads.values() for load in pair]
    assert max(loads) - min(loads) < 1e-4 * max(loads)
    system = vehicle_system(car)
    state = system.initial_state(20.0)
    assert np.abs(system.derivative(state, 20.0)).max() < 1e-6
    holds = [k for k, label in enumerate(system.state_names) if label.endswith("hold [-]")]
    assert np.abs(state[holds]).max() < 1e-3


@pytest.mark.parametrize(("name", "loaded"), CARS)
def test_compiled_rates_are_those_of_exudyn(name, loaded):
    """Sliding, rocking, lifted: the same rates by the compiled equations and by Exudyn."""
    system = vehicle_system(CARS[name, loaded])
    random = np.random.default_rng(3)
    for _ in range(3):
        state = system.initial_state(20.0)
        state += 0.3 * system.scales * random.standard_normal(system.size)
        expected = ExudynSystem.derivative(system, state, 20.0)
        size = np.abs(expected).max()
        assert system.derivative(state, 20.0) == pytest.approx(expected, abs=1e-9 * size)


def test_free_lengths_settle_to_the_drawing():
    """A car described by free lengths that settles to its drawing needs no friction there."""
    car = catalogue.two_axle_wagon()
    settled_car = static_equilibrium(with_free_lengths(car))
    for part, place in static_equilibrium(car).positions.items():
        assert settled_car.positions[part] == pytest.approx(place, abs=1e-6)


def sprung(friction):
    """A body of 20 t drawn 20 mm above its springs' free lengths, with wedges beside them."""
    contact = Contact(creep="polach-kalker", friction=0.3)
    made = VehicleBuilder("wagon", Track("UIC60"), contact, preload="free")
    body = made.body("body", mass=20e3, inertia=(20e3, 80e3, 80e3), centre=(0, 0, 1.2))
    axle = Wheelset(mass=1500, inertia=(900, 110, 900), radius=0.46, wheel="S1002")
    for name, x in (("leading", 3.0), ("trailing", -3.0)):
        one = made.wheelset(name, axle, x=x)
        for y in (1.0, -1.0):
            place = (x, y, one.z)
            made.connect(Spring((8e6, 1e6, 2e6)), one, body, at=place, offset=(0, 0, 0.02))
            if friction:
                made.connect(FrictionWedge(32.0, friction, 1e4), one, body, at=place)
    return made.finish()


def test_loading_from_rest_strains_the_holds():
    """Of the equilibria in the band the one that loading reaches: a straight way from the drawing.

    k (20 mm + s) + friction(s) carries a quarter of the body, the friction that of a wedge whose
    hold has come to 1 - exp(-s/presliding).
    """
    car = sprung(0.4)
    rest = find_rest(car)
    sunk = rest.pose[0, 2] - rest.pose[2, 2]
    wedge = FrictionWedge(32.0, 0.4, 1e4)
    hold = 1.0 - np.exp(-sunk / wedge.presliding)
    angle = np.radians(32.0) + np.arctan(0.4 * hold)
    rubbing = 0.4 * hold * wedge.spring_force / (np.tan(angle) - 0.4 * hold)
    assert 2e6 * (0.02 + sunk) + rubbing == pytest.approx(9.81 * 20e3 / 4.0, rel=1e-6)
    without = find_rest(sprung(0.0)).pose
    assert 1e-3 < sunk < 0.8 * (without[0, 2] - without[2, 2])
    system = vehicle_system(car)
    state = system.initial_state(20.0)
    assert np.abs(system.derivative(state, 20.0)).max() < 1e-5
    vertical = [k for k, n in enumerate(system.state_names) if n.endswith("vertical hold [-]")]
    assert state[vertical] == pytest.approx(-hold * np.ones(4), abs=1e-6)


def roots(car, speed=20.0):
    """Oscillating roots below 15 Hz by rising frequency."""
    values = linearise(car, speed).eigenvalues
    values = values[(values.imag > 0.5) & (values.imag < HIGHEST)]
    return values[np.argsort(values.imag)]


def assert_same_roots(found, expected, part=5e-3):
    """Each root has its like among the expected ones, to a part of its size."""
    assert len(found) == len(expected)
    distance = np.abs(found[:, None] - expected[None, :])
    assert np.all(distance.min(axis=1) < part * np.abs(found))
    assert np.all(distance.min(axis=0) < part * np.abs(expected))


def with_springs_for_wedges(car, across, damping=0.0):
    """The car with a spring (0, across, across) in the place of each wedge, beside its own spring.

    That one is a closed side bearer without friction: it pushes along the frame's vertical, as the
    wedge's spring does. The face on its column is a bushing: its stiffness along the track and a
    disc's, k R^2/4, against turning about y and z, with the damping of the face.
    """
    connections = []
    for one in car.connections:
        if isinstance(one.element, FrictionWedge):
            wedge = one.element
            pushing = SideBearer(0.0, wedge.spring, 0.0, force=wedge.spring_force)
            connections.append(replace(one, element=pushing))
            spring = Spring((0.0, across, across), (0.0, damping, damping))
            held, turned = wedge.along, 0.25 * wedge.along * wedge.radius**2
            face = np.array([held, 0.0, 0.0, 0.0, turned, turned])
            column = Bushing(tuple(face), tuple(wedge.damping_time * face))
            for element, name in ((column, "column"), (spring, "spring")):
                one = replace(
                    one, element=element, name=f"{one.name} {name}", preload=(0.0, 0.0, 0.0)
                )
                connections.append(one)
            continue
        connections.append(one)
    return replace(car, connections=tuple(connections))


def without_faces(car):
    """The car whose wedges let the bolster slide along the track and turn in its columns."""
    return replace(
        car,
        connections=tuple(
            replace(one, element=replace(one.element, along=0.0, radius=0.0))
            if isinstance(one.element, FrictionWedge)
            else one
            for one in car.connections
        ),
    )


@pytest.mark.parametrize("loaded", [True, False])
def test_wedges_without_friction_are_their_springs(loaded):
    car = catalogue.freight_car(loaded, wedge_friction=1e-7)
    plain = with_springs_for_wedges(car, 0.0)
    assert_same_roots(roots(car), roots(plain))


@pytest.mark.parametrize("friction", [1e3, 1e8])
@pytest.mark.parametrize("loaded", [True, False])
def test_wedges_of_endless_friction_hold_the_bolster_rigidly(loaded, friction):
    car = without_faces(catalogue.freight_car(loaded, wedge_friction=friction))
    rigid = with_springs_for_wedges(car, 1e10)
    assert_same_roots(roots(car), roots(rigid))


@pytest.mark.parametrize("loaded", [True, False])
def test_stuck_car_has_the_roots_of_the_holds_stiffness(loaded):
    """Springs of k = mu N/presliding with dampers k T in the place of all wedges.

    Where the faces hold along the track the column force, which follows the bolster's height and
    the vertical hold, moves a frame a little in pitch too, which bushings do not: below 0.5 %.
    """
    shipped = catalogue.freight_car(loaded)
    for car, part in ((without_faces(shipped), 1e-5), (shipped, 5e-3)):
        wedge = next(c.element for c in car.connections if isinstance(c.element, FrictionWedge))
        stiffness = wedge.friction * wedge.column_force / wedge.presliding
        damped = with_springs_for_wedges(car, stiffness, stiffness * wedge.damping_time)
        assert_same_roots(roots(car), roots(damped), part)


def test_the_load_lowers_the_stuck_cars_critical_speed_by_its_inertia():
    """The load's weight as a force on the empty body leaves the empty car's speed nearly (docs).

    Its mass takes it down by a quarter. Nearer to the loaded car's body the speed falls with each
    part of the inertia: kinematic motion shakes the body, whose inertia pulls at the trucks.
    """
    loaded, empty = catalogue.freight_car(True), catalogue.freight_car(False)
    heavy, light = loaded.part("body"), empty.part("body")
    swapped = replace(heavy, mass=light.mass, inertia=light.inertia)
    pressed = replace(
        loaded,
        bodies=tuple(swapped if body == heavy else body for body in loaded.bodies),
        loads=(Load("body", (0.0, 0.0, 9.81 * (light.mass - heavy.mass)), heavy.centre),),
    )
    speeds = [linear_critical_speed(car, 30.0, 70.0, points=11) for car in (loaded, empty, pressed)]
    assert speeds[2] == pytest.approx(float(speeds[1]), rel=0.05)
    assert speeds[0] < 0.78 * speeds[1]


def test_wedges_that_hold_along_the_track_yaw_the_bolster_with_its_wheelsets():
    """A three-piece truck warps as a parallelogram: axles and bolster turn together.

    In the critical mode of the empty car the bolster yaws as its wheelsets do, to a fifth; with
    wedges that let it slide along the track it hardly yaws, and the speed is a third lower.
    """
    car = catalogue.freight_car(False)
    loose = without_faces(car)
    shares, speeds = [], []
    for one in (car, loose):
        critical = linear_critical_speed(one, 25.0, 70.0, points=11)
        linear = linearise(one, critical.speed)
        names = linear.system.state_names
        _, mode = hunting_mode(linear)
        yaw = {n: abs(mode[names.index(f"front {n}: yaw [rad]")]) for n in ("leading", "bolster")}
        shares.append(yaw["bolster"] / yaw["leading"])
        speeds.append(critical.speed)
    assert shares[0] == pytest.approx(1.0, abs=0.2)
    assert shares[1] < 0.6
    assert speeds[1] < 0.7 * speeds[0]


def test_time_steps_follow_holds_of_short_presliding():
    """A hold relaxes at |u|/presliding: RK44 follows 2 over that, at half a metre a second."""
    car = catalogue.freight_car(False)
    assert followed_step(car) == pytest.approx(5e-4)
    short = replace(
        car,
        connections=tuple(
            replace(one, element=replace(one.element, presliding=2e-5))
            if isinstance(one.element, FrictionWedge)
            else one
            for one in car.connections
        ),
    )
    assert followed_step(short) == pytest.approx(2.0 * 2e-5 / 0.5)


def test_every_hold_is_a_neutral_state_by_its_name():
    """One zero root a hold, its mode the hold strained alone, in equilibrium."""
    car = catalogue.freight_car()
    linear = linearise(car, 20.0)
    states = [n.rpartition(": ")[2] for n in linear.system.state_names if n.endswith("hold [-]")]
    expected = {f"neutral: {state.removesuffix(' hold [-]')}" for state in states}
    named = [name for name in linear.mode_names if name.startswith("neutral: ")]
    assert len(named) == len(states) == 30
    assert set(named) == expected
    for row, name in enumerate(linear.mode_names):
        if name.startswith("neutral: "):
            mode = linear.eigenvectors[:, row] / linear.system.scales
            rate = linear.jacobian @ linear.eigenvectors[:, row] / linear.system.scales
            assert abs(linear.eigenvalues[row]) < 1e-6
            assert np.abs(rate).max() < 1e-5 * np.abs(mode).max()


def test_plate_friction_alone_turns_a_truck_stiffly():
    """Turning the body on its plates: stiffness mu N (2R/3)^2/presliding at rest."""
    load = 3.9e5
    plate = CentrePlate(radius=0.178, friction=0.3, damping_time=0.0)
    driven = DrivenElement(plate, (0, 0, load, 0, 0, 0))
    small = 1e-6
    driven.holds[:] = driven.held_after(np.array([0, 0, 0, 0, 0, small]))
    moment = driven.force(np.array([0, 0, 0, 0, 0, small]), np.zeros(6))[0][5]
    expected = 0.3 * load * (2.0 * 0.178 / 3.0) ** 2 / plate.presliding
    assert -moment / small == pytest.approx(expected, rel=1e-3)
