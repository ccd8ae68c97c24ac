"""Rigid contact drawn: its geometry over the lateral shift, and wheels standing on their rails.

Figure 3 of the paper: roll angle, vertical displacement, contact angles and rolling radii, exact
and as piecewise polynomials. Inputs SI, track frame; axes in mm, mrad and degrees.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.front.output import file_stem, write_figure
from exudyn_wheelset.front.plots import (
    GREY,
    LEFT_COLOUR,
    RAIL_COLOUR,
    RIGHT_COLOUR,
    WHEEL_COLOUR,
    new_figure,
    pair_name,
)
from exudyn_wheelset.geometry.piecewise import COLUMNS, PiecewiseGeometry, geometry_columns
from exudyn_wheelset.geometry.rigid import ContactGeometry, contact_geometry
from exudyn_wheelset.geometry.summary import telling_shifts
from exudyn_wheelset.results.files import write_columns

_PANELS = (
    ("roll angle [mrad]", 1e3, ("roll",)),
    ("vertical displacement [mm]", 1e3, ("z",)),
    ("contact angle [deg]", 180.0 / np.pi, ("left_angle", "right_angle")),
    ("rolling radius [mm]", 1e3, ("left_radius", "right_radius")),
)
# A second contact this close to touching [m] is drawn as a hollow mark.
_NEARLY_TOUCHING = 2.0e-5


def geometry_figure(
    wheelset: Wheelset, track: Track, geometry: ContactGeometry, pieces: PiecewiseGeometry
) -> Figure:
    """Figure 3 of the paper for a pair."""
    figure, axes = new_figure(10.5, 7.0, 2, 2)
    draw_contact_geometry(axes, geometry, pieces)
    degrees = pieces.degrees
    inclined = f", inclination 1:{1 / track.inclination:.0f}" if track.inclination else ""
    figure.suptitle(
        f"{pair_name(wheelset, track)}, gauge {track.gauge * 1e3:.0f} mm{inclined}\n"
        f"{len(degrees)} polynomials of degree {min(degrees)} to {max(degrees)}; "
        "dotted: a contact point jumps",
        fontsize=11,
    )
    return figure


def profiles_figure(wheelset: Wheelset, track: Track, shifts: Sequence[float]) -> Figure:
    """Both wheels on their rails, one row for each lateral shift [m]."""
    figure, axes = new_figure(9.5, 2.9 * len(shifts), len(shifts), 2)
    for row, shift in zip(axes, shifts, strict=True):
        draw_wheels_on_rails(row, wheelset, track, contact_geometry(wheelset, track, [shift]), 0)
        row[0].set_ylabel("z [mm]")
    for panel in axes[-1]:
        panel.set_xlabel("y in the track frame [mm], left positive")
    figure.suptitle(f"{pair_name(wheelset, track)}, seen from behind", fontsize=11)
    return figure


def keep_geometry(
    out: Path,
    wheelset: Wheelset,
    track: Track,
    geometry: ContactGeometry,
    pieces: PiecewiseGeometry,
) -> list[Path]:
    """Keep Figure 3, the profiles in contact and the contact by shift of a pair; the files.

    contact_geometry_<wheel>_<rail>.png, ..._profiles.png, ....csv (SI units).
    """
    stem = file_stem("contact_geometry", wheelset, track)
    shown = telling_shifts(pieces, float(geometry.y[-1]))
    columns = {
        "y": geometry.y,
        **dict(zip(COLUMNS, geometry_columns(geometry).T, strict=True)),
        "left_second_gap": geometry.left.second_gap,
        "right_second_gap": geometry.right.second_gap,
    }
    profiles = profiles_figure(wheelset, track, shown)
    return [
        write_figure(out / f"{stem}.png", geometry_figure(wheelset, track, geometry, pieces)),
        write_figure(out / f"{stem}_profiles.png", profiles),
        write_columns(out / f"{stem}.csv", columns),
    ]


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
