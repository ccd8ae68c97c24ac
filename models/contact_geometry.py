"""Rigid contact geometry of a wheelset over its lateral shift: Figure 3 of the paper.

Run `python models/contact_geometry.py` for AAR 1:20 wheels on UIC60 rails at the paper's gauge of
1432 mm and S1002 wheels at 1435 mm, or give a pair: `--wheel my_wheel.txt --rail UIC60
--gauge 1.435`. For each pair under runs/out/: roll angle, height, contact angles and rolling radii
with their piecewise polynomials (figure and CSV), the profiles in contact at a few shifts, and a
comparison of the two ways to find the roll angle.
"""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.geometry_plots import draw_contact_geometry, draw_wheels_on_rails
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.front.script import (
    add_profile_options,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.geometry.piecewise import (
    COLUMNS,
    PiecewiseGeometry,
    geometry_columns,
    piecewise_geometry,
)
from exudyn_wheelset.geometry.rigid import METHODS, ContactGeometry, contact_geometry
from exudyn_wheelset.results.files import write_columns

STEP = 1.0e-5
COMPARED_SHIFTS = 41
OPTIONS_OF_A_PAIR = ("radius", "tape_half_distance", "half_range")


@dataclass(frozen=True)
class Pair:
    """A wheelset on a track and the shifts to look at, |y| <= half_range [m]."""

    wheelset: Wheelset
    track: Track
    half_range: float

    @property
    def name(self) -> str:
        return f"{self.wheelset.wheel.name} on {self.track.rail.name}"


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
    gauge: float = 1.435,
    inclination: float = 1.0 / 40.0,
    radius: float = 0.46,
    tape_half_distance: float = 0.75,
    half_range: float = 0.008,
    gauge_depth: float = 0.014,
) -> Pair:
    """Wheel and rail by name or file; lengths [m]. The wheelset's mass has no influence here."""
    if not 1.0e-4 <= half_range <= 0.05:
        raise WheelsetError(f"half range = {half_range!r} m: give 0.1 mm to 50 mm, in metres")
    wheelset = Wheelset(
        mass=1.0e3,
        inertia=(600.0, 100.0, 600.0),
        radius=radius,
        wheel=wheel,
        tape_half_distance=tape_half_distance,
    )
    track = Track(rail, gauge=gauge, gauge_depth=gauge_depth, inclination=inclination)
    return Pair(wheelset, track, half_range)


def default_pairs() -> list[Pair]:
    """The paper's pair and the European one."""
    return [
        pair("AAR_1_20", gauge=1.432, radius=0.3556, half_range=0.012),
        pair("S1002", gauge=1.435, radius=0.46, half_range=0.008),
    ]


def examine(pair: Pair) -> Result:
    """Contact geometry of one pair."""
    count = 2 * round(pair.half_range / STEP) + 1
    y = np.linspace(-pair.half_range, pair.half_range, count)
    geometry = contact_geometry(pair.wheelset, pair.track, y)
    pieces = piecewise_geometry(
        pair.wheelset, pair.track, half_range=pair.half_range, representation="polynomial"
    )
    centre = count // 2
    touching = y[geometry.double_point_contact(tolerance=1.0e-6)]
    slope = np.gradient(geometry.rolling_radius_difference, y)
    numbers = {
        "gauge": pair.track.gauge,
        "inclination": pair.track.inclination,
        "radius": pair.wheelset.radius,
        "tape_half_distance": pair.wheelset.tape_half_distance,
        "height_at_rest": geometry.z[centre],
        "contact_angle_at_rest": geometry.left.angle[centre],
        "wheel_contact_at_rest": geometry.left.wheel_y[centre],
        "half_slope_of_radius_difference_at_rest": 0.5 * slope[centre],
        "jumps": pieces.jumps.tolist(),
        "double_point_contact": touching.tolist(),
        "polynomials": {
            "degrees": list(pieces.degrees),
            "breaks": pieces.breaks.tolist(),
            "residuals": {
                name: pieces.residuals[:, column].tolist() for column, name in enumerate(COLUMNS)
            },
        },
        "methods": compare_methods(pair),
    }
    return Result(pair, geometry, pieces, numbers)


