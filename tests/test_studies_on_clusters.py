"""A study of 200 vehicles by Dask and by MPI: the same bytes as one case after the other here.

Both are optional: what is not installed is skipped. MPI needs a launcher (mpiexec) as well.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from exudyn_wheelset.catalogue.cooperrider_bogie import CooperriderBogie
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.studies import study

CASES = {
    "conicity": [0.02 + 0.009 * k for k in range(20)],
    "half_wheelbase": [0.9 + 0.04 * k for k in range(10)],
}
SCRIPT = """
from mpi4py.futures import MPIPoolExecutor
from test_studies_on_clusters import CASES, critical
from exudyn_wheelset.studies import study

if __name__ == "__main__":
    with MPIPoolExecutor() as pool:
        study(critical, CASES, executor=pool, file={file!r}, progress=False)
"""


def critical(case):
    found = linear_critical_speed(CooperriderBogie(**case), 15.0, 150.0)
    return {"speed": found.speed, "frequency": found.frequency}


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    file = tmp_path_factory.mktemp("serial") / "study.jsonl"
    found = study(critical, CASES, executor=1, file=file)
    assert len(found) == 200 and not found.failed
    return file.read_bytes()


@pytest.mark.slow
def test_two_processes(serial, tmp_path):
    study(critical, CASES, executor=2, file=tmp_path / "study.jsonl")
    assert (tmp_path / "study.jsonl").read_bytes() == serial


@pytest.mark.slow
def test_dask(serial, tmp_path):
    distributed = pytest.importorskip("distributed")
    file = tmp_path / "study.jsonl"
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=tmp_path
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        study(critical, CASES, executor=client.get_executor(), file=file)
    assert file.read_bytes() == serial


@pytest.mark.slow
def test_mpi_on_two_ranks(serial, tmp_path):
    pytest.importorskip("mpi4py")
    beside = Path(sys.executable).parent / "mpiexec"
    launcher = str(beside) if beside.exists() else shutil.which("mpiexec")
    if launcher is None:
        pytest.skip("no mpiexec")
    file, script = tmp_path / "study.jsonl", tmp_path / "script.py"
    script.write_text(SCRIPT.format(file=str(file)))
    paths = [str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")]
    subprocess.run(
        [launcher, "-n", "2", sys.executable, "-m", "mpi4py.futures", str(script)],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))},
        check=True,
        timeout=300,
        cwd=tmp_path,
    )
    assert file.read_bytes() == serial
