"""Hertz kernels against complete elliptic integrals solved by root finding, and a published case.

Published case: A = 0.8e-3, B = 0.2814e-3 1/mm, N = 106.7 kN, G = 82 GPa, nu = 0.28 gives
a = 6.304 mm, b = 12.61 mm, p_max = 640.7 MPa, approach 0.0765 mm (three to four figures).
"""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

from exudyn_wheelset.contact.hertz import (
    hertz_from_approach,
    hertz_from_load,
    shape_and_slopes,
)

STEEL = {"shear_modulus": 82e9, "poisson": 0.28}


def hertz_by_root_finding(A, B, normal_force, shear_modulus, poisson):
    """Johnson 1985, equations 4.26 to 4.28, as they stand there; not for nearly equal A and B."""
    larger, smaller = max(A, B), min(A, B)

    def integrals(g):
        m = 1.0 - g * g
        return m, ellipkm1(g * g), ellipe(m)

    def ratio_error(log_g):
        g = math.exp(log_g)
        _, first, second = integrals(g)
        return math.log((second / g**2 - first) / (first - second)) - math.log(larger / smaller)

    g = math.exp(brentq(ratio_error, math.log(1e-9), math.log(0.9999), xtol=1e-14))
    m, first, second = integrals(g)
    modulus = shear_modulus / (1.0 - poisson)
    major = (3 * normal_force * (first - second) / (2 * math.pi * modulus * smaller * m)) ** (1 / 3)
    minor = g * major
    p_max = 1.5 * normal_force / (math.pi * major * minor)
    approach = p_max * minor * first / modulus
    a, b = (minor, major) if A > B else (major, minor)
    return a, b, approach, p_max


@pytest.mark.parametrize("ratio", [1e-6, 1e-4, 3.7e-3, 0.08, 0.3, 0.77, 1.4, 6.1, 55.0, 2.3e3, 1e6])
def test_elliptic_integrals(ratio):
    A, force = 1.1, 7.3e4
    expected = hertz_by_root_finding(A, A * ratio, force, **STEEL)
    # interpolation of the table is good to 1e-7, the reference's K - E to 1e-10
    np.testing.assert_allclose(hertz_from_load(A, A * ratio, force, **STEEL), expected, rtol=2e-7)


def test_table_between_its_nodes():
    rng = np.random.default_rng(1)
    for t in np.concatenate([rng.uniform(-13.8, 13.8, 150), rng.uniform(-1, 1, 150)]):
        if abs(t) > 0.01:
            expected = hertz_by_root_finding(1.0, math.exp(t), 1e5, **STEEL)
            np.testing.assert_allclose(
                hertz_from_load(1.0, math.exp(t), 1e5, **STEEL), expected, rtol=2e-7
            )


def test_published_case():
    a, b, approach, p_max = hertz_from_load(0.8, 0.2814, 106.7e3, **STEEL)
    # 0.2 %: the published figures are rounded to three or four digits
    np.testing.assert_allclose(
        [a, b, approach, p_max], [6.304e-3, 12.61e-3, 0.0765e-3, 640.7e6], rtol=2e-3
    )


def test_circular_patch():
    A, force = 0.9, 8e4
    modulus, radius = 82e9 / 0.72, 1 / (2 * A)
    a, b, approach, p_max = hertz_from_load(A, A, force, **STEEL)
    expected = (0.75 * force * radius / modulus) ** (1 / 3)
    np.testing.assert_allclose([a, b], expected, rtol=1e-12)
    np.testing.assert_allclose(approach, expected**2 / radius, rtol=1e-12)
    np.testing.assert_allclose(p_max, 1.5 * force / (math.pi * expected**2), rtol=1e-12)


def test_line_contact_limit():
    # p_max of the middle of a long patch: plane-strain Hertz with the local line load
    a, b, _, p_max = hertz_from_load(1.0, 1e-6, 1e5, **STEEL)
    line_load = 0.5 * math.pi * p_max * a
    expected = math.sqrt(line_load * (82e9 / 0.72) * 2.0 / math.pi)
    assert a < 0.01 * b
    assert p_max == pytest.approx(expected, rel=1e-3)  # error of order g^2 ln g


curvature = st.floats(1e-3, 1e3)
load = st.floats(1e-3, 1e7)


@settings(deadline=None)
@given(curvature, curvature, load)
def test_load_and_approach_invert_each_other(A, B, force):
    a, b, approach, _ = hertz_from_load(A, B, force, **STEEL)
    again = hertz_from_approach(A, B, approach, **STEEL)
    np.testing.assert_allclose(again, (force, a, b), rtol=1e-12)


