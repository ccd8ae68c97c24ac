"""From the numbers of a file to a profile: units, order, overhang, outliers, orientation, datum.

What every format has in common. Faults that a reader of the file must mend are errors with the
line; what can be decided is decided, and said in the profile's remarks.

Order of the steps: lost ends; unit to metres; outliers, if a tolerance is given; points in the
order of the curve, overhanging ends cut off, what runs back left out (see mending.py); kind and
orientation from the shape; the caller's mirror and shift; datum.
"""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles.curve import averaged
from exudyn_wheelset.profiles.formats.raw import RawProfile, fault, listed
from exudyn_wheelset.profiles.mending import (
    Stretch,
    advancing_stretch,
    in_order,
    longest_advance,
    without_lost_ends,
)
from exudyn_wheelset.profiles.orientation import look_at
from exudyn_wheelset.profiles.outliers import without_outliers, without_spikes
from exudyn_wheelset.profiles.plausible import RAIL_TOP_RANGE, size_hint
from exudyn_wheelset.profiles.profile import KINDS, Profile
from exudyn_wheelset.profiles.units import unit_factor

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_MOST_POINTS = 50_000
_DATUM_SHIFT = 5e-3
_STEEP = 3.0
_GAUGE_DEPTH = 0.014
_TAPE_FROM_FLANGE_BACK = 0.070
_TAPE_TOLERANCE = 0.010
_MOST_BACKSTEPS = 0.1
_MOST_LEFT_OUT = 0.4
_WIDE_GAP = 3e-3
_NARROWEST_WHEEL = 0.03
_UNDERCUT = 2e-5


@dataclass(frozen=True)
class Options:
    """What the caller says about a file; None where the file shall say it (see load_profile)."""

    kind: str | None = None
    unit: str | None = None
    smoothing: float | str = 0.0
    outlier_tolerance: float | None = None
    shift: tuple[float, float] = (0.0, 0.0)
    mirror_y: bool = False


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
    keep = without_lost_ends(points, lines, remarks)
    points, lines = points[keep], lines[keep]
    points *= unit_factor(raw, points, lines, label, options.unit, remarks)
    if options.outlier_tolerance is not None:
        keep = without_outliers(points, options.outlier_tolerance, lines, label, remarks)
        points, lines = points[keep], lines[keep]
    points, lines, low_face, high_face = _in_one_direction(points, lines, label, remarks)
    if options.smoothing == "auto" and options.outlier_tolerance is None:
        keep = without_spikes(points, lines, remarks)
        points, lines = points[keep], lines[keep]
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
        y, z, turned = _oriented(y, z, kind, raw, remarks)
        low_face, high_face = (high_face, low_face) if turned else (low_face, high_face)
    if options.mirror_y:
        y, z = -y[::-1], z[::-1]
        low_face, high_face = high_face, low_face
        remarks.append("y turned to the other side as asked for")
    y, z = _shifted(y, z, kind, raw, options.shift, remarks)
    if kind == "wheel" and not y[0] < 0.0 < y[-1]:
        width = float(y[-1] - y[0])
        narrow = f"{size_hint(width)} " if width < _NARROWEST_WHEEL else ""
        raise fault(
            label,
            place,
            f"{narrow}y reaches from {1e3 * y[0]:.2f} to {1e3 * y[-1]:.2f} mm and leaves out "
            f"the tape circle y = 0; give shift_y={-y[0] - _TAPE_FROM_FLANGE_BACK:.6g} to put "
            f"y = 0 {1e3 * _TAPE_FROM_FLANGE_BACK:g} mm from the first point of the flange",
        )
    if kind == "wheel" and not raw.trusted and low_face and not any(options.shift):
        beside = -y[0] - _TAPE_FROM_FLANGE_BACK
        if abs(beside) > _TAPE_TOLERANCE:
            remarks.append(
                f"the flange back lies {-1e3 * y[0]:.1f} mm from y = 0: is that the tape circle? "
                f"shift_y={beside:.4g} puts it {1e3 * _TAPE_FROM_FLANGE_BACK:g} mm away"
            )
    try:
        profile = Profile(
            raw.name or stem,
            kind,
            y,
            z,
            source=raw.source or f"{raw.format} file",
            smoothing=options.smoothing,
            remarks=remarks,
            ends_at_gauge_face=kind == "rail" and low_face,
        )
        # Asked for here, so that points which allow no such curve are refused with their file.
        profile.span  # noqa: B018
        return profile
    except ProfileError as error:
        message = str(error).removeprefix(f"{raw.name or stem}: ")
        raise fault(label, place, message) from None


