"""A side bearer: after a gap it pushes vertically and slides against friction mu N.

N = stiffness times the compression beyond the gap, which begins over a tenth of the gap as a
parabola, so that neither force nor stiffness jumps; potential: its integral. Closed (no gap) it
may press with a force at rest: a constant-contact side bearer.
"""

from __future__ import annotations

from dataclasses import dataclass

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.errors import WheelsetError
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

# Part of the gap over which the contact becomes stiff.
_ONSET = 0.1


@dataclass(frozen=True)
class SideBearer(Element):
    """A side bearer of the bolster (lower) below the body (upper).

    gap [m]: to the body at rest; stiffness [N/m]; friction [-]; force [N]: on the body at rest, for
    one without a gap; presliding [m], damping_time [s]: of the hold.

    Examples
    --------
    >>> from exudyn_wheelset import SideBearer
    >>> SideBearer(gap=6.35e-3, stiffness=2e7, friction=0.3).gap
    0.00635
    """

    gap: float
    stiffness: float
    friction: float
    force: float = 0.0
    presliding: float = PRESLIDING
    damping_time: float = DAMPING_TIME

    def __post_init__(self) -> None:
        put = object.__setattr__
        name = "SideBearer"
        put(self, "gap", number(f"{name}: gap", self.gap, "m", 0.0, 0.2, "metres are asked"))
        put(self, "stiffness", checked_stiffness(f"{name}: stiffness", self.stiffness))
        positive(f"{name}: stiffness", self.stiffness, "N/m")
        put(self, "friction", checked_friction(f"{name}: friction", self.friction))
        put(self, "force", number(f"{name}: force", self.force, "N", 0.0, 1e7))
        if self.gap > 0.0 and self.force > 0.0:
            raise WheelsetError(
                f"{name}: gap = {self.gap:g} m and force = {self.force:g} N: across a gap there is "
                "no force: give gap=0 or leave the force out"
            )
        put(self, "presliding", checked_presliding(f"{name}: presliding", self.presliding))
        time = checked_damping_time(f"{name}: damping_time", self.damping_time)
        put(self, "damping_time", time)

    def laws(self) -> tuple[Law, ...]:
        """One contact."""
        slidings = tuple(
            Sliding(name, row, self.friction, self.presliding)
            for name, row in (("longitudinal", ALONG_X), ("lateral", ALONG_Y))
        )
        friction = Friction(
            friction_kernel.PRESSED,
            slidings,
            stiffness=self.stiffness,
            load=self.force if self.gap == 0.0 else None,
            gap=self.gap,
            onset=_ONSET * self.gap,
            damping_time=self.damping_time,
        )
        return (Law(layout.FRICTION, friction=friction),)
