"""Which semi-ellipsoids carry a wheel: first guesses, a second one in a lobe, and the blend.

Equations (1) and (2) and why: energy.py. Everything here but the blend is a first guess for the
solution of (1), so it only has to be near.

Frame: track frame, left side; lengths in metres. Records LOAD, LOBE, WORK: layout.py.
"""

import math

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.ellipsoids import field, fill
from exudyn_wheelset.contact.energy import MISFIT, look_along, stationary
from exudyn_wheelset.contact.gap import gap_on_normal
from exudyn_wheelset.contact.gap_spline import LEVEL, primitives_at, sample_lobes, spline_depth
from exudyn_wheelset.contact.layout import MOST_ELLIPSES

# A parabola is so much wider at zero than at the level where a lobe's zone ends.
TO_ZERO = 1.0 / math.sqrt(1.0 - LEVEL)
# A lobe that a first estimate puts this far below the others' field is not tried.
SURELY_SUNK = 0.7
# A second load that gains less has not been found where it is.
NO_GAIN = 1.0e-5
# p is sampled to where it has fallen to this part of the depth.
NEAR = 0.0
# How far into one another two loads of a lobe reach, over the mean of their widths.
OVERLAP = 0.33
# Two lobes are one, equation (3), while the valley between them is less than MERGED_FROM of their
# depth deep, and two from MERGED_UP_TO on.
MERGED_FROM, MERGED_UP_TO = 0.03, 0.2
# s' of equation (2) over the gain: 0 up to NOTHING, from STEEP to BACK STEEPNESS, 1 from WHOLE on,
# without a step in s'' between; STEEPNESS so that s = g at WHOLE.
NOTHING, STEEP, BACK, WHOLE = 6.0e-3, 1.2e-2, 5.0e-2, 6.0e-2
STEEPNESS = (WHOLE + BACK) / (WHOLE + BACK - STEEP - NOTHING)


@compiled
def _begin(table, side, load, lobe, place, b, depth, modulus):
    """Guess of a load at a place of the rail, as wide as b, `depth` deep in the middle."""
    load.place = place
    load.b = b
    load.low = lobe.low
    load.high = lobe.high
    look_along(table, side, load)
    load.t = math.log(0.5 * depth / (b * b * load.along))
    fill(load, modulus)


@compiled
def _ends(side, lobe):
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
def _begin_lobes(table, side, lobes, found, loads, modulus, work):
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
def _rises(table, side, lobes, found, loads, count, modulus):
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
            left, right = _ends(side, lobe)
            b = 0.75 * min(left, right) * math.sqrt(rest / lobe.penetration)
            _begin(table, side, loads[count], lobe, lobe.foot, b, rest, modulus)
            loads[count].lobe = k
            return k
    return -1


@compiled
def _misfit(side, loads, k, count, modulus, work):
    """p - u at the ends of load k over its approach: the greatest, a negative one for half."""
    load = loads[k]
    edge = load.approach - load.width
    worst = 0.0
    for hand in range(2):
        place = load.place + (2 * hand - 1) * load.b
        p = spline_depth(work.gap, load, (place - side.line_start) / side.line_spacing)
        for j in range(count):
            if j != k:
                p -= field(place, loads[j], modulus)
        worst = max(worst, p - edge, 0.5 * (edge - p))
    return worst / load.approach


@compiled
def _begin_second(table, side, lobe, loads, k, count, misfit, other, modulus, work):
    """Guess of two loads in the place of load k: about the lobe's peak and beside it.

    On its longer side, or on the `other`.
    """
    left, right = _ends(side, lobe)
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
    _begin(table, side, one, lobe, place, b, depth, modulus)
    p = spline_depth(work.gap, lobe, (at - side.line_start) / side.line_spacing)
    two = loads[count]
    _begin(table, side, two, lobe, at, second, max(0.5 * p, 0.02 * depth), modulus)
    two.lobe = one.lobe


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _ramp(x):
    """From 0 to 1 without a step in the slope, and its integral from 0."""
    square = x * x
    return square * (3.0 - 2.0 * x), square * x * (1.0 - 0.5 * x)


