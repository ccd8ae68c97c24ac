"""A two-axle truck on profiled rails: wheel loads, critical speed and its mode, growth rates.

Run `python models/simple_truck.py`. The truck is that of the DTU passenger car: a frame and two
wheelsets, each a rigid body with six degrees of freedom, under a car body that runs straight.
It is started in the shape of its critical mode below and above the critical speed; growth of the
simulated motion beside the eigenvalue's. Figure, time histories and numbers land under runs/out/.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import exudyn as exu
from matplotlib.figure import Figure

from exudyn_wheelset import Motion, Truck, catalogue, linear_critical_speed
from exudyn_wheelset.checking import number
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.front.animation import Camera
from exudyn_wheelset.front.mode_plots import draw_mode_from_above, draw_roots
from exudyn_wheelset.front.motion_plots import draw_lateral, growth_title
from exudyn_wheelset.front.output import keep_runs
from exudyn_wheelset.front.pictures import draw_picture
from exudyn_wheelset.front.plots import new_figure, pair_name
from exudyn_wheelset.front.script import (
    DEFAULT_OUT,
    add_profile_options,
    finished,
    get_ready,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.front.settings import changed_settings, load_settings, output_of
from exudyn_wheelset.front.tables import print_growth, print_wheel_loads
from exudyn_wheelset.front.vehicle_options import add_creep_option, law_changes
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.stability.linear.modes import lateral_shape
from exudyn_wheelset.stability.linear.simulated_growth import compare_growth
from exudyn_wheelset.systems.starts import steady_wheel_loads

DEFAULT_SETTINGS = Path(__file__).resolve().parents[1] / "runs" / "rk44.json"
SEARCHED_SPEEDS = (15.0, 150.0)
FACTORS = (0.9, 1.1)
# On S1002 and UIC60 contact changes between two places within 0.2 mm: motion below that is linear.
AMPLITUDE = 2.0e-5
WHEELSETS = {f"truck {which} wheelset": which for which in ("leading", "trailing")}
BODIES = {**WHEELSETS, "truck frame": "frame"}


def run(
    truck: Truck | None = None,
    amplitude: float = AMPLITUDE,
    settings: exu.SimulationSettings | None = None,
    duration: float = 6.0,
    progress: bool = False,
    factors: Sequence[float] = FACTORS,
) -> tuple[dict[str, Any], list[Motion], CriticalPoint]:
    """Numbers of the header, motions at `factors` times the critical speed, the critical point."""
    truck = truck or catalogue.vehicle("truck")
    settings = settings or load_settings(DEFAULT_SETTINGS)
    times = output_of(settings, duration)
    number("amplitude", amplitude, "m", 1.0e-7, 0.02, "a lateral amplitude, in metres")
    system = truck.dynamic_system(settings=settings)
    critical = linear_critical_speed(system, *SEARCHED_SPEEDS)
    try:
        alone = linear_critical_speed(truck.wheelset_alone(), *SEARCHED_SPEEDS).speed
    except AnalysisError:
        alone = None
    loads = steady_wheel_loads(system, critical.speed)
    loads = {f"{WHEELSETS[wheelset]} {side}": load for (wheelset, side), load in loads.items()}
    shape = lateral_shape(critical.state_names, critical.mode)
    speeds = [factor * critical.speed for factor in factors]
    rows, motions = compare_growth(
        system, speeds, *times, amplitude=amplitude, near=critical, progress=progress
    )
    numbers = {
        "weight": truck.weight,
        "wheel_loads": {**loads, "sum": sum(loads.values())},
        "critical_speed": critical.speed,
        "frequency": critical.frequency,
        "critical_speed_of_a_wheelset_on_a_fixed_frame": alone,
        "mode": {name.removeprefix("truck "): part for name, part in shape.items()},
        "amplitude": amplitude,
        "runs": rows,
    }
    return numbers, motions, critical


def draw(
    truck: Truck, critical: CriticalPoint, numbers: dict[str, Any], motions: Sequence[Motion]
) -> Figure:
    """Root locus, mode seen from above at four phases, and the simulated motions."""
    figure, axes = new_figure(12.0, 7.2, 2, 2)
    draw_roots(axes[0, 0], truck, critical)
    draw_mode_from_above(axes[0, 1], truck.vehicle(), critical)
    for panel, motion, row in zip(axes[1], motions, numbers["runs"], strict=False):
        draw_lateral(panel, motion, BODIES, growth_title(row))
    figure.suptitle(f"{truck.name}: {pair_name(truck.wheelset, truck.track)}", fontsize=11)
    return figure


def show(numbers: dict[str, Any]) -> None:
    """Print loads, critical speeds and growth rates."""
    print_wheel_loads(numbers["wheel_loads"], numbers["weight"])
    alone = numbers["critical_speed_of_a_wheelset_on_a_fixed_frame"]
    print(
        f"linear critical speed {numbers['critical_speed']:.3f} m/s at "
        f"{numbers['frequency']:.3f} Hz; a wheelset of it on a fixed frame: "
        + ("stable up to the end of the search" if alone is None else f"{alone:.3f} m/s")
    )
    print_growth(numbers["runs"])


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser(__doc__.splitlines()[0], settings=DEFAULT_SETTINGS)
    add_profile_options(parser)
    add = parser.add_argument
    add_creep_option(parser, "shen-hedrick-elkins")
    add("--friction", type=float, default=0.15, help="coefficient of friction")
    add("--amplitude", type=float, default=AMPLITUDE, help="of the start [m]")
    add("--duration", type=float, default=6.0, help="of each run [s]")
    add("--picture", action="store_true", help="draw the truck on its rails")

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        contact = {**law_changes(arguments.creep), "friction": arguments.friction}
        truck = catalogue.vehicle("truck", **contact, **profiles_from(arguments).changes)
        settings = get_ready(arguments)
        given = (arguments.amplitude, settings, arguments.duration, not arguments.json)
        numbers, motions, critical = run(truck, *given)
        stem = (arguments.out or DEFAULT_OUT) / "simple_truck"
        if arguments.out is not None:
            figure = draw(truck, critical, numbers, motions)
            about = {"parameters": truck.parameters(), "settings": changed_settings(settings)}
            keep_runs(stem, numbers, motions, figure, **about)
        if arguments.picture:
            camera = Camera(azimuth=0.75, elevation=0.36, centre=(0.0, 0.0, 0.25), zoom=3.0)
            draw_picture(f"{stem}_picture.png", truck, None, camera, (-4, 4))
        return finished(numbers, motions)

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
