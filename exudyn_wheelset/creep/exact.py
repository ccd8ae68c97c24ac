"""The exact law: steady rolling of a Hertzian ellipse by Kalker's complete theory.

Sources: J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, 1990, chapters 2 to 4
(the theory, elements, steady rolling); E. A. H. Vollebregt, A Gauss-Seidel type solver for special
convex optimization problems in frictional contact mechanics, Journal of Optimization Theory and
Applications 145, 2010 (elements solved one by one, each with its friction bound).

Wheel and rail are half-spaces of the same material, so pressure and traction do not couple; what
a traction p on a cell moves, u = u_wheel - u_rail, is in exudyn_wheelset.creep.cerruti.

A particle comes from x + h and is at x one step later. It has slipped, in steady rolling,
    s = h (xi_x - phi y, xi_y + phi (x + h/6)) + u(x, y) - u(x + h, y)
(h/6 as the program CONTACT has it; it takes most of the spin's error of first order away), and
    |p| <= mu p_n,     s = 0 where |p| < mu p_n,     s = -lambda p with lambda >= 0 elsewhere.
p_n is Hertz's pressure at the cell's middle, scaled so that its sum is N: full sliding gives mu N.

Solution: the field shifted by a cell is the field of the shifted tractions, so
    u(x) - u(x + h) = sum K q,     q(x) = p(x) - p(x + h),
q reaching one cell beyond the trailing edge. K is symmetric and positive definite where the matrix
of p is neither, so Gauss-Seidel on q converges: a step of one cell's p changes q there, moves the p
of the adhering cells behind it with it, and is given back in the first cell behind that slips or
lies outside. Cell by cell, each 2 x 2 problem with its bound solved exactly, from the trailing to
the leading edge and strip by strip, 15 to 60 sweeps.

Grid: `cells_along` x `cells_across` over the rectangle around the ellipse; a cell belongs to the
patch if its middle does, and all are then scaled alike so that they cover pi a b (without that the
stairs at the edge cost 1.3 % of the linear force on 30 x 30 cells). The error is of first order in
the cell size. Everything is solved in
units of sqrt(a b) and mu p_0 for xi_x, xi_y, phi >= 0, the other signs by symmetry: mirror images
are exact. Creepage beyond FASTEST times that of saturation is taken as FASTEST, below SLOWEST
as proportional. Frames and signs as in exudyn_wheelset.creep.kalker.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.cerruti import influence
from exudyn_wheelset.creep.law import CreepLaw, CreepParameter
from exudyn_wheelset.creep.saturation import LEAST_FRICTION_FORCE, bounded

LAW = CreepLaw(
    "exact",
    6,
    "Kalker 1990, complete theory",
    (
        CreepParameter("cells_along", 40.0, 4.0, 200.0, "cells of the patch along x", whole=True),
        CreepParameter("cells_across", 40.0, 4.0, 200.0, "cells of the patch across y", whole=True),
    ),
)

TOLERANCE = 1e-5
MOST_SWEEPS = 400
LEAST_CREEP = 1e-290
FASTEST = 1e6
SLOWEST = 1e-6
# sums in any order, so that they run on vector units
_FAST = {"reassoc", "contract", "nsz"}


@compiled(fastmath=_FAST)
def _spread(
    field_x: NDArray,
    field_y: NDArray,
    xx: NDArray,
    xy: NDArray,
    yy: NDArray,
    same_x: float,
    turned_y: float,
    turned_x: float,
    same_y: float,
) -> None:
    """Add the field of one pair of cells, on strips to the left and right, to that of a strip."""
    for i in range(field_x.size):
        field_x[i] += xx[i] * same_x + xy[i] * turned_y
        field_y[i] += xy[i] * turned_x + yy[i] * same_y


@compiled(fastmath=_FAST)
def _dot(one: NDArray, other: NDArray) -> float:
    total = 0.0
    for i in range(one.size):
        total += one[i] * other[i]
    return total


@compiled
def _traction(
    p_x: float,
    p_y: float,
    slip_x: float,
    slip_y: float,
    soft_x: float,
    soft_y: float,
    bound: float,
) -> tuple[float, float, bool]:
    """Give the traction that stops the slip of one cell, or opposes it at the bound; and if so.

    slip: with the traction p as it is; soft: slip per traction. At the bound
    (soft + lambda) p_new = soft p - slip, |p_new| = bound, by Newton for lambda on 1/|p_new|.
    """
    drive_x = soft_x * p_x - slip_x
    drive_y = soft_y * p_y - slip_y
    new_x = drive_x / soft_x
    new_y = drive_y / soft_y
    size = math.sqrt(new_x * new_x + new_y * new_y)
    if size <= bound:
        return new_x, new_y, False
    factor = 0.0
    for _ in range(20):
        over = size - bound
        if over <= 1e-12 * bound:
            break
        slope = new_x * new_x / (soft_x + factor) + new_y * new_y / (soft_y + factor)
        factor += over * size * size / (bound * slope)
        new_x = drive_x / (soft_x + factor)
        new_y = drive_y / (soft_y + factor)
        size = math.sqrt(new_x * new_x + new_y * new_y)
    return new_x * bound / size, new_y * bound / size, True


@compiled
def _strip(
    first: int,
    last: int,
    slip_x: NDArray,
    slip_y: NDArray,
    xx: NDArray,
    yy: NDArray,
    bound: NDArray,
    p_x: NDArray,
    p_y: NDArray,
    q_x: NDArray,
    q_y: NDArray,
    slides: NDArray,
    keep: float,
) -> float:
    """Solve the cells of a strip once, from the trailing to the leading edge.

    slip: without the strip's own part. Returns the sum of squares of all changes of p.
    """
    middle = xx.size // 2
    change = 0.0
    for i in range(first, last):
        own = middle - i
        s_x = slip_x[i] + _dot(xx[own + first - 1 : own + last], q_x[first - 1 : last])
        s_y = slip_y[i] + _dot(yy[own + first - 1 : own + last], q_y[first - 1 : last])
        behind = i - 1
        while behind >= first and not slides[behind]:
            behind -= 1
        share = 1.0 if slides[i] else keep
        soft_x = (xx[middle] - xx[middle + i - behind]) / share
        soft_y = (yy[middle] - yy[middle + i - behind]) / share
        new_x, new_y, slides[i] = _traction(p_x[i], p_y[i], s_x, s_y, soft_x, soft_y, bound[i])
        step_x = new_x - p_x[i]
        step_y = new_y - p_y[i]
        change += step_x * step_x + step_y * step_y
        p_x[i] = new_x
        p_y[i] = new_y
        q_x[i] += step_x
        q_y[i] += step_y
        for j in range(i - 1, first - 1, -1):
            if slides[j]:
                q_x[j] = p_x[j] - p_x[j + 1]
                q_y[j] = p_y[j] - p_y[j + 1]
                break
            p_x[j] = p_x[j + 1] + q_x[j]
            p_y[j] = p_y[j + 1] + q_y[j]
            size = math.sqrt(p_x[j] * p_x[j] + p_y[j] * p_y[j])
            if size > bound[j]:
                p_x[j] *= bound[j] / size
                p_y[j] *= bound[j] / size
                q_x[j] = p_x[j] - p_x[j + 1]
                q_y[j] = p_y[j] - p_y[j + 1]
        q_x[first - 1] = -p_x[first]
        q_y[first - 1] = -p_y[first]
    return change


@compiled
def tractions(
    rigid_x: float,
    rigid_y: float,
    turn: float,
    half_x: float,
    half_y: float,
    poisson: float,
    along: int,
    across: int,
    tolerance: float,
    p_x: NDArray,
    p_y: NDArray,
) -> float:
    """Solve for the tractions p_x, p_y over the patch; give its cells' unscaled area over pi a b.

    p_x, p_y: arrays (across, along + 1), from the trailing edge and the right, column 0 left empty;
    zero, or the solution of a neighbouring state of the same patch to start from. Sweeps end when
    the change of p in one is below tolerance times p, both as root mean square.
    Units: sqrt(a b) for length, so half_x half_y = 1; mu p_0 for tractions, before the scaling of
    the bound; mu p_0/G for creepage rigid_x, rigid_y and for the turn (spin times sqrt(a b)).
    """
    shape = (across, along + 1)
    bound = np.zeros(shape)
    first = np.ones(across, np.int64)
    last = np.ones(across, np.int64)
    for j in range(across):
        side = (2.0 * j + 1.0) / across - 1.0
        for i in range(1, along + 1):
            ahead = (2.0 * i - 1.0) / along - 1.0
            inside = 1.0 - side * side - ahead * ahead
            if inside > 0.0:
                bound[j, i] = math.sqrt(inside)
                first[j] = i if last[j] == 1 else first[j]
                last[j] = i + 1
    covered = 4.0 * np.sum(last - first) / (math.pi * along * across)
    half_x /= math.sqrt(covered)
    half_y /= math.sqrt(covered)
    step_x = 2.0 * half_x / along
    step_y = 2.0 * half_y / across
    bound *= 2.0 * math.pi / 3.0 / (np.sum(bound) * step_x * step_y)
    xx, xy, yy = influence(along, across, step_x, step_y, poisson)
    for table in (xx, xy, yy):
        table /= math.pi
    q_x = p_x.copy()
    q_y = p_y.copy()
    q_x[:, :-1] -= p_x[:, 1:]
    q_y[:, :-1] -= p_y[:, 1:]
    nothing = np.zeros(along + 1)
    slides = p_x * p_x + p_y * p_y > 0.999999 * bound * bound
    slip_x = np.empty(along + 1)
    slip_y = np.empty(along + 1)
    # a step too far in slender cells, dx above 5 dy, makes sweeps oscillate
    keep = 0.9 if step_x < 5.0 * step_y else 0.8
    for _ in range(MOST_SWEEPS):
        change = 0.0
        for j in range(across):
            begin = first[j]
            end = last[j]
            for i in range(begin, end):
                slip_x[i] = (rigid_x - turn * ((j + 0.5) * step_y - half_y)) * step_x
                slip_y[i] = (rigid_y + turn * ((i - 1.0 / 3.0) * step_x - half_x)) * step_x
            own_x = slip_x[begin:end]
            own_y = slip_y[begin:end]
            for far in range(1, max(j, across - 1 - j) + 1):
                right = j - far
                left = j + far
                right_x = q_x[right] if right >= 0 else nothing
                right_y = q_y[right] if right >= 0 else nothing
                left_x = q_x[left] if left < across else nothing
                left_y = q_y[left] if left < across else nothing
                inner = left if right < 0 else right
                if left < across and last[left] > last[inner]:
                    inner = left
                for i in range(first[inner] - 1, last[inner]):
                    one = along + begin - i
                    two = along + end - i
                    _spread(
                        own_x,
                        own_y,
                        xx[far, one:two],
                        xy[far, one:two],
                        yy[far, one:two],
                        right_x[i] + left_x[i],
                        right_y[i] - left_y[i],
                        right_x[i] - left_x[i],
                        right_y[i] + left_y[i],
                    )
            change += _strip(
                begin,
                end,
                slip_x,
                slip_y,
                xx[0],
                yy[0],
                bound[j],
                p_x[j],
                p_y[j],
                q_x[j],
                q_y[j],
                slides[j],
                keep,
            )
        size = np.sum(p_x * p_x) + np.sum(p_y * p_y)
        if change <= tolerance * tolerance * size:
            break
    return covered


@compiled
def exact(
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
    """Give (F_x, F_y, M_z) on the wheel by the complete theory.

    parameters: [cells_along, cells_across].
    """
    limit = friction * normal_force
    if not (limit > LEAST_FRICTION_FORCE and a > 0.0 and b > 0.0):
        return 0.0, 0.0, 0.0
    creep_x, creep_y, spin = bounded(creep_x), bounded(creep_y), bounded(spin)
    length = math.sqrt(a) * math.sqrt(b)
    stiffness = shear_modulus * math.pi * a * b / (1.5 * limit)
    half_x = a / length
    half_y = b / length
    rigid_x = abs(creep_x) * stiffness
    rigid_y = creep_y * stiffness
    turn = abs(spin) * length * stiffness
    if spin < 0.0 or (spin == 0.0 and creep_y < 0.0):
        rigid_y = -rigid_y
    largest = max(rigid_x, abs(rigid_y), turn * max(half_x, half_y))
    if not largest > LEAST_CREEP:
        return 0.0, 0.0, 0.0
    scale = min(max(largest, SLOWEST), FASTEST) / largest
    along = int(parameters[0])
    across = int(parameters[1])
    p_x = np.zeros((across, along + 1))
    p_y = np.zeros((across, along + 1))
    covered = tractions(
        rigid_x * scale,
        rigid_y * scale,
        turn * scale,
        half_x,
        half_y,
        poisson,
        along,
        across,
        TOLERANCE,
        p_x,
        p_y,
    )
    force_x = float(np.sum(p_x))
    force_y = float(np.sum(p_y))
    moment = 0.0
    for j in range(across):
        for i in range(1, along + 1):
            moment += (2.0 * i - 1.0 - along) / along * half_x * p_y[j, i]
            moment -= (2.0 * j + 1.0 - across) / across * half_y * p_x[j, i]
    # mu p_0 times the area of a cell
    unit = 6.0 / math.pi * limit / (along * across * covered)
    if scale > 1.0:
        unit /= scale
    force_x *= unit
    force_y *= unit
    moment *= unit * length / math.sqrt(covered)
    # the last rounding must not carry the force over its limit
    total = math.sqrt(force_x * force_x + force_y * force_y)
    if total > limit:
        force_x *= limit / total
        force_y *= limit / total
    if creep_x == 0.0:
        force_x = 0.0
    if creep_y == 0.0 and spin == 0.0:
        force_y = moment = 0.0
    if creep_x < 0.0:
        force_x = -force_x
    if spin < 0.0 or (spin == 0.0 and creep_y < 0.0):
        force_y = -force_y
        moment = -moment
    return force_x, force_y, moment
