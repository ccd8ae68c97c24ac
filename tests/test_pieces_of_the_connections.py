"""Frames of bodies and dry friction in the compiled call, each by its definition.

Rotations against scipy's; pressures against integrals over the face and as derivatives of their
potentials; holds against their differential equation; a wedge's normal force by its equilibrium.
"""

import math

import numpy as np
import pytest
from scipy.integrate import dblquad, solve_ivp
from scipy.spatial.transform import Rotation

from exudyn_wheelset.vehicles import friction_kernel as law
from exudyn_wheelset.vehicles.elements.friction import Friction, Sliding
from exudyn_wheelset.vehicles.frames import middle_axes, place_frames, rotation_between
from exudyn_wheelset.vehicles.layout import (
    BODY,
    F_AXES,
    F_CENTRE,
    F_OMEGA,
    F_SPINNING,
    F_TAN,
    F_VELOCITY,
    FIRST,
    FRAME,
    SPINS,
)

ANGLES = [0.0, 3e-7, 0.9e-5, 1.1e-5, 1e-3, 0.3, 2.9]
DIRECTION = np.array([0.36, -0.48, 0.8])


def plain(kernel):
    return getattr(kernel, "py_func", kernel)


def frame_of(coordinates, velocities, spins):
    bodies = np.zeros((1, BODY))
    bodies[0, FIRST], bodies[0, SPINS], bodies[0, 2:5] = 1, spins, (0.5, -0.2, 0.7)
    frames = np.zeros((2, FRAME))
    q, v = (np.concatenate([[9.0], values]) for values in (coordinates, velocities))
    plain(place_frames)(q, v, bodies, frames)
    np.testing.assert_array_equal(frames[1, F_AXES], np.eye(3).ravel())
    return frames[0]


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("spins", [0.0, 1.0])
def test_axes_of_a_body(angle, spins):
    """Rotation vector and angular velocity of the body, this in its own axes (Exudyn's)."""
    coordinates = np.concatenate([[0.1, 0.2, 0.3], angle * DIRECTION])
    velocities = np.array([1.0, -2.0, 3.0, 0.4, -0.5, 0.7])
    frame = frame_of(coordinates, velocities, spins)
    turned = Rotation.from_rotvec(angle * DIRECTION).as_matrix()
    np.testing.assert_allclose(frame[F_SPINNING].reshape(3, 3), turned, rtol=0.0, atol=4e-16)
    # Off its first order, the smallest angles show the series' second term.
    rest = turned - np.eye(3)
    found = frame[F_SPINNING].reshape(3, 3) - np.eye(3)
    np.testing.assert_allclose(found, rest, atol=4e-16)
    np.testing.assert_allclose(frame[F_CENTRE], [0.6, 0.0, 1.0])
    np.testing.assert_array_equal(frame[F_VELOCITY], velocities[:3])
    axes = frame[F_AXES].reshape(3, 3)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    omega = turned @ velocities[3:]
    if spins == 0.0:
        np.testing.assert_allclose(axes, turned, atol=4e-16)
        np.testing.assert_allclose(frame[F_OMEGA], omega, atol=1e-15)
        return
    # Beside the spin: the axle is the body's, the nose stays level; the frame turns with both.
    np.testing.assert_allclose(axes[:, 1], turned[:, 1], atol=4e-16)
    assert axes[2, 0] == 0.0
    assert frame[F_TAN] == pytest.approx(axes[2, 1] / math.hypot(*axes[:2, 1]), abs=1e-15)
    step = 1e-6
    near = []
    for sign in (1.0, -1.0):
        later = Rotation.from_rotvec(sign * step * omega) * Rotation.from_matrix(turned)
        moved = np.concatenate([coordinates[:3], later.as_rotvec()])
        near.append(frame_of(moved, velocities, spins)[F_AXES].reshape(3, 3))
    rate = (near[0] - near[1]) / (2.0 * step) @ axes.T
    expected = [rate[2, 1], rate[0, 2], rate[1, 0]]
    np.testing.assert_allclose(frame[F_OMEGA], expected, atol=2e-8)


