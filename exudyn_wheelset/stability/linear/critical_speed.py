"""Linear stability of a steady run: eigenvalues over speed and the speeds where they cross zero.

About the equilibrium x0(V) the motion is a sum of exp(lambda t), lambda the eigenvalues of the
Jacobian of f(x; V). Where a complex pair crosses the imaginary axis the system hunts with the
frequency of the pair (Hopf bifurcation); where a bare real root crosses it diverges. A crossing
is bracketed by the number of unstable roots at two speeds: the real parts sorted by size are
continuous functions of speed even where two modes change places, so a bracketed root of the k-th
of them is the crossing, and no mode has to be followed by its shape.

Speeds in m/s, eigenvalues in 1/s, frequencies in Hz.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from scipy.optimize import brentq, linear_sum_assignment

from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.stability.linear.spectra import (
    NEUTRAL_FRACTION,
    NEUTRAL_RATE,
    Kind,
    Spectra,
    check_finite,
    oscillatory_pairs,
    real_roots,
)
from exudyn_wheelset.systems.system import Array, as_system


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Equations linearised about the equilibrium at one speed.

    speed         [m/s]
    state         equilibrium (n,)
    jacobian      (n, n)
    eigenvalues   (n,) [1/s], by falling real part
    eigenvectors  (n, n), columns in the order of the eigenvalues, over the system's states
    """

    speed: float
    state: Array
    jacobian: Array
    eigenvalues: Array
    eigenvectors: Array

    @property
    def growth_rate(self) -> float:
        """Real part [1/s] of the least damped oscillatory pair; -inf if none oscillates."""
        pairs = oscillatory_pairs(self.eigenvalues)
        return float(pairs.real.max()) if len(pairs) else -np.inf


@dataclass(frozen=True, eq=False)
class CriticalPoint(float):
    """A speed at which the steady run loses or gains stability; it is a float, the speed itself.

    speed        [m/s]
    frequency    of the mode [Hz]; 0 for a divergence
    eigenvalue   [1/s], its real part zero to the tolerance
    mode         eigenvector (n,) over `state_names`, complex; the largest reported displacement
                 (measured in the system's scales) has phase zero and the size of its scale
    state        equilibrium (n,)
    slope        change of the real part with speed [1/m]
    kind         "hopf" (a pair crosses) or "divergence" (a bare real root crosses)
    evaluations  number of speeds at which the equations were linearised to find it
    """

    speed: float
    frequency: float
    eigenvalue: complex
    mode: Array
    state: Array
    slope: float
    kind: Kind
    state_names: tuple[str, ...]
    evaluations: int

    def __new__(cls, speed: float, *_: Any, **__: Any) -> CriticalPoint:
        return super().__new__(cls, speed)

    @property
    def direction(self) -> Literal["loses stability", "gains stability"]:
        """What a rising speed does to the root that crosses."""
        return "loses stability" if self.slope > 0.0 else "gains stability"

    def __str__(self) -> str:
        what = f"{self.frequency:.4g} Hz" if self.kind == "hopf" else "divergence"
        return f"{self.speed:.4f} m/s ({what}, {self.direction})"


@dataclass(frozen=True, eq=False)
class RootLocus:
    """Eigenvalues over speed, each column one root followed by nearness.

    speeds (m,) [m/s], eigenvalues (m, n) [1/s], states (m, n) the equilibria
    """

    speeds: Array
    eigenvalues: Array
    states: Array


def linearise(vehicle: Any, speed: float, guess: Array | None = None) -> Linearisation:
    """Eigenvalues and eigenvectors about the equilibrium at a forward speed [m/s].

    `guess` is a state (n,) near the equilibrium. Raises AnalysisError if there is none.
    """
    system = as_system(vehicle)
    state = system.equilibrium(speed, guess)
    jacobian = system.jacobian(state, speed)
    check_finite(system, jacobian, speed)
    # Eigenvectors in scaled states are better conditioned than in metres beside radians/second.
    scales = system.scales
    values, vectors = np.linalg.eig(jacobian * scales[None, :] / scales[:, None])
    order = np.argsort(-values.real, kind="stable")
    return Linearisation(
        speed=float(speed),
        state=state,
        jacobian=jacobian,
        eigenvalues=values[order],
        eigenvectors=(scales[:, None] * vectors)[:, order],
    )


def linear_critical_speed(
    vehicle: Any,
    low: float,
    high: float,
    *,
    guess: float | None = None,
    points: int = 40,
    tolerance: float = 1e-6,
) -> CriticalPoint:
    """Lowest speed in [low, high] m/s at which the least damped oscillatory pair turns unstable.

    Scans upward at `points` speeds until a pair has become unstable, then brackets the root to
    `tolerance` [m/s]. An instability confined between two neighbouring speeds of the scan is not
    seen: raise `points`. With `guess` (a speed or an earlier CriticalPoint of a slightly
    different vehicle) a secant starts there, and the scan is only made if it fails.

    Raises AnalysisError if no pair loses stability in [low, high]; the message gives the growth
    rates at both ends.
    """
    spectra = Spectra(as_system(vehicle))
    _check_range(low, high, points)
    if guess is not None:
        found = _critical_speed_near(spectra, low, high, guess, tolerance)
        if found is not None:
            return found
    speeds = np.linspace(low, high, points)
    stable_below = spectra.unstable("hopf", speeds[0]) == 0
    for left, right in pairwise(speeds):
        stable_above = spectra.unstable("hopf", right) == 0
        if stable_below and not stable_above:
            found = _crossing(spectra, "hopf", 0, left, right, tolerance)
            if found is not None:
                return found
        stable_below = stable_above
    raise AnalysisError(_no_critical_speed(spectra, speeds))


