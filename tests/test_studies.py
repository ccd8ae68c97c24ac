"""Studies: the same bits whatever runs them, however often they are killed.

What is compared against is the function itself, called in a loop, and the bytes of the file of a
study that nothing disturbed.
"""

import csv
import math
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import Executor, Future, ThreadPoolExecutor

import numpy as np
import pytest
from exudyn.processing import ParameterVariation

from exudyn_wheelset import WheelsetError
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.studies import Study, files, grid, latin_hypercube, study, table_rows
from exudyn_wheelset.systems.function_system import FunctionSystem


def oscillator(case):
    """Linear critical speed of a damped oscillator fed with speed: damping/feed in closed form."""
    damping, feed = case["damping"], case["feed"]

    def rate(state, speed):
        return np.array([state[1], -4.0 * state[0] - (damping - feed * speed) * state[1]])

    system = FunctionSystem("oscillator", rate, ("y [m]", "vy [m/s]"), (1.0, 1.0))
    found = linear_critical_speed(system, 1.0, 100.0)
    return {"speed": found.speed, "frequency": found.frequency}


CASES = {"damping": [2.0, 3.0, 300.0], "feed": [0.1, 0.3]}


def slow_sine(case, pause=0.0):
    time.sleep(pause)
    return {"sine": math.sin(case["angle"]), "third": case["angle"] / 3.0}


def bits(found):
    return {name: found.table[name].tolist() for name in ("speed", "frequency", "reason")}


def test_a_study_says_what_the_function_says():
    found = study(oscillator, CASES, executor=1)
    assert len(found) == 6 and found.names == ("damping", "feed")
    table = found.table
    for row, case in zip(table.rows, grid(CASES), strict=True):
        if case["damping"] == 300.0:
            # 300/0.1 and 300/0.3 lie above 100 m/s: a value as well.
            assert math.isnan(row["speed"])
            assert row["reason"].startswith("AnalysisError: oscillator: no linear critical speed")
        else:
            assert row["speed"] == pytest.approx(case["damping"] / case["feed"], rel=1e-9)
            assert row["frequency"] == pytest.approx(1.0 / math.pi, rel=1e-6)
            assert row["reason"] == ""
    assert len(found.failed) == 2
    assert found.record["function"].endswith("oscillator")
    assert "exudyn" in found.record["versions"]


def test_serial_two_processes_threads_and_resumed_are_the_same_bits(tmp_path):
    files = [tmp_path / f"{name}.jsonl" for name in ("serial", "processes", "threads")]
    alone = study(oscillator, CASES, executor=1, file=files[0])
    shared = study(oscillator, CASES, executor=2, file=files[1])
    with ThreadPoolExecutor(2) as pool:
        threads = study(oscillator, CASES, executor=pool, file=files[2])
    assert np.array_equal(str(bits(alone)), str(bits(shared)))
    assert str(bits(alone)) == str(bits(threads))
    whole = files[0].read_bytes()
    assert all(file.read_bytes() == whole for file in files)
    # Killed in the middle of the line of its third case.
    lines = whole.splitlines(keepends=True)
    for kept in ([*lines[:3], lines[3][:20]], [lines[0], *lines[4:1:-1]], lines[:1]):
        files[0].write_bytes(b"".join(kept))
        resumed = study(oscillator, CASES, executor=1, file=files[0])
        assert str(bits(resumed)) == str(bits(alone))
        assert files[0].read_bytes() == whole
    assert str(bits(Study.load(files[0]))) == str(bits(alone))


def test_what_is_done_is_not_done_again(tmp_path):
    file = tmp_path / "study.jsonl"
    study(slow_sine, {"angle": [0.1, 0.2, 0.3]}, executor=1, file=file)

    class Refuses(Executor):
        def submit(self, *arguments, **options):
            raise AssertionError("nothing is left to do")

    again = study(slow_sine, {"angle": [0.1, 0.2, 0.3]}, executor=Refuses(), file=file)
    assert again.table["sine"].tolist() == [math.sin(a) for a in (0.1, 0.2, 0.3)]


