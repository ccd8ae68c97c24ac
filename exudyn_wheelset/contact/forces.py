"""Forces of the rails on a wheelset: patches, normal force, creepages and creep force.

For each patch, in the triad (x along the track, lateral tangent, normal n from rail into wheel):
- normal force N = N_Hertz(delta) (1 + damping delta') >= 0, a dissipative term that vanishes with
  the penetration (Hunt and Crossley 1975), delta' = -n.v;
- creepages from the exact velocity of the wheel's particle at the contact point (creepage.py);
- creep force by the chosen law with the patch's friction (friction.py); wrench about the
  wheelset's centre in the track frame.
V is the forward speed over the rails.

Rails: shape and velocity are two things. A rail of lateral and vertical shift y(s), z(s) at the
wheelset's station has the direction t = (1, y', z')/|.| and, crooked as it may be, is at rest. All
above is done in axes that follow it,
    e_x = t,   e_y = (-y', 1, 0)/|.|,   e_z = e_x x e_y,
about the point (0, y, z), where its profile stands as on straight track: positions, axle and
velocities are turned into them, forces back. So two rails of one slope are straight track turned by
it. The gap closes at n.v, v the velocity of the wheel's particle over the rail's material and n
across the rail: a wheelset that runs straight ahead touches a sloping rail at a lead, where its
particles go down as fast as the rail comes nearer, so that no rate of the shape need be told.
Creepages are v/V in the same axes. Of a wheelset with the yaw psi in the track frame the lateral
one is y_w'/V - psi, whatever the slope; V y' taken for a velocity of the rail would add -y'. Only
rails that move (elastic ones, a shaker's) have velocities, along e_y and e_z.

Patches and their elastic normal forces come from patches.py, by the energy and by strips from what
is compiled apart (sides_apart.py). With strips, FASTSIM runs over them (strip_creep.py); the other
laws take the ellipse with their load and second moments.

The right side is computed as the left side of the mirrored wheelset and mirrored back, so mirror
symmetry holds to rounding. Records and named tuples: layout.py.
"""

import math

from exudyn_wheelset.addresses import numbers_at
from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.creepage import creepage_at, direction, slip_velocity
from exudyn_wheelset.contact.friction import patch_friction
from exudyn_wheelset.contact.layout import (
    ENERGY,
    PARAMETER_COUNT,
    PARAMETERS,
    RAIL_MOTION,
    RESULT,
    RESULT_SIZE,
    RITZ,
    STRIPS,
    Axle,
    Creepage,
    Slip,
    Traction,
    Velocity,
    side_of,
)
from exudyn_wheelset.contact.patches import side_patches
from exudyn_wheelset.contact.sides_apart import ENERGY_SIDE, RITZ_SIDE, STRIP_SIDE, STRIP_TRACTION
from exudyn_wheelset.creep.fastsim import LAW as FASTSIM
from exudyn_wheelset.creep.kernel_apart import creep_kernel

# Below this forward speed creepage is formed with it, to stay finite at rest.
LEAST_SPEED = 0.1
_FASTSIM = FASTSIM.number
_ritz_side = RITZ_SIDE.call
_energy_side = ENERGY_SIDE.call
_strip_side = STRIP_SIDE.call
_strip_traction = STRIP_TRACTION.call


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _law_force(creepage, ellipse, damping, friction, parameters):
    """Creep force (F_x, F_y, M_z) of the chosen law on an ELLIPSE under a damped normal force."""
    return creep_kernel(
        int(parameters.law), creepage.x, creepage.y, creepage.spin, ellipse.a, ellipse.b,
        damping * ellipse.force, friction, parameters.shear_modulus, parameters.poisson,
        parameters.law_parameters,
    )  # fmt: skip


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _patch_creep(k, patches, shares, count, parameters):
    """Creep force of patch k of a side."""
    fx = 0.0
    fy = 0.0
    mz = 0.0
    share = shares[k]
    if share.damping <= 0.0:
        return fx, fy, mz
    creepage = Creepage(patches[k].creep_x, patches[k].creep_y, patches[k].spin)
    friction = patches[k].friction
    if share.separation > 0.0:
        fx, fy, mz = _law_force(creepage, share.own, share.damping, friction, parameters)
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
                    creepage.x + rest * (patches[j].creep_x - creepage.x) + share.faster,
                    creepage.y + rest * (patches[j].creep_y - creepage.y),
                    creepage.spin + rest * (patches[j].spin - creepage.spin),
                )
        gx, gy, gz = _law_force(creepage, share.merged, share.damping, friction, parameters)
        rest = (1.0 - share.separation) * share.share
        fx += rest * gx
        fy += rest * gy
        mz += rest * gz
    return fx, fy, mz


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _side(table, hand, axle, parameters, options, result, out):
    """Fill the patches of one side and their count."""
    if options.normal == RITZ:
        _ritz_side((
            table.ctypes.data, table.size, hand, parameters.ctypes.data, result.ctypes.data,
            axle.y, axle.z, axle.lx, axle.ly, axle.lz,
        ))  # fmt: skip
    elif options.normal == ENERGY:
        _energy_side((
            table.ctypes.data, table.size, hand, parameters.ctypes.data, result.ctypes.data,
            axle.y, axle.z, axle.lx, axle.ly, axle.lz,
        ))  # fmt: skip
    elif options.normal == STRIPS:
        _strip_side((
            table.ctypes.data, table.size, hand, parameters.ctypes.data, result.ctypes.data,
            axle.y, axle.z, axle.lx, axle.ly, axle.lz,
        ))  # fmt: skip
    else:
        out.count[hand] = side_patches(table, hand, axle, options, out.work, out.patches[hand])


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _axes_along(slope_y, slope_z):
    """Axes e_x, e_y, e_z (nine numbers) that follow a rail of these slopes [-]."""
    across = 1.0 / math.sqrt(1.0 + slope_y * slope_y)
    along = 1.0 / math.sqrt(1.0 + slope_y * slope_y + slope_z * slope_z)
    xx, xy, xz = along, along * slope_y, along * slope_z
    yx, yy = -across * slope_y, across
    return xx, xy, xz, yx, yy, 0.0, -xz * yy, xz * yx, xx * yy - xy * yx


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _into(a, x, y, z):
    """Components in axes a (nine numbers)."""
    return (
        a[0] * x + a[1] * y + a[2] * z,
        a[3] * x + a[4] * y + a[5] * z,
        a[6] * x + a[7] * y + a[8] * z,
    )


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _out_of(a, x, y, z):
    """Components in the track frame of what is given in axes a."""
    return (
        a[0] * x + a[3] * y + a[6] * z,
        a[1] * x + a[4] * y + a[7] * z,
        a[2] * x + a[5] * y + a[8] * z,
    )