def stability_changes(
    vehicle: Any, low: float, high: float, *, points: int = 80, tolerance: float = 1e-6
) -> list[CriticalPoint]:
    """All speeds in [low, high] m/s at which a pair or a real root crosses zero, by rising speed.

    Raises AnalysisError where the system has no equilibrium.
    """
    spectra = Spectra(as_system(vehicle))
    _check_range(low, high, points)
    speeds = np.linspace(low, high, points)
    found: list[CriticalPoint] = []
    kinds: tuple[Kind, ...] = ("hopf", "divergence")
    for kind in kinds:
        for left, right in pairwise(speeds):
            before, after = spectra.unstable(kind, left), spectra.unstable(kind, right)
            for index in range(min(before, after), max(before, after)):
                crossing = _crossing(spectra, kind, index, left, right, tolerance)
                if crossing is not None:
                    found.append(crossing)
    return sorted(found)


def hopf_points(
    vehicle: Any, low: float, high: float, *, points: int = 80, tolerance: float = 1e-6
) -> list[CriticalPoint]:
    """All speeds in [low, high] m/s at which an oscillatory pair crosses zero, by rising speed."""
    changes = stability_changes(vehicle, low, high, points=points, tolerance=tolerance)
    return [change for change in changes if change.kind == "hopf"]


def divergence_points(
    vehicle: Any, low: float, high: float, *, points: int = 80, tolerance: float = 1e-6
) -> list[CriticalPoint]:
    """All speeds in [low, high] m/s at which a bare real root crosses zero, by rising speed."""
    changes = stability_changes(vehicle, low, high, points=points, tolerance=tolerance)
    return [change for change in changes if change.kind == "divergence"]


def root_locus(vehicle: Any, speeds: Sequence[float] | Array) -> RootLocus:
    """Eigenvalues at `speeds` (m,) [m/s], each root followed from speed to speed.

    A root goes to the one nearest to its linear extrapolation. Raises AnalysisError.
    """
    spectra = Spectra(as_system(vehicle))
    speeds = np.asarray(speeds, dtype=float)
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


def _check_range(low: float, high: float, points: int) -> None:
    if not (np.isfinite(low) and np.isfinite(high) and low < high):
        raise AnalysisError(f"the range of speeds must rise from low to high, got {low} to {high}")
    if points < 2:
        raise AnalysisError(f"a scan needs at least 2 points, got {points}")


def _crossing(
    spectra: Spectra, kind: Kind, index: int, left: float, right: float, tolerance: float
) -> CriticalPoint | None:
    """Where the root number `index` (by falling real part) crosses zero between two speeds."""

    def excess(speed: float) -> float:
        sizes = spectra.excess(kind, speed)
        # A root that has left its kind (a pair fallen apart into two real roots) is far below.
        return float(sizes[index]) if index < len(sizes) else -1.0e3

    speed = float(brentq(excess, left, right, xtol=max(tolerance, 1e-9), rtol=1e-14))
    if kind == "divergence":
        return _divergence(spectra, speed, excess, right if excess(right) > 0.0 else left)
    roots = oscillatory_pairs(spectra.eigenvalues(speed))
    if index >= len(roots):
        return None
    eigenvalue = complex(roots[np.argsort(NEUTRAL_FRACTION * np.abs(roots) - roots.real)[index]])
    polished = _polish(spectra, speed, eigenvalue, tolerance)
    if polished is not None and left <= polished[0] <= right:
        speed, eigenvalue = polished
    # Where pairs merge into real roots or back the sorted real parts jump over zero: no crossing.
    if abs(eigenvalue.real) > 1e-4 * abs(eigenvalue):
        return None
    return _hopf_point(spectra, speed, eigenvalue)


def _divergence(
    spectra: Spectra, speed: float, excess: Callable[[float], float], unstable_end: float
) -> CriticalPoint | None:
    """The divergence near the speed where a real root reaches the neutral rate."""
    roots = real_roots(spectra.eigenvalues(speed))
    eigenvalue = float(roots[np.argmin(np.abs(roots - NEUTRAL_RATE))])
    if abs(eigenvalue - NEUTRAL_RATE) > 0.1 * NEUTRAL_RATE:
        return None
    step = float(np.clip(unstable_end - speed, -1e-3 * abs(speed), 1e-3 * abs(speed)))
    slope = (excess(speed + step) - excess(speed)) / step if step else 0.0
    if slope == 0.0:
        return None
    mode, state = _mode(spectra, speed, eigenvalue)
    return CriticalPoint(
        # The root found is that of real part = neutral rate: back to zero along its slope.
        speed=speed - NEUTRAL_RATE / slope,
        frequency=0.0,
        eigenvalue=0j,
        mode=mode,
        state=state,
        slope=slope,
        kind="divergence",
        state_names=spectra.system.state_names,
        evaluations=spectra.evaluations,
    )


