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
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import SensorBody

from exudyn_wheelset.catalogue import paper_wheelset as paper
from exudyn_wheelset.catalogue.wheelset_on_frame import WheelsetOnFrame
from exudyn_wheelset.compilation import warm_up
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.coupling.create import SENSOR_VALUES, WheelsetItems
from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.plots import draw_wheelset_motion, new_figure
from exudyn_wheelset.front.script import (
    add_profile_options,
    profiles_from,
    run_script,
    script_parser,
)
from exudyn_wheelset.front.settings import changed_settings, load_settings
from exudyn_wheelset.front.simulation import Ending, set_duration, simulate
from exudyn_wheelset.geometry.rigid import contact_geometry
from exudyn_wheelset.results.files import write_columns
from exudyn_wheelset.results.growth import measure_growth
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.stability.linear.linearisation import linearise
from exudyn_wheelset.systems.exudyn_system import ExudynSystem

DEFAULT_SETTINGS = Path(__file__).resolve().parents[1] / "runs" / "rk44.json"
SEARCHED_SPEEDS = (10.0, 300.0)
FACTORS = (0.85, 1.15)
OFFSET = 1.0e-3
# A growth rate is measured after the first period, in which the fast creep modes die away, and up
# to this multiple of the offset and this amplitude [m]: beyond, creep saturation starts to show.
LARGEST_GROWTH, LARGEST_AMPLITUDE = 2.0, 3.0e-3


@dataclass(frozen=True)
class Motion:
    """One simulated run: columns over time (SI, `t` first), how it ended, numbers about it."""

    speed: float
    columns: dict[str, np.ndarray]
    ending: Ending
    numbers: dict[str, Any]


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


def hunting_root(system: ExudynSystem, speed: float) -> complex:
    """The least damped root whose mode is lateral (y, yaw, roll), not longitudinal or vertical."""
    linear = linearise(system, speed)
    shown = list(system.displacement_indices)
    sizes = np.abs(linear.eigenvectors / system.scales[:, None])[shown] ** 2
    words = ("y [m]", "yaw", "roll")
    lateral = [any(word in system.state_names[index] for word in words) for index in shown]
    share = sizes[lateral].sum(axis=0) / sizes.sum(axis=0)
    chosen = (linear.eigenvalues.imag > 1.0e-3) & (share > 0.5)
    if not chosen.any():
        raise AnalysisError(f"{system.name}: no lateral oscillation at {speed:g} m/s")
    return complex(linear.eigenvalues[chosen][0])


def released_state(
    model: WheelsetOnFrame, system: ExudynSystem, speed: float, offset: float
) -> np.ndarray:
    """Steady running, moved to the left by `offset` [m] with both wheels on their rails."""
    state = system.equilibrium(speed)
    names = list(system.state_names)
    at = names.index("y [m]")
    geometry = contact_geometry(model.wheelset, model.track, [state[at], state[at] + offset])
    state[at] += offset
    state[names.index("roll [rad]")] += geometry.roll[1] - geometry.roll[0]
    state[names.index("z [m]")] += geometry.z[1] - geometry.z[0]
    return state


def release(
    model: WheelsetOnFrame,
    system: ExudynSystem,
    speed: float,
    offset: float,
    settings: exu.SimulationSettings,
    progress: bool = False,
) -> Motion:
    """Simulate the wheelset from `offset` [m] at `speed` [m/s]."""
    _, mbs, items = model.build(speed, show=False)
    sensors = _add_sensors(mbs, items)
    mbs.Assemble()
    _set_initial(mbs, system, released_state(model, system, speed, offset))
    ending = simulate(mbs, settings, [items.contact], progress, description=f"{speed:6.2f} m/s")
    columns = _columns(mbs, items, sensors, model.wheelset.radius)
    y, centre = columns["y"], float(system.equilibrium(speed)[_lateral(system)])
    columns["y_equilibrium"] = np.full(len(y), centre)
    root = hunting_root(system, speed)
    numbers: dict[str, Any] = {
        "speed": speed,
        "growth_rate_eigenvalue": root.real,
        "frequency_eigenvalue": root.imag / (2.0 * np.pi),
        "growth_rate_simulated": None,
        "frequency_simulated": None,
        "maximum_y": float(np.abs(y).max()),
        "final_amplitude": _final_amplitude(columns["t"], y - centre, root),
        "largest_normal_force": float(
            max(columns["left_normal_force"].max(), columns["right_normal_force"].max())
        ),
        "simulated_time": ending.time,
        "event": ending.event,
    }
    chosen = _linear_part(columns["t"], y - centre, offset, root)
    try:
        growth = measure_growth(columns["t"][chosen], y[chosen])
        numbers["growth_rate_simulated"] = growth.rate
        numbers["frequency_simulated"] = growth.frequency
    except AnalysisError as error:
        numbers["growth_rate_simulated_note"] = str(error)
    return Motion(speed, columns, ending, numbers)


