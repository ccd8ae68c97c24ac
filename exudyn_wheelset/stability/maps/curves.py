"""Curves of a stability map as data, and the regions between them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.results.columns import NamedColumns

STRAIGHT, DISTURBED, HUNTS = "always runs straight", "hunts if disturbed", "hunts"


@brief
@dataclass(frozen=True, eq=False)
class Curve:
    """Hopf points or folds over a parameter, in the order in which they lie on their curve.

    kind        "hopf" or "fold"
    speed       (points,) [m/s]
    parameter   (points,) in the unit of the number
    frequency   (points,) [Hz]
    amplitude   (points,) half of peak to peak of the watched displacement [m]; 0 for Hopf points
    amplitudes  (points, displacements) of all, also by name
    loses       (points,) whether the straight run loses stability with rising speed (Hopf points),
                or cycles are stable on one side of the fold
    ends        why the curve ends at its first and at its last point
    """

    kind: str
    speed: Array
    parameter: Array
    frequency: Array
    amplitude: Array
    amplitudes: NamedColumns
    loses: Array
    ends: tuple[str, str]

    def __len__(self) -> int:
        return len(self.speed)

    @property
    def cusps(self) -> Array:
        """Rows (k,) at which the parameter turns back along the curve."""
        steps = np.sign(np.diff(self.parameter))
        return np.flatnonzero(steps[1:] * steps[:-1] < 0.0) + 1

    def speeds_at(self, parameter: float) -> Array:
        """Speeds [m/s] at which the curve passes a value of the parameter, by cubics in it."""
        return np.array([speed for speed, _ in self.crossings(parameter)])

    def crossings(self, parameter: float) -> Iterator[tuple[float, int]]:
        """Speed at each passage of a value of the parameter, and the row before it."""
        offset = self.parameter - parameter
        for row in range(len(self) - 1):
            before, after = offset[row], offset[row + 1]
            if before * after > 0.0 or (before == 0.0 and row > 0):
                continue
            first = max(0, min(row - 1, len(self) - 4))
            near = slice(first, first + 4)
            rising = np.diff(self.parameter[near])
            if len(rising) and (np.all(rising > 0.0) or np.all(rising < 0.0)):
                yield _lagrange(self.parameter[near], self.speed[near], parameter), row
            else:
                # At a cusp the parameter has its extremum along the curve.
                share = before / (before - after) if before != after else 0.0
                yield float(self.speed[row] + share * (self.speed[row + 1] - self.speed[row])), row


class Regions(Mapping[str, Array]):
    """What a vehicle does by speed and parameter: polygons (k, 2) of (parameter, speed) by name.

    parameter   (m,) values at which the bounds were taken
    disturbed   (m,) lowest speed [m/s] of stable hunting
    growing     (m,) lowest speed [m/s] at which the straight run loses stability
    speeds      range of the map [m/s]

    `at` tells the region of a point.
    """

    def __init__(
        self, parameter: Array, disturbed: Array, growing: Array, speeds: tuple[float, float]
    ) -> None:
        self.parameter, self.disturbed, self.growing = parameter, disturbed, growing
        self.speeds = speeds
        low, high = (np.full(len(parameter), speed) for speed in speeds)
        bounds = {
            STRAIGHT: (low, disturbed),
            DISTURBED: (disturbed, growing),
            HUNTS: (growing, high),
        }
        self._polygons = {name: _between(parameter, *pair) for name, pair in bounds.items()}

    def at(self, speed: float, parameter: float) -> str:
        """The region of a speed [m/s] and a value of the parameter."""
        growing = float(np.interp(parameter, self.parameter, self.growing))
        disturbed = float(np.interp(parameter, self.parameter, self.disturbed))
        return HUNTS if speed >= growing else DISTURBED if speed >= disturbed else STRAIGHT

    def __getitem__(self, name: str) -> Array:
        return self._polygons[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._polygons)

    def __len__(self) -> int:
        return len(self._polygons)


def regions_of(
    hopf: list[Curve], folds: list[Curve], limits: tuple[float, float], speeds: tuple[float, float]
) -> Regions:
    """Regions from the curves: bounds are the lowest curves, over values of the parameter at every
    point of a curve and at even steps."""
    values = [np.linspace(*limits, 201), *(curve.parameter for curve in [*hopf, *folds])]
    parameter = np.unique(np.clip(np.concatenate(values), *limits))
    growing = _lowest(hopf, parameter, speeds)
    disturbed = np.minimum(_lowest(folds, parameter, speeds), growing)
    return Regions(parameter, disturbed, growing, speeds)


def _lowest(curves: list[Curve], parameter: Array, speeds: tuple[float, float]) -> Array:
    bound = np.full(len(parameter), speeds[1])
    for curve in curves:
        for index, value in enumerate(parameter):
            for speed, row in curve.crossings(float(value)):
                if curve.loses[row] or curve.loses[row + 1]:
                    bound[index] = min(bound[index], max(speed, speeds[0]))
    return bound


def _between(parameter: Array, lower: Array, upper: Array) -> Array:
    edge = np.concatenate([parameter, parameter[::-1]])
    return np.column_stack([edge, np.concatenate([lower, np.maximum(upper, lower)[::-1]])])


def _lagrange(nodes: Array, values: Array, where: float) -> float:
    total = 0.0
    for i, node in enumerate(nodes):
        others = np.delete(nodes, i)
        total += values[i] * np.prod((where - others) / (node - others))
    return float(total)
