"""Putting a vehicle together part by part; `finish` gives the frozen description.

coach = VehicleBuilder("coach", track=Track("UIC60"), contact=Contact(friction=0.4))
body = coach.body("body", mass=32e3, inertia=(56.8e3, 1.97e6, 1.97e6), centre=(0, 0, 1.8))
axle = coach.wheelset("axle", Wheelset(...), x=9.5)
coach.connect(Spring(stiffness=(31e6, 4e6, 1e6)), axle, body, at=(axle.x, 1.0, axle.z))
vehicle = coach.finish()
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from exudyn_wheelset.checking import unknown
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.contact.descriptions import Contact, Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt, spelt_class
from exudyn_wheelset.vehicles.description import (
    GROUND,
    Axle,
    Body,
    Connection,
    Load,
    Vehicle,
    check_loading,
)


@dataclass(frozen=True)
class Part:
    """A part of a vehicle being built: its name and the place (x, y, z) [m] of its centre."""

    name: str
    x: float
    y: float
    z: float


@spelt_class
class VehicleBuilder:
    """A vehicle being built. Parts may be named or, in what takes parts, given by their names.

    name, track, contact, preload, gravity: as in Vehicle. ground: the far end of connections that
    stand on no body, such as a car body that runs straight.

    Examples
    --------
    >>> from exudyn_wheelset import Spring, Track, VehicleBuilder, Wheelset
    >>> made = VehicleBuilder("one axle", track=Track("UIC60"))
    >>> axle = made.wheelset("axle", Wheelset(1500, (800, 110, 800), 0.46, "S1002"))
    >>> frame = made.body("frame", 3000, (2000, 3000, 4000), (0, 0, 0.8))
    >>> for y in (1.0, -1.0):
    ...     spring = made.connect(Spring((2e6, 1e6, 1e6)), axle, frame, at=(0, y, axle.z))
    ...
    >>> hold = made.connect(Spring((1e5, 1e5, 1e5)), frame, made.ground, at=(0, 0, 0.8))
    >>> made.finish().mass
    4500.0
    """

    ground = Part(GROUND, 0.0, 0.0, 0.0)

    def __init__(
        self,
        name: str,
        track: Track,
        contact: Contact | None = None,
        *,
        preload: str = "drawing",
        gravity: float = GRAVITY,
    ) -> None:
        self.name = name
        self._track = track
        self._contact = Contact() if contact is None else contact
        self._preload = preload
        self._gravity = check_loading(preload, gravity)
        self._parts: dict[str, Body | Axle] = {}
        self._connections: dict[str, Connection] = {}
        self._loads: list[Load] = []

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the bodies and wheelsets that are there."""
        return tuple(self._parts)

    @spelt
    def body(
        self,
        name: str,
        mass: float,
        inertia: Sequence[float],
        centre: Sequence[float],
    ) -> Part:
        """Add a rigid body: mass [kg], inertia (Ix, Iy, Iz) [kg m^2], centre (x, y, z) [m]."""
        return self._add(Body(name, mass, inertia, centre))  # type: ignore[arg-type]

    @spelt
    def wheelset(
        self, name: str, wheelset: Wheelset, x: float = 0.0, *, driven: bool = False
    ) -> Part:
        """Add a wheelset at x [m]; its part's z is its nominal radius."""
        return self._add(Axle(name, wheelset, x, driven))

    @spelt
    def connect(
        self,
        element: Any,
        lower: Part | str,
        upper: Part | str,
        at: Sequence[float],
        *,
        name: str | None = None,
        preload: Sequence[float] | None = None,
        offset: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> str:
        """Join two parts by an element at a place (x, y, z) [m]; return the connection's name.

        A wheelset goes first, `ground` last. preload, offset: as in Connection. name: if left out,
        that of the element and of the lower part, with a number where that is taken already.
        """
        ends = [self._name_of(part) for part in (lower, upper)]
        if name is None:
            name = self._unused(f"{ends[0]} {_words(type(element).__name__)}")
        elif name in self._connections:
            raise WheelsetError(
                f"{self.name}: two connections are named {name!r}: give each a name of its own"
            )
        self._connections[name] = Connection(
            name,
            element,
            ends[0],
            ends[1],
            at,  # type: ignore[arg-type]
            preload,  # type: ignore[arg-type]
            offset,  # type: ignore[arg-type]
        )
        return name

    def load(self, part: Part | str, force: Sequence[float], at: Sequence[float]) -> None:
        """Add a force (Fx, Fy, Fz) [N] of fixed direction on a part at a place (x, y, z) [m]."""
        self._loads.append(Load(self._name_of(part), force, at))  # type: ignore[arg-type]

    def finish(self) -> Vehicle:
        """The vehicle; raises WheelsetError where something is missing (see Vehicle)."""
        parts = self._parts.values()
        return Vehicle(
            self.name,
            tuple(part for part in parts if isinstance(part, Body)),
            tuple(part for part in parts if isinstance(part, Axle)),
            tuple(self._connections.values()),
            self._track,
            self._contact,
            tuple(self._loads),
            self._preload,
            self._gravity,
        )

    def _add(self, part: Body | Axle) -> Part:
        if part.name in self._parts:
            raise WheelsetError(
                f"{self.name}: two parts are named {part.name!r}: give each a name of its own"
            )
        self._parts[part.name] = part
        return Part(part.name, *part.centre)

    def _name_of(self, part: Part | str) -> str:
        name = part.name if isinstance(part, Part) else part
        if name != GROUND and name not in self._parts:
            raise unknown(f"part of {self.name}:", name, [*self._parts, GROUND])
        return name

    def _unused(self, name: str) -> str:
        number, unused = 1, name
        while unused in self._connections:
            number += 1
            unused = f"{name} {number}"
        return unused


def _words(name: str) -> str:
    """ "MaxwellDamper" as "maxwell damper"."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower()
