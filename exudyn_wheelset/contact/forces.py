"""Forces of the rails on a wheelset: patches, normal force, creepages and creep force.

For each patch, in the triad (x along the track, lateral tangent, normal n from rail into wheel):
- normal force N = N_Hertz(delta) (1 + damping delta') >= 0, a dissipative term that vanishes with
  the penetration (Hunt and Crossley 1975), delta' = -n.v;
- creepages from the exact velocity of the wheel's particle at the contact point P,
  v = v_C + omega x (P - C) minus the rail's: creep_x = v_x/V, creep_y = v.t/V, t = n x e_x, and
  spin = omega.n/V (Petersen and Hoffmann 2003; no small angles);
- creep force by the chosen law; wrench about the wheelset's centre in the track frame.
V is the forward speed over the rails.

Two neighbouring lobes with penetrations delta_1, delta_2 become one patch when the valley between
them disappears. With the separation s (search.py), the patch of lobe j carries
    N_j = s N(delta_j, B_j) + (1 - s) share_j N(max delta, B_merged),
where B_merged belongs to the zone over both lobes and share_j to lobe j's part of it; creep force,
ellipse and position are blended alike (a share of a merged patch has its share of that patch's
creep force). So a lobe enters and leaves without a step in force.

The right side is computed as the left side of the mirrored wheelset and mirrored back, so mirror
symmetry holds to rounding.
"""

import math

import numpy as np
from numba import njit

from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.locus import wheel_point
from exudyn_wheelset.contact.search import (
    LOBE_ARC,
    LOBE_CURVATURE,
    LOBE_FOOT,
    LOBE_LEFT,
    LOBE_PENETRATION,
    LOBE_RIGHT,
    LOBE_SEPARATION,
    LOBE_WIDTH,
    MERGED,
    MERGED_DEPTH,
    MOST_LOBES,
    OWN,
    VIRTUAL,
    find_lobes,
    zone_moments,
)
from exudyn_wheelset.contact.tables import (
    DATUM,
    HEADER,
    MOST_NODES,
    RADIUS,
    RAIL,
    RAIL_SEGMENTS,
    RAIL_SPACING,
)
from exudyn_wheelset.creep import creep_kernel
from exudyn_wheelset.normal.hertz import hertz_from_approach

FRICTION, SHEAR_MODULUS, POISSON, DAMPING, LAW, NORMAL, RAIL_SPEED = 0, 1, 2, 3, 4, 5, 6
LAW_PARAMETERS = 8
PARAMETER_COUNT = 16

(
    PATCH_WHEEL_Y,
    PATCH_RAIL_Y,
    PATCH_ANGLE,
    PATCH_RADIUS,
    PATCH_NORMAL_FORCE,
    PATCH_CREEP_X,
    PATCH_CREEP_Y,
    PATCH_SPIN,
    PATCH_FX,
    PATCH_FY,
    PATCH_MZ,
    PATCH_A,
    PATCH_B,
    PATCH_PENETRATION,
    PATCH_X,
    PATCH_Y,
    PATCH_Z,
    PATCH_NORMAL_Y,
    PATCH_NORMAL_Z,
    PATCH_ENERGY,
    PATCH_SEPARATION,
    PATCH_OWN_FORCE,
    PATCH_OWN_A,
    PATCH_OWN_B,
    PATCH_SHARE,
    PATCH_MERGED_FORCE,
    PATCH_MERGED_A,
    PATCH_MERGED_B,
    PATCH_LOBE,
    PATCH_PARTNER,
) = range(30)
PATCH_WIDTH = 30

# Result array: wrench (6), numbers of patches left and right, then the patches of either side.
COUNT_LEFT, COUNT_RIGHT, PATCHES = 6, 7, 8
RESULT_SIZE = PATCHES + 2 * MOST_LOBES * PATCH_WIDTH
HERTZ, HERTZ_LOCAL, VIRTUAL_PENETRATION = 0, 1, 2
_DEPTHS = RESULT_SIZE + MOST_LOBES * LOBE_WIDTH
_FACTORS = _DEPTHS + MOST_NODES
# Below this forward speed creepage is formed with it, to stay finite at rest.
LEAST_SPEED = 0.1


def new_result() -> np.ndarray:
    """Array that the kernels write into; one for each wheelset."""
    return np.zeros(_FACTORS + MOST_LOBES)


