"""Creep force over the strips of a patch: FASTSIM on the outline and the pressure it really has.

Each strip has its own normal, its own lateral tangent and its own creepages, from the velocity of
the wheel's particle in the strip's middle: where the contact angle turns along the patch, so do
spin and lateral creepage. Within a strip
    dp_x/dx = xi_x/L,    dp_y/dx = (xi_y + phi x)/L
while it sticks, and |p| is held at mu times a parabola with the load of the strip's pressure,
(3 pi/8) p_0 (1 - (x/a)^2), as in creep/fastsim.py, whose step in slip is used. Strips are summed as
vectors. Flexibilities are those of the ellipse with the patch's load and second moments
(strip_patches.py) at its mean creepages; what the strip's longitudinal creepage has beyond the
mean is spin and has the flexibility of spin.

For one plane and an ellipse this is FASTSIM with strips of equal width.
Frame: track frame, left side.
"""

import math

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.creepage import creepage_at, direction
from exudyn_wheelset.contact.layout import Traction
from exudyn_wheelset.creep.fastsim import flexibilities, slip_step


@compiled(fastmath=AS_REAL_NUMBERS)
def march(rise_x, rise_y, turn_y, cells):
    """Sums over the cells of a strip of p_x, p_y and x p_y, in units of its bound and half length.

    rise_x, rise_y: traction gained over a cell by creepage while it sticks; turn_y: by spin at the
    leading edge.
    """
    step = 2.0 / cells
    change = turn_y * step
    p_x = -0.5 * rise_x
    p_y = -0.5 * (rise_y + turn_y * (1.0 - 0.25 * step))
    total_x = total_y = lever = rise = before = 0.0
    for cell in range(cells):
        x = 1.0 - (cell + 0.5) * step
        if cell > 0:
            rise = rise_y + turn_y * (x + 0.5 * step)
            p_x -= rise_x
            p_y -= rise
        free = 1.0 - step * step / 12.0 - x * x
        size = p_x * p_x + p_y * p_y
        if size > free * free:
            if turn_y == 0.0 or cell == 0:
                cut = free / math.sqrt(size)
                p_x *= cut
                p_y *= cut
            else:
                p_x, p_y = slip_step(p_x + rise_x, p_y + rise, rise_x, rise, change, before, free)
        total_x += p_x
        total_y += p_y
        lever += x * p_y
        before = free
    return total_x, total_y, lever


@compiled(fastmath=AS_REAL_NUMBERS)
def _patch_flexibilities(share, patch, parameters):
    """Flexibilities of the patch's ellipse, blended with the merged one's while lobes merge."""
    limit = patch.friction * share.damping
    kind = parameters.law_parameters[2]
    soft_x, soft_y, soft_spin = flexibilities(
        patch.creep_x, patch.creep_y, patch.spin, share.own.a, share.own.b,
        limit * share.own.force, parameters.shear_modulus, parameters.poisson, kind,
    )  # fmt: skip
    if share.separation < 1.0:
        other_x, other_y, other_spin = flexibilities(
            patch.creep_x, patch.creep_y, patch.spin, share.merged.a, share.merged.b,
            limit * share.merged.force, parameters.shear_modulus, parameters.poisson, kind,
        )  # fmt: skip
        soft_x = other_x + share.separation * (soft_x - other_x)
        soft_y = other_y + share.separation * (soft_y - other_y)
        soft_spin = other_spin + share.separation * (soft_spin - other_spin)
    return soft_x, soft_y, soft_spin


@compiled(fastmath=AS_REAL_NUMBERS)
def strip_traction(strips, share, patch, slip, parameters):
    """Creep force of a patch over its strips, about its position, in its triad (Traction)."""
    x = y = z = moment_x = moment_y = moment_z = 0.0
    soft_x, soft_y, soft_spin = _patch_flexibilities(share, patch, parameters)
    ny, nz = patch.normal[1], patch.normal[2]
    cells = int(parameters.law_parameters[0])
    limit = patch.friction * share.damping * 0.375 * math.pi
    if soft_x == 0.0 or limit <= 0.0:
        return Traction(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for k in range(share.first_strip, share.first_strip + share.strip_count):
        strip = strips[k]
        bound = limit * strip.pressure
        if bound <= 0.0:
            continue
        creepage = creepage_at(slip, strip.x, strip.y, strip.z, strip.normal_y, strip.normal_z)
        a = strip.half_length
        cell = 2.0 * a / cells
        unit = cell / bound
        mean_x = patch.creep_x / soft_x + (creepage.x - patch.creep_x) / soft_spin
        px, pt, lever = march(
            unit * mean_x, unit * creepage.y / soft_y, unit * creepage.spin * a / soft_spin, cells
        )
        area = bound * cell * strip.width
        fx = area * px
        fy = area * pt * strip.normal_z
        fz = -area * pt * strip.normal_y
        spin_moment = direction(slip) * area * lever * a
        dx = strip.x - patch.position[0]
        dy = strip.y - patch.position[1]
        dz = strip.z - patch.position[2]
        x += fx
        y += fy
        z += fz
        moment_x += dy * fz - dz * fy
        moment_y += dz * fx - dx * fz + spin_moment * strip.normal_y
        moment_z += dx * fy - dy * fx + spin_moment * strip.normal_z
    return Traction(
        x, nz * y - ny * z, ny * y + nz * z,
        moment_x, nz * moment_y - ny * moment_z, ny * moment_y + nz * moment_z,
    )  # fmt: skip
