"""Normal contact as an energy in closed form: Hertz's of the parabola with the gap's moments.

p(s) is the penetration on the rail's normals (gap.py), sampled on lines fixed to the rail, and
q = p - z above a level z, 0 but beside a valley. Of a parabola q = H - B s^2 the moments are
    K_m = int q_+^m ds = c_m H^(m + 1/2)/sqrt(B),   c_m = sqrt(pi) m!/Gamma(m + 3/2),
so K_3 and K_5 say H and B, whatever the gap: H^2 = c_3 K_5/(c_5 K_3), B = c_3^2 H^7/K_3^2. Hertz's
patch of that parabola (hertz.py; A: half curvature along rolling at the place c_3) stores
    U = 2/5 N(A, B, delta) delta exp(KURTOSIS D_+ + SKEWNESS S),   delta = H + z,               (1)
    D = ln(K_4/sqrt(K_3 K_5)) - that of a parabola,  S = (c_5 - c_3)^2 B/H,
with the places c_m = int s q_+^m ds/K_m. D and S vanish for a parabola; D_+ is D where it is
greater than 0, rounded off over SHARPEST. A gap with two peaks or a shoulder, which no ellipse
fits, carries more than (1) without them says. KURTOSIS and SKEWNESS are what half-space solutions
(tests/half_space.py) of S1002, AAR and two worn wheels on their rails have. q_+^3 is smooth where q
begins, so sums over the lines are the integrals, and U a smooth function of the p on the lines
without a search or an iteration in it. Its gradient by them is a load on each line: the wheel is
pushed along its own normal there (gap.py), and forces are minus the gradient of U exactly.

Two lobes of p with a valley v between them are one such gap (U_0) or two (U_1, U_2), each on its
side of the valley and above the level z = v, if v > 0. Those sink in each other's field,
1/(pi E* r) for a unit of load (Boussinesq): with U_i(delta - u) = U_i (1 - u/delta)^2.5,
    U_12 = max over N of sum_i [N_i delta_i - W_i(N_i)] - N_1 N_2/(pi E* r).                    (2)
While the valley deepens U goes over from U_0 to U_12:
    U = s U_12 + (1 - s) U_0,   s from 0 to 1 with x = 1 - v/d from MERGED to APART,            (3)
d a smooth least of the depths of both lobes. More lobes: every valley splits or does not, with the
product of the s or 1 - s.

Frame: track frame, left side; lengths in metres. Records GROUP, VALLEY, LOBE, WORK: layout.py.
"""

import math

import numpy as np

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.gap import gap_on_normal, push_on_lines
from exudyn_wheelset.contact.gap_spline import sample_ranges
from exudyn_wheelset.contact.hertz import hertz_from_load, shape_and_slopes
from exudyn_wheelset.contact.layout import GAP_DEPTH
from exudyn_wheelset.contact.load_patches import add_line, fill_patch, roll_together

KURTOSIS, SHARPEST, SKEWNESS = 6.0, 2.7e-3, 2.0
C3, C4, C5 = 32.0 / 35.0, 256.0 / 315.0, 512.0 / 693.0
OF_PARABOLA = math.log(C4 / math.sqrt(C3 * C5))
MERGED, APART = 0.09, 0.26
# p is sampled to where the scan has it fallen to this part of the depth.
BEYOND = -0.2
# Half the range of v over which the level beside a valley begins to rise [m].
RISE = 2.0e-6
# Lobes sink in each other's fields by a factor of some 0.1 a sweep.
_SWEEPS = 30


@compiled
def _valleys(table, side, lobes, found, axle, work):
    """Fill `work.valleys` between neighbouring lobes, and the lobes' separations."""
    for k in range(found - 1):
        one = lobes[k]
        two = lobes[k + 1]
        valley = work.valleys[k]
        place = one.right - 0.5 * (one.arc - one.foot + two.arc - two.foot)
        arc = one.right
        depth = 0.0
        for _ in range(5):
            depth, first, second, arc = gap_on_normal(table, side, place, arc, axle)
            if depth < -10.0 * RISE or not second > 0.0:
                break
            step = min(max(-first / second, -1.0e-3), 1.0e-3)
            place = min(max(place + step, one.foot), two.foot)
            arc += step
        depth, _, _, arc = gap_on_normal(table, side, place, arc, axle)
        least = (one.penetration**-8.0 + two.penetration**-8.0) ** -0.125
        valley.place = place
        valley.arc = arc
        valley.depth = depth
        x = (1.0 - depth / least - MERGED) / (APART - MERGED)
        x = min(max(x, 0.0), 1.0)
        square = x * x
        valley.separation = square * x * (10.0 - 15.0 * x + 6.0 * square)
        slope = 30.0 * square * (1.0 - x) * (1.0 - x) / (APART - MERGED)
        valley.by_valley = -slope / least
        slope *= depth / (least * least)
        valley.by_one = slope * (least / one.penetration) ** 9.0
        valley.by_two = slope * (least / two.penetration) ** 9.0
        valley.gain = 0.0
        valley.weight = 0.0
        rise = min(max(depth + RISE, 0.0), 2.0 * RISE)
        valley.level = 0.25 * rise * rise / RISE + max(depth - RISE, 0.0)
        valley.level_slope = 0.5 * rise / RISE
        one.separation = valley.separation


