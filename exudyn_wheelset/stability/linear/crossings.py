"""Speeds at which an eigenvalue of the steady run crosses the imaginary axis.

Where a complex pair crosses the imaginary axis the system hunts with the frequency of the pair
(Hopf bifurcation); where a bare real root crosses it diverges. A crossing is bracketed by the
number of unstable roots at two speeds: the real parts sorted by size are continuous functions of
speed even where two modes change places, so a bracketed root of the k-th of them is the crossing,
and no mode has to be followed by its shape.

Speeds in m/s, eigenvalues in 1/s, frequencies in Hz.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from scipy.optimize import brentq

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import positive, whole
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.linear.law_checks import LawCheck, check_law, warn_of_law
from exudyn_wheelset.stability.linear.linearisation import linearised
from exudyn_wheelset.stability.linear.modes import NAMELESS, mode_name
from exudyn_wheelset.stability.linear.spectra import (
    NEUTRAL_FRACTION,
    NEUTRAL_RATE,
    Kind,
    Spectra,
    oscillatory_pairs,
    real_roots,
)
from exudyn_wheelset.stability.subject import as_system
from exudyn_wheelset.systems.source import Source
from exudyn_wheelset.systems.speeds import checked_range
from exudyn_wheelset.systems.system import DynamicSystem

if TYPE_CHECKING:
    from exudyn_wheelset.stability.gradients import Gradient


# A scan of a car at so many speeds takes a quarter of an hour.
MOST_POINTS = 10000


@brief
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
    mode_name    what moves: "truck hunting", "front truck hunting", "car body upper sway", ...
    remarks      what else is known of stability that is worse than this answer, and what "linear"
                 means for a creep law without a derivative
    law          what was measured of the creep law about the equilibrium, along the mode; None for
                 a divergence
    source       the description it was found from, if the system knows it
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
    mode_name: str = ""
    remarks: tuple[str, ...] = ()
    law: LawCheck | None = None
    source: Source | None = field(default=None, repr=False)

    def __new__(cls, speed: float, *_: Any, **__: Any) -> CriticalPoint:
        return super().__new__(cls, speed)

    @property
    def direction(self) -> Literal["loses stability", "gains stability"]:
        """What a rising speed does to the root that crosses."""
        return "loses stability" if self.slope > 0.0 else "gains stability"

    def gradient(self, names: Sequence[str] | None = None, vehicle: Any = None) -> Gradient:
        """Derivative of the speed by the numbers of the vehicle: name -> (m/s)/unit.

        names: some of them, None for all; vehicle: the description, where the analysis was given
        a system. Raises AnalysisError for a divergence, and where no description is known.
        """
        from exudyn_wheelset.stability.gradients import hopf_gradient, source_of

        if self.kind != "hopf":
            raise AnalysisError("only the speed at which a pair crosses has a gradient here")
        vehicle = source_of(self.source, vehicle)
        return hopf_gradient(vehicle, self.speed, self.eigenvalue, self.state, names)

    @property
    def additivity(self) -> float | None:
        """|f(a + b) - f(a) - f(b)|/|f| along the mode; 0 where the equations are linear."""
        return None if self.law is None else self.law.additivity

    @property
    def slope_ratio(self) -> float | None:
        """Slope of the creep law over that of the exact law at the equilibrium's patches."""
        return None if self.law is None else self.law.slope_ratio

    def __str__(self) -> str:
        what = [f"{self.frequency:.4g} Hz" if self.kind == "hopf" else "divergence"]
        if self.mode_name not in ("", *what, NAMELESS):
            what.append(self.mode_name)
        return f"{self.speed:.4f} m/s ({', '.join([*what, self.direction])})"


def stability_changes(
    vehicle: Any, low: float, high: float, *, points: int = 80, tolerance: float = 1e-6
) -> list[CriticalPoint]:
    """All speeds in [low, high] m/s at which a pair or a real root crosses zero, by rising speed.

    Raises AnalysisError where the system has no equilibrium.
    """
    spectra = Spectra(as_system(vehicle))
    check_range(spectra.system, low, high, points, tolerance)
    speeds = np.linspace(low, high, points)
    found: list[CriticalPoint] = []
    kinds: tuple[Kind, ...] = ("hopf", "divergence")
    for kind in kinds:
        for left, right in pairwise(speeds):
            before, after = spectra.unstable(kind, left), spectra.unstable(kind, right)
            for index in range(min(before, after), max(before, after)):
                point = crossing(spectra, kind, index, left, right, tolerance)
                if point is not None:
                    found.append(point)
    return sorted(found)


