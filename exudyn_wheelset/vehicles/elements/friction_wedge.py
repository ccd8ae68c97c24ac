"""A friction wedge between bolster and side frame of a three-piece truck.

A spring S presses the wedge between the column of the side frame, vertical and across the track,
and a face of the bolster at an angle a from the vertical. On the column it slides vertically and
sideways, with mu N on a circle. N follows from the equilibrium of the wedge with friction on both
faces (friction_kernel.column_force): while the spring is loaded (the bolster goes down) and while
it is unloaded the column feels

    N = S/(tan(a + phi) - mu)   and   N = S/(tan(a - phi) + mu),   tan(phi) = slope friction,

and S/tan(a) relaxed; in between the friction that is at work counts. Spring of the side frame
("variable damping"): S = tan(a) column_force - spring d_z carries the bolster, on which the wedge
acts vertically with S - mu N h. Spring inside the bolster ("constant damping", spring = 0): S is
constant, and only mu N h acts on the bolster. The potential of the spring is S^2/(2 spring).

Along the track a wedge is squeezed between bolster and column. Nearing each other they would press
it out downward, against friction on both faces, at

    N = S/(tan(a - phi) - mu),

so never while a <= phi + atan(mu), the sum of both angles of friction: the usual wedge locks (32
degrees with friction 0.4: 43.6) and holds bolster and side frame as stiffly as its faces are. Given
that stiffness, `along`, the column force is N plus what squeezes it, and the face, a disc of
`radius`, resists turning in the column (warp of the truck, pitch of the frame): with the stiffness
along radius^2/4 until an edge lifts at the moment N radius/4, then on less of its area, N growing
as the edges bind, and never with more than N radius (friction_kernel.column_face). It is the toe
moment that published wedge models have (two papers in Proc. ASME IMECE 2004, volume 47195, pages
67 and 77). Wedges come in pairs, one ahead and one behind the bolster.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.vehicles import friction_kernel, layout
from exudyn_wheelset.vehicles.elements.friction import (
    ALONG_Y,
    ALONG_Z,
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
class FrictionWedge(Element):
    """A wedge on the side frame (lower body) that holds the bolster (upper body) by friction.

    angle [deg]: of the inclined face from the vertical, 5 to 85; friction [-]: of the column;
    column_force [N]: normal force on the column in the drawing, friction relaxed; spring [N/m]: of
    the spring below the wedge, 0 for a column force that stays; slope_friction [-]: of the inclined
    face, that of the column if left out; presliding [m]: sliding over which the hold yields, so its
    stiffness is friction column_force/presliding; damping_time [s]: of the hold, and of the face
    along the track; along [N/m]: stiffness of the face between bolster and column, 0 for a wedge
    that holds nothing along the track; radius [m]: of the face, half its width, 0 for one that
    turns freely; ahead: whether the column is ahead of the bolster (else behind).

    Examples
    --------
    >>> from exudyn_wheelset import FrictionWedge
    >>> wedge = FrictionWedge(angle=32, friction=0.4, column_force=18e3)
    >>> [round(force) for force in wedge.slip_forces()]
    [4655, 7758]
    """

    angle: float
    friction: float
    column_force: float
    spring: float = 0.0
    slope_friction: float | None = None
    presliding: float = PRESLIDING
    damping_time: float = DAMPING_TIME
    along: float = 0.0
    radius: float = 0.0
    ahead: bool = True

    def __post_init__(self) -> None:
        put = object.__setattr__
        name = "FrictionWedge"
        mend = "the angle of the inclined face from the vertical, in degrees"
        put(self, "angle", number(f"{name}: angle", self.angle, "deg", 5.0, 85.0, mend))
        put(self, "friction", checked_friction(f"{name}: friction", self.friction))
        put(
            self,
            "column_force",
            number(f"{name}: column_force", self.column_force, "N", 0.0, 1e7),
        )
        put(self, "spring", checked_stiffness(f"{name}: spring", self.spring))
        if self.slope_friction is not None:
            slope = checked_friction(f"{name}: slope_friction", self.slope_friction)
            put(self, "slope_friction", slope)
            # Below zero the wedge locks: the harder it is pushed the harder it holds.
            left = self._tangent + (slope - self.friction) + self.friction * slope * self._tangent
            if left <= 0.0:
                lock = math.degrees(math.atan(self.friction) - math.atan(slope))
                raise WheelsetError(
                    f"{name}: angle = {self.angle:g} deg locks the wedge at friction = "
                    f"{self.friction:g} and slope_friction = {slope:g}: give more than "
                    f"{lock:.1f} deg"
                )
        put(self, "presliding", checked_presliding(f"{name}: presliding", self.presliding))
        time = checked_damping_time(f"{name}: damping_time", self.damping_time)
        put(self, "damping_time", time)
        if self.spring > 0.0:
            positive(f"{name}: column_force", self.column_force, "N")
        put(self, "along", checked_stiffness(f"{name}: along", self.along))
        put(
            self,
            "radius",
            number(f"{name}: radius", self.radius, "m", 0.0, 1.0, "metres are asked"),
        )
        if not isinstance(self.ahead, bool):
            raise WheelsetError(f"{name}: ahead = {self.ahead!r}: give True or False")
        if self.radius > 0.0 and self.along == 0.0:
            raise WheelsetError(
                f"{name}: radius = {self.radius:g} m and along = 0: a face without stiffness does "
                "not resist turning: give along, or leave the radius out"
            )

    @property
    def _tangent(self) -> float:
        return math.tan(math.radians(self.angle))

    @property
    def spring_force(self) -> float:
        """Force [N] of the wedge's spring in the drawing: column_force tan(angle)."""
        return self.column_force * self._tangent

    def slip_forces(self, compression: float = 0.0) -> tuple[float, float]:
        """Friction [N] in loading and unloading, bolster `compression` [m] below the drawing."""
        spring_force = max(0.0, self.spring_force + self.spring * compression)
        slope = self.friction if self.slope_friction is None else self.slope_friction
        loading, unloading = (
            self.friction
            * friction_kernel.column_force(spring_force, hold, self._tangent, self.friction, slope)
            for hold in (1.0, -1.0)
        )
        return loading, unloading

    def laws(self) -> tuple[Law, ...]:
        """The wedge: its spring and its friction."""
        slidings = (
            Sliding("lateral", ALONG_Y, self.friction, self.presliding),
            Sliding("vertical", ALONG_Z, self.friction, self.presliding),
        )
        friction = Friction(
            friction_kernel.WEDGE,
            slidings,
            stiffness=self.spring,
            force=self.spring_force,
            load=self.spring_force if self.spring > 0.0 else None,
            tangent=self._tangent,
            bed=self.along,
            side=1.0 if self.ahead else -1.0,
            radius=self.radius,
            slope_friction=self.friction if self.slope_friction is None else self.slope_friction,
            damping_time=self.damping_time,
        )
        return (Law(layout.FRICTION, friction=friction),)
