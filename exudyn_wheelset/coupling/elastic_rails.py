"""Rails on springs and dampers: a massless rail under each wheel that gives way to its forces.

For each rail, laterally and vertically, with its shift d, the force F of the wheel on it:
    c d' + k d = F(d, d').
F depends on the rate d' as well, through creepage and contact damping, which damp the rail more
than its own damper does, so d' is the root of this equation (elastic_forces.py); d are four
first-order coordinates of the Exudyn system. The rail keeps its inclination. Track frame, SI.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt_class

# Stiffness [N/m] of a wheel's contact with its rail under 90 kN, by Hertz 3 N/(2 delta).
_CONTACT = 1.5e9
# RK44 is stable to a step of 2.78 over the rate of a real root.
_REACH = 2.6


@spelt_class
@dataclass(frozen=True)
class RailElasticity:
    """Springs and dampers under one rail at the wheel.

    lateral_stiffness, vertical_stiffness [N/m]; lateral_damping, vertical_damping [N s/m], all
    positive. Common values for a rail on sleepers are 2e7 and 6e7 N/m, 1e5 and 2e5 N s/m.

    Examples
    --------
    >>> from exudyn_wheelset import RailElasticity
    >>> RailElasticity(vertical_stiffness=5e7).lateral_stiffness
    20000000.0
    """

    lateral_stiffness: float = 2.0e7
    vertical_stiffness: float = 6.0e7
    lateral_damping: float = 1.0e5
    vertical_damping: float = 2.0e5

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            unit, high = ("N/m", 1e11) if name.endswith("stiffness") else ("N s/m", 1e8)
            if number(name, value, unit) <= 0.0:
                raise WheelsetError(
                    f"{name} = {value!r} {unit}: give a positive number in {unit}; for rails that "
                    "do not give way leave the elasticity out"
                )
            positive(name, value, unit, high, "rails have some 1e7 to 1e9 N/m, 1e4 to 1e6 N s/m")

    def longest_step(self) -> float:
        """Time step [s] that RK44 holds: the rail goes after the contact's spring at its rate
        (contact + vertical_stiffness)/vertical_damping."""
        return _REACH * self.vertical_damping / (_CONTACT + self.vertical_stiffness)

    def numbers(self) -> np.ndarray:
        """Stiffness and damping (k_y, k_z, c_y, c_z)."""
        return np.array(
            [
                self.lateral_stiffness,
                self.vertical_stiffness,
                self.lateral_damping,
                self.vertical_damping,
            ]
        )
