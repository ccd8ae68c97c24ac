"""Forward speeds [m/s] at which an analysis may ask a system: each refusal names the way out.

Equations of one's own (`FunctionSystem`) may stand for anything, so their speed is any number. A
vehicle on wheels has creepages, slip by speed: none at rest, and above some 200 m/s no vehicle
runs, where km/h, mm/s or rad/s were meant. Equations that divide by the speed itself, not by its
size, hold forwards only.
"""

from __future__ import annotations

import math
from typing import Any

from exudyn_wheelset.checking import number
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.systems.system import DynamicSystem


def checked_speed(system: DynamicSystem, what: str, speed: Any) -> float:
    """`speed` as a float; AnalysisError where the system's equations do not hold at it."""
    value = number(what, speed, "m/s")
    slowest, fastest = system.speeds
    if math.isinf(fastest):
        return value
    if value == 0.0:
        raise AnalysisError(
            f"{what} = {value!r} m/s: {system.name} stands on its wheels and has no creepage, slip "
            "by speed: give a speed other than 0 m/s, such as 1"
        )
    if not slowest < value < fastest:
        direction = "runs forwards only: " if value < slowest == 0.0 else ""
        raise AnalysisError(
            f"{what} = {value!r} m/s: {system.name} {direction}give a speed between "
            f"{slowest:g} and {fastest:g} m/s; is it given in m/s?"
        )
    return value


def checked_range(system: DynamicSystem, low: Any, high: Any) -> tuple[float, float]:
    """(low, high) as floats; AnalysisError unless they rise and do not go through rest."""
    lower, upper = checked_speed(system, "low", low), checked_speed(system, "high", high)
    if not lower < upper:
        raise AnalysisError(
            f"the range of speeds must rise from low to high, got {low} to {high} m/s"
        )
    if lower < 0.0 < upper and not math.isinf(system.speeds[1]):
        raise AnalysisError(
            f"low = {low!r} m/s, high = {high!r} m/s: {system.name} has no creepage at rest, which "
            "lies between: give a low above 0 m/s, such as 1"
        )
    return lower, upper