@settings(deadline=None)
@given(curvature, curvature, load, st.floats(1e-3, 1e3))
def test_scaling_laws(A, B, force, k):
    """Similar contacts: lengths with k, curvatures with 1/k, forces with k^2, pressure alike."""
    a, b, approach, p_max = hertz_from_load(A, B, force, **STEEL)
    scaled = hertz_from_load(A / k, B / k, force * k * k, **STEEL)
    np.testing.assert_allclose(scaled, (a * k, b * k, approach * k, p_max), rtol=1e-9)
    stiffer = hertz_from_load(A, B, force * k, 82e9 * k, 0.28)
    np.testing.assert_allclose(stiffer, (a, b, approach, p_max * k), rtol=1e-9)
    root = k ** (1 / 3)
    heavier = hertz_from_load(A, B, force * k, **STEEL)
    np.testing.assert_allclose(
        heavier, (a * root, b * root, approach * root**2, p_max * root), 1e-9
    )


@settings(deadline=None)
@given(curvature, curvature, load)
def test_exchange_of_axes(A, B, force):
    a, b, approach, p_max = hertz_from_load(A, B, force, **STEEL)
    b2, a2, approach2, p_max2 = hertz_from_load(B, A, force, **STEEL)
    np.testing.assert_allclose((a2, b2, approach2, p_max2), (a, b, approach, p_max), rtol=1e-12)
    assert (a < b) == (A > B) or pytest.approx(B, rel=1e-9) == A


def test_continuity_through_the_table_and_its_ends():
    t = np.arange(-42.0, 42.0, 1.7e-4)
    values = np.log([hertz_from_load(1.0, r, 1e5, **STEEL) for r in np.exp(t)])
    # logarithms change by at most about 0.6 t; a jump anywhere would stand out
    assert np.abs(np.diff(values, axis=0)).max() < 1.7e-4
    second = np.diff(values, 2, axis=0)
    inside = np.abs(t[1:-1]) < 39.9
    # curvature of the logarithms is at most 0.1; rounding adds 4e-16 * 40 / step^2 = 1e-6
    assert np.abs(second[inside]).max() / 1.7e-4**2 < 0.12


@pytest.mark.parametrize("end", [-40.0, 40.0])
def test_straight_continuation_beyond_the_table(end):
    """Logarithms of all results go on with the slope they have at the end, and stay straight."""

    def values(t):
        return np.log(hertz_from_load(1.0, math.exp(t), 1e5, **STEEL))

    inside = (values(0.9999 * end) - values(0.9998 * end)) / (0.0001 * end)
    outside = (values(1.1 * end) - values(1.05 * end)) / (0.05 * end)
    # The slopes change by 1/t^2 a unit of t, 0.004 of them lie between.
    np.testing.assert_allclose(outside, inside, atol=1e-5)
    np.testing.assert_allclose(values(1.15 * end) - values(1.1 * end), 0.05 * end * outside, 1e-9)


def test_no_contact():
    assert hertz_from_load(1.0, 1.0, -5.0, **STEEL) == (0.0, 0.0, 0.0, 0.0)
    assert hertz_from_approach(1.0, 1.0, 0.0, **STEEL) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("end", [-40.0, 40.0])
def test_the_slope_at_the_tables_end_goes_on(end):
    """Beyond it the logarithms have the slope that differences inside give at the end itself."""

    def values(t):
        return np.log(hertz_from_load(1.0, math.exp(t), 1e5, **STEEL))

    h = math.copysign(0.02, end)
    inside = (3.0 * values(end) - 4.0 * values(end - h) + values(end - 2.0 * h)) / (2.0 * h)
    outside = (values(end + 50.0 * h) - values(end)) / (50.0 * h)
    # Third derivatives there are about 2/t^3; rounding of logarithms over the step.
    np.testing.assert_allclose(outside, inside, atol=3e-8)


@pytest.mark.parametrize("t", [-47.3, -39.93, -7.07, -0.03, 0.41, 3.33, 12.01, 39.93, 44.4])
def test_shape_functions_and_their_slopes(t):
    """The logarithms of results for A + B alike, and their difference quotients over t."""

    def shapes(x):
        ratio = math.exp(x)
        A, B = 1.0 / (1.0 + ratio), ratio / (1.0 + ratio)
        a, b, approach, _ = hertz_from_load(A, B, 1e5, **STEEL)
        circle, _, flat, _ = hertz_from_load(0.5, 0.5, 1e5, **STEEL)
        return np.log([a / circle, b / circle, approach / flat])

    found = np.array(shape_and_slopes(t))
    np.testing.assert_allclose(found[:3], shapes(t), atol=1e-12)
    step = 0.01
    slopes = (shapes(t + step) - shapes(t - step)) / (2.0 * step)
    np.testing.assert_allclose(found[3:6], slopes, atol=2e-6)
    if abs(t) < 40.0:
        bends = (
            np.array(shape_and_slopes(t + step)[3:5]) - np.array(shape_and_slopes(t - step)[3:5])
        ) / (2.0 * step)
        np.testing.assert_allclose(found[6:], bends, atol=1e-4 * (1.0 + 10.0 * (abs(t) < 5.0)))
