"""Profiles against the formulas of EN 13715 (S1002) and of the rail 60E1, and their derivatives."""

import math

import numpy as np
import pytest

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles import Profile, load_profile, shapes


def curvature_by_differences(height, y, step=2e-4):
    """Curvature from fourth-order central differences of a formula."""
    f = [height(y + k * step) for k in (-2, -1, 0, 1, 2)]
    first = (f[0] - 8 * f[1] + 8 * f[3] - f[4]) / (12 * step)
    second = (-f[0] + 16 * f[1] - 30 * f[2] + 16 * f[3] - f[4]) / (12 * step**2)
    return second / (1 + first**2) ** 1.5


def away_from(y, junctions, distance=1.5e-3):
    return y[np.min(np.abs(y[:, None] - np.asarray(junctions)), axis=1) > distance]


S1002_JUNCTIONS = 1e-3 * np.array(
    [-70, -62.764705882, -49.662510381, -39.764473993, -38.426669071, -35, -26, 32.15796, 60]
)


def test_s1002_file_height():
    """Within a nanometre of the formula; at junctions, what a curvature jump k makes of a cubic.

    That is k h^2/8 for points h = 0.1 mm apart, 2.4e-7 m for the sharpest one, and the two steps
    of the formula itself are 3.7e-8 and 1.2e-7 m.
    """
    profile = load_profile("S1002")
    y = np.linspace(-0.0695, 0.06, 7001)
    error = np.abs(profile.height(y) - shapes.s1002_height(y))
    assert np.max(error) < 2.4e-7
    smooth = np.min(np.abs(y[:, None] - S1002_JUNCTIONS), axis=1) > 2e-3
    assert np.max(error[smooth]) < 1e-9


def test_s1002_flange_tip_is_28_mm_below_the_tread():
    profile = load_profile("S1002")
    assert profile.height(-0.055) == pytest.approx(-0.028, abs=1e-9)


def test_s1002_flange_is_70_degrees():
    profile = load_profile("S1002")
    assert math.degrees(math.atan(profile.slope(-0.039))) == pytest.approx(70.0, abs=0.01)


def test_s1002_curvature_is_the_formulas():
    profile = load_profile("S1002")
    y = away_from(np.linspace(-0.0655, 0.0585, 2000), S1002_JUNCTIONS)
    steep = np.abs(profile.slope(y)) > 5.0
    y = y[~steep]
    exact = curvature_by_differences(shapes.s1002_height, y)
    # 1 % of the curvature, or of that of a rail's flattest part (1/0.3 m) where it is less.
    assert np.all(np.abs(profile.curvature(y) - exact) < 0.01 * np.maximum(np.abs(exact), 3.3))


@pytest.mark.parametrize(
    "low, high, radius",
    [(-9.9, 9.9, 0.3), (11.1, 25.4, 0.08), (-25.4, -11.1, 0.08), (26.6, 34.0, 0.013)],
)
def test_uic60_radii(low, high, radius):
    curvature = load_profile("UIC60").curvature(1e-3 * np.linspace(low, high, 301))
    assert curvature == pytest.approx(-1.0 / radius, rel=0.01)


def test_uic60_junctions():
    """Depths of the junctions as given, rounded to 1e-5 mm in y; the flank's slope is 20."""
    profile = load_profile("UIC60")
    depth = [0.1838e-3, 2.2531e-3, 14.2597e-3]
    assert -profile.height([10.5e-3, 25.988e-3, 36.0e-3 - 1e-9]) == pytest.approx(depth, abs=6e-7)
    assert profile.slope(0.0365) == pytest.approx(-20.0, rel=1e-4)


def test_uic60_is_symmetric():
    profile = load_profile("UIC60")
    y = np.linspace(0.0, 0.036, 500)
    assert profile.height(y) == pytest.approx(profile.height(-y), abs=1e-12)


def test_aar_pieces_are_tangent_and_of_the_stated_size():
    inch = 0.0254
    profile = load_profile("AAR_1_20")
    assert np.min(profile.z) == pytest.approx(-1.0 * inch, abs=2e-7)
    assert profile.slope(np.linspace(-0.028, 0.058, 50)) == pytest.approx(0.05, abs=3e-7)
    slopes = profile.slope(np.linspace(-0.0555, 0.0, 4000))
    assert math.degrees(math.atan(np.max(slopes))) == pytest.approx(75.0, abs=0.03)
    throat = profile.curvature(np.linspace(-0.0445, -0.0335, 50))
    assert throat == pytest.approx(-1.0 / (11.0 / 16.0 * inch), rel=0.01)
    back = -(2 + 27 / 32) * inch
    assert profile.height(back + 37.0 / 32.0 * inch) == pytest.approx(-3.0 / 8.0 * inch, abs=1e-9)
    # The step between neighbouring tangents of the points stays that of the tightest arc.
    turn = np.diff(np.arctan2(np.diff(profile.z), np.diff(profile.y)))
    assert np.max(np.abs(turn)) < 1.05 * 1e-4 / 0.0114


