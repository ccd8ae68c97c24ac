"""Patches of one wheel: where the contact locus reaches into the rail, and how far.

At every evaluation, without a table of contact positions: a scan of the wheel's nodes finds the
local maxima of the penetration (lobes) and the valleys between them; a safeguarded Newton
iteration on the angle between wheel and rail tangents refines each. Around a lobe the zone of
virtual penetration, where penetration exceeds (1 - VIRTUAL) of its maximum, is integrated by
Gauss's rule. For a parabola of curvature B the integral is

    I = (4/3) (VIRTUAL delta)^(3/2) / sqrt(B)   so   B = (16/9) (VIRTUAL delta)^3 / I^2

which defines the curvature that Hertz's theory gets: it equals the true one where that is constant
over the patch, and changes smoothly where the patch straddles a jump of curvature (R300/R80/R13 of
a rail head). The patch's position and normal are the weighted means over the same zone.
VIRTUAL = 0.55 is the value of Kik and Piotrowski (1996); the mean curvature so found agrees with
full half-space solutions on S1002/UIC60 to about 1 % in force (tests/test_contact_against_CONTACT).

Two neighbouring lobes merge smoothly: `separation` runs from 0 (no valley) to 1 (the valley leaves
the virtual penetration), see forces.py.

Frame: track frame, left side; lengths in metres.
"""

import math

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.locus import rail_foot, wheel_section
from exudyn_wheelset.contact.tables import (
    GRID,
    GRID_COUNT,
    GRID_START,
    GRID_STEP,
    NODE_COUNT,
    NODES,
    RAIL_HIGH,
    RAIL_LOW,
    WHEEL_SEGMENTS,
    WHEEL_SPACING,
)

VIRTUAL = 0.55
MOST_LOBES = 3
SCAN_MARGIN = 1.5e-4
MERGED_PROMINENCE = 0.1
LOBE_WIDTH = 20
LOBE_ARC, LOBE_FOOT, LOBE_PENETRATION, LOBE_LEFT, LOBE_RIGHT, LOBE_SEPARATION = 0, 1, 2, 3, 4, 5
LOBE_CURVATURE = 6
# Columns for the moments of a lobe's zone, its own and as a part of a merged patch (forces.py).
OWN, MERGED, MERGED_DEPTH = 8, 13, 18

GAUSS = (
    (0.046910077030668018, 0.11846344252809464),
    (0.23076534494715845, 0.23931433524968315),
    (0.5, 0.28444444444444433),
    (0.7692346550528415, 0.23931433524968315),
    (0.95308992296933193, 0.11846344252809464),
)


@compiled(inline="always")
def probe(table, side, arc, foot, cy, cz, lx, ly, lz):
    """Penetration at the wheel's arc length: (penetration, sine, 2 B, foot).

    sine: of the angle from the rail's tangent to the wheel's, the slope of -penetration along the
    wheel; 2 B [1/m]: relative curvature, its derivative.
    """
    py, pz, ny, nz, wheel_curvature = wheel_section(table, side, arc, cy, cz, lx, ly, lz)
    foot, ty, tz, rail_curvature, height = rail_foot(table, side, py, pz, foot)
    return -height, ty * ny + tz * nz, wheel_curvature - rail_curvature, foot


@compiled
def grid_foot(table, side, arc, cy, cz, lx, ly, lz):
    """Arc length of the rail point below the wheel's, from the grid: the guess for `rail_foot`."""
    py, _, _, _, _ = wheel_section(table, side, arc, cy, cz, lx, ly, lz)
    py = min(max(py, table[side + RAIL_LOW]), table[side + RAIL_HIGH])
    place = (py - table[side + GRID_START]) / table[side + GRID_STEP]
    cell = int(place)
    base = int(table[side + GRID] + table[side + GRID_COUNT]) + cell
    return table[base] + (place - cell) * (table[base + 1] - table[base])


