"""A rod with a spherical joint at either end: it pulls and pushes along its line.

Tension T = T0 + k (L - L0) + c L', L the distance of its ends; potential (L - L0) (T0 + k (L -
L0)/2), dissipation c L'^2. A rod under tension is the stiffer across its line, by T/L.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from exudyn_wheelset.checking import positive
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    Vector,
    checked_damping,
    checked_direction,
    checked_stiffness,
    mirrored_direction,
)


@dataclass(frozen=True)
class TractionRod(Element):
    """A rod of some length [m] along `direction`, which leads from the lower to the upper body.

    stiffness [N/m], damping [N s/m] along its line. The connection's place is its middle.

    Examples
    --------
    >>> from exudyn_wheelset import TractionRod
    >>> rod = TractionRod(5e6, damping=25e3, length=0.8)
    >>> float(rod.static_stiffness()[0, 0])
    5000000.0
    """

    stiffness: float
    damping: float = 0.0
    length: float = 1.0
    direction: Vector = (1.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "stiffness", checked_stiffness("TractionRod: stiffness", self.stiffness))
        put(self, "damping", checked_damping("TractionRod: damping", self.damping))
        put(self, "length", positive("TractionRod: length", self.length, "m", 20.0))
        put(self, "direction", checked_direction("TractionRod", self.direction))

    def places(self, at: Sequence[float]) -> tuple[Vector, Vector]:
        """Half a length to either side of the middle."""
        half = [0.5 * self.length * value for value in self.direction]
        lower = tuple(centre - away for centre, away in zip(at, half, strict=True))
        upper = tuple(centre + away for centre, away in zip(at, half, strict=True))
        return lower, upper  # type: ignore[return-value]

    def laws(self) -> tuple[Law, ...]:
        """One rod."""
        return (
            Law(
                layout.ROD,
                stiffness=(self.stiffness, 0.0, 0.0),
                damping=(self.damping, 0.0, 0.0),
            ),
        )

    def mirrored(self) -> TractionRod:
        """The rod as a mirror shows it."""
        return replace(self, direction=mirrored_direction(self.direction))
