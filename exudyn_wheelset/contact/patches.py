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

Frame: track frame, left side.
"""

import math

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.hertz import hertz_from_approach, hertz_from_load
from exudyn_wheelset.contact.layout import (
    HERTZ_LOCAL,
    NORMAL,
    PATCH_A,
    PATCH_ANGLE,
    PATCH_B,
    PATCH_ENERGY,
    PATCH_LOBE,
    PATCH_MERGED_A,
    PATCH_MERGED_B,
    PATCH_MERGED_FORCE,
    PATCH_NORMAL_FORCE,
    PATCH_NORMAL_Y,
    PATCH_NORMAL_Z,
    PATCH_OWN_A,
    PATCH_OWN_B,
    PATCH_OWN_FORCE,
    PATCH_PARTNER,
    PATCH_PENETRATION,
    PATCH_RADIUS,
    PATCH_RAIL_Y,
    PATCH_SEPARATION,
    PATCH_SHARE,
    PATCH_WHEEL_Y,
    PATCH_WIDTH,
    PATCH_X,
    PATCH_Y,
    PATCH_Z,
    POISSON,
    SHEAR_MODULUS,
    VIRTUAL_PENETRATION,
)
from exudyn_wheelset.contact.locus import wheel_point
from exudyn_wheelset.contact.search import (
    LOBE_ARC,
    LOBE_CURVATURE,
    LOBE_FOOT,
    LOBE_LEFT,
    LOBE_PENETRATION,
    LOBE_RIGHT,
    LOBE_SEPARATION,
    MERGED,
    MERGED_DEPTH,
    OWN,
    VIRTUAL,
    find_lobes,
    zone_moments,
)
from exudyn_wheelset.contact.tables import DATUM, RAIL, RAIL_SEGMENTS, RAIL_SPACING
from exudyn_wheelset.contact.virtual_penetration import virtual_penetration_force, zone_integrals


@compiled
def _ellipse(zone, lobe_depth, radius, nz, parameters):
    """Hertz ellipse of a zone's integral: (normal_force, a, b)."""
    extent = VIRTUAL * lobe_depth
    lateral = (16.0 / 9.0) * extent * extent * extent / (zone * zone)
    along = 0.5 * nz / radius
    return hertz_from_approach(
        along, lateral, lobe_depth, parameters[SHEAR_MODULUS], parameters[POISSON]
    )


@compiled
def _virtual_ellipse(first, second, zone, depth, radius, nz, parameters):
    """Force by virtual penetration and Hertz's ellipse under that force: (normal_force, a, b)."""
    modulus, poisson = parameters[SHEAR_MODULUS], parameters[POISSON]
    force = virtual_penetration_force(first, second, depth, modulus, poisson)
    extent = VIRTUAL * depth
    lateral = (16.0 / 9.0) * extent * extent * extent / (zone * zone)
    a, b, _, _ = hertz_from_load(0.5 * nz / radius, lateral, force, modulus, poisson)
    return force, a, b


@compiled
def _integrals(table, side, k, deepest, origin, along, cy, cz, lx, ly, lz, lobes):
    """Integrals of virtual penetration over lobe k's zone above (1 - VIRTUAL) deepest."""
    depth = lobes[k, LOBE_PENETRATION]
    level = (1.0 - VIRTUAL) * deepest
    if depth <= level:
        return 0.0, 0.0
    return zone_integrals(
        table, side, lobes[k, LOBE_ARC], lobes[k, LOBE_FOOT], depth, lobes[k, LOBE_CURVATURE],
        lobes[k, LOBE_LEFT], lobes[k, LOBE_RIGHT], level, origin, along, cy, cz, lx, ly, lz,
    )  # fmt: skip


@compiled
def _merged_integrals(
    table, side, k, other, deepest, centre, along, cy, cz, lx, ly, lz, lobes
):  # fmt: skip
    """Integrals over the zones of two merging lobes, with the displacement at lobe `centre`."""
    origin = lobes[centre, LOBE_ARC]
    first, second = _integrals(table, side, k, deepest, origin, along, cy, cz, lx, ly, lz, lobes)
    more, further = _integrals(
        table, side, other, deepest, origin, along, cy, cz, lx, ly, lz, lobes
    )
    return first + more, second + further


@compiled(inline="always")
def _unit(y, z):
    length = math.sqrt(y * y + z * z)
    return y / length, z / length


