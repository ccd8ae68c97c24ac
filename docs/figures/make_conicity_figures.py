"""Make the figure of docs/conicity.md and refresh its tables.

    python docs/figures/make_conicity_figures.py

The table beside EN 15302 needs the reference files (see tests/test_conicity_en15302.py) and is left
as it is without them.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
from pathlib import Path

import numpy as np

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.geometry.conicity import METHODS, equivalent_conicity
from exudyn_wheelset.geometry.rolling_radius import (
    rolling_radius_curve,
    rolling_radius_difference,
)
from exudyn_wheelset.profiles import load_profile

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
REFERENCE = Path(
    os.environ.get("EXUDYN_WHEELSET_REFERENCE", REPOSITORY.parent / "shared" / "reference")
)
sys.path.insert(0, str(REPOSITORY / "models"))
import conicity  # noqa: E402

BODY = (1000.0, (600.0, 100.0, 600.0), 0.46)


def shifts(spacing: float, reach: float) -> np.ndarray:
    half = round(reach / spacing)
    return spacing * np.arange(-half, half + 1)


def spacing_table() -> str:
    """Conicity of S1002 on UIC60 over the spacing of y and the method."""
    wheelset, track = Wheelset(*BODY, wheel="S1002"), Track("UIC60")
    rows = [
        "| spacing of y [mm] | method | 1 mm | 3 mm | 5 mm | 7 mm |",
        "|---|---|---|---|---|---|",
    ]
    amplitudes = np.array([1.0, 3.0, 5.0, 7.0]) * 1e-3
    cases = [(spacing, METHODS[0]) for spacing in (5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 2e-6)]
    cases += [(1e-5, method) for method in METHODS[1:]]
    for spacing, method in cases:
        curve = rolling_radius_curve(wheelset, track, 8e-3, spacing)
        values = equivalent_conicity(
            curve.y, curve.rolling_radius_difference, amplitudes, method=method
        )
        cells = " | ".join(f"{value:.4f}" for value in values)
        rows.append(f"| {1e3 * spacing:g} | {method} | {cells} |")
    return "\n".join(rows)


def reference_table() -> str:
    """Deviations from EN 15302's reference with and without roll, y every 0.02 mm."""
    folder = REFERENCE / "en15302"
    track = Track(load_profile(folder / "SUIC519A.dat"), origin_half_distance=0.75, inclination=0.0)
    rows = [
        "| case | axle | rms deviation | largest, at amplitude | outside the widened limits |",
        "|---|---|---|---|---|",
    ]
    for case, wheel in {"E1": "A", "E2": "B", "E3": "H", "E4": "I"}.items():
        wheelset = Wheelset(*BODY, load_profile(folder / f"RUIC519{wheel}.dat"))
        table = np.loadtxt(folder / f"ben_{case}.dat")
        level = rolling_radius_difference(wheelset, track, shifts(2e-5, 9e-3), neglect_roll=True)
        at_rail, at_axle = (
            rolling_radius_curve(wheelset, track, 9e-3, shift=shift) for shift in ("rail", "axle")
        )
        for axle, y, difference in (
            ("rolling, y at rail level", at_rail.y, at_rail.rolling_radius_difference),
            ("rolling, y at the axle", at_axle.y, at_axle.rolling_radius_difference),
            ("level", shifts(2e-5, 9e-3), level),
        ):
            value = equivalent_conicity(y, difference, 1e-3 * table[:, 0])
            off = value - table[:, 1]
            outside = table[(value > table[:, 4]) | (value < table[:, 5]), 0]
            worst = int(np.argmax(np.abs(off)))
            where = f"{outside.min():g} mm and above" if outside.size else "none"
            rms = np.sqrt(np.mean(off**2))
            rows.append(
                f"| {case} | {axle} | {rms:.4f} | {off[worst]:+.3f} at {table[worst, 0]:g} mm "
                f"| {where} |"
            )
    return "\n".join(rows)


def main() -> None:
    """Write the figure beside this script and the tables into docs/conicity.md."""
    with tempfile.TemporaryDirectory() as folder:
        figure = Path(conicity.run(out=folder)["files"][0])
        (HERE / "conicity_S1002_UIC60.png").write_bytes(figure.read_bytes())
    tables = {"spacing": spacing_table()}
    if (REFERENCE / "en15302").is_dir():
        tables["reference"] = reference_table()
    page = HERE.parent / "conicity.md"
    text = page.read_text(encoding="utf-8")
    for name, table in tables.items():
        block = f"<!-- {name} -->\n{table}\n<!-- end of {name} -->"
        text = re.sub(rf"<!-- {name} -->.*?<!-- end of {name} -->", block, text, flags=re.S)
    page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
