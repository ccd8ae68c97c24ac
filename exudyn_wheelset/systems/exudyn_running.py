"""Running Exudyn's solvers inside an analysis: without files, without messages, with its words."""

from __future__ import annotations

from typing import Any

import exudyn as exu


class QuietExudyn:
    """Keeps Exudyn's messages off the console: a run that fails is reported by the exception."""

    def __enter__(self) -> None:
        config: Any = exu.config
        self._kept = (config.suppressWarnings, config.printToConsole)
        config.suppressWarnings, config.printToConsole = True, False

    def __exit__(self, *_: object) -> None:
        config: Any = exu.config
        config.suppressWarnings, config.printToConsole = self._kept


def copied_settings(settings: exu.SimulationSettings | None) -> exu.SimulationSettings:
    """A copy of Exudyn's settings (default: its own) that writes no files and says nothing."""
    copy = exu.SimulationSettings()
    if settings is not None:
        copy.SetDictionary(settings.GetDictionary())
    copy.solution.file.write = False
    copy.timeIntegration.verboseMode = 0
    return copy


def failure_words(error: Exception) -> str:
    """The line of an exception that names the cause, without Exudyn's trace."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return " ".join(lines[:2]) if lines else type(error).__name__