@compiled
def _lobe_moments(table, side, k, deepest, slot, cy, cz, lx, ly, lz, lobes):
    """Moments of lobe k over the zone above (1 - VIRTUAL) deepest, kept in its row at `slot`."""
    depth = lobes[k, LOBE_PENETRATION]
    level = (1.0 - VIRTUAL) * deepest
    lobes[k, slot : slot + 5] = 0.0
    if depth > level:
        zone, arc, foot, ny, nz = zone_moments(
            table, side, lobes[k, LOBE_ARC], lobes[k, LOBE_FOOT], depth,
            lobes[k, LOBE_CURVATURE], lobes[k, LOBE_LEFT], lobes[k, LOBE_RIGHT],
            level, cy, cz, lx, ly, lz,
        )  # fmt: skip
        lobes[k, slot] = zone
        lobes[k, slot + 1] = arc
        lobes[k, slot + 2] = foot
        lobes[k, slot + 3] = ny
        lobes[k, slot + 4] = nz
    if slot == MERGED:
        lobes[k, MERGED_DEPTH] = deepest
    elif deepest > depth:
        lobes[k, MERGED_DEPTH] = deepest
        lobes[k, MERGED : MERGED + 5] = lobes[k, OWN : OWN + 5]


@compiled
def _moments_at(table, side, k, deepest, cy, cz, lx, ly, lz, lobes):
    """Column where lobe k's moments below the depth of its merged patch stand."""
    if lobes[k, LOBE_PENETRATION] == deepest:
        return OWN
    if lobes[k, MERGED_DEPTH] != deepest:
        _lobe_moments(table, side, k, deepest, MERGED, cy, cz, lx, ly, lz, lobes)
    return MERGED


