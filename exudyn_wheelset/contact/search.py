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
the virtual penetration), see patches.py.

Frame: track frame, left side; lengths in metres. Records LOBE, CANDIDATE, WORK and the named tuple
`axle`: layout.py.
"""

import math

import numpy as np

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.layout import (
    GRID_ARC,
    GRID_HEIGHT,
    MOST_LOBES,
    NODE_ARC,
    NODE_FLATNESS,
    NODE_LATERAL,
    NODE_RADIUS,
    NODE_SLOPE,
    Zone,
    block_row,
)
from exudyn_wheelset.contact.locus import rail_foot, wheel_section

VIRTUAL = 0.55
SCAN_MARGIN = 1.5e-4
MERGED_PROMINENCE = 0.1

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(5)
GAUSS_PLACES = 0.5 * (1.0 + _POINTS)
GAUSS_WEIGHTS = 0.5 * _WEIGHTS


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def probe(table, side, arc, foot, axle):
    """Penetration at the wheel's arc length: (penetration, sine, 2 B, foot).

    sine: of the angle from the rail's tangent to the wheel's, the slope of -penetration along the
    wheel; 2 B [1/m]: relative curvature, its derivative.
    """
    py, pz, ny, nz, wheel_curvature = wheel_section(table, side, arc, axle)
    foot, ty, tz, rail_curvature, height = rail_foot(table, side, py, pz, foot)
    return -height, ty * ny + tz * nz, wheel_curvature - rail_curvature, foot


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _foot_below(table, side, py):
    """Arc length of the rail point below a lateral position, from the grid."""
    py = min(max(py, side.rail_low), side.rail_high)
    place = (py - side.grid_start) / side.grid_step
    cell = int(place)
    arcs = block_row(table, side.grid, GRID_ARC)
    return arcs[cell] + (place - cell) * (arcs[cell + 1] - arcs[cell])


@compiled
def grid_foot(table, side, arc, axle):
    """Arc length of the rail point below the wheel's, from the grid: the guess for `rail_foot`."""
    return _foot_below(table, side, wheel_section(table, side, arc, axle)[0])


@compiled(fastmath=AS_REAL_NUMBERS)
def level_tangent(table, side, low, high, start, sign, axle):
    """Wheel arc length in [low, high] where the tangents agree: a lobe (sign 1) or valley (-1).

    start: first guess. Returns (arc, foot, penetration, 2 B).
    """
    arc = start
    foot = 0.0
    penetration = 0.0
    bend = 1.0
    for turn in range(40):
        py, pz, ny, nz, wheel_curvature = wheel_section(table, side, arc, axle)
        if turn == 0:
            foot = _foot_below(table, side, py)
        foot, ty, tz, rail_curvature, height = rail_foot(table, side, py, pz, foot)
        penetration = -height
        sine = ty * ny + tz * nz
        bend = wheel_curvature - rail_curvature
        if sign * sine > 0.0:
            high = arc
        else:
            low = arc
        step = -sine / bend if sign * bend > 0.0 else high - low
        trial = arc + step
        if trial <= low or trial >= high:
            trial = 0.5 * (low + high)
        change = trial - arc
        foot += change
        # Penetration is stationary here: a Taylor step over the last change is exact to 1e-13 m.
        penetration -= change * (sine + 0.5 * bend * change)
        arc = trial
        if abs(change) < 1.0e-7 or high - low < 1.0e-10:
            break
    return arc, foot, penetration, bend


@compiled(fastmath=True)
def _scan(
    lateral, radii, slopes, flatness, heights, depths, axle, low, high, start, per_step
):  # fmt: skip
    """Fill depths with the penetration of each node below the rail, -1 beside the rail.

    Without branches and with slices, so that the compiler may keep the loop tight. Of the root in
    locus.py it takes two terms: exact enough to choose a node.
    """
    cy, cz, lx, ly, lz = axle
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
def _range_over_rail(table, side, axle):
    """First node over the rail and the one behind the last, by halving.

    The wheel's lateral position grows with the node.
    """
    lateral = block_row(table, side.nodes, NODE_LATERAL)
    radii = block_row(table, side.nodes, NODE_RADIUS)
    first = 0
    final = side.nodes.count
    reach = side.rail_low - axle.y - 0.003
    while final - first > 8:
        middle = (first + final) // 2
        if lateral[middle] * axle.ly + radii[middle] * axle.lz < reach:
            first = middle
        else:
            final = middle
    final = side.nodes.count
    reach = side.rail_high - axle.y + 0.003
    low_end = first
    while final - low_end > 8:
        middle = (low_end + final) // 2
        if lateral[middle] * axle.ly + radii[middle] * axle.lz > reach:
            final = middle
        else:
            low_end = middle
    return first, final


