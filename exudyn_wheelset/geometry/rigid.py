"""Rigid contact geometry: how a wheelset lies on its rails for each lateral shift.

Source: the search of Wang (1984) as in section 2.2 of the paper: the wheelset, shifted by y and
yawed, is lifted and rolled until the least vertical distances between wheel and rail agree on
both sides; lowering it by that distance gives the contact. Two methods find the roll angle:
- "root": bracketed root of the difference of the two distances, which grows with the roll angle;
- "nelder-mead": the paper's minimisation, |d_L - d_R| for single-point contact, and for
  double-point contact on one side the weighted sum |d_1 - d_R| + |d_2 - d_R| + |d_1 - d_2|.
docs/decisions/rigid-contact-by-bracketed-root.md compares them.

Track frame, SI, roll about x (positive lifts the left wheel), yaw about z.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize

from exudyn_wheelset.checking import finite_array, numbers
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.contact.layout import Axle, side_of
from exudyn_wheelset.contact.locus import wheel_point
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.errors import ContactError, WheelsetError
from exudyn_wheelset.geometry.gap import gap_difference, least_gap
from exudyn_wheelset.geometry.roughness import warn_if_rough
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.spelling import spelt

METHODS = ("root", "nelder-mead")
_ROLL_RANGE = 0.12
# The bracket walks in small steps as far as flange contact rolls a wheelset, then in growing ones.
_ROLL_STEP = 4.0e-4
_WALKED_ROLL = 0.015
# Where the contact turns steep (r0 tan(contact angle) against the tape circles' distance) the
# difference of the distances falls with roll and may vanish at several angles. A step over which
# it rises as its slopes at both ends say, but for this share, hides no such fold; others are cut,
# down to a step that tells them apart.
_STRAIGHT = 0.15
_LEAST_ROLL_STEP = 5.0e-5
_SIDE_WIDTH = 7


@brief
@dataclass(frozen=True)
class ContactSide:
    """Contact points of one side, arrays of the shape of y; positions towards the field side.

    wheel_y [m] from the tape circle; rail_y [m] from the rail's highest point; angle [rad] of the
    contact plane, positive where it falls towards the track centre; radius [m] rolling radius;
    lead [m] x of the contact from the axle's centre; second_wheel_y, second_rail_y [m] and
    second_gap [m]: the next local minimum of the distance and its remaining gap (NaN if none), a
    double-point contact where the gap is zero.
    """

    wheel_y: np.ndarray
    rail_y: np.ndarray
    angle: np.ndarray
    radius: np.ndarray
    lead: np.ndarray
    second_wheel_y: np.ndarray
    second_rail_y: np.ndarray
    second_gap: np.ndarray


@brief
@dataclass(frozen=True)
class ContactGeometry:
    """Rigid contact of a wheelset over its lateral shift.

    y [m], yaw [rad]: the input; roll [rad]; z [m]: height of the centre above (rail tops +
    nominal radius); left, right: contact points.
    """

    y: np.ndarray
    yaw: np.ndarray
    roll: np.ndarray
    z: np.ndarray
    left: ContactSide
    right: ContactSide

    @property
    def rolling_radius_difference(self) -> np.ndarray:
        """r_left - r_right [m], positive for a shift to the left of a conical wheelset."""
        return self.left.radius - self.right.radius

    def double_point_contact(self, tolerance: float = 1.0e-6) -> np.ndarray:
        """True where either side has a second contact within `tolerance` [m] of touching."""
        with np.errstate(invalid="ignore"):
            return (self.left.second_gap < tolerance) | (self.right.second_gap < tolerance)


@compiled
def _crest(table, y, yaw, direction, one, other):
    """Roll angle between two where direction times the difference is not negative, or NaN.

    Golden section towards the maximum.
    """
    ratio = 0.6180339887498949
    inner = other - ratio * (other - one)
    outer = one + ratio * (other - one)
    f_inner = direction * gap_difference(table, y, inner, yaw)[0]
    f_outer = direction * gap_difference(table, y, outer, yaw)[0]
    for _ in range(36):
        if f_inner >= 0.0:
            return inner
        if f_outer >= 0.0:
            return outer
        if f_inner > f_outer:
            other, outer, f_outer = outer, inner, f_inner
            inner = other - ratio * (other - one)
            f_inner = direction * gap_difference(table, y, inner, yaw)[0]
        else:
            one, inner, f_inner = inner, outer, f_outer
            outer = one + ratio * (other - one)
            f_outer = direction * gap_difference(table, y, outer, yaw)[0]
    return np.nan


@compiled
def _roll_root(table, y, yaw, guess):
    """Roll angle at which both distances agree, or NaN without contact in range.

    A steep flange may agree at several angles: the first one on the way from `guess` is taken.
    """
    near = before = guess
    difference, slope_near = gap_difference(table, y, guess, yaw)
    direction = 1.0 if difference <= 0.0 else -1.0
    f_near = f_before = direction * difference
    step = 0.5 * _ROLL_STEP
    while True:
        far = near + direction * step
        difference, slope_far = gap_difference(table, y, far, yaw)
        f_far = direction * difference
        if not (-np.inf < f_near and -np.inf < f_far < np.inf) or step > _ROLL_RANGE:
            return np.nan
        walks = abs(near - guess) < _WALKED_ROLL
        mean = 0.5 * (slope_near + slope_far)
        straight = (
            min(slope_near, slope_far) > 0.0
            and abs(f_far - f_near - mean * step) < _STRAIGHT * mean * step
        )
        if walks and not straight and step > _LEAST_ROLL_STEP:
            step = max(0.25 * step, _LEAST_ROLL_STEP)
            continue
        if f_far >= 0.0:
            break
        if f_near >= f_before and f_near > f_far:
            crest = _crest(table, y, yaw, direction, before, far)
            if crest == crest:
                near, f_near, far = before, f_before, crest
                f_far = direction * gap_difference(table, y, far, yaw)[0]
                break
        before, f_before, near, f_near, slope_near = near, f_near, far, f_far, slope_far
        if not walks:
            step *= 1.5
        elif straight:
            step = min(2.0 * step, _ROLL_STEP)
    if direction > 0.0:
        low, f_low, high, f_high = near, f_near, far, f_far
    else:
        low, f_low, high, f_high = far, -f_far, near, -f_near
    side = 0
    for _ in range(80):
        if high - low < 1.0e-13 or f_high == f_low:
            break
        trial = high - f_high * (high - low) / (f_high - f_low)
        if not (low < trial < high):
            trial = 0.5 * (low + high)
        f = gap_difference(table, y, trial, yaw)[0]
        if f == 0.0:
            return trial
        # Illinois: a retained end that holds the root back counts half.
        if f > 0.0:
            high, f_high = trial, f
            if side == 1:
                f_low *= 0.5
            side = 1
        else:
            low, f_low = trial, f
            if side == -1:
                f_high *= 0.5
            side = -1
        if abs(f) < 1.0e-15:
            return trial
    return 0.5 * (low + high)


@compiled
def _fill_side(table, hand, y, lx, ly, lz, row):
    gap, arc, at, second, second_arc, second_at = least_gap(table, hand, y, lx, ly, lz)
    side = side_of(table, hand)
    axle = Axle(y, 0.0, lx, ly, lz)
    x, _, _, ny, nz, radius, wheel_y, _ = wheel_point(table, side, arc, axle)
    row[0] = wheel_y
    row[1] = curve_point(table, side.rail, at)[0] - side.datum
    row[2] = math.atan2(ny, -nz)
    row[3] = radius
    row[4] = x
    if second < np.inf:
        row[5] = wheel_point(table, side, second_arc, axle)[6]
        row[6] = curve_point(table, side.rail, second_at)[0] - side.datum
    else:
        row[5] = row[6] = np.nan
    return gap, second - gap if second < np.inf else np.nan


@compiled
def _geometry(table, y, yaw, order, roll, known, heights, left, right, second):
    """Fill the arrays; `known` says that roll is given and only the points are wanted.

    order: of the shifts from the centre outwards, so that a shift's contact is the one which the
    wheelset reaches from the centre, whatever the order of y.
    """
    guess_left = guess_right = 0.0
    for k in order:
        if not known:
            guess = guess_left if y[k] >= 0.0 else guess_right
            roll[k] = _roll_root(table, y[k], yaw[k], guess)
            if roll[k] != roll[k]:
                return k
            if y[k] >= 0.0:
                guess_left = roll[k]
            else:
                guess_right = roll[k]
        lx = -math.sin(yaw[k]) * math.cos(roll[k])
        ly = math.cos(yaw[k]) * math.cos(roll[k])
        lz = math.sin(roll[k])
        gap_left, second[k, 0] = _fill_side(table, 0, y[k], lx, ly, lz, left[k])
        gap_right, second[k, 1] = _fill_side(table, 1, -y[k], -lx, ly, -lz, right[k])
        heights[k] = -0.5 * (gap_left + gap_right) - side_of(table, 0).radius
        if heights[k] != heights[k]:
            return k
    return -1


@spelt
def contact_geometry(
    wheelset: Wheelset,
    track: Track,
    y: ArrayLike,
    yaw: ArrayLike = 0.0,
    method: str = "root",
    weights: tuple[float, float, float] = (1.0, 1.0, 1.0),
) -> ContactGeometry:
    """Return the rigid contact of `wheelset` on `track` for lateral shifts y.

    y [m] positive to the left, yaw [rad] positive nose left; both broadcast. method: "root" or
    "nelder-mead" (the paper's). weights: of the three differences of the double-point objective
    of "nelder-mead".
    Raises ContactError where no roll angle brings both wheels onto their rails. WheelsetWarning
    where contact jumps from crest to crest of a profile's measurement noise.

    Examples
    --------
    >>> from exudyn_wheelset import Track, Wheelset, contact_geometry
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    >>> found = contact_geometry(axle, Track("UIC60"), y=[0.0, 0.003])
    >>> (1e3 * found.rolling_radius_difference).round(2)  # [mm]
    array([0.  , 0.99])
    """
    weights = numbers("weights", weights, 3, "-", 0.0)  # type: ignore[assignment]
    found = searched_geometry(wheelset, track, y, yaw, method, weights)
    places = np.column_stack((found.left.wheel_y, found.right.wheel_y))
    warn_if_rough(wheelset, track, found.y, places)
    return found


def searched_geometry(
    wheelset: Wheelset,
    track: Track,
    y: ArrayLike,
    yaw: ArrayLike = 0.0,
    method: str = "root",
    weights: tuple[float, float, float] = (1.0, 1.0, 1.0),
) -> ContactGeometry:
    """As `contact_geometry`, without a warning: for searches that call it many times."""
    if method not in METHODS:
        raise WheelsetError(f"method {method!r} is unknown: use one of {', '.join(METHODS)}")
    if not isinstance(wheelset, Wheelset) or not isinstance(track, Track):
        raise WheelsetError(
            f"wheelset = {wheelset!r}, track = {track!r}: give a Wheelset and a Track"
        )
    try:
        shifts, yaws = np.broadcast_arrays(
            np.atleast_1d(finite_array("y", y, "m")), finite_array("yaw", yaw, "rad")
        )
    except WheelsetError:
        raise
    except ValueError as error:
        raise WheelsetError(
            f"y = {y!r}, yaw = {yaw!r}: give numbers [m, rad] of one shape ({error})"
        ) from None
    if np.any(np.abs(yaws) > 0.3):
        raise WheelsetError(f"yaw up to {np.abs(yaws).max():g} rad: give radians within +-0.3")
    shifts = np.array(shifts)
    yaws = np.array(yaws)
    table = contact_tables(wheelset, track)
    size = len(shifts)
    roll, heights = np.zeros(size), np.zeros(size)
    left, right = np.zeros((size, _SIDE_WIDTH)), np.zeros((size, _SIDE_WIDTH))
    second = np.zeros((size, 2))
    known = method == "nelder-mead"
    if known:
        roll[:] = [
            _roll_by_nelder_mead(table, shift, angle, weights)
            for shift, angle in zip(shifts, yaws, strict=True)
        ]
    order = np.argsort(np.abs(shifts), kind="stable")
    failed = _geometry(table, shifts, yaws, order, roll, known, heights, left, right, second)
    if failed >= 0:
        raise ContactError(
            f"no rigid contact at y = {shifts[failed] * 1e3:.3f} mm, "
            f"yaw = {yaws[failed] * 1e3:.3f} mrad: a wheel has left its rail; "
            "give a smaller shift or check gauge and tape_half_distance"
        )
    return ContactGeometry(
        shifts, yaws, roll, heights, _side(left, second[:, 0]), _side(right, second[:, 1])
    )


def _side(rows: np.ndarray, second_gap: np.ndarray) -> ContactSide:
    c = rows.T.copy()
    return ContactSide(c[0], c[1], c[2], c[3], c[4], c[5], c[6], second_gap)


def _roll_by_nelder_mead(
    table: np.ndarray, y: float, yaw: float, weights: tuple[float, float, float]
) -> float:
    """Roll angle that minimises the paper's objective (section 2.2)."""

    def single(x: np.ndarray) -> float:
        return abs(gap_difference(table, y, float(x[0]), yaw)[0])

    def double(x: np.ndarray) -> float:
        roll = float(x[0])
        cosine, lz = math.cos(roll), math.sin(roll)
        lx, ly = -math.sin(yaw) * cosine, math.cos(yaw) * cosine
        left = least_gap(table, 0, y, lx, ly, lz)
        right = least_gap(table, 1, -y, -lx, ly, -lz)
        one, other = (left, right) if left[3] - left[0] <= right[3] - right[0] else (right, left)
        if not np.isfinite(one[3]):
            return abs(one[0] - other[0])
        first, second, third = weights
        return (
            first * abs(one[0] - other[0])
            + second * abs(one[3] - other[0])
            + third * abs(one[0] - one[3])
        )

    options = {"xatol": 1e-12, "fatol": 1e-15, "maxiter": 400, "maxfev": 800}
    start = np.array([[0.0], [1e-3]])
    found = minimize(
        single, [0.0], method="Nelder-Mead", options={**options, "initial_simplex": start}
    )
    roll = float(found.x[0])
    cosine, lz = math.cos(roll), math.sin(roll)
    lx, ly = -math.sin(yaw) * cosine, math.cos(yaw) * cosine
    left = least_gap(table, 0, y, lx, ly, lz)
    right = least_gap(table, 1, -y, -lx, ly, -lz)
    if min(left[3] - left[0], right[3] - right[0]) < 1e-7:
        around = np.array([[roll], [roll + 1e-5]])
        found = minimize(
            double, [roll], method="Nelder-Mead", options={**options, "initial_simplex": around}
        )
        roll = float(found.x[0])
    return roll
