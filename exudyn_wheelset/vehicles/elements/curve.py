"""A force over displacement or speed by a table: monotone cubic between its points.

The cubics of Fritsch and Carlson (SIAM J. Numer. Anal. 17 (1980) 238-246) rise wherever the points
rise and have no jump in value or slope; beyond its last point the curve goes straight on. A table
that begins at zero is continued to the other side with the sign turned.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from exudyn_wheelset.checking import numbers
from exudyn_wheelset.errors import WheelsetError


@dataclass(frozen=True)
class Curve:
    """Points (x, y), x rising and y not falling, through (0, 0); see the module's header."""

    points: tuple[tuple[float, float], ...]

    def slope(self, x: float) -> float:
        """Slope at x."""
        return float(self._cubic().derivative()(x))

    def pool(self) -> np.ndarray:
        """The curve as kernel.curve_value reads it."""
        cubic = self._cubic()
        nodes = cubic.x
        area = cubic.antiderivative()
        start = area(0.0) if nodes[0] <= 0.0 <= nodes[-1] else 0.0
        rows = np.column_stack([cubic.c[::-1].T, area(nodes[:-1]) - start])
        return np.concatenate([[len(nodes) - 1.0], nodes, rows.ravel()])

    def inverse(self) -> Curve:
        """The curve with x and y exchanged; WheelsetError where it does not rise everywhere."""
        y = [point[1] for point in self.points]
        if any(after <= before for before, after in itertools.pairwise(y)):
            raise WheelsetError(
                f"table {self.points}: with a series stiffness its force must rise from each point "
                "to the next: give every point more force than the one before"
            )
        return Curve(tuple((force, speed) for speed, force in self.points))

    def _cubic(self) -> PchipInterpolator:
        x, y = np.array(self.points).T
        return PchipInterpolator(x, y)


def checked_table(what: str, table: Any, x_unit: str, y_unit: str) -> tuple[Any, ...]:
    """A table as pairs of floats; WheelsetError for one that no curve goes through."""
    if isinstance(table, str) or not isinstance(table, Iterable):
        raise WheelsetError(f"{what} = {table!r}: give pairs ({x_unit}, {y_unit})")
    points = tuple(
        numbers(f"{what}[{place}]", pair, 2, f"{x_unit}, {y_unit}")
        for place, pair in enumerate(table)
    )
    if len(points) < 2:
        raise WheelsetError(f"{what} has {len(points)} points: give at least two, (0, 0) first")
    for (x0, y0), (x1, y1) in itertools.pairwise(points):
        if x1 <= x0 or y1 < y0:
            raise WheelsetError(
                f"{what}: ({x1:g}, {y1:g}) follows ({x0:g}, {y0:g}): give rising {x_unit} and "
                f"{y_unit} that do not fall"
            )
    if points[0][0] > 0.0 or points[-1][0] < 0.0 or points[0][1] > 0.0 or points[-1][1] < 0.0:
        raise WheelsetError(
            f"{what} begins at ({points[0][0]:g}, {points[0][1]:g}): begin with (0, 0), or give "
            "both signs"
        )
    return points


def curve_of(points: tuple[Any, ...], play: float = 0.0) -> Curve:
    """The curve through a checked table, after some `play` to either side."""
    if points[0][0] < 0.0:
        if play > 0.0:
            raise WheelsetError("a table of both signs has its play in its points: leave play out")
        return Curve(points)
    if points[0] != (0.0, 0.0):
        points = ((0.0, 0.0), *points)
    if play > 0.0:
        points = ((0.0, 0.0), *((x + play, y) for x, y in points))
    return Curve((*((-x, -y) for x, y in reversed(points[1:])), *points))
