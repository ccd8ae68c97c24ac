"""A vehicle on its rails as a picture or a film, from its description and a simulated motion.

A model is what has a `track` and `create(mbs, speed)`: a Vehicle, a Truck, a WheelsetOnFrame.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_wheelset.front.animation import (
    Camera,
    render,
    render_motion,
    show_rails,
    write_film,
    write_image,
)
from exudyn_wheelset.results.motion import Motion

# Speed [m/s] at which a model that stands still is built.
_SPEED = 20.0


def on_rails(model: Any, speed: float, start: float = -3.0, end: float = 3.0) -> tuple[Any, Any]:
    """SC and mbs of the assembled model, rails drawn from x = start to x = end [m]."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    model.create(mbs, speed, sensors=False)
    show_rails(mbs, model.track, start, end)
    mbs.Assemble()
    return container, mbs


def draw_picture(
    path: str | Path,
    model: Any,
    motion: Motion | None = None,
    camera: Camera | None = None,
    ends: tuple[float, float] = (-3.0, 3.0),
) -> Path:
    """Picture of a model as drawn, or where the first wheelset of a motion is farthest out."""
    if motion is None:
        container, _ = on_rails(model, _SPEED, *ends)
        return write_image(path, render(container, camera, size=(960, 600)))
    container, mbs = on_rails(model, motion.speed, *ends)
    farthest = int(np.argmax(np.abs(motion[f"{motion.wheels[0][0]}: y"])))
    rows = motion.coordinates[[farthest]]
    return write_image(path, render_motion(container, mbs, rows, camera, (960, 600), 2)[0])


def draw_film(
    path: str | Path, model: Any, motion: Motion, seconds: float = 2.0, rate: int = 20
) -> Path:
    """Film of the last `seconds` [s] of a motion, seen from behind, close to the left wheel."""
    container, mbs = on_rails(model, motion.speed, -0.6, 2.4)
    end = motion.time[-1]
    rows = np.searchsorted(motion.time, np.arange(max(0.0, end - seconds), end, 1.0 / rate))
    camera = Camera(
        azimuth=0.0, elevation=0.1, centre=(0.0, 0.73, 0.02), zoom=0.26, perspective=0.1
    )
    frames = render_motion(container, mbs, motion.coordinates[rows], camera, size=(480, 360))
    return write_film(path, frames, rate)
