"""Jobs of a new user from an empty directory, with the built wheel in place of the source tree.

Each file in tests/jobs is one: it does its work, asserts one number of it and gives one wrong
input, which must be refused by a message that names it. Dependencies are those of the environment.
"""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
JOBS = sorted((ROOT / "tests" / "jobs").glob("*.py"))
SHIPPED = ("exudyn_wheelset", "models", "profiles", "runs")
NEEDS = {"motion_into_pandas": "pandas", "car_from_file_to_root_locus": "cattrs"}
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel, built from a copy so that nothing is left in the source tree."""
    tree, out = tmp_path_factory.mktemp("tree"), tmp_path_factory.mktemp("wheel")
    for name in SHIPPED:
        ignored = shutil.ignore_patterns("__pycache__", "out")
        shutil.copytree(ROOT / name, tree / name, ignore=ignored)
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, tree)
    command = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", str(out), str(tree)]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    if built.returncode and "setuptools" in built.stderr:
        pytest.skip(f"no setuptools to build with: {built.stderr[-300:]}")
    assert built.returncode == 0, built.stderr
    return next(out.glob("*.whl"))


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """A folder that holds what the wheel installs."""
    folder = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def run(installed, folder, *command):
    environment = {**os.environ, "PYTHONPATH": str(installed), "MPLBACKEND": "Agg"}
    environment["EXUDYN_NO_USER_SETTINGS"] = "1"
    return subprocess.run(
        [sys.executable, *command], cwd=folder, env=environment, capture_output=True, text=True,
        check=False,
    )  # fmt: skip


def test_wheel_has_every_file_of_the_tree(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    installed_as = {"models": "exudyn_wheelset/models", "runs": "exudyn_wheelset/runs"}
    installed_as["profiles"] = "exudyn_wheelset/profile_files"
    missing = []
    for top in SHIPPED:
        for path in (ROOT / top).rglob("*"):
            inside = path.relative_to(ROOT / top)
            if path.is_file() and not {"__pycache__", "out"} & set(inside.parts):
                name = f"{installed_as.get(top, top)}/{inside.as_posix()}"
                missing += [] if name in names else [name]
    assert missing == []


@pytest.mark.parametrize("job", JOBS, ids=[path.stem for path in JOBS])
def test_job(job, installed, tmp_path):
    if job.stem in NEEDS:
        pytest.importorskip(NEEDS[job.stem])
    shutil.copy(job, tmp_path / "job.py")
    where = run(installed, tmp_path, "-c", "import exudyn_wheelset as e; print(e.__file__)")
    assert where.stdout.startswith(str(installed)), where.stderr
    done = run(installed, tmp_path, "-W", "ignore", "job.py")
    assert done.returncode == 0, done.stdout + done.stderr
    assert not (tmp_path / "solution").exists()


def test_types_of_a_program(installed, tmp_path):
    pytest.importorskip("mypy")
    shutil.copy(ROOT / "tests" / "typed_program.py", tmp_path / "program.py")
    (tmp_path / "mypy.ini").write_text("[mypy]\nstrict = True\nignore_missing_imports = True\n")
    environment = {**os.environ, "MYPYPATH": str(installed)}
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--follow-imports=silent", "program.py"],
        cwd=tmp_path, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
