"""Rolling radii and conicity of unlike wheels in closed form: what EN 15302's pairs are made of.

Wheels of straight pieces on rail heads of one arc of radius R, tape circles over the rails' middles
at +-b. A line z = c + g y of the wheel, shifted by y towards its field side's opposite (left wheel,
y to the left), is nearest to the arc where the slopes agree, R sin(atan g) beside the middle:

    distance c - g y + R - R/cos(atan g),    radius r0 - c + g (y + R sin(atan g)).

With a level axle each wheel alone takes the line of the least distance. So Delta_r is straight
between steps, and e r0 y'' = -Delta_r is a harmonic oscillation in each piece: Delta_r = s u with
u = 0 where the piece (prolonged) vanishes has the angular rate sqrt(s/(e r0)). Here e = r0 = 1.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from exudyn_wheelset import Profile, Track, Wheelset
from exudyn_wheelset.geometry.conicity import equivalent_conicity, kinematic_oscillation
from exudyn_wheelset.geometry.rolling_radius import (
    level_contact_geometry,
    rolling_radius_curve,
    rolling_radius_difference,
)
from exudyn_wheelset.profiles import shapes

ARC, HALF, RADIUS = 0.08, 0.75, 0.46
TREAD, THROAT, KINK = 0.025, 0.15, 8.0e-3
# The profile is a spline through points 0.05 mm apart and the search ends within 1e-12 m.
RADIUS_ERROR = 2.0e-9
GRID = 1.0e-5 * np.arange(-1000, 1001)


def arc_rail() -> Track:
    angle = np.linspace(-0.45, 0.45, 1801)
    rail = Profile("arc", "rail", ARC * np.sin(angle), ARC * (np.cos(angle) - 1.0))
    return Track(rail, inclination=0.0, origin_half_distance=HALF)


def stepped_wheel() -> Profile:
    """Slope TREAD on the tread, THROAT beyond y = -KINK: the arc goes over before the kink."""
    y = np.linspace(-0.06, 0.06, 2401)
    return Profile(
        "stepped", "wheel", y, np.minimum(TREAD * y, TREAD * -KINK + THROAT * (y + KINK))
    )


def wheelset(left: Profile, right: Profile | None = None, right_radius: float | None = None):
    return Wheelset(1000.0, (600.0, 100.0, 600.0), RADIUS, left, HALF, right, right_radius)


def growth(slope: float, shift: np.ndarray) -> np.ndarray:
    """Rolling radius of a line through the tape circle less r0, over its wheel's shift outwards."""
    return slope * (shift + ARC * math.sin(math.atan(slope)))


def step_shift() -> float:
    """Shift at which both lines of the stepped wheel are equally far from the arc."""
    rise = 1.0 / math.cos(math.atan(THROAT)) - 1.0 / math.cos(math.atan(TREAD))
    return KINK - ARC * rise / (THROAT - TREAD)


def stepped_growth(shift: np.ndarray) -> np.ndarray:
    beyond = growth(THROAT, shift) - KINK * (THROAT - TREAD)
    return np.where(shift < step_shift(), growth(TREAD, shift), beyond)


def conicity_of(wavelength: float) -> float:
    return 2.0 * (math.pi / wavelength) ** 2


def level(*arguments) -> np.ndarray:
    return rolling_radius_difference(wheelset(*arguments), arc_rail(), GRID, neglect_roll=True)


def test_cones_of_two_slopes() -> None:
    """Delta_r = (g_l + g_r) y + const: the mean conicity about a rest beside the middle."""
    left, right = 0.05, 0.12
    difference = level(shapes.cone(left), shapes.cone(right))
    wanted = growth(left, GRID) - growth(right, -GRID)
    np.testing.assert_allclose(difference, wanted, atol=RADIUS_ERROR)
    motion = kinematic_oscillation(GRID, difference, 3.0e-3)
    assert motion.conicity == pytest.approx(0.5 * (left + right), rel=1e-5)
    rest = (growth(right, 0.0) - growth(left, 0.0)) / (left + right)
    assert 0.5 * (motion.lowest + motion.highest) == pytest.approx(rest, abs=1e-7)


