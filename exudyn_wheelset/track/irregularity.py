"""How far the rails lie off the layout: a table over the distance, from spectra, points, functions.

    alignment    a(s): both rails to the left            y_l = a + g/2,  y_r = a - g/2
    gauge        g(s): by how much it is wider           z_l = v + c/2,  z_r = v - c/2
    vertical     v(s): both rails upwards
    cross_level  c(s): height of the left rail over the right one
all in metres. Between the points of the table each rail runs on cubic splines, before the first
and behind the last it stays where it was. A signal with the one-sided density S is the sum of waves
    sum_k sqrt(2 S(O_k) dO) cos(O_k s + phase_k),   O_k = k dO,  dO = 2 pi/length,
with random phases: its variance is that of the band, whatever the seed (Shinozuka and Jan 1972).
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import number, numbers, positive, unknown
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt, spelt_class
from exudyn_wheelset.track.spectra import KINDS, Spectrum, spectra

# Rails farther off [m] are broken, or given in millimetres.
_FARTHEST = 0.3


@spelt_class
class Irregularity:
    """Shifts of both rails over the distance.

    distance (n,) [m], rising; shifts (n, 4) [m]: left y, z, right y, z. Made by `from_psd`,
    `from_points`, `from_functions` or `load`. name: what it is, for records. Immutable, hashable,
    equal to another of the same numbers. Raises WheelsetError with the row for distances that fall
    or stand still and for what is no number.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_wheelset import Irregularity
    >>> x = np.linspace(0, 20, 41)
    >>> shifts = np.zeros((4, 41))  # left y, left z, right y, right z [m]
    >>> shifts[1] = 2e-3 * np.sin(x)
    >>> rough = Irregularity.from_points(x, *shifts)
    >>> round(1e3 * float(np.abs(rough.shifts[:, 1]).max()), 1)  # [mm]
    2.0
    """

    def __init__(self, distance: Any, shifts: Any, name: str = "points") -> None:
        self.distance = np.ascontiguousarray(_numbers_of("distance", distance))
        self.shifts = np.ascontiguousarray(_numbers_of("shifts", shifts))
        self.name = name
        _check_distance(self.distance)
        if self.shifts.shape != (len(self.distance), 4):
            raise WheelsetError(
                f"irregularity: shifts have the shape {self.shifts.shape}: give a row (left y, z, "
                f"right y, z) for each of the {len(self.distance)} distances"
            )
        bad = ~np.isfinite(self.shifts).all(axis=1)
        if bad.any():
            row = int(np.argmax(bad))
            raise WheelsetError(
                f"irregularity: row {row} at {self.distance[row]:g} m holds no number: fill it in "
                "or leave the row out"
            )
        worst = float(np.abs(self.shifts).max())
        if worst > _FARTHEST:
            row = int(np.argmax(np.abs(self.shifts).max(axis=1)))
            raise WheelsetError(
                f"irregularity: {worst:g} m off at {self.distance[row]:g} m (at most "
                f"{_FARTHEST:g} m): give metres"
            )
        self.distance.setflags(write=False)
        self.shifts.setflags(write=False)

    @classmethod
    @spelt
    def from_points(
        cls,
        distance: Any,
        alignment: Any = 0.0,
        vertical: Any = 0.0,
        cross_level: Any = 0.0,
        gauge: Any = 0.0,
        name: str = "points",
    ) -> Irregularity:
        """Irregularity through points: distance (n,) [m], the four kinds (n,) [m], or 0.

        Distances need not be equal. Signs: module header.
        """
        distance = _numbers_of("distance", distance)
        _check_distance(distance)
        columns = []
        for kind, values in zip(KINDS, (alignment, vertical, cross_level, gauge), strict=True):
            column = _numbers_of(kind, values)
            if column.ndim and column.shape != distance.shape:
                raise WheelsetError(
                    f"{kind} has {column.size} values for {len(distance)} distances: give one each"
                )
            columns.append(np.broadcast_to(column, distance.shape))
        return cls(distance, _of_rails(*columns), name)

    @classmethod
    @spelt
    def from_functions(
        cls,
        left: Callable[[Array], Any],
        right: Callable[[Array], Any],
        length: float,
        spacing: float = 0.05,
        start: float = 0.0,
        name: str = "functions",
    ) -> Irregularity:
        """Irregularity from two functions of stations (n,) [m] that return (y, z) of a rail [m].

        Sampled every `spacing` [m] over `length` [m] from `start`; cubic splines lie between.
        """
        count = _count(length, spacing)
        distance = number("start", start, "m") + spacing * np.arange(count + 1)
        rails = []
        for what, function in (("left", left), ("right", right)):
            if not callable(function):
                raise WheelsetError(f"{what} = {function!r}: give a function of the station [m]")
            y, z = function(distance)
            rails += [
                np.broadcast_to(np.asarray(one, dtype=float), distance.shape) for one in (y, z)
            ]
        return cls(distance, np.column_stack(rails), name)

    @classmethod
    @spelt
    def from_psd(
        cls,
        name: str | Mapping[str, Spectrum],
        seed: int,
        length: float = 2000.0,
        spacing: float = 0.25,
        wavelengths: Iterable[float] = (3.0, 70.0),
        fade_in: float = 50.0,
        start: float = 0.0,
        kinds: Iterable[str] = KINDS,
        scale: float = 1.0,
    ) -> Irregularity:
        """Irregularity with given spectra, random by its seed; one seed repeats to the bit.

        name: "ERRI B176 low", "ERRI B176 high", "FRA class 4" to "6" (track/spectra.py), or a
        Spectrum by kind; wavelengths [m]: limits of the band; fade_in [m]: over which it grows from
        nothing behind `start` [m]; kinds: those that are there; scale: of all shifts [-].
        """
        if not isinstance(name, str | Mapping):
            raise WheelsetError(
                f"name = {name!r}: give the name of a spectrum, such as 'ERRI B176 low', or a "
                f"mapping of {', '.join(KINDS)} to Spectrum"
            )
        chosen = spectra(name) if isinstance(name, str) else dict(name)
        label = name if isinstance(name, str) else "own spectra"
        shortest, longest = numbers("wavelengths (shortest, longest)", wavelengths, 2, "m", 0.0)
        length = positive("length", length, "m", 1e7)
        positive("spacing", spacing, "m", 10.0)
        start, scale = number("start", start, "m"), number("scale", scale, "-")
        if not 0.0 < shortest < longest:
            raise WheelsetError(
                f"wavelengths = ({shortest:g}, {longest:g}) m: give a shortest below a longest"
            )
        if shortest < 4.0 * spacing:
            raise WheelsetError(
                f"spacing = {spacing:g} m holds no waves of {shortest:g} m: give at most "
                f"{shortest / 4.0:g} m, or a shortest wavelength of {4.0 * spacing:g} m"
            )
        fade_in = number("fade_in", fade_in, "m", 0.0, length)
        if isinstance(seed, bool) or not isinstance(seed, int | np.integer):
            raise WheelsetError(f"seed = {seed!r}: give a whole number")
        count = _count(length, spacing)
        step = 2.0 * math.pi / (count * spacing)
        frequency = step * np.arange(count // 2 + 1)
        inside = (frequency >= 2 * math.pi / longest) & (frequency <= 2 * math.pi / shortest)
        wanted = [kinds] if isinstance(kinds, str) else list(kinds)
        for kind in wanted:
            if kind not in KINDS:
                raise unknown("kind", kind, KINDS)
        signals = []
        for k, kind in enumerate(KINDS):
            if kind not in chosen or kind not in wanted:
                signals.append(np.zeros(count + 1))
                continue
            # Each kind has phases of its own, whether the others are there or not.
            phases = np.random.default_rng([int(seed), k]).uniform(0.0, 2 * math.pi, len(frequency))
            waves = np.zeros(len(frequency), dtype=complex)
            size = np.sqrt(2.0 * chosen[kind].density(frequency[inside]) * step)
            waves[inside] = 0.5 * count * size * np.exp(1j * phases[inside])
            signal = scale * np.fft.irfft(waves, count)
            signals.append(np.append(signal, signal[0]))
        along = spacing * np.arange(count + 1)
        t = np.clip(along / fade_in, 0.0, 1.0) if fade_in > 0.0 else np.ones(count + 1)
        growth = t**3 * (10.0 - 15.0 * t + 6.0 * t * t)
        shifts = growth[:, None] * _of_rails(*signals)
        return cls(start + along, shifts, f"{label}, seed {seed}")

    @classmethod
    def load(cls, path: str | Path) -> Irregularity:
        """Read a CSV file: a line of names, then distances and kinds, in any order of columns.

        Names: distance, alignment, vertical, cross_level, gauge, each with [m] or [mm] behind it
        (metres where nothing is said). Raises WheelsetError with the file and the line.
        """
        try:
            with Path(path).open(encoding="utf-8-sig", newline="") as file:
                rows = [row for row in csv.reader(file) if row]
        except OSError as error:
            raise WheelsetError(f"{path} cannot be read: {error.strerror}") from error
        if not rows:
            raise WheelsetError(f"{path} is empty: give a line of names and rows of numbers")
        columns: dict[str, int] = {}
        factors: dict[str, float] = {}
        for k, title in enumerate(rows[0]):
            name = re.sub(r"[ -]+", "_", title.partition("[")[0].strip().lower())
            if name in ("distance", *KINDS):
                columns[name] = k
                factors[name] = 1e-3 if "[mm]" in title else 1.0
        if "distance" not in columns or len(columns) < 2:
            raise WheelsetError(
                f"{path}: its first line is {','.join(rows[0])!r}: name a column distance and at "
                f"least one of {', '.join(KINDS)}"
            )
        values: dict[str, list[float]] = {name: [] for name in columns}
        for line, row in enumerate(rows[1:], start=2):
            for name, k in columns.items():
                try:
                    values[name].append(factors[name] * float(row[k]))
                except (IndexError, ValueError):
                    raise WheelsetError(
                        f"{path}, line {line}: no number under {name}: fill it in or leave the "
                        "line out"
                    ) from None
        arrays: dict[str, Any] = {name: np.array(column) for name, column in values.items()}
        try:
            return cls.from_points(**arrays, name=Path(path).name)
        except WheelsetError as error:
            raise WheelsetError(f"{path}: {error}") from error

    def mirrored(self) -> Irregularity:
        """The irregularity with left and right exchanged."""
        left_y, left_z, right_y, right_z = self.shifts.T
        shifts = np.column_stack([-right_y, right_z, -left_y, left_z])
        return Irregularity(self.distance, shifts, self.name)

    @property
    def end(self) -> float:
        """Last distance [m]."""
        return float(self.distance[-1])

    @property
    def spacing(self) -> float:
        """Shortest distance [m] of two points."""
        return float(np.diff(self.distance).min())

    @cached_property
    def _spline(self) -> CubicSpline:
        return CubicSpline(self.distance, self.shifts)

    def shape(self, station: Array | float) -> tuple[Array, Array]:
        """Shifts (..., 4) [m] and slopes (..., 4) [-] of left y, z, right y, z at stations."""
        station = np.asarray(station, dtype=float)
        inside = np.clip(station, self.distance[0], self.distance[-1])
        slopes = np.where((station == inside)[..., None], self._spline(inside, 1), 0.0)
        return np.asarray(self._spline(inside)), slopes

    @cached_property
    def table(self) -> tuple[Array, Array]:
        """Distances (n,) and coefficients (n - 1, 4, 4): rail shift, power of s minus distance."""
        return self.distance, np.ascontiguousarray(self._spline.c[::-1].transpose(1, 2, 0))

    def _key(self) -> tuple[bytes, bytes, str]:
        return self.distance.tobytes(), self.shifts.tobytes(), self.name

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Irregularity) and self._key() == other._key()

    @cached_property
    def _hash(self) -> int:
        return hash(self._key())

    def __hash__(self) -> int:
        return self._hash

    def __reduce__(self) -> tuple[Any, ...]:
        return Irregularity, (self.distance, self.shifts, self.name)

    def __repr__(self) -> str:
        return (
            f"Irregularity({self.name!r}: {self.distance[0]:g} to {self.end:g} m, "
            f"{len(self.distance)} points)"
        )


def _of_rails(alignment: Any, vertical: Any, cross_level: Any, gauge: Any) -> Array:
    """Left y, z, right y, z (n, 4) of the four kinds."""
    return np.column_stack(
        [
            alignment + 0.5 * gauge,
            vertical + 0.5 * cross_level,
            alignment - 0.5 * gauge,
            vertical - 0.5 * cross_level,
        ]
    )


def _count(length: Any, spacing: Any) -> int:
    length = positive("length", length, "m", 1e7)
    spacing = positive("spacing", spacing, "m", length)
    # An even number, so that the waves come in pairs.
    return int(2 * max(1, math.ceil(0.5 * length / spacing - 1e-9)))


def _numbers_of(what: str, values: Any) -> Array:
    """The values as floats, not-a-number among them; WheelsetError for texts and other things."""
    try:
        return np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise WheelsetError(f"irregularity: {what} = {values!r:.80}: give numbers in m") from None


def _check_distance(distance: Array) -> None:
    if distance.ndim != 1 or len(distance) < 2:
        raise WheelsetError("irregularity: give two distances [m] or more")
    finite = np.isfinite(distance)
    if not finite.all():
        raise WheelsetError(
            f"irregularity: the distance of row {int(np.argmin(finite))} is missing: fill it in or "
            "leave the row out"
        )
    falling = np.diff(distance) <= 0.0
    if falling.any():
        row = int(np.argmax(falling))
        raise WheelsetError(
            f"irregularity: distance {distance[row + 1]:g} m follows {distance[row]:g} m in row "
            f"{row + 1}: distances must rise; sort the rows, or leave one out"
        )
