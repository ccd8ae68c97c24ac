"""A friction damper along a direction: elastic, then slipping at a constant force.

F' = k (v - |v| F/F_slip). Over cyclic motion of amplitude A it takes the work 4 F_slip A -
4 (F_slip^2/k) tanh(k A/F_slip), at any frequency: from -F_m on, F = F_slip - (F_slip + F_m)
exp(-k x/F_slip) after the way x, and F_m = F_slip tanh(k A/F_slip) closes the loop.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.vehicles import friction_kernel, layout
from exudyn_wheelset.vehicles.elements.friction import (
    Friction,
    Sliding,
    checked_damping_time,
)
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    Vector,
    checked_direction,
    checked_stiffness,
    mirrored_direction,
)


@dataclass(frozen=True)
class FrictionDamper(Element):
    """Friction of constant slip force [N] along a direction of the element's axes.

    force F_slip [N]; stiffness k [N/m] of the hold; damping_time [s]: viscous part of the hold, its
    loss factor over the angular frequency. Carries no load that stays.

    Examples
    --------
    >>> from exudyn_wheelset import FrictionDamper
    >>> FrictionDamper((0, 0, 1), force=5e3, stiffness=2e7).force
    5000.0
    """

    direction: Vector
    force: float
    stiffness: float
    damping_time: float = 0.0

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "direction", checked_direction("FrictionDamper", self.direction))
        put(self, "force", number("FrictionDamper: force", self.force, "N", 0.0, 1e9))
        stiffness = checked_stiffness("FrictionDamper: stiffness", self.stiffness)
        put(self, "stiffness", positive("FrictionDamper: stiffness", stiffness, "N/m"))
        time = checked_damping_time("FrictionDamper: damping_time", self.damping_time)
        put(self, "damping_time", time)

    def laws(self) -> tuple[Law, ...]:
        """One friction contact; none without a force."""
        if self.force == 0.0:
            return ()
        row = (*self.direction, 0.0, 0.0, 0.0)
        sliding = Sliding("", row, 1.0, self.force / self.stiffness)
        friction = Friction(
            friction_kernel.CONSTANT,
            (sliding,),
            force=self.force,
            damping_time=self.damping_time,
        )
        return (Law(layout.FRICTION, friction=friction),)

    def mirrored(self) -> FrictionDamper:
        """The damper as a mirror shows it."""
        return replace(self, direction=mirrored_direction(self.direction))
