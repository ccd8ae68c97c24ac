"""Results on disk: whole or not at all, with the settings and versions they came from."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import exudyn as exu
import numba
import numpy as np
import scipy

import exudyn_wheelset


def versions() -> dict[str, str]:
    """Versions of everything that a number may depend on."""
    return {
        "exudyn_wheelset": exudyn_wheelset.__version__,
        "exudyn": exu.__version__,
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "numba": numba.__version__,
        "python": platform.python_version(),
    }


def write_atomically(path: Path, write: Callable[[Path], None]) -> Path:
    """Let `write` fill a file beside `path`, then put it in place; return `path`."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.stem}.part{path.suffix}")
    try:
        write(part)
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)
    return path


def write_json(path: Path, numbers: Mapping[str, Any], **about: Any) -> Path:
    """Write numbers with what they are about (settings, parameters) and all versions."""
    record = {"numbers": numbers, **about, "versions": versions()}
    text = json.dumps(record, indent=2, default=_plain) + "\n"
    return write_atomically(path, lambda part: part.write_text(text, encoding="utf-8") and None)


def write_csv(path: Path, columns: Mapping[str, np.ndarray], about: str = "") -> Path:
    """Write equally long columns as CSV with a header line."""
    table = np.column_stack([np.asarray(values, dtype=float) for values in columns.values()])
    header = "".join(f"# {line}\n" for line in about.splitlines()) + ",".join(columns)
    return write_atomically(
        path,
        lambda part: np.savetxt(part, table, delimiter=",", header=header, comments="", fmt="%.9g"),
    )


def write_figure(path: Path, figure: Any) -> Path:
    """Save a matplotlib figure."""
    return write_atomically(path, lambda part: figure.savefig(part, dpi=130))


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    return str(value)
