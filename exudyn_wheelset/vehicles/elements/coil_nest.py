"""A nest of coils with its friction wedges: the suspension of one side of a three-piece truck.

The coils are a Spring in the middle, the wedges stand before and behind them, half of `spacing`
away (friction_wedge.py): so a bolster that turns in the side frame (warp) rubs on both.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from exudyn_wheelset.checking import number
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.friction_wedge import FrictionWedge
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    Vector,
    checked_along,
)


@dataclass(frozen=True)
class CoilNest(Element):
    """Coils between side frame (lower) and bolster (upper), with a wedge at either end.

    stiffness (x, y, z) [N/m], damping (x, y, z) [N s/m] of the coils; wedge: each of the two;
    spacing [m]: of the wedges along the track.

    Examples
    --------
    >>> from exudyn_wheelset import CoilNest, FrictionWedge
    >>> wedge = FrictionWedge(angle=32, friction=0.4, column_force=18e3, spring=2e5)
    >>> float(CoilNest((1.5e6, 1.5e6, 2.5e6), wedge).static_stiffness()[2, 2])
    2900000.0
    """

    stiffness: Vector
    wedge: FrictionWedge
    spacing: float = 0.4
    damping: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        put = object.__setattr__
        stiffness, damping = checked_along("CoilNest", self.stiffness, self.damping)
        put(self, "stiffness", stiffness)
        put(self, "damping", damping)
        if not isinstance(self.wedge, FrictionWedge):
            raise WheelsetError(f"CoilNest: wedge = {self.wedge!r}: give a FrictionWedge")
        put(self, "spacing", number("CoilNest: spacing", self.spacing, "m", 0.0, 2.0))

    def laws(self) -> tuple[Law, ...]:
        """The coils and two wedges."""
        coils = Law(layout.SPRING, stiffness=self.stiffness, damping=self.damping)
        return (
            coils,
            *(
                replace(law, shift=(0.5 * self.spacing * side, 0.0, 0.0))
                for side in (1.0, -1.0)
                for law in replace(self.wedge, ahead=side > 0.0).laws()
            ),
        )
