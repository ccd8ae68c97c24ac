"""States of the patch at which the table of the exact law is made, and how a state is normalised.

With C the coefficients of linear theory, c = sqrt(a b), and forces in units of mu N:
    v_x = G c^2 C11 xi_x/(mu N),   v_y = G c^2 C22 xi_y/(mu N),   w = G c^3 S phi/(mu N),
    S = hypot(C23, TURN C11 b/c).
v_x, v_y are linear forces. S weighs what spin does to F_y (C23) and, on a wide patch, its slip
along x at the sides (C11 b). rho = |(v_x, v_y, w)| and the direction
    psi = atan2(v_x, w) in [0, pi/2],    theta = atan2(hypot(v_x, w), v_y) in [0, pi]
are the table's coordinates, sigma = rho^POWER/(1 + rho^POWER) standing for rho. At rho = 0 the law
is linear, at sigma = 1 it is full sliding, in both for each direction. The fourth is lg(a/b).
Nodes: sigma = 1/n, 2/n ... 1; psi and theta - WARP/2 sin 2 theta at the middles of equal parts, so
that the mirror images of a node are nodes and more of them are where v_y is small; lg(a/b) from -1
to 1.
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
CELLS = 30
SHAPES = 11
RADII = 40
THETAS = 28
WARP = 0.5
PSIS = 9
FAR = 1e4
ROUND = 0.004


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

    Arguments as those of `exact.tractions`, on CELLS x CELLS cells.
    """
    half_x = math.sqrt(ratio)
    half_y = 1.0 / half_x
    covered = tractions(
        rigid_x, rigid_y, turn, half_x, half_y, POISSON, CELLS, CELLS, tolerance, p_x, p_y
    )
    unit = 6.0 / math.pi / (CELLS * CELLS * covered)
    force_x = 0.0
    force_y = 0.0
    moment = 0.0
    for j in range(CELLS):
        y = (2.0 * j + 1.0 - CELLS) / CELLS * half_y
        for i in range(1, CELLS + 1):
            x = (2.0 * i - 1.0 - CELLS) / CELLS * half_x
            force_x -= p_x[j, i]
            force_y -= p_y[j, i]
            moment -= x * p_y[j, i] - y * p_x[j, i]
    return unit * force_x, unit * force_y, unit * moment / math.sqrt(covered)


@compiled
def cell_coefficients(ratio: float) -> NDArray:
    """Give C11, C22, C23 of the force, C23 of the moment, C33 as the cells have them."""
    tiny = 1e-6
    # creepage in units of mu p_0/G to linear force over C and mu N
    scale = 2.0 * math.pi / 3.0 / tiny
    p_x = np.zeros((CELLS, CELLS + 1))
    p_y = np.zeros((CELLS, CELLS + 1))
    along = patch_forces(tiny, 0.0, 0.0, ratio, 1e-6, p_x, p_y)
    p_x[:] = 0.0
    lateral = patch_forces(0.0, tiny, 0.0, ratio, 1e-6, p_x, p_y)
    p_y[:] = 0.0
    turning = patch_forces(0.0, 0.0, tiny, ratio, 1e-6, p_x, p_y)
    found = np.array([along[0], lateral[1], turning[1], -lateral[2], turning[2]])
    return found * scale


@compiled
def size_at(sigma: float) -> float:
    """rho of a node."""
    return FAR if sigma >= 1.0 else (sigma / (1.0 - sigma)) ** (1.0 / POWER)


@compiled
def turn_scale(c11: float, c23: float, b_over_c: float) -> float:
    """S of the module's header."""
    side = TURN * c11 * b_over_c
    return math.sqrt(c23 * c23 + side * side)


@compiled
def forces_at_nodes(
    ratio: float, coefficients: NDArray, theta: float, sigmas: NDArray, psis: NDArray
) -> NDArray:
    """Forces as `patch_forces` at states of one shape and theta: (sigmas, psis, 3)."""
    forces = np.empty((sigmas.size, psis.size, 3))
    p_x = np.zeros((CELLS, CELLS + 1))
    p_y = np.zeros((CELLS, CELLS + 1))
    scale = turn_scale(coefficients[0], coefficients[2], 1.0 / math.sqrt(ratio))
    for k in range(psis.size):
        psi = psis[k]
        p_x[:] = 0.0
        p_y[:] = 0.0
        for i in range(sigmas.size):
            rho = size_at(sigmas[i]) * 2.0 * math.pi / 3.0
            rigid_x = rho * math.sin(theta) * math.sin(psi) / coefficients[0]
            rigid_y = rho * math.cos(theta) / coefficients[1]
            turn = rho * math.sin(theta) * math.cos(psi) / scale
            forces[i, k] = patch_forces(rigid_x, rigid_y, turn, ratio, 5e-4, p_x, p_y)
    return forces
