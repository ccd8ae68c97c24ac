"""From the numbers of a file to a profile: units, order, overhang, outliers, orientation, datum.

What every format has in common. Faults that a reader of the file must mend are errors with the
line; what can be decided is decided, and said in the profile's remarks.

Order of the steps: unit to metres; outliers, if a tolerance is given; points in the direction of
growing y; overhanging ends cut off; kind and orientation from the shape; the caller's
shift; datum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles.curve import chord_length
from exudyn_wheelset.profiles.formats.raw import UNITS, RawProfile, fault, listed, unit_word
from exudyn_wheelset.profiles.orientation import look_at
from exudyn_wheelset.profiles.profile import KINDS, Profile, distance_to_neighbours, size_hint

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_CLOSEST = 1e-9
_GREATEST_SPAN = 0.3
_MOST_POINTS = 50_000
_DATUM_SHIFT = 5e-3
_STEEP = 3.0


@dataclass(frozen=True)
class Options:
    """What the caller says about a file; None where the file shall say it (see load_profile)."""

    kind: str | None = None
    unit: str | None = None
    smoothing: float = 0.0
    outlier_tolerance: float | None = None
    shift: tuple[float, float] = (0.0, 0.0)


def finish(raw: RawProfile, label: str, stem: str, options: Options) -> Profile:
    """The profile of a file; ProfileError names file, line and mend.

    label: how messages name the file; stem: the profile's name where the file gives none.
    """
    kind = options.kind or raw.kind
    if options.kind and raw.kind and options.kind != raw.kind:
        raise fault(
            label,
            raw.kind_line,
            f"the file holds a {raw.kind}, but kind={options.kind!r} was asked for",
        )
    if len(raw.y) < 8:
        raise fault(label, None, f"{len(raw.y)} points; a profile needs at least 8")
    if len(raw.y) > _MOST_POINTS:
        raise fault(label, None, f"{len(raw.y)} points; thin them out to {_MOST_POINTS} or fewer")
    remarks = list(raw.remarks)
    lines = np.array(raw.lines)
    points = np.column_stack((raw.y, raw.z)).astype(np.float64)
    points *= _unit_factor(raw, points, label, options.unit, remarks)

    _check_doubled(points, lines, label, options.outlier_tolerance)
    if options.outlier_tolerance is not None:
        keep = _without_outliers(points, options.outlier_tolerance, lines, label, remarks)
        points, lines = points[keep], lines[keep]
    if np.sum(np.diff(points[:, 0]) < 0.0) > 0.5 * len(points):
        points, lines = points[::-1], lines[::-1]
    keep_part = _advancing(points, lines, label, remarks)
    points, lines = points[keep_part], lines[keep_part]
    if len(points) < 8:
        raise fault(
            label, int(lines[0]), f"{len(points)} points left in one direction of y; 8 are needed"
        )
    y, z = points[:, 0], points[:, 1]

    place = raw.kind_line if raw.kind else int(lines[0])
    look = look_at(y, z)
    if kind is None:
        if look is None:
            raise fault(
                label,
                int(lines[0]),
                "the shape does not tell wheel from rail; add '# kind: wheel' (or rail) on top, "
                "or give kind=",
            )
        kind = look.kind
        remarks.append(f"taken as a {kind} by its shape")
    elif look is not None and look.kind != kind:
        raise fault(
            label,
            place,
            f"given as a {kind}, but the shape is that of a {look.kind}; say kind={look.kind!r}",
        )
    if not raw.trusted:
        y, z = _oriented(y, z, kind, raw, remarks)
    y, z = _shifted(y, z, kind, raw, options.shift, remarks)
    try:
        profile = Profile(
            raw.name or stem,
            kind,
            y,
            z,
            source=raw.source or f"{raw.format} file",
            smoothing=options.smoothing,
            remarks=remarks,
        )
        # Asked for here, so that points which allow no such curve are refused with their file.
        profile.span  # noqa: B018
        return profile
    except ProfileError as error:
        message = str(error).removeprefix(f"{raw.name or stem}: ")
        raise fault(label, place, message) from None


def _unit_factor(
    raw: RawProfile, points: FloatArray, label: str, asked: str | None, remarks: list[str]
) -> float:
    """Metres per number of the file; the unit is named, or told by the width of the profile."""
    unit = raw.unit
    if asked is not None:
        unit = unit_word(asked)
        if unit is None:
            raise ProfileError(f"{label}: unit={asked!r}; use 'mm', 'm', 'cm' or 'inch'")
        if raw.unit not in (None, unit):
            remarks.append(f"read in {unit} as asked for, although the file says {raw.unit}")
    _check_lost_points(raw, points, label, unit)
    width = float(np.max(np.ptp(points, axis=0)))
    if unit is None:
        if 15.0 <= width <= 1e3 * _GREATEST_SPAN:
            unit = "mm"
        elif 0.015 <= width <= _GREATEST_SPAN:
            unit = "m"
        else:
            raise fault(
                label,
                raw.lines[0],
                f"the numbers are {width:g} wide, which fits neither mm nor m; "
                "add '# unit: mm' (m, cm, inch) on top, or give unit=",
            )
        remarks.append(f"taken as {unit}, because the numbers are {width:g} wide")
    factor = UNITS[unit]
    if not 2e-3 <= width * factor <= _GREATEST_SPAN:
        raise fault(
            label,
            raw.unit_line or raw.lines[0],
            f"in {unit} the profile is {width * factor:g} m wide; one is 2 to 300 mm wide. "
            + size_hint(width * factor),
        )
    return factor


def _check_lost_points(raw: RawProfile, points: FloatArray, label: str, unit: str | None) -> None:
    """Name the line of a point that lies far from all others, before the unit is blamed."""
    centre = np.median(points, axis=0)
    distance = np.max(np.abs(points - centre), axis=1)
    typical = float(np.quantile(distance, 0.9))
    worst = int(np.argmax(distance))
    if distance[worst] > 20.0 * max(typical, 1e-12) and typical > 0.0:
        y, z = points[worst]
        raise fault(
            label,
            raw.lines[worst],
            f"the point y = {y:g}, z = {z:g} lies far from all others; mend or delete the line",
        )


def _check_doubled(
    points: FloatArray, lines: IntArray, label: str, tolerance: float | None
) -> None:
    same = np.flatnonzero(np.max(np.abs(np.diff(points, axis=0)), axis=1) < _CLOSEST)
    if len(same) and tolerance is None:
        i = int(same[0])
        raise fault(
            label,
            int(lines[i + 1]),
            f"repeats the point of line {lines[i]}; delete one of the two"
            + (f" ({len(same)} such lines)" if len(same) > 1 else ""),
        )


def _without_outliers(
    points: FloatArray, tolerance: float, lines: IntArray, label: str, remarks: list[str]
) -> IntArray:
    """Indices of the points within `tolerance` [m] of the curve through their neighbours."""
    if not tolerance > 0.0:
        raise ProfileError(f"{label}: outlier_tolerance = {tolerance:g} m; use a positive distance")
    keep = np.arange(len(points))
    t = chord_length(points)
    keep = keep[np.concatenate(([True], np.diff(t) > _CLOSEST))]
    doubled = len(points) - len(keep)
    if doubled:
        remarks.append(f"{doubled} doubled points left out")
    dropped: list[int] = []
    while len(keep) >= 8:
        distance = distance_to_neighbours(points[keep])
        worst = np.flatnonzero(distance > tolerance)
        if not len(worst):
            break
        gone = np.zeros(len(keep) + 4, dtype=bool)
        for i in worst[np.argsort(-distance[worst])]:
            if not np.any(gone[max(i - 2, 0) : i + 3]):
                gone[i] = True
        dropped += [int(lines[i]) for i in keep[gone[: len(keep)]]]
        keep = keep[~gone[: len(keep)]]
    if 5 * len(dropped) > len(points) or len(keep) < 8:
        raise fault(
            label,
            min(dropped),
            f"more than a fifth of the points lie farther than {tolerance:g} m from their "
            "neighbours; raise outlier_tolerance",
        )
    if dropped:
        words = [str(line) for line in sorted(dropped)]
        remarks.append(
            f"{len(dropped)} outliers beyond {1e6 * tolerance:g} micrometres left out, "
            f"lines {listed(words, 10)}"
        )
    return keep


def _advancing(points: FloatArray, lines: IntArray, label: str, remarks: list[str]) -> slice:
    """The longest stretch of growing y; what lies before and after must be a steep end.

    A steep end (flange back, web of the rail) overhangs and is cut off; anything else is a
    fault in the order of the points.
    """
    steps = np.diff(points[:, 0])
    breaks = np.flatnonzero(steps <= _CLOSEST)
    if not len(breaks):
        return slice(0, len(points))
    starts = np.concatenate(([0], breaks + 1))
    ends = np.concatenate((breaks, [len(points) - 1]))
    longest = int(np.argmax(points[ends, 0] - points[starts, 0]))
    first, last = int(starts[longest]), int(ends[longest])
    for end, i in ((points[: first + 1], first), (points[last:], last + 1)):
        travel = np.sum(np.abs(np.diff(end, axis=0)), axis=0)
        if len(end) > 1 and not travel[1] > _STEEP * travel[0]:
            previous = max(i - 1, 0)
            fault_word = "repeats" if points[i, 0] == points[previous, 0] else "runs back from"
            raise fault(
                label,
                int(lines[i]),
                f"y {fault_word} that of line {lines[previous]}; sort the points along the "
                "profile and delete double ones, or give outlier_tolerance=",
            )
    cut = len(points) - (last + 1 - first)
    remarks.append(f"{cut} points of overhanging ends cut off")
    return slice(first, last + 1)


def _oriented(
    y: FloatArray, z: FloatArray, kind: str, raw: RawProfile, remarks: list[str]
) -> tuple[FloatArray, FloatArray]:
    look = look_at(y, z)
    y_sign, z_sign = (look.y_sign, look.z_sign) if look is not None else (1, 1)
    if look is None and kind == "rail" and np.median(z) < 0.5 * (z[0] + z[-1]):
        z_sign = -1
    if z_sign < 0:
        z = -z
        remarks.append("z turned up, as the shape shows")
    if y_sign < 0:
        y, z = -y[::-1], z[::-1]
        remarks.append("y turned, because the flange lay at y > 0")
    if kind == "rail" and raw.format == "two-column text":
        remarks.append("y taken towards the field side, which the shape of a rail cannot show")
    return y, z


def _shifted(
    y: FloatArray,
    z: FloatArray,
    kind: str,
    raw: RawProfile,
    shift: tuple[float, float],
    remarks: list[str],
) -> tuple[FloatArray, FloatArray]:
    if raw.rail_datum:
        top = float(np.max(z))
        z = z - top
        left, right = _at_depth(y, z, 0.014)
        y = y - 0.5 * (left + right)
        remarks.append("y = 0 put midway between the flanks 14 mm below the top, z = 0 on top")
    if any(shift):
        y, z = y + shift[0], z + shift[1]
        remarks.append(f"shifted by {1e3 * shift[0]:g} mm in y and {1e3 * shift[1]:g} mm in z")
    if raw.trusted:
        return y, z
    if kind == "wheel" and y[0] <= 0.0 <= y[-1]:
        offset = float(np.interp(0.0, y, z))
        if 1e-6 < abs(offset) <= _DATUM_SHIFT:
            z = z - offset
            remarks.append(f"z lowered by {1e3 * offset:.4f} mm to be 0 at the tape circle")
    elif kind == "rail" and abs(np.max(z)) > _DATUM_SHIFT:
        top = float(np.max(z))
        z = z - top
        remarks.append(f"z lowered by {1e3 * top:.4f} mm to be 0 at the top")
    return y, z


def _at_depth(y: FloatArray, z: FloatArray, depth: float) -> tuple[float, float]:
    """y of both flanks at a depth [m] below z = 0; an end where the profile is not that deep."""
    above = np.flatnonzero(z >= -depth)
    first, last = int(above[0]), int(above[-1])
    left, right = float(y[first]), float(y[last])
    if first > 0:
        left = float(np.interp(-depth, z[first - 1 : first + 1], y[first - 1 : first + 1]))
    if last < len(y) - 1:
        right = float(np.interp(depth, -z[last : last + 2], y[last : last + 2]))
    return left, right


def check_options(kind: str | None, smoothing: float) -> None:
    """Raise ProfileError for an impossible kind or smoothing."""
    if kind is not None and kind not in KINDS:
        raise ProfileError(f"kind={kind!r}; use 'wheel' or 'rail'")
    if isinstance(smoothing, str) or not 0.0 <= smoothing <= 1e-3:
        raise ProfileError(f"smoothing = {smoothing} m; use 0 to 1e-3 m (10 micrometres is 1e-5)")
