"""`exudyn-wheelset study`: the same numbers of many vehicles, as a table, on all cores.

    linear       linear critical speed [m/s]
    nonlinear    nonlinear critical speed [m/s], the lowest with a stable limit cycle
    conicity     equivalent conicity of the leading wheelset at 3 mm [-]

A case that gives no number has the reason in its row. With --out each case is kept as soon as it is
done: a study that was ended goes on from there when it is called again.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.front.script import get_ready, script_profile
from exudyn_wheelset.front.values import axis_of
from exudyn_wheelset.front.vehicle_options import (
    ChosenVehicle,
    add_vehicle_options,
    chosen_vehicle,
    law_and_parameters,
    law_changes,
)
from exudyn_wheelset.geometry.rolling_pair import rolling_pair
from exudyn_wheelset.stability.hunting.nonlinear import nonlinear_critical_speed
from exudyn_wheelset.stability.linear.crossings import hopf_points
from exudyn_wheelset.stability.subject import as_system, changed, description_of
from exudyn_wheelset.studies import grid, study

ABOUT = (
    "All combinations of the values of --vary. With --out: a table (CSV), and the cases as they\n"
    "are done (JSONL), from which an ended study goes on."
)
EXAMPLES = (
    "study --vehicle s1002 --vary gauge=1.432:1.438:7 --vary friction=0.2,0.4 --out results",
    "study --vehicle truck --vary 'wheel=measured/*.whl' --what linear conicity --out results",
    "study --vehicle cooperrider --vary half_wheelbase=0.9:1.3:5 --what linear nonlinear --json",
)
SETTINGS = False
NUMBERS = ("linear", "nonlinear", "conicity")
_PROFILES = ("wheel", "rail")
_AMPLITUDE = 3.0e-3


def add_options(parser: argparse.ArgumentParser) -> None:
    """Vehicle, what varies and what is asked."""
    add_vehicle_options(parser, "s1002")
    add = parser.add_argument
    add(
        "--vary",
        action="append",
        type=axis_of,
        metavar="NAME=VALUES",
        help="friction, gauge, conicity, wheel, rail, creep, or any path as of --set, with values "
        "0.1,0.3 or LOW:HIGH:COUNT or files by pattern; several times for all combinations",
    )
    add("--what", nargs="+", choices=NUMBERS, default=["linear"], help="default: linear")
    add("--processes", type=int, help="default: as many as there are cores")


def case_numbers(
    case: dict[str, Any],
    word: str,
    options: Sequence[Sequence[Any]],
    numbers: Sequence[str],
    smoothing: float | str,
) -> dict[str, Any]:
    """The numbers of one case: the vehicle of a word with options, then with the case's values."""
    changes: dict[str, Any] = {}
    paths: list[tuple[str, Any]] = []
    for name, value in [*map(tuple, options), *case.items()]:
        if name in _PROFILES:
            changes[name] = script_profile(value, name, smoothing)
        elif name == "creep":
            changes |= law_changes(law_and_parameters(value))
        elif name in ("friction", "conicity", "damping", "gauge", "gauge_depth", "inclination"):
            changes[name] = value
        else:
            paths.append((name, tuple(value) if isinstance(value, list) else value))
    chosen = ChosenVehicle(word, changes)
    description: Any = description_of(word) if not changes else description_of(chosen.vehicle())
    for path, value in paths:
        description = changed(description, path, value)
    system = as_system(description)
    found: dict[str, Any] = {}
    if "conicity" in numbers:
        if not hasattr(description, "wheelsets"):
            raise WheelsetError(f"{word} is equations alone: it has no conicity of its own")
        axle = max(description.wheelsets, key=lambda axle: axle.x)
        pair = rolling_pair(axle.wheelset, description.track, 7.0e-3)
        found["conicity"] = float(pair.conicity([_AMPLITUDE])[0])
    points = [p for p in hopf_points(system, *chosen.searched) if p.slope > 0.0]
    if "linear" in numbers:
        found["linear"] = points[0].speed if points else None
    if "nonlinear" in numbers:
        found["nonlinear"] = None
        if points:
            try:
                speed = nonlinear_critical_speed(system, hopf=points[0], check=False)
                found["nonlinear"] = float(speed.speed)
            except AnalysisError as error:
                found["note"] = str(error)
    return found


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """Rows of the study that the options name."""
    if not arguments.vary:
        raise WheelsetError(
            "give what varies: --vary friction=0.1,0.3 or --vary gauge=1.432:1.438:7"
        )
    names = [name for name, _ in arguments.vary]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise WheelsetError(f"--vary {twice[0]} is given twice: give all its values in one")
    chosen = chosen_vehicle(arguments)
    # What is wrong with the vehicle itself is said before anything is computed.
    chosen.vehicle()
    get_ready(arguments)
    cases = grid(dict(arguments.vary))
    options = {name: value for name, value in chosen.options.items() if name != "smoothing"}
    if "creep" in options:
        options["creep"] = str(options["creep"])
    settings = {
        "word": arguments.vehicle,
        "options": [list(pair) for pair in options.items()],
        "numbers": list(arguments.what),
        "smoothing": arguments.smoothing,
    }
    out = arguments.out
    file = None if out is None else Path(out) / f"study_{Path(arguments.vehicle).stem}.jsonl"
    found = study(
        case_numbers,
        cases,
        arguments.processes,
        file,
        settings=settings,
        progress=False if arguments.json else None,
    )
    rows = list(found.table.rows)
    numbers: dict[str, Any] = {"cases": len(found), "rows": rows}
    if file is not None:
        numbers["files"] = [str(file), str(found.save_csv(file.with_suffix(".csv")))]
    return numbers


def show(numbers: dict[str, Any]) -> None:
    """Print the rows, the reason in place of numbers where there are none."""
    for row in numbers["rows"]:
        words = [
            f"{name} {value:.5g}" if isinstance(value, float) else f"{name} {value}"
            for name, value in row.items()
            if name != "reason" and value is not None
        ]
        print(", ".join(words) + (f": {row['reason']}" if row.get("reason") else ""))
    print(*numbers.get("files", ()), sep="\n")
