"""The curve that noise calls for: a spline whose bending is penalised as much as the data allow.

Physical idea: wheels and rails are made of arcs and wear smoothly, so what is penalised is the
change of curvature, the third derivative along the curve: an arc of any radius costs nothing and
keeps its radius, where a penalty on bending flattens it. The curve is a spline of degree 5 over
chord length with equal knots, its coefficients c minimising

    sum_i |p_i - sum_j B_j(t_i) c_j|^2 + lambda sum_k w_k |Delta^3 c_k|^2

(P. H. C. Eilers and B. D. Marx, "Flexible smoothing with B-splines and penalties", Statistical
Science 11, 1996, 89-121). lambda minimises the generalised cross validation

    n RSS/(n - gamma edf)^2,   edf = trace of the smoother,   gamma = 1.4

(P. Craven and G. Wahba, Numerische Mathematik 31, 1979, 377-403; gamma against undersmoothing:
Y.-J. Kim and C. Gu, J. Royal Statistical Society B 66, 2004, 337-356), so it needs no noise given.

Instruments that smooth, and encoders, leave errors that are alike over several points; to cross
validation they look like shape. With residuals of autocorrelation rho_k, n points are worth
n/(1 + 2 sum rho_k) independent ones, and that sum takes gamma's place where it is larger, up to
3.5, beyond which treads of measured wheels were moved by more than their errors (N. S. Altman,
"Kernel smoothing of data with correlated errors", J. American Statistical Association 85, 1990,
749-759). It is found on the residuals of a pilot fit with gamma = 3. Real waviness of such lengths
goes with it; errors alike over more than about 1.5 mm stay, for they cannot be told from shape.

A tread's curvature hardly changes and a flange root's does: one lambda for both would leave noise
on the one or round off the other. So w_k falls with the cube of the rms of Delta^3 c within 4 mm,
found by repeating the fit (L. Yang and Y. Hong, "Adaptive penalized splines for data smoothing",
Computational Statistics & Data Analysis 108, 2017, 70-83). Rails are arcs whose curvature steps
where they meet, in the middle of where wheels run (UIC60: 3.3 to 12.5 1/m), and 4 mm would smear
the step: theirs is 1 mm, which halves the error of conicity; on treads, whose curvature has no
steps, 1 mm doubles it. The cube, gamma and both lengths were chosen by the error of equivalent
conicity of S1002, worn wheels and UIC60 under 5 to 20 micrometres of noise;
docs/figures/make_profile_figures.py draws what comes out, and how near it is to the least error.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded
from scipy.ndimage import gaussian_filter1d

from exudyn_wheelset.profiles.curve import averaged
from exudyn_wheelset.profiles.noise import tangents

FloatArray = NDArray[np.float64]

_DEGREE = 5
_ORDER = 3
_MOST_KNOTS = 320
_MOST_POINTS = 3000
_KNOTS_PER_POINT = 1.0 / 1.5
_GAMMA = 1.4
_POWER = 3.0
# mm
_REACH = {"wheel": 4.0, "rail": 1.0}
_LEAST_ROUGHNESS = 1e-2
_PILOT_GAMMA = 3.0
_MOST_GAMMA = 3.5
_LONGEST_CORRELATION = 3.0
_DIED_AWAY = 0.1
_SCALE = 1e-3
_REPEATS = 2
_ALL_EXPONENTS = np.arange(-4.0, 14.5, 1.0)


@dataclass
class _System:
    """Normal equations in millimetres: bands of B^T B, right side, third differences."""

    basis: object
    parameter: FloatArray
    points: FloatArray
    gram: FloatArray
    gram_band: FloatArray
    right: FloatArray
    differences: FloatArray
    knots: FloatArray
    step: float


@dataclass(frozen=True)
class PenalisedFit:
    """curve: over length [m]; distance: rms of points to curve [m]; correlation: see header [m]."""

    curve: BSpline
    distance: float
    correlation: float


def fit_penalised(points: FloatArray, kind: str) -> PenalisedFit:
    """The penalised curve near `points`, shape (n, 2), n >= 8, columns y and z [m], in order.

    kind: "wheel" or "rail".
    """
    every = points
    group = -(-len(points) // _MOST_POINTS)
    if group > 1:
        # Steps shorter than the noise have no direction; means have, and lose nothing else.
        points = averaged(points, group)
    system = _system(points)
    pilot = _adaptive(system, _PILOT_GAMMA, _REACH[kind])
    correlated = _correlated_points(points, system, pilot)
    coefficients = _adaptive(system, float(np.clip(correlated, _GAMMA, _MOST_GAMMA)), _REACH[kind])
    curve = BSpline(_SCALE * system.knots, _SCALE * coefficients, _DEGREE)
    centres = group * np.arange(len(points)) + 0.5 * (group - 1)
    along = np.interp(np.arange(len(every)), centres, _SCALE * system.parameter)
    tangent = curve.derivative()(along)
    residual = every - curve(along)
    normal = (residual[:, 1] * tangent[:, 0] - residual[:, 0] * tangent[:, 1]) / np.hypot(
        *tangent.T
    )
    spacing = _SCALE * float(np.median(np.diff(system.parameter)))
    return PenalisedFit(
        curve,
        float(np.sqrt(np.mean(normal**2))),
        spacing * correlated if correlated > 1.0 else 0.0,
    )


def _adaptive(system: _System, gamma: float, reach: float) -> FloatArray:
    """Coefficients of the curve after repeated fits, each weighted by the roughness before.

    reach: within which the roughness is taken [mm].
    """
    weights = np.ones(system.differences.shape[0])
    coefficients, exponent = _cross_validated(system, weights, _ALL_EXPONENTS, gamma)
    for _ in range(_REPEATS):
        change = np.sum((system.differences @ coefficients) ** 2, axis=1)
        rough = np.sqrt(gaussian_filter1d(change, reach / system.step, mode="nearest"))
        highest = float(np.max(rough))
        if highest == 0.0:
            break
        weights = (highest / np.maximum(rough, _LEAST_ROUGHNESS * highest)) ** _POWER
        around = exponent + np.arange(-3.0, 3.5, 0.5)
        coefficients, exponent = _cross_validated(system, weights, around, gamma)
    return coefficients


def _correlated_points(points: FloatArray, system: _System, coefficients: FloatArray) -> float:
    """1 + 2 sum of the autocorrelation of the residuals normal to the curve; 1 for white noise.

    Robust: with s the median deviation, rho_k = (s_+^2 - s_-^2)/(s_+^2 + s_-^2) of the sums and
    differences of residuals k points apart; summed until it has died away.
    """
    residual = points - _SCALE * (system.basis @ coefficients)  # type: ignore[operator]
    direction = tangents(points)
    normal = residual[:, 1] * direction[:, 0] - residual[:, 0] * direction[:, 1]
    gentle = np.abs(direction[:, 0]) > 0.5
    spacing = float(np.median(np.diff(system.parameter)))
    total = 1.0
    for k in range(1, min(int(_LONGEST_CORRELATION / spacing), len(points) // 4) + 1):
        both = gentle[k:] & gentle[:-k]
        if np.count_nonzero(both) < 20:
            break
        plus = np.median(np.abs(normal[k:] + normal[:-k])[both]) ** 2
        minus = np.median(np.abs(normal[k:] - normal[:-k])[both]) ** 2
        if not plus - minus > _DIED_AWAY * (plus + minus):
            break
        total += 2.0 * float((plus - minus) / (plus + minus))
    return total


def _system(points: FloatArray) -> _System:
    scaled = points / _SCALE
    t = _along(points) / _SCALE
    pieces = int(np.clip(_KNOTS_PER_POINT * len(t), 8, _MOST_KNOTS))
    step = float(t[-1]) / pieces
    knots = step * np.arange(-_DEGREE, pieces + _DEGREE + 1, dtype=np.float64)
    knots[_DEGREE], knots[-_DEGREE - 1] = 0.0, t[-1]
    basis = BSpline.design_matrix(t, knots, _DEGREE).tocsr()
    gram = (basis.T @ basis).toarray()
    unit = np.eye(len(gram), dtype=np.float64)
    differences: FloatArray = np.diff(unit, n=_ORDER, axis=0) / step ** (_ORDER - 0.5)
    return _System(basis, t, scaled, gram, _band(gram), basis.T @ scaled, differences, knots, step)


def _along(points: FloatArray) -> FloatArray:
    """Length along the curve [m]: steps projected on its tangent, so that noise adds nothing."""
    direction = tangents(points)
    middle = 0.5 * (direction[1:] + direction[:-1])
    steps = np.diff(points, axis=0)
    along = np.sum(steps * middle, axis=1)
    return np.concatenate(([0.0], np.cumsum(np.maximum(along, 0.1 * np.hypot(*steps.T)))))


def _band(matrix: FloatArray) -> FloatArray:
    band = np.zeros((_DEGREE + 1, len(matrix)))
    for k in range(_DEGREE + 1):
        band[k, : len(matrix) - k] = np.diagonal(matrix, -k)
    return band


def _cross_validated(
    system: _System, weights: FloatArray, exponents: FloatArray, gamma: float
) -> tuple[FloatArray, float]:
    """Coefficients at the least cross validation among lambda = 10^exponents, and the exponent."""
    penalty = _band((system.differences * weights[:, None]).T @ system.differences)
    n = len(system.points)
    best: tuple[float, FloatArray, float] | None = None
    for exponent in exponents:
        try:
            factor = cholesky_banded(system.gram_band + 10.0**exponent * penalty, lower=True)
        except LinAlgError:
            continue
        coefficients = cho_solve_banded((factor, True), system.right)
        freedom = float(np.trace(cho_solve_banded((factor, True), system.gram)))
        if gamma * freedom >= n:
            continue
        residual = system.points - system.basis @ coefficients
        score = float(np.sum(residual**2)) / (n - gamma * freedom) ** 2
        if best is None or score < best[0]:
            best = (score, coefficients, float(exponent))
    if best is None:
        # Few points: the stiffest solvable curve.
        for exponent in exponents[::-1]:
            try:
                factor = cholesky_banded(system.gram_band + 10.0**exponent * penalty, lower=True)
            except LinAlgError:
                continue
            return cho_solve_banded((factor, True), system.right), float(exponent)
        raise ArithmeticError("no solvable penalty")
    return best[1], best[2]
