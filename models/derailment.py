"""How much lateral force lifts a flange over its rail: Nadal's limit, angle of attack, friction.

Run `python models/derailment.py`. A wheelset rolls steadily at a held yaw, both wheels carrying
alike, and is pushed sideways over the flank of its left flange: Y/Q of that wheel at every shift,
its greatest value is the limit. It prints the limits beside Nadal's, and keeps under runs/out/ (or
--out)

    derailment.png    limit over friction and over the angle of attack; Y/Q over the shift
    derailment.json   the numbers, with all versions

`--json` prints the numbers only:

    flange_angle   steepest of the wheel [rad]
    friction       limits by friction at 40 mrad, with Nadal's
    attack         limits by angle of attack [mrad] at friction 0.3

The limit is reached from above as the angle grows: at small angles part of the slip is along the
rail, and friction does not point straight up the flank as Nadal's does.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import root

from exudyn_wheelset.contact.descriptions import Contact, Track, Wheelset
from exudyn_wheelset.contact.wheelset_contact import contact_forces
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import run_script, script_parser
from exudyn_wheelset.front.vehicle_options import add_creep_option, law_changes
from exudyn_wheelset.geometry.rigid import contact_geometry
from exudyn_wheelset.results.running_safety import nadal_limit

WHEELSET = Wheelset(mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=0.46, wheel="S1002")
TRACK = Track("UIC60")
LOAD, SPEED = 50.0e3, 10.0  # of a wheel [N]; [m/s]
FRICTIONS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
ATTACKS = (2.0, 5.0, 10.0, 20.0, 40.0)  # [mrad]
# From both wheels on their treads over the flank of the flange [m].
SHIFTS = np.linspace(5.0e-3, 8.5e-3, 36)


def climb(attack: float, friction: float, creep: str = "exact-table", **law: Any) -> np.ndarray:
    """Y/Q of the left wheel at SHIFTS, NaN where both wheels cannot carry; attack: yaw [rad].

    law: the contact's options beside it, such as law_parameters.
    Unknown are height, roll and spin, from both wheel loads and the free rolling of the axle.
    """
    contact = Contact(creep=creep, friction=friction, **law)
    geometry = contact_geometry(WHEELSET, TRACK, SHIFTS)
    found = np.full(len(SHIFTS), np.nan)
    guess: np.ndarray | None = None
    for k, shift in enumerate(SHIFTS):
        start = np.array([geometry.z[k] - 8e-5, geometry.roll[k], 1.0])
        for begin in (start, guess) if guess is not None else (start,):
            solved = root(_unbalanced, begin, args=(shift, attack, contact), method="hybr")
            if np.abs(solved.fun).max() < 1e-4:
                guess = solved.x
                found[k] = _quotient(_forces(solved.x, shift, attack, contact))
                break
    return found


def _forces(unknown: np.ndarray, shift: float, attack: float, contact: Contact) -> Any:
    height, roll, ratio = unknown
    spin = ratio * SPEED / WHEELSET.radius
    # The nose towards the rail: yaw to the left under the left flange.
    velocity = (SPEED, 0.0, 0.0, -spin * np.sin(attack), spin * np.cos(attack), 0.0)
    pose = (0.0, shift, height, roll, 0.0, attack)
    return contact_forces(WHEELSET, TRACK, pose, velocity, contact=contact)


def _of_wheel(patches: Any) -> tuple[float, float]:
    lateral = sum(p.normal[2] * p.fy + p.normal[1] * p.normal_force for p in patches)
    vertical = sum(p.normal[2] * p.normal_force - p.normal[1] * p.fy for p in patches)
    return lateral, vertical


def _unbalanced(unknown: np.ndarray, shift: float, attack: float, contact: Contact) -> list[float]:
    forces = _forces(unknown, shift, attack, contact)
    left, right = _of_wheel(forces.left)[1], _of_wheel(forces.right)[1]
    axle = -np.sin(attack) * forces.moment[0] + np.cos(attack) * forces.moment[1]
    return [left / LOAD - 1.0, right / LOAD - 1.0, axle / (WHEELSET.radius * LOAD)]


def _quotient(forces: Any) -> float:
    lateral, vertical = _of_wheel(forces.left)
    return -lateral / vertical


def run(*, creep: str = "exact-table", out: str | Path | None = None, **law: Any) -> dict[str, Any]:
    """Everything the header names."""
    y = np.linspace(*WHEELSET.wheel.span, 4001)
    slope = np.gradient(WHEELSET.wheel.height(y), y)
    flange = float(np.arctan(slope[(y < -0.02) & (y > -0.05)].max()))
    curves = {mu: climb(0.04, mu, creep, **law) for mu in FRICTIONS}
    attacks = {attack: climb(1e-3 * attack, 0.3, creep, **law) for attack in ATTACKS}
    numbers: dict[str, Any] = {
        "flange_angle": flange,
        "friction": {
            f"{mu:g}": {"limit": float(np.nanmax(curve)), "nadal": nadal_limit(flange, mu)}
            for mu, curve in curves.items()
        },
        "attack": {f"{attack:g}": float(np.nanmax(curve)) for attack, curve in attacks.items()},
    }
    if out is not None:
        figure, ((over,), (along,)) = new_figure(7.0, 7.0, rows=2)
        pairs = numbers["friction"].values()
        over.plot(FRICTIONS, [pair["nadal"] for pair in pairs], "--", label="Nadal")
        over.plot(FRICTIONS, [pair["limit"] for pair in pairs], "o", label="40 mrad")
        over.set(xlabel="friction [-]", ylabel="greatest Y/Q [-]")
        for attack, curve in attacks.items():
            along.plot(1e3 * SHIFTS, curve, linewidth=0.9, label=f"{attack:g} mrad")
        along.set(xlabel="y [mm]", ylabel="Y/Q at friction 0.3 [-]")
        for axes in (over, along):
            axes.legend(fontsize=8, frameon=False)
        paths = [write_figure(Path(out) / "derailment.png", figure)]
        paths.append(write_json(Path(out) / "derailment.json", numbers))
        numbers["files"] = [str(path) for path in paths]
    return numbers


def _show(numbers: dict[str, Any]) -> None:
    print(f"flange angle {np.degrees(numbers['flange_angle']):.1f} degrees")
    for mu, pair in numbers["friction"].items():
        print(f"friction {mu}: Y/Q up to {pair['limit']:.3f}, Nadal {pair['nadal']:.3f}")
    for attack, limit in numbers["attack"].items():
        print(f"angle of attack {attack:>3} mrad: Y/Q up to {limit:.3f}")
    print(*numbers.get("files", ()), sep="\n")


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser("How much lateral force lifts a flange.", settings=False)
    add_creep_option(parser, "exact-table")

    def chosen(arguments: argparse.Namespace) -> dict[str, Any]:
        return run(out=arguments.out, **law_changes(arguments.creep))

    return run_script(chosen, parser, argv, _show)


if __name__ == "__main__":
    sys.exit(main())