@spelt
def hopf_points(
    vehicle: Any, low: float, high: float, *, points: int = 80, tolerance: float = 1e-6
) -> list[CriticalPoint]:
    """All speeds in [low, high] m/s at which an oscillatory pair crosses zero, by rising speed.

    Warns (WheelsetWarning) where the creep law is not linear about one of the equilibria or has
    another slope there than the exact law (see `law_checks`). Raises AnalysisError for speeds out
    of order and where the vehicle has no steady run.

    Examples
    --------
    >>> from exudyn_wheelset import hopf_points
    >>> points = hopf_points("cooperrider", 20, 120)
    >>> round(points[0].speed, 2), points[0].direction
    (68.64, 'loses stability')
    """
    system = as_system(vehicle)
    changes = stability_changes(system, low, high, points=points, tolerance=tolerance)
    found = [change for change in changes if change.kind == "hopf"]
    laws = [(point.speed, point.law) for point in found if point.law is not None]
    warn_of_law(system.name, laws)
    return found


def divergence_points(
    vehicle: Any, low: float, high: float, *, points: int = 80, tolerance: float = 1e-6
) -> list[CriticalPoint]:
    """All speeds in [low, high] m/s at which a bare real root crosses zero, by rising speed."""
    changes = stability_changes(vehicle, low, high, points=points, tolerance=tolerance)
    return [change for change in changes if change.kind == "divergence"]


def check_range(
    system: DynamicSystem, low: float, high: float, points: int, tolerance: float
) -> None:
    """Raise WheelsetError for a scan of speeds [m/s] that cannot be made."""
    lower, upper = checked_range(system, low, high)
    whole("points", points, 2, MOST_POINTS)
    positive("tolerance", tolerance, "m/s", upper - lower, "it has to be less than the range")


def crossing(
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
    polished = polish(spectra, speed, eigenvalue, tolerance)
    if polished is not None and left <= polished[0] <= right:
        speed, eigenvalue = polished
    # Where pairs merge into real roots or back the sorted real parts jump over zero: no crossing.
    if abs(eigenvalue.real) > 1e-4 * abs(eigenvalue):
        return None
    return hopf_point(spectra, speed, eigenvalue)


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
    mode, state, _ = _mode(spectra, speed, eigenvalue)
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
        mode_name=mode_name(spectra.system, mode, 0.0),
    )


def polish(
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


def hopf_point(spectra: Spectra, speed: float, eigenvalue: complex) -> CriticalPoint:
    mode, state, jacobian = _mode(spectra, speed, eigenvalue)
    step = 1e-4 * max(abs(speed), 1.0)
    shifted = spectra.nearest(speed + step, eigenvalue)
    law = check_law(spectra.system, state, speed, mode, jacobian)
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
        mode_name=mode_name(spectra.system, mode, abs(eigenvalue.imag) / (2.0 * np.pi)),
        remarks=(law.remark,) if law.remark else (),
        law=law,
        source=spectra.system.source,
    )


def _mode(spectra: Spectra, speed: float, eigenvalue: complex) -> tuple[Array, Array, Array]:
    """Eigenvector of the root nearest to an eigenvalue, the equilibrium and its Jacobian."""
    system = spectra.system
    state = spectra.state(speed)
    full = linearised(system, speed, state)
    mode = full.eigenvectors[:, np.argmin(np.abs(full.eigenvalues - eigenvalue))]
    shown = list(system.displacement_indices)
    largest = shown[int(np.argmax(np.abs(mode[shown]) / system.scales[shown]))]
    if mode[largest] == 0.0:
        largest = int(np.argmax(np.abs(mode) / system.scales))
    return mode * (system.scales[largest] / mode[largest]), state, full.jacobian
