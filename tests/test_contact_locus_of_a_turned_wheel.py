"""The contact locus against the surface of revolution itself, turned in yaw and roll.

The wheel's surface is C + w l + r(w) (cos(angle) u + sin(angle) v) with u, v perpendicular to the
axle l. Its normal is the cross product of its two tangents; on a prismatic rail it touches where
that normal has no component along x, which is looked for by a bracketed root in the angle. Nothing
of the closed form of locus.py is used. Creepages against the cross product of rigid motion.
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from exudyn_wheelset import Track, Wheelset
from exudyn_wheelset.contact.creepage import creepage_at, slip_velocity
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.layout import Axle, Slip, side_of
from exudyn_wheelset.contact.locus import locus_point, rail_foot, wheel_point, wheel_section
from exudyn_wheelset.contact.tables import contact_tables

YAWS_AND_ROLLS = [(0.0, 0.0), (0.03, 0.0), (-0.03, 0.01), (0.08, -0.02), (-0.05, -0.03)]


def axle_vector(yaw, roll):
    """Unit vector towards the left wheel: rolled about x, then yawed about z."""
    return np.array(
        [-math.sin(yaw) * math.cos(roll), math.cos(yaw) * math.cos(roll), math.sin(roll)]
    )


def touching_point(w, radius, slope, axle):
    """Point from the axle's centre and outward normal where the surface can touch, by root."""
    u = np.cross(axle, [0.0, 0.0, 1.0])
    u /= np.linalg.norm(u)
    v = np.cross(u, axle)

    def at(angle):
        radial = -math.cos(angle) * v + math.sin(angle) * u
        around = math.sin(angle) * v + math.cos(angle) * u
        along = axle + slope * radial
        normal = np.cross(along, around)
        normal *= np.sign(normal @ radial) / np.linalg.norm(normal)
        return w * axle + radius * radial, normal

    angle = brentq(lambda angle: at(angle)[1][0], -1.3, 1.3, xtol=1e-15)
    return at(angle)


@pytest.mark.parametrize(("yaw", "roll"), YAWS_AND_ROLLS)
@pytest.mark.parametrize("slope", [0.0, -0.05, -0.6, -2.7, 0.4])
def test_locus_point(yaw, roll, slope):
    axle = axle_vector(yaw, roll)
    wanted, normal = touching_point(0.71, 0.47, slope, axle)
    found = locus_point(0.71, 0.47, slope, 0.01, 0.02, -0.03, *axle)
    centre = np.array([0.01, 0.02, -0.03])
    np.testing.assert_allclose(found[:3], wanted + centre, atol=1e-13)
    np.testing.assert_allclose(found[3:], normal[1:], atol=1e-13)


def test_a_yawed_flange_leads():
    """Nose left: the left flange (radius growing inwards) touches ahead of the axle's end.

    The axle's end itself has gone back by w sin(yaw); the flange's point lies r tan(flange angle)
    sin(yaw) ahead of it (Wang 1984; for 70 degrees 1.3 mm a milliradian at r = 0.47 m).
    """
    axle = axle_vector(1e-3, 0.0)
    x = locus_point(0.71, 0.47, -2.7, 0.0, 0.0, 0.0, *axle)[0]
    assert x == pytest.approx(-0.71e-3 + 0.47 * 2.7 * 1e-3, abs=1e-8)


@pytest.fixture(scope="module")
def s1002():
    wheelset = Wheelset(1813.0, (1120.0, 112.0, 1120.0), 0.46, "S1002")
    return contact_tables(wheelset, Track("UIC60"))


