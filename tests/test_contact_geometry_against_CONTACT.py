"""Rigid contact geometry against the program CONTACT and against closed forms.

contact_geometry_S1002_UIC60.csv: solved by CONTACT at 1 N a wheel, the rigid limit. Its tolerances
are those with which a second rigid search agrees, and room for how a profile is interpolated. At
y = 0 the contact lies on the flat joint of two arcs, where a micrometre of height moves it by
tenths of a millimetre.

A cone on circular rail heads has a closed form in the roll angle (`cone_on_circles`).
"""

import csv
import math
from pathlib import Path

import numpy as np
import pytest

from exudyn_wheelset import (
    Profile,
    Track,
    Wheelset,
    WheelsetError,
    contact_geometry,
    piecewise_geometry,
)
from exudyn_wheelset.errors import ContactError
from exudyn_wheelset.profiles import shapes

REFERENCE = Path(__file__).parent / "reference" / "contact_geometry_S1002_UIC60.csv"
ROWS = [
    {name: value if name == "side" else float(value) for name, value in row.items()}
    for row in csv.DictReader(REFERENCE.read_text(encoding="utf-8").splitlines())
]
RADIUS = 0.46
HALF_DISTANCE = 0.75


def wheelset_of(wheel):
    return Wheelset(mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=RADIUS, wheel=wheel)


@pytest.fixture(scope="module")
def s1002():
    return wheelset_of("S1002")


@pytest.fixture(scope="module")
def uic60():
    return Track(rail="UIC60")


def circular_rail(radius):
    """A track whose rail heads are circles of `radius` [m], tops at +-HALF_DISTANCE."""
    half_width = min(0.04, 0.95 * radius)
    angle = np.linspace(-1.0, 1.0, 1601) * math.asin(half_width / radius)
    head = Profile("circle", "rail", radius * np.sin(angle), radius * (np.cos(angle) - 1.0))
    return Track(rail=head, inclination=0.0, datum_half_distance=HALF_DISTANCE)


def cone_on_circles(angle, head_radius, roll):
    """Exact pose and contact of a cone on circular heads: (y, z, sides).

    In the section at yaw 0 both generators of the wheelset touch circles with centres at
    (+-G, -R). With the circles' centres turned into the wheelset's frame, the difference and the
    sum of the two conditions of tangency are linear in y and the centre's height. sides: for left
    and right (wheel_y, rail_y, contact angle, rolling radius).
    """
    lean = HALF_DISTANCE * np.sin(roll) / math.tan(angle)
    rise = RADIUS + (
        head_radius - math.sin(angle) * HALF_DISTANCE * (np.cos(roll) - 1.0)
    ) / math.cos(angle)
    y = lean * np.cos(roll) - rise * np.sin(roll)
    height = lean * np.sin(roll) + rise * np.cos(roll)
    sides = []
    for side in (1.0, -1.0):
        across = side * HALF_DISTANCE - y
        along_axle = side * (np.cos(roll) * across - np.sin(roll) * height)
        below = -np.sin(roll) * across - np.cos(roll) * height + RADIUS
        along = math.cos(angle) * (along_axle - HALF_DISTANCE) + math.sin(angle) * below
        wheel_y = along * math.cos(angle)
        slope = angle + side * roll
        sides.append(
            (
                wheel_y,
                -head_radius * np.sin(slope),
                slope,
                RADIUS - wheel_y * math.tan(angle),
            )
        )
    return y, height - head_radius - RADIUS, sides


@pytest.mark.parametrize("method", ["root", "nelder-mead"])
@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{1e3 * row['y_m']:g}mm-{row['side']}")
def test_rows_of_CONTACT(s1002, uic60, method, row):
    geometry = contact_geometry(s1002, uic60, [row["y_m"]], method=method)
    side = getattr(geometry, row["side"])
    position = 1e-4 if row["y_m"] == 0.0 else 2e-5
    assert geometry.roll[0] == pytest.approx(row["roll_rad"], abs=2e-6)
    assert geometry.z[0] == pytest.approx(row["z_m"], abs=2e-6)
    assert side.wheel_y[0] == pytest.approx(row["wheel_y_m"], abs=position)
    assert side.rail_y[0] == pytest.approx(row["rail_y_m"], abs=position)
    # The steepest curvature in contact is that of the 13 mm gauge corner: 0.02 mm turn the
    # contact plane by 1.5 mrad and, on a flange of 60 degrees, change the radius by 0.04 mm.
    assert side.angle[0] == pytest.approx(row["contact_angle_rad"], abs=1.5e-3)
    assert side.radius[0] == pytest.approx(row["rolling_radius_m"], abs=4e-5)


