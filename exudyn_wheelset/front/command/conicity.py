"""`exudyn-wheelset conicity`: equivalent conicity of a wheelset on its track.

All shifts are taken at rail level, where the wheels stand; `--shift axle` takes those of the axle's
centre, `--shift level` leaves roll out. The numbers: conicity by amplitude in mm, the value and the
wavelength [m] at 3 mm, the position of rest and the shifts at which the flanges touch.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.front.contact_plots import SHIFT_TEXTS, keep_conicity
from exudyn_wheelset.front.script import add_profile_options, own_options, script_profile
from exudyn_wheelset.front.tables import print_conicity
from exudyn_wheelset.geometry.conicity import METHODS
from exudyn_wheelset.geometry.rolling_pair import rolling_pair
from exudyn_wheelset.geometry.rolling_radius import SHIFTS
from exudyn_wheelset.profiles import Profile

ABOUT = (
    "Prints tan(gamma_e) over the amplitude, the position of rest and where the flanges touch.\n"
    "With --out: figure with rolling radii, contact angles and the connection plot, two tables."
)
EXAMPLES = (
    "conicity --wheel S1002 --rail UIC60 --gauge 1.435 --inclination 1:40",
    "conicity --wheel worn.whl --smoothing auto --rail UIC60 --gauge 1.437 --out figures",
    "conicity --wheel S1002 --amplitudes-mm 3 --json",
)
SETTINGS = False

ProfileSource = Profile | str | PathLike[str]

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
    out: str | PathLike[str] | None = None,
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
        _ANY_MASS, _ANY_INERTIA, radius, wheel, tape_half_distance, right_wheel, right_radius
    )
    track = Track(
        rail,
        gauge,
        gauge_depth,
        inclination,
        right_rail,
        origin_half_distance=origin_half_distance,
    )
    pair = rolling_pair(wheelset, track, reach, "level" if neglect_roll else shift)
    numbers = pair.numbers(amplitudes_mm, method)
    if out is not None:
        numbers["files"] = [str(path) for path in keep_conicity(Path(out), pair, method)]
    return numbers


def add_options(parser: argparse.ArgumentParser) -> None:
    """Profiles, track, what differs on the right, amplitudes and method."""
    add_profile_options(parser)
    add = parser.add_argument
    add("--right-wheel", help="right wheel, if it differs")
    add("--right-rail", help="right rail, if it differs")
    where = "places the rail profiles' origins instead of the gauge [m]"
    add("--origin-half-distance", type=float, metavar="M", help=where)
    add("--radius", type=float, default=0.46, metavar="M", help="of the left wheel, 0.46 m")
    add("--right-radius", type=float, metavar="M", help="of the right wheel, if it differs [m]")
    add("--tape-half-distance", type=float, default=0.75, metavar="M", help="0.75 m")
    add("--amplitudes-mm", type=float, nargs="+", default=list(TABLE_AMPLITUDES_MM), metavar="MM")
    add("--method", choices=METHODS, default=METHODS[0], help=f"default {METHODS[0]}")
    where = "of what the shift is taken: at rail level, of the axle, roll left out"
    add("--shift", choices=SHIFTS, default=SHIFTS[0], help=where)
    add("--neglect-roll", action="store_true", help="the same as --shift level")


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """Numbers of the pair that the options name."""
    values = own_options(arguments)
    smoothing = values.pop("smoothing")
    for name in ("wheel", "rail", "right_wheel", "right_rail"):
        values[name] = script_profile(values[name], name.removeprefix("right_"), smoothing)
    return run(**values)


def show(numbers: dict[str, Any]) -> None:
    """Print the table."""
    print_conicity(numbers, SHIFT_TEXTS[numbers["shift"]])