def test_wheels_of_different_diameter() -> None:
    """The larger right wheel moves the rest to the left by d/(2 g) and leaves the conicity."""
    slope, larger = 0.1, 4.0e-4
    difference = level(shapes.cone(slope), None, RADIUS + larger)
    np.testing.assert_allclose(difference, 2.0 * slope * GRID - larger, atol=RADIUS_ERROR)
    motion = kinematic_oscillation(GRID, difference, 4.0e-3)
    assert motion.conicity == pytest.approx(slope, rel=1e-5)
    assert 0.5 * (motion.lowest + motion.highest) == pytest.approx(0.5 * larger / slope, abs=1e-7)


def test_wheel_with_a_step_in_slope() -> None:
    """Two like wheels: tread on tread within the step, throat on tread beyond it."""
    difference = level(stepped_wheel())
    away = np.abs(np.abs(GRID) - step_shift()) > 1.0e-6
    wanted = stepped_growth(GRID) - stepped_growth(-GRID)
    np.testing.assert_allclose(difference[away], wanted[away], atol=RADIUS_ERROR)

    step = step_shift()
    inner, outer = 2.0 * TREAD, TREAD + THROAT
    start = float(stepped_growth(step + 1e-15) - stepped_growth(-step - 1e-15)) / outer
    amplitudes = np.array([1.0, 3.0, 6.5, 8.0, 9.0]) * 1e-3
    conicity = equivalent_conicity(GRID, difference, amplitudes)
    for amplitude, value in zip(amplitudes, conicity, strict=True):
        if amplitude < step:
            # A dead straight tread has the conicity of its cone.
            assert value == pytest.approx(TREAD, rel=1e-5)
            continue
        end = amplitude - step + start
        speed = math.sqrt(outer * (end**2 - start**2))
        quarter = math.acos(start / end) / math.sqrt(outer)
        quarter += math.atan(step * math.sqrt(inner) / speed) / math.sqrt(inner)
        # The step lies somewhere in a cell of 10 um of the data.
        assert value == pytest.approx(conicity_of(4.0 * quarter), rel=5e-3)
    assert step < 8.0e-3


def test_contact_points_of_a_level_axle() -> None:
    """Places, angles, radii and heights of unlike wheels, and the other line near the step."""
    cone, shift = 0.12, step_shift() - 2.0e-5
    body = wheelset(stepped_wheel(), shapes.cone(cone), RADIUS + 3.0e-4)
    geometry = level_contact_geometry(body, arc_rail(), [shift])
    tread, throat = (ARC * math.sin(math.atan(slope)) for slope in (TREAD, THROAT))
    left, right = geometry.left, geometry.right
    other = ARC * math.sin(math.atan(cone))
    wanted = [
        (left.wheel_y, -tread - shift), (left.rail_y, -tread), (left.angle, math.atan(TREAD)),
        (left.radius, RADIUS + TREAD * (tread + shift)), (left.lead, 0.0),
        (left.second_wheel_y, -throat - shift), (left.second_rail_y, -throat),
        (right.wheel_y, shift - other), (right.rail_y, -other), (right.angle, math.atan(cone)),
        (right.radius, RADIUS + 3.0e-4 + cone * (other - shift)), (right.lead, 0.0),
    ]  # fmt: skip
    for found, value in wanted:
        assert found[0] == pytest.approx(value, abs=5e-8)
    # The throat's line comes nearer by the slopes' difference over the shift left to the step.
    assert left.second_gap[0] == pytest.approx(2.0e-5 * (THROAT - TREAD), abs=2e-9)
    assert np.isnan(right.second_gap[0])
    # Each wheel alone is lifted by its distance c - g y + R - R/cos; z is the mean of both.
    lifts = [
        TREAD * shift + ARC * (1.0 / math.cos(math.atan(TREAD)) - 1.0),
        -cone * shift + ARC * (1.0 / math.cos(math.atan(cone)) - 1.0) + 3.0e-4,
    ]
    assert geometry.z[0] == pytest.approx(0.5 * sum(lifts), abs=2e-9)
    assert geometry.roll[0] == 0.0 and geometry.yaw[0] == 0.0
    assert geometry.y[0] == shift


