"""A whole car: static loads, modes by name, critical speeds, hunting of each truck.

Run `python models/car.py --vehicle dtu_car`; the vehicle is a name of the catalogue or a file
(.toml). It prints wheel loads, least damped modes, the linear critical speed with the name of its
mode, and the speed at which each truck stops hunting, on the way down (quasi-static descent) and at
the fold of its periodic motion (continuation). It keeps under runs/out/ (or --out)

    car_<vehicle>.png       roots with names, the critical mode, each truck's amplitude, a hunt
    car_<vehicle>_hunt.csv  the simulated motion, as pandas reads it
    car_<vehicle>.json      the numbers, with the vehicle and all versions

`--json` prints the numbers only:

    linear_critical_speed [m/s], frequency_hz, mode_name, remarks
    damping          damping ratio of the least damped hunting mode at 60, 80 and 100 m/s
    hopf             all speeds at which an oscillation turns stable or unstable [m/s]
    by_truck         speed at which each truck stops hunting [m/s]; empty with --no-descent
    by_truck_method  which method gave it; by_truck_descent, by_truck_continuation: what each gives
    wheel_loads      left and right of each wheelset [N]
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset import hopf_points, linear_critical_speed, simulate, static_equilibrium
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.front.car_figure import car_figure
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.script import get_ready, run_script, script_parser
from exudyn_wheelset.front.tables import print_modes, print_rows, print_wheel_loads
from exudyn_wheelset.front.vehicle_options import ChosenVehicle, add_vehicle_options, chosen_vehicle
from exudyn_wheelset.stability.hunting.truck_speeds import TruckSpeeds, truck_speeds
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.stability.linear.linearisation import linearised
from exudyn_wheelset.systems.system import DynamicSystem

DAMPING_SPEEDS = (60.0, 80.0, 100.0)
HUNT = 6.0  # [s]
START = 3.0e-3  # [m], all wheelsets to the left


def run(
    vehicle: str | ChosenVehicle,
    *,
    descent: bool = True,
    settings: Any = None,
    out: str | Path | None = None,
    progress: bool = False,
    **changes: Any,
) -> dict[str, Any]:
    """The numbers of the header for a vehicle by name or file; with `out`, the files as well.

    changes: as of `catalogue.Changes`.
    """
    chosen = ChosenVehicle(vehicle, changes) if isinstance(vehicle, str) else vehicle
    system = chosen.system(settings)
    low, high = chosen.searched
    critical = linear_critical_speed(system, low, high)
    rest = static_equilibrium(chosen.description())
    modes = linearised(system, critical.speed).oscillations()
    numbers: dict[str, Any] = {
        "linear_critical_speed": critical.speed,
        "frequency_hz": critical.frequency,
        "mode_name": critical.mode_name,
        "remarks": list(critical.remarks),
        "damping": {f"{v:g}": linearised(system, v).hunting_damping for v in DAMPING_SPEEDS},
        "hopf": [float(point) for point in hopf_points(system, low, high)],
        "by_truck": {},
        "wheel_loads": {axle: list(loads) for axle, loads in rest.wheel_loads.items()},
        "modes": [[mode, r.imag / (2.0 * np.pi), -r.real / abs(r)] for mode, r in modes],
    }
    trucks = None
    if descent:
        try:
            trucks = truck_speeds(system, critical, progress=progress)
            numbers |= trucks.numbers()
        except AnalysisError as error:
            numbers["descent"] = str(error)
    if out is not None:
        stem = Path(out) / chosen.stem("car")
        numbers["files"] = keep(stem, chosen, system, critical, trucks, numbers, progress)
    return numbers


def keep(
    stem: Path,
    chosen: ChosenVehicle,
    system: DynamicSystem,
    critical: CriticalPoint,
    trucks: TruckSpeeds | None,
    numbers: dict[str, Any],
    progress: bool,
) -> list[str]:
    """Simulate a hunt above the critical speed; keep motion, figure and numbers: the files."""
    hunt = simulate(system, 1.1 * critical.speed, HUNT, start=START, progress=progress)
    figure = car_figure(chosen.description(), system, critical, trucks, hunt)
    files = [hunt.write_csv(f"{stem}_hunt.csv"), write_figure(f"{stem}.png", figure)]
    files.append(write_json(f"{stem}.json", numbers, **chosen.about(), system=system.measures()))
    return [str(path) for path in files]


def show(numbers: dict[str, Any]) -> None:
    """Print loads, modes and speeds."""
    sides = ("left", "right")
    loads = numbers["wheel_loads"].items()
    print_wheel_loads(
        {f"{axle} {s}": n for axle, q in loads for s, n in zip(sides, q, strict=True)}
    )
    print_modes(numbers["modes"][:8])
    speed, frequency = numbers["linear_critical_speed"], numbers["frequency_hz"]
    print(f"linear critical speed {speed:.3f} m/s ({frequency:.3f} Hz, {numbers['mode_name']})")
    for remark in numbers["remarks"]:
        print(f"    {remark}")
    methods = numbers.get("by_truck_method", {})
    print_rows(
        [
            (f"{truck or 'vehicle'} stops hunting at", f"{speed:.3f} m/s by {methods[truck]}")
            for truck, speed in numbers["by_truck"].items()
        ]
    )
    for words in [numbers[k] for k in ("descent", "continuation") if k in numbers]:
        print(words)
    print("\n".join(numbers.get("files", [])))


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser("Stability and hunting of a whole car.")
    add_vehicle_options(parser, "dtu_car")
    minutes = "leave out what takes minutes"
    parser.add_argument("--no-descent", dest="descent", action="store_false", help=minutes)

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        chosen = chosen_vehicle(arguments)
        options = {"descent": arguments.descent, "out": arguments.out}
        options["progress"] = not arguments.json
        return run(chosen, settings=get_ready(arguments), **options)

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
