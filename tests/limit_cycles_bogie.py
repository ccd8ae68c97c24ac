"""Bogie of Cooperrider as published by Kaas-Petersen, written out as first-order equations.

Source: C. Kaas-Petersen, Chaos in a railway bogie, Acta Mechanica 61 (1986) 89-107. Seven degrees
of freedom: q1, q3 lateral and q2, q4 yaw of the leading and trailing wheelset, q5, q6, q7 lateral,
yaw and roll of the frame; SI units, radians. A second statement of the model beside the one built
in Exudyn, so that the two can be compared.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_wheelset.analyses.system import DIFFERENCE_STEP, Array, DynamicSystem

WHEELSET_MASS, WHEELSET_INERTIA = 1022.0, 678.0
FRAME_MASS, FRAME_YAW_INERTIA, FRAME_ROLL_INERTIA = 2918.0, 6780.0, 6780.0
K1, K2, K3, K4, K5, K6 = 1.823e6, 3.646e6, 3.646e6, 0.1823e6, 0.3333e6, 2.710e6
D1, D2 = 20.0e3, 29.2e3
A, B, H1, H2, ARM1, ARM2 = 0.7163, 1.074, 0.0762, 0.6584, 0.620, 0.680
CONICITY, RADIUS = 0.05, 0.4572
FLANGE_STIFFNESS, FLANGE_CLEARANCE = 14.60e6, 9.1e-3
FRICTION_LIMIT, CREEP_STIFFNESS = 10.0e3, 6.563e6
PHI, PSI = 0.60252, 0.54219

NAMES = tuple(f"q{i}" for i in range(1, 8)) + tuple(f"q{i}'" for i in range(1, 8))
SCALES = np.array([5e-3, 5e-3, 5e-3, 5e-3, 5e-3, 5e-3, 5e-3] + [0.1] * 7)


@njit(cache=True)
def _creep_and_flange(q, yaw, rate, yaw_rate, speed):
    creep_x = CONICITY * q / RADIUS + A * yaw_rate / speed
    creep_y = rate / speed - yaw
    x, y = creep_x / PHI, creep_y / PSI
    size = np.sqrt(x * x + y * y)
    u = CREEP_STIFFNESS * size / FRICTION_LIMIT
    if u < 3.0:
        factor = CREEP_STIFFNESS * (1.0 - u / 3.0 + u * u / 27.0)
    else:
        factor = FRICTION_LIMIT / size
    flange = 0.0
    if q > FLANGE_CLEARANCE:
        flange = FLANGE_STIFFNESS * (q - FLANGE_CLEARANCE)
    elif q < -FLANGE_CLEARANCE:
        flange = FLANGE_STIFFNESS * (q + FLANGE_CLEARANCE)
    return factor * x, factor * y, flange


@njit(cache=True)
def _derivative(x, speed, out):
    for i in range(7):
        out[i] = x[7 + i]
    force_x1, force_y1, flange1 = _creep_and_flange(x[0], x[1], x[7], x[8], speed)
    force_x2, force_y2, flange2 = _creep_and_flange(x[2], x[3], x[9], x[10], speed)
    a1 = 2.0 * K1 * (x[0] - x[4] - B * x[5] - H1 * x[6])
    a2 = 2.0 * K2 * ARM1**2 * (x[1] - x[5])
    a3 = 2.0 * K1 * (x[2] - x[4] + B * x[5] - H1 * x[6])
    a4 = 2.0 * K2 * ARM1**2 * (x[3] - x[5])
    a5 = 2.0 * D2 * (x[11] - H2 * x[13]) + 2.0 * K4 * (x[4] - H2 * x[6])
    a6 = K6 * x[5]
    a7 = 2.0 * D1 * ARM2**2 * x[13] + (2.0 * K5 * ARM2**2 + 4.0 * K3 * ARM1**2) * x[6]
    out[7] = -(a1 + 2.0 * force_y1 + flange1) / WHEELSET_MASS
    out[8] = -(a2 + 2.0 * A * force_x1) / WHEELSET_INERTIA
    out[9] = -(a3 + 2.0 * force_y2 + flange2) / WHEELSET_MASS
    out[10] = -(a4 + 2.0 * A * force_x2) / WHEELSET_INERTIA
    out[11] = (a1 + a3 - a5) / FRAME_MASS
    out[12] = (B * a1 - B * a3 + a2 + a4 - a6) / FRAME_YAW_INERTIA
    out[13] = (H1 * a1 + H1 * a3 + H2 * a5 - a7) / FRAME_ROLL_INERTIA


@njit(cache=True)
def _derivatives(states, speed):
    out = np.empty_like(states)
    for row in range(len(states)):
        _derivative(states[row], speed, out[row])
    return out


@njit(cache=True)
def _jacobians(states, speed, steps):
    count, size = states.shape
    out = np.empty((count, size, size))
    upper, lower = np.empty(size), np.empty(size)
    for row in range(count):
        x = states[row].copy()
        for column in range(size):
            x[column] = states[row, column] + steps[column]
            _derivative(x, speed, upper)
            x[column] = states[row, column] - steps[column]
            _derivative(x, speed, lower)
            x[column] = states[row, column]
            for i in range(size):
                out[row, i, column] = (upper[i] - lower[i]) / (2.0 * steps[column])
    return out


@njit(cache=True)
def _simulate(state, speed, times, longest):
    """Classical Runge-Kutta; 2.5e-4 s leaves 1e-7 of the amplitude over a hunting period."""
    size = len(state)
    out = np.empty((len(times), size))
    x = state.copy()
    k1, k2, k3, k4 = np.empty(size), np.empty(size), np.empty(size), np.empty(size)
    out[0] = x
    for row in range(1, len(times)):
        span = times[row] - times[row - 1]
        steps = max(1, int(np.ceil(span / longest - 1e-9)))
        h = span / steps
        for _ in range(steps):
            _derivative(x, speed, k1)
            _derivative(x + 0.5 * h * k1, speed, k2)
            _derivative(x + 0.5 * h * k2, speed, k3)
            _derivative(x + h * k3, speed, k4)
            x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        out[row] = x
    return out


class KaasPetersenBogie(DynamicSystem):
    """The bogie as a DynamicSystem; displacements q1 to q7."""

    name = "Cooperrider bogie (Kaas-Petersen), equations written out"
    state_names = NAMES
    scales = SCALES
    displacement_indices = tuple(range(7))

    def derivative(self, state: Array, speed: float) -> Array:
        return _derivatives(np.asarray(state, dtype=float)[None], float(speed))[0]

    def derivatives(self, states: Array, speed: float) -> Array:
        return _derivatives(np.ascontiguousarray(states, dtype=float), float(speed))

    def jacobian(self, state: Array, speed: float) -> Array:
        return self.jacobians(np.asarray(state, dtype=float)[None], speed)[0]

    def jacobians(self, states: Array, speed: float) -> Array:
        states = np.ascontiguousarray(states, dtype=float)
        return _jacobians(states, float(speed), DIFFERENCE_STEP * SCALES)

    def simulate(self, state: Array, speed: float, times: Array) -> Array:
        state = np.array(state, dtype=float)
        return _simulate(state, float(speed), np.asarray(times, dtype=float), 2.5e-4)
