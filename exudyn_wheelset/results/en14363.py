"""Assessment by EN 14363: filters, percentiles of sections, maximum values, running instability.

    low pass       20 Hz, without phase: a Butterworth filter of second order, forth and back, whose
                   cut-off is set so that both passes together have 1/sqrt(2) at 20 Hz; in all
                   of fourth order, gain 1/(1 + (sqrt(2) - 1)(f/20 Hz)^4)
    percentiles    0.15, 50 and 99.85 % of the samples of every section
    maximum, one-dimensional    mean + k s over the sections, k = 3 for running safety, 2.2 for
                   track loading and ride, 0 for quasi-static values
    maximum, two-dimensional    at the target of an influence x (cant deficiency): the regression
                   line and t s sqrt(1 + 1/n + (x - mean)^2/sum (x_i - mean)^2), Student's t of
                   n - 2 degrees at the confidence asked for (one-sided), s of the residuals
    instability    root mean square of the sum of Y over 100 m, every 10 m, band-passed f0 +- 2 Hz,
                   against half the limit of the sum of Y

Sampled at equal times; SI.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.signal import butter, sosfiltfilt
from scipy.stats import t as student

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.running_safety import sliding_mean

PERCENTILES = (0.15, 50.0, 99.85)
SAFETY, LOADING, QUASI_STATIC = 3.0, 2.2, 0.0


def low_pass(time: Array, values: Array, frequency: float = 20.0) -> Array:
    """Values (m, ...) at equal times (m,) [s] without what is faster than `frequency` [Hz]."""
    rate = _rate(time)
    cut = frequency / (np.sqrt(2.0) - 1.0) ** 0.25
    return _forth_and_back(butter(2, cut, "low", fs=rate, output="sos"), values, rate, cut)


def band_pass(time: Array, values: Array, centre: float, half_width: float = 2.0) -> Array:
    """Values (m, ...) within `centre` +- `half_width` [Hz], fourth order without phase."""
    rate = _rate(time)
    low, high = max(centre - half_width, 0.05), centre + half_width
    sections = butter(2, (low, high), "band", fs=rate, output="sos")
    return _forth_and_back(sections, values, rate, high)


def _rate(time: Array) -> float:
    steps = np.diff(time)
    if len(steps) < 8 or np.ptp(steps) > 1e-6 * steps.mean():
        raise AnalysisError(
            f"filters need equal times, the motion has {len(time)} samples with steps of "
            f"{steps.min(initial=0.0):g} to {steps.max(initial=0.0):g} s: simulate with an interval"
        )
    return float(1.0 / steps.mean())


def _forth_and_back(sections: Array, values: Array, rate: float, highest: float) -> Array:
    if highest >= 0.5 * rate:
        raise AnalysisError(
            f"a filter up to {highest:.4g} Hz needs more than {2 * highest:.4g} samples a second, "
            f"there are {rate:.4g}: simulate with interval={0.25 / highest:.2g}"
        )
    padding = min(len(values) - 1, int(3.0 * rate / highest))
    return np.asarray(sosfiltfilt(sections, values, axis=0, padlen=padding))


def section_percentiles(
    distance: Array,
    values: Array,
    length: float = 100.0,
    percentiles: Sequence[float] = PERCENTILES,
) -> Array:
    """Percentiles (sections, len(percentiles), ...) of values (m, ...) over sections [m].

    Linear between sorted samples. Raises AnalysisError where there is no whole section.
    """
    # The last sample stands for the way up to the next.
    way = (distance[-1] - distance[0]) * len(distance) / max(len(distance) - 1, 1)
    begins = distance[0] + length * np.arange(int(way / length + 1e-9))
    if not len(begins):
        raise AnalysisError(
            f"sections of {length:g} m: the motion has {distance[-1] - distance[0]:.4g} m: run "
            "longer, or take shorter sections"
        )
    rows = [(distance >= begin) & (distance < begin + length) for begin in begins]
    return np.array([np.percentile(values[inside], percentiles, axis=0) for inside in rows])


def maximum_value(sections: Array, factor: float = SAFETY) -> Array:
    """Mean + factor s over sections (n, ...), s with n - 1: the one-dimensional method."""
    spread = sections.std(axis=0, ddof=1) if len(sections) > 1 else 0.0 * sections[0]
    return np.asarray(sections.mean(axis=0) + factor * spread)


def maximum_at(
    influence: Array, sections: Array, target: float, confidence: float = 0.99
) -> tuple[float, float]:
    """Regression of sections (n,) on an influence (n,) at its target: value, upper limit.

    The two-dimensional method; the upper limit is that of one further section. Raises AnalysisError
    for fewer than three sections or an influence that does not vary.
    """
    x, y = np.asarray(influence, dtype=float), np.asarray(sections, dtype=float)
    spread = float(((x - x.mean()) ** 2).sum())
    if len(x) < 3 or spread == 0.0:
        raise AnalysisError(
            f"regression of {len(x)} sections, influence from {x.min():g} to {x.max():g}: give "
            "three or more whose influence differs"
        )
    slope = float(((x - x.mean()) * (y - y.mean())).sum() / spread)
    value = float(y.mean() + slope * (target - x.mean()))
    residuals = y - y.mean() - slope * (x - x.mean())
    s = float(np.sqrt((residuals**2).sum() / (len(x) - 2)))
    factor = float(student.ppf(confidence, len(x) - 2))
    more = factor * s * np.sqrt(1.0 + 1.0 / len(x) + (target - x.mean()) ** 2 / spread)
    return value, value + float(more)


def instability(
    time: Array, distance: Array, sum_of_y: Array, frequency: float, length: float = 100.0
) -> tuple[Array, Array]:
    """Centres [m] and root mean squares of the sum of Y (m, ...) [N] over 100 m every 10 m.

    frequency f0 [Hz]: of the hunting; the band is f0 +- 2 Hz.
    """
    banded = band_pass(time, sum_of_y, frequency)
    centres, squares = sliding_mean(distance, banded**2, length, 10.0)
    return centres, np.sqrt(squares)
