"""Ride comfort from accelerations: EN 12299 and Sperling's index; limits stand in limits.py.

Weightings of EN 12299:2009 (as ISO 2631-1:1997, ISO 8041), with s = i 2 pi f, w_k = 2 pi f_k:

    band limits   s^2/(s^2 + w_1 s/Q + w_1^2) w_2^2/(s^2 + w_2 s/Q + w_2^2), 0.4 and 100 Hz,
                  Q = 1/sqrt(2)
    transition    (s + w_3)/(s^2 + w_4 s/Q_2 + w_4^2) w_4^2/w_3
    step          (s^2 + w_5 s/Q_3 + w_5^2)/(s^2 + w_6 s/Q_4 + w_6^2), with the gain K: 1 for Wk,
                  0.4 (w_6/w_5)^2 = 1.024 for Wb

Mean comfort N_MV = 6 sqrt(a_x95^2 + a_y95^2 + a_z95^2), the 95 % points of the weighted root mean
squares over blocks of 5 s, x and y by Wd, z by Wb; continuous comfort is those root mean squares.
Sperling: Wz = 4.42 a_w^0.3, a_w the root mean square [m/s^2] weighted by

    B = b sqrt((1.911 f^2 + (0.25 f^2)^2)/((1 - 0.277 f^2)^2 + (1.563 f - 0.0368 f^3)^2)),

b = 0.588 vertical, 0.737 lateral (Garg and Dukkipati 1984). Weighted in the frequency domain over
the whole signal; accelerations in m/s^2 at equal times.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import unknown
from exudyn_wheelset.errors import AnalysisError

BLOCK = 5.0


@dataclass(frozen=True)
class Weighting:
    """A frequency weighting: corner frequencies [Hz] and qualities as in the module's header."""

    edition: str
    transition: tuple[float, float, float]
    step: tuple[float, float, float, float] | None = None
    gain: float = 1.0

    def response(self, frequency: Array) -> Array:
        """Complex response at frequencies [Hz]."""
        s = 2j * np.pi * np.asarray(frequency, dtype=float)
        w1, w2 = 2.0 * np.pi * 0.4, 2.0 * np.pi * 100.0
        root = np.sqrt(2.0)
        h = s**2 / (s**2 + w1 * root * s + w1**2) * w2**2 / (s**2 + w2 * root * s + w2**2)
        f3, f4, q2 = self.transition
        w3, w4 = 2.0 * np.pi * f3, 2.0 * np.pi * f4
        h = h * (s + w3) / (s**2 + w4 * s / q2 + w4**2) * w4**2 / w3
        if self.step is not None:
            f5, q3, f6, q4 = self.step
            w5, w6 = 2.0 * np.pi * f5, 2.0 * np.pi * f6
            h = h * (s**2 + w5 * s / q3 + w5**2) / (s**2 + w6 * s / q4 + w6**2)
        return np.asarray(self.gain * h)


_EDITION = "EN 12299:2009, ISO 2631-1:1997"
WEIGHTINGS = {
    "Wd": Weighting(_EDITION, (2.0, 2.0, 0.63)),
    "Wc": Weighting(_EDITION, (8.0, 8.0, 0.63)),
    "Wb": Weighting(_EDITION, (16.0, 16.0, 0.63), (2.5, 0.8, 4.0, 0.8), 0.4 * (4.0 / 2.5) ** 2),
    "Wk": Weighting(_EDITION, (12.5, 12.5, 0.63), (2.37, 0.91, 3.35, 0.91)),
}


def weighted(time: Array, acceleration: Array, weighting: str) -> Array:
    """Acceleration (m,) [m/s^2] at equal times (m,) [s], weighted by "Wd", "Wc", "Wb" or "Wk"."""
    if weighting not in WEIGHTINGS:
        raise unknown("weighting", weighting, tuple(WEIGHTINGS))
    frequency = np.fft.rfftfreq(len(time), _step(time))
    spectrum = np.fft.rfft(acceleration) * WEIGHTINGS[weighting].response(frequency)
    return np.asarray(np.fft.irfft(spectrum, len(time)))


def block_rms(time: Array, values: Array, block: float = BLOCK) -> Array:
    """Root mean squares (blocks,) of values over whole blocks [s], one after the other."""
    count = round(block / _step(time))
    blocks = len(values) // count
    if blocks < 1:
        raise AnalysisError(
            f"comfort is taken over blocks of {block:g} s, the motion has "
            f"{time[-1] - time[0]:.4g} s: run longer"
        )
    rows = np.asarray(values)[: blocks * count].reshape(blocks, count)
    return np.asarray(np.sqrt(np.mean(rows**2, axis=1)))


def mean_comfort(time: Array, x: Array, y: Array, z: Array) -> float:
    """N_MV of the accelerations (m,) [m/s^2] along x, y, z on the floor."""
    parts = [
        np.percentile(block_rms(time, weighted(time, values, name)), 95.0)
        for values, name in ((x, "Wd"), (y, "Wd"), (z, "Wb"))
    ]
    return float(6.0 * np.sqrt(np.sum(np.square(parts))))


def sperling(time: Array, acceleration: Array, vertical: bool = False) -> float:
    """Sperling's comfort index Wz of an acceleration (m,) [m/s^2], lateral or vertical."""
    f = np.fft.rfftfreq(len(time), _step(time))
    above = (1.0 - 0.277 * f**2) ** 2 + (1.563 * f - 0.0368 * f**3) ** 2
    weight = np.sqrt((1.911 * f**2 + (0.25 * f**2) ** 2) / above)
    weight *= 0.588 if vertical else 0.737
    values = np.fft.irfft(np.fft.rfft(acceleration) * weight, len(time))
    return float(4.42 * np.sqrt(np.mean(values**2)) ** 0.3)


def _step(time: Array) -> float:
    steps = np.diff(time)
    if len(steps) < 8 or np.ptp(steps) > 1e-6 * steps.mean():
        raise AnalysisError("comfort needs equal times: simulate with an interval")
    return float(steps.mean())
