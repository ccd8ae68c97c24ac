"""States of the patch at which the table of the exact law is made, and how a state is normalised.

With C the coefficients of linear theory, c = sqrt(a b), and forces in units of mu N:
    v_x = G c^2 C11 xi_x/(mu N),   v_y = G c^2 C22 xi_y/(mu N),   w = G c^3 S phi/(mu N),
    S = hypot(C23, TURN C11 b/c).
v_x, v_y are linear forces. S weighs what spin does to F_y (C23) and, on a wide patch, its slip
along x at the sides (C11 b). rho = |(v_x, v_y, w)|, and the direction n = (v_x, v_y, w)/rho is
    psi = atan2(v_x, w) in [0, pi/2],    theta = atan2(hypot(v_x, w), v_y) in [0, pi].
At rho = 0 the law is linear, at rho = infinity it is full sliding, in both for each direction.

Pure spin saturates the lateral force where C23 phi alone does, on patches of all shapes, and there
its slope over xi_y falls to half, the steeper the longer the patch. So the table's radial
coordinate is one in which that knee has the same place for every shape, and more nodes around it:
    rho_e = rho (1 - (1 - C23/S) n_w^2),      at pure spin G c^3 C23 phi/(mu N),
    sigma = (1 - KNEE) g(rho_e^POWER) + KNEE g(rho_e^STEEP),      g(x) = x/(1 + x).
Nodes: sigma = 1/n, 2/n ... 1; psi = 0 ... pi/2 in equal steps; theta - WARP/2 sin 2 theta at the
middles of equal parts, so that the mirror images of a node are nodes and more of them are where
v_y is small; lg(a/b) from -1 to 1.

Cells: those of `exact`; on wide patches more of them across. There spin turns the slip round at
y = 0, which strips of cells resolve to first order only: the slope over xi_x at a/b = 0.1 and twice
saturation by spin is 0.028, 0.030, 0.031, 0.032 on 30, 40, 60, 90 strips, 0.033 in the limit.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.exact import tractions

POISSON = 0.28
TURN = 0.4
POWER = 1.25
STEEP = 12
KNEE = 0.3
CELLS = 40
# along and across where a/b < WIDE
WIDE = 0.6
WIDE_CELLS = 30, 60
SHAPES = 11
RADII = 40
THETAS = 36
WARP = 0.6
PSIS = 10
FAR = 1e4
# shapes at which Kalker's coefficients are kept
AXIS_RATIOS = 161
LARGE = 1e20
ROUND = 0.004


def cells_of(ratio: float) -> tuple[int, int]:
    """Cells along and across on which a shape is solved."""
    return WIDE_CELLS if ratio < WIDE else (CELLS, CELLS)


@compiled
def patch_forces(
    rigid_x: float,
    rigid_y: float,
    turn: float,
    ratio: float,
    tolerance: float,
    p_x: NDArray,
    p_y: NDArray,
) -> tuple[float, float, float]:
    """Give (-F_x, -F_y)/(mu N) and -M_z/(mu N c) of a patch a/b = ratio, from the last tractions.

    Arguments as those of `exact.tractions`; the cells are those of p_x and p_y.
    """
    across, along = p_x.shape
    along -= 1
    half_x = math.sqrt(ratio)
    half_y = 1.0 / half_x
    covered = tractions(
        rigid_x, rigid_y, turn, half_x, half_y, POISSON, along, across, tolerance, p_x, p_y
    )
    unit = 6.0 / math.pi / (along * across * covered)
    force_x = 0.0
    force_y = 0.0
    moment = 0.0
    for j in range(across):
        y = (2.0 * j + 1.0 - across) / across * half_y
        for i in range(1, along + 1):
            x = (2.0 * i - 1.0 - along) / along * half_x
            force_x -= p_x[j, i]
            force_y -= p_y[j, i]
            moment -= x * p_y[j, i] - y * p_x[j, i]
    return unit * force_x, unit * force_y, unit * moment / math.sqrt(covered)


@compiled
def cell_coefficients(ratio: float, along: int, across: int) -> NDArray:
    """Give C11, C22, C23 of the force, C23 of the moment, C33 as the cells have them."""
    tiny = 1e-6
    # creepage in units of mu p_0/G to linear force over C and mu N
    scale = 2.0 * math.pi / 3.0 / tiny
    p_x = np.zeros((across, along + 1))
    p_y = np.zeros((across, along + 1))
    along_x = patch_forces(tiny, 0.0, 0.0, ratio, 1e-6, p_x, p_y)
    p_x[:] = 0.0
    lateral = patch_forces(0.0, tiny, 0.0, ratio, 1e-6, p_x, p_y)
    p_y[:] = 0.0
    turning = patch_forces(0.0, 0.0, tiny, ratio, 1e-6, p_x, p_y)
    found = np.array([along_x[0], lateral[1], turning[1], -lateral[2], turning[2]])
    return found * scale


@compiled
def sigma_at(rho: float) -> float:
    """sigma of the module's header, rho being rho_e."""
    power = rho * math.sqrt(math.sqrt(rho))
    steep = min(rho, LARGE) ** 4
    steep *= steep * steep
    return (1.0 - KNEE) * power / (1.0 + power) + KNEE * steep / (1.0 + steep)


def size_at(sigma: float) -> float:
    """rho_e of a node, by bisection."""
    if sigma >= 1.0:
        return FAR
    low, high = -20.0, math.log(FAR)
    for _ in range(100):
        middle = 0.5 * (low + high)
        if sigma_at(math.exp(middle)) < sigma:
            low = middle
        else:
            high = middle
    return math.exp(0.5 * (low + high))


@compiled
def turn_scale(c11: float, c23: float, b_over_c: float) -> float:
    """S of the module's header."""
    side = TURN * c11 * b_over_c
    return math.sqrt(c23 * c23 + side * side)


@compiled
def forces_at_nodes(
    ratio: float,
    along: int,
    across: int,
    coefficients: NDArray,
    theta: float,
    sizes: NDArray,
    psis: NDArray,
    tolerance: float,
) -> NDArray:
    """Forces as `patch_forces` at one shape and theta, rho_e = sizes: (sizes, psis, 3)."""
    forces = np.empty((sizes.size, psis.size, 3))
    p_x = np.zeros((across, along + 1))
    p_y = np.zeros((across, along + 1))
    scale = turn_scale(coefficients[0], coefficients[2], 1.0 / math.sqrt(ratio))
    for k in range(psis.size):
        n_x = math.sin(theta) * math.sin(psis[k])
        n_w = math.sin(theta) * math.cos(psis[k])
        shorter = 1.0 - (1.0 - coefficients[2] / scale) * n_w * n_w
        p_x[:] = 0.0
        p_y[:] = 0.0
        for i in range(sizes.size):
            rho = sizes[i] / shorter * 2.0 * math.pi / 3.0
            rigid_x = rho * n_x / coefficients[0]
            rigid_y = rho * math.cos(theta) / coefficients[1]
            turn = rho * n_w / scale
            forces[i, k] = patch_forces(rigid_x, rigid_y, turn, ratio, tolerance, p_x, p_y)
    return forces
