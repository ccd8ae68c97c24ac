"""A branch of limit cycles as data: arrays over the points, marked speeds, file and plot.

The record kept with it (system, parameters, versions, method, settings, cost) and the orbits
themselves go into the file, so that a diagram can be drawn again, and a branch continued, from
the file alone. Speeds in m/s, periods in s, amplitudes are half of peak to peak in m or rad.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from scipy.optimize import brentq

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.results.columns import NamedColumns
from exudyn_wheelset.results.endings import Outcome
from exudyn_wheelset.results.records import read_record, write_record
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.stability.hunting.branch_plot import draw_branch
from exudyn_wheelset.stability.hunting.orbit import Orbit
from exudyn_wheelset.systems.source import Source

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from exudyn_wheelset.stability.gradients import Gradient
    from exudyn_wheelset.stability.hunting.fold_sensitivity import FoldSensitivity

KIND = "branch of limit cycles"


@brief
@dataclass(frozen=True, eq=False)
class Fold(float):
    """A speed at which a branch of limit cycles turns back; a float, the speed itself [m/s].

    amplitude   half of peak to peak by displacement name [m or rad]
    period      [s]
    index       of the point in the branch
    side        "lowest" (no cycle of the branch just below this speed) or "highest" (none above)
    orbit       the motion there, whole; source: the description of the vehicle, if it is known
    sensitivity of the speed to changes of the equations, where it was computed with the branch
    """

    speed: float
    amplitude: dict[str, float]
    period: float
    index: int
    side: Literal["lowest", "highest"]
    orbit: Orbit | None = field(default=None, repr=False)
    source: Source | None = field(default=None, repr=False)
    sensitivity: FoldSensitivity | None = field(default=None, repr=False)

    def __new__(cls, speed: float, *_: Any, **__: Any) -> Fold:
        return super().__new__(cls, speed)

    def gradient(self, names: Sequence[str] | None = None, vehicle: Any = None) -> Gradient:
        """Derivative of the fold's speed by the numbers of the vehicle: name -> (m/s)/unit.

        names: some of them, None for all; vehicle: the description, where the analysis was given
        a system. Raises AnalysisError where orbit or description are not known.
        """
        from exudyn_wheelset.stability.gradients import fold_gradient, source_of

        if self.orbit is None:
            raise AnalysisError("this fold was found without an orbit: follow the branch anew")
        description = source_of(self.source, vehicle)
        return fold_gradient(description, self.orbit, self.side, names, self.sensitivity)


@brief
@dataclass(frozen=True, eq=False)
class StabilityChange(float):
    """A speed between folds at which stability changes; a float, the speed itself [m/s].

    kind   "branch point" (a real multiplier passes +1: symmetry is lost or another branch
           crosses), "period doubling" (-1) or "torus" (a complex pair: modulated hunting)
    index  of the point of the branch after the change
    """

    speed: float
    kind: Literal["branch point", "period doubling", "torus"]
    index: int

    def __new__(cls, speed: float, *_: Any, **__: Any) -> StabilityChange:
        return super().__new__(cls, speed)


@spelt_class
@brief
@dataclass(frozen=True, eq=False)
class Branch:
    """Limit cycles in the order in which they lie on their branch.

    speed           (points,) [m/s]
    period          (points,) [s]
    amplitude       (points, displacements) half of peak to peak [m or rad]; columns also by name
    stable          (points,) whether the cycle is stable, for certain
    uncertain       (points,) where neither stable nor unstable is certain: a multiplier is nearer
                    to the unit circle than the trivial one to 1
    multipliers     (points, k) Floquet multipliers by falling size, the trivial one left out and
                    those of free motion along the track
    trivial_error   (points,) distance of the trivial multiplier from 1: an accuracy check; where
                    simulated motion contradicts the multipliers, their distance from it
    folds           where the branch turns back, in the order of the points
    changes         other changes of stability
    hopf            (speed [m/s], frequency [Hz]) of the Hopf point it starts from, or None
    outcome         how the branch ends at its last point
    first_outcome   how it ends at its first one, with a start inside it; else None
    method          "continuation"
    orbits          the motions themselves
    record          system, parameters, versions, settings, cost

    Examples
    --------
    >>> from exudyn_wheelset import hopf_points, limit_cycles
    >>> (hopf, *_) = hopf_points("cooperrider", 60, 75)
    >>> branch = limit_cycles("cooperrider", hopf, (60, 75))
    >>> [round(float(fold), 1) for fold in branch.folds[:1]]
    [66.7]
    """

    speed: Array
    period: Array
    amplitude: NamedColumns
    stable: Array
    uncertain: Array
    multipliers: Array
    trivial_error: Array
    folds: list[Fold]
    changes: list[StabilityChange]
    hopf: tuple[float, float] | None
    outcome: Outcome
    orbits: list[Orbit]
    first_outcome: Outcome | None = None
    method: str = "continuation"
    record: dict[str, Any] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.speed)

    @property
    def reason(self) -> str:
        """Why the branch ends, in words; with a start inside it, both ends."""
        if self.first_outcome is None:
            return str(self.outcome)
        return f"first point: {self.first_outcome}; last point: {self.outcome}"

    @property
    def stability(self) -> list[bool | None]:
        """Whether each cycle is stable: True, False, or None where it is uncertain."""
        return [
            None if doubt else bool(steady)
            for steady, doubt in zip(self.stable, self.uncertain, strict=True)
        ]

    def orbit(self, index: int) -> Orbit:
        """The motion at a point of the branch."""
        return self.orbits[index]

    @property
    def states(self) -> Array:
        """First state (points, n) of each orbit: initial values that lie on it."""
        return np.array([orbit.states[0] for orbit in self.orbits])

    def amplitudes_at(self, speed: float, name: str, stable: bool | None = None) -> Array:
        """Amplitudes [m or rad] of a displacement where the branch passes a speed [m/s].

        Speed and amplitude are interpolated by cubics over the chord length along the branch,
        which is smooth at a fold too. `stable` keeps one kind of them. Empty if the branch does
        not pass the speed.
        """
        column = self.amplitude[name]
        steps = np.hypot(
            np.diff(self.speed) / max(np.ptp(self.speed), 1e-300),
            np.diff(column) / max(np.ptp(column), 1e-300),
        )
        along = np.append(0.0, np.cumsum(np.maximum(steps, 1e-12)))
        found: list[float] = []
        for index in range(len(self) - 1):
            before, after = self.speed[index : index + 2] - speed
            if before * after > 0.0 or (before == 0.0 and index > 0):
                continue
            if stable is not None and stable != self.stable_after(index):
                continue
            if before == 0.0 or after == 0.0:
                found.append(float(column[index if before == 0.0 else index + 1]))
                continue
            first = max(0, min(index - 1, len(self) - 4))
            near = slice(first, first + 4)
            where = brentq(
                lambda s, near=near: _lagrange(along[near], self.speed[near] - speed, s),
                along[index],
                along[index + 1],
            )
            found.append(_lagrange(along[near], column[near], where))
        return np.array(found)

    def _stable_beside(self, index: int) -> bool:
        """Whether the orbits on either side of a fold are stable, or the next that are certain.

        Near a fold a multiplier is near 1: what its error hides there, orbits further on tell, up
        to the next fold.
        """
        ends = {fold.index for fold in self.folds}
        found = bool(self.stable[index])
        for way in (-1, 1):
            k = index + way
            while 0 <= k < len(self) and self.uncertain[k] and k not in ends:
                k += way
            found |= 0 <= k < len(self) and bool(self.stable[k])
        return found

    def lowest_stable(self, large: Array | None = None) -> tuple[float, str]:
        """Lowest speed [m/s] at which a cycle of the branch is stable, and what bounds it there.

        large: (points,) which cycles count; those count too that are stable from the Hopf point on.
        Raises AnalysisError if no cycle of the branch is stable.
        """
        counts = np.ones(len(self), dtype=bool) if large is None else np.array(large, dtype=bool)
        if self.hopf is not None and self.stable[0] and self.speed[0] > self.hopf[0] * (1 - 2e-3):
            first_unstable = np.flatnonzero(~self.stable)
            counts[: first_unstable[0] if len(first_unstable) else len(self)] = True
        if not np.any(self.stable & counts):
            raise AnalysisError(f"no limit cycle of the branch is stable; {self.reason}")
        candidates = [(float(self.speed[i]), i) for i in np.flatnonzero(self.stable & counts)]
        speed, index = min(candidates)
        what = "the end of the branch" if index in (0, len(self) - 1) else "a point of the branch"
        if index == 0 and self.hopf is not None:
            if speed > self.hopf[0] * (1.0 - 2e-3) - 1e-9:
                speed, what = min(speed, self.hopf[0]), "the Hopf point, which is supercritical"
            else:
                what = "the first orbit of the branch, below the Hopf point it starts from"
        for fold in self.folds:
            counted = fold.side == "lowest" and counts[fold.index]
            if counted and self._stable_beside(fold.index) and fold <= speed:
                speed, what = float(fold), "the fold of the limit cycle"
        for change in self.changes:
            # Between unstable orbits a further multiplier that leaves the circle bounds nothing.
            beside = bool(np.any(self.stable[max(0, change.index - 1) : change.index + 1]))
            if change < speed and beside and counts[change.index]:
                speed, what = float(change), f"a {change.kind} of the limit cycle"
        return speed, what

    def save(self, path: str | Path) -> Path:
        """Write the branch with its record to one .npz file, atomically; returns the path."""
        record = {
            **self.record,
            "kind": KIND,
            "method": self.method,
            "outcomes": [
                None if outcome is None else outcome.record()
                for outcome in (self.first_outcome, self.outcome)
            ],
            "displacements": list(self.amplitude.names),
            "hopf": self.hopf,
            "folds": [
                [fold.speed, fold.amplitude, fold.period, fold.index, fold.side]
                for fold in self.folds
            ],
            "changes": [[change.speed, change.kind, change.index] for change in self.changes],
        }
        arrays = {name: np.asarray(getattr(self, name)) for name in _ARRAYS}
        arrays["intervals"] = np.array([len(orbit.mesh) - 1 for orbit in self.orbits])
        arrays["meshes"] = np.concatenate([orbit.mesh for orbit in self.orbits])
        arrays["motions"] = np.concatenate([orbit.states for orbit in self.orbits])
        return write_record(path, arrays, record)

    @classmethod
    def load(cls, path: str | Path) -> Branch:
        """The branch of a file; raises AnalysisError if it does not hold one."""
        arrays, record = read_record(path, KIND)
        fields: dict[str, Any] = {name: arrays[name] for name in _ARRAYS}
        fields["amplitude"] = NamedColumns(fields["amplitude"], record["displacements"])
        meshes = np.split(arrays["meshes"], np.cumsum(arrays["intervals"] + 1)[:-1])
        degree = (len(arrays["motions"]) - len(meshes)) // int(np.sum(arrays["intervals"]))
        ends = np.cumsum(arrays["intervals"] * degree + 1)[:-1]
        motions = np.split(arrays["motions"], ends)
        each = zip(meshes, motions, fields["period"], fields["speed"], strict=True)
        orbits = [Orbit(m, x, float(period), float(v)) for m, x, period, v in each]
        return cls(
            **fields,
            orbits=orbits,
            folds=[replace(Fold(*entry), orbit=orbits[entry[3]]) for entry in record["folds"]],
            changes=[StabilityChange(*entry) for entry in record["changes"]],
            hopf=tuple(record["hopf"]) if record["hopf"] else None,
            outcome=Outcome.read(record["outcomes"][1]),
            first_outcome=Outcome.read(record["outcomes"][0]) if record["outcomes"][0] else None,
            method=record["method"],
            record=record,
        )

    def plot(
        self,
        ax: Axes | None = None,
        name: str | None = None,
        factor: float = 1.0,
        colour: str = "C0",
        label: str | None = None,
    ) -> Axes:
        """Draw amplitude over speed: stable solid, unstable dashed, of uncertain stability
        dash-dotted, Hopf point and folds marked.

        `name` is the displacement (default the first), `factor` turns its unit into the plotted
        one (1e3 for mm). Returns the axes.
        """
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.subplots()[1]
        name = name or self.amplitude.names[0]
        draw_branch(ax, self, name, factor, colour, label)
        if self.uncertain.any():
            ax.legend(fontsize=8)
        ax.set_xlabel("forward speed [m/s]")
        ax.set_ylabel(f"half of peak to peak: {name}" + (f" x {factor:g}" if factor != 1 else ""))
        return ax

    def stable_after(self, index: int) -> bool:
        """Whether the piece from a point to the next is stable; a fold goes with its neighbour."""
        folds = {fold.index for fold in self.folds}
        if index in folds:
            return bool(self.stable[index + 1])
        if index + 1 in folds:
            return bool(self.stable[index])
        return bool(self.stable[index] and self.stable[index + 1])

    def stability_after(self, index: int) -> bool | None:
        """As `stable_after`; None where a point of the piece is of uncertain stability."""
        folds = {fold.index for fold in self.folds}
        ends = [k for k in (index, index + 1) if k not in folds]
        if any(self.uncertain[k] for k in ends):
            return None
        return self.stable_after(index)


_ARRAYS = (
    "speed",
    "period",
    "amplitude",
    "stable",
    "uncertain",
    "multipliers",
    "trivial_error",
)


def _lagrange(nodes: Array, values: Array, where: float) -> float:
    total = 0.0
    for i, node in enumerate(nodes):
        others = np.delete(nodes, i)
        total += values[i] * np.prod((where - others) / (node - others))
    return float(total)
