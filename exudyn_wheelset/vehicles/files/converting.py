"""Tables of a file to objects and back, by the annotations of their classes (cattrs).

Stricter than cattrs by itself: no text is taken for a number, no number for True, no list of
another length for a tuple. Objects are made by calling their classes, which check the values.
"""

from __future__ import annotations

import dataclasses
import functools
import inspect
from collections.abc import Iterable, Mapping
from typing import Any, get_args, get_origin

from exudyn_wheelset.checking import unknown
from exudyn_wheelset.contact.rail_section import RailSection
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.profiles import Profile
from exudyn_wheelset.track.irregularity import Irregularity
from exudyn_wheelset.track.layout import Layout

# What is an object already where a table is turned into one.
MADE = (Profile, Layout, Irregularity, RailSection)
_KINDS = {bool: "true or false", str: "text", int: "a whole number", float: "a number"}


class EntryError(WheelsetError):
    """What is wrong in a table, and under which of its keys ("" for the whole of it)."""

    def __init__(self, message: str, key: str = "") -> None:
        super().__init__(message)
        self.key = key


def to_object(cls: type, table: Mapping[str, Any]) -> Any:
    """An object of `cls` from a table, which holds profiles as objects already.

    Raises EntryError for unknown keys, with the nearest, missing ones, wrong types and what the
    class itself refuses.
    """
    known = fields_of(cls)
    for key in table:
        if key not in known:
            raise EntryError(str(unknown("key", key, list(known))), key)
    missing = [name for name, needed in known.items() if needed and name not in table]
    if missing:
        raise EntryError(f"{missing[0]} is missing: give {', '.join(missing)}")
    try:
        if not dataclasses.is_dataclass(cls):
            return cls(**{key: frozen(value) for key, value in table.items()})
        return _converter().structure(dict(table), cls)
    except Exception as error:
        key, cause = _innermost(error)
        raise EntryError(_words(cause), key or key_in(str(cause))) from error


def to_table(value: Any, profile: Any) -> Any:
    """What a file has for an object: tables, lists, numbers, texts.

    profile: makes an entry of a Profile. Left out is what its class leaves open (None) or empty.
    """
    if isinstance(value, Profile):
        return profile(value)
    if isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return float(value)
    if isinstance(value, Mapping):
        return {str(key): to_table(entry, profile) for key, entry in value.items()}
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Iterable):
        return [to_table(entry, profile) for entry in value]
    table = {}
    for name in fields_of(type(value)):
        entry = getattr(value, name)
        if entry is None or (entry == () and not isinstance(entry, str)):
            continue
        if _is_nothing(entry) and _default_of(type(value), name) == entry:
            continue
        table[name] = to_table(entry, profile)
    return table


def fields_of(cls: type) -> dict[str, bool]:
    """Names of what a class is made from, with True for those that it cannot do without."""
    if dataclasses.is_dataclass(cls):
        return {
            field.name: field.default is dataclasses.MISSING
            and field.default_factory is dataclasses.MISSING
            for field in dataclasses.fields(cls)
            if field.init and not field.name.startswith("_")
        }
    return {
        name: parameter.default is inspect.Parameter.empty
        for name, parameter in inspect.signature(cls).parameters.items()
    }


def frozen(value: Any) -> Any:
    """Lists as tuples, all the way down."""
    return tuple(frozen(entry) for entry in value) if isinstance(value, list) else value


def key_in(message: str) -> str:
    """The entry that a message of the classes begins with, as "body 'frame': mass = ...": mass."""
    before = message.split(" = ", 1)[0] if " = " in message else ""
    words = before.rsplit(": ", 1)[-1].split()
    return words[0].split("[")[0] if words and words[0].isidentifier() else ""


def _default_of(cls: type, name: str) -> Any:
    return inspect.signature(cls).parameters[name].default


def _is_nothing(value: Any) -> bool:
    """Whether a value is zero, False or zeros only."""
    if isinstance(value, tuple):
        return all(_is_nothing(entry) for entry in value)
    return isinstance(value, bool | int | float) and value == 0


@functools.lru_cache(maxsize=1)
def _is_tuple(kind: Any) -> bool:
    origin: Any = get_origin(kind)
    return origin is tuple


def _converter() -> Any:
    from cattrs import Converter

    made = Converter(forbid_extra_keys=True, detailed_validation=True)
    for kind in _KINDS:
        made.register_structure_hook(kind, _strict)
    for kind in MADE:
        made.register_structure_hook(kind, lambda value, _: value)
    made.register_structure_hook_func(lambda kind: kind is Any, lambda value, _: frozen(value))
    made.register_structure_hook_func(_is_tuple, functools.partial(_row, made))
    return made


def _strict(value: Any, kind: type) -> Any:
    wrong = not isinstance(value, int | float if kind is float else kind)
    if wrong or (isinstance(value, bool) and kind is not bool):
        raise WheelsetError(
            f"{value!r} is no {_KINDS[kind].split(' ', 1)[-1]}: give {_KINDS[kind]}"
        )
    return kind(value)


def _row(made: Any, value: Any, kind: Any) -> tuple[Any, ...]:
    inner = get_args(kind)
    if not isinstance(value, list | tuple):
        raise WheelsetError(f"{value!r} is no list: give one, such as [0.0, 0.0, 0.0]")
    if len(inner) == 2 and inner[1] is Ellipsis:
        inner = (inner[0],) * len(value)
    if len(inner) != len(value):
        raise WheelsetError(f"{list(value)!r} has {len(value)} entries: give {len(inner)}")
    return tuple(made.structure(one, of) for one, of in zip(value, inner, strict=True))


def _innermost(error: BaseException) -> tuple[str, BaseException]:
    """The key and the first cause in what cattrs raises."""
    keys = []
    while getattr(error, "exceptions", None):
        error = error.exceptions[0]  # type: ignore[attr-defined]
        for note in getattr(error, "__notes__", ()):
            if hasattr(note, "name"):
                keys.append(str(note.name))
    return ".".join(keys), error


def _words(error: BaseException) -> str:
    if isinstance(error, WheelsetError):
        return str(error)
    return f"{error} ({type(error).__name__}): check the kinds of its entries"
