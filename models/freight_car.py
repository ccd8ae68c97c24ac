"""A freight car on three-piece trucks: what friction does to its stability, empty and loaded.

Run `python models/freight_car.py`. It prints how the car stands, the modes of the stuck car, the
linear critical speed over the friction of its wedges, and how it hunts, and keeps under runs/out/
(or --out)

    freight_car.png               critical speed over wedge friction; hunting; what a wedge does
    freight_car_<load>_hunt.csv   the simulated motions, as pandas reads them
    freight_car.json              the numbers, with the vehicles and all versions

`--json` prints the numbers only, each for "empty" and "loaded":

    wheel_loads  left and right of each wheelset [N]
    modes        of the stuck car at 20 m/s below 15 Hz: name, frequency [Hz], damping ratio
    neutral      how many states friction leaves open
    critical     linear critical speed [m/s] by wedge friction; null where none is found
    hunt         speed [m/s], amplitude [mm] of the leading wheelset in the first and last second,
                 greatest strain of a wedge's hold (1: it slips), outcome
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset import Motion, catalogue, linear_critical_speed, linearise, simulate
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import run_script, script_parser
from exudyn_wheelset.front.tables import print_modes
from exudyn_wheelset.front.vehicle_options import add_change_options, chosen_changes
from exudyn_wheelset.vehicles.statics import static_equilibrium

FRICTIONS = (0.0, 0.1, 0.2, 0.4, 0.6)
MODES_AT = 20.0  # [m/s]
# Speed over the linear critical one, first shift [m]: pushed to the flange the empty car hunts
# below its Hopf point; at much the same speed the loaded one sways, a little above its own.
HUNTS = {"empty": (0.9, 8e-3), "loaded": (1.2, 8e-3)}
HUNT = 6.0  # [s]
WEDGE = "front left front wedge"
NUMBERS = ("wheel_loads", "modes", "neutral", "critical", "hunt")


def run(
    *, wedge_friction: float = 0.4, out: str | Path | None = None, progress: bool = False,
    **changes: Any,
) -> dict[str, Any]:  # fmt: skip
    """Everything the header names; changes: see `catalogue.Changes`."""
    numbers: dict[str, Any] = {name: {} for name in NUMBERS}
    motions: dict[str, Motion] = {}
    for load, (share, shift) in HUNTS.items():
        options = {"loaded": load == "loaded", **changes}
        car = catalogue.freight_car(wedge_friction=wedge_friction, **options)
        rest = static_equilibrium(car)
        numbers["wheel_loads"][load] = {n: list(pair) for n, pair in rest.wheel_loads.items()}
        stuck = linearise(car, MODES_AT)
        numbers["modes"][load] = [
            [name, root.imag / (2.0 * np.pi), -root.real / abs(root)]
            for name, root in stuck.oscillations()
        ]
        numbers["neutral"][load] = sum(name.startswith("neutral") for name in stuck.mode_names)
        found = {mu: _critical(mu, **options) for mu in sorted({*FRICTIONS, wedge_friction})}
        numbers["critical"][load] = {f"{mu:g}": speed for mu, speed in found.items()}
        at = share * (found[wedge_friction] or MODES_AT)
        motions[load] = simulate(car, at, HUNT, start=shift, progress=progress)
        numbers["hunt"][load] = _hunt(motions[load])
    if out is not None:
        numbers["files"] = _keep(Path(out), numbers, motions)
    return numbers


def _critical(wedge_friction: float, **options: Any) -> float | None:
    """Linear critical speed [m/s], None where no hunting begins between the speeds searched."""
    car = catalogue.freight_car(wedge_friction=wedge_friction, **options)
    try:
        return linear_critical_speed(car, *catalogue.entry("freight_car").searched).speed
    except AnalysisError:
        return None


def _hunt(motion: Motion) -> dict[str, Any]:
    lateral, second = motion["front leading: y"], int(1.0 / (motion.time[1] - motion.time[0]))
    holds = [values for name, values in motion.columns.items() if "wedge" in name]
    return {
        "speed": motion.speed,
        "amplitude_mm": [500.0 * float(np.ptp(y)) for y in (lateral[:second], lateral[-second:])],
        "greatest_hold": max(float(np.abs(hold).max()) for hold in holds),
        "outcome": str(motion.outcome),
    }


def _keep(out: Path, numbers: dict[str, Any], motions: dict[str, Motion]) -> list[str]:
    files = [motion.write_csv(out / f"freight_car_{k}_hunt.csv") for k, motion in motions.items()]
    figure, ((over,), (hunting,), (wedge,)) = new_figure(7.5, 9.0, rows=3)
    for load, motion in motions.items():
        found = numbers["critical"][load]
        over.plot([float(mu) for mu in found], list(found.values()), "o-", markersize=3, label=load)
        label = f"{load}, {motion.speed:.1f} m/s"
        hunting.plot(motion.time, 1e3 * motion["front leading: y"], linewidth=0.9, label=label)
        hold = next(n for n in motion.columns if f"{WEDGE} lateral hold" in n)
        last = motion.after(max(0.0, motion.time[-1] - 0.7))
        sliding = last["front bolster: y"] - last["front left frame: y"]
        wedge.plot(1e3 * sliding, last.columns[hold], linewidth=0.9, label=label)
    over.set(xlabel="friction of the wedges [-]", ylabel="linear critical speed [m/s]")
    hunting.set(xlabel="time [s]", ylabel="y of the leading wheelset [mm]")
    wedge.set(xlabel="bolster against side frame, last 0.7 s [mm]", ylabel="friction over slip [-]")
    over.legend(fontsize=8, frameon=False)
    for axes in (hunting, wedge):
        axes.legend(
            fontsize=8, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False
        )
    records = {load: motion.record for load, motion in motions.items()}
    files.append(write_figure(out / "freight_car.png", figure))
    files.append(write_json(out / "freight_car.json", numbers, **records))
    return [str(path) for path in files]


def _show(numbers: dict[str, Any]) -> None:
    for load in HUNTS:
        left, right = numbers["wheel_loads"][load]["front leading"]
        print(f"{load}: {left / 1e3:.2f}, {right / 1e3:.2f} kN on the leading wheels")
        print_modes(numbers["modes"][load][:6], f"of the stuck car at {MODES_AT:g} m/s")
        for mu, speed in numbers["critical"][load].items():
            print(f"    wedge friction {mu:5}: linear critical speed {speed or np.nan:.2f} m/s")
        hunt = numbers["hunt"][load]
        first, last = hunt["amplitude_mm"]
        print(f"    at {hunt['speed']:.2f} m/s: {first:.2f} mm at first, {last:.2f} mm in the end")
    print(*numbers.get("files", ()), sep="\n")


def _run(arguments: argparse.Namespace) -> dict[str, Any]:
    changes = {"wedge_friction": arguments.wedge_friction, **chosen_changes(arguments)}
    return run(out=arguments.out, progress=not arguments.json, **changes)


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser("A freight car on three-piece trucks.", settings=False)
    add_change_options(parser)
    parser.add_argument("--wedge-friction", type=float, default=0.4, help="friction of the wedges")
    return run_script(_run, parser, argv, _show)


if __name__ == "__main__":
    sys.exit(main())