def test_another_study_is_not_mixed_with_the_first(tmp_path):
    file = tmp_path / "study.jsonl"
    study(slow_sine, {"angle": [0.1]}, executor=1, file=file)
    with pytest.raises(WheelsetError, match=r"holds another study .*digest"):
        study(slow_sine, {"angle": [0.2]}, executor=1, file=file)
    with pytest.raises(WheelsetError, match=r"holds another study .*settings"):
        study(slow_sine, {"angle": [0.1]}, executor=1, file=file, settings={"pause": 0.1})
    (tmp_path / "other.txt").write_text("no study\n")
    with pytest.raises(WheelsetError, match="not the file of a study"):
        study(slow_sine, {"angle": [0.1]}, executor=1, file=tmp_path / "other.txt")


KILLED = """
import math, sys, time
from exudyn_wheelset.studies import study

def slow_sine(case):
    time.sleep(0.01)
    return {"sine": math.sin(case["angle"]), "third": case["angle"] / 3.0}

if __name__ == "__main__":
    study(slow_sine, {"angle": [0.1 * k for k in range(60)]}, executor=1, file=sys.argv[1])
"""


def test_killed_at_random_it_ends_in_the_same_file(tmp_path):
    script = tmp_path / "killed.py"
    script.write_text(KILLED)
    reference, file = tmp_path / "reference.jsonl", tmp_path / "killed.jsonl"
    subprocess.run([sys.executable, str(script), str(reference)], check=True)
    random = np.random.default_rng(3)
    kills = 0
    for _ in range(20):
        process = subprocess.Popen([sys.executable, str(script), str(file)])
        before = file.stat().st_size if file.exists() else 0
        while process.poll() is None and (not file.exists() or file.stat().st_size <= before):
            time.sleep(0.002)
        time.sleep(float(random.uniform(0.0, 0.2)))
        if process.poll() is not None:
            break
        process.send_signal(signal.SIGKILL)
        process.wait()
        kills += 1
    assert process.returncode == 0 and kills >= 2
    assert file.read_bytes() == reference.read_bytes()
    assert [path.name for path in tmp_path.glob(".*")] == []


def test_it_is_a_parameter_function_of_exudyn():
    ranges = {"damping": [2.0, 3.0], "feed": [0.1, 0.3]}
    by_name, values = ParameterVariation(
        oscillator, ranges, useMultiProcessing=False, showProgress=False
    )
    found = study(oscillator, ranges, executor=1)
    assert [value["speed"] for value in values] == found.table["speed"].tolist()
    assert list(by_name["damping"]) == found.table["damping"].tolist()


def test_overhead():
    # Cases of 20 ms, as long as a linear critical speed of a truck; in process time, which other
    # work on the machine does not lengthen.
    def busy(case):
        end = time.process_time() + 0.02
        while time.process_time() < end:
            pass
        return case["k"]

    begin = time.process_time()
    study(busy, {"k": list(range(25))}, executor=1, progress=False)
    assert time.process_time() - begin < 1.05 * 0.5


def test_functions_that_cannot_be_sent_are_named():
    with pytest.raises(WheelsetError, match="define it at the top of a module"):
        study(lambda case: 1.0, {"k": [1, 2]}, executor=2)
    assert study(lambda case: 1.0, {"k": [1, 2]}, executor=1).table["value"].tolist() == [1, 1]


def test_a_job_of_another_library_needs_a_result_only():
    class Job:
        def __init__(self, value):
            self.value = value

        def result(self):
            return self.value

        def cancel(self):
            pass

    class Jobs:
        def submit(self, function, *arguments):
            return Job(function(*arguments))

    assert not issubclass(Job, Future)
    found = study(slow_sine, {"angle": [0.5, 0.7]}, executor=Jobs())
    assert found.table["sine"].tolist() == [math.sin(0.5), math.sin(0.7)]


