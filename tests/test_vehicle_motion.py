"""Vehicles in motion: energy, mirror symmetry, axes of the bodies, an element of one's own.

Energies are summed here from masses, heights and the connections' potential over simulated motion;
the mirror compares a vehicle's motion with that of the mirrored one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import ObjectConnectorCartesianSpringDamper, RigidBodyInertia
from scipy.integrate import cumulative_simpson
from scipy.spatial.transform import Rotation

from exudyn_wheelset import (
    Element,
    ExudynSystem,
    Spring,
    Wheelset,
    catalogue,
    dtu_truck,
    linearise,
    static_equilibrium,
)
from exudyn_wheelset.systems.vehicle_system import vehicle_system
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.assemble import add_vehicle
from exudyn_wheelset.vehicles.description import Axle

GRAVITY = 9.81
LATERAL = ("y [m]", "vy [m/s]", "roll [rad]", "yaw [rad]", "wx [rad/s]", "wz [rad/s]")


class Energies:
    """Kinetic, potential and contact energy of a vehicle, and the power its dampers take."""

    def __init__(self, vehicle, mbs, items):
        self.mbs, self.items = mbs, items
        self.parts = []
        for part in vehicle.parts:
            solid = part.wheelset if isinstance(part, Axle) else part
            self.parts.append((items.node(part.name), solid.mass, np.array(solid.inertia)))

    def at(self, coordinates, velocities, strokes):
        data = self.mbs.systemData
        data.SetODE2Coordinates(coordinates)
        data.SetODE2Coordinates_t(velocities)
        if len(strokes):
            data.SetODE1Coordinates(strokes)
        energy, power = self.items.connectors.energy(self.mbs)
        for node, mass, inertia in self.parts:
            place = np.array(data.GetNodeLTGODE2(node))
            v = velocities[place]
            energy += 0.5 * mass * v[:3] @ v[:3] + 0.5 * inertia @ v[3:] ** 2
            energy += mass * GRAVITY * coordinates[place[2]]
        energy += sum(contact.elastic_energy(self.mbs) for contact in self.items.contacts)
        return energy, power


@pytest.mark.slow
@pytest.mark.parametrize("name", ["dtu_car", "manchester_coach"])
def test_energy_goes_into_the_dampers_alone(name):
    """Without friction a car that bounces and sways for 20 s loses what its dampers take, to 1e-3.

    Only the body is pushed: the wheelsets stay on their treads, where the normal force has a
    potential. Energies are counted from those at rest.
    """
    vehicle = catalogue.vehicle(name, friction=0.0)
    system = vehicle_system(vehicle, step=5e-4)
    start = system.initial_state(20.0)
    kick = {"body: vz [m/s]": 0.2, "body: vy [m/s]": 0.1, "body: wx [rad/s]": 0.05}
    state = start.copy()
    for key, value in kick.items():
        state[system.state_names.index(key)] += value
    times = np.arange(0.0, 20.0 + 1e-9, 4e-3)
    states = system.simulate(state, 20.0, times)
    found = energies_of(vehicle, system)
    first = len(states[0]) - system._order1
    rest = found.at(*system.expand(start), start[first:])[0]
    rows = [found.at(*system.expand(row), row[first:]) for row in states]
    energy = np.array([row[0] for row in rows]) - rest
    taken = cumulative_simpson([row[1] for row in rows], x=times, initial=0.0)
    assert taken[-1] > 0.5 * energy[0]
    assert np.abs(energy + taken - energy[0]).max() < 1e-3 * energy[0]


def energies_of(vehicle, system):
    """The energies of the vehicle in the system's own model."""
    items = system.vehicle_items
    return Energies(vehicle, system.mbs, items)


