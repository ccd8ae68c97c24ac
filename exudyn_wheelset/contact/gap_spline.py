"""The penetration p(s) of a wheel as a cubic spline on a fixed grid of the rail.

Sampled at places s_j = j h that belong to the rail, whatever the pose, p is taken as the spline

    p(s) = sum c_j B((s - s_j)/h),   c_j = (8 p_j - p_(j-1) - p_(j+1))/6,                    (1)

B the cubic B-spline: a quasi-interpolant, exact for cubics (de Boor, A Practical Guide to Splines,
chapter XII), with a continuous curvature, linear in the p_j and local. So the energy of ritz.py
is a function of the p_j alone, and forces on the fixed lines of the grid are its exact gradient.

Means over the load 3/4 (1 - x^2) of an ellipse are closed: with P_1, P_2, P_3 the primitives of p,
S and D their sums and differences at the ends c + b and c - b, by parts

    P(c, b) = 3/4 int (1 - x^2) p(c + b x) dx = 3/2 (S_2/b^2 - D_3/b^3),                     (2)
    P_c = 3/2 (S_1/b^2 - D_2/b^3),                   P_cc = 3/2 (S_0/b^2 - D_1/b^3),
    b P_b = 3/2 (D_1/b - 3 S_2/b^2 + 3 D_3/b^3),     b P_bc = 3/2 (D_0/b - 3 S_1/b^2 + 3 D_2/b^3),
    b^2 P_bb = 3/2 (S_0 - 5 D_1/b + 12 S_2/b^2 - 12 D_3/b^3).

What a load puts on c_j is (2) of B: 3 h/(4 b) (1 - x_j^2 - h^2/(3 b^2)) away from the ends.

Frame: track frame, left side; places in units of h where they are called `at`. Records RANGE, LOAD,
GAP_... and LINE_...: layout.py.
"""

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.gap import sample_gap
from exudyn_wheelset.contact.layout import (
    GAP_COEFFICIENT,
    GAP_DEPTH,
    GAP_FIRST,
    GAP_SECOND,
    GAP_THIRD,
    NODE_ARC,
    block_row,
)

# Nodes beyond the end of a zone on either side: three make the last cell.
_MARGIN = 3
# The zone of a lobe is where p is above this part of its depth. Loads end at about half of it.
LEVEL = 0.25
_CHUNK = 16


@compiled
def _reach(depths, arcs, first, final, lobe, low, direction):
    """Length to where the scanned penetration falls to `low`, or to where the scan ends [m]."""
    k = lobe.node
    last = final if direction > 0 else first
    while k != last and depths[k - first] > low:
        k += direction
    length = direction * (arcs[k] - lobe.arc)
    inner, outer = depths[k - direction - first], depths[k - first]
    if k != lobe.node and outer < low < inner:
        length -= direction * (arcs[k] - arcs[k - direction]) * (low - outer) / (inner - outer)
    return max(length, 0.0)


@compiled
def sample_ranges(table, side, lobes, count, low, axle, work):
    """Sample p around all lobes to where it has fallen to `low` of their depth.

    Fills `work.ranges` of nodes; lobes get the number of theirs. Returns how many ranges.
    """
    per = 1.0 / side.line_spacing
    start = side.line_start
    final = side.lines.count - 1
    arcs = block_row(table, side.nodes, NODE_ARC)
    ranges = work.ranges
    made = 0
    for k in range(count):
        lobe = lobes[k]
        level = low * lobe.penetration
        at = (lobe.foot - start) * per
        # The chord of two nodes of the scan lies below the lobe: it is a little short. Beside the
        # rail the scan knows nothing, so that a second try goes further by itself.
        ends = 0.5 + _MARGIN - 20.0 * min(low, 0.0)
        reach = per * _reach(
            work.depths, arcs, work.first_node, work.final_node, lobe, level, -1
        )  # fmt: skip
        left = min(max(int(at - reach - ends), 0), final - 8)
        reach = per * _reach(
            work.depths, arcs, work.first_node, work.final_node, lobe, level, 1
        )  # fmt: skip
        right = max(min(int(at + reach + ends) + 1, final), left + 8)
        joined = made > 0 and left <= ranges[made - 1].last + 1
        if joined:
            made -= 1
            left = ranges[made].last + 1
        else:
            ranges[made].first = left
        if right >= left:
            ranges[made].last = right
            sample_gap(table, side, lobe, left, right + 1, axle, work.gap)
        lobe.range = made
        made += 1
    for k in range(count):
        lobe = lobes[k]
        lobe.low = ranges[lobe.range].first + 2
        lobe.high = ranges[lobe.range].last - 3
    return made


