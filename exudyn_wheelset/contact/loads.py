"""First guesses of the semi-ellipsoids that carry a wheel: of a lobe, and of a second one in it.

Equation (1) and why: ritz.py. They only have to be near its solution.

Frame: track frame, left side; lengths in metres. Records LOAD, LOBE, WORK: layout.py.
"""

import math

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.ellipsoids import field, fill
from exudyn_wheelset.contact.gap_spline import LEVEL, primitives_at, spline_depth
from exudyn_wheelset.contact.ritz import look_along

# A parabola is so much wider at zero than at the level where a lobe's zone ends.
TO_ZERO = 1.0 / math.sqrt(1.0 - LEVEL)
# A lobe that a first estimate puts this far below the others' field is not tried.
SURELY_SUNK = 0.7
# Where p - u over the approach is greater than UPWARDS at an end, it is looked at BEYOND of the
# width further out as well.
UPWARDS, BEYOND = 0.01, 0.4
# How far into one another two loads of a lobe reach, over the mean of their widths.
OVERLAP = 0.33


@compiled
def begin_load(table, side, load, lobe, place, b, depth, modulus):
    """Guess of a load at a place of the rail, as wide as b, `depth` deep in the middle."""
    load.place = place
    load.b = b
    load.low = lobe.low
    load.high = lobe.high
    look_along(table, side, load)
    load.t = math.log(0.5 * depth / (b * b * load.along))
    fill(load, modulus)


@compiled
def ends_of(side, lobe):
    """Lengths of the lobe to either side, to where p is zero or the next one begins."""
    foot = (lobe.foot - side.line_start) / side.line_spacing
    left = side.line_spacing * TO_ZERO * (foot - lobe.begin)
    right = side.line_spacing * TO_ZERO * (lobe.end - foot)
    return max(left, 1.0e-6), max(right, 1.0e-6)


@compiled
def _begin_lobe(table, side, load, lobe, begin, end, modulus, work):
    """Guess from area and centroid of p between two places: Hertz's for such a parabola."""
    h = side.line_spacing
    depth = lobe.penetration
    lateral = 0.5 * max(lobe.curvature, 0.5)
    load.place = lobe.foot
    load.low = lobe.low
    load.high = lobe.high
    level = LEVEL * depth
    edge = max(spline_depth(work.gap, lobe, begin), spline_depth(work.gap, lobe, end))
    if edge > 1.5 * level:
        # Cut off by a valley: as wide as the lobe's narrower side says.
        foot = (lobe.foot - side.line_start) / h
        width = max(0.75 * h * min(end - foot, foot - begin), 1.0e-6)
        lateral = 0.5 * depth / (width * width)
    elif end - begin > 4.0:
        _, i0, j0, _ = primitives_at(work.gap, lobe, begin)
        _, i1, j1, _ = primitives_at(work.gap, lobe, end)
        length = end - begin
        area = i1 - i0 - level * length
        moment = j1 - j0 - i0 * length - 0.5 * level * length * length
        load.place = side.line_start + h * (end - moment / area)
        area *= h
        over = depth - level
        lateral = 16.0 / 9.0 * over * over * over / (area * area)
    look_along(table, side, load)
    load.t = math.log(lateral / load.along)
    load.b = 1.0
    fill(load, modulus)
    load.b = math.sqrt(depth / load.approach)


@compiled
def begin_lobes(table, side, lobes, found, loads, modulus, work):
    """A guess for each lobe that reaches deeper than the field of deeper ones; their number."""
    for k in range(found):
        lobe = lobes[k]
        _begin_lobe(table, side, loads[k], lobe, lobe.begin, lobe.end, modulus, work)
        loads[k].lobe = k
        loads[k].sunk = 0.0
    if found == 1:
        return 1
    for k in range(found):
        fill(loads[k], modulus)
    for k in range(found):
        lobe = lobes[k]
        for j in range(found):
            if lobes[j].penetration > lobe.penetration:
                loads[k].sunk += field(lobe.foot, loads[j], modulus)
    kept = 0
    for k in range(found):
        if lobes[k].penetration > SURELY_SUNK * loads[k].sunk:
            if kept != k:
                loads[kept] = loads[k]
            kept += 1
    return kept


