"""Patches of one wheel with their elastic normal forces.

The normal force of a lobe (search.py) is N(delta, A, B): Hertz's with the averaged curvature
("hertz"), Hertz's with the curvature at the deepest point ("hertz-local"), or by virtual
penetration (virtual_penetration.py).

Two neighbouring lobes with penetrations delta_1, delta_2 become one patch when the valley between
them disappears. With the separation s (search.py), the patch of lobe j carries
    N_j = s N(delta_j, B_j) + (1 - s) share_j N(max delta, B_merged),
where B_merged belongs to the zone over both lobes and share_j to lobe j's part of it; creep force,
ellipse and position are blended alike (a share of a merged patch stands at that patch's place and
has its share of that patch's creep force). So a lobe enters and leaves without a step in force.
Two lobes that have merged wholly (s = 0) are one patch.

Patches of one wheel sink in each other's field: far from a load N the half-space has sunk by
    u = (1 - nu) N/(pi G r)
(both bodies; Boussinesq), r the distance, and of delta only delta - u is left for the patch itself.
At a fixed curvature N ~ delta^1.5, a, b ~ delta^0.5. u counts with the separation of the lobes:
what has merged is one patch already.

Frame: track frame, left side. Records LOBE, SHARE, PATCH and the named tuples: layout.py.
"""

import math

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.hertz import hertz_from_approach, hertz_from_load
from exudyn_wheelset.contact.layout import (
    HERTZ_LOCAL,
    VIRTUAL_PENETRATION,
    Ellipse,
    Material,
    Zone,
    side_of,
)
from exudyn_wheelset.contact.locus import wheel_point
from exudyn_wheelset.contact.search import VIRTUAL, find_lobes, zone_moments
from exudyn_wheelset.contact.virtual_penetration import virtual_penetration_force, zone_integrals

# Sinking in each other's fields converges by a factor of some 0.1 a sweep.
_SWEEPS = 12


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _mean_half_curvature(total, depth):
    """B [1/m] of the parabola with the same integral over its zone."""
    extent = VIRTUAL * depth
    return (16.0 / 9.0) * extent * extent * extent / (total * total)


@compiled(fastmath=AS_REAL_NUMBERS)
def _hertz_ellipse(along, lateral, depth, material):
    """Ellipse by Hertz of half curvatures along and lateral [1/m] and the approach [m]."""
    force, a, b = hertz_from_approach(
        along, lateral, depth, material.shear_modulus, material.poisson
    )
    return Ellipse(force, a, b)


@compiled(fastmath=AS_REAL_NUMBERS)
def _virtual_ellipse(first, second, lateral, depth, along, material):
    """Force by virtual penetration and Hertz's ellipse under that force."""
    force = virtual_penetration_force(first, second, depth, material)
    a, b, _, _ = hertz_from_load(along, lateral, force, material.shear_modulus, material.poisson)
    return Ellipse(force, a, b)


@compiled(fastmath=AS_REAL_NUMBERS)
def _integrals(table, side, lobe, deepest, origin, along, axle):
    """Integrals of virtual penetration over the lobe's zone above (1 - VIRTUAL) deepest."""
    level = (1.0 - VIRTUAL) * deepest
    if lobe.penetration <= level:
        return 0.0, 0.0
    return zone_integrals(table, side, lobe, level, origin, along, axle)


@compiled(fastmath=AS_REAL_NUMBERS)
def _merged_integrals(table, side, lobe, other, deepest, origin, along, axle):
    """Integrals over the zones of two merging lobes, with the displacement at `origin`."""
    first, second = _integrals(table, side, lobe, deepest, origin, along, axle)
    more, further = _integrals(table, side, other, deepest, origin, along, axle)
    return first + more, second + further


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _unit(y, z):
    length = math.sqrt(y * y + z * z)
    return y / length, z / length


@compiled(fastmath=AS_REAL_NUMBERS)
def _zone_moments(table, side, lobe, deepest, axle):
    """Moments of the lobe's zone above (1 - VIRTUAL) deepest; zeros if it does not reach there."""
    level = (1.0 - VIRTUAL) * deepest
    if lobe.penetration <= level:
        return Zone(0.0, 0.0, 0.0, 0.0, 0.0)
    return zone_moments(table, side, lobe, level, axle)


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _keep(record, zone):
    record.total = zone.total
    record.arc = zone.arc
    record.foot = zone.foot
    record.normal_y = zone.normal_y
    record.normal_z = zone.normal_z


