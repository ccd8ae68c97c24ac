"""Penetration on the rail's normals and the loads on it, against slow geometry and mechanics.

The wheel as a cloud of points of a surface of revolution, cut by the rail's normals; lines of force
by virtual work; the equations of several loads as difference quotients of the energy written down
here; what they find is the greatest energy near by.
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from exudyn_wheelset import Track, Wheelset
from exudyn_wheelset.contact import gap, ritz
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.ellipsoids import mean_distance
from exudyn_wheelset.contact.gap_spline import _primitives
from exudyn_wheelset.contact.layout import (
    GAP_ARC,
    GAP_COEFFICIENT,
    GAP_DEPTH,
    GAP_FIRST,
    GAP_SECOND,
    GAP_THIRD,
    HEADER,
    LINE_BEND,
    LINE_TANGENT_Y,
    LINE_TANGENT_Z,
    LINE_Y,
    LINE_Z,
    LOAD,
    LOBE,
    RESULT,
    SIDE,
    Axle,
    block_row,
    new_result,
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


# Two shallow lobes 7 mm apart on the head, and what is written down of their energy.
MIDDLE = PLACES[2]


def depth_of_two(s):
    x = s - MIDDLE
    return 9e-5 - 2.2 * np.minimum((x + 3e-3) ** 2, 1.3 * (x - 4e-3) ** 2 + 1e-5 / 2.2)


def room(depth=depth_of_two):
    work = new_result().view(RESULT)[0].work
    count = 140
    start = round((MIDDLE - LEFT.line_start) / LEFT.line_spacing) - 70
    at = slice(start, start + count)
    work.gap[GAP_DEPTH, at] = depth(
        LEFT.line_start + LEFT.line_spacing * np.arange(start, start + count)
    )
    plain(_primitives)(
        work.gap[GAP_DEPTH, at], work.gap[GAP_COEFFICIENT, at], work.gap[GAP_FIRST, at],
        work.gap[GAP_SECOND, at], work.gap[GAP_THIRD, at],
    )  # fmt: skip
    return work, start + 2, start + count - 4


def loads_at(x, bounds):
    loads = np.zeros(len(x) // 3, LOAD)
    for k in range(len(loads)):
        loads[k].t, loads[k].b, loads[k].place = x[3 * k], math.exp(x[3 * k + 1]), x[3 * k + 2]
        loads[k].low, loads[k].high = bounds
    return loads


def written_down(x, work, bounds):
    """Equation (1): what the loads gain in the gap less what they and their fields take."""
    loads = loads_at(x, bounds)
    total = 0.0
    for load in loads:
        plain(ritz._look)(TABLE, LEFT, load, work, MODULUS)
        total += load.force * (load.average - load.work)
    for k, one in enumerate(loads):
        for two in loads[k + 1 :]:
            apart = two.place - one.place
            mean = plain(mean_distance)(apart, one.a**2, one.b**2, two.a**2, two.b**2, MODULUS)
            total -= one.force * two.force * mean
    return total


def equations(x, work, bounds):
    """Energy, matrix, right side; the loads as they are then."""
    loads = loads_at(x, bounds)
    for load in loads:
        plain(ritz._look)(TABLE, LEFT, load, work, MODULUS)
    total = plain(ritz._equations)(loads, len(loads), MODULUS, work)
    size = 3 * len(loads)
    return total, work.matrix[:size, :size].copy(), work.matrix[:size, size].copy(), loads


GUESSES = {
    "one": [0.4, math.log(4.1e-3), MIDDLE - 2.3e-3],
    "two": [0.4, math.log(3.1e-3), MIDDLE - 3.2e-3, 0.9, math.log(2.4e-3), MIDDLE + 4.3e-3],
    "two that overlap": [
        -0.5, math.log(3.1e-3), MIDDLE - 1.2e-3, 0.7, math.log(2.4e-3), MIDDLE + 2.3e-3,
    ],
    "three": [
        0.4, math.log(3.1e-3), MIDDLE - 3.2e-3, 0.9, math.log(1.4e-3), MIDDLE + 4.3e-3,
        0.2, math.log(1.8e-3), MIDDLE + 1.1e-3,
    ],
}  # fmt: skip


def steps_of(loads):
    """Steps for (t, ln b, place) of each load, in that order, load by load."""
    return np.array([[1e-4, 1e-4, 1e-4 * load.b] for load in loads]).ravel()


def by_kind(values):
    """From load by load to the kernels' order: all t, all ln b, all places."""
    return np.asarray(values).reshape(-1, 3).T.ravel()