def test_datum_of_the_inclined_rail_from_its_arcs(uic60):
    turn = math.atan(1 / 40)

    def turned(y, z):
        return (
            math.cos(turn) * y - math.sin(turn) * z,
            math.sin(turn) * y + math.cos(turn) * z,
        )

    head, top = turned(0.0, -0.3)
    corner_y, corner_z = turned(-23.01622e-3, -14.90893e-3)
    gauge_level = top + 0.3 - 0.014
    gauge_point = corner_y - math.sqrt(0.013**2 - (gauge_level - corner_z) ** 2)
    # A micrometre of the datum is a slope of 3e-6 at the flat top of radius 300 mm.
    expected = 0.5 * 1.435 - gauge_point + head
    assert uic60.left_placement.datum_y == pytest.approx(expected, abs=2e-7)


def test_both_methods_agree_between_the_rows(s1002, uic60):
    y = np.linspace(-9.7e-3, 9.7e-3, 41)
    root = contact_geometry(s1002, uic60, y)
    simplex = contact_geometry(s1002, uic60, y, method="nelder-mead")
    # The simplex ends at 1e-12 rad; a contact on a head of radius 0.3 m moves by less than 1e-9 m.
    assert np.abs(root.roll - simplex.roll).max() < 1e-10
    assert np.abs(root.z - simplex.z).max() < 1e-10
    assert np.abs(root.left.wheel_y - simplex.left.wheel_y).max() < 1e-8


@pytest.mark.parametrize("yaw", [0.0, 0.02])
def test_the_mirrored_wheelset_has_the_mirrored_contact(s1002, uic60, yaw):
    y = np.linspace(-0.01, 0.01, 401)
    one = contact_geometry(s1002, uic60, y, yaw)
    other = contact_geometry(s1002, uic60, -y, -yaw)
    assert np.abs(one.roll + other.roll).max() < 1e-12
    assert np.abs(one.z - other.z).max() < 1e-14
    for name in ("wheel_y", "rail_y", "angle", "radius", "lead"):
        difference = getattr(one.left, name) - getattr(other.right, name)
        # Both roots end within 1e-13 rad; the contact point moves by metres a radian.
        assert np.abs(difference).max() < 1e-10, name


@pytest.mark.parametrize(
    ("angle", "head_radius"), [(0.05, 0.3), (0.025, 0.3), (0.1, 0.08), (0.05, 0.001)]
)
def test_cone_on_circular_rails(angle, head_radius):
    wheelset = wheelset_of(shapes.cone(math.tan(angle)))
    if head_radius == 0.001:
        track = Track(
            rail=shapes.knife_edge(head_radius),
            inclination=0.0,
            datum_half_distance=HALF_DISTANCE,
        )
    else:
        track = circular_rail(head_radius)
    roll = np.linspace(-1.0, 1.0, 9) * min(4e-4, 0.05 * angle)
    y, z, sides = cone_on_circles(angle, head_radius, roll)
    geometry = contact_geometry(wheelset, track, y)
    # Profiles are cubics over 0.1 mm of arc: nanometres in height, some more on the ridge of 1 mm
    # radius; along a head of radius R a slope error of 1e-6 shifts the contact by R 1e-6.
    assert np.abs(geometry.roll - roll).max() < 1e-8
    assert np.abs(geometry.z - z).max() < (3e-8 if head_radius == 0.001 else 5e-9)
    for side, (wheel_y, rail_y, slope, radius) in zip(
        (geometry.left, geometry.right), sides, strict=True
    ):
        assert np.abs(side.wheel_y - wheel_y).max() < 2e-6
        assert np.abs(side.rail_y - rail_y).max() < 2e-6
        assert np.abs(side.angle - slope).max() < 1e-7
        assert np.abs(side.radius - radius).max() < 2e-6 * angle


@pytest.mark.parametrize("angle", [0.025, 0.05, 0.1])
def test_effective_conicity_of_a_cone_on_a_round_head(angle):
    head_radius = 0.3
    geometry = contact_geometry(
        wheelset_of(shapes.cone(math.tan(angle))), circular_rail(head_radius), [0.0, 1e-4]
    )
    half_distance = HALF_DISTANCE + geometry.left.rail_y[0]
    conicity = 0.5 * geometry.rolling_radius_difference[1] / 1e-4
    expected = angle * (half_distance + head_radius * angle) / (half_distance - RADIUS * angle)
    # The formula takes sin and tan of the angle for the angle itself: first order, wrong by
    # (tan d - d)/d = d^2/3 in the conicity and by less in the two brackets.
    assert conicity == pytest.approx(expected, rel=0.5 * angle**2)


