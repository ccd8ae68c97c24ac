"""Rigid contact geometry of a wheelset over its lateral shift: Figure 3 of the paper.

Run `python models/contact_geometry.py` for AAR 1:20 wheels on UIC60 rails at the paper's gauge of
1432 mm and S1002 wheels at 1435 mm, or give a pair: `--wheel my_wheel.txt --rail UIC60
--gauge 1.435`. For each pair under runs/out/: roll angle, height, contact angles and rolling radii
with their piecewise polynomials (figure and CSV), the profiles in contact at a few shifts, and a
comparison of the two ways to find the roll angle.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from tqdm import tqdm

from exudyn_wheelset import Track, Wheelset, contact_geometry, piecewise_geometry
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.geometry_plots import keep_geometry
from exudyn_wheelset.front.output import write_json
from exudyn_wheelset.front.plots import pair_name
from exudyn_wheelset.front.script import (
    add_profile_options,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.front.tables import print_geometry
from exudyn_wheelset.geometry.piecewise import PiecewiseGeometry
from exudyn_wheelset.geometry.rigid import ContactGeometry
from exudyn_wheelset.geometry.summary import compare_methods, geometry_numbers

STEP = 1.0e-5
OPTIONS_OF_A_PAIR = ("radius", "tape_half_distance", "half_range")


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
    **track: float,
) -> Pair:
    """Wheel and rail by name or file; track: gauge, gauge_depth, inclination. Lengths [m]."""
    if not 1.0e-4 <= half_range <= 0.05:
        raise WheelsetError(f"half range = {half_range!r} m: give 0.1 mm to 50 mm, in metres")
    # The wheelset's mass has no influence here.
    wheelset = Wheelset(1.0e3, (600.0, 100.0, 600.0), radius, wheel, tape_half_distance)
    return Pair(wheelset, Track(rail, **track), half_range)


def default_pairs() -> list[Pair]:
    """The paper's pair and the European one."""
    return [
        pair("AAR_1_20", gauge=1.432, radius=0.3556, half_range=0.012),
        pair("S1002", gauge=1.435, radius=0.46, half_range=0.008),
    ]


def examine(pair: Pair) -> Result:
    """Contact geometry of one pair."""
    wheelset, track, reach = pair.wheelset, pair.track, pair.half_range
    y = np.linspace(-reach, reach, 2 * round(reach / STEP) + 1)
    geometry = contact_geometry(wheelset, track, y)
    pieces = piecewise_geometry(wheelset, track, half_range=reach, representation="polynomial")
    numbers = geometry_numbers(wheelset, track, geometry, pieces)
    numbers["methods"] = compare_methods(wheelset, track, reach)
    return Result(pair, geometry, pieces, numbers)


def run(pairs: Sequence[Pair] | None = None, progress: bool = False) -> dict[str, Any]:
    """Numbers of each pair by its name: jumps, polynomials, comparison of methods (SI)."""
    found = results(pairs, progress)
    return {pair_name(one.pair.wheelset, one.pair.track): one.numbers for one in found}


def results(pairs: Sequence[Pair] | None = None, progress: bool = False) -> list[Result]:
    """Contact of each pair."""
    chosen = default_pairs() if pairs is None else pairs
    return [examine(one) for one in tqdm(chosen, disable=not progress, unit="pair")]


def show(numbers: dict[str, Any]) -> None:
    """Print what was found."""
    for name, found in numbers.items():
        print_geometry(name, found)


def pairs_from(arguments: argparse.Namespace, parser: argparse.ArgumentParser) -> list[Pair] | None:
    """The pair that the options name; None, for the script's own pairs, where they name none."""
    given = profiles_from(arguments).changes
    own = {name: getattr(arguments, name) for name in OPTIONS_OF_A_PAIR}
    if "wheel" in given:
        return [pair(**given, **own)]
    changed = [*given, *(name for name, value in own.items() if value != parser.get_default(name))]
    if changed:
        options = ", ".join(f"--{name.replace('_', '-')}" for name in changed)
        raise WheelsetError(f"{options} needs a wheel: give --wheel as well")
    return None


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser(__doc__.splitlines()[0], settings=False)
    add_profile_options(parser, defaults=False)
    add = parser.add_argument
    add("--radius", type=float, default=0.46, help="at the tape circle [m]")
    add("--tape-half-distance", type=float, default=0.75, help="centre to tape circle [m]")
    add("--half-range", type=float, default=0.008, help="largest shift [m]")

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        numbers = {}
        for found in results(pairs_from(arguments, parser), progress=not arguments.json):
            wheelset, track = found.pair.wheelset, found.pair.track
            numbers[pair_name(wheelset, track)] = found.numbers
            files = keep_geometry(arguments.out, wheelset, track, found.geometry, found.pieces)
            if not arguments.json:
                print("wrote", ", ".join(str(file) for file in files), file=sys.stderr)
        write_json(arguments.out / "contact_geometry.json", numbers)
        return numbers

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