def _polish(
    spectra: Spectra, speed: float, eigenvalue: complex, tolerance: float
) -> tuple[float, complex] | None:
    """Speed and root where the real part of the pair near `eigenvalue` is zero, by a secant."""
    step = 1e-3 * max(abs(speed), 1.0)
    before, root_before = speed, spectra.nearest(speed, eigenvalue)
    now = speed - step if root_before.real > 0.0 else speed + step
    for _ in range(12):
        root = spectra.nearest(now, root_before)
        if root.real == root_before.real:
            return None
        following = now - root.real * (now - before) / (root.real - root_before.real)
        if not np.isfinite(following) or abs(following - now) > 0.2 * max(abs(now), 1.0):
            return None
        before, root_before = now, root
        if abs(following - now) < tolerance:
            return now, root
        now = float(following)
    return None


def _critical_speed_near(
    spectra: Spectra, low: float, high: float, guess: float, tolerance: float
) -> CriticalPoint | None:
    """The critical speed by a secant from a guess; None if the scan has to look for it."""
    try:
        if isinstance(guess, CriticalPoint) and len(guess.state) == spectra.system.size:
            spectra.start_from(guess.speed, guess.state)
            eigenvalue = guess.eigenvalue
        else:
            pairs = oscillatory_pairs(spectra.eigenvalues(float(guess)))
            eigenvalue = complex(pairs[np.argmax(pairs.real - NEUTRAL_FRACTION * np.abs(pairs))])
        polished = _polish(spectra, float(guess), eigenvalue, tolerance)
    except (AnalysisError, ValueError):
        return None
    if polished is None or not low <= polished[0] <= high:
        return None
    speed, eigenvalue = polished
    others = oscillatory_pairs(spectra.eigenvalues(speed))
    others = others[np.abs(others - eigenvalue) > 1e-6 * abs(eigenvalue)]
    if np.any(others.real > NEUTRAL_FRACTION * np.abs(others)):
        return None
    point = _hopf_point(spectra, speed, eigenvalue)
    return point if point.slope > 0.0 else None


def _hopf_point(spectra: Spectra, speed: float, eigenvalue: complex) -> CriticalPoint:
    mode, state = _mode(spectra, speed, eigenvalue)
    step = 1e-4 * max(abs(speed), 1.0)
    shifted = spectra.nearest(speed + step, eigenvalue)
    return CriticalPoint(
        speed=speed,
        frequency=abs(eigenvalue.imag) / (2.0 * np.pi),
        eigenvalue=eigenvalue,
        mode=mode,
        state=state,
        slope=(shifted.real - eigenvalue.real) / step,
        kind="hopf",
        state_names=spectra.system.state_names,
        evaluations=spectra.evaluations,
    )


def _mode(spectra: Spectra, speed: float, eigenvalue: complex) -> tuple[Array, Array]:
    """Eigenvector of the root nearest to an eigenvalue, and the equilibrium."""
    system = spectra.system
    state = spectra.state(speed)
    full = linearise(system, speed, state)
    mode = full.eigenvectors[:, np.argmin(np.abs(full.eigenvalues - eigenvalue))]
    shown = list(system.displacement_indices)
    largest = shown[int(np.argmax(np.abs(mode[shown]) / system.scales[shown]))]
    if mode[largest] == 0.0:
        largest = int(np.argmax(np.abs(mode) / system.scales))
    return mode * (system.scales[largest] / mode[largest]), state


def _no_critical_speed(spectra: Spectra, speeds: Array) -> str:
    """Why no pair loses stability over a scan of speeds."""

    def worst(speed: float) -> str:
        pairs = oscillatory_pairs(spectra.eigenvalues(speed))
        if not len(pairs):
            return f"nothing oscillates at {speed:g} m/s"
        root = pairs[np.argmax(pairs.real)]
        return f"{root.real:+.4g} 1/s at {speed:g} m/s ({root.imag / (2.0 * np.pi):.3g} Hz)"

    counts = [spectra.unstable("hopf", speed) for speed in speeds]
    low, high = float(speeds[0]), float(speeds[-1])
    if not any(counts):
        what = "every oscillation is damped; raise the upper speed"
    elif all(counts):
        what = "an oscillation grows at every speed; lower the lower speed"
    else:
        first_stable = speeds[counts.index(0)]
        what = f"an oscillation grows from the start and is damped from about {first_stable:g} m/s"
    divergent = [speed for speed in speeds if spectra.unstable("divergence", speed)]
    if divergent:
        what += f"; a bare real root diverges at {divergent[0]:g} m/s (see divergence_points)"
    return (
        f"{spectra.system.name}: no linear critical speed between {low:g} and {high:g} m/s: "
        f"{what}. Growth rate of the least damped pair: {worst(low)}, {worst(high)}"
    )
