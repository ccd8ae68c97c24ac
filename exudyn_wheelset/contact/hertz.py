"""Hertz contact of two elastic bodies of the same material: elliptic patches of every axis ratio.

The undeformed gap is A x^2 + B y^2 [m], x along the rolling direction, y lateral in the contact
plane; A = 1/(2 R_x) and B = 1/(2 R_y) [1/m] are half the relative curvatures, both positive.
The patch is the ellipse (x/a)^2 + (y/b)^2 <= 1, with p = p_max sqrt(1 - (x/a)^2 - (y/b)^2):
semi-axis a along x, b along y. The larger curvature has the smaller semi-axis.

Source: K. L. Johnson, Contact Mechanics, 1985, section 4.2, equations 4.26 to 4.28. With major
semi-axis c, minor semi-axis d = g c, m = 1 - g^2 and the elliptic integrals
    K = int 1/Delta, D = int sin^2/Delta, C = int cos^2/Delta, Delta = sqrt(1 - m sin^2),
over the quarter period they read (the larger half-curvature belongs to the minor axis)
    larger / smaller half-curvature = C / (g^2 D),
    smaller half-curvature = 3 N D / (2 pi E* c^3),      approach = 3 N K / (2 pi E* c),
and 1/E* = (1 - nu)/G for two bodies of shear modulus G and Poisson number nu.

The shape depends on t = ln(B/A) alone. Two smooth functions of t, measured against the circular
patch of the same A + B, are tabulated once at import and interpolated by cubic splines:
    a = a_0 exp(axis(t)),  b = a_0 exp(axis(-t)),  a_0 = (3 N / (4 E* (A + B)))^(1/3),
    approach = (9 N^2 (A + B) / (16 E*^2))^(1/3) exp(depth(t)).
Interpolation error below 1e-7 relative for |t| <= 40 (tests/test_hertz_elliptic_integrals.py);
beyond it, where no wheel or rail ever is, the logarithms continue as straight lines.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.special import elliprd, elliprf

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled

LOG_RATIO_END = 40.0
INTERVALS = 640
_PER_INTERVAL = INTERVALS / (2.0 * LOG_RATIO_END)


def _ellipse_of_axis_ratio(log_axis_ratio: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Give ln(curvature ratio), axis(t) and depth(t) of the minor/major axis ratio, t >= 0."""
    g2 = np.exp(2.0 * log_axis_ratio)
    sine_integral = elliprd(0.0, g2, 1.0) / 3.0
    cosine_over_g2 = elliprd(0.0, 1.0, g2) / 3.0
    ratio = cosine_over_g2 / sine_integral
    major = np.log(2.0 * sine_integral * (1.0 + ratio) / np.pi) / 3.0
    depth = np.log(2.0 * elliprf(0.0, g2, 1.0) / np.pi) - major
    return np.log(ratio), major, depth


