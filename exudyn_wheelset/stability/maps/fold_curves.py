"""Curves of folds of limit cycles in speed and a second number of the vehicle.

The orbits of all vehicles of the family are a surface X(s, p): s along the branch of one vehicle,
p from vehicle to vehicle, regular also where speeds turn back. On it a fold is where dV/ds
vanishes, a curve that is followed as any curve in a plane (see `tracing`); a cusp, where two folds
meet and vanish, is where it turns back in p, and where a fold shrinks into the Hopf curve, a
Bautin point, its amplitude goes to zero. Orbits lie on meshes with a point on each corner of f.

Coordinates: u = s over the size of the first orbit, w = parameter over its range.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.stability.hunting.condensed import Direction
from exudyn_wheelset.stability.hunting.fold_points import (
    ALIGN,
    Slope,
    distance_between,
    orbit_on_plane,
)
from exudyn_wheelset.stability.hunting.orbit import OrbitError
from exudyn_wheelset.stability.maps.tracing import Family

# Of the fold's speed [m/s].
TOLERANCE = 1e-3
# Of its parameter where it turns back, as a share of the range: speeds do not tell it at a cusp.
PARAMETER = 3e-4
# Difference step of the parameter, as a share of its range.
STEP = 1e-5
# A curve ends in a Bautin point where the orbit is smaller than this, in scales.
SMALLEST = 0.15
# A correction of Newton's method changes the orbit by no more than this share of its size.
LARGEST_CHANGE = 0.5


@dataclass(frozen=True, eq=False)
class FoldPlace:
    """An orbit of a vehicle of the family; unit: length of u; value: slope dV/du of its branch
    [m/s]."""

    point: Slope
    parameter: float
    unit: float

    @property
    def value(self) -> float:
        return self.point.slope * self.unit

    @property
    def speed(self) -> float:
        return self.point.orbit.speed

    @cached_property
    def multipliers(self) -> tuple[Array, float]:
        """Multipliers without the trivial one, and their error."""
        found = self.point.equations.multipliers(self.point.orbit, self.point.condensed)
        return found.values, found.error

    @property
    def one_side_stable(self) -> bool:
        """Whether cycles are stable on one side of the fold: no multiplier outside but its own."""
        values, error = self.multipliers
        # Its own is 1 to a factor: where forces jump it may come out as 2.
        factors = np.abs(np.log(np.maximum(np.abs(values), 1e-300)) + 1j * np.angle(values))
        others = np.delete(values, int(np.argmin(factors))) if len(values) else values
        return bool(np.all(np.abs(others) < 1.0 + max(1e-3, error)))


class FoldWorld:
    """Orbits and parameters in which folds are followed (see `tracing.World`)."""

    def __init__(
        self, family: Family, limits: tuple[float, float], speeds: tuple[float, float]
    ) -> None:
        self.family = family
        self.low, self.high = limits
        self.span = self.high - self.low
        self.slowest, self.fastest = speeds
        self._onward: dict[int, tuple[FoldPlace, Direction]] = {}
        self._aligned: dict[int, tuple[FoldPlace, Slope]] = {}

    def reach(self, base: FoldPlace, move: Array) -> FoldPlace:
        """The place at a move from a base: an orbit of another vehicle across another plane."""
        point = self._start(base)
        parameter = base.parameter
        guess = point.equations.moved(point.orbit, point.tangent, float(move[0]) * base.unit)
        if move[1]:
            parameter = float(np.clip(parameter + move[1] * self.span, self.low, self.high))
            onward = self.onward(FoldPlace(point, base.parameter, base.unit))
            guess = point.equations.moved(guess, onward, float(move[1]))
        align = 0 if point.equations.system.stiff else ALIGN
        found = orbit_on_plane(self.family(parameter), guess, point.tangent, point, align)
        change = abs(found.size / point.size - 1.0)
        if change > LARGEST_CHANGE or not 0.67 < found.orbit.period / guess.period < 1.5:
            raise OrbitError("Newton left the curve: the orbit changed its size or period")
        return FoldPlace(found, parameter, base.unit)

    def _start(self, base: FoldPlace) -> Slope:
        """The orbit of a base on the mesh that its neighbours are to have.

        On elastic contact corners come and go from orbit to orbit, and the slope jumps with them:
        there all places that are reached from one base share the mesh on its corners.
        """
        if not base.point.equations.system.stiff:
            return base.point
        known = self._aligned.get(id(base))
        if known is None or known[0] is not base:
            point = base.point
            try:
                point = orbit_on_plane(
                    self.family(base.parameter), point.orbit, point.tangent, point, 1
                )
            except OrbitError:
                point = base.point
            known = (base, point)
            self._aligned = {id(base): known}
        return known[1]

    def onward(self, base: FoldPlace) -> Direction:
        """Change of the orbit with w on its plane: the linear equations of Newton's method."""
        known = self._onward.get(id(base.point))
        if known is not None and known[0].point is base.point:
            return known[1]
        point, orbit = base.point, base.point.orbit
        equations = point.equations
        states = equations.node_states(orbit)
        ends = [
            float(np.clip(base.parameter + sign * STEP * self.span, self.low, self.high))
            for sign in (1.0, -1.0)
        ]
        rates = [
            np.asarray(self.family(end).derivatives(states, orbit.speed)) / equations.scales
            for end in ends
        ]
        slope = (rates[0] - rates[1]) * (self.span / (ends[0] - ends[1]))
        widths = np.diff(orbit.mesh)[:, None, None]
        defects = -widths * orbit.duration * slope.reshape(len(widths), orbit.degree, -1)
        rows = [equations.phase(orbit), equations.inner(orbit.mesh, point.tangent)]
        direction = point.condensed.solve(defects, rows, [0.0, 0.0])
        self._onward = {id(base.point): (base, direction)}
        return direction

    def between(self, base: FoldPlace, other: FoldPlace) -> Array:
        """Move from one place to another."""
        along = distance_between(base.point, other.point) / base.unit
        return np.array([along, (other.parameter - base.parameter) / self.span])

    def error(self, place: FoldPlace, move: Array) -> float:
        """By how much a correction moves the fold's speed, or its parameter, in tolerances."""
        if move[0]:
            return 0.5 * abs(float(place.value * move[0])) / TOLERANCE
        speed = self.onward(place).speed * place.point.equations.speed_unit
        return max(abs(float(speed)) / TOLERANCE, 1.0 / PARAMETER) * abs(float(move[1]))

    def ended(self, place: FoldPlace) -> str:
        """Why the curve ends at a place."""
        if place.point.size < SMALLEST:
            return BAUTIN
        if not self.slowest <= place.speed <= self.fastest:
            return f"the speed range was left at {place.speed:.4g} m/s"
        if place.parameter in (self.low, self.high):
            return f"the parameter's range ends at {place.parameter:g}"
        return ""


BAUTIN = "the fold shrinks into the Hopf curve (Bautin point)"
