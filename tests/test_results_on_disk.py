"""Results on disk and in other hands: whole files, two runs into one folder, pickle, pandas."""

import errno
import io
import json
import os
import pickle
import threading

import numpy as np
import pytest

from exudyn_wheelset.errors import AnalysisError, FileError
from exudyn_wheelset.front.output import write_json
from exudyn_wheelset.results import netcdf
from exudyn_wheelset.results.columns import NamedColumns
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.results.files import write_atomically, write_columns
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.results.versions import versions


def motion():
    time = np.linspace(0.0, 1.0, 11)
    columns = {
        "frame: y [m]": 1e-3 * np.sin(time),
        "axle: y [m]": 2e-3 * np.cos(time),
        "axle: yaw [rad]": 1e-4 * time,
        "axle left: Q [N]": 5e4 + time,
        "axle left: Y [N]": -1e3 * time,
        "axle right: Q [N]": 5e4 - time,
        "axle right: Y [N]": 1e3 * time,
    }
    outcome = Outcome(Ending.WHEEL_CLIMB, "axle at 1 s")
    return Motion(time, columns, outcome, 40.0, {"system": "test"}, np.zeros((11, 12)))


def same(one, other):
    assert one.names == other.names
    assert (one.outcome, one.speed, dict(one.record)) == (
        other.outcome,
        other.speed,
        dict(other.record),
    )
    for name in one.names:
        assert np.array_equal(one[name], other[name])
    assert np.array_equal(one.time, other.time)
    assert np.array_equal(one.coordinates, other.coordinates)


def test_a_motion_comes_back_from_its_file_and_from_pickle(tmp_path):
    path = motion().save(tmp_path / "folder" / "hunting")
    assert path.name == "hunting.npz"
    same(Motion.load(path), motion())
    same(pickle.loads(pickle.dumps(motion())), motion())


def test_a_motion_finds_columns_bodies_and_wheels_by_name():
    given = motion()
    assert given.bodies == ("frame", "axle")
    assert given.wheels == (("axle", "left"), ("axle", "right"))
    assert np.array_equal(given["axle: yaw"], given.columns["axle: yaw [rad]"])
    assert set(given.body("axle")) == {"y [m]", "yaw [rad]"}
    assert given.wheel("axle", "right")["Y [N]"][-1] == 1e3
    with pytest.raises(AnalysisError, match=r"no 'bogie'; it has frame, axle"):
        given.body("bogie")
    with pytest.raises(AnalysisError, match=r"0 is no name of a column: give one of"):
        given[0]
    assert "derailment: a flange has climbed" in repr(given)
    assert len(repr(given)) < 160
    late = given.after(0.45)
    assert late.time[0] == 0.5
    assert len(late) == len(late.coordinates) == 6
    with pytest.raises(AnalysisError, match="other lengths"):
        Motion(np.zeros(3), {"y [m]": np.zeros(2)}, given.outcome, 1.0)


def test_pandas_reads_the_csv_as_it_is(tmp_path):
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(motion().write_csv(tmp_path / "motion.csv"))
    assert list(table.columns) == ["t [s]", *motion().names]
    # Nine digits are written.
    assert table["axle: y [m]"].to_numpy() == pytest.approx(motion()["axle: y"], rel=1e-8)
    frame = motion().to_pandas()
    assert frame.index.name == "t [s]"
    assert np.array_equal(frame["frame: y [m]"], motion()["frame: y"])


def test_xarray_has_units():
    pytest.importorskip("xarray")
    data = motion().to_xarray()
    assert data["axle left: Q"].attrs["units"] == "N"
    assert data["axle: yaw"].dims == ("t",)
    assert data.attrs["ending"].startswith("derailment")


