"""Shapes to draw for the bodies of a vehicle in Exudyn's renderer: what they are is guessed from
what they are connected with; no dimension is a true one.

A body that reaches over wheelsets or trucks is a car body: a coach, or a hopper or wagon where
there is dry friction. What carries both ends of axles is a truck frame, what carries one end of two
axles a side frame, what is on one axle end an axle box, what is between is a bolster. Axle boxes
are drawn outside of the wheels wherever they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from exudyn import graphics

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.vehicles.description import GROUND, Body, Vehicle

Colour = list[float]
_COACH, _STRIPE, _ROOF = [0.80, 0.82, 0.80, 1.0], [0.62, 0.14, 0.13, 1.0], [0.60, 0.62, 0.64, 1.0]
_WINDOW, _UNDER = [0.10, 0.13, 0.17, 1.0], [0.20, 0.21, 0.22, 1.0]
_HOPPER, _RIB, _LOAD = [0.46, 0.22, 0.16, 1.0], [0.38, 0.18, 0.13, 1.0], [0.13, 0.13, 0.13, 1.0]
_FRAME, _CAST, _BOX = [0.20, 0.34, 0.33, 1.0], [0.27, 0.27, 0.28, 1.0], [0.36, 0.37, 0.38, 1.0]
# A body whose connections lie farther apart [m] is a car body.
_LONG = 4.0
# Half of the distance of axle boxes [m], at least.
_BOXES = 0.98
# Heavier ones of dry friction carry a load [kg].
_LOADED = 3.0e4
RUBBING = ("FrictionWedge", "CoilNest", "LeafSpring", "LinkSuspension", "CentrePlate")


def outside(y: Any) -> Any:
    """Lateral places [m] of axle boxes, moved out of the wheels."""
    return np.sign(y) * np.maximum(np.abs(y), _BOXES)


@dataclass(frozen=True)
class Reach:
    """Where a body's connections are: places (n, 3) [m] of the drawing, those on axles apart."""

    places: Array
    on_axles: Array

    @classmethod
    def of(cls, vehicle: Vehicle, name: str) -> Reach:
        """The reach of the body of a name."""
        axles = {axle.name for axle in vehicle.wheelsets}
        near, on_axles = [], []
        for one in vehicle.connections:
            if name not in (one.lower, one.upper):
                continue
            other = one.lower if one.upper == name else one.upper
            if other != GROUND:
                near.append(one.at)
            if other in axles:
                x, y, z = one.at
                on_axles.append((x, outside(y), z))
        return cls(np.array(near).reshape(-1, 3), np.array(on_axles).reshape(-1, 3))


def kind_of(vehicle: Vehicle, body: Body) -> str:
    """What a body looks like: "car body", "frame", "side frame", "axle box" or "bolster"."""
    reach = Reach.of(vehicle, body.name)
    if len(reach.places) and np.ptp(reach.places[:, 0]) > _LONG:
        return "car body"
    if not len(reach.on_axles):
        return "bolster" if len(reach.places) else "frame"
    y = reach.on_axles[:, 1]
    if y.min() < 0.0 < y.max():
        return "frame"
    return "side frame" if np.ptp(reach.on_axles[:, 0]) > 0.5 else "axle box"


def body_graphics(vehicle: Vehicle, body: Body) -> list[dict[str, Any]]:
    """What a body looks like, in its own axes."""
    kind = kind_of(vehicle, body)
    draw = {
        "car body": _car_body,
        "frame": _frame,
        "side frame": _side_frame,
        "axle box": _axle_box,
        "bolster": _bolster,
    }[kind]
    return draw(_Pencil(body.centre), vehicle, Reach.of(vehicle, body.name), body)


