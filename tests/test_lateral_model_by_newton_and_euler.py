"""The lateral model's forces against Newton and Euler along its own motion.

The model solves (1) to (6) of the paper for y'', yaw'' and both normal forces at once. Here none of
those equations is used: from the motion over a short time, height z(y(t)) and roll phi(y(t)) are
differentiated twice in time, and the forces that the model names must make just that: m z'' and
I_x phi'' with the gyroscopic moment of the spin. Where the contact climbs, z_yy y'^2 and phi_yy
y'^2 are a large part of both. Across and about the vertical the springs join in.
"""

import math

import numpy as np
import pytest

from exudyn_wheelset.catalogue.paper_wheelset import paper_lateral_wheelset
from exudyn_wheelset.contact.locus import locus_point

SPEED = 30.0


def rates(model, state):
    return np.asarray(model.derivative(np.array(state), SPEED))


def after(model, state, time):
    """State after a short time, one step of RK4."""
    k1 = rates(model, state)
    k2 = rates(model, state + 0.5 * time * k1)
    k3 = rates(model, state + 0.5 * time * k2)
    k4 = rates(model, state + time * k3)
    return state + time / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


def height_and_roll(model, shift):
    breaks, table = model._geometry
    cell = int(np.clip(np.searchsorted(breaks, shift) - 1, 0, len(breaks) - 2))
    powers = (shift - breaks[cell]) ** np.arange(table.shape[0])[::-1]
    return np.array([powers @ table[:, cell, 1], powers @ table[:, cell, 0]])


@pytest.mark.parametrize("wheel", ["AAR_1_20", "S1002"])
@pytest.mark.parametrize(("y", "y_rate"), [(1.0e-3, 0.2), (-5.6e-3, 0.35), (5.5e-3, -0.4)])
def test_vertical_and_roll_balance_along_the_motion(wheel, y, y_rate):
    model = paper_lateral_wheelset("profiled", 1, wheel=wheel, gauge=1.435)
    given = model.parameters
    state = np.array([y, 2.0e-3, y_rate, 0.1])
    step = 2.0e-5
    shifts = [after(model, state, time)[0] for time in (-step, 0.0, step)]
    below, here, above = (height_and_roll(model, shift) for shift in shifts)
    height_acceleration, roll_acceleration = (above - 2.0 * here + below) / step**2

    contact = model.contact_state(state, SPEED)
    yaw, roll = state[1], here[1]
    axle = np.array(
        [-math.sin(yaw) * math.cos(roll), math.cos(yaw) * math.cos(roll), math.sin(roll)]
    )
    force, moment = np.zeros(3), np.zeros(3)
    for hand, side in ((0, 1.0), (1, -1.0)):
        angle, wheel_y = contact["angle"][hand], contact["wheel_y"][hand]
        normal = np.array([0.0, -side * math.sin(angle), math.cos(angle)])
        tangent = np.array([0.0, math.cos(angle), side * math.sin(angle)])
        slope = -float(model.wheelset.wheel.slope(wheel_y))
        mirrored = axle * [side, 1.0, side]
        place = locus_point(
            0.75 + wheel_y, contact["radius"][hand], slope, 0.0, 0.0, 0.0, *mirrored
        )
        on_wheel = contact["normal_force"][hand] * normal + contact["fy"][hand] * tangent
        on_wheel[0] += contact["fx"][hand]
        force += on_wheel
        moment += np.cross([place[0], side * place[1], place[2]], on_wheel)
        moment += contact["mz"][hand] * normal
    # The splines' second derivative changes by 1e-3 over the 8 um that the step covers.
    assert force[2] - given.axle_load == pytest.approx(
        given.mass * height_acceleration, rel=2e-3, abs=1e-5 * given.axle_load
    )
    spin = given.spin_inertia * SPEED / given.radius
    assert moment[0] + spin * state[3] == pytest.approx(
        given.roll_inertia * roll_acceleration, rel=2e-3, abs=1e-5 * given.axle_load
    )
    _, _, y_acceleration, yaw_acceleration = rates(model, state)
    springs = 2.0 * np.array(
        [given.lateral_stiffness, given.longitudinal_stiffness * given.spring_half_distance**2]
    )
    assert force[1] - springs[0] * y == pytest.approx(given.mass * y_acceleration, rel=1e-9)
    roll_rate = (above[1] - below[1]) / (2.0 * step)
    assert moment[2] - springs[1] * yaw - spin * roll_rate == pytest.approx(
        given.yaw_inertia * yaw_acceleration, rel=1e-5
    )
    if (wheel, y) == ("S1002", 5.5e-3):
        # What is tested is there: without z_yy y'^2 the height would accelerate otherwise.
        slopes = (above - below) / (shifts[2] - shifts[0])
        without = slopes * y_acceleration
        assert abs(height_acceleration - without[0]) > 0.1 * abs(height_acceleration)
