"""Periodic orbits by orthogonal collocation: one hunting cycle as a boundary value problem.

An orbit of x' = f(x; V) with period T is x(s T) for the phase s in [0, 1]:

    dx/ds = T f(x; V),   x(1) = x(0),   integral <x - x_ref, dx_ref/ds> ds = 0      (1)

The last equation fixes the phase. On each of N mesh intervals x is a polynomial of degree m that
satisfies (1) at the m Gauss points; it is held by its values at m + 1 equidistant points. The
error falls with h^(m+1) along the orbit and with h^(2m) at mesh points, in period and in speed
(de Boor and Swartz, SIAM J. Numer. Anal. 10 (1973) 582) as long as f is smooth.

Newton's correction is condensed interval by interval (Doedel, Keller, Kernevez, Int. J. Bif.
Chaos 1 (1991) 745): the interior values are eliminated, so that every point of the orbit becomes
a linear function of q = (x(0), T, V), and a system of order n + 2 remains. The map of x(0) to
x(1) so obtained is the monodromy matrix; its eigenvalues are the Floquet multipliers.

Inside, states are measured in `system.scales`; orbits outside are in SI units and radians, the
period in s, the speed in m/s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from math import comb

import numpy as np

from exudyn_wheelset.analyses.system import DIFFERENCE_STEP, Array, DynamicSystem
from exudyn_wheelset.errors import AnalysisError, WheelsetError

DEGREE = 4
INTERVALS = 30
# One-sided difference step in scales: it leaves 1e-6 in a Jacobian, which moves no orbit (the
# defects are exact) and a multiplier by as little; a contact search resolves a nanometre.
FORWARD_STEP = 1e-6


class OrbitError(AnalysisError):
    """No periodic orbit was reached; `contact_lost` tells a model left from a Newton failed."""

    def __init__(self, message: str, contact_lost: bool = False) -> None:
        super().__init__(message)
        self.contact_lost = contact_lost


@dataclass(frozen=True)
class _Basis:
    """Lagrange basis on m + 1 equidistant points of [0, 1], taken at the m Gauss points."""

    points: Array
    gauss: Array
    weights: Array
    values: Array
    slopes: Array
    barycentric: Array


@lru_cache(maxsize=8)
def _basis(degree: int) -> _Basis:
    points = np.arange(degree + 1) / degree
    roots, weights = np.polynomial.legendre.leggauss(degree)
    gauss = 0.5 * (1.0 + roots)
    vandermonde = np.linalg.inv(np.vander(points, increasing=True))
    powers = np.arange(degree + 1)
    values = gauss[:, None] ** powers @ vandermonde
    slopes = (powers * gauss[:, None] ** np.maximum(powers - 1, 0)) @ vandermonde
    signs = np.array([(-1.0) ** j * comb(degree, j) for j in range(degree + 1)])
    return _Basis(points, gauss, 0.5 * weights, values, slopes, signs)


@dataclass(frozen=True, eq=False)
class Orbit:
    """One periodic motion, a piecewise polynomial of the phase s = t/period in [0, 1].

    mesh     (N + 1,) phases of the interval ends, from 0 to 1
    states   (N m + 1, n) states at the m + 1 equidistant points of each interval; the last is
             the first again
    period   [s]
    speed    [m/s]
    """

    mesh: Array
    states: Array
    period: float
    speed: float

    @property
    def degree(self) -> int:
        """Degree m of the polynomial on each interval."""
        return (len(self.states) - 1) // (len(self.mesh) - 1)

    @property
    def phases(self) -> Array:
        """Phases (N m + 1,) of `states`."""
        local = _basis(self.degree).points[:-1]
        inner = self.mesh[:-1, None] + np.diff(self.mesh)[:, None] * local
        return np.append(inner.ravel(), 1.0)

    def evaluate(self, phases: Array) -> Array:
        """States (k, n) at phases (k,) of any size; the orbit repeats with 1."""
        phases = np.mod(np.asarray(phases, dtype=float), 1.0)
        interval = np.clip(np.searchsorted(self.mesh, phases, side="right") - 1, 0, None)
        interval = np.minimum(interval, len(self.mesh) - 2)
        local = (phases - self.mesh[interval]) / np.diff(self.mesh)[interval]
        basis = _basis(self.degree)
        coefficients = np.linalg.inv(np.vander(basis.points, increasing=True))
        weights = local[:, None] ** np.arange(self.degree + 1) @ coefficients
        return np.einsum("kj,kjn->kn", weights, _windows(self.states, self.degree)[interval])

    def half_peak_to_peak(self) -> Array:
        """Amplitude (n,): half of the distance from the least to the largest value."""
        per_interval = 4 * self.degree
        local = np.arange(per_interval) / per_interval
        phases = (self.mesh[:-1, None] + np.diff(self.mesh)[:, None] * local).ravel()
        values = self.evaluate(phases)
        return 0.5 * (_peak(phases, values) + _peak(phases, -values))

    def on_mesh(self, mesh: Array) -> Orbit:
        """The same motion on other intervals."""
        moved = replace(self, mesh=np.asarray(mesh), states=np.empty(0))
        local = _basis(self.degree).points[:-1]
        phases = (moved.mesh[:-1, None] + np.diff(moved.mesh)[:, None] * local).ravel()
        states = self.evaluate(phases)
        return replace(moved, states=np.vstack([states, states[:1]]))


def orbit_from_samples(
    states: Array, period: float, speed: float, intervals: int, degree: int = DEGREE
) -> Orbit:
    """Orbit on an even mesh from N m + 1 states (N m + 1, n) at equal steps over one period.

    The last sample is replaced by the first, so a motion not yet settled makes a small step there.
    """
    states = np.array(states, dtype=float)
    if len(states) != intervals * degree + 1:
        raise AnalysisError(
            f"{intervals} intervals of degree {degree} need {intervals * degree + 1} samples, "
            f"got {len(states)}"
        )
    states[-1] = states[0]
    return Orbit(np.linspace(0.0, 1.0, intervals + 1), states, float(period), float(speed))


def balanced_mesh(orbit: Orbit, scales: Array, weight: float = 0.8) -> Array:
    """Mesh (N + 1,) on which each interval carries an equal share of the local error.

    The error density is |d^(m+1)x/ds^(m+1)|^(1/(m+1)), its derivative taken from the jumps of the
    piecewise constant m-th one. The share 1 - `weight` is spread evenly: corners of f (a flange
    spring, saturated creep) would otherwise draw all intervals to themselves.
    """
    degree, mesh = orbit.degree, orbit.mesh
    widths = np.diff(mesh)
    windows = _windows(orbit.states / scales, degree)
    highest = np.einsum("j,ijn->in", _basis(degree).barycentric, windows)
    highest *= (degree / widths[:, None]) ** degree
    gaps = 0.5 * (widths + np.roll(widths, 1))
    jumps = np.linalg.norm(highest - np.roll(highest, 1, axis=0), axis=1) / gaps
    density = (0.5 * (jumps + np.roll(jumps, -1))) ** (1.0 / (degree + 1))
    density = 0.25 * np.roll(density, 1) + 0.5 * density + 0.25 * np.roll(density, -1)
    total = float(np.sum(density * widths))
    if not np.isfinite(total) or total <= 0.0:
        return mesh
    share = np.concatenate([[0.0], np.cumsum(density * widths / total)])
    share = weight * share + (1.0 - weight) * mesh
    balanced = np.interp(np.linspace(0.0, 1.0, len(mesh)), share / share[-1], mesh)
    balanced[0], balanced[-1] = 0.0, 1.0
    return balanced


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

    def on_mesh(self, mesh: Array, degree: int) -> Gradients:
        """Interpolated linearly to the Gauss points of another mesh: good for Newton's steps,
        not for Floquet multipliers."""
        wanted = (mesh[:-1, None] + np.diff(mesh)[:, None] * _basis(degree).gauss).ravel()
        phases = np.concatenate([[self.phases[-1] - 1.0], self.phases, [self.phases[0] + 1.0]])
        right = np.searchsorted(phases, wanted)
        weight = (wanted - phases[right - 1]) / (phases[right] - phases[right - 1])

        def moved(values: Array) -> Array:
            periodic = np.concatenate([values[-1:], values, values[:1]])
            share = weight.reshape(-1, *[1] * (values.ndim - 1))
            return (1.0 - share) * periodic[right - 1] + share * periodic[right]

        return Gradients(wanted, moved(self.rates), moved(self.by_state), moved(self.by_speed))


@dataclass(frozen=True, eq=False)
class Condensed:
    """Newton's linear equations at an orbit, condensed to q = (x(0), T, V).

    inverse      (N, m n, m n) of the blocks of interior values
    propagation  (N, m n, n): interior values from the interval's first one
    points       (N, m + 1, n, n + 2): every value from q
    gradients    what they were assembled from
    """

    inverse: Array
    propagation: Array
    points: Array
    gradients: Gradients

    @property
    def monodromy(self) -> Array:
        """Map (n, n) of a disturbance, in scales, over one period."""
        size = self.points.shape[2]
        return self.points[-1, -1, :, :size]

    def solve(self, defects: Array, rows: list[Functional], values: list[float]) -> Direction:
        """Correction that removes the defects (N, m, n) and gives each row its value.

        Raises OrbitError if the bordered system has no solution.
        """
        intervals, points, size, columns = self.points.shape
        local = -np.matmul(self.inverse, defects.reshape(intervals, -1, 1))[..., 0]
        offset = np.empty((intervals, points, size))
        start = np.zeros(size)
        for index in range(intervals):
            offset[index, 0] = start
            inner = self.propagation[index] @ start + local[index]
            offset[index, 1:] = inner.reshape(points - 1, size)
            start = offset[index, -1]
        matrix = np.zeros((columns, columns))
        right = np.zeros(columns)
        matrix[:size] = self.points[-1, -1]
        matrix[:size, :size] -= np.eye(size)
        right[:size] = -offset[-1, -1]
        for line, (row, value) in enumerate(zip(rows, values, strict=True), start=size):
            matrix[line] = np.tensordot(row.orbit, self.points, axes=3)
            matrix[line, size] += row.period
            matrix[line, size + 1] += row.speed
            right[line] = value - np.sum(row.orbit * offset)
        # Least squares: a coordinate that the equations leave free makes the system singular, and
        # the least change of it is the right one.
        try:
            base = np.linalg.lstsq(matrix, right, rcond=1e-13)[0]
        except np.linalg.LinAlgError as error:
            raise OrbitError("Newton's equations of the orbit have no solution") from error
        return Direction(self.points @ base + offset, float(base[size]), float(base[size + 1]))


class Collocation:
    """The collocation equations of a system, with a count of what they cost.

    period_unit and speed_unit measure the changes of T and V. A system without Jacobians of its
    own is differentiated by n one-sided differences a point, f being known there. `evaluations`
    counts right-hand sides, those of differences included, `jacobians` Jacobian matrices of f.
    """

    def __init__(self, system: DynamicSystem, period_unit: float, speed_unit: float) -> None:
        self.system = system
        self.scales = np.asarray(system.scales, dtype=float)
        self.period_unit = float(period_unit)
        self.speed_unit = float(speed_unit)
        self.evaluations = 0
        self.jacobians = 0
        kind = type(system)
        self._differences = (
            kind.jacobian is DynamicSystem.jacobian and kind.jacobians is DynamicSystem.jacobians
        )

    def windows(self, orbit: Orbit) -> Array:
        """States of each interval (N, m + 1, n) in scales."""
        return _windows(orbit.states / self.scales, orbit.degree)

    def moved(self, orbit: Orbit, step: Direction, factor: float = 1.0) -> Orbit:
        """The orbit changed by factor * step."""
        change = step.orbit * self.scales
        last = change[-1, -1]
        states = orbit.states + factor * np.vstack([change[:, :-1].reshape(-1, len(last)), last])
        return replace(
            orbit,
            states=states,
            period=orbit.period + factor * step.period * self.period_unit,
            speed=orbit.speed + factor * step.speed * self.speed_unit,
        )

    def difference(self, orbit: Orbit, other: Orbit) -> Direction:
        """orbit - other, both on one mesh."""
        return Direction(
            self.windows(orbit) - self.windows(other),
            (orbit.period - other.period) / self.period_unit,
            (orbit.speed - other.speed) / self.speed_unit,
        )

    def inner(self, mesh: Array, direction: Direction) -> Functional:
        """The scalar product with a direction: mean over the phase plus period and speed."""
        degree = direction.orbit.shape[1] - 1
        basis = _basis(degree)
        gram = basis.values.T @ (basis.weights[:, None] * basis.values)
        weighted = np.einsum("i,jk,ikn->ijn", np.diff(mesh), gram, direction.orbit)
        return Functional(weighted, direction.period, direction.speed)

    def norm(self, mesh: Array, direction: Direction) -> float:
        """Length of a direction in the scalar product `inner`."""
        form = self.inner(mesh, direction)
        square = form(direction.orbit, direction.period, direction.speed)
        return float(np.sqrt(max(square, 0.0)))

    def size(self, orbit: Orbit) -> float:
        """Root mean square distance of the orbit from its mean, in scales (sum over states)."""
        windows = self.windows(orbit)
        basis = _basis(orbit.degree)
        widths = np.diff(orbit.mesh)
        weights = widths[:, None] * (basis.weights @ basis.values)
        mean = np.einsum("ij,ijn->n", weights, windows)
        return self.norm(orbit.mesh, Direction(windows - mean, 0.0, 0.0))

    def phase(self, orbit: Orbit) -> Functional:
        """The form <., dx_ref/ds> of the phase condition about the orbit as reference."""
        basis = _basis(orbit.degree)
        slopes = np.einsum("kj,ijn->ikn", basis.slopes, self.windows(orbit))
        row = np.einsum("k,kj,ikn->ijn", basis.weights, basis.values, slopes)
        return Functional(row / max(float(np.linalg.norm(row)), 1e-300), 0.0, 0.0)

    def defects(self, orbit: Orbit) -> Array:
        """What (1) lacks at the Gauss points (N, m, n), times the interval's width, in scales.

        Raises OrbitError with contact_lost if f is not finite somewhere on the orbit.
        """
        rates = self._rates(self._gauss_states(orbit), orbit.speed)
        basis = _basis(orbit.degree)
        slopes = np.einsum("kj,ijn->ikn", basis.slopes, self.windows(orbit))
        widths = np.diff(orbit.mesh)[:, None, None]
        return slopes - widths * orbit.period * rates.reshape(slopes.shape)

    def condense(self, orbit: Orbit) -> Condensed:
        """Newton's equations at the orbit: one Jacobian of f at every Gauss point."""
        return self.assemble(orbit, self.gradients(orbit))

    def gradients(self, orbit: Orbit) -> Gradients:
        """f and its derivatives at the Gauss points of an orbit; raises OrbitError."""
        states = self._gauss_states(orbit)
        step = DIFFERENCE_STEP * max(1.0, abs(orbit.speed))
        rates = self._rates(states, orbit.speed)
        if self._differences:
            by_state = self._forward_differences(states, orbit.speed, rates)
        else:
            by_state = self._jacobians(states, orbit.speed)
        by_speed = self._rates(states, orbit.speed + step)
        by_speed = (by_speed - self._rates(states, orbit.speed - step)) / (2.0 * step)
        basis = _basis(orbit.degree)
        phases = orbit.mesh[:-1, None] + np.diff(orbit.mesh)[:, None] * basis.gauss
        return Gradients(phases.ravel(), rates, by_state, by_speed)

    def assemble(self, orbit: Orbit, gradients: Gradients) -> Condensed:
        """Newton's equations from gradients given at the Gauss points of the orbit.

        Raises OrbitError if an interval's equations are singular.
        """
        basis = _basis(orbit.degree)
        intervals, degree, size = len(orbit.mesh) - 1, orbit.degree, len(self.scales)
        widths = np.repeat(np.diff(orbit.mesh), degree)
        jacobians = gradients.by_state * (orbit.period * widths)[:, None, None]
        jacobians = jacobians.reshape(intervals, degree, size, size)
        full = -np.einsum("kj,ikab->ikajb", basis.values, jacobians)
        for component in range(size):
            full[:, :, component, :, component] += basis.slopes
        full = full.reshape(intervals, degree * size, (degree + 1) * size)
        columns = widths[:, None] * gradients.rates * self.period_unit
        by_period = -columns.reshape(intervals, -1, 1)
        columns = widths[:, None] * gradients.by_speed * (orbit.period * self.speed_unit)
        by_speed = -columns.reshape(intervals, -1, 1)
        try:
            inverse = np.linalg.inv(full[:, :, size:])
        except np.linalg.LinAlgError as error:
            raise OrbitError("an interval of the orbit is too long for its equations") from error
        influence = -inverse @ np.concatenate([full[:, :, :size], by_period, by_speed], axis=2)

        points = np.empty((intervals, degree + 1, size, size + 2))
        start = np.eye(size, size + 2)
        for index in range(intervals):
            points[index, 0] = start
            inner = influence[index, :, :size] @ start
            inner[:, size:] += influence[index, :, size:]
            points[index, 1:] = inner.reshape(degree, size, size + 2)
            start = points[index, -1]
        return Condensed(inverse, influence[:, :, :size], points, gradients)

    def multipliers(self, orbit: Orbit, condensed: Condensed) -> tuple[Array, float]:
        """Floquet multipliers (n - 1,) by falling size, and the error of the trivial one.

        The direction of motion x'(0) is mapped to itself; the others are the eigenvalues of the
        monodromy matrix on the space across it, so that a fold, where a second multiplier passes
        1, cannot be confused with the trivial one. The error is |M e - e|, e = x'(0)/|x'(0)|.
        """
        rate = self._rates(orbit.states[:1], orbit.speed)[0]
        along = rate / np.linalg.norm(rate)
        matrix = condensed.monodromy
        basis = np.linalg.qr(np.column_stack([along, np.eye(len(along))]))[0]
        across = basis[:, 1 : len(along)]
        values = np.linalg.eigvals(across.T @ matrix @ across)
        order = np.argsort(-np.abs(values), kind="stable")
        return values[order], float(np.linalg.norm(matrix @ along - along))

    def _jacobians(self, states: Array, speed: float) -> Array:
        self.jacobians += len(states)
        try:
            jacobians = np.asarray(self.system.jacobians(states, speed))
        except WheelsetError as error:
            raise OrbitError(f"at {speed:.4f} m/s: {error}", contact_lost=True) from error
        if not np.all(np.isfinite(jacobians)):
            raise OrbitError(
                f"the Jacobian is not finite on the orbit at {speed:.4f} m/s", contact_lost=True
            )
        return jacobians * (self.scales[None, None, :] / self.scales[None, :, None])

    def _forward_differences(self, states: Array, speed: float, rates: Array) -> Array:
        self.jacobians += len(states)
        result = np.empty((*rates.shape, len(self.scales)))
        for column, scale in enumerate(self.scales):
            shifted = states.copy()
            shifted[:, column] += FORWARD_STEP * scale
            result[:, :, column] = (self._rates(shifted, speed) - rates) / FORWARD_STEP
        return result

    def _gauss_states(self, orbit: Orbit) -> Array:
        windows = _windows(orbit.states, orbit.degree)
        values = np.einsum("kj,ijn->ikn", _basis(orbit.degree).values, windows)
        return values.reshape(-1, windows.shape[2])

    def _rates(self, states: Array, speed: float) -> Array:
        """f in scales (k, n); raises OrbitError where the model has no value."""
        self.evaluations += len(states)
        try:
            rates = np.asarray(self.system.derivatives(states, speed)) / self.scales
        except WheelsetError as error:
            raise OrbitError(f"at {speed:.4f} m/s: {error}", contact_lost=True) from error
        if not np.all(np.isfinite(rates)):
            raise OrbitError(
                f"the equations give no finite value on the orbit at {speed:.4f} m/s",
                contact_lost=True,
            )
        return rates