@pytest.mark.parametrize("name", GUESSES)
def test_right_side_is_the_gradient_of_the_energy(name):
    x = np.array(GUESSES[name])
    work, *bounds = room()
    total, _, right, loads = equations(x, work, bounds)
    assert total == pytest.approx(written_down(x, work, bounds), rel=1e-12)
    gradient = []
    for k, step in enumerate(steps_of(loads)):
        ahead, behind = x.copy(), x.copy()
        ahead[k] += step
        behind[k] -= step
        rise = written_down(ahead, work, bounds) - written_down(behind, work, bounds)
        scale = loads[k // 3].force * (step if k % 3 < 2 else step / loads[k // 3].b)
        gradient.append(rise / (2.0 * scale))
    # The steps' error; a change of A along the rail twice over is left out.
    np.testing.assert_allclose(right, -by_kind(gradient), atol=2e-10)


@pytest.mark.parametrize("name", GUESSES)
def test_matrix_is_the_derivative_of_the_right_side(name):
    """Each row as it stands, over the load of its own; b in front of the third kind is kept."""
    x = np.array(GUESSES[name])
    work, *bounds = room()
    _, matrix, _, loads = equations(x, work, bounds)
    count = len(loads)
    columns = []
    for k, step in enumerate(steps_of(loads)):
        rows = []
        for sign in (1.0, -1.0):
            moved = x.copy()
            moved[k] += sign * step
            _, _, side, now = equations(moved, work, bounds)
            for j in range(count):
                side[2 * count + j] *= loads[j].b / now[j].b
            rows.append(side)
        unit = step if k % 3 < 2 else step / loads[k // 3].b
        columns.append(-(rows[0] - rows[1]) / (2.0 * unit))
    found = np.array(columns).reshape(count, 3, -1).transpose(1, 0, 2).reshape(3 * count, -1).T
    size = np.sqrt(np.abs(np.outer(np.diag(found), np.diag(found))))
    # Places of the quadrature held constant, and the change of A's own change: 2 % of the diagonal.
    assert np.all(np.abs(matrix - found) < 0.02 * size + 1e-9)


def test_elimination_solves_a_matrix_that_is_negative_and_leads_uphill_otherwise():
    rng = np.random.default_rng(8)
    loads = np.zeros(2, LOAD)
    for load in loads:
        load.force_by_t, load.own_by_t, load.width = 1e-3, 1e-3, 1e-3
    for trial in range(20):
        full = rng.normal(size=(6, 6))
        matrix = -(full @ full.T) - 0.1 * np.eye(6)
        right = rng.normal(size=6)
        work = np.column_stack([matrix, right])
        plain(ritz._solve)(loads, 2, work)
        np.testing.assert_allclose(work[:, 6], np.linalg.solve(matrix, right), rtol=1e-9)
        # The last column is minus the gradient: a step uphill has a product below zero with it.
        saddle = matrix + (trial % 4 + 1) * np.eye(6)
        work = np.column_stack([saddle, right])
        plain(ritz._solve)(loads, 2, work)
        assert work[:, 6] @ right < 0.0


@pytest.mark.parametrize("name", ["one", "two"])
def test_loads_are_found_where_the_energy_is_greatest(name):
    work, *bounds = room()
    best = None
    rng = np.random.default_rng(9)
    for _ in range(3):
        x = np.array(GUESSES[name])
        x += rng.uniform(-0.15, 0.15, x.size) * np.tile([1.0, 1.0, 2e-3], x.size // 3)
        loads = loads_at(x, bounds)
        found, total = plain(ritz.stationary)(TABLE, LEFT, loads, len(loads), MODULUS, work)
        assert found == len(loads)
        place = np.array([[load.t, math.log(load.b), load.place] for load in loads]).ravel()
        assert total == pytest.approx(written_down(place, work, bounds), rel=1e-6)
        _, _, right, _ = equations(place, work, bounds)
        assert np.abs(right).max() < 3e-5 * max(load.approach for load in loads)
        for _ in range(12):
            aside = rng.uniform(-1.0, 1.0, place.size) * np.tile([0.1, 0.05, 2e-4], len(loads))
            assert written_down(place + aside, work, bounds) < total
        best = total if best is None else best
        assert total == pytest.approx(best, rel=1e-6)


def test_one_load_in_a_parabola_takes_two_fifths_of_force_times_depth():
    """U = 2/5 N delta, its ellipse Hertz's of that parabola, at its top."""
    bend, deep, top = 2.7, 7e-5, MIDDLE + 0.4e-3
    work, *bounds = room(lambda s: deep - bend * (s - top) ** 2)
    loads = loads_at(np.array([0.1, math.log(4e-3), MIDDLE]), bounds)
    found, total = plain(ritz.stationary)(TABLE, LEFT, loads, 1, MODULUS, work)
    (load,) = loads
    assert found == 1
    assert load.lateral == pytest.approx(bend, rel=1e-4)
    assert load.approach == pytest.approx(deep, rel=1e-4)
    # A changes along the rail and moves the place by a little: a^2 A'/(10 B).
    assert load.place == pytest.approx(top, abs=1e-5)
    assert total == pytest.approx(0.4 * load.force * deep, rel=1e-4)


def test_a_load_that_has_nothing_to_carry_is_taken_out():
    work, *bounds = room()
    x = np.array([0.4, math.log(3.1e-3), MIDDLE - 3.2e-3, 0.9, math.log(1e-5), MIDDLE + 9e-3])
    loads = loads_at(x, bounds)
    found, total = plain(ritz.stationary)(TABLE, LEFT, loads, 2, MODULUS, work)
    alone = loads_at(x[:3], bounds)
    assert found == 1
    expected = plain(ritz.stationary)(TABLE, LEFT, alone, 1, MODULUS, work)[1]
    assert total == pytest.approx(expected, rel=1e-6)


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