class _Pencil:
    """Draws in places of the drawing what then stands in the axes of a body."""

    def __init__(self, centre: Sequence[float]) -> None:
        self._centre = np.array(centre)

    def brick(self, low: Sequence[float], high: Sequence[float], colour: Colour) -> dict[str, Any]:
        """A brick between two corners."""
        corners = np.array([low, high]) - self._centre
        made: dict[str, Any] = graphics.Brick(
            centerPoint=corners.mean(axis=0).tolist(),
            size=np.abs(corners[1] - corners[0]).tolist(),
            color=colour,
        )
        return made

    def along_x(self, outline: Any, ends: Sequence[float], colour: Colour) -> dict[str, Any]:
        """An outline (n, 2) in y and z, counter-clockwise seen from ahead, from x to x."""
        turn = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
        return self._extruded(
            np.array(outline) - self._centre[[1, 2]],
            ends[1] - ends[0],
            turn,
            [ends[0] - self._centre[0], 0.0, 0.0],
            colour,
        )

    def along_y(self, outline: Any, ends: Sequence[float], colour: Colour) -> dict[str, Any]:
        """An outline (n, 2) in x and z, counter-clockwise seen from the right, from y to y."""
        turn = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]
        return self._extruded(
            np.array(outline) - self._centre[[0, 2]],
            ends[1] - ends[0],
            turn,
            [0.0, ends[1] - self._centre[1], 0.0],
            colour,
        )

    def cylinder(
        self, start: Sequence[float], along: Sequence[float], radius: float, colour: Colour
    ) -> dict[str, Any]:
        """A cylinder from a place along a vector."""
        made: dict[str, Any] = graphics.Cylinder(
            pAxis=(np.array(start) - self._centre).tolist(),
            vAxis=list(along),
            radius=radius,
            color=colour,
            nTiles=24,
        )
        return made

    def _extruded(
        self, outline: Array, height: float, turn: Any, start: list[float], colour: Colour
    ) -> dict[str, Any]:
        count = len(outline)
        made: dict[str, Any] = graphics.SolidExtrusion(
            vertices=outline.tolist(),
            segments=[[k, (k + 1) % count] for k in range(count)],
            height=height,
            rot=np.array(turn),
            pOff=start,
            color=colour,
        )
        return made


def _car_body(pencil: _Pencil, vehicle: Vehicle, reach: Reach, body: Body) -> list[dict[str, Any]]:
    x = reach.places[:, 0]
    axles = [axle.x for axle in vehicle.wheelsets]
    overhang = min(max(0.16 * float(np.ptp(x)), 1.2), 3.2)
    rear = min(float(x.min()) - overhang, min(axles) - 0.9)
    front = max(float(x.max()) + overhang, max(axles) + 0.9)
    radius = max(axle.wheelset.radius for axle in vehicle.wheelsets)
    floor = max(float(np.median(reach.places[:, 2])) + 0.12, 2.0 * radius + 0.12)
    rubs = any(type(one.element).__name__ in RUBBING for one in vehicle.connections)
    draw = _freight if rubs else _coach
    on_axles = len(reach.on_axles) > 0
    items = draw(pencil, (rear, front), floor, body.mass > _LOADED, on_axles)
    for place in np.unique(np.round(reach.on_axles, 3), axis=0):
        items += _box(pencil, place)
    return items


def _coach(
    pencil: _Pencil, ends: tuple[float, float], floor: float, loaded: bool, on_axles: bool
) -> list[dict[str, Any]]:
    rear, front = ends
    half, eaves, top = 1.42, floor + 2.1, floor + 2.75
    roof = [
        (half * np.cos(angle), eaves + (top - eaves) * np.sin(angle))
        for angle in np.linspace(0.0, np.pi, 17)
    ]
    items = [
        pencil.along_x(
            [(-half, floor), (half, floor), (half, eaves), (-half, eaves)], ends, _COACH
        ),
        pencil.along_x(roof, ends, _ROOF),
        pencil.brick((rear, -1.435, floor + 0.1), (front, 1.435, floor + 0.42), _STRIPE),
        pencil.brick((0.3 * rear, -1.1, floor - 0.45), (0.3 * front, 1.1, floor), _UNDER),
    ]
    for end, away in ((rear, -1.0), (front, 1.0)):
        items.append(
            pencil.brick((end, -0.6, floor), (end + 0.25 * away, 0.6, floor + 2.2), _UNDER)
        )
        items += [
            pencil.cylinder((end, side, floor - 0.12), (0.55 * away, 0.0, 0.0), 0.08, _UNDER)
            for side in (0.87, -0.87)
        ]
    count = int((front - rear - 5.0) / 1.9)
    for place in np.arange(count) - 0.5 * (count - 1):
        middle = 0.5 * (rear + front) + 1.9 * place
        low, high = floor + 0.85, floor + 1.75
        items.append(
            pencil.brick((middle - 0.65, -1.43, low), (middle + 0.65, 1.43, high), _WINDOW)
        )
    for middle in (rear + 1.4, front - 1.4):
        low, high = floor + 0.05, floor + 2.0
        items.append(
            pencil.brick((middle - 0.42, -1.44, low), (middle + 0.42, 1.44, high), _STRIPE)
        )
        items.append(
            pencil.brick((middle - 0.2, -1.45, low + 1.0), (middle + 0.2, 1.45, high), _WINDOW)
        )
    return items