def test_stepped_wheel_beside_a_cone() -> None:
    """The oscillation turns at unlike distances from the rest: half a sine to the right."""
    cone = 0.05
    difference = level(stepped_wheel(), shapes.cone(cone))
    away = np.abs(GRID - step_shift()) > 1.0e-6
    wanted = stepped_growth(GRID) - growth(cone, -GRID)
    np.testing.assert_allclose(difference[away], wanted[away], atol=RADIUS_ERROR)

    step, inner, outer = step_shift(), TREAD + cone, THROAT + cone
    rest = (growth(cone, 0.0) - growth(TREAD, 0.0)) / inner
    start = float(stepped_growth(step + 1e-15) - growth(cone, -step)) / outer
    for depth in (7.5e-3, 8.5e-3):
        speed = depth * math.sqrt(inner)
        at_step = math.sqrt(speed**2 - inner * (step - rest) ** 2)
        end = math.sqrt(start**2 + at_step**2 / outer)
        half = 0.5 * math.pi / math.sqrt(inner)
        half += math.asin(math.sqrt(inner) * (step - rest) / speed) / math.sqrt(inner)
        half += math.acos(start / end) / math.sqrt(outer)
        lowest, highest = rest - depth, step + end - start
        motion = kinematic_oscillation(GRID, difference, 0.5 * (highest - lowest), 1.0, 1.0)
        assert motion.lowest == pytest.approx(lowest, abs=2e-5)
        assert motion.highest == pytest.approx(highest, abs=2e-5)
        assert motion.conicity == pytest.approx(conicity_of(2.0 * half), rel=5e-3)


@pytest.mark.parametrize(("left", "right"), [(0.05, 0.05), (0.03, 0.08)])
def test_rolling_cones_at_rail_level_and_at_the_axle(left: float, right: float) -> None:
    """Both wheels stay on their rails: b roll = g y_rail with the mean slope g of the cones.

    The contact moves on the rails by R roll, so the radii differ by 2 g (1 + R g/b) y_rail; the
    axle's centre has moved by y_rail - r0 roll = (1 - r0 g/b) y_rail only. Each to first order in
    the slopes: what is left out is of second order, below (g_l + g_r)^2, and curved over y.
    """
    mean = 0.5 * (left + right)
    body, track = wheelset(shapes.cone(left), shapes.cone(right)), arc_rail()
    at_rail = mean * (1.0 + ARC * mean / HALF)
    wanted = {
        "rail": at_rail,
        "axle": at_rail / (1.0 - RADIUS * mean / HALF),
        "level": mean,
    }
    found = {}
    for shift, value in wanted.items():
        curve = rolling_radius_curve(body, track, 1.0e-2, shift=shift)
        found[shift] = equivalent_conicity(curve.y, curve.rolling_radius_difference, 3.0e-3)
        assert found[shift] == pytest.approx(value, rel=(left + right) ** 2)
    # Three per cent lie between rail and axle: what is told apart is far more than the tolerance.
    assert found["axle"] / found["rail"] == pytest.approx(1 + RADIUS * mean / HALF, rel=3e-3)


def test_shift_at_rail_level_is_where_the_wheels_stand() -> None:
    """y + r0 roll, with the mean of both radii."""
    body = wheelset(shapes.cone(0.05), shapes.cone(0.1), RADIUS + 2e-3)
    rail = rolling_radius_curve(body, arc_rail(), 5.0e-3)
    axle = rolling_radius_curve(body, arc_rail(), 5.0e-3, shift="axle")
    np.testing.assert_array_equal(axle.y, axle.geometry.y)
    np.testing.assert_allclose(rail.y - axle.y, (RADIUS + 1e-3) * axle.geometry.roll, atol=1e-15)
    np.testing.assert_array_equal(rail.rolling_radius_difference, axle.rolling_radius_difference)
