"""Linear stability drawn: roots over speed, and a mode seen from above.

Growth rates in 1/s, frequencies in Hz, speeds in m/s; the motion of a mode is drawn large.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from exudyn_wheelset.front.plots import LEFT_COLOUR, RIGHT_COLOUR, WHEEL_COLOUR
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.stability.linear.linearisation import Linearisation, RootLocus, root_locus
from exudyn_wheelset.vehicles.description import Axle, Vehicle

# A rail's distance from the track's centre, half the length of an axle, half the width of a body,
# the length of half a drawn wheel and the largest lateral motion of the picture [m].
_RAIL, _HALF_AXLE, _HALF_WIDTH, _HALF_WHEEL, _MOTION = 0.75, 1.0, 0.95, 0.45, 0.35
# Vehicles longer than this [m] have their phases below each other, at rows so far apart [m].
_LONG, _ROW = 8.0, 3.8


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


def draw_roots(
    axes: Axes,
    vehicle: Any,
    critical: CriticalPoint,
    *,
    span: tuple[float, float] = (0.4, 1.6),
    decay: float = 10.0,
    highest_frequency: float = 12.0,
    named: Linearisation | None = None,
) -> None:
    """Draw the root locus of a vehicle at speeds of `span` times the critical, with its scale.

    Roots that decay faster than `decay` [1/s] or lie above highest_frequency [Hz] are left out.
    named: the equations at one speed, whose modes get their names written beside their roots.
    """
    speeds = np.linspace(span[0] * critical.speed, span[1] * critical.speed, 61)
    locus = root_locus(vehicle, speeds)
    marks = draw_root_locus(axes, locus, highest_frequency, critical.speed)
    axes.set_xlim(-decay, max(0.1 * decay, 1.2 * float(np.real(locus.eigenvalues).max())))
    axes.figure.colorbar(marks, ax=axes, label="speed [m/s]")
    if named is not None:
        _name_modes(axes, named, highest_frequency)


def _name_modes(axes: Axes, linear: Linearisation, highest_frequency: float) -> None:
    """Write names beside roots inside the axes, from below, each clear of those before.

    Modes of one name within a hertz, as two trucks have them, are named once.
    """
    left, right = axes.get_xlim()
    shown: list[tuple[float, float, str]] = []
    for name, root in linear.oscillations(highest=highest_frequency):
        frequency = root.imag / (2.0 * np.pi)
        known = any(other == name and abs(frequency - f) < 1.0 for f, _, other in shown)
        if left < root.real < right and not known:
            shown.append((frequency, root.real, name))
    taken = -np.inf
    for frequency, decay, name in sorted(shown):
        height = taken = max(frequency, taken + 0.04 * highest_frequency)
        leftwards = decay > left + 0.45 * (right - left)
        axes.annotate(
            name,
            (decay, frequency),
            xytext=(decay + (-0.03 if leftwards else 0.03) * (right - left), height),
            fontsize=7,
            va="center",
            ha="right" if leftwards else "left",
            arrowprops={"arrowstyle": "-", "linewidth": 0.4, "color": "0.5"},
            bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "alpha": 0.7, "lw": 0},
        )
    axes.set_ylim(0.0, 1.08 * highest_frequency)


def draw_critical_speeds(
    axes: Axes,
    rows: Mapping[str, Sequence[float]],
    columns: Sequence[str],
    published: Mapping[str, Sequence[float]],
) -> None:
    """Draw critical speeds [m/s] as bars, a group for each column, published ones as lines."""
    width = 0.8 / len(rows)
    places = np.arange(len(columns))
    for k, (row, values) in enumerate(rows.items()):
        bars = axes.bar(places + (k - (len(rows) - 1) / 2) * width, values, width, label=row)
        for bar, value in zip(bars, published.get(row, ()), strict=False):
            ends = [bar.get_x(), bar.get_x() + bar.get_width()]
            axes.plot(ends, [value] * 2, color="black", linewidth=2.0)
    axes.plot([], [], color="black", linewidth=2.0, label="published")
    axes.set_xticks(places, columns)
    axes.set_ylabel("linear critical speed [m/s]")
    axes.legend(fontsize=8, frameon=False)


def draw_mode_from_above(
    axes: Axes, vehicle: Vehicle, critical: CriticalPoint, phases: int = 4
) -> None:
    """Axles and bodies seen from above, running to the right, at phases of a period.

    critical: point of the vehicle's own system, whose states are named after its parts. Axles are
    drawn with their wheels, leading ones blue, trailing ones red; bodies as long as what they are
    joined to.
    """
    motion = {
        name.split(" [")[0]: complex(value)
        for name, value in zip(critical.state_names, critical.mode, strict=True)
    }
    lateral = [abs(value) for name, value in motion.items() if name.split(": ")[-1] in ("y", "yaw")]
    scale = _MOTION / max(lateral)
    reaches = {part.name: _reach(vehicle, part.name) for part in vehicle.bodies}
    ends = [axle.x for axle in vehicle.wheelsets]
    ends += [end for reach in reaches.values() for end in reach]
    length = max(ends) - min(ends)
    columns = 2 if length < _LONG else 1
    for k in range(phases):
        turn = np.exp(2j * np.pi * k / phases)
        row, column = divmod(k, columns)
        across, along = -_ROW * row, (length + 2.5) * column

        def moved(part: str, turn: complex = turn) -> tuple[float, float]:
            """Lateral displacement [m] and yaw [rad] of a part in the picture."""
            y, yaw = (motion.get(f"{part}: {w}", motion.get(w, 0.0)) for w in ("y", "yaw"))
            return scale * (y * turn).real, scale * (yaw * turn).real

        for name, (rear, front) in reaches.items():
            _draw_body(axes, *moved(name), rear, front, along, across)
        for axle in vehicle.wheelsets:
            _draw_axle(axes, axle, *moved(axle.name), along, across, _leads(vehicle, axle))
        middle = 0.5 * (max(ends) + min(ends))
        axes.text(along + middle, across - 1.75, f"{k}/{phases} period", ha="center", fontsize=8)
        for rail in (_RAIL, -_RAIL):
            axes.axhline(across + rail, color="black", linewidth=0.5, alpha=0.4, zorder=0)
    axes.set_aspect("equal")
    axes.set_ylim(-2.1 - _ROW * ((phases - 1) // columns), 1.7)
    axes.axis("off")
    axes.set_title(
        f"{critical.mode_name or 'critical mode'}, {critical.frequency:.2f} Hz, seen from above, "
        "running to the right",
        fontsize=10,
    )


def _reach(vehicle: Vehicle, name: str) -> tuple[float, float]:
    """Rear and front end [m] of what a body is joined to, at least a metre."""
    places = [one.at[0] for one in vehicle.connections if name in (one.lower, one.upper)]
    centre = vehicle.part(name).centre[0]
    return min([*places, centre - 0.5]), max([*places, centre + 0.5])


def _leads(vehicle: Vehicle, axle: Axle) -> bool:
    """Whether an axle stands ahead of the middle of its truck, or of the vehicle."""
    near = [other.x for other in vehicle.wheelsets if abs(other.x - axle.x) < 0.5 * _LONG]
    return axle.x >= 0.5 * (min(near) + max(near))


def _draw_axle(
    axes: Axes, axle: Axle, y: float, yaw: float, along: float, across: float, leads: bool
) -> None:
    colour = LEFT_COLOUR if leads else RIGHT_COLOUR
    forward = np.array([np.cos(yaw), np.sin(yaw)])
    sideways = np.array([-np.sin(yaw), np.cos(yaw)])
    centre = np.array([along + axle.x, across + y])
    tips = np.array([centre - _HALF_AXLE * sideways, centre + _HALF_AXLE * sideways])
    axes.plot(*tips.T, color=colour, linewidth=1.6)
    for place in (_RAIL, -_RAIL):
        hub = centre + place * sideways
        wheel = np.array([hub - _HALF_WHEEL * forward, hub + _HALF_WHEEL * forward])
        axes.plot(*wheel.T, color=colour, linewidth=4.0, solid_capstyle="round")


def _draw_body(
    axes: Axes, y: float, yaw: float, rear: float, front: float, along: float, across: float
) -> None:
    middle, half = 0.5 * (front + rear), 0.5 * (front - rear)
    corners = np.array([[half, 1.0], [half, -1.0], [-half, -1.0], [-half, 1.0]])
    corners[:, 1] *= _HALF_WIDTH
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    corners = corners @ turn.T + [along + middle, across + y]
    axes.fill(*corners.T, facecolor=WHEEL_COLOUR, alpha=0.12, edgecolor=WHEEL_COLOUR)
