"""Creep force of a wheel on two lobes that are one patch: against tractions on the half-space.

Pressure of the elastic half-space (half_space.py) and Kalker's complete theory on it
(half_space_rolling.py), each strip with the slip of its own particle of the wheel. S1002 on UIC60
at the centre under 66.66 kN presses with two lobes 10 mm apart, R300 and R80 of the rail head: by
contact/load_patches.py they have the creep force of one ellipse.
"""

import math

import numpy as np
import pytest
from half_space import gap_of_left_wheel, half_space_contact
from half_space_rolling import rolling_force
from scipy.optimize import brentq

from exudyn_wheelset import Track, Wheelset, contact_forces, contact_geometry
from exudyn_wheelset.contact.layout import HEADER, SIDE, Axle
from exudyn_wheelset.contact.locus import wheel_point
from exudyn_wheelset.contact.tables import contact_tables

WHEELSET = Wheelset(mass=1022.0, inertia=(678.0, 80.0, 678.0), radius=0.425, wheel="S1002")
TRACK = Track("UIC60")
LOAD, FRICTION, SHEAR_MODULUS, POISSON = 66.66e3, 0.15, 82.677e9, 0.27
SPEED, STEP = 30.0, 2e-5


def at_load(shift, load_of):
    """Pose (y, z, roll) at which the left wheel carries LOAD."""
    rigid = contact_geometry(WHEELSET, TRACK, [shift])
    height, roll = rigid.z[0], rigid.roll[0]
    depth = brentq(lambda d: load_of((shift, height - d, roll)) - LOAD, 2e-5, 1.5e-4, xtol=1e-8)
    return shift, height - depth, roll


class Truth:
    """Pressure and points of the wheel at a pose."""

    def __init__(self, pose, across=40, along=10):
        arc, depth, ny, nz, curvature = gap_of_left_wheel(WHEELSET, TRACK, *pose)
        inside = arc[depth > 0.0]
        self.ds = (inside[-1] - inside[0] + 4e-5) / across
        s = inside[0] - 2e-5 + self.ds * (np.arange(across) + 0.5)
        found = half_space_contact(
            s, np.interp(s, arc, depth), np.interp(s, arc, curvature), SHEAR_MODULUS, POISSON,
            along=along, tolerance=1e-5,
        )  # fmt: skip
        self.load, self.pressure, self.dx = found.load, found.pressure, found.dx
        self.normal = np.interp(s, arc, ny), np.interp(s, arc, nz)
        table = contact_tables(WHEELSET, TRACK)
        side = table[:HEADER].view(SIDE)[0]
        y, z, roll = pose
        axle = Axle(y, side["radius"] + z, 0.0, math.cos(roll), math.sin(roll))
        points = np.array([wheel_point(table, side, place, axle)[:3] for place in s])
        self.points = points - np.array([0.0, axle.y, axle.z])

    def force(self, velocity):
        vx, vy, _, wx, wy, wz = velocity
        x, y, z = self.points.T
        ny, nz = self.normal
        slips = (
            (vx + wy * z - wz * y) / vx,
            (nz * (vy + wz * x - wx * z) - ny * (wx * y - wy * x)) / vx,
            (ny * wy + nz * wz) / vx,
        )
        return np.array(
            rolling_force(self.pressure, self.ds, self.dx, slips, FRICTION, SHEAR_MODULUS, POISSON)
        )


def model_force(pose, velocity, normal):
    y, z, roll = pose
    patches = contact_forces(
        WHEELSET, TRACK, (0.0, y, z, roll, 0.0, 0.0), velocity, normal=normal,
        creep="exact-table", friction=FRICTION, shear_modulus=SHEAR_MODULUS, poisson=POISSON,
    ).left  # fmt: skip
    return np.array([sum(p.fx for p in patches), sum(p.fy for p in patches)]), patches


def free_and_slopes(force):
    """Radius [m] at which a wheel rolls without F_x, and -dF_x, -dF_y by creepage there [N]."""

    def rolling(radius, aside=0.0):
        return force((SPEED, aside * SPEED, 0.0, 0.0, SPEED / radius, 0.0))

    middle = WHEELSET.radius
    radius = brentq(lambda r: rolling(r)[0], middle - 5e-4, middle + 5e-4, xtol=1e-8)
    along = rolling(radius * (1.0 + STEP))[0] - rolling(radius * (1.0 - STEP))[0]
    aside = rolling(radius, STEP)[1] - rolling(radius, -STEP)[1]
    return radius, -along / (2.0 * STEP), -aside / (2.0 * STEP)


@pytest.fixture(scope="module", params=[0.0, 0.5e-3], ids=["0mm", "0.5mm"])
def judged(request):
    """Shift, and what the half-space says of it."""
    truth = Truth(at_load(request.param, lambda pose: Truth(pose, 40, 6).load))
    return request.param, free_and_slopes(truth.force)


@pytest.mark.parametrize("normal", ["energy", "ritz", "hertz"])
def test_two_lobes_roll_as_one_patch(judged, normal):
    """Within 8 % along x and 3 % across in the slopes, 0.05 mm in the radius on which it rolls.

    One ellipse is not the patch: it is 4 % too soft along x at the centre, 6 to 7 % beside it, and
    the judge's grid leaves 1 to 2 % of its own (tractions of first order in the cells).
    """
    shift, (radius, along, aside) = judged
    rolling = (SPEED, 0.0, 0.0, 0.0, SPEED / WHEELSET.radius, 0.0)
    pose = at_load(shift, lambda p: sum(q.normal_force for q in model_force(p, rolling, normal)[1]))
    own_radius, own_along, own_aside = free_and_slopes(lambda v: model_force(pose, v, normal)[0])
    assert own_radius == pytest.approx(radius, abs=5e-5)
    assert own_along == pytest.approx(along, rel=0.08)
    assert own_aside == pytest.approx(aside, rel=0.03)
