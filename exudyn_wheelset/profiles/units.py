"""The unit of a file's numbers: named, or told by the width of the profile."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles.formats.raw import UNITS, RawProfile, fault, listed, unit_word
from exudyn_wheelset.profiles.plausible import size_hint

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_GREATEST_SPAN = 0.3


def unit_factor(
    raw: RawProfile,
    points: FloatArray,
    lines: IntArray,
    label: str,
    asked: str | None,
    remarks: list[str],
) -> float:
    """Metres per number of the file; the unit is named, or told by the width of the profile."""
    unit = raw.unit
    if asked is not None:
        unit = unit_word(asked)
        if unit is None:
            raise ProfileError(f"{label}: unit={asked!r}; use 'mm', 'm', 'cm', 'um' or 'inch'")
        if raw.unit not in (None, unit):
            remarks.append(f"read in {unit} as asked for, although the file says {raw.unit}")
    _check_lost_points(points, lines, label)
    width = float(np.max(np.ptp(points, axis=0)))
    if unit is None:
        if 15.0 <= width <= 1e3 * _GREATEST_SPAN:
            unit = "mm"
        elif 0.015 <= width <= _GREATEST_SPAN:
            unit = "m"
        else:
            likely = [name for name, size in UNITS.items() if 0.06 <= width * size <= 0.2]
            asked_for = f"unit={likely[0]!r}, if it is that" if likely else "unit="
            raise fault(
                label,
                int(lines[0]),
                f"the numbers are {width:g} wide, which fits neither mm nor m; "
                f"add '# unit: mm' (m, cm, um, inch) on top, or give {asked_for}",
            )
        remarks.append(f"taken as {unit}, because the numbers are {width:g} wide")
    factor = UNITS[unit]
    if not 2e-3 <= width * factor <= _GREATEST_SPAN:
        raise fault(
            label,
            raw.unit_line or int(lines[0]),
            f"in {unit} the profile is {width * factor:g} m wide; one is 2 to 300 mm wide. "
            + size_hint(width * factor),
        )
    return factor


def _check_lost_points(points: FloatArray, lines: IntArray, label: str) -> None:
    """Name the lines of points that lie far from all others, before the unit is blamed."""
    centre = np.median(points, axis=0)
    distance = np.max(np.abs(points - centre), axis=1)
    typical = float(np.quantile(distance, 0.9))
    far = np.flatnonzero(distance > 20.0 * max(typical, 1e-12))
    if len(far) and typical > 0.0:
        y, z = points[far[0]]
        more = (
            f" (so do lines {listed([str(lines[i]) for i in far[1:]], 100)})"
            if far[1:].size
            else ""
        )
        raise fault(
            label,
            int(lines[far[0]]),
            f"the point y = {y:g}, z = {z:g} lies far from all others{more}; "
            "mend or delete the line",
        )
