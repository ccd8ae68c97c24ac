"""A coach on rough straight track at 60 and 160 km/h: shifts, forces, comfort.

Run `python models/rough_track.py`. It prints root mean squares and comfort, and keeps under
runs/out/ (or --out)

    rough_track.png     the rails; shifts and wheel loads over the distance
    rough_track_<speed>.csv  the motions, as pandas reads them
    rough_track.json    the numbers, with the vehicle and all versions

`--json` prints the numbers only, for each speed [km/h]:

    y_mm, yaw_mrad   root mean squares of the leading wheelset
    Q_kN             standard deviation below 20 Hz, largest of all wheels
    sum_of_y_kN      largest 2 m mean of all wheelsets; limit_kN
    percentiles_kN   0.15, 50 and 99.85 % of the leading wheelset's sum of Y below 20 Hz
    N_MV, Wz         mean comfort in the middle of the body, Sperling's index lateral and vertical
    outcome
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset import Motion, simulate
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import finished, run_script, script_parser
from exudyn_wheelset.front.vehicle_options import (
    add_vehicle_options,
    chosen_changes,
    named_vehicle,
)
from exudyn_wheelset.results.comfort import mean_comfort, sperling
from exudyn_wheelset.results.en14363 import PERCENTILES, low_pass
from exudyn_wheelset.results.running_safety import sum_of_y_limit
from exudyn_wheelset.track.irregularity import Irregularity

SPEEDS = (60.0, 160.0)  # [km/h]
BODY = "body"


def run(
    *, vehicle: str = "manchester_coach", spectrum: str = "ERRI B176 low", seed: int = 1,
    duration: float = 12.0, speeds: Sequence[float] = SPEEDS, out: str | Path | None = None,
    progress: bool = False, **changes: Any,
) -> dict[str, Any]:  # fmt: skip
    """Everything the header names; duration [s], speeds [km/h]; changes: `catalogue.Changes`."""
    car = named_vehicle(vehicle, **changes)
    length = max(speeds) / 3.6 * duration + 40.0
    rough = Irregularity.from_psd(spectrum, seed, length=length)
    car = car.on(replace(car.track, irregularity=rough))
    numbers: dict[str, Any] = {}
    motions = []
    for speed in speeds:
        motions.append(simulate(car, speed / 3.6, duration, progress=progress))
        numbers[f"{speed:g}"] = _numbers(motions[-1])
    if out is not None:
        numbers["files"] = _keep(Path(out), numbers, motions, rough)
    return finished(numbers, motions)


def _numbers(motion: Motion) -> dict[str, Any]:
    time = motion.time
    slow = low_pass(time, motion.Q)
    lateral = low_pass(time, motion.sum_of_y())
    _, means = motion.sliding_mean(np.abs(motion.sum_of_y()))
    x, y, z = motion.acceleration(BODY).T
    axle_load = float(motion.static_loads().sum(axis=1).mean())
    return {
        "y_mm": 1e3 * float(np.sqrt(np.mean(motion.y[:, 0] ** 2))),
        "yaw_mrad": 1e3 * float(np.sqrt(np.mean(motion.yaw[:, 0] ** 2))),
        "Q_kN": 1e-3 * float(slow.std(axis=0).max()),
        "sum_of_y_kN": 1e-3 * float(means.max()),
        "limit_kN": 1e-3 * sum_of_y_limit(axle_load),
        "percentiles_kN": (1e-3 * np.percentile(lateral[:, 0], PERCENTILES)).tolist(),
        "N_MV": mean_comfort(time, x, y, z),
        "Wz": [sperling(time, y), sperling(time, z, vertical=True)],
        "outcome": str(motion.outcome),
    }


def _keep(
    out: Path, numbers: dict[str, Any], motions: list[Motion], rough: Irregularity
) -> list[str]:
    figure, ((rails,), (shift,), (load,)) = new_figure(7.5, 8.5, rows=3)
    rails.plot(rough.distance, 1e3 * rough.shifts[:, 0], linewidth=0.8, label="left y")
    rails.plot(rough.distance, 1e3 * rough.shifts[:, 1], linewidth=0.8, label="left z")
    files = []
    for motion in motions:
        speed = f"{3.6 * motion.speed:.0f}"
        files.append(motion.write_csv(out / f"rough_track_{speed}.csv"))
        shift.plot(motion.distance, 1e3 * motion.y[:, 0], linewidth=0.8, label=f"{speed} km/h")
        slow = low_pass(motion.time, motion.Q[:, 0, 0])
        load.plot(motion.distance, 1e-3 * slow, linewidth=0.7, label=f"{speed} km/h")
    rails.set(ylabel="rail [mm]")
    shift.set(ylabel="y of the leading wheelset [mm]")
    load.set(xlabel="distance [m]", ylabel="Q, leading left, 20 Hz [kN]")
    for axes in (rails, shift, load):
        axes.legend(fontsize=8, frameon=False)
    files.append(write_figure(out / "rough_track.png", figure))
    files.append(write_json(out / "rough_track.json", numbers, motion=motions[-1].record))
    return [str(path) for path in files]


def _show(numbers: dict[str, Any]) -> None:
    for speed, of in numbers.items():
        if speed == "files":
            continue
        print(
            f"{speed} km/h: y {of['y_mm']:.2f} mm, yaw {of['yaw_mrad']:.2f} mrad, Q +-"
            f"{of['Q_kN']:.2f} kN, |sum of Y| to {of['sum_of_y_kN']:.1f} of {of['limit_kN']:.1f} "
            f"kN, N_MV {of['N_MV']:.2f}, Wz {of['Wz'][0]:.2f}, {of['Wz'][1]:.2f}; {of['outcome']}"
        )
    print(*numbers.get("files", ()), sep="\n")


def _run(arguments: argparse.Namespace) -> dict[str, Any]:
    given = {name: getattr(arguments, name) for name in ("spectrum", "seed", "duration")}
    given |= {"vehicle": arguments.vehicle, **chosen_changes(arguments)}
    return run(out=arguments.out, progress=not arguments.json, **given)


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser("A coach on rough straight track.", settings=False)
    add_vehicle_options(parser, "manchester_coach")
    parser.add_argument("--spectrum", default="ERRI B176 low", help="of the track")
    parser.add_argument("--seed", type=int, default=1, help="of the random phases")
    parser.add_argument("--duration", type=float, default=12.0, help="of each run [s]")
    return run_script(_run, parser, argv, _show)


if __name__ == "__main__":
    sys.exit(main())
