"""A leaf spring hung on links: the suspension of two-axle wagons, with its friction.

The body hangs on the ends of the leaf spring by links, pendulums of the lengths L_x (along) and
L_y (across): displaced by x, y, their ends lie deeper by x^2/(2 L_x) + y^2/(2 L_y), which
compresses the spring further, so that a load N brings the body back by N x/L_x, N y/L_y
(friction_kernel.HUNG, one potential for all). Links roll and slide in their eyes: along and across
they resist first with the slip force (friction) N, after J. Piotrowski, Model of the UIC link
suspension for freight wagons, Archive of Applied Mechanics 73 (2003) 517-532, who has one spring in
series with dry friction beside the pendulum; here that spring yields gradually. Leaves rub
vertically as in leaf_spring.py. Links are plumb at rest: all acts along the axes of the track, so
that a body that rolls about its ends of the links is not pushed aside.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from exudyn_wheelset.checking import number, numbers, positive
from exudyn_wheelset.vehicles import friction_kernel, layout
from exudyn_wheelset.vehicles.elements.friction import (
    ALONG_X,
    ALONG_Y,
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
    checked_damping,
    checked_stiffness,
)


@dataclass(frozen=True)
class LinkSuspension(Element):
    """Leaf spring and links between an axle box (lower) and the body (upper).

    stiffness [N/m]: of the leaf spring; length (x, y) [m]: of the pendulums along and across;
    friction (x, y) [-]: slip force of the links over the load; leaf_friction [-]: of the leaves
    over the load; presliding (x, y, z) [m]; damping (x, y, z) [N s/m]; damping_time [s].

    Examples
    --------
    >>> from exudyn_wheelset import LinkSuspension
    >>> links = LinkSuspension(1.2e6, length=(0.40, 0.25), friction=(0.10, 0.06))
    >>> links.length
    (0.4, 0.25)
    """

    stiffness: float
    length: tuple[float, float]
    friction: tuple[float, float]
    leaf_friction: float = 0.07
    presliding: Vector = (2.0e-3, 2.0e-3, 1.0e-3)
    damping: Vector = (0.0, 0.0, 0.0)
    damping_time: float = DAMPING_TIME

    def __post_init__(self) -> None:
        put = object.__setattr__
        name = "LinkSuspension"
        put(self, "stiffness", checked_stiffness(f"{name}: stiffness", self.stiffness))
        positive(f"{name}: stiffness", self.stiffness, "N/m")
        length = numbers(f"{name}: length (x, y)", self.length, 2, "m", 0.01, 5.0)
        put(self, "length", length)
        part = "a part of the load"
        put(self, "friction", _parts(f"{name}: friction (x, y)", self.friction))
        leaf = number(f"{name}: leaf_friction", self.leaf_friction, "-", 0.0, 0.9, part)
        put(self, "leaf_friction", leaf)
        given = numbers(f"{name}: presliding (x, y, z)", self.presliding, 3, "m")
        put(self, "presliding", tuple(checked_presliding(f"{name}: presliding", v) for v in given))
        given = numbers(f"{name}: damping (x, y, z)", self.damping, 3, "N s/m")
        put(self, "damping", tuple(checked_damping(f"{name}: damping", v) for v in given))
        time = checked_damping_time(f"{name}: damping_time", self.damping_time)
        put(self, "damping_time", time)

    def laws(self) -> tuple[Law, ...]:
        """The hung spring with the friction of links and leaves."""
        directions = (ALONG_X, ALONG_Y, ALONG_Z)
        frictions = (*self.friction, self.leaf_friction)
        names = ("longitudinal link", "lateral link", "leaf")
        slidings = tuple(
            Sliding(*one) for one in zip(names, directions, frictions, self.presliding, strict=True)
        )
        friction = Friction(
            friction_kernel.HUNG,
            slidings,
            coupled=False,
            stiffness=self.stiffness,
            lengths=self.length,
            damping_time=self.damping_time,
        )
        hung = Law(layout.FRICTION, friction=friction, upright=True)
        if not any(self.damping):
            return (hung,)
        return (hung, Law(layout.SPRING, damping=self.damping))


def _parts(what: str, values: Any) -> tuple[float, ...]:
    return numbers(what, values, 2, "-", 0.0, 0.9, "a part of the load")
