"""A bump stop: force over displacement by a table, after some play.

Potential: the integral of the table. No damping, no hysteresis, no jump of force or stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from exudyn_wheelset.checking import number
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.curve import checked_table, curve_of
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    Vector,
    checked_direction,
    mirrored_direction,
)


@dataclass(frozen=True)
class BumpStop(Element):
    """Force [N] over displacement [m] along a direction of the element's axes.

    table: pairs (displacement [m], force [N]) from (0, 0) on, rising; monotone cubic between
    them, straight on beyond the last, the same for both signs unless both are given. play [m]:
    free way to either side before the table begins.

    Examples
    --------
    >>> from exudyn_wheelset import BumpStop
    >>> stop = BumpStop((0, 1, 0), table=[(0, 0), (0.025, 0), (0.03, 600), (0.035, 1760)])
    >>> stop.direction
    (0.0, 1.0, 0.0)
    """

    direction: Vector
    table: Any
    play: float = 0.0

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "direction", checked_direction("BumpStop", self.direction))
        put(self, "table", checked_table("BumpStop: table", self.table, "m", "N"))
        put(self, "play", number("BumpStop: play", self.play, "m", 0.0, 1.0))
        self.laws()

    def laws(self) -> tuple[Law, ...]:
        """One stop."""
        return (
            Law(
                layout.DIRECTED,
                direction=self.direction,
                stop=curve_of(self.table, self.play),
            ),
        )

    def mirrored(self) -> BumpStop:
        """The stop as a mirror shows it."""
        return replace(self, direction=mirrored_direction(self.direction))