def test_the_mirrored_vehicle_moves_as_the_mirror_shows():
    """A car with its body's centre beside the middle and unlike wheels, from an unlike start."""
    car = catalogue.manchester_coach().replace("bodies.body.centre.y", 0.02)
    unlike = replace(car.wheelsets[0].wheelset, right_radius=0.4602)
    car = car.replace("wheelsets.front leading.wheelset", unlike)
    runs = []
    for sign, vehicle in ((1.0, car), (-1.0, car.mirrored())):
        system = vehicle_system(vehicle)
        flips = np.array(
            [sign if name.split(": ")[-1] in LATERAL else 1.0 for name in system.state_names]
        )
        # Strokes across: the mirrored damper's direction is turned as well.
        state = system.initial_state(40.0)
        state[system.state_names.index("front leading: y [m]")] += sign * 1e-3
        runs.append(flips * system.simulate(state, 40.0, np.linspace(0.0, 1.0, 51)))
    apart = np.abs(runs[1] - runs[0]).max(axis=0)
    largest = np.abs(runs[0]).max(axis=0)
    # Rounding is 3e-11 of the scales (mm, mrad); what moves by a twentieth of them is compared with
    # itself, the rest (4e-8 m/s of a rear wheelset) is below what rounding leaves of a sum.
    assert (apart / system.scales).max() < 1e-9
    moves = largest > 0.05 * system.scales
    assert moves.sum() > 20
    assert (apart[moves] / largest[moves]).max() < 1e-9


def test_mirroring_twice_is_the_same():
    car = catalogue.manchester_coach().replace("bodies.body.centre.y", 0.02)
    assert car.mirrored() != car
    assert car.mirrored().mirrored() == car
    wheelset = Wheelset(1e3, (500, 100, 500), 0.46, "S1002", right_radius=0.459)
    unlike = car.replace("wheelsets.front leading.wheelset", wheelset)
    assert unlike.mirrored().wheelsets[0].wheelset.radius == 0.459


@dataclass(frozen=True)
class TrackSpring(Element):
    """An element of one's own: Exudyn's Cartesian spring, which acts along the track's axes."""

    stiffness: tuple[float, float, float]
    damping: tuple[float, float, float]

    def static_stiffness(self) -> np.ndarray:
        return np.diag([*self.stiffness, 0.0, 0.0, 0.0])

    def create(self, mbs: Any, ends: Any, preload: Any) -> int:
        offset = [f / k if k else 0.0 for f, k in zip(preload[:3], self.stiffness, strict=True)]
        return mbs.AddObject(
            ObjectConnectorCartesianSpringDamper(
                markerNumbers=[end.marker for end in ends],
                stiffness=list(self.stiffness),
                damping=list(self.damping),
                offset=offset,
            )
        )


def test_an_element_of_ones_own_works_at_once():
    """The DTU car on Exudyn's springs along the track's axes: on straight track the same roots.

    Both agree to first order in the motion, so the roots do to the differences of the Jacobian;
    a critical speed of 41.488 m/s moves by less than 1e-6 of itself.
    """
    car = catalogue.dtu_car()
    own = replace(
        car,
        connections=tuple(
            replace(one, element=TrackSpring(one.element.stiffness, one.element.damping))
            if isinstance(one.element, Spring)
            else one
            for one in car.connections
        ),
    )
    ours, theirs = (linearise(vehicle, 40.0).eigenvalues for vehicle in (car, own))
    for root in ours[(ours.imag > 1.0) & (np.abs(ours) < 100.0)]:
        assert np.abs(theirs - root).min() < 1e-6 * abs(root)


