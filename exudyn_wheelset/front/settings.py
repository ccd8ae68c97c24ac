"""Exudyn solver settings from files: the names of exudyn.SimulationSettings, only what differs.

    {"timeIntegration": {"numberOfSteps": 4000, "endTime": 2.0, "solverType": "RK44"},
     "solution.file.write": false}

Nested objects and dotted names both work; enum values are given by name. An unknown name, a wrong
type or a wrong enum value is a SettingsError that names the nearest right one.
"""

from __future__ import annotations

import difflib
import importlib.resources
import json
import math
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import exudyn as exu

from exudyn_wheelset.checking import number
from exudyn_wheelset.errors import SettingsError
from exudyn_wheelset.spelling import spelt

# Exudyn's settings are four deep.
_DEEPEST = 20
_TOO_DEEP = f"nested more than {_DEEPEST} deep: the settings of Exudyn are four deep"


@spelt
def load_settings(
    source: str | PathLike[str] | Mapping[str, Any] | None,
) -> exu.SimulationSettings:
    """Return Exudyn's simulation settings with the entries of a file (or mapping) applied.

    A name that is no file is one of the package's own: "rk44", "generalized_alpha" or "fine".

    Raises SettingsError for a file that cannot be read or is no JSON object, unknown names, wrong
    types, unknown enum values and numbers outside Exudyn's range.

    Examples
    --------
    >>> from exudyn_wheelset import load_settings
    >>> settings = load_settings({"timeIntegration": {"endTime": 2.0, "solverType": "RK44"}})
    >>> settings.timeIntegration.endTime
    2.0
    """
    settings = exu.SimulationSettings()
    if source is None:
        return settings
    if not isinstance(source, str | PathLike | Mapping):
        raise SettingsError(f"{source!r}: give the file of the settings, or a mapping of them")
    if isinstance(source, Mapping):
        entries, origin = source, "settings"
    else:
        entries, origin = _read(Path(source)), str(source)
    apply_settings(settings, entries, origin)
    return settings


def apply_settings(
    settings: exu.SimulationSettings, entries: Mapping[str, Any], origin: str = "settings"
) -> None:
    """Set entries, nested or dotted, on Exudyn settings in place; errors as `load_settings`."""
    known = _flatten(settings.GetDictionary())
    for name, value in _flatten(entries).items():
        if name not in known:
            raise SettingsError(f"{origin}: {_unknown(name, known)}")
        target: Any = settings
        *groups, last = name.split(".")
        for group in groups:
            target = getattr(target, group)
        converted = _converted(f"{origin}: {name}", value, known[name])
        try:
            setattr(target, last, converted)
        except Exception as error:
            reason = str(error).split(" (", 1)[0]
            raise SettingsError(f"{origin}: {name} = {_shown(value)}: {reason}") from error


def changed_settings(settings: exu.SimulationSettings) -> dict[str, Any]:
    """Entries that differ from Exudyn's defaults, flat, enums by name: a file's content."""
    default = _flatten(exu.SimulationSettings().GetDictionary())
    now = _flatten(settings.GetDictionary())
    return {
        name: value.name if hasattr(value, "name") else value
        for name, value in now.items()
        if value != default[name]
    }


def _shipped() -> dict[str, Any]:
    """The settings files that come with the package, by their names."""
    try:
        folder: Any = importlib.resources.files("exudyn_wheelset.runs")
        files = list(folder.iterdir())
    except ModuleNotFoundError:
        files = list((Path(__file__).resolve().parents[2] / "runs").glob("*.json"))
    return {Path(one.name).stem: one for one in files if one.name.endswith(".json")}


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        own = _shipped()
        if path.parent != Path() or path.name.removesuffix(".json") not in own:
            raise SettingsError(
                f"{path}: no such settings file; the package's own are {', '.join(sorted(own))}"
            ) from None
    found: str = own[path.name.removesuffix(".json")].read_text(encoding="utf-8")
    return found


