"""An air spring: a static spring, and vertically a Maxwell branch for the air in the pipe.

The bellows' and reservoir's air together give the static stiffness; the pipe between them lets the
reservoir take part only slowly, so that fast motion meets the stiffness k_z + k_surge with a loss
around the frequency k_surge/(2 pi c_surge) (Berg, Vehicle System Dynamics 33 (2000) 272-284,
without the mass of the air). Potential of the spring and of the branch, dissipation F s'.
"""

from __future__ import annotations

from dataclasses import dataclass

from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.damper import STROKE
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    Vector,
    checked_along,
    checked_damping,
    checked_stiffness,
)


@dataclass(frozen=True)
class AirSpring(Element):
    """Static stiffness (x, y, z) [N/m] and damping [N s/m]; the surge's stiffness and damping.

    surge_stiffness [N/m]: what fast vertical motion meets beyond the static stiffness;
    surge_damping [N s/m]: of the pipe.

    Examples
    --------
    >>> from exudyn_wheelset import AirSpring
    >>> spring = AirSpring((1.6e5, 1.6e5, 4.3e5), surge_stiffness=2e5, surge_damping=2e4)
    >>> float(spring.static_stiffness()[2, 2])
    430000.0
    """

    stiffness: Vector
    surge_stiffness: float
    surge_damping: float
    damping: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        put = object.__setattr__
        stiffness, damping = checked_along("AirSpring", self.stiffness, self.damping)
        put(self, "stiffness", stiffness)
        put(self, "damping", damping)
        surge = checked_stiffness("AirSpring: surge_stiffness", self.surge_stiffness)
        put(self, "surge_stiffness", surge)
        put(self, "surge_damping", checked_damping("AirSpring: surge_damping", self.surge_damping))

    def laws(self) -> tuple[Law, ...]:
        """A spring, and a Maxwell branch where the surge has both its numbers."""
        spring = Law(layout.SPRING, stiffness=self.stiffness, damping=self.damping)
        if self.surge_stiffness == 0.0 or self.surge_damping == 0.0:
            return (spring,)
        branch = Law(
            layout.DIRECTED,
            stiffness=(self.surge_stiffness, 0.0, 0.0),
            damping=(self.surge_damping, 0.0, 0.0),
            direction=(0.0, 0.0, 1.0),
            state=STROKE,
        )
        return (spring, branch)
