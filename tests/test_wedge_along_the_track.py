"""A wedge along the track and in warp: statics of its faces, sums over the face, balance of energy.

The column's face is summed here point by point; when a wedge locks follows from its two equations
of equilibrium; what a law stores and takes must be the work done on it on any way.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from driven_element import DrivenElement, along

from exudyn_wheelset import CoilNest, FrictionWedge, WheelsetError

BED, RADIUS, COLUMN, ANGLE = 1.0e8, 0.1, 2.0e4, 32.0


def wedge(**changes):
    options = {"spring": 6e5, "along": BED, "radius": RADIUS, **changes}
    return FrictionWedge(ANGLE, options.pop("friction", 0.4), COLUMN, **options)


def face_by_points(squeeze, turn, count=700):
    """Normal force and moments about y, z (on the bolster) of a face ahead, summed over points."""
    grid = (np.arange(count) + 0.5) / count * 2.0 - 1.0
    y, z = (RADIUS * v.ravel() for v in np.meshgrid(grid, grid))
    inside = y**2 + z**2 < RADIUS**2
    y, z = y[inside], z[inside]
    near = COLUMN / BED + squeeze + turn[0] * z - turn[1] * y
    pressed = BED / len(y) * np.maximum(0.0, near)
    return pressed.sum(), (-pressed * z).sum(), (pressed * y).sum()


@pytest.mark.parametrize("ahead", [True, False])
@pytest.mark.parametrize("squeeze", [0.0, 3e-4, -1.5e-4])
@pytest.mark.parametrize("turn", [(0.0, 1e-3), (4e-3, 0.0), (-5e-3, 1.2e-2)])
def test_face_is_a_bed_that_only_pushes(ahead, squeeze, turn):
    side = 1.0 if ahead else -1.0
    place = np.array([side * squeeze, 0.0, 0.0, 0.0, *turn])
    force = DrivenElement(wedge(ahead=ahead)).force(place, np.zeros(6))[0]
    # A column behind presses forward where the bolster's turning brings it nearer.
    normal, about_y, about_z = face_by_points(squeeze, np.multiply(side, turn))
    assert -side * force[0] == pytest.approx(normal - COLUMN, rel=2e-3, abs=2e-3 * COLUMN)
    expected = side * np.array([about_y, about_z])
    assert force[4:] == pytest.approx(expected, rel=2e-3, abs=2e-3 * COLUMN * RADIUS)
    assert np.hypot(force[4], force[5]) <= normal * RADIUS


def test_small_turns_meet_the_stiffness_of_a_round_bed():
    force = DrivenElement(wedge()).force(np.array([0.0, 0, 0, 0, 0, 1e-4]), np.zeros(6))[0]
    assert force[5] == pytest.approx(-0.25 * BED * RADIUS**2 * 1e-4, rel=1e-9)
    assert force[0] == pytest.approx(0.0, abs=1e-6)


def test_a_column_left_behind_holds_nothing():
    """Beyond N/k the face is off: no friction left, and the force of the partner alone."""
    driven = DrivenElement(wedge())
    driven.holds[:] = 0.8, 0.0
    force = driven.force(np.array([-1.1 * COLUMN / BED, 0, 0, 0, 0, 0]), np.zeros(6))[0]
    carried = COLUMN * np.tan(np.radians(ANGLE))
    assert force == pytest.approx([COLUMN, 0.0, carried, 0.0, 0.0, 0.0], abs=1e-6)


def test_friction_is_that_of_the_squeezed_face():
    driven = DrivenElement(wedge())
    driven.holds[:] = 1.0, 0.0
    force = driven.force(np.array([2e-4, 0, 0, 0, 0, 0]), np.zeros(6))[0]
    assert force[1] == pytest.approx(-0.4 * (COLUMN + BED * 2e-4), rel=1e-12)


@pytest.mark.parametrize("friction", [0.2, 0.28, 0.4])
@pytest.mark.parametrize("angle", [28.0, 32.0, 45.0])
def test_a_wedge_locks_below_the_sum_of_its_friction_angles(angle, friction):
    """Squeezed out, with friction up on both faces: S/(tan(a - phi) - mu); none where it locks."""
    a, phi = np.radians(angle), np.arctan(friction)
    normal, up = np.array([np.cos(a), -np.sin(a)]), np.array([np.sin(a), np.cos(a)])
    slope, column = normal + friction * up, np.array([-1.0, friction])
    pressed = np.linalg.solve(np.column_stack([slope, column]), [0.0, -1.0])[1]
    assert 1.0 / pressed == pytest.approx(np.tan(a - phi) - friction, rel=1e-9)
    assert (pressed > 0.0) == (a > 2.0 * phi)


@pytest.mark.parametrize("ahead", [True, False])
def test_stored_and_taken_is_the_work_done(ahead):
    """Along a way that squeezes, tilts, lifts edges, slides and strains the spring all at once."""
    driven = DrivenElement(wedge(ahead=ahead))

    def motion(t):
        size = np.array([2e-4, 3e-3, 5e-3, 0.0, 4e-3, 8e-3])
        speed = np.array([11.0, 5.0, 7.0, 0.0, 13.0, 6.0])
        shift = np.array([0.3, 0.0, 0.0, 0.0, 0.8, 0.0])
        place = size * (np.sin(speed * t + shift) - np.sin(shift))
        return place, size * speed * np.cos(speed * t + shift)

    times = np.linspace(0.0, 1.5, 6001)
    work, taken, stored = [], [], []
    for t, after in itertools.pairwise(times):
        force = driven.drive(motion, [t, after])[-1]
        # Rotations of some milliradians: the rate of the rotation vector is the angular velocity.
        work.append(-force @ motion(after)[1])
        taken.append(driven.power)
        stored.append(driven.energy)
    step = times[1] - times[0]
    given = np.cumsum(work) * step
    kept = np.array(stored) - stored[0] + np.cumsum(taken) * step
    assert np.ptp(stored) > 20.0
    np.testing.assert_allclose(kept - kept[0], given - given[0], atol=2e-3 * np.ptp(given))


def test_a_pair_holds_the_bolster_between_its_columns():
    """At rest they cancel; along the track and in warp both hold; nothing else changes."""
    nests = [
        DrivenElement(CoilNest((1e6, 1e6, 2e6), one))
        for one in (wedge(), wedge(along=0.0, radius=0.0))
    ]
    still = [nest.force(np.zeros(6), np.zeros(6))[0] for nest in nests]
    np.testing.assert_allclose(still[0], still[1], atol=1e-6)
    for axis, size, more in ((0, 1e-5, 2.0 * BED), (5, 1e-5, 0.5 * BED * RADIUS**2)):
        place = along(axis, size, 0.0)[0]
        held, free = (nest.force(place, np.zeros(6))[0] for nest in nests)
        assert free[axis] - held[axis] == pytest.approx(more * size, rel=1e-6)
    for axis in (1, 2):
        place = along(axis, 1e-3, 0.0)[0]
        held, free = (nest.force(place, np.zeros(6))[0] for nest in nests)
        np.testing.assert_allclose(held, free, atol=1e-6)


def test_what_no_face_is_is_refused():
    for changes, said in (
        ({"radius": 0.1, "along": 0.0}, "give along"),
        ({"along": -1.0}, "not negative"),
        ({"radius": 100.0}, "metres"),
        ({"ahead": 1}, "True or False"),
    ):
        with pytest.raises(WheelsetError, match=said):
            wedge(**changes)