@compiled(fastmath=AS_REAL_NUMBERS)
def find_lobes(table, side, axle, work):
    """Fill `work.lobes` for one side; return their number.

    Lobes beyond MOST_LOBES (the least deep) are dropped.
    """
    first, final = _range_over_rail(table, side, axle)
    size = final - first
    depths = work.depths[:size]
    _scan(
        block_row(table, side.nodes, NODE_LATERAL)[first:final],
        block_row(table, side.nodes, NODE_RADIUS)[first:final],
        block_row(table, side.nodes, NODE_SLOPE)[first:final],
        block_row(table, side.nodes, NODE_FLATNESS)[first:final],
        block_row(table, side.grid, GRID_HEIGHT),
        depths, axle, side.rail_low, side.rail_high, side.grid_start, 1.0 / side.grid_step,
    )  # fmt: skip
    candidates = work.candidates
    found = 0
    before = -1.0
    last = -1.0
    valley = 1.0
    valley_node = -1
    for k in range(size):
        depth = depths[k]
        node = first + k
        if last > -SCAN_MARGIN and last >= before and last > depth and k > 0:
            found = _note_candidate(candidates, found, node - 1, before, last, depth, valley_node)
            valley = last
            valley_node = node - 1
        if depth < valley and found > 0:
            valley = depth
            valley_node = node
        before = last
        last = depth
    if last > -SCAN_MARGIN and last >= before:
        found = _note_candidate(candidates, found, final - 1, before, last, last, valley_node)
    work.first_node = first
    work.final_node = final - 1
    if found == 0:
        return 0
    return _refine_lobes(table, side, axle, work, found, first, final - 1)


@compiled
def _note_candidate(candidates, found, node, before, depth, after, valley):
    """Store a node of greatest depth and the depths around it; return the new number of them."""
    if found == MOST_LOBES:
        least = 0
        for k in range(1, found):
            if candidates[k].depth < candidates[least].depth:
                least = k
        if candidates[least].depth >= depth:
            return found
        for k in range(least, found - 1):
            candidates[k] = candidates[k + 1]
        found -= 1
    candidate = candidates[found]
    candidate.node = node
    candidate.depth = depth
    candidate.valley = valley
    candidate.before = before
    candidate.after = after
    return found + 1


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _vertex(left, middle, right, candidate):
    """Vertex of the parabola through the depths at three nodes."""
    fall = candidate.depth - candidate.before
    rise = candidate.after - candidate.depth
    curve = fall - rise
    shift = 0.25 * (fall + rise) / curve * (right - left) if curve > 0.0 else 0.0
    return min(max(middle + shift, left), right)


@compiled(fastmath=AS_REAL_NUMBERS)
def _refine_lobes(table, side, axle, work, found, first_node, final_node):
    """Turn the candidates into lobes that reach into the rail; return their number."""
    arcs = block_row(table, side.nodes, NODE_ARC)
    lobes = work.lobes
    kept = 0
    for k in range(found):
        candidate = work.candidates[k]
        left = arcs[max(candidate.node - 1, 0)]
        middle = arcs[candidate.node]
        right = arcs[min(candidate.node + 1, final_node)]
        arc, foot, penetration, bend = level_tangent(
            table, side, left, right, _vertex(left, middle, right, candidate), 1.0, axle
        )
        if penetration <= 0.0:
            continue
        lobe = lobes[kept]
        lobe.node = candidate.node
        lobe.arc = arc
        lobe.foot = foot
        lobe.penetration = penetration
        lobe.curvature = bend
        lobe.left = arcs[first_node]
        lobe.right = side.wheel.segments * side.wheel.spacing
        lobe.separation = 1.0
        lobe.merged_depth = 0.0
        if kept > 0:
            neighbour = lobes[kept - 1]
            before = max(arcs[max(candidate.valley - 1, 0)], neighbour.arc)
            after = min(arcs[min(candidate.valley + 1, final_node)], arc)
            border, _, depth, _ = level_tangent(
                table, side, before, after, 0.5 * (before + after), -1.0, axle
            )
            neighbour.right = border
            lobe.left = border
            smaller = min(penetration, neighbour.penetration)
            prominence = (smaller - depth) / (VIRTUAL * smaller)
            # Nearly one lobe is treated as one: the scan may see it as one as well.
            prominence = (prominence - MERGED_PROMINENCE) / (1.0 - MERGED_PROMINENCE)
            prominence = min(max(prominence, 0.0), 1.0)
            neighbour.separation = prominence * prominence * (3.0 - 2.0 * prominence)
        kept += 1
    return kept