def _freight(
    pencil: _Pencil, ends: tuple[float, float], floor: float, loaded: bool, on_axles: bool
) -> list[dict[str, Any]]:
    rear, front = ends
    half, top = 1.48, floor + (1.5 if on_axles else 2.5)
    sill = floor + 0.25
    items = [
        pencil.brick((rear, -0.25, floor - 0.2), (front, 0.25, floor + 0.1), _UNDER),
        pencil.brick((rear, -half, floor + 0.05), (front, half, sill), _HOPPER),
    ]
    slope = 0.0 if on_axles else 0.16 * (front - rear)
    side = [(rear + slope, sill), (front - slope, sill), (front, top), (rear, top)]
    if not on_axles:
        # The end sheets slope from above the trucks, the bays end between them.
        side[2:] = [(front, floor + 1.7), (front, top), (rear, top), (rear, floor + 1.7)]
        bays = 0.55 * (front - slope)
        outline = [
            (-0.7 * bays, floor - 0.45),
            (0.7 * bays, floor - 0.45),
            (bays, sill),
            (-bays, sill),
        ]
        items.append(pencil.along_y(outline, (-1.0, 1.0), _RIB))
    items.append(pencil.along_y(side, (-half + 0.06, half - 0.06), _HOPPER))
    count = max(int((front - rear - 2.0 * slope) / 1.15), 1) + 1
    for place in np.linspace(rear + slope + 0.1, front - slope - 0.1, count):
        low, high = (place - 0.05, -half - 0.02, sill), (place + 0.05, half + 0.02, top)
        items.append(pencil.brick(low, high, _RIB))
    items.append(pencil.brick((rear, -half - 0.03, top - 0.14), (front, half + 0.03, top), _RIB))
    for end in (rear, front):
        sign = 1.0 if end > 0.0 else -1.0
        inward = end - 0.12 * sign
        if not on_axles:
            low = (min(end, inward), -half, sill)
            high = (max(end, inward), -half + 0.12, floor + 1.7)
            items.append(pencil.brick(low, high, _RIB))
            items.append(pencil.brick((low[0], half - 0.12, sill), (high[0], half, high[2]), _RIB))
        items.append(
            pencil.brick((end, -0.15, floor - 0.2), (end + 0.5 * sign, 0.15, floor), _CAST)
        )
    if not loaded:
        inside = (rear + 0.15, -half + 0.15, top - 0.1), (front - 0.15, half - 0.15, top + 0.004)
        items.append(pencil.brick(*inside, _LOAD))
    else:
        length = 0.5 * (front - rear) - 0.25
        heap = [
            (-length, top),
            (length, top),
            (0.7 * length, top + 0.3),
            (-0.7 * length, top + 0.3),
        ]
        middle = 0.5 * (front + rear)
        heap = [(middle + along, z) for along, z in heap]
        items.append(pencil.along_y(heap, (-half + 0.15, half - 0.15), _LOAD))
    return items


