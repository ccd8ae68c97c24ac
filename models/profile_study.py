"""Every wheel of a folder on every rail of another: conicity, critical speeds, the worst pairs.

Run `python models/profile_study.py --wheels FOLDER --rails FOLDER --vehicle s1002`; vehicles are
those of `exudyn_wheelset.catalogue`, or files. For each pair:

    conicity_2mm, 3mm, 4mm   equivalent conicity by EN 15302 at these amplitudes [-]
    nonlinearity             (conicity at 4 mm - conicity at 2 mm)/2 mm [1/mm]: falling conicity
                             lets small hunting grow to large at once (O. Polach, Vehicle System
                             Dynamics 48, supplement (2010) 19-36)
    linear, nonlinear        critical speeds [m/s]
    reason                   why a pair has none

Pairs are kept in `profile_study.jsonl` under `--out` as they are done: a run that was ended goes on
from there. Table (CSV), map and a list of the pairs with the lowest speeds land beside it.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset import nonlinear_critical_speed
from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.front import script
from exudyn_wheelset.front.output import write_figure
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.vehicle_options import ChosenVehicle, named_vehicle
from exudyn_wheelset.geometry.conicity import equivalent_conicity
from exudyn_wheelset.geometry.rolling_radius import rolling_radius_curve
from exudyn_wheelset.profiles import load_profile
from exudyn_wheelset.stability.linear.crossings import hopf_points
from exudyn_wheelset.stability.subject import as_system, description_of
from exudyn_wheelset.studies import Study, files, study

AMPLITUDES_MM = (2, 3, 4)
REACH = 7.0e-3  # [m]: 4 mm and the way of the centre


def pair(
    case: dict[str, Any], name: str, smoothing: float | str, changes: Sequence[Sequence[Any]]
) -> dict[str, Any]:
    """The numbers of a pair of profiles under a vehicle; changes: pairs for `catalogue.Changes`."""
    wheel = load_profile(case["wheel"], kind="wheel", smoothing=smoothing)
    rail = load_profile(case["rail"], kind="rail", smoothing=smoothing)
    found = description_of(named_vehicle(name, wheel=wheel, rail=rail, **dict(changes)))
    wheelset = found.wheelsets[0].wheelset
    curve = rolling_radius_curve(wheelset, found.track, REACH)
    amplitudes = [1e-3 * amplitude for amplitude in AMPLITUDES_MM]
    conicity = equivalent_conicity(curve.y, curve.rolling_radius_difference, amplitudes)
    numbers: dict[str, Any] = {
        f"conicity_{a}mm": float(c) for a, c in zip(AMPLITUDES_MM, conicity, strict=True)
    }
    numbers["nonlinearity"] = 0.5 * (numbers["conicity_4mm"] - numbers["conicity_2mm"])
    system = as_system(found)
    hopf = [p for p in hopf_points(system, *ChosenVehicle(name).searched) if p.slope > 0.0]
    numbers["linear"] = hopf[0].speed if hopf else None
    if hopf:
        try:
            speed = nonlinear_critical_speed(system, hopf=hopf[0], check=False)
            numbers["nonlinear"] = speed.speed
        except AnalysisError as error:
            numbers["nonlinear"], numbers["note"] = None, str(error)
    return numbers


def run(
    wheels: str | PathLike,
    rails: str | PathLike,
    vehicle: str = "s1002",
    *,
    pattern: str = "*.*",
    smoothing: float | str = "auto",
    gauge: float | None = None,
    inclination: float | None = None,
    processes: int | None = None,
    out: str | PathLike | None = None,
) -> dict[str, Any]:
    """The study of all pairs, by rising critical speed; with `out`, its files."""
    named_vehicle(vehicle)
    axles, tracks = files(wheels, pattern, name="wheel"), files(rails, pattern, name="rail")
    cases = [{**wheel, **rail} for wheel in axles for rail in tracks]
    asked = {"gauge": gauge, "inclination": inclination}
    changes = {name: value for name, value in asked.items() if value is not None}
    settings = {"name": vehicle, "smoothing": smoothing, "changes": list(changes.items())}
    stem = None if out is None else Path(out) / "profile_study"
    found = study(pair, cases, processes, stem and f"{stem}.jsonl", settings=settings)
    kept = [found.save_csv(f"{stem}.csv")] if stem else []
    if stem and "nonlinear" in found.table:
        figure, axes = new_figure(7.0, 5.0)
        found.map("wheel", "rail", "nonlinear", ax=axes[0, 0])
        kept.append(write_figure(f"{stem}.png", figure))
    return {"pairs": len(found), "ranked": ranked(found), "files": list(map(str, kept))}


def ranked(found: Study) -> list[dict[str, Any]]:
    """Rows by rising nonlinear, then linear critical speed; pairs without one come last."""

    def key(row: dict[str, Any]) -> tuple[float, float]:
        speeds = [row.get(name) for name in ("nonlinear", "linear")]
        nonlinear, linear = (np.inf if s is None or np.isnan(s) else s for s in speeds)
        return min(nonlinear, linear), linear

    return sorted(found.table.rows, key=key)


def show(numbers: dict[str, Any]) -> None:
    """Print the worst pairs."""
    print(f"{numbers['pairs']} pairs; the lowest critical speeds:")
    for row in numbers["ranked"][:20]:
        names = f"{Path(row['wheel']).name} on {Path(row['rail']).name}"
        if row["reason"]:
            print(f"  {names}: {row['reason']}")
            continue
        values = [row[k] for k in ("nonlinear", "linear", "conicity_3mm", "nonlinearity")]
        texts = ["{:8.2f}", "{:8.2f}", "{:7.3f}", "{:+8.4f}"]
        shown = [t.format(np.nan if v is None else v) for t, v in zip(texts, values, strict=True)]
        print("  nonlinear {} linear {} m/s  conicity {}  nonlinearity {}".format(*shown), names)


def main(argv: Sequence[str] | None = None) -> int:
    """Run from the command line; exit status."""
    parser = script.script_parser(str(__doc__).splitlines()[0], settings=False)
    add = parser.add_argument
    add("--wheels", help="folder of wheel profiles")
    add("--rails", help="folder of rail profiles")
    add("--vehicle", default="s1002", help="name of the catalogue, or a file")
    add("--pattern", default="*.*", help="of the files' names")
    add("--smoothing", type=script.smoothing_of, default="auto", help="'auto', or 0 for none")
    add("--gauge", type=float, help="[m]; default the vehicle's own")
    add("--inclination", type=script.inclination_of, help="of the rails; 0 if measured in place")
    add("--processes", type=int, help="default: as many as there are cores")

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        values = script.own_options(arguments)
        if not values["wheels"] or not values["rails"]:
            raise WheelsetError("give folders of profiles: --wheels FOLDER --rails FOLDER")
        return run(**values)

    return script.run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
