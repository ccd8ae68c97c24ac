"""normal="strips" against the elastic half-space on a grid, Hertz's closed forms and FASTSIM.

half_space.py is the second method: a grid in two dimensions, no assumption on the shape of
the pressure. Its own error, from Hertz's ellipse on a like grid, is 0.1 % in force and 1 % in peak
pressure. Poses are rigid positions of S1002 on UIC60 1:40, lowered.
"""

import itertools
import math

import numpy as np
import pytest
from half_space import contact_of_gap, gap_of_left_wheel
from scipy.integrate import quad

from exudyn_wheelset import Track, Wheelset, contact_forces, contact_geometry, creep_force
from exudyn_wheelset.contact.hertz import hertz_from_approach
from exudyn_wheelset.contact.strips import influence, k_minus_e

MASS_DATA = {"mass": 1813.0, "inertia": (1120.0, 112.0, 1120.0), "radius": 0.46}
WHEELSET = Wheelset(wheel="S1002", **MASS_DATA)
TRACK = Track(rail="UIC60")
ROLLING = (20.0, 0.0, 0.0, 0.0, 20.0 / 0.46, 0.0)
POSES = {
    "flat on flat": (0.0, 6e-5),
    "tread": (0.003, 6e-5),
    "tread and throat, two patches": (0.005, 6e-5),
    "tread and throat under load": (0.0052, 1.2e-4),
    "throat": (0.006, 1.2e-4),
    "R13 in R13": (0.0062, 6e-5),
    "R13 in R13 under load": (0.0062, 1.2e-4),
    "R13 in R13, 45 degrees of angle": (0.00625, 9e-5),
    "flange root": (0.0064, 1e-4),
    "flange": (0.007, 1e-4),
}


def lowered(y, depth):
    geometry = contact_geometry(WHEELSET, TRACK, [y])
    return float(geometry.z[0]) - depth, float(geometry.roll[0])


def left_force(y, z, roll, **options):
    options = {"friction": 0.0, **options}
    forces = contact_forces(WHEELSET, TRACK, (0, y, z, roll, 0, 0), ROLLING, **options)
    return np.sum([np.multiply(p.normal_force, p.normal) for p in forces.left], axis=0), forces.left


def test_the_grid_gives_hertz_on_a_parabola():
    s = np.arange(-0.012, 0.012, 1e-4)
    gap = np.array([s, 6e-5 - 1.7 * s * s, 0 * s, 1 + 0 * s, 1.1 + 0 * s])
    force, a, b = hertz_from_approach(1.1, 1.7, 6e-5, 82e9, 0.28)
    found, _, _, peak, _ = contact_of_gap(gap)
    assert found == pytest.approx(force, rel=2e-3)
    assert peak == pytest.approx(1.5 * force / (math.pi * a * b), rel=0.01)


@pytest.mark.parametrize("name", POSES)
def test_force_and_peak_pressure(name):
    """Two per cent: pressure that is semi-elliptic along x is off by as much in the throat."""
    y, depth = POSES[name]
    z, roll = lowered(y, depth)
    gap = gap_of_left_wheel(WHEELSET, TRACK, y, z, roll)
    _, wanted_y, wanted_z, peak, _ = contact_of_gap(gap)
    force, patches = left_force(y, z, roll, normal="strips")
    assert force[1] == pytest.approx(wanted_y, rel=0.02)
    assert force[2] == pytest.approx(wanted_z, rel=0.02)
    assert max(p.peak_pressure for p in patches) == pytest.approx(peak, rel=0.03)
    # Height at the same vertical load: its error is that of the force over the stiffness.
    stiffer, _ = left_force(y, z - 1e-6, roll, normal="strips")
    assert abs(force[2] - wanted_z) < 1.2 * (stiffer[2] - force[2])


