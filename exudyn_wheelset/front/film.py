"""Films of simulated motions: a vehicle on its rails, time and lateral shift written in.

    motion = simulate(car, speed=40.0, duration=5.0, start=4e-3)
    film(car, motion, "hunting.mp4", view="wheel")

The camera goes along with the vehicle; rails are drawn of their true section, sleepers pass by.
Drawn by Exudyn's ray tracer without a display. MP4 needs imageio-ffmpeg or the program ffmpeg.
"""

from __future__ import annotations

import contextlib
import shutil
import subprocess
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from exudyn_wheelset.checking import number, numbers, positive, unknown, warn
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.animation import Camera, render, show_rails, write_film
from exudyn_wheelset.results.files import write_atomically
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.subject import named
from exudyn_wheelset.vehicles.description import Vehicle

VIEWS = ("vehicle", "truck", "wheel")
# Rails to be seen beyond the ends of the vehicle [m].
_BEYOND = 5.0
# Rails are cut off so far before a wheelset [m].
_CUT = 0.25


@spelt
def film(
    vehicle: Any,
    motion: Motion,
    path: str | Path = "film.mp4",
    *,
    start: float | None = None,
    seconds: float | None = None,
    rate: float = 25.0,
    slow: float = 1.0,
    view: str | Camera = "vehicle",
    watch: str | None = None,
    size: tuple[int, int] = (640, 360),
    smooth: int = 1,
    progress: bool = False,
) -> Path:
    """Film a motion of a vehicle and return the path that was written.

    vehicle  a Vehicle, another model with `track` and `create`, or a name of the catalogue
    motion   from `simulate`
    path     .mp4 or .gif; without ffmpeg a GIF takes the place of an MP4, with a warning
    start, seconds  the part of the motion that is shown [s]; all if left out
    rate     pictures a second; slow: how many times slower than it was
    view     "vehicle" from the side, its first "truck", its first left "wheel" from ahead, where
             millimetres are seen; or a Camera
    watch    wheelset whose lateral shift is written in; the first if left out
    size     (width, height) [pixels]; smooth: samples along each side of a pixel

    Raises WheelsetError for a motion of another vehicle and for impossible values.

    Examples
    --------
    >>> from exudyn_wheelset import catalogue, film, simulate
    >>> wheelset = catalogue.vehicle("s1002").vehicle()
    >>> motion = simulate(wheelset, speed=20, duration=0.1, initial=2e-3)
    >>> film(wheelset, motion, "run.gif", size=(64, 48), rate=10).name
    'run.gif'
    """
    vehicle = named(vehicle)
    if not isinstance(motion, Motion):
        raise WheelsetError(f"motion = {motion!r:.80}: give a Motion, what simulate(...) returns")
    if not isinstance(path, str | Path):
        raise WheelsetError(f"path = {path!r}: give the path of an .mp4 or .gif")
    if not isinstance(view, str | Camera):
        raise WheelsetError(f"view = {view!r}: give one of {', '.join(VIEWS)}, or a Camera")
    smooth = int(number("smooth", smooth, "-", 1, 16))
    rate, slow = positive("rate", rate, "1/s", 240.0), positive("slow", slow, "-", 1e4)
    size = _even(size)
    if Path(path).suffix.lower() not in ("", ".mp4", ".gif"):
        raise WheelsetError(f"{path}: films are .mp4 or .gif")
    watched = _watched(motion, watch)
    rows = _rows(motion, start, seconds, rate, slow)
    container, mbs, reach = _on_rails(vehicle, motion, view == "wheel")
    places = _coordinates(mbs, vehicle, motion)
    camera = view if isinstance(view, Camera) else camera_of(vehicle, view, reach)
    shift = motion[f"{watched}: y"] if watched in motion.bodies else np.zeros(len(motion))

    def pictures() -> Iterator[np.ndarray]:
        for row in _shown(rows, progress, motion):
            mbs.systemData.SetODE2Coordinates(places(row))
            mbs.systemData.SetTime(float(motion.time[row]))
            mbs.SendRedrawSignal()
            picture = render(container, camera, size, smooth)
            words = (
                f"t = {motion.time[row]:.2f} s    {motion.speed:.1f} m/s "
                f"({3.6 * motion.speed:.0f} km/h)    {watched}: y = {1e3 * shift[row]:+.1f} mm"
            )
            # To the left is to the right as seen from ahead.
            seen = shift[row] * np.sign(-np.cos(camera.azimuth))
            yield captioned(picture, words, float(seen))

    return _write(Path(path), pictures(), rate)


