"""Accuracy and cost of the creep laws side by side, in one run.

    python benchmarks/creep_laws.py [--json] [--figure FILE]

Accuracy: distance of the force vector to the creep curves of the program CONTACT
(tests/reference/creep_curves_ab1_nu0.28.csv), in per cent of mu N: the largest and the root mean
square of each set. Cost: time of one call from compiled code over that of Polach's law in the same
run: the laws take turns over the same states, and the least processor time of each of many turns
counts, so that what else the machine does falls out. Beside it the costs that CONTACT needs, as
measured elsewhere for one wheel on a like machine.
"""

from __future__ import annotations

import argparse
import csv
import json
import time
from pathlib import Path
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from exudyn_wheelset.creep import CREEP_LAWS, creep_force, creep_kernel, creep_parameters

REFERENCE = Path(__file__).parents[1] / "tests/reference/creep_curves_ab1_nu0.28.csv"
PATCH = {
    "a": 5.5e-3,
    "b": 5.5e-3,
    "normal_force": 80e3,
    "friction": 0.3,
    "shear_modulus": 82e9,
    "poisson": 0.28,
}
# law, parameters, label
VARIANTS: list[tuple[str, dict[str, Any], str]] = [
    ("linear", {}, "linear"),
    ("vermeulen-johnson", {}, "vermeulen-johnson"),
    ("shen-hedrick-elkins", {}, "shen-hedrick-elkins"),
    ("polach", {}, "polach"),
    ("polach", {"spin_moment": 1}, "polach, spin moment"),
    ("polach-kalker", {}, "polach-kalker"),
    ("polach-2005", {"slip_reduction": 1.0}, "polach-2005 (k_A = k_S = 1)"),
    ("fastsim", {}, "fastsim 10 x 10"),
    ("fastsim", {"flexibilities": "one"}, "fastsim 10 x 10, one L"),
    ("fastsim", {"flexibilities": "three"}, "fastsim 10 x 10, three L"),
    ("fastsim", {"cells_along": 50, "cells_across": 50}, "fastsim 50 x 50"),
    ("exact-table", {}, "exact-table"),
    ("exact", {}, "exact 40 x 40"),
]
BASE = "polach"
TURNS = 60
# states a turn: enough for the clock, few where a call takes long
TURN_SECONDS = 2e-4
# microseconds a wheel
CONTACT_COSTS = {
    "CONTACT, KPEC + FASTSIM": "330",
    "CONTACT, Hertz + FASTSIM, 10 across": "40",
    "CONTACT, full solution": "1000 to 20000",
}


def reference_curves(path: Path = REFERENCE) -> dict[str, NDArray]:
    """Give CONTACT's curves by set: columns creep_x, creep_y, spin, Fx, Fy, Mz (SI)."""
    names = ("creep_x", "creep_y", "spin_per_m", "Fx_N", "Fy_N", "Mz_Nm")
    curves: dict[str, list[list[float]]] = {}
    with path.open() as file:
        for row in csv.DictReader(file):
            curves.setdefault(row["set"], []).append([float(row[name]) for name in names])
    return {name: np.array(rows) for name, rows in curves.items()}


@njit
def _repeat(number: int, states: NDArray, parameters: NDArray, rounds: int) -> float:
    total = 0.0
    for _ in range(rounds):
        for i in range(states.shape[0]):
            force_x, force_y, moment = creep_kernel(
                number, states[i, 0], states[i, 1], states[i, 2],
                5.5e-3, 5.5e-3, 80e3, 0.3, 82e9, 0.28, parameters,
            )  # fmt: skip
            total += force_x + force_y + moment
    return total


def costs(
    laws: dict[str, tuple[str, dict[str, Any]]], states: NDArray, turns: int = TURNS
) -> dict[str, float]:
    """Give the time of one call [us] by label, mean over states, least of interleaved turns.

    laws: (name, parameters) by label. A law whose call takes more than TURN_SECONDS gets a tenth of
    the turns, one state in eleven.
    """
    runs = {}
    for label, (law, parameters) in laws.items():
        number, array = CREEP_LAWS[law].number, creep_parameters(law, **parameters)
        _repeat(number, states[:2], array, 1)
        begin = time.process_time()
        _repeat(number, states[:2], array, 1)
        one = max((time.process_time() - begin) / 2.0, 1e-8)
        slow = one > TURN_SECONDS
        used = states[::11] if slow else states
        rounds = max(1, int(TURN_SECONDS / (one * len(used))))
        runs[label] = (number, array, used, rounds, 10 if slow else 1)
    best = dict.fromkeys(laws, np.inf)
    for turn in range(turns):
        for label, (number, array, used, rounds, every) in runs.items():
            if turn % every:
                continue
            begin = time.process_time()
            _repeat(number, used, array, rounds)
            spent = 1e6 * (time.process_time() - begin) / (rounds * len(used))
            best[label] = min(best[label], spent)
    return best