@compiled(fastmath=AS_REAL_NUMBERS)
def _part_of_merged(table, side, lobe, deepest, axle):
    """Record of the lobe's moments as a part of a merged patch as deep as `deepest`."""
    if lobe.penetration == deepest:
        return lobe.own
    if lobe.merged_depth != deepest:
        _keep(lobe.merged, _zone_moments(table, side, lobe, deepest, axle))
        lobe.merged_depth = deepest
    return lobe.merged


@compiled(fastmath=AS_REAL_NUMBERS)
def _fill_own_zones(table, side, lobes, count, axle):
    """Fill `own` of each lobe.

    A lobe that has wholly merged into a deeper one needs no zone of its own: its part of the
    merged one takes the place.
    """
    for k in range(count):
        lobe = lobes[k]
        deepest = lobe.penetration
        if k > 0 and lobes[k - 1].separation == 0.0:
            deepest = max(deepest, lobes[k - 1].penetration)
        elif k + 1 < count and lobe.separation == 0.0:
            deepest = max(deepest, lobes[k + 1].penetration)
        zone = _zone_moments(table, side, lobe, deepest, axle)
        _keep(lobe.own, zone)
        if deepest > lobe.penetration:
            _keep(lobe.merged, zone)
            lobe.merged_depth = deepest


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _less_separated_neighbour(lobes, k):
    """Separation of lobe k from the neighbour that is less separated from it, and which it is."""
    separation = lobes[k].separation
    other = k + 1
    if k > 0 and lobes[k - 1].separation < separation:
        separation = lobes[k - 1].separation
        other = k - 1
    return separation, other


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _set_ellipse(record, ellipse):
    record.force = ellipse.force
    record.a = ellipse.a
    record.b = ellipse.b


@compiled(fastmath=AS_REAL_NUMBERS)
def _own_ellipse(table, side, lobe, normal, material, axle):
    """Ellipse of a lobe alone by the model of that number; its zone has been filled."""
    zone = lobe.own
    depth = lobe.penetration
    _, nz = _unit(zone.normal_y, zone.normal_z)
    _, _, _, _, _, radius, _, _ = wheel_point(table, side, zone.arc / zone.total, axle)
    along = 0.5 * nz / radius
    lateral = _mean_half_curvature(zone.total, depth)
    if normal == HERTZ_LOCAL:
        lateral = 0.5 * max(lobe.curvature, 1.0e-3)
    elif normal == VIRTUAL_PENETRATION:
        first, second = _integrals(table, side, lobe, depth, lobe.arc, along, axle)
        return _virtual_ellipse(first, second, lateral, depth, along, material)
    return _hertz_ellipse(along, lateral, depth, material)


@compiled(fastmath=AS_REAL_NUMBERS)
def _sink_in_each_other(lobes, shares, count, material):
    """Take the lobes' own ellipses back to what is left of their penetrations.

    A fixed point, from above and below in turn: a neighbour's sinking changes by less than a third
    of what its load's does.
    """
    compliance = (1.0 - material.poisson) / (math.pi * material.shear_modulus)
    for _ in range(_SWEEPS):
        change = 0.0
        for k in range(count):
            sunk = 0.0
            weight = 1.0
            for j in range(k + 1, count):
                weight *= lobes[j - 1].separation
                sunk += weight * _field(lobes, shares, k, j)
            weight = 1.0
            for j in range(k - 1, -1, -1):
                weight *= lobes[j].separation
                sunk += weight * _field(lobes, shares, k, j)
            sunk = min(compliance * sunk, lobes[k].penetration)
            change = max(change, abs(sunk - lobes[k].sunk))
            lobes[k].sunk = sunk
        if change < 1.0e-13:
            break
    for k in range(count):
        own = shares[k].own
        left = 1.0 - lobes[k].sunk / lobes[k].penetration
        root = math.sqrt(left)
        own.force *= left * root
        own.a *= root
        own.b *= root


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _field(lobes, shares, k, j):
    """Load [N] of lobe j as it is sunk now, over its distance from lobe k [m]."""
    if lobes[k].own.total <= 0.0 or lobes[j].own.total <= 0.0:
        return 0.0
    left = 1.0 - lobes[j].sunk / lobes[j].penetration
    force = shares[j].own.force * left * math.sqrt(left)
    distance = lobes[k].own.arc / lobes[k].own.total - lobes[j].own.arc / lobes[j].own.total
    return force / abs(distance)