@compiled
def sample_lobes(table, side, lobes, count, low, axle, work):
    """As `sample_ranges`, with p as a spline; lobes get the ends of their zones."""
    made = sample_ranges(table, side, lobes, count, low, axle, work)
    per = 1.0 / side.line_spacing
    start = side.line_start
    depths = work.gap[GAP_DEPTH]
    ranges = work.ranges
    for k in range(made):
        first = ranges[k].first
        end = ranges[k].last + 1
        _primitives(
            depths[first:end], work.gap[GAP_COEFFICIENT, first:end], work.gap[GAP_FIRST, first:end],
            work.gap[GAP_SECOND, first:end], work.gap[GAP_THIRD, first:end],
        )  # fmt: skip
    for k in range(count):
        lobe = lobes[k]
        lobe.begin, lobe.end = _zone(
            depths, lobe, (lobe.foot - start) * per, LEVEL * lobe.penetration
        )
        lead = lobe.arc - lobe.foot
        if k > 0:
            lobe.begin = max(lobe.begin, (lobe.left - lead - start) * per)
        if k + 1 < count:
            lobe.end = min(lobe.end, (lobe.right - lead - start) * per)


@compiled
def _zone(depths, lobe, at, level):
    """Places (at) on either side of a lobe where p falls to `level`, or as far as there is p."""
    middle = min(max(int(at + 0.5), lobe.low), lobe.high)
    k = middle
    while k > lobe.low and depths[k] > level:
        k -= 1
    begin = float(k)
    if depths[k] <= level < depths[k + 1]:
        begin += (level - depths[k]) / (depths[k + 1] - depths[k])
    k = middle
    while k < lobe.high and depths[k] > level:
        k += 1
    end = float(k)
    if depths[k] <= level < depths[k - 1]:
        end -= (level - depths[k]) / (depths[k - 1] - depths[k])
    return begin, end


@compiled(fastmath=AS_REAL_NUMBERS, noalias=True)
def _primitives(depths, coefficients, first, second, third):
    """Coefficients (1) and the primitives at the nodes of a range, in units of h."""
    final = len(depths) - 1
    for k in range(1, final):
        coefficients[k] = (8.0 * depths[k] - depths[k - 1] - depths[k + 1]) / 6.0
    for k in range(2, final - 2):
        a0, a1, a2, a3 = _cell(coefficients, k)
        first[k] = a0 + 0.5 * a1 + a2 / 3.0 + 0.25 * a3
        second[k] = 0.5 * a0 + a1 / 6.0 + a2 / 12.0 + a3 / 20.0
        third[k] = a0 / 6.0 + a1 / 24.0 + a2 / 60.0 + a3 / 120.0
    one = two = three = 0.0
    for k in range(2, final - 2):
        more, further, furthest = first[k], second[k], third[k]
        first[k] = one
        second[k] = two
        third[k] = three
        three += two + 0.5 * one + furthest
        two += one + further
        one += more


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _cell(coefficients, k):
    """Polynomial from node k on to the next."""
    c0 = coefficients[k - 1]
    c1 = coefficients[k]
    c2 = coefficients[k + 1]
    c3 = coefficients[k + 2]
    return (
        (c0 + 4.0 * c1 + c2) / 6.0,
        0.5 * (c2 - c0),
        0.5 * (c0 + c2) - c1,
        (c3 - c0) / 6.0 + 0.5 * (c1 - c2),
    )


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _cell_at(load, at):
    """Number of the cell in which a place is, of the range's first or last one beyond its ends."""
    if not at > load.low:
        return load.low
    return int(at) if at < load.high else load.high


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def spline_depth(gap, load, at):
    """p [m] at a place."""
    k = _cell_at(load, at)
    a0, a1, a2, a3 = _cell(gap[GAP_COEFFICIENT], k)
    u = at - k
    return a0 + u * (a1 + u * (a2 + u * a3))


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def primitives_at(gap, load, at):
    """p and its three primitives in units of h, at a place near the load's (or lobe's) range."""
    k = _cell_at(load, at)
    a0, a1, a2, a3 = _cell(gap[GAP_COEFFICIENT], k)
    u = at - k
    one = gap[GAP_FIRST, k]
    two = gap[GAP_SECOND, k]
    return (
        a0 + u * (a1 + u * (a2 + u * a3)),
        one + u * (a0 + u * (a1 / 2.0 + u * (a2 / 3.0 + u * a3 / 4.0))),
        two + u * (one + u * (a0 / 2.0 + u * (a1 / 6.0 + u * (a2 / 12.0 + u * a3 / 20.0)))),
        gap[GAP_THIRD, k]
        + u * (two + u * (
            one / 2.0 + u * (a0 / 6.0 + u * (a1 / 24.0 + u * (a2 / 60.0 + u * a3 / 120.0)))
        )),
    )  # fmt: skip


