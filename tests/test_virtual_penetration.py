"""Virtual penetration (Piotrowski and Chollet 2005, equations 8 to 16) against plain quadrature.

On a cone on a round rail head the gap is A x^2 + B y^2, so that the zone of virtual penetration
is an ellipse and the two integrals are written down here; its load on a circle is 4.9 % more than
Hertz's, the known price of one number for all shapes.
"""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ellipe, ellipk

from exudyn_wheelset import Track, Wheelset, contact_forces, contact_geometry
from exudyn_wheelset.contact.hertz import hertz_from_approach
from exudyn_wheelset.contact.layout import HEADER, SIDE
from exudyn_wheelset.contact.patch_curvature import patch_half_curvatures
from exudyn_wheelset.contact.search import VIRTUAL
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.contact.virtual_penetration import elliptic_k_minus_e

WHEELSET = Wheelset(mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=0.46, wheel="cone_1_20")
TRACK = Track("UIC60", inclination=0.0)
MODULUS = 82.0e9 / 0.72


def plain(kernel):
    return getattr(kernel, "py_func", kernel)


@pytest.mark.parametrize("m", [0.0, 1e-6, 0.03, 0.5, 0.97, 1.0 - 1e-9])
def test_difference_of_the_complete_integrals(m):
    found = plain(elliptic_k_minus_e)(m)
    assert found == pytest.approx(ellipk(m) - ellipe(m), rel=1e-8, abs=1e-16)


def force_by_quadrature(A, B, depth):
    end = math.sqrt(VIRTUAL * depth / B)

    def square(y):
        return (VIRTUAL * depth - B * y * y) / A

    def inner(y):
        total = square(y) + y * y
        m = square(y) / total
        return 4.0 * math.sqrt(total) * (ellipk(m) - ellipe(m))

    first, _ = quad(lambda y: math.pi * square(y), 0.0, end)
    second, _ = quad(inner, 0.0, end, limit=200)
    return math.pi * MODULUS * depth * first / second


def test_a_round_patch_has_five_percent_more_than_hertz():
    hertz = hertz_from_approach(1.3, 1.3, 8e-5, 82e9, 0.28)[0]
    assert force_by_quadrature(1.3, 1.3, 8e-5) / hertz == pytest.approx(1.049, abs=1e-3)


@pytest.mark.parametrize("depth", [6e-6, 2e-5])
def test_a_cone_on_a_round_head(depth):
    rigid = contact_geometry(WHEELSET, TRACK, [0.0])
    pose = (0.0, 0.0, rigid.z[0] - depth, rigid.roll[0], 0.0, 0.0)
    found = contact_forces(
        WHEELSET, TRACK, pose, (0.0,) * 6, "virtual-penetration", friction=0.0
    )  # fmt: skip
    (patch,) = found.left
    head = 0.3 if abs(patch.rail_y) < 0.0105 - patch.b else 0.08
    A, B = 0.5 * math.cos(patch.angle) / patch.radius, 0.5 / head
    # Seven points a side; the normal turns by B b over the patch.
    expected = force_by_quadrature(A, B, patch.penetration)
    assert patch.normal_force == pytest.approx(expected, rel=2e-3)


def test_mean_curvature_of_a_round_head_is_its_own():
    """16/9 depth^3 over the area squared is B of a parabola, at rest and on the deeper lobe."""
    rigid = contact_geometry(WHEELSET, TRACK, [0.0, 1e-3])
    table = contact_tables(WHEELSET, TRACK)
    found = patch_half_curvatures(table, rigid.y, rigid.roll, rigid.z, 2e-5)
    (patch,) = contact_forces(
        WHEELSET, TRACK, (0.0, 0.0, rigid.z[0] - 2e-5, rigid.roll[0], 0.0, 0.0), (0.0,) * 6
    ).left
    assert 0.0105 + patch.b < abs(patch.rail_y) < 0.025  # on R80, beside R300
    np.testing.assert_allclose(found[0], 0.5 / 0.08, rtol=2e-3)
    assert found.shape == (2, 2)
    # Mirrored, left and right change places.
    mirrored = patch_half_curvatures(table, -rigid.y, -rigid.roll, rigid.z, 2e-5)
    np.testing.assert_allclose(mirrored, found[:, ::-1], rtol=1e-9)
    above = patch_half_curvatures(table, rigid.y, rigid.roll, rigid.z, -1e-5)
    assert np.all(np.isnan(above))


def test_deeper_of_two_lobes_gives_the_curvature():
    """S1002 beside a jump: where throat and tread touch, B is that of whichever is deeper."""
    wheelset, track = Wheelset(1813.0, (1120.0, 112.0, 1120.0), 0.46, "S1002"), Track("UIC60")
    table = contact_tables(wheelset, track)
    assert table[:HEADER].view(SIDE)[0].radius == 0.46
    for shift in (4.6e-3, 5.2e-3):
        rigid = contact_geometry(wheelset, track, [shift])
        pose = (0.0, shift, rigid.z[0] - 6e-5, rigid.roll[0], 0.0, 0.0)
        forces = contact_forces(wheelset, track, pose, (0.0,) * 6, "hertz", friction=0.0)
        found = patch_half_curvatures(table, rigid.y, rigid.roll, rigid.z, 6e-5)[0]
        for hand, patches in enumerate((forces.left, forces.right)):
            deepest = max(patches, key=lambda patch: patch.penetration)
            along = 0.5 * math.cos(deepest.angle) / deepest.radius
            _, a, b = hertz_from_approach(
                along, found[hand], deepest.penetration, 82e9, 0.28
            )  # fmt: skip
            assert b / a == pytest.approx(deepest.b / deepest.a, rel=0.02)
