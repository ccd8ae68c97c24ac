"""Forces of elastic rails on a wheelset, with the rates at which the rails give way.

For each rail, laterally and vertically (along e_y and e_z of contact/forces.py), with its shift d
and the force -F of the wheel on it, its rate r = d' is the root of
    g(r) = c r + k d + F(d, r) = 0.
Where the wheel touches, and how deep, depends on d alone: patches are searched for once, and only
creepages, contact damping and creep forces are computed anew, as in contact/forces.py. The root is
found by Broyden's method, J <- J + g dr^T/|dr|^2, from the rate and the slope J = dg/dr of the
evaluation before; where that converges badly, slopes are taken by differences.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_wheelset.addresses import numbers_at
from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.creepage import creepage_at, direction, slip_velocity
from exudyn_wheelset.contact.forces import (
    LEAST_SPEED,
    _axes_along,
    _into,
    _out_of,
    _patch_creep,
    _side,
    _strip_traction,
)
from exudyn_wheelset.contact.friction import patch_friction
from exudyn_wheelset.contact.layout import (
    MOST_PATCHES,
    PARAMETER_COUNT,
    PARAMETERS,
    RAIL_MOTION,
    RESULT,
    RESULT_SIZE,
    STRIPS,
    Axle,
    Slip,
    side_of,
)
from exudyn_wheelset.creep.fastsim import LAW as FASTSIM

_FASTSIM = FASTSIM.number
# Rates [m/s] for the differences: small against a creep of 1e-4 at walking speed, large against
# rounding.
_RATE_STEP = 1.0e-6
# What may be left of g [N]: 1e-11 of a wheel load, so that a difference over 1e-9 m, a newton, is
# exact to 1e-6.
_LEFT = 1.0e-6
_MOST_STEPS = 20
# A step that leaves more of g than this asks for new slopes.
_POOR = 0.2


@compiled(fastmath=AS_REAL_NUMBERS)
def _slip_of_side(hand, slip, rate_y, rate_z, parameters, options, result, out, tractions):
    """Lateral and vertical force [N] on one wheel, mirrored, at these rates of its rail.

    slip: over a rail at rest; fills what in patches, shares and tractions (patches, 6) depends on
    rates, but leaves normal forces and twists as they are without damping.
    """
    patches, shares, count = out.patches[hand], out.work.shares, out.count[hand]
    slip = Slip(
        slip.x, slip.y - rate_y, slip.z - rate_z, slip.about_x, slip.about_y, slip.about_z,
        slip.speed,
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
    lateral = vertical = 0.0
    over_strips = options.normal == STRIPS and int(options.law) == _FASTSIM
    for k in range(count):
        patch, traction = patches[k], tractions[k]
        if over_strips:
            fx, fy, fz, mx, my, mz = _strip_traction((
                parameters.ctypes.data, result.ctypes.data, hand, k, slip.x, slip.y, slip.z,
                slip.about_x, slip.about_y, slip.about_z, slip.speed,
            ))  # fmt: skip
            traction[2], traction[3], traction[4] = fz, mx, my
        else:
            fx, fy, mz = _patch_creep(k, patches, shares, count, options)
            mz *= direction(slip)
        traction[0], traction[1], traction[5] = fx, fy, mz
        ny, nz = patch.normal[1], patch.normal[2]
        along_normal = patch.normal_force * shares[k].damping + traction[2]
        lateral += nz * fy + ny * along_normal
        vertical += nz * along_normal - ny * fy
    return lateral, vertical


@compiled(fastmath=AS_REAL_NUMBERS)
def _add_wrench(hand, axes, sloping, out, tractions):
    """Add the wrench of a side at its rates to that of the wheelset, and mirror its patches."""
    mirror = 1.0 - 2.0 * hand
    for k in range(out.count[hand]):
        patch, traction = out.patches[hand, k], tractions[k]
        damping = out.work.shares[k].damping
        px, py, pz = patch.position[0], patch.position[1], patch.position[2]
        ny, nz = patch.normal[1], patch.normal[2]
        patch.normal_force *= damping
        patch.peak_pressure *= damping
        patch.twist *= damping
        along_normal = patch.normal_force + traction[2]
        gy = nz * traction[1] + ny * along_normal
        gz = nz * along_normal - ny * traction[1]
        about = traction[5] + patch.twist
        fx, fy, fz = traction[0], mirror * gy, gz
        mx = mirror * (traction[3] + py * gz - pz * gy)
        my = about * ny + traction[4] * nz + pz * traction[0] - px * gz
        mz = mirror * (about * nz - traction[4] * ny + px * gy - py * traction[0])
        if sloping:
            fx, fy, fz = _out_of(axes, fx, fy, fz)
            mx, my, mz = _out_of(axes, mx, my, mz)
        out.force[0] += fx
        out.force[1] += fy
        out.force[2] += fz
        out.moment[0] += mx
        out.moment[1] += my
        out.moment[2] += mz
        patch.fx = traction[0]
        patch.fy = mirror * traction[1]
        patch.mz = mirror * traction[5]
        patch.creep_y *= mirror
        patch.spin *= mirror
        patch.position[1] *= mirror
        patch.normal[1] *= mirror


def elastic_at(
    table, size, rail_motion, parameters, result, elasticity, shifts, rates, slopes,
    y, z, lx, ly, lz, vx, vy, vz, wx, wy, wz,
):  # fmt: skip
    """As `elastic_forces` of elastic_apart.py, arrays by their addresses."""
    table = numbers_at(table, size)
    track = numbers_at(rail_motion, RAIL_MOTION)
    parameters = numbers_at(parameters, PARAMETER_COUNT)
    result = numbers_at(result, RESULT_SIZE)
    elasticity = numbers_at(elasticity, 4)
    shifts, rates, slopes = numbers_at(shifts, 4), numbers_at(rates, 4), numbers_at(slopes, 8)
    options = parameters.view(PARAMETERS)[0]
    out = result.view(RESULT)[0]
    tractions = np.zeros((MOST_PATCHES, 6))
    out.force[:] = 0.0
    out.moment[:] = 0.0
    cy, cz = elasticity[2], elasticity[3]
    for hand in range(2):
        mirror = 1.0 - 2.0 * hand
        slope_y, slope_z = track[8 + 2 * hand], track[9 + 2 * hand]
        sloping = slope_y != 0.0 or slope_z != 0.0
        i, j = 2 * hand, 2 * hand + 1
        hy, hz = y - track[i] - shifts[i], side_of(table, 0).radius + z - track[j] - shifts[j]
        ax, ay, az = lx, ly, lz
        ux, uy, uz = vx + options.rail_speed, vy, vz
        ox, oy, oz = wx, wy, wz
        axes = _axes_along(slope_y, slope_z)
        if sloping:
            _, hy, hz = _into(axes, 0.0, hy, hz)
            ax, ay, az = _into(axes, ax, ay, az)
            ux, uy, uz = _into(axes, ux, uy, uz)
            ox, oy, oz = _into(axes, ox, oy, oz)
        axle = Axle(mirror * hy, hz, mirror * ax, ay, mirror * az)
        _side(table, hand, axle, parameters, options, result, out)
        slip = Slip(
            ux, mirror * (uy - track[4 + i]), uz - track[4 + j], mirror * ox, oy, mirror * oz,
            max(abs(ux), LEAST_SPEED),
        )  # fmt: skip
        ky, kz = mirror * elasticity[0] * shifts[i], elasticity[1] * shifts[j]
        ry, rz = mirror * rates[i], rates[j]
        slope = slopes[4 * hand : 4 * hand + 4]
        if not (math.isfinite(ry) and math.isfinite(rz)):
            ry = rz = 0.0
            slope[0] = 0.0
        before = np.inf
        dy = dz = 0.0
        for step in range(_MOST_STEPS):
            fy, fz = _slip_of_side(hand, slip, ry, rz, parameters, options, result, out, tractions)
            gy, gz = cy * ry + ky + fy, cz * rz + kz + fz
            left = max(abs(gy), abs(gz))
            if left < _LEFT or not left < np.inf:
                break
            if step > 0:
                scale = 1.0 / (dy * dy + dz * dz)
                slope[0] += gy * dy * scale
                slope[1] += gy * dz * scale
                slope[2] += gz * dy * scale
                slope[3] += gz * dz * scale
            determinant = slope[0] * slope[3] - slope[1] * slope[2]
            # Contact and creep damp a rail, or nearly.
            if not determinant > 0.5 * cy * cz or slope[0] <= 0.0 or left > _POOR * before:
                py, pz = _slip_of_side(
                    hand, slip, ry + _RATE_STEP, rz, parameters, options, result, out, tractions
                )
                qy, qz = _slip_of_side(
                    hand, slip, ry, rz + _RATE_STEP, parameters, options, result, out, tractions
                )
                slope[0], slope[2] = cy + (py - fy) / _RATE_STEP, (pz - fz) / _RATE_STEP
                slope[1], slope[3] = (qy - fy) / _RATE_STEP, cz + (qz - fz) / _RATE_STEP
                determinant = slope[0] * slope[3] - slope[1] * slope[2]
            before = left
            dy = (slope[1] * gz - slope[3] * gy) / determinant
            dz = (slope[2] * gy - slope[0] * gz) / determinant
            ry += dy
            rz += dz
        rates[i], rates[j] = mirror * ry, rz
        _add_wrench(hand, axes, sloping, out, tractions)
