"""What the contact forces of any wheelset in any pose must satisfy: physics, not figures.

Mirror symmetry of the track, Coulomb's limit, finite answers, dissipation by creep, and continuity:
a force that a solver integrates may bend but must not step where one patch gives way to another.
"""

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from exudyn_wheelset import Track, Wheelset, contact_forces, contact_geometry
from exudyn_wheelset.contact.wheelset_contact import NORMAL_MODELS

LAWS = (
    "linear",
    "vermeulen-johnson",
    "shen-hedrick-elkins",
    "polach",
    "polach-2005",
    "fastsim",
)
FRICTION = 0.3
MASS_DATA = {"mass": 1813.0, "inertia": (1120.0, 112.0, 1120.0), "radius": 0.46}
CASES = {
    "S1002": (Wheelset(wheel="S1002", **MASS_DATA), Track(rail="UIC60")),
    "AAR": (Wheelset(wheel="AAR_1_20", **MASS_DATA), Track(rail="UIC60", gauge=1.432)),
}
PROPERTIES = settings(
    deadline=None, max_examples=150, suppress_health_check=[HealthCheck.too_slow], derandomize=True
)


def reals(bound):
    return st.floats(-bound, bound, allow_nan=False, allow_infinity=False, width=64)


# Anything within 30 mm and 50 mrad, most of it far from contact or deep in the rail ...
any_pose = st.tuples(reals(10.0), reals(0.03), reals(0.03), reals(0.05), reals(10.0), reals(0.05))
any_velocity = st.tuples(
    reals(100.0), reals(100.0), reals(100.0), reals(300.0), reals(300.0), reals(300.0)
)
# ... and poses in or near contact, rolling with moderate creepage.
near_pose = st.tuples(
    st.just(0.0), reals(0.008), st.floats(-4e-4, 2e-4), reals(2e-3), st.just(0.0), reals(0.03)
)
rolling = st.builds(
    lambda speed, vy, vz, slip, wx, wz: (speed, vy, vz, wx, speed / 0.46 * (1.0 + slip), wz),
    st.floats(1.0, 100.0),
    reals(0.5),
    reals(0.05),
    reals(0.01),
    reals(0.1),
    reals(0.5),
)
poses = st.one_of(any_pose, near_pose)
velocities = st.one_of(any_velocity, rolling, st.just((0.0,) * 6))


def numbers_of(forces):
    yield from forces.force
    yield from forces.moment
    for patch in (*forces.left, *forces.right):
        for value in vars(patch).values():
            yield from value if isinstance(value, tuple) else (value,)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("creep", LAWS)
@given(pose=poses, velocity=velocities)
@PROPERTIES
def test_every_pose_has_finite_forces(case, creep, pose, velocity):
    forces = contact_forces(*CASES[case], pose, velocity, creep=creep)
    assert all(math.isfinite(value) for value in numbers_of(forces))
    for patch in (*forces.left, *forces.right):
        assert patch.normal_force >= 0.0
        assert patch.a >= 0.0 and patch.b >= 0.0
        assert patch.energy >= 0.0


@pytest.mark.parametrize("normal", NORMAL_MODELS)
@given(pose=near_pose, velocity=rolling)
@PROPERTIES
def test_every_normal_model_is_finite_and_mirrors(normal, pose, velocity):
    check_mirror("S1002", pose, velocity, normal=normal, creep="polach")