def test_axes_turn_with_the_truck_in_a_curve():
    """A truck turned by 26 mrad under its body: its lateral springs pull along its own axes.

    Each primary spring of the DTU car sees the wheelset moved along the truck's lateral axis; the
    force on the wheelset then points along that axis, not along the track's.
    """
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    car = catalogue.dtu_car(friction=0.0)
    items = add_vehicle(mbs, car, 20.0, show=False, sensors=False)
    mbs.Assemble()
    data = mbs.systemData
    turn = Rotation.from_rotvec([0.0, 0.0, 0.026])
    q = np.array(data.GetODE2Coordinates(exu.ConfigurationType.Initial))
    centre = np.array([7.5, 0.0, 0.0])
    for name in ("front leading", "front trailing", "front frame"):
        place = np.array(data.GetNodeLTGODE2(items.node(name)))
        own = np.array(mbs.GetNodeParameter(items.node(name), "referenceCoordinates"))[:3]
        q[place[:3]] = centre + turn.apply(own - centre) - own
        q[place[3:]] = turn.as_rotvec()
    leading = np.array(data.GetNodeLTGODE2(items.node("front leading")))
    moved = q.copy()
    moved[leading[:3]] += turn.apply([0.0, 1e-3, 0.0])
    forces = []
    for coordinates in (q, moved):
        data.SetODE2Coordinates(coordinates)
        items.connectors.energy(mbs)
        block, k = items.connectors.block, list(items.wheelsets).index("front leading")
        start = int(block[layout.H_FORCES]) + 6 * k
        forces.append(block[start : start + 3].copy())
    assert forces[1] - forces[0] == pytest.approx(
        turn.apply([0.0, -2.0 * 1.823e6 * 1e-3, 0.0]), abs=1e-3
    )


def test_two_trucks_under_a_body_are_the_car():
    """Trucks whose secondary springs stand under a body of the model, against the whole vehicle."""
    truck = dtu_truck()
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    height = truck.wheelset.radius + truck.rest_height() + truck.axle_drop + 1.5584
    body = mbs.CreateRigidBody(
        name="body",
        inertia=RigidBodyInertia(mass=44388.0, inertiaTensor=np.diag([2.8e5, 5e5, 5e5])),
        nodeType=exu.NodeType.RotationRotationVector,
        referencePosition=[0.0, 0.0, height],
        gravity=[0.0, 0.0, -GRAVITY],
        returnDict=True,
    )
    for name, x in (("front", 7.5), ("rear", -7.5)):
        truck.create(
            mbs, 20.0, position=(x, 0.0), car_body=body["bodyNumber"], show=False, name=name
        )
    together = linearise(ExudynSystem(mbs, container), 40.0).eigenvalues
    car = linearise(catalogue.dtu_car(), 40.0).eigenvalues
    for root in car[(car.imag > 1.0) & (np.abs(car) < 100.0)]:
        assert np.abs(together - root).min() < 1e-6 * abs(root)


def test_a_driven_axle_pulls_and_the_vehicle_is_held():
    """Wheels that roll beside the tape circle, held at V/r0: their creep force is the pull."""
    car = catalogue.dtu_car().replace("wheelsets.front leading.driven", True)
    rest = static_equilibrium(car)
    assert rest.residual < 1e-6
    system = vehicle_system(car)
    slip = rest.radii["front trailing"] / 0.425 - 1.0
    # On a smaller radius the rim is slower than the ground: it brakes, and is pulled. 14.3 MN a
    # wheel is the slope of the creep law there.
    assert np.sign(rest.pull) == -np.sign(slip)
    assert 10.0 < abs(rest.pull) <= 2 * 14.5e6 * abs(slip)
    assert np.all(np.isfinite(system.equilibrium(20.0)))


def test_the_step_follows_a_stiff_damper_in_series():
    """A relaxation time c/k of 0.1 ms: beyond RK44 at 0.5 ms (2.78 c/k), followed by 0.2 ms."""
    coach = catalogue.manchester_coach()
    assert vehicle_system(coach).step == 5e-4
    stiff = coach.replace("connections.vertical damper.stiffness", 20.0e3 / 1e-4)
    system = vehicle_system(stiff)
    assert system.step == pytest.approx(2e-4)
    state = system.initial_state(30.0)
    state[system.state_names.index("body: vz [m/s]")] += 0.05
    motion = system.simulate(state, 30.0, np.linspace(0.0, 1.0, 21))
    assert np.abs(motion[:, system.state_names.index("body: z [m]")]).max() < 0.02
