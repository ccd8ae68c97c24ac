"""Pictures and films of a model on its rails, drawn by Exudyn's ray tracer: no display is needed.

    show_rails(mbs, track)          # before mbs.Assemble()
    image = render(SC, camera=Camera(zoom=1.6))
    write_image("wheelset.png", image)

Rails are extruded from their profiles, as they lie in the track; web, foot, sleepers and ballast
are drawn to plain dimensions and mean nothing.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import graphics
from exudyn.utilities import ObjectGround, VObjectGround

from exudyn_wheelset.contact.descriptions import RailPlacement, Track
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.results.files import write_atomically

RAIL_HEIGHT, WEB_WIDTH, FOOT_WIDTH, FOOT_HEIGHT = 0.172, 0.0165, 0.150, 0.020
SLEEPER_SPACING, SLEEPER_SIZE = 0.6, (0.26, 2.6, 0.20)
_HEAD_POINTS = 48
# Long thin triangles fill the ray tracer's search tree: rails of 26 m in one piece take 3.5 s of
# CPU time a picture, in pieces of 2 m 0.4 s.
_LONGEST_PIECE = 2.0


@dataclass(frozen=True)
class Camera:
    """Where a picture is taken from.

    azimuth [rad]: direction of view, 0 forward along the track, positive to the left; elevation
    [rad] above the horizontal; centre (x, y, z) [m] of the picture; zoom [m]: height of the
    visible scene; perspective 0 (parallel) to 1.
    """

    azimuth: float = 0.62
    elevation: float = 0.38
    centre: tuple[float, float, float] = (0.0, 0.0, 0.15)
    zoom: float = 1.9
    perspective: float = 0.25

    def rotation(self) -> np.ndarray:
        """Rotation from track axes to picture axes (right, up, towards the camera)."""
        forward = np.array(
            [
                np.cos(self.elevation) * np.cos(self.azimuth),
                np.cos(self.elevation) * np.sin(self.azimuth),
                -np.sin(self.elevation),
            ]
        )
        right = np.array([np.sin(self.azimuth), -np.cos(self.azimuth), 0.0])
        return np.array([right, np.cross(right, forward), -forward])


def rail_graphics(track: Track, start: float = -3.0, end: float = 3.0) -> list[dict[str, Any]]:
    """Both rails, sleepers and ballast from x = start to x = end [m] for Exudyn's renderer."""
    return [*_rails(track, start, end), *_sleepers(start, end, 0.0)]


def _rails(track: Track, start: float, end: float) -> list[dict[str, Any]]:
    """Rails and ballast."""
    if not start < end:
        raise WheelsetError(f"rails from {start!r} m to {end!r} m: give start < end")
    count = int(np.ceil((end - start) / _LONGEST_PIECE))
    ends = np.linspace(start, end, count + 1).tolist()
    return [item for k in range(count) for item in _piece(track, ends[k], ends[k + 1])]


def _piece(track: Track, start: float, end: float) -> list[dict[str, Any]]:
    length = end - start
    along_x = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    items = []
    for sign, placement in ((1.0, track.left_placement), (-1.0, track.right_placement)):
        section = _rail_section(placement, track.inclination)
        if sign < 0.0:
            section = section[::-1] * [-1.0, 1.0]
        count = len(section)
        items.append(
            graphics.SolidExtrusion(
                vertices=section.tolist(),
                segments=[[k, (k + 1) % count] for k in range(count)],
                height=length,
                rot=along_x,
                pOff=[start, 0.0, 0.0],
                color=[0.58, 0.45, 0.36, 1.0],
            )
        )
    height = SLEEPER_SIZE[2]
    top = -RAIL_HEIGHT - 0.5 * height
    items.append(
        graphics.Brick(
            centerPoint=[start + 0.5 * length, 0.0, top - 0.03],
            size=[length, 3.4, height - 0.06],
            color=[0.42, 0.41, 0.40, 1.0],
        )
    )
    return items


def _sleepers(start: float, end: float, travelled: float) -> list[dict[str, Any]]:
    """Sleepers, moved back by what has been travelled [m]."""
    depth, width, height = SLEEPER_SIZE
    top = -RAIL_HEIGHT - 0.5 * height
    behind = travelled % SLEEPER_SPACING
    first = np.ceil((start + behind + 0.5 * depth) / SLEEPER_SPACING - 0.5) + 0.5
    places = np.arange(first * SLEEPER_SPACING - behind, end - 0.5 * depth, SLEEPER_SPACING)
    return [
        graphics.Brick(
            centerPoint=[place, 0.0, top], size=[depth, width, height], color=[0.62, 0.61, 0.58, 1]
        )
        for place in places.tolist()
    ]


def show_rails(
    mbs: Any, track: Track, start: float = -3.0, end: float = 3.0, *, speed: float = 0.0
) -> int:
    """Add `rail_graphics` to a model as a ground object; return its number.

    speed [m/s]: of the model's frame, at which the sleepers pass by.
    """
    if not speed:
        return int(mbs.CreateGround(graphicsDataList=rail_graphics(track, start, end)))

    def sleepers(mbs: Any, item: int) -> list[dict[str, Any]]:
        time = mbs.systemData.GetTime(exu.ConfigurationType.Visualization)
        return _sleepers(start, end, speed * time)

    visual = VObjectGround(graphicsDataUserFunction=sleepers)  # type: ignore[arg-type]
    mbs.AddObject(ObjectGround(name="sleepers", visualization=visual))
    return int(mbs.CreateGround(graphicsDataList=_rails(track, start, end)))


