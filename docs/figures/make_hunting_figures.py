"""Make the figures of docs/hunting.md and print its numbers.

    python docs/figures/make_hunting_figures.py [sets influences s1002 small] [--data FOLDER]

All four take about five minutes. The branches, descents and disturbance runs behind the figures
are kept as data files (default runs/out/hunting), which models/bifurcation.py --redraw draws again.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset.catalogue.by_name import entry, vehicle
from exudyn_wheelset.front.diagrams import diagram_figure, draw_diagram
from exudyn_wheelset.front.output import write_figure
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.descent import Descent, quasi_static_descent
from exudyn_wheelset.stability.hunting.diagram import (
    RANGE,
    Diagram,
    branch_from,
    disturbed_speeds,
    mode_at_peak,
    rate_of,
)
from exudyn_wheelset.stability.hunting.disturbance import critical_disturbance
from exudyn_wheelset.stability.linear.crossings import CriticalPoint, hopf_points
from exudyn_wheelset.systems.exudyn_system import ExudynSystem

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]

NORMAL = "hertz"
# Whether data files of earlier runs are taken as they are.
KEPT = False
LAWS = ("polach", "shen-hedrick-elkins", "fastsim")
# Flange impacts are taken up in one blow, as on a track with ballast (catalogue/by_name.py).
DAMPING = 10.0
# Ends of the branches of sets 1 to 3, in Hopf speeds.
SPANS = {1: (0.8, 1.15), 2: (0.7, 1.15), 3: (0.45, 1.1)}
# Influences on set 2: option, its unit in the legend, values; the middle one is the paper's.
INFLUENCES = (
    ("friction", "friction {:g}", (0.15, 0.3, 0.5)),
    ("conicity", "conicity {:g}", (0.025, 0.05, 0.1)),
    ("gauge", "gauge {:g} m", (1.428, 1.432, 1.436)),
)


def model_of(name: str, **changes: Any) -> tuple[ExudynSystem, CriticalPoint]:
    """System and first Hopf point of a vehicle of the catalogue, on Hertzian contact."""
    model = vehicle(name, **changes)
    system = replace(model, contact={**model.contact, "normal": NORMAL}).dynamic_system()
    return system, hopf_points(system, *entry(name).searched)[0]


def branch_of(
    folder: Path, name: str, span: tuple[float, float], points: int = 90, **changes: Any
) -> Branch:
    """Branch inside `span` (in Hopf speeds), kept in `folder`; that of an earlier run if kept."""
    stem = "_".join([name, *(f"{key}_{value}" for key, value in changes.items())])
    path = folder / f"{stem}.npz"
    if KEPT and path.exists():
        return Branch.load(path)
    begun = time.perf_counter()
    system, hopf = model_of(name, **changes)
    speeds = (span[0] * hopf.speed, span[1] * hopf.speed)
    about = {"vehicle": name, "options": changes}
    branch = branch_from(system, hopf, speeds, about=about, maximum_points=points)
    branch.save(path)
    folds = ", ".join(f"{fold.speed:.2f} ({fold.side})" for fold in branch.folds) or "none"
    lowest = f"{branch.lowest_stable()[0]:.2f}" if np.any(branch.stable) else "none"
    print(
        f"{stem}: Hopf {hopf.speed:.3f} m/s; folds {folds}; lowest stable {lowest}; "
        f"{len(branch)} orbits; {time.perf_counter() - begun:.0f} s; {branch.reason}",
        flush=True,
    )
    return branch


def descent_of(folder: Path, name: str, branch: Branch, **changes: Any) -> Descent:
    """Descent from 1.1 Hopf speeds in steps of 1 %, kept in `folder`; an earlier one if kept."""
    path = folder / f"{name}_descent.npz"
    if KEPT and path.exists():
        return Descent.load(path)
    begun = time.perf_counter()
    system, hopf = model_of(name, **changes)
    # Flange impacts at 14 Hz want finer steps than the default: 161.0 m/s becomes 164.8 m/s.
    system.runner.step = min(system.step, 1.0 / (250.0 * hopf.frequency))
    high, low = 1.1 * hopf.speed, 0.6 * hopf.speed
    step = 0.01 * hopf.speed
    descent = quasi_static_descent(system, high, low, step=step, disturbance=10.0)
    if descent.outcome.ending is Ending.CONTACT_LOST:
        # Set 3: a push at that speed lifts a wheel. It begins on a cycle at the flange, lower.
        high = 1.02 * hopf.speed
        flange = np.flatnonzero(branch.amplitude["y"] > 10.5e-3)
        orbit = branch.orbits[flange[np.argmin(np.abs(branch.speed[flange] - high))]]
        state = system.carry_over(orbit.states[0], orbit.speed, high)
        descent = quasi_static_descent(system, high, low, step=step, state=state)
    descent.save(path)
    print(f"{name}: {descent.reason}; {time.perf_counter() - begun:.0f} s", flush=True)
    return descent


def sets(folder: Path) -> None:
    """The paper's wheelset, sets 1 to 3: whole diagrams, and the branch before the flange."""
    figure, axes = new_figure(11.0, 7.4, 2, 3)
    for column, k in enumerate((1, 2, 3)):
        whole, small = axes[0, column], axes[1, column]
        branches = []
        for law in ("polach", "fastsim"):
            changes: dict[str, Any] = {"creep": law, "damping": DAMPING}
            branches.append(branch_of(folder, f"paper-{k}", SPANS[k], **changes))
            if law == "polach":
                descent = descent_of(folder, f"paper-{k}", branches[0], **changes)
        shown = Diagram(branches, [descent])
        draw_diagram(whole, shown, ["C0", "C2"], ["polach", "fastsim"], notes=False)
        whole.set_ylim(0.0, 14.0)
        whole.set_title(f"set {k}", fontsize=10)
        whole.set_xlabel("")
        for index, law in enumerate(LAWS):
            branch = branch_of(folder, f"paper-{k}", (0.97, 1.03), 26, creep=law)
            y = 1e3 * branch.amplitude["y"]
            before = y < 10.0
            small.plot(
                1e2 * (branch.speed[before] / branch.speed[0] - 1.0),
                y[before],
                color=f"C{(0, 1, 2)[index]}",
                label=law,
            )
        small.axvline(0.0, color="0.6", linewidth=0.8)
        small.set_xlim(-0.75, 0.75)
        small.set_xlabel("speed beyond that of the smallest orbit [%]")
        small.set_ylabel("y, half of peak to peak [mm]")
        small.legend(fontsize=7, frameon=False, loc="lower left")
    write_figure(HERE / "hunting_paper_sets.png", figure)


