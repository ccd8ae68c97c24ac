"""`exudyn-wheelset geometry`: rigid contact of wheels and rails over the lateral shift."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from tqdm import tqdm

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.contact_view import contact_view
from exudyn_wheelset.front.geometry_plots import keep_geometry
from exudyn_wheelset.front.output import write_json
from exudyn_wheelset.front.plots import pair_name
from exudyn_wheelset.front.script import add_profile_options, profiles_from
from exudyn_wheelset.front.tables import print_geometry
from exudyn_wheelset.geometry.piecewise import PiecewiseGeometry, piecewise_geometry
from exudyn_wheelset.geometry.rigid import ContactGeometry, contact_geometry
from exudyn_wheelset.geometry.summary import compare_methods, geometry_numbers

ABOUT = (
    "Roll angle, height, contact angles and rolling radii of a pair, exact and as piecewise\n"
    "polynomials. With --out: figures, tables (CSV) and numbers (JSON)."
)
EXAMPLES = (
    "geometry --wheel S1002 --rail UIC60 --out figures",
    "geometry --wheel S1002 --show",
    "geometry --wheel measured/axle3.whl --smoothing auto --rail UIC60 --gauge 1.437 --json",
)
SETTINGS = False
STEP = 1.0e-5


@dataclass(frozen=True)
class Pair:
    """A wheelset on a track and the shifts to look at, |y| <= half_range [m]."""

    wheelset: Wheelset
    track: Track
    half_range: float


@dataclass(frozen=True)
class Result:
    """Contact of a pair: exact, as polynomials, and the numbers about both."""

    pair: Pair
    geometry: ContactGeometry
    pieces: PiecewiseGeometry
    numbers: dict[str, Any]


def pair(
    wheel: Any,
    rail: Any = "UIC60",
    radius: float = 0.46,
    tape_half_distance: float = 0.75,
    half_range: float = 0.008,
    **track: Any,
) -> Pair:
    """Wheel and rail by name or file; track: gauge, gauge_depth, inclination. Lengths [m]."""
    if not 1.0e-4 <= half_range <= 0.05:
        raise WheelsetError(f"half range = {half_range!r} m: give 0.1 mm to 50 mm, in metres")
    # The wheelset's mass has no influence here.
    wheelset = Wheelset(1.0e3, (600.0, 100.0, 600.0), radius, wheel, tape_half_distance)
    return Pair(wheelset, Track(rail, **track), half_range)


def examine(pair: Pair) -> Result:
    """Contact geometry of one pair."""
    wheelset, track, reach = pair.wheelset, pair.track, pair.half_range
    y = np.linspace(-reach, reach, 2 * round(reach / STEP) + 1)
    geometry = contact_geometry(wheelset, track, y)
    pieces = piecewise_geometry(wheelset, track, half_range=reach, representation="polynomial")
    numbers = geometry_numbers(wheelset, track, geometry, pieces)
    numbers["methods"] = compare_methods(wheelset, track, reach)
    return Result(pair, geometry, pieces, numbers)


def results(pairs: Sequence[Pair], progress: bool = False) -> list[Result]:
    """Contact of each pair."""
    return [examine(one) for one in tqdm(pairs, disable=not progress, unit="pair")]


def add_options(parser: argparse.ArgumentParser) -> None:
    """Those of a pair, and whether to look at it."""
    add_pair_options(parser)
    words = "open a window with sliders for shift and yaw"
    parser.add_argument("--show", action="store_true", help=words)


def add_pair_options(parser: argparse.ArgumentParser, defaults: bool = True) -> None:
    """Profiles, track, and how far to look; defaults: of the profiles, S1002 on UIC60."""
    add_profile_options(parser, defaults=defaults)
    add = parser.add_argument
    add("--radius", type=float, default=0.46, metavar="M", help="at the tape circle, 0.46 m")
    add("--tape-half-distance", type=float, default=0.75, metavar="M", help="0.75 m")
    add("--half-range", type=float, default=0.008, metavar="M", help="largest shift, 0.008 m")


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """Numbers of the pair that the options name, by its name."""
    given = profiles_from(arguments).changes
    own = {name: getattr(arguments, name) for name in ("radius", "tape_half_distance")}
    chosen = pair(**given, **own, half_range=arguments.half_range)
    if arguments.show:
        _shown(chosen)
    return kept([chosen], arguments)


def _shown(chosen: Pair) -> None:
    """Open a window, where there is a display."""
    import matplotlib.pyplot as plt

    view = contact_view(chosen.wheelset, chosen.track, max(0.012, chosen.half_range))
    if plt.get_backend().lower() == "agg":
        raise WheelsetError("--show needs a display; --out FOLDER keeps figures without one")
    view.show()


def kept(pairs: Sequence[Pair], arguments: argparse.Namespace) -> dict[str, Any]:
    """Numbers of pairs by name; with --out, their figures, tables and numbers."""
    numbers: dict[str, Any] = {}
    for found in results(pairs, progress=not arguments.json):
        wheelset, track = found.pair.wheelset, found.pair.track
        numbers[pair_name(wheelset, track)] = found.numbers
        if arguments.out is not None:
            files = keep_geometry(arguments.out, wheelset, track, found.geometry, found.pieces)
            found.numbers["files"] = [str(file) for file in files]
    if arguments.out is not None:
        write_json(arguments.out / "contact_geometry.json", numbers)
    return numbers


def show(numbers: dict[str, Any]) -> None:
    """Print what was found."""
    for name, found in numbers.items():
        print_geometry(name, found)
        print(*found.get("files", ()), sep="\n")
