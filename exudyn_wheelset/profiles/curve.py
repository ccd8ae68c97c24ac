"""The smooth curve through the points of a profile, and its table over arc length.

Physical idea: Hertz contact needs the second derivative of a profile, so the points are joined by
a parametric cubic B-spline over chord length, which has no trouble with a steep flange. Measured
points carry noise of some micrometres; their curve is a cubic smoothing spline, which minimises
bending under a bound on the distance to the points (C. H. Reinsch, "Smoothing by spline
functions", Numerische Mathematik 10, 1967, 177-183).

Frames and units: (y, z) in metres as in `exudyn_wheelset.profiles.profile`; chord length t and arc
length s in metres, both growing with y.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, CubicSpline, make_interp_spline
from scipy.linalg import LinAlgError, solveh_banded
from scipy.optimize import brentq

from exudyn_wheelset.errors import ProfileError

FloatArray = NDArray[np.float64]

_GAUSS_POINTS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(5)
_NEWTON_STEPS = 60


@dataclass(frozen=True, eq=False)
class ArcTable:
    """A profile as cubics over uniform pieces of arc length, for compiled kernels.

    On piece i, with u = s - s0 - i ds in [0, ds] [m], y = sum_k coefficients[i, k] u^k and
    z = sum_k coefficients[i, 4 + k] u^k, k = 0..3. The curve is twice continuously
    differentiable; dy/ds and dz/ds are the unit tangent to the order ds^3.

    s0: arc length at the first point [m]; ds: length of a piece [m];
    coefficients: shape (n, 8), C-contiguous, [m^(1-k)].
    """

    s0: float
    ds: float
    coefficients: FloatArray

    @property
    def length(self) -> float:
        """Arc length of the whole profile [m]."""
        return self.ds * len(self.coefficients)


def chord_length(points: FloatArray) -> FloatArray:
    """Length of the polygon up to each point [m], shape (n,); `points` has shape (n, 2) [m]."""
    steps = np.hypot(*np.diff(points, axis=0).T)
    return np.concatenate(([0.0], np.cumsum(steps)))


def averaged(points: FloatArray, group: int) -> FloatArray:
    """Means of `group` neighbouring points each, the last of what is left; columns as given."""
    edges = np.arange(0, len(points), group)
    counts = np.diff(np.append(edges, len(points)))
    means: FloatArray = np.add.reduceat(points, edges, axis=0) / counts[:, None]
    return means


def distance_to_neighbours(points: FloatArray) -> FloatArray:
    """Distance of each point to the cubic through two neighbours on either side [m], shape (n,).

    points: shape (n, 2), columns y and z [m]. It is 0 for the two points at each end.
    """
    # The added picometres part points that coincide after others between them were taken out.
    t = chord_length(points) + 1e-12 * np.arange(len(points))
    distance = np.zeros(len(t))
    window = [-2, -1, 1, 2]
    inner = np.arange(2, len(t) - 2)
    predicted = np.zeros((len(inner), 2))
    for i in window:
        weight = np.ones(len(inner))
        for j in window:
            if j != i:
                weight *= (t[inner] - t[inner + j]) / (t[inner + i] - t[inner + j])
        predicted += weight[:, None] * points[inner + i]
    distance[inner] = np.hypot(*(points[inner] - predicted).T)
    return distance


def smoothed_points(t: FloatArray, points: FloatArray, rms_distance: float) -> FloatArray:
    """Points of the cubic smoothing spline at `t`, at the given rms distance to `points`.

    t: chord length, shape (n,) [m]; points: shape (n, 2) [m]; rms_distance > 0 [m].
    Reinsch's system (R + lambda Q^T Q) c = Q^T p gives the curvatures c, and p - lambda Q c the
    smoothed points; lambda is the root at which the rms distance is reached. A straight line is
    returned where even that lies within the distance.
    """
    h = np.diff(t)
    columns = np.stack((1.0 / h[:-1], -1.0 / h[:-1] - 1.0 / h[1:], 1.0 / h[1:]))
    second_difference = (
        columns[0][:, None] * points[:-2]
        + columns[1][:, None] * points[1:-1]
        + columns[2][:, None] * points[2:]
    )
    interior = len(t) - 2
    gram = np.zeros((3, interior))
    gram[0] = np.sum(columns**2, axis=0)
    gram[1, :-1] = columns[1, :-1] * columns[0, 1:] + columns[2, :-1] * columns[1, 1:]
    gram[2, :-2] = columns[2, :-2] * columns[0, 2:]
    mass = np.zeros((3, interior))
    mass[0] = (h[:-1] + h[1:]) / 3.0
    mass[1, :-1] = h[1:-1] / 6.0

    def displacement(log_weight: float) -> FloatArray:
        weight = np.exp(log_weight)
        bending = solveh_banded(mass + weight * gram, second_difference, lower=True)
        moved = np.zeros_like(points)
        moved[:-2] += columns[0][:, None] * bending
        moved[1:-1] += columns[1][:, None] * bending
        moved[2:] += columns[2][:, None] * bending
        return np.asarray(weight * moved)

    def excess(log_weight: float) -> float:
        moved = displacement(log_weight)
        rms = np.sqrt(np.mean(np.sum(moved**2, axis=1)))
        return float(np.log(rms + 1e-300) - np.log(rms_distance))

    # lambda has the unit m^3: the cube of a length between a fraction of a step and many spans.
    # It is raised step by step, because the equations lose their digits long before its end.
    low, end = 3.0 * np.log(1e-3 * h.min()), 3.0 * np.log(1e2 * t[-1])
    if excess(low) >= 0.0:
        return points
    while low < end:
        high = min(low + 7.0, end)
        try:
            reached = excess(high) >= 0.0
        except LinAlgError:
            raise ProfileError(
                f"smoothing = {rms_distance:g} m is too much for {len(t)} points so close together;"
                " smooth less or thin the points out"
            ) from None
        if reached:
            return points - displacement(float(brentq(excess, low, high, xtol=1e-4)))
        low = high
    return points - displacement(end)


def fit_curve(points: FloatArray, smoothing: float) -> BSpline:
    """Cubic B-spline curve over chord length through (smoothing 0) or near the points.

    points: shape (n, 2), columns y and z [m]; smoothing: rms distance of points to curve [m].
    """
    t = chord_length(points)
    if smoothing == 0.0:
        return make_interp_spline(t, points, k=3)
    smooth = smoothed_points(t, points, smoothing)
    return make_interp_spline(t, smooth, k=3, bc_type="natural")


def breaks_of(curve: BSpline) -> FloatArray:
    """Parameter values between which the curve is one cubic [m]."""
    return np.unique(curve.t[curve.k : -curve.k])


def parameter_at(curve: BSpline, breaks: FloatArray, y: FloatArray) -> FloatArray:
    """Parameter t of the curve points with the given y [m]; every y lies within the curve."""
    y_breaks = curve(breaks)[:, 0]
    # A noisy flange may run back between points; the running maximum keeps the bracket ordered.
    piece = np.searchsorted(np.maximum.accumulate(y_breaks), y, side="right") - 1
    piece = np.clip(piece, 0, len(breaks) - 2)
    low, high = breaks[piece].copy(), breaks[piece + 1].copy()
    derivative = curve.derivative()
    t = 0.5 * (low + high)
    for _ in range(_NEWTON_STEPS):
        error = curve(t)[:, 0] - y
        low = np.where(error <= 0.0, t, low)
        high = np.where(error >= 0.0, t, high)
        slope = derivative(t)[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = t - error / slope
        inside = (newton >= low) & (newton <= high)
        step = np.where(inside, newton, 0.5 * (low + high)) - t
        t = t + step
        if np.all(np.abs(step) <= 1e-15):
            break
    return t


def arc_table(curve: BSpline, spacing: float) -> ArcTable:
    """Table of the curve over uniform arc length, pieces of at most `spacing` [m].

    The arc length of each cubic piece comes from five-point Gauss integration (error below
    1e-14 m for pieces of a millimetre); nodes at equal arc length are found with Newton's method
    and joined by a clamped cubic spline in arc length.
    """
    breaks = breaks_of(curve)
    derivative = curve.derivative()

    def lengths(start: FloatArray, end: FloatArray) -> FloatArray:
        half = 0.5 * (end - start)
        t = (0.5 * (start + end))[:, None] + half[:, None] * _GAUSS_POINTS
        speed = np.hypot(*np.moveaxis(derivative(t), -1, 0))
        return np.asarray(half * (speed @ _GAUSS_WEIGHTS))

    s_breaks = np.concatenate(([0.0], np.cumsum(lengths(breaks[:-1], breaks[1:]))))
    pieces = max(4, int(np.ceil(s_breaks[-1] / spacing)))
    if pieces > 10_000_000:
        raise ProfileError(f"spacing = {spacing:g} m gives {pieces} pieces; use 1e-5 m or more")
    s = np.linspace(0.0, s_breaks[-1], pieces + 1)
    piece = np.clip(np.searchsorted(s_breaks, s, side="right") - 1, 0, len(breaks) - 2)
    t = np.interp(s, s_breaks, breaks)
    for _ in range(8):
        error = s_breaks[piece] + lengths(breaks[piece], t) - s
        speed = np.hypot(*derivative(t).T)
        t = np.clip(t - error / speed, breaks[piece], breaks[piece + 1])
    tangent = derivative(t[[0, -1]])
    tangent /= np.hypot(*tangent.T)[:, None]
    table = CubicSpline(s, curve(t), bc_type=((1, tangent[0]), (1, tangent[1])))
    # CubicSpline stores (power, piece, column) with the highest power first.
    coefficients = np.ascontiguousarray(table.c[::-1].transpose(1, 2, 0).reshape(pieces, 8))
    coefficients.setflags(write=False)
    return ArcTable(0.0, float(s[1]), coefficients)
