"""Pieces of Ritz's stored energy (contact/ritz.py), each by its definition and by slow quadrature.

Energy and shape of one semi-ellipsoid by complete elliptic integrals; two in each other's field by
convolution and quadrature; means of a cubic penetration in closed form; the equations as the
gradient of the energy written down in this file; lines of force by virtual work.
"""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar
from scipy.special import ellipk

from exudyn_wheelset.contact import ellipsoids, gap_spline, load_sets
from exudyn_wheelset.contact.layout import (
    COUPLING,
    GAP_COEFFICIENT,
    GAP_DEPTH,
    GAP_FIRST,
    GAP_SECOND,
    GAP_THIRD,
    LOAD,
    LOBE,
)

MODULUS = 82.0e9 / 0.72
SHAPES = [(6e-3, -1.5), (5e-3, 0.0), (3e-3, 0.4), (2e-3, 2.43)]


def plain(kernel):
    """The function as Python, which calls other kernels compiled."""
    return getattr(kernel, "py_func", kernel)


def load_of(b, t, place=0.0, along=1.1):
    load = np.zeros(1, LOAD)[0]
    load.place, load.b, load.t, load.along = place, b, t, along
    plain(ellipsoids.fill)(load, MODULUS)
    return load


def slope(function, x, step):
    """Central difference quotient of fourth order."""
    one, two = (np.subtract(function(x + k * step), function(x - k * step)) for k in (1, 2))
    return (8.0 * one - two) / (12.0 * step)


def self_displacement(a, b):
    larger, smaller = max(a, b), min(a, b)
    return 6.0 * ellipk(1.0 - (smaller / larger) ** 2) / (5.0 * math.pi * MODULUS * larger)


def taken_energy(force, b, along):
    """Least energy over a, and the a where it is."""

    def taken(log_a):
        a = math.exp(log_a)
        return force * along * a * a / 5.0 + 0.5 * force**2 * self_displacement(a, b)

    best = minimize_scalar(taken, (math.log(b) - 1.0, math.log(b) + 1.0), tol=1e-14)
    return best.fun, math.exp(best.x)


@pytest.mark.parametrize(("b", "t"), SHAPES)
def test_energy_that_one_ellipse_takes(b, t):
    load = load_of(b, t)
    taken, a = taken_energy(load.force, b, load.along)
    assert load.force * load.work == pytest.approx(taken, rel=1e-6)
    assert load.a == pytest.approx(a, rel=1e-5)  # from a minimum: root of the energy's error
    assert load.lateral == pytest.approx(load.along * math.exp(t), rel=1e-12)
    by_force = slope(lambda f: taken_energy(f, b, load.along)[0], load.force, 1e-2 * load.force)
    assert load.own == pytest.approx(by_force, rel=1e-6)
    by_b = slope(lambda x: taken_energy(load.force, x, load.along)[0], b, 1e-2 * b)
    assert -0.4 * load.force * load.width / b == pytest.approx(by_b, rel=1e-5)
    depth = 1.5 * load.force * ellipk(1.0 - (min(a, b) / max(a, b)) ** 2) / max(a, b)
    assert load.approach == pytest.approx(depth / (math.pi * MODULUS), rel=1e-5)


@pytest.mark.parametrize(("b", "t"), SHAPES)
def test_derivatives_of_one_ellipse(b, t):
    load = load_of(b, t)
    # Splines of the shape functions have steps of 1e-4 in their third derivative.
    assert load.force_by_t == pytest.approx(
        slope(lambda x: math.log(load_of(b, x).force), t, 1e-3), rel=1e-7
    )
    assert load.own_by_t == pytest.approx(slope(lambda x: load_of(b, x).own, t, 1e-3), rel=1e-7)
    assert load.ratio_by_t == pytest.approx(
        slope(lambda x: math.log(load_of(b, x).a / b), t, 1e-3), rel=1e-7
    )
    assert load.force_by_tt == pytest.approx(
        slope(lambda x: load_of(b, x).force_by_t, t, 1e-3), rel=1e-4, abs=1e-5
    )
    assert load.ratio_by_tt == pytest.approx(
        slope(lambda x: load_of(b, x).ratio_by_t, t, 1e-3), rel=1e-3, abs=1e-5
    )


NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)


def convolution(one, two, offset):
    """Of two parabolas 3/(4 h) (1 - u^2/h^2): Gauss's rule is exact on a polynomial."""
    low, high = max(-one, offset - two), min(one, offset + two)
    if high <= low:
        return 0.0
    u = 0.5 * (low + high) + 0.5 * (high - low) * NODES
    values = (1.0 - (u / one) ** 2) * (1.0 - ((offset - u) / two) ** 2)
    return 0.5 * (high - low) * float(WEIGHTS @ values) * 0.5625 / (one * two)


@pytest.mark.parametrize(
    "at", [(1.3, 0.7, 0.4), (0.7, 1.3, 0.4), (1.3, 0.7, 1.1), (0.6, 0.9, 0.8), (1.0, 0.8, 1.7)]
)
def test_convolution_of_parabolas_and_its_derivatives(at):
    found = plain(ellipsoids.overlap)(*at)
    assert found[0] == pytest.approx(convolution(*at), rel=1e-12)

    def by(which, function):
        def along(x):
            return function(*at[:which], x, *at[which + 1 :])

        return slope(along, at[which], 1e-3)

    np.testing.assert_allclose(found[1:4], [by(k, convolution) for k in range(3)], atol=1e-9)
    second = [by(k, lambda *x: plain(ellipsoids.overlap)(*x)[1:4]) for k in range(3)]
    expected = [
        second[0][0], second[1][0], second[1][1], second[0][2], second[1][2], second[2][2],
    ]  # fmt: skip
    np.testing.assert_allclose(found[4:], expected, atol=2e-9)


def test_parabolas_that_do_not_meet():
    assert plain(ellipsoids.overlap)(0.5, 0.7, 1.3) == (0.0,) * 10


def projected(load, theta):
    return math.hypot(load.a * math.cos(theta), load.b * math.sin(theta))


def mean_by_quadrature(one, two):
    """Mean of 1/(pi E* distance) over both loads, by Fourier's slices."""
    r = abs(two.place - one.place)

    def at(theta):
        return convolution(projected(one, theta), projected(two, theta), r * math.sin(theta))

    def gone(theta):
        return r * math.sin(theta) - projected(one, theta) - projected(two, theta)

    end = 0.5 * math.pi
    if gone(end) > 0.0:
        end = brentq(gone, 0.0, end)
    return 2.0 / (math.pi * MODULUS) * quad(at, 0.0, end, limit=200, epsabs=1e-9)[0]


PAIRS = [
    (load_of(4e-3, 0.3), load_of(3e-3, -0.8, 5e-3), 1e-3),
    (load_of(3e-3, -0.8, 5e-3), load_of(4e-3, 0.3), 1e-3),
    (load_of(4e-3, 0.9), load_of(2e-3, 1.8, 1e-3), 1e-3),
    (load_of(2e-3, -1.0), load_of(1e-3, 0.2, 2e-2), 1e-2),
]


def mean_of(one, two):
    return plain(ellipsoids.mean_distance)(
        two.place - one.place, one.a**2, one.b**2, two.a**2, two.b**2, MODULUS
    )


@pytest.mark.parametrize("case", range(len(PAIRS)))
def test_two_ellipses_in_each_others_field(case):
    one, two, near = PAIRS[case]
    expected = mean_by_quadrature(one, two)
    assert mean_of(one, two) == pytest.approx(expected, rel=near)
    field = plain(ellipsoids.field)(two.place, one, MODULUS)
    point = SimpleNamespace(place=two.place, a=1e-6, b=1e-6)
    # Eight points see a place worse than a mean over a patch.
    assert field == pytest.approx(one.force * mean_by_quadrature(one, point), rel=0.06)


