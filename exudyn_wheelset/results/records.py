"""One file for a result: arrays and the record of how they came about, written in one go.

The file is numpy's npz; beside the arrays it holds the entry `record`, JSON text with settings,
parameters, versions and method. It is written next to its place and moved there when complete, so
a reader and an interrupted run never see half a file. Nothing in it is pickled.
"""

from __future__ import annotations

import json
import os
import tempfile
import zipfile
from collections.abc import Mapping
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.systems.system import Array, DynamicSystem


def describe(system: DynamicSystem, method: str, settings: Mapping[str, Any]) -> dict[str, Any]:
    """The record of an analysis: the system's own measures, method, settings, version and time."""
    measures = system.measures()
    try:
        own = version("exudyn-wheelset")
    except PackageNotFoundError:
        own = "not installed"
    return {
        **measures,
        "versions": {**measures.get("versions", {}), "exudyn_wheelset": own},
        "method": method,
        "settings": dict(settings),
        "created": datetime.now(timezone.utc).isoformat(timespec="seconds"),
    }


def write_record(path: str | Path, arrays: Mapping[str, Array], record: Mapping[str, Any]) -> Path:
    """Write arrays and record to `path`, suffix .npz, atomically; returns the path written."""
    path = Path(path)
    if path.suffix != ".npz":
        path = path.with_name(path.name + ".npz")
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(record, default=_plain)
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=path.stem, suffix=".part")
    try:
        with os.fdopen(handle, "wb") as stream:
            np.savez_compressed(stream, record=np.array(text), **arrays)  # type: ignore[arg-type]
        # mkstemp makes files for the owner alone; a result is as readable as any other file.
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise
    return path


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


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    return str(value)
