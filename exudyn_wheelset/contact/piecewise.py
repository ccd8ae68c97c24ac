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

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.contact.rigid import ContactGeometry, contact_geometry
from exudyn_wheelset.errors import WheelsetError

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
    moving = np.abs(np.diff(values[:, [2, 3, 6, 7]], axis=0)).max(axis=1)
    breaks, pieces, degrees, residuals = [y[0]], [], [], []
    jumps = []
    first = 0
    for last in [*np.flatnonzero(moving > JUMP), count - 1]:
        piece = slice(first, last + 1)
        if last < count - 1:
            jumps.append(_locate_jump(wheelset, track, y[last], y[last + 1]))
            end = jumps[-1]
        else:
            end = y[-1]
        curve, degree = _smooth_piece(
            y[piece], values[piece], breaks[-1], end, representation, tolerance, highest_degree
        )
        residuals.append(np.abs(curve(y[piece]) - values[piece]).max(axis=0))
        pieces.append(curve)
        degrees.append(degree)
        breaks.append(end)
        first = last + 1
    return PiecewiseGeometry(
        np.array(jumps), _join(pieces, breaks), tuple(degrees), np.array(residuals)
    )


def _locate_jump(wheelset: Wheelset, track: Track, low: float, high: float) -> float:
    """Shift at which the contact point jumps, by bisection."""
    reference = geometry_columns(contact_geometry(wheelset, track, [low]))[0, [2, 3, 6, 7]]
    for _ in range(24):
        middle = 0.5 * (low + high)
        here = geometry_columns(contact_geometry(wheelset, track, [middle]))[0, [2, 3, 6, 7]]
        if np.abs(here - reference).max() > 0.5 * JUMP:
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def _smooth_piece(y, values, low, high, representation, tolerance, highest_degree):
    if len(y) < 4:
        degree = len(y) - 1
        fit = np.polynomial.Polynomial
        rows = [fit.fit(y, column, degree).convert(domain=[-1, 1]) for column in values.T]
        coefficients = np.array([row(np.zeros(1))[0] for row in rows]) if degree == 0 else None
        if coefficients is not None:
            return PPoly(coefficients[None, None, :], [low, high]), 0
        return _polynomial_piece(y, values, low, high, tolerance, degree), degree
    if representation == "cubic":
        spline = CubicSpline(y, values)
        return PPoly(spline.c, spline.x), 3
    for degree in range(1, highest_degree + 1):
        piece = _polynomial_piece(y, values, low, high, tolerance, degree)
        allowed = tolerance * np.array([1, 1, 100, 100, 100, 1, 100, 100, 100, 1])
        if np.all(np.abs(piece(y) - values).max(axis=0) <= allowed):
            break
    return piece, degree


def _polynomial_piece(y, values, low, high, tolerance, degree):
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
        starts = np.concatenate([[low], inner])
        block = np.zeros((degree, len(starts), piece.c.shape[2]))
        for cell, start in enumerate(starts):
            for power in range(piece.c.shape[0]):
                scale = 1.0
                for k in range(2, power + 1):
                    scale *= k
                block[degree - 1 - power, cell] = piece(start, nu=power) / scale
        cells.append(block)
        knots.extend([*inner, high])
    return PPoly(np.concatenate(cells, axis=1), np.array(knots))
