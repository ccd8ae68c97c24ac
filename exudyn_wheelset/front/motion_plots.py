"""Simulated motions drawn: one wheelset in full, several bodies beside each other.

Axes in s, mm, mrad and kN.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_wheelset.front.plots import (
    GREY,
    LEFT_COLOUR,
    RIGHT_COLOUR,
    WHEEL_COLOUR,
    new_figure,
)
from exudyn_wheelset.results.motion import Motion


def released_figure(
    motions: Sequence[Motion], rows: Sequence[Mapping[str, Any]], wheelset: str, title: str
) -> Figure:
    """A wheelset's motions, forces and contact positions, one column for each speed.

    rows: numbers of `compare_growth`; a motion that ended before its time says how.
    """
    figure, axes = new_figure(5.6 * len(motions), 10.5, 5, len(motions), sharex="col", sharey=False)
    for column, motion, row in zip(axes.T, motions, rows, strict=True):
        draw_wheelset_motion(column, motion, wheelset, complex(row["growth_rate_eigenvalue"]))
        column[0].set_title(growth_title(row), fontsize=10)
        if row["event"]:
            column[0].axvline(motion.time[-1], color="black", linewidth=1.0)
            words = motion.outcome.ending.sentence
            at: dict[str, Any] = {"xycoords": ("data", "axes fraction"), "ha": "right", "va": "top"}
            column[0].annotate(words, (motion.time[-1], 0.97), fontsize=7, rotation=90, **at)
    figure.suptitle(title, fontsize=11)
    return figure


def draw_lateral(
    axes: Axes, motion: Motion, bodies: Sequence[str] | Mapping[str, str], title: str = ""
) -> None:
    """Lateral displacements of bodies over time; as a mapping, with labels of their own.

    title: default speed and ending.
    """
    labels = bodies if isinstance(bodies, Mapping) else {name: name for name in bodies}
    colours = (LEFT_COLOUR, RIGHT_COLOUR, WHEEL_COLOUR)
    last = 0.0
    for index, (name, label) in enumerate(labels.items()):
        y = motion[f"{name}: y"]
        colour = colours[index] if len(labels) <= len(colours) else None
        axes.plot(motion.time, 1e3 * y, color=colour, linewidth=1.0, label=label)
        last = max(last, float(np.argmax(np.abs(y))))
    axes.set_title(title or f"{motion.speed:.2f} m/s: {motion.outcome}", fontsize=10)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("y [mm]")
    axes.margins(y=0.2)
    corner: Any = "upper left" if last > 0.5 * len(motion) else "upper right"
    axes.legend(fontsize=8, frameon=False, loc=corner)


def growth_title(row: Mapping[str, Any]) -> str:
    """Speed, growth of the eigenvalue and, where it could be measured, of the simulated motion."""
    measured = row["growth_rate_simulated"]
    return f"{row['speed']:.2f} m/s: growth {row['growth_rate_eigenvalue']:+.3f} 1/s" + (
        "" if measured is None else f", simulated {measured:+.3f} 1/s"
    )


def draw_wheelset_motion(
    axes: Sequence[Axes], motion: Motion, wheelset: str, root: complex | None = None
) -> None:
    """Lateral motion, yaw, normal forces, creep forces and contact positions into five axes.

    wheelset: its name in the motion. root [1/s]: draws the envelope that the eigenvalue gives.
    """
    t, y = motion.time, motion[f"{wheelset}: y"]
    lateral, yaw, normal, creep, place = axes
    grows = np.argmax(np.abs(y)) > len(t) // 2
    corner: Any = "upper left" if grows else "upper right"
    lateral.plot(t, y * 1e3, color=WHEEL_COLOUR, linewidth=1.2)
    if root is not None:
        envelope = abs(y[0]) * np.exp(root.real * t)
        envelope = np.where(envelope < 1.15 * np.abs(y).max(), envelope, np.nan) * 1e3
        style: dict[str, Any] = {"color": GREY, "linewidth": 1.0, "linestyle": "--"}
        lateral.plot(t, envelope, label="growth of the eigenvalue", **style)
        lateral.plot(t, -envelope, **style)
        lateral.legend(fontsize=8, frameon=False, loc=corner)
    lateral.set_ylabel("y [mm]")
    yaw.plot(t, motion[f"{wheelset}: yaw"] * 1e3, color=WHEEL_COLOUR, linewidth=1.2)
    yaw.set_ylabel("yaw [mrad]")
    for side, colour in (("left", LEFT_COLOUR), ("right", RIGHT_COLOUR)):
        wheel = motion.wheel(wheelset, side)
        own: dict[str, Any] = {"color": colour, "linewidth": 1.0}
        normal.plot(t, wheel["normal_force [N]"] / 1e3, label=side, **own)
        creep.plot(t, wheel["fx [N]"] / 1e3, label=f"{side} Fx", **own)
        creep.plot(t, wheel["fy [N]"] / 1e3, linestyle=":", label=f"{side} Fy", **own)
        place.plot(t, wheel["wheel_y [m]"] * 1e3, label=side, **own)
    normal.set_ylabel("normal force [kN]")
    creep.set_ylabel("creep force [kN]")
    place.set_ylabel("contact on wheel [mm]")
    place.set_xlabel("time [s]")
    for panel in (normal, creep, place):
        panel.margins(y=0.3)
        panel.legend(fontsize=7, frameon=False, ncols=2, loc=corner)