def run(
    model: WheelsetOnFrame | None = None,
    speeds: Sequence[float] | None = None,
    offset: float = OFFSET,
    settings: exu.SimulationSettings | None = None,
    progress: bool = False,
) -> tuple[dict[str, Any], list[Motion]]:
    """Numbers and motions at `speeds` [m/s], by default 0.85 and 1.15 of the critical speed.

    After Ctrl-C the motions so far are returned; the last one's ending says so.
    """
    model = model or vehicle()
    settings = settings or load_settings(DEFAULT_SETTINGS)
    if not (np.isfinite(offset) and 0.0 < abs(offset) < 0.03):
        raise WheelsetError(f"offset = {offset!r} m: give a lateral offset up to 0.03, in metres")
    system = model.dynamic_system()
    critical: CriticalPoint | None = None
    try:
        critical = linear_critical_speed(system, *SEARCHED_SPEEDS)
    except AnalysisError:
        if speeds is None:
            raise
    if speeds is None:
        assert critical is not None
        speeds = [factor * critical.speed for factor in FACTORS]
    for speed in speeds:
        if not 0.1 <= speed <= 200.0:
            raise WheelsetError(f"speed = {speed!r} m/s: give 0.1 to 200 m/s")
    numbers: dict[str, Any] = {
        "critical_speed": critical.speed if critical else None,
        "frequency": critical.frequency if critical else None,
        "offset": offset,
        "runs": [],
    }
    motions = []
    for speed in speeds:
        motion = release(model, system, float(speed), offset, settings, progress)
        motions.append(motion)
        numbers["runs"].append(motion.numbers)
        if motion.ending.interrupted:
            break
    return numbers, motions


def _add_sensors(mbs: Any, items: WheelsetItems) -> dict[str, int]:
    types = exu.OutputVariableType
    wanted = {"position": types.Position, "rotation": types.RotationMatrix}
    return {
        name: mbs.AddSensor(
            SensorBody(
                bodyNumber=items.body,
                outputVariableType=what,
                storeInternal=True,
                writeToFile=False,
            )
        )
        for name, what in wanted.items()
    }


def _columns(
    mbs: Any, items: WheelsetItems, sensors: dict[str, int], radius: float
) -> dict[str, np.ndarray]:
    """What the sensors stored, by name."""
    position = mbs.GetSensorStoredData(sensors["position"])
    rotation = mbs.GetSensorStoredData(sensors["rotation"])[:, 1:].reshape(-1, 3, 3)
    columns = {
        "t": position[:, 0],
        "x": position[:, 1],
        "y": position[:, 2],
        "z": position[:, 3] - radius,
        "yaw": np.arctan2(-rotation[:, 0, 1], rotation[:, 1, 1]),
        "roll": np.arcsin(rotation[:, 2, 1]),
    }
    for side, sensor in (("left", items.left_sensor), ("right", items.right_sensor)):
        stored = mbs.GetSensorStoredData(sensor)
        for index, name in enumerate(SENSOR_VALUES):
            columns[f"{side}_{name}"] = stored[:, 1 + index]
    return columns


def _set_initial(mbs: Any, system: ExudynSystem, state: np.ndarray) -> None:
    coordinates, velocities = system.expand(state)
    initial = exu.ConfigurationType.Initial
    mbs.systemData.SetODE2Coordinates(coordinates, initial)
    mbs.systemData.SetODE2Coordinates_t(velocities, initial)


def _lateral(system: ExudynSystem) -> int:
    return list(system.state_names).index("y [m]")


def _linear_part(t: np.ndarray, y: np.ndarray, offset: float, root: complex) -> np.ndarray:
    """True in the longer of the stretches before and after the motion is too large to be linear."""
    settled = t >= 2.0 * np.pi / root.imag
    large = np.flatnonzero(np.abs(y) > min(LARGEST_GROWTH * abs(offset), LARGEST_AMPLITUDE))
    if not len(large):
        return settled
    before = settled & (t < t[large[0]])
    after = settled & (t > t[large[-1]])
    return before if before.sum() >= after.sum() else after


def _final_amplitude(t: np.ndarray, y: np.ndarray, root: complex) -> float:
    """Largest |y| in the last period."""
    return float(np.abs(y[t >= t[-1] - 2.0 * np.pi / root.imag]).max())


def draw(path: Path, motions: Sequence[Motion], title: str) -> Path:
    """Motion, forces and contact positions, one column for each speed."""
    figure, axes = new_figure(5.6 * len(motions), 10.5, 5, len(motions), sharex="col", sharey=False)
    for column, motion in zip(axes.T, motions, strict=True):
        numbers = motion.numbers
        draw_wheelset_motion(column, motion.columns, numbers["growth_rate_eigenvalue"])
        measured = numbers["growth_rate_simulated"]
        column[0].set_title(
            f"{motion.speed:.2f} m/s: growth {numbers['growth_rate_eigenvalue']:+.3f} 1/s"
            + ("" if measured is None else f", simulated {measured:+.3f} 1/s"),
            fontsize=10,
        )
        if motion.ending.event:
            column[0].axvline(motion.ending.time, color="black", linewidth=1.0)
            column[0].annotate(
                motion.ending.event.split(":")[1].strip() if ":" in motion.ending.event else "end",
                (motion.ending.time, 0.95),
                xycoords=("data", "axes fraction"),
                ha="right",
                va="top",
                fontsize=8,
                rotation=90,
            )
    figure.suptitle(title, fontsize=11)
    return write_figure(path, figure)