@compiled(fastmath=AS_REAL_NUMBERS, noalias=True)
def _sums(depths, level):
    """Sums of q^3, q^4, q^5 and of k q^3, k q^5 over lines k."""
    k3 = k4 = k5 = m3 = m5 = 0.0
    for k in range(len(depths)):
        q = max(depths[k] - level, 0.0)
        cube = q * q * q
        five = cube * q * q
        k3 += cube
        k4 += cube * q
        k5 += five
        m3 += k * cube
        m5 += k * five
    return k3, k4, k5, m3, m5


@compiled(fastmath=AS_REAL_NUMBERS, noalias=True)
def _add(depths, level, c2, c3, c4, d2, d4, weights):
    """Add q^2 (c2 + d2 k) + c3 q^3 + q^4 (c4 + d4 k) to the weights of lines k; return the sum."""
    total = 0.0
    for k in range(len(depths)):
        q = max(depths[k] - level, 0.0)
        square = q * q
        g = square * (c2 + d2 * k + q * (c3 + q * (c4 + d4 * k)))
        weights[k] += g
        total += g
    return total


@compiled
def _fill_group(table, side, lobes, found, first, last, work, modulus, group):
    """Fill the GROUP of the lobes from first to last: moments and energy of equation (1)."""
    h = side.line_spacing
    per = 1.0 / h
    ranges = work.ranges
    group.first = first
    group.last = last
    group.begin = ranges[lobes[first].range].first
    group.end = ranges[lobes[last].range].last + 1
    group.level = group.by_left = group.by_right = 0.0
    if first > 0:
        valley = work.valleys[first - 1]
        border = int((valley.place - side.line_start) * per) + 1
        group.begin = max(group.begin, border)
        group.level = valley.level
        group.by_left = valley.level_slope
    if last + 1 < found:
        valley = work.valleys[last]
        border = int((valley.place - side.line_start) * per) + 1
        group.end = min(group.end, border)
        if valley.level > group.level:
            group.level = valley.level
            group.by_left = 0.0
            group.by_right = valley.level_slope
    group.energy = group.sunk = 0.0
    if group.end - group.begin < 1:
        return
    depths = work.gap[GAP_DEPTH, group.begin : group.end]
    k3, k4, k5, m3, m5 = _sums(depths, group.level)
    if not k3 > 1.0e-24:
        return
    group.k3, group.k4, group.k5 = k3 * h, k4 * h, k5 * h
    group.c3, group.c5 = m3 / k3, m5 / k5
    height = math.sqrt(C3 / C5 * k5 / k3)
    cube = height * height * height
    group.height = height
    group.lateral = C3 * C3 * cube * cube * height / (group.k3 * group.k3)
    group.depth = height + group.level
    group.place = side.line_start + h * (group.begin + group.c3)
    _, r1, r2, rz, q1, _ = curve_point(table, side.rail, group.place)
    upright = max(r1, 0.05)
    radius = side.radius - rz
    group.along = 0.5 * upright / radius
    group.relative = (r2 / r1 if r1 > 0.05 else 0.0) + q1 / radius
    t = math.log(group.lateral / group.along)
    _, _, gamma, _, _, gamma1, _, _ = shape_and_slopes(t)
    ratio = math.exp(t)
    group.slope = -0.5 * ratio / (1.0 + ratio) - 1.5 * gamma1
    square = group.depth * math.exp(-gamma) / (group.along + group.lateral)
    force = 4.0 / 3.0 * modulus * (group.along + group.lateral) * square * math.sqrt(square)
    skew = h * (group.c5 - group.c3)
    group.skew = skew * group.lateral / height
    kurtosis = math.log(k4 / math.sqrt(k3 * k5)) - OF_PARABOLA
    root = math.sqrt(kurtosis * kurtosis + SHARPEST * SHARPEST)
    group.flatter = 0.5 * KURTOSIS * (1.0 + kurtosis / root)
    more = 0.5 * KURTOSIS * (kurtosis + root - SHARPEST)
    more += SKEWNESS * skew * group.skew
    group.energy = 0.4 * force * group.depth * math.exp(more)


