"""Make conventions.png: the frames and signs of docs/conventions.md, drawn from real profiles.

    python docs/figures/make_conventions_figure.py

S1002 wheels on UIC60 rails 1:40 at gauge 1435 mm, in rigid contact; shifts and angles to scale in
the detail of the left wheel, exaggerated where the drawing says so.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, FancyArrowPatch

from exudyn_wheelset import Track, Wheelset, contact_geometry

HERE = Path(__file__).resolve().parent
WHEELSET = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
TRACK = Track(rail="UIC60")
FRAME, WHEEL, RAIL, CONTACT, SIZE = "black", "tab:blue", "tab:brown", "tab:red", "0.35"


def arrow(axes: Axes, start, end, colour=FRAME, text="", offset=(0.0, 0.0), style="-|>", **more):
    """An arrow from start to end with its name at the tip."""
    axes.add_patch(
        FancyArrowPatch(
            start, end, arrowstyle=style, mutation_scale=13, color=colour, shrinkA=0, shrinkB=0,
            linewidth=1.5, zorder=6, **more,
        )
    )  # fmt: skip
    if text:
        axes.text(end[0] + offset[0], end[1] + offset[1], text, color=colour, zorder=7)


def turning(axes: Axes, centre, radius, start, stop, text, offset, colour=FRAME):
    """A circular arrow from the angle `start` to `stop` [degrees]."""
    axes.add_patch(
        Arc(centre, 2 * radius, 2 * radius, theta1=min(start, stop), theta2=max(start, stop),
            color=colour, linewidth=1.5, zorder=6)
    )  # fmt: skip
    ends = np.radians([stop - 4.0 * np.sign(stop - start), stop])
    places = [(centre[0] + radius * np.cos(a), centre[1] + radius * np.sin(a)) for a in ends]
    arrow(axes, *places, colour=colour)
    axes.text(places[1][0] + offset[0], places[1][1] + offset[1], text, color=colour)


def size(axes: Axes, start, end, text, offset):
    """A dimension line."""
    axes.annotate(
        "", end, start, arrowprops={"arrowstyle": "<|-|>", "color": SIZE, "lw": 0.9}, zorder=5
    )
    middle = 0.5 * (np.add(start, end))
    axes.text(middle[0] + offset[0], middle[1] + offset[1], text, color=SIZE, fontsize=8.5,
              ha="center", va="center")  # fmt: skip


def wheel_outline(y: float, z: float, roll: float, side: float) -> np.ndarray:
    """Lower edge of a wheel in the track frame, columns y and z [mm]."""
    low, high = WHEELSET.wheel.span
    along = np.linspace(low, high, 500)
    axial = side * (WHEELSET.tape_half_distance + along)
    below = -(WHEELSET.radius - WHEELSET.wheel.height(along))
    cosine, sine = np.cos(roll), np.sin(roll)
    lateral = y + cosine * axial - sine * below
    vertical = WHEELSET.radius + z + sine * axial + cosine * below
    return 1e3 * np.column_stack([lateral, vertical])


def rail_outline(side: float) -> np.ndarray:
    """Head of a rail in the track frame, columns y and z [mm]."""
    placed = TRACK.left_placement.coefficients
    u = TRACK.left_placement.spacing * np.linspace(0.0, 1.0, 4, endpoint=False)
    powers = np.vander(u, 4, increasing=True)
    lateral, vertical = (placed[:, :4] @ powers.T).ravel(), (placed[:, 4:] @ powers.T).ravel()
    return 1e3 * np.column_stack([side * lateral, vertical])


def draw_rear_view(axes: Axes) -> None:
    """The lower half of the wheelset, seen in the direction of travel."""
    z = float(contact_geometry(WHEELSET, TRACK, [0.0]).z[0])
    centre, top = 1e3 * (WHEELSET.radius + z), 600.0
    for side in (1.0, -1.0):
        wheel, rail = wheel_outline(0.0, z, 0.0, side), rail_outline(side)
        body = np.vstack([[wheel[0, 0], top], wheel, [wheel[-1, 0], top]])
        axes.fill(*body.T, color=WHEEL, alpha=0.18, linewidth=0)
        axes.plot(*body.T, color=WHEEL, linewidth=1.2)
        axes.fill(*rail.T, color=RAIL, alpha=0.3, linewidth=0)
        axes.plot(*rail.T, color=RAIL, linewidth=1.2)
        axes.plot([side * 750.0] * 2, [-115.0, centre + 40.0], color=SIZE, lw=0.8, ls="-.")
        axes.plot([side * 717.5] * 2, [-70.0, -14.0], color=SIZE, linewidth=0.7)
        axes.text(
            side * 745.0, top - 50.0, "left" if side > 0 else "right", color=WHEEL, ha="center"
        )
    axes.plot([-870, 870], [centre, centre], color=SIZE, linewidth=0.8, linestyle="-.")
    axes.fill_between([-683, 683], centre - 80, centre + 80, color=WHEEL, alpha=0.12, linewidth=0)
    axes.plot([-890, 890], [0, 0], color=RAIL, linewidth=0.8, linestyle=":")
    axes.text(480, 5, "plane of the rail tops", color=RAIL, fontsize=9, ha="center", va="bottom")
    arrow(axes, (0, 0), (230, 0), text="y, to the left", offset=(-20, 14))
    arrow(axes, (0, 0), (0, 210), text="z, up", offset=(-14, -4))
    axes.plot(0, 0, marker="o", markersize=11, markerfacecolor="white", color=FRAME, zorder=7)
    axes.plot(0, 0, marker="x", markersize=7, color=FRAME, zorder=8)
    axes.text(-25, 14, "x, forward (into the picture)", color=FRAME, ha="left")
    axes.plot(0, centre, marker="o", markersize=4, color=WHEEL, zorder=7)
    turning(axes, (0, centre), 170, -35, 35, "", (0, 0), colour=WHEEL)
    axes.text(190, centre + 8, "roll phi > 0:\nthe left wheel lifts", color=WHEEL, ha="right")
    arrow(axes, (690, centre), (900, centre), colour=WHEEL)
    axes.text(890, centre + 14, "axle l,\nspin V/r0 > 0", color=WHEEL, ha="right", va="bottom")
    size(axes, (750, -105), (-750, -105), "2 x tape_half_distance", (0, 17))
    size(axes, (717.5, -60), (-717.5, -60), "gauge, measured gauge_depth below the tops", (0, 17))
    size(axes, (-520, 0), (-520, centre), "radius + z", (95, -40))
    axes.set_xlim(1060, -930)
    axes.set_ylim(-125, 615)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title("Track frame and wheelset, seen in the direction of travel", fontsize=11)


def draw_left_contact(axes: Axes) -> None:
    """Profile frames, positions and contact angle of the left wheel at a shift of 5.9 mm."""
    shift = 5.9e-3
    geometry = contact_geometry(WHEELSET, TRACK, [shift])
    roll, z = float(geometry.roll[0]), float(geometry.z[0])
    wheel, rail = wheel_outline(shift, z, roll, 1.0), rail_outline(1.0)
    rail = rail[rail[:, 1] > -30.0]
    above = np.vstack([wheel, [[wheel[-1, 0], 60], [wheel[0, 0], 60]]])
    below = np.vstack([rail, [[rail[-1, 0], -40], [rail[0, 0], -40]]])
    axes.plot(*wheel.T, color=WHEEL, linewidth=1.8)
    axes.fill(*above.T, color=WHEEL, alpha=0.12)
    axes.plot(*rail.T, color=RAIL, linewidth=1.8)
    axes.fill(*below.T, color=RAIL, alpha=0.15)
    datum = 1e3 * TRACK.left_placement.datum_y
    tape = 1e3 * (WHEELSET.tape_half_distance + shift)
    axes.plot([tape, tape], [0, 50], color=WHEEL, linewidth=0.8, linestyle="-.")
    axes.plot([datum, datum], [-38, 0], color=RAIL, linewidth=0.8, linestyle="-.")
    arrow(axes, (tape, 1), (tape + 24, 1), colour=WHEEL, text="y", offset=(1.5, 2))
    arrow(axes, (tape, 1), (tape, 25), colour=WHEEL, text="z", offset=(3.5, -1))
    axes.text(
        tape + 2, 40, "wheel profile:\ny = z = 0 on the tape circle,\ny > 0 to the field side",
        color=WHEEL, fontsize=9, ha="right",
    )  # fmt: skip
    arrow(axes, (datum, -15), (datum + 24, -15), colour=RAIL, text="y", offset=(1.0, 1.5))
    axes.text(
        834, -6, "rail: y from the\nhighest point,\ny > 0 to the\nfield side",
        color=RAIL, fontsize=9, ha="left", va="top",
    )  # fmt: skip
    left = geometry.left
    angle = float(left.angle[0])
    touch = np.array([datum + 1e3 * left.rail_y[0], 0.0])
    touch[1] = np.interp(touch[0], rail[:, 0], rail[:, 1])
    tangent = np.array([np.cos(angle), np.sin(angle)])
    normal = np.array([-np.sin(angle), np.cos(angle)])
    axes.plot(*touch, marker="o", markersize=6, color=CONTACT, zorder=9)
    arrow(axes, touch, touch + 27 * tangent, colour=CONTACT, text="t", offset=(1.5, 3))
    arrow(
        axes, touch, touch + 27 * normal, colour=CONTACT, text="n, from rail into wheel",
        offset=(-1, 3),
    )  # fmt: skip
    axes.plot([touch[0], touch[0] + 25], [touch[1]] * 2, color=CONTACT, linewidth=0.8, ls=":")
    axes.add_patch(
        Arc(touch, 40, 40, theta1=0.0, theta2=np.degrees(angle), color=CONTACT, linewidth=1.0)
    )
    axes.text(
        touch[0] + 29, touch[1] - 2, "contact angle > 0", color=CONTACT, ha="left", va="top",
        fontsize=9,
    )  # fmt: skip
    size(axes, (datum, -27), (touch[0], -27), "|rail_y|", (0, -3.5))
    axes.plot([touch[0]] * 2, [touch[1], -29], color=SIZE, linewidth=0.6)
    size(axes, (tape, 35), (touch[0], 35), "|wheel_y|", (0, 3.5))
    axes.plot([touch[0]] * 2, [touch[1], 37], color=SIZE, linewidth=0.6)
    axes.text(690, 56, "flange, y < 0", color=WHEEL, ha="center", va="top", fontsize=9)
    axes.text(834, -37, "field side", color=SIZE, ha="left", fontsize=9)
    axes.text(676, -37, "track centre", color=SIZE, ha="right", fontsize=9)
    axes.set_xlim(838, 672)
    axes.set_ylim(-40, 62)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(
        f"Left wheel and rail, wheelset shifted by y = {1e3 * shift:g} mm "
        f"(contact angle {np.degrees(angle):.0f}°)",
        fontsize=11,
    )


def draw_top_view(axes: Axes) -> None:
    """Yaw and the triads of both contacts, seen from above."""
    yaw = np.radians(9.0)
    for side in (1.0, -1.0):
        axes.axvspan(side * 760 - 36, side * 760 + 36, color=RAIL, alpha=0.18, linewidth=0)
        axes.plot([side * 760] * 2, [-560, 560], color=RAIL, linewidth=0.7, linestyle=":")
    across = np.array([np.cos(yaw), -np.sin(yaw)])
    along = np.array([np.sin(yaw), np.cos(yaw)])
    axes.plot(*np.array([-900 * across, 900 * across]).T, color=WHEEL, lw=0.8, ls="-.")
    for side in (1.0, -1.0):
        corners = [
            side * place * across + reach * along
            for place, reach in ((690, -430), (690, 430), (810, 430), (810, -430))
        ]
        axes.fill(*np.array(corners).T, facecolor=WHEEL, alpha=0.18, edgecolor=WHEEL, linewidth=1.2)
        point = side * 750 * across
        arrow(axes, point, point + np.array([0, 240]), colour=CONTACT)
        arrow(axes, point, point + np.array([240, 0]), colour=CONTACT)
        axes.text(point[0] + 62, point[1] + 225, "x", color=CONTACT)
        axes.text(point[0] + 235, point[1] - 75, "t", color=CONTACT)
        axes.plot(
            *point, marker="o", markersize=9, markerfacecolor="white", color=CONTACT, zorder=8
        )
        axes.plot(*point, marker=".", markersize=4, color=CONTACT, zorder=9)
    arrow(axes, (0, 0), (0, 440), text="x", offset=(-25, -20))
    arrow(axes, (0, 0), (280, 0), text="y", offset=(-20, 30))
    arrow(axes, (0, 0), 440 * along, colour=WHEEL)
    turning(axes, (0, 0), 330, 90, 90 - np.degrees(yaw), "", (0, 0), colour=WHEEL)
    axes.text(170, 490, "yaw psi > 0: nose to the left", color=WHEEL, ha="center")
    axes.text(
        0, -330, "the same right-handed triad (x, t, n)\non both sides: creep_x along x,\n"
        "creep_y along t, spin about n", color=CONTACT, ha="center", va="center", fontsize=9,
    )  # fmt: skip
    axes.text(985, -540, "left rail", color=RAIL, ha="center", fontsize=9)
    axes.text(-985, -540, "right rail", color=RAIL, ha="center", fontsize=9)
    axes.set_xlim(1130, -1130)
    axes.set_ylim(-580, 580)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title("Seen from above (yaw exaggerated)", fontsize=11)


def main() -> None:
    """Write conventions.png beside this script."""
    figure = plt.figure(figsize=(12.0, 8.6), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=(1.0, 1.02), width_ratios=(1.25, 1.0))
    draw_rear_view(figure.add_subplot(grid[0, :]))
    draw_left_contact(figure.add_subplot(grid[1, 0]))
    draw_top_view(figure.add_subplot(grid[1, 1]))
    figure.savefig(HERE / "conventions.png", dpi=100)
    plt.close(figure)


if __name__ == "__main__":
    main()
