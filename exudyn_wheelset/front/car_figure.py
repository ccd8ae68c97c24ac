"""A vehicle's stability on one figure: roots with names, the critical mode, trucks, a hunt."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_wheelset.front.mode_plots import draw_mode_from_above, draw_roots
from exudyn_wheelset.front.motion_plots import draw_lateral
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.stability.hunting.branch_plot import draw_branch
from exudyn_wheelset.stability.hunting.truck_speeds import TruckSpeeds
from exudyn_wheelset.stability.hunting.watching import watched_trucks
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.stability.linear.linearisation import linearised
from exudyn_wheelset.systems.system import DynamicSystem
from exudyn_wheelset.vehicles.description import Vehicle


def car_figure(
    vehicle: Vehicle,
    system: DynamicSystem,
    critical: CriticalPoint,
    trucks: TruckSpeeds | None,
    hunt: Motion,
) -> Figure:
    """Root locus and critical mode above, hunting of each truck over speed and time below."""
    figure, axes = new_figure(13.0, 9.0, 2, 2)
    at_critical = linearised(system, critical.speed)
    draw_roots(axes[0, 0], system, critical, span=(0.3, 1.4), decay=15.0, named=at_critical)
    draw_mode_from_above(axes[0, 1], vehicle, critical)
    draw_trucks(axes[1, 0], system, critical, trucks)
    first = [wheelsets[0] for wheelsets in system.trucks.values()] or system.wheelset_names
    draw_lateral(axes[1, 1], hunt, first)
    figure.suptitle(system.name, fontsize=11)
    return figure


def draw_trucks(
    axes: Axes, system: DynamicSystem, critical: CriticalPoint, trucks: TruckSpeeds | None
) -> None:
    """Draw the lateral amplitude of each truck over speed: descent points, orbits as lines.

    Unstable orbits are dashed, those of uncertain stability dash-dotted. Dotted lines:
    speeds at which trucks stop; grey: the linear critical speed.
    """
    if trucks is not None:
        descent, branch = trucks.descent, trucks.branch
        order = np.argsort(descent.speeds)
        for index, name in enumerate(descent.trucks.names):
            amplitude = 1e3 * np.asarray(descent.trucks[name])[order]
            label = f"{name or 'vehicle'}, descent"
            colour = f"C{index}"
            axes.plot(descent.speeds[order], amplitude, "o", ms=4, color=colour, label=label)
            if branch is not None:
                state = system.state_names[watched_trucks(system)[name]]
                draw_branch(axes, branch, state, 1e3, colour, f"{name}, orbits".strip(", "), False)
        for index, (name, stop) in enumerate(trucks.speeds.items()):
            axes.axvline(stop, linewidth=0.9, linestyle=":", color=f"C{index}")
            words = f"{name or 'vehicle'} stops at {stop:.2f} ({trucks.methods[name]})"
            axes.annotate(
                words,
                (stop, 0.97 - 0.07 * index),
                xycoords=("data", "axes fraction"),
                xytext=(4, 0),
                textcoords="offset points",
                fontsize=8,
                color=f"C{index}",
            )
    axes.axvline(critical.speed, color="0.6", linewidth=0.9, label="linear critical speed")
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("speed [m/s]")
    axes.set_ylabel("lateral amplitude of hunting [mm]")
    axes.legend(fontsize=8, frameon=False, loc="lower right")
