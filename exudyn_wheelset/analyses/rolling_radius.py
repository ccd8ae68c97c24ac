"""Rolling-radius difference of a wheelset over its lateral shift, with and without roll.

Physical idea: a wheelset that shifts to one side rolls on unlike radii. It also rolls about x, as
the side whose contact climbs its flange lifts. y is the shift of the axle's centre, so roll moves
the wheels over the rails by a further r0 times the roll angle: 0.02 mm on the tread, millimetres
on a climbing flange. EN 15302's reference values leave roll out; `neglect_roll` does so too, by
holding the axle level. docs/conicity.md compares both.

Track frame, SI, y positive to the left, yaw 0.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.contact.locus import wheel_point
from exudyn_wheelset.contact.rigid import contact_geometry, least_gap
from exudyn_wheelset.contact.tables import HEADER, contact_tables
from exudyn_wheelset.errors import ContactError, WheelsetError

FloatArray = NDArray[np.float64]


def rolling_radius_difference(
    wheelset: Wheelset, track: Track, y: ArrayLike, neglect_roll: bool = False
) -> FloatArray:
    """Return r_left - r_right [m] of the rigid contact at shifts y, shape (n,) [m], yaw 0.

    neglect_roll holds the axle level, so each wheel touches where its own vertical distance to the
    rail is least: the assumption behind EN 15302's reference values.
    Raises ContactError where a wheel has left its rail.
    """
    if not neglect_roll:
        return contact_geometry(wheelset, track, y).rolling_radius_difference
    shifts = np.atleast_1d(np.asarray(y, dtype=float))
    if not np.all(np.isfinite(shifts)):
        raise WheelsetError("y must be finite numbers [m]")
    difference = np.empty_like(shifts)
    _level_axle(contact_tables(wheelset, track), shifts, difference)
    lost = np.flatnonzero(np.isnan(difference))
    if len(lost):
        raise ContactError(
            f"no contact with a level axle at y = {shifts[lost[0]] * 1e3:.3f} mm: a wheel has left "
            "its rail; give a smaller shift or check gauge and tape_half_distance"
        )
    return difference


def contact_range(
    wheelset: Wheelset, track: Track, reach: float, step: float = 1.0e-4
) -> tuple[float, float]:
    """Return the shifts [m] to the right (negative) and left up to which both wheels touch.

    reach [m]: farthest shift of interest; step [m]: the ends' resolution.
    Raises ContactError where there is no contact even near y = 0.
    """
    for what, value in (("reach", reach), ("step", step)):
        if not 0.0 < value <= 0.1:
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


@njit(cache=True, error_model="numpy")
def _level_axle(table, y, difference):
    """Radius difference with the axle parallel to the plane of the rail tops."""
    for k in range(len(y)):
        left = least_gap(table, 0, y[k], 0.0, 1.0, 0.0)[1]
        right = least_gap(table, HEADER, -y[k], 0.0, 1.0, 0.0)[1]
        difference[k] = (
            wheel_point(table, 0, left, y[k], 0.0, 0.0, 1.0, 0.0)[5]
            - wheel_point(table, HEADER, right, -y[k], 0.0, 0.0, 1.0, 0.0)[5]
        )
