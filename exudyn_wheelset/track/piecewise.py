"""Functions of the arc length as pieces of cubics: made, rounded off, put on common pieces.

A function is its breaks s (n + 1,) [m] and coefficients (n, 4) in powers of s minus the break
before; beyond its ends it stays what it is there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exudyn_wheelset.arrays import Array


class Pieces(NamedTuple):
    """breaks (n + 1,) [m]; coefficients (n, 4)."""

    breaks: Array
    coefficients: Array

    def __call__(self, s: Array | float, derivative: int = 0) -> Array:
        """Value, or a derivative, at stations s."""
        s = np.asarray(s, dtype=float)
        inside = np.clip(s, self.breaks[0], self.breaks[-1])
        row = np.clip(np.searchsorted(self.breaks, inside, "right") - 1, 0, len(self) - 1)
        x = inside - self.breaks[row]
        c = [self.coefficients[row, k] for k in range(4)]
        if derivative == 0:
            return np.asarray(c[0] + x * (c[1] + x * (c[2] + x * c[3])))
        found = c[1] + x * (2.0 * c[2] + x * 3.0 * c[3])
        if derivative == 2:
            found = 2.0 * c[2] + 6.0 * c[3] * x
        return np.asarray(np.where(s == inside, found, 0.0))

    def __len__(self) -> int:
        return len(self.coefficients)


def polyline(points: Array) -> Pieces:
    """Straight lines between points (n, 2), constant through a single one."""
    s, values = points[:, 0], points[:, 1]
    if len(s) == 1:
        return Pieces(np.array([s[0], s[0] + 1.0]), np.array([[values[0], 0.0, 0.0, 0.0]]))
    slopes = np.diff(values) / np.diff(s)
    zeros = np.zeros(len(slopes))
    return Pieces(s, np.column_stack([values[:-1], slopes, zeros, zeros]))


def on_breaks(function: Pieces, breaks: Array) -> Pieces:
    """The same function on breaks that hold all of its own within them."""
    inner = 0.5 * (breaks[:-1] + breaks[1:])
    first, last = function.breaks[0], function.breaks[-1]
    row = np.clip(np.searchsorted(function.breaks, inner, "right") - 1, 0, len(function) - 1)
    x = breaks[:-1] - function.breaks[row]
    c0, c1, c2, c3 = function.coefficients[row].T
    moved = np.column_stack(
        [c0 + x * (c1 + x * (c2 + x * c3)), c1 + x * (2 * c2 + 3 * x * c3), c2 + 3 * x * c3, c3]
    )
    outside = (inner < first) | (inner > last)
    moved[outside] = 0.0
    moved[outside, 0] = function(inner[outside])
    return Pieces(breaks, moved)


def rounded(function: Pieces, length: float) -> Pieces:
    """The function with every kink rounded off by a parabola over `length` [m] about it.

    That is its running mean where it is straight on both sides. Where the pieces beside a kink are
    shorter, it is rounded over the shorter one.
    """
    breaks, coefficients = function
    widths = np.diff(breaks)
    ends = coefficients[:, 1] + widths * (
        2.0 * coefficients[:, 2] + 3.0 * widths * coefficients[:, 3]
    )
    before, after = np.append(0.0, ends), np.append(coefficients[:, 1], 0.0)
    kinks = after - before
    size = np.abs(kinks).max(initial=0.0)
    corrections = []
    for k in np.flatnonzero(np.abs(kinks) > 1e-9 * size):
        half = 0.5 * length
        if k > 0:
            half = min(half, 0.5 * widths[k - 1])
        if k < len(widths):
            half = min(half, 0.5 * widths[k])
        rise = kinks[k] / (4.0 * half)
        # The parabola less the line before the kink, less the line behind it.
        corrections.append(
            Pieces(
                np.array([breaks[k] - half, breaks[k], breaks[k] + half]),
                np.array([[0.0, 0.0, rise, 0.0], [rise * half**2, -2.0 * rise * half, rise, 0.0]]),
            )
        )
    if not corrections:
        return function
    all_breaks = np.unique(np.concatenate([breaks, *(one.breaks for one in corrections)]))
    total = on_breaks(function, all_breaks).coefficients.copy()
    for one in corrections:
        # Zero outside, and not what it is at its ends.
        inside = (all_breaks[:-1] >= one.breaks[0]) & (all_breaks[1:] <= one.breaks[-1])
        total[inside] += on_breaks(one, all_breaks).coefficients[inside]
    return Pieces(all_breaks, total)


def on_common_breaks(functions: list[Pieces], longest: float) -> tuple[Array, Array]:
    """Breaks (n + 1,) and coefficients (n, k, 4) of k functions on common pieces.

    Pieces on which the functions change are cut to at most `longest` [m].
    """
    breaks = np.unique(np.concatenate([one.breaks for one in functions]))
    # Breaks that differ by rounding are one.
    breaks = breaks[np.append(True, np.diff(breaks) > 1e-9 * (1.0 + np.abs(breaks[1:])))]
    table = np.stack([on_breaks(one, breaks).coefficients for one in functions], axis=1)
    fine = [breaks[:1]]
    for k, changing in enumerate(np.any(table[:, :, 1:] != 0.0, axis=(1, 2))):
        width = breaks[k + 1] - breaks[k]
        count = int(np.ceil(width / longest)) if changing else 1
        fine.append(breaks[k] + width * np.arange(1, count + 1) / count)
    breaks = np.concatenate(fine)
    return breaks, np.stack([on_breaks(one, breaks).coefficients for one in functions], axis=1)
