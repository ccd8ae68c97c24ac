"""Running Exudyn's solver on a model: watched, interruptible, quiet, and without files.

Between its steps the solver lets Python look at the wheelsets and at the keyboard: a run ends where
a wheelset leaves the rails (derailment.py) or on Ctrl-C, and keeps what it has. Exudyn's files
(solution, restart, solver information) are written only where the settings give them names of their
own (`solution.file.name`): no folder `solution/` is left behind by who did not switch them off.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterable
from typing import Any

import exudyn as exu
from tqdm import tqdm

from exudyn_wheelset.coupling.derailment import DerailmentWatch
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
from exudyn_wheelset.results.endings import Ending, Outcome

# Wheelsets are looked at this often [s]: a derailing wheel needs some 20 ms over its flange.
CHECK_INTERVAL = 2.0e-3
# Names of Exudyn's files where none are given.
_DEFAULT: Any = exu.SimulationSettings().solution


class QuietExudyn:
    """Keeps Exudyn's messages off the console: a run that fails is reported by the exception."""

    def __enter__(self) -> None:
        config: Any = exu.config
        self._kept = (config.suppressWarnings, config.printToConsole)
        config.suppressWarnings, config.printToConsole = True, False

    def __exit__(self, *_: object) -> None:
        config: Any = exu.config
        config.suppressWarnings, config.printToConsole = self._kept


class OwnFilesOnly:
    """Keeps Exudyn from writing files, within a `with`, that the settings do not name."""

    def __init__(self, settings: exu.SimulationSettings) -> None:
        self._settings: Any = settings

    def __enter__(self) -> None:
        solution, integration = self._settings.solution, self._settings.timeIntegration
        self._kept = solution.file.write, solution.restart.write, integration.verboseModeFile
        solution.file.write &= solution.file.name != _DEFAULT.file.name
        solution.restart.write &= solution.restart.name != _DEFAULT.restart.name
        if solution.solverInformationFileName == _DEFAULT.solverInformationFileName:
            integration.verboseModeFile = 0

    def __exit__(self, *_: object) -> None:
        solution, integration = self._settings.solution, self._settings.timeIntegration
        solution.file.write, solution.restart.write, integration.verboseModeFile = self._kept


def copied_settings(settings: exu.SimulationSettings | None) -> exu.SimulationSettings:
    """A copy of Exudyn's settings (default: its own) that writes no files and says nothing.

    Accelerations at the end of an explicit step, a fifth evaluation of RK44 that changes no state,
    are left out.
    """
    copy = exu.SimulationSettings()
    if settings is not None:
        copy.SetDictionary(settings.GetDictionary())
    copy.solution.file.write = False
    copy.solution.restart.write = False
    copy.timeIntegration.verboseMode = 0
    copy.timeIntegration.verboseModeFile = 0
    copy.timeIntegration.explicit.computeEndOfStepAccelerations = False
    return copy


def failure_words(error: Exception) -> str:
    """The line of an exception that names the cause, without Exudyn's trace."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return " ".join(lines[:2]) if lines else type(error).__name__


def progress_bar(duration: float, shown: bool, description: str) -> tqdm:
    """Bar with the simulated seconds and the time that is left."""
    return tqdm(
        total=round(duration, 9),
        disable=not shown,
        desc=description,
        unit="s",
        bar_format="{desc}: {percentage:3.0f}%|{bar}| {n:.2f}/{total:.2f} s simulated, {remaining}",
    )


class _Overseer:
    """What is done between the solver's steps."""

    def __init__(
        self, start: float, end: float, contacts: Iterable[WheelRailContact], bar: tqdm, before: Any
    ) -> None:
        self.start, self.end = start, end
        self.watch = DerailmentWatch(contacts)
        self.watch.begin(start)
        self.bar = bar
        self.before = before
        self.stopped = threading.Event()
        self.outcome: Outcome | None = None
        # The solver asks for loads at other states before its first step.
        self.next_look = start + CHECK_INTERVAL

    def __call__(self, mbs: Any, time: float) -> bool:
        if self.before is not None and not self.before(mbs, time):
            return False
        if time < self.next_look:
            return True
        self.next_look = time + CHECK_INTERVAL
        self.bar.update(max(0.0, min(time, self.end) - self.start - self.bar.n))
        if self.stopped.is_set():
            self.outcome = Outcome(Ending.INTERRUPTED, f"at {time:.3f} s")
        else:
            self.outcome = self.watch.look(time)
        return self.outcome is None


def run_solver(
    mbs: Any,
    settings: exu.SimulationSettings,
    solver_type: Any = None,
    contacts: Iterable[WheelRailContact] = (),
    progress: bool = False,
    description: str = "simulating",
) -> Outcome:
    """Run the assembled model `mbs` from its initial values; what its sensors stored stays there.

    contacts: of the wheelsets to watch; progress: show a bar with the time that is left. The run
    ends before its time where a wheelset leaves the rails, where the solver or a user function
    gives up, or on Ctrl-C (in the main thread). The model's own user function before each step is
    called as well.
    """
    integration = settings.timeIntegration
    start, end = integration.startTime, integration.endTime
    bar = progress_bar(end - start, progress, description)
    before = mbs.GetPreStepUserFunction(asDict=True)
    theirs = before["function"] if isinstance(before, dict) else before or None
    overseer = _Overseer(start, end, contacts, bar, theirs)
    handler = None
    if threading.current_thread() is threading.main_thread():
        handler = signal.signal(signal.SIGINT, lambda *_: overseer.stopped.set())
    kind = integration.solverType if solver_type is None else solver_type
    mbs.SetPreStepUserFunction(overseer)
    try:
        with bar, QuietExudyn(), OwnFilesOnly(settings):
            try:
                done = mbs.SolveDynamic(settings, solverType=kind, showHints=False)
                found = Outcome(Ending.FINISHED if done else Ending.NO_CONVERGENCE)
            except Exception as error:
                found = Outcome(Ending.MODEL_FAILED, failure_words(error))
            outcome = overseer.outcome or found
            if outcome.ending is Ending.FINISHED:
                bar.update(end - start - bar.n)
    finally:
        mbs.SetPreStepUserFunction(theirs or 0)
        if handler is not None:
            signal.signal(signal.SIGINT, handler)
    return outcome
