"""Which lines of a text are the points: headers of words and numbers, trailers, several tables.

Instruments and their users put lines of numbers into headers (wheel sizes, a count of points, a
date), words behind the last point, and several tables into one file. What makes a table is that
its lines have the same number of columns and stand together; a line of words or a line of another
width with fewer than 8 points before it belongs to the header. A faulty line among the points is
no header: it is handed on and refused by its reader.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from exudyn_wheelset.profiles.formats.raw import fault, listed, number, shorten

Split = Callable[[str], list[str]]
_FEWEST = 8
_NUMERIC = re.compile(r"[\"'+\-.,;\s]*\d|[\"']?[+-]?(nan|inf)", re.I)
_OVERLAP = 0.5


@dataclass
class Table:
    """The lines with points: (line, cells) each; header: indices of the rows before the first."""

    rows: list[tuple[int, list[str]]]
    width: int
    remarks: list[str] = field(default_factory=list)


def looks_numeric(text: str) -> bool:
    """Whether a line begins as a number does."""
    return bool(_NUMERIC.match(text))


def find_table(
    texts: Sequence[tuple[int, str]],
    split: Split,
    label: str,
    side: str = "left",
    join: bool = False,
) -> Table:
    """The points among lines of text.

    texts: (line, text) without comments and empty lines; split: cells of a text; side: of two
    tables for the same width, "left" takes the first and "right" the second unless words before
    them name the sides; join: tables are pieces of one profile.
    Raises ProfileError, naming the line, where there is no table or a faulty line in it.
    """
    cells = [split(text) for _, text in texts]
    widths = Counter(
        len(row) for row, (_, text) in zip(cells, texts, strict=True) if looks_numeric(text)
    )
    if not widths:
        raise fault(label, None, "no line with numbers; give lines with y and z")
    width = widths.most_common(1)[0][0]
    if width == 1:
        first = next(line for line, text in texts if looks_numeric(text))
        raise fault(label, first, "one column; give y and z on each line")
    good = [len(row) == width and number(row[0]) is not None for row in cells]
    words = [not looks_numeric(text) for _, text in texts]
    table = Table([], width)
    if not any(good):
        table.rows = [(texts[i][0], cells[i]) for i in range(len(texts)) if not words[i]]
        return table
    start = _start(good, words)
    numbers = [texts[i] for i in range(start) if not words[i]]
    if numbers:
        said = listed([f"line {line} ({shorten(text, 30)!r})" for line, text in numbers], 3)
        table.remarks.append(f"numbers before the points taken as header: {said}")
    last = max(i for i, is_good in enumerate(good) if is_good)
    if any(words[last + 1 :]):
        end = next(i for i in range(last + 1, len(texts)) if words[i])
        table.remarks.append(f"words after the points not read, from line {texts[end][0]} on")
    else:
        end = len(texts)
    breaks = [i for i in range(start, end) if words[i]]
    first, last = start, end
    if breaks and not join:
        first, last = _choose(texts, cells, good, breaks, (start, end), label, side, table.remarks)
    table.rows = [(texts[i][0], cells[i]) for i in range(first, last) if not words[i]]
    return table


def columns_by_content(rows: Sequence[tuple[int, list[str]]], width: int) -> list[int]:
    """The columns that may be coordinates: neither a running number nor all the same.

    Columns of an unlabelled table with more than two columns; the first two are y and z.
    """
    values = [[number(cells[k]) for _, cells in rows if len(cells) == width] for k in range(width)]
    kept = []
    for k, column in enumerate(values):
        known = [value for value in column if value is not None]
        if len(known) < len(column) or not known:
            continue
        steps = {round(b - a, 9) for a, b in pairwise(known)}
        if steps == {0.0} or (steps == {1.0} and known[0] in (0.0, 1.0)):
            continue
        kept.append(k)
    return kept


def _start(good: list[bool], words: list[bool]) -> int:
    """Index of the first point: fewer than 8 points before a line of words are its header."""
    start = good.index(True)
    total = sum(good)
    seen = 0
    for i in range(start, len(good)):
        if words[i] and seen < _FEWEST <= total - seen and True in good[i:]:
            total -= seen
            seen = 0
            start = i + good[i:].index(True)
        elif good[i]:
            seen += 1
    return start


def _choose(
    texts: Sequence[tuple[int, str]],
    cells: list[list[str]],
    good: list[bool],
    breaks: list[int],
    limits: tuple[int, int],
    label: str,
    side: str,
    remarks: list[str],
) -> tuple[int, int]:
    """First and last index of the table to take where words part several."""
    edges = [limits[0] - 1, *breaks, limits[1]]
    blocks = [(a + 1, b) for a, b in pairwise(edges) if sum(good[a + 1 : b]) >= _FEWEST]
    whole = limits[0], limits[1]
    if len(blocks) < 2:
        line, text = texts[breaks[0]]
        raise fault(label, line, f"{shorten(text)!r} among the points; delete the line")
    ranges = []
    for a, b in blocks:
        column = [number(cells[i][0]) or 0.0 for i in range(a, b) if good[i]]
        ranges.append((min(column), max(column)))
    low = max(r[0] for r in ranges[:2])
    high = min(r[1] for r in ranges[:2])
    shortest = min(r[1] - r[0] for r in ranges[:2])
    if not high - low > _OVERLAP * shortest:
        line, text = texts[breaks[0]]
        raise fault(label, line, f"{shorten(text)!r} among the points; delete the line")
    names = [" ".join(texts[i][1].lower() for i in range(max(a - 3, 0), a)) for a, _ in blocks]
    named = [k for k, name in enumerate(names) if re.search(rf"\b{side}\b", name)]
    taken = named[0] if len(named) == 1 else (1 if side == "right" else 0)
    first, last = blocks[taken]
    remarks.append(
        f"{len(blocks)} tables of points; table {taken + 1} taken, "
        f"lines {texts[first][0]} to {texts[last - 1][0]} (side={side!r})"
    )
    assert whole[0] <= first < last <= whole[1]
    return first, last