def test_a_motion_comes_back_from_netcdf_to_the_last_bit(tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    pytest.importorskip("h5py")
    given = motion()
    path = given.write_netcdf(tmp_path / "folder" / "hunting.nc")
    same(Motion.read_netcdf(path), given)
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        assert data["Q"].dims == ("t", "wheelset", "side")
        assert data["Q"].attrs["units"] == "N"
        chosen = data["Q"].sel(wheelset="axle", side="right")
        assert np.array_equal(chosen, given.columns["axle right: Q [N]"])
        assert data["distance"].to_numpy() == pytest.approx(40.0 * given.time)
        assert json.loads(data.attrs["record"])["system"] == "test"
    bare = Motion(given.time, given.columns, given.outcome, 40.0, start=3.0)
    again = Motion.read_netcdf(bare.write_netcdf(tmp_path / "bare.nc"))
    same(again, bare)
    assert again.start == 3.0
    (tmp_path / "text.nc").write_text("no file of this kind")
    with pytest.raises(AnalysisError, match="not a result of this package"):
        Motion.read_netcdf(tmp_path / "text.nc")
    with pytest.raises(AnalysisError, match="no such file"):
        Motion.read_netcdf(tmp_path / "nowhere.nc")


def test_without_the_library_the_error_says_what_to_do(monkeypatch):
    import builtins

    real = builtins.__import__

    def missing(name, *arguments):
        if name in ("pandas", "xarray", "h5netcdf", "h5py"):
            raise ImportError(name)
        return real(name, *arguments)

    monkeypatch.setattr(netcdf, "import_module", missing)
    for method in ("to_pandas", "to_xarray"):
        with pytest.raises(AnalysisError, match="pip install"):
            getattr(motion(), method)()
    with pytest.raises(AnalysisError, match="pip install"):
        motion().write_netcdf("anywhere.nc")


def test_named_columns_keep_their_names():
    table = NamedColumns(np.arange(6.0).reshape(3, 2), ["y [m]", "yaw [rad]"])
    for copy in (pickle.loads(pickle.dumps(table)), table.copy()):
        assert copy.names == table.names
        assert np.array_equal(copy["yaw"], [1.0, 3.0, 5.0])
    assert repr(table) == "<3 points of y [m], yaw [rad]>"


def test_two_runs_into_one_folder_do_not_mix(tmp_path):
    """Two writers of the same file, each slow: the file is that of one of them, whole."""
    meet = threading.Barrier(2)

    def write(letter):
        def fill(part):
            with part.open("w") as stream:
                for _ in range(50):
                    stream.write(letter * 100)
                    stream.flush()
                    meet.wait()

        write_atomically(tmp_path / "result.txt", fill)

    threads = [threading.Thread(target=write, args=(letter,)) for letter in "ab"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    text = (tmp_path / "result.txt").read_text()
    assert text in ("a" * 5000, "b" * 5000)
    assert [file.name for file in tmp_path.iterdir()] == ["result.txt"]


@pytest.mark.parametrize("kind", ["npz", "csv", "json"])
def test_a_full_disk_is_one_line(tmp_path, monkeypatch, kind):
    def full(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(FileError) as caught:
        if kind == "npz":
            motion().save(tmp_path / "a.npz")
        elif kind == "csv":
            motion().write_csv(tmp_path / "a.csv")
        else:
            write_json(tmp_path / "a.json", {"speed": 1.0})
    assert str(caught.value) == f"{tmp_path}/a.{kind} cannot be written: No space left on device"
    assert list(tmp_path.iterdir()) == []


def test_files_appear_whole_or_not_at_all(tmp_path):
    path = tmp_path / "kept.txt"
    path.write_text("before")

    def fails(part):
        part.write_text("half")
        raise OSError("disk full")

    with pytest.raises(FileError, match=r"kept\.txt cannot be written: disk full"):
        write_atomically(path, fails)
    assert path.read_text() == "before"
    assert [file.name for file in tmp_path.iterdir()] == ["kept.txt"]


def test_files_are_as_readable_as_others(tmp_path):
    plain, written = tmp_path / "plain", tmp_path / "written.csv"
    plain.write_text("x")
    write_columns(written, {"a": [1.0, 2.0]})
    assert written.stat().st_mode == plain.stat().st_mode


def test_json_holds_numpy_and_versions(tmp_path):
    path = write_json(tmp_path / "a.json", {"y": np.array([1.0]), "n": np.int64(3)}, about=np.pi)
    record = json.load(io.StringIO(path.read_text()))
    assert record["numbers"] == {"y": [1.0], "n": 3}
    assert record["versions"] == versions()
    assert set(versions()) == {"python", "exudyn_wheelset", "exudyn", "numpy", "scipy", "numba"}
