"""Shapes of transition curves: how curvature goes from one value to the next over the length.

Each is a function f of t = s/L with f(0) = 0, f(1) = 1, as pieces of cubics:

    clothoid   f = t                                      cant by a straight ramp
    bloss      f = 3 t^2 - 2 t^3                          cant alike
    helmert    f = 2 t^2 up to the middle, 1 - 2 (1 - t)^2 beyond; cant alike (Schramm's)
    cubic      the curvature of the cubic parabola y = c x^3 along its arc,
               kappa = 6 c x/(1 + 9 c^2 x^4)^1.5, with c so that its end has the curvature asked
               for; cant by a straight ramp

The cubic parabola depends on L and on the change of curvature; it is written as cubics in PIECES
pieces with its values and slopes (1e-8 of the curvature for L = 100 m, R = 300 m).
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import WheelsetError

SHAPES = ("clothoid", "bloss", "cubic", "helmert")
# Shapes whose cant rises by a straight ramp.
STRAIGHT_RAMPS = ("clothoid", "cubic")
PIECES = 16


def shape_pieces(shape: str, length: float, change: float) -> tuple[Array, Array]:
    """Breaks t (k + 1,) from 0 to 1 and coefficients (k, 4) of f in powers of t minus its break.

    length [m]; change [1/m] of the curvature, for "cubic". Raises WheelsetError where a cubic
    parabola cannot reach that curvature in that length.
    """
    if shape == "bloss":
        return np.array([0.0, 1.0]), np.array([[0.0, 0.0, 3.0, -2.0]])
    if shape == "helmert":
        return np.array([0.0, 0.5, 1.0]), np.array([[0.0, 0.0, 2.0, 0.0], [0.5, 2.0, -2.0, 0.0]])
    if shape == "clothoid" or change == 0.0:
        return np.array([0.0, 1.0]), np.array([[0.0, 1.0, 0.0, 0.0]])
    return _cubic_parabola(length, abs(change))


def _cubic_parabola(length: float, curvature: float) -> tuple[Array, Array]:
    nodes, weights = np.polynomial.legendre.leggauss(12)

    def arc(c: float, x: Array) -> Array:
        """Arc length from 0 to each x."""
        at = 0.5 * x[:, None] * (1.0 + nodes)
        return 0.5 * x * (np.sqrt(1.0 + 9.0 * c * c * at**4) @ weights)

    def abscissae(c: float, s: Array) -> Array:
        x = s.copy()
        for _ in range(30):
            x -= (arc(c, x) - s) / np.sqrt(1.0 + 9.0 * c * c * x**4)
        return x

    def curvature_at(c: float, x: Array) -> Array:
        return np.asarray(6.0 * c * x / (1.0 + 9.0 * c * c * x**4) ** 1.5)

    # A cubic parabola is sharpest at 9 c^2 x^4 = 1/5; a little before it the end is looked for.
    end = np.array([length])
    low, high = 0.0, 1.0 / length**2
    while 9.0 * high**2 * abscissae(high, end)[0] ** 4 > 0.2:
        high *= 0.9
    sharpest = float(curvature_at(high, abscissae(high, end))[0])
    if curvature > sharpest:
        raise WheelsetError(
            f"a cubic parabola of {length:g} m cannot change the curvature by {curvature:.5g} 1/m "
            f"(radius {1 / curvature:.4g} m), at most by {sharpest:.5g} 1/m: make it longer, or "
            "take a clothoid"
        )
    for _ in range(100):
        c = 0.5 * (low + high)
        if curvature_at(c, abscissae(c, end))[0] < curvature:
            low = c
        else:
            high = c
    t = np.linspace(0.0, 1.0, PIECES + 1)
    x = abscissae(high, t * length)
    square = 9.0 * high**2 * x**4
    f = curvature_at(high, x) / curvature
    # d kappa/ds = (d kappa/dx)/sqrt(1 + square)
    slope = 6.0 * high * (1.0 - 5.0 * square) / (1.0 + square) ** 3 * length / curvature
    f[-1] = 1.0
    h = 1.0 / PIECES
    rise = (f[1:] - f[:-1]) / h
    coefficients = np.column_stack(
        [
            f[:-1],
            slope[:-1],
            (3.0 * rise - 2.0 * slope[:-1] - slope[1:]) / h,
            (slope[:-1] + slope[1:] - 2.0 * rise) / h**2,
        ]
    )
    return t, coefficients
