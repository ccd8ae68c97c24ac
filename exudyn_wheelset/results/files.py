"""Files that appear whole or not at all.

A file is written beside its place under a name of its own and moved there when complete: a reader,
an interrupted run and a second run into the same folder never see or mix half a file.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset.errors import FileError


def write_atomically(path: str | Path, write: Callable[[Path], Any]) -> Path:
    """Let `write` fill a file beside `path`, of the same suffix, then put it in place.

    Folders are made where they are missing. Returns the path. Raises FileError, one line with the
    reason, where it cannot be written (a full disk, a folder without permission).
    """
    path = Path(path)
    part = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(
            dir=path.parent, prefix=f".{path.stem}.", suffix=f".part{path.suffix}"
        )
        os.close(handle)
        part = Path(name)
        write(part)
        # mkstemp makes files for the owner alone; a result is as readable as any other file.
        mask = os.umask(0)
        os.umask(mask)
        part.chmod(0o666 & ~mask)
        os.replace(part, path)
    except OSError as error:
        raise FileError(f"{path} cannot be written: {error.strerror or error}") from error
    finally:
        if part is not None:
            part.unlink(missing_ok=True)
    return path


def write_columns(path: str | Path, columns: Mapping[str, Sequence[float] | np.ndarray]) -> Path:
    """Write equally long columns as CSV: one line of names, then numbers. Returns the path."""
    table = np.column_stack([np.asarray(values, dtype=float) for values in columns.values()])
    header = ",".join(columns)
    return write_atomically(
        path,
        lambda part: np.savetxt(
            part, table, delimiter=",", header=header, comments="", fmt="%.9g", encoding="utf-8"
        ),
    )


def plain(value: Any) -> Any:
    """A value that json does not know, as one that it does: for json.dumps(default=plain)."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    return str(value)
