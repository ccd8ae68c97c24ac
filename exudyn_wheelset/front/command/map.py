"""`exudyn-wheelset map`: Hopf points and folds over speed and one number of a vehicle."""

from __future__ import annotations

import argparse
from typing import Any

from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import get_ready
from exudyn_wheelset.front.values import range_of
from exudyn_wheelset.front.vehicle_options import add_vehicle_options, chosen_vehicle
from exudyn_wheelset.stability.maps.curves import Curve
from exudyn_wheelset.stability.maps.stability_map import StabilityMap, stability_map

ABOUT = (
    "Follows the curves of Hopf points and of folds of limit cycles: where the vehicle always\n"
    "runs straight, hunts if disturbed, and hunts. With --out: the map (PNG) and its curves (JSON)."
)
EXAMPLES = (
    "map --vehicle cooperrider --over conicity=0.02:0.2 --out figures",
    "map --vehicle s1002 --over gauge=1.433:1.438 --starts 5 --no-folds",
    "map --vehicle truck --over 'connections.front left spring.stiffness.x=1e6:1e7' --json",
)
SETTINGS = False


def add_options(parser: argparse.ArgumentParser) -> None:
    """Vehicle, number and its range, how fine."""
    add_vehicle_options(parser, "cooperrider")
    add = parser.add_argument
    add(
        "--over",
        type=range_of,
        metavar="NUMBER=LOW:HIGH",
        help="the second number: friction, gauge, conicity, inclination, or any path as of --set",
    )
    pair: dict[str, Any] = {"type": float, "nargs": 2, "metavar": ("LOW", "HIGH")}
    add("--speeds", **pair, help="range of speeds [m/s]; else about the Hopf points")
    add("--points", type=int, default=40, help="of a curve over the range, at least; 40")
    add("--starts", type=int, default=3, help="values at which diagrams are made; 3")
    add("--no-folds", dest="folds", action="store_false", help="leave limit cycles out")


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """The map of the vehicle that the options name; its curves as numbers."""
    if arguments.over is None:
        raise WheelsetError("give the number of the map: --over conicity=0.02:0.2")
    chosen = chosen_vehicle(arguments)
    get_ready(arguments)
    name, limits = arguments.over
    found = stability_map(
        chosen.vehicle(),
        "speed",
        name,
        limits,
        speeds=None if arguments.speeds is None else tuple(arguments.speeds),
        points=arguments.points,
        starts=arguments.starts,
        folds=arguments.folds,
        progress=not arguments.json,
    )
    numbers = map_numbers(found)
    if arguments.out is not None:
        figure, axes = new_figure(7.0, 5.0)
        found.plot(axes[0, 0])
        axes[0, 0].set_title(chosen.title(chosen.name), fontsize=10)
        stem = arguments.out / f"{chosen.stem('map')}_over_{name.replace(' ', '_')}"
        files = [write_figure(f"{stem}.png", figure)]
        files.append(write_json(f"{stem}.json", numbers, **chosen.about(), record=found.record))
        numbers["files"] = [str(path) for path in files]
    return numbers


def map_numbers(found: StabilityMap) -> dict[str, Any]:
    """Parameter, unit, range, and of each curve its speeds [m/s], parameters and ends."""

    def numbers_of(curve: Curve) -> dict[str, Any]:
        return {
            "parameter": curve.parameter.tolist(),
            "speed": curve.speed.tolist(),
            "ends": [str(end) for end in curve.ends],
        }

    return {
        "parameter": found.parameter,
        "unit": found.unit,
        "limits": list(found.limits),
        "hopf": [numbers_of(curve) for curve in found.hopf],
        "folds": [numbers_of(curve) for curve in found.folds],
        "bautin_points": [list(point) for point in found.bautin_points],
        "remarks": list(found.remarks),
    }


def show(numbers: dict[str, Any]) -> None:
    """Print where the curves run."""
    unit = "" if numbers["unit"] in ("", "-") else f" {numbers['unit']}"
    for kind, words in (("hopf", "Hopf points"), ("folds", "folds")):
        for curve in numbers[kind]:
            ends = [0, -1]
            (first, last), (slow, fast) = (
                [curve[what][end] for end in ends] for what in ("parameter", "speed")
            )
            print(
                f"{words}: {slow:.2f} m/s at {numbers['parameter']} = {first:.5g}{unit} to "
                f"{fast:.2f} m/s at {last:.5g}{unit}; ends: {', '.join(curve['ends'])}"
            )
    for speed, at in numbers["bautin_points"]:
        print(f"from sub- to supercritical at {speed:.2f} m/s, {at:.5g}{unit}")
    print(*numbers["remarks"], *numbers.get("files", ()), sep="\n")