@pytest.mark.parametrize("normal", ["energy", "ritz", "hertz", "strips"])
@pytest.mark.parametrize("y", [0.0047, 0.0048, 0.0049, 0.005, 0.0051])
def test_tread_and_throat_share_the_load(y, normal):
    """Two patches 8 mm apart sink in each other's field: vertical force 2 %, share 0.015.

    A little more by "energy", 2.5 % or 1 um of height, where the lesser one carries on 3 um of 10.

    Without that the vertical force would be up to 21 % too large.
    """
    z, roll = lowered(y, 6e-5)
    gap = gap_of_left_wheel(WHEELSET, TRACK, y, z, roll)
    # The contact angle is 11 degrees in the valley between the two.
    load, _, vertical, _, in_throat = contact_of_gap(gap, steeper=math.radians(11.0))
    force, patches = left_force(y, z, roll, normal=normal)
    bound = 0.025 if normal == "energy" else 0.02
    assert force[2] == pytest.approx(vertical, rel=bound)
    if len(patches) == 2:
        share = patches[0].normal_force / sum(p.normal_force for p in patches)
        assert share == pytest.approx(in_throat / load, abs=0.015)


@pytest.mark.parametrize("u", [0.02, 0.1, 0.5, 1.0, 3.0, 10.0])
def test_closed_forms_of_displacement_and_bend(u):
    """2 r D and D/r against the integrals over sqrt(1 - t^2), t = sin(angle), that they stand for.

    The bend is -1/2 d^2/dx^2 of 1/distance, (u^2 - 2 t^2)/(2 (u^2 + t^2)^(5/2)).
    """

    def integral(kernel):
        ends = [0.0, min(u, 0.5), min(5.0 * u, 1.0), math.pi / 2]
        parts = itertools.pairwise(ends)
        return 2.0 * sum(
            quad(lambda angle: math.cos(angle) ** 2 * kernel(math.sin(angle)), *part, limit=200)[0]
            for part in parts
        )

    r = math.sqrt(1.0 + u * u)
    d = k_minus_e(u * u)
    assert 2.0 * r * d == pytest.approx(integral(lambda t: 1.0 / math.hypot(t, u)), rel=1e-5)
    wanted = integral(lambda t: 0.5 * (u * u - 2.0 * t * t) / (t * t + u * u) ** 2.5)
    assert d / r == pytest.approx(wanted, rel=1e-4)


@pytest.mark.parametrize("distance", [0.0, 2e-4, 4e-4, 6e-4, 8e-4, 5e-3])
def test_influence_is_the_integral_over_the_strips_width(distance):
    """The logarithm is integrated in closed form, the rest by few points: 0.2 % is left."""
    a, width = 4e-3, 4e-4
    places = distance + width * ((np.arange(40000) + 0.5) / 40000 - 0.5)
    u = np.abs(places) / a
    r = np.sqrt(1.0 + u * u)
    d = np.array([k_minus_e(square) for square in u * u])
    depth, bend = influence(distance, width, a)
    assert depth == pytest.approx(np.mean(2.0 * r * d) * width, rel=2e-3)
    assert bend == pytest.approx(np.mean(d / r) * width / a**2, rel=2e-3)


def test_difference_of_the_elliptic_integrals():
    from scipy.special import ellipe, ellipkm1

    for u in np.geomspace(1e-4, 40.0, 60):
        rest = u * u / (1.0 + u * u)
        wanted = ellipkm1(rest) - ellipe(1.0 - rest)
        assert k_minus_e(u * u) == pytest.approx(wanted, abs=6e-8)


@pytest.fixture(scope="module")
def tread():
    """A pose whose patch is nearly an ellipse in one plane."""
    z, roll = lowered(0.003, 5e-5)
    return 0.003, z, roll


def test_an_elliptic_patch_is_hertz(tread):
    """On the tread at 3 mm curvature changes little over the patch: force 0.3 %, axes 2 %."""
    (hertz,), (strips,) = (left_force(*tread, normal=n)[1] for n in ("hertz", "strips"))
    assert strips.normal_force == pytest.approx(hertz.normal_force, rel=3e-3)
    assert strips.a == pytest.approx(hertz.a, rel=0.02)
    assert strips.b == pytest.approx(hertz.b, rel=0.02)
    assert strips.energy == pytest.approx(hertz.energy, rel=0.01)
    for name in ("wheel_y", "rail_y"):
        assert getattr(strips, name) == pytest.approx(getattr(hertz, name), abs=1e-4)


