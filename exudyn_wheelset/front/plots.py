"""Figures of the model scripts, drawn without a display and without pyplot's global state.

Every function draws into axes it is given. Arguments are SI; the axes show millimetres,
milliradians, degrees, kilonewtons and hertz, and say so.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.geometry.piecewise import COLUMNS, PiecewiseGeometry, geometry_columns
from exudyn_wheelset.geometry.rigid import ContactGeometry
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.stability.linear.linearisation import RootLocus

LEFT_COLOUR, RIGHT_COLOUR = "#1f6fb4", "#d1495b"
WHEEL_COLOUR, RAIL_COLOUR, GREY = "#3b4252", "#8a6d3b", "#8a8f98"
_PANELS = (
    ("roll angle [mrad]", 1e3, ("roll",)),
    ("vertical displacement [mm]", 1e3, ("z",)),
    ("contact angle [deg]", 180.0 / np.pi, ("left_angle", "right_angle")),
    ("rolling radius [mm]", 1e3, ("left_radius", "right_radius")),
)
# A second contact this close to touching [m] is drawn as a hollow mark.
_NEARLY_TOUCHING = 2.0e-5


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
    axes.spines[["top", "right"]].set_visible(False)


def draw_contact_geometry(
    axes: np.ndarray, geometry: ContactGeometry, pieces: PiecewiseGeometry
) -> None:
    """Figure 3 of the paper into four axes: exact contact (broad) under its polynomials (thin)."""
    values = geometry_columns(geometry)
    y = geometry.y
    ends = [y[0], *pieces.jumps, y[-1]]
    for panel, (label, factor, names) in zip(np.ravel(axes), _PANELS, strict=True):
        for name in names:
            colour = RIGHT_COLOUR if name.startswith("right") else LEFT_COLOUR
            column = COLUMNS.index(name)
            for low, high in pairwise(ends):
                inside = (y > low) & (y < high)
                if len(names) == 1:
                    inside |= (y == low) | (y == high)
                shown = name.split("_")[0] if len(names) > 1 else "contact search"
                first = low == ends[0]
                panel.plot(
                    y[inside] * 1e3,
                    values[inside, column] * factor,
                    color=colour,
                    alpha=0.35,
                    linewidth=5.0,
                    solid_capstyle="round",
                    label=shown if first else None,
                )
                margin = 1e-9 * (high - low)
                fine = np.linspace(low + margin, high - margin, 200)
                panel.plot(
                    fine * 1e3,
                    pieces(fine)[:, column] * factor,
                    color="black",
                    linewidth=0.9,
                    label="polynomials" if first and name == names[-1] else None,
                )
        for jump in pieces.jumps:
            panel.axvline(jump * 1e3, color=GREY, linewidth=0.8, linestyle=":")
        panel.set_ylabel(label)
        panel.set_xlabel("lateral shift y [mm], left positive")
        panel.legend(fontsize=8, frameon=False)


def draw_wheels_on_rails(
    axes: Sequence[Axes],
    wheelset: Wheelset,
    track: Track,
    geometry: ContactGeometry,
    index: int,
) -> None:
    """Left and right wheel on its rail at geometry's point `index` into axes (left, right).

    Seen from behind, the left wheel on the left. Dots: contact points with the contact normal;
    hollow dots: a second contact within 0.02 mm of touching.
    """
    for hand, panel in enumerate(axes):
        wheel, rail = _outlines(wheelset, track, geometry, index, hand)
        sign = 1.0 if hand == 0 else -1.0
        side = geometry.left if hand == 0 else geometry.right
        placement = track.left_placement if hand == 0 else track.right_placement
        panel.fill_between(
            rail[:, 0] * 1e3, rail[:, 1] * 1e3, -45.0, color=RAIL_COLOUR, alpha=0.22, linewidth=0
        )
        panel.plot(*(rail.T * 1e3), color=RAIL_COLOUR, linewidth=1.6)
        panel.plot(*(wheel.T * 1e3), color=WHEEL_COLOUR, linewidth=1.6)
        points = [(side.rail_y[index], True)]
        if side.second_gap[index] < _NEARLY_TOUCHING:
            points.append((side.second_rail_y[index], False))
        for rail_y, touches in points:
            y = sign * (placement.datum_y + rail_y)
            order = np.argsort(rail[:, 0])
            z = np.interp(y, rail[order, 0], rail[order, 1])
            colour = LEFT_COLOUR if hand == 0 else RIGHT_COLOUR
            panel.plot(
                y * 1e3,
                z * 1e3,
                "o",
                markersize=6,
                color=colour if touches else "white",
                markeredgecolor=colour,
                zorder=5,
            )
            if touches:
                angle = sign * side.angle[index]
                normal = np.array([-np.sin(angle), np.cos(angle)]) * 0.022
                panel.annotate(
                    "",
                    xy=((y + normal[0]) * 1e3, (z + normal[1]) * 1e3),
                    xytext=(y * 1e3, z * 1e3),
                    arrowprops={"arrowstyle": "->", "color": colour, "linewidth": 1.4},
                )
        middle = sign * placement.datum_y * 1e3
        outwards, inwards = (50.0, 78.0) if hand == 0 else (78.0, 50.0)
        panel.set_xlim(middle + outwards, middle - inwards)
        panel.set_ylim(-38.0, 30.0)
        panel.set_aspect("equal")
        panel.set_title(
            f"{'left' if hand == 0 else 'right'}, y = {geometry.y[index] * 1e3:.1f} mm: "
            f"{np.degrees(side.angle[index]):.1f} deg, r = {side.radius[index] * 1e3:.2f} mm",
            fontsize=9,
        )


def _outlines(
    wheelset: Wheelset, track: Track, geometry: ContactGeometry, index: int, hand: int
) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) of a wheel's and its rail's outline in the track frame, y and z [m]."""
    sign = 1.0 if hand == 0 else -1.0
    wheel = wheelset.wheel if hand == 0 else (wheelset.right_wheel or wheelset.wheel)
    radius = wheelset.radius if hand == 0 else (wheelset.right_radius or wheelset.radius)
    table = wheel.arc_table()
    place = np.linspace(0.0, table.ds * len(table.coefficients), 1500)
    lateral, height = _along(table.coefficients, table.ds, place)
    across = sign * (wheelset.tape_half_distance + lateral)
    below = radius - height
    roll = geometry.roll[index]
    outline = np.column_stack(
        [
            geometry.y[index] + across * np.cos(roll) + below * np.sin(roll),
            wheelset.radius + geometry.z[index] + across * np.sin(roll) - below * np.cos(roll),
        ]
    )
    placement = track.left_placement if hand == 0 else track.right_placement
    place = np.linspace(0.0, placement.spacing * len(placement.coefficients), 1500)
    lateral, height = _along(placement.coefficients, placement.spacing, place)
    return outline, np.column_stack([sign * lateral, height])


