"""Numbers of the model scripts printed for people. SI arguments; units stand in the table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np


def print_rows(rows: Sequence[tuple[str, str]], width: int = 34) -> None:
    """Print words and values side by side."""
    for what, value in rows:
        print(f"{what:{width}s}{value}")


def print_beside(
    rows: Mapping[str, Sequence[float]],
    columns: Sequence[str],
    published: Mapping[str, Sequence[float]],
) -> None:
    """Print numbers by row and column, in brackets what is published and the difference."""
    print(f"{'':20s}" + "".join(f"{column:>24s}" for column in columns))
    for row, values in rows.items():
        cells = []
        for k, value in enumerate(values):
            if row in published:
                known = published[row][k]
                cells.append(f"{value:8.1f} ({known:5.1f}, {100 * (value / known - 1):+5.1f} %)")
            else:
                cells.append(f"{value:8.1f}{'':17s}")
        print(f"{row:20s}" + "".join(f"{cell:>24s}" for cell in cells))


def print_wheel_loads(loads: Mapping[str, float], weight: float | None = None) -> None:
    """Print vertical wheel loads [N] by wheel, and the weight [N] that they carry."""
    head = "" if weight is None else f"weight {weight / 1e3:.3f} kN; "
    print(f"\n{head}vertical wheel loads [kN]:")
    for wheel, load in loads.items():
        print(f"  {wheel:32s}{load / 1e3:10.3f}")


def print_growth(rows: Sequence[Mapping[str, Any]]) -> None:
    """Print growth rates and frequencies of motions beside those of the eigenvalues.

    rows: numbers of `compare_growth`.
    """
    print(f"{'speed':>8s}{'growth [1/s]':>24s}{'frequency [Hz]':>24s}{'max |y|':>10s}")
    print(f"{'[m/s]':>8s}" + 2 * f"{'motion':>12s}{'eigenvalue':>12s}" + f"{'[mm]':>10s}")
    for row in rows:
        pairs = ""
        for what in ("growth_rate", "frequency"):
            found = row[f"{what}_simulated"]
            pairs += f"{'-':>12s}" if found is None else f"{found:12.4f}"
            pairs += f"{row[f'{what}_eigenvalue']:12.4f}"
        event = f"  {row['event']}" if row["event"] else ""
        print(f"{row['speed']:8.2f}{pairs}{row['maximum_y'] * 1e3:10.3f}{event}")


def print_modes(
    modes: Sequence[Sequence[Any]], where: str = "at the linear critical speed"
) -> None:
    """Print name, frequency [Hz] and damping ratio of modes."""
    print(f"least damped modes {where}:")
    for name, frequency, damping in modes:
        print(f"    {name:36} {frequency:6.2f} Hz, damping ratio {damping:+.4f}")


def print_geometry(name: str, numbers: Mapping[str, Any]) -> None:
    """Print what `geometry_numbers` and `compare_methods` ("methods") found of a pair."""
    methods, fits = numbers["methods"], numbers["polynomials"]

    def residual(what: str) -> float:
        found = fits["residuals"].items()
        return float(max(max(values) for column, values in found if column.endswith(what)))

    half_slope = numbers["half_slope_of_radius_difference_at_rest"]
    print(f"\n{name}, gauge {numbers['gauge'] * 1e3:.0f} mm")
    rows = [
        ("at rest: height", f"{numbers['height_at_rest'] * 1e3:.4f} mm"),
        ("contact angle", f"{np.degrees(numbers['contact_angle_at_rest']):.3f} deg"),
        ("contact on the wheel", f"{numbers['wheel_contact_at_rest'] * 1e3:.3f} mm"),
        ("half slope of r_L - r_R", f"{half_slope:.5f}"),
        ("jumps at y [mm]", ", ".join(f"{y * 1e3:.4f}" for y in numbers["jumps"]) or "none"),
        ("degrees of the polynomials", ", ".join(str(degree) for degree in fits["degrees"])),
        (
            "largest residuals",
            f"of roll {residual('roll'):.1e} rad, of height {residual('z') * 1e3:.1e} mm,",
        ),
        (
            "",
            f"of contact angles {np.degrees(residual('angle')):.1e} deg, "
            f"of radii {residual('radius') * 1e3:.1e} mm",
        ),
        (
            "bracketed root, Nelder-Mead",
            f"{methods['root_seconds'] * 1e3:.2f} ms, "
            f"{methods['nelder_mead_seconds'] * 1e3:.2f} ms for {methods['shifts']} shifts: "
            f"{methods['times_faster']:.0f} times faster",
        ),
        ("they differ by at most", f"{methods['largest_roll_difference']:.1e} rad in roll"),
    ]
    print_rows([(f"  {what}", value) for what, value in rows], 32)


def print_conicity(numbers: Mapping[str, Any], shift: str) -> None:
    """Print what `RollingPair.numbers` found, and the files that were kept; shift in words."""
    print(f"{numbers['wheel']} on {numbers['rail']}, {shift}")
    print("amplitude [mm]  tan(gamma_e) [-]")
    for amplitude, value in numbers["conicity"].items():
        print(f"{amplitude:>14s}  " + ("none" if value is None else f"{value:.4f}"))
    right, left = numbers["flange_contact_mm"]
    rows = [
        ("equivalent conicity at 3 mm", numbers["conicity_3mm"], ".4f", ""),
        ("wavelength at 3 mm", numbers["wavelength_3mm"], ".2f", " m"),
        ("position of rest", numbers["rest_mm"], ".3f", " mm"),
        ("flange contact to the left from", left, ".2f", " mm"),
        ("flange contact to the right from", right, ".2f", " mm"),
    ]
    print_rows(
        [
            (what, "none" if value is None else f"{value:{form}}{unit}")
            for what, value, form, unit in rows
        ]
    )
    for path in numbers.get("files", ()):
        print(path)
