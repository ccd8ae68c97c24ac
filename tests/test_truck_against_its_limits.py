"""The truck against cases whose answer is known: statics, published bogie, stiff and rigid limits.

Sources: equilibrium of forces; C. Kaas-Petersen, Acta Mechanica 61 (1986) 89-107 (lateral bogie
model, Hopf point at 68.64 m/s and 4.00 Hz); A. H. Wickens, Fundamentals of Rail Vehicle Dynamics,
for the kinematic wave of a rigid two-axle truck.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from exudyn_wheelset.catalogue.truck import Truck, dtu_truck
from exudyn_wheelset.catalogue.wheelset_on_frame import Suspension, WheelsetOnFrame
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.contact.wheelset_contact import contact_forces
from exudyn_wheelset.creep import kalker_coefficients
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.geometry.rigid import contact_geometry
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.linearisation import linearise

PUBLISHED_SPEED, PUBLISHED_FREQUENCY = 68.64, 4.00
CONTACT_HALF_DISTANCE = 0.7163


def kaas_petersen_truck(shear_modulus: float = 8.27e10) -> Truck:
    """The classic bogie in three dimensions.

    Cones that, with the roll they cause on UIC60 heads, have the conicity 0.05 of the source;
    contact points at its half distance; wheelset inertias that its lateral equations know (yaw;
    roll equal to it, as an axisymmetric body has; next to no spin).
    """
    wheelset = Wheelset(
        mass=1022.0,
        inertia=(678.0, 1.0, 678.0),
        radius=0.4572,
        wheel="cone_0.0482",
        tape_half_distance=0.727,
    )
    return Truck(
        wheelset=wheelset,
        track=Track("UIC60", inclination=0.0, datum_half_distance=0.7283),
        frame_mass=2918.0,
        frame_inertia=(6780.0, 6780.0, 6780.0),
        half_wheelbase=1.074,
        axle_drop=0.0762,
        secondary_rise=0.6584,
        primary=Suspension(0.620, stiffness=(3.646e6, 1.823e6, 3.646e6)),
        secondary=Suspension(
            0.680, stiffness=(0.0, 182.3e3, 333.3e3), damping=(0.0, 29.2e3, 20.0e3)
        ),
        yaw=Suspension(1.0, stiffness=(2.710e6 / 2.0, 0.0, 0.0)),
        car_load=0.5 * 44388.0 * 9.81,
        # No spin creep in the source: the cubic of Vermeulen and Johnson.
        contact={
            "creep": "vermeulen-johnson",
            "friction": 0.15,
            "shear_modulus": shear_modulus,
            "poisson": 0.27,
            "damping": 0.1,
        },
    )


def creep_coefficients(truck: Truck) -> tuple[float, float]:
    """Linear creep coefficients f11, f22 [N] of one wheel at rest."""
    pose = (0.0, 0.0, truck.rest_height(), 0.0, 0.0, 0.0)
    rolling = (10.0, 0.0, 0.0, 0.0, 10.0 / truck.wheelset.radius, 0.0)
    (patch,) = contact_forces(truck.wheelset, truck.track, pose, rolling, **truck.contact).left
    factors = kalker_coefficients(patch.a, patch.b, truck.contact["poisson"])
    size = truck.contact["shear_modulus"] * patch.a * patch.b
    return size * factors[0], size * factors[1]


def test_published_bogie_critical_speed():
    """The lateral model's Hopf point, to what its seven coordinates leave out.

    Wheelset roll with its inertia, gravitational stiffness of the contact angles and the tipping
    of the car's load are here and not there; each is below 1 % of the springs it adds to. The
    creep coefficients are matched in their mean; they differ from the source in their ratio.
    """
    truck = kaas_petersen_truck()
    geometry = contact_geometry(truck.wheelset, truck.track, [-1e-3, 0.0, 1e-3])
    conicity = geometry.rolling_radius_difference[2] / 2e-3
    half_distance = truck.wheelset.tape_half_distance + geometry.left.wheel_y[1]
    assert conicity == pytest.approx(0.05, rel=0.01)
    assert half_distance == pytest.approx(CONTACT_HALF_DISTANCE, rel=0.002)

    # f11 = 6.563e6/0.60252 N and f22 = 6.563e6/0.54219 N in the source.
    wanted = 6.563e6 / np.sqrt(0.60252 * 0.54219)
    shear_modulus = truck.contact["shear_modulus"]
    for _ in range(4):
        f11, f22 = creep_coefficients(kaas_petersen_truck(shear_modulus))
        shear_modulus *= (wanted / np.sqrt(f11 * f22)) ** 3
    truck = kaas_petersen_truck(shear_modulus)
    f11, f22 = creep_coefficients(truck)
    assert np.sqrt(f11 * f22) == pytest.approx(wanted, rel=0.02)

    critical = linear_critical_speed(truck, 30.0, 120.0)
    assert critical.speed == pytest.approx(PUBLISHED_SPEED, rel=0.03)
    assert critical.frequency == pytest.approx(PUBLISHED_FREQUENCY, rel=0.04)


def test_wheel_loads_balance_the_weight():
    """The vertical forces of all wheels add up to the weight, equally on all four."""
    truck = dtu_truck()
    system = truck.dynamic_system()
    _, mbs, items = truck.build(30.0, sensors=False, show=False)
    mbs.Assemble()
    coordinates, velocities = system.expand(system.equilibrium(30.0))
    mbs.systemData.SetODE2Coordinates(coordinates)
    mbs.systemData.SetODE2Coordinates_t(velocities)
    forces = [contact.current(mbs) for contact in items.contacts]
    total = sum(force.force for force in forces)
    # The equilibrium is solved to 1e-9 in accelerations.
    assert total[2] == pytest.approx(truck.weight, rel=1e-6)
    assert total[0] == pytest.approx(0.0, abs=1.0)
    assert total[1] == pytest.approx(0.0, abs=1.0)
    sides = [
        sum(patch.normal_force for patch in side) for f in forces for side in (f.left, f.right)
    ]
    assert sides == pytest.approx([sides[0]] * 4, rel=1e-6)


def test_modes_of_a_mirror_symmetric_truck_are_lateral_or_vertical():
    """A truck equal on both sides: no mode mixes lateral motions with longitudinal and vertical."""
    truck = dtu_truck()
    system = truck.dynamic_system()
    linear = linearise(system, 30.0)
    scaled = np.abs(linear.eigenvectors / system.scales[:, None])
    words = ("y [m]", "yaw", "roll", "vy", "wx", "wz")
    lateral = np.array([any(word in name for word in words) for name in system.state_names])
    share = (scaled[lateral] ** 2).sum(axis=0) / (scaled**2).sum(axis=0)
    # Roots of both kinds that nearly agree leave their eigenvectors open to rounding.
    values = linear.eigenvalues
    apart = np.array([np.sort(np.abs(values - value))[1] > 1e-2 for value in values])
    assert apart.sum() >= 20
    assert np.all(np.minimum(share, 1.0 - share)[apart] < 1e-6)


def test_wheelsets_under_a_fixed_frame_are_single_wheelsets():
    """A frame that cannot move: the truck's critical speed is that of one wheelset."""
    stiff = Suspension(0.680, stiffness=(1e10, 1e10, 1e10), damping=(1e7, 1e7, 1e7))
    truck = replace(dtu_truck(), secondary=stiff, frame_mass=1e5, frame_inertia=(1e7, 1e7, 1e7))
    alone = WheelsetOnFrame(
        wheelset=truck.wheelset,
        track=truck.track,
        suspension=truck.primary,
        axle_load=truck.axle_load,
        contact=truck.contact,
    )
    of_truck = linear_critical_speed(truck, 30.0, 120.0)
    of_wheelset = linear_critical_speed(alone, 30.0, 120.0)
    # The lone wheelset has its load on it and rolls freely against vertical springs that are not
    # loaded; the frame still yields by 1/1000 of the primary springs.
    assert of_truck.speed == pytest.approx(of_wheelset.speed, rel=0.01)
    assert of_truck.frequency == pytest.approx(of_wheelset.frequency, rel=0.01)