def test_knife_edge_is_the_limit_of_the_formula():
    """On a knife-edge the effective conicity is d g_a/(g_a - r0 d)."""
    angle = 0.05
    track = Track(rail=shapes.knife_edge(1e-3), inclination=0.0, datum_half_distance=HALF_DISTANCE)
    geometry = contact_geometry(wheelset_of(shapes.cone(math.tan(angle))), track, [0.0, 1e-4])
    conicity = 0.5 * geometry.rolling_radius_difference[1] / 1e-4
    expected = angle * HALF_DISTANCE / (HALF_DISTANCE - RADIUS * angle)
    # The edge's own radius adds R d/g_a, 7e-5; the rest is of second order in the angle.
    assert conicity == pytest.approx(expected, rel=0.5 * angle**2)


def test_two_points_touch_where_the_contact_jumps(s1002, uic60):
    low, high = 4.7e-3, 4.9e-3
    for _ in range(24):
        middle = 0.5 * (low + high)
        if contact_geometry(s1002, uic60, [middle]).left.wheel_y[0] > -0.023:
            low = middle
        else:
            high = middle
    y = np.array([low - 2e-5, low, high, high + 2e-5])
    geometry = contact_geometry(s1002, uic60, y)
    assert geometry.double_point_contact().tolist() == [False, True, True, False]
    left = geometry.left
    # On either side of the jump the runner-up is the point that carries on the other.
    assert left.wheel_y[1] - left.wheel_y[2] > 0.01
    assert left.second_wheel_y[1] == pytest.approx(left.wheel_y[2], abs=1e-8)
    assert left.second_wheel_y[2] == pytest.approx(left.wheel_y[1], abs=1e-8)
    assert np.all(left.second_gap[1:3] >= 0.0)
    # The bracket is 1e-11 m wide and the distances differ in slope by a few tenths.
    assert left.second_gap[1:3].max() < 1e-11
    assert geometry.roll[1] == pytest.approx(geometry.roll[2], abs=1e-11)


@pytest.mark.parametrize("wheel", ["S1002", "AAR_1_20"])
def test_pieces_are_cut_at_the_jumps(wheel):
    wheelset, track = wheelset_of(wheel), Track(rail="UIC60", gauge=1.432)
    pieces = piecewise_geometry(wheelset, track, half_range=0.011)
    assert len(pieces.jumps) > 0
    # Where the contact goes over by a fold the shift is defined to some tens of nanometres.
    assert pieces.jumps == pytest.approx(-pieces.jumps[::-1], abs=1e-7)
    for jump in pieces.jumps:
        beside = contact_geometry(wheelset, track, [jump - 1e-7, jump + 1e-7])
        moved = [np.ptp(side.wheel_y) for side in (beside.left, beside.right)]
        assert max(moved) > 1e-4
    between = np.linspace(-10.9e-3, 10.9e-3, 477)
    away = np.abs(between[:, None] - pieces.jumps).min(axis=1) > 1e-6
    exact = contact_geometry(wheelset, track, between[away])
    # Cubics over 0.05 mm; where the contact crosses a joint of arcs on the flange, the roll
    # angle (some mrad there) bends within one of them.
    assert np.abs(pieces(between[away])[:, 0] - exact.roll).max() < 2e-5
    assert np.abs(pieces(between[away])[:, 1] - exact.z).max() < 2e-5
    tread = away & (np.abs(between) < 4e-3)
    exact = contact_geometry(wheelset, track, between[tread])
    assert np.abs(pieces(between[tread])[:, 0] - exact.roll).max() < 2e-8
    assert np.abs(pieces(between[tread])[:, 1] - exact.z).max() < 2e-8


def test_the_contact_is_the_one_reached_from_the_centre():
    """Near a fold of a steep flange several roll angles fit: neighbours must not choose."""
    wheelset, track = wheelset_of("AAR_1_20"), Track(rail="UIC60", gauge=1.432)
    y = np.linspace(-0.0115, 0.0115, 93)
    together = contact_geometry(wheelset, track, y)
    alone = [contact_geometry(wheelset, track, [shift]).roll[0] for shift in y]
    assert together.roll == pytest.approx(np.array(alone), abs=1e-9)
    assert together.roll == pytest.approx(-together.roll[::-1], abs=1e-9)
    assert np.all(np.diff(together.roll) > 0.0)


@pytest.mark.parametrize("y", [-0.1, 0.1, 0.5])
def test_a_wheel_beside_its_rail_is_an_error(s1002, uic60, y):
    with pytest.raises(ContactError, match="left its rail"):
        contact_geometry(s1002, uic60, [0.0, y])


@pytest.mark.parametrize("arguments", [([np.nan],), ([np.inf],), ([0.0], np.nan), ([0.0], 2.0)])
def test_numbers_that_no_position_has_are_errors(s1002, uic60, arguments):
    with pytest.raises(WheelsetError):
        contact_geometry(s1002, uic60, *arguments)


def test_unknown_method_is_an_error(s1002, uic60):
    with pytest.raises(WheelsetError, match="nelder-mead"):
        contact_geometry(s1002, uic60, [0.0], method="simplex")
