"""Rows of a comparison, and the files that it is made with."""

import csv
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Row:
    """What is compared, both figures, and their difference, as they stand on the page."""

    what: str
    theirs: str
    ours: str
    difference: str


def outside(file: str) -> Path:
    """Where a file lies that is no part of the project."""
    given = os.environ.get("EXUDYN_WHEELSET_REFERENCE")
    folders = [Path(given)] if given else [p / "shared/reference" for p in REPOSITORY.parents]
    return next((f / file for f in folders if (f / file).exists()), Path(file))


def table(path: Path) -> dict[str, Any]:
    """Columns of a CSV file; those of words stay lists of words."""
    with path.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    columns: dict[str, Any] = {}
    for name in rows[0]:
        words = [row[name] for row in rows]
        try:
            columns[name] = np.array(words, dtype=float)
        except ValueError:
            columns[name] = words
    return columns


def worst(
    what: str, theirs: Any, ours: Any, places: Sequence[str], per: Any = None, unit: str = ""
) -> Row:
    """The row of the point whose difference is largest; per: what it is a share of, else `unit`."""
    theirs, ours = np.atleast_1d(theirs), np.atleast_1d(ours)
    off = ours - theirs
    shares = off if per is None else off / per
    k = int(np.argmax(np.abs(shares)))
    said = f"{off[k]:+.2g}{unit}" if per is None else f"{100 * shares[k]:+.2g} %"
    where = f" at {places[k]}" if places else ""
    count = f", {len(theirs)} points" if len(theirs) > 1 else ""
    return Row(f"{what}{where}{count}", f"{theirs[k]:.6g}", f"{ours[k]:.6g}", said)


def plain(what: str, theirs: float, ours: float, digits: int) -> Row:
    """The row of one number, its difference in per cent."""
    share = 100.0 * (ours / theirs - 1.0)
    return Row(what, f"{theirs:.{digits}f}", f"{ours:.{digits}f}", f"{share:+.2g} %")


def vectors(what: str, theirs: Any, ours: Any, places: Sequence[str], per: Any, of: str) -> Row:
    """The row of the force whose vector is farthest off, its distance in per cent of `per`."""
    off = np.hypot(*(np.asarray(ours) - theirs)) / per
    k = int(np.argmax(off))
    sizes = [f"{np.hypot(*np.asarray(one)[:, k]):.5g}" for one in (theirs, ours)]
    rms = f", rms {100 * np.sqrt(np.mean(off**2)):.2g} %" if len(off) > 20 else ""
    where = f" at {places[k]}" if places else ""
    return Row(f"{what}{where}, {len(off)} points", *sizes, f"{100 * off[k]:.2g} % of {of}{rms}")
