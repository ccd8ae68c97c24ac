"""The numbers of a vehicle by name: what a gradient is taken by and a design may change.

A name is a path of `Vehicle.replace`. Parts that are alike (both springs of an axle, all wheelsets)
are named together wherever one path means them all and they have one value: what they mean on the
drawing is one number.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from exudyn_wheelset.checking import unknown
from exudyn_wheelset.stability.subject import _SHORT
from exudyn_wheelset.vehicles.description import Vehicle

# Steps of differences: relative, and the largest in metres, where contact changes its place.
RELATIVE_STEP = 1.0e-3
LARGEST_LENGTH_STEP = 1.0e-5
# Zero has no size of its own: a step that is little for a railway vehicle, by unit.
_STEP_FROM_ZERO = {"N/m": 1.0e3, "N s/m": 10.0, "N m/rad": 1.0e3, "N m s/rad": 10.0, "s/m": 0.01}
_HELD = ("preload", "offset", "gravity")
_UNITS = (
    ("yaw_stiffness", "N m/rad"),
    ("roll_stiffness", "N m/rad"),
    ("stiffness", "N/m"),
    ("contact.damping", "s/m"),
    ("damping", "N s/m"),
    ("creep_stiffness", "N"),
    ("friction_force", "N"),
    ("force", "N"),
    ("load", "N"),
    ("modulus", "Pa"),
    ("mass", "kg"),
    ("inertia", "kg m2"),
    ("conicity", "-"),
    ("friction", "-"),
    ("poisson", "-"),
    ("inclination", "-"),
    ("axis", "-"),
)
_LENGTHS = ("distance", "wheelbase", "height", "radius", "gauge", "clearance", "depth", "length")
_AXES = "xyz"


@dataclass(frozen=True)
class Number:
    """A number of a vehicle: its value in SI units, its unit as text, a step for differences."""

    name: str
    value: float
    unit: str
    step: float


def vehicle_numbers(description: Any) -> dict[str, Number]:
    """All numbers of a description by name, in its order.

    Left out are zeros other than stiffnesses and dampings, forces at rest, and tables. An empty
    mapping for what is not a description.
    """
    found: dict[str, Number] = {}
    if not dataclasses.is_dataclass(description) or isinstance(description, type):
        return found
    for name, value in _leaves(description, ""):
        if any(step in _HELD for step in name.split(".")):
            continue
        path = _common(description, name, value) if isinstance(description, Vehicle) else name
        if path not in found:
            number = _number(path, value)
            if number.step > 0.0:
                found[path] = number
    return found


def number_of(description: Any, path: str) -> Number:
    """The number at a path, which may mean several parts of one value or a short name.

    Raises WheelsetError, with the nearest name, where there is none.
    """
    path = _SHORT.get(path, path) if isinstance(description, Vehicle) else path
    known = vehicle_numbers(description)
    if path in known:
        return known[path]
    names = []
    for name, value in _leaves(description, ""):
        names.append(name)
        if name == path or (isinstance(description, Vehicle) and _means(path, name)):
            return _number(path, value)
    raise unknown("number of the vehicle:", path, [*known, *names])


def unit_of(name: str) -> str:
    """Unit of the number of a name, as text; "" where the name does not tell."""
    last = name.lower()
    for word, unit in _UNITS:
        if word in last:
            rotational = last.rpartition(".")[2] in ("3", "4", "5") and unit in ("N/m", "N s/m")
            return {"N/m": "N m/rad", "N s/m": "N m s/rad"}[unit] if rotational else unit
    steps = last.split(".")
    if any(word in last for word in _LENGTHS) or "at" in steps or "centre" in steps:
        return "m"
    return "m" if steps[-1] == "x" and len(steps) == 3 else ""


def _number(name: str, value: float) -> Number:
    unit = unit_of(name)
    step = RELATIVE_STEP * abs(value)
    if unit == "m":
        step = min(step, LARGEST_LENGTH_STEP)
    if value == 0.0:
        step = _STEP_FROM_ZERO.get(unit, 0.0)
    return Number(name, float(value), unit, step)


def _leaves(node: Any, path: str) -> Iterator[tuple[str, float]]:
    """Paths and values of the floats in a tree of dataclasses and tuples."""
    if isinstance(node, float):
        yield path, node
    elif dataclasses.is_dataclass(node) and not isinstance(node, type):
        for entry in dataclasses.fields(node):
            if entry.name.startswith("_"):
                continue
            # An element and a wheelset are named without the word for what holds them.
            skipped = entry.name in ("element", "wheelset")
            inner = path if skipped else f"{path}.{entry.name}".lstrip(".")
            yield from _leaves(getattr(node, entry.name), inner)
    elif isinstance(node, tuple) and node:
        if all(isinstance(entry, float) for entry in node):
            if path.startswith("wheelsets.") and path.endswith("inertia") and node[0] == node[2]:
                # A wheelset that spins must be alike about x and z: one number.
                yield f"{path}.xz", node[0]
                yield f"{path}.y", node[1]
                return
            for place, value in enumerate(node):
                step = _AXES[place] if len(node) == 3 else str(place)
                yield f"{path}.{step}", value
        elif all(dataclasses.is_dataclass(entry) for entry in node):
            for entry in node:
                name = getattr(entry, "name", getattr(entry, "body", None))
                if isinstance(name, str):
                    yield from _leaves(entry, f"{path}.{name}")


def _means(path: str, name: str) -> bool:
    """Whether a path with a part of a name, or *, means the leaf of a whole name."""
    steps, whole = path.split("."), name.split(".")
    # `replace` takes paths with and without the word for what holds an element or a wheelset.
    steps = steps[:2] + [step for step in steps[2:] if step not in ("element", "wheelset")]
    if len(steps) != len(whole) or len(steps) < 3:
        return False
    part = steps[1] in ("*", whole[1]) or whole[1].endswith(f" {steps[1]}")
    part = part or whole[1].startswith(f"{steps[1]} ")
    return part and steps[:1] + steps[2:] == whole[:1] + whole[2:]


def _common(vehicle: Vehicle, name: str, value: float) -> str:
    """The widest path that means this number and others of the same value only."""
    steps = name.split(".")
    if steps[0] not in ("bodies", "wheelsets", "connections", "loads") or len(steps) < 3:
        return name
    alike = [
        (other.split(".")[1], theirs)
        for other, theirs in _leaves(getattr(vehicle, steps[0]), steps[0])
        if other.split(".")[2:] == steps[2:]
    ]
    words = steps[1].split()
    wider = [" ".join(words[-count:]) for count in range(1, len(words))]
    if steps[0] == "wheelsets" and len(vehicle.wheelsets) > 1:
        wider.insert(0, "*")
    parts = [
        getattr(part, "name", getattr(part, "body", "")) for part in getattr(vehicle, steps[0])
    ]
    for part in wider:
        meant = [
            n
            for n in parts
            if part in ("*", n) or n.endswith(f" {part}") or n.startswith(f"{part} ")
        ]
        if part in parts and part != steps[1]:
            continue
        values = dict(alike)
        if all(values.get(n) == value for n in meant):
            return ".".join([steps[0], part, *steps[2:]])
    return name
