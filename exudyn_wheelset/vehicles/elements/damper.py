"""Dampers along a direction: linear or with blow-off, alone or in series with a spring.

Alone, F = c v or F(v) by a table, dissipation F v. In series with a spring of stiffness k (the
rubber and oil of a real damper: Maxwell's element),

    F = k (e - s),   s' = F/c   (or the table's speed at F),   so F' = k (e' - F/c),

e the elongation along the direction, s the stroke of the damper, a first-order coordinate [m];
potential k (e - s)^2/2, dissipation F s'. Over sinusoids of angular frequency w its complex
stiffness is k i w c/(k + i w c). It carries no load that stays.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from exudyn_wheelset.checking import positive, warn
from exudyn_wheelset.coupling.registration import FirstOrderState
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.curve import checked_table, curve_of
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    Vector,
    checked_damping,
    checked_direction,
    checked_stiffness,
    mirrored_direction,
)

# A stroke of hunting below the flange.
STROKE = FirstOrderState("stroke", "m", 1.0e-3)
# Longer than any vehicle's motion takes [s].
_LONGEST_RELAXATION = 10.0


@dataclass(frozen=True)
class MaxwellDamper(Element):
    """A damper in series with a spring, along a direction of the element's axes.

    direction (x, y, z); stiffness k [N/m]; damping c [N s/m], both above 0. Warns where they look
    exchanged: c/k is the time [s] in which a force relaxes.

    Examples
    --------
    >>> from exudyn_wheelset import MaxwellDamper
    >>> damper = MaxwellDamper((0, 1, 0), stiffness=6e6, damping=32e3)
    >>> round(1e3 * damper.damping / damper.stiffness, 2)  # relaxation time [ms]
    5.33
    """

    direction: Vector
    stiffness: float
    damping: float

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "direction", checked_direction("MaxwellDamper", self.direction))
        put(self, "stiffness", checked_stiffness("MaxwellDamper: stiffness", self.stiffness))
        put(self, "damping", checked_damping("MaxwellDamper: damping", self.damping))
        positive("MaxwellDamper: stiffness", self.stiffness, "N/m")
        positive("MaxwellDamper: damping", self.damping, "N s/m")
        if self.damping > _LONGEST_RELAXATION * self.stiffness:
            warn(
                f"MaxwellDamper: stiffness = {self.stiffness:g} N/m and damping = "
                f"{self.damping:g} N s/m let a force relax in c/k = "
                f"{self.damping / self.stiffness:g} s (usual are milliseconds, at most "
                f"{_LONGEST_RELAXATION:g} s): are they exchanged?"
            )

    def laws(self) -> tuple[Law, ...]:
        """One damper in series."""
        return (
            Law(
                layout.DIRECTED,
                stiffness=(self.stiffness, 0.0, 0.0),
                damping=(self.damping, 0.0, 0.0),
                direction=self.direction,
                state=STROKE,
            ),
        )

    def mirrored(self) -> MaxwellDamper:
        """The damper as a mirror shows it."""
        return replace(self, direction=mirrored_direction(self.direction))


@dataclass(frozen=True)
class Damper(Element):
    """A damper along a direction of the element's axes, linear or by a table with blow-off.

    damping [N s/m], or table: pairs (speed [m/s], force [N]) from (0, 0) on, rising; monotone
    cubic between them, straight on beyond, the same for both signs unless both are given.
    series_stiffness [N/m]: of a spring in series; the table's forces must then rise throughout.

    Examples
    --------
    >>> from exudyn_wheelset import Damper
    >>> blow_off = Damper((0, 1, 0), table=[(0, 0), (0.1, 1.0e4), (0.3, 1.4e4)])
    >>> linear = Damper((0, 1, 0), damping=32e3)
    >>> linear.damping
    32000.0
    """

    direction: Vector
    damping: float | None = None
    table: Any = None
    series_stiffness: float | None = None

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "direction", checked_direction("Damper", self.direction))
        if (self.damping is None) == (self.table is None):
            raise WheelsetError("Damper: give damping [N s/m], or a table of (m/s, N)")
        if self.damping is not None:
            put(self, "damping", checked_damping("Damper: damping", self.damping))
        else:
            put(self, "table", checked_table("Damper: table", self.table, "m/s", "N"))
        if self.series_stiffness is not None:
            stiffness = checked_stiffness("Damper: series_stiffness", self.series_stiffness)
            put(self, "series_stiffness", positive("Damper: series_stiffness", stiffness, "N/m"))
            if self.damping is not None:
                positive("Damper: damping", self.damping, "N s/m")
        self.laws()

    def laws(self) -> tuple[Law, ...]:
        """One damper, in series or not."""
        curve = None if self.table is None else curve_of(self.table)
        in_series = self.series_stiffness is not None
        return (
            Law(
                layout.DIRECTED,
                stiffness=(self.series_stiffness or 0.0, 0.0, 0.0),
                damping=(self.damping or 0.0, 0.0, 0.0),
                direction=self.direction,
                blow_off=curve.inverse() if curve is not None and in_series else curve,
                state=STROKE if in_series else None,
            ),
        )

    def mirrored(self) -> Damper:
        """The damper as a mirror shows it."""
        return replace(self, direction=mirrored_direction(self.direction))
