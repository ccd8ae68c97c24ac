"""Bifurcation diagram of a vehicle: hunting amplitude over speed, stable and unstable.

Run `python models/bifurcation.py --vehicle s1002`; names are those of
`exudyn_wheelset.catalogue.by_name`. From the Hopf point, where the straight run loses stability,
the branch of limit cycles is followed through its folds (continuation). With `--json` it prints
only its numbers:

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
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

from exudyn_wheelset.catalogue.by_name import CATALOGUE, entry, vehicle_system
from exudyn_wheelset.compilation import warm_up
from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import (
    add_profile_options,
    run_script,
    script_parser,
    script_profile,
)
from exudyn_wheelset.front.settings import load_settings
from exudyn_wheelset.results.columns import column_index
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.continuation import ContinuationSettings
from exudyn_wheelset.stability.hunting.descent import Descent, quasi_static_descent
from exudyn_wheelset.stability.hunting.disturbance import CriticalDisturbances, critical_disturbance
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.watching import watched_index
from exudyn_wheelset.stability.linear.crossings import CriticalPoint, hopf_points
from exudyn_wheelset.systems.system import DynamicSystem

matplotlib.use("Agg")

CHANGES = (
    "friction",
    "creep",
    "gauge",
    "gauge_depth",
    "wheel",
    "rail",
    "conicity",
    "inclination",
    "damping",
)
# Ends of the branch, in Hopf speeds.
RANGE = (0.5, 1.3)
# Unit in which a displacement is drawn, by the unit in its name.
DRAWN = {"m": ("mm", 1e3), "rad": ("mrad", 1e3)}


@dataclass(frozen=True, eq=False)
class Diagram:
    """What a figure shows; any part may be missing. displacement: the state that it draws."""

    branches: Sequence[Branch] = ()
    descents: Sequence[Descent] = ()
    disturbances: Sequence[CriticalDisturbances] = ()
    displacement: str | None = None

    @property
    def watched(self) -> str:
        """Full name of the displacement that is drawn, its unit in brackets."""
        parts: list[Branch | Descent] = [*self.branches, *self.descents]
        if parts:
            names, record = parts[0].amplitude.names, parts[0].record
            wanted = self.displacement or record.get("displacement") or names[0]
            return names[column_index(names, wanted)]
        for runs in self.disturbances:
            return str(runs.record["settings"]["watch"])
        raise AnalysisError("there is nothing to draw: give a branch, a descent or disturbances")


def follow(
    system: DynamicSystem,
    hopf: CriticalPoint,
    speeds: tuple[float, float] | None = None,
    *,
    progress: bool = False,
    about: dict[str, Any] | None = None,
    **settings: Any,
) -> Branch:
    """The branch from a Hopf point inside `speeds` [m/s], default 0.5 and 1.3 times the point's.

    Where Newton's method fails on the default number of intervals, the branch is followed once
    more on half as many again, and the longer one is kept. about: what else is to stand in the
    branch's record; settings: of ContinuationSettings.
    """
    low, high = speeds or (RANGE[0] * hopf.speed, RANGE[1] * hopf.speed)
    branch = limit_cycles(system, hopf, (low, high), progress=progress, **settings)
    if branch.outcome.ending is Ending.ORBIT_LOST and "intervals" not in settings:
        finer = {**settings, "intervals": 3 * ContinuationSettings().intervals // 2}
        other = limit_cycles(system, hopf, (low, high), progress=progress, **finer)
        branch = max(branch, other, key=len)
    shown = system.state_names[watched_index(system)]
    return replace(branch, record={**branch.record, "displacement": shown, **(about or {})})


def lateral_mode(system: DynamicSystem, hopf: CriticalPoint) -> np.ndarray:
    """The shape (n,) of hunting at a Hopf point when its watched displacement is at its peak of 1.

    A disturbance of this shape, times an amplitude in m, is a hunting motion from the start.
    """
    mode = np.asarray(hopf.mode)
    return np.real(mode / mode[watched_index(system)])


def velocity_of(system: DynamicSystem, displacement: int, speed: float) -> int:
    """Index of the state that is the rate of a displacement."""
    return int(np.argmax(system.jacobian(system.equilibrium(speed), speed)[displacement]))


def disturbed_speeds(branch: Branch, count: int = 4) -> np.ndarray:
    """Speeds [m/s] inside the range where straight run and hunting are both stable, or none."""
    if branch.hopf is None or not np.any(branch.stable):
        return np.empty(0)
    low, high = branch.lowest_stable()[0], branch.hopf[0]
    # Small limit cycles beside a supercritical Hopf point are not what a disturbance leads to.
    first = branch.folds[0].index if branch.folds else len(branch)
    if np.any(branch.stable[:first]):
        high = min(high, float(branch.speed[:first].min()))
    if high - low < 1e-3 * high:
        return np.empty(0)
    return low + (high - low) * (np.arange(count) + 0.5) / count


def draw(path: Path, diagram: Diagram, title: str) -> Path:
    """The figure of a diagram."""
    figure, axes = new_figure(8.0, 5.2)
    draw_diagram(axes[0, 0], diagram)
    axes[0, 0].set_title(title, fontsize=10)
    for branch in diagram.branches[:1]:
        axes[0, 0].text(
            0.0,
            -0.16,
            f"{branch.method}, {len(branch)} orbits; the branch ends: {branch.reason}",
            transform=axes[0, 0].transAxes,
            fontsize=7,
            color="0.35",
            wrap=True,
        )
    write_figure(path, figure)
    return path


def draw_diagram(
    axes: Any,
    diagram: Diagram,
    colours: Sequence[str] = (),
    labels: Sequence[str] = (),
    notes: bool = True,
) -> None:
    """Amplitudes over speed into axes; colours and labels of the branches, in their order.

    notes: write speeds beside Hopf points and folds, and say what the line styles are.
    """
    name = diagram.watched
    unit, factor = DRAWN.get(name.rpartition("[")[2].rstrip("]"), (None, 1.0))
    for index, branch in enumerate(diagram.branches):
        colour = colours[index] if index < len(colours) else f"C{index}"
        label = labels[index] if index < len(labels) else None
        _draw_branch(axes, branch, name, factor, colour, label, notes)
    if diagram.branches and notes:
        axes.plot([], [], "-", color="0.3", label="stable")
        axes.plot([], [], "--", color="0.3", label="unstable: edge of the basin of attraction")
    for descent in diagram.descents:
        axes.plot(
            descent.speeds,
            factor * descent.amplitude[name],
            "v",
            color="C1",
            markersize=4,
            label=f"quasi-static descent, jump at {descent.speed:.2f} m/s",
            zorder=4,
        )
    for runs in diagram.disturbances:
        axes.plot(
            runs.speeds,
            factor * runs.edge,
            "x",
            color="C3",
            label=f"disturbance runs, {runs.direction.split(' [')[0]}: where motions part",
            zorder=5,
        )
    axes.set_ylim(bottom=0.0)
    # Room for the notes beside lowest folds.
    left, right = axes.get_xlim()
    axes.set_xlim(left - 0.08 * (right - left), right)
    axes.set_xlabel("forward speed [m/s]")
    what = name.split(" [")[0]
    axes.set_ylabel(f"{what}, half of peak to peak" + (f" [{unit}]" if unit else ""))
    axes.legend(fontsize=8, frameon=False)


def _draw_branch(
    axes: Any,
    branch: Branch,
    name: str,
    factor: float,
    colour: str,
    label: str | None,
    notes: bool,
) -> None:
    speed, values = branch.speed, factor * branch.amplitude[name]
    marginal = {fold.index for fold in branch.folds}
    steady = [bool(stable) or k in marginal for k, stable in enumerate(branch.stable)]
    solid = [before and after for before, after in pairwise(steady)]
    if branch.hopf is not None:
        speed, values = np.append(branch.hopf[0], speed), np.append(0.0, values)
        solid.insert(0, steady[0])
    first = 0
    for k in range(1, len(solid) + 1):
        if k < len(solid) and solid[k] == solid[first]:
            continue
        piece = slice(first, k + 1)
        style = "-" if solid[first] else "--"
        axes.plot(speed[piece], values[piece], style, color=colour, linewidth=1.6)
        first = k
    if label is not None:
        axes.plot([], [], "-", color=colour, label=label)
    if branch.hopf is not None:
        axes.plot(branch.hopf[0], 0.0, "o", color=colour, clip_on=False, zorder=6)
        if notes:
            _note(axes, f"Hopf {branch.hopf[0]:.2f} m/s", branch.hopf[0], 0.0, colour)
    noted: list[tuple[float, float]] = []
    reach, height = np.ptp(speed) + 1e-9, np.ptp(values) + 1e-9
    for fold in branch.folds:
        where = fold.speed, factor * branch.amplitude[name][fold.index]
        axes.plot(*where, "s", color=colour, markersize=5, zorder=6)
        # Folds close together, as in a branch of impacts, share a note.
        apart = (abs(where[0] - v) / reach + abs(where[1] - a) / height > 0.08 for v, a in noted)
        if notes and all(apart):
            noted.append(where)
            _note(axes, f"fold {fold.speed:.2f} m/s", *where, colour, fold.side == "lowest")


def _note(
    axes: Any, text: str, speed: float, value: float, colour: str, leftwards: bool = False
) -> None:
    axes.annotate(
        text,
        (speed, value),
        xytext=(-7, 0) if leftwards else (7, 4),
        textcoords="offset points",
        horizontalalignment="right" if leftwards else "left",
        fontsize=8,
        color=colour,
    )


def read(files: Sequence[Path]) -> Diagram:
    """The diagram in data files, each a branch, a descent or disturbance runs."""
    found: dict[Any, list[Any]] = {Branch: [], Descent: [], CriticalDisturbances: []}
    for path in files:
        failures = []
        for kind, members in found.items():
            try:
                members.append(kind.load(path))
                break
            except AnalysisError as error:
                failures.append(str(error))
        else:
            raise AnalysisError(failures[0])
    return Diagram(found[Branch], found[Descent], found[CriticalDisturbances])


def _numbers(
    hopf: Sequence[CriticalPoint], branch: Branch | None, seconds: float, reason: str
) -> dict[str, Any]:
    lowest = None
    if branch is not None and np.any(branch.stable):
        lowest = branch.lowest_stable()[0]
    return {
        "hopf": [float(point) for point in hopf],
        "folds": [float(fold) for fold in branch.folds] if branch else [],
        "nonlinear_critical_speed": lowest,
        "method": "continuation",
        "points": len(branch) if branch else 0,
        "seconds": seconds,
        "reason": branch.reason if branch else reason,
    }


def _compute(arguments: argparse.Namespace) -> dict[str, Any]:
    progress = not arguments.json
    changes = {name: getattr(arguments, name) for name in CHANGES}
    changes = {name: value for name, value in changes.items() if value is not None}
    settings = load_settings(arguments.settings) if arguments.settings else None
    profiles = {
        kind: script_profile(changes[kind], kind, arguments.smoothing)
        for kind in ("wheel", "rail")
        if kind in changes
    }
    system = vehicle_system(arguments.vehicle, settings, **{**changes, **profiles})
    if profiles and arguments.smoothing:
        changes["smoothing"] = arguments.smoothing
    stem = "_".join(
        ["bifurcation", arguments.vehicle, *(f"{k}_{_plain(v)}" for k, v in changes.items())]
    )
    seconds = warm_up()
    if progress:
        print(f"kernels ready in {seconds:.1f} s", file=sys.stderr)
    searched = arguments.searched or entry(arguments.vehicle).searched
    points = hopf_points(system, *searched)
    lost = [point for point in points if point.direction == "loses stability"]
    if not lost:
        raise AnalysisError(
            f"{system.name} does not lose stability to an oscillation between {searched[0]:g} and "
            f"{searched[1]:g} m/s; search elsewhere with --searched LOW HIGH"
        )
    hopf = lost[0]
    wanted = {"intervals": arguments.intervals, "maximum_points": arguments.points}
    given = {name: value for name, value in wanted.items() if value is not None}
    about = {"vehicle": arguments.vehicle, "options": {k: str(v) for k, v in changes.items()}}
    about["hopf_points"] = [float(point) for point in points]
    begun = time.perf_counter()
    branch, reason = None, ""
    try:
        branch = follow(system, hopf, arguments.speeds, progress=progress, about=about, **given)
    except AnalysisError as error:
        reason = str(error)
    numbers = _numbers(points, branch, time.perf_counter() - begun, reason)
    files = []
    if branch is not None:
        files.append(branch.save(arguments.out / f"{stem}.npz"))
        if branch.outcome.ending is not Ending.INTERRUPTED:
            files += _simulate(arguments, system, hopf, branch, numbers, stem)
    write_json(arguments.out / f"{stem}.json", numbers, **about, system=system.measures())
    if files:
        draw(arguments.out / f"{stem}.png", read(files), _title(system.name, changes))
    return numbers


def _simulate(
    arguments: argparse.Namespace,
    system: DynamicSystem,
    hopf: CriticalPoint,
    branch: Branch,
    numbers: dict[str, Any],
    stem: str,
) -> list[Path]:
    """Descent and disturbance runs as asked for; their data files. Adds to `numbers`."""
    files = []
    watched = system.state_names[watched_index(system)]
    largest = 1.05 * float(branch.amplitude[watched].max())
    shape = lateral_mode(system, hopf)
    low, high = arguments.speeds or (RANGE[0] * hopf.speed, RANGE[1] * hopf.speed)
    if arguments.descent:
        path = arguments.out / f"{stem}_descent.npz"
        descent = quasi_static_descent(
            system,
            high,
            low,
            step=arguments.step or 0.005 * hopf.speed,
            state=system.equilibrium(high) + largest * shape,
            state_file=path,
            progress=not arguments.json,
        )
        files.append(path)
        numbers["descent"] = {"speed": float(descent.speed), "reason": descent.reason}
    if arguments.disturbance is not None:
        speeds = np.asarray(arguments.disturbance or disturbed_speeds(branch))
        numbers["disturbance"] = {"speeds": speeds, "critical": []}
        if len(speeds):
            direction: str | int = arguments.direction
            size = 1.5 * largest / system.scales[watched_index(system)]
            if direction == "blow":
                direction = velocity_of(system, watched_index(system), hopf.speed)
                size = 4.0 * 2.0 * np.pi * hopf.frequency * largest
            runs = critical_disturbance(
                system,
                speeds,
                size,
                direction=direction,
                tolerance=0.005,
                progress=not arguments.json,
            )
            files.append(runs.save(arguments.out / f"{stem}_disturbance.npz"))
            numbers["disturbance"] = {
                "of": runs.direction,
                "speeds": runs.speeds,
                "critical": [float(v) if np.isfinite(v) else None for v in runs.critical],
            }
    return files


def _redraw(arguments: argparse.Namespace) -> dict[str, Any]:
    diagram = read(arguments.redraw)
    first: Any = [*diagram.branches, *diagram.descents, *diagram.disturbances][0]
    path = arguments.out / f"{arguments.redraw[0].stem}.png"
    draw(path, diagram, _title(first.record["system"], first.record.get("options", {})))
    if not diagram.branches:
        return {"figure": str(path), "reason": first.reason}
    branch = diagram.branches[0]
    numbers = _numbers([], branch, branch.record["cost"]["seconds"], "")
    hopf = branch.record.get("hopf_points") or ([branch.hopf[0]] if branch.hopf else [])
    return {**numbers, "hopf": hopf, "figure": str(path)}


def _title(system: str, changes: dict[str, Any]) -> str:
    return ", ".join([system, *(f"{name} {value}" for name, value in changes.items())])


def _plain(value: Any) -> str:
    return Path(value).stem if isinstance(value, str) else f"{value:g}"


def show(numbers: dict[str, Any]) -> None:
    """Print the numbers."""

    def speeds(values: Sequence[float]) -> str:
        return ", ".join(f"{value:.3f}" for value in values) or "none"

    if "hopf" in numbers:
        lowest = numbers["nonlinear_critical_speed"]
        rows = [
            ("linear critical speeds (Hopf) [m/s]", speeds(numbers["hopf"])),
            ("folds of the branch [m/s]", speeds(numbers["folds"])),
            ("nonlinear critical speed [m/s]", "none" if lowest is None else f"{lowest:.3f}"),
            ("method", f"{numbers['method']}, {numbers['points']} orbits"),
            ("the branch ends because", numbers["reason"]),
        ]
    else:
        rows = [("reason", numbers["reason"])]
    if "descent" in numbers:
        descent = numbers["descent"]
        rows.append(("jump by descent [m/s]", f"{descent['speed']:.3f}: {descent['reason']}"))
    if "disturbance" in numbers:
        runs = numbers["disturbance"]
        pairs = zip(runs["speeds"], runs["critical"], strict=False)
        sizes = [(at, "none" if size is None else f"{size:.4g}") for at, size in pairs]
        text = ", ".join(f"{size} at {speed:.2f} m/s" for speed, size in sizes)
        what = f"smallest {runs.get('of', 'disturbance')} that hunts"
        rows.append((what, text or "nowhere are straight run and hunting both stable"))
    if "figure" in numbers:
        rows.append(("figure", numbers["figure"]))
    for what, value in rows:
        print(f"{what:38s}{value}")


def parser() -> argparse.ArgumentParser:
    """Arguments of the script."""
    made = script_parser(__doc__.splitlines()[0])
    made.add_argument("--vehicle", default="s1002", help=f"one of {', '.join(CATALOGUE)}")
    made.add_argument(
        "--speeds",
        type=float,
        nargs=2,
        metavar=("LOW", "HIGH"),
        help="range of the diagram [m/s]; else 0.5 and 1.3 times the Hopf point's",
    )
    made.add_argument(
        "--searched",
        type=float,
        nargs=2,
        metavar=("LOW", "HIGH"),
        help="speeds searched for Hopf points [m/s]; else the vehicle's usual ones",
    )
    made.add_argument("--points", type=int, help="largest number of orbits on the branch")
    made.add_argument("--intervals", type=int, help="collocation intervals of an orbit")
    made.add_argument("--descent", action="store_true", help="add a quasi-static descent")
    made.add_argument("--step", type=float, help="steps of the descent [m/s]; else 0.5 %% of Hopf")
    made.add_argument(
        "--disturbance",
        type=float,
        nargs="*",
        metavar="SPEED",
        help="add disturbance runs at these speeds [m/s]; else at four between the "
        "nonlinear and the linear critical speed",
    )
    made.add_argument(
        "--direction",
        choices=("blow", "mode"),
        default="blow",
        help="what is disturbed: the lateral velocity [m/s], or the shape of the least damped mode "
        "in units of its scale (a millimetre of a wheelset)",
    )
    made.add_argument("--friction", type=float, help="coefficient of friction")
    made.add_argument("--creep", help="creep law")
    made.add_argument("--conicity", type=float, help="taper of the tread of an AAR wheel")
    made.add_argument("--damping", type=float, help="damping of the normal contact [s/m]")
    add_profile_options(made, wheel=None, rail=None, gauge=None, gauge_depth=None, inclination=None)
    made.add_argument(
        "--redraw",
        type=Path,
        nargs="+",
        metavar="FILE",
        help="only draw the data files of earlier runs again, on one figure",
    )
    return made


def main(argv: Sequence[str] | None = None) -> int:
    """Run the script; exit status."""

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        if arguments.redraw:
            return _redraw(arguments)
        if arguments.speeds and not 0.0 < arguments.speeds[0] < arguments.speeds[1]:
            low, high = arguments.speeds
            raise WheelsetError(f"--speeds {low:g} {high:g}: give the lower one first, above 0")
        return _compute(arguments)

    return run_script(work, parser(), argv, show)


if __name__ == "__main__":
    sys.exit(main())