def _frame(pencil: _Pencil, vehicle: Vehicle, reach: Reach, body: Body) -> list[dict[str, Any]]:
    places = reach.on_axles if len(reach.on_axles) else reach.places
    if not len(places):
        places = np.array([body.centre])
    x, y = places[:, 0], places[:, 1]
    half = max(0.5 * float(np.ptp(y)), 0.3)
    rear, front = float(x.min()) - 0.3, float(x.max()) + 0.3
    middle = 0.5 * (rear + front)
    axle = float(np.median(places[:, 2]))
    low, high = axle + 0.38, axle + 0.54
    items = []
    for side in (half, -half):
        items.append(pencil.brick((rear, side - 0.09, low), (front, side + 0.09, high), _FRAME))
    across = (-half, half)
    wide = 0.28 if front - rear > 1.5 else 0.1
    items.append(
        pencil.brick((middle - wide, across[0], low), (middle + wide, across[1], high), _FRAME)
    )
    if front - rear > 1.5:
        for end in (rear, front):
            items.append(
                pencil.cylinder((end, -half, high - 0.07), (0.0, 2.0 * half, 0.0), 0.05, _FRAME)
            )
    for place in places:
        items += _box(pencil, place)
    return items


def _box(pencil: _Pencil, place: Array) -> list[dict[str, Any]]:
    """An axle box around the end of an axle, drawn on what it carries."""
    x, y, z = place
    return [
        pencil.brick((x - 0.15, y - 0.11, z - 0.15), (x + 0.15, y + 0.11, z + 0.14), _BOX),
        pencil.cylinder((x, y + 0.11 * np.sign(y), z), (0.0, 0.03 * np.sign(y), 0.0), 0.1, _CAST),
    ]


def _side_frame(
    pencil: _Pencil, vehicle: Vehicle, reach: Reach, body: Body
) -> list[dict[str, Any]]:
    x, y = reach.on_axles[:, 0], float(np.median(reach.on_axles[:, 1]))
    z = float(np.median(reach.on_axles[:, 2]))
    middle, half = 0.5 * float(x.min() + x.max()), 0.5 * float(np.ptp(x))
    ends = (y - 0.075, y + 0.075)

    def at(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
        return [(middle + along, z + up) for along, up in points]

    outlines = [
        [(-half - 0.16, 0.12), (half + 0.16, 0.12), (half + 0.16, 0.22), (0.5, 0.38), (-0.5, 0.38),
         (-half - 0.16, 0.22)],
        [(-0.48, -0.30), (0.48, -0.30), (0.48, -0.19), (-0.48, -0.19)],
    ]  # fmt: skip
    for sign in (1.0, -1.0):
        column = [(0.30, -0.2), (0.42, -0.2), (0.42, 0.2), (0.30, 0.2)]
        diagonal = [(0.40, -0.30), (0.50, -0.30), (half - 0.02, 0.13), (half - 0.20, 0.13)]
        for shape in (column, diagonal):
            points = [(sign * along, up) for along, up in shape]
            outlines.append(points if sign > 0.0 else points[::-1])
    items = [pencil.along_y(at(points), ends, _CAST) for points in outlines]
    for place in reach.on_axles:
        start = (place[0], y - 0.12, place[2])
        items.append(pencil.cylinder(start, (0.0, 0.24, 0.0), 0.12, _BOX))
        cap = (place[0], y + (0.12 if y > 0.0 else -0.15), place[2])
        items.append(pencil.cylinder(cap, (0.0, 0.03, 0.0), 0.09, _UNDER))
    return items


def _axle_box(pencil: _Pencil, vehicle: Vehicle, reach: Reach, body: Body) -> list[dict[str, Any]]:
    return [item for place in reach.on_axles for item in _box(pencil, place)]


def _bolster(pencil: _Pencil, vehicle: Vehicle, reach: Reach, body: Body) -> list[dict[str, Any]]:
    x, _, z = body.centre
    half = max(float(np.abs(reach.places[:, 1]).max()) + 0.06, 0.3)
    ends, middle = (z - 0.02, z + 0.10), (z - 0.12, z + 0.13)
    outline = [
        (-half, ends[0]), (-0.4 * half, middle[0]), (0.4 * half, middle[0]), (half, ends[0]),
        (half, ends[1]), (0.4 * half, middle[1]), (-0.4 * half, middle[1]), (-half, ends[1]),
    ]  # fmt: skip
    return [pencil.along_x(outline, (x - 0.2, x + 0.2), _CAST)]
