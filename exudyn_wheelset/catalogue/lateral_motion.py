"""Motion of the lateral model in one compiled call, by the method of Dormand and Prince.

Fifth order with the embedded fourth-order error (J. R. Dormand and P. J. Prince, J. Comp. Appl.
Math. 6 (1980) 19-26, RK5(4)7M; steps as in E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary
Differential Equations I, Springer 1993, section II.4). A step never passes a sample, so that
samples need no interpolation. States (y, yaw, y', yaw') in SI units and radians.
"""

import numpy as np

from exudyn_wheelset.catalogue.lateral_kernel import lateral_accelerations as large_angles
from exudyn_wheelset.catalogue.lateral_kernel import small_angle_accelerations as small_angles
from exudyn_wheelset.compilation import compiled

FINISHED, LEFT_TRACK, NOT_FINITE, STEP_TOO_SMALL = range(4)
STATES = 4
# Relative tolerance, and absolute one in units of the scales.
RELATIVE, ABSOLUTE = 1.0e-8, 1.0e-9
STAGES = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
# Fifth-order weights (the last row above, and 0) minus the fourth-order ones.
ERROR = np.array(
    [71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40],
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
def lateral_motion(start, speed, p, breaks, coefficients, small, times, scales, limit, samples):
    """Fill samples (m, 4) at times (m,) from start (4,) at times[0].

    Returns how it ended, the number of samples filled and the time [s] reached. It ends where |y|
    passes `limit` [m].
    """
    stages = np.zeros((7, STATES))
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
        for s in range(1, 7):
            for k in range(STATES):
                total = 0.0
                for j in range(s):
                    total += STAGES[s, j] * stages[j, k]
                stage[0, k] = state[k] + taken * total
            lateral_rates(stage, speed, p, breaks, coefficients, small, rate)
            stages[s] = rate[0]
        square = 0.0
        for k in range(STATES):
            error = 0.0
            for s in range(7):
                error += ERROR[s] * stages[s, k]
            size = max(abs(state[k]), abs(stage[0, k]))
            square += (taken * error / (ABSOLUTE * scales[k] + RELATIVE * size)) ** 2
        norm = np.sqrt(square / STATES)
        if not np.isfinite(norm):
            if taken < 1.0e-9:
                return NOT_FINITE, filled, now
            step = 0.1 * taken
            continue
        factor = min(5.0, max(0.2, 0.9 * norm ** (-0.2))) if norm > 0.0 else 5.0
        if norm > 1.0 and taken > least:
            step = taken * min(factor, 0.9)
            continue
        state[:] = stage[0]
        stages[0] = stages[6]
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
