"""Whether points can be a profile of their kind (frames: profile.py); messages with mends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.errors import ProfileError

FloatArray = NDArray[np.float64]

MINIMUM_POINTS = 8
_MINIMUM_SPAN = 2e-3
_MAXIMUM_SPAN = 0.3
_MAXIMUM_HEIGHT = 0.3
_DATUM_TOLERANCE = 5e-3
RAIL_TOP_RANGE = 0.03
_RAIL_FALL = 4e-3


def check_points(name: str, y: FloatArray, z: FloatArray) -> None:
    """Raise ProfileError unless y, z [m] are enough points, finite, in order, of plausible size."""
    if len(y) != len(z):
        raise ProfileError(f"{name}: {len(y)} values of y but {len(z)} of z; give pairs")
    if len(y) < MINIMUM_POINTS:
        raise ProfileError(f"{name}: {len(y)} points; give at least {MINIMUM_POINTS}")
    for label, values in (("y", y), ("z", z)):
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            raise ProfileError(
                f"{name}: {label} of point {bad[0] + 1} is {values[bad[0]]}; remove the point"
            )
    steps = np.diff(y)
    bad = np.flatnonzero(steps <= 0.0)
    if len(bad):
        i = int(bad[0])
        fault = "repeats" if steps[i] == 0.0 else "runs back from"
        raise ProfileError(
            f"{name}: y of point {i + 2} ({y[i + 1]:g} m) {fault} that of point {i + 1} "
            f"({y[i]:g} m); sort the points by y and remove double ones"
        )
    span = float(y[-1] - y[0])
    height = float(np.ptp(z))
    if not _MINIMUM_SPAN <= span <= _MAXIMUM_SPAN or height > _MAXIMUM_HEIGHT:
        raise ProfileError(
            f"{name}: the profile is {span:g} m wide and {height:g} m high; "
            f"a profile is 2 to 300 mm wide. {size_hint(max(span, height))}"
        )
    if float(np.min(steps)) < 1e-12:
        i = int(np.argmin(steps))
        raise ProfileError(
            f"{name}: points {i + 1} and {i + 2} are {steps[i]:g} m apart in y; remove one"
        )


def size_hint(span: float) -> str:
    """A guess, in words, which unit was meant when a profile is `span` metres wide."""
    guesses = (
        *(("mm", 1e-3), ("inch", 0.0254), ("metres, read as mm", 1e3), ("cm", 1e-2)),
        ("inch", 25.4),
    )
    for unit, factor in guesses:
        if 0.03 <= span * factor <= 0.2:
            return f"The numbers look like {unit}: name the unit."
    return "Check the unit."


def check_kind(name: str, kind: str, y: FloatArray, z: FloatArray) -> None:
    """Raise ProfileError unless the points [m] look like a wheel or a rail in its own frame."""
    top = int(np.argmax(z))
    lowest = int(np.argmin(z))
    falls = min(z[top] - z[0], z[top] - z[-1])
    head_like = falls > _RAIL_FALL and 0 < top < len(z) - 1
    if kind == "wheel":
        if head_like and y[0] < y[top] < y[-1] and abs(y[top]) <= 0.6 * max(-y[0], y[-1]):
            raise ProfileError(
                f"{name}: given as a wheel, but it falls by {1e3 * falls:.1f} mm or more to both "
                "sides as a rail head does; say kind='rail'"
            )
        if not y[0] < 0.0 < y[-1]:
            raise ProfileError(
                f"{name}: y reaches from {1e3 * y[0]:.2f} to {1e3 * y[-1]:.2f} mm and leaves out "
                "the tape circle y = 0; shift the profile so that y = 0 lies on the tape circle"
            )
        datum = float(np.interp(0.0, y, z))
        if z[top] - datum > max(0.015, datum - z[lowest]):
            side = "" if y[top] < 0.0 else " and mirror y"
            raise ProfileError(
                f"{name}: the flange points up (z = {1e3 * z[top]:.2f} mm at "
                f"y = {1e3 * y[top]:.2f} mm); z is up and the flange tip below: turn the sign of z"
                + side
            )
        if y[lowest] > 0.0 and z[-1] < z[0] and np.ptp(z) > 1e-6:
            raise ProfileError(
                f"{name}: the lowest point lies at y = {1e3 * y[lowest]:.2f} mm, on the field "
                "side; the flange belongs to y < 0: mirror y"
            )
        if abs(datum) > _DATUM_TOLERANCE:
            raise ProfileError(
                f"{name}: z = {1e3 * datum:.2f} mm at the tape circle y = 0; it is 0 there: shift z"
            )
        return
    if abs(z[top]) > _DATUM_TOLERANCE:
        raise ProfileError(
            f"{name}: the top lies at z = {1e3 * z[top]:.2f} mm; it is z = 0 on a rail: shift z, "
            "or turn its sign if z points down"
        )
    if abs(y[top]) > RAIL_TOP_RANGE or not 0 < top < len(z) - 1:
        raise ProfileError(
            f"{name}: given as a rail, but the highest point lies at y = {1e3 * y[top]:.2f} mm "
            f"in the range {1e3 * y[0]:.2f} to {1e3 * y[-1]:.2f} mm; a rail has it near y = 0 "
            "and falls to both sides: say kind='wheel', shift y, or turn the sign of z"
        )


def advancing_part(y: FloatArray, z: FloatArray) -> slice:
    """The stretch of points around y = 0 over which y advances by 1e-4 of the length or more."""
    steps = np.diff(y)
    good = steps > 1e-4 * np.hypot(steps, np.diff(z))
    start = int(np.argmin(np.abs(y) + np.where(np.append(good, False), 0.0, 1e3)))
    bad = np.flatnonzero(~good)
    before, after = bad[bad < start], bad[bad >= start]
    first = int(before[-1]) + 1 if len(before) else 0
    last = int(after[0]) + 1 if len(after) else len(y)
    return slice(first, last)
