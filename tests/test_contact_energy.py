"""Normal forces as the gradient of one stored energy, and the energy itself.

By the moments of the gap (contact/energy.py), the default, and by Ritz's method (contact/ritz.py).

Against mechanics: difference quotients of the energy, work around closed loops, symmetry of the
stiffness. Against the half-space solved on the same penetration (half_space.py): load, energy and
place. Friction and damping are off. Pairs: AAR and S1002 on UIC60 and worn measured pairs, where
they are at hand.
"""

import math
from pathlib import Path

import numpy as np
import pytest
from half_space import half_space_contact

from exudyn_wheelset import Track, Wheelset, contact_energy, contact_forces, contact_geometry
from exudyn_wheelset.contact.gap import gap_on_normal
from exudyn_wheelset.contact.hertz import hertz_from_approach
from exudyn_wheelset.contact.layout import HEADER, SIDE, Axle
from exudyn_wheelset.contact.tables import contact_tables

SHEAR_MODULUS, POISSON = 82.0e9, 0.28
LAWS = ("energy", "ritz")
PROFILES = Path(__file__).parents[2] / "shared" / "reference" / "profiles"
DATA = {"mass": 1813.0, "inertia": (1120.0, 112.0, 1120.0), "radius": 0.46}
# Wheel on rail: shifts [m] on the tread, at the jump, on the flange.
SHIFTS = {
    "S1002": (0.0, 0.3e-3, 0.8e-3, 3e-3, 4.9e-3, 5.6e-3, 6.6e-3),
    "AAR": (2e-3, 6e-3, 8e-3),
    "worn7216": (1e-3, 4e-3, 6e-3),
    "worn7813": (1e-3, 4e-3, 6e-3),
}


def pair(name):
    if name == "S1002":
        return Wheelset(wheel="S1002", **DATA), Track("UIC60")
    if name == "AAR":
        return Wheelset(wheel="AAR_1_20", **DATA), Track("UIC60", gauge=1.432)
    wheel = PROFILES / f"{name}.prw"
    if not wheel.exists():
        pytest.skip("no measured profiles here")
    return Wheelset(wheel=wheel, **DATA), Track(PROFILES / "siteb.prr", inclination=0.0)


PAIRS = {}


def cases():
    return [(name, shift) for name, shifts in SHIFTS.items() for shift in shifts]


@pytest.fixture(
    params=[(law, *case) for law in LAWS for case in cases()],
    ids=lambda case: f"{case[0]}-{case[1]}-{1e3 * case[2]:g}mm",
)
def at(request):
    """A normal model, a wheelset, its track and a pose (y, z, roll, yaw), 60 micrometres deep."""
    normal, name, shift = request.param
    if name not in PAIRS:
        PAIRS[name] = pair(name)
    wheelset, track = PAIRS[name]
    rigid = contact_geometry(wheelset, track, [shift], 5e-3)
    return normal, wheelset, track, np.array([shift, rigid.z[0] - 6e-5, rigid.roll[0], 5e-3])


def full(pose):
    y, z, roll, yaw = pose
    return (0.0, y, z, roll, 0.0, yaw)


def energy(normal, wheelset, track, pose):
    return contact_energy(wheelset, track, full(pose), normal=normal)


def forces_of(normal, wheelset, track, pose):
    return contact_forces(wheelset, track, full(pose), (0.0,) * 6, normal=normal, friction=0.0)


def generalised(normal, wheelset, track, pose):
    """Forces on (y, z, roll, yaw): roll turns about the nose line, yaw about z."""
    forces = forces_of(normal, wheelset, track, pose)
    yaw = pose[3]
    moment = forces.moment
    about_nose = moment[0] * math.cos(yaw) + moment[1] * math.sin(yaw)
    return np.array([forces.force[1], forces.force[2], about_nose, moment[2]])


# A micrometre at the wheel: lengths, and angles over 0.75 m (roll) and over the lead (yaw).
STEPS = np.array([1e-7, 3e-8, 1e-7, 1e-6])
SIZES = np.array([1.0, 1.0, 0.75, 0.1])


# Where the valley between two lobes fills up, so that the weights of the energies change.
MERGING = [(5.24e-3, 1.2e-4), (5.29e-3, 1.2e-4), (4.28e-3, 2e-4), (4.46e-3, 2e-4)]


@pytest.mark.parametrize("normal", LAWS)
@pytest.mark.parametrize(("shift", "depth"), MERGING)
def test_wrench_is_the_gradient_while_two_lobes_merge(normal, shift, depth):
    wheelset, track = PAIRS.setdefault("S1002", pair("S1002"))
    rigid = contact_geometry(wheelset, track, [shift], 5e-3)
    merging = normal, wheelset, track, np.array([shift, rigid.z[0] - depth, rigid.roll[0], 5e-3])
    check_gradient(merging)
    check_torque(merging)


def test_wrench_is_minus_the_gradient_of_the_energy(at):
    check_gradient(at)


