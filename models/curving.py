"""A coach through a curve: straight, transition, curve, transition, and the steady curve.

Run `python models/curving.py`. It prints what the steady curve asks of every wheelset and how the
simulated curve ends, and keeps under runs/out/ (or --out)

    curving.png    over the distance: lateral shifts, angles of attack, wheel loads, Y/Q
    curving.csv    the motion, as pandas reads it
    curving.json   the numbers, with the vehicle and all versions

`--json` prints the numbers only:

    steady         of each wheelset: y [mm], angle of attack [mrad], Q and Y [kN], Y/Q and wear
                   numbers [N], left and right
    limits         Nadal's limit of Y/Q at 70 degrees, limit of the sum of Y [kN]
    greatest       2 m means of the run: Y/Q, |sum of Y| [kN]; unloading [-]
    difference     of the end of the simulated curve from the steady one: y [mm], Q [-]
    outcome        of the run
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset import Motion, simulate
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import finished, run_script, script_parser
from exudyn_wheelset.front.vehicle_options import (
    add_vehicle_options,
    chosen_changes,
    named_vehicle,
)
from exudyn_wheelset.results.running_safety import nadal_limit, sum_of_y_limit
from exudyn_wheelset.systems.steady_curve import SteadyCurve, steady_curve
from exudyn_wheelset.track.layout import Curve, Layout, Straight, Transition

STRAIGHT, TRANSITION, CURVE = 30.0, 60.0, 150.0  # [m]
FLANGE = math.radians(70.0)


def run(
    *, vehicle: str = "manchester_coach", radius: float = 300.0, cant: float = 0.12,
    speed: float = 18.0, shape: str = "bloss", out: str | Path | None = None,
    progress: bool = False, **changes: Any,
) -> dict[str, Any]:  # fmt: skip
    """Everything the header names; radius, cant [m], speed [m/s]; changes: `catalogue.Changes`."""
    car = named_vehicle(vehicle, **changes)
    curve = steady_curve(car, radius, cant, speed)
    ends = [Straight(STRAIGHT), Transition(TRANSITION, shape)]
    layout = Layout([*ends, Curve(radius, CURVE, cant), *reversed(ends)])
    on_line = car.on(replace(car.track, layout=layout))
    motion = simulate(on_line, speed, (layout.length - 15.0) / speed, progress=progress)
    friction = car.contact.friction
    axle_load = float(motion.static_loads().sum(axis=1).mean())
    _, quotient = motion.sliding_mean(motion.guiding_quotient())
    _, lateral = motion.sliding_mean(motion.sum_of_y())
    # The last wheelset is still in the curve, the first has not left it.
    end = int(np.argmin(np.abs(motion.distance - (STRAIGHT + TRANSITION + CURVE - 12.0))))
    numbers = {
        "steady": {
            name: {
                "y_mm": 1e3 * curve.y[k],
                "angle_of_attack_mrad": 1e3 * curve.yaw[k],
                "Q_kN": (1e-3 * curve.Q[k]).tolist(),
                "Y_kN": (1e-3 * curve.Y[k]).tolist(),
                "Y/Q": curve.guiding_quotient()[k].tolist(),
                "wear_N": curve.wear_number()[k].tolist(),
            }
            for k, name in enumerate(curve.wheelsets)
        },
        "limits": {
            "nadal": nadal_limit(FLANGE, friction),
            "sum_of_y_kN": 1e-3 * sum_of_y_limit(axle_load),
        },
        "greatest": {
            "Y/Q": float(np.nanmax(quotient)),
            "sum_of_y_kN": 1e-3 * float(np.abs(lateral).max()),
            "unloading": float(motion.unloading().max()),
        },
        "difference": {
            "y_mm": 1e3 * float(np.abs(motion.y[end] - curve.y).max()),
            "Q": float(np.abs(motion.Q[end] / curve.Q - 1.0).max()),
        },
        "outcome": str(motion.outcome),
    }
    if out is not None:
        numbers["files"] = _keep(Path(out), numbers, motion, curve)
    return finished(numbers, [motion])


def _keep(out: Path, numbers: dict[str, Any], motion: Motion, curve: SteadyCurve) -> list[str]:
    figure, ((shift,), (attack,), (load,), (quotient,)) = new_figure(7.5, 10.0, rows=4)
    outer = 1 if curve.radius > 0.0 else 0
    for k, name in enumerate(motion.wheelsets):
        shift.plot(motion.distance, 1e3 * motion.y[:, k], linewidth=0.9, label=name)
        attack.plot(motion.distance, 1e3 * motion.yaw[:, k], linewidth=0.9)
        load.plot(motion.distance, 1e-3 * motion.Q[:, k, outer], linewidth=0.7)
        centres, means = motion.sliding_mean(motion.guiding_quotient()[:, k, outer])
        quotient.plot(centres, means, linewidth=0.9)
    quotient.axhline(numbers["limits"]["nadal"], color="0.5", linewidth=0.7, linestyle="--")
    shift.set(ylabel="y [mm]")
    attack.set(ylabel="angle of attack [mrad]")
    load.set(ylabel="Q, outer wheels [kN]")
    quotient.set(xlabel="distance [m]", ylabel="Y/Q, outer, 2 m means [-]")
    shift.legend(fontsize=8, frameon=False)
    files = [motion.write_csv(out / "curving.csv"), write_figure(out / "curving.png", figure)]
    files.append(write_json(out / "curving.json", numbers, motion=motion.record))
    return [str(path) for path in files]


def _show(numbers: dict[str, Any]) -> None:
    for name, of in numbers["steady"].items():
        print(
            f"{name:16} y {of['y_mm']:+6.2f} mm, attack {of['angle_of_attack_mrad']:+5.2f} "
            f"mrad, Y/Q {of['Y/Q'][0]:+.2f} left, {of['Y/Q'][1]:+.2f} right"
        )
    greatest, limits = numbers["greatest"], numbers["limits"]
    print(f"greatest Y/Q over 2 m {greatest['Y/Q']:.2f}, Nadal {limits['nadal']:.2f}")
    print(f"|sum of Y| {greatest['sum_of_y_kN']:.1f} kN, limit {limits['sum_of_y_kN']:.1f} kN")
    print(numbers["outcome"], *numbers.get("files", ()), sep="\n")


def _run(arguments: argparse.Namespace) -> dict[str, Any]:
    given = {name: getattr(arguments, name) for name in ("radius", "cant", "speed", "shape")}
    given |= {"vehicle": arguments.vehicle, **chosen_changes(arguments)}
    return run(out=arguments.out, progress=not arguments.json, **given)


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser("A coach through a curve.", settings=False)
    add_vehicle_options(parser, "manchester_coach")
    parser.add_argument("--radius", type=float, default=300.0, help="[m], positive to the left")
    parser.add_argument("--cant", type=float, default=0.12, help="of the outer rail [m]")
    parser.add_argument("--speed", type=float, default=18.0, help="[m/s]")
    parser.add_argument("--shape", default="bloss", help="of the transitions")
    return run_script(_run, parser, argv, _show)


if __name__ == "__main__":
    sys.exit(main())
