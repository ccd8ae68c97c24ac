"""Make the figure of docs/which-creep-law.md and refresh its tables.

    python docs/figures/make_creep_choice.py

Every law beside `exact`: its force over creepage, spin and shape of the patch; its slopes at zero
creepage over spin; the time of a call; the linear critical speeds it gives to five vehicles. Takes
some minutes.
"""

from __future__ import annotations

import re
import sys
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from exudyn_wheelset import AnalysisError, WheelsetWarning, linear_critical_speed
from exudyn_wheelset.catalogue.by_name import vehicle
from exudyn_wheelset.contact.descriptions import Contact
from exudyn_wheelset.creep import CREEP_LAWS, creep_force, creep_law, kalker_coefficients
from exudyn_wheelset.creep.slopes import CreepPatch, creep_slopes

HERE = Path(__file__).parent
PAGE = HERE.parent / "which-creep-law.md"
sys.path.insert(0, str(HERE.parents[1] / "benchmarks"))
import creep_laws  # noqa: E402

EXACT = "exact"
# law, its parameters, label, colour, line
LAWS: list[tuple[str, dict[str, Any], str, str, str]] = [
    ("linear", {}, "linear", "0.6", ":"),
    ("vermeulen-johnson", {}, "vermeulen-johnson", "tab:brown", "-."),
    ("shen-hedrick-elkins", {}, "shen-hedrick-elkins", "tab:green", "-"),
    ("polach", {}, "polach", "tab:blue", "--"),
    ("polach-kalker", {}, "polach-kalker", "tab:blue", "-"),
    ("fastsim", {"flexibilities": "one"}, "fastsim, one L", "tab:orange", "--"),
    ("fastsim", {}, "fastsim, blended", "tab:orange", "-"),
    ("exact-table", {}, "exact-table", "tab:red", "-"),
]
LAWS = [law for law in LAWS if law[0] in CREEP_LAWS]
STEEL = {"friction": 0.3, "shear_modulus": 82e9, "poisson": 0.28}
SHAPES = (0.2, 0.5, 1.0, 2.0, 5.0)
SPINS = (0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0)
CREEPS = (0.1, 0.3, 0.6, 1.0, 1.5, 2.5)
DIRECTIONS = ((1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (0.7, 0.7), (0.7, -0.7))
# 12.1 mm across, 4.3 mm along: a wheel of the truck on the inner edge of the rail's top
TRUCKS_SHAPE = 4.3 / 12.1
SPIN_GRID = np.linspace(0.0, 2.0, 21)
VEHICLES = {
    "paper-1": "AAR wheelset",
    "s1002": "S1002 wheelset",
    "truck": "truck",
    "three_axle_truck": "three-axle truck",
    "cooperrider_bogie_3d": "bogie",
}
SEARCHED = {
    "paper-1": (20.0, 80.0),
    "s1002": (20.0, 120.0),
    "truck": (20.0, 150.0),
    "three_axle_truck": (20.0, 180.0),
    "cooperrider_bogie_3d": (20.0, 120.0),
}
POINTS = 60


def patch(a_over_b: float) -> dict[str, float]:
    """A patch of 36 square millimetres' product of axes under a peak pressure of 1 GPa."""
    a = 6e-3 * np.sqrt(a_over_b)
    b = 6e-3 / np.sqrt(a_over_b)
    return {"a": a, "b": b, "normal_force": 2.0 / 3.0 * np.pi * a * b * 1e9, **STEEL}


def saturations(state: dict[str, float]) -> tuple[float, float, float]:
    """Creepages along and across and spin that saturate the patch by the linear theory."""
    a, b = state["a"], state["b"]
    c11, c22, c23, _ = kalker_coefficients(a, b, state["poisson"])
    unit = state["friction"] * state["normal_force"] / (state["shear_modulus"] * a * b)
    return unit / c11, unit / c22, unit / (np.sqrt(a * b) * c23)


def force_errors() -> dict[str, np.ndarray]:
    """Distance from the exact force over mu N by law: (spins, states)."""
    errors: dict[str, list[np.ndarray]] = {label: [] for _, _, label, *_ in LAWS}
    for spin in SPINS:
        rows: dict[str, list[np.ndarray]] = {label: [] for label in errors}
        for shape in SHAPES:
            state = patch(shape)
            along, across, turn = saturations(state)
            pull = np.array(
                [[u * x * along, u * y * across] for u in CREEPS for x, y in DIRECTIONS]
            )
            where = {"creep_x": pull[:, 0], "creep_y": pull[:, 1], "spin": spin * turn, **state}
            exact = creep_force(EXACT, **where)
            limit = state["friction"] * state["normal_force"]
            for law, parameters, label, *_ in LAWS:
                force = creep_force(law, **where, **parameters)
                rows[label].append(np.hypot(force[0] - exact[0], force[1] - exact[1]) / limit)
        for label in errors:
            errors[label].append(np.concatenate(rows[label]))
    return {label: np.array(rows) for label, rows in errors.items()}


def slopes(shape: float) -> dict[str, np.ndarray]:
    """Slopes over Kalker's at zero creepage (spins, 2) by law, exact included."""
    state = patch(shape)
    turn = saturations(state)[2]
    patches = [CreepPatch(creep_law(EXACT), 0.0, 0.0, spin * turn, **state) for spin in SPIN_GRID]
    kalker = creep_slopes(patches, "linear")
    found = {EXACT: creep_slopes(patches) / kalker}
    for law, parameters, label, *_ in LAWS:
        found[label] = creep_slopes(patches, law, **parameters) / kalker
    return found


def critical_speed(name: str, law: str, parameters: dict[str, Any], guess: Any = None) -> Any:
    """Linear critical speed of a vehicle of the catalogue with a law; None if it has none."""
    described = vehicle(name)
    contact: Any
    if isinstance(described.contact, Contact):
        contact = replace(described.contact, creep=law, law_parameters=parameters)
    else:
        contact = {**described.contact, "creep": law, **parameters}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", WheelsetWarning)
        try:
            return linear_critical_speed(
                replace(described, contact=contact), *SEARCHED[name], guess=guess, points=POINTS
            )
        except AnalysisError:
            return None


def critical_speeds() -> dict[str, dict[str, Any]]:
    """Critical points by vehicle and law; the exact law's by a secant from the nearest law's."""
    found: dict[str, dict[str, Any]] = {}
    for name in VEHICLES:
        found[name] = {
            label: critical_speed(name, law, parameters) for law, parameters, label, *_ in LAWS
        }
        near = found[name].get("exact-table") or found[name]["fastsim, blended"]
        found[name][EXACT] = critical_speed(name, EXACT, {}, guess=near)
    return found


def costs() -> dict[str, float]:
    """Time of one call over that of `polach` by law, mean over creepages and spins on a patch."""
    states = np.vstack([rows[:, :3] for rows in creep_laws.reference_curves().values()])
    laws = {label: (law, parameters) for law, parameters, label, *_ in LAWS}
    measured = creep_laws.costs({**laws, EXACT: (EXACT, {})}, states)
    return {label: spent / measured[creep_laws.BASE] for label, spent in measured.items()}


def draw(path: Path, errors: dict, steep: dict, points: dict, spent: dict[str, float]) -> None:
    """Error and slopes over spin, critical speeds, cost, in four panels."""
    figure, axes = plt.subplots(2, 2, figsize=(12, 8.4), layout="constrained")
    styles = {label: {"color": colour, "linestyle": line} for _, _, label, colour, line in LAWS}
    for label, style in styles.items():
        rms = 100.0 * np.sqrt(np.mean(errors[label] ** 2, axis=1))
        axes[0, 0].semilogy(SPINS, rms, label=label, **style)
    axes[0, 0].set(
        xlabel="spin over that of saturation [-]",
        ylabel="distance from the exact force, rms [% of $\\mu N$]",
        title="Force: five shapes of patch, creepage 0.1 to 2.5 of saturation",
        ylim=(0.003, 200.0),
    )
    for axis, column, name in ((axes[0, 1], 0, "x"), (axes[1, 0], 1, "y")):
        for label, style in styles.items():
            axis.plot(SPIN_GRID, steep[label][:, column], **style)
        axis.plot(SPIN_GRID[::2], steep[EXACT][::2, column], "k.", markersize=8, label="exact")
        axis.set(
            xlabel="spin over that of saturation [-]",
            ylabel=f"$-\\partial F_{name}/\\partial\\xi_{name}$ over Kalker's [-]",
            title=f"Slope along {name} at zero creepage, a/b = {TRUCKS_SHAPE:.2f} (truck)",
            ylim=(0.0, 1.15),
        )
        axis.legend(loc="lower left", fontsize="small")
    rows = [*reversed(styles), EXACT]
    for place, name in enumerate(VEHICLES):
        exact = points[name][EXACT]
        for label in rows:
            point = points[name][label]
            if point is None or exact is None:
                continue
            colour = styles.get(label, {"color": "black"})["color"]
            hollow = styles.get(label, {}).get("linestyle") not in ("-", None)
            axes[1, 1].plot(
                100.0 * (point / exact - 1.0),
                place + 0.07 * (rows.index(label) - len(rows) / 2),
                "o",
                color=colour,
                markerfacecolor="none" if hollow else colour,
            )
    axes[1, 1].axvline(0.0, color="black", linewidth=0.8)
    axes[1, 1].set_yticks(
        range(len(VEHICLES)),
        [f"{label}\n{points[name][EXACT]:.1f} m/s" for name, label in VEHICLES.items()],
    )
    axes[1, 1].set(
        xlabel="linear critical speed beside the exact law's [%]",
        title="Critical speeds (colours as above, hollow where dashed)",
    )
    axes[0, 0].legend(
        [f"{label} (cost {spent[label]:.2g})" for label in styles],
        fontsize="small",
        loc="lower center",
        ncols=2,
    )
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def table(errors: dict, steep: dict, points: dict, spent: dict[str, float]) -> str:
    """The same as a Markdown table, one law a row."""
    within = [k for k, spin in enumerate(SPIN_GRID) if spin <= 0.5]
    lines = [
        "| law | force, rms | largest | slope x | slope y | cost | "
        + " | ".join(VEHICLES.values())
        + " |",
        "|---|" + "---:|" * (5 + len(VEHICLES)),
    ]

    def speed(point: Any) -> str:
        return "none" if point is None else f"{point:.2f}"

    for label in [*(label for _, _, label, *_ in LAWS), EXACT]:
        cells = [f"`{label}`" if label in CREEP_LAWS else label]
        if label == EXACT:
            cells += ["0", "0", "", ""]
        else:
            cells += [
                f"{100.0 * np.sqrt(np.mean(errors[label] ** 2)):.1f}",
                f"{100.0 * errors[label].max():.1f}",
            ]
            for column in (0, 1):
                ratio = 100.0 * (steep[label][within] / steep[EXACT][within] - 1.0)[:, column]
                cells.append(f"{ratio.min():+.0f} to {ratio.max():+.0f}")
        cells.append(f"{spent[label]:.2g}" if spent[label] < 1e3 else f"{spent[label]:.0e}")
        cells += [speed(points[name][label]) for name in VEHICLES]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main() -> None:
    """Write the figure beside this script and the table into docs/which-creep-law.md."""
    errors, steep, points, spent = force_errors(), slopes(TRUCKS_SHAPE), critical_speeds(), costs()
    draw(HERE / "creep_choice.png", errors, steep, points, spent)
    text = PAGE.read_text(encoding="utf-8")
    made = f"<!-- table -->\n{table(errors, steep, points, spent)}\n<!-- end of table -->"
    PAGE.write_text(
        re.sub(r"<!-- table -->.*<!-- end of table -->", lambda _: made, text, flags=re.S),
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()
