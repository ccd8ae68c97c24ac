"""Bifurcation diagram of a vehicle: hunting amplitude over speed, stable and unstable.

Run `python models/bifurcation.py --vehicle s1002`; names are those of the catalogue. From the Hopf
point, where the straight run loses stability, the branch of limit cycles is followed through its
folds (continuation). With `--json` it prints only its numbers:

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
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.front.diagrams import diagram_figure, print_diagram
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.script import get_ready, run_script, script_parser
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


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """The diagram of the vehicle that the options name; its numbers. Keeps figure and data."""
    if arguments.speeds and not 0.0 < arguments.speeds[0] < arguments.speeds[1]:
        low, high = arguments.speeds
        raise WheelsetError(f"--speeds {low:g} {high:g}: give the lower one first, above 0")
    chosen = chosen_vehicle(arguments)
    system = chosen.system(get_ready(arguments))
    hopf, points = first_hopf_point(system, *(arguments.searched or chosen.searched))
    about = {**chosen.about(), "hopf_points": [float(point) for point in points]}
    wanted = {"intervals": arguments.intervals, "maximum_points": arguments.points}
    given = {name: value for name, value in wanted.items() if value is not None}
    progress, speeds = not arguments.json, arguments.speeds
    path = arguments.out / chosen.stem("bifurcation")

    begun = time.perf_counter()
    branch, reason = None, ""
    try:
        branch = branch_from(system, hopf, speeds, progress=progress, about=about, **given)
    except AnalysisError as error:
        reason = str(error)
    numbers = diagram_numbers(points, branch, time.perf_counter() - begun, reason)
    descents, disturbances = [], []
    if branch is not None:
        branch.save(f"{path}.npz")
        going_on = branch.outcome.ending is not Ending.INTERRUPTED
        if arguments.descent and going_on:
            options = {"step": arguments.step, "state_file": f"{path}_descent.npz"}
            descent = descent_from(system, hopf, branch, speeds, progress=progress, **options)
            descents.append(descent)
            numbers["descent"] = {"speed": float(descent.speed), "reason": descent.reason}
        if arguments.disturbance is not None and going_on:
            at = arguments.disturbance or None
            options = {"direction": arguments.direction, "progress": progress}
            runs = disturbances_beside(system, hopf, branch, at, **options)
            numbers["disturbance"] = disturbance_numbers(runs)
            if runs is not None:
                runs.save(f"{path}_disturbance.npz")
                disturbances.append(runs)
        figure = diagram_figure(
            Diagram([branch], descents, disturbances), chosen.title(system.name)
        )
        write_figure(f"{path}.png", figure)
    write_json(f"{path}.json", numbers, **about, system=system.measures())
    return numbers


def redraw(files: Sequence[Path], out: Path) -> dict[str, Any]:
    """Draw data files of earlier runs again, on one figure; their numbers."""
    diagram = Diagram.load(files)
    title = titled(diagram.record["system"], diagram.record.get("options", {}))
    path = write_figure(out / f"{files[0].stem}.png", diagram_figure(diagram, title))
    return {**diagram.numbers(), "figure": str(path)}


def parser() -> argparse.ArgumentParser:
    """Options of the script."""
    made = script_parser(__doc__.splitlines()[0])
    pair: dict[str, Any] = {"type": float, "nargs": 2, "metavar": ("LOW", "HIGH")}
    add = made.add_argument
    add_vehicle_options(made, "s1002")
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
    return made


def main(argv: Sequence[str] | None = None) -> int:
    """Run the script; exit status."""

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        if arguments.redraw:
            return redraw(arguments.redraw, arguments.out)
        return compute(arguments)

    return run_script(work, parser(), argv, print_diagram)


if __name__ == "__main__":
    sys.exit(main())
