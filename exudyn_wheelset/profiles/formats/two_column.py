"""Plain text with two columns, y and z: the project's own files, users' files, CSV.

Header lines "# key: value" may give name, kind (wheel or rail), unit (mm, m, cm, inch) and source.
With the kind in such a header the file is taken as it is, in the frames of
`exudyn_wheelset.profiles.profile`; without it, unit, kind and orientation are detected and said in
the profile's remarks. Other comment lines (#, %, !, //) and lines of words before the first
numbers are skipped; a line of column names may carry the unit: "y [mm]; z [mm]".

Columns are separated by blanks, tabs, semicolons, bars or commas; a decimal comma is understood
where another separator or quotes tell the columns apart. Brackets around a row, lines that hold
nothing but separators, and labels before the numbers are passed over. Of columns named for two
sides `side` takes one.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from exudyn_wheelset.profiles.formats.raw import (
    RawProfile,
    coordinate,
    fault,
    shorten,
    unit_word,
)
from exudyn_wheelset.profiles.formats.rows import (
    Split,
    columns_by_content,
    find_table,
    looks_numeric,
)
from exudyn_wheelset.profiles.profile import Profile

NAME = "two-column text"
_HEADER = re.compile(r"^\s*[#%!/\"]+\s*(name|kind|unit|units|source)\s*[:=]\s*(.*?)\s*$", re.I)
_COMMENT = ("#", "%", "!", "//")
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?|[+-]?\d+(?:[eE][+-]?\d+)?")
_COLUMN_NAMES = (
    (("y",), ("z",)),
    (("x",), ("y",)),
    (("x",), ("z",)),
    (
        (
            *("lateral", "laterally", "horizontal", "transversal", "transverse", "quer", "breite"),
            *("width", "largeur", "ancho", "larghezza", "orizzontale", "bredde", "poziome"),
        ),
        (
            *("vertical", "vertikal", "height", "höhe", "hoehe", "hauteur", "altura", "altezza"),
            *("verticale", "höjd", "højde", "pionowe"),
        ),
    ),
)
_LABEL = re.compile(r"[A-Za-z_]\w*\s*[;,\t ]\s*(?=[\"']?[-+.]?\d)")
_OTHER = {"left": "right", "right": "left"}
_SIDE_WORDS = {
    "left": re.compile(r"left|links|gauche|^[xyz][ _.-]?l\b|^l[ _.-]?[xyz]\b"),
    "right": re.compile(r"right|rechts|droite|^[xyz][ _.-]?r\b|^r[ _.-]?[xyz]\b"),
}
_UNIT_KEYS = (
    *("unit", "units", "length", "einheit", "einheiten"),
    *("unité", "unite", "unidad", "unità", "enhet"),
)
_KIND_KEYS = ("kind", "type", "typ", "art", "object", "objekt", "tipo", "profile", "profil")
_KIND_WORDS = {
    "wheel": ("wheel", "rad", "roue", "rueda", "ruota", "hjul"),
    "rail": ("rail", "schiene", "carril", "rotaia", "räl", "skena", "skinne"),
}


def read(lines: list[str], label: str, side: str = "left") -> RawProfile:
    """Read a two-column file; ProfileError names file, line and mend."""
    raw = RawProfile(NAME)
    texts: list[tuple[int, str]] = []
    for count, line in enumerate(lines, start=1):
        text = line.strip().strip("\x1a")
        if not text:
            continue
        if text.startswith(_COMMENT):
            _header(raw, text, count, label)
            continue
        text = _without_comment(text).replace("|", ";").strip("{}()[] \t")
        if text.strip(" \t,;\"'"):
            texts.append((count, text))
    texts = _without_labels(raw, texts)
    numeric = [(count, text) for count, text in texts if looks_numeric(text)]
    if not numeric:
        raise fault(label, None, "no line with numbers; give lines with y and z")
    split, decimal_comma, separator = _separator(
        [text for _, text in numeric], label, numeric[0][0]
    )
    table = find_table(texts, split, label, side)
    rows, width = table.rows, table.width
    words = [(count, text) for count, text in texts if count < rows[0][0]]
    _words_of_header(raw, words)
    first, second, named = _columns(raw, words, split, width, side)
    if not named and width > 2:
        kept = columns_by_content(rows, width)
        first, second = kept[:2] if len(kept) >= 2 else (0, 1)
    for count, tokens in rows:
        if len(tokens) <= max(first, second):
            raise fault(
                label,
                count,
                f"{len(tokens)} of {width} columns ({shorten(' '.join(tokens))!r}); "
                "add the missing value or delete the line",
            )
        y = coordinate(tokens[first], label, count, "y", finite=False)
        raw.add(y, coordinate(tokens[second], label, count, "z", finite=False), count)
    raw.check_finite(label)
    raw.remarks += table.remarks
    if separator != "blanks":
        raw.remarks.append(f"columns separated by {separator}")
    if decimal_comma:
        raw.remarks.append("decimal commas")
    if width > 2 and (first, second) != (0, 1):
        raw.remarks.append(f"columns {first + 1} and {second + 1} of {width} taken as y and z")
    elif width > 2:
        raw.remarks.append(f"the first 2 of {width} columns taken as y and z")
    raw.trusted = raw.kind is not None and raw.kind_line is not None
    raw.gauge_by_depth = not raw.trusted
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


def _without_labels(raw: RawProfile, texts: list[tuple[int, str]]) -> list[tuple[int, str]]:
    """Points that all have a label before them, without it."""
    labelled = [bool(_LABEL.match(text)) for _, text in texts]
    if sum(labelled) < 8 or any(looks_numeric(text) for _, text in texts):
        return texts
    raw.remarks.append("labels before the points not read")
    return [
        (count, _LABEL.sub("", text) if is_labelled else text)
        for (count, text), is_labelled in zip(texts, labelled, strict=True)
    ]


def _separator(texts: list[str], label: str, line: int) -> tuple[Split, bool, str]:
    """How to split a row, whether commas are decimal, and the separator in words."""
    sample = texts[:200]
    half = 0.5 * len(sample)

    def often(test: Callable[[str], object]) -> bool:
        return sum(bool(test(text)) for text in sample) > half

    def by(mark: str) -> Split:
        return lambda text: [token.strip().strip('"') for token in text.rstrip(mark).split(mark)]

    def with_points(split: Split) -> Split:
        return lambda text: [token.replace(",", ".") for token in split(text)]

    if often(lambda text: ";" in text):
        comma = often(lambda text: "," in text)
        return with_points(by(";")) if comma else by(";"), comma, "semicolons"
    if not often(lambda text: "," in text):
        if often(lambda text: "\t" in text):
            return _by_tabs, False, "tabs"
        return str.split, False, "blanks"
    if often(
        lambda text: (
            len(text.split()) >= 2
            and all(_DECIMAL_COMMA.fullmatch(token) for token in text.split()[:2])
        )
    ):
        if often(lambda text: "\t" in text):
            return with_points(_by_tabs), True, "tabs"
        return with_points(str.split), True, "blanks"
    if often(lambda text: text.count('"') >= 4 and re.search(r'"[+-]?\d*,\d', text)):
        quoted = re.compile(r'"([^"]*)"|([^",\s]+)')
        return (
            with_points(lambda text: [a or b for a, b in quoted.findall(text)]),
            True,
            "commas between quotes",
        )
    if often(lambda text: re.fullmatch(r"[+-]?\d+,\d+,[+-]?\d+,\d+", text)):
        raise fault(
            label,
            line,
            "commas both as decimal sign and between columns; separate the columns by semicolons",
        )
    return by(","), False, "commas"


def _by_tabs(text: str) -> list[str]:
    return [cell.strip().strip('"') for cell in re.split(r"\t+|\s{2,}", text.strip())]


def _columns(
    raw: RawProfile, words: list[tuple[int, str]], split: Split, width: int, side: str
) -> tuple[int, int, bool]:
    """Columns of y and z by the line of column names, if there is one; takes the unit from it."""
    for line, text in reversed(words[-4:]):
        cells = [str(cell).lower().strip().strip('"') for cell in split(text)]
        named = [cell for cell in cells if not re.fullmatch(r"[\[(].*[\])]", cell)]
        if len(named) > width:
            named = named[len(named) - width :]
        if width >= 4:
            of_side = [k for k, cell in enumerate(named) if _SIDE_WORDS[side].search(cell)]
            others = [k for k, cell in enumerate(named) if _SIDE_WORDS[_OTHER[side]].search(cell)]
            if len(of_side) == 2 and len(others) >= 2:
                raw.remarks.append(f"the columns of the {side} side taken (side={side!r})")
                return of_side[0], of_side[1], True
        names = [re.sub(r"[^a-zà-ÿ].*$", "", cell) for cell in named]
        units = [unit_word(m[1]) for cell in cells if (m := re.search(r"[\[(](.*?)[\])]", cell))]
        if not units and all(unit_word(cell) for cell in cells):
            units = [unit_word(cells[0])]
        if raw.unit is None and units and units[0] is not None:
            raw.unit, raw.unit_line = units[0], line
        for firsts, seconds in _COLUMN_NAMES:
            across = [k for k, name in enumerate(names) if name in firsts]
            upward = [k for k, name in enumerate(names) if name in seconds]
            if across and upward:
                return across[0], upward[0], True
    return 0, 1, False


def _words_of_header(raw: RawProfile, words: list[tuple[int, str]]) -> None:
    """Unit and kind that lines such as "Unit: mm" or "Einheit;mm" name, in several languages."""
    for line, text in words:
        parts = [part.strip().strip('"') for part in re.split(r"[:=;,\t]", text, maxsplit=1)]
        if len(parts) < 2:
            continue
        key, value = parts[0].lower(), parts[1].split(";")[0].split(",")[0].strip()
        if key in _UNIT_KEYS and raw.unit is None and unit_word(value):
            raw.unit, raw.unit_line = unit_word(value), line
        elif key in _KIND_KEYS and raw.kind is None:
            for kind, names in _KIND_WORDS.items():
                if any(name in value.lower() for name in names):
                    raw.kind = kind


def _one_line(text: str) -> str:
    return " ".join(text.split())