@compiled
def level_tangent(table, side, low, high, start, sign, cy, cz, lx, ly, lz):
    """Wheel arc length in [low, high] where the tangents agree: a lobe (sign 1) or valley (-1).

    start: first guess. Returns (arc, foot, penetration, 2 B).
    """
    arc = start
    foot = grid_foot(table, side, arc, cy, cz, lx, ly, lz)
    penetration = 0.0
    bend = 1.0
    for _ in range(40):
        penetration, sine, bend, new_foot = probe(table, side, arc, foot, cy, cz, lx, ly, lz)
        slope = sign * sine
        if slope > 0.0:
            high = arc
        else:
            low = arc
        step = -sine / bend if sign * bend > 0.0 else high - low
        trial = arc + step
        if trial <= low or trial >= high:
            trial = 0.5 * (low + high)
        foot = new_foot + (trial - arc)
        change = abs(trial - arc)
        # Penetration is stationary here: a Taylor step over the last change is exact to 1e-13 m.
        penetration -= sine * (trial - arc) + 0.5 * bend * (trial - arc) ** 2
        arc = trial
        if change < 1.0e-7 or high - low < 1.0e-10:
            break
    return arc, foot, penetration, bend


@compiled(fastmath=True)
def _scan(
    lateral, radii, slopes, flatness, heights, depths,
    cy, cz, lx, ly, lz, low, high, start, per_step,
):  # fmt: skip
    """Fill depths with the penetration of each node below the rail, -1 beside the rail.

    Without branches and with slices, so that the compiler may keep the loop tight. Of the root in
    locus.py it takes two terms: exact enough to choose a node.
    """
    square = lx * lx
    q = 1.0 / (1.0 - square)
    most = len(heights) - 2
    for k in range(len(depths)):
        w = lateral[k]
        r = radii[k]
        t = slopes[k]
        x = square * (1.0 + t * t)
        root = (1.0 - x * (0.5 + 0.125 * x)) * q
        along = -square * t * q
        py = cy + w * ly + r * (along * ly + root * lz)
        pz = cz + w * lz + r * (along * lz - root * ly)
        place = (py - start) * per_step
        cell = min(max(int(place), 0), most)
        height = heights[cell] + (place - cell) * (heights[cell + 1] - heights[cell])
        inside = 1.0 if (py >= low) & (py <= high) else 0.0
        depths[k] = inside * ((height - pz) * flatness[k] + 1.0) - 1.0


@compiled
def find_lobes(table, side, cy, cz, lx, ly, lz, lobes, depths):
    """Fill `lobes` (MOST_LOBES, LOBE_WIDTH) for one side; return their number.

    Per lobe: wheel arc of the maximum, rail foot, penetration, territory [left, right] in wheel
    arc, separation from the next lobe, 2 B. Lobes beyond MOST_LOBES (the least deep) are dropped.
    depths (MOST_NODES): room for the scan.
    """
    nodes = int(table[side + NODES])
    count = int(table[side + NODE_COUNT])
    grid = int(table[side + GRID])
    start = table[side + GRID_START]
    per_step = 1.0 / table[side + GRID_STEP]
    low = table[side + RAIL_LOW]
    high = table[side + RAIL_HIGH]
    # The wheel's lateral position grows with the node: halve the range to where the rail begins.
    first = 0
    final = count
    reach = low - cy - 0.003
    while final - first > 8:
        middle = (first + final) // 2
        if table[nodes + count + middle] * ly + table[nodes + 2 * count + middle] * lz < reach:
            first = middle
        else:
            final = middle
    final = count
    reach = high - cy + 0.003
    low_end = first
    while final - low_end > 8:
        middle = (low_end + final) // 2
        if table[nodes + count + middle] * ly + table[nodes + 2 * count + middle] * lz > reach:
            final = middle
        else:
            low_end = middle
    at = nodes + first
    size = final - first
    cells = int(table[side + GRID_COUNT])
    depths = depths[:size]
    _scan(
        table[at + count : at + count + size],
        table[at + 2 * count : at + 2 * count + size],
        table[at + 3 * count : at + 3 * count + size],
        table[at + 4 * count : at + 4 * count + size],
        table[grid : grid + cells],
        depths, cy, cz, lx, ly, lz, low, high, start, per_step,
    )  # fmt: skip
    found = 0
    before = -1.0
    last = -1.0
    valley = 1.0
    valley_node = -1
    for k in range(size):
        depth = depths[k]
        node = first + k
        if last > -SCAN_MARGIN and last >= before and last > depth and k > 0:
            found = _note_lobe(lobes, found, node - 1, before, last, depth, valley_node)
            valley = last
            valley_node = node - 1
        if depth < valley and found > 0:
            valley = depth
            valley_node = node
        before = last
        last = depth
    if last > -SCAN_MARGIN and last >= before:
        found = _note_lobe(lobes, found, final - 1, before, last, last, valley_node)
    if found == 0:
        return 0
    return _refine_lobes(table, side, cy, cz, lx, ly, lz, lobes, found, first, final - 1)


