"""Forces of the rails on a wheelset: patches, normal force, creepages and creep force.

For each patch, in the triad (x along the track, lateral tangent, normal n from rail into wheel):
- normal force N = N_Hertz(delta) (1 + damping delta') >= 0, a dissipative term that vanishes with
  the penetration (Hunt and Crossley 1975), delta' = -n.v;
- creepages from the exact velocity of the wheel's particle at the contact point P,
  v = v_C + omega x (P - C) minus the rail's: creep_x = v_x/V, creep_y = v.t/V, t = n x e_x, and
  spin = omega.n/V (Petersen and Hoffmann 2003; no small angles);
- creep force by the chosen law; wrench about the wheelset's centre in the track frame.
V is the forward speed over the rails. Peak pressure is 3 N/(2 pi a b), Hertz's; a share of a merged
patch has its share of the ellipse, so that this is the merged patch's.

Patches and their elastic normal forces come from patches.py.

The right side is computed as the left side of the mirrored wheelset and mirrored back, so mirror
symmetry holds to rounding. Records and named tuples: layout.py.
"""

import math

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.layout import PARAMETERS, RESULT, Axle, Creepage, side_of
from exudyn_wheelset.contact.patches import side_patches
from exudyn_wheelset.creep import creep_kernel

# Below this forward speed creepage is formed with it, to stay finite at rest.
LEAST_SPEED = 0.1


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
    if share.separation < 1.0:
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
        fx = share.separation * fx + rest * gx
        fy = share.separation * fy + rest * gy
        mz = share.separation * mz + rest * gz
    return fx, fy, mz


@compiled
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
        ux = forward
        uy = mirror * velocity.y - mirror * rail_motion[4 + 2 * hand]
        uz = velocity.z - rail_motion[5 + 2 * hand]
        ox = mirror * velocity.about_x
        oy = velocity.about_y
        oz = mirror * velocity.about_z
        for k in range(count):
            patch = patches[k]
            px, py, pz = patch.position[0], patch.position[1], patch.position[2]
            ny, nz = patch.normal[1], patch.normal[2]
            slip_x = ux + oy * pz - oz * py
            slip_y = uy + oz * px - ox * pz
            slip_z = uz + ox * py - oy * px
            closing = -(ny * slip_y + nz * slip_z)
            shares[k].damping = max(1.0 + options.damping * closing, 0.0)
            patch.creep_x = slip_x / speed
            patch.creep_y = (nz * slip_y - ny * slip_z) / speed
            patch.spin = (ny * oy + nz * oz) / speed
        for k in range(count):
            patch = patches[k]
            px, py, pz = patch.position[0], patch.position[1], patch.position[2]
            ny, nz = patch.normal[1], patch.normal[2]
            normal_force = patch.normal_force * shares[k].damping
            fx, fy, mz = _patch_creep(k, patches, shares, count, options)
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
            patch.fx = fx
            patch.fy = mirror * fy
            patch.mz = mirror * mz
        for k in range(count):
            # Only now, when no other patch of the side needs them any more.
            patch = patches[k]
            patch.normal_force *= shares[k].damping
            patch.peak_pressure = 1.5 * patch.normal_force / (math.pi * patch.a * patch.b)
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
