"""One file for a result: arrays and the record of how they came about, written in one go.

The file is numpy's npz; beside the arrays it holds the entry `record`, JSON text with settings,
parameters, versions and method. Nothing in it is pickled.
"""

from __future__ import annotations

import json
import zipfile
from collections.abc import Mapping
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.files import plain, write_atomically
from exudyn_wheelset.results.versions import versions


class Measured(Protocol):
    """Whatever tells its own settings and parameters."""

    def measures(self) -> dict[str, Any]: ...


def describe(system: Measured, method: str, settings: Mapping[str, Any]) -> dict[str, Any]:
    """The record of an analysis: the system's own measures, method, settings, versions and time."""
    return {
        **system.measures(),
        "versions": versions(),
        "method": method,
        "settings": dict(settings),
        "created": datetime.now(timezone.utc).isoformat(timespec="seconds"),
    }


def write_record(path: str | Path, arrays: Mapping[str, Array], record: Mapping[str, Any]) -> Path:
    """Write arrays and record to `path`, suffix .npz, atomically; returns the path written."""
    path = Path(path)
    if path.suffix != ".npz":
        path = path.with_name(path.name + ".npz")
    text = np.array(json.dumps(record, default=plain))

    def write(part: Path) -> None:
        with part.open("wb") as stream:
            np.savez_compressed(stream, record=text, **arrays)  # type: ignore[arg-type]

    return write_atomically(path, write)


def read_record(path: str | Path, kind: str) -> tuple[dict[str, Array], dict[str, Any]]:
    """Arrays and record of a file of the given `kind`; raises AnalysisError if it is not one."""
    try:
        with np.load(path, allow_pickle=False) as content:
            arrays = {name: content[name] for name in content.files}
        record = json.loads(str(arrays.pop("record")))
    except FileNotFoundError:
        raise AnalysisError(f"{path}: no such file") from None
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise AnalysisError(f"{path}: not a result of this package ({error})") from error
    if not isinstance(record, dict) or record.get("kind") != kind:
        found = record.get("kind") if isinstance(record, dict) else None
        raise AnalysisError(f"{path}: holds {found!r}, not a {kind!r}")
    return arrays, record
