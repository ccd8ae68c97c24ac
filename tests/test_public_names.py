"""The public names: what the package loads at first use, and what type checkers are told of it."""

import runpy
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]


def test_stub_names_what_the_package_loads():
    stub = runpy.run_path(str(ROOT / "tools" / "make_stub.py"))["stub"]
    written = (ROOT / "exudyn_wheelset" / "__init__.pyi").read_text(encoding="utf-8")
    assert written == stub(), "run python tools/make_stub.py"


def test_importing_the_package_loads_nothing():
    """Names load at their first use: reading a profile must not wait for the compiler."""
    program = """
import sys, exudyn_wheelset
heavy = {"numpy", "scipy", "numba", "exudyn", "matplotlib"}
assert not heavy & set(sys.modules), heavy & set(sys.modules)
exudyn_wheelset.create_wheelset
assert "matplotlib" not in sys.modules
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
