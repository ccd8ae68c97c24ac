"""Motions as xarray datasets and NetCDF files: named arrays with units over labelled axes.

Every column is a variable over the time t, by its name without the unit, which is its attribute
`units`. Beside them stand the quantities that are read first, over t, wheelset and side: Q, Y,
patches, wear_number, and y and yaw of the wheelsets on their track; `distance` is a coordinate.
Attributes say how the motion ended and hold settings, parameters and versions (`record`, JSON), so
that a file gives back the motion to the last bit.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.endings import Outcome
from exudyn_wheelset.results.files import plain, write_atomically

if TYPE_CHECKING:
    from exudyn_wheelset.results.motion import Motion

SIDES = ("left", "right")
_ENGINE = "h5netcdf"
_OF_WHEELS = (("Q", "N"), ("Y", "N"), ("patches", "-"), ("wear_number", "N"))
_OF_WHEELSETS = (("y", "m"), ("yaw", "rad"))


def imported(name: str) -> Any:
    """An optional package by name; raises AnalysisError where it is not installed."""
    try:
        return import_module(name)
    except ImportError as error:
        raise AnalysisError(
            f"{name} is not installed: pip install {name}, or use `columns` and `write_csv`"
        ) from error


def to_dataset(motion: Motion) -> Any:
    """The motion as an xarray Dataset."""
    xarray = imported("xarray")
    variables: dict[str, Any] = {}
    for name, values in motion.columns.items():
        short, unit = _parted(name)
        variables[short] = ("t", values, {"units": unit})
    columns = set(motion.columns)
    for name, unit in _OF_WHEELS:
        if all(f"{a} {b}: {name} [{unit}]" in columns for a, b in motion.wheels) and motion.wheels:
            values = motion.of_wheels(f"{name} [{unit}]")
            variables[name] = (("t", "wheelset", "side"), values, {"units": unit})
    for name, unit in _OF_WHEELSETS:
        if all(f"{one}: track {name} [{unit}]" in columns for one in motion.wheelsets):
            values = getattr(motion, name)
            variables[name] = (("t", "wheelset"), values, {"units": unit})
    coordinates: dict[str, Any] = {
        "t": ("t", motion.time, {"units": "s"}),
        "distance": ("t", motion.distance, {"units": "m"}),
    }
    if motion.wheels:
        coordinates["wheelset"] = list(motion.wheelsets)
        coordinates["side"] = list(SIDES)
    attributes = {"speed": motion.speed, "start": motion.start, "ending": str(motion.outcome)}
    return xarray.Dataset(variables, coordinates, attributes)


def _libraries() -> Any:
    """xarray, with what it writes and reads NetCDF by."""
    for name in ("h5py", _ENGINE):
        imported(name)
    return imported("xarray")


def _parted(name: str) -> tuple[str, str]:
    """Name and unit of a column."""
    short, _, unit = name.partition(" [")
    return short, unit.removesuffix("]")


def write_netcdf(motion: Motion, path: str | Path, kind: str) -> Path:
    """Write the motion as NetCDF 4, whole or not at all; returns the path."""
    _libraries()
    dataset = to_dataset(motion)
    along = "t" if len(motion.coordinates) == len(motion) else "drawn"
    dataset["coordinates"] = ((along, "coordinate"), motion.coordinates)
    record = {
        **motion.record,
        "kind": kind,
        "outcome": motion.outcome.record(),
        "names": list(motion.columns),
    }
    dataset.attrs["record"] = json.dumps(record, default=plain)
    packed = {
        name: {"zlib": True, "complevel": 4}
        for name, variable in dataset.variables.items()
        if variable.dtype.kind == "f" and variable.size
    }
    return write_atomically(
        path, lambda part: dataset.to_netcdf(part, engine=_ENGINE, encoding=packed)
    )


def read_netcdf(make: Callable[..., Motion], path: str | Path, kind: str) -> Motion:
    """The motion of a file; `make` is its class. Raises AnalysisError for another file."""
    xarray = _libraries()
    try:
        with xarray.open_dataset(path, engine=_ENGINE) as dataset:
            dataset.load()
        record: dict[str, Any] = json.loads(dataset.attrs["record"])
    except FileNotFoundError:
        raise AnalysisError(f"{path}: no such file") from None
    except (OSError, ValueError, KeyError) as error:
        raise AnalysisError(f"{path}: not a result of this package ({error})") from error
    if not isinstance(record, Mapping) or record.pop("kind", None) != kind:
        raise AnalysisError(f"{path}: holds no {kind!r}")
    columns = {name: np.asarray(dataset[_parted(name)[0]]) for name in record.pop("names")}
    outcome = Outcome.read(record.pop("outcome"))
    speed, start = float(dataset.attrs["speed"]), float(dataset.attrs["start"])
    coordinates = np.asarray(dataset["coordinates"])
    return make(np.asarray(dataset["t"]), columns, outcome, speed, record, coordinates, start)
