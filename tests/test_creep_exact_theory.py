"""The exact law against closed forms: Carter, Kalker's coefficients, full sliding, symmetry."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest

from exudyn_wheelset.creep import creep_force
from exudyn_wheelset.creep.cerruti import influence
from exudyn_wheelset.creep.exact import tractions

LOAD, FRICTION, SHEAR, POISSON = 80e3, 0.3, 82e9, 0.28
LIMIT = LOAD * FRICTION
KALKER = Path(__file__).parent / "reference" / "kalker_coefficients.csv"


def exact(creep_x, creep_y, spin, a, b, poisson=POISSON, along=30, across=30):
    cells = {"cells_along": along, "cells_across": across}
    return creep_force(
        "exact", creep_x, creep_y, spin, a, b, LOAD, FRICTION, SHEAR, poisson, **cells
    )


def carter(creep):
    """Force over mu N of a patch a << b, each strip by Carter; creep over that of saturation.

    F. W. Carter, On the action of a locomotive driving wheel, 1926. A strip of load N' and
    half-length a sqrt(1 - t^2) has F = mu N' (1 - (1 - u)^2), u = creep/sqrt(1 - t^2) up to 1.
    """
    t = (np.arange(20000) + 0.5) / 20000
    edge = 1 - t * t
    return np.mean(1.5 * edge * (1 - (1 - np.minimum(1, creep / np.sqrt(edge))) ** 2))


@pytest.mark.parametrize("along", [20, 40, 80])
def test_carter_in_the_strip_limit(along):
    """Longitudinal (plane strain) and lateral (antiplane) creepage; the error is of first order."""
    a, b = 1e-3, 0.1
    saturation = 2 * FRICTION * 1.5 * LOAD / (math.pi * a * b) / SHEAR
    u = np.array([0.1, 0.3, 0.6, 0.9, 1.2])
    want = np.array([carter(value) for value in u])
    force_x = exact(u * saturation * (1 - POISSON), 0, 0, a, b, along=along, across=20)[0]
    force_y = exact(0, u * saturation, 0, a, b, along=along, across=20)[1]
    for force in (force_x, force_y):
        error = -force / LIMIT - want
        # at most 0.3 over the cells: halved with them
        assert np.abs(error).max() < 0.3 / along
        # sliding everywhere, but elastic slip still turns the tractions at the edge a little
        assert abs(error[-1]) < 2e-5


def slopes(a, b, poisson, cells):
    """Kalker's coefficients C11, C22, C23 (force of spin), C23 (moment of creepage) of the grid."""
    tiny = 1e-9
    unit = -SHEAR * a * b * tiny
    length = math.sqrt(a * b)
    along = exact(tiny, 0, 0, a, b, poisson, cells, cells)
    lateral = exact(0, tiny, 0, a, b, poisson, cells, cells)
    turning = exact(0, 0, tiny, a, b, poisson, cells, cells)
    return np.array(
        [
            along[0] / unit,
            lateral[1] / unit,
            turning[1] / (unit * length),
            -lateral[2] / (unit * length),
            turning[2] / (unit * length**2),
        ]
    )


with KALKER.open() as _file:
    ROWS = list(csv.DictReader(_file))


@pytest.mark.parametrize("row", ROWS[::3], ids=lambda row: row["axis_ratio"])
@pytest.mark.parametrize(("column", "poisson"), [("nu0", 0.0), ("nu025", 0.25), ("nu05", 0.5)])
def test_kalkers_coefficients(row, column, poisson):
    """Richardson's extrapolation from 24 and 48 cells: the grid's own error is 0.5 to 3 %."""
    kind, value = row["axis_ratio"].split("=")
    ratio = float(value) if kind == "a/b" else 1 / float(value)
    a, b = 5e-3 * math.sqrt(ratio), 5e-3 / math.sqrt(ratio)
    coarse, fine = slopes(a, b, poisson, 24), slopes(a, b, poisson, 48)
    got = 2 * fine - coarse
    want = np.array(
        [float(row[f"{name}_{column}"]) for name in ("C11", "C22", "C23", "C23", "C33")]
    )
    # Kalker's table has two or three digits, C23 beside b/a = 0.1 and C33 are its roughest
    np.testing.assert_allclose(got[:4], want[:4], rtol=0.014)
    np.testing.assert_allclose(got[4], want[4], rtol=0.025)