def check_gradient(at):
    normal, wheelset, track, pose = at
    forces = generalised(normal, wheelset, track, pose)
    load = np.abs(forces[:2]).max()
    for k in range(4):
        step = np.zeros(4)
        step[k] = STEPS[k]
        values = [energy(normal, wheelset, track, pose + m * step) for m in (-2, -1, 1, 2)]
        slope = (8.0 * (values[2] - values[1]) - (values[3] - values[0])) / (12.0 * STEPS[k])
        assert -slope == pytest.approx(forces[k], abs=1e-5 * load * SIZES[k])


def test_no_torque_about_the_axle(at):
    """Pressure on a surface of revolution: every line of force meets the axle."""
    check_torque(at)


def check_torque(at):
    normal, wheelset, track, pose = at
    _, _, roll, yaw = pose
    axle = [-math.sin(yaw) * math.cos(roll), math.cos(yaw) * math.cos(roll), math.sin(roll)]
    forces = forces_of(normal, wheelset, track, pose)
    assert abs(forces.moment @ axle) < 1e-10 * np.linalg.norm(forces.force) * 0.46


def test_patches_and_their_twists_are_the_wrench(at):
    normal, wheelset, track, pose = at
    forces = forces_of(normal, wheelset, track, pose)
    force, moment = np.zeros(3), np.zeros(3)
    for patches, hand in ((forces.left, 1.0), (forces.right, -1.0)):
        for patch in patches:
            push = patch.normal_force * np.array(patch.normal)
            force += push
            moment += np.cross(patch.position, push) + hand * patch.twist * np.array(patch.normal)
    np.testing.assert_allclose(force, forces.force, atol=1e-9 * np.abs(force).max())
    np.testing.assert_allclose(moment, forces.moment, atol=1e-9 * np.abs(force).max())


def test_work_around_closed_loops(at):
    """Loops of random harmonics in (y, z, roll, yaw); the trapezoidal rule is spectral on them."""
    normal, wheelset, track, pose = at
    random = np.random.default_rng(7)
    points = 128
    angle = 2.0 * math.pi * np.arange(points) / points
    for _ in range(4):
        sizes = np.array([1e-4, 1e-5, 2e-5, 3e-3])
        turns = random.uniform(-1.0, 1.0, (2, 4)) * sizes
        path = pose + np.outer(np.cos(angle), turns[0]) + np.outer(np.sin(angle), turns[1])
        speed = np.outer(-np.sin(angle), turns[0]) + np.outer(np.cos(angle), turns[1])
        forces = np.array([generalised(normal, wheelset, track, p) for p in path])
        work = (forces * speed).sum() * 2.0 * math.pi / points
        swing = np.ptp([energy(normal, wheelset, track, p) for p in path[::4]])
        assert abs(work) < 1e-4 * swing


def test_stiffness_is_symmetric(at):
    normal, wheelset, track, pose = at
    stiffness = np.empty((4, 4))
    for k in range(4):
        step = np.zeros(4)
        step[k] = STEPS[k]
        ahead = generalised(normal, wheelset, track, pose + step)
        stiffness[:, k] = (ahead - generalised(normal, wheelset, track, pose - step)) / (
            2.0 * STEPS[k]
        )
    size = np.sqrt(np.abs(np.outer(np.diag(stiffness), np.diag(stiffness))))
    assert np.all(np.abs(stiffness - stiffness.T) < 1e-4 * (np.abs(stiffness + stiffness.T) + size))


def curve_of(table, curve):
    """Arc lengths [m] and the coefficients of a curve in the kernels' table."""
    start, count = int(curve["offset"]), int(curve["segments"])
    coefficients = table[start : start + 8 * count].reshape(count, 8)
    return curve["spacing"] * np.arange(count), coefficients


def gap_of_left_wheel(wheelset, track, pose, count=200):
    """Rail positions and arc lengths over the overlap, penetration, half curvature along."""
    y, z, roll, yaw = pose
    axle = Axle(
        y, wheelset.radius + z,
        -math.sin(yaw) * math.cos(roll), math.cos(yaw) * math.cos(roll), math.sin(roll),
    )  # fmt: skip
    table = contact_tables(wheelset, track)
    side = table[:HEADER].view(SIDE)[0]
    patches = forces_of("hertz", wheelset, track, pose).left
    arcs, rail = curve_of(table, side["rail"])
    wheel_arcs, wheel = curve_of(table, side["wheel"])
    middle = np.interp(patches[0].rail_y + side["datum"], rail[:, 0], arcs)
    ahead = np.interp(patches[0].wheel_y, wheel[:, 0], wheel_arcs)
    halves = []
    for direction in (-1.0, 1.0):
        arc, rows = ahead, []
        for s in middle + direction * 5e-5 * np.arange(500):
            for _ in range(3):
                p, _, _, arc = gap_on_normal(table, side, s, arc, axle)
            rows.append((s, p))
            arc += direction * 5e-5
        halves.append(np.array(rows))
    s, p = np.vstack([halves[0][:0:-1], halves[1]]).T
    inside = s[p > 0.0]
    grid = np.linspace(inside[0] - 1e-4, inside[-1] + 1e-4, count)
    upright = np.interp(grid, arcs, rail[:, 1])
    height = np.interp(grid, arcs, rail[:, 4])
    places = np.interp(grid, arcs, rail[:, 0]) - side["datum"]
    return places, grid, np.interp(grid, s, p), 0.5 * upright / (wheelset.radius - height)


