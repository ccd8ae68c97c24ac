"""Make the picture of the README from the project's own renderer and analyses.

    python docs/figures/make_readme_picture.py

The paper's wheelset on its rails, its motion when released beside the track centre above the
critical speed, and its roots over speed.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from exudyn_wheelset.front.animation import Camera, render, show_rails
from exudyn_wheelset.front.mode_plots import draw_root_locus
from exudyn_wheelset.front.output import write_figure
from exudyn_wheelset.front.plots import LEFT_COLOUR, RIGHT_COLOUR, tidy
from exudyn_wheelset.stability.linear.linearisation import root_locus

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "models"))
import single_wheelset  # noqa: E402

OFFSET = 2.0e-3


def main() -> Path:
    """Write readme.png beside this script."""
    model = single_wheelset.vehicle()
    container, mbs, _ = model.build(20.0, sensors=False)
    show_rails(mbs, model.track, -4.0, 4.5)
    mbs.Assemble()
    camera = Camera(azimuth=0.5, elevation=0.30, centre=(0.1, -0.02, 0.2), zoom=1.95)
    image = render(container, camera, size=(1040, 900), smooth=2)

    numbers, motions = single_wheelset.run(model, offset=OFFSET)
    critical = numbers["critical_speed"]
    figure = Figure(figsize=(12.0, 5.2), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=[1.12, 1.0])
    picture = left.subplots()
    picture.imshow(image)
    picture.axis("off")
    motion_panel, locus_panel = right.subplots(2, 1)
    for panel in (motion_panel, locus_panel):
        tidy(panel)
    below, above = motions
    for motion, colour in ((above, RIGHT_COLOUR), (below, LEFT_COLOUR)):
        motion_panel.plot(
            motion.time,
            motion["wheelset: y"] * 1e3,
            color=colour,
            linewidth=1.2,
            label=f"{motion.speed:.1f} m/s",
        )
    motion_panel.set_xlabel("time [s]")
    motion_panel.set_ylabel("lateral shift [mm]")
    motion_panel.legend(fontsize=9, frameon=False, loc="upper left", ncols=2)
    motion_panel.set_ylim(-13.0, 16.0)
    motion_panel.set_title("released 2 mm beside the track centre", fontsize=10)

    speeds = np.linspace(5.0, 60.0, 221)
    locus = root_locus(model.dynamic_system(), speeds)
    marks = draw_root_locus(locus_panel, locus, 6.0)
    right.colorbar(marks, ax=locus_panel, label="speed [m/s]")
    for found, colour in zip(numbers["runs"], (LEFT_COLOUR, RIGHT_COLOUR), strict=True):
        locus_panel.plot(
            found["growth_rate_eigenvalue"],
            found["frequency_eigenvalue"],
            "o",
            markersize=9,
            markerfacecolor="none",
            markeredgewidth=2.0,
            color=colour,
        )
    locus_panel.annotate("hunting", (0.45, 2.75), fontsize=9)
    locus_panel.annotate("fore and aft", (0.03, 2.2), fontsize=9)
    locus_panel.set_xlim(-0.5, 1.0)
    locus_panel.set_title(f"roots over speed: critical at {critical:.1f} m/s", fontsize=10)
    return write_figure(HERE / "readme.png", figure)


if __name__ == "__main__":
    print(main())
