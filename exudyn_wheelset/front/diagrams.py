"""Bifurcation diagrams on a figure: branches, descents and disturbance runs over speed.

Displacements in m are drawn in mm, those in rad in mrad.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.tables import print_rows
from exudyn_wheelset.stability.hunting.branch_plot import draw_branch
from exudyn_wheelset.stability.hunting.diagram import Diagram

# Unit in which a displacement is drawn, by the unit in its name.
DRAWN = {"m": ("mm", 1e3), "rad": ("mrad", 1e3)}


def diagram_figure(diagram: Diagram, title: str) -> Figure:
    """The diagram on a figure of its own; below it, how the first branch ends."""
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
    return figure


def draw_diagram(
    axes: Axes,
    diagram: Diagram,
    colours: Sequence[str] = (),
    labels: Sequence[str] = (),
    notes: bool = True,
) -> None:
    """Draw amplitudes over speed; colours and labels of the branches, in their order.

    notes: write speeds beside Hopf points and folds, and say what the line styles are.
    """
    name = diagram.watched
    unit, factor = DRAWN.get(name.rpartition("[")[2].rstrip("]"), (None, 1.0))
    for index, branch in enumerate(diagram.branches):
        colour = colours[index] if index < len(colours) else f"C{index}"
        label = labels[index] if index < len(labels) else None
        draw_branch(axes, branch, name, factor, colour, label, notes)
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
        what = runs.direction.split(" [")[0]
        axes.plot(
            runs.speeds,
            factor * runs.edge,
            "x",
            color="C3",
            label=f"disturbance runs, {what}: where motions part",
            zorder=5,
        )
    axes.set_ylim(bottom=0.0)
    # Room for the notes beside lowest folds.
    left, right = axes.get_xlim()
    axes.set_xlim(left - 0.12 * (right - left), right)
    axes.set_xlabel("forward speed [m/s]")
    what = name.split(" [")[0]
    axes.set_ylabel(f"{what}, half of peak to peak" + (f" [{unit}]" if unit else ""))
    axes.legend(fontsize=8, frameon=False)


def print_diagram(numbers: dict[str, Any]) -> None:
    """Print the numbers of a diagram: of `diagram_numbers`, and of descent and disturbance runs."""

    def speeds(values: Sequence[float]) -> str:
        return ", ".join(f"{value:.3f}" for value in values) or "none"

    rows = [("reason", numbers["reason"])]
    if "hopf" in numbers:
        lowest = numbers["nonlinear_critical_speed"]
        rows = [
            ("linear critical speeds (Hopf) [m/s]", speeds(numbers["hopf"])),
            ("folds of the branch [m/s]", speeds(numbers["folds"])),
            ("nonlinear critical speed [m/s]", "none" if lowest is None else f"{lowest:.3f}"),
            ("method", f"{numbers['method']}, {numbers['points']} orbits"),
            ("the branch ends because", numbers["reason"]),
        ]
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
    print_rows(rows, 38)