@pytest.mark.parametrize("angle", ANGLES)
def test_rotation_between_two_bodies(angle):
    lower = Rotation.from_rotvec([0.2, -0.5, 0.1])
    upper = lower * Rotation.from_rotvec(angle * DIRECTION)
    theta = np.zeros(3)
    lower_axes = lower.as_matrix().ravel()
    plain(rotation_between)(lower_axes, upper.as_matrix().ravel(), theta)
    np.testing.assert_allclose(theta, angle * DIRECTION, atol=1e-14)
    if angle > 0.5:
        return
    middle = np.zeros(9)
    plain(middle_axes)(lower_axes, theta, middle)
    expected = lower * Rotation.from_rotvec(0.5 * angle * DIRECTION)
    # Series to the fourth order: (angle/2)^5/120.
    near = 1e-15 + (0.5 * angle) ** 5 / 50.0
    np.testing.assert_allclose(middle.reshape(3, 3), expected.as_matrix(), atol=near)


def slope(function, x, step=1e-7):
    return (function(x + step) - function(x - step)) / (2.0 * step)


@pytest.mark.parametrize("onset", [0.0, 2e-3])
def test_what_only_pushes_has_a_potential(onset):
    stiffness = 3e6
    force = [plain(law.pressed)(c, stiffness, onset)[0] for c in (-1e-3, 0.0)]
    assert force == [0.0, 0.0]
    for c in (1e-4, 0.9e-3, 1.9e-3, 2.1e-3, 7e-3):
        found, stored = plain(law.pressed)(c, stiffness, onset)
        by_way = slope(lambda x: plain(law.pressed)(x, stiffness, onset)[1], c)
        assert found == pytest.approx(by_way, rel=1e-6)
        if c > onset:
            assert found == pytest.approx(stiffness * (c - 0.5 * onset))
        assert stored == pytest.approx(plain(law.pressed)(c - 1e-9, stiffness, onset)[1], rel=1e-4)
    for c in (0.0, onset) if onset else ():
        for part in (0, 1):
            near = [plain(law.pressed)(c + e, stiffness, onset)[part] for e in (-1e-12, 1e-12)]
            assert near[1] == pytest.approx(near[0], abs=1e-4)


@pytest.mark.parametrize("c", [5e-3, 1.1e-3, 0.2e-3, -0.7e-3])
def test_a_disc_on_a_bed_that_only_pushes(c):
    """By integrals over the disc: compressed by c + tilt x where that is positive."""
    radius, stiffness, tilt = 0.2, 5e7, 8e-3
    bed = stiffness / (math.pi * radius**2)

    def over(power, order):
        def at(y, x):
            return x**order * max(c + tilt * x, 0.0) ** power

        edge = min(max(-c / tilt, -radius), radius)

        def chord(x):
            return math.sqrt(max(radius**2 - x * x, 0.0))

        found, _ = dblquad(at, edge, radius, lambda x: -chord(x), chord, epsabs=1e-12)
        return bed * found

    force, moment, stored = plain(law.disc)(c, tilt, radius, stiffness)
    assert force == pytest.approx(over(1, 0), rel=1e-6)
    assert moment == pytest.approx(over(1, 1), rel=1e-6)
    assert stored == pytest.approx(0.5 * over(2, 0), rel=1e-6)
    assert plain(law.disc)(-1.01 * tilt * radius, tilt, radius, stiffness) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("hold", [-1.0, -0.4, 0.0, 0.7, 1.0])
@pytest.mark.parametrize("frictions", [(0.35, 0.1), (0.5, 0.4), (0.0, 0.2)])
def test_a_wedge_stands_between_column_and_slope(hold, frictions):
    """Three forces on a wedge without mass: spring, column with friction, slope with friction."""
    friction, sliding = frictions
    spring, tangent = 2.1e4, math.tan(math.radians(35.0))
    found = plain(law.column_force)(spring, hold, tangent, friction, sliding)
    lean = math.atan(tangent) + math.atan(sliding * hold)
    # R cos(lean) = N, R sin(lean) = S + mu h N.
    rows = [[1.0, -math.cos(lean)], [-friction * hold, math.sin(lean)]]
    normal, _ = np.linalg.solve(rows, [0.0, spring])
    assert found == pytest.approx(normal, rel=1e-12)
    if abs(hold) < 1.0:
        by_hold = slope(
            lambda h: plain(law.column_force)(spring, h, tangent, friction, sliding), hold
        )
        assert plain(law.column_force_slope)(
            spring, hold, tangent, friction, sliding
        ) == pytest.approx(by_hold, rel=1e-6, abs=1e-4)