@compiled(fastmath=AS_REAL_NUMBERS)
def average(gap, load, start, per):
    """Fill means of p over the load, equation (2), and their derivatives by place and ln b."""
    b = load.b * per
    c = (load.place - start) * per
    p, p1, p2, p3 = primitives_at(gap, load, c - b)
    q, q1, q2, q3 = primitives_at(gap, load, c + b)
    v = 1.0 / b
    d0 = q - p
    s0 = q + p
    d1 = (q1 - p1) * v
    s1 = (q1 + p1) * v
    d2 = (q2 - p2) * v * v
    s2 = (q2 + p2) * v * v
    d3 = (q3 - p3) * v * v * v
    slope = 1.5 * v * per
    load.average = 1.5 * (s2 - d3)
    load.slope = slope * (s1 - d2)
    load.bend = slope * per * v * (s0 - d1)
    load.spread = 1.5 * (d1 - 3.0 * (s2 - d3))
    load.slope_spread = slope * (d0 - 3.0 * (s1 - d2))
    load.spread_spread = 1.5 * (s0 - 5.0 * d1 + 12.0 * (s2 - d3))


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _second_third(u):
    """Second and third primitive of the cubic B-spline at u."""
    if u >= 2.0:
        return u, 0.5 * u * u + 1.0 / 6.0
    x = u + 2.0
    five = x * x * x * x * x
    second = five
    third = five * x
    if u > -1.0:
        x = u + 1.0
        five = 4.0 * x * x * x * x * x
        second -= five
        third -= five * x
    if u > 0.0:
        five = 6.0 * u * u * u * u * u
        second += five
        third += five * u
    if u > 1.0:
        x = u - 1.0
        five = 4.0 * x * x * x * x * x
        second -= five
        third -= five * x
    return second / 120.0, third / 720.0


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _end_weight(j, low, high, v):
    """Weight of the coefficient j near an end of the load."""
    if high - j <= -2.0 or low - j >= 2.0:
        return 0.0
    end, ends = _second_third(high - j)
    if low - j > -2.0:
        start, starts = _second_third(low - j)
        end += start
        ends -= starts
    return 1.5 * v * v * (end - ends * v)


@compiled(fastmath=AS_REAL_NUMBERS, noalias=True)
def _weights(c, b, first, weights, parts):
    """Fill the parts of a load on the lines from `first` on; weights: room for those of c_j."""
    count = len(parts)
    v = 1.0 / b
    low = c - b
    high = c + b
    most = 1.0 - v * v / 3.0
    for k in range(count + 2):
        x = (k + first - 1 - c) * v
        weights[k] = 0.75 * v * (most - x * x)
    near = min(6, count + 2)
    for k in range(near):
        weights[k] = _end_weight(k + first - 1.0, low, high, v)
    for k in range(max(count - 4, near), count + 2):
        weights[k] = _end_weight(k + first - 1.0, low, high, v)
    for k in range(count):
        parts[k] = (8.0 * weights[k + 1] - weights[k] - weights[k + 2]) / 6.0


@compiled
def line_weights(load, start, per, work):
    """Fill `work.parts` with a load's parts on the lines of the grid, of a sum of 1.

    Returns (first line, number of lines). Of a load that reaches beyond where p is known, which is
    none that a rail can carry, the part inside.
    """
    b = load.b * per
    c = (load.place - start) * per
    low, high = load.low, load.high + 1.0
    if not (c - b >= low and c + b <= high):
        begin = c - b if low < c - b < high - 1.0 else low
        end = c + b if begin + 1.0 < c + b < high else high
        c = 0.5 * (begin + end)
        b = 0.5 * (end - begin)
    first = int(c - b) - 2
    count = int(c + b) + 4 - first
    _weights(c, b, first, work.parts[1], work.parts[0, :count])
    return first, count
