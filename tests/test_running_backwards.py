"""A vehicle that runs backwards is the vehicle turned end for end running forwards.

Every place x becomes -x. A car that is alike at both ends has the same roots whichever way it runs;
one with a softer front truck has not, and turned twice it is itself again.
"""

from dataclasses import replace

import numpy as np
import pytest

from exudyn_wheelset import (
    Track,
    Wheelset,
    catalogue,
    contact_forces,
    linear_critical_speed,
    linearise,
)
from exudyn_wheelset.creep import CREEP_LAWS


def turned(vehicle):
    """The vehicle end for end; elements of the cars here act alike to both ends."""
    return replace(
        vehicle,
        bodies=tuple(
            replace(body, centre=(-body.centre[0], *body.centre[1:])) for body in vehicle.bodies
        ),
        wheelsets=tuple(replace(axle, x=-axle.x) for axle in vehicle.wheelsets),
        connections=tuple(
            replace(one, at=(-one.at[0], *one.at[1:])) for one in vehicle.connections
        ),
    )


def roots(vehicle, speed=40.0):
    """Roots that oscillate, below 100 1/s in size, by frequency and damping."""
    values = linearise(vehicle, speed).eigenvalues
    values = values[(values.imag > 0.1) & (np.abs(values) < 100.0)]
    return values[np.lexsort((values.real.round(4), values.imag.round(4)))]


@pytest.mark.parametrize("creep", ["shen-hedrick-elkins", "exact-table"])
def test_a_symmetric_car_has_the_same_critical_speed_backwards(creep):
    car = catalogue.dtu_car(creep=creep)
    assert turned(car) != car
    forwards, backwards = (linear_critical_speed(one, 20.0, 100.0) for one in (car, turned(car)))
    # Jacobians by differences of 6e-6 of the scales leave 1e-7 of the speed.
    assert backwards.speed == pytest.approx(forwards.speed, rel=1e-6)
    assert backwards.frequency == pytest.approx(forwards.frequency, rel=1e-6)
    np.testing.assert_allclose(roots(turned(car)), roots(car), rtol=1e-5, atol=1e-5)


def test_an_unsymmetric_car_has_not():
    car = catalogue.dtu_car()
    soft = tuple(
        replace(
            one,
            element=replace(one.element, stiffness=tuple(0.5 * k for k in one.element.stiffness)),
        )
        if "front leading" in (one.lower, one.upper)
        else one
        for one in car.connections
    )
    car = replace(car, connections=soft)
    assert np.abs(roots(turned(car))[:4] - roots(car)[:4]).max() > 1e-3
    np.testing.assert_array_equal(roots(turned(turned(car))), roots(car))


def mirrored(vector):
    """A rotation, a rate of one or a moment seen in a mirror across the track."""
    return vector * np.array([1.0, -1.0, -1.0])


@pytest.mark.parametrize(
    ("normal", "creep"),
    [("hertz", law) for law in CREEP_LAWS] + [("strips", "fastsim"), ("energy", "exact-table")],
)
def test_forces_backwards_are_those_forwards_in_a_mirror(normal, creep):
    """Rolling on cones with spin, yawed, off the middle: camber thrust keeps its side."""
    wheelset = Wheelset(mass=1000.0, inertia=(600.0, 80.0, 600.0), radius=0.46, wheel="S1002")
    rotation, velocity = np.array([2e-4, 0.0, 3e-3]), np.array([20.0, 0.02, 0.0])
    rates = np.array([0.0, 20.0 / 0.46 * 1.001, 0.01])
    mirror = np.array([-1.0, 1.0, 1.0])
    found = [
        contact_forces(
            wheelset, Track("UIC60"), (0.0, 3e-3, -8e-5, *turn), (*along, *about),
            normal=normal, creep=creep,
        )
        for turn, along, about in (
            (rotation, velocity, rates),
            (mirrored(rotation), mirror * velocity, mirrored(rates)),
        )
    ]  # fmt: skip
    forwards, backwards = found
    assert abs(forwards.force[1]) > 10.0
    np.testing.assert_allclose(backwards.force, mirror * forwards.force, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(backwards.moment, mirrored(forwards.moment), rtol=1e-9, atol=1e-6)


def test_negative_speed_is_the_vehicle_turned():
    """By the creep law whose lateral force follows spin most closely."""
    car = catalogue.dtu_car(creep="exact-table")
    soft = car.replace("bodies.front frame.mass", 1.5 * car.bodies[1].mass)
    np.testing.assert_allclose(roots(soft, -40.0), roots(turned(soft), 40.0), rtol=1e-4, atol=1e-4)