def check_mirror(case, pose, velocity, **options):
    x, y, z, roll, pitch, yaw = pose
    vx, vy, vz, wx, wy, wz = velocity
    one = contact_forces(*CASES[case], pose, velocity, **options)
    other = contact_forces(
        *CASES[case], (x, -y, z, -roll, pitch, -yaw), (vx, -vy, vz, -wx, wy, -wz), **options
    )
    assert all(math.isfinite(value) for value in numbers_of(one))
    # The left side of one is the right side of the other, term by term: equal bit by bit, but for
    # the order in which two sides are added up.
    size = 1e-13 * (1.0 + np.abs(one.force).max())
    assert np.abs(one.force * [1, -1, 1] - other.force).max() <= size
    size = 1e-13 * (1.0 + np.abs(one.moment).max() + np.abs(one.force).max())
    assert np.abs(one.moment * [-1, 1, -1] - other.moment).max() <= size
    for mine, theirs in ((one.left, other.right), (one.right, other.left)):
        assert len(mine) == len(theirs)
        for here, there in zip(mine, theirs, strict=True):
            for name, value in vars(here).items():
                if name in ("creep_y", "spin", "fy", "mz"):
                    assert getattr(there, name) == -value, name
                elif name in ("position", "normal"):
                    assert getattr(there, name) == (value[0], -value[1], value[2])
                else:
                    assert getattr(there, name) == value, name


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("creep", LAWS)
@given(pose=poses, velocity=velocities)
@PROPERTIES
def test_mirrored_wheelset_has_mirrored_forces(case, creep, pose, velocity):
    check_mirror(case, pose, velocity, creep=creep)


@pytest.mark.parametrize("creep", LAWS)
@given(pose=poses, velocity=velocities)
@PROPERTIES
def test_creep_force_stays_within_friction(creep, pose, velocity):
    options = {"cap": 1.0} if creep == "linear" else {}
    forces = contact_forces(
        *CASES["S1002"], pose, velocity, creep=creep, friction=FRICTION, **options
    )
    for patch in (*forces.left, *forces.right):
        assert math.hypot(patch.fx, patch.fy) <= FRICTION * patch.normal_force * (1.0 + 1e-9)


@given(pose=poses, velocity=velocities)
@PROPERTIES
def test_fastsim_dissipates(pose, velocity):
    """Creep force and spin moment together never drive: simplified theory with one flexibility.

    Over a wheel: neighbouring patches that merge slip with one common creepage.
    """
    forces = contact_forces(*CASES["S1002"], pose, velocity, creep="fastsim", flexibilities="one")
    for patches in (forces.left, forces.right):
        power = sum(p.fx * p.creep_x + p.fy * p.creep_y + p.mz * p.spin for p in patches)
        scale = sum(
            FRICTION * p.normal_force * (math.hypot(p.creep_x, p.creep_y) + p.a * abs(p.spin))
            for p in patches
        )
        assert power <= 1e-9 * scale


@given(pose=near_pose, velocity=rolling)
@PROPERTIES
def test_forces_do_no_work_beyond_their_moments(pose, velocity):
    """Power of the wrench on the rigid wheelset = power of the forces at the contact points."""
    forces = contact_forces(*CASES["S1002"], pose, velocity, creep="fastsim")
    wrench = forces.force @ velocity[:3] + forces.moment @ velocity[3:]
    total = size = 0.0
    sides = [(patch, 1.0) for patch in forces.left] + [(patch, -1.0) for patch in forces.right]
    for patch, hand in sides:
        normal = np.array(patch.normal)
        tangent = np.cross(normal, [1.0, 0.0, 0.0])
        force = np.array([patch.fx, 0.0, 0.0]) + patch.fy * tangent + patch.normal_force * normal
        particle = np.array(velocity[:3]) + np.cross(velocity[3:], patch.position)
        total += force @ particle + (patch.mz + hand * patch.twist) * normal @ velocity[3:]
        size += np.linalg.norm(force) * np.linalg.norm(particle)
    assert wrench == pytest.approx(total, abs=1e-9 * (size + 1.0))