def _in_one_direction(
    points: FloatArray, lines: IntArray, label: str, remarks: list[str]
) -> tuple[FloatArray, IntArray, bool, bool]:
    """Points with growing y, their lines, and whether the curve is upright at either end."""
    order = in_order(points, lines, remarks)
    points, lines = points[order], lines[order]
    if len(points) < 8:
        raise fault(label, None, f"{len(points)} different points; a profile needs at least 8")
    stretch = advancing_stretch(points)
    _say_what_is_cut(points, lines, stretch, remarks)
    points = points[stretch.first : stretch.last + 1]
    lines = lines[stretch.first : stretch.last + 1]
    for group in (1, 2, 4, 8, 16):
        thinned, their_lines = averaged(points, group), lines[::group]
        steps = np.diff(thinned, axis=0)
        gentle = np.abs(steps[:, 1]) < _STEEP * np.abs(steps[:, 0])
        if np.sum(gentle & (steps[:, 0] <= 0.0)) <= _MOST_BACKSTEPS * len(thinned):
            break
    if group > 1:
        remarks.append(
            f"means of {group} neighbouring points taken, because their noise runs back along y"
        )
    points, lines = thinned, their_lines
    row = longest_advance(points[:, 0])
    gone = np.setdiff1d(np.arange(len(points)), row)
    if len(points) < 8:
        raise fault(
            label,
            int(lines[0]),
            f"{len(points)} points left between overhanging ends; 8 are needed: give a longer "
            "part of the profile",
        )
    if len(row) < 8 or len(gone) > _MOST_LEFT_OUT * len(points):
        i = int(gone[0])
        raise fault(
            label,
            int(lines[i]),
            f"y = {1e3 * points[i, 0]:g} mm runs back, as at {len(gone)} of {len(points)} points; "
            "sort the points along the profile",
        )
    if len(gone):
        back = np.max(np.maximum.accumulate(points[:, 0]) - points[:, 0])
        words = [str(line) for line in lines[gone]]
        remarks.append(
            f"{len(gone)} points left out that run back by up to {1e3 * back:.3g} mm in y, "
            f"lines {listed(words)}"
        )
    gaps = np.hypot(*np.diff(points[row], axis=0).T)
    widest = int(np.argmax(gaps))
    if gaps[widest] > max(_WIDE_GAP, 10.0 * float(np.median(gaps))):
        low, high = 1e3 * points[row[widest]], 1e3 * points[row[widest + 1]]
        remarks.append(
            f"no points for {1e3 * gaps[widest]:.1f} mm between y = {low[0]:.2f} and "
            f"{high[0]:.2f} mm of the file; the curve bridges them"
        )
    return points[row], lines[row], stretch.low_face, stretch.high_face


def _say_what_is_cut(
    points: FloatArray, lines: IntArray, stretch: Stretch, remarks: list[str]
) -> None:
    first, last = stretch.first, stretch.last
    cut = first + len(points) - 1 - last
    if not cut:
        return
    parts = []
    for end, edge, sign in (
        (slice(0, first), first, 1.0),
        (slice(last + 1, len(points)), last, -1.0),
    ):
        if end.start == end.stop:
            continue
        behind = float(np.max(sign * (points[end, 0] - points[edge, 0])))
        their = lines[end]
        parts.append(
            f"lines {min(their)} to {max(their)}"
            + (f", which recede by {1e3 * behind:.2g} mm" if behind > _UNDERCUT else "")
        )
    remarks.append(f"{cut} points of overhanging ends cut off: {'; '.join(parts)}")


def _oriented(
    y: FloatArray, z: FloatArray, kind: str, raw: RawProfile, remarks: list[str]
) -> tuple[FloatArray, FloatArray, bool]:
    """Points with z up and the sides in place, and whether y was turned."""
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
    if kind == "rail" and raw.gauge_by_depth:
        top = float(np.max(z))
        gauge, field = top - z[0], top - z[-1]
        if gauge < _GAUGE_DEPTH <= field:
            y, z = -y[::-1], z[::-1]
            remarks.append(
                f"y turned: only the side at y > 0 reaches down {1e3 * _GAUGE_DEPTH:g} mm, where "
                "the gauge is measured (mirror_y=True turns it back)"
            )
            return y, z, y_sign > 0
        if raw.format == "two-column text" and not field < _GAUGE_DEPTH <= gauge:
            remarks.append("y taken towards the field side, which the shape of a rail cannot show")
    return y, z, y_sign < 0


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
        if abs(offset) > 1e-6:
            z = z - offset
            remarks.append(f"z lowered by {1e3 * offset:.4f} mm to be 0 at the tape circle")
    elif kind == "rail":
        if abs(np.max(z)) > _DATUM_SHIFT:
            top = float(np.max(z))
            z = z - top
            remarks.append(f"z lowered by {1e3 * top:.4f} mm to be 0 at the top")
        y = _centred(y, z, remarks)
    return y, z


def _centred(y: FloatArray, z: FloatArray, remarks: list[str]) -> FloatArray:
    """y of a rail from the middle of its head, where the file's origin lies elsewhere."""
    crest = int(np.argmax(z))
    if abs(y[crest]) <= RAIL_TOP_RANGE:
        return y
    deepest = min(0.014, float(z[crest] - max(z[0], z[-1])))
    left, right = _at_depth(y, z - z[crest], deepest)
    middle = 0.5 * (left + right)
    if abs(y[crest] - middle) > RAIL_TOP_RANGE:
        middle = float(y[crest])
    remarks.append(
        f"y = 0 put midway between the flanks {1e3 * deepest:.1f} mm below the top: the file's "
        f"origin lay {1e3 * abs(middle):.2f} mm beside it"
    )
    return y - middle


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


def check_options(kind: str | None, smoothing: float | str) -> None:
    """Raise ProfileError for an impossible kind or smoothing."""
    if kind is not None and kind not in KINDS:
        raise ProfileError(f"kind={kind!r}; use 'wheel' or 'rail'")
    if smoothing == "auto":
        return
    is_number = isinstance(smoothing, Real) and not isinstance(smoothing, bool)
    if not is_number or not 0.0 <= smoothing <= 1e-3:  # type: ignore[operator]
        raise ProfileError(
            f"smoothing = {smoothing!r}; use 'auto' or 0 to 1e-3 m (10 micrometres is 1e-5)"
        )
