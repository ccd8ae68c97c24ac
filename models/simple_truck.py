"""A two-axle truck on profiled rails: wheel loads, critical speed and its mode, growth rates.

Run `python models/simple_truck.py`. The truck is that of the DTU passenger car: a frame and two
wheelsets, each a rigid body with six degrees of freedom, under a car body that runs straight.
It is started in the shape of its critical mode below and above the critical speed; the growth of
the simulated motion stands beside the eigenvalue's. Figure, time histories and numbers land under
runs/out/; `--picture` draws the truck.
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

from exudyn_wheelset.catalogue.truck import Truck, dtu_truck
from exudyn_wheelset.catalogue.wheelset_on_frame import WheelsetOnFrame
from exudyn_wheelset.checking import number
from exudyn_wheelset.compilation import warm_up
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import (
    LEFT_COLOUR,
    RIGHT_COLOUR,
    WHEEL_COLOUR,
    draw_root_locus,
    new_figure,
)
from exudyn_wheelset.front.script import (
    add_profile_options,
    print_growth,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.front.settings import changed_settings, load_settings, output_of
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.results.growth import growth_beside
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.stability.linear.linearisation import linearise, root_locus
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.simulation import simulate
from exudyn_wheelset.systems.starts import wheel_loads as wheel_loads_of

DEFAULT_SETTINGS = Path(__file__).resolve().parents[1] / "runs" / "rk44.json"
SEARCHED_SPEEDS = (15.0, 150.0)
FACTORS = (0.9, 1.1)
DURATION = 6.0
# On S1002 and UIC60 contact passes between two nearly touching places within 0.2 mm: only a motion
# well below that is linear.
AMPLITUDE = 2.0e-5
BODIES = ("leading", "trailing", "frame")
NAMES = dict(
    zip(BODIES, ("truck leading wheelset", "truck trailing wheelset", "truck frame"), strict=True)
)


def wheel_loads(system: ExudynSystem, speed: float) -> dict[str, float]:
    """Vertical force of the rails [N] on each wheel in steady running, and the sum."""
    state = system.equilibrium(speed)
    loads = {
        f"{which} {side}": float(load)
        for which, items in zip(BODIES, system.wheelsets, strict=False)
        for side, load in zip(("left", "right"), wheel_loads_of(system, items, state), strict=True)
    }
    return {**loads, "sum": sum(loads.values())}


def wheelset_alone(truck: Truck) -> WheelsetOnFrame:
    """One of the truck's wheelsets on its primary springs to a frame that does not yield."""
    return WheelsetOnFrame(
        wheelset=truck.wheelset,
        track=truck.track,
        suspension=truck.primary,
        axle_load=truck.axle_load,
        contact=truck.contact,
        driven=truck.driven,
        name=f"wheelset of the {truck.name}",
    )


def mode_shape(point: CriticalPoint) -> dict[str, dict[str, float]]:
    """Size [mm, mrad] and phase [deg] of the mode's lateral motions, the largest of size 1."""
    shape = {}
    for name, value in zip(point.state_names, point.mode, strict=True):
        if any(word in name for word in (": y [m]", "yaw", "roll")):
            short = name.removeprefix("truck ").split(" [")[0]
            shape[short] = {
                "size": float(abs(value) * 1e3),
                "phase": float(np.degrees(np.angle(value))),
            }
    return shape


def simulate_mode(
    system: ExudynSystem,
    critical: CriticalPoint,
    speed: float,
    amplitude: float,
    duration: float,
    interval: float,
    progress: bool = False,
) -> tuple[dict[str, Any], Motion]:
    """Start at `speed` [m/s] in the critical mode, of the given lateral amplitude [m]."""
    linear = linearise(system, speed)
    nearest = int(np.argmin(_distance(linear.eigenvalues, critical)))
    root, mode = complex(linear.eigenvalues[nearest]), linear.eigenvectors[:, nearest]
    lateral = [k for k, name in enumerate(system.state_names) if name.endswith(": y [m]")]
    mode = mode * (amplitude / mode[lateral[int(np.argmax(np.abs(mode[lateral])))]])
    motion = simulate(
        system, speed, duration, linear.state + mode.real, interval=interval, progress=progress
    )
    leading = motion[f"{NAMES['leading']}: y"]
    finished = motion.outcome.ending is Ending.FINISHED
    numbers = {
        "speed": speed,
        **growth_beside(root, motion.time, leading, 2.0 * amplitude),
        "maximum_y": float(np.abs(leading).max()),
        "simulated_time": float(motion.time[-1]),
        "ending": motion.outcome.ending.name,
        "event": None if finished else str(motion.outcome),
    }
    return numbers, motion


