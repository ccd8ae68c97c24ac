"""An anti-roll bar: a moment about the longitudinal axis against the roll of two bodies.

Potential k theta_x^2/2, dissipation c w_x^2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    checked_damping,
    checked_stiffness,
)


@dataclass(frozen=True)
class AntiRollBar(Element):
    """Stiffness [N m/rad] and damping [N m s/rad] against roll of the upper on the lower body.

    Examples
    --------
    >>> from exudyn_wheelset import AntiRollBar
    >>> float(AntiRollBar(940e3).static_stiffness()[3, 3])
    940000.0
    """

    stiffness: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        put = object.__setattr__
        stiffness = checked_stiffness("AntiRollBar: stiffness", self.stiffness, "N m/rad")
        put(self, "stiffness", stiffness)
        put(self, "damping", checked_damping("AntiRollBar: damping", self.damping, "N m s/rad"))

    def laws(self) -> tuple[Law, ...]:
        """One matrix with the roll alone."""
        about_x = np.zeros((6, 6))
        about_x[3, 3] = 1.0
        return (Law(layout.MATRIX, matrices=(self.stiffness * about_x, self.damping * about_x)),)
