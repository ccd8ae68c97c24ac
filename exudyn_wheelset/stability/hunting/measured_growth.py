"""Growth of a disturbance of a limit cycle, measured on simulated motion: a check of multipliers.

Floquet multipliers come from Jacobians along the orbit. On elastic contact the right-hand side has
small steps (a patch appears, contact points change place) that no Jacobian holds, and near a Hopf
point, where the multiplier of the amplitude is within a per cent of 1, its sign may be wrong. So
the orbit is made a little larger and a little smaller about its mean and simulated for some
periods: the difference of the two amplitudes grows by the multiplier a period, steps included.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.stability.hunting.aligned import Point
from exudyn_wheelset.systems.system import DynamicSystem

# The change of size, periods simulated, and those at the beginning that hold what the change stirs.
CHANGE, PERIODS, STIRRED = 0.02, 7, 2
SAMPLES = 64
# Multipliers this near to 1 are checked; a measured growth nearer to 1 than DECIDED says nothing.
CHECKED, DECIDED = 0.02, 2.0e-3


def checked(system: DynamicSystem, point: Point, margin: float) -> Point:
    """The point, its multipliers' error raised where simulated motion contradicts their sign."""
    found = point.multipliers
    if not system.stiff or point.is_fold or not len(found.values):
        return point
    leading = complex(found.values[0])
    amplitude = abs(leading.imag) < 1e-9 and abs(leading.real - 1.0) < CHECKED
    if not amplitude or found.stable(margin) is None:
        return point
    growth = measured_growth(system, point)
    agrees = (growth - 1.0) * (leading.real - 1.0) > 0.0
    if agrees or not abs(growth - 1.0) > DECIDED:
        return point
    error = max(found.error, abs(growth - leading.real))
    return replace(point, multipliers=replace(found, error=error))


def measured_growth(system: DynamicSystem, point: Point) -> float:
    """Factor a period by which the amplitude's disturbance grows; nan if a motion ends early."""
    orbit = point.orbit.whole()
    phases = np.linspace(0.0, 1.0, 4 * SAMPLES, endpoint=False)
    mean = orbit.evaluate(phases).mean(axis=0)
    shown = list(system.displacement_indices)
    sizes = orbit.half_peak_to_peak()[shown] / system.scales[shown]
    watched = shown[int(np.argmax(sizes))]
    times = orbit.period * np.arange(PERIODS * SAMPLES + 1) / SAMPLES
    amplitudes = []
    for factor in (1.0 - CHANGE, 1.0 + CHANGE):
        start = mean + factor * (orbit.states[0] - mean)
        try:
            signal = system.simulate(start, orbit.speed, times)[:-1, watched]
        except WheelsetError:
            return float("nan")
        amplitudes.append(np.ptp(signal.reshape(PERIODS, SAMPLES), axis=1))
    apart = amplitudes[1] - amplitudes[0]
    if apart[-1] <= 0.0 or apart[STIRRED] <= 0.0:
        return float("nan")
    return float((apart[-1] / apart[STIRRED]) ** (1.0 / (PERIODS - 1 - STIRRED)))
