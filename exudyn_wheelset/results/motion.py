"""A simulated motion as data: named columns over time, how it ended, and where it came from.

Of a track with a layout all this is in the frame that travels with the vehicle; "track y", "track
yaw", "track roll" and "station" of a wheelset are where it stands in the frame of the track at its
own station, and Y and Q are in that frame as well. What railway engineers read off a motion is in
its methods; the formulas are in running_safety.py.

Bodies: displacement from the drawn position x, y, z [m], yaw, roll, pitch [rad] and their rates,
named as the states of the system ("frame: y [m]"). Wheels: forces of the rail on the wheel and
values of its contact ("wheelset left: Q [N]"): Y lateral towards +y, Q upwards, both in the track
frame. Track frame: x forward, y left, z up; SI units, radians.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import finite_array, number
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results import comfort, en14363, netcdf
from exudyn_wheelset.results import running_safety as safety
from exudyn_wheelset.results.columns import column_index
from exudyn_wheelset.results.endings import Outcome
from exudyn_wheelset.results.files import write_columns
from exudyn_wheelset.results.records import read_record, write_record
from exudyn_wheelset.spelling import spelt_class

KIND = "motion"
_SIDES = ("left", "right")


@spelt_class
@dataclass(frozen=True, eq=False, repr=False)
class Motion:
    """The result of a simulation.

    time         (m,) [s]
    columns      (m,) each, by name with its unit; `motion["frame: y"]` finds one by its first words
    outcome      how it ended; what was computed before is all here
    speed        [m/s]
    record       system, parameters, settings, versions
    coordinates  (m, nq) Exudyn's second-order coordinates, for drawing the model again; (m, 0)
                 for a system that is not Exudyn's
    start        station [m] of the vehicle's origin at time zero

    Examples
    --------
    >>> from exudyn_wheelset import catalogue, simulate
    >>> motion = simulate(catalogue.vehicle("s1002"), speed=20, duration=0.1, initial=2e-3)
    >>> round(1e3 * float(motion["wheelset: y"][0]), 2)  # [mm]
    2.0
    >>> sorted(motion.wheel("wheelset", "left"))[:2]
    ['Q [N]', 'Y [N]']
    """

    time: Array
    columns: Mapping[str, Array]
    outcome: Outcome
    speed: float
    record: Mapping[str, Any] = field(default_factory=dict)
    coordinates: Array = field(default_factory=lambda: np.zeros((0, 0)))
    start: float = 0.0

    def __post_init__(self) -> None:
        number("speed", self.speed, "m/s")
        number("start", self.start, "m")
        if finite_array("time", self.time, "s").ndim != 1 or np.any(np.diff(self.time) < 0.0):
            raise AnalysisError(f"time = {self.time!r}: give rising times (n,) [s]")
        wrong = {
            name: len(values) for name, values in self.columns.items() if len(values) != len(self)
        }
        if wrong:
            raise AnalysisError(
                f"a motion of {len(self)} samples cannot have columns of other lengths: {wrong}"
            )

    def __len__(self) -> int:
        return len(self.time)

    def __getitem__(self, name: str) -> Array:
        names = list(self.columns)
        return self.columns[names[column_index(names, name)]]

    def __repr__(self) -> str:
        end = f"{self.time[-1]:g} s" if len(self) else "nothing"
        return (
            f"<Motion of {self.record.get('system', 'a model')} at {self.speed:g} m/s: {end}, "
            f"{len(self)} samples of {len(self.columns)} columns; {self.outcome.ending.sentence}>"
        )

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns, with their units."""
        return tuple(self.columns)

    @property
    def bodies(self) -> tuple[str, ...]:
        """Names of the bodies, in the order of the model."""
        wheels = {f"{wheelset} {side}" for wheelset, side in self.wheels}
        found = dict.fromkeys(name.split(": ")[0] for name in self.columns if ": " in name)
        return tuple(name for name in found if name not in wheels)

    @property
    def wheels(self) -> tuple[tuple[str, str], ...]:
        """Wheelset and side of every wheel, in the order of the model, left before right."""
        return tuple(
            (name.removesuffix(f" {side}: Q [N]"), side)
            for name in self.columns
            for side in _SIDES
            if name.endswith(f" {side}: Q [N]")
        )

    @property
    def wheelsets(self) -> tuple[str, ...]:
        """Names of the wheelsets, in the order of the model."""
        return tuple(dict.fromkeys(name for name, _ in self.wheels))

    @property
    def distance(self) -> Array:
        """Station (m,) [m] of the vehicle's origin."""
        return self.start + self.speed * self.time

    @property
    def y(self) -> Array:
        """Lateral shift (m, wheelsets) [m] against the track's centre line at each wheelset."""
        return self._of_wheelsets("track y [m]")

    @property
    def yaw(self) -> Array:
        """Yaw (m, wheelsets) [rad] against the track's direction at each wheelset."""
        return self._of_wheelsets("track yaw [rad]")

    @property
    def Q(self) -> Array:
        """Vertical forces (m, wheelsets, 2) [N] of the rails on left and right wheels, upwards."""
        return self.of_wheels("Q [N]")

    @property
    def Y(self) -> Array:
        """Lateral forces (m, wheelsets, 2) [N] of the rails on the wheels, to the left."""
        return self.of_wheels("Y [N]")

    @property
    def patches(self) -> Array:
        """Number of patches (m, wheelsets, 2) on left and right wheels."""
        return self.of_wheels("patches [-]")

    def _of_wheelsets(self, column: str) -> Array:
        found = [self.columns[f"{name}: {column}"] for name in self.wheelsets]
        return np.column_stack(found) if found else np.zeros((len(self), 0))

    def of_wheels(self, column: str) -> Array:
        """A column of every wheel, (m, wheelsets, 2): "wear_number [N]", "creep_y [-]", ..."""
        shape = (len(self), len(self.wheelsets), 2)
        found = [self.wheel(name, side)[column] for name, side in self.wheels]
        return np.column_stack(found).reshape(shape) if found else np.zeros(shape)

    def body(self, name: str) -> dict[str, Array]:
        """Columns of one body by their own names: "y [m]", "yaw [rad]", "vy [m/s]", ..."""
        return self._of(name, self.bodies)

    def wheel(self, wheelset: str, side: str) -> dict[str, Array]:
        """Columns of one wheel, side "left" or "right": "Q [N]", "Y [N]", "creep_x [-]", ..."""
        return self._of(f"{wheelset} {side}", tuple(f"{a} {b}" for a, b in self.wheels))

    def _of(self, name: str, known: tuple[str, ...]) -> dict[str, Array]:
        prefix = f"{name}: "
        found = {
            column[len(prefix) :]: values
            for column, values in self.columns.items()
            if column.startswith(prefix)
        }
        if not found:
            raise AnalysisError(f"the motion has no {name!r}; it has {', '.join(known)}")
        return found

    def guiding_quotient(self) -> Array:
        """Y/Q (m, wheelsets, 2), Y the wheel's force on the rail towards its field side."""
        return safety.guiding_quotient(self.Y, self.Q)

    def sum_of_y(self) -> Array:
        """Sum of both rails' lateral forces (m, wheelsets) [N], to the left."""
        return np.asarray(self.Y.sum(axis=2))

    def static_loads(self) -> Array:
        """Wheel loads Q0 (wheelsets, 2) [N] at rest: of the record, else the wheelsets' means."""
        known = self.record.get("static_loads")
        if known is not None:
            return np.array([known[name] for name in self.wheelsets])
        mean = self.Q.mean(axis=(0, 2))
        return np.column_stack([mean, mean])

    def unloading(self, static_loads: Array | None = None) -> Array:
        """(Q0 - Q)/Q0 (m, wheelsets, 2); Q0 (wheelsets, 2) [N] defaults to `static_loads`."""
        loads = self.static_loads() if static_loads is None else np.asarray(static_loads)
        return safety.unloading(self.Q, loads)

    def wear_number(self) -> Array:
        """T-gamma (m, wheelsets, 2) [N]: |F_x xi_x| + |F_y xi_y| + |M_z phi| over all patches."""
        return self.of_wheels("wear_number [N]")

    def acceleration(self, body: str, place: Sequence[float] = (0.0, 0.0, 0.0)) -> Array:
        """Acceleration (m, 3) [m/s^2] of a point of a body, along x, y, z of the vehicle's frame.

        place (x, y, z) [m] from the body's centre: over a bogie, at an axle box. The rate of the
        point's velocity in the frame, v + w x r for small rotations, by differences of the samples;
        what the frame itself does in a curve is not in it.
        """
        own = self.body(body)
        velocity = np.column_stack([own[f"v{axis} [m/s]"] for axis in "xyz"])
        spin = np.column_stack([own[f"w{axis} [rad/s]"] for axis in "xyz"])
        return np.asarray(np.gradient(velocity + np.cross(spin, place), self.time, axis=0))

    def sliding_mean(
        self, values: Array, length: float = 2.0, step: float = 0.5
    ) -> tuple[Array, Array]:
        """Means of values (m, ...) over `length` [m], every `step` [m]: centres [m], means."""
        return safety.sliding_mean(self.distance, values, length, step)

    def percentiles(self, values: Array, length: float = 100.0, frequency: float = 20.0) -> Array:
        """0.15, 50 and 99.85 % points (sections, 3, ...) of values (m, ...) over sections [m].

        Low-passed at `frequency` [Hz] before (EN 14363: 4th order, no shift of phase). Raises
        AnalysisError for a motion shorter than a section or sampled too coarsely.
        """
        filtered = en14363.low_pass(self.time, values, frequency)
        return en14363.section_percentiles(self.distance, filtered, length)

    def instability(self, frequency: float, length: float = 100.0) -> tuple[Array, Array]:
        """Root mean square of the sum of Y about a frequency f0 [Hz], +- 2 Hz (EN 14363).

        Centres (k,) [m] of windows of `length` [m] every 10 m, values (k, wheelsets) [N]; compare
        with half of the limit of the sum of Y.
        """
        return en14363.instability(self.time, self.distance, self.sum_of_y(), frequency, length)

    def mean_comfort(self, body: str, place: Sequence[float] = (0.0, 0.0, 0.0)) -> float:
        """N_MV of EN 12299 at a point of a body (see `acceleration`), from blocks of 5 s."""
        return comfort.mean_comfort(self.time, *self.acceleration(body, place).T)

    def continuous_comfort(self, body: str, place: Sequence[float] = (0.0, 0.0, 0.0)) -> Array:
        """Weighted root mean squares (blocks, 3) [m/s^2] along x, y, z over blocks of 5 s."""
        rows = zip(self.acceleration(body, place).T, ("Wd", "Wd", "Wb"), strict=True)
        return np.column_stack(
            [comfort.block_rms(self.time, comfort.weighted(self.time, a, name)) for a, name in rows]
        )

    def sperling(
        self, body: str, place: Sequence[float] = (0.0, 0.0, 0.0), vertical: bool = False
    ) -> float:
        """Sperling's Wz of the lateral, or vertical, acceleration at a point of a body."""
        row = 2 if vertical else 1
        return comfort.sperling(self.time, self.acceleration(body, place)[:, row], vertical)

    def after(self, time: float) -> Motion:
        """The part from a time [s] on."""
        rows = self.time >= time
        return Motion(
            self.time[rows],
            {name: values[rows] for name, values in self.columns.items()},
            self.outcome,
            self.speed,
            self.record,
            self.coordinates[rows] if len(self.coordinates) else self.coordinates,
            self.start,
        )

    def write_csv(self, path: str | Path) -> Path:
        """Write time and columns as CSV, one line of names; whole or not at all."""
        return write_columns(path, {"t [s]": self.time, **self.columns})

    def save(self, path: str | Path) -> Path:
        """Write everything to an npz file, whole or not at all; `Motion.load` reads it back."""
        record = {
            **self.record,
            "kind": KIND,
            "speed": self.speed,
            "start": self.start,
            "outcome": self.outcome.record(),
            "names": list(self.columns),
        }
        table = np.column_stack([self.time, *self.columns.values()])
        return write_record(path, {"table": table, "coordinates": self.coordinates}, record)

    @classmethod
    def load(cls, path: str | Path) -> Motion:
        """Read a file that `save` has written; raises AnalysisError if it is no such file."""
        arrays, record = read_record(path, KIND)
        table = arrays["table"]
        columns = {name: table[:, 1 + k] for k, name in enumerate(record.pop("names"))}
        outcome, speed = Outcome.read(record.pop("outcome")), float(record.pop("speed"))
        start = float(record.pop("start", 0.0))
        record.pop("kind")
        return cls(table[:, 0], columns, outcome, speed, record, arrays["coordinates"], start)

    def to_pandas(self) -> Any:
        """A pandas DataFrame over "t [s]"; raises AnalysisError where pandas is not installed."""
        pandas = netcdf.imported("pandas")
        return pandas.DataFrame(
            dict(self.columns), index=pandas.Index(self.time, name="t [s]"), copy=True
        )

    def to_xarray(self) -> Any:
        """An xarray Dataset over t, wheelset and side (netcdf.py); AnalysisError without xarray."""
        return netcdf.to_dataset(self)

    def write_netcdf(self, path: str | Path) -> Path:
        """Write everything as NetCDF 4, whole or not at all; `Motion.read_netcdf` reads it back.

        Needs xarray and h5netcdf (extra `study`); raises AnalysisError where they are missing.
        """
        return netcdf.write_netcdf(self, path, KIND)

    @classmethod
    def read_netcdf(cls, path: str | Path) -> Motion:
        """Read a file of `write_netcdf`; raises AnalysisError if it is no such file."""
        return netcdf.read_netcdf(cls, path, KIND)