@compiled
def blend(gain):
    """s(g) and its derivative, equation (2)."""
    if gain <= NOTHING:
        return 0.0, 0.0
    if gain < STEEP:
        rate, s = _ramp((gain - NOTHING) / (STEEP - NOTHING))
        return STEEPNESS * (STEEP - NOTHING) * s, STEEPNESS * rate
    if gain >= WHOLE:
        return gain, 1.0
    s = STEEPNESS * (gain - 0.5 * (STEEP + NOTHING))
    if gain < BACK:
        return s, STEEPNESS
    rate, less = _ramp((gain - BACK) / (WHOLE - BACK))
    return s - (STEEPNESS - 1.0) * (WHOLE - BACK) * less, STEEPNESS - (STEEPNESS - 1.0) * rate


@compiled
def _deepest_alone(table, side, lobes, found, load, modulus, work):
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


@compiled
def _second_set(table, side, lobes, work, modulus):
    """Look for one load more than in the first set, where that misfits most; into the second."""
    loads = work.loads[0]
    count = work.sets[0].count
    first = work.sets[0].energy
    work.sets[1].count = 0
    worst = MISFIT
    which = -1
    for k in range(count):
        misfit = _misfit(side, loads, k, count, modulus, work)
        if misfit > worst:
            worst = misfit
            which = k
    if which < 0 or count == MOST_ELLIPSES:
        return
    seconds = work.loads[1]
    for attempt in range(2):
        for k in range(count):
            seconds[k] = loads[k]
        lobe = lobes[loads[which].lobe]
        _begin_second(table, side, lobe, seconds, which, count, worst, attempt > 0, modulus, work)
        more, energy = stationary(table, side, seconds, count + 1, modulus, work)
        if more > count and energy > first * (1.0 + NO_GAIN):
            work.sets[1].count = more
            work.sets[1].energy = energy
            return
        if worst < 2.0 * MISFIT:
            return


@compiled
def _valley(table, side, lobes, loads, count, axle, work):
    """Least separated pair of loads of neighbouring lobes: (first of them, q, dq/dx).

    x = 1 - valley/d with d^-8 = d_1^-8 + d_2^-8, a smooth least of the lobes' depths;
    `work.merging` takes the lines on which x depends.
    """
    merging = work.merging
    pair = -1
    least = MERGED_UP_TO
    for k in range(count - 1):
        one = lobes[loads[k].lobe]
        two = lobes[loads[k + 1].lobe]
        if loads[k + 1].lobe != loads[k].lobe + 1:
            continue
        depth = (one.penetration**-8.0 + two.penetration**-8.0) ** -0.125
        place = one.right - 0.5 * (one.arc - one.foot + two.arc - two.foot)
        arc = one.right
        valley = 0.0
        for _ in range(2):
            valley, _, _, arc = gap_on_normal(table, side, place, arc, axle)
        separation = 1.0 - valley / depth
        if separation < least:
            pair = k
            least = separation
            merging[0].place = place
            merging[0].arc = arc
            merging[0].weight = -1.0 / depth
            merging[1].place = one.foot
            merging[1].arc = one.arc
            merging[1].weight = valley / (depth * depth) * (depth / one.penetration) ** 9.0
            merging[2].place = two.foot
            merging[2].arc = two.arc
            merging[2].weight = valley / (depth * depth) * (depth / two.penetration) ** 9.0
    if pair < 0:
        return -1, 1.0, 0.0
    x = (least - MERGED_FROM) / (MERGED_UP_TO - MERGED_FROM)
    if x <= 0.0:
        return pair, 0.0, 0.0
    square = x * x
    rest = 1.0 - x
    slope = 30.0 * square * rest * rest / (MERGED_UP_TO - MERGED_FROM)
    return pair, square * x * (10.0 - 15.0 * x + 6.0 * square), slope


