"""The result of a quasi-static descent: hunting over falling speed, and where it stops."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.results.columns import NamedColumns
from exudyn_wheelset.results.endings import Outcome
from exudyn_wheelset.results.records import read_record, write_record

KIND = "quasi-static descent"


@brief
@dataclass(frozen=True, eq=False)
class Descent:
    """Stable hunting motion over falling speed, down to the jump.

    speeds      (k,) speeds that hunted, in the order they were run [m/s]
    amplitude   (k, displacements) half of peak to peak [m or rad]; columns also by name
    trucks      (k, trucks) mean amplitude of the watched displacement of each truck; by name
    period      (k,) [s]
    settled     (k,) whether the peaks settled; if not, the run was ended after all its cycles
    states      (k, n) last state at each speed
    stops       bracket [m/s] by truck: highest speed at which its hunting had died out, lowest at
                which it hunted; only trucks that stopped
    jumped      highest speed at which all hunting died out [m/s]; nan while it has not
    time        simulated in total [s]
    outcome     how it ended; `reason` says it in words
    method      "descent"
    record      system, parameters, versions, settings
    """

    speeds: Array
    amplitude: NamedColumns
    trucks: NamedColumns
    period: Array
    settled: Array
    states: Array
    stops: dict[str, tuple[float, float]]
    jumped: float
    time: float
    outcome: Outcome
    method: str = "descent"
    record: dict[str, Any] = field(default_factory=dict)

    @property
    def reason(self) -> str:
        """Why it ended, in words."""
        return str(self.outcome)

    @property
    def bracket(self) -> tuple[float, float]:
        """Speeds [m/s] below and above the jump: the highest that died, the lowest that hunted."""
        return self.jumped, float(np.min(self.speeds))

    @property
    def by_truck(self) -> dict[str, float]:
        """Speed [m/s] at which each truck stops hunting, the middle of its bracket."""
        return {name: 0.5 * sum(bracket) for name, bracket in self.stops.items()}

    @property
    def speed(self) -> float:
        """Speed of the jump [m/s], the middle of the bracket; nan if it was not reached."""
        return 0.5 * sum(self.bracket)

    def save(self, path: str | Path) -> Path:
        """Write to one .npz file, atomically; returns the path."""
        record = {
            **self.record,
            "kind": KIND,
            "method": self.method,
            "outcome": self.outcome.record(),
            "jumped": None if np.isnan(self.jumped) else self.jumped,
            "time": self.time,
            "displacements": list(self.amplitude.names),
            "trucks": list(self.trucks.names),
            "stops": self.stops,
        }
        arrays = {name: np.asarray(getattr(self, name)) for name in _ARRAYS}
        return write_record(path, arrays, record)

    @classmethod
    def load(cls, path: str | Path) -> Descent:
        """The descent of a file; raises AnalysisError if it does not hold one."""
        arrays, record = read_record(path, KIND)
        fields: dict[str, Any] = {name: arrays[name] for name in _ARRAYS}
        fields["amplitude"] = NamedColumns(fields["amplitude"], record["displacements"])
        fields["trucks"] = NamedColumns(fields["trucks"], record["trucks"])
        jumped = record["jumped"]
        return cls(
            **fields,
            jumped=np.nan if jumped is None else float(jumped),
            stops={name: tuple(bracket) for name, bracket in record["stops"].items()},
            time=record["time"],
            outcome=Outcome.read(record["outcome"]),
            record=record,
        )

    def plot(self, ax: Any, name: str | None = None, factor: float = 1.0, **style: Any) -> Any:
        """Draw the amplitudes as points and the jump as a thin line; returns the axes."""
        values = factor * self.amplitude[name or self.amplitude.names[0]]
        style = {"marker": "v", "linestyle": "none", "markersize": 4, "label": "descent", **style}
        ax.plot(self.speeds, values, **style)
        if not np.isnan(self.jumped):
            ax.axvline(self.speed, color="0.6", linewidth=0.8)
        return ax


_ARRAYS = ("speeds", "amplitude", "trucks", "period", "settled", "states")