@njit(cache=True, error_model="numpy")
def _ellipse(zone, lobe_depth, radius, nz, parameters):
    """Hertz ellipse of a zone's integral: (normal_force, a, b)."""
    extent = VIRTUAL * lobe_depth
    lateral = (16.0 / 9.0) * extent * extent * extent / (zone * zone)
    along = 0.5 * nz / radius
    return hertz_from_approach(
        along, lateral, lobe_depth, parameters[SHEAR_MODULUS], parameters[POISSON]
    )


@njit(cache=True, error_model="numpy", inline="always")
def _unit(y, z):
    length = math.sqrt(y * y + z * z)
    return y / length, z / length


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
def _moments_at(table, side, k, deepest, cy, cz, lx, ly, lz, lobes):
    """Column where lobe k's moments below the depth of its merged patch stand."""
    if lobes[k, LOBE_PENETRATION] == deepest:
        return OWN
    if lobes[k, MERGED_DEPTH] != deepest:
        _lobe_moments(table, side, k, deepest, MERGED, cy, cz, lx, ly, lz, lobes)
    return MERGED


@njit(cache=True, error_model="numpy")
def _side_patches(table, side, cy, cz, lx, ly, lz, parameters, result, out, lobes, depths):
    """Normal contact of one side: fills patch rows with geometry and elastic force; their count."""
    count = find_lobes(table, side, cy, cz, lx, ly, lz, lobes, depths)
    for k in range(count):
        _lobe_moments(table, side, k, lobes[k, LOBE_PENETRATION], OWN, cy, cz, lx, ly, lz, lobes)
    merging = parameters[NORMAL] != HERTZ_LOCAL
    kept = 0
    for k in range(count):
        zone = lobes[k, OWN]
        if zone <= 0.0:
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
            merged_force, merged_a, merged_b = _ellipse(whole, deepest, radius, nz, parameters)
            rest = (1.0 - separation) * share
            # A share's position counts with the force it brings.
            weight = rest * merged_force / max(separation * force + rest * merged_force, 1.0e-30)
            if own > 0.0:
                place += weight * (lobes[k, mine + 1] / own - place)
                at += weight * (lobes[k, mine + 2] / own - at)
                my, mz = _unit(lobes[k, mine + 3], lobes[k, mine + 4])
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


@njit(cache=True, error_model="numpy", inline="always")
def _patch_creep(
    law, creep_x, creep_y, spin, factor, parameters, law_parameters, result, row, out, count
):  # fmt: skip
    """Creep force of a patch; `factor` is what damping makes of the elastic normal force."""
    fx = 0.0
    fy = 0.0
    mz = 0.0
    separation = result[row + PATCH_SEPARATION]
    if factor <= 0.0:
        return fx, fy, mz
    if separation > 0.0:
        fx, fy, mz = creep_kernel(
            law, creep_x, creep_y, spin, result[row + PATCH_OWN_A], result[row + PATCH_OWN_B],
            factor * result[row + PATCH_OWN_FORCE], parameters[FRICTION],
            parameters[SHEAR_MODULUS], parameters[POISSON], law_parameters,
        )  # fmt: skip
    if separation < 1.0:
        # A share of a merged patch has its share of the creep force of the whole, which slips
        # with the mean creepage.
        share = result[row + PATCH_SHARE]
        for k in range(count):
            other = out + k * PATCH_WIDTH
            if result[other + PATCH_LOBE] == result[row + PATCH_PARTNER]:
                creep_x += (1.0 - share) * (result[other + PATCH_CREEP_X] - creep_x)
                creep_y += (1.0 - share) * (result[other + PATCH_CREEP_Y] - creep_y)
                spin += (1.0 - share) * (result[other + PATCH_SPIN] - spin)
        gx, gy, gz = creep_kernel(
            law, creep_x, creep_y, spin, result[row + PATCH_MERGED_A],
            result[row + PATCH_MERGED_B], factor * result[row + PATCH_MERGED_FORCE],
            parameters[FRICTION], parameters[SHEAR_MODULUS], parameters[POISSON], law_parameters,
        )  # fmt: skip
        rest = (1.0 - separation) * share
        fx = separation * fx + rest * gx
        fy = separation * fy + rest * gy
        mz = separation * mz + rest * gz
    return fx, fy, mz


