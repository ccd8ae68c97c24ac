"""Sets of semi-ellipsoids that carry a wheel, and the blend of their energies.

Equations (1) to (3) and why: ritz.py. A set may have more than one place where Pi of (1) is
stationary; U is the greatest of those found from several guesses (loads.py).

Frame: track frame, left side; lengths in metres. Records LOAD, LOBE, SET, WORK: layout.py.
"""

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.gap import gap_on_normal
from exudyn_wheelset.contact.gap_spline import sample_lobes
from exudyn_wheelset.contact.layout import LOBES, MERGED, MOST_ELLIPSES, ONE_MORE, SETS
from exudyn_wheelset.contact.loads import (
    begin_load,
    begin_lobes,
    begin_second,
    deepest_alone,
    ends_of,
    misfit_of,
    rises,
)
from exudyn_wheelset.contact.ritz import MISFIT, stationary

# A second load that gains less has not been found where it is.
NO_GAIN = 1.0e-5
# p is sampled to where it has fallen to this part of the depth.
NEAR = 0.0
# Room between two loads, over the lesser's width, in which that is tried wider.
ROOM = 0.2
# Two lobes are one, equation (3), while the valley between them is less than MERGED_FROM of their
# depth deep, and two from MERGED_UP_TO on.
MERGED_FROM, MERGED_UP_TO = 0.03, 0.2
# s' of equation (2) over the gain: 0 up to NOTHING, from STEEP to BACK STEEPNESS, 1 from WHOLE on,
# without a step in s'' between; STEEPNESS so that s = g at WHOLE.
NOTHING, STEEP, BACK, WHOLE = 6.0e-3, 1.2e-2, 5.0e-2, 6.0e-2
STEEPNESS = (WHOLE + BACK) / (WHOLE + BACK - STEEP - NOTHING)


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
def _one_more(table, side, lobes, work, modulus):
    """Look for one load more than the lobes', where these misfit most; into the set ONE_MORE."""
    loads = work.loads[LOBES]
    count = work.sets[LOBES].count
    worst = MISFIT
    which = -1
    for k in range(count):
        misfit = misfit_of(side, loads, k, count, modulus, work)
        if misfit > worst:
            worst = misfit
            which = k
    if which < 0 or count == MOST_ELLIPSES:
        return
    seconds = work.loads[ONE_MORE]
    lobe = lobes[loads[which].lobe]
    for attempt in range(2):
        for k in range(count):
            seconds[k] = loads[k]
        begin_second(table, side, lobe, seconds, which, count, worst, attempt > 0, modulus, work)
        found, energy = stationary(table, side, seconds, count + 1, modulus, work)
        if found > count and energy > work.sets[LOBES].energy * (1.0 + NO_GAIN):
            work.sets[ONE_MORE].count = found
            work.sets[ONE_MORE].energy = energy
            return
        if worst < 2.0 * MISFIT:
            return


@compiled
def _wider(table, side, lobes, count, energy, work, modulus):
    """Try the lesser of two neighbouring loads over all the room that they leave; return U_1.

    A load that is short of the next one, in lobes that are not separate, may have a wider twin.
    """
    loads = work.loads[LOBES]
    trial = work.trial
    for k in range(count - 1):
        one, two = loads[k], loads[k + 1]
        if two.lobe != one.lobe + 1 or lobes[one.lobe].separation == 1.0:
            continue
        low, high = one.place + one.b, two.place - two.b
        lesser = k if one.b < two.b else k + 1
        if high - low < ROOM * loads[lesser].b:
            continue
        for j in range(count):
            trial[j] = loads[j]
        if lesser == k:
            low = one.place - one.b
        else:
            high = two.place + two.b
        wide = trial[lesser]
        depth = 0.5 * wide.approach
        lobe = lobes[wide.lobe]
        begin_load(table, side, wide, lobe, 0.5 * (low + high), 0.5 * (high - low), depth, modulus)
        found, more = stationary(table, side, trial, count, modulus, work)
        if found == count and more > energy:
            energy = more
            for j in range(count):
                loads[j] = trial[j]
    return energy


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
    """Without the lesser one of a pair of loads of the lobes' set; into the set MERGED."""
    loads = work.loads[LOBES]
    merged = work.loads[MERGED]
    one = lobes[loads[pair].lobe]
    two = lobes[loads[pair + 1].lobe]
    kept = pair if one.penetration >= two.penetration else pair + 1
    count = 0
    for k in range(work.sets[LOBES].count):
        if k == pair or k == pair + 1:
            if k != kept:
                continue
            lobe = lobes[loads[kept].lobe]
            left = lobe.foot - one.foot + ends_of(side, one)[0]
            right = two.foot - lobe.foot + ends_of(side, two)[1]
            b = 0.75 * min(left, right)
            depth = lobe.penetration
            begin_load(table, side, merged[count], lobe, lobe.foot, b, depth, modulus)
            merged[count].lobe = loads[kept].lobe
        else:
            merged[count] = loads[k]
        count += 1
    count, energy = stationary(table, side, merged, count, modulus, work)
    work.sets[MERGED].count = count
    work.sets[MERGED].energy = energy
    work.pair = loads[pair].lobe
    work.pair_share = loads[pair].force / (loads[pair].force + loads[pair + 1].force)


