"""`exudyn-wheelset hunt`: bifurcation diagram of a vehicle, hunting amplitude over speed.

From the Hopf point, where the straight run loses stability, the branch of limit cycles is followed
through its folds (continuation). The numbers:

    hopf                      speeds at which an oscillation loses or regains stability [m/s]
    folds                     speeds at which the branch turns [m/s], in its order
    nonlinear_critical_speed  lowest speed with a stable limit cycle [m/s]; None if there is none
    method                    what made the numbers
    points, seconds, reason   orbits on the branch, time of the continuation, why the branch ends

`--descent` adds hunting simulated at falling speed down to its jump, `--disturbance` the smallest
one-off lateral blow (a velocity) that leads to it; both come onto the same figure. It shows
the unstable branch dashed: a motion that stays below it dies out, one beyond it hunts.

Figure and data land under `--out`, named after the vehicle and what was changed of it. The data
files (.npz) hold settings, parameters, versions and method; `--redraw FILE ...` draws them again.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.front.diagrams import diagram_figure, print_diagram
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.script import get_ready
from exudyn_wheelset.front.vehicle_options import add_vehicle_options, chosen_vehicle, titled
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.diagram import (
    Diagram,
    branch_from,
    descent_from,
    diagram_numbers,
    disturbance_numbers,
    disturbances_beside,
    first_hopf_point,
)

ABOUT = (
    "Follows the limit cycles from the Hopf point through their folds. --settings hold for the\n"
    "simulations of --descent and --disturbance. With --out: figure, data (.npz), numbers."
)
EXAMPLES = (
    "hunt --vehicle cooperrider",
    "hunt --vehicle s1002 --friction 0.2 --descent --out figures",
    "hunt --vehicle my_truck.toml --set 'connections.secondary.damping.y=50e3' --json",
)
SETTINGS = True
show = print_diagram


def add_options(parser: argparse.ArgumentParser) -> None:
    """Vehicle, speeds, mesh, and what comes beside the branch."""
    pair: dict[str, Any] = {"type": float, "nargs": 2, "metavar": ("LOW", "HIGH")}
    add = parser.add_argument
    add_vehicle_options(parser, "s1002")
    add(
        "--speeds",
        **pair,
        help="range of the diagram [m/s]; else 0.5 and 1.3 times the Hopf point's",
    )
    add("--searched", **pair, help="speeds searched for Hopf points [m/s]; else the vehicle's own")
    add("--points", type=int, help="largest number of orbits on the branch")
    add("--intervals", type=int, help="collocation intervals of an orbit")
    add("--descent", action="store_true", help="add a quasi-static descent")
    add("--step", type=float, help="steps of the descent [m/s]; else 0.5 %% of Hopf")
    several: dict[str, Any] = {"type": float, "nargs": "*", "metavar": "SPEED"}
    add(
        "--disturbance",
        **several,
        help="add disturbance runs at these speeds [m/s]; else at four between the nonlinear and "
        "the linear critical speed",
    )
    add(
        "--direction",
        choices=("blow", "mode"),
        default="blow",
        help="what is disturbed: the lateral velocity [m/s], or the shape of the least damped mode "
        "in units of its scale (a millimetre of a wheelset)",
    )
    files: dict[str, Any] = {"type": Path, "nargs": "+", "metavar": "FILE"}
    add("--redraw", **files, help="only draw the data files of earlier runs again, on one figure")


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """The diagram of the vehicle that the options name; its numbers. Keeps figure and data."""
    if arguments.redraw:
        return redraw(arguments.redraw, arguments.out)
    if arguments.speeds and not 0.0 < arguments.speeds[0] < arguments.speeds[1]:
        low, high = arguments.speeds
        raise WheelsetError(f"--speeds {low:g} {high:g}: give the lower one first, above 0")
    chosen = chosen_vehicle(arguments)
    settings = get_ready(arguments)
    if settings is not None and not arguments.descent and arguments.disturbance is None:
        raise WheelsetError(
            f"--settings {arguments.settings}: a diagram by continuation simulates nothing: add "
            "--descent or --disturbance, or leave the settings out"
        )
    system = chosen.system(settings)
    hopf, points = first_hopf_point(system, *(arguments.searched or chosen.searched))
    about = {**chosen.about(), "hopf_points": [float(point) for point in points]}
    wanted = {"intervals": arguments.intervals, "maximum_points": arguments.points}
    given = {name: value for name, value in wanted.items() if value is not None}
    progress, speeds = not arguments.json, arguments.speeds
    path = None if arguments.out is None else arguments.out / chosen.stem("bifurcation")

    begun = time.perf_counter()
    branch, reason = None, ""
    try:
        branch = branch_from(system, hopf, speeds, progress=progress, about=about, **given)
    except AnalysisError as error:
        reason = str(error)
    numbers = diagram_numbers(points, branch, time.perf_counter() - begun, reason)
    descents, disturbances = [], []
    if branch is not None:
        if path is not None:
            branch.save(f"{path}.npz")
        going_on = branch.outcome.ending is not Ending.INTERRUPTED
        if arguments.descent and going_on:
            kept = None if path is None else f"{path}_descent.npz"
            options: dict[str, Any] = {"step": arguments.step, "state_file": kept}
            descent = descent_from(system, hopf, branch, speeds, progress=progress, **options)
            descents.append(descent)
            numbers["descent"] = {"speed": float(descent.speed), "reason": descent.reason}
        if arguments.disturbance is not None and going_on:
            at = arguments.disturbance or None
            options = {"direction": arguments.direction, "progress": progress}
            runs = disturbances_beside(system, hopf, branch, at, **options)
            numbers["disturbance"] = disturbance_numbers(runs)
            if runs is not None:
                if path is not None:
                    runs.save(f"{path}_disturbance.npz")
                disturbances.append(runs)
    if path is not None:
        if branch is not None:
            diagram = Diagram([branch], descents, disturbances)
            figure = diagram_figure(diagram, chosen.title(system.name))
            write_figure(f"{path}.png", figure)
        write_json(f"{path}.json", numbers, **about, system=system.measures())
    return numbers


def redraw(files: Sequence[Path], out: Path | None) -> dict[str, Any]:
    """Draw data files of earlier runs again, on one figure; their numbers."""
    diagram = Diagram.load(files)
    title = titled(diagram.record["system"], diagram.record.get("options", {}))
    figure = diagram_figure(diagram, title)
    path = write_figure((out or files[0].parent) / f"{files[0].stem}.png", figure)
    return {**diagram.numbers(), "figure": str(path)}