@compiled(fastmath=AS_REAL_NUMBERS)
def side_patches(table, hand, axle, parameters, work, patches):
    """Normal contact of one side by Hertz's theory or virtual penetration.

    Fills patches with geometry and elastic force; returns their count.
    """
    side = side_of(table, hand)
    lobes = work.lobes
    shares = work.shares
    material = Material(parameters.shear_modulus, parameters.poisson)
    count = find_lobes(table, side, axle, work)
    _fill_own_zones(table, side, lobes, count, axle)
    normal = int(parameters.normal)
    virtual = normal == VIRTUAL_PENETRATION
    local = normal == HERTZ_LOCAL
    one_patch = not local and count == 2 and lobes[0].separation == 0.0
    for k in range(count):
        lobes[k].sunk = 0.0
        ellipse = Ellipse(0.0, 0.0, 0.0)
        if lobes[k].own.total > 0.0:
            ellipse = _own_ellipse(table, side, lobes[k], normal, material, axle)
        _set_ellipse(shares[k].own, ellipse)
    if count > 1 and not one_patch:
        _sink_in_each_other(lobes, shares, count, material)
    kept = 0
    for k in range(count):
        lobe = lobes[k]
        zone = lobe.own
        if one_patch:
            if lobe.penetration < lobes[1 - k].penetration or kept > 0:
                continue
        elif zone.total <= 0.0:
            continue
        depth = lobe.penetration
        place = zone.arc / zone.total
        at = zone.foot / zone.total
        if local:
            place = lobe.arc
            at = lobe.foot
        ny, nz = _unit(zone.normal_y, zone.normal_z)
        own = shares[k].own
        force, a, b = own.force, own.a, own.b
        share = shares[kept]
        _set_ellipse(share.own, Ellipse(force, a, b))
        separation, partner = _less_separated_neighbour(lobes, k)
        if separation < 1.0 and not local:
            other = lobes[partner]
            deepest = max(depth, other.penetration)
            mine = _part_of_merged(table, side, lobe, deepest, axle)
            theirs = _part_of_merged(table, side, other, deepest, axle)
            whole = mine.total + theirs.total
            part = mine.total / whole
            merged_place = (mine.arc + theirs.arc) / whole
            merged_at = (mine.foot + theirs.foot) / whole
            my, mz = _unit(mine.normal_y + theirs.normal_y, mine.normal_z + theirs.normal_z)
            _, _, _, _, _, merged_radius, _, _ = wheel_point(table, side, merged_place, axle)
            along = 0.5 * mz / merged_radius
            lateral = _mean_half_curvature(whole, deepest)
            if virtual:
                # The displacement is taken at either lobe's deepest point: at one of them only, a
                # step would follow when the other becomes the deeper.
                first, second = _merged_integrals(
                    table, side, lobe, other, deepest, lobe.arc, along, axle
                )
                _, further = _merged_integrals(
                    table, side, lobe, other, deepest, other.arc, along, axle
                )
                second = 1.0 / (part / second + (1.0 - part) / further)
                merged = _virtual_ellipse(first, second, lateral, deepest, along, material)
            else:
                merged = _hertz_ellipse(along, lateral, deepest, material)
            if one_patch:
                part = 1.0
            rest = (1.0 - separation) * part
            # A share stands where the whole patch does, with the weight of the force it brings.
            weight = rest * merged.force / max(separation * force + rest * merged.force, 1.0e-30)
            place += weight * (merged_place - place)
            at += weight * (merged_at - at)
            ny, nz = _unit(ny + weight * (my - ny), nz + weight * (mz - nz))
            share.share = part
            _set_ellipse(share.merged, merged)
            force = separation * force + rest * merged.force
            a = separation * a + (1.0 - separation) * merged.a
            b = separation * b + rest * merged.b
        else:
            separation = 1.0
        if force <= 0.0 or b <= 0.0:
            continue
        share.separation = separation
        share.lobe = k
        share.partner = partner
        share.shift_y = share.shift_z = 0.0
        px, py, pz, _, _, radius, wheel_y, _ = wheel_point(table, side, place, axle)
        rail_y, _, _, _, _, _ = curve_point(table, side.rail, at)
        patch = patches[kept]
        patch.wheel_y = wheel_y
        patch.rail_y = rail_y - side.datum
        patch.angle = math.atan2(-ny, nz)
        patch.radius = radius
        patch.normal_force = force
        patch.a = a
        patch.b = b
        patch.penetration = depth
        patch.position[0] = px
        patch.position[1] = py - axle.y
        patch.position[2] = pz - axle.z
        patch.normal[1] = ny
        patch.normal[2] = nz
        # Of one ellipse, and half the work of its own part against what the neighbours sink it.
        patch.energy = 0.4 * force * depth + 0.1 * separation * share.own.force * lobe.sunk
        # A share of a merged patch has its share of the ellipse: this is the merged patch's.
        patch.peak_pressure = 1.5 * force / (math.pi * a * b)
        patch.twist = 0.0
        kept += 1
    return kept