def camera_of(vehicle: Any, view: str, reach: tuple[float, float] = (-1.0, 1.0)) -> Camera:
    """The camera of a view (see `film`); reach [m]: rear and front end of what is to be seen."""
    if view not in VIEWS:
        raise unknown("view", view, VIEWS)
    axles = getattr(vehicle, "wheelsets", ())
    first = max((axle.x for axle in axles), default=0.0)
    if view == "wheel":
        return Camera(
            azimuth=np.pi, elevation=0.01, centre=(first, 0.76, 0.08), zoom=0.6, perspective=0.0
        )
    if view == "truck":
        near = [axle.x for axle in axles if first - axle.x < 4.0] or [0.0]
        middle = (float(np.mean(near)), 0.0, 0.6)
        return Camera(azimuth=-0.95, elevation=0.16, centre=middle, zoom=2.6, perspective=0.2)
    middle = (0.5 * (reach[0] + reach[1]), 0.0, 0.1 * (reach[1] - reach[0]))
    zoom = max(0.58 * (reach[1] - reach[0]), 1.9)
    return Camera(azimuth=-0.95, elevation=0.18, centre=middle, zoom=zoom, perspective=0.1)


def captioned(picture: np.ndarray, words: str, shift: float = 0.0) -> np.ndarray:
    """A picture (height, width, 3) with a line of words and a scale of +-10 mm for a shift [m].

    shift: to the right of the picture.
    """
    from matplotlib import get_data_path
    from PIL import Image, ImageDraw, ImageFont

    image = Image.fromarray(picture)
    height, width = picture.shape[:2]
    text = max(11, height // 26)
    font = ImageFont.truetype(str(Path(get_data_path()) / "fonts/ttf/DejaVuSans.ttf"), text)
    while text > 6 and font.getlength(words) > 0.94 * width:
        text -= 1
        font = font.font_variant(size=text)
    draw = ImageDraw.Draw(image)
    left, top = 0.03 * width, 0.03 * height
    ink, paper = (25, 30, 38), (240, 243, 247)
    draw.text((left, top), words, fill=ink, font=font, stroke_width=2, stroke_fill=paper)
    middle, half, line = 0.5 * width, 0.15 * width, height - 1.2 * text
    draw.line((middle - half, line, middle + half, line), fill=(90, 96, 105), width=2)
    for place in (-1.0, 0.0, 1.0):
        x = middle + place * half
        draw.line((x, line - 0.3 * text, x, line + 0.3 * text), fill=(90, 96, 105), width=2)
    x = middle + float(np.clip(shift / 10e-3, -1.1, 1.1)) * half
    r = 0.35 * text
    draw.ellipse((x - r, line - r, x + r, line + r), fill=(190, 40, 40))
    return np.asarray(image)


def _even(size: tuple[int, int]) -> tuple[int, int]:
    """A size with even numbers, which films want."""
    pair = numbers("size (width, height)", size, 2, "pixels", 32, 8192)
    width, height = (int(value) for value in pair)
    return width + width % 2, height + height % 2


def _watched(motion: Motion, watch: str | None) -> str:
    names = list(dict.fromkeys(name for name, _ in motion.wheels)) or list(motion.bodies)
    if watch is None:
        return names[0] if names else ""
    if watch not in motion.bodies:
        raise unknown("body of the motion to watch", watch, motion.bodies)
    return watch


def _rows(
    motion: Motion, start: float | None, seconds: float | None, rate: float, slow: float
) -> np.ndarray:
    """Samples of the motion, one a picture."""
    if not len(motion):
        raise WheelsetError("the motion has no samples: there is nothing to film")
    first = float(motion.time[0]) if start is None else number("start", start, "s")
    last = float(motion.time[-1])
    if seconds is not None:
        last = min(last, first + positive("seconds", seconds, "s"))
    if first > last:
        raise WheelsetError(f"start = {first:g} s lies behind the motion's end at {last:g} s")
    times = np.arange(first, last + 1e-9, 1.0 / (rate * slow))
    return np.minimum(np.searchsorted(motion.time, times - 1e-9), len(motion) - 1)


def _on_rails(vehicle: Any, motion: Motion, cut: bool) -> tuple[Any, Any, tuple[float, float]]:
    """SC and mbs of the vehicle on its rails, and the rear and front end of its wheelsets [m].

    cut: the rails end just before the first wheelset, so that their section is seen below it.
    """
    import exudyn as exu

    if not hasattr(vehicle, "track") or not hasattr(vehicle, "create"):
        raise WheelsetError(
            f"{vehicle!r} has no track to be drawn on: give a Vehicle, or add rails to your model "
            "and use render_motion (docs/your-own-vehicle.md)"
        )
    container = exu.SystemContainer()
    mbs: Any = container.AddSystem()
    if isinstance(vehicle, Vehicle):
        # The picture moves along: a curve is straight in it.
        vehicle = vehicle.on(replace(vehicle.track, layout=None, irregularity=None))
    vehicle.create(mbs, motion.speed, sensors=False)
    axles = [axle.x for axle in getattr(vehicle, "wheelsets", ())] or [0.0]
    reach = (min(axles) - 1.5, max(axles) + 1.5)
    front = max(axles) + _CUT if cut else reach[1] + _BEYOND
    show_rails(mbs, vehicle.track, reach[0] - _BEYOND, front, speed=motion.speed)
    mbs.Assemble()
    return container, mbs, reach


def _coordinates(mbs: Any, vehicle: Any, motion: Motion) -> Callable[[int], np.ndarray]:
    """Exudyn's coordinates of a sample: those of the motion, or put together from its columns."""
    size = len(mbs.systemData.GetODE2Coordinates())
    if motion.coordinates.shape[1:] == (size,):
        return lambda row: np.ascontiguousarray(motion.coordinates[row])
    parts = [part.name for part in getattr(vehicle, "parts", ())]
    missing = [name for name in parts if name not in motion.bodies]
    if not parts or missing or 6 * len(parts) != size:
        raise WheelsetError(
            f"{motion!r} is of another vehicle"
            + (f": it has no {missing[0]!r}" if missing else "")
            + ": give the vehicle that was simulated"
        )
    table = np.zeros((len(motion), len(parts), 6))
    for k, name in enumerate(parts):
        body = motion.body(name)
        for axis, column in enumerate(("x [m]", "y [m]", "z [m]")):
            if column in body:
                table[:, k, axis] = body[column]
        pitch = body.get("pitch [rad]")
        if pitch is None:
            spin = body.get("wy [rad/s]", np.zeros(len(motion)))
            steps = 0.5 * (spin[1:] + spin[:-1]) * np.diff(motion.time)
            pitch = np.concatenate([[0.0], np.cumsum(steps)])
        angles = np.column_stack([body["yaw [rad]"], body["roll [rad]"], pitch])
        table[:, k, 3:] = Rotation.from_euler("ZXY", angles).as_rotvec()
    return lambda row: np.ascontiguousarray(table[row].ravel())


def _shown(rows: np.ndarray, progress: bool, motion: Motion) -> Iterable[int]:
    if not progress:
        return rows
    from tqdm import tqdm

    shown: Iterable[int] = tqdm(rows, desc=f"film at {motion.speed:g} m/s", unit="pictures")
    return shown


def _write(path: Path, pictures: Iterator[np.ndarray], rate: float) -> Path:
    suffix = path.suffix.lower()
    if suffix == ".gif":
        return write_film(path, list(pictures), rate)
    writer = mp4_writer()
    if writer is None:
        if suffix:
            warn(f"{path} becomes a GIF: for MP4 install imageio-ffmpeg or ffmpeg")
        return write_film(path.with_suffix(".gif"), list(pictures), rate)
    path = path.with_suffix(".mp4")
    return write_atomically(path, lambda part: writer(part, pictures, rate))


def mp4_writer() -> Callable[[Path, Iterator[np.ndarray], float], None] | None:
    """What writes pictures as MP4 here: imageio with its ffmpeg, the program ffmpeg, or None."""
    try:
        import imageio_ffmpeg
    except ImportError:
        program = shutil.which("ffmpeg")
    else:
        program = imageio_ffmpeg.get_ffmpeg_exe()
    if program is None:
        return None

    def write(path: Path, pictures: Iterator[np.ndarray], rate: float) -> None:
        first = next(pictures)
        height, width = first.shape[:2]
        command = [
            program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
            "-s", f"{width}x{height}", "-r", f"{rate:g}", "-i", "-", "-an",
            "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "20", str(path),
        ]  # fmt: skip
        done = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
        assert done.stdin is not None and done.stderr is not None
        try:
            # Where it ends early (a full disk), its own words say why.
            with contextlib.suppress(BrokenPipeError):
                done.stdin.write(np.ascontiguousarray(first).tobytes())
                for picture in pictures:
                    done.stdin.write(np.ascontiguousarray(picture).tobytes())
                done.stdin.close()
            said = done.stderr.read().decode(errors="replace")
        finally:
            code = done.wait()
        if code:
            raise WheelsetError(f"{path.name}: ffmpeg gave up: {said.strip()}")

    return write