def test_the_field_of_a_round_ellipse_and_far_away():
    load = load_of(4e-3, 0.0)
    at = plain(ellipsoids.field)
    # Displacement in the middle of Hertz's circle; 1/(pi E* r) far away.
    assert at(0.0, load, MODULUS) == pytest.approx(0.75 * load.force / (MODULUS * 4e-3), rel=1e-4)
    expected = load.force / (math.pi * MODULUS * 0.1)
    assert at(0.1, load, MODULUS) == pytest.approx(expected, rel=0.06)
    assert at(-0.1, load, MODULUS) == pytest.approx(at(0.1, load, MODULUS), rel=1e-12)


def coupling_of(one, two):
    record = np.zeros(1, COUPLING)[0]
    plain(ellipsoids.coupling)(one, two, MODULUS, record)
    return record


def moved(load, by, name):
    """The load by a little wider (at constant t), of another t, or further along."""
    b, t, place = load.b, load.t, load.place
    if name == "l":
        b *= math.exp(by)
    elif name == "t":
        t += by
    else:
        place += by
    return load_of(b, t, place)


@pytest.mark.parametrize("case", range(len(PAIRS)))
def test_coupling_is_the_mean_and_its_derivatives(case):
    one, two, _ = PAIRS[case]
    k = coupling_of(one, two)
    assert k.total == pytest.approx(mean_of(one, two), rel=1e-12)
    size = k.total
    near = 2e-6 * size  # of difference quotients across the parabolas' corners
    for name, first, second in (("l", k.l1, k.l2), ("t", k.t1, k.t2)):
        step = 1e-4
        assert first == pytest.approx(
            slope(lambda x, n=name: mean_of(moved(one, x, n), two), 0.0, step), abs=near
        )
        assert second == pytest.approx(
            slope(lambda x, n=name: mean_of(one, moved(two, x, n)), 0.0, step), abs=near
        )
    reach = max(one.b, two.b)
    by_r = slope(lambda x: mean_of(one, moved(two, x * reach, "c")), 0.0, 1e-4)
    assert k.r * reach == pytest.approx(by_r, abs=near)


@pytest.mark.parametrize("case", range(3))
def test_second_derivatives_of_the_coupling(case):
    """At constant places of the quadrature: differences of the sums' first derivatives."""
    one, two, _ = PAIRS[case]
    k = coupling_of(one, two)
    reach = abs(two.place - one.place)
    q = 2.0 * (one.a**2 + two.a**2)
    ratio = math.sqrt(q / (q + reach**2))
    sums = plain(ellipsoids._integrals)

    def first(one, two, r):
        found = sums(
            one.a**2, one.b**2, one.ratio_by_t, one.ratio_by_tt,
            two.a**2, two.b**2, two.ratio_by_t, two.ratio_by_tt, r, ratio, ratio / MODULUS,
        )  # fmt: skip
        return np.array(found[1:6])  # by r, l1, t1, l2, t2

    side = 1.0 if two.place >= one.place else -1.0
    near = 3e-4 * k.total * np.array([1.0 / reach, 1.0, 1.0, 1.0, 1.0])
    by_r = slope(lambda x: first(one, two, x), reach, 1e-4 * reach)
    expected = np.array([k.rr, side * k.rl1, side * k.rt1, side * k.rl2, side * k.rt2])
    np.testing.assert_array_less(np.abs(by_r - expected), near / reach)
    rows = {
        ("l", 0): [side * k.rl1, k.l1l1, k.l1t1, k.l1l2, k.l1t2],
        ("t", 0): [side * k.rt1, k.l1t1, k.t1t1, k.t1l2, k.t1t2],
        ("l", 1): [side * k.rl2, k.l1l2, k.t1l2, k.l2l2, k.l2t2],
        ("t", 1): [side * k.rt2, k.l1t2, k.t1t2, k.l2t2, k.t2t2],
    }
    for (name, which), row in rows.items():

        def at(x, name=name, which=which):
            pair = [one, two]
            pair[which] = moved(pair[which], x, name)
            return first(*pair, reach)

        np.testing.assert_array_less(np.abs(slope(at, 0.0, 1e-4) - row), near)


