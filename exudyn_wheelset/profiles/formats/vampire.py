"""VAMPIRE wheel (.whe) and rail (.rai) profiles: left and right in one file, in millimetres.

Line 1 is WHEELPROFILE or RAILPROFILE, line 2 a title; line 3 is TREADDATUM (EUROPEAN: 70 mm from
the flange back; US1: 2 27/32 in; US2: 3 1/16 in; CUSTOM d) or GAUGEPOINT (EUROPEAN: 14 mm below
the top; US: 5/8 in; CUSTOM h); line 4 FLANGEBACK or GAUGE, a distance. Then rows y z of the left
and y z of the right profile; y from the centre line of track or wheelset, to the right.

Convention of the result: y to the field side from the tread datum for wheels, from midway between
the flanks for rails, because the format does not know the head's centre. z of rails is up; that of
wheels is found from the flange.
"""

from __future__ import annotations

import math
import re

from exudyn_wheelset.profiles.formats.raw import (
    RawProfile,
    coordinate,
    fault,
    number,
    shorten,
)

NAME = "VAMPIRE"
_INCH = 25.4
_TREAD_DATUM = {"EUROPEAN": 70.0, "US1": (2 + 27 / 32) * _INCH, "US2": (3 + 1 / 16) * _INCH}
_GAUGE_POINT = {"EUROPEAN": 14.0, "US": 5 / 8 * _INCH}


def looks_like(lines: list[str]) -> bool:
    """Whether a text begins as VAMPIRE's profiles do."""
    return bool(lines) and lines[0].strip().upper().startswith(("WHEELPROFILE", "RAILPROFILE"))


def read(lines: list[str], label: str, side: str = "left") -> RawProfile:
    """Read one side of a VAMPIRE profile; ProfileError names file, line and mend."""
    head = [(count, line) for count, line in enumerate(lines, start=1) if line.strip()][:4]
    if len(head) < 4:
        raise fault(label, len(lines), "the file ends in its header; it seems to be cut off")
    wheel = lines[0].strip().upper().startswith("WHEELPROFILE")
    raw = RawProfile(
        NAME,
        name=" ".join(head[1][1].split()),
        kind="wheel" if wheel else "rail",
        kind_line=1,
        unit="mm",
    )
    datum = _datum(head[2], "TREADDATUM" if wheel else "GAUGEPOINT", wheel, label)
    distance = _keyword(head[3], "FLANGEBACK" if wheel else "GAUGE", label)
    other: list[tuple[float, float]] = []
    column = 2 if side == "right" else 0
    sign = 1.0 if side == "right" else -1.0
    for count, line in enumerate(lines[head[3][0] :], start=head[3][0] + 1):
        text = re.split(r'["!%]', line, maxsplit=1)[0].strip().strip("\x1a")
        tokens = [token for token in re.split(r"[\s,;]+", text) if token]
        if not tokens:
            continue
        if len(tokens) < 4:
            raise fault(
                label,
                count,
                f"{len(tokens)} of 4 columns ({shorten(text)!r}); give y and z of both sides",
            )
        row = [coordinate(token, label, count, "a coordinate") for token in tokens[:4]]
        raw.add(sign * row[column], row[column + 1], count)
        other.append((-sign * row[2 - column], row[3 - column]))
    if wheel:
        raw.y = [y - 0.5 * distance - datum for y in raw.y]
        raw.z = [-z for z in raw.z]
        raw.remarks.append(
            f"VAMPIRE {side} wheel: y = 0 put {datum:g} mm from the flange back, z turned up"
        )
    else:
        raw.y = [y - 0.5 * distance for y in raw.y]
        raw.rail_datum = True
        raw.remarks.append(
            f"VAMPIRE {side} rail: gauge {distance:g} mm at {datum:g} mm below the top"
        )
    if _differs(raw, other, wheel, distance, datum):
        raw.remarks.append(f"left and right differ; this is the {side} one")
    return raw


def _differs(
    raw: RawProfile, other: list[tuple[float, float]], wheel: bool, distance: float, datum: float
) -> bool:
    offset = 0.5 * distance + (datum if wheel else 0.0)
    height = -1.0 if wheel else 1.0
    return any(
        abs(y - (oy - offset)) > 1e-6 or abs(z - height * oz) > 1e-6
        for y, z, (oy, oz) in zip(raw.y, raw.z, other, strict=True)
    )


def _datum(place: tuple[int, str], word: str, wheel: bool, label: str) -> float:
    count, line = place
    names = _TREAD_DATUM if wheel else _GAUGE_POINT
    tokens = line.upper().replace("=", " ").split()
    if not tokens or tokens[0] != word:
        raise fault(label, count, f"{shorten(line)!r}; it gives {word}")
    if len(tokens) >= 3 and tokens[1] == "CUSTOM":
        return _positive(tokens[2], word, label, count)
    if len(tokens) >= 2 and tokens[1] in names:
        return names[tokens[1]]
    raise fault(
        label, count, f"{shorten(line)!r}; use {', '.join(names)} or CUSTOM with millimetres"
    )


def _keyword(place: tuple[int, str], word: str, label: str) -> float:
    count, line = place
    tokens = line.upper().replace("=", " ").split()
    if len(tokens) < 2 or tokens[0] != word:
        raise fault(label, count, f"{shorten(line)!r}; it gives {word} in millimetres")
    return _positive(tokens[1], word, label, count)


def _positive(token: str, word: str, label: str, line: int) -> float:
    value = number(token)
    if value is None or not math.isfinite(value) or not 0.0 < value < 1e4:
        raise fault(label, line, f"{word} {shorten(token)!r}; give millimetres")
    return value
