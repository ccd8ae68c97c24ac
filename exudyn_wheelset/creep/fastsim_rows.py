"""FASTSIM's march with all strips abreast: what creep laws are called with.

The numbers are those of one strip after the other (tests/fastsim_strip_by_strip.py), to
rounding (1e-14 of the friction force in wheel contacts, 1e-9 where traction hardly turns). A cell
that slips costs six divisions, three roots and an exponential, each waiting for the one before;
cells side by side wait for nothing, so that the processor does several at once: a patch that slips
all over takes half the time. Where few cells of a row slip, they are taken one by one.

Strips +y stand first, those of -y after them, each beside its own mirror image in the sums, and
all are computed alike, so mirrored input gives mirrored output bit by bit.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.fastsim import LARGEST, flexibilities, slip_step
from exudyn_wheelset.creep.saturation import LEAST_FRICTION_FORCE, bounded

# Rows of the work: traction, what creepage adds to it over a cell, sums over the cells of traction
# and x p_y, |p|^2; of the strips +y the half length and the place in units of a and b; whether a
# strip is none of the copies.
P_X, P_Y, RISE_X, RISE_Y, TOTAL_X, TOTAL_Y, LEVER, SQUARE, EDGE, OFFSET, OWN = range(11)
# Strips are made up to a multiple of it by copies, which weigh nothing.
_ABREAST = 8
# As many slipping cells of a row are cheaper one by one (measured: 27 ns each, 150 ns for the row).
_FEW = 4


@compiled(inline="always")
def _decay(turn):
    """exp(-turn) to 1e-14 for 0 to 20, in operations that go abreast: Taylor's sum of turn/32."""
    u = -turn / 32.0
    value = 1.0 + u / 12.0
    value = 1.0 + u / 11.0 * value
    value = 1.0 + u / 10.0 * value
    value = 1.0 + u / 9.0 * value
    value = 1.0 + u / 8.0 * value
    value = 1.0 + u / 7.0 * value
    value = 1.0 + u / 6.0 * value
    value = 1.0 + u / 5.0 * value
    value = 1.0 + u / 4.0 * value
    value = 1.0 + u / 3.0 * value
    value = 1.0 + u / 2.0 * value
    value = 1.0 + u * value
    value *= value
    value *= value
    value *= value
    value *= value
    return value * value


@compiled
def _stick(p_x, p_y, rise_x, rise_y, square, own, shift, free_square):
    """Take a row one cell on, sticking; shift: what spin adds to rise_y. How many of the strips
    exceed |p|^2; their copies do not count, for a mirrored patch has copies of another strip."""
    count = 0
    for k in range(p_x.shape[0]):
        p_x[k] -= rise_x[k]
        p_y[k] -= rise_y[k] + shift
        square[k] = p_x[k] * p_x[k] + p_y[k] * p_y[k]
        count += own[k] * square[k] > free_square
    return count


@compiled
def _cut(p_x, p_y, square, bound):
    """Cut a row back to the bound, each |p| in its direction."""
    for k in range(p_x.shape[0]):
        cut = bound / math.sqrt(max(square[k], bound * bound))
        p_x[k] *= cut
        p_y[k] *= cut


@compiled
def _slip(p_x, p_y, rises_x, rises_y, squares, shift, change, before, bound):
    """`slip_step` for all cells of a row that exceed the bound, without branches."""
    growth = bound - before
    for k in range(p_x.shape[0]):
        rise_x, rise_y = rises_x[k], rises_y[k] + shift
        x, y = p_x[k] + rise_x, p_y[k] + rise_y
        speed_squared = rise_x * rise_x + rise_y * rise_y
        slope = -(x * rise_x + y * rise_y) - before * growth
        rest = x * x + y * y - before * before
        inside = min(rest, 0.0)
        square = speed_squared - growth * growth
        root = math.sqrt(max(slope * slope - square * inside, 0.0))
        above = -inside if slope > 0.0 else root - slope
        below = slope + root if slope > 0.0 else square
        stick = above / (below if below > 0.0 else 1.0)
        stick = min(max(stick, 0.0), 1.0) if below > 0.0 else 0.0
        sticks = (slope < 0.0) | (rest < -1e-14 * before * before)
        stick = stick if sticks else 0.0
        x -= stick * rise_x
        y -= stick * rise_y
        size = math.sqrt(x * x + y * y) if sticks else before
        left = 1.0 - stick
        turn = 2.0 * math.sqrt(speed_squared) * left / (size + bound)
        decay = _decay(min(turn, 20.0))
        late = max(turn, 1e-2)
        late = (late - 1.0 + decay) / (late * max(1.0 - decay, 1e-3))
        # By series where the difference of nearly equal numbers would lose digits.
        place = late if turn > 1e-2 else 0.5 + turn * (1.0 / 12.0 - turn * turn / 720.0)
        rise_y += change * (left * (1.0 - place) - 0.5)
        per_speed = -1.0 / math.sqrt(rise_x * rise_x + rise_y * rise_y + 1e-200)
        drive_x, drive_y = rise_x * per_speed, rise_y * per_speed
        along = max((x * drive_x + y * drive_y) / size, -1.0)
        back = (1.0 - along) * decay * decay
        scale = bound / (1.0 + along + back)
        share = scale * (1.0 + along - back - 2.0 * decay * along)
        keep = scale * 2.0 * decay / size
        share = share if turn <= 20.0 else bound
        keep = keep if turn <= 20.0 else 0.0
        slips = squares[k] > bound * bound
        p_x[k] = share * drive_x + keep * x if slips else p_x[k]
        p_y[k] = share * drive_y + keep * y if slips else p_y[k]


