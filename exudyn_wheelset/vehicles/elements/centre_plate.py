"""A flat centre plate: it carries the body, turns against friction, rocks on its edge, lifts off.

The plate is a disc of radius R in a bowl, on a bed of stiffness `stiffness` in all that only pushes
(friction_kernel.disc): it carries N, holds the body against rocking with stiffness R^2/4 times the
angle until an edge lifts at the moment N R/4, then less, and never more than N R, rocking on the
edge. Under uniform pressure it turns against the moment 2/3 mu N R and shifts against mu N; both
together slip where

    (F_x^2 + F_y^2)/(mu N)^2 + (M/(2/3 mu N R))^2 = 1,

the ellipse by which the limit surface of a disc is usually replaced (R. Howe, M. Cutkosky, Int. J.
Robotics Research 15 (1996) 557-572). The rim of the bowl stops the plate after `play`.
"""

from __future__ import annotations

from dataclasses import dataclass

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.vehicles import friction_kernel, layout
from exudyn_wheelset.vehicles.elements.friction import (
    ALONG_X,
    ALONG_Y,
    DAMPING_TIME,
    PRESLIDING,
    Friction,
    Sliding,
    checked_damping_time,
    checked_friction,
    checked_presliding,
)
from exudyn_wheelset.vehicles.elements.protocol import Element, Law, checked_stiffness


@dataclass(frozen=True)
class CentrePlate(Element):
    """A centre plate of the body (upper) in the bowl of the bolster (lower).

    radius [m]; friction [-]; stiffness [N/m]: vertical, of the whole face; play [m]: of the rim, to
    either side; stop [N/m]: stiffness of the rim; presliding [m], at 2/3 of the radius for turning;
    damping_time [s]: of the hold.

    Examples
    --------
    >>> from exudyn_wheelset import CentrePlate
    >>> CentrePlate(radius=0.178, friction=0.3).play
    0.003
    """

    radius: float
    friction: float
    stiffness: float = 3.0e9
    play: float = 3.0e-3
    stop: float = 5.0e7
    presliding: float = PRESLIDING
    damping_time: float = DAMPING_TIME

    def __post_init__(self) -> None:
        put = object.__setattr__
        name = "CentrePlate"
        put(self, "radius", positive(f"{name}: radius", self.radius, "m", 2.0, "metres are asked"))
        put(self, "friction", checked_friction(f"{name}: friction", self.friction))
        for what in ("stiffness", "stop"):
            value = checked_stiffness(f"{name}: {what}", getattr(self, what))
            put(self, what, value)
        positive(f"{name}: stiffness", self.stiffness, "N/m")
        put(self, "play", number(f"{name}: play", self.play, "m", 0.0, 0.1, "metres are asked"))
        put(self, "presliding", checked_presliding(f"{name}: presliding", self.presliding))
        time = checked_damping_time(f"{name}: damping_time", self.damping_time)
        put(self, "damping_time", time)

    def laws(self) -> tuple[Law, ...]:
        """One disc."""
        turning = (0.0, 0.0, 0.0, 0.0, 0.0, 2.0 * self.radius / 3.0)
        slidings = tuple(
            Sliding(name, row, self.friction, self.presliding)
            for name, row in (("longitudinal", ALONG_X), ("lateral", ALONG_Y), ("yaw", turning))
        )
        friction = Friction(
            friction_kernel.DISC,
            slidings,
            stiffness=self.stiffness,
            radius=self.radius,
            play=self.play,
            stop=self.stop,
            damping_time=self.damping_time,
        )
        return (Law(layout.FRICTION, friction=friction),)
