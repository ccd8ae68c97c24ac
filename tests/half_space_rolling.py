"""Steady rolling of any pressure on the half-space: a judge for creep forces beside the ellipse.

The equations of exudyn_wheelset.creep.exact (Kalker 1990, complete theory), cell by cell: there on
Hertz's ellipse, here under the pressure of half_space.py, and with the rigid slip of each strip's
own particle of the wheel instead of one creepage and a spin. Influence numbers and the solution of
one strip are that module's own, and tested there against CONTACT.

Lengths in metres, tractions over the shear modulus; strips across, cells along x from the trailing
edge, as in creep.exact.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.cerruti import influence
from exudyn_wheelset.creep.exact import _spread, _strip

SWEEPS = 400


@compiled
def _tractions(creep_x, creep_y, spin, bound, step_x, step_y, poisson, tolerance, p_x, p_y):
    """Solve for tractions over the shear modulus, (strips, cells + 1), column 0 empty."""
    across, along = bound.shape[0], bound.shape[1] - 1
    xx, xy, yy = influence(along, across, step_x, step_y, poisson)
    for table in (xx, xy, yy):
        table /= math.pi
    first = np.ones(across, np.int64)
    last = np.ones(across, np.int64)
    for j in range(across):
        for i in range(1, along + 1):
            if bound[j, i] > 0.0:
                first[j] = i if last[j] == 1 else first[j]
                last[j] = i + 1
    q_x, q_y = p_x.copy(), p_y.copy()
    slides = np.zeros(bound.shape, np.bool_)
    nothing = np.zeros(along + 1)
    slip_x, slip_y = np.empty(along + 1), np.empty(along + 1)
    for _ in range(SWEEPS):
        change = 0.0
        for j in range(across):
            begin, end = first[j], last[j]
            for i in range(begin, end):
                ahead = (i - 1.0 / 3.0 - 0.5 * along) * step_x
                slip_x[i] = creep_x[j] * step_x
                slip_y[i] = (creep_y[j] + spin[j] * ahead) * step_x
            for far in range(1, max(j, across - 1 - j) + 1):
                right, left = j - far, j + far
                right_x = q_x[right] if right >= 0 else nothing
                right_y = q_y[right] if right >= 0 else nothing
                left_x = q_x[left] if left < across else nothing
                left_y = q_y[left] if left < across else nothing
                for i in range(along + 1):
                    one, two = along + begin - i, along + end - i
                    _spread(
                        slip_x[begin:end], slip_y[begin:end],
                        xx[far, one:two], xy[far, one:two], yy[far, one:two],
                        right_x[i] + left_x[i], right_y[i] - left_y[i],
                        right_x[i] - left_x[i], right_y[i] + left_y[i],
                    )  # fmt: skip
            change += _strip(
                begin, end, slip_x, slip_y, xx[0], yy[0], bound[j], p_x[j], p_y[j], q_x[j], q_y[j],
                slides[j], 0.9,
            )  # fmt: skip
        if change <= tolerance * tolerance * (np.sum(p_x * p_x) + np.sum(p_y * p_y)):
            break


def rolling_force(pressure, ds, dx, slips, friction, shear_modulus, poisson):
    """Creep force (x, lateral tangent) [N] of a pressure (strips, cells) [Pa] on a regular grid.

    slips: creepage along x, lateral creepage and spin [1/m], each for every strip.
    """
    bound = np.zeros((pressure.shape[0], pressure.shape[1] + 1))
    bound[:, 1:] = friction * pressure / shear_modulus
    p_x, p_y = np.zeros_like(bound), np.zeros_like(bound)
    _tractions(*slips, bound, dx, ds, poisson, 1e-6, p_x, p_y)
    cell = shear_modulus * ds * dx
    return cell * p_x.sum(), cell * p_y.sum()