def run(
    truck: Truck | None = None,
    amplitude: float = AMPLITUDE,
    settings: exu.SimulationSettings | None = None,
    duration: float = DURATION,
    progress: bool = False,
    factors: Sequence[float] = FACTORS,
) -> tuple[dict[str, Any], list[Motion]]:
    """Numbers of the header, and the motions at `factors` times the critical speed.

    After Ctrl-C the motions so far are returned; the last one's outcome says so.
    """
    truck = truck or dtu_truck()
    settings = settings or load_settings(DEFAULT_SETTINGS)
    duration, interval = output_of(settings, duration)
    number("amplitude", amplitude, "m", 1.0e-7, 0.02, "a lateral amplitude, in metres")
    system = truck.dynamic_system(settings=settings)
    critical = linear_critical_speed(system, *SEARCHED_SPEEDS)
    try:
        alone = linear_critical_speed(wheelset_alone(truck), *SEARCHED_SPEEDS).speed
    except AnalysisError:
        alone = None
    numbers: dict[str, Any] = {
        "weight": truck.weight,
        "wheel_loads": wheel_loads(system, critical.speed),
        "critical_speed": critical.speed,
        "frequency": critical.frequency,
        "critical_speed_of_a_wheelset_on_a_fixed_frame": alone,
        "mode": mode_shape(critical),
        "amplitude": amplitude,
        "runs": [],
    }
    motions: list[Motion] = []
    for factor in factors:
        speed = factor * critical.speed
        row, motion = simulate_mode(
            system, critical, speed, amplitude, duration, interval, progress
        )
        motions.append(motion)
        numbers["runs"].append(row)
        if motion.outcome.ending is Ending.INTERRUPTED:
            break
    return numbers, motions


def _distance(eigenvalues: np.ndarray, critical: CriticalPoint) -> np.ndarray:
    """How far roots are from the critical one; those below the real axis are out of question."""
    root = complex(0.0, abs(critical.eigenvalue.imag))
    return np.where(eigenvalues.imag > 0.0, np.abs(eigenvalues - root), np.inf)


def draw(path: Path, truck: Truck, numbers: dict[str, Any], motions: Sequence[Motion]) -> Path:
    """Root locus, mode seen from above at four phases, and the simulated motions."""
    figure, axes = new_figure(12.0, 7.2, 2, 2)
    critical = numbers["critical_speed"]
    speeds = np.linspace(0.4 * critical, 1.6 * critical, 61)
    locus = root_locus(truck.dynamic_system(), speeds)
    marks = draw_root_locus(axes[0, 0], locus, 12.0, critical)
    axes[0, 0].set_xlim(-10.0, max(1.0, 1.2 * float(np.real(locus.eigenvalues).max())))
    figure.colorbar(marks, ax=axes[0, 0], label="speed [m/s]")
    _draw_mode(axes[0, 1], truck, numbers)
    for panel, motion, row in zip(axes[1], motions, numbers["runs"], strict=False):
        for name, colour in zip(BODIES, (LEFT_COLOUR, RIGHT_COLOUR, WHEEL_COLOUR), strict=True):
            y = motion[f"{NAMES[name]}: y"] * 1e3
            panel.plot(motion.time, y, color=colour, linewidth=1.0, label=name)
        measured = row["growth_rate_simulated"]
        panel.set_title(
            f"{motion.speed:.2f} m/s: growth {row['growth_rate_eigenvalue']:+.3f} 1/s"
            + ("" if measured is None else f", simulated {measured:+.3f} 1/s"),
            fontsize=10,
        )
        panel.set_xlabel("time [s]")
        panel.set_ylabel("y [mm]")
        grows = row["growth_rate_eigenvalue"] > 0.0
        panel.legend(fontsize=8, frameon=False, loc="upper left" if grows else "upper right")
    figure.suptitle(
        f"{truck.name}: {truck.wheelset.wheel.name} on {truck.track.rail.name}", fontsize=11
    )
    return write_figure(path, figure)


