"""Time simulation with a progress bar, derailment as an ending and Ctrl-C that keeps the results.

Exudyn's solver runs a model; between its steps this module looks at the contacts and at the
keyboard. Growth rate and frequency of what was simulated come from a fit that knows nothing of
eigenvalues: the decaying or growing sinusoid nearest to the motion.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import numpy as np
from scipy.optimize import least_squares

from exudyn_wheelset.coupling.running import run_solver
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results import endings


@dataclass(frozen=True)
class Ending:
    """How a simulation ended.

    time [s]: simulated; event: None at the planned end, else what ended the run before;
    interrupted: by Ctrl-C.
    """

    time: float
    event: str | None = None
    interrupted: bool = False


@dataclass(frozen=True)
class Growth:
    """Growth rate [1/s], frequency [Hz] and what remains of the motion beside it, relative."""

    rate: float
    frequency: float
    residual: float


def set_duration(settings: exu.SimulationSettings, duration: float) -> None:
    """Let a simulation last `duration` [s] with the settings' own time step."""
    integration = settings.timeIntegration
    step = (integration.endTime - integration.startTime) / integration.numberOfSteps
    integration.endTime = integration.startTime + duration
    integration.numberOfSteps = max(1, round(duration / step))


def simulate(
    mbs: Any,
    settings: exu.SimulationSettings,
    contacts: Iterable[WheelRailContact] = (),
    progress: bool = False,
    description: str = "simulating",
) -> Ending:
    """Run the assembled model `mbs` from its initial values; what its sensors stored stays there.

    The run ends before its time where one of `contacts` finds its wheelset derailed, where the
    solver gives up, or by Ctrl-C (in the main thread); the ending says which.
    """
    start = settings.timeIntegration.startTime
    outcome = run_solver(mbs, settings, None, contacts, progress, description)
    reached = float(mbs.systemData.GetTime()) - start
    event = None if outcome.ending is endings.Ending.FINISHED else str(outcome)
    return Ending(reached, event, outcome.ending is endings.Ending.INTERRUPTED)


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
