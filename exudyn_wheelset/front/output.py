"""Numbers, tables and figures of a model script on disk, with the versions they came from."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.results.files import plain, write_atomically
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.results.versions import versions


def write_json(path: str | Path, numbers: Mapping[str, Any], **about: Any) -> Path:
    """Write numbers with what they are about (settings, parameters) and all versions."""
    record = {"numbers": numbers, **about, "versions": versions()}
    text = json.dumps(record, indent=2, default=plain) + "\n"
    return write_atomically(path, lambda part: part.write_text(text, encoding="utf-8"))


def write_figure(path: str | Path, figure: Any) -> Path:
    """Save a matplotlib figure."""
    return write_atomically(path, lambda part: figure.savefig(part, dpi=130))


def file_stem(script: str, wheelset: Wheelset, track: Track) -> str:
    """Name of the files of a script about a pair, with nothing in it that a file system minds."""
    return re.sub(r"[^\w.+-]+", "_", f"{script}_{wheelset.wheel.name}_{track.rail.name}")


def keep_runs(
    stem: str | Path,
    numbers: Mapping[str, Any],
    motions: Sequence[Motion],
    figure: Any,
    **about: Any,
) -> list[Path]:
    """Keep what a script has computed: <stem>.json, <stem>_<speed>.csv of each motion, <stem>.png.

    about: settings and parameters, for the record. Returns the files.
    """
    return [
        write_json(f"{stem}.json", numbers, **about),
        *(motion.write_csv(f"{stem}_{motion.speed:.2f}.csv") for motion in motions),
        write_figure(f"{stem}.png", figure),
    ]
