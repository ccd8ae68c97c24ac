"""Stability map: Hopf and fold curves of a vehicle over speed and one of its numbers.

    map = stability_map("cooperrider", "speed", "conicity", (0.02, 0.2))
    map.hopf[0].speed, map.folds[0].speed, map.regions.at(66.0, 0.05)

At a few values of the number, the `starts`, a diagram is made (Hopf points, the branch of limit
cycles from the first of them, its folds); Hopf points are looked for at both ends too. Each Hopf
point and each fold that lies on no curve yet begins one, which is followed both ways to the ends of
the range, through cusps and into Bautin points. A fold curve that begins and ends between those
values without passing one is not found: give more `starts`.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from tqdm import tqdm

from exudyn_wheelset.checking import numbers, whole
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.results.records import describe
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.hunting.continuation_settings import ContinuationSettings
from exudyn_wheelset.stability.maps.curves import Curve, Regions, regions_of
from exudyn_wheelset.stability.maps.fold_curves import BAUTIN
from exudyn_wheelset.stability.maps.map_making import MapMaker
from exudyn_wheelset.stability.numbers import unit_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@brief
@dataclass(frozen=True, eq=False)
class StabilityMap:
    """Curves in speed and a number of the vehicle.

    parameter   name of the number; limits: its range; unit as text
    hopf        curves of Hopf points
    folds       curves of folds of limit cycles
    speeds      range of speeds [m/s]
    remarks     what could not be followed, and why
    record      system, versions, settings, cost
    """

    parameter: str
    unit: str
    limits: tuple[float, float]
    speeds: tuple[float, float]
    hopf: list[Curve]
    folds: list[Curve]
    remarks: tuple[str, ...] = ()
    record: dict[str, Any] = field(default_factory=dict)

    @property
    def regions(self) -> Regions:
        """Where the vehicle always runs straight, hunts if disturbed, and hunts."""
        return regions_of(self.hopf, self.folds, self.limits, self.speeds)

    @property
    def bautin_points(self) -> list[tuple[float, float]]:
        """(speed [m/s], parameter) at which Hopf points turn from sub- to supercritical: where the
        squared amplitude of a fold, extrapolated from its last points, is zero."""
        found = []
        for curve in self.folds:
            for end, rows in zip(curve.ends, ([0, 1], [-1, -2]), strict=True):
                if end == BAUTIN:
                    last, before = curve.amplitude[rows] ** 2
                    share = last / (before - last)
                    values = (curve.speed[rows], curve.parameter[rows])
                    speed, parameter = (float(v[0] + share * (v[0] - v[1])) for v in values)
                    found.append((speed, parameter))
        return found

    def to_xarray(self) -> Any:
        """All points of all curves as an xarray Dataset over `point`, with kind and number of the
        curve beside each."""
        import xarray

        curves = [*self.hopf, *self.folds]
        columns: dict[str, Any] = {
            name: np.concatenate([getattr(curve, name) for curve in curves])
            for name in ("speed", "parameter", "frequency", "amplitude", "loses")
        }
        columns["kind"] = np.concatenate([np.full(len(c), c.kind) for c in curves])
        columns["curve"] = np.concatenate([np.full(len(c), k) for k, c in enumerate(curves)])
        data = xarray.Dataset({name: (("point",), values) for name, values in columns.items()})
        data["speed"].attrs["units"] = "m/s"
        data["parameter"].attrs.update(units=self.unit, long_name=self.parameter)
        data["frequency"].attrs["units"] = "Hz"
        data.attrs.update({name: str(value) for name, value in self.record.items()})
        return data

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw speed over the parameter: regions shaded, Hopf curves solid, fold curves dashed
        (dotted where cycles are unstable on both sides), cusps and Bautin points marked."""
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.subplots()[1]
        for (name, polygon), colour in zip(
            self.regions.items(), ("#e8f4e8", "#fff3d6", "#fbe3e1"), strict=True
        ):
            ax.fill(*polygon.T, color=colour, zorder=0, label=name)
        for number, curve in enumerate(self.hopf):
            label = "Hopf points" if number == 0 else None
            ax.plot(curve.parameter, curve.speed, "-", color="C3", label=label)
        for number, curve in enumerate(self.folds):
            label = "folds of limit cycles" if number == 0 else None
            style = "--" if curve.loses.any() else ":"
            ax.plot(curve.parameter, curve.speed, style, color="C0", label=label)
            rows = curve.cusps
            ax.plot(curve.parameter[rows], curve.speed[rows], "v", color="C0", ms=5)
        for speed, parameter in self.bautin_points:
            ax.plot(parameter, speed, "D", color="k", ms=5)
        ax.set_xlim(*self.limits)
        shown = np.concatenate([curve.speed for curve in [*self.hopf, *self.folds]])
        margin = 0.1 * float(np.ptp(shown)) + 0.01 * float(shown.max())
        ax.set_ylim(shown.min() - margin, shown.max() + margin)
        unit = "" if self.unit in ("", "-") else f" [{self.unit}]"
        ax.set_xlabel(f"{self.parameter.replace('_', ' ')}{unit}")
        ax.set_ylabel("forward speed [m/s]")
        ax.legend(fontsize=8)
        return ax


