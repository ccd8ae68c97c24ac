"""An Exudyn model with joints in independent coordinates.

Second-order coordinates q with the generalised velocities v (angular velocities of rigid bodies in
body axes), the joints g(q) = 0 and their Jacobian G(q), g' = G v:

    M a + G^T mu = F(q, v),   G a = -gamma,   gamma = (dG/dt) v                             (1)

In a state X, whose angles are yaw, roll and pitch, v = E(X) X_pos' (see reduction), so that the
positions change the joints by H = G E. At the model's drawn place, columns of H and of G are chosen
that stand for all the others (pivoted QR decomposition): as many dependent positions and velocities
as there are joints that do not repeat each other; the rest is independent, and keeps its names. A
state x has the independent ones only, coordinates of the null space of G at that place. What
depends on them follows by Newton's method on g = 0 with the independent positions held, and by
G v = 0, so that x holds far from that place too. Eigenvalues do not know which ones were chosen.

Accelerations by (1), with the mass matrix M inverted once: mu = (G M^-1 G^T)^-1 (G M^-1 F + gamma),
a = M^-1 (F - G^T mu). gamma is the difference of G v along the motion, which turns spinning bodies.

Wheelsets' coordinates are taken for dependent ones last, so that their lateral shift and yaw stay
states. Joints must not depend on time, nor on velocities alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import exudyn as exu
import numpy as np
from scipy.linalg import qr

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.systems.exudyn_layout import Layout
from exudyn_wheelset.systems.exudyn_running import Runner
from exudyn_wheelset.systems.reduction import CYCLIC, rate_of_state

# A column this much shorter than the longest one holds nothing (metres and radians alike).
_RANK = 1.0e-9
# Coordinates of wheelsets count so much less when dependent ones are chosen.
_WHEELSETS_LAST = 1.0e-4
_NEWTON_STEPS = 30
# Of joints [m, rad]: closed.
_CLOSED = 1.0e-13
_NEARLY_CLOSED = 1.0e-9
# More is no rounding and no initial displacement [m, rad].
_OPEN = 0.05
# Displacement [m, rad] along the motion for the change of G.
_ALONG = 1.0e-5


class JointedLayout:
    """Layout of the states of a model with joints: the independent ones of its whole layout.

    The interface is that of Layout; `whole` has all coordinates.
    """

    def __init__(self, whole: Layout, joints: Joints) -> None:
        self.whole = whole
        self.joints = joints
        self._kept = np.array(
            [
                *joints.free_positions,
                *(whole.positions + joints.free_velocities),
                *range(whole.positions + len(whole.position_of), len(whole.names)),
            ],
            dtype=int,
        )
        self.positions = len(joints.free_positions)
        self.names = tuple(whole.names[k] for k in self._kept)
        self.scales = tuple(whole.scales[k] for k in self._kept)
        self.wheelsets = whole.wheelsets
        place = {int(k): n for n, k in enumerate(joints.free_velocities)}
        self.steady_velocities = tuple(
            (place[index], ratio) for index, ratio in whole.steady_velocities if index in place
        )
        self._place = {int(k): n for n, k in enumerate(joints.free_positions)}

    def wheelset_states(self, indices: Sequence[int]) -> tuple[int, int, int, int]:
        """States of y, z, yaw and roll of a spinning body; CYCLIC where they depend on others."""
        places = self.whole.wheelset_states(indices)
        y, z, yaw, roll = (self._place.get(place, CYCLIC) for place in places)
        return y, z, yaw, roll

    def complete(self, state: Array) -> tuple[Array, Array]:
        """The whole state of an independent one, its joints closed, and their Jacobian there."""
        return self.joints.complete(np.asarray(state, dtype=float), self._kept)

    def expand(self, state: Array) -> tuple[Array, Array, Array]:
        """Coordinates, velocities (nq,), (nq,) and first-order ones (n1,) of a state (n,)."""
        return self.whole.expand(self.complete(state)[0])

    def reduce(self, coordinates: Array, velocities: Array, first_order: Array) -> Array:
        """States (m, n) of m coordinates, velocities (m, nq) and first-order ones (m, n1)."""
        return self.whole.reduce(coordinates, velocities, first_order)[:, self._kept]

    def rate(self, whole_state: Array, accelerations: Array) -> Array:
        """Rate (n,) of a state from accelerations (nq + n1) at its whole state."""
        rate = np.zeros(len(self.whole.names))
        rate_of_state(
            whole_state, accelerations, self.whole.position_of, self.whole.rotations, rate
        )
        return rate[self._kept]


class Joints:
    """The algebraic equations of an assembled model, solved for what depends on the rest.

    solver: Exudyn's, initialised; start: whole state of the model's initial values. Raises
    AnalysisError, which begins with `name`, for joints that are open there, and for a model that
    its joints hold altogether.
    """

    def __init__(
        self, name: str, mbs: Any, solver: Any, whole: Layout, start: Array, wheelsets: set[int]
    ) -> None:
        self._name, self._mbs, self._solver, self._whole = name, mbs, solver, whole
        self._data = mbs.systemData
        self._order = len(whole.position_of)
        self._first = len(whole.names) - whole.positions
        self._count = int(solver.GetAEsize())
        self._rows = np.arange(self._count)
        self._before = np.array(solver.GetSystemJacobian())[self._first :, : self._order]
        # Without reactions in Exudyn's own right-hand side.
        self._data.SetAECoordinates(np.zeros(self._count))
        self._start = start.copy()
        coordinates = whole.expand(start)[0]
        jacobian = self._jacobian(coordinates)
        # Exudyn has an equation for each free axis of a joint too, and joints may repeat others.
        self._rows = _spanning(jacobian.T, np.ones(self._count), self._count)
        jacobian = jacobian[self._rows]
        open_by = float(np.abs(self._residual(coordinates)).max(initial=0.0))
        if open_by > _OPEN:
            raise AnalysisError(
                f"{name}: the joints are open by {open_by:.3g} m or rad in the model's initial "
                "values: put the bodies where their joints close"
            )
        held = jacobian @ self._tangent(start)
        rank = len(self._rows)
        places = np.arange(whole.positions)
        wanted = np.where(np.isin(places, list(wheelsets)), _WHEELSETS_LAST, 1.0)
        self.bound_positions = _spanning(held, wanted, rank)
        spinning = list(self._spinning())
        wanted = np.where(np.isin(np.arange(self._order), spinning), _WHEELSETS_LAST, 1.0)
        self.bound_velocities = _spanning(jacobian, wanted, rank)
        if len(self.bound_positions) < rank or len(self.bound_velocities) < rank:
            raise AnalysisError(
                f"{name}: joints that hold cyclic coordinates: leave them out of `cyclic`"
            )
        self.free_positions = np.setdiff1d(np.arange(whole.positions), self.bound_positions)
        self.free_velocities = np.setdiff1d(np.arange(self._order), self.bound_velocities)
        if not len(self.free_velocities):
            raise AnalysisError(f"{name}: its joints leave the model nothing to move")
        self._slope = -np.linalg.solve(held[:, self.bound_positions], held[:, self.free_positions])

    def complete(self, state: Array, kept: Array) -> tuple[Array, Array]:
        """The whole state whose entries `kept` are those of `state`, and G (m, nq) there."""
        whole = self._start.copy()
        whole[kept] = state
        bound, free = self.bound_positions, self.free_positions
        whole[bound] += self._slope @ (whole[free] - self._start[free])
        before = np.inf
        for _ in range(_NEWTON_STEPS):
            coordinates = self._whole.expand(whole)[0]
            residual = self._residual(coordinates)
            size = float(np.abs(residual).max())
            jacobian = self._jacobian(coordinates)
            if size < _CLOSED or (size < _NEARLY_CLOSED and size > 0.5 * before):
                break
            before = size
            held = (jacobian @ self._tangent(whole))[:, bound]
            step = np.linalg.lstsq(held, residual, rcond=None)[0]
            if not np.all(np.isfinite(step)):
                size = np.inf
                break
            whole[bound] -= step
        if not size < _NEARLY_CLOSED:
            raise AnalysisError(
                f"{self._name}: the joints cannot be closed ({size:.3g} m or rad stay open): the "
                "state lies beyond what they allow"
            )
        velocities = whole[self._whole.positions : self._whole.positions + self._order]
        moving = jacobian[:, self.free_velocities] @ velocities[self.free_velocities]
        velocities[self.bound_velocities] = -np.linalg.solve(
            jacobian[:, self.bound_velocities], moving
        )
        return whole, jacobian

    def bend(self, coordinates: Array, velocities: Array) -> Array:
        """gamma (m,) = (dG/dt) v; leaves Exudyn a little beside the coordinates."""
        along = _ALONG / max(float(np.abs(velocities).max()), 1e-3)
        ahead = self._jacobian(self._moved(coordinates, velocities, along)) @ velocities
        behind = self._jacobian(self._moved(coordinates, velocities, -along)) @ velocities
        return (ahead - behind) / (2.0 * along)

    @staticmethod
    def accelerations(jacobian: Array, bent: Array, force: Array, inverse_mass: Array) -> Array:
        """Accelerations (nq,) under forces (nq,): equations (1)."""
        yielding = inverse_mass @ jacobian.T
        free = inverse_mass @ force
        reactions = np.linalg.solve(jacobian @ yielding, jacobian @ free + bent)
        return free - yielding @ reactions

    def _residual(self, coordinates: Array) -> Array:
        self._data.SetODE2Coordinates(coordinates)
        self._solver.ComputeAlgebraicEquations(self._mbs, False)
        return np.array(self._solver.GetSystemResidual())[self._first :][self._rows]

    def _jacobian(self, coordinates: Array) -> Array:
        """G (m, nq) at coordinates (nq,)."""
        solver = self._solver
        self._data.SetODE2Coordinates(coordinates)
        # Exudyn adds to what is there.
        solver.ComputeJacobianAE(self._mbs, 1.0, 0.0, 1.0, False)
        added = solver.GetSystemJacobian()[self._first :, : self._order] - self._before
        solver.ComputeJacobianAE(self._mbs, -1.0, 0.0, 1.0, False)
        return added[self._rows]

    def _spinning(self) -> set[int]:
        """Velocities of spinning bodies."""
        return {
            int(first) + k
            for first, _, spins in self._whole.rotations
            if spins
            for k in range(-3, 3)
        }

    def _tangent(self, whole: Array) -> Array:
        """E (nq, positions): generalised velocities of the rates of positions."""
        layout = self._whole
        matrix = np.zeros((self._order, layout.positions))
        for index, place in enumerate(layout.position_of.tolist()):
            if place >= 0:
                matrix[index, place] = 1.0
        for first, yaw, spins in layout.rotations.tolist():
            roll = whole[yaw + 1]
            rates = np.zeros((3, 2 if spins else 3))
            rates[:, 0] = 0.0, np.sin(roll), np.cos(roll)
            rates[:, 1] = 1.0, 0.0, 0.0
            if not spins:
                rates[:, 2] = 0.0, 1.0, 0.0
                c, s = np.cos(whole[yaw + 2]), np.sin(whole[yaw + 2])
                rates = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]) @ rates
            matrix[first : first + 3, yaw : yaw + rates.shape[1]] = rates
        return matrix

    def _moved(self, coordinates: Array, velocities: Array, time: float) -> Array:
        """Coordinates after a short time [s] of the motion."""
        moved = coordinates + time * velocities
        turn_bodies(
            coordinates, velocities, time, self._whole.rotations, self._whole.reference, moved
        )
        return moved


@compiled
def turn_bodies(
    coordinates: Array,
    velocities: Array,
    time: float,
    rotations: Array,
    reference: Array,
    moved: Array,
) -> None:
    """Put rotation vectors that angular velocities in body axes reach in a time [s] into `moved`.

    Unit quaternions: that of the body times that of the small turn.
    """
    for k in range(rotations.shape[0]):
        start = rotations[k, 0]
        a1 = coordinates[start] + reference[k, 0]
        a2 = coordinates[start + 1] + reference[k, 1]
        a3 = coordinates[start + 2] + reference[k, 2]
        angle = math.sqrt(a1 * a1 + a2 * a2 + a3 * a3)
        factor = math.sin(0.5 * angle) / angle if angle > 1e-12 else 0.5
        a0, a1, a2, a3 = math.cos(0.5 * angle), factor * a1, factor * a2, factor * a3
        b1 = time * velocities[start]
        b2 = time * velocities[start + 1]
        b3 = time * velocities[start + 2]
        angle = math.sqrt(b1 * b1 + b2 * b2 + b3 * b3)
        factor = math.sin(0.5 * angle) / angle if angle > 1e-12 else 0.5
        b0, b1, b2, b3 = math.cos(0.5 * angle), factor * b1, factor * b2, factor * b3
        c0 = a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3
        c1 = a0 * b1 + b0 * a1 + a2 * b3 - a3 * b2
        c2 = a0 * b2 + b0 * a2 + a3 * b1 - a1 * b3
        c3 = a0 * b3 + b0 * a3 + a1 * b2 - a2 * b1
        sine = math.sqrt(c1 * c1 + c2 * c2 + c3 * c3)
        factor = 2.0 * math.atan2(sine, c0) / sine if sine > 1e-12 else 2.0
        moved[start] = factor * c1 - reference[k, 0]
        moved[start + 1] = factor * c2 - reference[k, 1]
        moved[start + 2] = factor * c3 - reference[k, 2]


def _spanning(matrix: Array, wanted: Array, most: int) -> Array:
    """Columns, in rising order, that span those of a matrix; the more wanted ones first."""
    if not matrix.size:
        return np.zeros(0, dtype=int)
    triangle, order = qr(matrix * wanted, mode="r", pivoting=True)[:2]
    size = np.abs(np.diag(triangle))
    lengths = wanted[order[: len(size)]]
    rank = int(np.sum(size > _RANK * np.abs(matrix).max() * np.minimum(lengths, 1.0)))
    return np.sort(order[: min(rank, most)])


def jointed_layout(
    name: str, mbs: Any, solver: Any, whole: Layout, wheelset_nodes: Sequence[int]
) -> JointedLayout:
    """Layout of the independent states of an assembled model with joints; see the header."""
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    kinds = [mbs.GetNode(node)["nodeType"] for node in range(data.NumberOfNodes())]
    if any("EP" in kind for kind in kinds):
        raise AnalysisError(
            f"{name}: nodes with Euler parameters have algebraic equations of their own, which "
            "this analysis does not treat: use NodeType.RotationRotationVector"
        )
    start = whole.reduce(
        *(
            np.atleast_2d(values)
            for values in (
                data.GetODE2Coordinates(initial),
                data.GetODE2Coordinates_t(initial),
                data.GetODE1Coordinates(initial),
            )
        )
    )[0]
    places = [whole.wheelset_states(list(data.GetNodeLTGODE2(node))) for node in wheelset_nodes]
    positions = {place for four in places for place in four if place >= 0}
    return JointedLayout(whole, Joints(name, mbs, solver, whole, start, positions))


def follow_joints(runner: Runner, name: str, choose: bool) -> None:
    """Let a runner solve algebraic equations: generalised alpha, if it may `choose`.

    Raises AnalysisError for an explicit solver, which cannot.
    """
    if choose:
        runner.solver_type = exu.DynamicSolverType.GeneralizedAlpha
        # Forces of wheels on rails are loads.
        runner.settings.timeIntegration.computeLoadsJacobian = 2
    elif runner.solver_type not in (
        exu.DynamicSolverType.GeneralizedAlpha,
        exu.DynamicSolverType.TrapezoidalIndex2,
    ):
        kind = str(runner.solver_type).split(".")[-1]
        raise AnalysisError(
            f"{name}: the model has joints, algebraic equations that {kind} does not solve: leave "
            "solver_type out, or give GeneralizedAlpha or TrapezoidalIndex2"
        )