@compiled
def _note_lobe(lobes, found, node, before, depth, after, valley_node):
    """Store a candidate: node numbers and the depths around it, until it is refined."""
    if found == MOST_LOBES:
        least = 0
        for k in range(1, found):
            if lobes[k, LOBE_PENETRATION] < lobes[least, LOBE_PENETRATION]:
                least = k
        if lobes[least, LOBE_PENETRATION] >= depth:
            return found
        for k in range(least, found - 1):
            for j in range(LOBE_WIDTH):
                lobes[k, j] = lobes[k + 1, j]
        found -= 1
    lobes[found, LOBE_ARC] = node
    lobes[found, LOBE_PENETRATION] = depth
    lobes[found, LOBE_LEFT] = valley_node
    lobes[found, LOBE_FOOT] = before
    lobes[found, LOBE_CURVATURE] = after
    return found + 1


@compiled(inline="always")
def _vertex(left, middle, right, lobes, k):
    """Vertex of the parabola through the depths at three nodes."""
    fall = lobes[k, LOBE_PENETRATION] - lobes[k, LOBE_FOOT]
    rise = lobes[k, LOBE_CURVATURE] - lobes[k, LOBE_PENETRATION]
    curve = fall - rise
    shift = 0.25 * (fall + rise) / curve * (right - left) if curve > 0.0 else 0.0
    return min(max(middle + shift, left), right)


@compiled
def _refine_lobes(table, side, cy, cz, lx, ly, lz, lobes, found, first_node, final_node):
    nodes = int(table[side + NODES])
    kept = 0
    for k in range(found):
        node = int(lobes[k, LOBE_ARC])
        valley_node = int(lobes[k, LOBE_LEFT])
        left = table[nodes + max(node - 1, 0)]
        middle = table[nodes + node]
        right = table[nodes + min(node + 1, final_node)]
        arc, foot, penetration, bend = level_tangent(
            table, side, left, right, _vertex(left, middle, right, lobes, k), 1.0,
            cy, cz, lx, ly, lz,
        )  # fmt: skip
        if penetration <= 0.0:
            continue
        lobes[kept, LOBE_ARC] = arc
        lobes[kept, LOBE_FOOT] = foot
        lobes[kept, LOBE_PENETRATION] = penetration
        lobes[kept, LOBE_CURVATURE] = bend
        lobes[kept, LOBE_LEFT] = table[nodes + first_node]
        lobes[kept, LOBE_SEPARATION] = 1.0
        lobes[kept, MERGED_DEPTH] = 0.0
        if kept > 0:
            before = table[nodes + max(valley_node - 1, 0)]
            after = table[nodes + min(valley_node + 1, final_node)]
            before = max(before, lobes[kept - 1, LOBE_ARC])
            after = min(after, arc)
            border, _, depth, _ = level_tangent(
                table, side, before, after, 0.5 * (before + after), -1.0, cy, cz, lx, ly, lz
            )
            lobes[kept - 1, LOBE_RIGHT] = border
            lobes[kept, LOBE_LEFT] = border
            smaller = min(penetration, lobes[kept - 1, LOBE_PENETRATION])
            prominence = (smaller - depth) / (VIRTUAL * smaller)
            # Nearly one lobe is treated as one: the scan may see it as one as well.
            prominence = (prominence - MERGED_PROMINENCE) / (1.0 - MERGED_PROMINENCE)
            prominence = min(max(prominence, 0.0), 1.0)
            lobes[kept - 1, LOBE_SEPARATION] = prominence * prominence * (3.0 - 2.0 * prominence)
        kept += 1
    if kept > 0:
        segments = table[side + WHEEL_SEGMENTS]
        lobes[kept - 1, LOBE_RIGHT] = segments * table[side + WHEEL_SPACING]
        lobes[kept - 1, LOBE_SEPARATION] = 1.0
    return kept


