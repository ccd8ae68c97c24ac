"""Eigenvalues of a system over speed: computed once a speed, sorted into pairs and real roots.

Which roots count as unstable is decided here, with margins for the rounding of the differences.
Eigenvalues in 1/s, speeds in m/s.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.stability.linear.modes import is_lateral
from exudyn_wheelset.systems.system import DynamicSystem

# A pair counts as unstable above this fraction of its |eigenvalue|: undamped modes (a spring
# without damper) have a real part that is rounding of the differences, of either sign.
NEUTRAL_FRACTION = 1.0e-6
# A real root counts as unstable above this rate [1/s]: a coordinate that the equations leave free
# has a double zero root, which rounding moves by its square root.
NEUTRAL_RATE = 1.0e-3
# Pairs slower than this [Hz] are taken for real roots: they are split double zeros.
LOWEST_FREQUENCY = 1.0e-3

Kind = Literal["hopf", "divergence"]


class Spectra:
    """Eigenvalues over speed, computed once a speed; equilibria start from the nearest known."""

    def __init__(self, system: DynamicSystem) -> None:
        self.system = system
        self.evaluations = 0
        self._states: dict[float, Array] = {}
        self._values: dict[float, Array] = {}
        self._jacobians: dict[float, Array] = {}
        self._pairs: dict[float, tuple[Array, Array]] = {}
        self._start: tuple[float, Array] | None = None

    def start_from(self, speed: float, state: Array) -> None:
        self._start = (speed, state)

    def state(self, speed: float) -> Array:
        self.eigenvalues(speed)
        return self._states[speed]

    def eigenvalues(self, speed: float) -> Array:
        if speed not in self._values:
            known = self._start
            if self._states:
                nearest = min(self._states, key=lambda other: abs(other - speed))
                known = (nearest, self._states[nearest])
            guess = None if known is None else self.system.carry_over(known[1], known[0], speed)
            state = self.system.equilibrium(speed, guess)
            jacobian = self.system.jacobian(state, speed)
            check_finite(self.system, jacobian, speed)
            scales = self.system.scales
            values = np.linalg.eigvals(jacobian * scales[None, :] / scales[:, None])
            self.evaluations += 1
            self._states[speed] = state
            self._jacobians[speed] = jacobian
            self._values[speed] = values
        return self._values[speed]

    def excess(self, kind: Kind, speed: float) -> Array:
        """By how much each root of a kind exceeds the neutral margin, falling [1/s]."""
        values = self.eigenvalues(speed)
        if kind == "hopf":
            pairs = oscillatory_pairs(values)
            margins = pairs.real - NEUTRAL_FRACTION * np.abs(pairs)
        else:
            margins = real_roots(values) - NEUTRAL_RATE
        return np.sort(margins)[::-1]

    def unstable(self, kind: Kind, speed: float) -> int:
        return int(np.count_nonzero(self.excess(kind, speed) > 0.0))

    def pairs(self, speed: float) -> tuple[Array, Array]:
        """Oscillatory roots (k,) at a speed and their modes (n, k), the least damped first."""
        if speed not in self._pairs:
            self.eigenvalues(speed)
            scales = self.system.scales
            matrix = self._jacobians[speed] * scales[None, :] / scales[:, None]
            values, vectors = np.linalg.eig(matrix)
            rows = np.flatnonzero(oscillates(values))
            rows = rows[np.argsort(-values.real[rows], kind="stable")]
            self._pairs[speed] = values[rows], scales[:, None] * vectors[:, rows]
        return self._pairs[speed]

    def lateral_pairs(self, speed: float) -> Array:
        """Oscillatory roots (k,) whose modes are lateral, the least damped first."""
        values, modes = self.pairs(speed)
        return values[[is_lateral(self.system, mode) for mode in modes.T]]

    def lateral_excess(self, speed: float) -> float:
        """By how much the least damped lateral pair exceeds the neutral margin [1/s]."""
        values = self.lateral_pairs(speed)
        return float(np.max(values.real - NEUTRAL_FRACTION * np.abs(values), initial=-np.inf))

    def nearest(self, speed: float, eigenvalue: complex) -> complex:
        """The oscillatory root nearest to an eigenvalue."""
        pairs = oscillatory_pairs(self.eigenvalues(speed))
        if not len(pairs):
            raise AnalysisError(f"{self.system.name}: nothing oscillates at {speed:g} m/s")
        return complex(pairs[np.argmin(np.abs(pairs - eigenvalue))])


def oscillates(values: Array) -> Array:
    """Whether each root (n,) stands for an oscillatory pair: the one of positive frequency."""
    return values.imag > 2.0 * np.pi * LOWEST_FREQUENCY


def oscillatory_pairs(values: Array) -> Array:
    """One root of each oscillatory pair, the one with positive imaginary part."""
    return np.asarray(values[oscillates(values)])


def real_roots(values: Array) -> Array:
    """Real parts of the roots that do not oscillate."""
    return np.asarray(values.real[np.abs(values.imag) <= 2.0 * np.pi * LOWEST_FREQUENCY])


def check_finite(system: DynamicSystem, jacobian: Array, speed: float) -> None:
    """Raise AnalysisError if a Jacobian holds anything but numbers."""
    if not np.all(np.isfinite(jacobian)):
        raise AnalysisError(
            f"{system.name}: the Jacobian at the equilibrium at {speed:g} m/s is not finite; a "
            "difference step leaves the range of the model: check the scales"
        )
