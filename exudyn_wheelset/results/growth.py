"""Growth rate and frequency of a simulated motion, by a fit that knows nothing of eigenvalues.

The fit is the decaying or growing sinusoid nearest to the motion. Beside an eigenvalue it is taken
where the motion is linear: after the first period, in which fast modes die away, and while it is
small.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from exudyn_wheelset.errors import AnalysisError


@dataclass(frozen=True)
class Growth:
    """Growth rate [1/s], frequency [Hz] and what remains of the motion beside it, relative."""

    rate: float
    frequency: float
    residual: float


def measure_growth(t: np.ndarray, y: np.ndarray) -> Growth:
    """Growth rate and frequency of the sinusoid in y(t), samples at equal times [s].

    Least squares of exp(rate t) (A cos + B sin) + C; the start comes from the crossings of the
    mean. Raises AnalysisError for fewer than two periods.
    """
    t = np.asarray(t, dtype=float)
    y = np.asarray(y, dtype=float)
    centred = y - y.mean() if len(y) else y
    size = float(np.sqrt(np.mean(centred**2))) if len(y) else 0.0
    crossings = np.flatnonzero(np.diff(np.signbit(centred)))
    if len(t) < 20 or len(crossings) < 4:
        raise AnalysisError(
            f"{len(crossings)} zero crossings in {len(t)} samples of linear motion: a growth rate "
            "needs two periods of oscillation; release from a smaller offset, or simulate longer"
        )
    between = t[crossings[-1]] - t[crossings[0]]
    first = np.pi * (len(crossings) - 1) / between
    origin = t - t[0]
    # The fit stops by absolute measures: a motion of micrometres must not look solved.
    scaled = centred / size

    def rest(x: np.ndarray) -> np.ndarray:
        swell = np.exp(x[0] * origin)
        basis = np.column_stack(
            [swell * np.cos(x[1] * origin), swell * np.sin(x[1] * origin), np.ones_like(origin)]
        )
        return np.asarray(scaled - basis @ np.linalg.lstsq(basis, scaled, rcond=None)[0])

    found = least_squares(rest, [0.0, first], x_scale=[0.1 * first, 0.1 * first])
    return Growth(
        rate=float(found.x[0]),
        frequency=float(abs(found.x[1])) / (2.0 * np.pi),
        residual=float(np.sqrt(np.mean(found.fun**2))),
    )


def growth_beside(
    root: complex, time: np.ndarray, y: np.ndarray, largest: float
) -> dict[str, float | str | None]:
    """Growth and frequency of a root [1/s] beside those of the motion y(time) about zero.

    Measured in the longer of the stretches before and after |y| exceeds `largest`, after the first
    period. The simulated ones are None, with a note, where there are no two periods of that.
    """
    numbers: dict[str, Any] = {
        "growth_rate_eigenvalue": root.real,
        "frequency_eigenvalue": root.imag / (2.0 * np.pi),
        "growth_rate_simulated": None,
        "frequency_simulated": None,
    }
    settled = time >= 2.0 * np.pi / root.imag
    large = np.flatnonzero(np.abs(y) > largest)
    if len(large):
        before, after = settled & (time < time[large[0]]), settled & (time > time[large[-1]])
        settled = before if before.sum() >= after.sum() else after
    try:
        growth = measure_growth(time[settled], y[settled])
    except AnalysisError as error:
        return {**numbers, "growth_rate_simulated_note": str(error)}
    return {
        **numbers,
        "growth_rate_simulated": growth.rate,
        "frequency_simulated": growth.frequency,
    }