def _read(path: Path) -> Mapping[str, Any]:
    try:
        entries = json.loads(_text(path))
    except (OSError, UnicodeDecodeError) as error:
        raise SettingsError(f"{path}: cannot be read: {error}") from error
    except json.JSONDecodeError as error:
        raise SettingsError(
            f"{path}: line {error.lineno}: not JSON ({error.msg}); write an object such as "
            '{"timeIntegration": {"endTime": 2.0}}'
        ) from error
    except RecursionError:
        raise SettingsError(f"{path}: {_TOO_DEEP}") from None
    except ValueError as error:
        # Python's limit on the digits of a whole number.
        raise SettingsError(f"{path}: a number of too many digits ({error})") from None
    if not isinstance(entries, dict):
        raise SettingsError(f"{path}: holds a {type(entries).__name__}, not an object {{...}}")
    return entries


def _flatten(entries: Mapping[str, Any], prefix: str = "", depth: int = 0) -> dict[str, Any]:
    if depth > _DEEPEST:
        raise SettingsError(_TOO_DEEP)
    flat: dict[str, Any] = {}
    for name, value in entries.items():
        if not isinstance(name, str):
            raise SettingsError(f"{prefix}{name!r} is no name of a setting: give words")
        if isinstance(value, Mapping):
            flat.update(_flatten(value, f"{prefix}{name}.", depth + 1))
        else:
            flat[prefix + name] = value
    return flat


def _unknown(name: str, known: Mapping[str, Any]) -> str:
    message = f"Exudyn has no setting {name!r}"
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.0)
    same_end = [k for k in known if k.rsplit(".", 1)[-1].lower() == name.rsplit(".", 1)[-1].lower()]
    candidates = same_end or near
    return f"{message}; the nearest is {candidates[0]!r}" if candidates else message


def _converted(where: str, value: Any, default: Any) -> Any:
    """Value in the type of the default; enums from their names."""
    if hasattr(default, "__members__") or hasattr(type(default), "__members__"):
        members = type(default).__members__
        if isinstance(value, str) and value in members:
            return members[value]
        near = difflib.get_close_matches(_shown(value), list(members), n=1, cutoff=0.0)
        raise SettingsError(
            f"{where} = {_shown(value)}: give one of {', '.join(members)}; "
            f"the nearest is {near[0]!r}"
        )
    if isinstance(default, bool):
        right = isinstance(value, bool)
    elif isinstance(default, int):
        right = isinstance(value, int) and not isinstance(value, bool)
    elif isinstance(default, float):
        right = isinstance(value, int | float) and not isinstance(value, bool)
    else:
        right = isinstance(value, type(default))
    if not right:
        raise SettingsError(
            f"{where} = {_shown(value)} is of type {type(value).__name__}: "
            f"give a {type(default).__name__} (the default is {default!r})"
        )
    if not isinstance(default, float):
        return value
    try:
        finite = math.isfinite(value)
    except OverflowError:
        finite = False
    if not finite:
        raise SettingsError(
            f"{where} = {_shown(value)} is not finite: give a number (the default is {default!r})"
        )
    return float(value)


def _shown(value: Any) -> str:
    """A value as text that fits into a line."""
    if isinstance(value, int) and abs(value) > 10**40:
        return f"a number of {int(math.log10(abs(value))) + 1} digits"
    text = repr(value)
    return text if len(text) < 80 else f"{text[:70]}..."


def output_of(
    settings: exu.SimulationSettings, duration: float | None = None
) -> tuple[float, float]:
    """Duration and sampling interval [s] that settings ask of a simulation.

    duration: what a script's option asks for in its place. Raises WheelsetError out of range.
    """
    integration = settings.timeIntegration
    span = integration.endTime - integration.startTime if duration is None else duration
    span = number("duration", span, "s", 0.01, 3600.0)
    return span, min(span, settings.solution.sensors.writePeriod)
