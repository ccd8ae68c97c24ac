"""The equations about a steady run: equilibrium, Jacobian, eigenvalues and modes at a speed.

About the equilibrium x0(V) of x' = f(x; V) the motion is a sum of v exp(lambda t), lambda the
eigenvalues and v the eigenvectors (modes) of the Jacobian of f. What a mode is, hunting, sway,
bounce, is read from what moves in it (see `modes`).

Speeds in m/s, eigenvalues in 1/s, frequencies in Hz.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import finite_array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.linear.law_checks import LawCheck, check_law, warn_of_law
from exudyn_wheelset.stability.linear.modes import (
    HUNTING_SHARE,
    hunting_share,
    is_lateral,
    mode_name,
)
from exudyn_wheelset.stability.linear.neutral import neutral_name, separated
from exudyn_wheelset.stability.linear.spectra import Spectra, check_finite, oscillates
from exudyn_wheelset.stability.subject import as_system
from exudyn_wheelset.systems.speeds import checked_speed
from exudyn_wheelset.systems.system import DynamicSystem


@brief
@dataclass(frozen=True, eq=False)
class Linearisation:
    """Equations linearised about the equilibrium at one speed.

    speed           [m/s]
    state           equilibrium (n,)
    jacobian        (n, n)
    eigenvalues     (n,) [1/s], by falling real part
    eigenvectors    (n, n), columns in the order of the eigenvalues, over the system's states
    hunting_shares  (n,) share of the wheelsets' lateral and yaw motion in each mode, 0 to 1
    system          what was linearised
    law             what was measured of the creep law along the least damped hunting mode; None
                    where nothing hunts or it was not asked for
    """

    speed: float
    state: Array
    jacobian: Array
    eigenvalues: Array
    eigenvectors: Array
    hunting_shares: Array
    system: DynamicSystem = field(repr=False)
    law: LawCheck | None = None

    @property
    def growth_rate(self) -> float:
        """Real part [1/s] of the least damped hunting mode; -inf if none hunts.

        Hunting modes are those in which the wheelsets move sideways and yaw (see `modes`).
        """
        row = self.hunting_row
        return -np.inf if row is None else float(self.eigenvalues.real[row])

    @property
    def hunting_row(self) -> int | None:
        """Place of the least damped hunting mode among the eigenvalues; None if none hunts."""
        rows = np.flatnonzero(oscillates(self.eigenvalues) & (self.hunting_shares > HUNTING_SHARE))
        return int(rows[0]) if len(rows) else None

    @property
    def hunting_damping(self) -> float | None:
        """Damping ratio -Re/abs of the least damped hunting mode; None if none hunts."""
        row = self.hunting_row
        if row is None:
            return None
        root = self.eigenvalues[row]
        return float(-root.real / abs(root))

    def oscillations(
        self, lowest: float = 0.05, highest: float = 15.0
    ) -> list[tuple[str, complex]]:
        """Name and root [1/s] of the modes between two frequencies [Hz], least damped first."""
        frequencies = self.eigenvalues.imag / (2.0 * np.pi)
        return [
            (name, complex(root))
            for name, root, frequency in zip(
                self.mode_names, self.eigenvalues, frequencies, strict=True
            )
            if lowest < frequency < highest
        ]

    @property
    def mode_names(self) -> tuple[str, ...]:
        """Name of each mode (n) by what moves in it."""
        frequencies = np.abs(self.eigenvalues.imag) / (2.0 * np.pi)
        return tuple(
            neutral_name(self.system, value, mode) or mode_name(self.system, mode, frequency)
            for value, mode, frequency in zip(
                self.eigenvalues, self.eigenvectors.T, frequencies, strict=True
            )
        )


@brief
@dataclass(frozen=True, eq=False)
class RootLocus:
    """Eigenvalues over speed, each column one root followed by nearness.

    speeds (m,) [m/s], eigenvalues (m, n) [1/s], states (m, n) the equilibria
    """

    speeds: Array
    eigenvalues: Array
    states: Array


@spelt
def linearise(vehicle: Any, speed: float, guess: Array | None = None) -> Linearisation:
    """Eigenvalues and eigenvectors about the equilibrium at a forward speed [m/s].

    `guess` is a state (n,) near the equilibrium. Warns (WheelsetWarning) where the creep law is not
    linear there or has another slope than the exact law (see `law_checks`); `law` of the result
    has the numbers. Raises AnalysisError if there is no equilibrium.

    Examples
    --------
    >>> from exudyn_wheelset import linearise
    >>> linear = linearise("cooperrider", 60.0)
    >>> bool(linear.eigenvalues.real.max() < 0.0)  # stable
    True
    """
    system = as_system(vehicle)
    speed = checked_speed(system, "speed", speed)
    if guess is not None:
        guess = _checked_state(system, guess)
    linear = linearised(system, speed, guess)
    row = linear.hunting_row
    if row is None:
        return linear
    mode = linear.eigenvectors[:, row]
    law = check_law(system, linear.state, linear.speed, mode, linear.jacobian)
    warn_of_law(system.name, [(linear.speed, law)])
    return replace(linear, law=law)


def _checked_state(system: DynamicSystem, state: Any) -> Array:
    found = finite_array("guess", state, "SI units")
    if found.shape != (system.size,):
        raise AnalysisError(
            f"guess of the shape {found.shape}: give the {system.size} states of {system.name}"
        )
    return found


def linearised(system: DynamicSystem, speed: float, guess: Array | None = None) -> Linearisation:
    """`linearise` without the measurements of the creep law, for steps of an analysis."""
    state = system.equilibrium(speed, guess)
    jacobian = system.jacobian(state, speed)
    check_finite(system, jacobian, speed)
    # Eigenvectors in scaled states are better conditioned than in metres beside radians/second.
    scales = system.scales
    values, vectors = np.linalg.eig(jacobian * scales[None, :] / scales[:, None])
    order = np.argsort(-values.real, kind="stable")
    modes = separated(system, values[order], (scales[:, None] * vectors)[:, order])
    return Linearisation(
        speed=float(speed),
        state=state,
        jacobian=jacobian,
        eigenvalues=values[order],
        eigenvectors=modes,
        hunting_shares=np.array([hunting_share(system, mode) for mode in modes.T]),
        system=system,
    )


def hunting_mode(linear: Linearisation) -> tuple[complex, Array]:
    """Eigenvalue [1/s] and mode (n,) of the least damped hunting.

    Where no mode hunts, those of the least damped oscillation, lateral if there is one. Raises
    AnalysisError if nothing oscillates.
    """
    row = linear.hunting_row
    if row is None:
        rows = np.flatnonzero(oscillates(linear.eigenvalues))
        if not len(rows):
            raise AnalysisError(
                f"{linear.system.name} does not oscillate about its equilibrium at "
                f"{linear.speed:g} m/s; give a state to start from, or the period of the motion"
            )
        modes = linear.eigenvectors.T[rows]
        lateral = [
            row for row, mode in zip(rows, modes, strict=True) if is_lateral(linear.system, mode)
        ]
        row = int(lateral[0] if lateral else rows[0])
    return complex(linear.eigenvalues[row]), linear.eigenvectors[:, row]


@spelt
def root_locus(vehicle: Any, speeds: Sequence[float] | Array) -> RootLocus:
    """Eigenvalues at `speeds` (m,) [m/s], each root followed from speed to speed.

    A root goes to the one nearest to its linear extrapolation. Raises AnalysisError.

    Examples
    --------
    >>> from exudyn_wheelset import root_locus
    >>> locus = root_locus("cooperrider", [60.0, 75.0])
    >>> locus.speeds
    array([60., 75.])
    """
    spectra = Spectra(as_system(vehicle))
    given = list(speeds) if isinstance(speeds, Iterable) else [speeds]
    system = spectra.system
    speeds = np.array([checked_speed(system, "one of speeds", one) for one in given])
    if not len(speeds):
        raise AnalysisError("speeds = []: give one speed [m/s] or more")
    rows: list[Array] = []
    for index, speed in enumerate(speeds):
        values = spectra.eigenvalues(speed)
        if not rows:
            rows.append(values)
            continue
        expected = rows[-1]
        if index > 1:
            ratio = (speed - speeds[index - 1]) / (speeds[index - 1] - speeds[index - 2])
            expected = rows[-1] + ratio * (rows[-1] - rows[-2])
        _, order = linear_sum_assignment(np.abs(expected[:, None] - values[None, :]))
        rows.append(values[order])
    return RootLocus(
        speeds=speeds,
        eigenvalues=np.array(rows),
        states=np.array([spectra.state(speed) for speed in speeds]),
    )
