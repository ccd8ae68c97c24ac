"""A system that is known only by its description: what is left of a model in a stored result."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NoReturn

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.systems.system import DynamicSystem

_FACTS = (
    "name",
    "state_names",
    "scales",
    "displacement_indices",
    "lateral_indices",
    "yaw_indices",
    "lateral_limit",
    "speeds",
    "wheelset_names",
    "trucks",
    "stiff",
)


class DescribedSystem(DynamicSystem):
    """Names, scales and measures of a system; its equations stayed behind.

    Exudyn's models cannot be pickled. A result that holds one is stored with this in its place, so
    that modes keep their names.
    """

    def __init__(self, facts: Mapping[str, Any], measures: Mapping[str, Any]) -> None:
        self._facts, self._measures = dict(facts), dict(measures)
        for name, value in facts.items():
            setattr(self, name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._facts, self._measures)

    def derivative(self, state: Array, speed: float) -> NoReturn:
        """Not known any more: raises AnalysisError."""
        raise AnalysisError(
            f"{self.name}: this result was stored without its model; build the model again to "
            "evaluate it"
        )

    def measures(self) -> dict[str, Any]:
        return dict(self._measures)


def described(system: DynamicSystem) -> DescribedSystem:
    """The description of a system."""
    facts = {name: getattr(system, name) for name in _FACTS}
    facts["trucks"] = dict(system.trucks)
    return DescribedSystem(facts, system.measures())