@spelt
def stability_map(
    vehicle: Any,
    first: str,
    parameter: str,
    limits: tuple[float, float],
    *,
    speeds: tuple[float, float] | None = None,
    points: int = 40,
    starts: int = 3,
    most: int = 400,
    folds: bool = True,
    branches: int = 1,
    intervals: int | None = None,
    settings: ContinuationSettings | None = None,
    progress: bool = False,
) -> StabilityMap:
    """Hopf and fold curves of a vehicle over speed and a number of it, within `limits`.

    vehicle    a description, a name of the catalogue, or a function of the parameter's value that
               gives a vehicle or a system
    first      "speed"
    parameter  path of `Vehicle.replace`, name of a number, or a short one: friction, gauge,
               conicity, inclination, shear_modulus
    speeds     range [m/s]; default 0.4 times the lowest to 1.3 times the highest first Hopf point
    points     of a curve over the range, at least; most: of a curve that turns to and fro
    starts     values of the parameter at which diagrams are made
    folds      False leaves limit cycles out
    branches   Hopf points of a diagram whose limit cycles are followed, the lowest ones first: a
               car has one a truck
    intervals  of the orbits' mesh; default that of the diagrams, 90 on elastic contact
    settings   of the diagrams

    Raises AnalysisError where there is no Hopf point at any of the starts.

    Examples
    --------
    >>> from exudyn_wheelset import stability_map
    >>> found = stability_map(
    ...     "cooperrider", "speed", "conicity", (0.04, 0.06), points=3, starts=1, folds=False
    ... )
    >>> [round(float(speed)) for speed in sorted(found.hopf[0].speed[[0, -1]])]
    [62, 78]
    """
    if first != "speed":
        raise AnalysisError(f"{first!r}: the first parameter of a map is 'speed'")
    low, high = numbers("limits (low, high)", limits, 2, "unit of the parameter")
    whole("points", points, 2)
    whole("starts", starts, 1)
    whole("most", most, points)
    whole("branches", branches, 1)
    if not low < high:
        raise AnalysisError(f"limits = ({low:g}, {high:g}): give (low, high) with low below high")
    begun = time.perf_counter()
    made = MapMaker(vehicle, parameter, (low, high), progress)
    values = [0.5 * (low + high)] if starts == 1 else np.linspace(low, high, starts).tolist()
    with tqdm(disable=not progress, unit="point", desc="stability map") as bar:
        found = made.hopf_starts(values, speeds)
        hopf = made.hopf_curves(found, points, most, bar)
        remarks = made.remarks
        fold_curves: list[Curve] = []
        if folds:
            begun_at = [(value, points_) for value, points_ in found if value in values]
            fold_curves = made.fold_curves(
                begun_at, points, most, intervals, settings, bar, branches
            )
    record = describe(
        made.family(values[len(values) // 2]),
        "stability map",
        {"parameter": parameter, "limits": [low, high], "points": points, "starts": values},
    )
    record["cost"] = {"seconds": time.perf_counter() - begun}
    return StabilityMap(
        parameter,
        unit_of(parameter),
        (low, high),
        made.speeds,
        hopf,
        fold_curves,
        tuple(remarks),
        record,
    )
