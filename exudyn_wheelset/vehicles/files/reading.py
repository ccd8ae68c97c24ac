"""`load_vehicle`: a vehicle from a TOML file, or VehicleError with file, line, value and mend."""

from __future__ import annotations

import functools
import importlib.resources
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset.checking import unknown
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.contact.descriptions import Contact, Track, Wheelset
from exudyn_wheelset.contact.rail_section import RailSection
from exudyn_wheelset.errors import VehicleError, WheelsetError
from exudyn_wheelset.profiles import Profile, load_profile
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.vehicles.builder import VehicleBuilder
from exudyn_wheelset.vehicles.description import GROUND, Axle, Body, Load, Vehicle
from exudyn_wheelset.vehicles.files.converting import (
    EntryError,
    fields_of,
    frozen,
    key_in,
    to_object,
)
from exudyn_wheelset.vehicles.files.element_types import element_type
from exudyn_wheelset.vehicles.files.lines import line_of
from exudyn_wheelset.vehicles.files.track_entries import irregularity_of, layout_of
from exudyn_wheelset.vehicles.files.units import Implausible, check_axle, check_vehicle

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

TOP = ("name", "description", "preload", "gravity", "check")
TABLES = ("track", "contact")
LISTS = ("profile", "wheelset", "body", "connection", "load")
OF_AXLE = ("name", "x", "driven")
OF_CONNECTION = ("name", "type", "between", "at", "preload", "offset", "element")
# Entries of Wheelset and Track that are profiles, and what kind of.
PROFILES = {"wheel": "wheel", "right_wheel": "wheel", "rail": "rail", "right_rail": "rail"}
# A file of a vehicle with sampled profiles has some 100 kB.
_LARGEST = 20_000_000