@pytest.mark.parametrize("slip", [0.002, 0.02, 0.2])
def test_creep_over_strips_is_fastsim_on_an_ellipse(tread, slip):
    """The same theory on strips of equal width: 3 % of mu N between the grids."""
    y, z, roll = tread
    velocity = (20.0, slip, 0.0, 0.0, (20.0 + 0.5 * slip) / 0.4605, 0.0)
    forces = contact_forces(
        WHEELSET, TRACK, (0, y, z, roll, 0, 0), velocity,
        normal="strips", creep="fastsim", cells_along=20,
    )  # fmt: skip
    (patch,) = forces.left
    fx, fy, mz = creep_force(
        "fastsim", patch.creep_x, patch.creep_y, patch.spin, patch.a, patch.b,
        patch.normal_force, 0.3, 82e9, 0.28, cells_along=20, cells_across=20,
    )  # fmt: skip
    limit = 0.3 * patch.normal_force
    assert math.hypot(patch.fx - fx, patch.fy - fy) < 0.03 * limit
    assert abs(patch.mz - mz) < 0.03 * limit * math.sqrt(patch.a * patch.b)


@pytest.mark.parametrize("yaw", [0.0, 0.005])
@pytest.mark.parametrize("name", ["throat", "R13 in R13", "flange root"])
def test_creep_over_strips_against_the_exact_law_on_the_like_ellipse(name, yaw):
    """Two ways to the creep force of a patch with large spin: 2 % of mu N apart.

    One is rough about elasticity, the other about the outline and the fanning normals.
    """
    y, depth = POSES[name]
    geometry = contact_geometry(WHEELSET, TRACK, [y], yaw)
    roll = float(geometry.roll[0])
    axle = np.array([-math.sin(yaw), math.cos(yaw), math.sin(roll)])
    velocity = (20.0, 0.0, 0.0, *(20.0 / 0.4605 * axle))
    pose = (0, y, float(geometry.z[0]) - depth, roll, 0, yaw)
    sums = []
    for creep in ("fastsim", "exact"):
        forces = contact_forces(WHEELSET, TRACK, pose, velocity, normal="strips", creep=creep)
        sums.append([(p.fx, p.fy, p.normal_force) for p in forces.left])
    over_strips, on_ellipse = (np.sum(rows, axis=0) for rows in sums)
    limit = 0.3 * on_ellipse[2]
    assert np.hypot(*(over_strips - on_ellipse)[:2]) < 0.02 * limit


def test_force_is_nearly_the_gradient_of_the_energy():
    """Each strip's force is along its own normal: within 2 % of the energy's gradient."""
    for y in (0.0, 0.003, 0.0048, 0.006, 0.0062, 0.007):
        z, roll = lowered(y, 6e-5)

        def of(q):
            return contact_forces(
                WHEELSET, TRACK, (0, q[0], q[1], q[2], 0, 0), ROLLING, normal="strips", friction=0.0
            )

        def energy(q):
            forces = of(q)
            return sum(p.energy for p in (*forces.left, *forces.right))

        pose = np.array([y, z, roll])
        steps = 2e-6 * np.eye(3)
        slope = [(energy(pose - d) - energy(pose + d)) / 4e-6 for d in steps]
        forces = of(pose)
        found = np.array([forces.force[1], forces.force[2], forces.moment[0]])
        size = abs(forces.force[2])
        assert np.abs(slope - found).max() < 0.02 * size


def test_sliding_strips_transmit_friction():
    """Full sliding: the creep force is mu times the load, against the slip, in every plane."""
    y, depth = POSES["R13 in R13"]
    z, roll = lowered(y, depth)
    pose = (0, y, z, roll, 0, 0)
    velocity = (20.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    options = {"normal": "strips", "creep": "fastsim"}
    rubbing = contact_forces(WHEELSET, TRACK, pose, velocity, friction=0.3, **options)
    smooth = contact_forces(WHEELSET, TRACK, pose, velocity, friction=0.0, **options)
    load = sum(p.normal_force for p in (*smooth.left, *smooth.right))
    # Normals that fan out by 24 degrees make the vector sum up to 2 % less than the load.
    assert rubbing.force[0] == pytest.approx(-0.3 * load, rel=0.025)
    assert rubbing.force[1:] == pytest.approx(smooth.force[1:], abs=1e-3 * load)
