"""Rigid contact geometry as piecewise polynomials of the lateral shift (Figure 3 of the paper).

The contact point of a profiled wheel jumps where it goes over to the flange or across a change of
curvature; roll angle and height stay continuous there but have a kink. So the range of y is cut
at the jumps, and between them every quantity is a smooth function:
- `cubic`: cubic splines through searched points, closer together where the contact moves fast;
- `polynomial`: polynomials of the smallest degree that meets a tolerance, which is the
  representation of the paper. A polynomial is a Chebyshev series through FIT points of its piece,
  cut off behind its degree; a piece that no degree fits is cut where it misses most.

Both are judged between the points they were made from, and cut or refined until they hold there.
A residual is the largest deviation from the contact search at the points judged, plus the largest
change of that deviation from one of them to the next, for what lies between.

Columns: roll [rad], z [m], then for the left and the right side wheel_y [m], rail_y [m],
angle [rad], radius [m]. Yaw is zero: that is what the paper tabulates.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline, PPoly

from exudyn_wheelset.checking import number, warn, whole
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.geometry.rigid import ContactGeometry, searched_geometry
from exudyn_wheelset.geometry.roughness import rough_profiles, warn_if_rough
from exudyn_wheelset.spelling import spelt

FloatArray = NDArray[np.float64]
Search = Callable[[FloatArray], FloatArray]

COLUMNS = (
    "roll",
    "z",
    "left_wheel_y",
    "left_rail_y",
    "left_angle",
    "left_radius",
    "right_wheel_y",
    "right_rail_y",
    "right_angle",
    "right_radius",
)
# Places and angles of the contact are slopes of what roll, z and radius are: a hundred times the
# tolerance leaves them 0.2 mm and 0.01 degrees.
TOLERANCE_FACTORS = np.array([1, 1, 100, 100, 100, 1, 100, 100, 100, 1], dtype=float)
REPRESENTATIONS = ("cubic", "polynomial")
# A contact point that moves more than this from one search to the next may have jumped [m].
JUMP = 1.0e-3
# Smooth and worn pairs take 4000 to 7000 searches at the default tolerance; with 0.1 um of noise on
# points 0.2 mm apart there is no end of jumps.
_MOST_SEARCHES = 12_000
# A jump is located this closely [m]; the search decides between two contacts by their distances,
# which it knows to 1e-15 m and which differ by some tenths of the shift.
_BRACKET = 2.0e-12
# Pieces are searched from this far beside their ends [m]: nearer, either branch may be found.
_BESIDE = 2.0e-11
# Narrower pieces and cells are not cut [m].
_NARROWEST = 1.0e-9
# Twice as many points as coefficients: aliasing does not disturb the series' lower half.
_FIT_POINTS = 20
_JUDGED_POINTS = 49
# A cut is made no nearer to an end than this share of the piece: where a contact point moves as
# the root of the distance from a fold, pieces that grow tenfold are fitted by degree 9.
_LEAST_SHARE = 0.1


@dataclass(frozen=True)
class PiecewiseGeometry:
    """Contact geometry over y in pieces.

    jumps: (k,) shifts [m] where the contact jumps; breaks: (pieces + 1,) ends of the pieces [m];
    curves: PPoly with the values of COLUMNS; degrees: of each piece; residuals: (pieces, 10)
    largest deviation from the contact search in each piece, also between the points it was made
    from, in the units of COLUMNS.
    """

    jumps: FloatArray
    breaks: FloatArray
    curves: PPoly
    degrees: tuple[int, ...]
    residuals: FloatArray

    def __call__(self, y: ArrayLike, derivative: int = 0) -> FloatArray:
        """Values of COLUMNS at y [m], shape (..., 10), or their derivatives over y."""
        return np.asarray(self.curves(y, nu=derivative))


def geometry_columns(geometry: ContactGeometry) -> FloatArray:
    """Values (n, 10) of COLUMNS."""
    sides = (geometry.left, geometry.right)
    columns = [geometry.roll, geometry.z]
    for side in sides:
        columns += [side.wheel_y, side.rail_y, side.angle, side.radius]
    return np.column_stack(columns)


@spelt
def piecewise_geometry(
    wheelset: Wheelset,
    track: Track,
    half_range: float = 0.012,
    spacing: float = 5.0e-5,
    representation: str = "cubic",
    tolerance: float = 2.0e-6,
    highest_degree: int = 9,
) -> PiecewiseGeometry:
    """Return the contact geometry for |y| <= half_range [m] in pieces.

    spacing [m] of the contact searches that look for jumps, and of the cubics at most; tolerance
    [m or rad] for roll, height and radii, a hundred times as much for positions and angles; the
    polynomials' degree is raised up to highest_degree to meet it, and pieces are cut. Every
    residual is within the tolerance unless the contact search itself is rougher.
    A profile whose curvature is measurement noise jumps at every turn: it gets straight lines
    between the searched points, with their residuals, and a WheelsetWarning.
    Raises ContactError if a wheel leaves its rail within the range.

    Examples
    --------
    >>> from exudyn_wheelset import Track, Wheelset, piecewise_geometry
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "cone_0.05")
    >>> pieces = piecewise_geometry(axle, Track("UIC60"), half_range=2e-3)
    >>> len(pieces.jumps)
    0
    """
    if representation not in REPRESENTATIONS:
        raise WheelsetError(f"representation {representation!r}: use 'cubic' or 'polynomial'")
    whole("highest_degree", highest_degree, 1, _FIT_POINTS - 1)
    half_range = number("half_range", half_range, "m", 1e-5, 0.1, "the largest shift, in metres")
    spacing = number("spacing", spacing, "m", 1e-7, half_range)
    tolerance = number("tolerance", tolerance, "m", 1e-12, 1e-2)
    allowed = tolerance * TOLERANCE_FACTORS
    left = _MOST_SEARCHES * max(1.0, math.sqrt(2.0e-6 / tolerance))

    def search(y: FloatArray) -> FloatArray:
        """Columns at y, any shape (...): (..., 10) in units of what is allowed."""
        nonlocal left
        left -= y.size
        if left < 0:
            raise _TooRough
        found = geometry_columns(searched_geometry(wheelset, track, y.ravel()))
        return (found / allowed).reshape(*y.shape, len(COLUMNS))

    y = np.linspace(-half_range, half_range, 2 * int(np.ceil(half_range / spacing)) + 1)
    places = search(y)[:, [2, 3, 6, 7]] * allowed[2]
    moved = np.flatnonzero(np.abs(np.diff(places, axis=0)).max(axis=1) > JUMP)
    try:
        if rough_profiles(wheelset, track):
            warn_if_rough(wheelset, track, y, places)
            raise _TooRough
        jumps = _locate_jumps(search, y[moved], y[moved + 1])
        jumps = np.unique(jumps[np.isfinite(jumps)])
        ends = np.concatenate([y[:1], jumps, y[-1:]])
        jumps, pieces = _polynomials(search, ends, highest_degree)
        if representation == "cubic":
            ends = np.concatenate([y[:1], jumps, y[-1:]])
            pieces = [_cubics(search, low, high, spacing) for low, high in pairwise(ends)]
    except _TooRough:
        if left < 0:
            _warn_of_jumps(wheelset, track, tolerance)
        left = math.inf
        jumps, pieces = _straight_lines(search, y, moved)
    return _geometry_of(jumps, pieces, y[-1], allowed)


class _TooRough(Exception):
    """No end of jumps: profiles of noise, or all searches used."""


def _warn_of_jumps(wheelset: Wheelset, track: Track, tolerance: float) -> None:
    names = f"{wheelset.wheel.name} on {track.rail.name}"
    warn(
        f"{names}: the contact jumps too often for pieces that hold {tolerance:g} m, as it does "
        "where points with noise curve the profiles; straight lines between the searched points "
        "are returned, with their residuals: smooth what was measured, smoothing='auto'"
    )


def _geometry_of(
    jumps: FloatArray, pieces: list[_Piece], last: float, allowed: FloatArray
) -> PiecewiseGeometry:
    breaks = np.array([*(piece.low for piece in pieces), last])
    curves = _join([piece.curve for piece in pieces], breaks)
    return PiecewiseGeometry(
        jumps,
        breaks,
        PPoly(curves.c * allowed, curves.x),
        tuple(piece.degree for piece in pieces),
        np.array([piece.residual for piece in pieces]) * allowed,
    )


class _Piece(NamedTuple):
    """Curves from `low` to the next piece; residual (10,) in units of what is allowed."""

    low: float
    curve: PPoly
    degree: int
    residual: FloatArray


def _residual(miss: FloatArray) -> FloatArray:
    """Largest deviation over points (..., points, 10), with what may lie between the points."""
    between = np.abs(np.diff(miss, axis=-2)).max(axis=-2)
    return np.asarray(np.abs(miss).max(axis=-2) + between)


def _locate_jumps(search: Search, low: FloatArray, high: FloatArray) -> FloatArray:
    """The shift in each bracket at which the contact jumps, by bisection; NaN: it moves fast."""
    low, high = low.copy(), high.copy()
    if not low.size:
        return low
    at_low, at_high = search(low), search(high)
    while np.any(high - low > _BRACKET):
        middle = 0.5 * (low + high)
        here = search(middle)
        left = np.abs(here - at_low).max(axis=1) > np.abs(at_high - here).max(axis=1)
        high[left], at_high[left] = middle[left], here[left]
        low[~left], at_low[~left] = middle[~left], here[~left]
    jumped = np.abs(at_high - at_low).max(axis=1) > 1.0
    return np.where(jumped, 0.5 * (low + high), np.nan)


def _straight_lines(
    search: Search, y: FloatArray, moved: NDArray[np.intp]
) -> tuple[FloatArray, list[_Piece]]:
    """Jumps midway between searched points, straight lines through the points between them."""
    jumps = 0.5 * (y[moved] + y[moved + 1])
    lows = np.concatenate([y[:1], jumps])
    values = search(y)
    between = search(0.5 * (y[1:] + y[:-1]))
    pieces = []
    for low, nodes in zip(lows, np.split(np.arange(len(y)), moved + 1), strict=True):
        if len(nodes) == 1:
            step = 0.25 * (y[1] - y[0])
            x = np.array([y[nodes[0]] - step, y[nodes[0]] + step])
            curve = PPoly(np.stack([0.0 * values[nodes], values[nodes]]), x)
            miss = (curve(x) - search(x))[None]
        else:
            rise = np.diff(values[nodes], axis=0) / np.diff(y[nodes])[:, None]
            curve = PPoly(np.stack([rise, values[nodes[:-1]]]), y[nodes])
            middle = 0.5 * (values[nodes[1:]] + values[nodes[:-1]])
            miss = np.repeat((middle - between[nodes[:-1]])[None], 2, axis=1)
        pieces.append(_Piece(float(low), curve, 1, _residual(miss)[0]))
    return jumps, pieces


def _polynomials(
    search: Search, ends: FloatArray, highest_degree: int
) -> tuple[FloatArray, list[_Piece]]:
    """Jumps and polynomials (PPoly, degree, residual), residuals at most 1 unless too narrow."""
    fit = np.cos(np.pi * (np.arange(_FIT_POINTS) + 0.5) / _FIT_POINTS)
    places = np.unique(
        np.concatenate([fit, np.linspace(-1.0, 1.0, _JUDGED_POINTS), [-0.999, 0.999]])
    )
    fitted = np.searchsorted(places, fit)
    # Discrete orthogonality of the Chebyshev polynomials at the roots of the next one.
    to_series = chebyshev.chebvander(fit, _FIT_POINTS - 1).T * (2.0 / _FIT_POINTS)
    to_series[0] *= 0.5
    at_places = chebyshev.chebvander(places, highest_degree)
    jumps = list(ends[1:-1])
    low, high = ends[:-1], ends[1:]
    done = []
    while low.size:
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        inner = np.maximum(half - _BESIDE, 0.5 * half)
        y = middle[:, None] + inner[:, None] * places
        exact = search(y)
        series = np.einsum("ij,pjc->pic", to_series, exact[:, fitted])[:, : highest_degree + 1]
        pending = np.ones(len(low), dtype=bool)
        for degree in range(1, highest_degree + 1):
            n = degree + 1
            miss = np.einsum("ij,pjc->pic", at_places[:, :n], series[:, :n]) - exact
            residual = _residual(miss)
            holds = residual.max(axis=1) <= 1.0
            if degree == highest_degree:
                holds |= high - low < _NARROWEST
            for k in np.flatnonzero(pending & holds):
                curve = _power_series(series[k, :n], middle[k], inner[k])
                done.append(_Piece(low[k], curve, degree, residual[k]))
            pending &= ~holds
        rest = np.flatnonzero(pending)
        step = np.abs(np.diff(exact[rest], axis=1)).max(axis=2)
        widest = step.argmax(axis=1)
        worst = np.abs(miss[rest]).max(axis=2).argmax(axis=1)
        share = np.clip(places[worst], 2 * _LEAST_SHARE - 1.0, 1.0 - 2 * _LEAST_SHARE)
        cut = middle[rest] + half[rest] * share
        suspicious = np.flatnonzero(step.max(axis=1) > 2.0)
        found = _locate_jumps(
            search,
            y[rest[suspicious], widest[suspicious]],
            y[rest[suspicious], widest[suspicious] + 1],
        )
        is_jump = np.isfinite(found)
        cut[suspicious[is_jump]] = found[is_jump]
        jumps += list(found[is_jump])
        low, high = np.concatenate([low[rest], cut]), np.concatenate([cut, high[rest]])
    done.sort(key=lambda piece: piece.low)
    return np.array(sorted(jumps)), done


def _power_series(series: FloatArray, middle: float, half: float) -> PPoly:
    """Chebyshev series (degree + 1, 10) on middle +- half as one PPoly cell about the middle."""
    powers = np.zeros((len(series), 1, series.shape[1]))
    for column, coefficients in enumerate(series.T):
        found = chebyshev.cheb2poly(coefficients)
        powers[: len(found), 0, column] = found
    powers /= half ** np.arange(len(series))[:, None, None]
    return PPoly(powers[::-1], [middle, middle + half])


def _cubics(search: Search, low: float, high: float, spacing: float) -> _Piece:
    """Cubic splines between two jumps, with cells halved until what lies within them fits."""
    beside = min(_BESIDE, 0.25 * (high - low))
    nodes = np.linspace(low + beside, high - beside, int(np.ceil((high - low) / spacing)) + 1)
    values = search(nodes)
    starts, widths = nodes[:-1], np.diff(nodes)
    judged, exact = np.empty(0), np.empty((0, len(COLUMNS)))
    while True:
        added = (starts[:, None] + widths[:, None] * [0.25, 0.5, 0.75]).ravel()
        judged, exact = _merged(judged, exact, added, search(added))
        spline = CubicSpline(nodes, values)
        miss = spline(judged) - exact
        large = judged[np.abs(miss).max(axis=1) > 0.33]
        cells = np.unique(np.searchsorted(nodes, large, side="right") - 1)
        cells = cells[np.diff(nodes)[cells] > _NARROWEST]
        if not cells.size:
            return _Piece(low, PPoly(spline.c, spline.x), 3, _residual(miss))
        half = 0.5 * np.diff(nodes)[cells]
        starts = np.concatenate([nodes[cells], nodes[cells] + half])
        widths = np.concatenate([half, half])
        nodes, values = _merged(nodes, values, starts[len(cells) :], search(starts[len(cells) :]))


def _merged(
    x: FloatArray, values: FloatArray, other_x: FloatArray, other_values: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Two tables over x as one, in order."""
    x = np.concatenate([x, other_x])
    order = np.argsort(x, kind="stable")
    return x[order], np.concatenate([values, other_values])[order]