@compiled
def _sink(groups, count, modulus):
    """Bring the groups to where they stand in each other's fields, equation (2); the energy."""
    compliance = 1.0 / (math.pi * modulus)
    for k in range(count):
        group = groups[k]
        group.sunk = 0.0
        group.load = 2.5 * group.energy / group.depth if group.energy > 0.0 else 0.0
    if count > 1:
        for _ in range(_SWEEPS):
            change = 0.0
            for k in range(count):
                group = groups[k]
                if group.energy <= 0.0:
                    continue
                sunk = 0.0
                for j in range(count):
                    if j != k and groups[j].energy > 0.0:
                        sunk += groups[j].load / abs(groups[j].place - group.place)
                sunk = min(compliance * sunk, group.depth)
                change = max(change, abs(sunk - group.sunk))
                group.sunk = sunk
                left = 1.0 - sunk / group.depth
                group.load = 2.5 * group.energy / group.depth * left * math.sqrt(left)
            if change < 1.0e-14:
                break
    total = 0.0
    for k in range(count):
        group = groups[k]
        group.by_place = 0.0
        if group.energy <= 0.0:
            continue
        left = 1.0 - group.sunk / group.depth
        total += group.energy * left * left * math.sqrt(left) + 0.5 * group.load * group.sunk
        for j in range(count):
            if j != k and groups[j].energy > 0.0:
                apart = group.place - groups[j].place
                group.by_place += (
                    compliance * group.load * groups[j].load / (apart * abs(apart))
                )  # fmt: skip
    return total


@compiled
def _push(side, group, weight, work):
    """Add the loads on lines of a group, the derivatives of its part of the energy."""
    if group.energy <= 0.0:
        return
    h = side.line_spacing
    left = 1.0 - group.sunk / group.depth
    energy = weight * group.energy * left * left * math.sqrt(left)
    by_depth = weight * group.load * group.sunk / group.depth
    skewed = SKEWNESS * group.skew
    square = skewed * h * (group.c5 - group.c3)
    half = 1.25 * group.height / group.depth
    by5 = energy * (half + 3.5 * group.slope - 0.5 * group.flatter + 3.0 * square)
    by3 = energy * (-half - 5.5 * group.slope - 0.5 * group.flatter - 5.0 * square)
    by5 += 0.5 * group.height * by_depth
    by3 -= 0.5 * group.height * by_depth
    aside5 = 2.0 * energy * skewed
    aside3 = weight * group.by_place - energy * (0.5 + group.slope) * group.relative - aside5
    d2 = 3.0 * h * h * aside3 / group.k3
    d4 = 5.0 * h * h * aside5 / group.k5
    total = _add(
        work.gap[GAP_DEPTH, group.begin : group.end], group.level,
        3.0 * h * by3 / group.k3 - d2 * group.c3, 4.0 * h * group.flatter * energy / group.k4,
        5.0 * h * by5 / group.k5 - d4 * group.c5, d2, d4,
        work.parts[2, group.begin : group.end],
    )  # fmt: skip
    by_level = 2.5 * energy / group.depth + by_depth - total
    if group.by_left > 0.0:
        work.valleys[group.first - 1].weight += by_level * group.by_left
    if group.by_right > 0.0:
        work.valleys[group.last].weight += by_level * group.by_right


@compiled
def _energy(table, side, lobes, found, modulus, work):
    """Energy of equation (3); its gradient into `work.parts[2]` and the valleys."""
    for k in range(found):
        lines = work.ranges[lobes[k].range]
        work.parts[2, lines.first : lines.last + 1] = 0.0
    groups = work.groups
    energy = 0.0
    for merged in range(1 << (found - 1)):
        weight = 1.0
        for k in range(found - 1):
            separation = work.valleys[k].separation
            weight *= 1.0 - separation if merged >> k & 1 else separation
        if weight == 0.0:
            continue
        count = 0
        first = 0
        for k in range(found):
            if k + 1 == found or not merged >> k & 1:
                _fill_group(table, side, lobes, found, first, k, work, modulus, groups[count])
                count += 1
                first = k + 1
        stored = _sink(groups, count, modulus)
        energy += weight * stored
        for k in range(count):
            _push(side, groups[k], weight, work)
        for k in range(found - 1):
            valley = work.valleys[k]
            if 0.0 < valley.separation < 1.0:
                if merged >> k & 1:
                    valley.gain -= weight / (1.0 - valley.separation) * stored
                else:
                    valley.gain += weight / valley.separation * stored
    return energy