def compare_methods(pair: Pair) -> dict[str, Any]:
    """Time and agreement of the bracketed root and of the paper's Nelder-Mead minimisation.

    Both have run once before the clock starts: what is compiled or loaded then does not count.
    """
    y = np.linspace(-pair.half_range, pair.half_range, COMPARED_SHIFTS)
    for method in METHODS:
        contact_geometry(pair.wheelset, pair.track, y[:2], method=method)
    found: dict[str, ContactGeometry] = {}
    seconds = {}
    for method, repeats in (("root", 5), ("nelder-mead", 1)):
        taken = []
        for _ in range(repeats):
            start = time.perf_counter()
            found[method] = contact_geometry(pair.wheelset, pair.track, y, method=method)
            taken.append(time.perf_counter() - start)
        seconds[method] = min(taken)
    exact, minimised = found["root"], found["nelder-mead"]
    return {
        "shifts": len(y),
        "root_seconds": seconds["root"],
        "nelder_mead_seconds": seconds["nelder-mead"],
        "times_faster": seconds["nelder-mead"] / seconds["root"],
        "largest_roll_difference": float(np.abs(exact.roll - minimised.roll).max()),
        "largest_height_difference": float(np.abs(exact.z - minimised.z).max()),
    }


def run(pairs: Sequence[Pair] | None = None, progress: bool = False) -> dict[str, Any]:
    """Numbers of each pair by its name: jumps, polynomials, comparison of methods (SI)."""
    return {result.pair.name: result.numbers for result in results(pairs, progress)}


def results(pairs: Sequence[Pair] | None = None, progress: bool = False) -> list[Result]:
    """Contact of each pair."""
    chosen = default_pairs() if pairs is None else pairs
    return [examine(one) for one in tqdm(chosen, disable=not progress, unit="pair")]


def draw(out: Path, result: Result) -> list[Path]:
    """Write Figure 3, the profiles in contact and the data of one pair; return the files."""
    pair, geometry = result.pair, result.geometry
    stem = f"contact_geometry_{pair.wheelset.wheel.name}_{pair.track.rail.name}"
    stem = re.sub(r"[^\w.+-]+", "_", stem)
    figure, axes = new_figure(10.5, 7.0, 2, 2)
    draw_contact_geometry(axes, geometry, result.pieces)
    degrees = result.pieces.degrees
    figure.suptitle(
        f"{pair.name}, gauge {pair.track.gauge * 1e3:.0f} mm, inclination "
        f"1:{1 / pair.track.inclination:.0f}"
        * (pair.track.inclination != 0.0)
        + f"\n{len(degrees)} polynomials of degree {min(degrees)} to {max(degrees)}; "
        "dotted: a contact point jumps",
        fontsize=11,
    )
    files = [write_figure(out / f"{stem}.png", figure)]

    shown = shifts_to_show(result)
    figure, axes = new_figure(9.5, 2.9 * len(shown), len(shown), 2)
    for row, shift in zip(axes, shown, strict=True):
        draw_wheels_on_rails(
            row,
            pair.wheelset,
            pair.track,
            contact_geometry(pair.wheelset, pair.track, [shift]),
            0,
        )
        row[0].set_ylabel("z [mm]")
    for panel in axes[-1]:
        panel.set_xlabel("y in the track frame [mm], left positive")
    figure.suptitle(f"{pair.name}, seen from behind", fontsize=11)
    files.append(write_figure(out / f"{stem}_profiles.png", figure))

    columns = dict(zip(COLUMNS, geometry_columns(geometry).T, strict=True))
    columns = {
        "y": geometry.y,
        **columns,
        "left_second_gap": geometry.left.second_gap,
        "right_second_gap": geometry.right.second_gap,
    }
    files.append(write_columns(out / f"{stem}.csv", columns))
    return files


