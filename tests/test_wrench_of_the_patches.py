"""The wrench on a wheelset put together from its patches, and their kinematics by rigid motion.

Each patch has its place from the wheelset's centre, its normal from rail into wheel and its forces;
statics says what they amount to. Each place is a particle of a rigid body; its velocity over V is
the creepage, the angular velocity about the normal over V the spin. Nothing else of the kernels is
used. Poses on tread, across the jumps and on the flange, yawed and rolled, at any velocity.
"""

import math

import numpy as np
import pytest

from exudyn_wheelset import Track, Wheelset, contact_forces, contact_geometry

TAPE, RADIUS = 0.75, 0.46
WHEELSET = Wheelset(1813.0, (1120.0, 112.0, 1120.0), RADIUS, "S1002")
TRACK = Track("UIC60")
CASES = [
    (shift, yaw, creep)
    for shift in (-6.6e-3, -4.82e-3, -2e-3, 1e-4, 3e-3, 4.84e-3, 6.4e-3)
    for yaw in (0.0, 8e-3, -1.2e-2)
    for creep in ("shen-hedrick-elkins", "fastsim")
]


def contact(shift, yaw, creep, seed, damping=0.0):
    random = np.random.default_rng(seed)
    rigid = contact_geometry(WHEELSET, TRACK, [shift])
    roll = rigid.roll[0] + 2e-5 * random.normal()
    height = rigid.z[0] - random.uniform(4e-5, 9e-5)
    speed = random.uniform(10.0, 60.0)
    velocity = np.array([speed, 0.1, 0.01, 0.05, speed / RADIUS * 1.001, 0.03])
    velocity[[1, 2, 3, 5]] *= random.normal(size=4)
    found = contact_forces(
        WHEELSET, TRACK, (0.0, shift, height, roll, 0.0, yaw), tuple(velocity),
        creep=creep, damping=damping,
    )  # fmt: skip
    axle = np.array(
        [-math.sin(yaw) * math.cos(roll), math.cos(yaw) * math.cos(roll), math.sin(roll)]
    )
    return found, velocity, axle


@pytest.mark.parametrize(("shift", "yaw", "creep"), CASES)
@pytest.mark.parametrize("damping", [0.0, 5.0])
def test_force_and_moment_are_those_of_the_patches(shift, yaw, creep, damping):
    found, _, _ = contact(shift, yaw, creep, 3, damping)
    assert found.left and found.right
    force, moment = np.zeros(3), np.zeros(3)
    sides = [(1.0, patch) for patch in found.left] + [(-1.0, patch) for patch in found.right]
    for hand, patch in sides:
        normal, place = np.array(patch.normal), np.array(patch.position)
        assert np.linalg.norm(normal) == pytest.approx(1.0, abs=1e-12)
        along = np.array([1.0, 0.0, 0.0])
        on_wheel = patch.normal_force * normal + patch.fx * along
        on_wheel += patch.fy * np.cross(normal, along)
        force += on_wheel
        moment += np.cross(place, on_wheel) + (patch.mz + hand * patch.twist) * normal
    size = np.abs(force).max()
    np.testing.assert_allclose(found.force, force, atol=1e-9 * size)
    np.testing.assert_allclose(found.moment, moment, atol=1e-9 * size)


@pytest.mark.parametrize(("shift", "yaw", "creep"), CASES[::2])
def test_kinematics_of_each_patch(shift, yaw, creep):
    found, velocity, axle = contact(shift, yaw, creep, 4)
    speed, rates = velocity[0], velocity[3:]
    for side, patches in ((1.0, found.left), (-1.0, found.right)):
        for patch in patches:
            normal, place = np.array(patch.normal), np.array(patch.position)
            particle = velocity[:3] + np.cross(rates, place)
            tangent = np.cross(normal, [1.0, 0.0, 0.0])
            assert patch.creep_x == pytest.approx(particle[0] / speed, abs=1e-12)
            assert patch.creep_y == pytest.approx(particle @ tangent / speed, abs=1e-12)
            assert patch.spin == pytest.approx(rates @ normal / speed, abs=1e-9)
            # Positive where the contact plane falls towards the track's centre.
            assert patch.angle == pytest.approx(math.atan2(-side * normal[1], normal[2]), abs=1e-12)
            # Along the axle from the tape circle; the patch lies within its own width of the wheel.
            assert side * (place @ axle) - TAPE == pytest.approx(patch.wheel_y, abs=2e-5)
            radial = math.sqrt(place @ place - (place @ axle) ** 2)
            height = float(WHEELSET.wheel.height(patch.wheel_y))
            assert radial == pytest.approx(RADIUS - height, abs=3e-5)
            assert patch.radius == pytest.approx(
                radial, abs=radial * (math.tan(1.23) * yaw) ** 2 + 3e-5
            )


@pytest.mark.parametrize("shift", [-2e-3, 3e-3])
def test_a_single_patch_is_an_ellipse_of_hertz(shift):
    """Mean pressure 2/3 of the peak; half of the sphere-like stiffness of one ellipse.

    For the ellipse a, b under N Hertz gives the peak 3 N/(2 pi a b) and for given axis ratio
    N/(approach) = 2/3 dN/d(approach): N grows with the power 3/2 of the penetration.
    """
    rigid = contact_geometry(WHEELSET, TRACK, [shift])
    forces = []
    for depth in (2e-5, 4e-5):
        found = contact_forces(
            WHEELSET, TRACK, (0.0, shift, rigid.z[0] - depth, rigid.roll[0], 0.0, 0.0),
            (20.0, 0.0, 0.0, 0.0, 20.0 / RADIUS, 0.0),
        )  # fmt: skip
        (patch,) = found.right if shift > 0.0 else found.left
        peak = 1.5 * patch.normal_force / (math.pi * patch.a * patch.b)
        assert patch.peak_pressure == pytest.approx(peak, rel=1e-9)
        assert patch.penetration == pytest.approx(depth * math.cos(patch.angle), rel=2e-3)
        forces.append(patch.normal_force)
    # Curvature is averaged over the patch, which grows: a tread is nearly one arc there.
    assert math.log2(forces[1] / forces[0]) == pytest.approx(1.5, abs=0.1)
