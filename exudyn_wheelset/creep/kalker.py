"""Kalker's creep coefficients of the linear theory, over every axis ratio and Poisson number.

Source: J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, 1990, table E.3 and its
asymptotes. Linear theory, force on the body whose creepage it is (axes: x rolling, y lateral, z
the contact normal; a along x, b along y):
    F_x = -G a b C11 xi_x,       F_y = -G a b (C22 xi_y + sqrt(a b) C23 phi),
    M_z = G (a b)^(3/2) C23 xi_y - G (a b)^2 C33 phi.

Between the nodes of the table: linear in g = min(a/b, b/a) for each Poisson number, then
parabolic in 1/C over the Poisson number, as the program CONTACT does. The coefficients are
continuous everywhere; their slope over a/b jumps at the nodes g = 0.1, 0.2, ... 1 (most for b < a:
three times as steep below g = 0.2 as above it). For g <= 0.08 the asymptotes hold as they stand;
between 0.08 and 0.1 the ratio of table to asymptote at g = 0.1 fades out smoothly. CONTACT goes
over to the asymptotes there with a jump, at nu = 0.28 of 6 % in C23 (a < b) and 4 % in C11 (b < a).
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_wheelset.compilation import compiled

# rows: b/a = 0.1 ... 0.9, then a/b = 1.0 ... 0.1; columns: C11, C22, C23, C33; nu = 0, 1/4, 1/2
_LONG = [
    [[10.7, 11.7, 12.9], [10.7, 12.8, 16.0], [12.2, 14.6, 18.0], [0.795, 0.526, 0.228]],
    [[6.96, 7.78, 8.82], [6.96, 8.14, 9.79], [5.72, 6.63, 7.89], [0.828, 0.601, 0.341]],
    [[5.57, 6.34, 7.34], [5.57, 6.40, 7.51], [3.79, 4.32, 5.01], [0.868, 0.674, 0.446]],
    [[4.84, 5.57, 6.57], [4.84, 5.48, 6.31], [2.88, 3.24, 3.70], [0.912, 0.747, 0.549]],
    [[4.37, 5.10, 6.11], [4.37, 4.90, 5.56], [2.35, 2.62, 2.96], [0.958, 0.819, 0.650]],
    [[4.06, 4.78, 5.80], [4.06, 4.50, 5.04], [2.01, 2.23, 2.50], [1.01, 0.892, 0.751]],
    [[3.82, 4.54, 5.58], [3.82, 4.21, 4.67], [1.76, 1.95, 2.18], [1.05, 0.965, 0.852]],
    [[3.65, 4.36, 5.42], [3.65, 3.99, 4.39], [1.58, 1.75, 1.94], [1.10, 1.04, 0.954]],
    [[3.51, 4.22, 5.30], [3.51, 3.81, 4.16], [1.44, 1.59, 1.77], [1.16, 1.11, 1.06]],
]
_ROUND = [[[3.40, 4.12, 5.20], [3.40, 3.67, 3.98], [1.33, 1.47, 1.63], [1.21, 1.19, 1.16]]]
_WIDE = [
    [[2.51, 3.31, 4.85], [2.51, 2.52, 2.53], [0.334, 0.473, 0.731], [6.42, 8.28, 11.7]],
    [[2.59, 3.37, 4.81], [2.59, 2.63, 2.66], [0.483, 0.603, 0.809], [3.46, 4.27, 5.66]],
    [[2.68, 3.44, 4.80], [2.68, 2.75, 2.81], [0.607, 0.715, 0.889], [2.49, 2.96, 3.72]],
    [[2.78, 3.53, 4.82], [2.78, 2.88, 2.98], [0.720, 0.823, 0.977], [2.02, 2.32, 2.77]],
    [[2.88, 3.62, 4.83], [2.88, 3.01, 3.14], [0.827, 0.929, 1.07], [1.74, 1.93, 2.22]],
    [[2.98, 3.72, 4.91], [2.98, 3.14, 3.31], [0.930, 1.03, 1.18], [1.56, 1.68, 1.86]],
    [[3.09, 3.81, 4.97], [3.09, 3.28, 3.48], [1.03, 1.14, 1.29], [1.43, 1.50, 1.60]],
    [[3.19, 3.91, 5.05], [3.19, 3.41, 3.65], [1.13, 1.25, 1.40], [1.34, 1.37, 1.42]],
    [[3.29, 4.01, 5.12], [3.29, 3.54, 3.82], [1.23, 1.36, 1.51], [1.27, 1.27, 1.27]],
]
_TABLE = np.array([_LONG + _ROUND, _WIDE + _ROUND])

TABLE_END = 0.1
ASYMPTOTE_BEGIN = 0.08


@compiled
def kalker_asymptotes(a_over_b: float, poisson: float) -> tuple[float, float, float, float]:
    """Give (C11, C22, C23, C33) of a very narrow patch, a/b or b/a far below 1.

    Source: Kalker 1990, last rows of table E.3.
    """
    if a_over_b < 1.0:
        g = a_over_b
        quarter = 0.25 * math.pi**2
        c11 = quarter / (1.0 - poisson)
        c23 = math.pi * math.sqrt(g) / (3.0 * (1.0 - poisson))
        c23 *= 1.0 + poisson * (math.log(16.0 / g) - 5.0)
        return c11, quarter, c23, 0.25 * c11 / g
    g = 1.0 / a_over_b
    log_g = math.log(16.0 * a_over_b * a_over_b)
    constant = 3.0 - math.log(4.0)
    d11 = log_g - 2.0 * poisson
    d22 = (1.0 - poisson) * log_g + 2.0 * poisson
    d23 = (1.0 - poisson) * log_g - 2.0 + 4.0 * poisson
    c11 = 2.0 * math.pi / (g * d11) * (1.0 + constant / d11)
    c22 = 2.0 * math.pi / (g * d22) * (1.0 + (1.0 - poisson) * constant / d22)
    c23 = 2.0 * math.pi / (3.0 * g * math.sqrt(g) * d23)
    c33 = 0.25 * math.pi * (1.0 - poisson * (log_g - 2.0) / d23)
    return c11, c22, c23, c33


@compiled
def _table_coefficients(wide: int, g: float, poisson: float) -> tuple[float, float, float, float]:
    """Interpolate the table for 0.1 <= g <= 1; wide = 1 for a <= b, 0 for a > b."""
    position = 10.0 * g - 1.0
    row = min(max(int(position), 0), 8)
    upper = position - row
    lower = 1.0 - upper
    n = 8.0 * (poisson - 0.25) * (poisson - 0.5)
    n1 = 16.0 * poisson * (0.5 - poisson)
    n2 = 8.0 * poisson * (poisson - 0.25)
    here = _TABLE[wide, row]
    beyond = _TABLE[wide, row + 1]
    p0 = lower * here[0, 0] + upper * beyond[0, 0]
    p1 = lower * here[0, 1] + upper * beyond[0, 1]
    p2 = lower * here[0, 2] + upper * beyond[0, 2]
    c11 = p0 * p1 * p2 / (n * p1 * p2 + n1 * p0 * p2 + n2 * p0 * p1)
    p0 = lower * here[1, 0] + upper * beyond[1, 0]
    p1 = lower * here[1, 1] + upper * beyond[1, 1]
    p2 = lower * here[1, 2] + upper * beyond[1, 2]
    c22 = p0 * p1 * p2 / (n * p1 * p2 + n1 * p0 * p2 + n2 * p0 * p1)
    p0 = lower * here[2, 0] + upper * beyond[2, 0]
    p1 = lower * here[2, 1] + upper * beyond[2, 1]
    p2 = lower * here[2, 2] + upper * beyond[2, 2]
    c23 = p0 * p1 * p2 / (n * p1 * p2 + n1 * p0 * p2 + n2 * p0 * p1)
    p0 = lower * here[3, 0] + upper * beyond[3, 0]
    p1 = lower * here[3, 1] + upper * beyond[3, 1]
    p2 = lower * here[3, 2] + upper * beyond[3, 2]
    c33 = p0 * p1 * p2 / (n * p1 * p2 + n1 * p0 * p2 + n2 * p0 * p1)
    return c11, c22, c23, c33


@compiled
def kalker_coefficients(a: float, b: float, poisson: float) -> tuple[float, float, float, float]:
    """Give Kalker's coefficients (C11, C22, C23, C33) of an elliptic patch.

    Semi-axes a along rolling and b lateral, any common unit, both > 0 (not checked); poisson
    from 0 to 0.5. Dimensionless, continuous in both arguments.
    Source: Kalker 1990, table E.3; interpolation as the module's header says.
    """
    ratio = a / b
    if ratio <= 1.0:
        wide = 1
        g = ratio
    else:
        wide = 0
        g = b / a
    if g >= TABLE_END:
        return _table_coefficients(wide, g, poisson)
    k11, k22, k23, k33 = kalker_asymptotes(ratio, poisson)
    if g > ASYMPTOTE_BEGIN:
        s = (g - ASYMPTOTE_BEGIN) / (TABLE_END - ASYMPTOTE_BEGIN)
        weight = s * s * (3.0 - 2.0 * s)
        end = TABLE_END if wide == 1 else 1.0 / TABLE_END
        t11, t22, t23, t33 = _table_coefficients(wide, TABLE_END, poisson)
        e11, e22, e23, e33 = kalker_asymptotes(end, poisson)
        k11 *= 1.0 + weight * (t11 / e11 - 1.0)
        k22 *= 1.0 + weight * (t22 / e22 - 1.0)
        k23 *= 1.0 + weight * (t23 / e23 - 1.0)
        k33 *= 1.0 + weight * (t33 / e33 - 1.0)
    return k11, k22, k23, k33