@compiled(fastmath=AS_REAL_NUMBERS)
def _wheelset_forces(table, axle, velocity, rail_motion, parameters, result):
    options = parameters.view(PARAMETERS)[0]
    out = result.view(RESULT)[0]
    shares = out.work.shares
    forward = velocity.x + options.rail_speed
    height = side_of(table, 0).radius + axle.z
    over_strips = options.normal == STRIPS and int(options.law) == _FASTSIM
    force_x = force_y = force_z = moment_x = moment_y = moment_z = 0.0
    for hand in range(2):
        mirror = 1.0 - 2.0 * hand
        patches = out.patches[hand]
        slope_y, slope_z = rail_motion[8 + 2 * hand], rail_motion[9 + 2 * hand]
        sloping = slope_y != 0.0 or slope_z != 0.0
        y, z = axle.y - rail_motion[2 * hand], height - rail_motion[2 * hand + 1]
        lx, ly, lz = axle.lx, axle.ly, axle.lz
        vx, vy, vz = forward, velocity.y, velocity.z
        wx, wy, wz = velocity.about_x, velocity.about_y, velocity.about_z
        axes = _axes_along(slope_y, slope_z)
        if sloping:
            _, y, z = _into(axes, 0.0, y, z)
            lx, ly, lz = _into(axes, lx, ly, lz)
            vx, vy, vz = _into(axes, vx, vy, vz)
            wx, wy, wz = _into(axes, wx, wy, wz)
        mirrored = Axle(mirror * y, z, mirror * lx, ly, mirror * lz)
        _side(table, hand, mirrored, parameters, options, result, out)
        count = out.count[hand]
        slip = Slip(
            vx, mirror * vy - mirror * rail_motion[4 + 2 * hand], vz - rail_motion[5 + 2 * hand],
            mirror * wx, wy, mirror * wz, max(abs(vx), LEAST_SPEED),
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
            slipping = slip.speed * math.hypot(patch.creep_x, patch.creep_y)
            patch.friction = patch_friction(options, hand, patch.angle, slipping)
            faster = slip.about_y * shares[k].shift_z - slip.about_z * shares[k].shift_y
            shares[k].faster = faster / slip.speed
        for k in range(count):
            patch = patches[k]
            px, py, pz = patch.position[0], patch.position[1], patch.position[2]
            ny, nz = patch.normal[1], patch.normal[2]
            if over_strips:
                fx, gy, gz, mx, my, mz = _strip_traction((
                    parameters.ctypes.data, result.ctypes.data, hand, k, slip.x, slip.y, slip.z,
                    slip.about_x, slip.about_y, slip.about_z, slip.speed,
                ))  # fmt: skip
                creep = Traction(fx, gy, gz, mx, my, mz)
            else:
                fx, fy, mz = _patch_creep(k, patches, shares, count, options)
                creep = Traction(fx, fy, 0.0, 0.0, 0.0, direction(slip) * mz)
            along_normal = patch.normal_force * shares[k].damping + creep.normal
            gy = nz * creep.lateral + ny * along_normal
            gz = -ny * creep.lateral + nz * along_normal
            patch.twist *= shares[k].damping
            about = creep.moment_normal + patch.twist
            my = about * ny + creep.moment_lateral * nz
            mz = about * nz - creep.moment_lateral * ny
            fx, fy, fz = creep.x, mirror * gy, gz
            mx = mirror * (creep.moment_x + py * gz - pz * gy)
            my += pz * creep.x - px * gz
            mz = mirror * (mz + (px * gy - py * creep.x))
            if sloping:
                fx, fy, fz = _out_of(axes, fx, fy, fz)
                mx, my, mz = _out_of(axes, mx, my, mz)
            force_x += fx
            force_y += fy
            force_z += fz
            moment_x += mx
            moment_y += my
            moment_z += mz
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


def forces_at(
    table, size, rail_motion, parameters, result, y, z, lx, ly, lz, vx, vy, vz, wx, wy, wz
):  # fmt: skip
    """As `wheelset_forces` of forces_apart.py, arrays by their addresses."""
    _wheelset_forces(
        numbers_at(table, size), Axle(y, z, lx, ly, lz), Velocity(vx, vy, vz, wx, wy, wz),
        numbers_at(rail_motion, RAIL_MOTION), numbers_at(parameters, PARAMETER_COUNT),
        numbers_at(result, RESULT_SIZE),
    )  # fmt: skip