def test_a_wedge_that_its_slope_holds_leaves_the_column():
    for friction, sliding in ((0.3, 1.4), (0.2, 9.0)):
        assert plain(law.column_force)(1e4, 1.0, 1.0, friction, sliding) == 0.0
        assert plain(law.column_force_slope)(1e4, 1.0, 1.0, friction, sliding) == 0.0
    # Beyond STEEPEST nothing changes any more.
    steep = [plain(law.column_force)(1e4, -0.8, 0.7, 0.2, mu) for mu in (law.STEEPEST, 50.0)]
    assert steep[0] == steep[1]


KINDS = {
    "pressed": {law.P_KIND: law.PRESSED, law.P_STIFFNESS: 2e6, law.P_COMPRESSION: 6e-3,
                law.P_ONSET: 1e-3},
    "hung": {law.P_KIND: law.HUNG, law.P_STIFFNESS: 2e6, law.P_COMPRESSION: 6e-3,
             law.P_LENGTH_X: 0.4, law.P_LENGTH_Y: 0.6},
    "disc": {law.P_KIND: law.DISC, law.P_STIFFNESS: 4e7, law.P_COMPRESSION: 1e-3,
             law.P_RADIUS: 0.17, law.P_PLAY: 2e-3, law.P_STOP: 3e7, law.P_STOP_ONSET: 1e-3,
             law.P_TILT_X: 1e-3, law.P_TILT_Y: -2e-3},
    "constant": {law.P_KIND: law.CONSTANT, law.P_FORCE: 7e3},
}  # fmt: skip
SLIDING = np.array([[1.0, 0.0, 0.1, 0.0, 0.0, 0.2], [0.0, 1.0, 0.0, 0.3, 0.0, 0.0]])


def block_of(kind, coupled, time=0.0):
    block = np.zeros(3 + law.P_COMPONENTS + 2 * law.COMPONENT)
    for place, value in KINDS[kind].items():
        block[3 + place] = value
    block[3 + law.P_COUNT], block[3 + law.P_COUPLED] = 2, coupled
    block[3 + law.P_DAMPING_TIME] = time
    for k in range(2):
        at = 3 + law.P_COMPONENTS + law.COMPONENT * k
        block[at : at + 6] = SLIDING[k]
        block[at + law.C_FRICTION], block[at + law.C_PRESLIDING] = (0.3, 0.2)[k], (1e-3, 2e-3)[k]
    return block


def forces_of(block, strain, speeds=(0.0,) * 6, holds=(0.0, 0.0)):
    g, drag, rates = np.zeros(6), np.zeros(6), np.zeros(5)
    states = np.array([7.0, *holds])
    speeds = np.array(speeds)
    energy, power = plain(law.friction_law)(block, 3, strain, speeds, states, 1, rates, 2, g, drag)
    return energy, power, g, drag, rates[2:4]


STRAINS = [
    (1e-3, 2e-3, 1e-3, 2e-3, 1e-3, 4e-3),
    (-4e-3, 3e-3, -2e-3, -9e-3, 4e-3, 0.0),
    (5e-3, -1e-3, 5.5e-3, 1e-3, -3e-3, 2e-3),
]


@pytest.mark.parametrize("strain", STRAINS)
@pytest.mark.parametrize("kind", KINDS)
def test_pressures_are_derivatives_of_their_potential(kind, strain):
    block = block_of(kind, 0.0)
    _, _, g, _, _ = forces_of(block, np.array(strain))
    for k in range(6):
        shift = np.zeros(6)
        shift[k] = 1e-7
        rise = forces_of(block, strain + shift)[0] - forces_of(block, strain - shift)[0]
        assert g[k] == pytest.approx(rise / 2e-7, rel=1e-5, abs=0.05)


