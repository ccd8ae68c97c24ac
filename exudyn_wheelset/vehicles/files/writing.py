"""`save_vehicle`: a vehicle as a TOML file that gives an equal vehicle when it is read again."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.contact.descriptions import Track
from exudyn_wheelset.errors import VehicleError, WheelsetError
from exudyn_wheelset.profiles import Profile, load_profile
from exudyn_wheelset.results.files import write_atomically
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.files.converting import to_table
from exudyn_wheelset.vehicles.files.element_types import type_name
from exudyn_wheelset.vehicles.files.reading import OF_CONNECTION, vehicle_of
from exudyn_wheelset.vehicles.files.track_entries import irregularity_table, layout_table
from exudyn_wheelset.vehicles.files.units import check_vehicle

# What an entry has of its own where all else is like that of an earlier one.
_OWN = {
    "wheelset": ("name", "x"),
    "body": ("name", "centre"),
    "connection": ("name", "between", "at"),
}


@spelt
def save_vehicle(vehicle: Vehicle, path: str | os.PathLike[str], *, description: str = "") -> Path:
    """Write a vehicle as a TOML file; return its path.

    Profiles of the package are written by name, others with their points. A vehicle that
    `load_vehicle` would refuse for its proportions is marked `check = false`. The text is read
    again before it is written: VehicleError for an element that does not come out equal, as one
    that changes the numbers it is given at each creation, and for a contact or an element that no
    file can name.

    Examples
    --------
    >>> from exudyn_wheelset import catalogue, save_vehicle
    >>> save_vehicle(catalogue.vehicle("dtu_car"), "car.toml", description="with my changes").name
    'car.toml'
    """
    if not isinstance(vehicle, Vehicle):
        raise VehicleError(f"{vehicle!r} is no Vehicle: give one, as VehicleBuilder.finish() does")
    try:
        text = vehicle_text(vehicle, description)
    except WheelsetError as error:
        raise VehicleError(f"{vehicle.name!r} cannot be written: {error}") from error
    again = vehicle_of(text, str(path), Path(path).parent, check=False)
    for what in vehicle.__dataclass_fields__:
        if getattr(again, what) != getattr(vehicle, what):
            raise VehicleError(
                f"{vehicle.name!r} cannot be written: its {what} are not equal when they are read "
                "again: see that the classes keep the numbers that they are given"
            )
    return write_atomically(Path(path), lambda part: part.write_text(text, "utf-8", newline="\n"))


def vehicle_text(vehicle: Vehicle, description: str = "") -> str:
    """The text of a vehicle's file."""
    import tomlkit

    profiles: dict[str, Profile] = {}

    def profile_key(profile: Profile) -> str:
        try:
            if load_profile(profile.name) == profile:
                return profile.name
        except WheelsetError:
            pass
        key, number = profile.name, 1
        while profiles.get(key, profile) != profile or _is_shipped(key):
            number += 1
            # In brackets: "cone_0.05 2" would be the cone of 0.052.
            key = f"{profile.name} ({number})"
        profiles[key] = profile
        return key

    document = tomlkit.document()
    document.add(tomlkit.comment("A vehicle in SI units, track frame: x forward, y left, z up."))
    document["name"] = vehicle.name
    if description:
        document["description"] = description
    document["preload"] = vehicle.preload
    if vehicle.gravity != GRAVITY:
        document["gravity"] = vehicle.gravity
    try:
        check_vehicle(vehicle)
    except WheelsetError:
        document["check"] = False
    document["track"] = _track_table(vehicle.track, profile_key)
    document["contact"] = _contact_table(vehicle)
    lists = {
        "wheelset": [
            {
                "name": axle.name,
                "x": axle.x,
                **({"driven": True} if axle.driven else {}),
                **to_table(axle.wheelset, profile_key),
            }
            for axle in vehicle.wheelsets
        ],
        "body": [to_table(body, profile_key) for body in vehicle.bodies],
        "connection": [_connection_table(one) for one in vehicle.connections],
        "load": [to_table(load, profile_key) for load in vehicle.loads],
    }
    for kind, tables in lists.items():
        if tables:
            document[kind] = _likened(kind, tables)
    if profiles:
        listed = tomlkit.aot()
        for key, profile in profiles.items():
            listed.append(_profile_table(key, profile))
        document["profile"] = listed
    return tomlkit.dumps(document)


def _is_shipped(name: str) -> bool:
    try:
        load_profile(name)
    except WheelsetError:
        return False
    return True


def _track_table(track: Track, profile_key: Callable[[Profile], str]) -> dict[str, Any]:
    plain = replace(track, layout=None, irregularity=None)
    table: dict[str, Any] = to_table(plain, profile_key)
    if track.layout is not None:
        table["layout"] = layout_table(track.layout)
    if track.irregularity is not None:
        table["irregularity"] = irregularity_table(track.irregularity)
    return table


def _contact_table(vehicle: Vehicle) -> dict[str, Any]:
    contact = vehicle.contact
    if not isinstance(contact.creep, str):
        raise VehicleError(
            f"its creep law is a function, {contact.creep!r}: register it (register_creep_law) and "
            "give its name"
        )
    table = dict(to_table(contact, None))
    law = dict(contact.law_parameters)
    table.pop("law_parameters", None)
    # Zeros are numbers like others here: the file says all that the contact is.
    table = {
        name: getattr(contact, name)
        for name in contact.__dataclass_fields__
        if name != "law_parameters" and getattr(contact, name) is not None
    }
    return {**table, **({"law_parameters": law} if law else {})}


def _connection_table(one: Any) -> dict[str, Any]:
    element = to_table(one.element, None)
    apart = {key: value for key, value in element.items() if key in OF_CONNECTION}
    table = {
        "name": one.name,
        "type": type_name(type(one.element)),
        "between": [one.lower, one.upper],
        "at": list(one.at),
        **{key: value for key, value in element.items() if key not in apart},
    }
    if one.preload is not None:
        table["preload"] = list(one.preload)
    if any(one.offset):
        table["offset"] = list(one.offset)
    return {**table, "element": apart} if apart else table


def _likened(kind: str, tables: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The tables, those that differ from an earlier one in their own entries alone by `like`."""
    if kind not in _OWN:
        return tables
    own = _OWN[kind]
    written: list[dict[str, Any]] = []
    first: list[tuple[dict[str, Any], str]] = []
    for table in tables:
        rest = {key: value for key, value in table.items() if key not in own}
        like = next((name for other, name in first if other == rest), None)
        if like is None or len(rest) < 2:
            first.append((rest, table["name"]))
            written.append(table)
        else:
            kept = {key: value for key, value in table.items() if key in own}
            written.append({"name": kept.pop("name"), "like": like, **kept})
    return written


def _profile_table(key: str, profile: Profile) -> Any:
    import tomlkit

    table = tomlkit.table()
    if key != profile.name:
        table["key"] = key
    table["name"] = profile.name
    table["kind"] = profile.kind
    for what in ("source", "smoothing", "is_mirrored", "is_automatic", "ends_at_gauge_face"):
        if getattr(profile, what):
            table[what] = getattr(profile, what)
    if profile.remarks:
        table["remarks"] = list(profile.remarks)
    rows = zip(profile.y.tolist(), profile.z.tolist(), strict=True)
    points = tomlkit.array("[]").multiline(True)
    points.extend([[y, z] for y, z in rows])
    table["points"] = points
    return table
