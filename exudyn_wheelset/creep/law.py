"""Description of a creep law: its name, its number for compiled code, its parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class CreepParameter:
    """One number that a creep law takes besides the state of the patch.

    `low` and `high` are the range allowed, both ends included; `whole` asks for a whole number.
    """

    name: str
    default: float
    low: float
    high: float
    meaning: str
    whole: bool = False


@dataclass(frozen=True)
class CreepLaw:
    """A creep law as `creep_kernel` knows it.

    `number` selects the law in compiled code; `parameters` are in the order of its array;
    `shorthands` are names that set several parameters at once.
    """

    name: str
    number: int
    source: str
    parameters: tuple[CreepParameter, ...] = ()
    shorthands: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def expand(self, parameters: Mapping[str, Any]) -> dict[str, Any]:
        """Parameters by their own names, shorthands replaced; a name given itself goes before."""
        expanded: dict[str, Any] = {}
        for name, value in parameters.items():
            for own in self.shorthands.get(name, ()):
                expanded.setdefault(own, value)
        own_names = {k: v for k, v in parameters.items() if k not in self.shorthands}
        return {**expanded, **own_names}

    def index(self, parameter: str) -> int:
        """Give the place of a parameter in the law's array; KeyError if there is none."""
        for i, known in enumerate(self.parameters):
            if known.name == parameter:
                return i
        raise KeyError(parameter)


SPIN_MOMENT = CreepParameter(
    "spin_moment",
    0.0,
    0.0,
    1.0,
    "0: no spin moment, 1: Kalker's linear moment, saturated",
    whole=True,
)
