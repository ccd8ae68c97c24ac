"""Patches of one wheel by the stored energy: each load's wrench, ellipse and place.

The rails push the wheel along the lines of the grid that a load covers (gap.py), a wrench with
a force F in the y-z plane and a moment M about the axle's centre. It is that of |F| along n = F/|F|
at a point of its central axis and of a moment M.n about n, the load's twist: with yaw the lines of
a throat or flange patch lie at different leads and point different ways. The point is taken where
the axis passes the wheel at the load's middle.

While a second load in a lobe comes or goes (energy.py), patches of both sets are there, each with
the weight of its forces; what a weight below zero takes, the others' patches give.

Frame: track frame, left side. Records LOAD, SHARE, PATCH: layout.py.
"""

import math

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.gap import gap_on_normal, line_of_force, push_on_lines
from exudyn_wheelset.contact.gap_spline import line_weights
from exudyn_wheelset.contact.layout import GAP_ARC
from exudyn_wheelset.contact.loads import side_loads
from exudyn_wheelset.contact.locus import wheel_point


@compiled
def _wrench(table, side, load, axle, work, wrench):
    """Fill force (y, z) and moment of a load."""
    first, count = line_weights(load, side.line_start, 1.0 / side.line_spacing, work)
    parts = work.parts[0, :count]
    push_on_lines(table, side, first, parts, axle, work.gap, wrench)
    wrench *= load.force


@compiled
def _arc_in_the_middle(side, load, gap):
    """The wheel's arc length at the load's place."""
    at = (load.place - side.line_start) / side.line_spacing
    at = at if load.low < at < load.high else 0.5 * (load.low + load.high)
    k = int(at)
    arcs = gap[GAP_ARC]
    return arcs[k] + (at - k) * (arcs[k + 1] - arcs[k])


@compiled
def _fill_patch(table, side, load, arc, weight, wrench, axle, patch, share):
    fy, fz, mx, my, mz = wrench[0], wrench[1], wrench[2], wrench[3], wrench[4]
    square = fy * fy + fz * fz
    force = math.sqrt(square)
    ny = fy / force
    nz = fz / force
    _, py, pz, _, _, radius, wheel_y, _ = wheel_point(table, side, arc, axle)
    x = (fy * mz - fz * my) / square
    y = fz * mx / square
    z = -fy * mx / square
    along = ny * (py - axle.y - y) + nz * (pz - axle.z - z)
    rail_y, _, _, _, _, _ = curve_point(table, side.rail, load.place)
    patch.wheel_y = wheel_y
    patch.rail_y = rail_y - side.datum
    patch.angle = math.atan2(-ny, nz)
    patch.radius = radius
    patch.normal_force = force
    patch.twist = my * ny + mz * nz
    patch.a = load.a
    patch.b = weight * load.b
    patch.penetration = load.average + 0.2 * load.width
    patch.position[0] = x
    patch.position[1] = y + along * ny
    patch.position[2] = z + along * nz
    patch.normal[1] = ny
    patch.normal[2] = nz
    patch.energy = weight * load.force * max(load.average - load.work - 0.5 * load.sunk, 0.0)
    patch.peak_pressure = 1.5 * force / (math.pi * load.a * weight * load.b)
    share.own.force = force / weight
    share.own.a = load.a
    share.own.b = load.b
    share.separation = weight
    share.share = 0.0


@compiled
def _add_line(table, side, place, arc, axle, weight, wrench):
    fy, fz, mx, my, mz = line_of_force(table, side, place, arc, axle)
    wrench[0] += weight * fy
    wrench[1] += weight * fz
    wrench[2] += weight * mx
    wrench[3] += weight * my
    wrench[4] += weight * mz


@compiled
def load_patches(table, side, found, axle, material, work, patches):
    """Fill the patches of one side from its lobes; return their number."""
    if found == 0:
        return 0
    modulus = material.shear_modulus / (1.0 - material.poisson)
    energy, by_q = side_loads(table, side, found, axle, modulus, work)
    sets = work.sets
    wrench = work.wrenches[0]
    spare = work.wrenches[1]
    spare[:] = 0.0
    if by_q != 0.0:
        for k in range(3):
            line = work.merging[k]
            arc = line.arc
            for _ in range(2):
                _, _, _, arc = gap_on_normal(table, side, line.place, arc, axle)
            _add_line(table, side, line.place, arc, axle, by_q * line.weight, spare)
    share = 0.0
    for m in range(3):
        share += max(sets[m].weight, 0.0)
        if sets[m].weight < 0.0:
            for k in range(sets[m].count):
                _wrench(table, side, work.loads[m, k], axle, work, wrench)
                spare += sets[m].weight * wrench
    kept = 0
    total = 0.0
    for m in range(3):
        weight = sets[m].weight
        if weight <= 0.0:
            continue
        forces = 0.0
        for k in range(sets[m].count):
            forces += work.loads[m, k].force
        for k in range(sets[m].count):
            load = work.loads[m, k]
            _wrench(table, side, load, axle, work, wrench)
            arc = _arc_in_the_middle(side, load, work.gap)
            wrench *= weight
            wrench += weight / share * load.force / forces * spare
            _fill_patch(
                table, side, load, arc, weight / share, wrench, axle, patches[kept],
                work.shares[kept],
            )  # fmt: skip
            total += patches[kept].energy
            kept += 1
    # What the sum of weighted energies leaves of the whole, some thousandths, goes to all alike.
    for k in range(kept):
        patches[k].energy *= energy / total if total > 0.0 else 0.0
    return kept
