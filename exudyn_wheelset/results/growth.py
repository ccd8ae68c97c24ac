"""Growth rate and frequency of a simulated motion, by a fit that knows nothing of eigenvalues.

The fit is the decaying or growing sinusoid nearest to the motion.
"""

from __future__ import annotations

from dataclasses import dataclass

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
        return scaled - basis @ np.linalg.lstsq(basis, scaled, rcond=None)[0]

    found = least_squares(rest, [0.0, first], x_scale=[0.1 * first, 0.1 * first])
    return Growth(
        rate=float(found.x[0]),
        frequency=float(abs(found.x[1])) / (2.0 * np.pi),
        residual=float(np.sqrt(np.mean(found.fun**2))),
    )