def influences(folder: Path) -> None:
    """Friction, conicity and flange clearance on the paper's wheelset, set 2."""
    figure, axes = new_figure(11.0, 4.2, 1, 3)
    known: Branch | None = None
    for panel, (option, words, values) in zip(axes[0], INFLUENCES, strict=True):
        branches = []
        for place, value in enumerate(values):
            if place == 1 and known is not None:
                branches.append(known)
                continue
            changes: dict[str, Any] = {} if place == 1 else {option: value}
            branch = branch_of(
                folder, "paper-2", (0.7, 1.15), creep="fastsim", damping=DAMPING, **changes
            )
            branches.append(branch)
            known = branch if place == 1 else known
        labels = [words.format(value) for value in values]
        draw_diagram(panel, Diagram(branches), labels=labels, notes=False)
        above: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": 3}
        panel.legend(fontsize=8, frameon=False, columnspacing=1.0, **above)
    write_figure(HERE / "hunting_influences.png", figure)


def s1002(folder: Path) -> None:
    """S1002 on UIC60: continuation, descent and disturbance runs on one figure."""
    branch = branch_of(folder, "s1002", RANGE, 200)
    system, hopf = model_of("s1002")
    largest = 1.05 * float(branch.amplitude["y"].max())
    high = RANGE[1] * hopf.speed
    start = system.equilibrium(high) + largest * mode_at_peak(system, hopf)
    begun = time.perf_counter()
    descent = quasi_static_descent(system, high, 0.9 * hopf.speed, step=0.5, state=start)
    print(f"descent: {descent.reason}; {time.perf_counter() - begun:.0f} s", flush=True)
    begun = time.perf_counter()
    blow = rate_of(system, 1, hopf.speed)
    speeds = disturbed_speeds(branch, 5)
    runs = critical_disturbance(system, speeds, 1.0, direction=blow, tolerance=0.005)
    for speed, size, edge in zip(runs.speeds, runs.critical, runs.edge, strict=True):
        (unstable,) = branch.amplitudes_at(speed, "y", stable=False)[:1]
        print(
            f"blow at {speed:.2f} m/s: {size:.3f} m/s; motions part at {1e3 * edge:.2f} mm, "
            f"unstable orbit {1e3 * unstable:.2f} mm"
        )
    print(f"disturbance runs: {runs.runs}; {time.perf_counter() - begun:.0f} s", flush=True)
    descent.save(folder / "s1002_descent.npz")
    runs.save(folder / "s1002_disturbance.npz")
    shown = Diagram([branch], [descent], [runs])
    title = "S1002 on UIC60, 1:40, gauge 1435 mm: three methods"
    write_figure(HERE / "hunting_s1002.png", diagram_figure(shown, title))


def small(folder: Path) -> None:
    """S1002 over the gauge; Hopf point beside the speed of the smallest orbit, by creep law."""
    for gauge in (1.433, 1.434, 1.435, 1.436, 1.437):
        branch_of(folder, "s1002", (0.45, 1.3), 70, gauge=gauge)
    print("| creep law | " + " | ".join(f"set {k}: Hopf, small orbit" for k in (1, 2, 3)) + " |")
    for law in LAWS:
        cells = []
        for k in (1, 2, 3):
            system, hopf = model_of(f"paper-{k}", creep=law)
            span = (0.97 * hopf.speed, 1.03 * hopf.speed)
            branch = branch_from(system, hopf, span, maximum_points=2)
            cells.append(f"{hopf.speed:.3f}, {branch.speed[0]:.3f}")
        print(f"| {law} | " + " | ".join(cells) + " |")


def main() -> None:
    makers = {"sets": sets, "influences": influences, "s1002": s1002, "small": small}
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", help=f"of {', '.join(makers)}; all if left out")
    parser.add_argument("--data", type=Path, default=REPOSITORY / "runs" / "out" / "hunting")
    parser.add_argument("--kept", action="store_true", help="take data files that are there")
    arguments = parser.parse_args()
    global KEPT
    KEPT = arguments.kept
    begun = time.perf_counter()
    for part in arguments.parts or makers:
        if part not in makers:
            parser.error(f"{part!r} is not one of {', '.join(makers)}")
        makers[part](arguments.data)
    print(f"{time.perf_counter() - begun:.0f} s in total")


if __name__ == "__main__":
    main()
