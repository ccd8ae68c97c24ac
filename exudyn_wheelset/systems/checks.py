"""What ExudynSystem refuses of its arguments: each with the value and the mend."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import positive
from exudyn_wheelset.errors import AnalysisError


def check_arguments(mbs: Any, container: Any, name: Any, settings: Any) -> None:
    """Raise AnalysisError where an argument is not of its kind, or two have changed places."""
    if not isinstance(mbs, exu.MainSystem):
        raise AnalysisError(
            f"mbs is a {type(mbs).__name__}: give Exudyn's system first, then its container: "
            "ExudynSystem(mbs, SC)"
        )
    if not isinstance(container, exu.SystemContainer | None):
        raise AnalysisError(
            f"SC is a {type(container).__name__}: give the SystemContainer of the system, "
            "ExudynSystem(mbs, SC)"
        )
    if not isinstance(name, str):
        raise AnalysisError(f"name = {name!r}: give a text")
    if not isinstance(settings, exu.SimulationSettings | None):
        raise AnalysisError(
            f"settings is a {type(settings).__name__}: give exudyn.SimulationSettings(), or "
            "load_settings(...) for a file or a mapping"
        )


def check_states(
    name: str,
    found: Sequence[str],
    state_names: Sequence[str],
    scales: Any,
    displacements: Sequence[int],
) -> Array:
    """The scales (n,) as numbers; AnalysisError where names, scales or indices do not fit."""
    for what, given in (("state_names", state_names), ("scales", scales)):
        if isinstance(given, str) or len(given) != len(found):
            count = "a text" if isinstance(given, str) else f"{len(given)} entries"
            raise AnalysisError(
                f"{name}: {what} has {count}, the system has {len(found)} states: "
                f"{', '.join(found)}"
            )
    for index in displacements:
        if isinstance(index, bool) or not isinstance(index, int | np.integer):
            raise AnalysisError(
                f"{name}: displacement_indices holds {index!r}: give numbers of states"
            )
        if not 0 <= index < len(found):
            raise AnalysisError(
                f"{name}: displacement_indices holds {index}: give 0 to {len(found) - 1}"
            )
    return np.array(
        [positive(f"scale of {a}", b, "SI") for a, b in zip(found, scales, strict=True)]
    )