SPACING = 2e-4
CUBIC = np.polynomial.Polynomial([6e-5, -2e-3, -1.3, 60.0])  # over place [m]


def sampled(depths):
    """The six rows of a gap whose penetrations are given, in one range of nodes."""
    rows = np.zeros((6, len(depths)))
    rows[GAP_DEPTH] = depths
    plain(gap_spline._primitives)(
        rows[GAP_DEPTH], rows[GAP_COEFFICIENT], rows[GAP_FIRST], rows[GAP_SECOND], rows[GAP_THIRD]
    )
    return rows


def ranged(load, count):
    load.low, load.high = 2, count - 4
    return load


@pytest.mark.parametrize("b", [0.3e-3, 1.1e-3, 4.13e-3])
@pytest.mark.parametrize("place", [-0.73e-3, 0.1e-3, 0.61e-3])
def test_means_of_a_cubic(b, place):
    """Over 3/4 (1 - x^2) the mean of x^2 is 1/5 and of odd powers none."""
    start, count = -7e-3, 71
    load = ranged(load_of(b, 0.0, place), count)
    rows = sampled(CUBIC(start + SPACING * np.arange(count)))
    plain(gap_spline.average)(rows, load, start, 1.0 / SPACING)
    p, p1, p2, p3 = (CUBIC.deriv(k)(place) if k else CUBIC(place) for k in range(4))
    found = [load.average, load.slope * b, load.bend * b * b]
    found += [load.spread, load.slope_spread * b, load.spread_spread]
    square = b * b
    expected = [
        p + 0.1 * square * p2, b * (p1 + 0.1 * square * p3), square * p2,
        0.2 * square * p2, 0.2 * square * b * p3, 0.2 * square * p2,
    ]  # fmt: skip
    # Means over few cells are differences of primitives: they lose (range/width)^3 of rounding.
    np.testing.assert_allclose(found, expected, atol=1e-15 * (14e-3 / b) ** 3 * 1e-4 + 1e-16)
    at = (place - start) / SPACING
    assert plain(gap_spline.spline_depth)(rows, load, at) == pytest.approx(p, rel=1e-12)


def test_primitives_are_integrals_of_the_spline():
    rng = np.random.default_rng(2)
    count = 30
    rows = sampled(rng.uniform(0.0, 1.0, count))
    load = ranged(load_of(1e-3, 0.0), count)
    at = plain(gap_spline.primitives_at)
    for place in (2.2, 5.71, 11.0, 19.4, 25.6):
        found = at(rows, load, place)
        assert found[0] == plain(gap_spline.spline_depth)(rows, load, place)
        by_place = slope(lambda x: np.array(at(rows, load, x)[1:]), place, 1e-3)
        np.testing.assert_allclose(by_place, found[:3], rtol=1e-7, atol=1e-7)
    for node in (3, 9, 26):
        before, after = (at(rows, load, node + e) for e in (-1e-12, 1e-12))
        np.testing.assert_allclose(before, after, rtol=1e-9, atol=1e-10)


@pytest.mark.parametrize("width", [0.4, 1.3, 2.6, 4.37, 9.2])
def test_parts_on_the_lines_give_the_mean(width):
    """The mean is linear in what is sampled; the parts on the lines are its coefficients."""
    rng = np.random.default_rng(3)
    start, count = -4e-3, 41
    depths = rng.uniform(0.0, 1.0, count)
    rows = sampled(depths)
    work = SimpleNamespace(parts=np.zeros((3, count)))
    for place in rng.uniform(-1.5e-3, 1.5e-3, 8):
        load = ranged(load_of(width * SPACING, 0.0, place), count)
        plain(gap_spline.average)(rows, load, start, 1.0 / SPACING)
        first, lines = plain(gap_spline.line_weights)(load, start, 1.0 / SPACING, work)
        parts = work.parts[0, :lines].copy()
        assert parts @ depths[first : first + lines] == pytest.approx(load.average, abs=1e-9)
        places = start + SPACING * np.arange(first, first + lines)
        assert parts.sum() == pytest.approx(1.0, abs=1e-12)
        assert parts @ places == pytest.approx(place, abs=1e-12)
        second = place**2 + 0.2 * load.b**2
        assert parts @ places**2 == pytest.approx(second, abs=1e-14)