def draw_picture(path: Path, model: WheelsetOnFrame, motion: Motion) -> Path:
    """Picture of the wheelset on its rails where it was farthest from the centre."""
    from exudyn_wheelset.front.animation import render_motion, show_rails, write_image

    container, mbs, _ = model.build(motion.speed, sensors=False)
    show_rails(mbs, model.track)
    mbs.Assemble()
    farthest = int(np.argmax(np.abs(motion.columns["y"])))
    image = render_motion(container, mbs, _poses(motion, [farthest]), size=(960, 600), smooth=2)[0]
    return write_image(path, image)


def draw_film(
    path: Path, model: WheelsetOnFrame, motion: Motion, seconds: float = 2.0, rate: int = 20
) -> Path:
    """Film of the last `seconds` [s] of a motion, seen from behind, close to the left wheel."""
    from exudyn_wheelset.front.animation import Camera, render_motion, show_rails, write_film

    container, mbs, _ = model.build(motion.speed, sensors=False)
    show_rails(mbs, model.track, -0.6, 2.4)
    mbs.Assemble()
    t = motion.columns["t"]
    times = np.arange(max(t[0], t[-1] - seconds), t[-1], 1.0 / rate)
    camera = Camera(
        azimuth=0.0, elevation=0.1, centre=(0.0, 0.73, 0.02), zoom=0.26, perspective=0.1
    )
    frames = render_motion(
        container, mbs, _poses(motion, np.searchsorted(t, times)), camera, size=(480, 360)
    )
    return write_film(path, frames, rate)


def _poses(motion: Motion, rows: Sequence[int] | np.ndarray) -> np.ndarray:
    """Exudyn coordinates of the wheelset, without its spin, at rows of the motion."""
    from scipy.spatial.transform import Rotation

    columns = motion.columns
    poses = np.zeros((len(rows), 6))
    for pose, row in zip(poses, rows, strict=True):
        pose[:3] = columns["x"][row], columns["y"][row], columns["z"][row]
        angles = [columns["yaw"][row], columns["roll"][row]]
        pose[3:] = Rotation.from_euler("ZX", angles).as_rotvec()
    return poses


def show(numbers: dict[str, Any]) -> None:
    """Print growth rates beside eigenvalues and how each run ended."""
    if numbers["critical_speed"] is not None:
        print(
            f"\nlinear critical speed {numbers['critical_speed']:.3f} m/s "
            f"at {numbers['frequency']:.3f} Hz"
        )
    print(
        f"{'speed':>8s}{'growth':>11s}{'eigenvalue':>12s}{'frequency':>11s}{'eigenvalue':>12s}"
        f"{'max |y|':>10s}{'final':>9s}"
    )
    print(
        f"{'[m/s]':>8s}{'[1/s]':>11s}{'[1/s]':>12s}{'[Hz]':>11s}{'[Hz]':>12s}"
        f"{'[mm]':>10s}{'[mm]':>9s}"
    )
    for row in numbers["runs"]:
        growth, frequency = row["growth_rate_simulated"], row["frequency_simulated"]
        print(
            f"{row['speed']:8.2f}"
            + ("          -" if growth is None else f"{growth:+11.4f}")
            + f"{row['growth_rate_eigenvalue']:+12.4f}"
            + ("          -" if frequency is None else f"{frequency:11.4f}")
            + f"{row['frequency_eigenvalue']:12.4f}"
            + f"{row['maximum_y'] * 1e3:10.3f}{row['final_amplitude'] * 1e3:9.3f}"
            + (f"  {row['event']}" if row["event"] else "")
        )


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
        if arguments.duration is not None:
            if not 0.01 <= arguments.duration <= 3600.0:
                raise WheelsetError(f"duration = {arguments.duration!r} s: give 0.01 to 3600 s")
            set_duration(settings, arguments.duration)
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
        numbers, motions = run(model, arguments.speed, arguments.offset, settings, progress)
        out = arguments.out
        write_json(
            out / "single_wheelset.json",
            numbers,
            parameters=model.parameters(),
            settings=changed_settings(settings),
        )
        for motion in motions:
            write_columns(
                out / f"single_wheelset_{motion.speed:.2f}.csv",
                motion.columns,
            )
        title = f"{model.name}: {model.wheelset.wheel.name} on {model.track.rail.name}"
        if numbers["critical_speed"] is not None:
            title += f", critical speed {numbers['critical_speed']:.2f} m/s"
        draw(out / "single_wheelset.png", motions, title)
        if arguments.picture:
            draw_picture(out / "single_wheelset_picture.png", model, motions[-1])
        if arguments.film:
            draw_film(out / "single_wheelset.gif", model, motions[-1])
        if motions[-1].ending.interrupted:
            if progress:
                show(numbers)
            raise KeyboardInterrupt
        return numbers

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
