"""Two bodies that move as one rigid body deform nothing: no connection between them feels it.

All parts turn with one angular velocity about one point. Rates of gaps vanish in every frame that
turns with a body, so that forces, rates of the strokes and dissipated power are those at rest. And
where an element acts beside its place, it is the same element at that other place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_vehicle_elements import ELEMENTS, Joined, pose, preload_of

from exudyn_wheelset import Element, Spring
from exudyn_wheelset.systems.constraints import turn_bodies
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.protocol import Law

# Links hang plumb and leaves act upright: their axes are those of the track.
TURNING = [name for name in ELEMENTS if name not in ("links", "leaf spring")]


@pytest.mark.parametrize("name", TURNING)
def test_a_rigid_motion_of_the_whole_is_not_felt(name):
    ends = ("axle", "frame") if name == "axle box" else ("frame", "body")
    joined = Joined(ELEMENTS[name], *ends, preload=preload_of(name))
    q = pose(8, angle=0.05, spin=0.4)
    omega, drift = np.array([0.3, -0.2, 0.5]), np.array([1.0, -0.4, 0.2])
    v = np.zeros((3, 6))
    for body in range(3):
        v[body, :3] = drift + np.cross(omega, joined.centres[body] + q[body, :3])
        v[body, 3:] = Rotation.from_rotvec(q[body, 3:]).inv().apply(omega)
    strokes = np.full(joined.strokes.size, 4e-4)
    still = joined.evaluate(q, strokes=strokes)
    turning = joined.evaluate(q, v.ravel(), strokes)
    size = np.abs(still[0]).max()
    np.testing.assert_allclose(turning[0], still[0], atol=1e-10 * size)
    np.testing.assert_allclose(turning[1], still[1], rtol=1e-9, atol=1e-10)
    assert turning[3] == pytest.approx(still[3], abs=1e-9 * size)
    # The same bodies in motion against each other are felt where there is a damper; a Maxwell
    # element's force is that of its stroke.
    apart = v + np.random.default_rng(1).uniform(-0.3, 0.3, (3, 6))
    felt = np.abs(joined.evaluate(q, apart.ravel(), strokes)[0] - still[0]).max()
    undamped = ("bump stop", "centre plate", "side bearer", "wedge")
    damped = name not in (*undamped, "maxwell", "blow-off in series")
    assert felt > 1e-4 * size or not damped


STIFFNESS, BESIDE = (3.0e6, 2.0e6, 1.0e6), (0.3, -0.2, 0.15)


@dataclass(frozen=True)
class SpringBeside(Element):
    """A spring at one side of its place: shipped elements with a shift come in pairs."""

    def laws(self):
        return (Law(layout.SPRING, stiffness=STIFFNESS, shift=BESIDE),)


def test_a_law_beside_its_place_acts_there():
    at = np.array([0.3, 0.9, 0.8])
    q = pose(9)
    shifted = Joined(SpringBeside(), at=tuple(at)).evaluate(q)
    there = Joined(Spring(STIFFNESS), at=tuple(at + BESIDE)).evaluate(q)
    np.testing.assert_allclose(shifted[0], there[0], atol=1e-12 * np.abs(there[0]).max())
    assert shifted[2] == pytest.approx(there[2], rel=1e-12)


def test_its_static_stiffness_is_that_of_the_shifted_point():
    """F = -K (u + theta x d), M = d x F about the place: the 6 x 6 matrix on (u, theta)."""
    matrix = SpringBeside().static_stiffness()
    for motion in np.eye(6):
        force = np.diag(STIFFNESS) @ (motion[:3] + np.cross(motion[3:], BESIDE))
        np.testing.assert_allclose(matrix @ motion, [*force, *np.cross(BESIDE, force)], atol=1e-6)


def test_bodies_turn_as_rotation_matrices_say():
    """R(t) = R(0) exp(t omega~), angular velocity in the body's axes, reference turned already."""
    random = np.random.default_rng(4)
    for _ in range(20):
        coordinates, velocities = random.uniform(-1.2, 1.2, 6), random.uniform(-2.0, 2.0, 6)
        reference = random.uniform(-0.5, 0.5, (1, 3))
        moved = coordinates.copy()
        turn_bodies(coordinates, velocities, 0.3, np.array([[3, 0, 0]]), reference, moved)
        before = Rotation.from_rotvec(coordinates[3:] + reference[0])
        after = before * Rotation.from_rotvec(0.3 * velocities[3:])
        found = Rotation.from_rotvec(moved[3:] + reference[0])
        np.testing.assert_allclose(found.as_matrix(), after.as_matrix(), atol=1e-13)
        np.testing.assert_array_equal(moved[:3], coordinates[:3])
