"""Time simulation with a progress bar, derailment as an ending and Ctrl-C that keeps the results.

Exudyn's solver runs a model; between its steps this module looks at the contacts and at the
keyboard.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import exudyn as exu

from exudyn_wheelset.coupling.running import run_solver
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
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
