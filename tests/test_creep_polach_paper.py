"""Polach's laws against the equations of the papers written out again, and their limits."""

import math

import numpy as np
import pytest
from creep_reference import PATCH
from hypothesis import given, settings
from hypothesis import strategies as st

from exudyn_wheelset.creep import creep_force, kalker_coefficients

ELLIPSES = [(5.5e-3, 5.5e-3), (2e-3, 7e-3), (9e-3, 3e-3)]


def polach_1999(sx, sy, psi, a, b, load, friction, G, nu):
    c11, c22, c23, _ = kalker_coefficients(a, b, nu)
    syc = sy + psi * a if abs(sy + psi * a) > abs(sy) else sy
    sc, s = math.hypot(sx, syc), math.hypot(sx, sy)
    cjj = math.sqrt((c11 * sx / s) ** 2 + (c22 * sy / s) ** 2)
    eps = G * math.pi * a * b * cjj * sc / (4 * load * friction)
    force = 2 * load * friction / math.pi * (eps / (1 + eps**2) + math.atan(eps))
    widening = 1 + 6.3 * (1 - math.exp(-a / b))
    eps_s = 8 / 3 * G * b * math.sqrt(a * b) * c23 * abs(syc) / (load * friction * widening)
    d = (eps_s**2 - 1) / (eps_s**2 + 1)
    km = abs(eps_s) * (d**3 / 3 - d**2 / 2 + 1 / 6) - math.sqrt((1 - d**2) ** 3) / 3
    fys = -9 / 16 * a * load * friction * km * widening
    x, y = -force * sx / sc, -(force * sy / sc + fys * psi / sc)
    return np.array([x, y]) * min(1.0, load * friction / math.hypot(x, y))


creep = st.floats(-0.05, 0.05).filter(lambda v: abs(v) > 1e-7)


@settings(deadline=None)
@given(creep, creep, st.floats(-2.0, 2.0), st.floats(1e-3, 1e-2), st.floats(1e-3, 1e-2))
def test_equations_of_1999(sx, sy, psi, a, b):
    got = creep_force("polach", sx, sy, psi, a, b, 8e4, 0.3, 82e9, 0.28)
    expected = polach_1999(sx, sy, psi, a, b, 8e4, 0.3, 82e9, 0.28)
    # 1 - d loses digits in the published form: 1e-9 of the friction force
    np.testing.assert_allclose(got[:2], expected, rtol=1e-8, atol=1e-8 * 24e3)


@pytest.mark.parametrize("law", ["polach", "shen-hedrick-elkins"])
@pytest.mark.parametrize(("a", "b"), ELLIPSES)
def test_linear_limits(law, a, b):
    state = PATCH | {"a": a, "b": b}
    c11, c22, c23, _ = kalker_coefficients(a, b, 0.28)
    small = 1e-8
    fx, fy, _ = creep_force(law, small, 0.0, 0.0, **state)
    assert fx == pytest.approx(-82e9 * a * b * c11 * small, rel=1e-4)
    assert fy == 0.0
    fx, fy, _ = creep_force(law, 0.0, small, 0.0, **state)
    assert fy == pytest.approx(-82e9 * a * b * c22 * small, rel=1e-4)
    spin = small / a
    fx, fy, _ = creep_force(law, 0.0, 0.0, spin, **state)
    assert fy == pytest.approx(-82e9 * (a * b) ** 1.5 * c23 * spin, rel=1e-4)


@pytest.mark.parametrize(("a", "b"), ELLIPSES)
@pytest.mark.parametrize("spin", [0.1, -0.1, 1.0])
def test_linearisation_at_zero_creepage_with_spin(a, b, spin):
    """Hunting eigenvalues come from these differences: one value from both sides, every step."""
    state = PATCH | {"a": a, "b": b}
    _, base, _ = creep_force("polach", 0.0, 0.0, spin, **state)
    slopes = []
    for step in (1e-6, 1e-7, 1e-8):
        for sign in (1.0, -1.0):
            fx, _, _ = creep_force("polach", sign * step, 0.0, spin, **state)
            _, fy, _ = creep_force("polach", 0.0, sign * step, spin, **state)
            slopes.append([sign * fx / step, sign * (fy - base) / step])
    # curvature of the law over a step of 1e-6 against creepages of spin a = 5e-4
    np.testing.assert_allclose(slopes, [slopes[-1]] * 6, rtol=6e-3)


def test_continuity_where_the_spin_changes_sides():
    """The effective lateral creepage switches at s_y = -psi a/2."""
    psi, a = 0.4, 5.5e-3
    for sx in (0.0, 1e-4, 3e-3):
        below = creep_force("polach", sx, -psi * a / 2 - 1e-13, psi, **PATCH)
        above = creep_force("polach", sx, -psi * a / 2 + 1e-13, psi, **PATCH)
        # stiffness about 1e7 N times the step
        np.testing.assert_allclose(below, above, atol=1e-5)


@settings(deadline=None)
@given(creep, creep, st.floats(-2.0, 2.0))
def test_law_of_2005_without_reduction_is_that_of_1999(sx, sy, psi):
    plain = creep_force("polach", sx, sy, psi, **PATCH)
    reduced = creep_force(
        "polach-2005", sx, sy, psi, **PATCH, adhesion_reduction=1.0, slip_reduction=1.0
    )
    np.testing.assert_allclose(reduced, plain, rtol=1e-14)


@pytest.mark.parametrize(
    ("mu", "k_a", "k_s", "ratio", "decay"), [(0.55, 1.0, 0.4, 0.4, 0.6), (0.3, 0.3, 0.1, 0.4, 0.2)]
)
@pytest.mark.parametrize("s", [1e-4, 3e-3, 0.02, 0.3])
def test_equations_of_2005(mu, k_a, k_s, ratio, decay, s):
    """Dry and wet values of the paper, longitudinal creepage, 20 m/s."""
    state = PATCH | {"friction": mu}
    speed = 20.0
    friction = mu * ((1 - ratio) * math.exp(-decay * speed * s) + ratio)
    c11 = kalker_coefficients(5.5e-3, 5.5e-3, 0.28)[0]
    eps = 82e9 * math.pi * 5.5e-3**2 * c11 * s / (4 * 80e3 * friction)
    force = 2 * 80e3 * friction / math.pi
    force *= k_a * eps / (1 + (k_a * eps) ** 2) + math.atan(k_s * eps)
    fx, fy, _ = creep_force(
        "polach-2005",
        s,
        0.0,
        0.0,
        **state,
        adhesion_reduction=k_a,
        slip_reduction=k_s,
        friction_ratio=ratio,
        friction_decay=decay,
        speed=speed,
    )
    assert fx == pytest.approx(-force, rel=1e-12)
    assert fy == 0.0


def test_adhesion_falls_at_large_slip():
    forces = creep_force("polach-2005", np.array([0.02, 0.1, 0.5]), 0.0, 0.0, **PATCH, speed=20.0)[
        0
    ]
    assert np.all(np.diff(np.abs(forces)) < 0)
