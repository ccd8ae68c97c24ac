"""Rolling-radius difference of a wheelset over its lateral shift, and which shift is meant.

Physical idea: a wheelset that shifts to one side rolls on unlike radii. It also rolls about x, as
the side whose contact climbs its flange lifts, and turns about its centre by doing so: where the
centre has moved by y, the wheels stand y + r0 roll off the rails' middle. That is 0.02 mm more on
the tread, millimetres more on a climbing flange. So a shift is one of

    "rail"   y + r0 roll, where the wheels stand on the rails: what the wheelset's path is;
    "axle"   y of the axle's centre;
    "level"  roll left out, each wheel touching alone: what EN 15302's reference values assume.

docs/conicity.md compares them. Track frame, SI, y positive to the left, yaw 0.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from exudyn_wheelset.checking import finite_array, number
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.contact.layout import Axle, side_of
from exudyn_wheelset.contact.locus import wheel_point
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.errors import ContactError, WheelsetError
from exudyn_wheelset.geometry.gap import least_gap
from exudyn_wheelset.geometry.rigid import (
    ContactGeometry,
    ContactSide,
    contact_geometry,
)
from exudyn_wheelset.spelling import spelt

FloatArray = NDArray[np.float64]


SHIFTS = ("rail", "axle", "level")


class ShiftCurve(NamedTuple):
    """Rolling-radius difference [m] over the shift y [m], and the contact it comes from."""

    y: FloatArray
    rolling_radius_difference: FloatArray
    geometry: ContactGeometry


@spelt
def rolling_radius_curve(
    wheelset: Wheelset,
    track: Track,
    reach: float = 15.0e-3,
    spacing: float = 2.0e-5,
    shift: str = "rail",
) -> ShiftCurve:
    """Return r_left - r_right [m] over the shift, as far as both wheels touch: for conicity.

    reach [m]: largest shift of the axle's centre; spacing [m] between its shifts; shift: "rail",
    "axle" or "level", see the module's header. `y` and `rolling_radius_difference` of the result
    are what `equivalent_conicity` takes; `geometry` is the contact over the axle's centre.
    Raises ContactError where there is no contact even near the centre.

    Examples
    --------
    >>> from exudyn_wheelset import Track, Wheelset, equivalent_conicity, rolling_radius_curve
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    >>> y, difference, geometry = rolling_radius_curve(axle, Track("UIC60"), reach=5e-3)
    >>> float(equivalent_conicity(y, difference, 3e-3).round(2))
    0.18
    """
    if shift not in SHIFTS:
        raise WheelsetError(f"shift {shift!r} is unknown: use one of {', '.join(SHIFTS)}")
    if not 0.0 < number("spacing", spacing, "m") <= number("reach", reach, "m"):
        raise WheelsetError(f"spacing = {spacing!r} m: give a positive length below reach, in m")
    low, high = contact_range(wheelset, track, reach)
    y = spacing * np.arange(np.ceil(low / spacing), np.floor(high / spacing) + 1)
    find = level_contact_geometry if shift == "level" else contact_geometry
    geometry = find(wheelset, track, y)
    if shift == "rail":
        right_radius = wheelset.right_radius or wheelset.radius
        y = y + 0.5 * (wheelset.radius + right_radius) * geometry.roll
    return ShiftCurve(y, geometry.rolling_radius_difference, geometry)


def rolling_radius_difference(
    wheelset: Wheelset, track: Track, y: ArrayLike, neglect_roll: bool = False
) -> FloatArray:
    """Return r_left - r_right [m] of the rigid contact at shifts y, shape (n,) [m], yaw 0.

    y: of the axle's centre (`rolling_radius_curve` has that at rail level); neglect_roll holds the
    axle level, see `level_contact_geometry`.
    Raises ContactError where a wheel has left its rail.
    """
    geometry = level_contact_geometry if neglect_roll else contact_geometry
    return geometry(wheelset, track, y).rolling_radius_difference


def level_contact_geometry(wheelset: Wheelset, track: Track, y: ArrayLike) -> ContactGeometry:
    """Return the contact of each wheel alone with a level axle at shifts y, shape (n,) [m], yaw 0.

    Each wheel touches where its own vertical distance to the rail is least, and the heights of both
    sides do not agree: the assumption behind EN 15302's reference values. z is the mean of both.
    Raises ContactError where a wheel has left its rail.
    """
    shifts = np.atleast_1d(finite_array("y", y, "m"))
    sides = np.full((2, len(shifts), 9), np.nan)
    table = contact_tables(wheelset, track)
    _level_side(table, 0, shifts, sides[0])
    _level_side(table, 1, -shifts, sides[1])
    lost = np.flatnonzero(np.isnan(sides[:, :, 0]).any(axis=0))
    if len(lost):
        raise ContactError(
            f"no contact with a level axle at y = {shifts[lost[0]] * 1e3:.3f} mm: a wheel has left "
            "its rail; give a smaller shift or check gauge and tape_half_distance"
        )
    left, right = (ContactSide(*rows[:, 1:].T.copy()) for rows in sides)
    heights = -0.5 * (sides[0, :, 0] + sides[1, :, 0]) - wheelset.radius
    level = np.zeros(len(shifts))
    return ContactGeometry(shifts, level, level.copy(), heights, left, right)


def contact_range(
    wheelset: Wheelset, track: Track, reach: float, step: float = 1.0e-4
) -> tuple[float, float]:
    """Return the shifts [m] to the right (negative) and left up to which both wheels touch.

    reach [m]: farthest shift of interest; step [m]: the ends' resolution.
    Raises ContactError where there is no contact even near y = 0.
    """
    for what, value in (("reach", reach), ("step", step)):
        if not 0.0 < number(what, value, "m") <= 0.1:
            raise WheelsetError(f"{what} = {value!r} m: give a positive shift in m, up to 0.1")

    def touches(shift: float) -> bool:
        try:
            contact_geometry(wheelset, track, shift)
        except ContactError:
            return False
        return True

    contact_geometry(wheelset, track, 0.0)
    ends = []
    for sign in (-1.0, 1.0):
        inside, outside = 0, math.ceil(reach / step)
        if touches(sign * reach):
            ends.append(sign * reach)
            continue
        while outside - inside > 1:
            middle = (inside + outside) // 2
            if touches(sign * middle * step):
                inside = middle
            else:
                outside = middle
        ends.append(sign * inside * step)
    return ends[0], ends[1]


@compiled
def _level_side(table, hand, y, rows):
    """Fill gap and the fields of ContactSide; NaN where there is no contact."""
    side = side_of(table, hand)
    for k in range(len(y)):
        gap, arc, at, second, second_arc, second_at = least_gap(table, hand, y[k], 0.0, 1.0, 0.0)
        if not gap < np.inf:
            continue
        row = rows[k]
        axle = Axle(y[k], 0.0, 0.0, 1.0, 0.0)
        x, _, _, ny, nz, radius, wheel_y, _ = wheel_point(table, side, arc, axle)
        row[0] = gap
        row[1] = wheel_y
        row[2] = curve_point(table, side.rail, at)[0] - side.datum
        row[3] = math.atan2(ny, -nz)
        row[4] = radius
        row[5] = x
        if second < np.inf:
            row[6] = wheel_point(table, side, second_arc, axle)[6]
            row[7] = curve_point(table, side.rail, second_at)[0] - side.datum
            row[8] = second - gap
