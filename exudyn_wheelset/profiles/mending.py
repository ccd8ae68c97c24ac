"""Points in the order of the curve: what measured files have wrong about it, and its mends.

A profile is followed as a parametric curve: what counts is the order of the points along it, not
that of their y. Each function takes points (shape (n, 2), columns y and z [m]) in file order and
returns the indices to keep, in their new order; what it did goes to `remarks`, by line.

- Lost ends: up to three points beyond a gap, off the curve's course (a line of wheel sizes that
  was taken for a point, an end mark). They go.
- Doubled points, points measured twice and second passes over the same part go. Neighbours in the
  wrong order (noise along the curve) are exchanged where that makes the polygon shorter; pieces in
  the wrong order are put in order.
- Overhanging ends (flange back, web, a gauge face that undercuts after wear) are cut off where the
  curve stops advancing: a wheel that comes from above cannot touch what lies behind. The rest is
  a function of y, which is what the contact kernels need.
- What still runs back after that is left out: the longest row of points with growing y remains
  (C. Schensted, "Longest increasing and decreasing subsequences", Canad. J. Math. 13, 1961).
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.profiles.curve import chord_length
from exudyn_wheelset.profiles.formats.raw import listed

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

CLOSEST = 1e-9
_MOST_LOST = 3
_FEWEST = 8
# An end whose y grows by less than this part of its length carries no wheel: 1:50, where UIC60's
# flank has 1:20; seen over 3 mm, so that noise and a wavering gauge do not end a profile.
_LEAST_ADVANCE = 0.02
_WINDOW = 3e-3
# A curve that turns back this gently is no overhang but a second pass over the same part.
_OVERHANG_STEEPNESS = 0.5
# A step back this short, in parts of the steps beside it, is the same point measured twice.
_REPEATED = 0.2


@dataclass(frozen=True)
class Stretch:
    """first, last: indices kept; low_face, high_face: the curve is upright where it was cut."""

    first: int
    last: int
    low_face: bool
    high_face: bool


def without_lost_ends(points: FloatArray, lines: IntArray, remarks: list[str]) -> IntArray:
    """Indices without points at the ends that lie off the curve's course, in any unit."""
    first, last = 0, len(points)
    if last < 20:
        return np.arange(last)
    steps = np.hypot(*np.diff(points, axis=0).T)
    typical = float(np.median(steps))
    inner = points[_MOST_LOST : last - _MOST_LOST]
    extent = float(np.max(np.ptp(inner, axis=0)))
    for k in range(_MOST_LOST, 0, -1):
        if _is_lost(points, k, typical, extent):
            first = k
            break
    backward = points[::-1]
    for k in range(_MOST_LOST, 0, -1):
        if _is_lost(backward, k, typical, extent):
            last -= k
            break
    gone = [*range(first), *range(last, len(points))]
    if gone:
        said = [f"line {lines[i]} ({points[i, 0]:g}, {points[i, 1]:g})" for i in gone]
        remarks.append(f"end points off the curve left out: {listed(said)}")
    return np.arange(first, last)


def _is_lost(points: FloatArray, k: int, typical: float, extent: float) -> bool:
    """Whether the first k points lie beyond a gap and not on the curve's way on."""
    jump = points[k - 1] - points[k]
    gap = float(np.hypot(*jump))
    if not gap > max(6.0 * typical, 0.02 * extent):
        return False
    if gap > extent:
        return True
    course = points[k] - points[k + 4]
    length = float(np.hypot(*course))
    return length > 0.0 and float(jump @ course) < 0.8 * gap * length


def in_order(points: FloatArray, lines: IntArray, remarks: list[str]) -> IntArray:
    """Indices in the order of the curve, y growing, without doubled points."""
    order = np.arange(len(points))
    if np.sum(np.diff(points[:, 0]) < 0.0) > 0.5 * len(points):
        order = order[::-1]
    order = _pieces_in_order(points, order, remarks)
    order = _without_second_passes(points, order, lines, remarks)
    by_height = order[np.argsort(points[order, 0], kind="stable")]
    if _length(points[order]) > 3.0 * _length(points[by_height]):
        order = by_height
        remarks.append("points out of order: sorted by y")
    doubled = np.hypot(*np.diff(points[order], axis=0).T) < CLOSEST
    if np.any(doubled):
        gone = order[1:][doubled]
        order = order[np.concatenate(([True], ~doubled))]
        words = [str(line) for line in sorted(lines[gone])]
        remarks.append(f"{len(gone)} doubled points left out, lines {listed(words)}")
    return _neighbours_in_order(points, order, lines, remarks)


def _length(points: FloatArray) -> float:
    return float(np.sum(np.hypot(*np.diff(points, axis=0).T)))


def _pieces_in_order(points: FloatArray, order: IntArray, remarks: list[str]) -> IntArray:
    steps = np.hypot(*np.diff(points[order], axis=0).T)
    typical = float(np.median(steps))
    extent = float(np.max(np.ptp(points, axis=0)))
    jumps = np.flatnonzero(steps > max(20.0 * typical, 0.1 * extent))
    if not 0 < len(jumps) <= 8:
        return order
    pieces = np.split(order, jumps + 1)
    if min(len(piece) for piece in pieces) < _FEWEST:
        return order
    turned = [p if points[p[0], 0] <= points[p[-1], 0] else p[::-1] for p in pieces]
    turned.sort(key=lambda piece: float(np.mean(points[piece, 0])))
    joined = np.concatenate(turned)
    if not _length(points[joined]) < _length(points[order]) - 0.5 * np.min(steps[jumps]):
        return order
    remarks.append(f"{len(pieces)} pieces of the curve put in order")
    return joined


