"""Motion of the lateral model in one compiled call, by embedded pairs of explicit methods.

Accurate: fifth order with the embedded fourth-order error (J. R. Dormand and P. J. Prince, J. Comp.
Appl. Math. 6 (1980) 19-26, RK5(4)7M). Rough: third order with the second-order error (P. Bogacki
and L. F. Shampine, Appl. Math. Lett. 2 (1989) 321-325), for motions that are only to settle or to
die out: the kinks of the contact geometry, a few hundred in a cycle, and the rates of creep set the
steps, so that a higher order gains nothing. Steps as in E. Hairer, S. P. Norsett, G. Wanner,
Solving Ordinary Differential Equations I, Springer 1993, section II.4; the last stage is the first
of the next step. A step never passes a sample, so that samples need no interpolation. States (y,
yaw, y', yaw') in SI units and radians.
"""

from typing import NamedTuple

import numpy as np

from exudyn_wheelset.catalogue.lateral_kernel import lateral_accelerations as large_angles
from exudyn_wheelset.catalogue.lateral_kernel import small_angle_accelerations as small_angles
from exudyn_wheelset.compilation import compiled

FINISHED, LEFT_TRACK, NOT_FINITE, STEP_TOO_SMALL = range(4)
STATES = 4


class Pair(NamedTuple):
    """Stages (s, s), the last row the weights; weights less the embedded ones (s); exponent of the
    step's change; relative tolerance of a step, the absolute one a tenth of it in the scales."""

    stages: np.ndarray
    error: np.ndarray
    exponent: float
    tolerance: float


ACCURATE = Pair(
    np.array(
        [
            [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
            [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
            [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
            [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
            [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
            [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
        ]
    ),
    np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]),
    -1 / 5,
    1.0e-8,
)
# Amplitudes of hunting to 1e-4, to 6e-4 with Polach's law, whose forces jump.
ROUGH = Pair(
    np.array([[0.0, 0.0, 0.0], [1 / 2, 0.0, 0.0], [0.0, 3 / 4, 0.0], [2 / 9, 1 / 3, 4 / 9]]),
    np.array([-5 / 72, 1 / 12, 1 / 9, -1 / 8]),
    -1 / 3,
    2.0e-5,
)


@compiled
def lateral_rates(states, speed, p, breaks, coefficients, small, rates):
    """Fill rates (m, 4) of states (m, 4); `small`: small angles on knife-edge rails."""
    sides = np.zeros((2, 12))
    for row in range(states.shape[0]):
        state = states[row]
        # Without the normal forces of the state before: a rate depends on its state alone.
        sides[:, 0] = 0.0
        if small:
            y2, yaw2 = small_angles(state, speed, p, sides)
        else:
            y2, yaw2 = large_angles(state, speed, p, breaks, coefficients, sides)
        rates[row, 0], rates[row, 1] = state[2], state[3]
        rates[row, 2], rates[row, 3] = y2, yaw2


@compiled
def lateral_motion(
    start, speed, p, breaks, coefficients, small, times, scales, limit, pair, samples
):
    """Fill samples (m, 4) at times (m,) from start (4,) at times[0].

    Returns how it ended, the number of samples filled and the time [s] reached. It ends where |y|
    passes `limit` [m].
    """
    count = len(pair.error)
    stages = np.zeros((count, STATES))
    stage = np.empty((1, STATES))
    rate = np.empty((1, STATES))
    state = start.copy()
    samples[0] = state
    now = times[0]
    stage[0] = state
    lateral_rates(stage, speed, p, breaks, coefficients, small, rate)
    stages[0] = rate[0]
    step = 1.0e-4
    filled = 1
    while filled < times.shape[0]:
        ending = times[filled]
        least = 1.0e-13 * max(abs(now), abs(ending))
        left = ending - now
        last = step >= left
        taken = left if last else step
        if taken < 1.0e-10 and not last:
            return STEP_TOO_SMALL, filled, now
        for s in range(1, count):
            for k in range(STATES):
                total = 0.0
                for j in range(s):
                    total += pair.stages[s, j] * stages[j, k]
                stage[0, k] = state[k] + taken * total
            lateral_rates(stage, speed, p, breaks, coefficients, small, rate)
            stages[s] = rate[0]
        square = 0.0
        for k in range(STATES):
            error = 0.0
            for s in range(count):
                error += pair.error[s] * stages[s, k]
            size = max(abs(state[k]), abs(stage[0, k]))
            square += (taken * error / (pair.tolerance * (0.1 * scales[k] + size))) ** 2
        norm = np.sqrt(square / STATES)
        if not np.isfinite(norm):
            if taken < 1.0e-9:
                return NOT_FINITE, filled, now
            step = 0.1 * taken
            continue
        factor = min(5.0, max(0.2, 0.9 * norm**pair.exponent)) if norm > 0.0 else 5.0
        if norm > 1.0 and taken > least:
            step = taken * min(factor, 0.9)
            continue
        state[:] = stage[0]
        stages[0] = stages[count - 1]
        now = ending if last else now + taken
        # A step cut short by a sample says little of what the next one may be.
        if not last or taken * factor > step or factor < 1.0:
            step = taken * factor
        if abs(state[0]) > limit:
            return LEFT_TRACK, filled, now
        if last:
            samples[filled] = state
            filled += 1
    return FINISHED, filled, now
