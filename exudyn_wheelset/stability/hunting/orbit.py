"""A periodic motion as a piecewise polynomial of its phase, and the mesh that suits it.

The motion over one period T is x(s T) for the phase s in [0, 1]. On each of N mesh intervals it is
a polynomial of degree m, held by its values at m + 1 equidistant points; neighbours share their
end point, and the last point is the first again. States in SI units and radians, T in s, the
speed in m/s.

The mesh is spread by de Boor's rule as in AUTO (Russell and Christiansen, SIAM J. Numer. Anal. 15
(1978) 59): each interval takes an equal share of |d^(m+1)x/ds^(m+1)|^(1/(m+1)).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from math import comb

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.stability.hunting.orbit_kernels import at_nodes, half_ranges

DEGREE = 4
INTERVALS = 30


class OrbitError(AnalysisError):
    """No periodic orbit was reached; `contact_lost` tells a model left from a Newton failed."""

    def __init__(self, message: str, contact_lost: bool = False) -> None:
        super().__init__(message)
        self.contact_lost = contact_lost


@dataclass(frozen=True)
class Basis:
    """Lagrange basis on m + 1 equidistant points of [0, 1], taken at m Gauss or Radau nodes.

    coefficients of the powers; gram, shares: integrals of products and of the polynomials.
    """

    points: Array
    nodes: Array
    weights: Array
    values: Array
    slopes: Array
    barycentric: Array
    coefficients: Array
    gram: Array
    shares: Array


@lru_cache(maxsize=16)
def basis_of(degree: int, stiff: bool = False) -> Basis:
    """Basis of a degree m at the m Gauss points, or at the Radau nodes for stiff equations."""
    points = np.arange(degree + 1) / degree
    # The nodes are the roots of P_m, or of P_m - P_(m-1), which has one at the right end.
    legendre = np.zeros(degree + 1)
    legendre[degree], legendre[degree - 1] = 1.0, -float(stiff)
    nodes = 0.5 * (1.0 + np.sort(np.polynomial.legendre.legroots(legendre).real))
    if stiff:
        nodes[-1] = 1.0
    weights = np.linalg.solve(np.vander(nodes, increasing=True).T, 1.0 / np.arange(1, degree + 1))
    vandermonde = np.linalg.inv(np.vander(points, increasing=True))
    powers = np.arange(degree + 1)
    values = nodes[:, None] ** powers @ vandermonde
    slopes = (powers * nodes[:, None] ** np.maximum(powers - 1, 0)) @ vandermonde
    signs = np.array([(-1.0) ** j * comb(degree, j) for j in range(degree + 1)])
    gram = values.T @ (weights[:, None] * values)
    return Basis(points, nodes, weights, values, slopes, signs, vandermonde, gram, weights @ values)


@brief
@dataclass(frozen=True, eq=False)
class Orbit:
    """One periodic motion as a piecewise polynomial.

    mesh     (N + 1,) interval ends, from 0 to 1, as fractions of what is stored
    states   (N m + 1, n) states at the m + 1 equidistant points of each interval
    period   [s]
    speed    [m/s]
    mirror   None: the whole period is stored. Signs (n,), 1 or -1: half of it is; the other half
             is the mirror image, x(t + period/2) = mirror x(t), as on a symmetric vehicle
    """

    mesh: Array
    states: Array
    period: float
    speed: float
    mirror: Array | None = None

    @property
    def degree(self) -> int:
        """Degree m of the polynomial on each interval."""
        return (len(self.states) - 1) // (len(self.mesh) - 1)

    @property
    def duration(self) -> float:
        """Time [s] that the stored part takes."""
        return self.period if self.mirror is None else 0.5 * self.period

    def evaluate(self, phases: Array) -> Array:
        """States (k, n) at phases t/period (k,) of any size; the orbit repeats with 1."""
        phases = np.mod(np.asarray(phases, dtype=float), 1.0)
        if self.mirror is None:
            return self._inside(phases)
        late = phases >= 0.5
        values = self._inside(2.0 * phases - late)
        values[late] *= self.mirror
        return values

    def half_peak_to_peak(self) -> Array:
        """Amplitude (n,): half of the distance from the least to the largest value."""
        local = np.arange(4 * self.degree) / (4 * self.degree)
        phases = (self.mesh[:-1, None] + np.diff(self.mesh)[:, None] * local).ravel()
        weights = local[:, None] ** np.arange(self.degree + 1) @ basis_of(self.degree).coefficients
        values: Array = at_nodes(np.ascontiguousarray(self.states), weights)
        values = values.reshape(-1, values.shape[2])
        if self.mirror is not None:
            phases = np.concatenate([0.5 * phases, 0.5 + 0.5 * phases])
            values = np.concatenate([values, self.mirror * values])
        ranges: Array = half_ranges(phases, values)
        return ranges

    def on_mesh(self, mesh: Array) -> Orbit:
        """The same motion on other intervals of the stored part."""
        local = basis_of(self.degree).points[:-1]
        inside = (mesh[:-1, None] + np.diff(mesh)[:, None] * local).ravel()
        states = self._inside(inside)
        last = states[:1] if self.mirror is None else self.mirror * states[:1]
        return replace(self, mesh=np.asarray(mesh), states=np.vstack([states, last]))

    def whole(self) -> Orbit:
        """The same motion with the whole period stored."""
        if self.mirror is None:
            return self
        mesh = np.concatenate([0.5 * self.mesh, 0.5 + 0.5 * self.mesh[1:]])
        states = np.concatenate([self.states, self.mirror * self.states[1:]])
        states[-1] = states[0]
        return Orbit(mesh, states, self.period, self.speed)

    def halved(self, mirror: Array) -> Orbit:
        """The first half of a motion that is its own mirror image, on half of the intervals."""
        whole = self.whole()
        count = len(whole.mesh) // 2 * whole.degree
        states = whole.evaluate(0.5 * np.arange(count + 1) / count)
        states[-1] = mirror * states[0]
        mesh = np.linspace(0.0, 1.0, len(whole.mesh) // 2 + 1)
        return Orbit(mesh, states, whole.period, whole.speed, mirror)

    def _inside(self, fractions: Array) -> Array:
        """States (k, n) at fractions (k,) of the stored part, from 0 to 1."""
        interval = np.searchsorted(self.mesh, fractions, side="right") - 1
        interval = np.clip(interval, 0, len(self.mesh) - 2)
        local = (fractions - self.mesh[interval]) / np.diff(self.mesh)[interval]
        weights = local[:, None] ** np.arange(self.degree + 1) @ basis_of(self.degree).coefficients
        return np.asarray(
            np.einsum("kj,kjn->kn", weights, windows_of(self.states, self.degree)[interval])
        )


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


def balanced_mesh(
    orbit: Orbit, scales: Array, intervals: int | None = None, weight: float = 0.8
) -> Array:
    """Mesh on which each interval, of as many or of `intervals`, has an equal share of the error.

    The error density is |d^(m+1)x/ds^(m+1)|^(1/(m+1)), its derivative taken from the jumps of the
    piecewise constant m-th one. The share 1 - `weight` is spread evenly: corners of f (a flange
    spring, saturated creep) would otherwise draw all intervals to themselves.
    """
    degree, mesh = orbit.degree, orbit.mesh
    widths = np.diff(mesh)
    windows = windows_of(orbit.states / scales, degree)
    highest = np.einsum("j,ijn->in", basis_of(degree).barycentric, windows)
    highest *= (degree / widths[:, None]) ** degree
    gaps = 0.5 * (widths + np.roll(widths, 1))
    before = np.roll(highest, 1, axis=0)
    if orbit.mirror is not None:
        before[0] *= orbit.mirror
    jumps = np.linalg.norm(highest - before, axis=1) / gaps
    density = (0.5 * (jumps + np.roll(jumps, -1))) ** (1.0 / (degree + 1))
    density = 0.25 * np.roll(density, 1) + 0.5 * density + 0.25 * np.roll(density, -1)
    total = float(np.sum(density * widths))
    if not np.isfinite(total) or total <= 0.0:
        density, total = np.ones(len(widths)), 1.0
    share = np.concatenate([[0.0], np.cumsum(density * widths / total)])
    share = weight * share + (1.0 - weight) * mesh
    wanted = np.linspace(0.0, 1.0, (intervals or len(widths)) + 1)
    balanced = np.interp(wanted, share / share[-1], mesh)
    balanced[0], balanced[-1] = 0.0, 1.0
    return np.asarray(balanced)


def windows_of(states: Array, degree: int) -> Array:
    """States (N, m + 1, n) of each interval from the chain (N m + 1, n)."""
    first = np.arange(0, len(states) - 1, degree)
    return np.asarray(states[first[:, None] + np.arange(degree + 1)])
