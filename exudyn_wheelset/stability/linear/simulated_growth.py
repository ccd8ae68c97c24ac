"""Small motion simulated beside its eigenvalue: growth rate and frequency by two methods.

    rows, motions = compare_growth(system, speeds, offset=1e-3)
    rows, motions = compare_growth(system, speeds, amplitude=2e-5, near=critical)

A motion starts in steady running with all wheelsets moved sideways (`offset`), or in the shape of a
mode (`amplitude`), which moves as the linear equations say from the first moment on. What the
motion does is fitted without knowledge of eigenvalues (results/growth.py). Speeds in m/s, y in m.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.results.growth import growth_beside
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.stability.linear.linearisation import Linearisation, linearise
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.simulation import simulate

# A growth rate is measured up to this multiple of the start and this amplitude [m]: beyond, creep
# saturation starts to show.
LARGEST_GROWTH, LARGEST_AMPLITUDE = 2.0, 3.0e-3


def compare_growth(
    system: ExudynSystem,
    speeds: Sequence[float],
    duration: float = 6.0,
    interval: float = 2.0e-3,
    *,
    offset: float | None = None,
    amplitude: float | None = None,
    near: CriticalPoint | None = None,
    progress: bool = False,
) -> tuple[list[dict[str, Any]], list[Motion]]:
    """Motions at `speeds` [m/s], sampled every `interval` over `duration` [s], beside eigenvalues.

    offset     [m] all wheelsets are moved to the left by, or
    amplitude  [m] of the lateral motion in the shape of the mode; give one of the two
    near       the critical point whose mode is meant; default the least damped hunting

    Returns a row of numbers for each motion, and the motions: speed; growth rates [1/s] and
    frequencies [Hz] as of `growth_beside`; maximum_y and final_amplitude (in the last period) of
    the first wheelset [m]; largest_normal_force of any wheel [N]; simulated_time [s]; ending, the
    name of an Ending, and event, None or how it ended before its time. An interrupted motion is
    the last. Raises AnalysisError where nothing hunts.
    """
    if (offset is None) == (amplitude is None):
        raise AnalysisError("give the offset of the wheelsets or the amplitude of the mode [m]")
    rows: list[dict[str, Any]] = []
    motions: list[Motion] = []
    for speed in speeds:
        linear = linearise(system, float(speed))
        row = linear.hunting_row if near is None else nearest_row(linear, near)
        if row is None:
            raise AnalysisError(f"{system.name}: no lateral oscillation at {speed:g} m/s")
        start: float | Array = 0.0 if offset is None else offset
        if amplitude is not None:
            start = mode_start(system, linear, row, amplitude)
        motion = simulate(
            system, float(speed), duration, initial=start, interval=interval, progress=progress
        )
        size = abs(offset or amplitude or 0.0)
        rows.append(_numbers(system, linear, complex(linear.eigenvalues[row]), motion, size))
        motions.append(motion)
        if motion.outcome.ending is Ending.INTERRUPTED:
            break
    return rows, motions


def mode_start(system: ExudynSystem, linear: Linearisation, row: int, amplitude: float) -> Array:
    """Equilibrium (n,) plus a mode whose largest lateral displacement is at its peak [m]."""
    mode = linear.eigenvectors[:, row]
    lateral = [k for k, name in enumerate(system.state_names) if name.split(": ")[-1] == "y [m]"]
    largest = lateral[int(np.argmax(np.abs(mode[lateral])))]
    return np.asarray(linear.state + (mode * (amplitude / mode[largest])).real)


def nearest_row(linear: Linearisation, critical: CriticalPoint) -> int:
    """Place among the eigenvalues of the oscillation nearest to a critical point's."""
    values = linear.eigenvalues
    root = complex(0.0, abs(critical.eigenvalue.imag))
    return int(np.argmin(np.where(values.imag > 0.0, np.abs(values - root), np.inf)))


def _numbers(
    system: ExudynSystem, linear: Linearisation, root: complex, motion: Motion, start: float
) -> dict[str, Any]:
    y = motion[f"{system.wheelsets[0].name}: y"]
    beside = y - linear.state[system.lateral_indices[0]]
    last_period = motion.time >= motion.time[-1] - 2.0 * np.pi / root.imag
    forces = [motion.wheel(*wheel)["normal_force [N]"].max() for wheel in motion.wheels]
    finished = motion.outcome.ending is Ending.FINISHED
    largest = min(LARGEST_GROWTH * start, LARGEST_AMPLITUDE)
    return {
        "speed": motion.speed,
        **growth_beside(root, motion.time, beside, largest),
        "maximum_y": float(np.abs(y).max()),
        "final_amplitude": float(np.abs(beside[last_period]).max()),
        "largest_normal_force": float(max(forces)),
        "simulated_time": float(motion.time[-1]),
        "ending": motion.outcome.ending.name,
        "event": None if finished else str(motion.outcome),
    }
