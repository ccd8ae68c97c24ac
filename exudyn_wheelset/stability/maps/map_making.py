"""Where the curves of a stability map begin, and following them.

Hopf points and folds of diagrams at a few values of the number; each that lies on no curve yet
begins one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.results.columns import NamedColumns
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.branch import Fold
from exudyn_wheelset.stability.hunting.continuation_settings import ContinuationSettings
from exudyn_wheelset.stability.hunting.fold_points import fold_near, prepared
from exudyn_wheelset.stability.hunting.large_starts import hunting_at
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.simulated_stability import SHORT
from exudyn_wheelset.stability.hunting.watching import watched_index
from exudyn_wheelset.stability.linear.crossings import CriticalPoint, hopf_points
from exudyn_wheelset.stability.linear.modes import is_lateral
from exudyn_wheelset.stability.maps.curves import Curve
from exudyn_wheelset.stability.maps.fold_curves import FoldPlace, FoldWorld
from exudyn_wheelset.stability.maps.hopf_curves import HopfPlace, HopfWorld
from exudyn_wheelset.stability.maps.tracing import Family, Tracer
from exudyn_wheelset.stability.subject import as_system, changed, description_of
from exudyn_wheelset.systems.system import DynamicSystem

# Speeds looked at by default, in Hopf speeds.
RANGE = (0.4, 1.3)
# A diagram may rise to this multiple of its Hopf point's speed before it turns back to the flange:
# that of the S1002 wheelset at a friction of 0.5 rises to 1.30.
REACH = 1.4
# A fold or Hopf point lies on a curve if it is this near to it, relative to its speed; folds of
# S1002 wheelsets come as near as 1e-3 to each other, but at other amplitudes.
SAME_SPEED, SAME_AMPLITUDE = 2e-3, 0.05
# How a branch ends that was followed as far as asked for.
WHOLE = (Ending.UPPER_END, Ending.LOWER_END, Ending.CLOSED)
# Hunting that no branch has reached is looked for at this multiple of the Hopf point's speed.
BESIDE = 1.05


class MapMaker:
    """Curves of a vehicle over a number of it, with remarks on what could not be followed."""

    def __init__(
        self, vehicle: Any, parameter: str, limits: tuple[float, float], progress: bool
    ) -> None:
        function = callable(vehicle) and not hasattr(vehicle, "dynamic_system")
        description = vehicle if function else description_of(vehicle)
        self.family = Family(lambda value: as_system(changed(description, parameter, value)))
        self.limits = limits
        self.remarks: list[str] = []
        self.speeds = (0.0, np.inf)

    def hopf_starts(
        self, values: list[float], speeds: tuple[float, float] | None
    ) -> list[tuple[float, list[CriticalPoint]]]:
        """Hopf points of lateral modes at each start and at both ends of the range."""
        from exudyn_wheelset.stability.hunting.nonlinear import SEARCH

        found = []
        # The ends of the range tell the speeds to look at, starts or not.
        for value in sorted({*values, *self.limits}):
            system = self.family(value)
            points: list[CriticalPoint] = []
            for range_ in SEARCH if speeds is None else (speeds,):
                try:
                    points = [p for p in hopf_points(system, *range_) if self._lateral(value, p)]
                except WheelsetError as error:
                    self.remarks.append(f"{value:g}: {error}")
                if any(point.direction == "loses stability" for point in points):
                    break
            if points:
                found.append((value, points))
            else:
                self.remarks.append(f"no Hopf point at {value:g}")
        if not found:
            raise AnalysisError(f"no Hopf point at any start: {'; '.join(self.remarks)}")
        if speeds is None:
            lowest = [min(points).speed for _, points in found]
            speeds = (RANGE[0] * min(lowest), RANGE[1] * max(lowest))
            # Other pairs that cross in the range as well.
            found = [
                (
                    value,
                    [
                        p
                        for p in hopf_points(self.family(value), *speeds)
                        if self._lateral(value, p)
                    ],
                )
                for value, _ in found
            ]
        self.speeds = float(speeds[0]), float(speeds[1])
        return found

    def _lateral(self, value: float, point: CriticalPoint) -> bool:
        return is_lateral(self.family(value), point.mode)

    def hopf_curves(
        self,
        found: list[tuple[float, list[CriticalPoint]]],
        points: int,
        most: int,
        bar: Any,
    ) -> list[Curve]:
        """Curves through all Hopf points."""
        world = HopfWorld(self.family, self.limits, self.speeds)
        curves: list[Curve] = []
        for value, starts in found:
            for start in starts:
                if not self.speeds[0] <= start.speed <= self.speeds[1]:
                    continue
                if _on_a_curve(curves, value, start.speed):
                    continue
                try:
                    tracer = Tracer(world, world.begin(start, value), 1.0 / points, bar.update)
                    places, ends = tracer.both_ways(most)
                except WheelsetError as error:
                    self.remarks.append(f"Hopf point at {value:g}, {start.speed:.4f} m/s: {error}")
                    continue
                curves.append(self._hopf_curve(world, places, ends))
        return curves

    def _hopf_curve(
        self, world: HopfWorld, places: list[HopfPlace], ends: tuple[str, str]
    ) -> Curve:
        system = self.family(places[0].parameter)
        names = [system.state_names[index] for index in system.displacement_indices]
        step = np.array([1e-5, 0.0])
        loses = np.array([world.reach(p, step).value > p.value for p in places])
        return Curve(
            "hopf",
            np.array([place.speed for place in places]),
            np.array([place.parameter for place in places]),
            np.array([place.eigenvalue.imag / (2.0 * np.pi) for place in places]),
            np.zeros(len(places)),
            NamedColumns(np.zeros((len(places), len(names))), names),
            loses,
            ends,
        )

    def fold_curves(
        self,
        found: list[tuple[float, list[CriticalPoint]]],
        points: int,
        most: int,
        intervals: int | None,
        settings: ContinuationSettings | None,
        bar: Any,
        branches: int,
    ) -> list[Curve]:
        """Curves through the folds of all diagrams."""
        world = FoldWorld(self.family, self.limits, self.speeds)
        curves: list[Curve] = []
        for value, starts in found:
            system = self.family(value)
            for fold in self._folds(system, starts, settings, branches):
                if not self.speeds[0] <= fold.speed <= self.speeds[1] or fold.orbit is None:
                    continue
                watched = system.state_names[watched_index(system)]
                if _on_a_curve(curves, value, fold.speed, fold.amplitude[watched]):
                    continue
                try:
                    orbit = prepared(system, fold.orbit, intervals, self._ends())
                    point = fold_near(system, orbit, fold.side, 1e-4)
                    place = FoldPlace(point, value, point.size)
                    amplitude = point.orbit.half_peak_to_peak()[watched_index(system)]
                    if _on_a_curve(curves, value, place.speed, float(amplitude)):
                        continue
                    tracer = Tracer(world, place, 1.0 / points, bar.update)
                    places, ends = tracer.both_ways(most)
                except WheelsetError as error:
                    self.remarks.append(f"fold at {value:g}, {fold.speed:.4f} m/s: {error}")
                    continue
                curves.append(self._fold_curve(places, ends))
        return curves

    def _ends(self) -> tuple[DynamicSystem, DynamicSystem]:
        return self.family(self.limits[0]), self.family(self.limits[1])

    def _folds(
        self,
        system: DynamicSystem,
        starts: list[CriticalPoint],
        settings: ContinuationSettings | None,
        branches: int,
    ) -> list[Fold]:
        """Folds of the branches from the first Hopf points of one vehicle."""
        folds: list[Fold] = []
        for start in [s for s in sorted(starts) if s.direction == "loses stability"][:branches]:
            speeds = (
                max(self.speeds[0], RANGE[0] * start.speed),
                min(self.speeds[1], REACH * start.speed),
            )
            if not speeds[0] < start.speed < speeds[1]:
                continue
            try:
                branch = limit_cycles(system, start, speeds, settings=settings)
                folds += branch.folds
                if branch.outcome.ending not in WHOLE:
                    folds += self._folds_of_hunting(system, start.speed, speeds, settings)
            except WheelsetError as error:
                self.remarks.append(f"branch at {start.speed:.4f} m/s: {error}")
        return folds

    def _folds_of_hunting(
        self,
        system: DynamicSystem,
        hopf: float,
        speeds: tuple[float, float],
        settings: ContinuationSettings | None,
    ) -> list[Fold]:
        """Folds of the branch through a motion that hunts beside a Hopf point [m/s].

        A branch from the Hopf point that is lost between tread and flange does not tell of what
        lies on the flange; a large disturbance does.
        """
        from exudyn_wheelset.stability.hunting.nonlinear import SMALLEST

        speed = min(BESIDE * hopf, speeds[1])
        hunting = hunting_at(system, speed, SHORT, SMALLEST)
        if hunting is None:
            return []
        branch = limit_cycles(
            system, hunting[1].state, speeds, start_speed=speed, settings=settings
        )
        return branch.folds

    def _fold_curve(self, places: list[FoldPlace], ends: tuple[str, str]) -> Curve:
        system = self.family(places[0].parameter)
        indices = list(system.displacement_indices)
        names = [system.state_names[index] for index in indices]
        amplitudes = np.array([p.point.orbit.half_peak_to_peak()[indices] for p in places])
        table = NamedColumns(amplitudes, names)
        return Curve(
            "fold",
            np.array([place.speed for place in places]),
            np.array([place.parameter for place in places]),
            np.array([1.0 / place.point.orbit.period for place in places]),
            amplitudes[:, indices.index(watched_index(system))],
            table,
            np.array([place.one_side_stable for place in places]),
            ends,
        )


def _on_a_curve(
    curves: list[Curve], parameter: float, speed: float, amplitude: float | None = None
) -> bool:
    """Whether a point lies on a curve already."""
    for curve in curves:
        for known, row in curve.crossings(parameter):
            if abs(known - speed) > SAME_SPEED * speed:
                continue
            if amplitude is None:
                return True
            beside: Array = curve.amplitude[row : row + 2]
            near = np.abs(beside - amplitude).min() < SAME_AMPLITUDE * amplitude
            if near or beside.min() <= amplitude <= beside.max():
                return True
    return False