@pytest.mark.parametrize("coupled", [0.0, 1.0])
@pytest.mark.parametrize("kind", KINDS)
def test_friction_resists_by_its_holds(kind, coupled):
    """Rates (u - |u| h)/delta, forces mu N (h + T h') along each component, their power."""
    strain, speeds = np.array(STRAINS[0]), np.array([0.02, -0.05, 0.01, 0.03, 0.07, -0.02])
    holds, time = np.array([0.4, -0.7]), 2e-3
    _, power, g, drag, rates = forces_of(block_of(kind, coupled, time), strain, speeds, holds)
    normal = KINDS[kind].get(law.P_FORCE, 0.0) or -g[2]
    u = SLIDING @ speeds
    size = np.full(2, np.hypot(*u)) if coupled else np.abs(u)
    expected = (u - size * holds) / [1e-3, 2e-3]
    np.testing.assert_allclose(rates, expected, rtol=1e-12)
    force = np.array([0.3, 0.2]) * normal * (holds + time * expected)
    np.testing.assert_allclose(drag, force @ SLIDING, rtol=1e-12, atol=1e-9)
    assert power == pytest.approx(force @ u, rel=1e-12)


@pytest.mark.parametrize("coupled", [0.0, 1.0])
def test_holds_after_a_straight_way_solve_their_equation(coupled):
    block = block_of("constant", coupled)
    way = np.array([1.5e-3, -0.8e-3, 0.2e-3, 1e-3, 0.0, 1e-3])
    holds = np.zeros(4)
    plain(law.monotone_hold)(block, 3, way, holds, 1)
    found = solve_ivp(
        lambda _, h: forces_of(block, np.zeros(6), way, h)[4], (0.0, 1.0), [0.0, 0.0],
        rtol=1e-10, atol=1e-12,
    )  # fmt: skip
    if not coupled:
        np.testing.assert_allclose(holds[1:3], found.y[:, -1], rtol=1e-8)
    else:
        # A presliding displacement of each component's own: along its way, each as if alone.
        size = np.hypot(*(SLIDING @ way))
        expected = (1.0 - np.exp(-size / np.array([1e-3, 2e-3]))) * (SLIDING @ way) / size
        np.testing.assert_allclose(holds[1:3], expected, rtol=1e-12)
        np.testing.assert_allclose(holds[1:3], found.y[:, -1], rtol=1e-8)


@pytest.mark.parametrize("load", [900.0, 4e4])
@pytest.mark.parametrize("kind", [law.PRESSED, law.HUNG, law.DISC])
def test_at_rest_a_pressed_surface_carries_its_preload(kind, load):
    """As drawn, unstrained, by its pressure alone: force and, of a disc, the preload's moments."""
    sliding = Sliding("along", (1.0, 0.0, 0.0, 0.0, 0.0, 0.0), 0.3, 1e-3)
    surface = Friction(kind, (sliding,), stiffness=4e7, radius=0.3, stop=1e7)
    moments = (0.03 * load, -0.05 * load) if kind == law.DISC else (0.0, 0.0)
    preload = np.array([0.0, 0.0, load, *moments, 0.0])
    block = np.concatenate([np.zeros(3), surface.pool(preload)])
    g = forces_of(block, np.zeros(6), holds=(0.0,))[2]
    np.testing.assert_array_equal(preload, np.zeros(6))
    assert -g[2] == pytest.approx(load, rel=1e-12)
    np.testing.assert_allclose(-g[3:5], moments, rtol=1e-12)


def test_a_gap_closes_over_its_onset():
    """Nothing up to the gap; half of stiffness times onset at the end of the onset."""
    sliding = Sliding("along", (1.0, 0.0, 0.0, 0.0, 0.0, 0.0), 0.3, 1e-3)
    apart = Friction(law.PRESSED, (sliding,), stiffness=4e7, onset=1e-3, gap=2e-3)
    block = np.concatenate([np.zeros(3), apart.pool(np.zeros(6))])
    for way, force in ((0.0, 0.0), (2e-3, 0.0), (3e-3, 2e4), (4e-3, 6e4)):
        down = np.array([0.0, 0.0, -way, 0.0, 0.0, 0.0])
        assert -forces_of(block, down, holds=(0.0,))[2][2] == pytest.approx(force, abs=1e-6)
