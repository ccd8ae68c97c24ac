"""Measurement noise of a profile's points, normal to its curve.

Physical idea: five neighbouring points of a smooth curve lie on a cubic but for noise. In the frame
of the local tangent, u along and v normal to it, the combination r = sum w_j v_j that vanishes for
every cubic v(u) is the fourth divided difference; with sum w_j^2 = 1 white noise of standard
deviation sigma gives r the same deviation (difference estimators: T. Gasser, L. Sroka and C.
Jennen-Steinmetz, "Residual variance and residual pattern in nonlinear regression", Biometrika 73,
1986, 625-633). The weights are the minors of the Vandermonde matrix, so points of the same u do no
harm. Noise along the curve does not show, and does not matter.

Steps of curvature (junctions of arcs) and outliers are a minority of large r: the deviation is that
of a normal distribution cut off at 2.5 deviations, found by iteration from the median.

What it cannot see is noise that varies slowly, over more than about four points: that is shape to
any method that knows the points alone. The same estimate from every second and fourth point is
larger then; `noise_by_spacing` gives all three.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.checking import warn
from exudyn_wheelset.profiles.curve import chord_length

FloatArray = NDArray[np.float64]

# Farther than this along the curve the third degree does not follow a flange's curvature.
_REACH = 1e-3
# Where wheels run, slopes are below 0.75, and noise in z is noise normal to the curve. With fewer
# than 150 windows there the estimate would be off by more than 10 %: then all but upright flanks,
# where noise makes points run back in y and readers leave the farther ones out.
_LEVELS = ((0.8, 150), (0.25, 12))
_CUT = 2.5
# Variance of the standard normal distribution cut off at 2.5: 1 - 2 a phi(a)/(2 Phi(a) - 1).
_VARIANCE_WITHIN_CUT = 0.9112
# A tread's own curvature, 3 1/m.
_WORTHLESS_CURVATURE = 3.0


def normal_noise(points: FloatArray, stride: int = 1) -> float:
    """Standard deviation [m] of white noise normal to the curve through `points`.

    points: shape (n, 2), columns y and z [m], in the order of the curve; stride: take the points
    i - 2 stride, ..., i + 2 stride. 0 for fewer than 12 windows of five points.
    """
    n = len(points)
    if n - 4 * stride < 12:
        return 0.0
    centre = np.arange(2 * stride, n - 2 * stride)
    tangent = tangents(points)[centre]
    for advance, enough in _LEVELS:
        gentle = np.abs(tangent[:, 0]) > advance
        if np.count_nonzero(gentle) >= max(enough, 0.3 * len(centre)):
            centre, tangent = centre[gentle], tangent[gentle]
            break
    index = centre[:, None] + stride * np.arange(-2, 3)
    offset = points[index] - points[centre][:, None, :]
    u = offset[..., 0] * tangent[:, None, 0] + offset[..., 1] * tangent[:, None, 1]
    v = offset[..., 1] * tangent[:, None, 0] - offset[..., 0] * tangent[:, None, 1]
    # The unit of u drops out; without it the products of six differences would underflow.
    u = u / np.max(np.abs(u), axis=1, keepdims=True, initial=1e-12)
    weights = np.empty_like(u)
    for j in range(5):
        others = [k for k in range(5) if k != j]
        minor = np.ones(len(u))
        for a, b in combinations(others, 2):
            minor = minor * (u[:, b] - u[:, a])
        weights[:, j] = (-1.0) ** j * minor
    norm = np.sqrt(np.sum(weights**2, axis=1))
    usable = norm > 0.0
    if np.count_nonzero(usable) < 12:
        return 0.0
    residual = np.abs(np.sum(weights * v, axis=1)[usable] / norm[usable])
    return _deviation(residual)


def noise_by_spacing(points: FloatArray) -> dict[int, float]:
    """`normal_noise` [m] of every, every second and every fourth point, as far as 1 mm reaches.

    White noise gives the same number three times. Where it grows, the noise of neighbouring points
    is correlated (an instrument that smooths, a roughness of the surface).
    """
    spacing = float(np.median(np.hypot(*np.diff(points, axis=0).T)))
    strides = [1] + [k for k in (2, 4) if 2 * k * spacing <= 2.5 * _REACH]
    return {k: normal_noise(points, k) for k in strides}


def curvature_noise(sigma: float, points: FloatArray) -> float:
    """Deviation [1/m] of the curvature of a curve through points that are off by sigma [m].

    The second difference of points h apart has the deviation sqrt(6) sigma/h^2.
    """
    spacing = float(np.median(np.hypot(*np.diff(points, axis=0).T)))
    return float(np.sqrt(6.0)) * sigma / spacing**2


def warn_of_noise(name: str, sigma: float, noise: float) -> None:
    """WheelsetWarning where a curve's curvature is off by more than a tread has.

    sigma: of the points [m]; noise: of the curvature [1/m].
    """
    if noise > _WORTHLESS_CURVATURE:
        warn(
            f"{name}: the points are off by {1e6 * sigma:.2g} micrometres, so the curvature of the "
            f"curve through them is off by {noise:.3g} 1/m, where a tread has about 3 1/m: contact "
            "will be rough and conicity wrong; give smoothing='auto'"
        )


def tangents(points: FloatArray) -> FloatArray:
    """Unit vectors from the mean of the points behind to that of the points ahead, within 1 mm."""
    s = chord_length(points)
    n = len(points)
    index = np.arange(n)
    low = np.minimum(np.searchsorted(s, s - _REACH), np.maximum(index - 2, 0))
    high = np.maximum(np.searchsorted(s, s + _REACH, side="right"), np.minimum(index + 3, n))
    sums = np.vstack((np.zeros(2), np.cumsum(points, axis=0)))
    behind = (sums[index + 1] - sums[low]) / (index + 1 - low)[:, None]
    ahead = (sums[high] - sums[index]) / (high - index)[:, None]
    direction = ahead - behind
    length = np.hypot(*direction.T)
    safe = np.where(length > 0.0, length, 1.0)[:, None]
    return np.where(length[:, None] > 0.0, direction / safe, np.array([1.0, 0.0]))


def _deviation(residual: FloatArray) -> float:
    sigma = 1.4826 * float(np.median(residual))
    for _ in range(20):
        kept = residual[residual <= _CUT * sigma]
        if len(kept) < 6:
            break
        before, sigma = sigma, float(np.sqrt(np.mean(kept**2) / _VARIANCE_WITHIN_CUT))
        if abs(sigma - before) <= 1e-3 * before:
            break
    return sigma