def test_aar_wide_flange():
    inch = 0.0254
    wide = shapes.aar_1_20(flange_thickness=1.375 * inch, tape_from_flange_back=(3 + 1 / 16) * inch)
    assert np.min(wide.z) == pytest.approx(-inch, abs=2e-7)
    with pytest.raises(ProfileError, match=r"overlap|not on the flange"):
        shapes.aar_1_20(flange_height=0.012)


@pytest.mark.parametrize("name", ["cone_0.05", "Cone-1-20", "cone_1_20", "cone 1:20", "CONE_.05"])
def test_cone_radius_grows_towards_the_flange(name):
    profile = load_profile(name)
    y = np.linspace(-0.07, 0.06, 57)
    assert profile.height(y) == pytest.approx(0.05 * y, abs=1e-12)
    assert profile.curvature(y) == pytest.approx(0.0, abs=0.02)


def test_cone_of_any_conicity():
    assert load_profile("cone_0.1234").slope(0.0) == pytest.approx(0.1234, abs=1e-12)
    assert load_profile("cone_1_40").slope(0.0) == pytest.approx(0.025, abs=1e-12)


def test_knife_edge():
    profile = load_profile("knife_edge")
    assert profile.kind == "rail"
    assert profile.curvature(np.linspace(-8e-4, 8e-4, 20)) == pytest.approx(-1000.0, rel=0.01)


def test_arc_table_runs_along_the_curve():
    profile = load_profile("S1002")
    table = profile.arc_table(1e-4)
    assert table.coefficients.shape[1] == 8
    u = 0.37 * table.ds
    powers = u ** np.arange(4)
    y, z = table.coefficients[:, :4] @ powers, table.coefficients[:, 4:] @ powers
    inner = (y > -0.0695) & (y < 0.0599)
    # Second nodes within a step of a junction repeat its k h^2/8 (see test_s1002_file_height).
    assert profile.height(y[inner]) == pytest.approx(z[inner], abs=2.4e-7)
    first = np.array([0.0, 1.0, 2.0 * u, 3.0 * u**2])
    speed = np.hypot(table.coefficients[:, :4] @ first, table.coefficients[:, 4:] @ first)
    assert speed == pytest.approx(1.0, abs=1e-6)
    second = np.array([0.0, 0.0, 2.0, 6.0 * u])
    ty, tz = table.coefficients[:, :4] @ first, table.coefficients[:, 4:] @ first
    curvature = ty * (table.coefficients[:, 4:] @ second) - tz * (
        table.coefficients[:, :4] @ second
    )
    smooth = inner & np.array([np.min(np.abs(v - S1002_JUNCTIONS)) > 1.5e-3 for v in y])
    exact = profile.curvature(y[smooth])
    assert np.all(np.abs(curvature[smooth] - exact) < 0.01 * np.maximum(np.abs(exact), 3.3))


def test_arc_length_of_a_cone_is_exact():
    table = load_profile("cone_1_20").arc_table()
    assert table.length == pytest.approx(0.13 * math.hypot(1.0, 0.05), abs=1e-13)


def test_outside_is_an_error():
    profile = load_profile("UIC60")
    for method in (profile.height, profile.slope, profile.curvature):
        for y in (0.05, -0.05, math.nan, math.inf):
            with pytest.raises(ProfileError, match="outside"):
                method([0.0, y])


def test_shape_is_kept():
    profile = load_profile("UIC60")
    assert profile.height(0.0).shape == ()
    assert profile.height(np.zeros((3, 4))).shape == (3, 4)
    assert profile.height([]).shape == (0,)


def test_inclined_rail_against_rotation_of_points():
    angle = math.atan(1 / 40)
    rail = load_profile("UIC60")
    inclined = rail.rotated(angle)
    y, z = 0.01, float(rail.height(0.01))
    turned = (math.cos(angle) * y - math.sin(angle) * z, math.sin(angle) * y + math.cos(angle) * z)
    assert inclined.height(turned[0]) == pytest.approx(turned[1], abs=1e-10)
    # Inclined towards the track centre, the top wanders to the field side (towards y > 0), because
    # the head turns about the point where it was horizontal.
    assert inclined.y[np.argmax(inclined.z)] == pytest.approx(0.3 * math.sin(angle), abs=1e-4)


def test_steeply_inclined_rail_loses_only_the_overhang():
    inclined = load_profile("UIC60").rotated(math.atan(1 / 20))
    assert "overhang" in inclined.remarks[-1]
    assert inclined.z[0] < -0.0158 and inclined.z[-1] < -0.03


def test_mirrored_twice_is_the_same():
    wheel = load_profile("S1002")
    there = wheel.mirrored()
    assert there.height(0.055) == pytest.approx(-0.028, abs=1e-9)
    back = there.mirrored()
    assert np.array_equal(back.y, wheel.y) and not back.is_mirrored


def test_a_profile_passes_through():
    profile = shapes.uic60()
    assert load_profile(profile) is profile
    assert isinstance(profile, Profile)
