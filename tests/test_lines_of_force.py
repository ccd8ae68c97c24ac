"""Penetration on the rail's normals and the loads on it, against slow geometry and mechanics.

The wheel as a cloud of points of a surface of revolution, cut by the rail's normals; lines of force
by virtual work.
"""

import numpy as np
import pytest
from rail_lines import CASES, LEFT, PLACES, POSES, TABLE, axle_of, converged, plain, wheel_depth

from exudyn_wheelset.contact import gap
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.layout import (
    GAP_ARC,
    GAP_DEPTH,
    LINE_BEND,
    LINE_TANGENT_Y,
    LINE_TANGENT_Z,
    LINE_Y,
    LINE_Z,
    LOBE,
    RESULT,
    block_row,
    new_result,
)


@pytest.mark.parametrize(("pose", "place"), CASES)
def test_depth_on_a_normal_of_the_rail(pose, place):
    axle = axle_of(*pose)
    depth, first, second, arc = converged(place, axle)
    assert depth == pytest.approx(wheel_depth(place, axle, arc), abs=1e-9)
    step = 2e-6
    before, after = (converged(place + s * step, axle, arc) for s in (-1.0, 1.0))
    assert first == pytest.approx((after[0] - before[0]) / (2.0 * step), abs=1e-6)
    assert second == pytest.approx(
        (after[1] - before[1]) / (2.0 * step), abs=1e-2 + 1e-3 * abs(second)
    )


@pytest.mark.parametrize(("pose", "place"), CASES)
def test_a_near_guess_leaves_an_error_of_third_order(pose, place):
    axle = axle_of(*pose)
    depth, _, _, arc = converged(place, axle)
    errors = []
    for guess in (1e-4, 2e-4):
        found = plain(gap.gap_on_normal)(TABLE, LEFT, place, arc + guess, axle)
        errors.append(abs(found[0] - depth))
    # Curvatures here change by less than 100 1/m in a millimetre: c' g^3 / 2.
    assert errors[0] < 1e-7
    assert errors[1] < 8.0 * 1e-7


@pytest.mark.parametrize(("pose", "place"), CASES)
def test_a_line_of_force_does_the_work_of_the_depth(pose, place):
    """A motion of the wheel takes dp = -(force . motion) from the penetration."""
    shift, yaw, roll = pose
    axle = axle_of(*pose)
    arc = converged(place, axle)[3]
    force = plain(gap.line_of_force)(TABLE, LEFT, place, arc, axle)
    step = 1e-6

    def rise(shifts=(0.0, 0.0), turned=(0.0, 0.0, 0.0)):
        values = []
        for sign in (1.0, -1.0):
            moved = axle_of(
                shift + sign * shifts[0], yaw, roll, 0.46 + sign * shifts[1],
                sign * np.array(turned),
            )  # fmt: skip
            values.append(converged(place, moved, arc)[0])
        return -(values[0] - values[1]) / (2.0 * step)

    found = [
        rise(shifts=(step, 0.0)), rise(shifts=(0.0, step)), rise(turned=(step, 0.0, 0.0)),
        rise(turned=(0.0, step, 0.0)), rise(turned=(0.0, 0.0, step)),
    ]  # fmt: skip
    np.testing.assert_allclose(force, found, atol=1e-6)


