"""`exudyn-wheelset film`: a simulated motion as a film, or the vehicle as a picture."""

from __future__ import annotations

import argparse
from typing import Any

from exudyn_wheelset.checking import number
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.animation import render, write_image
from exudyn_wheelset.front.command.simulate import add_run_options, motion_numbers, motion_of
from exudyn_wheelset.front.film import VIEWS, camera_of, film
from exudyn_wheelset.front.pictures import on_rails
from exudyn_wheelset.front.script import finished, get_ready
from exudyn_wheelset.front.vehicle_options import chosen_vehicle

ABOUT = (
    "Drawn by Exudyn's ray tracer, without a display. MP4 where ffmpeg or imageio-ffmpeg is\n"
    "installed, else GIF. Needs --out."
)
EXAMPLES = (
    "film --vehicle truck --speed 50 --duration 3 --initial 4e-3 --view truck --out films",
    "film --vehicle dtu_car --picture --out pictures",
)
SETTINGS = True
# Speed [m/s] at which a model that stands still is built.
_SPEED = 20.0


def add_options(parser: argparse.ArgumentParser) -> None:
    """Those of a motion, and how it is seen."""
    add_run_options(parser)
    add = parser.add_argument
    add("--picture", action="store_true", help="no motion: draw the vehicle as it stands")
    add("--view", choices=VIEWS, default=VIEWS[0], help="what is looked at; default vehicle")
    add("--format", choices=("mp4", "gif"), default="mp4", help="of the film; default mp4")
    add("--start", type=float, metavar="S", help="where the film begins in the motion [s]")
    add("--seconds", type=float, metavar="S", help="of the motion that are shown; else all")
    add("--slow", type=float, default=1.0, help="times slower than it was; 1")
    add("--rate", type=float, default=25.0, help="pictures a second; 25")
    size: dict[str, Any] = {"type": int, "nargs": 2, "metavar": ("WIDTH", "HEIGHT")}
    add("--size", **size, default=[640, 360], help="pixels; 640 360")


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """Numbers of the motion and the file of its film."""
    if arguments.out is None:
        raise WheelsetError("give the folder of the film: --out FOLDER")
    chosen = chosen_vehicle(arguments)
    stem = arguments.out / chosen.stem("film")
    width, height = (int(number("--size", side, "pixels", 32, 8192)) for side in arguments.size)
    size = (width, height)
    if arguments.picture:
        if arguments.settings is not None:
            raise WheelsetError("--settings have no effect on a --picture: leave one of them out")
        vehicle = chosen.description()
        ends = [axle.x for axle in vehicle.wheelsets]
        reach = (min(ends) - 2.0, max(ends) + 2.0)
        container, _ = on_rails(vehicle, _SPEED, *reach)
        image = render(container, camera_of(vehicle, arguments.view, reach), size=size)
        return {"files": [str(write_image(f"{stem}.png", image))]}
    settings = get_ready(arguments)
    vehicle = chosen.description()
    motion = motion_of(chosen, settings, arguments)
    path = film(
        vehicle,
        motion,
        f"{stem}.{arguments.format}",
        start=arguments.start,
        seconds=arguments.seconds,
        rate=arguments.rate,
        slow=arguments.slow,
        view=arguments.view,
        size=size,
        progress=not arguments.json,
    )
    return finished({**motion_numbers(motion), "files": [str(path)]}, [motion])


def show(numbers: dict[str, Any]) -> None:
    """Print how the motion ended, and the file."""
    if "outcome" in numbers:
        print(f"{numbers['speed']:g} m/s, {numbers['duration']:g} s: {numbers['outcome']}")
    print(*numbers["files"], sep="\n")