@compiled
def zone_end(table, side, arc, foot, penetration, bend, limit, level, cy, cz, lx, ly, lz):
    """Wheel arc between `arc` (a maximum) and `limit` where the penetration falls to `level`."""
    direction = 1.0 if limit > arc else -1.0
    reach = abs(limit - arc)
    excess = penetration - level
    # Where the gap is nearly flat the parabola's width is no guide: start within 1 cm or so.
    distance = min(math.sqrt(2.0 * excess / max(bend, 0.5)), reach)
    inner = 0.0
    outer = reach
    for _ in range(20):
        depth, sine, _, _ = probe(
            table, side, arc + direction * distance, foot + direction * distance,
            cy, cz, lx, ly, lz,
        )  # fmt: skip
        rest = depth - level
        slope = direction * sine
        step = rest / slope if slope > 1.0e-9 else math.copysign(reach, rest)
        if rest > 0.0:
            if distance >= reach:
                break
            inner = distance
        else:
            outer = distance
        if abs(rest) < 3.0e-3 * excess and inner <= distance + step <= outer:
            # The error left is of second order in this step, and of fourth in the integrals.
            distance += step
            break
        trial = min(distance + step, 2.5 * distance)
        if trial <= inner or trial > outer:
            trial = outer if outer >= reach and rest > 0.0 else 0.5 * (inner + outer)
        if outer - inner < 1.0e-9:
            break
        distance = trial
    return arc + direction * distance


@compiled
def zone_moments(table, side, arc, foot, penetration, bend, left, right, level, cy, cz, lx, ly, lz):
    """Integrals over the zone around `arc` where penetration exceeds `level`.

    Returns (I, int arc, int foot, int normal_y, int normal_z), each weighted with penetration
    minus level [m]; the normal is the mean of wheel's and rail's, from rail into wheel.
    """
    total = 0.0
    total_arc = 0.0
    total_foot = 0.0
    total_ny = 0.0
    total_nz = 0.0
    for half in range(2):
        limit = left if half == 0 else right
        end = zone_end(table, side, arc, foot, penetration, bend, limit, level, cy, cz, lx, ly, lz)
        length = abs(end - arc)
        for k in range(5):
            place = arc + (end - arc) * GAUSS[k][0]
            py, pz, ny, nz, _ = wheel_section(table, side, place, cy, cz, lx, ly, lz)
            at, ty, tz, _, height = rail_foot(table, side, py, pz, foot + place - arc)
            weight = GAUSS[k][1] * length * max(-height - level, 0.0)
            total += weight
            total_arc += weight * place
            total_foot += weight * at
            total_ny += weight * 0.5 * (-tz - ny)
            total_nz += weight * 0.5 * (ty - nz)
    return total, total_arc, total_foot, total_ny, total_nz


__all__ = [
    "LOBE_WIDTH",
    "MOST_LOBES",
    "VIRTUAL",
    "find_lobes",
    "zone_moments",
]
