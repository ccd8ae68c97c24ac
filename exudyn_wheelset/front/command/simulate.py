"""`exudyn-wheelset simulate`: a motion in time, what it did to the wheels, and how it ended.

outcome      how it ended, in words; duration: time reached [s]
wheelsets    by name: largest |y| and, in the last second, half of peak to peak [m]
wheels       by name: largest and smallest Q [N], largest |Y| [N]
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.front.motion_plots import draw_lateral
from exudyn_wheelset.front.output import keep_runs
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import finished, get_ready
from exudyn_wheelset.front.settings import changed_settings, output_of
from exudyn_wheelset.front.tables import print_rows
from exudyn_wheelset.front.vehicle_options import ChosenVehicle, add_vehicle_options, chosen_vehicle
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.systems.simulation import simulate

ABOUT = (
    "Steady running, all wheelsets moved aside at the start. --settings give the solver, its\n"
    "step, and the duration where --duration does not. With --out: time histories (CSV), figure."
)
EXAMPLES = (
    "simulate --vehicle dtu_car --speed 60 --duration 5 --initial 3e-3 --out results",
    "simulate --vehicle truck --speed 45 --settings rk44.json --json",
)
SETTINGS = True
DURATION, INTERVAL = 5.0, 2.0e-3


def add_run_options(parser: argparse.ArgumentParser) -> None:
    """Vehicle, speed, start and duration: what a motion is made of."""
    add_vehicle_options(parser, "dtu_car")
    add = parser.add_argument
    add("--speed", type=float, default=40.0, metavar="V", help="40 m/s")
    add("--duration", type=float, metavar="S", help="[s]; else that of the settings, or 5 s")
    add("--initial", type=float, default=2e-3, metavar="M", help="shift to the left, 2e-3 m")
    add("--interval", type=float, default=INTERVAL, metavar="S", help="of the samples, 2e-3 s")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Those of a motion."""
    add_run_options(parser)


def motion_of(chosen: ChosenVehicle, settings: Any, arguments: argparse.Namespace) -> Motion:
    """The motion that the options of `add_run_options` ask for."""
    speed = number("--speed", arguments.speed, "m/s", 0.1, 200.0)
    initial = number("--initial", arguments.initial, "m", -0.05, 0.05, "a shift, in metres")
    duration, interval = arguments.duration, arguments.interval
    if settings is not None:
        duration, _ = output_of(settings, duration)
    duration = positive("--duration", DURATION if duration is None else duration, "s", 3600.0)
    interval = positive("--interval", interval, "s", duration)
    return simulate(
        chosen.system(settings),
        speed,
        duration,
        initial=initial,
        interval=interval,
        progress=not arguments.json,
    )


def motion_numbers(motion: Motion) -> dict[str, Any]:
    """The numbers of the header."""
    last = motion.after(motion.time[-1] - 1.0)
    wheelsets = list(dict.fromkeys(name for name, _ in motion.wheels)) or list(motion.bodies)
    numbers: dict[str, Any] = {
        "speed": motion.speed,
        "duration": float(motion.time[-1]),
        "outcome": str(motion.outcome),
        "wheelsets": {},
        "wheels": {},
    }
    for name in wheelsets:
        column = f"{name}: y"
        numbers["wheelsets"][name] = {
            "largest_y": float(np.abs(motion[column]).max()),
            "last_half_peak_to_peak": float(0.5 * np.ptp(last[column])),
        }
    for wheelset, side in motion.wheels:
        forces = motion.wheel(wheelset, side)
        numbers["wheels"][f"{wheelset} {side}"] = {
            "largest_q": float(forces["Q [N]"].max()),
            "smallest_q": float(forces["Q [N]"].min()),
            "largest_y": float(np.abs(forces["Y [N]"]).max()),
        }
    return numbers


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """Numbers of the motion that the options name; with --out, its time histories."""
    chosen = chosen_vehicle(arguments)
    settings = get_ready(arguments)
    motion = motion_of(chosen, settings, arguments)
    numbers = motion_numbers(motion)
    if arguments.out is not None:
        figure, axes = new_figure(8.0, 4.5)
        draw_lateral(axes[0, 0], motion, list(numbers["wheelsets"]))
        figure.suptitle(chosen.title(chosen.name), fontsize=10)
        about: dict[str, Any] = {**chosen.about(), "record": motion.record}
        if settings is not None:
            about["settings"] = changed_settings(settings)
        stem = arguments.out / chosen.stem("simulate")
        kept = keep_runs(stem, numbers, [motion], figure, **about)
        numbers["files"] = [str(path) for path in kept]
    return finished(numbers, [motion])


def show(numbers: dict[str, Any]) -> None:
    """Print shifts and forces."""
    print(f"{numbers['speed']:g} m/s, {numbers['duration']:g} s: {numbers['outcome']}")
    for name, of in numbers["wheelsets"].items():
        largest, last = (1e3 * of[key] for key in ("largest_y", "last_half_peak_to_peak"))
        words = f"|y| to {largest:.3f} mm, in the end +-{last:.3f} mm"
        print_rows([(name, words)], 28)
    for name, of in numbers["wheels"].items():
        low, high, guiding = (1e-3 * of[key] for key in ("smallest_q", "largest_q", "largest_y"))
        print_rows([(name, f"Q {low:.1f} to {high:.1f} kN, |Y| to {guiding:.1f} kN")], 28)
    print(*numbers.get("files", ()), sep="\n")