def test_influence_of_a_cell_on_itself_and_far_away():
    """A unit square: mean of 1/r at its middle 4 asinh(1) (twice), far away a point force."""
    nu = 0.3
    xx, xy, yy = influence(60, 60, 1.0, 1.0, nu)
    # by symmetry A and B share the integral of 1/r, 4 asinh(1)
    np.testing.assert_allclose(xx[0, 60], 4 * math.asinh(1) * (1 - nu / 2), rtol=1e-13)
    np.testing.assert_allclose(yy[0, 60], xx[0, 60], rtol=1e-13)
    x, y = 40.0, 30.0
    # Cerruti: ((1 - nu)/r + nu x^2/r^3), nu x y/r^3; the cell's size enters as its square over r
    np.testing.assert_allclose(xx[30, 100], (1 - nu) / 50 + nu * x**2 / 50**3, rtol=1e-4)
    np.testing.assert_allclose(yy[30, 100], (1 - nu) / 50 + nu * y**2 / 50**3, rtol=1e-4)
    np.testing.assert_allclose(xy[30, 100], nu * x * y / 50**3, rtol=1e-4)


@pytest.mark.parametrize("angle", np.linspace(0, np.pi, 7))
def test_full_sliding(angle):
    force = exact(math.cos(angle), math.sin(angle), 0, 6e-3, 3e-3)
    want = -LIMIT * np.array([math.cos(angle), math.sin(angle)])
    # elastic slip turns the tractions a little, less than in proportion to 1/creepage
    np.testing.assert_allclose(force[:2], want, atol=2e-5 * LIMIT)


def test_moment_of_full_turning_slip():
    """Very large spin alone: all of the patch turns, M = -(3 pi/16) mu N a for a = b."""
    moment = exact(0, 0, 300.0, 5e-3, 5e-3, along=60, across=60)[2]
    # the pole of slip moves off the middle a little still
    np.testing.assert_allclose(moment, -3 * math.pi / 16 * LIMIT * 5e-3, rtol=2e-3)


def test_tractions_obey_friction():
    """No traction above its bound, adhesion at the leading edge, slip at the trailing edge."""
    p_x, p_y = np.zeros((30, 31)), np.zeros((30, 31))
    covered = tractions(0.3, 0.2, 0.4, 1.0, 1.0, POISSON, 30, 30, 1e-5, p_x, p_y)
    size = np.hypot(p_x, p_y)
    middle_of = (np.arange(30) + 0.5) / 15 - 1
    inside = 1 - middle_of[:, None] ** 2 - middle_of**2
    # Hertz's pressure in units of its peak, scaled so that the cells carry N exactly
    bound = np.zeros((30, 31))
    bound[:, 1:] = np.sqrt(np.maximum(inside, 0))
    bound *= 2 * np.pi / 3 * np.count_nonzero(inside > 0) / np.pi / bound.sum()
    assert np.all(size <= bound * (1 + 1e-9))
    slides = size > bound * (1 - 1e-9)
    middle = slides[15, 1:]
    assert middle[0] and not middle[-2]
    # the zones of slip and adhesion do not alternate on the middle strip
    assert np.count_nonzero(np.diff(middle.astype(int))) <= 2
    assert abs(covered - 1) < 0.02


STATES = [(4e-4, 3e-4, 0.1), (1e-3, -8e-4, 0.6), (0.0, 6e-4, 0.3), (5e-4, 5e-4, 0.0), (0, 0, 0.4)]


@pytest.mark.parametrize("state", STATES)
def test_mirror_images_are_exact(state):
    x, y, spin = state
    patch = {"a": 6e-3, "b": 4e-3, "along": 12, "across": 14}
    fx, fy, mz = exact(x, y, spin, **patch)
    assert exact(x, -y, -spin, **patch) == (fx, -fy, -mz)
    assert exact(-x, y, spin, **patch) == (-fx, fy, mz)
    assert exact(-x, -y, -spin, **patch) == (-fx, -fy, -mz)


@pytest.mark.parametrize("state", STATES)
def test_only_ratios_matter(state):
    """Lengths, loads and stiffness enter by xi G c^2/(mu N) and phi c alone."""
    x, y, spin = state
    one = np.array(exact(x, y, spin, 6e-3, 4e-3, along=12, across=12))
    cells = {"cells_along": 12, "cells_across": 12}
    other = creep_force(
        "exact",
        4 * x,
        4 * y,
        2 * spin,
        12e-3,
        8e-3,
        LOAD * 8,
        FRICTION * 2,
        SHEAR,
        POISSON,
        **cells,
    )
    np.testing.assert_allclose(np.array(other) / [16, 16, 32], one, rtol=1e-9, atol=1e-9)
