"""Plain text with two columns, y and z: the project's own files, users' files, CSV.

Header lines "# key: value" may give name, kind (wheel or rail), unit (mm, m, cm, inch) and source.
With the kind in such a header the file is taken as it is, in the frames of
`exudyn_wheelset.profiles.profile`; without it, unit, kind and orientation are detected and said in
the profile's remarks. Other comment lines (#, %, !, //) and lines of words before the first
numbers are skipped; a line of column names may carry the unit: "y [mm]; z [mm]".

Columns are separated by blanks, tabs, semicolons or commas; a decimal comma is understood where
another separator tells the columns apart.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable

from exudyn_wheelset.profiles.formats.raw import (
    RawProfile,
    coordinate,
    fault,
    shorten,
    unit_word,
)
from exudyn_wheelset.profiles.profile import Profile

NAME = "two-column text"
Split = Callable[[str], list[str]]
_HEADER = re.compile(r"^\s*[#%!/\"]+\s*(name|kind|unit|units|source)\s*[:=]\s*(.*?)\s*$", re.I)
_COMMENT = ("#", "%", "!", "//")
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?|[+-]?\d+(?:[eE][+-]?\d+)?")
_COLUMN_NAMES = (("y", "z"), ("x", "y"), ("x", "z"), ("lateral", "vertical"))


def read(lines: list[str], label: str) -> RawProfile:
    """Read a two-column file; ProfileError names file, line and mend."""
    raw = RawProfile(NAME)
    rows: list[tuple[int, str]] = []
    words: list[tuple[int, str]] = []
    for count, line in enumerate(lines, start=1):
        text = line.strip().strip("\x1a")
        if not text:
            continue
        if text.startswith(_COMMENT):
            _header(raw, text, count, label)
            continue
        text = _without_comment(text)
        if re.match(r"[\"+\-.,;]*\s*\d|[+-]?(nan|inf)\b", text, re.I) or rows:
            rows.append((count, text))
        elif text:
            words.append((count, text))
    if not rows:
        raise fault(label, None, "no line with numbers; give lines with y and z")
    split, decimal_comma, separator = _separator([text for _, text in rows], label, rows[0][0])
    first, second = _columns(raw, words, split)
    most = Counter(len(split(text)) for _, text in rows).most_common(1)[0][0]
    if most == 1:
        raise fault(label, rows[0][0], "one column; give y and z on each line")
    for count, text in rows:
        tokens = split(text)
        if len(tokens) <= max(first, second):
            raise fault(
                label,
                count,
                f"{len(tokens)} of {most} columns ({shorten(text)!r}); "
                "add the missing value or delete the line",
            )
        if decimal_comma:
            tokens = [token.replace(",", ".") for token in tokens]
        y = coordinate(tokens[first], label, count, "y")
        raw.add(y, coordinate(tokens[second], label, count, "z"), count)
    if separator != "blanks":
        raw.remarks.append(f"columns separated by {separator}")
    if decimal_comma:
        raw.remarks.append("decimal commas")
    if most > 2 and (first, second) != (0, 1):
        raw.remarks.append(f"columns {first + 1} and {second + 1} of {most} taken as y and z")
    elif most > 2:
        raw.remarks.append(f"the first 2 of {most} columns taken as y and z")
    raw.trusted = raw.kind is not None
    return raw


def write(profile: Profile) -> str:
    """The profile as text in millimetres with eight decimals (1e-11 m)."""
    lines = [
        f"# name: {_one_line(profile.name)}",
        f"# kind: {profile.kind}",
        "# unit: mm",
        f"# source: {_one_line(profile.source)}",
        "# y [mm]  z [mm]",
    ]
    lines += [f"{1e3 * y:.8f} {1e3 * z:.8f}" for y, z in zip(profile.y, profile.z, strict=True)]
    return "\n".join(lines) + "\n"


def _header(raw: RawProfile, text: str, line: int, label: str) -> None:
    match = _HEADER.match(text)
    if not match:
        return
    key, value = match[1].lower(), match[2]
    if key == "name":
        raw.name = value
    elif key == "source":
        raw.source = value
    elif key == "kind":
        if value.lower() not in ("wheel", "rail"):
            raise fault(label, line, f"kind {shorten(value)!r}; write '# kind: wheel' or 'rail'")
        raw.kind, raw.kind_line = value.lower(), line
    else:
        unit = unit_word(value)
        if unit is None:
            raise fault(label, line, f"unit {shorten(value)!r}; use mm, m, cm or inch")
        raw.unit, raw.unit_line = unit, line


def _without_comment(text: str) -> str:
    for mark in ("#", "!", "%", "//"):
        text = text.split(mark, 1)[0]
    return text.strip()


def _separator(texts: list[str], label: str, line: int) -> tuple[Split, bool, str]:
    """How to split a row, whether commas are decimal, and the separator in words."""
    sample = texts[:200]
    half = 0.5 * len(sample)

    def often(test: Callable[[str], object]) -> bool:
        return sum(bool(test(text)) for text in sample) > half

    def by(mark: str) -> Split:
        return lambda text: [token.strip().strip('"') for token in text.split(mark)]

    if often(lambda text: ";" in text):
        comma = often(lambda text: "," in text)
        return by(";"), comma, "semicolons"
    if not often(lambda text: "," in text):
        tabs = often(lambda text: "\t" in text)
        return str.split, False, "tabs" if tabs else "blanks"
    if often(
        lambda text: (
            len(text.split()) >= 2
            and all(_DECIMAL_COMMA.fullmatch(token) for token in text.split()[:2])
        )
    ):
        tabs = often(lambda text: "\t" in text)
        return str.split, True, "tabs" if tabs else "blanks"
    if often(lambda text: re.fullmatch(r"[+-]?\d+,\d+,[+-]?\d+,\d+", text)):
        raise fault(
            label,
            line,
            "commas both as decimal sign and between columns; separate the columns by semicolons",
        )
    return by(","), False, "commas"


def _columns(raw: RawProfile, words: list[tuple[int, str]], split: Split) -> tuple[int, int]:
    """Columns of y and z by the line of column names, if there is one; takes the unit from it."""
    for line, text in reversed(words[-3:]):
        cells = [str(cell).lower().strip() for cell in split(text)]
        names = [re.sub(r"[^a-z].*$", "", cell) for cell in cells]
        units = [unit_word(m[1]) for cell in cells if (m := re.search(r"[\[(](.*?)[\])]", cell))]
        if raw.unit is None and units and units[0] is not None:
            raw.unit, raw.unit_line = units[0], line
        for first, second in _COLUMN_NAMES:
            if first in names and second in names:
                return names.index(first), names.index(second)
    return 0, 1


def _one_line(text: str) -> str:
    return " ".join(text.split())
