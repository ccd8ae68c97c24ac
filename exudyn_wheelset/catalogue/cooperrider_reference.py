"""The equations of the Cooperrider bogie written out one by one, without Exudyn.

The second writing of the model in `cooperrider_bogie` (equations and source there): force by force
from the formulas, not from matrices, compiled, with an exact Jacobian. It is the cross-check of
the Exudyn model and serves where many evaluations are wanted.
"""

from __future__ import annotations

import math
from dataclasses import asdict

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.catalogue.cooperrider_bogie import SCALES, STATE_NAMES, CooperriderBogie
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.systems.function_system import FunctionSystem


@compiled
def _creep_factor(creep: float, friction_force: float, creep_stiffness: float) -> float:
    """Resultant creep force over resultant creep [N]."""
    u = creep_stiffness * creep / friction_force
    if u >= 3.0:
        return friction_force / creep
    return creep_stiffness * (1.0 - u / 3.0 + u * u / 27.0)


@compiled
def _creep_factor_slope(creep: float, friction_force: float, creep_stiffness: float) -> float:
    """Derivative of `_creep_factor` by the creep [N]."""
    u = creep_stiffness * creep / friction_force
    if u >= 3.0:
        return -friction_force / (creep * creep)
    return creep_stiffness * creep_stiffness / friction_force * (2.0 * u / 27.0 - 1.0 / 3.0)


@compiled
def _flange_force(lateral: float, stiffness: float, clearance: float) -> float:
    if lateral > clearance:
        return stiffness * (lateral - clearance)
    if lateral < -clearance:
        return stiffness * (lateral + clearance)
    return 0.0


@compiled
def bogie_rate(x: Array, speed: float, p: Array, rate: Array) -> None:
    """Rate (14,) of the state x (14,), written in place; p (25,) the bogie's fields in order."""
    mw, iw, mf, i_f, ifr, k1, k2, k3, k4, k5, k6, dv, dl, a, b, h1, h2, d1, d2, conicity = p[:20]
    r0, k0, clearance, friction, creep_stiffness = p[20:25]
    q1, q2, q3, q4, q5, q6, q7 = x[:7]
    q1_t, q2_t, q3_t, q4_t, q5_t, q6_t, q7_t = x[7:14]

    a1 = 2.0 * k1 * (q1 - q5 - b * q6 - h1 * q7)
    a2 = 2.0 * k2 * d1 * d1 * (q2 - q6)
    a3 = 2.0 * k1 * (q3 - q5 + b * q6 - h1 * q7)
    a4 = 2.0 * k2 * d1 * d1 * (q4 - q6)
    a5 = 2.0 * dl * (q5_t - h2 * q7_t) + 2.0 * k4 * (q5 - h2 * q7)
    a6 = k6 * q6
    a7 = 2.0 * dv * d2 * d2 * q7_t + 2.0 * k5 * d2 * d2 * q7 + 4.0 * k3 * d1 * d1 * q7

    xi_x1 = (conicity * q1 / r0 + a * q2_t / speed) / 0.60252
    xi_y1 = (q1_t / speed - q2) / 0.54219
    xi_x3 = (conicity * q3 / r0 + a * q4_t / speed) / 0.60252
    xi_y3 = (q3_t / speed - q4) / 0.54219
    factor1 = _creep_factor(math.sqrt(xi_x1**2 + xi_y1**2), friction, creep_stiffness)
    factor3 = _creep_factor(math.sqrt(xi_x3**2 + xi_y3**2), friction, creep_stiffness)

    rate[0], rate[1], rate[2], rate[3] = q1_t, q2_t, q3_t, q4_t
    rate[4], rate[5], rate[6] = q5_t, q6_t, q7_t
    rate[7] = -(a1 + 2.0 * factor1 * xi_y1 + _flange_force(q1, k0, clearance)) / mw
    rate[8] = -(a2 + 2.0 * a * factor1 * xi_x1) / iw
    rate[9] = -(a3 + 2.0 * factor3 * xi_y3 + _flange_force(q3, k0, clearance)) / mw
    rate[10] = -(a4 + 2.0 * a * factor3 * xi_x3) / iw
    rate[11] = (a1 + a3 - a5) / mf
    rate[12] = (b * (a1 - a3) + a2 + a4 - a6) / i_f
    rate[13] = (h1 * (a1 + a3) + h2 * a5 - a7) / ifr