@compiled
def _add(p_x, p_y, total_x, total_y, lever, x):
    """Add a row at x to the sums."""
    for k in range(p_x.shape[0]):
        total_x[k] += p_x[k]
        total_y[k] += p_y[k]
        lever[k] += x * p_y[k]


@compiled
def _lay_out(work, half, strips, slip_x, slip_y, turn_x):
    """Fill the rows with the strips as they begin."""
    for k in range(work.shape[1]):
        hand = 1 if k >= half else 0
        strip = min(k - half * hand, half - 1)
        theta = math.pi / strips * (strip + 0.5)
        if hand == 0:
            work[EDGE, k] = math.sin(theta)
            work[OFFSET, k] = 0.0 if 2 * strip + 1 == strips else math.cos(theta)
        edge, offset = work[EDGE, strip], work[OFFSET, strip]
        if hand == 1:
            offset = -offset
        work[RISE_X, k] = (slip_x - turn_x * offset) / edge
        work[RISE_Y, k] = slip_y / edge
        # Half a step leads from the edge to the middle of the first cell.
        work[P_X, k] = 0.5 * work[RISE_X, k]
        work[P_Y, k] = 0.5 * work[RISE_Y, k]
        work[OWN, k] = 1.0 if k < 2 * half else 0.0
        work[TOTAL_X, k] = work[TOTAL_Y, k] = work[LEVER, k] = 0.0


@compiled
def _march(work, cells, turn_y, spin):
    """Take all strips over the patch."""
    p_x, p_y, rise_x, rise_y = work[P_X], work[P_Y], work[RISE_X], work[RISE_Y]
    square, own = work[SQUARE], work[OWN]
    step = 2.0 / cells
    change = turn_y * step
    cell_bound = 1.0 - step * step / 12.0
    before = 0.0
    for cell in range(cells):
        x = 1.0 - (cell + 0.5) * step
        shift = turn_y * (x + 0.5 * step)
        if cell == 0:
            shift = 0.5 * turn_y * (1.0 - 0.25 * step)
        free = cell_bound - x * x
        count = _stick(p_x, p_y, rise_x, rise_y, square, own, shift, free * free)
        if count > 0:
            if spin == 0.0 or cell == 0:
                _cut(p_x, p_y, square, free)
            elif count > _FEW:
                _slip(p_x, p_y, rise_x, rise_y, square, shift, change, before, free)
            else:
                for k in range(p_x.shape[0]):
                    if square[k] > free * free:
                        rise = rise_y[k] + shift
                        p_x[k], p_y[k] = slip_step(
                            p_x[k] + rise_x[k], p_y[k] + rise, rise_x[k], rise, change, before, free
                        )
        _add(p_x, p_y, work[TOTAL_X], work[TOTAL_Y], work[LEVER], x)
        before = free


@compiled
def fastsim_rows(
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

    cells = int(parameters[0])
    strips = int(parameters[1])
    step = 2.0 / cells
    to_traction = a * step * math.pi * a * b / (2.0 * limit)
    slip_x = creep_x / soft_x * to_traction
    slip_y = creep_y / soft_y * to_traction
    turn_x = spin * b / soft_spin * to_traction
    turn_y = spin * a / soft_spin * to_traction
    # Beyond LARGEST all slides, in a direction that keeps when all slips are scaled down together.
    largest = max(abs(slip_x), abs(slip_y), abs(turn_x), abs(turn_y))
    if largest > LARGEST:
        scale = LARGEST / largest
        slip_x *= scale
        slip_y *= scale
        turn_x *= scale
        turn_y *= scale
    half = (strips + 1) // 2
    work = np.empty((11, (2 * half + _ABREAST - 1) // _ABREAST * _ABREAST))
    _lay_out(work, half, strips, slip_x, slip_y, turn_x)
    _march(work, cells, turn_y, spin)
    sum_x = sum_y = moment_x = moment_y = 0.0
    for k in range(half):
        other = k + half
        edge = work[EDGE, k]
        # Bound ~ edge^2, cell length ~ edge, strip width ~ edge.
        weight = edge * edge * edge * edge
        if 2 * k + 1 == strips:
            weight *= 0.5
        sum_x += weight * (work[TOTAL_X, k] + work[TOTAL_X, other])
        sum_y += weight * (work[TOTAL_Y, k] + work[TOTAL_Y, other])
        moment_x += weight * work[OFFSET, k] * (work[TOTAL_X, k] - work[TOTAL_X, other])
        moment_y += weight * edge * (work[LEVER, k] + work[LEVER, other])
    # mu p_0 a b step angle; the last rounding must not carry the force over its limit.
    unit = 2.0 / math.pi * limit * step * math.pi / strips
    force_x = unit * sum_x
    force_y = unit * sum_y
    total = math.sqrt(force_x * force_x + force_y * force_y)
    if total > limit:
        force_x *= limit / total
        force_y *= limit / total
    return force_x, force_y, unit * (a * moment_y - b * moment_x)