def _shape_table() -> NDArray:
    """Give, for each interval of t, the cubics of axis(t), axis(-t) and depth(t): (n, 12)."""
    samples = -np.linspace(0.0, 1.0, 400) * (0.5 * LOG_RATIO_END + 2.0)
    inverse = CubicSpline(_ellipse_of_axis_ratio(samples)[0], samples)
    t = np.linspace(0.0, LOG_RATIO_END, INTERVALS // 2 + 1)
    log_g = inverse(t)
    log_g -= (_ellipse_of_axis_ratio(log_g)[0] - t) * inverse(t, 1)
    log_g[0] = 0.0
    _, major, depth = _ellipse_of_axis_ratio(log_g)
    axis = CubicSpline(np.r_[-t[:0:-1], t], np.r_[(major + log_g)[:0:-1], major])
    depth_spline = CubicSpline(axis.x, np.r_[depth[:0:-1], depth])
    mirrored = CubicSpline(axis.x, axis(-axis.x))
    cubics = [spline.c[::-1].T for spline in (axis, mirrored, depth_spline)]
    return np.ascontiguousarray(np.hstack(cubics))


_SHAPE = _shape_table()


@compiled(fastmath=AS_REAL_NUMBERS)
def _ellipse_shape(A: float, B: float) -> tuple[float, float, float]:
    """Give axis(t), axis(-t), depth(t) for t = ln(B/A)."""
    t = math.log(B / A)
    inside = min(max(t, -LOG_RATIO_END), LOG_RATIO_END)
    i = min(int((inside + LOG_RATIO_END) * _PER_INTERVAL), INTERVALS - 1)
    s = inside - (i / _PER_INTERVAL - LOG_RATIO_END)
    row = _SHAPE[i]
    log_a = row[0] + s * (row[1] + s * (row[2] + s * row[3]))
    log_b = row[4] + s * (row[5] + s * (row[6] + s * row[7]))
    log_depth = row[8] + s * (row[9] + s * (row[10] + s * row[11]))
    if t != inside:
        log_a += (t - inside) * (row[1] + s * (2.0 * row[2] + 3.0 * s * row[3]))
        log_b += (t - inside) * (row[5] + s * (2.0 * row[6] + 3.0 * s * row[7]))
        log_depth += (t - inside) * (row[9] + s * (2.0 * row[10] + 3.0 * s * row[11]))
    return log_a, log_b, log_depth


@compiled(fastmath=AS_REAL_NUMBERS)
def shape_and_slopes(t: float) -> tuple[float, ...]:
    """Give axis(t), axis(-t), depth(t), their first derivatives by t, axes' second ones."""
    inside = min(max(t, -LOG_RATIO_END), LOG_RATIO_END)
    i = min(int((inside + LOG_RATIO_END) * _PER_INTERVAL), INTERVALS - 1)
    s = inside - (i / _PER_INTERVAL - LOG_RATIO_END)
    row = _SHAPE[i]
    slope_a = row[1] + s * (2.0 * row[2] + 3.0 * s * row[3])
    slope_b = row[5] + s * (2.0 * row[6] + 3.0 * s * row[7])
    slope_depth = row[9] + s * (2.0 * row[10] + 3.0 * s * row[11])
    beyond = t - inside
    return (
        row[0] + s * (row[1] + s * (row[2] + s * row[3])) + beyond * slope_a,
        row[4] + s * (row[5] + s * (row[6] + s * row[7])) + beyond * slope_b,
        row[8] + s * (row[9] + s * (row[10] + s * row[11])) + beyond * slope_depth,
        slope_a,
        slope_b,
        slope_depth,
        2.0 * row[2] + 6.0 * s * row[3],
        2.0 * row[6] + 6.0 * s * row[7],
    )


@compiled(fastmath=AS_REAL_NUMBERS)
def hertz_from_load(
    A: float, B: float, normal_force: float, shear_modulus: float, poisson: float
) -> tuple[float, float, float, float]:
    """Give the patch that a normal force makes: (a, b, approach, p_max).

    A, B [1/m] half the relative curvatures along rolling and laterally, both > 0 (not checked);
    normal_force [N]; shear_modulus [Pa] and poisson of both bodies. Semi-axes a (rolling),
    b (lateral) and approach [m], p_max [Pa]. All zero if the force is not positive.
    Source: Johnson 1985, equations 4.26 to 4.28.
    """
    if not normal_force > 0.0:
        return 0.0, 0.0, 0.0, 0.0
    log_a, log_b, log_depth = _ellipse_shape(A, B)
    circle = (0.75 * normal_force * (1.0 - poisson) / (shear_modulus * (A + B))) ** (1.0 / 3.0)
    a = circle * math.exp(log_a)
    b = circle * math.exp(log_b)
    approach = (A + B) * circle * circle * math.exp(log_depth)
    return a, b, approach, 1.5 * normal_force / (math.pi * a * b)


@compiled(fastmath=AS_REAL_NUMBERS)
def hertz_from_approach(
    A: float, B: float, approach: float, shear_modulus: float, poisson: float
) -> tuple[float, float, float]:
    """Give the force and the patch that an approach makes: (normal_force, a, b).

    A, B [1/m] half the relative curvatures along rolling and laterally, both > 0 (not checked);
    approach [m] of distant points of the two bodies; shear_modulus [Pa] and poisson of both
    bodies. normal_force [N], semi-axes a (rolling) and b (lateral) [m]. All zero if the approach
    is not positive. Source: Johnson 1985, equations 4.26 to 4.28.
    """
    if not approach > 0.0:
        return 0.0, 0.0, 0.0
    log_a, log_b, log_depth = _ellipse_shape(A, B)
    circle_squared = approach * math.exp(-log_depth) / (A + B)
    circle = math.sqrt(circle_squared)
    stiffness = 4.0 * shear_modulus / (3.0 * (1.0 - poisson))
    normal_force = stiffness * (A + B) * circle * circle_squared
    return normal_force, circle * math.exp(log_a), circle * math.exp(log_b)
