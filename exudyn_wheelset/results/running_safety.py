"""Running safety and track loading as railway engineers read them off wheel forces.

Forces of the rails on the wheels in the track's frame: Y to the left, Q upwards; axis -1 is left,
right. Limits by EN 14363 and UIC 518; SI.

    Y/Q              Y counted towards the field side, as the wheel pushes its rail; a flange climbs
                     above Nadal's limit (tan d - mu)/(1 + mu tan d), d the flange's angle
                     (Nadal 1896); compared as a mean over 2 m in steps of 0.5 m
    sum of Y         |Y_left + Y_right| up to k (10 kN + P0/3), P0 the static axle load, k = 1, for
                     freight wagons 0.85 (Prud'homme), as a mean over 2 m
    unloading        (Q0 - Q)/Q0
    load transfer    of a quasi-static curve: dQ/Q0 = 2 h (V^2/(R g) - u/e)/e, h the height of the
                     centre of gravity, u the cant, e the distance of the contact points
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError

FIELD_SIDE = np.array([-1.0, 1.0])


def guiding_quotient(lateral: Array, vertical: Array) -> Array:
    """Y/Q (..., 2), Y towards the field side; NaN where a wheel carries nothing."""
    loaded = vertical > 0.0
    return np.where(loaded, FIELD_SIDE * lateral / np.where(loaded, vertical, 1.0), np.nan)


def nadal_limit(flange_angle: float, friction: float) -> float:
    """Y/Q at which a flange of that angle [rad] begins to climb: (tan d - mu)/(1 + mu tan d)."""
    slope = math.tan(flange_angle)
    return (slope - friction) / (1.0 + friction * slope)


def sum_of_y_limit(axle_load: float, freight: bool = False) -> float:
    """Limit [N] of |sum of Y| as a mean over 2 m: 10 kN + P0/3, times 0.85 for freight wagons."""
    return (0.85 if freight else 1.0) * (10.0e3 + axle_load / 3.0)


def unloading(vertical: Array, static_loads: Array) -> Array:
    """(Q0 - Q)/Q0 of forces (m, wheelsets, 2) and loads at rest (wheelsets, 2) [N]."""
    return np.asarray((static_loads - vertical) / static_loads)


def sliding_mean(distance: Array, values: Array, length: float, step: float) -> tuple[Array, Array]:
    """Means of values (m, ...) over windows of `length` [m] every `step` [m]: centres, means.

    Of the straight lines between the samples, exactly. Raises AnalysisError where the way is
    shorter than a window.
    """
    distance, values = np.asarray(distance, dtype=float), np.asarray(values, dtype=float)
    if distance[-1] < distance[0]:
        distance, values = distance[::-1], values[::-1]
    way = float(distance[-1] - distance[0])
    if way < length * (1.0 - 1e-9):
        raise AnalysisError(
            f"a mean over {length:g} m needs as long a way, the motion has {way:.4g} m: run longer"
        )
    count = int((way - length) / step + 1e-9) + 1
    begins = distance[0] + step * np.arange(count)
    flat = values.reshape(len(values), -1)
    pieces = 0.5 * np.diff(distance)[:, None] * (flat[1:] + flat[:-1])
    total = np.vstack([np.zeros(flat.shape[1]), np.cumsum(pieces, axis=0)])

    def integral(at: Array) -> Array:
        row = np.clip(np.searchsorted(distance, at, "right") - 1, 0, len(distance) - 2)
        x = (at - distance[row])[:, None]
        width = (distance[row + 1] - distance[row])[:, None]
        rise = (flat[row + 1] - flat[row]) / np.where(width > 0.0, width, 1.0)
        return np.asarray(total[row] + x * (flat[row] + 0.5 * x * rise))

    ends = np.minimum(begins + length, distance[-1])
    means = (integral(ends) - integral(begins)) / length
    return begins + 0.5 * length, means.reshape(count, *values.shape[1:])
