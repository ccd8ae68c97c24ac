"""A coil spring under load: its force acts in its middle, between both ends, along its own axis.

A coil between plates bends and shears alike at both ends. Sheared by u under the load P, with the
shear force H, either plate feels the moment (H h + P u)/2: the force of both passes through the
middle of the coil. So the coil is a spring at its middle, which rigid halves of its height join to
the bodies, in axes half way between both; its load turns with those axes, as the coil does:

    upper end   force -A (K d - P), moment about the middle of the coil -A k_b theta,

potential e^T K e/2 - P . d. What follows under load: plates that stay parallel meet the shear
stiffness alone; a coil that is free to tip at both ends pushes sideways by P u/h, whatever its
shear stiffness; a plate tipped by theta pushes sideways by (k_s h + P) theta/2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    Vector,
    checked_along,
    checked_stiffness,
)


@dataclass(frozen=True)
class CoilSpring(Element):
    """A coil; the connection's place is the middle of its loaded height.

    stiffness (x, y, z) [N/m]: shear, shear and axial, between parallel plates under the load;
    bending, torsion [N m/rad]: between plates that turn against each other about a horizontal
    axis, or about the coil's; damping (x, y, z) [N s/m].

    Examples
    --------
    >>> from exudyn_wheelset import CoilSpring
    >>> coil = CoilSpring((2e6, 2e6, 5e5), bending=10.5e3)
    >>> float(coil.static_stiffness()[2, 2])
    500000.0
    """

    stiffness: Vector
    bending: float = 0.0
    torsion: float = 0.0
    damping: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        put = object.__setattr__
        stiffness, damping = checked_along("CoilSpring", self.stiffness, self.damping)
        put(self, "stiffness", stiffness)
        put(self, "damping", damping)
        for what in ("bending", "torsion"):
            value = checked_stiffness(f"CoilSpring: {what}", getattr(self, what), "N m/rad")
            put(self, what, value)

    def laws(self) -> tuple[Law, ...]:
        """One matrix in the axes half way between both bodies."""
        stiffness = np.diag([*self.stiffness, self.bending, self.bending, self.torsion])
        damping = np.diag([*self.damping, 0.0, 0.0, 0.0])
        return (Law(layout.MATRIX, matrices=(stiffness, damping), middle=True),)
