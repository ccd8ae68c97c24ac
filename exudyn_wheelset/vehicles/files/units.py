"""What no vehicle has: numbers in a file that are in another unit than its key asks for.

A vehicle in a script is refused for what is impossible. A file is refused for what is out of
proportion too, by a factor of a thousand at least: it was typed from a sheet in mm, t or kN/mm.
Bounds, with the widest of what is built:

    mass of a body           up to 200 t (a heavy locomotive); of a wheelset 100 kg to 20 t
    radius of gyration       0.03 times to (1.5 m + 1.5 times) the body's reach, which is where its
                             connections are; a wheelset 0.1 to 1.5 m (solid axle with wheels: 0.8)
    moments of inertia       the least at least 1/1000 of the largest (a rod 2 m long, 0.1 m thick:
                             1/270; a car body 1/35)
    radius of a wheel        0.1 (roller rigs) to 1 m
    places                   |y| up to 4 m, |x| up to 60 m, z from -1 to 10 m, not within 5 cm of
                             the rail tops but for 0; centres from 0.1 m up; connections not
                             within 1 cm of the vehicle's middle, along or across, but for 0
    stiffness                1e4 (lateral, of an air spring: 1e5) to 1e9 N/m (the contact of wheel
                             and rail), of faces that press to 1e10; damping 100 (a rubber block:
                             1e3) to 1e7 N s/m; zero is free
    play, gap                0.1 mm to 0.5 m, zero is free; forces up to 3 times the weight
    pressing force           from 100 N up; radius of a plate from 3 cm up
    table                    1 mm to 1 m or 0.01 to 5 m/s; relaxation in series up to 1 s
    friction                 0.01 (of an element 0.002) to 1.5, zero is free
    inclination              from 1/1000, zero is free
    sinking under the load   1 m (balance.py)

Every part must be tied to the others.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import fields

import numpy as np

from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.vehicles.balance import balance, given_preloads
from exudyn_wheelset.vehicles.description import GROUND, Axle, Connection, Vehicle
from exudyn_wheelset.vehicles.elements.protocol import Law
from exudyn_wheelset.vehicles.struts import struts_of

_SOFTEST, _STIFFEST = 1.0e4, 1.0e9
_LIGHTEST_DAMPING, _HEAVIEST_DAMPING = 100.0, 1.0e7
_SHORTEST_WAY, _WIDEST_WAY = 1.0e-4, 0.5
_LEAST_PRESSURE = 100.0
_NEAREST = 0.01
_GREATEST_FORCE = 3.0
_FASTEST = 5.0
_LONGEST_RELAXATION = 1.0


class Implausible(WheelsetError):
    """A number out of proportion: kind and name of the entry that has it, and its key."""

    def __init__(self, kind: str, name: str, key: str, message: str) -> None:
        super().__init__(
            f"{message}; if it is meant, put check = false at the top of the file, or load it with "
            "check=False"
        )
        self.kind, self.name, self.key = kind, name, key


def check_vehicle(vehicle: Vehicle) -> None:
    """Raise Implausible for a number out of proportion, WheelsetError for what cannot stand."""
    _check_track(vehicle)
    for axle in vehicle.wheelsets:
        check_axle(axle)
    for body in vehicle.bodies:
        _within("body", body.name, "mass", body.mass, 1.0, 2.0e5, "kg")
        _check_place("body", body.name, "centre", body.centre, 0.1)
        reach = max(
            (
                math.dist(place, body.centre)
                for one in vehicle.connections
                for end, place in zip((one.lower, one.upper), _places(one), strict=True)
                if end == body.name
            ),
            default=0.0,
        )
        low, high = 0.03 * reach, 1.5 + 1.5 * reach
        _check_inertia("body", body.name, body.mass, body.inertia, low, high, 1e-3)
    weight = vehicle.mass * max(vehicle.gravity, 1.0)
    for one in vehicle.connections:
        _check_connection(one, _GREATEST_FORCE * weight)
    for load in vehicle.loads:
        size = math.hypot(*load.force)
        _within("load", load.body, "force", size, 0.0, _GREATEST_FORCE * weight, "N")
        _check_place("load", load.body, "at", load.at, -1.0)
    _check_tied(vehicle)
    centres = np.array([part.centre for part in vehicle.parts])
    struts = struts_of(vehicle, centres)
    balance(vehicle, struts, centres, given_preloads(vehicle, struts), tapes=True)


def check_axle(axle: Axle) -> None:
    """Raise Implausible for a wheelset out of proportion."""
    solid = axle.wheelset
    _within("wheelset", axle.name, "radius", solid.radius, 0.1, 1.0, "m")
    _within("wheelset", axle.name, "mass", solid.mass, 100.0, 2.0e4, "kg")
    _check_inertia("wheelset", axle.name, solid.mass, solid.inertia, 0.1, 1.5, 0.005)
    _within("wheelset", axle.name, "x", axle.x, -60.0, 60.0, "m")


def _check_track(vehicle: Vehicle) -> None:
    track, contact = vehicle.track, vehicle.contact
    _within("track", "", "gauge_depth", track.gauge_depth, 1e-3, 0.05, "m")
    _within("track", "", "inclination", abs(track.inclination), 1e-3, 0.2, "-")
    for name in fields(contact):
        value = getattr(contact, name.name)
        if name.name.endswith("friction") and value is not None:
            _within("contact", "", name.name, value, 0.01, 1.5, "-")
    _within("contact", "", "shear_modulus", contact.shear_modulus, 1e9, 1e12, "Pa")
    _within("contact", "", "poisson", contact.poisson, 0.05, 0.5, "-")
    _within("", "", "gravity", vehicle.gravity, 1.0, 30.0, "m/s^2")


def _check_inertia(
    kind: str,
    name: str,
    mass: float,
    inertia: tuple[float, float, float],
    low: float,
    high: float,
    least: float,
) -> None:
    gyration = math.sqrt(max(inertia) / mass)
    if not low <= gyration <= high:
        raise Implausible(
            kind,
            name,
            "inertia",
            f"mass = {mass:g} kg and inertia = {inertia} kg m^2 make a radius of gyration of "
            f"{gyration:.3g} m, where {low:.2g} to {high:.2g} m belong to its size: give kg and "
            "kg m^2",
        )
    if min(inertia) < least * max(inertia):
        raise Implausible(
            kind,
            name,
            "inertia",
            f"inertia = {inertia} kg m^2: the least is {min(inertia) / max(inertia):.2g} times the "
            f"largest (at least {least:g}): give all three in kg m^2",
        )


def _check_connection(one: Connection, greatest: float) -> None:
    _check_place("connection", one.name, "at", one.at, -1.0)
    for value in one.at[:2]:
        if 1e-9 < abs(value) < _NEAREST:
            raise Implausible(
                "connection",
                one.name,
                "at",
                f"at = {one.at} m stands {value:g} m beside the middle (0, or {_NEAREST:g} m and "
                "more): give metres",
            )
    if one.preload is not None:
        force = math.hypot(*one.preload)
        _within("connection", one.name, "preload", force, 0.0, greatest, "N")
    for law in one.element.laws() if hasattr(one.element, "laws") else ():
        for key, values, low, high, unit in (
            ("stiffness", _along(law, 0), _SOFTEST, _STIFFEST, "N/m"),
            ("damping", _along(law, 1), _LIGHTEST_DAMPING, _HEAVIEST_DAMPING, "N s/m"),
        ):
            for value in values:
                _within("connection", one.name, key, value, low, high, unit)
        _check_ways(one, law, greatest)


def _check_ways(one: Connection, law: Law, greatest: float) -> None:
    """Play, gaps and tables of displacement, forces of friction."""
    if law.stop is not None:
        way, force = law.stop.points[-1]
        _within("connection", one.name, "table", way, 1e-3, 2.0 * _WIDEST_WAY, "m")
        _within("connection", one.name, "table", force, 0.0, 100.0 * greatest, "N")
    if law.blow_off is not None:
        # A damper in series has its table the other way round.
        force, speed = law.blow_off.points[-1]
        if law.state is None:
            force, speed = speed, force
        _within("connection", one.name, "table", speed, 0.01, _FASTEST, "m/s")
        _within("connection", one.name, "table", force, 0.0, 100.0 * greatest, "N")
    if law.state is not None and law.stiffness[0] > 0.0:
        relaxation = law.damping[0] / law.stiffness[0]
        if relaxation > _LONGEST_RELAXATION:
            raise Implausible(
                "connection",
                one.name,
                "damping",
                f"stiffness = {law.stiffness[0]:g} N/m and damping = {law.damping[0]:g} N s/m let "
                f"a force relax in {relaxation:.3g} s (at most {_LONGEST_RELAXATION:g} s): give "
                "N/m and N s/m",
            )
    friction = getattr(law, "friction", None)
    if friction is None:
        return
    for key, value, low, high, unit in (
        ("gap", friction.gap, _SHORTEST_WAY, _WIDEST_WAY, "m"),
        ("play", friction.play, _SHORTEST_WAY, _WIDEST_WAY, "m"),
        ("radius", friction.radius, 0.03, 1.0, "m"),
        ("stop", friction.stop, _SOFTEST, _STIFFEST, "N/m"),
        ("stiffness", friction.stiffness, _SOFTEST, 10.0 * _STIFFEST, "N/m"),
        (_named(one, "column_force", "force"), abs(friction.force), _LEAST_PRESSURE, greatest, "N"),
        *(("friction", sliding.friction, 0.002, 1.5, "-") for sliding in friction.slidings),
    ):
        _within("connection", one.name, key, value, low, high, unit)


def _named(one: Connection, *keys: str) -> str:
    """The first of the keys that the element has."""
    return next((key for key in keys if hasattr(one.element, key)), keys[-1])


def _along(law: Law, which: int) -> Iterable[float]:
    """Stiffnesses (0) or dampings (1) of a law along its axes."""
    if law.matrices is not None:
        return [float(value) for value in np.diag(law.matrices[which])[:3]]
    return law.damping if which else law.stiffness


def _check_place(
    kind: str, name: str, key: str, place: tuple[float, float, float], lowest: float
) -> None:
    for value, low, high in zip(place, (-60.0, -4.0, lowest), (60.0, 4.0, 10.0), strict=True):
        on_rail = high == 10.0 and 0.0 < abs(value) < 0.05
        if on_rail or not low <= value <= high:
            raise Implausible(
                kind,
                name,
                key,
                f"{key} = {place} m lies outside a vehicle (x up to 60 m, y up to 4 m, z from "
                f"{lowest:g} to 10 m): give metres from the plane of the rail tops",
            )


def _within(
    kind: str, name: str, key: str, value: float, low: float, high: float, unit: str
) -> None:
    if value != 0.0 and not low <= value <= high:
        shown = "" if unit == "-" else f" {unit}"
        raise Implausible(
            kind,
            name,
            key,
            f"{key} = {value:g}{shown} is out of proportion (usual: {low:g} to {high:g}{shown}): "
            f"give it in {unit if shown else 'plain numbers'}",
        )


def _check_tied(vehicle: Vehicle) -> None:
    """Raise Implausible for a part that no connection ties to the first one."""
    near: dict[str, set[str]] = {part.name: set() for part in vehicle.parts}
    near[GROUND] = set()
    for one in vehicle.connections:
        near[one.lower].add(one.upper)
        near[one.upper].add(one.lower)
    reached: set[str] = set()
    ahead = [vehicle.parts[0].name]
    while ahead:
        name = ahead.pop()
        if name not in reached:
            reached.add(name)
            ahead += near[name]
    for part in vehicle.parts:
        if part.name not in reached:
            kind = "wheelset" if part in vehicle.wheelsets else "body"
            raise Implausible(
                kind,
                part.name,
                "",
                f"{kind} {part.name!r} is not connected with {vehicle.parts[0].name!r}: add the "
                "[[connection]] that is missing",
            )


def _places(one: Connection) -> tuple[tuple[float, ...], tuple[float, ...]]:
    lower, upper = one.element.places(one.at)
    return tuple(lower), tuple(upper)
