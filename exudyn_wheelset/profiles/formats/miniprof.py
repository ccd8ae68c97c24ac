"""MiniProf measurements: wheels (.whl), rails (.ban, .rai) and templates (.mpt), in millimetres.

The header has lines key=value, in files of version 1 free text and numbers; a blank line may end
it. The points follow in the columns that ColumnDef names (X, Y, then angle, curvature, others,
not used here), separated by blanks, tabs, commas or semicolons. Comments begin with ", !, % or #.
XOffset and YOffset are added. Templates (.mpt) have sections in brackets: pieces of points, or
straight pieces MPDn=L x1 y1 x2 y2.

Conventions (from files of the instrument): wheel: X from the flange back towards the field side,
Y = 0 on the tread at WheelDiameterTaperline, 70 mm if that is not given, towards the flange tip;
rail: X towards the gauge side, Y up. So y = X - 70 mm, z = -Y for a wheel and y = -X, z = Y for a
rail. Both are checked on the shape, because users turn their files: see `raw.RawProfile`.
"""

from __future__ import annotations

import math
import re

import numpy as np

from exudyn_wheelset.profiles.formats.raw import (
    UNITS,
    RawProfile,
    coordinate,
    fault,
    number,
    point_cells,
    shorten,
)
from exudyn_wheelset.profiles.formats.rows import find_table
from exudyn_wheelset.profiles.orientation import look_at

NAME = "MiniProf"
TAPE_FROM_FLANGE_BACK = 70.0
_WIDEST = 0.3
_KEYS = re.compile(
    r"^\s*(XYPoints|ColumnDef|MPTypeNo|MPSerNo|ProgramName|RefPoint1|MPDC)\s*=", re.I
)
_COMMENT = ('"', "!", "%", "#")
_WHEEL_KEYS = {"wheeldiametertaperline", "wheeladjustpoint", "diametertaperline", "sd", "sh", "qr"}
_RAIL_KEYS = {"rail", "railaligntype", "railangle", "crownradius", "crownr", "w1", "w2", "w3"}


def looks_like(lines: list[str]) -> bool:
    """Whether a text has MiniProf's keywords or an old MiniProf heading."""
    if lines and lines[0].lstrip().upper().startswith(("#MINIWHEELPROF", "#MINIRAILPROF")):
        return True
    return sum(bool(_KEYS.match(line)) for line in lines[:200]) >= 2


def read(
    lines: list[str], label: str, kind: str | None = None, unit: str | None = "mm"
) -> RawProfile:
    """Read a MiniProf file; the kind comes from the suffix where the caller gives none.

    unit: of the numbers, one of UNITS, for the place of the tape circle.
    """
    raw = RawProfile(NAME, unit="mm")
    suffix = label.lower().rsplit(".", 1)[-1]
    first_line = lines[0].upper() if lines else ""
    if suffix == "whl" or "MINIWHEELPROF" in first_line:
        raw.kind = "wheel"
    elif suffix in ("ban", "rai") or "MINIRAILPROF" in first_line:
        raw.kind = "rail"
    header: dict[str, tuple[str, int]] = {}
    pieces: list[tuple[str, int]] = []
    _header(lines, header, pieces)
    raw.name = header.get("filename", ("", 0))[0]
    if pieces:
        _template(raw, pieces, label)
    else:
        _table(raw, lines, header, label)
    offsets = []
    for axis, key in (("y", "xoffset"), ("z", "yoffset")):
        text, line = header.get(key, ("", 0))
        value = number(text) if text else 0.0
        if value is None or not math.isfinite(value) or abs(value) > 1e7:
            raise fault(label, line, f"{key} is {shorten(text)!r}, not a number; mend it")
        offsets.append(value)
        if value:
            raw.remarks.append(f"{axis} shifted by {value:g} mm ({key})")
    metre = UNITS[unit or "mm"]
    wheel = (kind or raw.kind or _kind_of(header, raw, metre)) == "wheel"
    if wheel:
        if sum(x + offsets[0] < -0.5 * TAPE_FROM_FLANGE_BACK for x in raw.y) > len(raw.y) // 2:
            raw.y = [-x for x in raw.y]
            offsets[0] = -offsets[0]
            raw.remarks.append("X falls from the flange back on: turned")
        given = number(header.get("wheeldiametertaperline", ("", 0))[0])
        tape = given if given is not None and 50.0 <= given <= 100.0 else TAPE_FROM_FLANGE_BACK
        tape *= 1e-3 / metre
        raw.y = [x + offsets[0] - tape for x in raw.y]
        raw.z = [-(y + offsets[1]) for y in raw.z]
        raw.remarks.append(
            f"MiniProf wheel: y = 0 put {tape:g} {unit} from the flange back, z turned up"
        )
    else:
        raw.y = [-(x + offsets[0]) for x in raw.y]
        raw.z = [y + offsets[1] for y in raw.z]
        raw.gauge_by_depth = True
        raw.remarks.append("MiniProf rail: y turned to the field side")
    return raw