def shifts_to_show(result: Result) -> list[float]:
    """Centred, half-way to the flange, and the flange contact after the last jump."""
    jumps = result.pieces.jumps[result.pieces.jumps > 0.0]
    reach = result.pair.half_range
    edge = jumps[-1] if len(jumps) else reach
    return [0.0, 0.5 * edge, min(edge + 2.0e-4, reach)]


def show(numbers: dict[str, Any]) -> None:
    """Print what was found."""
    for name, pair in numbers.items():
        methods, fits = pair["methods"], pair["polynomials"]

        def residual(what: str, of: dict[str, list[float]] = fits["residuals"]) -> float:
            return max(max(values) for name, values in of.items() if name.endswith(what))

        print(f"\n{name}, gauge {pair['gauge'] * 1e3:.0f} mm")
        rows = [
            ("at rest: height", f"{pair['height_at_rest'] * 1e3:.4f} mm"),
            ("contact angle", f"{np.degrees(pair['contact_angle_at_rest']):.3f} deg"),
            ("contact on the wheel", f"{pair['wheel_contact_at_rest'] * 1e3:.3f} mm"),
            ("half slope of r_L - r_R", f"{pair['half_slope_of_radius_difference_at_rest']:.5f}"),
            ("jumps at y [mm]", ", ".join(f"{y * 1e3:.4f}" for y in pair["jumps"]) or "none"),
            ("degrees of the polynomials", ", ".join(str(degree) for degree in fits["degrees"])),
            (
                "largest residuals",
                "of roll " + f"{residual('roll'):.1e} rad, of height {residual('z') * 1e3:.1e} mm,",
            ),
            (
                "",
                f"of contact angles {np.degrees(residual('angle')):.1e} deg, "
                f"of radii {residual('radius') * 1e3:.1e} mm",
            ),
            (
                "bracketed root, Nelder-Mead",
                f"{methods['root_seconds'] * 1e3:.2f} ms, "
                f"{methods['nelder_mead_seconds'] * 1e3:.2f} ms for {methods['shifts']} shifts: "
                f"{methods['times_faster']:.0f} times faster",
            ),
            ("they differ by at most", f"{methods['largest_roll_difference']:.1e} rad in roll"),
        ]
        for what, value in rows:
            print(f"  {what:30s}{value}")


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser(__doc__.splitlines()[0], settings=False)
    add_profile_options(
        parser, wheel=None, rail=None, gauge=None, gauge_depth=None, inclination=None
    )
    parser.add_argument("--radius", type=float, default=0.46, help="at the tape circle [m]")
    parser.add_argument(
        "--tape-half-distance", type=float, default=0.75, help="centre to tape circle [m]"
    )
    parser.add_argument("--half-range", type=float, default=0.008, help="largest shift [m]")

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        profiles = profiles_from(arguments)
        names = ("gauge", "gauge_depth", "inclination")
        given = {name: getattr(profiles, name) for name in names}
        given = {name: value for name, value in given.items() if value is not None}
        own = {name: getattr(arguments, name) for name in OPTIONS_OF_A_PAIR}
        pairs = None
        if profiles.wheel is None:
            changed = [*given, *(["rail"] if arguments.rail else [])]
            changed += [name for name, value in own.items() if value != parser.get_default(name)]
            if changed:
                options = ", ".join(f"--{name.replace('_', '-')}" for name in changed)
                raise WheelsetError(f"{options} needs a wheel: give --wheel as well")
        else:
            pairs = [pair(profiles.wheel, profiles.rail or "UIC60", **given, **own)]
        found = results(pairs, progress=not arguments.json)
        numbers = {result.pair.name: result.numbers for result in found}
        for result in found:
            files = draw(arguments.out, result)
            if not arguments.json:
                print("wrote", ", ".join(str(file) for file in files), file=sys.stderr)
        write_json(arguments.out / "contact_geometry.json", numbers)
        return numbers

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
