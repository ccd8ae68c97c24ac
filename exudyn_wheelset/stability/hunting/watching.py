"""Which displacements tell whether a vehicle hunts, and with what period to look at them.

Each truck is watched by itself, by the lateral displacement of its first wheelset: one may hunt
while another runs straight. A system without trucks is watched by one displacement.
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.checking import whole
from exudyn_wheelset.results.columns import column_index
from exudyn_wheelset.stability.linear.linearisation import hunting_mode, linearised
from exudyn_wheelset.stability.linear.modes import displacements
from exudyn_wheelset.systems.system import DynamicSystem


def watched_trucks(system: DynamicSystem, watch: str | int | None = None) -> dict[str, int]:
    """State whose peaks are watched, by truck; one under the name "" for a system without trucks.

    With `watch` (a name or an index) it is that displacement alone.
    """
    if watch is None and system.trucks:
        places = displacements(system)
        return {
            name: places[labels[0], "y"]
            for name, labels in system.trucks.items()
            if (labels[0], "y") in places
        }
    return {"": watched_index(system, watch)}


def watched_index(system: DynamicSystem, watch: str | int | None = None) -> int:
    """State whose peaks are watched: by name or index; else the first lateral displacement.

    That is the first wheelset's where the system knows its wheelsets. Elsewhere lateral means a
    name that begins with y (after the body's name and a colon); without one it is the first
    displacement.
    """
    if isinstance(watch, str):
        return column_index(system.state_names, watch)
    if watch is not None:
        return whole("watch (a displacement's name or place)", watch, 0, system.size - 1)
    if system.lateral_indices:
        return system.lateral_indices[0]
    for index in system.displacement_indices:
        name = system.state_names[index].split(": ")[-1].split(" [")[0]
        if name == "y" or name.startswith("y_"):
            return index
    return system.displacement_indices[0]


def typical_period(system: DynamicSystem, speed: float) -> float:
    """Period [s] of the least damped hunting mode about the equilibrium at a speed [m/s].

    Of the least damped oscillation where no mode hunts. Raises AnalysisError if nothing oscillates.
    """
    return 2.0 * np.pi / abs(hunting_mode(linearised(system, speed))[0].imag)
