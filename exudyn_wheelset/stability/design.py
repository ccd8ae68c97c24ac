"""Design: change a few numbers of a vehicle until its critical speeds are as wanted.

With g_i the influences of the numbers (per cent of speed for one per cent of the number), the
relative changes r that reach the wanted speed are many; taken are the smallest together,
r = g (g.g)^-1 (V_wanted/V - 1), for several speeds by least squares, at most `largest_step` at a
time; then the speeds are computed anew.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from exudyn_wheelset.checking import positive, refuse_options, whole
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.hunting.nonlinear import nonlinear_critical_speed
from exudyn_wheelset.stability.numbers import number_of
from exudyn_wheelset.stability.subject import as_system, changed, description_of

SPEEDS = ("linear_critical_speed", "nonlinear_critical_speed")


@brief
@dataclass(frozen=True, eq=False)
class Design:
    """A vehicle that has been changed to reach critical speeds.

    vehicle   the changed description
    changes   value before and after, by name
    reached   critical speeds [m/s] of it, by name
    wanted    what they were to be [m/s]
    steps     gradient steps taken
    """

    vehicle: Any
    changes: dict[str, tuple[float, float]]
    reached: dict[str, float]
    wanted: dict[str, float]
    steps: int

    def __str__(self) -> str:
        lines = [
            f"{name.replace('_', ' ')} {self.reached[name]:.3f} m/s (wanted {wanted:.3f})"
            for name, wanted in self.wanted.items()
        ]
        for name, (before, after) in self.changes.items():
            share = f" ({100.0 * (after / before - 1.0):+.2f} %)" if before else ""
            lines.append(f"  {name}: {before:.6g} -> {after:.6g}{share}")
        return "\n".join(lines)


@spelt
def design(
    vehicle: Any,
    wanted: Mapping[str, float],
    vary: Sequence[str],
    *,
    tolerance: float = 1e-3,
    steps: int = 8,
    largest_step: float = 0.25,
    **options: Any,
) -> Design:
    """Change the numbers named in `vary` until the critical speeds are as `wanted` [m/s].

    wanted         "linear_critical_speed" and/or "nonlinear_critical_speed" with their values
    vary           names of numbers, paths of `Vehicle.replace`, none of which may be zero
    tolerance      relative, of the speeds
    largest_step   relative change of a number in one step; after `steps` of them it is given up
    options        of `nonlinear_critical_speed`

    Raises AnalysisError where the numbers cannot reach it, with how far they have come.

    Examples
    --------
    >>> from exudyn_wheelset import design
    >>> found = design("cooperrider", {"linear_critical_speed": 70.0}, vary=["conicity"])
    >>> [round(float(value), 4) for value in found.changes["conicity"]]
    [0.05, 0.0482]
    """
    known = inspect.signature(nonlinear_critical_speed).parameters
    refuse_options(nonlinear_critical_speed, [name for name in options if name not in known])
    for name in wanted:
        if name not in SPEEDS:
            raise AnalysisError(f"{name!r} cannot be asked for: give {' or '.join(SPEEDS)}")
    if not wanted or not vary:
        raise AnalysisError("give at least one speed to reach and one number to vary")
    tolerance = positive("tolerance", tolerance, "-", 1.0)
    largest_step = positive("largest_step", largest_step, "-", 1.0)
    steps = whole("steps", steps, 1)
    for name, speed in wanted.items():
        positive(name, speed, "m/s")
    description = description_of(vehicle)
    first = {name: number_of(description, name).value for name in vary}
    if not all(first.values()):
        raise AnalysisError(f"a number that is zero has no per cent to change: {first}")
    goal = np.array([float(wanted[name]) for name in wanted])
    values = dict(first)
    for step in range(steps + 1):
        found = {name: _speed(description, name, options) for name in wanted}
        speeds = np.array([float(speed) for speed in found.values()])
        if np.all(np.abs(speeds / goal - 1.0) < tolerance):
            reached = dict(zip(wanted, map(float, speeds), strict=True))
            changes = {name: (first[name], values[name]) for name in vary}
            return Design(description, changes, reached, dict(wanted), step)
        gradients = [speed.gradient(vary) for speed in found.values()]
        matrix = np.array([[g.influence[name] for name in vary] for g in gradients])
        change = np.linalg.lstsq(matrix, np.log(goal / speeds), rcond=1e-6)[0]
        largest = float(np.max(np.abs(change)))
        if largest == 0.0:
            break
        change *= min(1.0, largest_step / largest)
        for name, share in zip(vary, change, strict=True):
            values[name] *= float(np.exp(share))
            description = changed(description, name, values[name])
    raise AnalysisError(
        f"{', '.join(vary)} did not bring {', '.join(wanted)} to {goal.tolist()} m/s in {steps} "
        f"steps: {speeds.tolist()} m/s were reached with {values}"
    )


def _speed(description: Any, name: str, options: Mapping[str, Any]) -> Any:
    if name == "nonlinear_critical_speed":
        return nonlinear_critical_speed(description, **options)
    from exudyn_wheelset.stability.hunting.nonlinear import _first_hopf

    low, high = options.get("low"), options.get("high")
    return _first_hopf(as_system(description), low, high)
