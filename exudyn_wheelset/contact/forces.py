"""Forces of the rails on a wheelset: patches, normal force, creepages and creep force.

For each patch, in the triad (x along the track, lateral tangent, normal n from rail into wheel):
- normal force N = N_Hertz(delta) (1 + damping delta') >= 0, a dissipative term that vanishes with
  the penetration (Hunt and Crossley 1975), delta' = -n.v;
- creepages from the exact velocity of the wheel's particle at the contact point P,
  v = v_C + omega x (P - C) minus the rail's: creep_x = v_x/V, creep_y = v.t/V, t = n x e_x, and
  spin = omega.n/V (Petersen and Hoffmann 2003; no small angles);
- creep force by the chosen law; wrench about the wheelset's centre in the track frame.
V is the forward speed over the rails.

Patches and their elastic normal forces come from patches.py.

The right side is computed as the left side of the mirrored wheelset and mirrored back, so mirror
symmetry holds to rounding.
"""

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.layout import (
    COUNT_LEFT,
    DAMPING,
    DEPTHS,
    FACTORS,
    FRICTION,
    LAW,
    LAW_PARAMETERS,
    PATCH_CREEP_X,
    PATCH_CREEP_Y,
    PATCH_FX,
    PATCH_FY,
    PATCH_LOBE,
    PATCH_MERGED_A,
    PATCH_MERGED_B,
    PATCH_MERGED_FORCE,
    PATCH_MZ,
    PATCH_NORMAL_FORCE,
    PATCH_NORMAL_Y,
    PATCH_NORMAL_Z,
    PATCH_OWN_A,
    PATCH_OWN_B,
    PATCH_OWN_FORCE,
    PATCH_PARTNER,
    PATCH_SEPARATION,
    PATCH_SHARE,
    PATCH_SPIN,
    PATCH_WIDTH,
    PATCH_X,
    PATCH_Y,
    PATCH_Z,
    PATCHES,
    POISSON,
    RAIL_SPEED,
    RESULT_SIZE,
    SHEAR_MODULUS,
)
from exudyn_wheelset.contact.patches import side_patches
from exudyn_wheelset.contact.search import LOBE_WIDTH, MOST_LOBES
from exudyn_wheelset.contact.tables import HEADER, RADIUS
from exudyn_wheelset.creep import creep_kernel

# Below this forward speed creepage is formed with it, to stay finite at rest.
LEAST_SPEED = 0.1


@compiled(inline="always")
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


@compiled
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
    lobes = result[RESULT_SIZE:DEPTHS].reshape(MOST_LOBES, LOBE_WIDTH)
    depths = result[DEPTHS:FACTORS]
    factors = result[FACTORS:]
    forward = vx + parameters[RAIL_SPEED]
    speed = max(abs(forward), LEAST_SPEED)
    law = int(parameters[LAW])
    law_parameters = parameters[LAW_PARAMETERS:]
    force_x = force_y = force_z = moment_x = moment_y = moment_z = 0.0
    for hand in range(2):
        mirror = 1.0 - 2.0 * hand
        side = hand * HEADER
        out = PATCHES + hand * MOST_LOBES * PATCH_WIDTH
        count = side_patches(
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
