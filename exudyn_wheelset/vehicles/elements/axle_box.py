"""The bearing of an axle box: a body held on the axle line at two points.

The spin of the wheelset does not move points of its axle, so springs at two of them hold the box
against everything but turning about the axle; no joint is needed. Potential and dissipation are
those of the two springs.
"""

from __future__ import annotations

from dataclasses import dataclass

from exudyn_wheelset.checking import positive
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    Vector,
    checked_along,
)


@dataclass(frozen=True)
class AxleBox(Element):
    """Stiffness (x, y, z) [N/m] and damping [N s/m] of each of two points on the axle.

    spacing [m]: of the two points, half of it to either side of the connection's place. The lower
    end is the wheelset, the upper one the box, a body of its own.

    Examples
    --------
    >>> from exudyn_wheelset import AxleBox
    >>> AxleBox(spacing=0.3).spacing
    0.3
    """

    stiffness: Vector = (2.0e8, 2.0e8, 2.0e8)
    damping: Vector = (2.0e4, 2.0e4, 2.0e4)
    spacing: float = 0.2

    def __post_init__(self) -> None:
        put = object.__setattr__
        stiffness, damping = checked_along("AxleBox", self.stiffness, self.damping)
        put(self, "stiffness", stiffness)
        put(self, "damping", damping)
        put(self, "spacing", positive("AxleBox: spacing", self.spacing, "m", 1.0))

    def laws(self) -> tuple[Law, ...]:
        """Two springs."""
        return tuple(
            Law(
                layout.SPRING,
                stiffness=self.stiffness,
                damping=self.damping,
                shift=(0.0, side, 0.0),
            )
            for side in (0.5 * self.spacing, -0.5 * self.spacing)
        )