def measure() -> dict[str, Any]:
    """Measure every variant; gives a dictionary that json can hold."""
    curves = reference_curves()
    limit = PATCH["friction"] * PATCH["normal_force"]
    states = np.vstack([rows[:, :3] for rows in curves.values()])
    spent = costs({label: (law, parameters) for law, parameters, label in VARIANTS}, states)
    results = []
    for law, parameters, label in VARIANTS:
        largest, mean = {}, {}
        for name, rows in curves.items():
            fx, fy, _ = creep_force(law, *rows[:, :3].T, **PATCH, **parameters)
            error = 100.0 * np.hypot(fx - rows[:, 3], fy - rows[:, 4]) / limit
            largest[name] = round(float(error.max()), 2)
            mean[name] = round(float(np.sqrt(np.mean(error**2))), 2)
        results.append(
            {
                "label": label,
                "law": law,
                "parameters": parameters,
                "cost_us": spent[label],
                "cost_ratio": spent[label] / spent[BASE],
                "largest_error": largest,
                "rms_error": mean,
            }
        )
    return {"sets": list(curves), "laws": results, "contact_cost_us": CONTACT_COSTS}


def _two_digits(value: float) -> str:
    return f"{value:.2g}" if value < 100.0 else f"{float(f'{value:.2g}'):.0f}"


def table(measured: dict[str, Any]) -> str:
    """Give the result as a Markdown table: largest error in % of mu N, cost per call."""
    sets = measured["sets"]
    lines = [
        "| law | " + " | ".join(sets) + " | us a call | times polach |",
        "|---|" + "---:|" * (len(sets) + 2),
    ]
    for result in measured["laws"]:
        errors = [result["largest_error"][name] for name in sets]
        cells = [f"{e:.1f}" if e < 100 else f"{e:.0f}" for e in errors]
        lines.append(
            f"| {result['label']} | " + " | ".join(cells)
            + f" | {_two_digits(result['cost_us'])} | {_two_digits(result['cost_ratio'])} |"
        )  # fmt: skip
    for name, microseconds in measured["contact_cost_us"].items():
        lines.append(f"| {name} (measured elsewhere) |" + " |" * len(sets) + f" {microseconds} | |")
    return "\n".join(lines)


def draw(measured: dict[str, Any], path: Path) -> None:
    """Draw the forces over creepage beside CONTACT's, and error over cost, into a file."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    curves = reference_curves()
    limit = PATCH["friction"] * PATCH["normal_force"]
    panels = [
        ("lon", 0, 3, "longitudinal creepage [-]"),
        ("spin", 2, 4, "spin [1/m]"),
        ("lat_spin_p1e-3", 1, 4, "lateral creepage [-], with spin 1 1/m"),
    ]
    shown = {
        "vermeulen-johnson": ("tab:brown", "--"),
        "shen-hedrick-elkins": ("tab:green", "--"),
        "polach": ("tab:blue", "-"),
        "fastsim": ("tab:orange", "-"),
        "exact-table": ("tab:red", "-"),
    }
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.2), layout="constrained")
    for axis, (name, over, force, label) in zip(axes.flat, panels, strict=False):
        rows = curves[name]
        grid = np.geomspace(rows[0, over], rows[-1, over], 200)
        states = np.tile(rows[0, :3], (len(grid), 1))
        states[:, over] = grid
        for law, (color, style) in shown.items():
            forces = creep_force(law, *states.T, **PATCH)
            axis.semilogx(grid, -forces[force - 3] / limit, style, color=color, label=law)
        axis.semilogx(
            rows[:, over], -rows[:, force] / limit, "ko", markersize=4, label="CONTACT, full"
        )
        axis.set_xlabel(label)
        axis.set_ylabel(f"-F{'xy'[force - 3]} / (mu N) [-]")
        axis.set_ylim(0.0, 1.05)
        axis.grid(alpha=0.3)
    axes.flat[0].legend(fontsize="small")
    last = axes.flat[3]
    for i, result in enumerate(r for r in measured["laws"] if r["law"] != "linear"):
        mean = np.sqrt(np.mean(np.square(list(result["rms_error"].values()))))
        last.loglog(result["cost_us"], mean, "osD^vPX*<>ph"[i], markersize=7, label=result["label"])
    last.axvline(40.0, color="0.5", linestyle="--")
    last.text(36.0, 0.035, "CONTACT, Hertz", rotation=90, fontsize=7, ha="right")
    last.axvline(330.0, color="0.5", linestyle="--")
    last.text(297.0, 0.035, "CONTACT, KPEC", rotation=90, fontsize=7, ha="right")
    last.set_xlim(0.02, 1e5)
    last.set_ylim(0.03, 50.0)
    last.set_xlabel("cost of a call [us]")
    last.set_ylabel("rms error of all sets [% of mu N]")
    last.grid(alpha=0.3)
    last.legend(fontsize=7, loc="upper right", framealpha=1.0)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main() -> None:
    """Measure, print the table or json, draw on request."""
    parser = argparse.ArgumentParser(description="Accuracy and cost of the creep laws.")
    parser.add_argument("--json", action="store_true", help="print json instead of the table")
    parser.add_argument("--figure", type=Path, help="draw the comparison into this file")
    arguments = parser.parse_args()
    measured = measure()
    if arguments.json:
        print(json.dumps(measured, indent=1))
    else:
        print("Largest distance to CONTACT [% of mu N] by set, and cost of a call:\n")
        print(table(measured))
    if arguments.figure:
        draw(measured, arguments.figure)


if __name__ == "__main__":
    main()