def test_latin_hypercube_has_one_case_in_each_part():
    cases = latin_hypercube(20, {"a": (1.0, 3.0)}, b=(-1.0, 1.0), seed=4)
    for name, low, high in (("a", 1.0, 3.0), ("b", -1.0, 1.0)):
        parts = sorted(int(20 * (case[name] - low) / (high - low)) for case in cases)
        assert parts == list(range(20))
    assert cases == latin_hypercube(20, {"a": (1.0, 3.0)}, b=(-1.0, 1.0), seed=4)
    assert cases != latin_hypercube(20, {"a": (1.0, 3.0)}, b=(-1.0, 1.0), seed=5)


def test_cases_from_tables_and_folders(tmp_path):
    path = tmp_path / "cases.csv"
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerows([["name", "mass", "axles"], ["one", 0.1, 2], ["two", 1e-3, 3]])
    expected = [{"name": "one", "mass": 0.1, "axles": 2}, {"name": "two", "mass": 1e-3, "axles": 3}]
    assert table_rows(path) == expected
    assert table_rows({name: [row[name] for row in expected] for name in expected[0]}) == expected
    assert files(tmp_path, "*.csv", name="wheel") == [{"wheel": str(path)}]
    with pytest.raises(WheelsetError, match="no file"):
        files(tmp_path, "*.whl")
    with pytest.raises(WheelsetError, match="columns of different lengths"):
        table_rows({"a": [1, 2], "b": [1]})


def test_grids_open_over_their_axes():
    xarray = pytest.importorskip("xarray")
    found = study(slow_sine, [{"angle": a, "side": s} for a in (2.0, 1.0) for s in ("r", "l")], 1)
    dataset = found.to_xarray()
    assert isinstance(dataset, xarray.Dataset) and dataset["sine"].dims == ("angle", "side")
    assert float(dataset["sine"].sel(angle=2.0, side="l")) == math.sin(2.0)
    assert float(found.to_pandas()["third"][2]) == 1.0 / 3.0
    scattered = study(slow_sine, [{"angle": 1.0}, {"angle": 1.0}], 1).to_xarray()
    assert scattered["sine"].dims == ("case",)


def _fails(case):
    raise ValueError("broken")


def test_axes_of_a_grid_and_drawings(tmp_path):
    import matplotlib.pyplot as plt

    found = study(slow_sine, [{"angle": a, "side": s} for a in (2.0, 1.0) for s in ("r", "l")], 1)
    axes = found.axes()
    assert axes["angle"].tolist() == [1.0, 2.0] and axes["side"].tolist() == ["l", "r"]
    lines = found.plot("angle", "sine").get_lines()
    assert [line.get_label() for line in lines] == ["side l", "side r"]
    assert lines[0].get_ydata().tolist() == [math.sin(1.0), math.sin(2.0)]
    nothing = study(_fails, grid(side=[1.0, 2.0], angle=[0.0, 1.0]), 1, progress=False)
    for draw in (nothing.map, nothing.plot):
        with pytest.raises(WheelsetError, match=r"without results.*broken"):
            draw()
    field = found.map("side", "angle", "sine").collections[0].get_array()
    assert np.asarray(field).ravel().tolist() == 2 * [math.sin(1.0)] + 2 * [math.sin(2.0)]
    found.draw_table()
    plt.close("all")
    text = found.save_csv(tmp_path / "table.csv").read_text().splitlines()
    assert text[0] == "angle,side,sine,third,reason" and len(text) == 5


COMPILES = """
import numpy as np
from numba.core import event

class Counter(event.Listener):
    count = 0
    def on_start(self, event): pass
    def on_end(self, event): Counter.count += 1

event.register("numba:compile", Counter())
from exudyn_wheelset.catalogue.cooperrider_bogie import contact_forces
contact_forces(np.zeros(7), np.zeros(7), 1.0, np.ones(6), np.zeros(7))
print(Counter.count)
"""


def test_workers_with_an_empty_cache_compile_once(tmp_path):
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    workers = [
        subprocess.Popen(
            [sys.executable, "-c", COMPILES], env=environment, stdout=subprocess.PIPE, text=True
        )
        for _ in range(2)
    ]
    counts = [int(worker.communicate()[0]) for worker in workers]
    assert sum(counts) == 1
