"""A freight car on three-piece trucks: what friction does to its stability, empty and loaded.

Run `python models/freight_car.py`. It prints how the car stands, the modes of the stuck car, the
linear critical speed over the friction of its wedges, and how it hunts, and keeps under runs/out/
(or --out)

    freight_car.png               critical speed over wedge friction; hunting; how a wedge works
    freight_car_<load>_hunt.csv   the simulated motions, as pandas reads them
    freight_car.json              the numbers, with the vehicles and all versions

`--json` prints the numbers only, each for "empty" and "loaded":

    wheel_loads  left and right of each wheelset [N]
    modes        of the stuck car at 20 m/s below 15 Hz: name, frequency [Hz], damping ratio
    neutral      how many states friction leaves open
    critical     linear critical speed [m/s] by wedge friction; null where none is found
    hunt         speed [m/s], amplitude [mm] of the leading wheelset after the start and at the end,
                 greatest strain of a wedge's hold (1: it slips), outcome
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset import catalogue
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import run_script, script_parser
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.linearisation import linearise
from exudyn_wheelset.systems.simulation import simulate
from exudyn_wheelset.vehicles.statics import static_equilibrium

LOADS = {"empty": False, "loaded": True}
FRICTIONS = (0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
MODES_AT = 20.0  # [m/s]
# Speed over the linear critical one, first shift [m]: the empty car hunts below its Hopf point if
# it is pushed to the flange, the loaded one sways above it.
HUNTS = {"empty": (0.95, 8e-3), "loaded": (1.15, 3e-3)}
HUNT = 6.0  # [s]
WEDGE = "front left front wedge"


def run(
    *,
    frictions: Sequence[float] = FRICTIONS,
    wedge_friction: float = 0.4,
    out: str | Path | None = None,
    progress: bool = False,
    **changes: Any,
) -> dict[str, Any]:
    """Everything the header names; changes: see `catalogue.Changes`."""
    names = ("wheel_loads", "modes", "neutral", "critical", "hunt")
    numbers: dict[str, Any] = {name: {} for name in names}
    motions: dict[str, Motion] = {}
    records = {}
    for load, loaded in LOADS.items():
        options = {"loaded": loaded, **changes}
        car = catalogue.freight_car(wedge_friction=wedge_friction, **options)
        rest = static_equilibrium(car)
        numbers["wheel_loads"][load] = {n: list(pair) for n, pair in rest.wheel_loads.items()}
        stuck = linearise(car, MODES_AT)
        numbers["modes"][load] = [
            [name, float(root.imag / (2.0 * np.pi)), float(-root.real / abs(root))]
            for name, root in zip(stuck.mode_names, stuck.eigenvalues, strict=True)
            if 0.05 < root.imag / (2.0 * np.pi) < 15.0
        ]
        numbers["neutral"][load] = sum(name.startswith("neutral") for name in stuck.mode_names)
        numbers["critical"][load] = {f"{mu:g}": _critical(mu, **options) for mu in frictions}
        critical = _critical(wedge_friction, **options) or MODES_AT
        share, shift = HUNTS[load]
        motions[load] = simulate(car, share * critical, HUNT, start=shift, progress=progress)
        numbers["hunt"][load] = _hunt(motions[load])
        records[load] = motions[load].record
    if out is not None:
        numbers["files"] = _keep(Path(out), numbers, motions, records)
    return numbers


def _critical(wedge_friction: float, **options: Any) -> float | None:
    """Linear critical speed [m/s], None where no hunting begins between the speeds searched."""
    car = catalogue.freight_car(wedge_friction=wedge_friction, **options)
    try:
        return linear_critical_speed(car, *catalogue.entry("freight_car").searched).speed
    except AnalysisError:
        return None


def _hunt(motion: Motion) -> dict[str, Any]:
    lateral = motion["front leading: y"]
    second = max(2, int(1.0 / (motion.time[1] - motion.time[0])))
    holds = [name for name in motion.columns if "wedge" in name and name.endswith("hold")]
    return {
        "speed": motion.speed,
        "amplitude_mm": [
            500.0 * float(np.ptp(part)) for part in (lateral[:second], lateral[-second:])
        ],
        "greatest_hold": max(float(np.abs(motion[name]).max()) for name in holds),
        "outcome": str(motion.outcome),
    }


def _keep(
    out: Path, numbers: dict[str, Any], motions: dict[str, Motion], records: dict[str, Any]
) -> list[str]:
    files = [
        motion.write_csv(out / f"freight_car_{load}_hunt.csv") for load, motion in motions.items()
    ]
    figure, panels = new_figure(7.5, 9.0, rows=3)
    over, hunting, wedge = panels[:, 0]
    for load, motion in motions.items():
        found = numbers["critical"][load]
        over.plot([float(mu) for mu in found], list(found.values()), "o-", markersize=3, label=load)
        label = f"{load}, {motion.speed:.1f} m/s"
        lateral = motion["front leading: y"]
        hunting.plot(motion.time, 1e3 * lateral, linewidth=0.9, label=label)
        hold = next(n for n in motion.columns if n.endswith(f"{WEDGE} lateral hold"))
        sliding = motion["front bolster: y"] - motion["front left frame: y"]
        wedge.plot(1e3 * sliding, motion[hold], linewidth=0.7, label=label)
    over.set_xlabel("friction of the wedges [-]")
    over.set_ylabel("linear critical speed [m/s]")
    hunting.set_xlabel("time [s]")
    hunting.set_ylabel("y of the leading wheelset [mm]")
    wedge.set_xlabel("bolster against side frame, lateral [mm]")
    wedge.set_ylabel("lateral friction over slip force [-]")
    for axes in (over, hunting, wedge):
        axes.legend(fontsize=8, frameon=False)
    files.append(write_figure(out / "freight_car.png", figure))
    files.append(write_json(out / "freight_car.json", numbers, **records))
    return [str(path) for path in files]


def _show(numbers: dict[str, Any]) -> None:
    for load in LOADS:
        left, right = numbers["wheel_loads"][load]["front leading"]
        print(f"{load}: {left / 1e3:.2f}, {right / 1e3:.2f} kN on the leading wheels")
        print(f"    stuck at {MODES_AT:g} m/s ({numbers['neutral'][load]} neutral states):")
        for name, frequency, damping in numbers["modes"][load][:6]:
            print(f"    {name:36} {frequency:6.2f} Hz, damping ratio {damping:+.4f}")
        for friction, speed in numbers["critical"][load].items():
            said = "no linear critical speed" if speed is None else f"{speed:.2f} m/s"
            print(f"    wedge friction {friction:5}: {said}")
        hunt = numbers["hunt"][load]
        first, last = hunt["amplitude_mm"]
        print(
            f"    at {hunt['speed']:.2f} m/s: {first:.2f} mm at first, {last:.2f} mm at the end, "
            f"wedges to {hunt['greatest_hold']:.2f} of slipping; {hunt['outcome']}"
        )
    for path in numbers.get("files", ()):
        print(path)


def _run(arguments: argparse.Namespace) -> dict[str, Any]:
    changes = {"friction": arguments.friction, "creep": arguments.creep}
    return run(
        wedge_friction=arguments.wedge_friction,
        out=None if arguments.json else arguments.out,
        progress=not arguments.json,
        **{name: value for name, value in changes.items() if value is not None},
    )


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser("A freight car on three-piece trucks.", settings=False)
    parser.add_argument("--wedge-friction", type=float, default=0.4, help="friction of the wedges")
    parser.add_argument("--friction", type=float, help="friction of wheel and rail")
    parser.add_argument("--creep", help="creep law")
    return run_script(_run, parser, argv, _show)


if __name__ == "__main__":
    sys.exit(main())
