"""Patches of one wheel by the stored energy: each lobe's wrench, ellipse and place.

The rails push the wheel along the lines of the grid that a load covers (gap.py), a wrench with
a force F in the y-z plane and a moment M about the axle's centre. It is that of |F| along n = F/|F|
at a point of its central axis and of a moment M.n about n, the patch's twist: with yaw the lines of
a throat or flange patch lie at different leads and point different ways. The point is taken where
the axis passes the wheel.

The loads of a lobe, with the weights of their sets (ritz.py), are one patch: the sum of their
forces, and for the creep law the ellipse of their second moments, b^2/5 about the mean place, and
of their mean a^2. So a second load comes and goes without a change in the number of patches. Of the
load that stands for two lobes while they merge either has the part that it carries of the two. A
set of a weight below zero takes from forces, and says nothing of shapes.

Lobes that are not separate (`separation`, search.py) roll as one patch: those of separation 0 are
one, and others, to the part that they are not separate, have the creep force of one ellipse of the
loads of both, again by second moments about the mean place, with the creepage there; each has its
share of the load of it. Two ellipses instead would each adhere and slide as if the other were not
there: against tractions solved on the half-space's own pressure they are 7 % off in the slope along
x, one ellipse 3 % (S1002 at rest, 67 kN).

Frame: track frame, left side. Records LOAD, SHARE, PATCH: layout.py.
"""

import math

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.gap import gap_on_normal, line_of_force, push_on_lines
from exudyn_wheelset.contact.gap_spline import line_weights
from exudyn_wheelset.contact.layout import GAP_ARC, MERGED, SETS
from exudyn_wheelset.contact.load_sets import side_loads
from exudyn_wheelset.contact.locus import wheel_point


@compiled
def _arc_at(side, place, low, high, gap):
    """The wheel's arc length at a place of the rail where p has been sampled."""
    at = (place - side.line_start) / side.line_spacing
    at = at if low < at < high else 0.5 * (low + high)
    k = int(at)
    arcs = gap[GAP_ARC]
    return arcs[k] + (at - k) * (arcs[k + 1] - arcs[k])


@compiled
def _add_load(side, load, weight, foot, work):
    """Add a load with its weight to `work.whole` and to the parts of the lines."""
    whole = work.whole
    force = weight * load.force
    place = load.place - foot
    first, count = line_weights(load, side.line_start, 1.0 / side.line_spacing, work)
    parts = work.parts[0]
    summed = work.parts[2]
    if whole.count == 0:
        whole.first = first
        whole.end = first
    if first < whole.first:
        summed[first : whole.first] = 0.0
        whole.first = first
    if first + count > whole.end:
        summed[whole.end : first + count] = 0.0
        whole.end = first + count
    for k in range(count):
        summed[first + k] += force * parts[k]
    whole.count += 1
    whole.force += force
    shaping = max(force, 0.0)
    whole.shaping += shaping
    whole.place += shaping * place
    whole.second += shaping * (place * place + 0.2 * load.b * load.b)
    whole.along += shaping * load.a * load.a
    whole.depth += shaping * (load.average + 0.2 * load.width)
    whole.energy += force * max(load.average - load.work - 0.5 * load.sunk, 0.0)
    whole.low = load.low
    whole.high = load.high


@compiled
def _add_lobes(side, first, last, work):
    """Fill `work.whole` with the loads of the lobes from first to last in all sets."""
    whole = work.whole
    whole.count = 0
    whole.force = whole.place = whole.second = whole.along = whole.depth = whole.energy = 0.0
    whole.weight = whole.peak = whole.shaping = 0.0
    foot = work.lobes[first].foot
    pair = work.pair
    for m in range(SETS):
        weight = work.sets[m].weight
        if weight == 0.0:
            continue
        peak = 0.0
        for j in range(work.sets[m].count):
            load = work.loads[m, j]
            part = 1.0 if first <= load.lobe <= last else 0.0
            if m == MERGED and pair >= 0 and pair <= load.lobe <= pair + 1:
                part = 0.0
                if first <= pair <= last:
                    part += work.pair_share
                if first <= pair + 1 <= last:
                    part += 1.0 - work.pair_share
            if part > 0.0:
                _add_load(side, load, part * weight, foot, work)
                peak = max(peak, 1.5 * load.force / (math.pi * load.a * load.b))
        if peak > 0.0:
            whole.weight += weight
            whole.peak += weight * peak


