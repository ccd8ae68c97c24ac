"""The public names: what the package loads at first use, and what type checkers are told of it."""

import runpy
from pathlib import Path

ROOT = Path(__file__).parents[1]


def test_stub_names_what_the_package_loads():
    stub = runpy.run_path(str(ROOT / "tools" / "make_stub.py"))["stub"]
    written = (ROOT / "exudyn_wheelset" / "__init__.pyi").read_text(encoding="utf-8")
    assert written == stub(), "run python tools/make_stub.py"