@compiled
def _covered(side, work):
    """Whether p has been sampled wherever a load presses."""
    per = 1.0 / side.line_spacing
    for m in range(SETS):
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

    `work.sets`: LOBES, one load each; ONE_MORE in one of them; MERGED, without the lesser of two
    lobes that merge.
    """
    energy = by_q = 0.0
    for attempt in range(3):
        low = NEAR - 0.6 * attempt
        sample_lobes(table, side, work.lobes, found, low, axle, work)
        energy, by_q = _weighted_sets(table, side, found, axle, modulus, work)
        if _covered(side, work):
            return energy, by_q
    work.pair = -1
    for m in range(SETS):
        work.sets[m].count = 0
        work.sets[m].weight = 0.0
    load = work.loads[LOBES, 0]
    work.sets[LOBES].count = deepest_alone(table, side, work.lobes, found, load, modulus, work)
    work.sets[LOBES].weight = 1.0
    return load.force * (load.own - load.work), 0.0


@compiled
def _weighted_sets(table, side, found, axle, modulus, work):
    """As `side_loads`, when p has been sampled."""
    lobes = work.lobes
    loads = work.loads[LOBES]
    sets = work.sets
    work.pair = -1
    for k in range(SETS):
        sets[k].count = 0
        sets[k].weight = 0.0
    count = begin_lobes(table, side, lobes, found, loads, modulus, work)
    first = 0.0
    for attempt in range(3):
        count, first = stationary(table, side, loads, count, modulus, work)
        if count in (0, found, MOST_ELLIPSES) or attempt == 2:
            break
        if rises(table, side, lobes, found, loads, count, modulus) < 0:
            break
        count += 1
    if count == 0:
        count = deepest_alone(table, side, lobes, found, loads[0], modulus, work)
        sets[LOBES].count = count
        sets[LOBES].weight = 1.0
        return loads[0].force * (loads[0].own - loads[0].work), 0.0
    sets[LOBES].count = count
    first = _wider(table, side, lobes, count, first, work, modulus)
    sets[LOBES].energy = first
    pair, apart, slope = _valley(table, side, lobes, loads, count, axle, work)
    separate = first
    sets[LOBES].weight = apart
    if apart > 0.0:
        _one_more(table, side, lobes, work, modulus)
        if sets[ONE_MORE].count > 0:
            gain = sets[ONE_MORE].energy / first - 1.0
            s, rate = blend(gain)
            separate = first * (1.0 + s)
            sets[LOBES].weight = apart * (1.0 + s - (1.0 + gain) * rate)
            sets[ONE_MORE].weight = apart * rate
    if pair < 0:
        return separate, 0.0
    _merged_set(table, side, lobes, pair, work, modulus)
    if sets[MERGED].count == 0:
        sets[LOBES].weight += 1.0 - apart
        return separate, 0.0
    gain = first / sets[MERGED].energy - 1.0
    s, rate = blend(gain)
    merged = sets[MERGED].energy * (1.0 + s)
    sets[LOBES].weight += (1.0 - apart) * rate
    sets[MERGED].weight = (1.0 - apart) * (1.0 + s - (1.0 + gain) * rate)
    return apart * separate + (1.0 - apart) * merged, (separate - merged) * slope
