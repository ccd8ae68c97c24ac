"""Least vertical distance between a wheel and its rail, by a scan and a refined minimum.

Source: section 2.2 of the paper (Wang 1984): the shortest of the vertical bars between the
profiles, the wheelset lifted. With yaw the wheel's contact locus (locus.py) takes the place of its
profile: at a minimum its tangent is the rail's. Frame: track frame, left side, centre at z = 0.
"""

import math

import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.layout import (
    GRID_HEIGHT,
    NODE_ARC,
    NODE_FLATNESS,
    NODE_LATERAL,
    NODE_RADIUS,
    NODE_SLOPE,
    Axle,
    block_row,
    side_of,
)
from exudyn_wheelset.contact.locus import wheel_point
from exudyn_wheelset.contact.search import grid_foot

# Local minima of the coarse scan within this height of the least are refined: the nodes, a
# millimetre apart, see a minimum too high by at most 0.02 mm across, 0.1 mm along a steep flange.
_SCAN_WINDOW = 2.0e-4
# Where wheel and rail are of one radius (13 mm in 13 mm at the throat) they part by nanometres over
# a millimetre, and several minima lie between two nodes: each of this many cells is looked at, a
# cell with a minimum in parts shorter than the pieces of the profiles (0.1 mm).
_CELLS = 4
_PARTS = 4
# The scan takes the rail as straight between the grid's points: twice the sag of an arc, of the sum
# of the second differences at both ends.
_SAG = 0.125
# Newton's steps to the foot on the rail, from the grid's guess some micrometres off: two leave a
# rounding error.
_STEPS_FOR_SIGN = 2
_EXACT_STEPS = 12


@compiled
def _vertical_gap(table, side, arc, axle, most_steps):
    """Height of the wheel's point above the rail (centre at z = 0), sine between the tangents."""
    _, py, pz, ny, nz, _, _, curvature = wheel_point(table, side, arc, axle)
    at = grid_foot(table, side, arc, axle)
    for _ in range(most_steps):
        y, y1, y2, z, z1, z2 = curve_point(table, side.rail, at)
        step = (py - y) / y1
        at += step
        if abs(step) < 1.0e-13:
            break
    y, y1, y2, z, z1, z2 = curve_point(table, side.rail, at)
    sine = y1 * ny + z1 * nz
    return pz - z, sine, curvature - (y1 * z2 - z1 * y2), at


@compiled
def _minimum(table, side, low, high, axle):
    """Local minimum of the vertical gap in [low, high]: (arc, gap, rail arc)."""
    arc = 0.5 * (low + high)
    for _ in range(60):
        _, sine, bend, _ = _vertical_gap(table, side, arc, axle, _EXACT_STEPS)
        if sine > 0.0:
            high = arc
        else:
            low = arc
        trial = arc - sine / bend if bend > 0.0 else 0.5 * (low + high)
        if trial <= low or trial >= high:
            trial = 0.5 * (low + high)
        change = abs(trial - arc)
        arc = trial
        if change < 1.0e-12:
            break
    gap, _, _, at = _vertical_gap(table, side, arc, axle, _EXACT_STEPS)
    return arc, gap, at


@compiled
def _least_minimum(table, side, low, high, axle):
    """Least of the local minima in [low, high], where the gap falls at first and rises at last."""
    least = np.inf
    least_arc = least_at = np.nan
    width = (high - low) / _PARTS
    falls = True
    for part in range(_PARTS):
        end = low + width
        rises = part == _PARTS - 1 or (
            _vertical_gap(table, side, end, axle, _STEPS_FOR_SIGN)[1] > 0.0
        )
        if falls and rises:
            arc, gap, at = _minimum(table, side, low, end, axle)
            if gap < least:
                least, least_arc, least_at = gap, arc, at
        falls = not rises
        low = end
    return least_arc, least, least_at


