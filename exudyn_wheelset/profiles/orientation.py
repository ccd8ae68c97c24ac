"""What a row of points looks like: a rail head, a wheel with its flange, and which way round.

The test looks at the level stretches of a profile. A rail head has 20 mm or more of nearly level
surface at its extreme height, and falls from there to both sides. A wheel has its extreme height
at the narrow flange tip, where it may end, and 30 mm or more of nearly level tread well away from
that height. What is neither is a piece of a rail head if it is level on top and steep at one end,
or level over most of its width and falls at both ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_GRID = 1e-3
_LEVEL_SLOPE = 0.25
_TIP_SLOPE = 0.5
_HEAD_WIDTH = 0.02
_HEAD_DEPTH = 3e-3
_HEAD_FALL = 4e-3
_TREAD_WIDTH = 0.03
_FLANGE_HEIGHT = 8e-3


@dataclass(frozen=True)
class Look:
    """kind: "wheel" or "rail"; y_sign, z_sign: -1 where the axis must be turned, else 1."""

    kind: str
    y_sign: int
    z_sign: int


def look_at(y: FloatArray, z: FloatArray) -> Look | None:
    """What points with increasing y look like [m]; None where the shape does not tell.

    The direction of y of a rail cannot be told from its shape; y_sign is 1 there.
    """
    grid = np.arange(y[0], y[-1] + 0.5 * _GRID, _GRID)
    if len(grid) < 10:
        return None
    height = np.interp(grid, y, z)
    slope = np.gradient(height, _GRID)
    level = np.abs(slope) < _LEVEL_SLOPE
    best: Look | None = None
    widest = 0.0
    for sign in (1, -1):
        up = sign * height
        top = int(np.argmax(sign * z))
        fall = min(sign * (z[top] - z[0]), sign * (z[top] - z[-1]))
        tip_at_end = top in (0, len(z) - 1) and abs(_end_slope(height, top)) < _TIP_SLOPE
        if (fall < _HEAD_FALL or top in (0, len(z) - 1)) and not tip_at_end:
            continue
        depth = sign * z[top] - up
        head = _GRID * np.count_nonzero(level & (depth < _HEAD_DEPTH))
        tread = level & (depth > _FLANGE_HEIGHT)
        width = _GRID * np.count_nonzero(tread)
        if width >= _TREAD_WIDTH and width > head and width > widest:
            beyond = float(np.mean(grid[tread])) > y[top]
            best, widest = Look("wheel", 1 if beyond else -1, -sign), width
        elif head >= _HEAD_WIDTH and head > widest and not tip_at_end:
            best, widest = Look("rail", 1, sign), head
    return best or _half_head(height, level, z) or _plateau(height, z)


def _end_slope(height: FloatArray, top: int) -> float:
    """Mean slope over the last 3 mm at the end that the index `top` of the points is."""
    end = height[:4] if top == 0 else height[-4:]
    return float(end[-1] - end[0]) / (3.0 * _GRID)


def _half_head(height: FloatArray, level: NDArray[np.bool_], z: FloatArray) -> Look | None:
    """A rail head seen from the gauge side: level on top, steep at one end, measured not far
    beyond the top at the other."""
    for sign in (1, -1):
        up = sign * height
        top = float(np.max(sign * z))
        crest = int(np.argmax(up))
        falls = sorted((top - sign * z[0], top - sign * z[-1]))
        head = _GRID * np.count_nonzero(level & (top - up < _HEAD_DEPTH))
        steep = max(abs(_end_slope(height, 0)), abs(_end_slope(height, 1))) > 1.0
        if (
            0 < crest < len(height) - 1
            and falls[0] > 0.05 * _HEAD_FALL
            and falls[1] > 2.0 * _HEAD_FALL
            and head >= _HEAD_WIDTH
            and steep
        ):
            return Look("rail", 1, sign)
    return None


def _plateau(height: FloatArray, z: FloatArray) -> Look | None:
    """A piece of a rail head: level over most of its width, falling at both ends, on one side."""
    for sign in (1, -1):
        up = sign * height
        top = float(np.max(sign * z))
        falls = min(top - sign * z[0], top - sign * z[-1])
        level = np.count_nonzero(top - up < 0.2 * _HEAD_FALL)
        if falls > 0.2 * _HEAD_FALL and level > 0.6 * len(height):
            return Look("rail", 1, sign)
    return None
