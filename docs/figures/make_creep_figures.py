"""Make the figures of docs/creep.md and refresh its table.

    python docs/figures/make_creep_figures.py

Runs benchmarks/creep_laws.py for creep_laws.png and the table; draws creep_moment.png (spin moment
beside CONTACT's, Kalker's coefficients over the axis ratio) from the package itself.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from exudyn_wheelset.creep import creep_force, kalker_coefficients

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "benchmarks"))
import creep_laws  # noqa: E402


def draw_moment_and_coefficients(path: Path) -> None:
    """Draw the spin moments over lateral creepage and spin, and the coefficients over a/b."""
    curves = creep_laws.reference_curves()
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.8), layout="constrained")
    panels = [("lat", 1, "lateral creepage [-]"), ("spin", 2, "spin [1/m]")]
    for axis, (name, over, label) in zip(axes, panels, strict=False):
        rows = curves[name]
        grid = np.geomspace(rows[0, over], rows[-1, over], 200)
        states = np.zeros((len(grid), 3))
        states[:, over] = grid
        saturated = creep_force("polach", *states.T, **creep_laws.PATCH, spin_moment=1)[2]
        fastsim = creep_force("fastsim", *states.T, **creep_laws.PATCH)[2]
        axis.semilogx(grid, saturated, color="tab:blue", label="linear moment, saturated")
        axis.semilogx(grid, fastsim, color="tab:orange", label="fastsim 10 x 10")
        axis.semilogx(rows[:, over], rows[:, 5], "ko", markersize=4, label="CONTACT, full")
        axis.set_xlabel(label)
        axis.set_ylabel("M_z [N m]")
        axis.grid(alpha=0.3)
    axes[1].legend(fontsize="small")
    ratios = np.geomspace(0.02, 50.0, 1501)
    values = np.array([kalker_coefficients(ratio, 1.0, 0.28) for ratio in ratios])
    for i, name in enumerate(("C11", "C22", "C23", "C33")):
        axes[2].loglog(ratios, values[:, i], label=name)
    for end in (0.1, 10.0):
        axes[2].axvline(end, color="0.6", linewidth=0.8, linestyle=":")
    axes[2].set_xlabel("a/b [-], nu = 0.28 (dotted: end of the table)")
    axes[2].set_ylabel("Kalker's coefficients [-]")
    axes[2].grid(alpha=0.3)
    axes[2].legend(fontsize="small")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main() -> None:
    """Write both figures beside this script and the table into docs/creep.md."""
    measured = creep_laws.measure()
    creep_laws.draw(measured, HERE / "creep_laws.png")
    draw_moment_and_coefficients(HERE / "creep_moment.png")
    page = HERE.parent / "creep.md"
    table = f"<!-- table -->\n{creep_laws.table(measured)}\n<!-- end of table -->"
    text = page.read_text(encoding="utf-8")
    page.write_text(
        re.sub(r"<!-- table -->.*<!-- end of table -->", lambda _: table, text, flags=re.S),
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()
