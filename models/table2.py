"""Table 2 of the paper: linear critical speeds of its wheelset, recomputed beside the published.

Run `python models/table2.py`. Rows: the three codes of the paper with the lateral model, the full
six-degree-of-freedom Exudyn model ("exudyn"), and both profiled models with a spin that is free
instead of held at V/r0 ("profiled_free_spin", "exudyn_free_spin"). Figure (root locus) and data
land under runs/out/.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

from exudyn_wheelset.catalogue import paper_wheelset as paper
from exudyn_wheelset.contact.descriptions import Contact
from exudyn_wheelset.front.mode_plots import draw_critical_speeds, draw_root_locus
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import (
    ScriptProfiles,
    add_profile_options,
    get_ready,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.front.tables import print_beside, print_rows
from exudyn_wheelset.profiles import load_profile
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.linearisation import root_locus

PUBLISHED = {
    "mohan": (37.1, 117.2, 221.0),
    "idealized": (37.0, 116.9, 210.0),
    "profiled": (38.8, 115.4, 187.8),
}
SETS = ("set 1", "set 2", "set 3")
ROWS = ("mohan", "idealized", "profiled", "exudyn", "profiled_free_spin", "exudyn_free_spin")
SEARCHED_SPEEDS = (10.0, 300.0)
PAPER_PROFILES = ScriptProfiles(
    load_profile(paper.WHEEL), load_profile(paper.RAIL), paper.GAUGE, 0.014, paper.INCLINATION
)


def vehicle(row: str, spring_set: int, profiles: ScriptProfiles = PAPER_PROFILES) -> Any:
    """The model behind a cell of the table; profiles: of the rows that have any."""
    if row.startswith("exudyn"):
        model = paper.paper_wheelset(spring_set, driven=row == "exudyn", wheel=profiles.wheel)
        return replace(model, track=profiles.track)
    code = row.removesuffix("_free_spin")
    return paper.paper_lateral_wheelset(
        code, spring_set, free_spin=code != row, **profiles.__dict__
    )


def assumed(profiles: ScriptProfiles = PAPER_PROFILES) -> dict[str, Any]:
    """What the paper leaves out and is set here, once for all cells (docs/table2.md)."""
    given = asdict(paper.paper_parameters(1))
    names = (
        "yaw_inertia",
        "longitudinal_damping",
        "lateral_damping",
        "axle_load",
        "friction",
        "shear_modulus",
        "poisson",
        "rail_head_radius",
    )
    return {
        **{name: given[name] for name in names},
        "wheel": profiles.wheel.name,
        "rail": profiles.rail.name,
        "gauge": profiles.gauge,
        "inclination": profiles.inclination,
        "tape_half_distance": paper.TAPE_HALF_DISTANCE,
        "contact_damping": Contact.damping,
        "spin": "V/r0, r0 the nominal radius, as in equations (2) and (4); free in *_free_spin",
    }


def run(
    rows: Sequence[str] = ROWS,
    progress: bool = False,
    profiles: ScriptProfiles = PAPER_PROFILES,
) -> dict[str, Any]:
    """Critical speeds [m/s] of the three spring sets by row, and what was assumed."""
    numbers: dict[str, Any] = {}
    cells = [(row, spring_set) for row in rows for spring_set in (1, 2, 3)]
    for row, spring_set in tqdm(cells, disable=not progress, unit="cell", desc="critical speeds"):
        critical = linear_critical_speed(vehicle(row, spring_set, profiles), *SEARCHED_SPEEDS)
        numbers.setdefault(row, []).append(round(critical.speed, 3))
    numbers["assumed"] = assumed(profiles)
    return numbers


def draw(numbers: dict[str, Any], profiles: ScriptProfiles = PAPER_PROFILES) -> Figure:
    """Root locus of the Exudyn model and bars of the table."""
    figure, axes = new_figure(11.0, 4.6, 1, 2)
    left, right = axes[0]
    locus = root_locus(vehicle("exudyn", 1, profiles), np.linspace(10.0, 60.0, 51))
    marks = draw_root_locus(left, locus, 9.5, numbers.get("exudyn", [None])[0])
    left.set_title(f"{left.get_title()}, set 1, Exudyn")
    figure.colorbar(marks, ax=left, label="speed [m/s]")
    rows = {row: numbers[row] for row in ROWS if row in numbers}
    draw_critical_speeds(right, rows, SETS, PUBLISHED)
    right.set_title("Table 2")
    return figure


def show(numbers: dict[str, Any]) -> None:
    """Print the table."""
    print("\nLinear critical speed [m/s], recomputed (published, difference)")
    rows = {row: numbers[row] for row in ROWS if row in numbers}
    print_beside(rows, SETS, {row: PUBLISHED[row] for row in rows if row in PUBLISHED})
    print("\nAssumed in every cell (the paper leaves it out):")
    print_rows([(f"  {name}", str(value)) for name, value in numbers["assumed"].items()], 26)


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser(__doc__.splitlines()[0], settings=False)
    own = {"gauge": paper.GAUGE, "inclination": paper.INCLINATION}
    add_profile_options(parser, wheel=paper.WHEEL, rail=paper.RAIL, **own)
    parser.add_argument("--rows", nargs="+", choices=ROWS, default=list(ROWS), help="of the table")

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        profiles = profiles_from(arguments)
        get_ready(arguments)
        start = time.perf_counter()
        numbers = run(arguments.rows, not arguments.json, profiles)
        about = {"published": PUBLISHED, "seconds": time.perf_counter() - start}
        if arguments.out is not None:
            write_json(arguments.out / "table2.json", numbers, **about)
            write_figure(arguments.out / "table2.png", draw(numbers, profiles))
        return numbers

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