def _along(
    coefficients: np.ndarray, spacing: float, place: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Lateral position and height of a curve at arc lengths `place` [m]."""
    segment = np.clip((place / spacing).astype(int), 0, len(coefficients) - 1)
    rest = (place - segment * spacing)[:, None]
    powers = rest ** np.arange(4)
    rows = coefficients[segment]
    return (rows[:, :4] * powers).sum(axis=1), (rows[:, 4:] * powers).sum(axis=1)


def draw_root_locus(
    axes: Axes, locus: RootLocus, highest_frequency: float = 10.0, critical: float | None = None
) -> Any:
    """Oscillatory roots below `highest_frequency` [Hz], coloured by speed; return the marks."""
    roots = np.asarray(locus.eigenvalues)
    frequencies = roots.imag / (2.0 * np.pi)
    shown = (frequencies > 0.05) & (frequencies < highest_frequency)
    speeds = np.broadcast_to(np.asarray(locus.speeds)[:, None], roots.shape)
    marks = axes.scatter(
        roots.real[shown], frequencies[shown], c=speeds[shown], s=10, cmap="viridis"
    )
    axes.axvline(0.0, color="black", linewidth=0.8)
    if critical is not None:
        axes.set_title(f"root locus, critical at {critical:.1f} m/s")
    axes.set_xlabel("growth rate [1/s]")
    axes.set_ylabel("frequency [Hz]")
    return marks


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
        panel.legend(fontsize=7, frameon=False, ncols=2, loc=corner)