def _draw_mode(panel: Any, truck: Truck, numbers: dict[str, Any]) -> None:
    """Axles and frame seen from above at four phases of a period, motion drawn large."""
    mode = numbers["mode"]

    def value(name: str, phase: float) -> float:
        part = mode[name]
        return part["size"] * np.cos(np.radians(part["phase"]) + phase)

    half, side, gap = truck.half_wheelbase, 1.0, 4.6
    scale = 0.35 / max(part["size"] for part in mode.values())
    for k in range(4):
        phase = 0.5 * np.pi * k
        centre = gap * k
        for name, ahead, colour in (
            ("leading wheelset: ", half, LEFT_COLOUR),
            ("trailing wheelset: ", -half, RIGHT_COLOUR),
        ):
            y, yaw = (scale * value(f"{name}{what}", phase) for what in ("y", "yaw"))
            for s in (side * 0.75, -side * 0.75):
                x0, y0 = centre + ahead - s * np.sin(yaw), y + s * np.cos(yaw)
                wheel = 0.45 * np.array([np.cos(yaw), np.sin(yaw)])
                panel.plot(
                    [x0 - wheel[0], x0 + wheel[0]],
                    [y0 - wheel[1], y0 + wheel[1]],
                    color=colour,
                    linewidth=4.0,
                    solid_capstyle="round",
                )
            panel.plot(
                [centre + ahead - side * np.sin(yaw), centre + ahead + side * np.sin(yaw)],
                [y + side * np.cos(yaw), y - side * np.cos(yaw)],
                color=colour,
                linewidth=1.6,
            )
        y, yaw = (scale * value(f"frame: {what}", phase) for what in ("y", "yaw"))
        corners = np.array([[half, 0.95], [half, -0.95], [-half, -0.95], [-half, 0.95]])
        turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
        corners = corners @ turn.T + [centre, y]
        panel.fill(*corners.T, facecolor=WHEEL_COLOUR, alpha=0.12, edgecolor=WHEEL_COLOUR)
        panel.text(centre, -1.75, f"{k}/4 period", ha="center", fontsize=8)
    for rail in (0.75, -0.75):
        panel.axhline(rail, color="black", linewidth=0.5, alpha=0.4, zorder=0)
    panel.set_aspect("equal")
    panel.set_ylim(-2.0, 1.7)
    panel.axis("off")
    panel.set_title(
        f"critical mode, {numbers['frequency']:.2f} Hz, seen from above, running to the right",
        fontsize=10,
    )


def draw_picture(path: Path, truck: Truck) -> Path:
    """Picture of the truck on its rails."""
    from exudyn_wheelset.front.animation import Camera, render, show_rails, write_image

    container, mbs, _ = truck.build(20.0, sensors=False)
    show_rails(mbs, truck.track, -4.0, 4.0)
    mbs.Assemble()
    camera = Camera(azimuth=0.75, elevation=0.36, centre=(0.0, 0.0, 0.25), zoom=3.0)
    return write_image(path, render(container, camera, size=(960, 600)))


def show(numbers: dict[str, Any]) -> None:
    """Print loads, critical speeds and growth rates."""
    print(f"\nweight {numbers['weight'] / 1e3:.3f} kN; vertical wheel loads [kN]:")
    for wheel, load in numbers["wheel_loads"].items():
        print(f"  {wheel:18s}{load / 1e3:10.3f}")
    alone = numbers["critical_speed_of_a_wheelset_on_a_fixed_frame"]
    print(
        f"linear critical speed {numbers['critical_speed']:.3f} m/s at "
        f"{numbers['frequency']:.3f} Hz; a wheelset of it on a fixed frame: "
        + ("stable up to the end of the search" if alone is None else f"{alone:.3f} m/s")
    )
    print_growth(numbers["runs"])


def main(argv: Sequence[str] | None = None) -> int:
    parser = script_parser(__doc__.splitlines()[0])
    parser.set_defaults(settings=DEFAULT_SETTINGS)
    add_profile_options(parser)
    parser.add_argument("--creep", default="shen-hedrick-elkins", help="creep law")
    parser.add_argument("--friction", type=float, default=0.15, help="coefficient of friction")
    parser.add_argument("--amplitude", type=float, default=AMPLITUDE, help="of the start [m]")
    parser.add_argument("--duration", type=float, default=DURATION, help="of each run [s]")
    parser.add_argument("--picture", action="store_true", help="draw the truck on its rails")

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        settings = load_settings(arguments.settings)
        profiles = profiles_from(arguments)
        truck = dtu_truck(profiles.wheel, creep=arguments.creep, friction=arguments.friction)
        truck = replace(truck, track=profiles.track)
        progress = not arguments.json
        seconds = warm_up()
        if progress:
            print(f"kernels ready in {seconds:.1f} s", file=sys.stderr)
        numbers, motions = run(truck, arguments.amplitude, settings, arguments.duration, progress)
        out = arguments.out
        write_json(
            out / "simple_truck.json",
            numbers,
            parameters=truck.parameters(),
            settings=changed_settings(settings),
        )
        for motion in motions:
            motion.write_csv(out / f"simple_truck_{motion.speed:.2f}.csv")
        draw(out / "simple_truck.png", truck, numbers, motions)
        if arguments.picture:
            draw_picture(out / "simple_truck_picture.png", truck)
        if motions[-1].outcome.ending is Ending.INTERRUPTED:
            if progress:
                show(numbers)
            raise KeyboardInterrupt
        return numbers

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
