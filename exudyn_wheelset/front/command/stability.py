"""`exudyn-wheelset stability`: wheel loads, modes, and speeds at which a vehicle loses stability.

linear_critical_speed [m/s], frequency_hz, mode_name, remarks
hopf         all speeds at which an oscillation turns stable or unstable [m/s]
damping      damping ratio of the least damped hunting mode at the speeds of --speeds
modes        at the critical speed: name, frequency [Hz], damping ratio
wheel_loads  left and right of each wheelset [N], of vehicles with bodies
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.mode_plots import draw_roots
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import get_ready
from exudyn_wheelset.front.tables import print_modes, print_rows, print_wheel_loads
from exudyn_wheelset.front.vehicle_options import ChosenVehicle, add_vehicle_options, chosen_vehicle
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.crossings import CriticalPoint, hopf_points
from exudyn_wheelset.stability.linear.linearisation import linearised
from exudyn_wheelset.systems.system import DynamicSystem
from exudyn_wheelset.vehicles.statics import static_equilibrium

ABOUT = "The linearised vehicle. With --out: root locus (PNG) and numbers (JSON)."
EXAMPLES = (
    "stability --vehicle dtu_car",
    "stability --vehicle truck --creep exact-table --friction 0.4 --wheel worn.whl --json",
    "stability --vehicle dtu_car --set 'connections.secondary.damping.y=50e3' --speeds 60 80 100",
)
SETTINGS = False


def run(
    chosen: ChosenVehicle,
    searched: tuple[float, float] | None = None,
    speeds: tuple[float, ...] = (),
) -> tuple[dict[str, Any], DynamicSystem, CriticalPoint]:
    """The numbers of the header, the system they are of and its critical point."""
    system = chosen.system()
    low, high = searched or chosen.searched
    critical = linear_critical_speed(system, low, high)
    numbers: dict[str, Any] = {
        "linear_critical_speed": critical.speed,
        "frequency_hz": critical.frequency,
        "mode_name": critical.mode_name,
        "remarks": list(critical.remarks),
        "hopf": [float(point) for point in hopf_points(system, low, high)],
        "damping": {f"{v:g}": linearised(system, v).hunting_damping for v in speeds},
        "modes": [
            [name, root.imag / (2.0 * np.pi), -root.real / abs(root)]
            for name, root in linearised(system, critical.speed).oscillations()
        ],
    }
    try:
        description = chosen.description()
    except WheelsetError:
        # Equations alone: there are no wheels to load.
        return numbers, system, critical
    rest = static_equilibrium(description)
    numbers["wheel_loads"] = {axle: list(loads) for axle, loads in rest.wheel_loads.items()}
    return numbers, system, critical


def add_options(parser: argparse.ArgumentParser) -> None:
    """Vehicle and speeds."""
    add_vehicle_options(parser, "dtu_car")
    pair: dict[str, Any] = {"type": float, "nargs": 2, "metavar": ("LOW", "HIGH")}
    where = "speeds searched [m/s]; else the vehicle's own"
    parser.add_argument("--searched", **pair, help=where)
    what = "speeds at which the damping is told [m/s]"
    parser.add_argument("--speeds", type=float, nargs="+", default=[], metavar="V", help=what)


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """Numbers of the vehicle that the options name; with --out, the root locus."""
    chosen = chosen_vehicle(arguments)
    get_ready(arguments)
    numbers, system, critical = run(chosen, arguments.searched, tuple(arguments.speeds))
    if arguments.out is not None:
        figure, axes = new_figure(7.0, 5.0)
        draw_roots(axes[0, 0], system, critical)
        axes[0, 0].set_title(chosen.title(system.name), fontsize=10)
        stem = arguments.out / chosen.stem("stability")
        files = [write_figure(f"{stem}.png", figure)]
        files.append(
            write_json(f"{stem}.json", numbers, **chosen.about(), system=system.measures())
        )
        numbers["files"] = [str(path) for path in files]
    return numbers


def show(numbers: dict[str, Any]) -> None:
    """Print loads, modes and speeds."""
    loads = {
        f"{axle} {side}": load
        for axle, pair in numbers.get("wheel_loads", {}).items()
        for side, load in zip(("left", "right"), pair, strict=True)
    }
    if loads:
        print_wheel_loads(loads)
    print_modes(numbers["modes"][:8])
    speed, frequency = numbers["linear_critical_speed"], numbers["frequency_hz"]
    rows = [
        ("linear critical speed", f"{speed:.3f} m/s ({3.6 * speed:.0f} km/h)"),
        ("its mode", f"{numbers['mode_name'] or 'lateral'}, {frequency:.3f} Hz"),
        ("speeds at which stability changes", ", ".join(f"{v:.2f}" for v in numbers["hopf"])),
    ]
    for at, ratio in numbers["damping"].items():
        rows.append((f"damping ratio of hunting at {at} m/s", f"{ratio:+.4f}"))
    print_rows(rows, 36)
    for remark in numbers["remarks"]:
        print(f"    {remark}")
    print(*numbers.get("files", ()), sep="\n")
