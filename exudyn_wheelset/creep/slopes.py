"""A contact patch as a creep law sees it, and the slopes of the law's forces there.

The slopes -dF_x/dxi_x and -dF_y/dxi_y [N] are what a linearised vehicle knows of its creep law.
They are taken by central differences over a hundredth of the creepage of saturation by the linear
theory, u = mu N/(G a b C): small enough for the curvature of the curve (1e-4 of the slope), large
enough for laws on a grid, whose slope jumps as a cell turns from stick to slip.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.creep.kalker import kalker_coefficients
from exudyn_wheelset.creep.law import CreepLaw
from exudyn_wheelset.creep.registry import creep_force

_STEP = 1.0e-2


@dataclass(frozen=True)
class CreepPatch:
    """A patch and its creep law.

    law, with its parameters by name; creep_x, creep_y [-]; spin [1/m]; semi-axes a along rolling,
    b lateral [m]; normal_force [N]; friction [-]; shear_modulus [Pa]; poisson [-]; where: a name
    for messages.
    """

    law: CreepLaw
    creep_x: float
    creep_y: float
    spin: float
    a: float
    b: float
    normal_force: float
    friction: float
    shear_modulus: float
    poisson: float
    parameters: dict[str, Any] = field(default_factory=dict)
    where: str = ""


def creep_slopes(
    patches: Sequence[CreepPatch], law: Any = None, **parameters: Any
) -> NDArray[np.float64]:
    """Give (-dF_x/dxi_x, -dF_y/dxi_y) [N] of patches (n, 2), by their own laws or by `law`."""
    slopes = np.empty((len(patches), 2))
    for row, patch in enumerate(patches):
        c11, c22, _, _ = kalker_coefficients(patch.a, patch.b, patch.poisson)
        saturation = patch.friction * patch.normal_force
        saturation /= patch.shear_modulus * patch.a * patch.b
        steps = _STEP * saturation / np.array([c11, c22])
        shifts = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]) * steps
        forces = creep_force(
            patch.law if law is None else law,
            patch.creep_x + shifts[:, 0],
            patch.creep_y + shifts[:, 1],
            patch.spin,
            patch.a,
            patch.b,
            patch.normal_force,
            patch.friction,
            patch.shear_modulus,
            patch.poisson,
            **(patch.parameters if law is None else parameters),
        )
        slopes[row, 0] = (forces[0][1] - forces[0][0]) / (2.0 * steps[0])
        slopes[row, 1] = (forces[1][3] - forces[1][2]) / (2.0 * steps[1])
    return slopes
