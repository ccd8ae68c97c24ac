"""Make the figure of docs/table2.md and refresh its tables.

    python docs/figures/make_table2_figures.py

All numbers of that page come from here: Table 2 by models/table2.py, the effective conicities, the
state of the contact on the centred track, and how the rows move with each choice that the paper
leaves open.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from exudyn_wheelset import contact_geometry, creep_force, linear_critical_speed
from exudyn_wheelset.catalogue.lateral_wheelset import LateralWheelset, paper_parameters
from exudyn_wheelset.catalogue.paper_wheelset import paper_lateral_wheelset
from exudyn_wheelset.creep import kalker_coefficients
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.profiles import shapes

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "models"))
import table2  # noqa: E402

SETS = (1, 2, 3)
SPEEDS = (10.0, 300.0)


def model(code: str, spring_set: int, given: dict[str, float], **options: Any) -> LateralWheelset:
    return paper_lateral_wheelset(
        code, spring_set, parameters=paper_parameters(spring_set, **given), **options
    )


def critical(code: str, spring_set: int, given: dict[str, float], **options: Any) -> float:
    """Linear critical speed [m/s], NaN where there is none in the range searched."""
    try:
        return float(linear_critical_speed(model(code, spring_set, given, **options), *SPEEDS))
    except AnalysisError:
        return float("nan")


def tangents(vehicle: LateralWheelset) -> dict[str, float]:
    """Left contact of the centred wheelset and its tangent creep stiffnesses [N]."""
    state = {name: value[0] for name, value in vehicle.contact_state(np.zeros(4), 150.0).items()}
    given = vehicle.parameters
    patch = (state["a"], state["b"], state["normal_force"])
    material = (given.friction, given.shear_modulus, given.poisson)
    x, y, spin = state["creep_x"], state["creep_y"], state["spin"]
    h = 1.0e-6

    def force(dx: float, dy: float) -> tuple[float, float]:
        fx, fy, _ = creep_force(vehicle.creep, x + dx, y + dy, spin, *patch, *material)
        return float(fx), float(fy)

    scale = given.shear_modulus * state["a"] * state["b"]
    c11, c22, _, _ = kalker_coefficients(state["a"], state["b"], given.poisson)
    return {
        **state,
        "f_x": -(force(h, 0.0)[0] - force(-h, 0.0)[0]) / (2.0 * h),
        "f_y": -(force(0.0, h)[1] - force(0.0, -h)[1]) / (2.0 * h),
        "kalker_x": scale * c11,
        "kalker_y": scale * c22,
    }


def markdown(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] + ["---:"] * (len(head) - 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def recomputed() -> str:
    numbers = table2.run()
    rows = []
    for name in table2.ROWS:
        cells = [f"`{name}`"]
        for k in range(3):
            cell = f"{numbers[name][k]:.1f}"
            if name in table2.PUBLISHED:
                known = table2.PUBLISHED[name][k]
                cell += f" ({known:.1f}, {100.0 * (numbers[name][k] / known - 1.0):+.1f} %)"
            cells.append(cell)
        rows.append(cells)
    return markdown(["row", "set 1", "set 2", "set 3"], rows)


def conicities() -> str:
    """Slope of the rolling-radius difference beside the formula of a cone on round rail heads."""
    rows = [["`mohan`", "0.7160", "-", "0.05000", "0.05000", "0"]]
    for code, head in (("idealized", 1.0e-3), ("profiled", 0.3)):
        vehicle = model(code, 1, {})
        y = np.array([-1.0e-4, 0.0, 1.0e-4])
        geometry = contact_geometry(vehicle.wheelset, vehicle.track, y)
        slope = np.ptp(geometry.rolling_radius_difference) / np.ptp(y) / 2.0
        half = vehicle.wheelset.tape_half_distance + geometry.left.wheel_y[1]
        d, r0 = vehicle.parameters.conicity, vehicle.parameters.radius
        formula = d * (half + head * d) / (half - r0 * d)
        rows.append(
            [
                f"`{code}`",
                f"{half:.4f}",
                f"{head:g}",
                f"{formula:.5f}",
                f"{slope:.5f}",
                f"{100.0 * (slope / d - 1.0):+.1f} %",
            ]
        )
    head = ["code", "g_a [m]", "R [m]", "formula", "from the contact geometry", "against d"]
    return markdown(head, rows)


def operating() -> str:
    rows = []
    for name, code, options in (
        ("`idealized`", "idealized", {}),
        ("`profiled`, spin V/r0", "profiled", {}),
        ("`profiled`, free spin", "profiled", {"free_spin": True}),
    ):
        vehicle = model(code, 3, {}, **options)
        at = tangents(vehicle)
        rows.append(
            [
                name,
                f"{1e3 * (at['radius'] - vehicle.parameters.radius):+.3f}",
                f"{1e4 * at['creep_x']:+.2f}",
                f"{at['fx'] / 1e3:.2f}",
                f"{at['kalker_x'] / 1e6:.2f}",
                f"{at['kalker_y'] / 1e6:.2f}",
                f"{at['f_x'] / 1e6:.2f}",
                f"{at['f_y'] / 1e6:.2f}",
            ]
        )
    head = [
        "row",
        "r - r0 [mm]",
        "xi_x [1e-4]",
        "F_x a wheel [kN]",
        "Kalker f_x [MN]",
        "Kalker f_y [MN]",
        "tangent f_x [MN]",
        "tangent f_y [MN]",
    ]
    return markdown(head, rows)


def causes() -> str:
    rows = []
    for name, options in (
        ("Polach's law, all terms", {}),
        ("linear law (no saturation)", {"creep": "linear"}),
        ("Polach's law, no gyroscopic terms", {"gyroscopic": False}),
        ("linear law, no gyroscopic terms", {"creep": "linear", "gyroscopic": False}),
    ):
        held, free = (critical("profiled", 3, {}, **options, free_spin=f) for f in (False, True))
        rows.append([name, f"{held:.1f}", f"{free:.1f}", f"{held - free:+.1f}"])
    return markdown(["set 3, `profiled`", "spin V/r0", "free spin", "difference"], rows)


def profiled_choices() -> str:
    inch = shapes.INCH
    wide = {"flange_thickness": 1.375 * inch, "tape_from_flange_back": 3.0625 * inch}
    cases: list[tuple[str, dict[str, float], dict[str, Any]]] = [
        ("**as chosen**", {}, {}),
        ("inclination 1:20", {}, {"inclination": 1.0 / 20.0}),
        ("inclination 0", {}, {"inclination": 0.0}),
        ("gauge 1435 mm", {}, {"gauge": 1.435}),
        ("tape circles at 740 mm", {}, {"tape_half_distance": 0.740}),
        ("tape circles at 745 mm", {}, {"tape_half_distance": 0.745}),
        ("tape circles at 755 mm", {}, {"tape_half_distance": 0.755}),
        ("friction 0.2", {"friction": 0.2}, {}),
        ("friction 0.5", {"friction": 0.5}, {}),
        ("axle load 60 kN", {"axle_load": 60e3}, {}),
        ("axle load 100 kN", {"axle_load": 100e3}, {}),
        ("axle load 190 kN", {"axle_load": 190e3}, {}),
        ("yaw inertia 640 kg m^2", {"yaw_inertia": 640.0}, {}),
        ("flange angle 68 degrees", {}, {"wheel": shapes.aar_1_20(flange_angle=np.radians(68.0))}),
        ("throat radius 9/16 in", {}, {"wheel": shapes.aar_1_20(throat_radius=9 / 16 * inch)}),
        ("throat radius 13/16 in", {}, {"wheel": shapes.aar_1_20(throat_radius=13 / 16 * inch)}),
        ("wide flange", {}, {"wheel": shapes.aar_1_20(**wide)}),
        ("no gyroscopic terms", {}, {"gyroscopic": False}),
        ("no inertial terms in (3), (4)", {}, {"inertial": False}),
        ("creep: linear", {}, {"creep": "linear"}),
        ("creep: vermeulen-johnson", {}, {"creep": "vermeulen-johnson"}),
        ("creep: shen-hedrick-elkins", {}, {"creep": "shen-hedrick-elkins"}),
        ("creep: fastsim, three L", {}, {"creep": "fastsim", "flexibilities": 3}),
    ]
    rows = []
    for name, given, options in cases:
        vehicle = model("profiled", 3, given, **options)
        creep = vehicle.contact_state(np.zeros(4), 150.0)["creep_x"][0]
        speeds = [critical("profiled", k, given, **options) for k in SETS]
        free = critical("profiled", 3, given, free_spin=True, **options)
        cells = [f"{speed:.1f}" for speed in (*speeds, free)]
        rows.append([name, f"{1e4 * creep:+.1f}", *cells])
    head = ["choice", "xi_x [1e-4]", "set 1", "set 2", "set 3", "set 3, free spin"]
    return markdown(head, rows)


def knife_edge_choices() -> str:
    cases: list[tuple[str, dict[str, float], dict[str, Any]]] = [
        ("**as chosen**", {}, {}),
        ("axle load 60 kN", {"axle_load": 60e3}, {}),
        ("axle load 190 kN", {"axle_load": 190e3}, {}),
        ("friction 0.2", {"friction": 0.2}, {}),
        ("friction 0.5", {"friction": 0.5}, {}),
        ("rail head radius 0.08 m", {"rail_head_radius": 0.08}, {}),
        ("rail head radius 1 m", {"rail_head_radius": 1.0}, {}),
        ("yaw inertia 640 kg m^2", {"yaw_inertia": 640.0}, {}),
        ("no gyroscopic terms", {}, {"gyroscopic": False}),
    ]
    rows = []
    for name, given, options in cases:
        cells = [
            " / ".join(f"{critical(code, k, given, **options):.1f}" for k in SETS)
            for code in ("mohan", "idealized")
        ]
        rows.append([name, *cells])
    same = " / ".join(f"{critical('idealized', k, {}, inertial=False):.1f}" for k in SETS)
    rows.append(["no inertial terms in (3), (4)", "has none", same])
    return markdown(["choice", "`mohan`, sets 1 / 2 / 3", "`idealized`, sets 1 / 2 / 3"], rows)


def draw(path: Path) -> None:
    """Critical speed over the radius the wheels roll on; tangent stiffness over the creepage."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.0, 4.2), layout="constrained")
    places = np.linspace(0.740, 0.754, 29)
    offset, held, free = [], [], []
    for place in places:
        vehicle = model("profiled", 3, {}, tape_half_distance=float(place))
        state = vehicle.contact_state(np.zeros(4), 150.0)
        offset.append(1e3 * (state["radius"][0] - vehicle.parameters.radius))
        for speeds, is_free in ((held, False), (free, True)):
            options = {"tape_half_distance": float(place), "free_spin": is_free}
            speeds.append(critical("profiled", 3, {}, **options))
    left.plot(offset, held, ".-", color="tab:blue", label="spin held at V/r0")
    left.plot(offset, free, ".-", color="tab:orange", label="free spin")
    left.axhline(187.8, color="0.4", linewidth=0.9, linestyle="--")
    left.text(max(offset), 187.8, "paper, profiled", ha="right", va="bottom", fontsize=8)
    left.axhline(210.0, color="0.4", linewidth=0.9, linestyle=":")
    left.text(max(offset), 208.6, "paper, idealized", ha="right", va="top", fontsize=8)
    left.axvline(0.0, color="0.8", linewidth=0.8)
    left.set_xlabel("rolling radius of the centred wheelset minus r0 [mm]")
    left.set_ylabel("linear critical speed, set 3 [m/s]")
    left.legend()
    left.grid(alpha=0.3)

    state = tangents(model("profiled", 3, {}, free_spin=True))
    given = paper_parameters(3)
    arguments = (state["a"], state["b"], state["normal_force"])
    arguments += (given.friction, given.shear_modulus, given.poisson)
    creep = np.linspace(0.0, 4.0e-3, 201)
    h = 1.0e-6

    def slope(dx: float, dy: float, component: int) -> np.ndarray:
        ends = [
            creep_force("polach", creep + sign * dx, sign * dy, state["spin"], *arguments)
            for sign in (1.0, -1.0)
        ]
        return -(ends[0][component] - ends[1][component]) / (2.0 * h) / 1e6

    right.plot(1e3 * creep, slope(h, 0.0, 0), color="tab:blue", label="longitudinal, f_x")
    right.plot(1e3 * creep, slope(0.0, h, 1), color="tab:green", label="lateral, f_y")
    held_creep = abs(tangents(model("profiled", 3, {}))["creep_x"])
    right.axvline(1e3 * held_creep, color="0.4", linewidth=0.9, linestyle="--")
    right.text(1e3 * held_creep, 0.4, " spin V/r0, as chosen", fontsize=8)
    right.set_xlabel("constant longitudinal creepage [1e-3]")
    right.set_ylabel("tangent creep stiffness, Polach [MN]")
    right.set_ylim(bottom=0.0)
    right.legend()
    right.grid(alpha=0.3)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main() -> None:
    """Write the figure beside this script and the tables into docs/table2.md."""
    page = HERE.parent / "table2.md"
    text = page.read_text(encoding="utf-8")
    for make in (recomputed, conicities, operating, causes, profiled_choices, knife_edge_choices):
        name = make.__name__
        block = f"<!-- {name} -->\n{make()}\n<!-- end of {name} -->"
        print(block, flush=True)
        pattern = rf"<!-- {name} -->.*?<!-- end of {name} -->"
        text = re.sub(pattern, lambda _, block=block: block, text, flags=re.S)
    page.write_text(text, encoding="utf-8")
    draw(HERE / "table2_spin.png")


if __name__ == "__main__":
    main()