@pytest.mark.parametrize("beyond", [-1.0, 1.0])
def test_a_load_beyond_the_range_has_its_parts_inside(beyond):
    start, count = -4e-3, 41
    work = SimpleNamespace(parts=np.zeros((3, count + 9)))
    for place in (3e-3, 3.6e-3, 6e-3):
        load = ranged(load_of(1.5e-3, 0.0, beyond * place), count)
        first, lines = plain(gap_spline.line_weights)(load, start, 1.0 / SPACING, work)
        assert first >= 0
        np.testing.assert_allclose(work.parts[0, count - first : lines], 0.0, atol=1e-12)
        assert work.parts[0, :lines].sum() == pytest.approx(1.0, abs=1e-9)


def test_zone_of_a_parabola():
    """Where it has fallen to the level; a chord of its cells is h^2/8 of bend off."""
    peak, half = 20.3, 8.4
    depths = 1.0 - ((np.arange(41) - peak) / half) ** 2
    lobe = np.zeros(1, LOBE)[0]
    lobe.low, lobe.high = 2, 37
    begin, end = plain(gap_spline._zone)(depths, lobe, peak, 0.25)
    reach = half * math.sqrt(0.75)
    assert begin == pytest.approx(peak - reach, abs=0.02)
    assert end == pytest.approx(peak + reach, abs=0.02)
    lobe.low, lobe.high = 17, 24
    assert plain(gap_spline._zone)(depths, lobe, peak, 0.25) == (17.0, 24.0)


def test_reach_of_a_scanned_parabola():
    peak, half = 9.8e-3, 4.1e-3
    arcs = 2e-3 + 0.5e-3 * np.arange(31)
    depths = 1.0 - ((arcs - peak) / half) ** 2
    lobe = np.zeros(1, LOBE)[0]
    lobe.node, lobe.arc = int(np.argmax(depths)) + 5, peak
    kernel = plain(gap_spline._reach)
    for direction in (-1, 1):
        found = kernel(depths, np.concatenate([np.zeros(5), arcs]), 5, 35, lobe, 0.3, direction)
        assert found == pytest.approx(half * math.sqrt(0.7), abs=0.5e-3**2 / half)
        # Where the scan ends nothing more is known.
        near = kernel(depths, np.concatenate([np.zeros(5), arcs]), 18, 22, lobe, 0.3, direction)
        assert near >= 0.0


def test_gains_are_let_through_without_a_step():
    """Equation (2): s = 0 for small gains, s = g for large ones, s' continuous and s'' too."""
    blend = plain(load_sets.blend)
    gains = np.linspace(0.0, 0.08, 801)
    s, rate = np.array([blend(g) for g in gains]).T
    assert np.all(s[gains <= load_sets.NOTHING] == 0.0)
    np.testing.assert_allclose(s[gains >= load_sets.WHOLE], gains[gains >= load_sets.WHOLE])
    for g in np.linspace(0.0011, 0.0791, 40):
        assert blend(g)[1] == pytest.approx(slope(lambda x: blend(x)[0], g, 1e-6), abs=1e-5)
    # Rates of a cubic ramp rise by at most 1.5 of its mean slope, over 6 thousandths of gain.
    assert np.abs(np.diff(rate)).max() < 1.6 * load_sets.STEEPNESS * 1e-4 / 6e-3
    assert np.abs(np.diff(rate, 2)).max() < 0.1 * np.abs(np.diff(rate)).max()
    assert np.abs(np.diff(s)).max() < 1.01 * load_sets.STEEPNESS * 1e-4