@pytest.mark.parametrize("pose", POSES)
def test_sampling_and_pushing_many_lines_is_one_by_one(pose):
    axle = axle_of(*pose)
    spacing, start = LEFT.line_spacing, LEFT.line_start
    rows = new_result().view(RESULT)[0].work.gap
    rng = np.random.default_rng(4)
    for place in PLACES[1:3]:
        node = round((place - start) / spacing)
        lobe = np.zeros(1, LOBE)[0]
        lobe.foot = start + node * spacing
        lobe.arc = converged(lobe.foot, axle)[3] + 2e-4
        first, end = node - 4, node + 5
        plain(gap.sample_gap)(TABLE, LEFT, lobe, first, end, axle, rows)
        expected = np.zeros(5)
        weights = rng.uniform(-1.0, 1.0, end - first)
        for k, weight in zip(range(first, end), weights, strict=True):
            guess = start + k * spacing + lobe.arc - lobe.foot
            at = start + k * spacing
            depth, _, _, arc = plain(gap.gap_on_normal)(TABLE, LEFT, at, guess, axle)
            assert rows[GAP_DEPTH, k] == pytest.approx(depth, abs=1e-13)
            assert rows[GAP_ARC, k] == pytest.approx(arc, abs=1e-13)
            line = plain(gap.line_of_force)(TABLE, LEFT, at, rows[GAP_ARC, k], axle)
            expected += weight * np.array(line)
        wrench = np.zeros(5)
        plain(gap.push_on_lines)(TABLE, LEFT, first, weights, axle, rows, wrench)
        np.testing.assert_allclose(wrench, expected, atol=1e-12)


def test_beside_its_profiles_a_wheel_and_a_rail_go_on_straight():
    """Penetration far outside is that of the end's tangents: linear in the place."""
    axle = axle_of(*POSES[0])
    rows = new_result().view(RESULT)[0].work.gap
    lobe = np.zeros(1, LOBE)[0]
    lobe.foot = LEFT.line_start
    lobe.arc = -0.02
    plain(gap.sample_gap)(TABLE, LEFT, lobe, 0, 12, axle, rows)
    for k in range(12):
        at = LEFT.line_start + k * LEFT.line_spacing
        found = plain(gap.gap_on_normal)(TABLE, LEFT, at, at + lobe.arc - lobe.foot, axle)
        assert rows[GAP_DEPTH, k] == pytest.approx(found[0], abs=1e-12)
    assert np.abs(np.diff(rows[GAP_DEPTH, :12], 2)).max() < 1e-12


def test_lines_follow_the_rail_and_go_on_straight_beyond_it():
    """Unit tangents, points a spacing apart along them, curvature of the turning tangent."""
    y, z, along_y, along_z, bend = (
        block_row(TABLE, LEFT.lines, row)
        for row in (LINE_Y, LINE_Z, LINE_TANGENT_Y, LINE_TANGENT_Z, LINE_BEND)
    )
    spacing = LEFT.line_spacing
    # Chords are h^2/24 of curvature squared short, on arcs of 13 mm and more; where arcs meet a
    # mean of tangents is h/8 of the change of curvature off.
    np.testing.assert_allclose(np.hypot(np.diff(y), np.diff(z)), spacing, rtol=2e-5)
    np.testing.assert_allclose(np.hypot(along_y, along_z), 1.0, rtol=1e-4)
    middle = 0.5 * (along_y[1:] + along_y[:-1]), 0.5 * (along_z[1:] + along_z[:-1])
    np.testing.assert_allclose(np.diff(y) / spacing, middle[0], atol=2e-3)
    np.testing.assert_allclose(np.diff(z) / spacing, middle[1], atol=2e-3)
    turning = np.diff(np.unwrap(np.arctan2(along_z, along_y))) / spacing
    mean = 0.5 * (bend[1:] + bend[:-1])
    assert np.median(np.abs(turning - mean)) < 0.05
    for end in (slice(0, 20), slice(-20, None)):
        assert np.all(bend[end] == 0.0)
        np.testing.assert_allclose(np.diff(along_z[end]), 0.0, atol=1e-12)
    for k in (30, 200, -30):
        at = LEFT.line_start + (k % len(y)) * spacing
        ry, r1, _, rz, q1, _ = plain(curve_point)(TABLE, LEFT.rail, at)
        found = y[k], z[k], along_y[k], along_z[k]
        np.testing.assert_allclose(found, (ry, rz, r1, q1), atol=1e-12)
