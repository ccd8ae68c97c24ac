"""Curves of Hopf points in speed and a second number of the vehicle.

At every place the equilibrium, the Jacobian and the root nearest to the last one; the curve is
where its real part vanishes. Coordinates: u = speed over the range of speeds, w = parameter.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.stability.linear.spectra import check_finite, oscillates
from exudyn_wheelset.stability.maps.tracing import Family

# [m/s]
TOLERANCE = 1e-4
# Roots of less than this frequency, as a share of the one followed, are not taken for it.
SLOWEST = 0.2


@dataclass(frozen=True, eq=False)
class HopfPlace:
    """A root at a speed [m/s] and a parameter; value: its real part [1/s]."""

    speed: float
    parameter: float
    eigenvalue: complex
    mode: Array
    state: Array

    @property
    def value(self) -> float:
        return self.eigenvalue.real


class HopfWorld:
    """Speeds and parameters in which Hopf points are followed (see `tracing.World`)."""

    def __init__(
        self, family: Family, limits: tuple[float, float], speeds: tuple[float, float]
    ) -> None:
        self.family = family
        self.low, self.high = limits
        self.span = self.high - self.low
        self.slowest, self.fastest = speeds
        self.unit = self.fastest - self.slowest

    def begin(self, point: CriticalPoint, parameter: float) -> HopfPlace:
        """The place of a Hopf point."""
        return HopfPlace(point.speed, parameter, point.eigenvalue, point.mode, point.state)

    def reach(self, base: HopfPlace, move: Array) -> HopfPlace:
        """The place at a move from a base, with the root that is like the base's."""
        speed = base.speed + float(move[0]) * self.unit
        parameter = base.parameter + float(move[1]) * self.span
        if move[1]:
            parameter = float(np.clip(parameter, self.low, self.high))
        system = self.family(parameter)
        state = system.equilibrium(speed, system.carry_over(base.state, base.speed, speed))
        scales = np.asarray(system.scales)
        matrix = system.jacobian(state, speed) * scales[None, :] / scales[:, None]
        check_finite(system, matrix, speed)
        values, vectors = np.linalg.eig(matrix)
        rows = np.flatnonzero(
            oscillates(values) & (values.imag > SLOWEST * abs(base.eigenvalue.imag))
        )
        before = base.mode / scales
        before = before / np.linalg.norm(before)
        alike = np.abs(vectors[:, rows].conj().T @ before)
        apart = np.abs(values[rows] - base.eigenvalue) / abs(base.eigenvalue)
        row = rows[int(np.argmin(apart - 0.2 * alike))]
        return HopfPlace(speed, parameter, complex(values[row]), scales * vectors[:, row], state)

    def between(self, base: HopfPlace, other: HopfPlace) -> Array:
        """Move from one place to another."""
        return np.array(
            [
                (other.speed - base.speed) / self.unit,
                (other.parameter - base.parameter) / self.span,
            ]
        )

    def error(self, place: HopfPlace, move: Array) -> float:
        """Size of a correction in tolerances."""
        return float(np.abs(move).sum()) * self.unit / TOLERANCE

    def ended(self, place: HopfPlace) -> str:
        """Why the curve ends at a place."""
        if not self.slowest <= place.speed <= self.fastest:
            return f"the speed range was left at {place.speed:.4g} m/s"
        if place.parameter in (self.low, self.high):
            return f"the parameter's range ends at {place.parameter:g}"
        return ""
