"""Equivalent conicity of a wheelset on its track, with the figure of its contact geometry.

Run `python models/conicity.py --wheel S1002 --rail UIC60 --gauge 1.435`; wheel and rail are names
or profile files. It prints the conicity over the amplitude, and keeps under runs/out/ (or --out)

    conicity_<wheel>_<rail>.png   rolling-radius difference, equivalent conicity, contact angle,
                                  contact positions and the contact-point connection plot
    conicity_<wheel>_<rail>_shifts.csv      contact over the lateral shift, every 0.02 mm
    conicity_<wheel>_<rail>_amplitudes.csv  conicity over the amplitude, every 0.1 mm

All shifts are taken at rail level, where the wheels stand; `--shift axle` takes those of the axle's
centre, `--shift level` leaves roll out. `--json` prints the numbers only: conicity by amplitude in
mm, the value at 3 mm, the position of rest and the shifts at which the flanges touch.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.contact_plots import SHIFT_TEXTS, contact_figure, flange_contact
from exudyn_wheelset.front.output import write_figure
from exudyn_wheelset.front.script import (
    add_profile_options,
    run_script,
    script_parser,
    script_profile,
)
from exudyn_wheelset.geometry.conicity import METHODS, equivalent_conicity, kinematic_oscillation
from exudyn_wheelset.geometry.rigid import ContactGeometry
from exudyn_wheelset.geometry.rolling_radius import SHIFTS, rolling_radius_curve
from exudyn_wheelset.profiles import Profile, load_profile
from exudyn_wheelset.results.files import write_columns

ProfileSource = Profile | str | PathLike

SHIFT_SPACING = 2.0e-5
DRAWN_AMPLITUDES = 1e-4 * np.arange(5, 101)
TABLE_AMPLITUDES_MM = tuple(float(value) for value in range(1, 11))
# Contact geometry does not ask for mass and inertia; a description of a wheelset does.
_ANY_MASS, _ANY_INERTIA = 1000.0, (600.0, 100.0, 600.0)


def run(
    wheel: ProfileSource = "S1002",
    rail: ProfileSource = "UIC60",
    gauge: float = 1.435,
    inclination: float = 1.0 / 40.0,
    radius: float = 0.46,
    tape_half_distance: float = 0.75,
    right_wheel: ProfileSource | None = None,
    right_rail: ProfileSource | None = None,
    right_radius: float | None = None,
    origin_half_distance: float | None = None,
    amplitudes_mm: Sequence[float] = TABLE_AMPLITUDES_MM,
    reach: float = 15.0e-3,
    neglect_roll: bool = False,
    method: str = "integration",
    shift: str = "rail",
    gauge_depth: float = 0.014,
    out: str | PathLike | None = None,
) -> dict[str, Any]:
    """Equivalent conicity by amplitude, position of rest and flange contact, as a dictionary.

    wheel, rail, right_wheel, right_rail: profile, name or path; gauge, radius, right_radius,
    tape_half_distance, origin_half_distance, gauge_depth [m]; inclination [-]; reach [m]: largest
    shift looked at; shift: "rail", "axle" or "level", see `rolling_radius_curve`; neglect_roll:
    the same as "level", as in EN 15302's reference; method: see `equivalent_conicity`; out:
    directory for figure and tables. A conicity is None where no oscillation of that amplitude
    exists or it would leave the rails.
    """
    wheelset = Wheelset(
        _ANY_MASS,
        _ANY_INERTIA,
        radius,
        load_profile(wheel, kind="wheel"),
        tape_half_distance,
        None if right_wheel is None else load_profile(right_wheel, kind="wheel"),
        right_radius,
    )
    track = Track(
        load_profile(rail, kind="rail"),
        gauge,
        gauge_depth,
        inclination=inclination,
        right_rail=None if right_rail is None else load_profile(right_rail, kind="rail"),
        origin_half_distance=origin_half_distance,
    )
    shift = "level" if neglect_roll else shift
    y, difference, geometry = rolling_radius_curve(wheelset, track, reach, SHIFT_SPACING, shift)
    geometry = replace(geometry, y=y)
    spacing = 2.0 * tape_half_distance
    wanted = [*amplitudes_mm, 3.0]
    conicity = _conicity(y, difference, 1e-3 * np.array(wanted), spacing, radius, method)
    numbers: dict[str, Any] = {
        "wheel": wheelset.wheel.name,
        "rail": track.rail.name,
        "shift": shift,
        "conicity_3mm": _number(conicity[-1]),
        "conicity": {
            f"{at:g}": _number(value) for at, value in zip(wanted[:-1], conicity[:-1], strict=True)
        },
        "rest_mm": _rest_mm(y, difference),
        "flange_contact_mm": _flange_contact_mm(geometry),
        "wavelength_3mm": _wavelength(y, difference, spacing, wheelset),
    }
    if out is not None:
        drawn = _conicity(y, difference, DRAWN_AMPLITUDES, spacing, radius, method)
        numbers["files"] = _keep(Path(out), wheelset, track, geometry, drawn, shift)
    return numbers


def _conicity(
    y: np.ndarray,
    difference: np.ndarray,
    amplitudes: np.ndarray,
    spacing: float,
    radius: float,
    method: str,
) -> np.ndarray:
    """Conicity, NaN at amplitudes that reach beyond the shifts with contact."""

    def at(amplitude: float) -> float:
        return float(equivalent_conicity(y, difference, amplitude, spacing, radius, method))

    # A position of rest must exist: this small amplitude raises if it does not.
    at(1.0e-4)
    values = []
    for amplitude in amplitudes:
        try:
            values.append(at(float(amplitude)))
        except WheelsetError:
            if not amplitude > 0.0:
                raise
            values.append(np.nan)
    return np.array(values)


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _rest_mm(y: np.ndarray, difference: np.ndarray) -> float | None:
    """Shift at which both radii agree, nearest to the middle [mm]."""
    motion = kinematic_oscillation(y, difference, 1.0e-5)
    return _number(round(0.5e3 * (motion.lowest + motion.highest), 6) + 0.0)


def _wavelength(
    y: np.ndarray, difference: np.ndarray, spacing: float, wheelset: Wheelset
) -> float | None:
    """Wavelength of the kinematic oscillation of 3 mm [m]."""
    radius = 0.5 * (wheelset.radius + (wheelset.right_radius or wheelset.radius))
    try:
        return _number(kinematic_oscillation(y, difference, 3.0e-3, spacing, radius).wavelength)
    except WheelsetError:
        return None


def _flange_contact_mm(geometry: ContactGeometry) -> list[float | None]:
    """Shifts to the right and to the left at which a flange begins to carry [mm]."""
    touching = flange_contact(geometry)
    right, left = geometry.y[touching & (geometry.y < 0.0)], geometry.y[touching & (geometry.y > 0)]
    return [
        float(1e3 * right.max()) if right.size else None,
        float(1e3 * left.min()) if left.size else None,
    ]


def _keep(
    out: Path,
    wheelset: Wheelset,
    track: Track,
    geometry: ContactGeometry,
    conicity: np.ndarray,
    shift: str,
) -> list[str]:
    """Write figure and tables; return their paths."""
    stem = f"conicity_{wheelset.wheel.name}_{track.rail.name}"
    stem = re.sub(r"[^\w.-]+", "_", stem)
    columns = {
        "y_mm": 1e3 * geometry.y,
        "rolling_radius_difference_mm": 1e3 * geometry.rolling_radius_difference,
        "roll_mrad": 1e3 * geometry.roll,
        "z_mm": 1e3 * geometry.z,
    }
    for name, side in (("left", geometry.left), ("right", geometry.right)):
        columns[f"{name}_wheel_y_mm"] = 1e3 * side.wheel_y
        columns[f"{name}_rail_y_mm"] = 1e3 * side.rail_y
        columns[f"{name}_angle_deg"] = np.degrees(side.angle)
        columns[f"{name}_radius_mm"] = 1e3 * side.radius
    by_amplitude = {"amplitude_mm": 1e3 * DRAWN_AMPLITUDES, "conicity": conicity}
    figure = contact_figure(wheelset, track, geometry, DRAWN_AMPLITUDES, conicity, shift)
    return [
        str(path)
        for path in (
            write_figure(out / f"{stem}.png", figure),
            write_columns(out / f"{stem}_shifts.csv", columns),
            write_columns(out / f"{stem}_amplitudes.csv", by_amplitude),
        )
    ]


def main(argv: Sequence[str] | None = None) -> int:
    """Run from the command line; exit status."""
    parser = script_parser(str(__doc__).splitlines()[0], settings=False)
    add = parser.add_argument
    add_profile_options(parser)
    add("--right-wheel", help="right wheel, if it differs")
    add("--right-rail", help="right rail, if it differs")
    add("--origin-half-distance", type=float, help="[m], places the rail profiles' origins instead")
    add("--radius", type=float, default=0.46, help="of the left wheel at the tape circle [m]")
    add("--right-radius", type=float, help="right wheel, if it differs [m]")
    add("--tape-half-distance", type=float, default=0.75, help="axle's centre to tape circle [m]")
    add("--amplitudes-mm", type=float, nargs="+", default=list(TABLE_AMPLITUDES_MM), metavar="MM")
    add("--method", choices=METHODS, default=METHODS[0])
    add(
        "--shift",
        choices=SHIFTS,
        default=SHIFTS[0],
        help="at rail level, of the axle, roll left out",
    )
    add("--neglect-roll", action="store_true", help="the same as --shift level")

    def run_arguments(arguments: argparse.Namespace) -> dict[str, Any]:
        values = vars(arguments).copy()
        smoothing = values.pop("smoothing")
        del values["json"]
        for name in ("wheel", "rail", "right_wheel", "right_rail"):
            values[name] = script_profile(values[name], name.removeprefix("right_"), smoothing)
        return run(**values)

    return run_script(run_arguments, parser, argv, _print_table)


def _print_table(numbers: dict[str, Any]) -> None:
    print(f"{numbers['wheel']} on {numbers['rail']}, {SHIFT_TEXTS[numbers['shift']]}")
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
    for what, value, form, unit in rows:
        print(f"{what:34s}" + ("none" if value is None else f"{value:{form}}{unit}"))
    for path in numbers.get("files", ()):
        print(path)


if __name__ == "__main__":
    sys.exit(main())
