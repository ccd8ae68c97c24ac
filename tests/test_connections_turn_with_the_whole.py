"""Two bodies that move as one rigid body deform nothing: no connection between them feels it.

All parts turn with one angular velocity about one point. Rates of gaps vanish in every frame that
turns with a body, so that forces, rates of the strokes and dissipated power are those at rest.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_vehicle_elements import ELEMENTS, Joined, pose, preload_of

from exudyn_wheelset.systems.constraints import turn_bodies

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