@compiled(fastmath=AS_REAL_NUMBERS)
def zone_end(table, side, lobe, limit, level, axle):
    """Wheel arc between the lobe's maximum and `limit` where the penetration falls to `level`."""
    arc, foot = lobe.arc, lobe.foot
    direction = 1.0 if limit > arc else -1.0
    reach = abs(limit - arc)
    excess = lobe.penetration - level
    # Where the gap is nearly flat the parabola's width is no guide: start within 1 cm or so.
    distance = min(math.sqrt(2.0 * excess / max(lobe.curvature, 0.5)), reach)
    inner = 0.0
    outer = reach
    for _ in range(20):
        depth, sine, _, _ = probe(
            table, side, arc + direction * distance, foot + direction * distance, axle
        )
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


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _root_step(table, side, lobe, offset, root, axle):
    """Newton's step towards the place where the lobe has fallen by root^2, from arc + offset.

    On the square root of the fall, which is a straight line where the lobe is a parabola.
    Returns (new offset, misfit of the root over it).
    """
    depth, sine, _, _ = probe(table, side, lobe.arc + offset, lobe.foot + offset, axle)
    fallen = math.sqrt(max(lobe.penetration - depth, 1.0e-4 * root * root))
    misfit = root - fallen
    return offset + 2.0 * fallen * misfit / sine, abs(misfit) / root


@compiled(fastmath=AS_REAL_NUMBERS)
def zone_ends(table, side, lobe, level, axle):
    """Wheel arcs on either side of the lobe where the penetration falls to `level`.

    Two steps from the parabola at the lobe, both sides at once; where that is not enough, or leads
    beyond the lobe's territory, the safe search of `zone_end`.
    """
    excess = lobe.penetration - level
    root = math.sqrt(excess)
    start = root * math.sqrt(2.0 / max(lobe.curvature, 0.5))
    least, most = lobe.left - lobe.arc, lobe.right - lobe.arc
    left, right = -start, start
    one = other = 1.0
    if -start > least and start < most:
        left, _ = _root_step(table, side, lobe, left, root, axle)
        right, _ = _root_step(table, side, lobe, right, root, axle)
        if least < left < 0.0 < right < most:
            left, one = _root_step(table, side, lobe, left, root, axle)
            right, other = _root_step(table, side, lobe, right, root, axle)
    # The error left is of second order in the last misfit, and of fourth in the integrals.
    if one < 1.5e-3 and least < left < 0.0:
        left += lobe.arc
    else:
        left = zone_end(table, side, lobe, lobe.left, level, axle)
    if other < 1.5e-3 and 0.0 < right < most:
        right += lobe.arc
    else:
        right = zone_end(table, side, lobe, lobe.right, level, axle)
    return left, right


@compiled(fastmath=AS_REAL_NUMBERS)
def zone_moments(table, side, lobe, level, axle):
    """Zone of the lobe where penetration exceeds `level`: its moments."""
    arc, foot = lobe.arc, lobe.foot
    left, right = zone_ends(table, side, lobe, level, axle)
    total = 0.0
    total_arc = 0.0
    total_foot = 0.0
    total_ny = 0.0
    total_nz = 0.0
    for k in range(2 * len(GAUSS_PLACES)):
        point = k >> 1
        length = right - arc if k & 1 else left - arc
        offset = length * GAUSS_PLACES[point]
        py, pz, ny, nz, _ = wheel_section(table, side, arc + offset, axle)
        at, ty, tz, _, height = rail_foot(table, side, py, pz, foot + offset)
        weight = GAUSS_WEIGHTS[point] * abs(length) * max(-height - level, 0.0)
        total += weight
        total_arc += weight * (arc + offset)
        total_foot += weight * at
        total_ny += weight * 0.5 * (-tz - ny)
        total_nz += weight * 0.5 * (ty - nz)
    return Zone(total, total_arc, total_foot, total_ny, total_nz)
