"""Description of a creep law: its name, its number for compiled code, its parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from exudyn_wheelset.errors import WheelsetError


@dataclass(frozen=True)
class CreepParameter:
    """One number that a creep law takes besides the state of the patch.

    `low` and `high` are the range allowed, both ends included; `whole` asks for a whole number;
    `words` are names of values, accepted in their place.
    """

    name: str
    default: float
    low: float
    high: float
    meaning: str
    whole: bool = False
    words: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class CreepLaw:
    """A creep law as `creep_kernel` knows it.

    `number` selects the law in compiled code; `parameters` are in the order of its array;
    `shorthands` are names that set several parameters at once; `function` is that of a law of
    one's own (exudyn_wheelset.creep.own); `when_linearised` says what a Jacobian holds of a law
    that has no derivative at zero creepage with spin, the equilibrium of a wheelset on its rails.
    """

    name: str
    number: int
    source: str
    parameters: tuple[CreepParameter, ...] = ()
    shorthands: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    function: Any = None
    when_linearised: str = ""

    def expand(self, parameters: Mapping[str, Any]) -> dict[str, Any]:
        """Parameters by their own names, shorthands and words replaced.

        A name given itself goes before a shorthand. Raises WheelsetError for an unknown word.
        """
        expanded: dict[str, Any] = {}
        for name, value in parameters.items():
            for own in self.shorthands.get(name, ()):
                expanded.setdefault(own, value)
        own_names = {k: v for k, v in parameters.items() if k not in self.shorthands}
        return {name: self._number(name, v) for name, v in {**expanded, **own_names}.items()}

    def _number(self, name: str, value: Any) -> Any:
        """Value of a parameter given by a word; any other value as it is."""
        if not isinstance(value, str):
            return value
        words = {w: v for p in self.parameters if p.name == name for w, v in p.words}
        if value in words:
            return words[value]
        known = ", ".join(map(repr, words))
        raise WheelsetError(
            f"{name} = {value!r} of creep law {self.name!r}: give "
            + (f"one of {known}" if words else "a number")
        )

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
