"""Figures of the gallery that no other script makes: contact, roots and modes, motions.

Run `python docs/figures/make_gallery.py`; pictures land in docs/figures/gallery/.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from exudyn_wheelset import (
    Track,
    Wheelset,
    catalogue,
    contact_geometry,
    contact_view,
    linear_critical_speed,
    load_profile,
    piecewise_geometry,
    profile_report,
    simulate,
)
from exudyn_wheelset.front.command.creep import run as creep_run
from exudyn_wheelset.front.geometry_plots import geometry_figure, profiles_figure
from exudyn_wheelset.front.mode_plots import draw_mode_from_above, draw_roots
from exudyn_wheelset.front.motion_plots import draw_lateral, draw_wheelset_motion
from exudyn_wheelset.front.output import write_figure
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.vehicle_options import law_and_parameters

FOLDER = Path(__file__).parent / "gallery"
AXLE = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
TRACK = Track("UIC60")


def contact() -> dict[str, Figure]:
    """Geometry over the shift, wheels on rails, the interactive look, a profile's report."""
    y = np.linspace(-7e-3, 7e-3, 281)
    pieces = piecewise_geometry(AXLE, TRACK, 7e-3, representation="polynomial")
    view = contact_view(AXLE, TRACK, figure=Figure(figsize=(9.0, 5.2)))
    view.shift.set_val(6.0)
    view.yaw.set_val(10.0)
    return {
        "geometry": geometry_figure(AXLE, TRACK, contact_geometry(AXLE, TRACK, y), pieces),
        "wheels_on_rails": profiles_figure(AXLE, TRACK, [0.0, 3e-3, 6.5e-3]),
        "contact_view": view.figure,
        "profile_report": profile_report(load_profile("S1002"), samples=0).figure,
    }


def creep() -> Figure:
    """Longitudinal creep force of four laws."""
    creepage = np.linspace(0.0, 0.01, 41)
    laws = [law_and_parameters(law) for law in ("linear", "polach", "fastsim", "exact-table")]
    figure, axes = new_figure(6.0, 4.0)
    for law, forces in creep_run(laws, creepage)["laws"].items():
        axes[0, 0].plot(creepage, -1e-3 * np.array(forces["force_x"]), label=law)
    axes[0, 0].set(xlabel="longitudinal creepage [-]", ylabel="-F_x [kN]", ylim=(0.0, 30.0))
    axes[0, 0].legend(fontsize=8, frameon=False)
    return figure


def stability() -> dict[str, Figure]:
    """Roots over speed and the critical mode of a truck, and its motion beyond that speed."""
    truck = catalogue.vehicle("truck")
    system = truck.dynamic_system()
    critical = linear_critical_speed(system, 15, 150)
    roots, axes = new_figure(6.5, 4.5)
    draw_roots(axes[0, 0], system, critical)
    mode, axes = new_figure(7.0, 4.5)
    draw_mode_from_above(axes[0, 0], truck.vehicle(), critical)
    motion = simulate(system, 1.1 * critical.speed, 3.0, initial=1e-3)
    lateral, axes = new_figure(7.0, 3.5)
    draw_lateral(axes[0, 0], motion, list(dict.fromkeys(name for name, _ in motion.wheels)))
    forces, axes = new_figure(6.0, 10.0, rows=5, sharex=True)
    first = motion.wheels[0][0]
    draw_wheelset_motion(axes[:, 0], motion.after(2.0), first)
    return {"roots": roots, "mode": mode, "lateral": lateral, "wheelset_motion": forces}


def main() -> None:
    """Draw all of them."""
    for name, figure in {**contact(), "creep": creep(), **stability()}.items():
        print(write_figure(FOLDER / f"{name}.png", figure))


if __name__ == "__main__":
    main()
