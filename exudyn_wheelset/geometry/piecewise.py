"""Rigid contact geometry as piecewise polynomials of the lateral shift (Figure 3 of the paper).

The contact point of a profiled wheel jumps where it goes over to the flange or across a change of
curvature; roll angle and height stay continuous there but have a kink. So the range of y is cut
at the jumps, and between them every quantity is a smooth function:
- `cubic`: cubic splines through closely spaced points, as exact as the contact search;
- `polynomial`: least-squares polynomials of the smallest degree that meets a tolerance, which is
  the representation of the paper.

Columns: roll [rad], z [m], then for the left and the right side wheel_y [m], rail_y [m],
angle [rad], radius [m]. Yaw is zero: that is what the paper tabulates.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.geometry.rigid import ContactGeometry, contact_geometry

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
# A contact point that moves more than this between two close shifts has jumped [m].
JUMP = 1.0e-3
# A jump is located this closely [m]; of jumps nearer to each other than _CLOSEST one is kept (on
# the steep start of a flange the contact may go over within nanometres of a fold).
_BRACKET = 2.0e-12
_CLOSEST = 2.0e-7
# Pieces are sampled from this far beside a jump [m]: nearer, either branch may be found.
_BESIDE = 5.0e-8
_POINTS = [2, 3, 6, 7]
REPRESENTATIONS = ("cubic", "polynomial")


@dataclass(frozen=True)
class PiecewiseGeometry:
    """Contact geometry over y in pieces.

    jumps: (k,) shifts [m] where a contact point jumps; curves: PPoly with the values of COLUMNS;
    degrees: highest degree in each piece between jumps; residuals: (pieces, 10) largest deviation
    from the contact search in each piece.
    """

    jumps: np.ndarray
    curves: PPoly
    degrees: tuple[int, ...]
    residuals: np.ndarray

    def __call__(self, y, derivative: int = 0) -> np.ndarray:
        """Values of COLUMNS at y [m], shape (..., 10), or their derivatives over y."""
        return self.curves(y, nu=derivative)


def geometry_columns(geometry: ContactGeometry) -> np.ndarray:
    """Values (n, 10) of COLUMNS."""
    sides = (geometry.left, geometry.right)
    columns = [geometry.roll, geometry.z]
    for side in sides:
        columns += [side.wheel_y, side.rail_y, side.angle, side.radius]
    return np.column_stack(columns)


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

    spacing [m] of the contact searches; tolerance [m or rad] for the polynomials, whose degree is
    raised up to highest_degree to meet it (angles are allowed a hundred times as much, since they
    are derivatives). Raises ContactError if a wheel leaves its rail within the range.
    """
    if representation not in REPRESENTATIONS:
        raise WheelsetError(f"representation {representation!r}: use 'cubic' or 'polynomial'")
    count = 2 * int(np.ceil(half_range / spacing)) + 1
    y = np.linspace(-half_range, half_range, count)
    values = geometry_columns(contact_geometry(wheelset, track, y))
    moving = np.abs(np.diff(values[:, _POINTS], axis=0)).max(axis=1)
    jumps: list[float] = []
    for cell in np.flatnonzero(moving > JUMP):
        jumps += _locate_jumps(wheelset, track, y[cell], y[cell + 1])
    breaks = [y[0], *jumps, y[-1]]
    pieces, degrees, residuals, knots = [], [], [], []
    for low, high in pairwise(breaks):
        inner = y[(y > low + 0.5 * spacing) & (y < high - 0.5 * spacing)]
        # Beside a jump the contact moves fast: closer points there.
        reach = min(2.0 * spacing, 0.5 * (high - low) - _BESIDE)
        closer = _BESIDE + reach * np.array([0.0, 0.004, 0.02, 0.06, 0.14, 0.28, 0.5, 0.75, 1.0])
        inner = inner[(inner > low + 1.1 * reach) & (inner < high - 1.1 * reach)]
        samples = np.unique(np.concatenate([low + closer, inner, high - closer]))
        exact = geometry_columns(contact_geometry(wheelset, track, samples))
        if representation == "cubic":
            spline = CubicSpline(samples, exact)
            found = [(low, high, PPoly(spline.c, spline.x), 3, slice(None))]
        else:
            found = _polynomial_pieces(samples, exact, low, high, tolerance, highest_degree)
        for start, _, curve, degree, part in found:
            knots.append(start)
            residuals.append(np.abs(curve(samples[part]) - exact[part]).max(axis=0))
            pieces.append(curve)
            degrees.append(degree)
    breaks = [*knots, y[-1]]
    return PiecewiseGeometry(
        np.array(jumps), _join(pieces, breaks), tuple(degrees), np.array(residuals)
    )


