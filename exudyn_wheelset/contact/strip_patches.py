"""Patches of one wheel from strips: what the sums over their strips are as forces and ellipses.

One patch a lobe, or one for two lobes that have merged wholly. With q = pi/2 a p the load of a
strip per width, its force acts along its own normal: the patch's normal force is the vector sum
(smaller than the sum of q where the normals fan out), its place the point on the mean surface about
which the strips' forces have no moment about x.

Creep laws that know ellipses only get the one with the same load and the same second moments: for
Hertz's ellipse the load's mean of a^2 is 4/5 of its square semi-axis, and its variance across is
b^2/5. Lobes that merge share such an ellipse as in patches.py, so that creep forces are continuous.
The normal force needs no such blend.

Frame: track frame, left side. Records: layout.py.
"""

import math

import numpy as np

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.layout import STRIPS_A_LOBE, Ellipse, Material
from exudyn_wheelset.contact.locus import wheel_point
from exudyn_wheelset.contact.search import find_lobes
from exudyn_wheelset.contact.strips import solve_strips

LOAD, ARC, ARC_SQUARE, FOOT, LENGTH_SQUARE, PEAK, ENERGY = range(7)


@compiled(fastmath=AS_REAL_NUMBERS)
def _load_moments(strips, sums):
    """Fill sums: load [N], its moments of arc, arc^2, foot, a^2, peak pressure [Pa], energy [J]."""
    sums[:] = 0.0
    for k in range(len(strips)):
        strip = strips[k]
        a = strip.half_length
        load = 0.5 * math.pi * a * strip.pressure * strip.width
        sums[LOAD] += load
        sums[ARC] += load * strip.arc
        sums[ARC_SQUARE] += load * (strip.arc * strip.arc + strip.width * strip.width / 12.0)
        sums[FOOT] += load * strip.foot
        sums[LENGTH_SQUARE] += load * a * a
        sums[PEAK] = max(sums[PEAK], strip.pressure)
        # Half the work of the pressure on the depth P - A x^2; the load's mean of x^2 is a^2/4.
        sums[ENERGY] += 0.5 * load * (strip.depth - 0.25 * strip.curvature * a * a)


@compiled(fastmath=AS_REAL_NUMBERS)
def _ellipse_of(sums):
    """Ellipse with the load and its second moments."""
    load = sums[LOAD]
    mean = sums[ARC] / load
    variance = max(sums[ARC_SQUARE] / load - mean * mean, 1.0e-12)
    return Ellipse(load, math.sqrt(1.25 * sums[LENGTH_SQUARE] / load), math.sqrt(5.0 * variance))


@compiled(fastmath=AS_REAL_NUMBERS)
def _fill_patch(table, side, strips, sums, axle, patch):
    """Resultant of the strips, its place and normal."""
    force_y = force_z = moment_x = moment_lead = mean_y = mean_z = 0.0
    for k in range(len(strips)):
        strip = strips[k]
        load = 0.5 * math.pi * strip.half_length * strip.pressure * strip.width
        fy, fz = load * strip.normal_y, load * strip.normal_z
        force_y += fy
        force_z += fz
        moment_x += strip.y * fz - strip.z * fy
        moment_lead += strip.x * load
        mean_y += load * strip.y
        mean_z += load * strip.z
    load = sums[LOAD]
    force = math.sqrt(force_y * force_y + force_z * force_z)
    ny, nz = force_y / force, force_z / force
    y, z = mean_y / load, mean_z / load
    along = (moment_x - (y * force_z - z * force_y)) / force
    arc = sums[ARC] / load
    _, _, _, _, _, radius, wheel_y, _ = wheel_point(table, side, arc, axle)
    patch.wheel_y = wheel_y
    patch.rail_y = curve_point(table, side.rail, sums[FOOT] / load)[0] - side.datum
    patch.angle = math.atan2(-ny, nz)
    patch.radius = radius
    patch.normal_force = force
    patch.position[0] = moment_lead / load
    patch.position[1] = y + along * nz
    patch.position[2] = z - along * ny
    patch.normal[1] = ny
    patch.normal[2] = nz
    patch.peak_pressure = sums[PEAK]
    patch.energy = sums[ENERGY]
    patch.twist = 0.0


@compiled(fastmath=AS_REAL_NUMBERS)
def strip_patches(table, side, axle, parameters, work, patches):
    """Normal contact of one side by strips: fills patches, shares and strips; their count."""
    lobes = work.lobes
    strips = work.strips
    count = find_lobes(table, side, axle, work)
    if count == 0:
        return 0
    material = Material(parameters.shear_modulus, parameters.poisson)
    solve_strips(table, side, lobes, count, strips, material, axle)
    sums = np.empty((count + 1, 7))
    for k in range(count):
        _load_moments(strips[k * STRIPS_A_LOBE : (k + 1) * STRIPS_A_LOBE], sums[k])
    one_patch = count == 2 and lobes[0].separation == 0.0
    kept = 0
    for k in range(1 if one_patch else count):
        span = 2 if one_patch else 1
        first, last = k * STRIPS_A_LOBE, (k + span) * STRIPS_A_LOBE
        own = sums[k]
        if one_patch:
            own = sums[count]
            _load_moments(strips[first:last], own)
        if own[LOAD] <= 0.0:
            continue
        share = work.shares[kept]
        share.lobe = k
        share.first_strip = first
        share.strip_count = last - first
        ellipse = _ellipse_of(own)
        share.own.force = ellipse.force
        share.own.a = ellipse.a
        share.own.b = ellipse.b
        share.separation = 1.0
        share.partner = -1
        share.shift_y = share.shift_z = 0.0
        patch = patches[kept]
        patch.a = ellipse.a
        patch.b = ellipse.b
        patch.penetration = lobes[k].penetration
        if not one_patch:
            separation = lobes[k].separation
            partner = k + 1
            if k > 0 and lobes[k - 1].separation < separation:
                separation = lobes[k - 1].separation
                partner = k - 1
            if separation < 1.0 and sums[partner, LOAD] > 0.0:
                low = min(k, partner) * STRIPS_A_LOBE
                _load_moments(strips[low : low + 2 * STRIPS_A_LOBE], sums[count])
                merged = _ellipse_of(sums[count])
                share.merged.force = merged.force
                share.merged.a = merged.a
                share.merged.b = merged.b
                share.separation = separation
                share.partner = partner
                share.share = own[LOAD] / merged.force
        else:
            patch.penetration = max(lobes[0].penetration, lobes[1].penetration)
        _fill_patch(table, side, strips[first:last], own, axle, patch)
        kept += 1
    return kept
