"""The scripts of models/ as tests see them: loaded by path, run by their `main`, read by --json."""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[1]
SCRIPTS = sorted(path.stem for path in (ROOT / "models").glob("*.py"))


def load(name: str) -> ModuleType:
    """Import a script by its path."""
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, ROOT / "models" / f"{name}.py")
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
    return sys.modules[name]


def call(name: str, *arguments: str) -> int:
    """Exit status of a script's `main`."""
    try:
        status = load(name).main(list(arguments))
    except SystemExit as leaving:
        status = leaving.code
    return status if isinstance(status, int) else 0


def printed_numbers(capsys: pytest.CaptureFixture[str]) -> dict:
    """What --json printed: one JSON object and nothing else."""
    return json.loads(capsys.readouterr().out)


def table_of(path: Path) -> dict[str, np.ndarray]:
    """Columns of a CSV file."""
    lines = path.read_text(encoding="utf-8").splitlines()
    rows = np.array([line.split(",") for line in lines[1:]], dtype=float)
    return dict(zip(lines[0].split(","), rows.T, strict=True))