@compiled
def least_gap(table, hand, cy, lx, ly, lz):
    """Least vertical distance of one side with the centre at z = 0, and the runner-up.

    hand: 0 left, 1 right; cy [m] and the axle's unit vector mirrored for the right side.
    Returns (gap, wheel arc, rail arc, second gap, second wheel arc, second rail arc); the second
    gap is inf where there is no other local minimum within the scan's window.
    """
    side = side_of(table, hand)
    axle = Axle(cy, 0.0, lx, ly, lz)
    count = side.fine_nodes.count
    arcs = block_row(table, side.fine_nodes, NODE_ARC)
    lateral = block_row(table, side.fine_nodes, NODE_LATERAL)
    radii = block_row(table, side.fine_nodes, NODE_RADIUS)
    slopes = block_row(table, side.fine_nodes, NODE_SLOPE)
    flatness = block_row(table, side.fine_nodes, NODE_FLATNESS)
    heights = block_row(table, side.grid, GRID_HEIGHT)
    gaps = np.full(count, np.inf)
    sags = np.zeros(count)
    lowest = np.inf
    q = 1.0 - lx * lx
    for node in range(count):
        w = lateral[node]
        r = radii[node]
        t = slopes[node]
        root = math.sqrt(max(q - lx * lx * t * t, 1.0e-6)) / q
        along = -lx * lx * t / q
        py = cy + w * ly + r * (along * ly + root * lz)
        if py < side.rail_low or py > side.rail_high:
            continue
        place = (py - side.grid_start) / side.grid_step
        cell = int(place)
        height = heights[cell] + (place - cell) * (heights[cell + 1] - heights[cell])
        gaps[node] = w * lz + r * (along * lz - root * ly) - height
        last = min(cell + 2, len(heights) - 1)
        bend = heights[cell - 1] - heights[cell] - heights[cell + 1] + heights[last]
        sags[node] = _SAG * abs(bend)
        lowest = min(lowest, gaps[node])
    best = second = np.inf
    best_arc = best_at = second_arc = second_at = np.nan
    if lowest == np.inf:
        return best, best_arc, best_at, second, second_arc, second_at
    marked = np.zeros(count + 1, dtype=np.bool_)
    for node in range(count):
        gap = gaps[node] - sags[node]
        before = gaps[node - 1] + sags[node - 1] if node > 0 else np.inf
        after = gaps[node + 1] + sags[node + 1] if node + 1 < count else np.inf
        window = _SCAN_WINDOW / flatness[node]
        marked[node] = gap <= lowest + window and gap <= before and gap < after
    falls = True
    for node in range(count - 1):
        if not (marked[node] or marked[node + 1]):
            falls = True
            continue
        low = arcs[node]
        width = (arcs[node + 1] - low) / _CELLS
        ends = not (marked[node + 1] or marked[node + 2])
        for cell in range(_CELLS):
            high = low + width
            rises = (ends and cell == _CELLS - 1) or (
                _vertical_gap(table, side, high, axle, _STEPS_FOR_SIGN)[1] > 0.0
            )
            if falls and rises:
                arc, gap, at = _least_minimum(table, side, low, high, axle)
                if gap < best:
                    second, second_arc, second_at = best, best_arc, best_at
                    best, best_arc, best_at = gap, arc, at
                elif gap < second:
                    second, second_arc, second_at = gap, arc, at
            falls = not rises
            low = high
    return best, best_arc, best_at, second, second_arc, second_at


@compiled
def _slope_over_roll(table, hand, arc, cy, lx, ly, lz):
    """Rate of the least distance as roll lifts the side [m/rad]: its point turns about the centre.

    That another point becomes the least adds nothing (envelope).
    """
    _, py, pz, ny, nz, _, _, _ = wheel_point(
        table, side_of(table, hand), arc, Axle(cy, 0.0, lx, ly, lz)
    )
    return py - cy - ny / nz * pz


@compiled
def gap_difference(table, y, roll, yaw):
    """Least distance on the left minus that on the right [m], and its rate over roll [m/rad]."""
    lx = -math.sin(yaw) * math.cos(roll)
    ly = math.cos(yaw) * math.cos(roll)
    lz = math.sin(roll)
    left, left_arc, _, _, _, _ = least_gap(table, 0, y, lx, ly, lz)
    right, right_arc, _, _, _, _ = least_gap(table, 1, -y, -lx, ly, -lz)
    if not (left < np.inf and right < np.inf):
        return left - right, np.nan
    slope = _slope_over_roll(table, 0, left_arc, y, lx, ly, lz)
    slope += _slope_over_roll(table, 1, right_arc, -y, -lx, ly, -lz)
    return left - right, slope
