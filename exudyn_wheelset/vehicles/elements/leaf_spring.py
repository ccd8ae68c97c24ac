"""A leaf spring: vertical, its leaves rub on each other with a part of its load.

F = N (1 - e h), N = k c its elastic force, h the hold of the leaves: loaded and unloaded slowly it
follows k c (1 + e) and k c (1 - e), and goes over from one to the other exponentially within
`presliding`, as P. Fancher et al. measured it (SAE Paper 800905, 1980). The load keeps to the
vertical of the track. Springs and dampers along and across are linear.
"""

from __future__ import annotations

from dataclasses import dataclass

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.vehicles import friction_kernel, layout
from exudyn_wheelset.vehicles.elements.friction import (
    ALONG_Z,
    DAMPING_TIME,
    Friction,
    Sliding,
    checked_damping_time,
    checked_presliding,
)
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    Vector,
    checked_along,
)


@dataclass(frozen=True)
class LeafSpring(Element):
    """Stiffness and damping (x, y, z) [N/m], [N s/m]; friction [-]: of the leaves, over the load.

    presliding [m]: within which the force changes over; damping_time [s]: of the hold.

    Examples
    --------
    >>> from exudyn_wheelset import LeafSpring
    >>> LeafSpring((2e6, 1e6, 1.2e6), friction=0.07).friction
    0.07
    """

    stiffness: Vector
    friction: float = 0.07
    damping: Vector = (0.0, 0.0, 0.0)
    presliding: float = 1.0e-3
    damping_time: float = DAMPING_TIME

    def __post_init__(self) -> None:
        put = object.__setattr__
        stiffness, damping = checked_along("LeafSpring", self.stiffness, self.damping)
        put(self, "stiffness", stiffness)
        put(self, "damping", damping)
        positive("LeafSpring: stiffness z", self.stiffness[2], "N/m")
        friction = number(
            "LeafSpring: friction", self.friction, "-", 0.0, 0.9, "a part of the load"
        )
        put(self, "friction", friction)
        put(self, "presliding", checked_presliding("LeafSpring: presliding", self.presliding))
        time = checked_damping_time("LeafSpring: damping_time", self.damping_time)
        put(self, "damping_time", time)

    def laws(self) -> tuple[Law, ...]:
        """The leaves, and what is linear."""
        x, y, z = self.stiffness
        friction = Friction(
            friction_kernel.PRESSED,
            (Sliding("leaf", ALONG_Z, self.friction, self.presliding),),
            stiffness=z,
            damping_time=self.damping_time,
        )
        leaves = Law(layout.FRICTION, friction=friction, upright=True)
        if not (x or y or any(self.damping)):
            return (leaves,)
        return (leaves, Law(layout.SPRING, stiffness=(x, y, 0.0), damping=self.damping))
