"""Periodic orbits by orthogonal collocation: one hunting cycle as a boundary value problem.

An orbit of x' = f(x; V) with period T is x(s T) for the phase s in [0, 1]:

    dx/ds = T f(x; V),   x(1) = x(0),   integral <x - x_ref, dx_ref/ds> ds = 0      (1)

The last equation fixes the phase. On each of N mesh intervals x is a polynomial of degree m that
satisfies (1) at m nodes; it is held by its values at m + 1 equidistant points. The nodes are Gauss
points: the error falls with h^(m+1) along the orbit and with h^(2m) at mesh points, in period and
in speed (de Boor and Swartz, SIAM J. Numer. Anal. 10 (1973) 582) as long as f is smooth.

Wheels bounce on the stiffness of their contact at 200 Hz and more, nearly undamped, while the
vehicle hunts at a few Hz. Gauss points carry such an oscillation on from interval to interval,
undamped and unresolved. For a `stiff` system the nodes are Radau's, the end of the interval among
them (order h^(2m-1) at mesh points; Hairer and Wanner, Solving Ordinary Differential Equations
II, section IV.5): they damp what the mesh does not resolve, so that the wheels follow the rails.

Newton's correction is condensed interval by interval (Doedel, Keller, Kernevez, Int. J. Bif.
Chaos 1 (1991) 745): the interior values are eliminated, so that every point of the orbit becomes
a linear function of q = (x(0), T, V), and a system of order n + 2 remains. The map of x(0) to
x(1) so obtained is the monodromy matrix; its eigenvalues are the Floquet multipliers.

Inside, states are measured in `system.scales`; orbits outside are in SI units and radians, the
period in s, the speed in m/s.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.stability.hunting.condensed import (
    Condensed,
    Direction,
    Functional,
    Gradients,
)
from exudyn_wheelset.stability.hunting.floquet import Multipliers, floquet_multipliers
from exudyn_wheelset.stability.hunting.orbit import Basis, Orbit, OrbitError, basis_of, windows_of
from exudyn_wheelset.stability.hunting.orbit_kernels import at_nodes, condense_intervals, weighed
from exudyn_wheelset.systems.system import DIFFERENCE_STEP, DynamicSystem

# One-sided difference step in scales, ten nanometres for a wheelset: above what a contact search
# resolves, below what bends the slope of a smooth f. Defects are exact, so orbits and folds do not
# move with it.
FORWARD_STEP = 1e-5


class Collocation:
    """The collocation equations of a system, with a count of what they cost.

    period_unit and speed_unit measure the changes of T and V; mirror is that of the orbits. A
    system without Jacobians of its own is differentiated by n one-sided differences a point, f
    being known there. `evaluations` counts right-hand sides, those of differences included,
    `jacobians` Jacobian matrices of f, `newton_steps` the corrector's steps.
    """

    def __init__(
        self,
        system: DynamicSystem,
        period_unit: float,
        speed_unit: float,
        mirror: Array | None = None,
    ) -> None:
        self.system = system
        self.mirror = mirror
        # What changes sign in the other half has no mean.
        self._odd = np.zeros(system.size, dtype=bool) if mirror is None else mirror < 0.0
        self.scales = np.asarray(system.scales, dtype=float)
        self.period_unit = float(period_unit)
        self.speed_unit = float(speed_unit)
        self.evaluations = 0
        self.jacobians = 0
        self.newton_steps = 0
        kind = type(system)
        self._differences = (
            kind.jacobian is DynamicSystem.jacobian and kind.jacobians is DynamicSystem.jacobians
        )

    def basis(self, degree: int) -> Basis:
        """The polynomials of an interval at the nodes that suit the system."""
        return basis_of(degree, self.system.stiff)

    def windows(self, orbit: Orbit) -> Array:
        """States of each interval (N, m + 1, n) in scales."""
        return windows_of(orbit.states / self.scales, orbit.degree)

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
        """The scalar product with a direction: covariance over the phase plus period and speed.

        Means are left out: the spin of a wheelset follows the speed by 1/radius, and would make
        the length of a direction a measure of the speed alone, which turns back at a fold.
        """
        degree = direction.orbit.shape[1] - 1
        basis = self.basis(degree)
        weights = weighed(
            np.ascontiguousarray(direction.orbit),
            np.diff(mesh),
            basis.gram,
            basis.shares,
            self._odd,
        )
        return Functional(weights, direction.period, direction.speed)

    def norm(self, mesh: Array, direction: Direction) -> float:
        """Length of a direction in the scalar product `inner`."""
        form = self.inner(mesh, direction)
        square = form(direction.orbit, direction.period, direction.speed)
        return float(np.sqrt(max(square, 0.0)))

    def size(self, orbit: Orbit) -> float:
        """Distance of the orbit from its mean, in scales (root mean square over the phase)."""
        return self.norm(orbit.mesh, Direction(self.windows(orbit), 0.0, 0.0))

    def phase(self, orbit: Orbit) -> Functional:
        """The form <., dx_ref/ds> of the phase condition about the orbit as reference."""
        basis = self.basis(orbit.degree)
        slopes = at_nodes(orbit.states / self.scales, basis.slopes)
        row = np.matmul(basis.values.T * basis.weights, slopes)
        return Functional(row / max(float(np.linalg.norm(row)), 1e-300), 0.0, 0.0)

    def defects(self, orbit: Orbit) -> Array:
        """What (1) lacks at the nodes (N, m, n), times the interval's width, in scales.

        Raises OrbitError with contact_lost if f is not finite somewhere on the orbit.
        """
        rates = self._rates(self.node_states(orbit), orbit.speed)
        basis = self.basis(orbit.degree)
        slopes = at_nodes(orbit.states / self.scales, basis.slopes)
        widths = np.diff(orbit.mesh)[:, None, None]
        return np.asarray(slopes - widths * orbit.duration * rates.reshape(slopes.shape))

    def condense(self, orbit: Orbit) -> Condensed:
        """Newton's equations at the orbit: one Jacobian of f at every node."""
        return self.assemble(orbit, self.gradients(orbit))

    def gradients(self, orbit: Orbit) -> Gradients:
        """f and its derivatives at the nodes of an orbit; raises OrbitError."""
        states = self.node_states(orbit)
        rates = self._rates(states, orbit.speed)
        if self._differences:
            by_state = self._forward_differences(states, orbit.speed, rates)
        else:
            by_state = self._jacobians(states, orbit.speed)
        by_speed = self._along_speed(states, orbit.speed, rates, by_state)
        basis = self.basis(orbit.degree)
        phases = orbit.mesh[:-1, None] + np.diff(orbit.mesh)[:, None] * basis.nodes
        return Gradients(phases.ravel(), rates, by_state, by_speed)

    def _along_speed(self, states: Array, speed: float, rates: Array, by_state: Array) -> Array:
        """df/dV at states (k, n), consistent with their Jacobians.

        Speed and the spin of a wheelset shift the creepage by thousands of times what a joint
        change of both does, and it is the joint change that an orbit follows. So the difference is
        taken along with the states that the speed carries over, and their part by the Jacobians
        is subtracted: Newton's equations are then exact along the joint change.
        """
        step = DIFFERENCE_STEP * max(1.0, abs(speed))
        carry = self.system.carry_over
        ahead = np.array([carry(state, speed, speed + step) for state in states])
        change = self._rates(ahead, speed + step) - rates
        carried = (ahead - states) / self.scales
        return np.asarray((change - np.einsum("kij,kj->ki", by_state, carried)) / step)

    def assemble(self, orbit: Orbit, gradients: Gradients) -> Condensed:
        """Newton's equations from gradients given at the nodes of the orbit.

        Raises OrbitError if an interval's equations are singular.
        """
        basis = self.basis(orbit.degree)
        intervals, degree, size = len(orbit.mesh) - 1, orbit.degree, len(self.scales)
        share = orbit.duration / orbit.period * self.period_unit
        inverse = np.empty((intervals, degree * size, degree * size))
        propagation = np.empty((intervals, degree * size, size))
        points = np.empty((intervals, degree + 1, size, size + 2))
        try:
            condense_intervals(
                np.ascontiguousarray(gradients.by_state),
                gradients.rates * share,
                gradients.by_speed * (orbit.duration * self.speed_unit),
                np.diff(orbit.mesh),
                float(orbit.duration),
                basis.values,
                basis.slopes,
                inverse,
                propagation,
                points,
            )
        except (np.linalg.LinAlgError, ValueError) as error:
            raise OrbitError("an interval of the orbit is too long for its equations") from error
        closure = np.ones(size) if orbit.mirror is None else np.asarray(orbit.mirror)
        return Condensed(inverse, propagation, points, closure, gradients)

    def multipliers(self, orbit: Orbit, condensed: Condensed) -> Multipliers:
        """Floquet multipliers of the orbit without the trivial one (see `floquet`)."""
        rate = self._rates(orbit.states[:1], orbit.speed)[0]
        return floquet_multipliers(condensed.monodromy, rate, self.system)

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
        return np.asarray(jacobians * (self.scales[None, None, :] / self.scales[None, :, None]))

    def _forward_differences(self, states: Array, speed: float, rates: Array) -> Array:
        self.jacobians += len(states)
        result = np.empty((*rates.shape, len(self.scales)))
        for column, scale in enumerate(self.scales):
            shifted = states.copy()
            shifted[:, column] += FORWARD_STEP * scale
            result[:, :, column] = (self._rates(shifted, speed) - rates) / FORWARD_STEP
        return result

    def node_states(self, orbit: Orbit) -> Array:
        """States (N m, n) at the nodes of an orbit, SI units."""
        values: Array = at_nodes(
            np.ascontiguousarray(orbit.states), self.basis(orbit.degree).values
        )
        return values.reshape(-1, values.shape[2])

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
        return np.asarray(rates)
