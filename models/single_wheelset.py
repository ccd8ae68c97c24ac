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
import numpy as np

from exudyn_wheelset import Ending, Motion, Track, Wheelset, WheelsetOnFrame, linear_critical_speed
from exudyn_wheelset.catalogue import paper_wheelset as paper
from exudyn_wheelset.checking import number
from exudyn_wheelset.compilation import warm_up
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import draw_wheelset_motion, new_figure
from exudyn_wheelset.front.script import (
    add_profile_options,
    print_growth,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.front.settings import changed_settings, load_settings, output_of
from exudyn_wheelset.results.growth import growth_beside
from exudyn_wheelset.stability.linear.linearisation import linearise
from exudyn_wheelset.systems.simulation import simulate

DEFAULT_SETTINGS = Path(__file__).resolve().parents[1] / "runs" / "rk44.json"
SEARCHED_SPEEDS = (10.0, 300.0)
FACTORS = (0.85, 1.15)
OFFSET = 1.0e-3
# A growth rate is measured up to this multiple of the offset and this amplitude [m]: beyond, creep
# saturation starts to show.
LARGEST_GROWTH, LARGEST_AMPLITUDE = 2.0, 3.0e-3
NAME = "wheelset"


def vehicle(
    spring_set: int = 1,
    wheel: Any = None,
    rail: Any = None,
    gauge: float | None = None,
    inclination: float | None = None,
    driven: bool = False,
    gauge_depth: float | None = None,
    **contact: Any,
) -> WheelsetOnFrame:
    """The paper's wheelset, with other profiles, track or contact where they are given."""
    model = paper.paper_wheelset(spring_set, driven=driven, **contact)
    if wheel is not None:
        given = model.wheelset
        model = replace(
            model,
            wheelset=Wheelset(
                given.mass, given.inertia, given.radius, wheel, given.tape_half_distance
            ),
        )
    given_track = {"gauge": gauge, "gauge_depth": gauge_depth, "inclination": inclination}
    changed = {name: value for name, value in given_track.items() if value is not None}
    if changed or rail is not None:
        track = model.track
        own = {name: getattr(track, name) for name in given_track}
        model = replace(
            model, track=Track(track.rail if rail is None else rail, **{**own, **changed})
        )
    return model


def release(
    model: WheelsetOnFrame,
    speed: float,
    offset: float,
    settings: exu.SimulationSettings,
    duration: float | None = None,
    progress: bool = False,
) -> tuple[dict[str, Any], Motion]:
    """Let the wheelset go `offset` [m] beside the centre at `speed` [m/s]; numbers and motion."""
    system = model.dynamic_system(settings=settings)
    span, interval = output_of(settings, duration)
    linear = linearise(system, speed)
    if linear.hunting_row is None:
        raise AnalysisError(f"{system.name}: no lateral oscillation at {speed:g} m/s")
    root = complex(linear.eigenvalues[linear.hunting_row])
    motion = simulate(system, speed, span, offset, interval=interval, progress=progress)
    y = motion[f"{NAME}: y"]
    beside = y - linear.state[system.lateral_indices[0]]
    last_period = motion.time >= motion.time[-1] - 2.0 * np.pi / root.imag
    forces = [motion.wheel(NAME, side)["normal_force [N]"].max() for side in ("left", "right")]
    largest = min(LARGEST_GROWTH * abs(offset), LARGEST_AMPLITUDE)
    finished = motion.outcome.ending is Ending.FINISHED
    numbers = {
        "speed": speed,
        **growth_beside(root, motion.time, beside, largest),
        "maximum_y": float(np.abs(y).max()),
        "final_amplitude": float(np.abs(beside[last_period]).max()),
        "largest_normal_force": float(max(forces)),
        "simulated_time": float(motion.time[-1]),
        "ending": motion.outcome.ending.name,
        "event": None if finished else str(motion.outcome),
    }
    return numbers, motion


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
    numbers: dict[str, Any] = {"critical_speed": None, "frequency": None, "offset": offset}
    try:
        critical = linear_critical_speed(model, *SEARCHED_SPEEDS)
        numbers |= {"critical_speed": critical.speed, "frequency": critical.frequency}
    except AnalysisError:
        if speeds is None:
            raise
    if speeds is None:
        speeds = [factor * numbers["critical_speed"] for factor in FACTORS]
    for speed in speeds:
        number("speed", speed, "m/s", 0.1, 200.0)
    motions = []
    numbers["runs"] = []
    for speed in speeds:
        row, motion = release(model, float(speed), offset, settings, duration, progress)
        numbers["runs"].append(row)
        motions.append(motion)
        if motion.outcome.ending is Ending.INTERRUPTED:
            break
    return numbers, motions


def draw(path: Path, numbers: dict[str, Any], motions: Sequence[Motion], title: str) -> Path:
    """Motion, forces and contact positions, one column for each speed."""
    figure, axes = new_figure(5.6 * len(motions), 10.5, 5, len(motions), sharex="col", sharey=False)
    for column, motion, row in zip(axes.T, motions, numbers["runs"], strict=True):
        draw_wheelset_motion(column, motion, NAME, complex(row["growth_rate_eigenvalue"]))
        measured = row["growth_rate_simulated"]
        column[0].set_title(
            f"{motion.speed:.2f} m/s: growth {row['growth_rate_eigenvalue']:+.3f} 1/s"
            + ("" if measured is None else f", simulated {measured:+.3f} 1/s"),
            fontsize=10,
        )
        if row["event"]:
            column[0].axvline(motion.time[-1], color="black", linewidth=1.0)
            words = motion.outcome.ending.sentence
            at: dict[str, Any] = {"xycoords": ("data", "axes fraction"), "ha": "right", "va": "top"}
            column[0].annotate(words, (motion.time[-1], 0.97), fontsize=7, rotation=90, **at)
    figure.suptitle(title, fontsize=11)
    return write_figure(path, figure)


def draw_picture(path: Path, model: WheelsetOnFrame, motion: Motion) -> Path:
    """Picture of the wheelset on its rails where it was farthest from the centre."""
    from exudyn_wheelset.front.animation import render_motion, show_rails, write_image

    container, mbs, _ = model.build(motion.speed, sensors=False)
    show_rails(mbs, model.track)
    mbs.Assemble()
    farthest = int(np.argmax(np.abs(motion[f"{NAME}: y"])))
    rows = motion.coordinates[[farthest]]
    return write_image(path, render_motion(container, mbs, rows, size=(960, 600), smooth=2)[0])


def draw_film(
    path: Path, model: WheelsetOnFrame, motion: Motion, seconds: float = 2.0, rate: int = 20
) -> Path:
    """Film of the last `seconds` [s] of a motion, seen from behind, close to the left wheel."""
    from exudyn_wheelset.front.animation import Camera, render_motion, show_rails, write_film

    container, mbs, _ = model.build(motion.speed, sensors=False)
    show_rails(mbs, model.track, -0.6, 2.4)
    mbs.Assemble()
    end = motion.time[-1]
    rows = np.searchsorted(motion.time, np.arange(max(0.0, end - seconds), end, 1.0 / rate))
    camera = Camera(
        azimuth=0.0, elevation=0.1, centre=(0.0, 0.73, 0.02), zoom=0.26, perspective=0.1
    )
    frames = render_motion(container, mbs, motion.coordinates[rows], camera, size=(480, 360))
    return write_film(path, frames, rate)


def show(numbers: dict[str, Any]) -> None:
    """Print growth rates beside eigenvalues and how each run ended."""
    if numbers["critical_speed"] is not None:
        critical, frequency = numbers["critical_speed"], numbers["frequency"]
        print(f"\nlinear critical speed {critical:.3f} m/s at {frequency:.3f} Hz")
    print_growth(numbers["runs"])


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser(__doc__.splitlines()[0])
    parser.set_defaults(settings=DEFAULT_SETTINGS)
    parser.add_argument("--set", type=int, choices=(1, 2, 3), default=1, help="springs of Table 1")
    add_profile_options(
        parser,
        wheel=paper.WHEEL,
        rail=paper.RAIL,
        gauge=paper.GAUGE,
        inclination=paper.INCLINATION,
    )
    parser.add_argument(
        "--speed", type=float, nargs="+", help="[m/s]; default: 0.85 and 1.15 of the critical"
    )
    parser.add_argument("--offset", type=float, default=OFFSET, help="lateral, at the release [m]")
    parser.add_argument("--duration", type=float, help="[s]; default: that of the settings")
    parser.add_argument("--creep", default="polach", help="creep law")
    parser.add_argument("--friction", type=float, help="coefficient; default: that of Table 2")
    parser.add_argument("--driven", action="store_true", help="hold the spin at V/r0")
    parser.add_argument("--picture", action="store_true", help="draw the wheelset on its rails")
    parser.add_argument("--film", action="store_true", help="a film of the last run's end")

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        settings = load_settings(arguments.settings)
        contact = {"creep": arguments.creep}
        if arguments.friction is not None:
            contact["friction"] = arguments.friction
        profiles = profiles_from(arguments)
        model = vehicle(
            arguments.set,
            profiles.wheel,
            profiles.rail,
            profiles.gauge,
            profiles.inclination,
            arguments.driven,
            profiles.gauge_depth,
            **contact,
        )
        progress = not arguments.json
        seconds = warm_up()
        if progress:
            print(f"kernels ready in {seconds:.1f} s", file=sys.stderr)
        numbers, motions = run(
            model, arguments.speed, arguments.offset, settings, arguments.duration, progress
        )
        out = arguments.out
        write_json(
            out / "single_wheelset.json",
            numbers,
            parameters=model.parameters(),
            settings=changed_settings(settings),
        )
        for motion in motions:
            motion.write_csv(out / f"single_wheelset_{motion.speed:.2f}.csv")
        title = f"{model.name}: {model.wheelset.wheel.name} on {model.track.rail.name}"
        if numbers["critical_speed"] is not None:
            title += f", critical speed {numbers['critical_speed']:.2f} m/s"
        draw(out / "single_wheelset.png", numbers, motions, title)
        if arguments.picture:
            draw_picture(out / "single_wheelset_picture.png", model, motions[-1])
        if arguments.film:
            draw_film(out / "single_wheelset.gif", model, motions[-1])
        if motions[-1].outcome.ending is Ending.INTERRUPTED:
            if progress:
                show(numbers)
            raise KeyboardInterrupt
        return numbers

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