@pytest.mark.parametrize("hand", [0, 1])
@pytest.mark.parametrize(("yaw", "roll"), YAWS_AND_ROLLS)
def test_points_of_the_profile(s1002, hand, yaw, roll):
    """Wheel's points by arc length; at the tape circle the radius is nominal."""
    side = side_of(s1002, hand)
    vector = axle_vector(yaw, roll)
    axle = Axle(0.004, -0.002, *vector)
    for arc in np.linspace(0.2, 0.8, 13) * side.wheel.spacing * side.wheel.segments:
        y, y1, y2, z, z1, z2 = curve_point(s1002, side.wheel, arc)
        w, radius, slope = 0.75 + y, 0.46 - z, -z1 / y1
        wanted, normal = touching_point(w, radius, slope, vector)
        x, py, pz, ny, nz, arm, wheel_y, curvature = wheel_point(s1002, side, arc, axle)
        np.testing.assert_allclose([x, py - 0.004, pz + 0.002], wanted, atol=1e-13)
        np.testing.assert_allclose([ny, nz], normal[1:], atol=1e-9)
        assert wheel_y == pytest.approx(y, abs=1e-15)
        assert curvature == pytest.approx((y1 * z2 - z1 * y2) / math.hypot(y1, z1) ** 3, rel=1e-4)
        section = wheel_section(s1002, side, arc, axle)
        # wheel_section takes the profile's tangent as of unit length.
        np.testing.assert_allclose(section, (py, pz, ny, nz, curvature), rtol=1e-4, atol=1e-5)
        # The lead takes its share of the radius out of the direction of travel.
        lead = (wanted - w * vector)[0]
        assert arm == pytest.approx(math.sqrt(radius**2 - lead**2), abs=1e-13)


def test_foot_on_the_rail_is_the_nearest_point(s1002):
    """From a guess 10 um off: third order, curvature 77 1/m, 1e-15 * 77^2 m."""
    side = side_of(s1002, 0)
    length = side.rail.spacing * side.rail.segments
    for arc in np.linspace(0.25, 0.75, 9) * length:
        y, y1, _, z, z1, _ = curve_point(s1002, side.rail, arc)
        for height in (-4e-5, 3e-5):
            py, pz = y - height * z1, z + height * y1

            def distance(s, py=py, pz=pz):
                y, _, _, z, _, _ = curve_point(s1002, side.rail, s)
                return math.hypot(py - y, pz - z)

            nearest = minimize_scalar(
                distance, bounds=(arc - 1e-3, arc + 1e-3), method="bounded", options={"xatol": 1e-9}
            )
            foot, ty, tz, curvature, found = rail_foot(s1002, side, py, pz, arc + 1e-5)
            # A minimum is seen to the square root of rounding in its place only.
            assert foot == pytest.approx(nearest.x, abs=1e-6)
            assert foot == pytest.approx(arc, abs=5e-8)
            assert found == pytest.approx(height, abs=1e-9)
            assert abs(found) == pytest.approx(nearest.fun, abs=1e-9)
            exact = curve_point(s1002, side.rail, arc)
            np.testing.assert_allclose([ty, tz], [exact[1], exact[4]], atol=1e-5)
            assert curvature <= 1e-6


def test_velocity_and_creepage_of_a_particle():
    """v + omega x r; across along n x e_x; spin about the normal, over V with its sign."""
    random = np.random.default_rng(5)
    for _ in range(20):
        velocity, rates, place = random.normal(size=(3, 3))
        speed, angle = random.uniform(5.0, 60.0), random.uniform(-1.2, 1.2)
        slip = Slip(*velocity, *rates, speed)
        particle = velocity + np.cross(rates, place)
        np.testing.assert_allclose(slip_velocity(slip, *place), particle, atol=1e-14)
        normal = np.array([0.0, math.sin(angle), math.cos(angle)])
        tangent = np.cross(normal, [1.0, 0.0, 0.0])
        creep = creepage_at(slip, *place, normal[1], normal[2])
        spin = math.copysign(1.0, velocity[0]) * (rates @ normal)
        wanted = np.array([particle[0], particle @ tangent, spin]) / speed
        np.testing.assert_allclose([creep.x, creep.y, creep.spin], wanted, atol=1e-14)