@given(pose=near_pose)
@PROPERTIES
def test_contact_damping_takes_energy(pose):
    """Approaching raises the normal force, parting lowers it, never below zero."""
    case = CASES["S1002"]
    still = contact_forces(*case, pose, (20.0, 0, 0, 0, 43.0, 0), damping=5.0)
    down = contact_forces(*case, pose, (20.0, 0, -0.02, 0, 43.0, 0), damping=5.0)
    up = contact_forces(*case, pose, (20.0, 0, 0.5, 0, 43.0, 0), damping=5.0)
    for rest, closing, parting in zip(
        (*still.left, *still.right), (*down.left, *down.right), (*up.left, *up.right), strict=True
    ):
        # Forward motion alone closes nothing: the normals have no component along the track.
        assert closing.normal_force >= rest.normal_force >= parting.normal_force >= 0.0


# Shifts (m) around which the contact of S1002 on UIC60 changes: the flat at the centre falls into
# two patches and one, tread and throat at 4.85 mm, throat and flange at 6.25 mm.
CHANGES = [0.0, 0.00025, 0.0005, 0.001, 0.002, 0.003, 0.004, 0.0045, 0.00485, 0.0055, 0.006, 0.007]


def walk(centre, step, quantity, half_width=1.25e-4, depth=1e-4, **options):
    """Values of `quantity` over shifts around `centre` at fixed roll and height, `depth` deep."""
    case = CASES["S1002"]
    rigid = contact_geometry(*case, [centre])
    roll, height = rigid.roll[0], rigid.z[0] - depth
    spin = 20.0 / 0.46
    velocity = (20.0, 0.0, 0.0, 0.0, spin * math.cos(roll), spin * math.sin(roll))
    count = round(2.0 * half_width / step) + 1
    shifts = centre + np.linspace(-half_width, half_width, count)
    rows = [
        quantity(contact_forces(*case, (0.0, y, height, roll, 0.0, 0.0), velocity, **options))
        for y in shifts
    ]
    return np.array(rows), rigid


def normal_forces(forces):
    return [sum(p.normal_force for p in side) for side in (forces.left, forces.right)]


def wrench_of(forces):
    return [*forces.force, *forces.moment]


@pytest.mark.parametrize("centre", CHANGES, ids=lambda y: f"{1e3 * y:g}mm")
def test_normal_force_is_continuous_across_changes_of_patch(centre):
    """A step in y changes N by no more than stiffness x step x slope of the contact plane."""
    step = 1e-6
    values, rigid = walk(centre, step, normal_forces)
    jumps = np.abs(np.diff(values, axis=0)).max(axis=0)
    for jump, side, force in zip(jumps, (rigid.left, rigid.right), values.max(axis=0), strict=True):
        # N ~ depth^1.5 per patch: dN/d depth = 1.5 N/depth. The depth is measured along the
        # normal and grows by sin(angle) dy; of the patches in reach the steepest counts, and a
        # patch 0.1 mm deep reaches 0.1 rad further up the throat, 0.6 rad where the flange starts.
        reach = 0.7 if 0.0055 <= centre <= 0.0065 else 0.2
        slope = math.sin(min(abs(side.angle[0]) + reach, 1.25))
        assert jump <= 1.5 * force / 1e-4 * slope * step


@pytest.mark.parametrize("creep", ["polach", "fastsim"])
@pytest.mark.parametrize("centre", CHANGES, ids=lambda y: f"{1e3 * y:g}mm")
def test_half_the_step_halves_the_largest_change(centre, creep):
    """What a real discontinuity would not do."""
    largest = [
        np.abs(np.diff(walk(centre, step, wrench_of, creep=creep)[0], axis=0)).max(axis=0)
        for step in (1e-6, 5e-7)
    ]
    # A kink (a patch that enters or leaves) falls into one step whole: somewhat above a half. Where
    # two lobes become one, its zone of 25 mm is integrated in one piece instead of two: the five
    # points of each leave a thousandth of the normal force, 150 kN here, or 75 nm of depth.
    residue = 200.0 if centre in (0.00025, 0.0005) else 1.0
    size = residue * np.array([0.1, 0.1, 1.0, 0.75, 0.05, 0.1])
    assert np.all(largest[1] <= 0.6 * largest[0] + size)
