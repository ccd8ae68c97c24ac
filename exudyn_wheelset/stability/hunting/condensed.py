"""Newton's linear equations of an orbit, condensed interval by interval, and what they act on.

See `collocation` for the equations, `orbit_kernels` for the arithmetic. All in scales.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.stability.hunting.orbit import OrbitError
from exudyn_wheelset.stability.hunting.orbit_kernels import (
    bordered_matrix,
    solve_condensed,
    speed_functional,
)

# Singular values below this part of the largest one are those of states that the equations leave
# free.
FREE = 1e-13


@dataclass(frozen=True, eq=False)
class Functional:
    """A linear form on (orbit, period, speed), in scaled unknowns: one row of a bordered system.

    orbit (N, m + 1, n), period and speed: the coefficients; value: what it is to become.
    """

    orbit: Array
    period: float
    speed: float

    def __call__(self, orbit: Array, period: float, speed: float) -> float:
        return float(np.sum(self.orbit * orbit)) + self.period * period + self.speed * speed


@dataclass(frozen=True, eq=False)
class Direction:
    """A change of (orbit, period, speed): windows (N, m + 1, n) in scales, period and speed
    relative to the units of the `Collocation`."""

    orbit: Array
    period: float
    speed: float

    def vector(self) -> Array:
        """All components in one vector."""
        return np.concatenate([self.orbit.ravel(), [self.period, self.speed]])

    @classmethod
    def from_vector(cls, vector: Array, shape: tuple[int, ...]) -> Direction:
        """The inverse of `vector`, for windows of a shape (N, m + 1, n)."""
        return cls(vector[:-2].reshape(shape), float(vector[-2]), float(vector[-1]))

    def __mul__(self, factor: float) -> Direction:
        return Direction(factor * self.orbit, factor * self.period, factor * self.speed)


@dataclass(frozen=True, eq=False)
class Gradients:
    """f (k, n), df/dx (k, n, n) and df/dV (k, n), in scales, at phases (k,) of an orbit."""

    phases: Array
    rates: Array
    by_state: Array
    by_speed: Array

    def on_mesh(self, mesh: Array, nodes: Array) -> Gradients:
        """Interpolated linearly to the nodes of another mesh: good for Newton's steps,
        not for Floquet multipliers. Beyond the ends the nearest value is taken."""
        wanted = (mesh[:-1, None] + np.diff(mesh)[:, None] * nodes).ravel()
        right = np.clip(np.searchsorted(self.phases, wanted), 1, len(self.phases) - 1)
        gaps = self.phases[right] - self.phases[right - 1]
        weight = np.clip((wanted - self.phases[right - 1]) / gaps, 0.0, 1.0)

        def moved(values: Array) -> Array:
            share = weight.reshape(-1, *[1] * (values.ndim - 1))
            return np.asarray((1.0 - share) * values[right - 1] + share * values[right])

        return Gradients(wanted, moved(self.rates), moved(self.by_state), moved(self.by_speed))


@dataclass(frozen=True, eq=False)
class Condensed:
    """Newton's linear equations at an orbit, condensed to q = (x(0), T, V).

    inverse      (N, m n, m n) of the blocks of interior values
    propagation  (N, m n, n): interior values from the interval's first one
    points       (N, m + 1, n, n + 2): every value from q
    closure      (n,) signs that the end carries over to the start: 1, or the orbit's mirror
    gradients    what they were assembled from
    """

    inverse: Array
    propagation: Array
    points: Array
    closure: Array
    gradients: Gradients
    _borders: list[Border] = field(default_factory=list, repr=False)

    @property
    def monodromy(self) -> Array:
        """Map (n, n) of a disturbance, in scales, over one period.

        Over half of it, then mirrored, twice, if the orbit is its own mirror image.
        """
        size = self.points.shape[2]
        matrix = self.closure[:, None] * self.points[-1, -1, :, :size]
        return np.asarray(matrix if np.all(self.closure > 0.0) else matrix @ matrix)

    def solve(self, defects: Array, rows: list[Functional], values: list[float]) -> Direction:
        """Correction that removes the defects (N, m, n) and gives both rows their values.

        Raises OrbitError if the bordered system has no solution.
        """
        border = self._border(rows)
        change, base = solve_condensed(
            self.inverse,
            self.propagation,
            self.points,
            border.forms,
            border.solution,
            np.ascontiguousarray(defects),
            np.array(values),
        )
        return Direction(change, float(base[-2]), float(base[-1]))

    def speed_weights(self, rows: list[Functional]) -> Array:
        """Weights (N, m, n) of the defects in the speed of `solve` with both rows zero."""
        border = self._border(rows)
        weights: Array = speed_functional(
            self.inverse, self.propagation, border.forms, border.solution
        )
        return weights

    def _border(self, rows: list[Functional]) -> Border:
        """The bordered system of two rows; the last one is kept."""
        for known in self._borders:
            if all(one is two for one, two in zip(known.rows, rows, strict=True)):
                return known
        forms = np.array([row.orbit for row in rows])
        ends = np.array([[row.period, row.speed] for row in rows])
        matrix = bordered_matrix(self.points, self.closure, forms, ends)
        # A coordinate that the equations leave free makes the system singular, and the least
        # change of it is the right one.
        try:
            solution = np.ascontiguousarray(np.linalg.pinv(matrix, rcond=FREE))
        except np.linalg.LinAlgError as error:
            raise OrbitError("Newton's equations of the orbit have no solution") from error
        self._borders[:] = [Border(tuple(rows), forms, solution)]
        return self._borders[0]


@dataclass(frozen=True, eq=False)
class Border:
    """Two rows (2, N, m + 1, n) beside the closing condition, and the solution (n + 2, n + 2) of
    the system of q that they make."""

    rows: tuple[Functional, ...]
    forms: Array
    solution: Array