@compiled
def rises(table, side, lobes, found, loads, count, modulus):
    """First lobe without a load of its own that is deeper than the field there, or -1."""
    for k in range(found):
        lobe = lobes[k]
        rest = lobe.penetration
        own = False
        for j in range(count):
            own = own or loads[j].lobe == k
            if not own:
                rest -= field(lobe.foot, loads[j], modulus)
        if not own and rest > 1.0e-9:
            left, right = ends_of(side, lobe)
            b = 0.75 * min(left, right) * math.sqrt(rest / lobe.penetration)
            b = max(b, 0.2 * side.line_spacing)
            begin_load(table, side, loads[count], lobe, lobe.foot, b, rest, modulus)
            loads[count].lobe = k
            return k
    return -1


@compiled
def misfit_of(side, loads, k, count, modulus, work):
    """p - u about the ends of load k over its approach: the greatest, a negative one for half.

    Beyond an end where it is not surely below zero as well: there a shoulder may rise.
    """
    load = loads[k]
    edge = load.approach - load.width
    per = 1.0 / side.line_spacing
    worst = 0.0
    for hand in range(2):
        outwards = (2 * hand - 1) * load.b
        place = load.place + outwards
        rest = spline_depth(work.gap, load, (place - side.line_start) * per) - edge
        for j in range(count):
            if j != k:
                rest -= field(place, loads[j], modulus)
        worst = max(worst, rest, -0.5 * rest)
        if rest > UPWARDS * load.approach:
            place += BEYOND * outwards
            rest = spline_depth(work.gap, load, (place - side.line_start) * per)
            for j in range(count):
                rest -= field(place, loads[j], modulus)
            worst = max(worst, rest)
    return worst / load.approach


@compiled
def begin_second(table, side, lobe, loads, k, count, misfit, other, modulus, work):
    """Guess of two loads in the place of load k: about the lobe's peak and beside it.

    On its longer side, or on the `other`.
    """
    left, right = ends_of(side, lobe)
    hand = 1.0 if (right > left) != other else -1.0
    near = min(left, right)
    far = right if hand > 0.0 else left
    weight = min(misfit / 0.1, 1.0)
    one = loads[k]
    b = math.exp((1.0 - weight) * math.log(one.b) + weight * math.log(0.75 * near))
    place = one.place + weight * (lobe.foot - one.place)
    depth = lobe.penetration
    zone = lobe.foot + hand * far / TO_ZERO
    second = 0.4 * b
    for _ in range(2):
        inner = place + hand * (b - OVERLAP * math.sqrt(b * second))
        second = max(0.5 * hand * (zone - inner) * min(misfit / 0.1, 1.0), 0.1 * b)
    at = inner + hand * second
    begin_load(table, side, one, lobe, place, b, depth, modulus)
    p = spline_depth(work.gap, lobe, (at - side.line_start) / side.line_spacing)
    two = loads[count]
    begin_load(table, side, two, lobe, at, second, max(0.5 * p, 0.02 * depth), modulus)
    two.lobe = one.lobe


@compiled
def deepest_alone(table, side, lobes, found, load, modulus, work):
    """Guess of one load for poses far from any that the equations are made for; its number."""
    if found == 0:
        return 0
    lobe = lobes[0]
    for k in range(1, found):
        if lobes[k].penetration > lobe.penetration:
            lobe = lobes[k]
    _begin_lobe(table, side, load, lobe, lobe.begin, lobe.end, modulus, work)
    fill(load, modulus)
    load.average = load.own
    load.sunk = 0.0
    return 1