@compiled
def _merged_set(table, side, lobes, pair, work, modulus):
    """Without the lesser one of a pair of loads of the first set; into the third."""
    loads = work.loads[0]
    merged = work.loads[2]
    one = lobes[loads[pair].lobe]
    two = lobes[loads[pair + 1].lobe]
    kept = pair if one.penetration >= two.penetration else pair + 1
    count = 0
    for k in range(work.sets[0].count):
        if k == pair or k == pair + 1:
            if k != kept:
                continue
            lobe = lobes[loads[kept].lobe]
            left = lobe.foot - one.foot + _ends(side, one)[0]
            right = two.foot - lobe.foot + _ends(side, two)[1]
            b = 0.75 * min(left, right)
            depth = lobe.penetration
            _begin(table, side, merged[count], lobe, lobe.foot, b, depth, modulus)
            merged[count].lobe = loads[kept].lobe
        else:
            merged[count] = loads[k]
        count += 1
    count, energy = stationary(table, side, merged, count, modulus, work)
    work.sets[2].count = count
    work.sets[2].energy = energy


@compiled
def _covered(side, work):
    """Whether p has been sampled wherever a load presses."""
    per = 1.0 / side.line_spacing
    for m in range(3):
        for k in range(work.sets[m].count):
            load = work.loads[m, k]
            at = (load.place - side.line_start) * per
            b = load.b * per
            if at - b < load.low or at + b > load.high + 1:
                return False
    return True


@compiled
def side_loads(table, side, found, axle, modulus, work):
    """Sets of loads of one side, with their weights; returns (energy [J], weight of grad q).

    `work.sets`: all lobes; one load more in a lobe; without the lesser of two that merge.
    """
    energy = by_q = 0.0
    for attempt in range(3):
        low = NEAR - 0.6 * attempt
        sample_lobes(table, side, work.lobes, found, low, axle, work)
        energy, by_q = _weighted_sets(table, side, found, axle, modulus, work)
        if _covered(side, work):
            return energy, by_q
    for m in range(3):
        work.sets[m].count = 0
        work.sets[m].weight = 0.0
    load = work.loads[0, 0]
    work.sets[0].count = _deepest_alone(table, side, work.lobes, found, load, modulus, work)
    work.sets[0].weight = 1.0
    return load.force * (load.own - load.work), 0.0


@compiled
def _weighted_sets(table, side, found, axle, modulus, work):
    """As `side_loads`, when p has been sampled."""
    lobes = work.lobes
    loads = work.loads[0]
    sets = work.sets
    for k in range(3):
        sets[k].count = 0
        sets[k].weight = 0.0
    count = _begin_lobes(table, side, lobes, found, loads, modulus, work)
    first = 0.0
    for _ in range(3):
        count, first = stationary(table, side, loads, count, modulus, work)
        if count in (0, found, MOST_ELLIPSES):
            break
        if _rises(table, side, lobes, found, loads, count, modulus) < 0:
            break
        count += 1
    if count == 0:
        count = _deepest_alone(table, side, lobes, found, loads[0], modulus, work)
        sets[0].count = count
        sets[0].weight = 1.0
        return loads[0].force * (loads[0].own - loads[0].work), 0.0
    sets[0].count = count
    sets[0].energy = first
    pair, apart, slope = _valley(table, side, lobes, loads, count, axle, work)
    separate = first
    sets[0].weight = apart
    if apart > 0.0:
        _second_set(table, side, lobes, work, modulus)
        if sets[1].count > 0:
            gain = sets[1].energy / first - 1.0
            s, rate = blend(gain)
            separate = first * (1.0 + s)
            sets[0].weight = apart * (1.0 + s - (1.0 + gain) * rate)
            sets[1].weight = apart * rate
    if pair < 0:
        return separate, 0.0
    _merged_set(table, side, lobes, pair, work, modulus)
    if sets[2].count == 0:
        sets[0].weight += 1.0 - apart
        return separate, 0.0
    gain = first / sets[2].energy - 1.0
    s, rate = blend(gain)
    merged = sets[2].energy * (1.0 + s)
    sets[0].weight += (1.0 - apart) * rate
    sets[2].weight = (1.0 - apart) * (1.0 + s - (1.0 + gain) * rate)
    return apart * separate + (1.0 - apart) * merged, (separate - merged) * slope
