"""Numbers of the model scripts printed for people. SI arguments; units stand in the table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any


def print_rows(rows: Sequence[tuple[str, str]], width: int = 34) -> None:
    """Print words and values side by side."""
    for what, value in rows:
        print(f"{what:{width}s}{value}")


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