@pytest.mark.parametrize("depth", [4e-5, 1e-4])
@pytest.mark.parametrize("shift", [-1e-3, 0.0, 0.6e-3, 1e-3, 2e-3, 4e-3, 4.6e-3, 4.9e-3, 5.1e-3])
def test_load_energy_and_place_of_the_half_space(shift, depth):
    """S1002 on UIC60: ellipse, shoulder, two lobes in one patch, two patches that feel each other.

    Ritz's energy is below the true one, which the reference's grid has to 0.1 %. The blend of one
    and two loads leaves up to 0.6 % of energy and 2 % of load; else both are within 1 %. Moments
    know of the shape beside a parabola two numbers: mostly 3 % of load, 6 % and 0.7 mm where a
    shoulder carries (0.6 mm).
    """
    wheelset, track = PAIRS.setdefault("S1002", pair("S1002"))
    rigid = contact_geometry(wheelset, track, [shift])
    pose = np.array([shift, rigid.z[0] - depth, rigid.roll[0], 0.0])
    places, s, p, along = gap_of_left_wheel(wheelset, track, pose)
    truth = half_space_contact(s, p, along, SHEAR_MODULUS, POISSON, along=24)
    for law, loads, below, above, aside in (
        ("ritz", 0.02, 0.015, 0.001, 3e-4), ("energy", 0.06, 0.04, 0.03, 7e-4),
    ):  # fmt: skip
        patches = forces_of(law, wheelset, track, pose).left
        load = sum(patch.normal_force for patch in patches)
        stored = sum(patch.energy for patch in patches)
        assert load == pytest.approx(truth.load, rel=loads)
        assert -below * truth.energy < stored - truth.energy < above * truth.energy
        place = np.interp(truth.place, s, places)
        mean = sum(patch.normal_force * patch.rail_y for patch in patches) / load
        assert mean == pytest.approx(place, abs=aside)


@pytest.mark.parametrize(
    ("name", "shift", "force", "height"),
    [
        ("worn7216", -4e-3, 0.01, 1e-6), ("worn7216", 2e-3, 0.01, 1e-6),
        ("worn7813", -2e-3, 0.01, 1e-6), ("worn7813", 6e-3, 0.01, 1e-6),
        ("worn7216", 6e-3, 0.06, 2e-6), ("worn7216", 6.6e-3, 0.06, 2e-6),
    ],
)  # fmt: skip
@pytest.mark.parametrize("depth", [3e-5, 6e-5])
def test_worn_measured_pairs_on_tread_and_flange(name, shift, force, height, depth):
    """Height at the same load by N ~ depth^1.5. The flanges touch over 1 mm, five lines of p."""
    wheelset, track = PAIRS.setdefault(name, pair(name))
    rigid = contact_geometry(wheelset, track, [shift])
    pose = np.array([shift, rigid.z[0] - depth, rigid.roll[0], 0.0])
    _, s, p, along = gap_of_left_wheel(wheelset, track, pose)
    truth = half_space_contact(s, p, along, SHEAR_MODULUS, POISSON, along=24, tolerance=1e-5)
    for law in ("energy", "ritz", "hertz"):
        load = sum(patch.normal_force for patch in forces_of(law, wheelset, track, pose).left)
        assert load == pytest.approx(truth.load, rel=force)
        assert abs(load / truth.load - 1.0) / 1.5 * depth < height


@pytest.mark.parametrize(("normal", "near"), [("energy", 3e-3), ("ritz", 2e-3)])
def test_a_cone_on_a_round_head_is_hertz(normal, near):
    """Constant curvatures, up to the turn of the normal over the patch: 1e-3 of the force.

    Moments see the whole overlap, half as wide again as the patch: 3e-3 of the width.
    """
    wheelset, track = Wheelset(wheel="cone_1_20", **DATA), Track("UIC60", inclination=0.0)
    rigid = contact_geometry(wheelset, track, [0.0])
    depth = 2e-5
    pose = (0.0, 0.0, rigid.z[0] - depth, rigid.roll[0], 0.0, 0.0)
    forces = contact_forces(wheelset, track, pose, (0.0,) * 6, normal=normal, friction=0.0)
    (patch,) = forces.left
    angle = patch.angle
    along = 0.5 * math.cos(angle) / patch.radius
    head = 0.3 if abs(patch.rail_y) < 0.0105 - patch.b else 0.08
    force, a, b = hertz_from_approach(along, 0.5 / head, patch.penetration, SHEAR_MODULUS, POISSON)
    assert patch.normal_force == pytest.approx(force, rel=near)
    assert patch.a == pytest.approx(a, rel=near)
    assert patch.b == pytest.approx(b, rel=near)
    assert patch.energy == pytest.approx(0.4 * force * patch.penetration, rel=near)