def _without_second_passes(
    points: FloatArray, order: IntArray, lines: IntArray, remarks: list[str]
) -> IntArray:
    """Without the points of a sweep that begins before the end of the sweep in front of it."""
    row = points[order]
    steps = np.diff(row, axis=0)
    lengths = np.hypot(*steps.T)
    typical = float(np.median(lengths))
    keep = np.ones(len(order), dtype=bool)
    for i in np.flatnonzero(lengths > 4.0 * typical):
        if i < 4:
            continue
        before = row[max(i - 200, 0) : i]
        nearest = np.min(np.hypot(*(before - row[i + 1]).T))
        course = row[i] - row[i - 3]
        if nearest > typical or float(steps[i] @ course) >= 0.0:
            continue
        behind = (row[i + 1 :] - row[i]) @ course <= 0.0
        end = i + 1 + (len(behind) if np.all(behind) else int(np.argmin(behind)))
        keep[i + 1 : end] = False
    if not np.all(keep) and np.count_nonzero(~keep) < 0.3 * len(order):
        gone = lines[order[~keep]]
        remarks.append(
            f"{len(gone)} points of a second pass left out, lines {min(gone)} to {max(gone)}"
        )
        return order[keep]
    return order


def _neighbours_in_order(
    points: FloatArray, order: IntArray, lines: IntArray, remarks: list[str]
) -> IntArray:
    order = order.copy()
    exchanged: list[int] = []
    repeated: list[int] = []
    for i in np.flatnonzero(np.diff(points[order, 0]) <= 0.0):
        if not 1 <= i < len(order) - 2:
            continue
        a, b, c, d = points[order[i - 1 : i + 3]]
        if np.hypot(*(c - b)) < _REPEATED * min(np.hypot(*(b - a)), np.hypot(*(d - c))):
            repeated.append(int(i) + 1)
            continue
        now = np.hypot(*(b - a)) + np.hypot(*(d - c))
        then = np.hypot(*(c - a)) + np.hypot(*(d - b))
        if then < now and c[0] < b[0]:
            order[[i, i + 1]] = order[[i + 1, i]]
            exchanged.append(int(lines[order[i]]))
    if exchanged:
        words = [str(line) for line in sorted(exchanged)]
        remarks.append(f"{len(exchanged)} points put in order, lines {listed(words)}")
    if repeated:
        words = [str(line) for line in sorted(lines[order[repeated]])]
        remarks.append(
            f"{len(repeated)} points left out that repeat their neighbour, lines {listed(words)}"
        )
    return np.delete(order, repeated)


def advancing_stretch(points: FloatArray) -> Stretch:
    """The stretch of points between overhanging ends; y grows over it but for noise."""
    middle = longest_advance(points[:, 0])
    start = int(middle[len(middle) // 2])
    s = chord_length(points)
    last, high = _end_of_advance(s, points[:, 0], points[:, 1], start)
    n = len(points)
    back, low = _end_of_advance(s[-1] - s[::-1], -points[::-1, 0], points[::-1, 1], n - 1 - start)
    return Stretch(n - 1 - back, last, low, high)


def _end_of_advance(s: FloatArray, y: FloatArray, z: FloatArray, start: int) -> tuple[int, bool]:
    """Index of the last point before y stops growing, and whether it stops before the end."""
    ends = np.searchsorted(s, s + _WINDOW, side="right")
    cumulated_y = np.concatenate(([0.0], np.cumsum(y)))
    cumulated_s = np.concatenate(([0.0], np.cumsum(s)))
    cumulated_z = np.concatenate(([0.0], np.cumsum(z)))
    middles = np.searchsorted(s, s + 0.5 * _WINDOW, side="right")
    for i in range(start, len(s) - 1):
        low, high = max(int(middles[i]), i + 1), int(ends[i])
        if high <= low:
            low, high = i + 1, i + 2
        count = high - low
        way = (cumulated_s[high] - cumulated_s[low]) / count - s[i]
        advance = (cumulated_y[high] - cumulated_y[low]) / count - y[i]
        climb = abs((cumulated_z[high] - cumulated_z[low]) / count - z[i])
        if way < 0.2 * _WINDOW and i + 3 > len(s) - 1:
            break
        if advance < _LEAST_ADVANCE * way and climb > _OVERHANG_STEEPNESS * abs(advance):
            furthest = i + int(np.argmax(y[i : max(int(ends[i]), i + 1)]))
            return furthest, True
    return len(s) - 1, False


def longest_advance(y: FloatArray) -> IntArray:
    """Indices of the longest subsequence with growing y."""
    tails: list[float] = []
    ends: list[int] = []
    before = np.full(len(y), -1)
    for i, value in enumerate(y.tolist()):
        place = bisect_left(tails, value)
        if place == len(tails):
            tails.append(value)
            ends.append(i)
        else:
            tails[place] = value
            ends[place] = i
        before[i] = ends[place - 1] if place else -1
    row = []
    i = ends[-1]
    while i >= 0:
        row.append(i)
        i = int(before[i])
    return np.array(row[::-1])
