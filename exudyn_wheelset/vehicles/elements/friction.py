"""What friction elements hand to the compiled call: pressure, directions of sliding, holds.

The law and the pressures stand in vehicles/friction_kernel.py. A hold is relaxed (0) where the
vehicle is drawn: friction carries nothing there, and from there it is strained.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.coupling.registration import FirstOrderState
from exudyn_wheelset.vehicles import friction_kernel as places

# Sliding over which the hold of rough steel faces is broken, in railway dampers [m].
PRESLIDING = 2.5e-4
# Loss factor of the hold over the angular frequency [s]: 1.3 % at 5 Hz.
DAMPING_TIME = 4.0e-4
# Beyond it no face is known, but rigid connections are its limit.
_HIGHEST_FRICTION = 1.0e9
# No hold is stiffer [N/m], at its load in the drawing: rigid beside all springs, and still 1e-16 m
# of rounding are no force.
_STIFFEST = 1.0e10
# A hold of hunting, part of the slip force.
_SCALE = 0.1

ALONG_X = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
ALONG_Y = (0.0, 1.0, 0.0, 0.0, 0.0, 0.0)
ALONG_Z = (0.0, 0.0, 1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Sliding:
    """A component of sliding: its name, its velocity as a row (6) over (d', w), its friction."""

    name: str
    row: tuple[float, ...]
    friction: float
    presliding: float


@dataclass(frozen=True)
class Friction:
    """A friction contact of a law.

    kind: of friction_kernel.CONSTANT, ...; slidings: 1 to 3 components, on one circle if coupled;
    stiffness [N/m]: of what presses; force [N]: constant pressure, or of the wedge's spring in the
    drawing; load [N]: known vertical force on the upper body in the drawing, None where the balance
    of the bodies says it; gap, onset [m]; radius [m] of a disc, play [m] and stop [N/m] of its rim;
    lengths [m] of links; tangent: of the wedge's angle, slope_friction: of its inclined face; bed
    [N/m]: of the wedge's face on its column, 0 for none, side: 1 for a column ahead, -1 behind.
    """

    kind: int
    slidings: tuple[Sliding, ...]
    coupled: bool = True
    stiffness: float = 0.0
    force: float = 0.0
    load: float | None = None
    gap: float = 0.0
    onset: float = 0.0
    radius: float = 1.0
    play: float = 0.0
    stop: float = 0.0
    lengths: tuple[float, float] = (1.0, 1.0)
    tangent: float = 1.0
    slope_friction: float = 0.0
    bed: float = 0.0
    side: float = 1.0
    damping_time: float = DAMPING_TIME

    @property
    def states(self) -> tuple[FirstOrderState, ...]:
        """The holds: friction force over slip force."""
        return tuple(
            FirstOrderState(f"{sliding.name} hold".strip(), "-", _SCALE)
            for sliding in self.slidings
        )

    def static_stiffness(self) -> np.ndarray:
        """(6, 6) of what presses, against loads that stay; friction itself is relaxed."""
        matrix = np.zeros((6, 6))
        if self.kind == places.CONSTANT or self.gap > 0.0:
            return matrix
        matrix[2, 2] = self.stiffness
        if self.kind == places.DISC:
            matrix[3, 3] = matrix[4, 4] = 0.25 * self.stiffness * self.radius**2
        matrix[0, 0] = self.bed
        if self.kind == places.WEDGE:
            matrix[4, 4] = matrix[5, 5] = 0.25 * self.bed * self.radius**2
        return matrix

    def pool(self, preload: np.ndarray) -> np.ndarray:
        """The data as friction_kernel.friction_law reads them; preload (6): in the drawing.

        Takes out of `preload` what the pressure makes itself.
        """
        data = np.zeros(places.P_COMPONENTS)
        data[places.P_KIND] = self.kind
        data[places.P_STIFFNESS] = self.stiffness
        data[places.P_ONSET] = self.onset
        data[places.P_FORCE] = self.force
        data[places.P_RADIUS] = self.radius
        data[places.P_PLAY] = self.play
        data[places.P_STOP] = self.stop
        data[places.P_STOP_ONSET] = max(0.5 * self.play, 1e-4)
        data[[places.P_LENGTH_X, places.P_LENGTH_Y]] = self.lengths
        data[places.P_TANGENT] = self.tangent
        data[places.P_SLOPE] = self.slope_friction
        data[places.P_DAMPING_TIME] = self.damping_time
        data[places.P_COUPLED] = float(self.coupled)
        data[places.P_COUNT] = len(self.slidings)
        data[places.P_BED] = self.bed
        data[places.P_SIDE] = self.side
        data[places.P_RELAXED] = self.force / self.tangent
        pressing = self.force or max(preload[2], 0.0)
        if self.kind != places.CONSTANT and self.stiffness > 0.0:
            compressed = -self.gap if self.gap > 0.0 else preload[2] / self.stiffness
            data[places.P_COMPRESSION] = compressed
            preload[2] = 0.0
            if self.kind == places.DISC:
                rocking = 0.25 * self.stiffness * self.radius**2
                data[[places.P_TILT_X, places.P_TILT_Y]] = -preload[3:5] / rocking
                preload[3:5] = 0.0
        rows = [
            (*one.row, one.friction, max(one.presliding, one.friction * pressing / _STIFFEST))
            for one in self.slidings
        ]
        return np.concatenate([data, np.array(rows).ravel()])


def checked_friction(what: str, value: Any) -> float:
    """A friction coefficient from 0 up."""
    mend = "a friction coefficient is not negative, steel on steel has 0.1 to 0.6"
    return number(what, value, "-", 0.0, _HIGHEST_FRICTION, mend)


def checked_presliding(what: str, value: Any) -> float:
    """A presliding displacement [m] above 0."""
    return positive(what, value, "m", 0.1, "metres are asked")


def checked_damping_time(what: str, value: Any) -> float:
    """A time of damping of the hold [s]."""
    return number(what, value, "s", 0.0, 0.1, "it is the loss factor of the hold over w")
