"""Springs and bushings: linear in displacement and rotation, in the axes of a body.

Potential e^T K e/2, dissipation e'^T D e', e = (d, theta) as in vehicles/kernel.py. Their preload
keeps its direction in the track.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from exudyn_wheelset.checking import numbers
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.protocol import (
    Element,
    Law,
    checked_damping,
    checked_stiffness,
    mirrored_matrix,
)


@dataclass(frozen=True)
class Spring(Element):
    """A spring with a damper beside it.

    stiffness: (x, y, z) [N/m], or six numbers with those about x, y, z [N m/rad], or a symmetric
    (6, 6) matrix; damping: the same forms [N s/m, N m s/rad]. Both ends are at the connection's
    place. Raises WheelsetError for other shapes, negative numbers, matrices that feed energy in;
    warns of a stiffness that looks like kN/mm.

    Examples
    --------
    >>> from exudyn_wheelset import Spring
    >>> spring = Spring((1.6e6, 4e5, 1.2e6), damping=(15e3, 2e3, 4e3))
    >>> float(spring.static_stiffness()[1, 1])
    400000.0
    """

    stiffness: Any
    damping: Any = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        what = type(self).__name__
        put = object.__setattr__
        put(self, "stiffness", _checked(f"{what}: stiffness", self.stiffness, checked_stiffness))
        put(self, "damping", _checked(f"{what}: damping", self.damping, checked_damping))

    def laws(self) -> tuple[Law, ...]:
        """Three springs, or one of a matrix."""
        if len(self.stiffness) == 3 and len(self.damping) == 3:
            return (Law(layout.SPRING, stiffness=self.stiffness, damping=self.damping),)
        return (Law(layout.MATRIX, matrices=(_matrix(self.stiffness), _matrix(self.damping))),)

    def mirrored(self) -> Spring:
        """The spring as a mirror shows it."""
        return replace(self, stiffness=_mirrored(self.stiffness), damping=_mirrored(self.damping))


@dataclass(frozen=True)
class Bushing(Spring):
    """A rubber bushing: stiffness and damping in the forms of a Spring.

    Three numbers (x, y, z) [N/m] for one that turns freely, six with those about x, y, z [N m/rad],
    or (6, 6).

    Examples
    --------
    >>> from exudyn_wheelset import Bushing
    >>> bushing = Bushing((8e6, 4e6, 1e6, 1e4, 1e4, 2e4))
    >>> float(bushing.static_stiffness()[5, 5])
    20000.0
    """


def _checked(what: str, values: Any, check: Any) -> Any:
    """Three or six numbers or a (6, 6) matrix as tuples."""
    if isinstance(values, (str, bytes)) or not hasattr(values, "__len__"):
        raise WheelsetError(f"{what} = {values!r}: give the numbers along x, y and z")
    if len(values) == 6 and all(hasattr(row, "__len__") for row in values):
        rows = tuple(numbers(f"{what}[{k}]", row, 6, "SI") for k, row in enumerate(values))
        matrix = np.array(rows)
        if not np.allclose(matrix, matrix.T, rtol=1e-9, atol=0.0):
            raise WheelsetError(f"{what}: the matrix is not symmetric: give a symmetric one")
        least = float(np.linalg.eigvalsh(matrix)[0])
        if least < -1e-9 * max(1.0, float(np.abs(matrix).max())):
            raise WheelsetError(
                f"{what}: the matrix has the eigenvalue {least:g} below 0, which would feed energy "
                "in: give a positive semidefinite one"
            )
        return rows
    if len(values) not in (3, 6):
        raise WheelsetError(
            f"{what} has {len(values)} numbers: give three (x, y, z), six with those about x, y, "
            "z, or a (6, 6) matrix"
        )
    straight = [check(f"{what} {axis}", v) for axis, v in zip("xyz", values[:3], strict=True)]
    unit = "N m/rad" if check is checked_stiffness else "N m s/rad"
    about = [
        check(f"{what} about {axis}", v, unit)
        for axis, v in zip("xyz", values[3:], strict=len(values) == 6)
    ]
    return (*straight, *about)


def _matrix(values: Any) -> np.ndarray:
    if hasattr(values[0], "__len__"):
        return np.array(values)
    return np.diag([*values, *(0.0 for _ in range(6 - len(values)))])


def _mirrored(values: Any) -> Any:
    if not hasattr(values[0], "__len__"):
        return values
    return tuple(tuple(float(v) for v in row) for row in mirrored_matrix(np.array(values)))
