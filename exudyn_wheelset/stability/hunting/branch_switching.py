"""From one branch of limit cycles to the one that leaves it: lost symmetry and doubled periods.

Where a real multiplier of an orbit X0 passes 1 (other than at a fold) or -1, a second branch
leaves. Its direction is the eigenvector, carried along the orbit by the condensed equations,

    y(0) = e,   M e = mu e,      X = X0 + eps y,                                           (1)

once round for mu = 1; for mu = -1 twice round, with y(t + T) = -y(t), on the orbit taken twice. The
first orbit is corrected on the plane across y through (1), where X0 is not, and the branch is
followed from there. On a symmetric vehicle y has not the symmetry of X0: a motion that is its own
mirror image splits into two, each the other's mirror image, of which one is followed. (Doedel,
Keller, Kernevez, Int. J. Bif. Chaos 1 (1991) 745, section 4.)
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.records import describe
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.hunting.branch import Branch, StabilityChange
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.condensed import Condensed, Direction, Functional
from exudyn_wheelset.stability.hunting.continuation import follow
from exudyn_wheelset.stability.hunting.continuation_settings import ContinuationSettings
from exudyn_wheelset.stability.hunting.corrector import solve_orbit
from exudyn_wheelset.stability.hunting.folds import parts
from exudyn_wheelset.stability.hunting.limit_cycles import gather
from exudyn_wheelset.stability.hunting.orbit import Orbit, OrbitError
from exudyn_wheelset.stability.hunting.orbit_kernels import weighed
from exudyn_wheelset.stability.hunting.same_branch import lies_on
from exudyn_wheelset.stability.hunting.symmetry import mirror_of_orbit
from exudyn_wheelset.stability.subject import as_system
from exudyn_wheelset.systems.system import DynamicSystem

# Sizes of (1) tried, as shares of the orbit's size.
STEPS = (0.1, 0.05, 0.2, 0.02)
# The multiplier is brought this near to 1 or -1.
AT_CROSSING = 1e-3
# Length of a unit direction without its mean, below which the speed tells the way along a branch.
MEAN_ALONE = 0.1


@dataclass(frozen=True, eq=False)
class Crossing:
    """An orbit at which a multiplier passes 1 or -1, with its eigenvector (n,) in scales."""

    orbit: Orbit
    condensed: Condensed
    multiplier: float
    vector: Array


@spelt
def switch_branch(
    vehicle: Any,
    branch: Branch,
    change: StabilityChange,
    speeds: tuple[float, float] | None = None,
    *,
    settings: ContinuationSettings | None = None,
    **changes: Any,
) -> Branch:
    """The branch that leaves another one at a change of stability.

    vehicle: as for `limit_cycles`; change: one of `branch.changes`, a "branch point" or a "period
    doubling"; speeds (low, high) [m/s], default those of the branch; settings as for
    `limit_cycles`. The speed of `change` is that of the first branch; `record["leaves_at"]` says
    where the multiplier passes. Raises AnalysisError for a torus, and where no branch is found.

    >>> import numpy as np
    >>> from exudyn_wheelset import FunctionSystem, hopf_points, limit_cycles, switch_branch
    >>> def lure(x, alpha):
    ...     return np.array([x[1], x[2], -alpha * x[2] - x[1] - x[0] + x[0] ** 2])
    >>> system = FunctionSystem("Lur'e", lure, ("x", "v", "a"), (1.0, 1.0, 1.0))
    >>> branch = limit_cycles(system, hopf_points(system, 0.8, 1.3)[0], (0.6, 1.1))
    >>> double = switch_branch(system, branch, branch.changes[0])
    >>> round(double.record["leaves_at"], 3)
    0.63
    """
    system = as_system(vehicle)
    if change.kind == "torus":
        raise AnalysisError(
            f"at {change.speed:.4f} m/s a complex pair leaves the unit circle: motion beyond is no "
            "limit cycle; simulate it"
        )
    settings = replace(settings or ContinuationSettings(), **changes)
    low, high = speeds or (float(branch.speed.min()), float(branch.speed.max()))
    sign = 1.0 if change.kind == "branch point" else -1.0
    crossing = _crossing(system, branch, change.index, sign)
    equations = Collocation(system, crossing.orbit.period, high - low)
    orbit, direction = crossing.orbit, _carried(crossing, sign)
    if sign < 0.0:
        orbit = twice(orbit)
        direction = Direction(np.concatenate([direction.orbit, -direction.orbit]), 0.0, 0.0)
    # Means count here: a lost symmetry may show in them alone.
    direction = direction * (1.0 / _length(equations, orbit, direction))
    row = _covariance(equations, orbit, direction)
    size = equations.size(orbit)
    failure = "Newton's method came back to the branch"
    symmetric = sign > 0.0 and mirror_of_orbit(system, orbit) is not None
    for step in STEPS:
        guess = equations.moved(orbit, direction, step * size)
        try:
            first = solve_orbit(equations, guess, row, refreshes=10).orbit
        except OrbitError as error:
            failure = str(error)
            continue
        away = row(*parts(equations.difference(first, orbit)))
        if away < 0.5 * step * size or not 0.5 < equations.size(first) / size < 2.0:
            continue
        # Newton's method may find the branch itself, farther on.
        if (
            symmetric
            and mirror_of_orbit(system, first) is not None
            and lies_on(system, branch, first)
        ):
            continue
        points, outcome = follow(equations, first, direction, (low, high), settings)
        record = describe(system, "branch switching", {**settings.record(), "speeds": [low, high]})
        record |= {"leaves_at": float(orbit.speed), "because": change.kind}
        return gather(system, points, None, (None, outcome), settings, record)
    raise AnalysisError(
        f"{system.name}: no branch was found beside that at {orbit.speed:.4f} m/s: {failure}"
    )


def _covariance(equations: Collocation, orbit: Orbit, direction: Direction) -> Functional:
    """The scalar product with a direction over the phase, its mean included."""
    basis = equations.basis(orbit.degree)
    every = np.ones(len(equations.scales), dtype=bool)
    rows = weighed(direction.orbit, np.diff(orbit.mesh), basis.gram, basis.shares, every)
    return Functional(rows, 0.0, 0.0)


def _length(equations: Collocation, orbit: Orbit, direction: Direction) -> float:
    return float(np.sqrt(_covariance(equations, orbit, direction)(*parts(direction))))


def twice(orbit: Orbit) -> Orbit:
    """A whole orbit gone through twice."""
    mesh = np.concatenate([0.5 * orbit.mesh, 0.5 + 0.5 * orbit.mesh[1:]])
    states = np.concatenate([orbit.states, orbit.states[1:]])
    return Orbit(mesh, states, 2.0 * orbit.period, orbit.speed)


def _crossing(system: DynamicSystem, branch: Branch, index: int, sign: float) -> Crossing:
    """Between two points of a branch, by false position along the line through them."""
    after = branch.orbits[index].whole()
    before = branch.orbits[index - 1].whole().on_mesh(after.mesh)
    equations = Collocation(system, after.period, 1.0)
    way = equations.difference(after, before)
    length = equations.norm(after.mesh, way)
    row = equations.inner(after.mesh, way * (1.0 / length))

    def at(share: float) -> Crossing:
        guess = equations.moved(before, way, share)
        orbit = solve_orbit(equations, guess, row, roughness=1e-3).orbit
        condensed = equations.condense(orbit)
        return Crossing(orbit, condensed, *_nearest(equations, orbit, condensed, sign))

    ends, found = [0.0, 1.0], [at(0.0), at(1.0)]
    off = [crossing.multiplier - sign for crossing in found]
    for _ in range(12):
        best = int(np.argmin(np.abs(off)))
        if abs(off[best]) < AT_CROSSING or off[0] * off[1] > 0.0:
            break
        share = ends[0] + (ends[1] - ends[0]) * float(np.clip(off[0] / (off[0] - off[1]), 0.1, 0.9))
        new = at(share)
        side = 0 if (new.multiplier - sign) * off[0] > 0.0 else 1
        ends[side], found[side], off[side] = share, new, new.multiplier - sign
    return found[int(np.argmin(np.abs(off)))]


def _nearest(
    equations: Collocation, orbit: Orbit, condensed: Condensed, sign: float
) -> tuple[float, Array]:
    """The real multiplier nearest to 1 or -1 that is not the trivial one, and its vector."""
    values, vectors = np.linalg.eig(condensed.monodromy)
    motion = equations.system.derivative(orbit.states[0], orbit.speed) / equations.scales
    motion = motion / np.linalg.norm(motion)
    along = np.abs(np.linalg.solve(vectors, motion))
    trivial = int(np.argmax(np.where(np.abs(values - 1.0) < 0.5, along, 0.0)))
    apart = np.abs(values - sign) + 10.0 * np.abs(values.imag)
    apart[trivial] = np.inf
    place = int(np.argmin(apart))
    vector = vectors[:, place].real
    # Without the direction of motion, which shifts the phase alone.
    vector = vector - (vector @ motion) * motion
    return float(values[place].real), vector / np.linalg.norm(vector)


def _carried(crossing: Crossing, sign: float) -> Direction:
    """The eigenvector carried along its orbit, and closed: Newton's corrections keep a gap."""
    size = len(crossing.vector)
    carried = crossing.condensed.points[..., :size] @ crossing.vector
    gap = sign * crossing.vector - carried[-1, -1]
    mesh, degree = crossing.orbit.mesh, crossing.orbit.degree
    phases = mesh[:-1, None] + np.diff(mesh)[:, None] * np.arange(degree + 1) / degree
    return Direction(carried + phases[..., None] * gap, 0.0, 0.0)