@njit(cache=True, error_model="numpy")
def wheelset_forces(
    table, y, z, lx, ly, lz, vx, vy, vz, wx, wy, wz, rail_motion, parameters, result
):  # fmt: skip
    """Fill `result` with the wrench on the wheelset and its patches; return nothing.

    table: contact_tables(). y, z [m]: the centre, z from `radius` above the rail tops; l: unit
    vector of the axle, towards the left wheel; v [m/s], w [rad/s]: velocity of the centre over
    the ground and angular velocity, track frame. rail_motion (8): lateral and vertical shift of
    the left and the right rail [m], then their rates [m/s]. parameters: see module constants;
    RAIL_SPEED is the speed at which the rails run backwards (a model in a moving frame).
    Patches on the right side come back in the right-handed triad of the track frame; positions
    and angles count towards the field side.
    """
    lobes = result[RESULT_SIZE:_DEPTHS].reshape(MOST_LOBES, LOBE_WIDTH)
    depths = result[_DEPTHS:_FACTORS]
    factors = result[_FACTORS:]
    forward = vx + parameters[RAIL_SPEED]
    speed = max(abs(forward), LEAST_SPEED)
    law = int(parameters[LAW])
    law_parameters = parameters[LAW_PARAMETERS:]
    force_x = force_y = force_z = moment_x = moment_y = moment_z = 0.0
    for hand in range(2):
        mirror = 1.0 - 2.0 * hand
        side = hand * HEADER
        out = PATCHES + hand * MOST_LOBES * PATCH_WIDTH
        count = _side_patches(
            table, side, mirror * (y - rail_motion[2 * hand]),
            table[RADIUS] + z - rail_motion[2 * hand + 1],
            mirror * lx, ly, mirror * lz, parameters, result, out, lobes, depths,
        )  # fmt: skip
        result[COUNT_LEFT + hand] = count
        rail_vy = mirror * rail_motion[4 + 2 * hand]
        rail_vz = rail_motion[5 + 2 * hand]
        ux = forward
        uy = mirror * vy - rail_vy
        uz = vz - rail_vz
        ox = mirror * wx
        oy = wy
        oz = mirror * wz
        for k in range(count):
            row = out + k * PATCH_WIDTH
            px = result[row + PATCH_X]
            py = result[row + PATCH_Y]
            pz = result[row + PATCH_Z]
            ny = result[row + PATCH_NORMAL_Y]
            nz = result[row + PATCH_NORMAL_Z]
            slip_x = ux + oy * pz - oz * py
            slip_y = uy + oz * px - ox * pz
            slip_z = uz + ox * py - oy * px
            closing = -(ny * slip_y + nz * slip_z)
            factors[k] = max(1.0 + parameters[DAMPING] * closing, 0.0)
            result[row + PATCH_CREEP_X] = slip_x / speed
            result[row + PATCH_CREEP_Y] = (nz * slip_y - ny * slip_z) / speed
            result[row + PATCH_SPIN] = (ny * oy + nz * oz) / speed
        for k in range(count):
            row = out + k * PATCH_WIDTH
            px = result[row + PATCH_X]
            py = result[row + PATCH_Y]
            pz = result[row + PATCH_Z]
            ny = result[row + PATCH_NORMAL_Y]
            nz = result[row + PATCH_NORMAL_Z]
            elastic = result[row + PATCH_NORMAL_FORCE]
            normal_force = elastic * factors[k]
            creep_x = result[row + PATCH_CREEP_X]
            creep_y = result[row + PATCH_CREEP_Y]
            spin = result[row + PATCH_SPIN]
            fx, fy, mz = _patch_creep(
                law, creep_x, creep_y, spin, factors[k], parameters, law_parameters,
                result, row, out, count,
            )  # fmt: skip
            gy = nz * fy + ny * normal_force
            gz = -ny * fy + nz * normal_force
            my = mz * ny
            mzz = mz * nz
            mx = py * gz - pz * gy
            my += pz * fx - px * gz
            mzz += px * gy - py * fx
            force_x += fx
            force_y += mirror * gy
            force_z += gz
            moment_x += mirror * mx
            moment_y += my
            moment_z += mirror * mzz
            result[row + PATCH_FX] = fx
            result[row + PATCH_FY] = mirror * fy
            result[row + PATCH_MZ] = mirror * mz
        for k in range(count):
            # Only now, when no other patch of the side needs them any more.
            row = out + k * PATCH_WIDTH
            result[row + PATCH_NORMAL_FORCE] *= factors[k]
            result[row + PATCH_CREEP_Y] *= mirror
            result[row + PATCH_SPIN] *= mirror
            result[row + PATCH_Y] *= mirror
            result[row + PATCH_NORMAL_Y] *= mirror
    result[0] = force_x
    result[1] = force_y
    result[2] = force_z
    result[3] = moment_x
    result[4] = moment_y
    result[5] = moment_z
