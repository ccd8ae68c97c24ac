"""Kept kernels: never those of other sources, compiled once by processes that start together.

A copy of the package is changed between runs, as an update or an editor changes it. The kernel is a
creep law that calls a function of another file: numba's own cache knows nothing of that file.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled

PACKAGE = Path(__file__).parents[1] / "exudyn_wheelset"
PROGRAM = """
import logging, sys
logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stderr)
import numpy as np
from exudyn_wheelset.creep.linear import linear
print(linear(1e-3, 0.0, 0.0, 5e-3, 5e-3, 1e5, 0.3, 8e10, 0.28, np.zeros(1))[0])
"""


@pytest.fixture
def copy(tmp_path):
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(PACKAGE, tmp_path / "tree" / PACKAGE.name, ignore=ignored)
    return tmp_path / "tree"


def start(tree, cache):
    environment = {**os.environ, "PYTHONPATH": str(tree), "NUMBA_CACHE_DIR": str(cache)}
    return subprocess.Popen(
        [sys.executable, "-c", PROGRAM],
        cwd=tree, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def force(tree, cache):
    out, said = start(tree, cache).communicate()
    assert out, said
    return float(out), said


def test_a_changed_callee_is_compiled_anew(copy, tmp_path):
    cache = tmp_path / "cache"
    first, said = force(copy, cache)
    assert "compiling creep.linear.linear" in said
    again, said = force(copy, cache)
    assert again == first and "compiling" not in said
    callee = copy / PACKAGE.name / "creep" / "kalker.py"
    text = callee.read_text(encoding="utf-8")
    # Kalker's table a tenth larger: so is the linear force.
    changed = text.replace("_TABLE = np", "_TABLE = 1.1 * np", 1)
    assert changed != text
    callee.write_text(changed, encoding="utf-8")
    third, said = force(copy, cache)
    assert "compiling creep.linear.linear" in said
    assert abs(third / first - 1.1) < 1e-12
    callee.write_text(text, encoding="utf-8")
    back, said = force(copy, cache)
    assert back == first and "compiling" not in said


def test_processes_that_start_together_compile_once(copy, tmp_path):
    running = [start(copy, tmp_path / "cache") for _ in range(2)]
    ended = [process.communicate() for process in running]
    assert ended[0][0] == ended[1][0] != ""
    assert sum("compiling creep.linear.linear" in said for _, said in ended) == 1


def test_without_a_folder_kernels_are_compiled_in_memory(copy, tmp_path):
    (tmp_path / "file").write_text("")
    found, said = force(copy, tmp_path / "file" / "cache")
    assert found < 0.0
    assert "compiled at every start" in said


def test_a_function_has_its_own_arithmetic_whoever_calls_it_first():
    """(1 + e)^2 - (1 + 2 e) is e^2, but 0 where the square is rounded before the difference."""

    def square_less(a, b):
        return a * a - b

    inner = compiled(square_less)
    fused = compiled(fastmath=AS_REAL_NUMBERS)(lambda a, b: inner(a, b))
    plain = compiled(lambda a, b: inner(a, b))
    e = 2.0**-27
    fused(1.0 + e, 1.0 + 2.0 * e)
    assert plain(1.0 + e, 1.0 + 2.0 * e) == 0.0
