"""The state that does not spin against rotation matrices (scipy) and differences over time.

Two bodies and a slider: the first one spins about its axle (its x is cyclic), the second does not.
R = Rz(yaw) Rx(roll) Ry(pitch); the angular velocity is read off R' R^T by central differences of a
smooth motion, nothing of the closed forms of reduction.py is used.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exudyn_wheelset.systems.reduction import (
    CYCLIC,
    ROTATION,
    expand_state,
    reduce_coordinates,
    state_rate,
)

# Second-order coordinates: x y z and rotation vector of each body, then the slider.
POSITION_OF = np.array(
    [CYCLIC, 0, 1, ROTATION, ROTATION, ROTATION, 4, 5, 6, ROTATION, ROTATION, ROTATION, 10]
)
ROTATIONS = np.array([[3, 2, 1], [9, 7, 0]])
REFERENCE = np.array([[0.1, -0.2, 0.05], [-0.03, 0.02, 0.4]])
POSITIONS, SIZE, FIRST = 11, 13, 3
STATE = POSITIONS + SIZE + FIRST


def turned(yaw, roll, pitch):
    return Rotation.from_euler("ZXY", [yaw, roll, pitch])


def random_state(seed):
    return np.random.default_rng(seed).uniform(-0.6, 0.6, STATE)


def expanded(state):
    coordinates, velocities, first = np.full(SIZE, 9.0), np.zeros(SIZE), np.zeros(FIRST)
    expand_state(state, POSITION_OF, ROTATIONS, REFERENCE, coordinates, velocities, first)
    return coordinates, velocities, first


@pytest.mark.parametrize("seed", range(5))
def test_coordinates_of_a_state(seed):
    state = random_state(seed)
    coordinates, velocities, first = expanded(state)
    wanted = np.zeros(SIZE)
    wanted[1:3], wanted[6:9], wanted[12] = state[0:2], state[4:7], state[10]
    wanted[3:6] = turned(state[2], state[3], 0.0).as_rotvec() - REFERENCE[0]
    wanted[9:12] = turned(*state[7:10]).as_rotvec() - REFERENCE[1]
    np.testing.assert_allclose(coordinates, wanted, atol=1e-14)
    np.testing.assert_array_equal(velocities, state[POSITIONS : POSITIONS + SIZE])
    np.testing.assert_array_equal(first, state[POSITIONS + SIZE :])


def test_no_rotation_at_all():
    """The factor of the rotation vector is a limit there."""
    coordinates, _, _ = expanded(np.zeros(STATE))
    np.testing.assert_array_equal(coordinates[3:6], -REFERENCE[0])
    state = np.ones(STATE)
    reduce_coordinates(
        np.r_[np.zeros(3), -REFERENCE[0], np.zeros(3), -REFERENCE[1], 0.0],
        np.zeros(SIZE), np.zeros(FIRST), POSITION_OF, ROTATIONS, REFERENCE, state,
    )  # fmt: skip
    np.testing.assert_allclose(state, 0.0, atol=1e-15)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("spin", [0.0, 0.7, 2.2, -1.9])
def test_state_of_coordinates_takes_the_spin_out(seed, spin):
    """Body components of the angular velocity, turned by the spin, are those that do not spin."""
    wanted = random_state(seed)
    coordinates, velocities, first = expanded(wanted)
    coordinates[3:6] = turned(wanted[2], wanted[3], spin).as_rotvec() - REFERENCE[0]
    intermediate = wanted[POSITIONS + 3 : POSITIONS + 6]
    velocities[3:6] = Rotation.from_euler("y", spin).inv().apply(intermediate)
    state = np.zeros(STATE)
    reduce_coordinates(coordinates, velocities, first, POSITION_OF, ROTATIONS, REFERENCE, state)
    np.testing.assert_allclose(state, wanted, atol=1e-14)


def angles(t, seed):
    """Smooth yaw, roll, pitch over time."""
    a, b, c = np.random.default_rng(seed).uniform(-0.4, 0.4, (3, 3))
    return a + b * t + c * t * t


def angular_velocity(t, seed, step=1e-4):
    """Of the motion `angles`, track frame, by a central difference of the rotation."""
    after, before = turned(*angles(t + step, seed)), turned(*angles(t - step, seed))
    return (after * before.inv()).as_rotvec() / (2.0 * step)


@pytest.mark.parametrize("seed", range(5))
def test_rates_of_a_motion(seed):
    """Rates of the state along a motion, forces being the accelerations by differences."""
    step = 1e-4

    def intermediate(t):
        yaw, roll, _ = angles(t, seed)
        return turned(yaw, roll, 0.0).inv().apply(angular_velocity(t, seed))

    def body(t, seed):
        return turned(*angles(t, seed)).inv().apply(angular_velocity(t, seed))

    def difference(of, *arguments):
        return (of(step, *arguments) - of(-step, *arguments)) / (2.0 * step)

    state = random_state(seed)
    other = seed + 50
    # The spin of the first body is zero at this moment: its pitch is cyclic.
    pitch = angles(0.0, seed)[2]
    state[2:4], state[7:10] = angles(0.0, seed)[:2], angles(0.0, other)
    state[POSITIONS + 3 : POSITIONS + 6] = intermediate(0.0)
    state[POSITIONS + 9 : POSITIONS + 12] = body(0.0, other)
    accelerations = np.random.default_rng(seed).normal(size=SIZE)
    # The multibody code is asked at pitch 0: components of the body frame that lies so.
    turn = Rotation.from_euler("y", pitch)
    accelerations[3:6] = turn.apply(difference(body, seed))
    accelerations[9:12] = difference(body, other)
    mass = np.eye(SIZE) + 0.1 * np.random.default_rng(seed).normal(size=(SIZE, SIZE))
    force = np.r_[mass @ accelerations, 0.3, -0.7, 1.1]
    rate = np.zeros(STATE)
    state_rate(state, force, np.linalg.inv(mass), POSITION_OF, ROTATIONS, rate)

    wanted = np.empty(STATE)
    velocities = state[POSITIONS : POSITIONS + SIZE]
    wanted[0:2], wanted[4:7], wanted[10] = velocities[1:3], velocities[6:9], velocities[12]
    wanted[2:4] = difference(angles, seed)[:2]
    wanted[7:10] = difference(angles, other)
    wanted[POSITIONS : POSITIONS + SIZE] = accelerations
    wanted[POSITIONS + 3 : POSITIONS + 6] = difference(intermediate)
    wanted[POSITIONS + SIZE :] = 0.3, -0.7, 1.1
    # Central differences of differences: (1e-4)^2 of third derivatives, rounding 1e-16/(1e-4)^2.
    np.testing.assert_allclose(rate, wanted, atol=2e-7)
