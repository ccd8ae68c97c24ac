"""Limits that motions are compared with: EN 14363, EN 12299, and 49 CFR 213.333 beside them.

Each is an object with its edition, value, unit and, in words, what it is compared with. Where a
limit depends on the vehicle it is a function. Those of 49 CFR 213.333 (vehicle/track interaction
safety limits for passenger cars, final rule of 13 March 2013, 78 Federal Register 16052, in force
since 11 July 2013), which are free to use, with V and L the vertical and lateral force of a wheel,
1 g = 9.80665 m/s^2, 1 kip = 4448.22 N:

    single wheel vertical load ratio   V/V_static, least over 5 ft, at least 0.15
    single wheel L/V                   up to (tan d - 0.5)/(1 + 0.5 tan d), over 5 ft
    net axle L/V                       up to 0.4 + 5/V_a, V_a the axle's static load in kips
    truck side L/V                     up to 0.6, the sums over a side of a truck
    accelerations                      peak to peak over 1 s; RMS_t over 4 s (truck 2 s), the root
                                       mean square of what differs from the straight line through
                                       the window

What of it was compared with a second public source stands in docs/track.md. Before a vehicle is
assessed by one of these numbers it is to be read in the standard itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.running_safety import nadal_limit

STANDARD_GRAVITY = 9.80665
_KIP = 4448.2216


@dataclass(frozen=True)
class Limit:
    """A limit with where it stands: value, unit, formula in words."""

    edition: str
    value: float
    unit: str
    formula: str


_EN = "EN 14363:2016"
# Running safety, track loading, running behaviour; 20 Hz low pass unless said otherwise.
EN_14363 = {
    "Y/Q": Limit(_EN, 0.8, "-", "leading wheels, mean over 2 m, maximum; flange of 68 to 70 deg"),
    "sum of Y": Limit(_EN, 1.0, "-", "|sum of Y| over k (10 kN + P0/3), mean over 2 m, maximum"),
    "instability": Limit(_EN, 0.5, "-", "rms of sum of Y over 100 m, f0 +- 2 Hz, over that limit"),
    "Q": Limit(_EN, 90.0e3, "N", "Q beyond the static Q0, maximum, line speeds to 160 km/h"),
    "quasi-static Q": Limit(_EN, 145.0e3, "N", "median over curve sections, outer wheel"),
    "quasi-static Y": Limit(_EN, 60.0e3, "N", "median over curve sections, outer wheel"),
    "body lateral": Limit(_EN, 2.5, "m/s^2", "0.4 to 10 Hz, maximum of |y''|, passenger vehicles"),
    "body vertical": Limit(_EN, 2.5, "m/s^2", "0.4 to 10 Hz, maximum of |z''|, passenger vehicles"),
}

_CFR = "49 CFR 213.333 (78 FR 16052, 2013)"
CFR_213_333 = {
    "vertical load ratio": Limit(_CFR, 0.15, "-", "V/V_static of a wheel, at least, over 5 ft"),
    "truck side L/V": Limit(_CFR, 0.6, "-", "sums over a side of a truck, over 5 ft"),
    "carbody lateral": Limit(_CFR, 0.65, "g", "peak to peak over 1 s, 10 Hz low pass"),
    "carbody vertical": Limit(_CFR, 1.0, "g", "peak to peak over 1 s, 10 Hz low pass"),
    "carbody lateral sustained": Limit(_CFR, 0.10, "g", "RMS_t over 4 s"),
    "carbody vertical sustained": Limit(_CFR, 0.25, "g", "RMS_t over 4 s"),
    "truck lateral": Limit(_CFR, 0.30, "g", "RMS_t over 2 s, 10 Hz low pass"),
}
COMFORT_STEPS = (
    Limit("EN 12299:2009", 1.5, "-", "N_MV below: very comfortable"),
    Limit("EN 12299:2009", 2.5, "-", "N_MV below: comfortable"),
    Limit("EN 12299:2009", 3.5, "-", "N_MV below: medium"),
    Limit("EN 12299:2009", 4.5, "-", "N_MV below: uncomfortable; above: very uncomfortable"),
)
# The older scale of the same index; above the last: very poor.
UIC_513_STEPS = (
    Limit("UIC 513:1994", 1.0, "-", "N_MV below: very good"),
    Limit("UIC 513:1994", 2.0, "-", "N_MV below: good"),
    Limit("UIC 513:1994", 4.0, "-", "N_MV below: moderate"),
    Limit("UIC 513:1994", 5.0, "-", "N_MV below: poor; above: very poor"),
)


def single_wheel_limit(flange_angle: float) -> float:
    """L/V of a wheel by 49 CFR 213.333: Nadal's limit at a friction of 0.5; flange angle [rad]."""
    return nadal_limit(flange_angle, 0.5)


def net_axle_limit(axle_load: float) -> float:
    """Net axle L/V by 49 CFR 213.333: 0.4 + 5/V_a; axle_load V_a static [N]."""
    return 0.4 + 5.0 / (axle_load / _KIP)


def peak_to_peak(time: Array, values: Array, window: float = 1.0) -> float:
    """Greatest difference of values (m,) at equal times (m,) [s] within a window [s]."""
    rows = _windows(time, values, window)
    return float(np.max(rows.max(axis=1) - rows.min(axis=1)))


def detrended_rms(time: Array, values: Array, window: float = 4.0) -> float:
    """RMS_t: greatest root mean square, over windows [s], of values less their straight line."""
    rows = _windows(time, values, window)
    x = np.arange(rows.shape[1]) - 0.5 * (rows.shape[1] - 1)
    mean = rows.mean(axis=1)
    slope = rows @ x / (x @ x)
    squares = np.mean(rows**2, axis=1) - mean**2 - slope**2 * np.mean(x * x)
    return float(np.sqrt(max(float(squares.max()), 0.0)))


def _windows(time: Array, values: Array, window: float) -> Array:
    step = float(time[-1] - time[0]) / max(len(time) - 1, 1)
    count = round(window / step) + 1 if step > 0.0 else 0
    if count < 2 or count > len(values):
        raise AnalysisError(
            f"windows of {window:g} s: the motion has {len(time)} samples over "
            f"{time[-1] - time[0]:.4g} s: run longer"
        )
    return np.lib.stride_tricks.sliding_window_view(np.asarray(values, dtype=float), count)