@compiled
def _note_which_press(side, lobes, found, work):
    """Set `sunk` of lobes that the others' fields leave nothing to carry to 1, of others to 0."""
    per = 1.0 / side.line_spacing
    begin = work.ranges[lobes[0].range].first
    first = 0
    for k in range(found):
        lobes[k].sunk = 0.0
        if k + 1 < found and lobes[k].separation == 0.0:
            continue
        end = work.ranges[lobes[k].range].last + 1
        if k + 1 < found:
            end = min(end, int((work.valleys[k].place - side.line_start) * per) + 1)
        begin = max(begin, work.ranges[lobes[first].range].first)
        if not (end > begin and np.sum(work.parts[2, begin:end]) > 0.0):
            for j in range(first, k + 1):
                lobes[j].sunk = 1.0
        begin = end
        first = k + 1


@compiled
def _push_by_valley(table, side, lobes, k, left, right, axle, work, wrench):
    """Add to a wrench the loads of valley k: a patch's on its `left`, on its `right`, or both.

    What belongs to a lobe that does not press goes to the other.
    """
    valley = work.valleys[k]
    one, two = lobes[k], lobes[k + 1]
    part = 0.0
    if left:
        part += 0.5 if two.sunk == 0.0 else 1.0
    if right:
        part += 0.5 if one.sunk == 0.0 else 1.0
    if left and right:
        part = 1.0
    on_valley = part * (valley.weight + valley.gain * valley.by_valley)
    if on_valley != 0.0:
        add_line(table, side, valley.place, valley.arc, axle, on_valley, wrench)
    if valley.gain == 0.0:
        return
    if left or one.sunk > 0.0:
        load = valley.gain * valley.by_one
        add_line(table, side, one.foot, one.arc, axle, load, wrench)
    if right or two.sunk > 0.0:
        load = valley.gain * valley.by_two
        add_line(table, side, two.foot, two.arc, axle, load, wrench)


@compiled
def energy_patches(table, side, found, axle, material, work, patches):
    """Fill the patches of one side from its lobes; return their number."""
    if found == 0:
        return 0
    modulus = material.shear_modulus / (1.0 - material.poisson)
    lobes = work.lobes
    sample_ranges(table, side, lobes, found, BEYOND, axle, work)
    _valleys(table, side, lobes, found, axle, work)
    energy = _energy(table, side, lobes, found, modulus, work)
    _note_which_press(side, lobes, found, work)
    whole = work.whole
    wrench = work.wrenches[0]
    kept = 0
    total = 0.0
    last = -1
    while last + 1 < found:
        first = last + 1
        last = first
        while last + 1 < found and lobes[last].separation == 0.0:
            last += 1
        if lobes[first].sunk > 0.0:
            continue
        group = work.groups[0]
        if found > 1:
            _fill_group(table, side, lobes, found, first, last, work, modulus, group)
        begin = group.begin
        end = group.end
        weights = work.parts[2, begin:end]
        push_on_lines(table, side, begin, weights, axle, work.gap, wrench)
        for k in range(max(first - 1, 0), min(last + 1, found - 1)):
            _push_by_valley(table, side, lobes, k, k >= first, k < last, axle, work, wrench)
        force = math.hypot(wrench[0], wrench[1])
        load = np.sum(weights)
        mean = 0.0
        for k in range(end - begin):
            mean += k * weights[k]
        mean = min(max(mean / load, 0.0), end - begin - 1.0)
        place = side.line_start + side.line_spacing * (begin + mean)
        a, b, _, peak = hertz_from_load(
            group.along, group.lateral, force, material.shear_modulus, material.poisson
        )
        foot = lobes[first].foot
        mean = place - foot
        whole.shaping = whole.force = force
        whole.place = force * mean
        whole.second = force * (mean * mean + 0.2 * b * b)
        whole.along = force * a * a
        whole.depth = force * group.depth
        whole.energy = force
        whole.weight = 1.0
        whole.peak = peak
        whole.low = lobes[first].low
        whole.high = lobes[last].high
        share = work.shares[kept]
        share.lobe = first
        share.last_lobe = last
        fill_patch(table, side, whole, foot, wrench, axle, work.gap, patches[kept], share)
        total += force
        kept += 1
    for k in range(kept):
        patches[k].energy *= energy / total
        roll_together(table, side, axle, lobes, work.shares, k, kept, patches)
    return kept
