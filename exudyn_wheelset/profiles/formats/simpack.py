"""SIMPACK wheel (.prw) and rail (.prr) profiles.

A header section gives the type (0 rail, 1 wheel); the spline section gives the points and how to
process them, in this order, in the file's own units: point.dist.min, shift.y and shift.z, rotate
(about x), bound.y and bound.z (ignored where min >= max), mirror.y and mirror.z, inversion of the
order, units.len.f and units.ang.f (file unit per metre or radian). "!" and "%" begin comments.

Convention of the result: y to the field side (SIMPACK's right-hand side), z down. So z is turned
here. Not taken over, and said in the remarks: approx.smooth, whose meaning is SIMPACK's own, and
the weights in a third column. Points outside bound.y and bound.z are left out.
"""

from __future__ import annotations

import math
import re
from datetime import datetime, timezone

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles.formats.raw import (
    UNITS,
    RawProfile,
    coordinate,
    fault,
    listed,
    number,
    point_cells,
    shorten,
    unit_word,
)
from exudyn_wheelset.profiles.profile import Profile

NAME = "SIMPACK"
_NUMERIC = (
    "point.dist.min",
    "shift.y",
    "shift.z",
    "rotate",
    "bound.y.min",
    "bound.y.max",
    "bound.z.min",
    "bound.z.max",
    "mirror.y",
    "mirror.z",
    "inversion",
    "units.len.f",
    "units.ang.f",
    "approx.smooth",
)
_TEXT = ("comment", "file", "file.mtime", "type", "units.len", "units.ang")
_NESTING = {"header": (), "spline": (), "point": ("spline",)}


def looks_like(lines: list[str]) -> bool:
    """Whether a text has SIMPACK's sections."""
    return any(
        re.match(r"\s*(header|spline)\.begin\b", line, re.IGNORECASE) for line in lines[:300]
    )


def read(lines: list[str], label: str) -> RawProfile:
    """Read a SIMPACK profile; ProfileError names file, line and mend."""
    raw = RawProfile(NAME)
    values: dict[str, float] = {}
    unknown: list[str] = []
    weights = False
    open_sections: list[str] = []
    ended = False
    for count, line in enumerate(lines, start=1):
        text = re.split(r"[!%]", line, maxsplit=1)[0].strip()
        if not text or ended:
            continue
        section = re.fullmatch(r"(\w+)\.(begin|end)", text.lower())
        if section:
            ended = _nest(open_sections, section[1], section[2], label, count)
        elif open_sections[-1:] == ["point"]:
            tokens = point_cells(text)
            if len(tokens) < 2:
                raise fault(label, count, f"one value ({shorten(text)!r}); give y and z")
            weights = weights or len(tokens) > 2
            y = coordinate(tokens[0], label, count, "y")
            raw.add(y, coordinate(tokens[1], label, count, "z"), count)
        elif "=" in text and open_sections:
            key, _, value = (part.strip() for part in text.partition("="))
            _keyword(raw, values, unknown, open_sections[-1], key.lower(), value, label, count)
        else:
            raise fault(
                label, count, f"{shorten(text)!r} outside a section; delete it or begin it with '!'"
            )
    if open_sections == ["spline"] and raw.lines:
        raw.remarks.append("'spline.end' is missing")
    elif open_sections or not ended:
        where = f"inside '{open_sections[-1]}.begin'" if open_sections else "without 'spline.end'"
        mend = "export it again, or add 'point.end' and 'spline.end' if that is all there is"
        raise fault(label, len(lines), f"the file ends {where}; it seems to be cut off: {mend}")
    by_suffix = {"prw": "wheel", "prr": "rail"}.get(label.lower().rsplit(".", 1)[-1])
    if raw.kind is None and by_suffix:
        raw.kind = by_suffix
        raw.remarks.append(f"taken as a {by_suffix} by the suffix; the header has no type")
    if raw.kind is None:
        raise fault(label, None, "no type in the header; add 'type = 1' (wheel) or 0 (rail)")
    if weights:
        raw.remarks.append("weights of the points not used")
    if unknown:
        raw.remarks.append(f"keywords not known: {listed(unknown)}")
    _process(raw, values, label)
    return raw


def write(profile: Profile) -> str:
    """The profile as a .prw or .prr file in millimetres, nothing left to be processed."""
    order = slice(None, None, -1) if profile.kind == "wheel" else slice(None)
    comment = " ".join(f"{profile.name}: {profile.source}".split()).replace("'", "")
    stamp = datetime.now(tz=timezone.utc).strftime("%Y-%m-%d %H:%M:%S")
    lines = [
        f"! {profile.name}, written {stamp} UTC; y to the field side, z down".replace("\n", " "),
        "header.begin",
        "  version        = 1",
        f"  type           = {int(profile.kind == 'wheel')}",
        "header.end",
        "spline.begin",
        "  approx.smooth  = 0.0",
        "  file           = '-'",
        "  file.mtime     = 0",
        f"  comment        = '{comment}'",
        "  type           = 0",
        "  point.dist.min = 0.0",
        "  shift.y        = 0.0",
        "  shift.z        = 0.0",
        "  rotate         = 0.0",
        "  bound.y.min    = 1.0",
        "  bound.y.max    = 0.0",
        "  bound.z.min    = 1.0",
        "  bound.z.max    = 0.0",
        "  mirror.y       = 0",
        "  mirror.z       = 0",
        "  inversion      = 0",
        "  units.len      = 'mm'",
        "  units.ang      = 'rad'",
        "  units.len.f    = 1000.0",
        "  units.ang.f    = 1.0",
        "  point.begin",
    ]
    lines += [
        f"    {1e3 * y:.8f} {-1e3 * z:.8f}"
        for y, z in zip(profile.y[order], profile.z[order], strict=True)
    ]
    return "\n".join([*lines, "  point.end", "spline.end"]) + "\n"


