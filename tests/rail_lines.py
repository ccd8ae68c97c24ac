"""A wheel over the normals of a rail: tables, poses, places, and the penetration found slowly."""

import math

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from exudyn_wheelset import Track, Wheelset
from exudyn_wheelset.contact import gap
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.layout import (
    HEADER,
    SIDE,
    Axle,
)
from exudyn_wheelset.contact.tables import contact_tables

MODULUS = 82.0e9 / 0.72
WHEELSET = Wheelset(mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=0.46, wheel="S1002")
TRACK = Track("UIC60")
TABLE = contact_tables(WHEELSET, TRACK)
LEFT = TABLE[:HEADER].view(SIDE)[0]
# Shift, yaw and roll; wheel and rail arc of a place on tread, throat and flange are found from it.
POSES = [(0.0, 0.0, 0.0), (3e-3, 0.02, 1e-3), (-2e-3, -0.03, -2e-3), (6e-3, 0.03, 1e-3)]


def plain(kernel):
    return getattr(kernel, "py_func", kernel)


def axle_of(shift, yaw, roll, height=0.46, turned=(0.0, 0.0, 0.0)):
    """Axle record; `turned` are small rotations [rad] about x, y and z on top."""
    axis = np.array(
        [-math.sin(yaw) * math.cos(roll), math.cos(yaw) * math.cos(roll), math.sin(roll)]
    )
    axis = axis + np.cross(turned, axis)
    axis /= np.linalg.norm(axis)
    return Axle(shift, height, *map(float, axis))


def profile(arc):
    y, _, _, z, _, _ = plain(curve_point)(TABLE, LEFT.wheel, arc)
    return y, z


def wheel_depth(place, axle, near):
    """Greatest depth of the wheel's surface on the rail's normal at a place."""
    ry, r1, _, rz, q1, _ = plain(curve_point)(TABLE, LEFT.rail, place)
    axis = np.array([axle.lx, axle.ly, axle.lz])
    down = np.array([0.0, 0.0, -1.0]) + axle.lz * axis
    down /= np.linalg.norm(down)
    ahead = np.cross(down, axis)
    centre = np.array([0.0, axle.y, axle.z])

    def point(arc, angle):
        y, z = profile(arc)
        radial = math.cos(angle) * down + math.sin(angle) * ahead
        at = centre + (LEFT.tape + y) * axis + (LEFT.radius - z) * radial - [0.0, ry, rz]
        return at[1] * r1 + at[2] * q1, at[1] * q1 - at[2] * r1  # along tangent, into the rail

    def depth(angle):
        arc = brentq(lambda a: point(a, angle)[0], near - 4e-3, near + 4e-3, xtol=1e-15)
        return point(arc, angle)[1]

    found = minimize_scalar(lambda angle: -depth(angle), (-0.03, 0.03), tol=1e-12)
    return -found.fun


def converged(place, axle, arc=None):
    if arc is None:
        ry = plain(curve_point)(TABLE, LEFT.rail, place)[0]
        arc = brentq(lambda a: LEFT.tape + profile(a)[0] + axle.y - ry, 0.0, 0.2)
    for _ in range(8):
        depth, first, second, arc = plain(gap.gap_on_normal)(TABLE, LEFT, place, arc, axle)
    return depth, first, second, arc


def places():
    """Arc lengths of the rail 25 mm inside, about the middle and in the gauge corner."""
    arcs = np.linspace(0.0, LEFT.rail.spacing * LEFT.rail.segments, 400)
    lateral = [plain(curve_point)(TABLE, LEFT.rail, a)[0] - LEFT.datum for a in arcs]
    return [float(np.interp(y, lateral, arcs)) for y in (-0.024, -0.011, 0.0021, 0.0143)]


PLACES = places()
CASES = [(pose, place) for pose in POSES for place in PLACES]
