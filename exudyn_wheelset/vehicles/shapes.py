"""Shapes to draw for the bodies of a vehicle in Exudyn's renderer; no true shape."""

from __future__ import annotations

from typing import Any

import numpy as np
from exudyn import graphics

from exudyn_wheelset.vehicles.description import Axle, Body, Vehicle

_CAR = [0.62, 0.70, 0.78, 0.55]
_FRAME = [0.24, 0.42, 0.36, 1.0]
_LONG = 6.0


def body_graphics(vehicle: Vehicle, body: Body) -> list[dict[str, Any]]:
    """A car body, or two side beams with a cross beam, as large as the body's connections reach."""
    centre = np.array(body.centre)
    reach = [
        np.array(one.at) - centre
        for one in vehicle.connections
        if body.name in (one.lower, one.upper)
    ]
    on_axle = any(
        isinstance(vehicle.part(one.lower), Axle)
        for one in vehicle.connections
        if one.upper == body.name
    )
    low, high = np.min(reach, axis=0), np.max(reach, axis=0)
    length = max(high[0] - low[0], 0.5)
    width = max(high[1] - low[1], 0.5)
    if length > _LONG:
        size = [length + 5.0, 2.8, 2.6]
        middle = [0.5 * (low[0] + high[0]), 0.0, max(low[2] + 1.5, 0.0)]
        return [graphics.Brick(centerPoint=middle, size=size, color=_CAR)]
    if not on_axle:
        return [graphics.Brick(centerPoint=[0, 0, 0], size=[0.3, 0.2, 0.3], color=_FRAME)]
    middle_x = 0.5 * (low[0] + high[0])
    beams = [
        graphics.Brick(centerPoint=[middle_x, side, 0.1], size=[length, 0.14, 0.16], color=_FRAME)
        for side in (0.5 * width, -0.5 * width)
    ]
    cross = graphics.Brick(centerPoint=[middle_x, 0, 0.1], size=[0.4, width, 0.14], color=_FRAME)
    return [*beams, cross]
