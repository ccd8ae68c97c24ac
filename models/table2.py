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
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from exudyn_wheelset.catalogue import paper_wheelset as paper
from exudyn_wheelset.compilation import warm_up
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.script import (
    ScriptProfiles,
    add_profile_options,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.profiles import load_profile
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.linearisation import root_locus

PUBLISHED = {
    "mohan": (37.1, 117.2, 221.0),
    "idealized": (37.0, 116.9, 210.0),
    "profiled": (38.8, 115.4, 187.8),
}
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
        "contact_damping": paper.CONTACT_DAMPING,
        "spin": "V/r0, r0 the nominal radius, as in equations (2) and (4); free in *_free_spin",
    }


def run(
    rows: Sequence[str] = ROWS,
    progress: bool = False,
    profiles: ScriptProfiles = PAPER_PROFILES,
) -> dict[str, Any]:
    """Critical speeds [m/s] of the three spring sets by row, and what was assumed."""
    numbers: dict[str, Any] = {}
    bar = tqdm(total=3 * len(rows), disable=not progress, unit="cell", desc="critical speeds")
    with bar:
        for row in rows:
            numbers[row] = []
            for spring_set in (1, 2, 3):
                critical = linear_critical_speed(
                    vehicle(row, spring_set, profiles), *SEARCHED_SPEEDS
                )
                numbers[row].append(round(critical.speed, 3))
                bar.update()
    numbers["assumed"] = assumed(profiles)
    return numbers


def draw(path: Path, numbers: dict[str, Any], profiles: ScriptProfiles = PAPER_PROFILES) -> Path:
    """Root locus of the Exudyn model and bars of the table."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6))
    speeds = np.linspace(10.0, 60.0, 51)
    locus = root_locus(vehicle("exudyn", 1, profiles), speeds)
    roots = np.asarray(locus.eigenvalues)
    shown = (roots.imag > 1.0) & (roots.imag < 60.0)
    points = left.scatter(
        roots.real[shown],
        roots.imag[shown] / (2.0 * np.pi),
        c=np.broadcast_to(speeds[:, None], roots.shape)[shown],
        s=9,
        cmap="viridis",
    )
    figure.colorbar(points, ax=left, label="speed [m/s]")
    left.axvline(0.0, color="black", linewidth=0.8)
    left.set_xlabel("growth rate [1/s]")
    left.set_ylabel("frequency [Hz]")
    left.set_title(f"Root locus, set 1, Exudyn: critical at {numbers['exudyn'][0]:.1f} m/s")
    left.grid(alpha=0.3)

    rows = [row for row in ROWS if row in numbers]
    width = 0.8 / len(rows)
    places = np.arange(3)
    for k, row in enumerate(rows):
        bars = right.bar(places + (k - (len(rows) - 1) / 2) * width, numbers[row], width, label=row)
        if row in PUBLISHED:
            for bar, value in zip(bars, PUBLISHED[row], strict=True):
                right.plot(
                    [bar.get_x(), bar.get_x() + bar.get_width()], [value] * 2, color="black", lw=2
                )
    right.plot([], [], color="black", lw=2, label="published")
    right.set_xticks(places, ["set 1", "set 2", "set 3"])
    right.set_ylabel("linear critical speed [m/s]")
    right.set_title("Table 2")
    right.legend(fontsize=8)
    right.grid(axis="y", alpha=0.3)
    figure.tight_layout()
    write_figure(path, figure)
    plt.close(figure)
    return path


def show(numbers: dict[str, Any]) -> None:
    """Print the table."""
    print("\nLinear critical speed [m/s], recomputed (published, difference)")
    print(f"{'':20s}{'set 1':>24s}{'set 2':>24s}{'set 3':>24s}")
    for row in ROWS:
        cells = []
        for k, value in enumerate(numbers[row]):
            if row in PUBLISHED:
                known = PUBLISHED[row][k]
                cells.append(f"{value:8.1f} ({known:5.1f}, {100 * (value / known - 1):+5.1f} %)")
            else:
                cells.append(f"{value:8.1f}{'':17s}")
        print(f"{row:20s}" + "".join(f"{cell:>24s}" for cell in cells))
    print("\nAssumed in every cell (the paper leaves it out):")
    for name, value in numbers["assumed"].items():
        print(f"  {name:24s}{value}")


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser(__doc__.splitlines()[0], settings=False)
    add_profile_options(
        parser,
        wheel=paper.WHEEL,
        rail=paper.RAIL,
        gauge=paper.GAUGE,
        inclination=paper.INCLINATION,
    )

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        seconds = warm_up()
        if not arguments.json:
            print(f"kernels ready in {seconds:.1f} s", file=sys.stderr)
        start = time.perf_counter()
        profiles = profiles_from(arguments)
        numbers = run(progress=not arguments.json, profiles=profiles)
        taken = time.perf_counter() - start
        write_json(
            arguments.out / "table2.json",
            numbers,
            published=PUBLISHED,
            seconds=taken,
        )
        draw(arguments.out / "table2.png", numbers, profiles)
        return numbers

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
