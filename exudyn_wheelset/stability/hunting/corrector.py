"""Correction of a guess to a periodic orbit: Newton's method that spares Jacobians.

The Jacobians of f along an orbit cost n times as much as its defects, and those of a neighbour are
nearly right. So the equations condensed at a neighbour are kept, and Broyden's rank-one formula
corrects them from step to step (Kelley, Iterative Methods for Linear and Nonlinear Equations,
SIAM 1995, section 7.3). Corners of f (flange, saturated creep, lift-off) are passed by halving
steps and by new Jacobians where the old ones no longer serve.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.condensed import Condensed, Direction, Functional
from exudyn_wheelset.stability.hunting.orbit import Orbit, OrbitError

# Below this share of Newton's step, a step is taken as it is.
SMALLEST_FACTOR = 0.1


@dataclass(frozen=True, eq=False)
class Solution:
    """A converged orbit and how it was reached.

    condensed   the last condensed equations, near the orbit, not at it
    iterations  Newton's steps, and refreshed: how often Jacobians were computed
    error       last correction, relative to the size of the orbit
    """

    orbit: Orbit
    condensed: Condensed
    iterations: int
    refreshed: int
    error: float


def solve_orbit(
    equations: Collocation,
    guess: Orbit,
    row: Functional,
    target: float = 0.0,
    condensed: Condensed | None = None,
    reference: Orbit | None = None,
    tolerance: float = 1e-9,
    roughness: float = 0.0,
    iterations: int = 25,
    contraction: float = 0.6,
    refreshes: int = 4,
) -> Solution:
    """Periodic orbit near `guess` on which `row` of (orbit - guess) has the value `target`.

    `condensed` are the equations at a neighbour; without them the first Jacobians are those of the
    guess. Converged when the correction, relative to the size of the orbit, is below `tolerance`
    (in the largest component). A step is measured by the correction that the same equations ask
    for after it (natural monotonicity, Deuflhard, Newton Methods for Nonlinear Problems, Springer
    2004, section 3.3): above `contraction` times the one before, Jacobians are computed anew, at
    most `refreshes` times; with new ones a step that does not reduce it is halved. Where f jumps (a
    contact point that changes place) the corrections may stop falling: an orbit with one below
    `roughness` is then taken. Raises OrbitError.
    """
    reference = reference or guess
    phase = equations.phase(reference)
    mesh, size = guess.mesh, max(equations.size(guess), 1e-12)
    best, best_orbit = np.inf, guess
    fresh, refreshed = condensed is None, int(condensed is None)
    condensed = condensed or equations.condense(guess)

    def correction(orbit: Orbit, defects: Array) -> tuple[Direction, float]:
        moved = equations.difference(orbit, guess)
        apart = moved if reference is guess else equations.difference(orbit, reference)
        along = row(moved.orbit, moved.period, moved.speed)
        values = [-phase(apart.orbit, 0.0, 0.0), target - along]
        assert condensed is not None
        raw = condensed.solve(defects, [phase, row], values)
        return raw, equations.norm(mesh, raw)

    orbit, defects = guess, equations.defects(guess)
    raw, norm = correction(orbit, defects)
    steps: list[Direction] = []
    for iteration in range(1, iterations + 1):
        equations.newton_steps += 1
        step = _broyden(raw, steps)
        length = _relative_size(step, size, orbit, equations)
        if not np.isfinite(length):
            break
        if length < best:
            best, best_orbit = length, orbit
        if length < tolerance:
            return Solution(equations.moved(orbit, step), condensed, iteration, refreshed, length)
        factor, ratio = 1.0, np.inf
        while True:
            trial = equations.moved(orbit, step, factor)
            try:
                if trial.period <= 0.0:
                    raise OrbitError("Newton's correction makes the period negative")
                new_defects = equations.defects(trial)
                new_raw, new_norm = correction(trial, new_defects)
                ratio = new_norm / max(norm, 1e-300)
            except OrbitError:
                if factor < SMALLEST_FACTOR:
                    raise
                ratio = np.inf
            if ratio < 1.0 - 0.25 * factor or (factor < SMALLEST_FACTOR and ratio < np.inf):
                break
            if not fresh and ratio < np.inf:
                break
            factor *= 0.5
        if ratio < 1.0 or fresh:
            orbit, defects, raw, norm = trial, new_defects, new_raw, new_norm
            steps = [*steps, step] if factor == 1.0 else []
            fresh = False
        if ratio > contraction:
            # Rounding of f sets a floor to the corrections.
            floor = (1e3 if refreshed else 1e2) * tolerance
            if refreshed >= refreshes or length < floor:
                break
            condensed = equations.condense(orbit)
            refreshed, fresh, steps = refreshed + 1, True, []
            raw, norm = correction(orbit, defects)
    if best < max(roughness, 1e3 * tolerance):
        return Solution(best_orbit, condensed, iteration, refreshed, best)
    raise OrbitError(
        f"Newton did not converge in {iteration} steps at {orbit.speed:.4f} m/s; the smallest "
        f"correction was {best:.2g} of the orbit"
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
    """Largest change, relative to the orbit's size; of means, to a hundredth of them if larger."""
    means = step.orbit.mean(axis=(0, 1))
    levels = np.maximum(size, 0.01 * np.abs(orbit.states[0]) / equations.scales)
    return max(
        float(np.abs(step.orbit - means).max()) / size,
        float((np.abs(means) / levels).max()),
        abs(step.period) * equations.period_unit / orbit.period,
        abs(step.speed) * equations.speed_unit / max(1.0, abs(orbit.speed)),
    )
