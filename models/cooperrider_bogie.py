"""The Cooperrider bogie of Kaas-Petersen: linear and nonlinear critical speed, hunting amplitudes.

Run `python models/cooperrider_bogie.py`; with `--json` it prints only its numbers:

    hopf          linear critical speed [m/s]: the straight run loses stability
    fold          nonlinear critical speed [m/s]: the branch of limit cycles turns, below it the
                  bogie does not hunt
    amplitude_mm  lateral amplitude of the leading wheelset (half of peak to peak) [mm] of the
                  stable limit cycle, by speed in m/s

`--descent` finds the fold a second time by simulating quasi-static descent (`--settings` names a
file of Exudyn solver settings for it), `--reference` takes the equations written out without
Exudyn. The bifurcation diagram and its data land under `--out`.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from exudyn_wheelset.catalogue.cooperrider_bogie import STATE_NAMES, cooperrider_system
from exudyn_wheelset.catalogue.cooperrider_reference import cooperrider_reference_system
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import run_script, script_parser
from exudyn_wheelset.front.settings import load_settings
from exudyn_wheelset.front.tables import print_rows
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.nonlinear import nonlinear_critical_speed
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.systems.system import DynamicSystem

LEADING_WHEELSET = STATE_NAMES[0]
SEARCHED_SPEEDS = (20.0, 120.0)
BRANCH_SPEEDS = (55.0, 80.0)
# The flange's corner keeps the orbit from being smooth: with 30, 50, 80, 120 intervals the fold
# lies at 66.658, 66.655, 66.656, 66.656 m/s.
INTERVALS = 80


def run(
    system: DynamicSystem | None = None,
    speeds: Sequence[float] = (70.0, 75.0),
    progress: bool = False,
) -> tuple[dict[str, Any], CriticalPoint, Branch]:
    """The numbers of the header for amplitudes at `speeds` [m/s], the Hopf point, the branch."""
    system = system or cooperrider_system()
    hopf = linear_critical_speed(system, *SEARCHED_SPEEDS)
    low, high = BRANCH_SPEEDS
    branch = limit_cycles(
        system,
        hopf,
        (low, max(high, *speeds) + 1.0),
        intervals=INTERVALS,
        progress=progress,
    )
    amplitudes = {}
    for speed in speeds:
        found = branch.amplitudes_at(speed, LEADING_WHEELSET, stable=True)
        amplitudes[f"{speed:g}"] = float(found.max() * 1e3) if len(found) else None
    lowest = [fold.speed for fold in branch.folds if fold.side == "lowest"]
    numbers = {
        "hopf": float(hopf),
        "fold": min(lowest) if lowest else None,
        "amplitude_mm": amplitudes,
    }
    return numbers, hopf, branch


def main(argv: Sequence[str] | None = None) -> dict[str, Any]:
    """Run the script; returns its numbers, leaves by SystemExit after an error."""
    parser = script_parser(__doc__.splitlines()[0])
    parser.add_argument(
        "--speeds", type=float, nargs="+", default=[70.0, 75.0], help="speeds of the amplitudes"
    )
    parser.add_argument("--descent", action="store_true", help="find the fold by descent as well")
    parser.add_argument("--reference", action="store_true", help="equations without Exudyn")
    numbers: dict[str, Any] = {}

    def compute(arguments: argparse.Namespace) -> dict[str, Any]:
        numbers.update(_compute(arguments))
        return numbers

    status = run_script(compute, parser, argv, show=_print_table)
    if status:
        raise SystemExit(status)
    return numbers


def _compute(arguments: argparse.Namespace) -> dict[str, Any]:
    if arguments.reference:
        system: DynamicSystem = cooperrider_reference_system()
    else:
        settings = load_settings(arguments.settings) if arguments.settings else None
        system = cooperrider_system(settings=settings)
    progress = not arguments.json
    numbers, hopf, branch = run(system, arguments.speeds, progress)
    if arguments.descent:
        descent = nonlinear_critical_speed(system, "descent", hopf=hopf, progress=progress)
        numbers["fold_by_descent"] = float(descent)
    if arguments.out is not None:
        write_json(arguments.out / "cooperrider_bogie.json", numbers, system=system.measures())
        branch.save(arguments.out / "cooperrider_bogie.npz")
        _draw(branch, arguments.out / "cooperrider_bogie.png")
    return numbers


def _print_table(numbers: dict[str, Any]) -> None:
    fold = numbers["fold"]
    rows = [
        ("linear critical speed (Hopf)", f"{numbers['hopf']:.3f} m/s"),
        ("nonlinear critical speed (fold)", "none" if fold is None else f"{fold:.3f} m/s"),
    ]
    if "fold_by_descent" in numbers:
        rows.append(("the same by descent", f"{numbers['fold_by_descent']:.3f} m/s"))
    for speed, amplitude in numbers["amplitude_mm"].items():
        text = "no stable cycle" if amplitude is None else f"{amplitude:.3f} mm"
        rows.append((f"leading wheelset at {speed} m/s", text))
    print_rows(rows)


def _draw(branch: Branch, path: Path) -> None:
    figure, axes = new_figure(7.0, 4.5)
    branch.plot(axes[0, 0], LEADING_WHEELSET, factor=1e3)
    axes[0, 0].set_ylabel("lateral amplitude of the leading wheelset [mm]")
    axes[0, 0].set_title("Cooperrider bogie")
    write_figure(path, figure)


if __name__ == "__main__":
    main()