@dataclass(frozen=True, eq=False)
class Solution:
    """A converged orbit, the last condensed equations (near it, not at it) and Newton's steps."""

    orbit: Orbit
    condensed: Condensed
    iterations: int
    refreshed: int


def solve_orbit(
    equations: Collocation,
    guess: Orbit,
    row: Functional,
    target: float = 0.0,
    condensed: Condensed | None = None,
    reference: Orbit | None = None,
    tolerance: float = 1e-9,
    iterations: int = 25,
    contraction: float = 0.6,
) -> Solution:
    """Periodic orbit near `guess` on which `row` of (orbit - guess) has the value `target`.

    Newton's method with the equations `condensed` at a neighbour: from step to step they are kept
    and corrected by Broyden's rank-one formula (Kelley, Iterative Methods for Linear and
    Nonlinear Equations, SIAM 1995, section 7.3). Only when a correction is larger than
    `contraction` times the one before are the Jacobians computed anew. A step that does not
    reduce the defects is halved. Converged when the correction, relative to the size of the orbit,
    is below `tolerance` (in the largest component). Raises OrbitError.
    """
    reference = reference or guess
    phase = equations.phase(reference)
    orbit = guess
    defects = equations.defects(orbit)
    fresh = condensed is None
    refreshed = 0
    if condensed is None:
        condensed = equations.condense(orbit)
        refreshed = 1
    size = max(equations.size(guess), 1e-12)
    previous = np.inf
    steps: list[Direction] = []
    for iteration in range(1, iterations + 1):
        moved = equations.difference(orbit, guess)
        apart = equations.difference(orbit, reference)
        values = [
            -phase(apart.orbit, 0.0, 0.0),
            target - row(moved.orbit, moved.period, moved.speed),
        ]
        step = _broyden(condensed.solve(defects, [phase, row], values), steps)
        length = _relative_size(step, size, orbit, equations)
        if not np.isfinite(length):
            raise OrbitError("Newton's correction is not finite")
        if length < tolerance:
            return Solution(equations.moved(orbit, step), condensed, iteration, refreshed)
        if not fresh and length > contraction * previous:
            # Rounding of f, or a corner of f that is crossed to and fro, sets a floor.
            if length < 1e3 * tolerance and refreshed:
                return Solution(orbit, condensed, iteration, refreshed)
            condensed = equations.condense(orbit)
            refreshed += 1
            fresh = True
            previous = np.inf
            steps = []
            continue
        orbit, defects, factor = _damped(equations, orbit, defects, step, length)
        steps = [*steps, step] if factor == 1.0 else []
        previous = length
        fresh = False
    raise OrbitError(
        f"Newton did not converge in {iterations} steps at {orbit.speed:.4f} m/s; the last "
        f"correction was {previous:.2g} of the orbit"
    )