def test_rigid_truck_follows_the_kinematic_wave():
    """Slow, rigid primary suspension, free secondary: Wickens' wave of a rigid truck.

    No creep force in sum: c y'/V = yaw and (e^2 f11 + c b^2 f22) yaw'/V = -f11 e conicity y/r0,
    where c = 1 + r0 roll/y is what roll adds to the lateral velocity of the contact points. At a
    walking pace masses and secondary springs have no influence.
    """
    soft = Suspension(0.680, stiffness=(1.0, 1.0, 333.3e3))
    rigid = Suspension(0.620, stiffness=(3e9, 3e9, 3.646e6))
    truck = replace(kaas_petersen_truck(), primary=rigid, secondary=soft, yaw=None)
    geometry = contact_geometry(truck.wheelset, truck.track, [-1e-3, 0.0, 1e-3])
    conicity = geometry.rolling_radius_difference[2] / 2e-3
    radius = geometry.left.radius[1]
    half = truck.wheelset.tape_half_distance + geometry.left.wheel_y[1]
    rolled = 1.0 + radius * geometry.roll[2] / geometry.y[2]
    f11, f22 = creep_coefficients(truck)
    stretch = half**2 + rolled * truck.half_wheelbase**2 * f22 / f11
    wave = 2.0 * np.pi * np.sqrt(rolled * radius / (conicity * half) * stretch)
    speed = 5.0
    linear = linearise(truck.dynamic_system(), speed)
    frequencies = linear.eigenvalues.imag / (2.0 * np.pi)
    # 2 %: gravitational stiffness of the contact angles and the roll of the frame are left out.
    nearest = frequencies[np.argmin(np.abs(frequencies - speed / wave))]
    assert nearest == pytest.approx(speed / wave, rel=0.02)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"frame_mass": -1.0}, "frame_mass"),
        ({"half_wheelbase": 1074.0}, "metres"),
        ({"car_load": float("nan")}, "car_load"),
        ({"primary": Suspension(0.62, (1e6, 1e6, 0.0))}, "vertical"),
    ],
)
def test_impossible_trucks_are_refused(change, words):
    with pytest.raises(WheelsetError, match=words):
        replace(dtu_truck(), **change)
