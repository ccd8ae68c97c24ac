"""Least vertical distance between a wheel and its rail, by a scan and a refined minimum.

Source: section 2.2 of the paper (Wang 1984): the shortest of the vertical bars between the
profiles, the wheelset lifted. With yaw the wheel's contact locus (locus.py) takes the place of its
profile: at a minimum its tangent is the rail's. Frame: track frame, left side, centre at z = 0.
"""

import math

import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.locus import wheel_point
from exudyn_wheelset.contact.search import grid_foot
from exudyn_wheelset.contact.tables import (
    FINE_COUNT,
    FINE_NODES,
    GRID,
    GRID_START,
    GRID_STEP,
    HEADER,
    RAIL,
    RAIL_HIGH,
    RAIL_LOW,
    RAIL_SEGMENTS,
    RAIL_SPACING,
)

# Local minima of the coarse scan within this height of the least are refined: the nodes, a
# millimetre apart, see a minimum too high by at most 0.02 mm across, 0.1 mm along a steep flange.
_SCAN_WINDOW = 2.0e-4


@compiled
def _vertical_gap(table, side, arc, cy, lx, ly, lz):
    """Height of the wheel's point above the rail (centre at z = 0), sine between the tangents."""
    _, py, pz, ny, nz, _, _, curvature = wheel_point(table, side, arc, cy, 0.0, lx, ly, lz)
    at = grid_foot(table, side, arc, cy, 0.0, lx, ly, lz)
    offset = int(table[side + RAIL])
    spacing = table[side + RAIL_SPACING]
    segments = int(table[side + RAIL_SEGMENTS])
    for _ in range(12):
        y, y1, y2, z, z1, z2 = curve_point(table, offset, spacing, segments, at)
        step = (py - y) / y1
        at += step
        if abs(step) < 1.0e-13:
            break
    y, y1, y2, z, z1, z2 = curve_point(table, offset, spacing, segments, at)
    sine = y1 * ny + z1 * nz
    return pz - z, sine, curvature - (y1 * z2 - z1 * y2), at


@compiled
def _refine(table, side, low, high, cy, lx, ly, lz):
    """Local minimum of the vertical gap in [low, high]: (arc, gap, rail arc)."""
    arc = 0.5 * (low + high)
    for _ in range(60):
        _, sine, bend, _ = _vertical_gap(table, side, arc, cy, lx, ly, lz)
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
    gap, _, _, at = _vertical_gap(table, side, arc, cy, lx, ly, lz)
    return arc, gap, at


@compiled
def least_gap(table, side, cy, lx, ly, lz):
    """Least vertical distance of one side with the centre at z = 0, and the runner-up.

    Returns (gap, wheel arc, rail arc, second gap, second wheel arc, second rail arc); the second
    gap is inf where there is no other local minimum within the scan's window.
    """
    nodes = int(table[side + FINE_NODES])
    count = int(table[side + FINE_COUNT])
    grid = int(table[side + GRID])
    start = table[side + GRID_START]
    step = table[side + GRID_STEP]
    gaps = np.full(count, np.inf)
    lowest = np.inf
    q = 1.0 - lx * lx
    for node in range(count):
        base = nodes + node
        w = table[base + count]
        r = table[base + 2 * count]
        t = table[base + 3 * count]
        root = math.sqrt(max(q - lx * lx * t * t, 1.0e-6)) / q
        along = -lx * lx * t / q
        py = cy + w * ly + r * (along * ly + root * lz)
        if py < table[side + RAIL_LOW] or py > table[side + RAIL_HIGH]:
            continue
        place = (py - start) / step
        cell = int(place)
        at = grid + cell
        height = table[at] + (place - cell) * (table[at + 1] - table[at])
        gaps[node] = w * lz + r * (along * lz - root * ly) - height
        lowest = min(lowest, gaps[node])
    best = second = np.inf
    best_arc = best_at = second_arc = second_at = np.nan
    if lowest == np.inf:
        return best, best_arc, best_at, second, second_arc, second_at
    for node in range(count):
        gap = gaps[node]
        before = gaps[node - 1] if node > 0 else np.inf
        after = gaps[node + 1] if node + 1 < count else np.inf
        window = _SCAN_WINDOW / table[nodes + 4 * count + node]
        if gap > lowest + window or gap > before or gap >= after:
            continue
        low = table[nodes + max(node - 1, 0)]
        high = table[nodes + min(node + 1, count - 1)]
        arc, gap, at = _refine(table, side, low, high, cy, lx, ly, lz)
        if gap < best:
            second, second_arc, second_at = best, best_arc, best_at
            best, best_arc, best_at = gap, arc, at
        elif gap < second and arc != best_arc:
            second, second_arc, second_at = gap, arc, at
    return best, best_arc, best_at, second, second_arc, second_at


@compiled
def gap_difference(table, y, roll, yaw):
    """Least distance on the left minus that on the right [m], and the left one."""
    lx = -math.sin(yaw) * math.cos(roll)
    ly = math.cos(yaw) * math.cos(roll)
    lz = math.sin(roll)
    left = least_gap(table, 0, y, lx, ly, lz)[0]
    right = least_gap(table, HEADER, -y, -lx, ly, -lz)[0]
    return left - right, left