def _broyden(step: Direction, steps: list[Direction]) -> Direction:
    """The correction by the kept equations, improved by what the steps before have shown."""
    vector = step.vector()
    for index, taken in enumerate(steps):
        before = taken.vector()
        square = float(before @ before)
        share = float(before @ vector) / square
        if index + 1 < len(steps):
            vector = vector + share * steps[index + 1].vector()
        elif share < 0.9:
            vector = vector / (1.0 - share)
    return Direction.from_vector(vector, step.orbit.shape)


def speed_row(orbit: Orbit, size: int) -> Functional:
    """The row that holds the speed fixed."""
    shape = (len(orbit.mesh) - 1, orbit.degree + 1, size)
    return Functional(np.zeros(shape), 0.0, 1.0)


def _relative_size(step: Direction, size: float, orbit: Orbit, equations: Collocation) -> float:
    return max(
        float(np.abs(step.orbit).max()) / size,
        abs(step.period) * equations.period_unit / orbit.period,
        abs(step.speed) * equations.speed_unit / max(1.0, abs(orbit.speed)),
    )


def _damped(
    equations: Collocation, orbit: Orbit, defects: Array, step: Direction, length: float
) -> tuple[Orbit, Array, float]:
    """The orbit after a step, halved while it makes the defects grow or leaves the model."""
    before = float(np.linalg.norm(defects))
    factor = 1.0
    while True:
        trial = equations.moved(orbit, step, factor)
        if trial.period > 0.0:
            try:
                after = equations.defects(trial)
            except OrbitError:
                if factor < 0.1:
                    raise
            else:
                # Near the solution the defects may be rounding: small steps are taken whole.
                if length < 1e-3 or factor < 0.1 or np.linalg.norm(after) < 2.0 * before:
                    return trial, after, factor
        elif factor < 0.1:
            raise OrbitError("Newton's correction makes the period negative")
        factor *= 0.5


def _windows(states: Array, degree: int) -> Array:
    """States (N, m + 1, n) of each interval from the chain (N m + 1, n)."""
    first = np.arange(0, len(states) - 1, degree)
    return states[first[:, None] + np.arange(degree + 1)]


def _peak(phases: Array, values: Array) -> Array:
    """Largest value (n,) of each column, by the parabola through the three highest samples."""
    count, size = values.shape
    index = values.argmax(axis=0)
    column = np.arange(size)
    middle = values[index, column]
    below, above = values[index - 1, column], values[(index + 1) % count, column]
    left = np.mod(phases[index] - phases[index - 1], 1.0)
    right = np.mod(phases[(index + 1) % count] - phases[index], 1.0)
    slope_left, slope_right = (middle - below) / left, (above - middle) / right
    curvature = 2.0 * (slope_right - slope_left) / (left + right)
    slope = (slope_left * right + slope_right * left) / (left + right)
    with np.errstate(divide="ignore", invalid="ignore"):
        rise = np.where(curvature < 0.0, -0.5 * slope**2 / curvature, 0.0)
    return middle + rise
