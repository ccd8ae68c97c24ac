"""A whole car: static loads, modes by name, critical speeds, hunting of each truck.

Run `python models/car.py --vehicle dtu_car`; the vehicle is a name of the catalogue. It prints the
wheel loads, the least damped modes, the linear critical speed with the name of its mode, and the
speed at which each truck stops hunting on the way down (quasi-static descent), and keeps under
runs/out/ (or --out)

    car_<vehicle>.png       root locus, amplitude of each truck over speed, a simulated hunt
    car_<vehicle>_hunt.csv  the simulated motion, as pandas reads it
    car_<vehicle>.json      the numbers, with the vehicle and all versions

`--json` prints the numbers only:

    linear_critical_speed [m/s], frequency_hz, mode_name, remarks
    damping     damping ratio of the least damped hunting mode at 60, 80 and 100 m/s
    hopf        all speeds at which an oscillation turns stable or unstable [m/s]
    by_truck    speed at which each truck stops hunting [m/s]; empty with --no-descent
    wheel_loads left and right of each wheelset [N]
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset import catalogue
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.front.mode_plots import draw_root_locus
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import (
    add_profile_options,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.front.settings import load_settings
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.stability.hunting.descent import Descent
from exudyn_wheelset.stability.hunting.nonlinear import nonlinear_critical_speed
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.crossings import CriticalPoint, hopf_points
from exudyn_wheelset.stability.linear.linearisation import linearise, root_locus
from exudyn_wheelset.systems.simulation import simulate
from exudyn_wheelset.systems.system import DynamicSystem
from exudyn_wheelset.vehicles.statics import static_equilibrium

DAMPING_SPEEDS = (60.0, 80.0, 100.0)
HUNT = 6.0  # [s]
WEAKLY_DAMPED = 15.0  # [1/s], what the root locus shows


def run(
    name: str,
    *,
    descent: bool = True,
    settings: Any = None,
    out: str | Path | None = None,
    progress: bool = False,
    **changes: Any,
) -> dict[str, Any]:
    """Everything the header names for a car of the catalogue; changes: see `catalogue.Changes`."""
    car = catalogue.vehicle(name, **changes)
    system = catalogue.vehicle_system(name, settings, **changes)
    low, high = catalogue.entry(name).searched
    critical = linear_critical_speed(system, low, high)
    rest = static_equilibrium(car)
    numbers: dict[str, Any] = {
        "linear_critical_speed": critical.speed,
        "frequency_hz": critical.frequency,
        "mode_name": critical.mode_name,
        "remarks": list(critical.remarks),
        "damping": {f"{speed:g}": _damping(system, speed) for speed in DAMPING_SPEEDS},
        "hopf": [float(point) for point in hopf_points(system, low, high)],
        "by_truck": {},
        "wheel_loads": {axle: list(loads) for axle, loads in rest.wheel_loads.items()},
        "modes": _modes(system, critical),
    }
    found = None
    if descent:
        try:
            lowest = nonlinear_critical_speed(system, "descent", hopf=critical, progress=progress)
        except AnalysisError as error:
            numbers["descent"] = str(error)
        else:
            found = lowest.branch
            numbers["by_truck"] = lowest.by_truck or {"": lowest.speed}
            numbers["descent"] = lowest.how
    if out is not None:
        numbers["files"] = _keep(Path(out), name, system, critical, found, numbers, progress)
    return numbers


def _damping(system: DynamicSystem, speed: float) -> float | None:
    """Damping ratio -Re/abs of the least damped hunting mode; None if none hunts."""
    linear = linearise(system, speed)
    row = linear.hunting_row
    if row is None:
        return None
    root = linear.eigenvalues[row]
    return float(-root.real / abs(root))


def _modes(system: DynamicSystem, critical: CriticalPoint) -> list[list[Any]]:
    """Name, frequency [Hz] and damping ratio of the oscillations below 15 Hz, at critical speed."""
    linear = linearise(system, critical.speed)
    return [
        [name, float(root.imag / (2.0 * np.pi)), float(-root.real / abs(root))]
        for name, root in zip(linear.mode_names, linear.eigenvalues, strict=True)
        if 0.05 < root.imag / (2.0 * np.pi) < 15.0
    ]


def _keep(
    out: Path,
    name: str,
    system: DynamicSystem,
    critical: CriticalPoint,
    descent: Descent | None,
    numbers: dict[str, Any],
    progress: bool,
) -> list[str]:
    speed = 1.1 * critical.speed
    hunt = simulate(system, speed, HUNT, start=3e-3, progress=progress)
    files = [hunt.write_csv(out / f"car_{name}_hunt.csv")]
    figure, panels = new_figure(7.5, 9.0, rows=3)
    axes = panels[:, 0]
    speeds = np.linspace(0.3 * critical.speed, 1.4 * critical.speed, 60)
    marks = draw_root_locus(axes[0], root_locus(system, speeds), critical=critical.speed)
    axes[0].set_xlim(-WEAKLY_DAMPED, 0.3 * WEAKLY_DAMPED)
    figure.colorbar(marks, ax=axes[0], label="speed [m/s]")
    _draw_trucks(axes[1], critical, descent)
    _draw_hunt(axes[2], system, hunt)
    files.append(write_figure(out / f"car_{name}.png", figure))
    files.append(write_json(out / f"car_{name}.json", numbers, system=system.measures()))
    return [str(path) for path in files]


def _draw_trucks(axes: Any, critical: CriticalPoint, descent: Descent | None) -> None:
    """Amplitude of each truck over speed by descent, and the linear critical speed."""
    if descent is not None:
        order = np.argsort(descent.speeds)
        for truck in descent.trucks.names:
            amplitude = 1e3 * np.asarray(descent.trucks[truck])[order]
            axes.plot(
                descent.speeds[order], amplitude, "o-", markersize=3, label=truck or "vehicle"
            )
        for truck, stop in descent.by_truck.items():
            axes.axvline(stop, linewidth=0.8, linestyle=":", color="0.4")
            axes.annotate(f"{truck} stops\n{stop:.1f}", (stop, 0.0), fontsize=7)
        axes.legend(fontsize=8, frameon=False)
    axes.axvline(critical.speed, color="0.6", linewidth=0.8)
    axes.set_xlabel("speed [m/s]")
    axes.set_ylabel("amplitude of hunting [mm]")


def _draw_hunt(axes: Any, system: DynamicSystem, hunt: Motion) -> None:
    """Lateral displacement of the first wheelset of each truck, or of all, over time."""
    shown = [wheelsets[0] for wheelsets in system.trucks.values()] or system.wheelset_names
    for wheelset in shown:
        axes.plot(hunt.time, 1e3 * hunt[f"{wheelset}: y"], linewidth=0.9, label=wheelset)
    axes.set_title(f"{hunt.speed:.1f} m/s: {hunt.outcome}", fontsize=9)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("y [mm]")
    axes.legend(fontsize=8, frameon=False, loc="upper left")


def _show(numbers: dict[str, Any]) -> None:
    for axle, (left, right) in numbers["wheel_loads"].items():
        print(f"{axle:32} {left / 1e3:8.2f} {right / 1e3:8.2f} kN left, right")
    print("least damped modes at the linear critical speed:")
    for name, frequency, damping in numbers["modes"][:8]:
        print(f"    {name:36} {frequency:6.2f} Hz, damping ratio {damping:+.4f}")
    print(
        f"linear critical speed {numbers['linear_critical_speed']:.3f} m/s "
        f"({numbers['frequency_hz']:.3f} Hz, {numbers['mode_name']})"
    )
    for remark in numbers["remarks"]:
        print(f"    {remark}")
    for truck, speed in numbers["by_truck"].items():
        print(f"{truck or 'vehicle'} stops hunting at {speed:.2f} m/s")
    for path in numbers.get("files", ()):
        print(path)


def _arguments(arguments: argparse.Namespace) -> dict[str, Any]:
    profiles = profiles_from(arguments)
    changes = {
        what: getattr(profiles, what)
        for what in ("wheel", "rail", "gauge", "gauge_depth", "inclination")
    }
    changes |= {"friction": arguments.friction, "creep": arguments.creep}
    return {what: value for what, value in changes.items() if value is not None}


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser("Stability and hunting of a whole car.")
    add_profile_options(
        parser, wheel=None, rail=None, gauge=None, gauge_depth=None, inclination=None
    )
    parser.add_argument("--vehicle", default="dtu_car", help="name of the catalogue")
    parser.add_argument("--creep", default=None, help="creep law")
    parser.add_argument("--friction", type=float, default=None, help="friction coefficient [-]")
    parser.add_argument(
        "--no-descent", dest="descent", action="store_false", help="leave out what takes minutes"
    )
    return run_script(
        lambda arguments: run(
            arguments.vehicle,
            descent=arguments.descent,
            settings=None if arguments.settings is None else load_settings(arguments.settings),
            out=None if arguments.json else arguments.out,
            progress=not arguments.json,
            **_arguments(arguments),
        ),
        parser,
        argv,
        _show,
    )


if __name__ == "__main__":
    sys.exit(main())
