"""FASTSIM marched as Kalker 1982 has it, one strip after the other: slow and plain.

Equations and signs: exudyn_wheelset/creep/fastsim.py.
"""

import math

import numba
from numpy.typing import NDArray

from exudyn_wheelset.creep.fastsim import LARGEST, flexibilities, slip_step
from exudyn_wheelset.creep.saturation import LEAST_FRICTION_FORCE, bounded


@numba.njit(error_model="numpy")
def fastsim(
    creep_x: float,
    creep_y: float,
    spin: float,
    a: float,
    b: float,
    normal_force: float,
    friction: float,
    shear_modulus: float,
    poisson: float,
    parameters: NDArray,
) -> tuple[float, float, float]:
    """Give (F_x, F_y, M_z) on the wheel by FASTSIM.

    parameters: [cells_along, cells_across, flexibilities].
    """
    limit = friction * normal_force
    if not (limit > LEAST_FRICTION_FORCE and a > 0.0 and b > 0.0):
        return 0.0, 0.0, 0.0
    creep_x, creep_y, spin = bounded(creep_x), bounded(creep_y), bounded(spin)
    soft_x, soft_y, soft_spin = flexibilities(
        creep_x, creep_y, spin, a, b, limit, shear_modulus, poisson, parameters[2]
    )
    if soft_x == 0.0:
        return 0.0, 0.0, 0.0

    # tractions in units of the bound at the middle of their strip; x and y in units of a and b
    cells = int(parameters[0])
    strips = int(parameters[1])
    bound = 2.0 * limit / (math.pi * a * b)
    step = 2.0 / cells
    to_traction = a * step / bound
    slip_x = creep_x / soft_x * to_traction
    slip_y = creep_y / soft_y * to_traction
    turn_x = spin * b / soft_spin * to_traction
    turn_y = spin * a / soft_spin * to_traction
    # beyond LARGEST all slides, in a direction that keeps when all slips are scaled down together
    largest = max(abs(slip_x), abs(slip_y), abs(turn_x), abs(turn_y))
    if largest > LARGEST:
        scale = LARGEST / largest
        slip_x *= scale
        slip_y *= scale
        turn_x *= scale
        turn_y *= scale
    change = turn_y * step
    cell_bound = 1.0 - step * step / 12.0
    sum_x = sum_y = moment_x = moment_y = 0.0
    angle = math.pi / strips
    for strip in range((strips + 1) // 2):
        theta = angle * (strip + 0.5)
        edge = math.sin(theta)
        offset = math.cos(theta)
        if 2 * strip + 1 == strips:
            offset = 0.0
        rise_1x = (slip_x - turn_x * offset) / edge
        rise_2x = (slip_x + turn_x * offset) / edge
        rise_y = slip_y / edge
        # half a step leads from the edge to the middle of the first cell
        p1x = -0.5 * rise_1x
        p2x = -0.5 * rise_2x
        entry = -0.5 * (rise_y + turn_y * (1.0 - 0.25 * step))
        p1y = p2y = entry
        total_1x = total_2x = total_1y = total_2y = lever_1 = lever_2 = 0.0
        rise = before = 0.0
        for cell in range(cells):
            x = 1.0 - (cell + 0.5) * step
            if cell > 0:
                rise = rise_y + turn_y * (x + 0.5 * step)
                p1x -= rise_1x
                p2x -= rise_2x
                p1y -= rise
                p2y -= rise
            free = cell_bound - x * x
            size_1 = p1x * p1x + p1y * p1y
            size_2 = p2x * p2x + p2y * p2y
            if size_1 > free * free:
                if spin == 0.0 or cell == 0:
                    cut = free / math.sqrt(size_1)
                    p1x *= cut
                    p1y *= cut
                else:
                    p1x, p1y = slip_step(
                        p1x + rise_1x, p1y + rise, rise_1x, rise, change, before, free
                    )
            if size_2 > free * free:
                if spin == 0.0 or cell == 0:
                    cut = free / math.sqrt(size_2)
                    p2x *= cut
                    p2y *= cut
                else:
                    p2x, p2y = slip_step(
                        p2x + rise_2x, p2y + rise, rise_2x, rise, change, before, free
                    )
            total_1x += p1x
            total_2x += p2x
            total_1y += p1y
            total_2y += p2y
            lever_1 += x * p1y
            lever_2 += x * p2y
            before = free
        # bound ~ edge^2, cell length ~ edge, strip width ~ edge
        weight = edge * edge * edge * edge
        if 2 * strip + 1 == strips:
            weight *= 0.5
        sum_x += weight * (total_1x + total_2x)
        sum_y += weight * (total_1y + total_2y)
        moment_x += weight * offset * (total_1x - total_2x)
        moment_y += weight * edge * (lever_1 + lever_2)
    # mu p_0 a b step angle; the last rounding must not carry the force over its limit
    unit = 2.0 / math.pi * limit * step * angle
    force_x = unit * sum_x
    force_y = unit * sum_y
    total = math.sqrt(force_x * force_x + force_y * force_y)
    if total > limit:
        force_x *= limit / total
        force_y *= limit / total
    return force_x, force_y, unit * (a * moment_y - b * moment_x)
