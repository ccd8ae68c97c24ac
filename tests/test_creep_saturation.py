"""Cubic saturation, saturated moments (creep/saturation.py), and a strip's cells that adhere."""

import math

import numpy as np
import pytest

from exudyn_wheelset import creep_force
from exudyn_wheelset.contact.layout import PARAMETERS, PATCH, SHARE
from exudyn_wheelset.contact.strip_creep import _patch_flexibilities, march
from exudyn_wheelset.creep import kalker_coefficients
from exudyn_wheelset.creep.fastsim import flexibilities, slip_step
from exudyn_wheelset.creep.saturation import (
    cubic_share,
    linear_force,
    linear_spin_moment,
    saturated_spin_moment,
)

A, B, MODULUS, POISSON, LIMIT = 5e-3, 3e-3, 82e9, 0.28, 2e4


def plain(kernel):
    return getattr(kernel, "py_func", kernel)


@pytest.mark.parametrize("u", [1e-6, 0.7, 2.0, 2.99, 3.01, 3.6, 50.0])
def test_cubic_saturation(u):
    expected = 1.0 - (1.0 - min(u, 3.0) / 3.0) ** 3
    assert u * plain(cubic_share)(u) == pytest.approx(expected, rel=1e-12, abs=1e-15)


def moment(creep_x, creep_y, spin, limit=LIMIT):
    return plain(saturated_spin_moment)(creep_x, creep_y, spin, A, B, limit, MODULUS, POISSON)


def creep_of(u):
    """Lateral creepage whose linear force is u mu N."""
    _, c22, _, _ = kalker_coefficients(A, B, POISSON)
    return u * LIMIT / (MODULUS * A * B * c22)


@pytest.mark.parametrize("u", [0.3, 1.5, 2.9, 3.1, 3.6, 8.0])
def test_moment_of_lateral_creepage(u):
    """The lead of slip over adhesion: Kalker's C23 on what friction has left, nothing in full slip.

    The force along does as much to it as one across.
    """
    c11, c22, c23, _ = kalker_coefficients(A, B, POISSON)
    lead = MODULUS * (A * B) ** 1.5 * c23
    left = max(1.0 - u / 3.0, 0.0) ** 3
    assert moment(0.0, creep_of(u), 0.0) == pytest.approx(lead * creep_of(u) * left, abs=1e-9)
    along = creep_of(u) * c22 / c11 * 0.8
    both = moment(along, 0.6 * creep_of(u), 0.0)
    assert both == pytest.approx(lead * 0.6 * creep_of(u) * left, abs=1e-9)


def test_moment_of_spin_alone():
    """Linear at first; (3 pi/16) mu N sqrt(ab) when all turns."""
    _, _, _, c33 = kalker_coefficients(A, B, POISSON)
    small = 1e-4
    linear = plain(linear_spin_moment)(0.0, small, A, B, MODULUS, POISSON)
    assert linear == pytest.approx(-MODULUS * (A * B) ** 2 * c33 * small, rel=1e-12)
    assert moment(0.0, 0.0, small) == pytest.approx(linear, rel=1e-3)
    turning = 3.0 * math.pi / 16.0 * LIMIT * math.sqrt(A * B)
    # Spin presses to the side as well: that share of the friction does not turn.
    _, _, c23, _ = kalker_coefficients(A, B, POISSON)
    aside = math.sqrt(A * B) * c23 * turning / (math.sqrt(A * B) ** 2 * c33) / LIMIT
    share = 1.0 / math.sqrt(1.0 + aside**2)
    assert moment(0.0, 0.0, 1e4) == pytest.approx(-turning * share, rel=1e-9)
    assert moment(0.0, 0.0, -1e4) == pytest.approx(turning * share, rel=1e-9)


def test_linear_force_and_moment_do_as_much_work_either_way():
    """Forces and moments of creepages are a symmetric matrix but for C23's sign (Kalker 1967)."""
    _, force = plain(linear_force)(0.0, 0.0, 1.0, A, B, MODULUS, POISSON)
    assert plain(linear_spin_moment)(1.0, 0.0, A, B, MODULUS, POISSON) == pytest.approx(-force)