def _locate_jumps(wheelset: Wheelset, track: Track, low: float, high: float) -> list[float]:
    """Shifts in (low, high) at which a contact point jumps, by bisection; fast motion is none."""

    def points(y: float) -> np.ndarray:
        return geometry_columns(contact_geometry(wheelset, track, [y]))[0, _POINTS]

    first, last, at_low, at_high = low, high, points(low), points(high)
    while high - low > _BRACKET:
        middle = 0.5 * (low + high)
        here = points(middle)
        if np.abs(here - at_low).max() > np.abs(at_high - here).max():
            high, at_high = middle, here
        else:
            low, at_low = middle, here
    if np.abs(at_high - at_low).max() < 0.1 * JUMP:
        return []
    before, after = low - _CLOSEST, high + _CLOSEST
    return [
        *(_locate_jumps(wheelset, track, first, before) if before > first else []),
        0.5 * (low + high),
        *(_locate_jumps(wheelset, track, after, last) if after < last else []),
    ]


def _polynomial_pieces(y, values, low, high, tolerance, highest_degree):
    """Polynomials of the smallest degree in tolerance: (low, high, PPoly, degree, part of y).

    Where the highest degree does not (a kink, a steep flange), the piece is cut at its worst point,
    as long as both halves have points enough.
    """
    allowed = tolerance * np.array([1, 1, 100, 100, 100, 1, 100, 100, 100, 1])
    pending = [(low, high, slice(0, len(y)))]
    done = []
    while pending:
        start, end, part = pending.pop()
        for degree in range(1, min(highest_degree, part.stop - part.start - 1) + 1):
            piece = _polynomial_piece(y[part], values[part], start, end, degree)
            miss = np.abs(piece(y[part]) - values[part]) / allowed
            if miss.max() <= 1.0:
                break
        least = highest_degree + 2
        if miss.max() > 1.0 and part.stop - part.start >= 2 * least:
            worst = part.start + int(np.argmax(miss.max(axis=1)))
            cut = min(max(worst, part.start + least - 1), part.stop - least)
            pending.append((y[cut], end, slice(cut, part.stop)))
            pending.append((start, y[cut], slice(part.start, cut + 1)))
        else:
            done.append((start, end, piece, degree, part))
    return done


def _polynomial_piece(y, values, low, high, degree):
    """Least-squares polynomials on [low, high] as one PPoly piece."""
    coefficients = np.empty((degree + 1, 1, values.shape[1]))
    for column, samples in enumerate(values.T):
        fitted = np.polynomial.Polynomial.fit(y, samples, degree, domain=[y[0], y[-1]])
        shifted = fitted(np.polynomial.Polynomial([low, 1.0]))
        powers = np.zeros(degree + 1)
        powers[: len(shifted.coef)] = shifted.coef
        coefficients[:, 0, column] = powers[::-1]
    return PPoly(coefficients, [low, high])


def _join(pieces: list[PPoly], breaks: list[float]) -> PPoly:
    """One PPoly of all pieces, whose first and last cells reach the jumps."""
    degree = max(piece.c.shape[0] for piece in pieces)
    cells, knots = [], [breaks[0]]
    for piece, low, high in zip(pieces, breaks[:-1], breaks[1:], strict=True):
        inner = piece.x[(piece.x > low) & (piece.x < high)]
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
