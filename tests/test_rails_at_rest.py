"""Crooked rails at rest: their shape moves and turns the contact, and gives no creepage.

Two sources of truth. Geometry: rails of one constant slope are straight track turned by it. And the
linear model of a coned wheelset on knife edges, written here by Newton and Euler, driven through
the position of the rails alone.
"""

import math

import exudyn as exu
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exudyn_wheelset import Contact, Irregularity, Track, Wheelset, contact_forces, simulate
from exudyn_wheelset.coupling.create import create_wheelset
from exudyn_wheelset.creep.kalker import kalker_coefficients
from exudyn_wheelset.profiles.shapes import cone, knife_edge

SPEED, RADIUS = 20.0, 0.46
WHEELSET = Wheelset(mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=RADIUS, wheel="S1002")
TRACK = Track(rail="UIC60")
OPTIONS = {"damping": 2.0, "friction": 0.35}
POSES = [
    (0.0, 0.0, -2.8e-4, 0.0, 0.0, 0.0),
    (1.3, 0.004, -1.6e-4, 3e-4, 0.4, 0.006),
    (-0.2, -0.0065, 2.9e-3, -4.4e-3, -2.1, 0.02),
    (0.0, 0.007, 4.5e-3, 6.4e-3, 3.0, 0.017),
]
VELOCITY = (SPEED, 0.05, -0.01, 0.02, 1.001 * SPEED / RADIUS, -0.1)


def axes_along(slope_y, slope_z):
    """Columns: the rail's direction, the level direction across, and upwards."""
    along = np.array([1.0, slope_y, slope_z]) / math.sqrt(1.0 + slope_y**2 + slope_z**2)
    across = np.array([-slope_y, 1.0, 0.0]) / math.hypot(1.0, slope_y)
    return np.column_stack([along, across, np.cross(along, across)])


@pytest.mark.parametrize("normal", ["hertz", "energy"])
@pytest.mark.parametrize(("slope_y", "slope_z"), [(8e-3, 0.0), (0.0, -5e-3), (-4e-3, 6e-3)])
@pytest.mark.parametrize("pose", POSES)
def test_rails_of_one_slope_are_straight_track_turned_by_it(pose, slope_y, slope_z, normal):
    axes = axes_along(slope_y, slope_z)
    shift = np.array([0.0, 2e-3, -1e-3])
    _, y, z, roll, pitch, yaw = pose
    turn = Rotation.from_euler("ZXY", [yaw, roll, pitch])
    # The pose is the same beside the rails; only the axes it is told in are turned.
    told = Rotation.from_matrix(axes) * turn
    place = shift + axes @ [0.0, y, RADIUS + z]
    # Rails are lines: the cross section through the centre is as good as any.
    place -= place[0] * np.array([1.0, slope_y, slope_z])
    yaw, roll, pitch = told.as_euler("ZXY")
    velocity = np.concatenate([axes @ VELOCITY[:3], axes @ VELOCITY[3:]])
    crooked = contact_forces(
        WHEELSET, TRACK, (0.0, place[1], place[2] - RADIUS, roll, pitch, yaw), velocity,
        rail_motion=(shift[1], shift[2], shift[1], shift[2], 0.0, 0.0, 0.0, 0.0),
        rail_slope=(slope_y, slope_z) * 2, normal=normal, **OPTIONS,
    )  # fmt: skip
    straight = contact_forces(WHEELSET, TRACK, pose, VELOCITY, normal=normal, **OPTIONS)
    assert len(crooked.left) == len(straight.left) and len(crooked.right) == len(straight.right)
    # 1e-16 of a metre of height is 1e-12 of the penetration; its cube root is in strained lobes.
    for turned, known in ((crooked.force, straight.force), (crooked.moment, straight.moment)):
        assert axes.T @ turned == pytest.approx(known, rel=1e-9, abs=1e-9 * np.abs(known).max())
    for one, other in zip(
        crooked.left + crooked.right, straight.left + straight.right, strict=True
    ):
        assert one.creep_y == pytest.approx(other.creep_y, rel=1e-9, abs=1e-12)


LAMBDA, HALF, LENGTH = 0.05, 0.75, 1.0
# Of one axle end, along and across.
STIFFNESS, DAMPING = (5.0e4, 1.0e5), (2.0e4, 2.0e4)
CONE = Wheelset(mass=1250.0, inertia=(700.0, 100.0, 700.0), radius=0.45, wheel=cone(LAMBDA))
EDGES = Track(rail=knife_edge(1e-2), inclination=0.0, datum_half_distance=HALF)
LINEAR = Contact(creep="linear", damping=1.0)
LOAD = 5.0e4


def creep_coefficients():
    """f11, f22, f23 of one wheel: forces of its patch under LOAD over creepage and spin."""
    rest = contact_forces(CONE, EDGES, (0, 0, -5e-5, 0, 0, 0), (1, 0, 0, 0, 1 / 0.45, 0))
    depth = rest.left[0].penetration * (LOAD / rest.left[0].normal_force) ** (2 / 3)
    pose = (0, 0, -5e-5 - (depth - rest.left[0].penetration), 0, 0, 0)
    patch = contact_forces(CONE, EDGES, pose, (1, 1e-4, 0, 0, 1 / 0.45, 0), contact=LINEAR).left[0]
    assert patch.normal_force == pytest.approx(LOAD, rel=5e-3)
    c11, c22, c23, _ = kalker_coefficients(patch.a, patch.b, LINEAR.poisson)
    area = LINEAR.shear_modulus * patch.a * patch.b
    return area * c11, area * c22, area * math.sqrt(patch.a * patch.b) * c23


