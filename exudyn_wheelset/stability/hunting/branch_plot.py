"""A branch of limit cycles drawn: half of peak to peak over speed.

Stable cycles are solid, unstable ones dashed, those whose stability is uncertain dash-dotted in
a lighter line with an entry of their own in the legend; a dot marks the Hopf point, squares mark
folds, triangles other changes of stability, each with its speed beside it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from exudyn_wheelset.stability.hunting.branch import Branch

# Marks nearer than this share of the drawn branch share a note, as in a branch of impacts.
_NOTE_DISTANCE = 0.08
UNCERTAIN = "stability uncertain"
_STYLES: dict[bool | None, dict[str, Any]] = {
    True: {"linestyle": "-", "linewidth": 1.6},
    False: {"linestyle": "--", "linewidth": 1.6},
    None: {"linestyle": "-.", "linewidth": 1.6, "alpha": 0.6},
}


def draw_branch(
    axes: Axes,
    branch: Branch,
    name: str,
    factor: float = 1.0,
    colour: str = "C0",
    label: str | None = None,
    notes: bool = True,
) -> None:
    """Draw the amplitude `name` of a branch times `factor` over speed [m/s] into axes.

    notes: write the speeds of Hopf point, folds and changes of stability beside their marks.
    """
    speed, values = branch.speed, factor * branch.amplitude[name]
    steady = [branch.stability_after(index) for index in range(len(branch) - 1)]
    if branch.hopf is not None:
        speed, values = np.append(branch.hopf[0], speed), np.append(0.0, values)
        steady.insert(0, branch.stability[0])
    first = 0
    for index in range(1, len(steady) + 1):
        if index < len(steady) and steady[index] == steady[first]:
            continue
        piece = slice(first, index + 1)
        axes.plot(speed[piece], values[piece], color=colour, **_STYLES[steady[first]])
        first = index
    if label is not None:
        axes.plot([], [], "-", color=colour, label=label)
    if None in steady and UNCERTAIN not in axes.get_legend_handles_labels()[1]:
        axes.plot([], [], color="0.4", label=UNCERTAIN, **_STYLES[None])
    marks: list[tuple[str, float, float, dict[str, Any], bool]] = []
    if branch.hopf is not None:
        marks.append(("Hopf", branch.hopf[0], 0.0, {"marker": "o", "clip_on": False}, False))
    for fold in branch.folds:
        height = factor * branch.amplitude[name][fold.index]
        square = {"marker": "s", "markersize": 5}
        marks.append(("fold", fold.speed, height, square, fold.side == "lowest"))
    for change in branch.changes:
        height = factor * branch.amplitude[name][change.index]
        triangle = {"marker": "^", "fillstyle": "none"}
        marks.append((change.kind, change.speed, height, triangle, False))
    noted: list[tuple[float, float]] = []
    reach, rise = np.ptp(speed) + 1e-9, np.ptp(values) + 1e-9
    for what, at, height, style_of_mark, leftwards in marks:
        axes.plot(at, height, color=colour, linestyle="none", zorder=6, **style_of_mark)
        apart = (abs(at - v) / reach + abs(height - a) / rise > _NOTE_DISTANCE for v, a in noted)
        if notes and all(apart):
            noted.append((at, height))
            # Notes of changes below the branch, where those of folds do not stand.
            above = {"Hopf": 4, "fold": 0 if leftwards else 4}.get(what, -12)
            where = -7 if leftwards else 7, above
            _note(axes, f"{what} {at:.2f} m/s", (at, height), where, colour)


def _note(
    axes: Axes, text: str, place: tuple[float, float], beside: tuple[int, int], colour: str
) -> None:
    axes.annotate(
        text,
        place,
        xytext=beside,
        textcoords="offset points",
        horizontalalignment="right" if beside[0] < 0 else "left",
        fontsize=8,
        color=colour,
    )
