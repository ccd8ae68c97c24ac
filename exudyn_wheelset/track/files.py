"""Layouts as TOML files.

base = 1.5
gradient = [[0.0, 0.0], [400.0, 0.01]]
[[element]]
kind = "curve"
radius = -300.0
length = 500.0
cant = 0.12
"""

from __future__ import annotations

import os
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from exudyn_wheelset.checking import unknown
from exudyn_wheelset.errors import FileError, WheelsetError
from exudyn_wheelset.track.layout import Curve, Layout, Straight, Transition

_KINDS: dict[str, Any] = {"straight": Straight, "transition": Transition, "curve": Curve}
_OWN = ("base", "rounding", "gradient", "element")


def write_layout(layout: Layout, path: str | Path) -> Path:
    """Write a layout as TOML, whole or not at all; return where."""
    lines = [f"base = {layout.base!r}", f"rounding = {layout.rounding!r}"]
    if layout.gradient:
        lines.append(f"gradient = {[list(point) for point in layout.gradient]!r}")
    for element in layout.elements:
        kind = next(name for name, known in _KINDS.items() if isinstance(element, known))
        lines += ["", "[[element]]", f'kind = "{kind}"']
        for entry in fields(element):
            value = getattr(element, entry.name)
            if value is not None:
                shown = f'"{value}"' if isinstance(value, str) else repr(value)
                lines.append(f"{entry.name} = {shown}")
    target = Path(path)
    draft = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        draft.write_text("\n".join(lines) + "\n", encoding="utf-8")
        draft.replace(target)
    except OSError as error:
        raise FileError(f"{target} cannot be written: {error.strerror}") from error
    return target


def read_layout(path: str | Path) -> Layout:
    """Read a layout; WheelsetError with the file and the entry for what is missing or unknown."""
    try:
        content = _toml().loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise WheelsetError(f"{path} cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise WheelsetError(f"{path} is no TOML file: {error}") from error
    for name in content:
        if name not in _OWN:
            raise unknown(f"entry of {path}:", name, _OWN)
    elements = []
    for k, entry in enumerate(content.pop("element", [])):
        kind = entry.pop("kind", None)
        if kind not in _KINDS:
            raise unknown(f"{path}: kind of element {k}", kind, tuple(_KINDS))
        known = [one.name for one in fields(_KINDS[kind])]
        for name in entry:
            if name not in known:
                raise unknown(f"{path}: entry of element {k} ({kind})", name, known)
        needed = [one.name for one in fields(_KINDS[kind]) if one.default is MISSING]
        missing = [name for name in needed if name not in entry]
        if missing:
            raise WheelsetError(f"{path}: element {k} ({kind}) has no {missing[0]}: give it")
        elements.append(_KINDS[kind](**entry))
    try:
        return Layout(elements, **content)
    except WheelsetError as error:
        raise WheelsetError(f"{path}: {error}") from error


def _toml() -> Any:
    try:
        import tomllib
    except ModuleNotFoundError:
        try:
            import tomli as tomllib  # type: ignore[no-redef]
        except ModuleNotFoundError as error:
            raise WheelsetError("reading TOML takes Python 3.11, or: pip install tomli") from error
    return tomllib