@compiled
def fill_patch(table, side, whole, foot, wrench, axle, gap, patch, share):
    """Fill a patch and its share from the WHOLE of its loads and their wrench."""
    fy, fz, mx, my, mz = wrench[0], wrench[1], wrench[2], wrench[3], wrench[4]
    square = fy * fy + fz * fz
    force = math.sqrt(square)
    ny = fy / force
    nz = fz / force
    mean = whole.place / whole.shaping
    arc = _arc_at(side, foot + mean, whole.low, whole.high, gap)
    x = (fy * mz - fz * my) / square
    y = fz * mx / square
    z = -fy * mx / square
    _, py, pz, _, _, _, _, _ = wheel_point(table, side, arc, axle)
    arc += nz * (axle.y + y - py) - ny * (axle.z + z - pz)
    _, py, pz, _, _, radius, wheel_y, _ = wheel_point(table, side, arc, axle)
    along = ny * (py - axle.y - y) + nz * (pz - axle.z - z)
    rail_y, _, _, _, _, _ = curve_point(table, side.rail, foot + mean)
    a = math.sqrt(whole.along / whole.shaping)
    b = math.sqrt(5.0 * max(whole.second / whole.shaping - mean * mean, 1.0e-12))
    patch.wheel_y = wheel_y
    patch.rail_y = rail_y - side.datum
    patch.angle = math.atan2(-ny, nz)
    patch.radius = radius
    patch.normal_force = force
    patch.twist = my * ny + mz * nz
    patch.a = a
    patch.b = b
    patch.penetration = whole.depth / whole.shaping
    patch.position[0] = x
    patch.position[1] = y + along * ny
    patch.position[2] = z + along * nz
    patch.normal[1] = ny
    patch.normal[2] = nz
    patch.energy = whole.energy
    patch.peak_pressure = whole.peak / whole.weight * force / whole.force
    share.own.force = force
    share.own.a = a
    share.own.b = b
    share.place = foot + mean
    share.arc = arc


@compiled
def add_line(table, side, place, arc, axle, weight, wrench):
    """Add a load on one line of force to a wrench."""
    fy, fz, mx, my, mz = line_of_force(table, side, place, arc, axle)
    wrench[0] += weight * fy
    wrench[1] += weight * fz
    wrench[2] += weight * mx
    wrench[3] += weight * my
    wrench[4] += weight * mz


@compiled
def roll_together(table, side, axle, lobes, shares, k, count, patches):
    """Fill what patch k of `count` shares with the neighbour from which it is least separated."""
    share = shares[k]
    patch = patches[k]
    share.separation = 1.0
    share.share = 0.0
    other = -1
    if k > 0 and shares[k - 1].last_lobe + 1 == share.lobe:
        other = k - 1
        share.separation = lobes[share.lobe - 1].separation
    if k + 1 < count and share.last_lobe + 1 == shares[k + 1].lobe:
        separation = lobes[share.last_lobe].separation
        if separation < share.separation:
            other = k + 1
            share.separation = separation
    if share.separation == 1.0:
        return
    one, two = share.own, shares[other].own
    part = one.force / (one.force + two.force)
    rest = 1.0 - part
    apart = share.place - shares[other].place
    square = part * one.b * one.b + rest * two.b * two.b + 5.0 * part * rest * apart * apart
    share.merged.force = one.force + two.force
    share.merged.a = math.sqrt(part * one.a * one.a + rest * two.a * two.a)
    share.merged.b = math.sqrt(square)
    share.partner = shares[other].lobe
    share.share = part
    arc = part * share.arc + rest * shares[other].arc
    _, py, pz, _, _, _, _, _ = wheel_point(table, side, arc, axle)
    place, its = patch.position, patches[other].position
    share.shift_y = py - axle.y - part * place[1] - rest * its[1]
    share.shift_z = pz - axle.z - part * place[2] - rest * its[2]
    patch.a += (1.0 - share.separation) * (share.merged.a - patch.a)
    patch.b += (1.0 - share.separation) * (part * share.merged.b - patch.b)


@compiled
def load_patches(table, side, found, axle, material, work, patches):
    """Fill the patches of one side from its lobes; return their number."""
    if found == 0:
        return 0
    modulus = material.shear_modulus / (1.0 - material.poisson)
    energy, by_q = side_loads(table, side, found, axle, modulus, work)
    lobes = work.lobes
    whole = work.whole
    wrench = work.wrenches[0]
    spare = work.wrenches[1]
    spare[:] = 0.0
    if by_q != 0.0:
        for k in range(3):
            line = work.merging[k]
            arc = line.arc
            for _ in range(2):
                _, _, _, arc = gap_on_normal(table, side, line.place, arc, axle)
            add_line(table, side, line.place, arc, axle, by_q * line.weight, spare)
    forces = 0.0
    for m in range(SETS):
        for k in range(work.sets[m].count):
            forces += work.sets[m].weight * work.loads[m, k].force
    kept = 0
    total = 0.0
    last = -1
    while last + 1 < found:
        first = last + 1
        last = first
        while last + 1 < found and lobes[last].separation == 0.0:
            last += 1
        _add_lobes(side, first, last, work)
        if whole.count == 0 or whole.force <= 0.0 or whole.weight <= 0.0:
            continue
        push_on_lines(
            table, side, whole.first, work.parts[2, whole.first : whole.end], axle, work.gap, wrench
        )
        for j in range(5):
            wrench[j] += whole.force / forces * spare[j]
        share = work.shares[kept]
        share.lobe = first
        share.last_lobe = last
        fill_patch(
            table, side, whole, lobes[first].foot, wrench, axle, work.gap, patches[kept], share
        )
        total += whole.energy
        kept += 1
    # What the sum of weighted energies leaves of the whole, some thousandths, goes to all alike.
    for k in range(kept):
        patches[k].energy *= energy / total if total > 0.0 else 0.0
        roll_together(table, side, axle, lobes, work.shares, k, kept, patches)
    return kept
