"""A wheelset to draw: its wheels of their true profiles as bodies of revolution, with marks that
show its spin."""

from __future__ import annotations

from typing import Any

import numpy as np
from exudyn import graphics

from exudyn_wheelset.contact.descriptions import Wheelset

_STEEL = [0.45, 0.48, 0.52, 1.0]
_DISC = [0.36, 0.39, 0.43, 1.0]
_AXLE = [0.5, 0.5, 0.5, 1.0]
_PAINT = [0.93, 0.91, 0.84, 1.0]
_HOLES = 4
# Of the points of a profile [m]: chords stay within 0.15 mm of a throat of 6 mm radius.
_SPACING = 2.5e-3
# Axle beyond the wheels [m], where its boxes sit.
_STUB = 0.15


def wheelset_graphics(wheelset: Wheelset) -> list[dict[str, Any]]:
    """Axle and both wheels for Exudyn's renderer, in the axes of the body."""
    items = []
    for hand, sign in enumerate((1.0, -1.0)):
        profile = wheelset.wheel if hand == 0 else (wheelset.right_wheel or wheelset.wheel)
        radius = wheelset.radius if hand == 0 else (wheelset.right_radius or wheelset.radius)
        curve = profile.arc_table(_SPACING).coefficients
        y, z = curve[:, 0], curve[:, 4]
        outline = np.column_stack([wheelset.tape_half_distance + y, radius - z])
        inner = 0.8 * radius
        contour = np.vstack([[outline[0, 0], inner], outline, [outline[-1, 0], inner]])
        contour[:, 0] *= sign
        if sign < 0.0:
            contour = contour[::-1]
        items.append(
            graphics.SolidOfRevolution(
                pAxis=[0, 0, 0],
                vAxis=[0, 1, 0],
                contour=contour.tolist(),
                color=_STEEL,
                nTiles=64,
            )
        )
        items += _disc(sign * (wheelset.tape_half_distance - 0.02), radius)
    half = wheelset.tape_half_distance + _STUB
    items.append(
        graphics.Cylinder(
            pAxis=[0, -half, 0], vAxis=[0, 2 * half, 0], radius=0.09, color=_AXLE, nTiles=32
        )
    )
    return items


def _disc(place: float, radius: float) -> list[dict[str, Any]]:
    """The web of a wheel at y = `place` [m], with holes and a stroke of paint on both faces."""

    def across(
        x: float, z: float, size: float, wide: float, colour: list[float], tiles: int
    ) -> dict[str, Any]:
        made: dict[str, Any] = graphics.Cylinder(
            pAxis=[x, place - 0.5 * wide, z],
            vAxis=[0, wide, 0],
            radius=size,
            color=colour,
            nTiles=tiles,
        )
        return made

    items = [across(0.0, 0.0, 0.82 * radius, 0.04, _DISC, 48)]
    items.append(across(0.0, 0.0, 0.3 * radius, 0.12, _STEEL, 32))
    for k in range(_HOLES):
        angle = (k + 0.5) * 2.0 * np.pi / _HOLES
        x, z = 0.55 * radius * np.sin(angle), 0.55 * radius * np.cos(angle)
        items.append(across(x, z, 0.1 * radius, 0.044, [0.1, 0.1, 0.1, 1.0], 20))
    items.append(
        graphics.Brick(
            centerPoint=[0.0, place, 0.62 * radius],
            size=[0.045, 0.046, 0.3 * radius],
            color=_PAINT,
        )
    )
    return items