def _nest(open_sections: list[str], name: str, step: str, label: str, line: int) -> bool:
    """Open or close a section; True when the spline section, the last one, has been closed."""
    if name not in _NESTING:
        raise fault(label, line, f"unknown section {shorten(name)!r}; use header, spline, point")
    if step == "begin":
        if tuple(open_sections) != _NESTING[name]:
            raise fault(label, line, f"'{name}.begin' out of place; close the open section first")
        open_sections.append(name)
        return False
    if open_sections[-1:] != [name]:
        raise fault(label, line, f"'{name}.end' without its beginning; add '{name}.begin'")
    open_sections.pop()
    return name == "spline"


def _keyword(
    raw: RawProfile,
    values: dict[str, float],
    unknown: list[str],
    section: str,
    key: str,
    value: str,
    label: str,
    line: int,
) -> None:
    if section == "header":
        if key == "type":
            parsed = number(value)
            if parsed not in (0.0, 1.0):
                raise fault(label, line, f"type = {shorten(value)!r}; use 0 (rail) or 1 (wheel)")
            raw.kind, raw.kind_line = ("rail", "wheel")[int(parsed)], line
        return
    if key in _NUMERIC:
        parsed = number(value)
        if parsed is None or not math.isfinite(parsed) or abs(parsed) > 1e12:
            raise fault(label, line, f"{key} = {shorten(value)!r} is not a number; mend it")
        if key in ("units.len.f", "units.ang.f") and not parsed > 0.0:
            raise fault(label, line, f"{key} = {value}; give file units per metre, 1000 for mm")
        if key in ("mirror.y", "mirror.z", "inversion") and parsed not in (0.0, 1.0):
            raise fault(label, line, f"{key} = {shorten(value)}; use 0 or 1")
        values[key] = parsed
        if key == "units.len.f":
            raw.unit_line = line
    elif key == "units.len" and unit_word(value):
        raw.unit = unit_word(value)
    elif key == "comment":
        raw.source = value.strip("'\"")
    elif key not in _TEXT:
        unknown.append(shorten(key))


def _process(raw: RawProfile, values: dict[str, float], label: str) -> None:
    points = list(zip(raw.y, raw.z, raw.lines, strict=True))
    closest = values.get("point.dist.min", 0.0)
    if closest > 0.0:
        kept = points[:1]
        for point in points[1:]:
            if math.hypot(point[0] - kept[-1][0], point[1] - kept[-1][1]) >= closest:
                kept.append(point)
        if len(kept) < len(points):
            raw.remarks.append(
                f"{len(points) - len(kept)} points closer than point.dist.min left out"
            )
        points = kept
    dy, dz = values.get("shift.y", 0.0), values.get("shift.z", 0.0)
    if dy or dz:
        points = [(y + dy, z + dz, line) for y, z, line in points]
        raw.remarks.append(f"shifted by {dy:g}, {dz:g} (shift.y, shift.z)")
    angle = values.get("rotate", 0.0) / values.get("units.ang.f", 1.0)
    if angle:
        cos, sin = math.cos(angle), math.sin(angle)
        points = [(cos * y - sin * z, sin * y + cos * z, line) for y, z, line in points]
        raw.remarks.append(f"rotated by {angle:g} rad (rotate)")
    for axis, name in ((0, "bound.y"), (1, "bound.z")):
        low, high = values.get(f"{name}.min", 1.0), values.get(f"{name}.max", 0.0)
        if low < high:
            inside = [point for point in points if low <= point[axis] <= high]
            if len(inside) < len(points):
                raw.remarks.append(f"{len(points) - len(inside)} points outside {name} left out")
            points = inside
    if values.get("mirror.y"):
        points = [(-y, z, line) for y, z, line in points]
        raw.remarks.append("mirrored in y (mirror.y)")
    if values.get("mirror.z"):
        points = [(y, -z, line) for y, z, line in points]
        raw.remarks.append("mirrored in z (mirror.z)")
    if values.get("inversion"):
        points.reverse()
        raw.remarks.append("order of the points inverted (inversion)")
    if values.get("approx.smooth"):
        raw.remarks.append(
            f"approx.smooth = {values['approx.smooth']:g} not used; give smoothing= instead"
        )
    if "units.len.f" not in values and raw.unit is not None:
        values["units.len.f"] = round(1.0 / UNITS[raw.unit], 9)
        raw.remarks.append(f"unit {raw.unit} by units.len; units.len.f is missing")
    # Millimetres, whatever the file's unit, so that no number loses digits on the way.
    factor = 1000.0 / values.get("units.len.f", 1.0)
    if not math.isfinite(factor):
        raise ProfileError(f"{label}: units.len.f is too small; give file units per metre")
    raw.unit = "mm"
    raw.y = [factor * y for y, _, _ in points]
    raw.z = [-factor * z for _, z, _ in points]
    raw.lines = [line for _, _, line in points]
    raw.remarks.append(
        f"SIMPACK: {values.get('units.len.f', 1.0):g} file units per metre, z turned up"
    )