def render(
    SC: Any,
    camera: Camera | None = None,
    size: tuple[int, int] = (960, 600),
    smooth: int = 2,
) -> np.ndarray:
    """Picture (height, width, 3) of an assembled model as it was last drawn or solved.

    size (width, height) [pixels]; smooth: samples along each side of a pixel.
    """
    camera = camera or Camera()
    _prepare(SC, size, smooth, camera)
    rotation = camera.rotation()
    state = SC.renderer.GetState()
    # The renderer takes the transposed rotation, the centre in picture axes and half the height.
    state["modelRotation"] = rotation.T
    state["rotationCenterPoint"] = np.zeros(3)
    state["centerPoint"] = rotation @ np.array(camera.centre)
    state["zoom"] = 0.5 * camera.zoom
    state["currentWindowSize"] = np.array(size, dtype=np.int32)
    SC.renderer.SetState(state, waitForRendererFullStartup=False)
    return np.array(SC.renderer.RedrawAndGetImage(useRaytracer=True))


def render_motion(
    SC: Any,
    mbs: Any,
    coordinates: Iterable[np.ndarray],
    camera: Camera | None = None,
    size: tuple[int, int] = (640, 400),
    smooth: int = 1,
) -> list[np.ndarray]:
    """A picture for each vector of second-order coordinates of the assembled system `mbs`.

    The current state of the system is put back afterwards.
    """
    kept = mbs.systemData.GetODE2Coordinates()
    frames = []
    try:
        for row in coordinates:
            mbs.systemData.SetODE2Coordinates(np.ascontiguousarray(row, dtype=float))
            mbs.SendRedrawSignal()
            frames.append(render(SC, camera, size, smooth))
    finally:
        mbs.systemData.SetODE2Coordinates(kept)
        mbs.SendRedrawSignal()
    return frames


def write_image(path: str | Path, image: np.ndarray) -> Path:
    """Write a picture (height, width, 3) as PNG or what the suffix says."""
    from PIL import Image

    return write_atomically(Path(path), lambda part: Image.fromarray(image).save(part))


def write_film(path: str | Path, frames: Sequence[np.ndarray], rate: float = 25.0) -> Path:
    """Write pictures as an endless GIF of `rate` frames a second."""
    from PIL import Image

    if not frames:
        raise WheelsetError(f"{path}: a film needs at least one frame")
    images = [Image.fromarray(frame) for frame in frames]
    # One palette for all frames: colours that change from frame to frame flicker.
    palette = images[len(images) // 2].quantize(colors=128)
    images = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]

    def save(part: Path) -> None:
        images[0].save(part, save_all=True, append_images=images[1:], duration=1e3 / rate, loop=0)

    return write_atomically(Path(path), save)


def _prepare(SC: Any, size: tuple[int, int], smooth: int, camera: Camera) -> None:
    settings = SC.visualizationSettings
    for group in ("nodes", "markers", "connectors", "loads", "sensors"):
        getattr(settings, group).show = False
    view = settings.view0
    view.scene.drawCoordinateSystem = 0
    view.window.renderWindowSize = list(size)
    view.window.showComputationInfo = False
    view.camera.perspective = camera.perspective
    general = settings.general
    general.autoFitScene = False
    general.showSolverInformation = False
    general.showSolutionInformation = False
    general.showSolverTime = False
    general.backgroundColor = [0.93, 0.95, 0.97, 1.0]
    light = settings.openGL.light0
    # From the camera's side, or what is seen lies in the shade.
    light.position = [-3.0, -5.0 if np.sin(camera.azimuth) > 0.0 else 5.0, 7.0, 0.0]
    light.shadow = 0.5
    light.diffuse = 0.6
    settings.raytracer.multiSampling = smooth
    settings.raytracer.numberOfThreads = os.cpu_count() or 1


def _rail_section(placement: RailPlacement, inclination: float) -> np.ndarray:
    """Closed outline (n, 2) of a left rail, counter-clockwise, y and z [m]."""
    head = np.vstack([placement.coefficients[:, [0, 4]]])
    keep = np.unique(np.linspace(0, len(head) - 1, _HEAD_POINTS).astype(int))
    head = head[keep]
    low = head[[0, -1], 1].max() - 0.002
    bottom, foot = -RAIL_HEIGHT, -RAIL_HEIGHT + FOOT_HEIGHT
    inner, outer = head[0, 0], head[-1, 0]
    if low < foot or outer - inner < WEB_WIDTH:
        # A rail that is all head, or an edge: a block below it.
        return np.vstack([head[::-1], [[inner, bottom], [outer + 1e-3, bottom]]])
    middle = 0.5 * (inner + outer)
    web, half_foot = 0.5 * WEB_WIDTH, 0.5 * FOOT_WIDTH
    shoulder = head[:, 1].min() - 0.012
    lean = np.array(
        [
            [middle - web, shoulder],
            [middle - web, foot + 0.012],
            [middle - half_foot, foot],
            [middle - half_foot, bottom],
            [middle + half_foot, bottom],
            [middle + half_foot, foot],
            [middle + web, foot + 0.012],
            [middle + web, shoulder],
        ]
    )
    # The rail leans towards the track centre: its foot stands further out.
    lean[:, 0] -= inclination * (lean[:, 1] - shoulder)
    return np.vstack([head[::-1], lean])