@spelt
def load_vehicle(path: str | os.PathLike[str], *, check: bool = True) -> Vehicle:
    """The vehicle of a TOML file (see vehicles/files), or that a bare name such as "dtu_car" means.

    check: refuse what no vehicle has (units.py): millimetres for metres, tonnes for kilograms,
    parts that nothing holds, a body that sinks by a metre; `check = false` in the file means the
    same as False here. Profile files are found beside the vehicle file. Raises VehicleError with
    the file, the line or key, the value and the mend.

    Examples
    --------
    >>> from exudyn_wheelset import catalogue, load_vehicle, save_vehicle
    >>> path = save_vehicle(catalogue.vehicle("dtu_car"), "car.toml")
    >>> load_vehicle(path).name
    'DTU car'
    """
    file = _file_of(path)
    try:
        data = file.read_bytes()
        text = data.decode("utf-8-sig")
    except OSError as error:
        raise VehicleError(f"{path} cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise VehicleError(f"{path}, line {line}: no UTF-8 text: save the file as UTF-8") from error
    if len(data) > _LARGEST:
        raise VehicleError(f"{path} has {len(data)} bytes: give a vehicle file")
    return vehicle_of(text, str(path), file.parent, check)


def vehicle_of(text: str, label: str, folder: Path, check: bool = True) -> Vehicle:
    """The vehicle of a file's text; label: the file in messages, folder: where profiles are."""
    return _Reader(label, text, folder).vehicle(check)


def _file_of(path: str | os.PathLike[str]) -> Path:
    try:
        file = Path(path)
        if file.is_file():
            return file
    except (TypeError, ValueError, OSError) as error:
        raise VehicleError(f"path = {path!r}: give the path of a file ({error})") from error
    if str(path).isidentifier():
        shipped = importlib.resources.files("exudyn_wheelset") / "catalogue" / "files"
        inside = Path(str(shipped)) / f"{path}.toml"
        if inside.is_file():
            return inside
    raise VehicleError(f"{path}: no such file: give the path of a vehicle file (TOML)")


class _Reader:
    """One file being read: its text for the lines of messages, its folder for profiles."""

    def __init__(self, label: str, text: str, folder: Path) -> None:
        self._label = label
        self._text = text
        self._folder = folder
        self._profiles: dict[str, Profile] = {}
        self._top: dict[str, Any] = {}
        self._checked = True

    def vehicle(self, check: bool) -> Vehicle:
        """The vehicle that the file describes."""
        top = self._top = self._parsed()
        self._checked = check and top.get("check", True) is True
        for number, entry in enumerate(top.get("profile", [])):
            with self._reading("profile", number):
                key, profile = _sampled(entry)
                self._profiles[key] = profile
        with self._reading("track"):
            track = self._track(top.get("track", {}))
        with self._reading("contact"):
            contact = _contact(top.get("contact", {}))
        with self._reading(""):
            if not isinstance(top.get("description", ""), str):
                raise EntryError(f"description = {top['description']!r}: give text", "description")
            if not isinstance(top.get("check", True), bool):
                raise EntryError(f"check = {top['check']!r}: give true or false", "check")
            if "name" not in top:
                raise EntryError('name is missing: give the vehicle a name = "..."')
            made = VehicleBuilder(
                top["name"],
                track,
                contact,
                preload=top.get("preload", "drawing"),
                gravity=top.get("gravity", GRAVITY),
            )
        for kind, add in (
            ("wheelset", self._add_wheelset),
            ("body", _add_body),
            ("connection", _add_connection),
            ("load", _add_load),
        ):
            for number, table in enumerate(self._resolved(kind)):
                with self._reading(kind, number):
                    add(made, table)
        try:
            vehicle = made.finish()
            if self._checked:
                check_vehicle(vehicle)
        except Implausible as error:
            raise self._fault(
                str(error), *self._place(error.kind, error.name), error.key
            ) from error
        except WheelsetError as error:
            raise self._fault(str(error), *self._place_in(str(error))) from error
        return vehicle

    def _parsed(self) -> dict[str, Any]:
        """The file as tables; VehicleError for what is no TOML or has unknown tables."""
        try:
            top = tomllib.loads(self._text.replace("\r\n", "\n"))
        except (ValueError, RecursionError) as error:
            raise VehicleError(f"{self._label}: no TOML: {error}") from error
        for key, value in top.items():
            if key not in (*TOP, *TABLES, *LISTS):
                words = str(unknown("key", key, [*TOP, *TABLES, *LISTS]))
                raise self._fault(words, key if isinstance(value, dict | list) else "", 0, key)
            if key in TABLES and not isinstance(value, dict):
                raise self._fault(f"{key} = {value!r}: give a table [{key}]", "", 0, key)
            if key in LISTS and not (
                isinstance(value, list) and all(isinstance(one, dict) for one in value)
            ):
                raise self._fault(f"{key} is no list of tables: give [[{key}]]", key, 0, key)
        return top

    def _resolved(self, kind: str) -> list[dict[str, Any]]:
        """The tables of a kind, those that say `like` completed from an earlier one."""
        named: dict[str, dict[str, Any]] = {}
        tables = []
        for number, given in enumerate(self._top.get(kind, [])):
            table = dict(given)
            if "like" in table:
                like = table.pop("like")
                with self._reading(kind, number):
                    if not isinstance(like, str) or like not in named:
                        words = unknown(f"earlier {kind}", like, list(named))
                        raise EntryError(str(words), "like")
                    table = {**named[like], **table}
                    if "name" not in given:
                        table.pop("name")
            tables.append(table)
            if isinstance(table.get("name"), str):
                named[table["name"]] = table
        return tables

    def _add_wheelset(self, made: VehicleBuilder, table: dict[str, Any]) -> None:
        own = [name for name in table if name not in OF_AXLE]
        known = [*OF_AXLE, *fields_of(Wheelset), "like"]
        _check_keys(table, known, ("name", "x"))
        solid = to_object(Wheelset, self._with_profiles({name: table[name] for name in own}))
        driven = table.get("driven", False)
        if not isinstance(driven, bool):
            raise EntryError(f"driven = {driven!r}: give true or false", "driven")
        made.wheelset(table["name"], solid, table["x"], driven=driven)
        if self._checked:
            # Before what stands on it is refused for its place.
            try:
                check_axle(Axle(table["name"], solid, table["x"]))
            except Implausible as error:
                raise EntryError(str(error), error.key) from error

    def _with_profiles(self, table: dict[str, Any]) -> dict[str, Any]:
        """A table with the profiles that it names."""
        made = dict(table)
        for key, kind in PROFILES.items():
            if key in made:
                try:
                    made[key] = self._profile(made[key], kind)
                except Exception as error:
                    raise EntryError(f"{key} = {made[key]!r}: {error}", key) from error
        return made

    def _track(self, table: dict[str, Any]) -> Track:
        made = self._with_profiles(table)
        for key, make in (("layout", layout_of), ("irregularity", irregularity_of)):
            if key in made:
                try:
                    made[key] = make(made[key], self._folder)
                except Exception as error:
                    raise EntryError(f"{key}: {error}", key) from error
        if "sections" in made:
            made["sections"] = tuple(self._section(one) for one in made["sections"])
        track: Track = to_object(Track, made)
        return track

    def _section(self, table: Any) -> RailSection:
        if not isinstance(table, dict):
            raise EntryError(f"{table!r} is no section of rails: give a table", "sections")
        _check_keys(table, ["start", "rail", "right_rail"], ("start", "rail"))
        return RailSection(**self._with_profiles(table))

    def _profile(self, source: Any, kind: str) -> Profile:
        options: dict[str, Any] = {}
        if isinstance(source, dict):
            options = {key: value for key, value in source.items() if key != "file"}
            source = source.get("file")
        if not isinstance(source, str) or not source:
            raise EntryError('give the name of a profile, or {file = "..."}')
        if source in self._profiles and not options:
            return self._profiles[source]
        beside = self._folder / source
        if beside.is_file():
            return load_profile(beside, **{"kind": kind, **options})
        if Path(source).is_file():
            raise EntryError(f"no such file in {self._folder}: give its path from there")
        if options:
            return load_profile(source, **{"kind": kind, **options})
        return _of_package(source, kind)

    @contextmanager
    def _reading(self, table: str, number: int = 0) -> Iterator[None]:
        """What goes wrong inside is a fault of that table."""
        try:
            yield
        except VehicleError:
            raise
        except EntryError as error:
            raise self._fault(str(error), table, number, error.key) from error
        except WheelsetError as error:
            raise self._fault(str(error), table, number, key_in(str(error))) from error
        except Exception as error:
            words = f"{type(error).__name__}: {error}: check the kinds of its entries"
            raise self._fault(words, table, number) from error

    def _fault(self, message: str, table: str, number: int = 0, key: str = "") -> VehicleError:
        line = line_of(self._text, table, number, key)
        place = f"{self._label}, line {line}" if line else self._label
        header = f"[{table}]" if table in TABLES else f"[[{table}]] number {number + 1}"
        entries = self._top.get(table)
        if isinstance(entries, list) and number < len(entries):
            name = entries[number].get("name")
            header = f"{table} {name!r}" if isinstance(name, str) else header
        parts = [place, header if table in (*TABLES, *LISTS) else "", key]
        if key and message.startswith((key, f"{header}: {key}")):
            parts.pop()
        if message.startswith(header):
            parts[1] = ""
        return VehicleError(": ".join([part for part in parts if part] + [message]))

    def _place(self, kind: str, name: str) -> tuple[str, int]:
        """Table and number of the entry of a kind and name."""
        for number, table in enumerate(self._top.get(kind, [])):
            if isinstance(table, dict) and table.get("name", table.get("body")) == name:
                return kind, number
        return (kind, 0) if kind in TABLES else ("", 0)

    def _place_in(self, message: str) -> tuple[str, int]:
        """Table and number of the entry whose name a message says first."""
        found = []
        for kind in LISTS[1:]:
            for number, table in enumerate(self._top.get(kind, [])):
                name = table.get("name")
                if isinstance(name, str) and repr(name) in message:
                    found.append((message.index(repr(name)), kind, number))
        return min(found)[1:] if found else ("", 0)


@functools.lru_cache(maxsize=16)
def _of_package(name: str, kind: str) -> Profile:
    # Profiles do not change, and reading one takes longer than all else in a vehicle's file.
    return load_profile(name, kind=kind)


def _add_body(made: VehicleBuilder, table: dict[str, Any]) -> None:
    _check_keys(table, [*fields_of(Body), "like"], tuple(fields_of(Body)))
    made.body(**{key: frozen(value) for key, value in table.items()})


def _add_load(made: VehicleBuilder, table: dict[str, Any]) -> None:
    _check_keys(table, list(fields_of(Load)), tuple(fields_of(Load)))
    made.load(table["body"], frozen(table["force"]), frozen(table["at"]))


def _add_connection(made: VehicleBuilder, table: dict[str, Any]) -> None:
    if "type" not in table:
        raise EntryError('type is missing: give that of the element, such as type = "spring"')
    try:
        cls = element_type(table["type"])
    except WheelsetError as error:
        raise EntryError(str(error), "type") from error
    known = fields_of(cls)
    _check_keys(table, [*OF_CONNECTION, *known, "like"], ("between", "at"))
    entries = {key: value for key, value in table.items() if key not in OF_CONNECTION}
    apart = table.get("element", {})
    if not isinstance(apart, dict):
        raise EntryError(f"element = {apart!r}: give a table", "element")
    element = to_object(cls, {**entries, **apart})
    between = table["between"]
    if (
        not isinstance(between, list)
        or len(between) != 2
        or not all(isinstance(end, str) for end in between)
    ):
        raise EntryError(f'between = {between!r}: give two names, ["lower", "upper"]', "between")
    for end in between:
        if end != GROUND and end not in made.names:
            raise EntryError(str(unknown("part", end, [*made.names, GROUND])), "between")
    made.connect(
        element,
        between[0],
        between[1],
        at=frozen(table["at"]),
        name=table.get("name"),
        preload=frozen(table.get("preload")),
        offset=frozen(table.get("offset", [0.0, 0.0, 0.0])),
    )


def _check_keys(table: dict[str, Any], known: list[str], needed: tuple[str, ...]) -> None:
    for key in table:
        if key not in known:
            raise EntryError(str(unknown("key", key, known)), key)
    missing = [key for key in needed if key not in table]
    if missing:
        raise EntryError(f"{missing[0]} is missing: give {', '.join(missing)}")


def _contact(table: dict[str, Any]) -> Contact:
    try:
        return Contact(**table)
    except WheelsetError as error:
        key = key_in(str(error))
        if not key:
            key = next((one for one in table if repr(one) in str(error)), "")
        raise EntryError(str(error), key) from error


def _sampled(table: dict[str, Any]) -> tuple[str, Profile]:
    """Key and profile of a [[profile]]."""
    _check_keys(table, ["key", "points", *fields_of(Profile)], ("name", "kind", "points"))
    entries = {key: value for key, value in table.items() if key not in ("key", "points")}
    points = np.array(table["points"], dtype=float)
    if points.ndim != 2 or points.shape[1] != 2:
        raise EntryError("points: give pairs [y, z] in metres", "points")
    key = table.get("key", table["name"])
    if not isinstance(key, str) or not isinstance(table["name"], str):
        raise EntryError(f"name = {table['name']!r}, key = {key!r}: give texts", "name")
    return key, Profile(y=points[:, 0], z=points[:, 1], **entries)
