"""How a track lies and how far its rails are off, as entries of `[track]`.

layout = "line.toml"            a file of `write_layout`, beside the vehicle file, or
[track.layout]                  base, rounding, gradient as in Layout
[[track.layout.element]]        kind = "straight", "transition" or "curve", and its fields
[track.irregularity]            file = "rough.csv" (Irregularity.load), or name and
points = [[s, ly, lz, ry, rz]]  distance and the shifts of the left and the right rail [m]
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset.checking import unknown
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.track.files import read_layout
from exudyn_wheelset.track.irregularity import Irregularity
from exudyn_wheelset.track.layout import Curve, Layout, Straight, Transition
from exudyn_wheelset.vehicles.files.converting import to_object, to_table

_KINDS: dict[str, type] = {"straight": Straight, "transition": Transition, "curve": Curve}
_OF_LAYOUT = ("element", "gradient", "base", "rounding")
_OF_IRREGULARITY = ("file", "name", "points")


def layout_of(entry: Any, folder: Path) -> Layout:
    """The layout of an entry; WheelsetError for what is none."""
    if isinstance(entry, str):
        return read_layout(folder / entry)
    table = _table("layout", entry, _OF_LAYOUT)
    elements = []
    for given in table.pop("element", []):
        kind = given.get("kind") if isinstance(given, dict) else None
        if kind not in _KINDS:
            raise unknown("kind of element of the layout", kind, tuple(_KINDS))
        elements.append(
            to_object(_KINDS[kind], {key: value for key, value in given.items() if key != "kind"})
        )
    return Layout(elements, **table)


def layout_table(layout: Layout) -> dict[str, Any]:
    """The entry of a layout."""
    names = {cls: name for name, cls in _KINDS.items()}
    table: dict[str, Any] = {"base": layout.base, "rounding": layout.rounding}
    if layout.gradient:
        table["gradient"] = [list(point) for point in layout.gradient]
    table["element"] = [
        {"kind": names[type(element)], **to_table(element, None)} for element in layout.elements
    ]
    return table


def irregularity_of(entry: Any, folder: Path) -> Irregularity:
    """The irregularity of an entry; WheelsetError for what is none."""
    table = _table("irregularity", entry, _OF_IRREGULARITY)
    if "file" in table:
        return Irregularity.load(folder / str(table["file"]))
    points = np.array(table.get("points", []), dtype=float)
    if points.ndim != 2 or points.shape[1] != 5:
        raise WheelsetError("points: give rows [distance, left y, left z, right y, right z] in m")
    return Irregularity(points[:, 0], points[:, 1:], str(table.get("name", "points")))


def irregularity_table(irregularity: Irregularity) -> dict[str, Any]:
    """The entry of an irregularity, with its points."""
    rows = np.column_stack([irregularity.distance, irregularity.shifts])
    return {"name": irregularity.name, "points": rows.tolist()}


def _table(what: str, entry: Any, known: tuple[str, ...]) -> dict[str, Any]:
    if not isinstance(entry, dict):
        raise WheelsetError(f"{entry!r} is no {what}: give a table")
    for key in entry:
        if key not in known:
            raise unknown(f"key of {what}", key, known)
    return dict(entry)
