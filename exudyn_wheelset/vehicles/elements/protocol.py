"""What an element is: how a connection of a vehicle pulls and turns the two bodies it joins.

A class is an element if it has

    places(at)          the two points (x, y, z) [m] of the drawing where it meets the lower and the
                        upper body, from the connection's place `at`
    static_stiffness()  (6, 6) [N/m, N/rad, N m/m, N m/rad] of a load that stays, against the
                        displacement (3) [m] and rotation (3) [rad] of the upper end relative to the
                        lower one, in the element's axes; zeros for what carries no such load

and one of

    laws()              what the compiled kernel (vehicles/kernel.py) is to do: all laws of a
                        vehicle are evaluated in one call
    create(mbs, ends, preload)  add items of Exudyn; ends: an `End` for the lower and the upper
                        body; preload (6): force [N] and moment [N m] on the upper body at rest,
                        track frame; returns the item numbers

Nothing is to be registered: a class of one's own works at once. `Element` is a base with defaults.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from exudyn_wheelset.checking import number, numbers, warn
from exudyn_wheelset.coupling.registration import FirstOrderState
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.elements.curve import Curve
from exudyn_wheelset.vehicles.elements.friction import Friction

Vector = tuple[float, float, float]
# Below it a spring of a railway vehicle is not to be expected [N/m]; 1 kN/mm is 1e6 N/m.
_SOFT = 1.0e3
_STIFF = 1.0e12
_SIGNS = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])


@dataclass(frozen=True)
class End:
    """One end of a connection in an Exudyn system.

    body, marker: item numbers (the marker is rigid, at the end's point); node: of the body, None
    for the ground; position (3) [m]: of the point in the drawing; spins: whether the body is a
    wheelset, whose marker turns with the spin.
    """

    body: int
    marker: int
    node: int | None
    position: Vector
    spins: bool


@dataclass(frozen=True)
class Law:
    """One row of the compiled kernel, which states the laws.

    kind: of layout.SPRING (stiffness, damping along three axes), MATRIX (6 x 6), DIRECTED (along
    `direction`, with a stop over displacement and a blow-off table, in series with a spring if
    `state` is given), ROD (along the line of its ends) or FRICTION (friction_kernel.py, what
    `friction` says). shift (3) [m]: of both ends from the element's places. middle: axes half way
    between both bodies. upright: axes of the track, for what hangs or stands by its load.
    """

    kind: int
    stiffness: Vector = (0.0, 0.0, 0.0)
    damping: Vector = (0.0, 0.0, 0.0)
    direction: Vector = (1.0, 0.0, 0.0)
    matrices: tuple[np.ndarray, np.ndarray] | None = None
    stop: Curve | None = None
    blow_off: Curve | None = None
    state: FirstOrderState | None = None
    friction: Friction | None = None
    shift: Vector = (0.0, 0.0, 0.0)
    middle: bool = False
    upright: bool = False

    @property
    def states(self) -> tuple[FirstOrderState, ...]:
        """First-order coordinates."""
        if self.friction is not None:
            return self.friction.states
        return () if self.state is None else (self.state,)

    @property
    def load(self) -> float | None:
        """Vertical force [N] on the upper body in the drawing, where the law knows it itself."""
        return None if self.friction is None else self.friction.load

    def static_stiffness(self, line: np.ndarray) -> np.ndarray:
        """(6, 6) against loads that stay; line (3): unit vector from the lower to the upper end."""
        if self.friction is not None:
            return self.friction.static_stiffness()
        matrix = np.zeros((6, 6))
        if self.kind == layout.SPRING:
            matrix[:3, :3] = np.diag(self.stiffness)
        elif self.kind == layout.MATRIX:
            assert self.matrices is not None
            matrix[:] = self.matrices[0]
        elif self.kind == layout.ROD:
            matrix[:3, :3] = self.stiffness[0] * np.outer(line, line)
        elif self.state is None:
            slope = 0.0 if self.stop is None else self.stop.slope(0.0)
            along = np.array(self.direction)
            matrix[:3, :3] = (self.stiffness[0] + slope) * np.outer(along, along)
        return matrix


class Element:
    """Base of elements: both ends at the connection's place, no static stiffness.

    Examples
    --------
    >>> from exudyn_wheelset import Element, Spring
    >>> isinstance(Spring((1e6, 1e6, 1e6)), Element)
    True
    """

    def places(self, at: Sequence[float]) -> tuple[Vector, Vector]:
        """Points (x, y, z) [m] where it meets the lower and the upper body."""
        x, y, z = at
        return (x, y, z), (x, y, z)

    def static_stiffness(self) -> np.ndarray:
        """Stiffness (6, 6) of a load that stays, element's axes."""
        lower, upper = (np.array(place) for place in self.places((0.0, 0.0, 0.0)))
        line = upper - lower
        length = np.linalg.norm(line)
        line = line / length if length > 0.0 else line
        total = np.zeros((6, 6))
        for law in getattr(self, "laws", tuple)():
            lever = np.eye(6)
            x, y, z = law.shift
            lever[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
            total += lever.T @ law.static_stiffness(line) @ lever
        return total

    def mirrored(self) -> Any:
        """The element as a mirror at the vehicle's middle plane shows it; here the same."""
        return self


def check_element(what: str, element: Any) -> None:
    """Raise WheelsetError, which begins with `what`, for something that is no element."""
    if isinstance(element, type):
        raise WheelsetError(f"{what}: {element.__name__} is a class: give {element.__name__}(...)")
    missing = [method for method in ("places", "static_stiffness") if not hasattr(element, method)]
    if missing or not (hasattr(element, "laws") or hasattr(element, "create")):
        raise WheelsetError(
            f"{what}: {element!r} is no element: give a Spring, MaxwellDamper, ... or an object "
            "with the methods places, static_stiffness and create (vehicles/elements/protocol.py)"
        )


def checked_direction(what: str, direction: Any) -> Vector:
    """A unit vector along `direction`; WheelsetError for one of no length."""
    given = numbers(f"{what}: direction (x, y, z)", direction, 3, "-")
    length = float(np.linalg.norm(given))
    if length == 0.0:
        raise WheelsetError(f"{what}: direction = {given}: give a vector of some length")
    # A unit vector stays what it is, to the last digit: elements are written and read again.
    x, y, z = (value if abs(length - 1.0) < 1e-15 * 4 else value / length for value in given)
    return (x, y, z)


def checked_stiffness(what: str, value: Any, unit: str = "N/m") -> float:
    """A stiffness from 0 up; a warning where it looks like kN/mm."""
    stiffness = number(what, value, unit, 0.0, _STIFF, "a stiffness is not negative")
    if 0.0 < stiffness < _SOFT:
        mend = f"if {stiffness:g} kN/mm is meant, give {stiffness:g}e6"
        if unit != "N/m":
            mend = f"if {stiffness:g} kN m/rad is meant, give {stiffness:g}e3"
        warn(
            f"{what} = {stiffness:g} {unit} is soft for a railway vehicle (usual are {_SOFT:g} "
            f"{unit} and more); {mend}"
        )
    return stiffness


def checked_damping(what: str, value: Any, unit: str = "N s/m") -> float:
    """A damping from 0 up."""
    return number(what, value, unit, 0.0, 1e10, "a damping is not negative")


def checked_along(what: str, stiffness: Any, damping: Any) -> tuple[Vector, Vector]:
    """Stiffness [N/m] and damping [N s/m] along x, y and z, each as the two above check it."""
    x, y, z = (
        checked_stiffness(f"{what}: stiffness {axis}", value)
        for axis, value in zip(
            "xyz", numbers(f"{what}: stiffness (x, y, z)", stiffness, 3, "N/m"), strict=True
        )
    )
    a, b, c = (
        checked_damping(f"{what}: damping {axis}", value)
        for axis, value in zip(
            "xyz", numbers(f"{what}: damping (x, y, z)", damping, 3, "N s/m"), strict=True
        )
    )
    return (x, y, z), (a, b, c)


def mirrored_matrix(matrix: np.ndarray) -> np.ndarray:
    """A (6, 6) matrix in the mirror at the plane y = 0."""
    return matrix * np.outer(_SIGNS, _SIGNS)


def mirrored_direction(direction: Vector) -> Vector:
    """A direction in the mirror at the plane y = 0."""
    x, y, z = direction
    return (x, -y, z)
