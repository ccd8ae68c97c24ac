"""Rails on springs and dampers: a massless rail under each wheel that gives way to its forces.

For each rail, laterally and vertically, with its shift d, the force F of the wheel on it:
    c d' + k d = F(d, d').
F depends on the rate d' as well, through creepage and contact damping, so d' is the root of this
equation, found by Newton's method in the two directions of each rail; d are four first-order
coordinates of the Exudyn system. The rail keeps its inclination. Track frame, SI.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.forces_apart import wheelset_forces
from exudyn_wheelset.coupling.wheel_forces import wheel_force
from exudyn_wheelset.errors import WheelsetError

# Rates [m/s] for the differences: small against a creep of 1e-4 at walking speed, large against
# rounding.
_RATE_STEP = 1.0e-6


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
            if not np.isfinite(value) or value <= 0.0:
                raise WheelsetError(
                    f"{name} = {value!r}: give a positive number (N/m or N s/m); for rails that "
                    "do not give way leave the elasticity out"
                )

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


@compiled
def side_forces(result, forces):
    """Fill forces (4): lateral and vertical force [N] on the left, then on the right wheel."""
    for hand in range(2):
        forces[2 * hand], forces[2 * hand + 1] = wheel_force(result, hand)


@compiled
def elastic_forces(
    table, axle, velocity, rail_motion, parameters, result, elasticity, shifts, rates
):  # fmt: skip
    """As `wheelset_forces`, on rails shifted by `shifts` (4) [m] against their springs.

    elasticity: (k_y, k_z, c_y, c_z); rates (4) [m/s]: set to those of the shifts, left y, z, right
    y, z, from a guess. rail_motion (12): of the track, to which shifts and rates are added.
    """
    unmoved = rail_motion
    rail_motion = np.empty(12)
    for k in range(4):
        rail_motion[k] = unmoved[k] + shifts[k]
        rail_motion[8 + k] = unmoved[8 + k]
    forces = np.empty(4)
    moved = np.empty((2, 4))
    for _ in range(12):
        for direction in range(2):
            for k in range(4):
                step = _RATE_STEP if k % 2 == direction else 0.0
                rail_motion[4 + k] = unmoved[4 + k] + rates[k] + step
            wheelset_forces(table, axle, velocity, rail_motion, parameters, result)
            side_forces(result, moved[direction])
        for k in range(4):
            rail_motion[4 + k] = unmoved[4 + k] + rates[k]
        wheelset_forces(table, axle, velocity, rail_motion, parameters, result)
        side_forces(result, forces)
        largest = 0.0
        for hand in range(2):
            i = 2 * hand
            j = i + 1
            gy = elasticity[2] * rates[i] + elasticity[0] * shifts[i] + forces[i]
            gz = elasticity[3] * rates[j] + elasticity[1] * shifts[j] + forces[j]
            yy = elasticity[2] + (moved[0, i] - forces[i]) / _RATE_STEP
            zy = (moved[0, j] - forces[j]) / _RATE_STEP
            yz = (moved[1, i] - forces[i]) / _RATE_STEP
            zz = elasticity[3] + (moved[1, j] - forces[j]) / _RATE_STEP
            determinant = yy * zz - yz * zy
            rates[i] -= (gy * zz - yz * gz) / determinant
            rates[j] -= (yy * gz - gy * zy) / determinant
            largest = max(largest, abs(gy), abs(gz))
        # The correction after a residual this small is below rounding.
        if largest < 1.0e-4:
            break