def _join(pieces: list[PPoly], breaks: FloatArray) -> PPoly:
    """One PPoly of all pieces, whose first and last cells reach the jumps."""
    degree = max(piece.c.shape[0] for piece in pieces)
    cells, knots = [], [breaks[0]]
    for piece, low, high in zip(pieces, breaks[:-1], breaks[1:], strict=True):
        inner = piece.x[1:-1]
        cells.append(_cells(piece, np.concatenate([[low], inner]), degree))
        knots.extend([*inner, high])
    return PPoly(np.concatenate(cells, axis=1), np.array(knots))


def _cells(piece: PPoly, starts: np.ndarray, degree: int) -> np.ndarray:
    """Coefficients of a PPoly about new starts of cells, Taylor's formula."""
    block = np.zeros((degree, len(starts), piece.c.shape[2]))
    factorial = 1.0
    for power in range(piece.c.shape[0]):
        factorial *= max(power, 1)
        block[degree - 1 - power] = piece(starts, nu=power) / factorial
    return block


def with_short_cells(curves: PPoly, longest: float) -> PPoly:
    """The same functions in cells of at most `longest` [m]."""
    starts = [
        np.linspace(low, high, int(np.ceil((high - low) / longest)), endpoint=False)
        for low, high in pairwise(curves.x)
    ]
    knots = np.concatenate(starts)
    return PPoly(_cells(curves, knots, curves.c.shape[0]), np.append(knots, curves.x[-1]))