@compiled
def bogie_jacobian(x: Array, speed: float, p: Array, matrix: Array) -> None:
    """Jacobian (14, 14) of `bogie_rate`, written in place; at the corner of the flange spring the
    side of the dead band is taken."""
    mw, iw, mf, i_f, ifr, k1, k2, k3, k4, k5, k6, dv, dl, a, b, h1, h2, d1, d2, conicity = p[:20]
    r0, k0, clearance, friction, creep_stiffness = p[20:25]
    matrix[:] = 0.0
    for i in range(7):
        matrix[i, 7 + i] = 1.0
    lateral, yaw = 2.0 * k1, 2.0 * k2 * d1 * d1
    for w in range(2):
        y, sign = 2 * w, 1.0 - 2.0 * w
        row_y, row_yaw = 7 + y, 8 + y
        # Gradient of A1 (A3) and A2 (A4) by q, used in the wheelset's and the frame's rows.
        for column, value in (
            (y, lateral),
            (4, -lateral),
            (5, -sign * b * lateral),
            (6, -h1 * lateral),
        ):
            matrix[row_y, column] -= value / mw
            matrix[11, column] += value / mf
            matrix[12, column] += sign * b * value / i_f
            matrix[13, column] += h1 * value / ifr
        for column, value in ((y + 1, yaw), (5, -yaw)):
            matrix[row_yaw, column] -= value / iw
            matrix[12, column] += value / i_f
        xi_x = (conicity * x[y] / r0 + a * x[8 + y] / speed) / 0.60252
        xi_y = (x[7 + y] / speed - x[y + 1]) / 0.54219
        creep = math.sqrt(xi_x * xi_x + xi_y * xi_y)
        factor = _creep_factor(creep, friction, creep_stiffness)
        slope = _creep_factor_slope(creep, friction, creep_stiffness) / creep if creep else 0.0
        xx, xy, yy = factor + slope * xi_x * xi_x, slope * xi_x * xi_y, factor + slope * xi_y * xi_y
        for column, by_x, by_y in (
            (y, conicity / r0 / 0.60252, 0.0),
            (y + 1, 0.0, -1.0 / 0.54219),
            (7 + y, 0.0, 1.0 / speed / 0.54219),
            (8 + y, a / speed / 0.60252, 0.0),
        ):
            matrix[row_y, column] -= 2.0 * (xy * by_x + yy * by_y) / mw
            matrix[row_yaw, column] -= 2.0 * a * (xx * by_x + xy * by_y) / iw
        if abs(x[y]) > clearance:
            matrix[row_y, y] -= k0 / mw
    # Secondary suspension: A5, A6, A7.
    for column, value in (
        (4, 2.0 * k4),
        (6, -2.0 * k4 * h2),
        (11, 2.0 * dl),
        (13, -2.0 * dl * h2),
    ):
        matrix[11, column] -= value / mf
        matrix[13, column] += h2 * value / ifr
    matrix[12, 5] -= k6 / i_f
    matrix[13, 6] -= (2.0 * k5 * d2 * d2 + 4.0 * k3 * d1 * d1) / ifr
    matrix[13, 13] -= 2.0 * dv * d2 * d2 / ifr


@compiled
def _rates(states: Array, speed: float, p: Array) -> Array:
    rates = np.empty_like(states)
    for row in range(states.shape[0]):
        bogie_rate(states[row], speed, p, rates[row])
    return rates


@compiled
def _jacobians(states: Array, speed: float, p: Array) -> Array:
    matrices = np.empty((states.shape[0], 14, 14))
    for row in range(states.shape[0]):
        bogie_jacobian(states[row], speed, p, matrices[row])
    return matrices


def cooperrider_reference_system(bogie: CooperriderBogie | None = None) -> FunctionSystem:
    """The bogie's equations as compiled functions, with exact Jacobians and vectorised forms."""
    bogie = bogie or CooperriderBogie()
    parameters = np.array(list(asdict(bogie).values()))

    def derivative(state: Array, speed: float) -> Array:
        rate = np.empty(14)
        bogie_rate(state, speed, parameters, rate)
        return rate

    def jacobian(state: Array, speed: float) -> Array:
        matrix = np.empty((14, 14))
        bogie_jacobian(state, speed, parameters, matrix)
        return matrix

    return FunctionSystem(
        "Cooperrider bogie (reference equations)",
        derivative,
        STATE_NAMES,
        SCALES,
        jacobian_function=jacobian,
        derivatives_function=lambda states, speed: _rates(
            np.ascontiguousarray(states), speed, parameters
        ),
        jacobians_function=lambda states, speed: _jacobians(
            np.ascontiguousarray(states), speed, parameters
        ),
        parameters=asdict(bogie),
    )
