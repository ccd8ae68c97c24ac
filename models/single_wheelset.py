"""A wheelset released beside the track centre, below and above its critical speed.

Run `python models/single_wheelset.py`. The full Exudyn model of the paper's wheelset (six degrees
of freedom, profiled wheels and rails, springs to a frame that moves at constant speed) is shifted
sideways and let go: below the critical speed the motion dies away, above it the wheelset hunts.
The measured growth rates stand beside those of the eigenvalues. Figure, time histories and numbers
land under runs/out/; `--picture` and `--film` draw the wheelset on its rails.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import exudyn as exu

from exudyn_wheelset import Motion, WheelsetOnFrame, catalogue, linear_critical_speed, load_settings
from exudyn_wheelset.catalogue import paper_wheelset as paper
from exudyn_wheelset.checking import number
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.front.motion_plots import released_figure
from exudyn_wheelset.front.output import keep_runs
from exudyn_wheelset.front.pictures import draw_film, draw_picture
from exudyn_wheelset.front.plots import pair_name
from exudyn_wheelset.front.script import (
    DEFAULT_OUT,
    add_profile_options,
    finished,
    get_ready,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.front.settings import changed_settings, output_of
from exudyn_wheelset.front.tables import print_growth
from exudyn_wheelset.front.vehicle_options import add_creep_option, law_changes
from exudyn_wheelset.stability.linear.simulated_growth import compare_growth

DEFAULT_SETTINGS = Path(__file__).resolve().parents[1] / "runs" / "rk44.json"
SEARCHED_SPEEDS = (10.0, 300.0)
FACTORS = (0.85, 1.15)
OFFSET = 1.0e-3


def vehicle(spring_set: int = 1, driven: bool = False, **changes: Any) -> WheelsetOnFrame:
    """The paper's wheelset; changes: profiles, track and contact, see `catalogue.Changes`."""
    model = catalogue.vehicle(f"paper-{spring_set}", **changes)
    name = f"the paper's wheelset, set {spring_set}" + ("" if driven else ", free spin")
    return replace(model, driven=driven, name=name)


def run(
    model: WheelsetOnFrame | None = None,
    speeds: Sequence[float] | None = None,
    offset: float = OFFSET,
    settings: exu.SimulationSettings | None = None,
    duration: float | None = None,
    progress: bool = False,
) -> tuple[dict[str, Any], list[Motion]]:
    """Numbers and motions at `speeds` [m/s], by default 0.85 and 1.15 of the critical speed.

    After Ctrl-C the motions so far are returned; the last one's outcome says so.
    """
    model = model or vehicle()
    settings = settings or load_settings(DEFAULT_SETTINGS)
    number("offset", abs(offset), "m", 1e-9, 0.03, "a lateral offset, in metres")
    system = model.dynamic_system(settings=settings)
    numbers: dict[str, Any] = {"critical_speed": None, "frequency": None, "offset": offset}
    try:
        critical = linear_critical_speed(system, *SEARCHED_SPEEDS)
        numbers |= {"critical_speed": critical.speed, "frequency": critical.frequency}
    except AnalysisError:
        if speeds is None:
            raise
    if speeds is None:
        speeds = [factor * numbers["critical_speed"] for factor in FACTORS]
    speeds = [number("speed", speed, "m/s", 0.1, 200.0) for speed in speeds]
    numbers["runs"], motions = compare_growth(
        system, speeds, *output_of(settings, duration), offset=offset, progress=progress
    )
    return numbers, motions


def show(numbers: dict[str, Any]) -> None:
    """Print growth rates beside eigenvalues and how each run ended."""
    if numbers["critical_speed"] is not None:
        critical, frequency = numbers["critical_speed"], numbers["frequency"]
        print(f"\nlinear critical speed {critical:.3f} m/s at {frequency:.3f} Hz")
    print_growth(numbers["runs"])


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser(__doc__.splitlines()[0], settings=DEFAULT_SETTINGS)
    add = parser.add_argument
    add("--set", type=int, choices=(1, 2, 3), default=1, help="springs of Table 1")
    own = {"gauge": paper.GAUGE, "inclination": paper.INCLINATION}
    add_profile_options(parser, wheel=paper.WHEEL, rail=paper.RAIL, **own)
    add("--speed", type=float, nargs="+", help="[m/s]; default: 0.85 and 1.15 of the critical")
    add("--offset", type=float, default=OFFSET, help="lateral, at the release [m]")
    add("--duration", type=float, help="[s]; default: that of the settings")
    add_creep_option(parser, "polach")
    add("--friction", type=float, help="coefficient; default: that of Table 2")
    add("--driven", action="store_true", help="hold the spin at V/r0")
    add("--picture", action="store_true", help="draw the wheelset on its rails")
    add("--film", action="store_true", help="a film of the last run's end")

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        changes = {**law_changes(arguments.creep), **profiles_from(arguments).changes}
        if arguments.friction is not None:
            changes["friction"] = arguments.friction
        model = vehicle(arguments.set, arguments.driven, **changes)
        settings = get_ready(arguments)
        numbers, motions = run(
            model,
            arguments.speed,
            arguments.offset,
            settings,
            arguments.duration,
            not arguments.json,
        )
        title = f"{model.name}: {pair_name(model.wheelset, model.track)}"
        if numbers["critical_speed"] is not None:
            title += f", critical speed {numbers['critical_speed']:.2f} m/s"
        figure = released_figure(motions, numbers["runs"], "wheelset", title)
        about = {"parameters": model.parameters(), "settings": changed_settings(settings)}
        out = arguments.out or DEFAULT_OUT
        if arguments.out is not None:
            keep_runs(out / "single_wheelset", numbers, motions, figure, **about)
        if arguments.picture:
            draw_picture(out / "single_wheelset_picture.png", model, motions[-1])
        if arguments.film:
            draw_film(out / "single_wheelset.gif", model, motions[-1])
        return finished(numbers, motions)

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
