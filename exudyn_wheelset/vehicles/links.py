"""Springs, dampers and rods of a vehicle to draw: between the places of their two bodies as they
move.

Exudyn asks for them anew in each picture. An end at a wheelset goes along with the axle, but does
not spin. Thickness and length are chosen to be seen.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import graphics
from exudyn.utilities import ObjectGround, VObjectGround

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.vehicles.description import GROUND, Axle, Body, Connection, Vehicle
from exudyn_wheelset.vehicles.shapes import kind_of, outside

_SPRING, _CASE, _ROD = [0.82, 0.62, 0.16, 1.0], [0.16, 0.17, 0.19, 1.0], [0.70, 0.71, 0.73, 1.0]
_LEAF, _WEDGE = [0.30, 0.31, 0.33, 1.0], [0.55, 0.45, 0.30, 1.0]
# A bearing or adapter so stiff [N/m] is no coil to be seen.
_RIGID = 4.0e7
_WINDINGS, _POINTS_EACH = 5, 8
_AHEAD, _UP = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Link:
    """What is drawn between two places [m] of the drawing, on a lower and an upper body."""

    kind: str
    lower: str
    upper: str
    places: Array
    size: float


def links_of(vehicle: Vehicle) -> list[Link]:
    """All that is drawn for the connections of a vehicle."""
    found = []
    for one in vehicle.connections:
        if GROUND not in (one.lower, one.upper):
            found += _links(vehicle, one)
    return found


def add_links(
    mbs: Any, vehicle: Vehicle, nodes: Mapping[str, int], name: str | None = None
) -> int | None:
    """Add what draws the connections to `mbs`; nodes by part; its object, None for none.

    name: of the vehicle in this system, its own if left out.
    """
    links = links_of(vehicle)
    if not links:
        return None
    centres = {part.name: np.array(part.centre) for part in vehicle.parts}
    axles = {axle.name for axle in vehicle.wheelsets}
    arms = [
        (link, link.places[0] - centres[link.lower], link.places[1] - centres[link.upper])
        for link in links
    ]
    visible = exu.ConfigurationType.Visualization
    position, rotation = exu.OutputVariableType.Position, exu.OutputVariableType.RotationMatrix

    def drawn(mbs: Any, item: int) -> list[dict[str, Any]]:
        frames = {}
        for name, node in nodes.items():
            centre = np.array(mbs.GetNodeOutput(node, position, configuration=visible))
            axes = np.array(mbs.GetNodeOutput(node, rotation, configuration=visible)).reshape(3, 3)
            frames[name] = centre, _without_spin(axes) if name in axles else axes
        items = []
        for link, low, high in arms:
            (start, turned), (end, turned_too) = frames[link.lower], frames[link.upper]
            items += _shape(link, start + turned @ low, end + turned_too @ high)
        return items

    function: Any = drawn
    visual = VObjectGround(graphicsDataUserFunction=function)
    return int(
        mbs.AddObject(ObjectGround(name=f"{name or vehicle.name} links", visualization=visual))
    )


def _without_spin(axes: Array) -> Array:
    """Axes with y along the axle and z as far up as that leaves."""
    y = axes[:, 1]
    x = np.cross(y, [0.0, 0.0, 1.0])
    x /= np.linalg.norm(x)
    return np.column_stack([x, y, np.cross(x, y)])


def _links(vehicle: Vehicle, one: Connection) -> list[Link]:
    """What one connection looks like, by the laws of its element."""
    lower, upper = (np.array(place) for place in one.element.places(one.at))
    kind = type(one.element).__name__
    if kind == "TractionRod":
        return [Link("rod", one.lower, one.upper, np.array([lower, upper]), 0.03)]
    if kind in ("LeafSpring", "LinkSuspension"):
        places = np.array([lower, upper]) + np.outer((0.16, 0.45), _UP)
        places[:, 1] = outside(places[:, 1])
        return [Link("leaves", one.lower, one.upper, places, 0.6)]
    if kind == "FrictionWedge":
        up = np.array([0.0, 0.0, 0.11])
        return [Link("block", one.lower, one.upper, np.array([lower - up, upper + up]), 0.08)]
    if kind == "CentrePlate":
        up = np.array([0.0, 0.0, 0.05])
        return [Link("rod", one.lower, one.upper, np.array([lower - up, upper + up]), 0.178)]
    if kind == "SideBearer":
        up = np.array([0.0, 0.0, 0.07])
        return [Link("block", one.lower, one.lower, np.array([lower - up, upper]), 0.07)]
    if not hasattr(one.element, "laws"):
        return []
    stiffness = np.array(one.element.static_stiffness())
    if stiffness[2, 2] > 0.0:
        return _coils(vehicle, one, lower, upper, float(stiffness[2, 2]))
    along = np.zeros(3)
    for law in one.element.laws():
        if law.matrices is None:
            own = np.array(law.direction) * (law.damping[0] + law.stiffness[0])
            along = along + (own if law.direction != (1.0, 0.0, 0.0) else np.array(law.damping))
    if not np.linalg.norm(along) or kind == "BumpStop":
        return []
    return [_damper(one, lower, upper, along / np.linalg.norm(along))]


def _coils(
    vehicle: Vehicle, one: Connection, lower: Array, upper: Array, stiffness: float
) -> list[Link]:
    if stiffness > _RIGID:
        return []
    on_axle = isinstance(vehicle.part(one.lower), Axle)
    below = vehicle.part(one.lower)
    if on_axle:
        # From the top of the axle box up to the beam of the frame.
        ends, radius = (0.14, 0.38), 0.085
    elif isinstance(below, Body) and kind_of(vehicle, below) == "side frame":
        nest = [
            np.array([lower, upper]) + moved for moved in ((-0.19, 0, 0), (0, 0, 0), (0.19, 0, 0))
        ]
        apart = np.outer([-0.13, 0.14], _UP)
        return [Link("coil", one.lower, one.upper, places + apart, 0.07) for places in nest]
    else:
        ends, radius = (-0.18, 0.12), 0.13
    places = np.array([lower, upper]) + np.outer(ends, _UP)
    if on_axle:
        places[:, 1] = outside(places[:, 1])
    return [Link("coil", one.lower, one.upper, places, radius)]


def _damper(one: Connection, lower: Array, upper: Array, along: Array) -> Link:
    """A telescope along its direction, outside of the spring at the same place."""
    out = np.array([0.0, 0.17 if lower[1] >= 0.0 else -0.17, 0.0])
    up = np.array([0.0, 0.0, 0.26]) if abs(along[2]) > 0.5 else np.zeros(3)
    half = 0.22 * along * (1.0 if along[2] >= 0.0 else -1.0)
    places = np.array([lower + out + up - half, upper + out + up + half])
    return Link("damper", one.lower, one.upper, places, 0.045)


def _shape(link: Link, start: Array, end: Array) -> list[dict[str, Any]]:
    way = end - start
    length = float(np.linalg.norm(way))
    if length < 1e-6:
        return []
    if link.kind == "coil":
        return [_coil(start, way, link.size)]
    if link.kind == "damper":
        return [
            _cylinder(start, 0.6 * way, link.size, _CASE),
            _cylinder(start + 0.5 * way, 0.5 * way, 0.6 * link.size, _ROD),
        ]
    if link.kind == "leaves":
        return _leaves(start, end, link.size)
    if link.kind == "block":
        middle, size = 0.5 * (start + end), [2.0 * link.size, 1.6 * link.size, length]
        return [graphics.Brick(centerPoint=middle.tolist(), size=size, color=_WEDGE)]
    return [_cylinder(start, way, link.size, _ROD)]


def _cylinder(start: Array, way: Array, radius: float, colour: list[float]) -> dict[str, Any]:
    made: dict[str, Any] = graphics.Cylinder(
        pAxis=start.tolist(), vAxis=way.tolist(), radius=radius, color=colour, nTiles=16
    )
    return made


def _coil(start: Array, way: Array, radius: float) -> dict[str, Any]:
    """Wire wound about the line from start along way."""
    along = way / np.linalg.norm(way)
    side = np.cross(along, [0.0, 1.0, 0.0] if abs(along[1]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    other = np.cross(along, side)
    part = np.linspace(0.0, 1.0, _WINDINGS * _POINTS_EACH + 1)[:, None]
    angle = 2.0 * np.pi * _WINDINGS * part
    points = start + part * way + radius * (np.cos(angle) * side + np.sin(angle) * other)
    axes = np.gradient(points, axis=0)
    made: dict[str, Any] = graphics.Tube(
        points=points.tolist(), axes=axes.tolist(), radius=0.19 * radius, color=_SPRING, nTiles=6
    )
    return made


def _leaves(start: Array, end: Array, half: float) -> list[dict[str, Any]]:
    """A pack of leaves on an axle box, hung at both ends of the longest one."""
    items = []
    for k in range(5):
        reach = half * (1.0 - 0.17 * (4 - k))
        middle = start + 0.022 * k * _UP
        for sign in (1.0, -1.0):
            tip = middle + sign * reach * _AHEAD + 0.10 * (reach / half) ** 2 * _UP
            items.append(_bar(middle, tip, 0.018))
    for sign in (1.0, -1.0):
        eye = start + sign * half * _AHEAD + 0.19 * _UP
        hung = end + 1.06 * sign * half * _AHEAD
        items.append(_cylinder(eye, hung - eye, 0.02, _ROD))
    return items


def _bar(start: Array, end: Array, thick: float) -> dict[str, Any]:
    """A flat bar from a point to another of larger or smaller x."""
    low, high = (start, end) if start[0] < end[0] else (end, start)
    up = np.array([0.0, 0.0, 0.5 * thick])
    corners = np.array([low - up, high - up, high + up, low + up])
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    made: dict[str, Any] = graphics.SolidExtrusion(
        vertices=corners[:, [0, 2]].tolist(),
        segments=[[k, (k + 1) % 4] for k in range(4)],
        height=0.09,
        rot=turn,
        pOff=[0.0, float(start[1]) + 0.045, 0.0],
        color=_LEAF,
    )
    return made