def transfer_by_newton_and_euler(speed, wave_length):
    """y/eps of the coned wheelset, complex, rails at y = eps(x).

    u = y - eps; roll follows the rails, phi = lambda u/(b - lambda r0); creepages see the velocity
    of the wheel's particle alone: xi_y = (y' + r0 phi')/V - psi.
    """
    f11, f22, f23 = creep_coefficients()
    r0, mass, (ix, iy, iz) = CONE.radius, CONE.mass, CONE.inertia
    s = 2j * math.pi * speed / wave_length
    roll = LAMBDA / (HALF - LAMBDA * r0)
    more = 1.0 + LAMBDA * r0 / HALF
    spin = speed / r0
    normal = LOAD

    def residual(y, psi, eps):
        u = y - eps
        phi = roll * u
        xi_y = (s * y + r0 * s * phi) / speed - psi
        # Between a cone and its own axle the angle stays: of spin only the yawing's is left, and
        # +-lambda/r0 under unlike loads, N_l - N_r = (2 N u - r0 F)/b, for f23 goes with N.
        creep = -2.0 * f22 * xi_y - 2.0 * f23 * (s * psi / speed - LAMBDA / r0 * u / HALF)
        creep /= 1.0 + f23 * LAMBDA / (normal * HALF)
        # The couple of the normal forces that holds the roll, in the sloping planes.
        couple = (iy * spin * s * psi - ix * s * s * phi) * LAMBDA / HALF
        spring = 2.0 * (STIFFNESS[1] + DAMPING[1] * s)
        yaw_spring = 2.0 * LENGTH**2 * (STIFFNESS[0] + DAMPING[0] * s)
        lateral = -mass * s * s * y - spring * y + more * creep
        lateral -= 2 * normal * (phi + LAMBDA * u / HALF)
        radius = LAMBDA * (u + r0 * phi) / r0
        about = -(iz * s * s + yaw_spring) * psi - iy * spin * s * phi
        about += -2 * HALF * f11 * (HALF * s * psi / speed + radius) + 2 * f23 * xi_y
        return np.array([lateral + couple, about])

    matrix = np.column_stack([residual(1.0, 0.0, 0.0), residual(0.0, 1.0, 0.0)])
    return np.linalg.solve(matrix, -residual(0.0, 0.0, 1.0))


def simulated_transfer(speed, wave_length, known):
    amplitude = 1e-4
    # The wheelset's own waves die at 0.15 1/s: the motion begins near the known one.
    y, yaw = amplitude * known.imag
    k = 2.0 * math.pi / wave_length

    def rail(station):
        return amplitude * np.sin(k * station), 0.0

    # Splines through 100 points a wave follow it to 1e-7 of its height.
    rough = Irregularity.from_functions(rail, rail, 9.0 * speed + 10.0, wave_length / 100.0)

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    spare = 2.0 * LOAD - CONE.mass * 9.81
    items = create_wheelset(
        mbs, CONE, EDGES, speed=speed, moving_frame=True, contact=LINEAR, irregularity=rough,
        lateral_offset=y, yaw=yaw, show=False, sensors=False,
    )  # fmt: skip
    ground = mbs.CreateGround()
    for side in (-LENGTH, LENGTH):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, items.body],
            localPosition0=[0.0, side, items.reference[2]],
            localPosition1=[0.0, side, 0.0],
            stiffness=[*STIFFNESS, 0.0],
            damping=[*DAMPING, 0.0],
        )
    mbs.CreateForce(bodyNumber=items.body, loadVector=[0.0, 0.0, -spare])
    mbs.Assemble()
    motion = simulate(mbs, speed, 9.0, interval=5e-3)
    late = motion.time > 5.0
    time = motion.time[late]
    # The wheelset slips back by some creepage: its station is read, not assumed.
    x = motion["wheelset: x"][late] + speed * time
    table = np.column_stack([np.sin(k * x), np.cos(k * x), np.ones_like(x)])
    answers = []
    for name in ("y", "yaw"):
        sine, cosine, _ = np.linalg.lstsq(table, motion[f"wheelset: {name}"][late], rcond=None)[0]
        answers.append((sine + 1j * cosine) / amplitude)
    return np.array(answers)


# Six wave lengths about the wheelset's own of 2 pi sqrt(b r0/lambda) = 16.3 m; the last two pairs
# have one frequency at two speeds.
@pytest.mark.parametrize(
    ("speed", "wave_length"),
    [(15.0, 5.0), (15.0, 8.0), (15.0, 12.0), (15.0, 16.0), (15.0, 25.0), (15.0, 40.0), (10.0, 8.0)],
)
def test_transfer_function_is_that_of_the_linear_model(speed, wave_length):
    known = transfer_by_newton_and_euler(speed, wave_length)
    found = simulated_transfer(speed, wave_length, known)
    assert abs(found[0] / known[0] - 1.0) < 0.02
    assert abs(found[1] / known[1] - 1.0) < 0.02