def _kind_of(header: dict[str, tuple[str, int]], raw: RawProfile, metre: float) -> str | None:
    """Wheel or rail by the instrument's type (1xx wheels, 2xx rails), its results, the shape."""
    type_number = header.get("mptypeno", ("", 0))[0]
    if re.fullmatch(r"[12]\d\d", type_number):
        return "wheel" if type_number[0] == "1" else "rail"
    wheel = any(header.get(key, ("", 0))[0] for key in _WHEEL_KEYS)
    if wheel != any(header.get(key, ("", 0))[0] for key in _RAIL_KEYS):
        return "wheel" if wheel else "rail"
    points = metre * np.array(sorted(zip(raw.y, raw.z, strict=True))).reshape(-1, 2)
    if not 0.0 < np.ptp(points[:, :1]) < _WIDEST:
        return None
    look = look_at(points[:, 0], points[:, 1])
    return None if look is None else look.kind


def _header(
    lines: list[str], header: dict[str, tuple[str, int]], pieces: list[tuple[str, int]]
) -> None:
    """Collect key=value lines; the pieces MPDn of a template go to `pieces`."""
    for index, line in enumerate(lines):
        match = re.match(r"^\s*([A-Za-z][\w .]*?)\s*=\s*(.*?)\s*$", line)
        if match:
            key = match[1].lower()
            header.setdefault(key, (match[2], index + 1))
            if re.fullmatch(r"mpd\d+", key):
                pieces.append((match[2], index + 1))


def _table(
    raw: RawProfile, lines: list[str], header: dict[str, tuple[str, int]], label: str
) -> None:
    definition, definition_line = header.get("columndef", ("X,Y", 0))
    names = [name.strip().upper() for name in re.split(r"[,;\s]+", definition) if name.strip()]
    if "X" not in names or "Y" not in names:
        raise fault(
            label, definition_line, f"ColumnDef={shorten(definition)} has no X and Y; mend it"
        )
    columns = names.index("X"), names.index("Y")
    texts = []
    for count, whole in enumerate(lines, start=1):
        text = whole.strip().strip("\x1a")
        if text and not text.startswith(_COMMENT):
            texts.append((count, text))
    template = any(text.startswith("[") for _, text in texts[:5])
    table = find_table(texts, point_cells, label, join=template)
    raw.remarks += table.remarks
    for line, tokens in table.rows:
        if len(tokens) <= max(columns):
            raise fault(
                label,
                line,
                f"{len(tokens)} of {len(names)} columns ({shorten(' '.join(tokens))!r}); "
                "add the missing value or delete the line",
            )
        x = coordinate(tokens[columns[0]], label, line, "X", finite=False)
        raw.add(x, coordinate(tokens[columns[1]], label, line, "Y", finite=False), line)
    raw.check_finite(label)
    text, announced_line = header.get("xypoints", ("", 0))
    announced = number(text) if text else None
    if announced is not None and math.isfinite(announced):
        if len(raw.y) < 0.5 * announced:
            raise fault(
                label,
                announced_line,
                f"XYPoints={text} but {len(raw.y)} points follow; the file seems to be cut off: "
                f"export it again, or write XYPoints={len(raw.y)} if that is all there is",
            )
        if round(announced) != len(raw.y):
            raw.remarks.append(f"XYPoints={text} but {len(raw.y)} points")


def _template(raw: RawProfile, pieces: list[tuple[str, int]], label: str) -> None:
    for text, line in pieces:
        tokens = text.split()
        if len(tokens) != 5 or tokens[0].upper() != "L":
            raise fault(
                label, line, f"{shorten(text)!r}; only straight pieces 'L x1 y1 x2 y2' are read"
            )
        ends = [coordinate(token, label, line, "coordinate") for token in tokens[1:]]
        start = (raw.y[-1], raw.z[-1]) if raw.y else None
        if start is None:
            raw.add(ends[0], ends[1], line)
        elif math.hypot(ends[0] - start[0], ends[1] - start[1]) > 1e-3:
            raise fault(label, line, "the piece does not begin where the one before ends")
        raw.add(ends[2], ends[3], line)