@compiled
def side_patches(table, side, cy, cz, lx, ly, lz, parameters, result, out, lobes, depths):
    """Normal contact of one side: fills patch rows with geometry and elastic force; their count."""
    count = find_lobes(table, side, cy, cz, lx, ly, lz, lobes, depths)
    for k in range(count):
        deepest = lobes[k, LOBE_PENETRATION]
        # A lobe that has wholly merged into a deeper one needs no zone of its own.
        if k > 0 and lobes[k - 1, LOBE_SEPARATION] == 0.0:
            deepest = max(deepest, lobes[k - 1, LOBE_PENETRATION])
        elif k + 1 < count and lobes[k, LOBE_SEPARATION] == 0.0:
            deepest = max(deepest, lobes[k + 1, LOBE_PENETRATION])
        _lobe_moments(table, side, k, deepest, OWN, cy, cz, lx, ly, lz, lobes)
    merging = parameters[NORMAL] != HERTZ_LOCAL
    one_patch = merging and count == 2 and lobes[0, LOBE_SEPARATION] == 0.0
    kept = 0
    for k in range(count):
        zone = lobes[k, OWN]
        if one_patch:
            if lobes[k, LOBE_PENETRATION] < lobes[1 - k, LOBE_PENETRATION] or kept > 0:
                continue
        elif zone <= 0.0:
            continue
        depth = lobes[k, LOBE_PENETRATION]
        place = lobes[k, OWN + 1] / zone
        at = lobes[k, OWN + 2] / zone
        ny, nz = _unit(lobes[k, OWN + 3], lobes[k, OWN + 4])
        _, _, _, _, _, radius, _, _ = wheel_point(table, side, place, cy, cz, lx, ly, lz)
        if parameters[NORMAL] == HERTZ_LOCAL:
            place = lobes[k, LOBE_ARC]
            at = lobes[k, LOBE_FOOT]
            force, a, b = hertz_from_approach(
                0.5 * nz / radius, 0.5 * max(lobes[k, LOBE_CURVATURE], 1.0e-3), depth,
                parameters[SHEAR_MODULUS], parameters[POISSON],
            )  # fmt: skip
        else:
            force, a, b = _ellipse(zone, depth, radius, nz, parameters)
        virtual = parameters[NORMAL] == VIRTUAL_PENETRATION
        if virtual:
            first, second = _integrals(
                table, side, k, depth, lobes[k, LOBE_ARC], 0.5 * nz / radius,
                cy, cz, lx, ly, lz, lobes,
            )  # fmt: skip
            force, a, b = _virtual_ellipse(first, second, zone, depth, radius, nz, parameters)
        # Merge with the neighbour that is less separated.
        row = out + kept * PATCH_WIDTH
        result[row + PATCH_OWN_FORCE] = force
        result[row + PATCH_OWN_A] = a
        result[row + PATCH_OWN_B] = b
        separation = lobes[k, LOBE_SEPARATION]
        other = k + 1
        if k > 0 and lobes[k - 1, LOBE_SEPARATION] < separation:
            separation = lobes[k - 1, LOBE_SEPARATION]
            other = k - 1
        if separation < 1.0 and merging:
            deepest = max(depth, lobes[other, LOBE_PENETRATION])
            mine = _moments_at(table, side, k, deepest, cy, cz, lx, ly, lz, lobes)
            theirs = _moments_at(table, side, other, deepest, cy, cz, lx, ly, lz, lobes)
            own = lobes[k, mine]
            whole = own + lobes[other, theirs]
            share = own / whole
            merged_place = (lobes[k, mine + 1] + lobes[other, theirs + 1]) / whole
            merged_at = (lobes[k, mine + 2] + lobes[other, theirs + 2]) / whole
            my, mz = _unit(
                lobes[k, mine + 3] + lobes[other, theirs + 3],
                lobes[k, mine + 4] + lobes[other, theirs + 4],
            )
            _, _, _, _, _, merged_radius, _, _ = wheel_point(
                table, side, merged_place, cy, cz, lx, ly, lz
            )
            merged_force, merged_a, merged_b = _ellipse(
                whole, deepest, merged_radius, mz, parameters
            )
            if virtual:
                along = 0.5 * mz / merged_radius
                # The displacement is taken at either lobe's deepest point: at one of them only, a
                # step would follow when the other becomes the deeper.
                first, second = _merged_integrals(
                    table, side, k, other, deepest, k, along, cy, cz, lx, ly, lz, lobes
                )
                _, further = _merged_integrals(
                    table, side, k, other, deepest, other, along, cy, cz, lx, ly, lz, lobes
                )
                second = 1.0 / (share / second + (1.0 - share) / further)
                merged_force, merged_a, merged_b = _virtual_ellipse(
                    first, second, whole, deepest, merged_radius, mz, parameters
                )
            if one_patch:
                share = 1.0
            rest = (1.0 - separation) * share
            # A share stands where the whole patch does, with the weight of the force it brings.
            weight = rest * merged_force / max(separation * force + rest * merged_force, 1.0e-30)
            place += weight * (merged_place - place)
            at += weight * (merged_at - at)
            ny, nz = _unit(ny + weight * (my - ny), nz + weight * (mz - nz))
            result[row + PATCH_SHARE] = share
            result[row + PATCH_MERGED_FORCE] = merged_force
            result[row + PATCH_MERGED_A] = merged_a
            result[row + PATCH_MERGED_B] = merged_b
            force = separation * force + rest * merged_force
            a = separation * a + (1.0 - separation) * merged_a
            b = separation * b + rest * merged_b
        else:
            separation = 1.0
        result[row + PATCH_SEPARATION] = separation
        result[row + PATCH_LOBE] = k
        result[row + PATCH_PARTNER] = other
        if force <= 0.0 or b <= 0.0:
            continue
        px, py, pz, _, _, radius, wheel_y, _ = wheel_point(table, side, place, cy, cz, lx, ly, lz)
        rail_y, _, _, _, _, _ = curve_point(
            table, int(table[side + RAIL]), table[side + RAIL_SPACING],
            int(table[side + RAIL_SEGMENTS]), at,
        )  # fmt: skip
        result[row + PATCH_WHEEL_Y] = wheel_y
        result[row + PATCH_RAIL_Y] = rail_y - table[side + DATUM]
        result[row + PATCH_ANGLE] = math.atan2(-ny, nz)
        result[row + PATCH_RADIUS] = radius
        result[row + PATCH_NORMAL_FORCE] = force
        result[row + PATCH_A] = a
        result[row + PATCH_B] = b
        result[row + PATCH_PENETRATION] = depth
        result[row + PATCH_X] = px
        result[row + PATCH_Y] = py - cy
        result[row + PATCH_Z] = pz - cz
        result[row + PATCH_NORMAL_Y] = ny
        result[row + PATCH_NORMAL_Z] = nz
        result[row + PATCH_ENERGY] = 0.4 * force * depth
        kept += 1
    return kept
