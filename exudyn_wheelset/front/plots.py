"""What all figures of the package share: size, colours, a pale grid; drawn without a display.

Every function that draws takes axes and SI arguments; the axes show millimetres, milliradians,
degrees, kilonewtons and hertz, and say so. pyplot's global state is left alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_wheelset.contact.descriptions import Track, Wheelset

LEFT_COLOUR, RIGHT_COLOUR = "#1f6fb4", "#d1495b"
WHEEL_COLOUR, RAIL_COLOUR, GREY = "#3b4252", "#8a6d3b", "#8a8f98"


def new_figure(
    width: float, height: float, rows: int = 1, columns: int = 1, **options: Any
) -> tuple[Figure, np.ndarray]:
    """Return a figure of width x height [inch] and its axes (rows, columns)."""
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, **options)
    for panel in axes.flat:
        tidy(panel)
    return figure, axes


def tidy(axes: Axes) -> None:
    """Pale grid, no box."""
    axes.grid(alpha=0.25, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def pair_name(wheelset: Wheelset, track: Track) -> str:
    """What stands on what."""
    return f"{wheelset.wheel.name} on {track.rail.name}"
