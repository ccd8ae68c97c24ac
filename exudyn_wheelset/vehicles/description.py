"""A vehicle as a description: bodies, wheelsets and connections by name; frozen and validated.

Drawn in the track frame (x forward, y left, z up from the plane of the rail tops), with the
vehicle standing at x = 0 where its builder puts it. The wheelsets' centres are drawn at z = radius;
where they really stand on their rails statics.py finds. Everything is hashable, can be pickled and
is equal after a round trip.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from exudyn_wheelset.checking import moments_of_inertia, number, numbers, positive, unknown
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.contact.descriptions import Contact, Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.vehicles.elements.protocol import check_element

# The far end of a connection that stands on no body: what moves along at the forward speed.
GROUND = "ground"
PRELOADS = ("drawing", "free")
# A tape circle farther from the top of its rail has no tread there any more.
_FARTHEST_FROM_RAIL = 0.04
# A connection that meets a wheelset off the axle by more would hold a bearing that turns.
AXLE_TOLERANCE = 2.0e-3


def check_name(what: str, name: Any) -> str:
    """`name`, if it is text that a path of `Vehicle.replace` can hold; WheelsetError otherwise."""
    if not isinstance(name, str) or not name.strip():
        raise WheelsetError(f"{what}: name = {name!r}: give a text")
    if "." in name:
        raise WheelsetError(f"{what}: name = {name!r}: leave out the dot, which paths are split at")
    return name


@dataclass(frozen=True)
class Body:
    """A rigid body: mass [kg], inertia (Ix, Iy, Iz) [kg m^2] about its centre (x, y, z) [m].

    The centre is that of the loaded vehicle at rest, z from the plane of the rail tops. Raises
    WheelsetError for what no body has: each moment of inertia is at most the sum of the others.
    """

    name: str
    mass: float
    inertia: tuple[float, float, float]
    centre: tuple[float, float, float]

    def __post_init__(self) -> None:
        check_name("body", self.name)
        put = object.__setattr__
        put(self, "mass", positive(f"body {self.name!r}: mass", self.mass, "kg", 1e6))
        inertia = moments_of_inertia(f"body {self.name!r}: inertia", self.inertia, self.mass)
        put(self, "inertia", inertia)
        what = f"body {self.name!r}: centre (x, y, z)"
        put(self, "centre", numbers(what, self.centre, 3, "m", -100.0, 100.0, "metres are asked"))


@dataclass(frozen=True)
class Axle:
    """A wheelset of the vehicle at the place x [m]; driven: its spin is held at V/radius."""

    name: str
    wheelset: Wheelset
    x: float
    driven: bool = False

    def __post_init__(self) -> None:
        check_name("wheelset", self.name)
        if not isinstance(self.wheelset, Wheelset):
            raise WheelsetError(
                f"wheelset {self.name!r}: {self.wheelset!r} is no Wheelset: give "
                "Wheelset(mass=..., inertia=..., radius=..., wheel=...)"
            )
        x = number(f"wheelset {self.name!r}: x", self.x, "m", -100.0, 100.0, "metres are asked")
        object.__setattr__(self, "x", x)

    @property
    def centre(self) -> tuple[float, float, float]:
        """Where the centre is drawn [m]."""
        return (self.x, 0.0, self.wheelset.radius)


@dataclass(frozen=True)
class Connection:
    """An element between a lower and an upper body, by name, at a place of the drawing.

    lower, upper: names of bodies or wheelsets, or "ground" for what moves along at the forward
    speed; the element's axes are those of the lower body, or of the upper one where the lower one
    is a wheelset, which spins. at (x, y, z) [m]: where it acts; at a wheelset that is its axle.
    preload: (Fx, Fy, Fz) [N] on the upper body at rest, or None to find it from the balance of the
    bodies. offset (x, y, z) [m]: how far the upper end is from the drawn position where there is
    no force, for `preload="free"` vehicles.
    """

    name: str
    element: Any
    lower: str
    upper: str
    at: tuple[float, float, float]
    preload: tuple[float, float, float] | None = None
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        check_name("connection", self.name)
        what = f"connection {self.name!r}"
        check_element(what, self.element)
        for end in ("lower", "upper"):
            if not isinstance(getattr(self, end), str):
                raise WheelsetError(
                    f"{what}: {end} = {getattr(self, end)!r}: give the name of a body or wheelset"
                )
        if self.lower == self.upper:
            raise WheelsetError(f"{what} joins {self.lower!r} to itself: give two bodies")
        put = object.__setattr__
        mend = "metres are asked"
        put(self, "at", numbers(f"{what}: at (x, y, z)", self.at, 3, "m", -100.0, 100.0, mend))
        if self.preload is not None:
            preload = numbers(f"{what}: preload (Fx, Fy, Fz)", self.preload, 3, "N", -1e7, 1e7)
            put(self, "preload", preload)
        offset = numbers(f"{what}: offset (x, y, z)", self.offset, 3, "m", -2.0, 2.0, mend)
        put(self, "offset", offset)


@dataclass(frozen=True)
class Load:
    """A force (Fx, Fy, Fz) [N] of fixed direction in the track frame on a body, at a place [m]."""

    body: str
    force: tuple[float, float, float]
    at: tuple[float, float, float]

    def __post_init__(self) -> None:
        put = object.__setattr__
        what = f"load on {self.body!r}"
        put(self, "force", numbers(f"{what}: force (Fx, Fy, Fz)", self.force, 3, "N", -1e7, 1e7))
        put(self, "at", numbers(f"{what}: at (x, y, z)", self.at, 3, "m", -100.0, 100.0))


@spelt_class
@dataclass(frozen=True, repr=False)
class Vehicle:
    """Bodies, wheelsets and connections on a track.

    track, contact: the same for all wheelsets. preload: "drawing": the positions given are those
    of the loaded vehicle on its rails, and the forces of the connections at rest follow from the
    balance of every body, those that balance leaves open shared by stiffness; "free": the
    connections are without force in the drawing (but for their `offset`), and the vehicle settles
    from there. gravity [m/s^2]. Raises WheelsetError for names that are not there or there twice,
    bodies that nothing holds, wheelsets that do not stand on the track.

    Examples
    --------
    >>> from exudyn_wheelset import catalogue
    >>> car = catalogue.vehicle("dtu_car")
    >>> softer = car.replace("contact.friction", 0.2)
    >>> len(car.wheelsets), round(car.mass / 1e3, 1)  # [t]
    (4, 54.3)
    """

    name: str
    bodies: tuple[Body, ...]
    wheelsets: tuple[Axle, ...]
    connections: tuple[Connection, ...]
    track: Track
    contact: Contact = field(default_factory=Contact)
    loads: tuple[Load, ...] = ()
    preload: str = "drawing"
    gravity: float = GRAVITY

    def __post_init__(self) -> None:
        put = object.__setattr__
        check_name("vehicle", self.name)
        for what, kind in (
            ("bodies", Body),
            ("wheelsets", Axle),
            ("connections", Connection),
            ("loads", Load),
        ):
            entries = tuple(getattr(self, what))
            for entry in entries:
                if not isinstance(entry, kind):
                    raise WheelsetError(f"{self.name}: {entry!r} in {what} is no {kind.__name__}")
            put(self, what, entries)
        if not isinstance(self.track, Track):
            raise WheelsetError(f"{self.name}: track = {self.track!r}: give a Track")
        if not isinstance(self.contact, Contact):
            raise WheelsetError(f"{self.name}: contact = {self.contact!r}: give a Contact")
        put(self, "gravity", check_loading(self.preload, self.gravity))
        if not self.wheelsets:
            raise WheelsetError(f"{self.name} has no wheelset: give it at least one")
        self._check_names()
        self._check_connections()
        self._check_on_track()

    def __repr__(self) -> str:
        parts = ", ".join(part.name for part in self.parts)
        return f"Vehicle({self.name!r}: {parts}; {len(self.connections)} connections)"

    def _check_names(self) -> None:
        for kind, names in (
            ("body or wheelset", [part.name for part in self.parts]),
            ("connection", [one.name for one in self.connections]),
        ):
            twice = {name for name in names if names.count(name) > 1}
            if twice:
                raise WheelsetError(
                    f"{self.name}: two parts are named {sorted(twice)[0]!r} (a {kind}): give each "
                    "a name of its own"
                )
        if GROUND in [part.name for part in self.parts]:
            raise WheelsetError(f"{self.name}: no part can be named {GROUND!r}: rename it")

    def _check_connections(self) -> None:
        known = [*(part.name for part in self.parts), GROUND]
        on_axle = {axle.name: axle for axle in self.wheelsets}
        for one in self.connections:
            for end in (one.lower, one.upper):
                if end not in known:
                    raise unknown(f"body of connection {one.name!r} of {self.name}:", end, known)
            if one.upper in on_axle and one.lower not in on_axle:
                raise WheelsetError(
                    f"{self.name}: connection {one.name!r} stands with its lower end on "
                    f"{one.lower!r} and carries the wheelset {one.upper!r}: give the wheelset first"
                )
            if one.lower == GROUND:
                raise WheelsetError(
                    f"{self.name}: connection {one.name!r} stands on the ground: give the body "
                    "first and 'ground' as the upper end"
                )
            lower, upper = one.element.places(one.at)
            for end, place in ((one.lower, lower), (one.upper, upper)):
                if end in on_axle:
                    self._check_on_axle(one, on_axle[end], place)
        for load in self.loads:
            if load.body not in known[:-1]:
                raise unknown(f"body of a load of {self.name}:", load.body, known[:-1])
        for body in self.bodies:
            if not any(body.name in (one.lower, one.upper) for one in self.connections):
                raise WheelsetError(
                    f"{self.name}: nothing holds the body {body.name!r}: connect it or leave it out"
                )

    def _check_on_axle(self, one: Connection, axle: Axle, place: Sequence[float]) -> None:
        x, z = place[0] - axle.x, place[2] - axle.wheelset.radius
        if max(abs(x), abs(z)) > AXLE_TOLERANCE:
            raise WheelsetError(
                f"{self.name}: connection {one.name!r} meets the wheelset {axle.name!r} at "
                f"({place[0]:g}, {place[1]:g}, {place[2]:g}) m, off the axle by ({x:g}, 0, {z:g}) m"
                f" (at most {AXLE_TOLERANCE:g} m), where it would turn along with the spin: put it "
                f"at x = {axle.x:g}, z = {axle.wheelset.radius:g} m, or hold it by an axle box, a "
                "body of its own on an AxleBox"
            )

    def _check_on_track(self) -> None:
        for axle in self.wheelsets:
            placements = (self.track.left_placement, self.track.right_placement)
            for side, rail in zip(("left", "right"), placements, strict=True):
                off = axle.wheelset.tape_half_distance - rail.datum_y
                if not abs(off) < _FARTHEST_FROM_RAIL:
                    raise WheelsetError(
                        f"{self.name}: the {side} wheel of {axle.name!r} is not on its rail: its "
                        f"tape circle lies {axle.wheelset.tape_half_distance:g} m from the centre, "
                        f"the rail's top {rail.datum_y:.4f} m (at most {_FARTHEST_FROM_RAIL:g} m "
                        "apart): check gauge and tape_half_distance, both in metres"
                    )

    @property
    def parts(self) -> tuple[Body | Axle, ...]:
        """Wheelsets and bodies, in the order of their coordinates."""
        return (*self.wheelsets, *self.bodies)

    @property
    def mass(self) -> float:
        """Mass [kg] of all parts."""
        bodies = math.fsum(body.mass for body in self.bodies)
        return bodies + math.fsum(axle.wheelset.mass for axle in self.wheelsets)

    def part(self, name: str) -> Body | Axle:
        """The body or wheelset of a name; WheelsetError with the nearest for an unknown one."""
        for part in self.parts:
            if part.name == name:
                return part
        raise unknown(f"part of {self.name}:", name, [part.name for part in self.parts])

    def replace(self, path: str, value: Any) -> Vehicle:
        """A vehicle with one number (or other entry) changed, by its path.

        "bodies.body.mass", "wheelsets.front leading.wheelset.radius", "contact.friction",
        "track.gauge", "connections.yaw damper.damping"; a last entry 0, 1, 2 or x, y, z picks one
        of several numbers: "connections.primary.stiffness.y", xz the first and the last. Where
        no part has that name, all are meant whose name begins or ends with it, as every "front
        left yaw damper" ends with "yaw damper"; "*" means all. What is connected to an axle goes
        along with its place and radius. Raises WheelsetError for what is not there, with the
        nearest.
        """
        from exudyn_wheelset.vehicles.paths import replaced

        changed: Vehicle = replaced(self, path, value)
        return changed

    def on(self, track: Track) -> Vehicle:
        """The vehicle on another track."""
        return dataclasses.replace(self, track=track)

    def create(self, mbs: Any, speed: float, **options: Any) -> Any:
        """Add the vehicle to `mbs` and return its item numbers by name: `add_vehicle`."""
        from exudyn_wheelset.vehicles.assemble import add_vehicle

        return add_vehicle(mbs, self, speed, **options)

    def mirrored(self) -> Vehicle:
        """The vehicle as a mirror at its middle plane shows it: left and right exchanged."""
        return dataclasses.replace(
            self,
            bodies=tuple(
                dataclasses.replace(body, centre=_mirror(body.centre)) for body in self.bodies
            ),
            wheelsets=tuple(
                dataclasses.replace(axle, wheelset=_mirrored_wheelset(axle.wheelset))
                for axle in self.wheelsets
            ),
            connections=tuple(
                dataclasses.replace(
                    one,
                    element=one.element.mirrored(),
                    at=_mirror(one.at),
                    preload=None if one.preload is None else _mirror(one.preload),
                    offset=_mirror(one.offset),
                )
                for one in self.connections
            ),
            loads=tuple(
                dataclasses.replace(load, force=_mirror(load.force), at=_mirror(load.at))
                for load in self.loads
            ),
            track=_mirrored_track(self.track),
            contact=self.contact.mirrored(),
        )


def _mirror(vector: Iterable[float]) -> tuple[float, float, float]:
    x, y, z = vector
    return (x, -y, z)


def _mirrored_wheelset(wheelset: Wheelset) -> Wheelset:
    if wheelset.right_wheel is None and wheelset.right_radius is None:
        return wheelset
    right_wheel = wheelset.right_wheel or wheelset.wheel
    right_radius = wheelset.right_radius or wheelset.radius
    return dataclasses.replace(
        wheelset,
        wheel=right_wheel,
        radius=right_radius,
        right_wheel=wheelset.wheel,
        right_radius=wheelset.radius,
    )


def _mirrored_track(track: Track) -> Track:
    return dataclasses.replace(
        track,
        rail=track.right_rail or track.rail,
        right_rail=None if track.right_rail is None else track.rail,
        layout=None if track.layout is None else track.layout.mirrored(),
        irregularity=None if track.irregularity is None else track.irregularity.mirrored(),
        sections=tuple(
            one
            if one.right_rail is None
            else dataclasses.replace(one, rail=one.right_rail, right_rail=one.rail)
            for one in track.sections
        ),
    )


def check_loading(preload: str, gravity: float) -> float:
    """Gravity [m/s^2] as a float; WheelsetError where it or the kind of preload is none."""
    if preload not in PRELOADS:
        raise unknown("preload", preload, PRELOADS)
    return number("gravity", gravity, "m/s^2", 0.0, 100.0)