@pytest.mark.parametrize("cells", [4, 7, 20])
def test_cells_of_a_strip_that_adhere(cells):
    """Tractions of the middles of cells are exact: sums are the midpoint rule's on parabolas."""
    step = 2.0 / cells
    parabola, square = 4.0 / 3.0 + step**2 / 6.0, 2.0 / 3.0 - step**2 / 6.0
    small = 1e-9
    x, y, lever = plain(march)(small, 2.0 * small, 0.0, cells)
    assert x == pytest.approx(-small * 0.5 * cells**2, rel=1e-9)
    assert y == pytest.approx(-small * cells**2, rel=1e-9)
    assert lever == pytest.approx(2.0 * small * square / step**2, rel=1e-9)
    x, y, lever = plain(march)(0.0, 0.0, small, cells)
    assert x == 0.0
    assert y == pytest.approx(-small * 0.5 * parabola / step**2, rel=1e-9)
    assert lever == pytest.approx(0.0, abs=1e-9 * abs(y))
    # All slides against the creepage: the sum of the bound, a parabola less its cells' bend.
    x, y, lever = plain(march)(300.0, -400.0, 0.0, cells)
    assert (x, y) == (pytest.approx(-0.8 / step), pytest.approx(16.0 / 15.0 / step))
    assert lever == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("cells", [4, 10])
def test_spin_alone_while_all_adheres(cells):
    """Lateral force of small spin: cells and strips are midpoint rules whose sums are known."""
    strips = 9
    tiny = (0.0, 0.0, 1e-6, A, B, 1e9, 0.3, MODULUS, POISSON)
    options = {"cells_across": strips, "flexibilities": "three"}
    step = 2.0 / cells
    coarse = creep_force("fastsim", *tiny, cells_along=cells, **options)[1]
    fine = creep_force("fastsim", *tiny, cells_along=400, **options)[1]
    expected = (4.0 / 3.0 + step**2 / 6.0) / (4.0 / 3.0 + 0.005**2 / 6.0)
    assert coarse / fine == pytest.approx(expected, rel=1e-9)


def integrated(p_x, p_y, rise_x, rise_y, change, before, bound, count=40000):
    """The traction carried over a step in small ones: it sticks, and is held at the bound."""
    d = 1.0 / count
    for k in range(count):
        middle = (k + 0.5) * d
        p_x -= rise_x * d
        p_y -= (rise_y + change * (0.5 - middle)) * d
        most = before + (bound - before) * (k + 1.0) * d
        size = math.hypot(p_x, p_y)
        if size > most:
            p_x *= most / size
            p_y *= most / size
    return p_x, p_y


@pytest.mark.parametrize(
    "start",
    [
        (-0.5, -0.3, 0.4, 0.2, 0.0, 0.9, 0.7),
        (-0.6, 0.2, 0.5, -0.3, 0.0, 0.7, 0.8),
        (-0.3, -0.4, 0.2, 0.6, 0.0, 0.5, 0.45),
        (0.3, 0.4, -0.2, -0.6, 0.0, 0.5, 0.6),
        (-0.4, 0.28, 0.1, -0.1, 0.02, 0.5, 0.48),
        (0.5, 0.0, 9.0, 4.0, 0.0, 0.5, 0.4),
    ],
)
def test_a_step_that_meets_the_bound(start):
    """Stick to the bound, then slip along it: closed forms against small steps of the same."""
    p_x, p_y = plain(slip_step)(*start)
    expected = integrated(*start)
    assert math.hypot(p_x, p_y) == pytest.approx(start[-1], rel=1e-12)
    # The bound is taken in its mean over the part that slips, the turning slip in one place.
    assert (p_x, p_y) == (
        pytest.approx(expected[0], abs=0.015 * start[-1]),
        pytest.approx(expected[1], abs=0.015 * start[-1]),
    )


@pytest.mark.parametrize("kind", [1.0, 2.0, 3.0])
def test_flexibilities_while_two_lobes_merge(kind):
    """Those of either ellipse with its own load, and in between in proportion to the separation."""
    share, patch, parameters = (np.zeros(1, record)[0] for record in (SHARE, PATCH, PARAMETERS))
    patch.creep_x, patch.creep_y, patch.spin, patch.friction = 1e-3, -2e-3, 0.1, 0.3
    share.damping = 1.2
    share.own.force, share.own.a, share.own.b = 3e4, 5e-3, 3e-3
    share.merged.force, share.merged.a, share.merged.b = 7e4, 6e-3, 9e-3
    parameters.shear_modulus, parameters.poisson = MODULUS, POISSON
    parameters.law_parameters[2] = kind

    def at(separation):
        share.separation = separation
        return np.array(plain(_patch_flexibilities)(share, patch, parameters))

    def of(ellipse):
        limit = 0.3 * 1.2 * ellipse.force
        return np.array(
            plain(flexibilities)(
                1e-3, -2e-3, 0.1, ellipse.a, ellipse.b, limit, MODULUS, POISSON, kind
            )
        )  # fmt: skip

    np.testing.assert_allclose(at(1.0), of(share.own), rtol=1e-12)
    np.testing.assert_allclose(at(0.0), of(share.merged), rtol=1e-12)
    np.testing.assert_allclose(at(0.3), 0.3 * at(1.0) + 0.7 * at(0.0), rtol=1e-12)
