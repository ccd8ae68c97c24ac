"""Bifurcation diagrams of the truck and the S1002 wheelset with several creep laws, on one figure.

Run `python docs/figures/make_hunting_by_law.py`; it writes hunting_by_law.png beside itself and
prints Hopf points, folds and ends for docs/hunting.md. Some minutes.
"""

from __future__ import annotations

import time
import warnings
from pathlib import Path

import numpy as np
from matplotlib.lines import Line2D

from exudyn_wheelset.catalogue import vehicle_system
from exudyn_wheelset.errors import AnalysisError, WheelsetWarning
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed

LAWS = ("shen-hedrick-elkins", "polach-kalker", "fastsim", "exact-table")
VEHICLES = {"s1002": (10.0, 150.0), "truck": (15.0, 150.0)}


def main() -> None:
    warnings.simplefilter("ignore", WheelsetWarning)
    figure, panels = new_figure(9.0, 4.2, columns=2)
    for axes, (name, searched) in zip(panels[0], VEHICLES.items(), strict=True):
        for number, law in enumerate(LAWS):
            begun = time.perf_counter()
            try:
                system = vehicle_system(name, creep=law)
                hopf = linear_critical_speed(system, *searched)
                low, high = 0.5 * hopf.speed, 1.25 * hopf.speed
                branch = limit_cycles(system, hopf, (low, high))
            except AnalysisError as error:
                print(f"{name}, {law}: {error}", flush=True)
                continue
            watched = next(column for column in branch.amplitude.names if column.endswith("y [m]"))
            branch.plot(axes, watched, factor=1e3, colour=f"C{number}")
            folds = ", ".join(f"{fold:.2f}" for fold in branch.folds) or "none"
            print(
                f"{name}, {law}: Hopf {hopf.speed:.3f} m/s, folds {folds}; {len(branch)} orbits, "
                f"{np.count_nonzero(branch.uncertain)} uncertain, "
                f"{time.perf_counter() - begun:.0f} s; {branch.reason}",
                flush=True,
            )
        for text in list(axes.texts):
            text.remove()
        axes.set_title({"s1002": "S1002 wheelset", "truck": "truck"}[name])
        axes.set_ylabel("lateral amplitude of the first wheelset [mm]")
        lines = [Line2D([], [], color=f"C{number}", label=law) for number, law in enumerate(LAWS)]
        axes.legend(handles=lines, fontsize=8, frameon=False)
    figure.savefig(Path(__file__).with_name("hunting_by_law.png"), dpi=130)


if __name__ == "__main__":
    main()
