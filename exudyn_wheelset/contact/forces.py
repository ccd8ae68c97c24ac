"""Forces of the rails on a wheelset: patches, normal force, creepages and creep force.

For each patch, in the triad (x along the track, lateral tangent, normal n from rail into wheel):
- normal force N = N_Hertz(delta) (1 + damping delta') >= 0, a dissipative term that vanishes with
  the penetration (Hunt and Crossley 1975), delta' = -n.v;
- creepages from the exact velocity of the wheel's particle at the contact point (creepage.py);
- creep force by the chosen law; wrench about the wheelset's centre in the track frame.
V is the forward speed over the rails.

Patches and their elastic normal forces come from patches.py. With strips, FASTSIM runs over them
(strip_creep.py); the other laws take the ellipse with their load and second moments.

The right side is computed as the left side of the mirrored wheelset and mirrored back, so mirror
symmetry holds to rounding. Records and named tuples: layout.py.
"""

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.creepage import creepage_at, slip_velocity
from exudyn_wheelset.contact.layout import (
    PARAMETERS,
    RESULT,
    STRIPS,
    Axle,
    Creepage,
    Slip,
    Traction,
    side_of,
)
from exudyn_wheelset.contact.patches import side_patches
from exudyn_wheelset.contact.strip_creep import strip_traction
from exudyn_wheelset.creep import CREEP_LAWS, creep_kernel

# Below this forward speed creepage is formed with it, to stay finite at rest.
LEAST_SPEED = 0.1
_FASTSIM = CREEP_LAWS["fastsim"].number


@compiled(inline="always")
def _law_force(creepage, ellipse, damping, parameters):
    """Creep force (F_x, F_y, M_z) of the chosen law on an ELLIPSE under a damped normal force."""
    return creep_kernel(
        int(parameters.law), creepage.x, creepage.y, creepage.spin, ellipse.a, ellipse.b,
        damping * ellipse.force, parameters.friction, parameters.shear_modulus,
        parameters.poisson, parameters.law_parameters,
    )  # fmt: skip


@compiled(inline="always")
def _patch_creep(k, patches, shares, count, parameters):
    """Creep force of patch k of a side."""
    fx = 0.0
    fy = 0.0
    mz = 0.0
    share = shares[k]
    if share.damping <= 0.0:
        return fx, fy, mz
    creepage = Creepage(patches[k].creep_x, patches[k].creep_y, patches[k].spin)
    if share.separation > 0.0:
        fx, fy, mz = _law_force(creepage, share.own, share.damping, parameters)
        fx *= share.separation
        fy *= share.separation
        mz *= share.separation
    if share.share > 0.0 and share.separation < 1.0:
        # A share of a merged patch has its share of the creep force of the whole, which slips
        # with the mean creepage.
        for j in range(count):
            if shares[j].lobe == share.partner:
                rest = 1.0 - share.share
                creepage = Creepage(
                    creepage.x + rest * (patches[j].creep_x - creepage.x),
                    creepage.y + rest * (patches[j].creep_y - creepage.y),
                    creepage.spin + rest * (patches[j].spin - creepage.spin),
                )
        gx, gy, gz = _law_force(creepage, share.merged, share.damping, parameters)
        rest = (1.0 - share.separation) * share.share
        fx += rest * gx
        fy += rest * gy
        mz += rest * gz
    return fx, fy, mz


@compiled(fastmath=AS_REAL_NUMBERS)
def wheelset_forces(table, axle, velocity, rail_motion, parameters, result):
    """Fill `result` with the wrench on the wheelset and its patches; return nothing.

    table: contact_tables(). axle (Axle): y, z [m] of the centre, z from `radius` above the rail
    tops, and the axle's unit vector; velocity (Velocity) of the centre over the ground and
    angular, track frame. rail_motion (8): lateral and vertical shift of the left and the right
    rail [m], then their rates [m/s]. parameters: contact_parameters(); result: new_result().
    Patches on the right side come back in the right-handed triad of the track frame; positions
    and angles count towards the field side.
    """
    options = parameters.view(PARAMETERS)[0]
    out = result.view(RESULT)[0]
    shares = out.work.shares
    forward = velocity.x + options.rail_speed
    speed = max(abs(forward), LEAST_SPEED)
    height = side_of(table, 0).radius + axle.z
    over_strips = options.normal == STRIPS and int(options.law) == _FASTSIM
    force_x = force_y = force_z = moment_x = moment_y = moment_z = 0.0
    for hand in range(2):
        mirror = 1.0 - 2.0 * hand
        patches = out.patches[hand]
        mirrored = Axle(
            mirror * (axle.y - rail_motion[2 * hand]), height - rail_motion[2 * hand + 1],
            mirror * axle.lx, axle.ly, mirror * axle.lz,
        )  # fmt: skip
        count = side_patches(table, hand, mirrored, options, out.work, patches)
        out.count[hand] = count
        slip = Slip(
            forward, mirror * velocity.y - mirror * rail_motion[4 + 2 * hand],
            velocity.z - rail_motion[5 + 2 * hand],
            mirror * velocity.about_x, velocity.about_y, mirror * velocity.about_z, speed,
        )  # fmt: skip
        for k in range(count):
            patch = patches[k]
            px, py, pz = patch.position[0], patch.position[1], patch.position[2]
            ny, nz = patch.normal[1], patch.normal[2]
            _, slip_y, slip_z = slip_velocity(slip, px, py, pz)
            about = ny * slip.about_y + nz * slip.about_z
            closing = -(ny * slip_y + nz * slip_z + patch.twist / patch.normal_force * about)
            shares[k].damping = max(1.0 + options.damping * closing, 0.0)
            patch.creep_x, patch.creep_y, patch.spin = creepage_at(slip, px, py, pz, ny, nz)
        for k in range(count):
            patch = patches[k]
            px, py, pz = patch.position[0], patch.position[1], patch.position[2]
            ny, nz = patch.normal[1], patch.normal[2]
            if over_strips:
                creep = strip_traction(out.work.strips, shares[k], patch, slip, options)
            else:
                fx, fy, mz = _patch_creep(k, patches, shares, count, options)
                creep = Traction(fx, fy, 0.0, 0.0, 0.0, mz)
            along_normal = patch.normal_force * shares[k].damping + creep.normal
            gy = nz * creep.lateral + ny * along_normal
            gz = -ny * creep.lateral + nz * along_normal
            force_x += creep.x
            force_y += mirror * gy
            force_z += gz
            moment_x += mirror * (creep.moment_x + py * gz - pz * gy)
            patch.twist *= shares[k].damping
            about = creep.moment_normal + patch.twist
            my = about * ny + creep.moment_lateral * nz
            mz = about * nz - creep.moment_lateral * ny
            moment_y += my + (pz * creep.x - px * gz)
            moment_z += mirror * (mz + (px * gy - py * creep.x))
            patch.fx = creep.x
            patch.fy = mirror * creep.lateral
            patch.mz = mirror * creep.moment_normal
        for k in range(count):
            # Only now, when no other patch of the side needs them any more.
            patch = patches[k]
            patch.normal_force *= shares[k].damping
            patch.peak_pressure *= shares[k].damping
            patch.creep_y *= mirror
            patch.spin *= mirror
            patch.position[1] *= mirror
            patch.normal[1] *= mirror
    out.force[0] = force_x
    out.force[1] = force_y
    out.force[2] = force_z
    out.moment[0] = moment_x
    out.moment[1] = moment_y
    out.moment[2] = moment_z
