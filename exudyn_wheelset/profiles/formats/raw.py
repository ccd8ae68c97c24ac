"""What every reader hands on, and the reading of numbers and text that readers share.

A reader turns the text of a file into a `RawProfile`: the numbers as written, the line each stands
on, and what the file itself says about name, kind, unit and orientation. Everything that all
formats have in common (units, order, orientation, plausibility) happens afterwards, in
`exudyn_wheelset.profiles.finish`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from exudyn_wheelset.errors import ProfileError

UNITS = {"mm": 1e-3, "m": 1.0, "cm": 1e-2, "um": 1e-6, "inch": 0.0254}
_UNIT_WORDS = {
    "mm": "mm",
    "millimetre": "mm",
    "millimeter": "mm",
    "millimetres": "mm",
    "millimeters": "mm",
    "millimètre": "mm",
    "millimètres": "mm",
    "milímetros": "mm",
    "m": "m",
    "metre": "m",
    "meter": "m",
    "metres": "m",
    "meters": "m",
    "cm": "cm",
    "um": "um",
    "µm": "um",
    "μm": "um",
    "micron": "um",
    "microns": "um",
    "in": "inch",
    "inch": "inch",
    "inches": "inch",
    "zoll": "inch",
    "pouce": "inch",
    "pouces": "inch",
    "pulgadas": "inch",
    '"': "inch",
}
_NUMBER = re.compile(
    r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?|[+-]?nan|[+-]?inf(?:inity)?", re.I
)
_DECIMAL_COMMAS = re.compile(r"(\s*[+-]?\d+,\d+(\s+|$)){2,}")
_LINE_END = re.compile(r"\r\n|\n|\r")
_LARGEST_NUMBER = 1e7
_MOST_BYTES = 5_000_000
_MOST_LINES = 100_000


@dataclass
class RawProfile:
    """Points of a file as its format defines them, turned to "y to the field side, z up".

    y, z: numbers in the file's unit; lines: the line each point stands on, counted from 1.
    unit: one of UNITS, or None where the file does not say; unit_line, kind_line: where it says.
    trusted: the file says that it is in the package's frame, so nothing is turned or shifted.
    rail_datum: the format has no head centre; y = 0 is put midway between the flanks of a rail.
    gauge_by_depth: the direction of y is often turned by users; where only one side of a rail
    reaches down to where the gauge is measured, that is taken as the gauge side.
    """

    format: str
    y: list[float] = field(default_factory=list)
    z: list[float] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    name: str = ""
    source: str = ""
    kind: str | None = None
    kind_line: int | None = None
    unit: str | None = None
    unit_line: int | None = None
    remarks: list[str] = field(default_factory=list)
    trusted: bool = False
    rail_datum: bool = False
    gauge_by_depth: bool = False

    def add(self, y: float, z: float, line: int) -> None:
        """Add one point."""
        self.y.append(y)
        self.z.append(z)
        self.lines.append(line)

    def check_finite(self, label: str) -> None:
        """Raise ProfileError, naming every line, where a coordinate is NaN or infinite."""
        bad = [
            (line, "y" if not math.isfinite(y) else "z", y if not math.isfinite(y) else z)
            for y, z, line in zip(self.y, self.z, self.lines, strict=True)
            if not (math.isfinite(y) and math.isfinite(z))
        ]
        if bad:
            line, column, value = bad[0]
            more = f" (so are lines {listed([str(b[0]) for b in bad[1:]], 100)})" if bad[1:] else ""
            raise fault(
                label, line, f"{column} is {value:g}{more}; delete the line or mend the value"
            )


def fault(label: str, line: int | None, message: str) -> ProfileError:
    """The error that names file, line and mend."""
    place = label if line is None else f"{label}, line {line}"
    return ProfileError(f"{place}: {message}")


def decode(data: bytes, label: str) -> tuple[str, list[str]]:
    """The text of a file and remarks on its encoding; ProfileError for binary or empty files."""
    if len(data) > _MOST_BYTES:
        raise ProfileError(f"{label}: {len(data)} bytes; a profile file has less than 5 MB")
    if data.count(b"\n") + data.count(b"\r") > 2 * _MOST_LINES:
        raise ProfileError(f"{label}: more than {_MOST_LINES} lines; thin the points out")
    if not data.strip():
        raise ProfileError(f"{label}: the file is empty; it needs at least 8 lines with y and z")
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        try:
            return data.decode("utf-16").lstrip("\ufeff"), ["read as UTF-16 text"]
        except UnicodeDecodeError as error:
            raise ProfileError(
                f"{label}: starts like UTF-16 text but is none ({error.reason}); save it as UTF-8"
            ) from None
    head = data[:100_000]
    controls = [i for i, byte in enumerate(head) if byte < 32 and byte not in b"\t\n\r\x0b\x0c\x1a"]
    if 0 in head or len(controls) > len(head) // 50:
        line = head[: controls[0]].count(b"\n") + 1
        raise ProfileError(
            f"{label}, line {line}: not text (byte {head[controls[0]]}); "
            "export the profile as a text file"
        )
    try:
        return data.decode("utf-8-sig"), []
    except UnicodeDecodeError:
        return data.decode("latin-1"), ["not UTF-8, read as Latin-1 text"]


def split_lines(text: str) -> list[str]:
    """The lines of a text, whatever the operating system and the minus sign that wrote it."""
    return _LINE_END.split(text.replace("\u2212", "-"))


def number(token: str) -> float | None:
    """The value of a token that is a number and nothing else (Fortran's D exponent too)."""
    if not _NUMBER.fullmatch(token):
        return None
    return float(token.lower().replace("d", "e"))


def coordinate(token: str, label: str, line: int, column: str, *, finite: bool = True) -> float:
    """A coordinate; ProfileError naming file and line for a word, NaN and infinity.

    finite: False leaves NaN and infinity to `RawProfile.check_finite`, which names all of them.
    """
    value = number(token)
    if value is None:
        raise fault(
            label, line, f"{column} is {shorten(token)!r}, not a number; mend or delete the line"
        )
    if not math.isfinite(value):
        if not finite:
            return value
        raise fault(label, line, f"{column} is {token}; delete the line or mend the value")
    if abs(value) > _LARGEST_NUMBER:
        raise fault(label, line, f"{column} = {value:g} is no length of a profile; mend the value")
    return value


def point_cells(text: str) -> list[str]:
    """The cells of a row of numbers; commas between digits of two columns are decimal signs."""
    if ";" in text or not _DECIMAL_COMMAS.fullmatch(text):
        separators = r"[\s;]+" if ";" in text and "," in text else r"[\s,;]+"
        cells = [cell for cell in re.split(separators, text) if cell]
    else:
        cells = text.split()
    return [cell.replace(",", ".") for cell in cells]


def unit_word(text: str) -> str | None:
    """The unit that a word names, as a key of UNITS, or None."""
    return _UNIT_WORDS.get(text.strip().strip("[]().'").lower())


def shorten(text: str, length: int = 40) -> str:
    """A text short enough for a message."""
    text = " ".join(text.split())
    return text if len(text) <= length else text[: length - 3] + "..."


def listed(words: Sequence[str], most: int = 5) -> str:
    """Words separated by commas, the first `most` of them."""
    more = "" if len(words) <= most else f" and {len(words) - most} more"
    return ", ".join(words[:most]) + more
