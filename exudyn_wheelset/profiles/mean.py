"""The mean of several sections of one wheel or rail, laid on each other.

One noisy section leaves the conicity undecided by more than is asked for where contact runs over
many millimetres of tread (the Cramer-Rao bound of docs/profiles.md); n sections are sqrt(n) better.

Sections differ by where the instrument sat. Each is laid on the automatic curve of the first by the
rigid motion (d_y, d_z, theta) that makes the sum of squares of the distances normal to it least,
    r = (z - h(y)) cos alpha,    dr = -sin alpha d_y + cos alpha d_z + (y cos alpha + z sin alpha)
theta,    tan alpha = h'(y),
by Gauss and Newton over points where |h'| < 3, those beyond four deviations left out. Then all are
moved back by the mean of the motions: the mean of the places is that of the sections, no section's.
Their points in the order of the curve, n neighbours made one, are the result.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles.curve import averaged
from exudyn_wheelset.profiles.finish import check_options
from exudyn_wheelset.profiles.profile import Profile
from exudyn_wheelset.spelling import spelt

FloatArray = NDArray[np.float64]

_STEEPEST = 3.0
_CUT = 4.0
_STEPS = 8
_MARGIN = 1e-3
_FARTHEST = 0.05
_LARGEST_ANGLE = 0.2


@spelt
def mean_profile(sections: Sequence[Profile], smoothing: float | str = "auto") -> Profile:
    """The mean of sections of one wheel or one rail, measured one by one.

    sections: two or more of the same kind and side, as `load_profile` gives them; smoothing: as of
    `load_profile`, of the mean. What lies beyond one of the sections is cut off. The remarks say
    how far the sections had to be moved. Raises ProfileError where kinds or sides differ, or where
    two sections cannot be laid on each other.

    Examples
    --------
    >>> from exudyn_wheelset import load_profile, mean_profile
    >>> sections = [load_profile("S1002"), load_profile("S1002").shifted(0.0, 1e-5)]
    >>> mean_profile(sections).kind
    'wheel'
    """
    sections = list(sections)
    if len(sections) < 2 or not all(isinstance(section, Profile) for section in sections):
        raise ProfileError("a mean needs two or more profiles; load each with load_profile")
    first = sections[0]
    for section in sections[1:]:
        if (section.kind, section.is_mirrored) != (first.kind, first.is_mirrored):
            raise ProfileError(
                f"{section.name} is a {section.kind} and {first.name} a {first.kind}, or of the "
                "other side; give sections of one wheel or one rail"
            )
    check_options(first.kind, smoothing)
    curve = first.smoothed("auto")
    motions = [np.zeros(3), *(_motion(section, curve) for section in sections[1:])]
    middle = np.mean(motions, axis=0)
    clouds = [_moved(s, motion) for s, motion in zip(sections, motions, strict=True)]
    low = max(np.min(cloud[:, 0]) for cloud in clouds)
    high = min(np.max(cloud[:, 0]) for cloud in clouds)
    points = np.concatenate(clouds)
    points = points[(points[:, 0] >= low) & (points[:, 0] <= high)]
    points = averaged(points[np.argsort(_along(points, curve))], len(sections))
    points = _turned(points, -middle)
    keep = np.concatenate(([True], np.diff(np.maximum.accumulate(points[:, 0])) > 0.0))
    spread = np.max(np.abs(motions - middle), axis=0)
    mean = Profile(
        f"mean of {len(sections)} sections of {first.name}",
        first.kind,
        points[keep, 0],
        points[keep, 1],
        source=first.source,
        smoothing=smoothing,
        is_mirrored=first.is_mirrored,
        ends_at_gauge_face=first.ends_at_gauge_face,
        remarks=(
            f"{len(sections)} sections laid on each other; from their mean they lay up to "
            f"{1e3 * spread[0]:.3f} mm in y, {1e3 * spread[1]:.3f} mm in z and "
            f"{1e3 * spread[2]:.2f} mrad away",
        ),
    )
    if mean.kind == "wheel":
        return mean.shifted(dz=-float(mean.height(0.0))) if low < 0.0 < high else mean
    return mean.shifted(dz=-float(np.max(mean.height(np.linspace(*mean.span, 2000)))))


def _motion(section: Profile, curve: Profile) -> FloatArray:
    """d_y, d_z [m] and theta [rad] that lay the section on the curve."""
    motion = np.zeros(3)
    low, high = curve.span
    for _ in range(_STEPS):
        y, z = _moved(section, motion).T
        inside = (y > low + _MARGIN) & (y < high - _MARGIN)
        y, z = y[inside], z[inside]
        if len(y) < len(section.y) // 2:
            break
        slope = curve.slope(y)
        alpha = np.arctan(slope)
        sin, cos = np.sin(alpha), np.cos(alpha)
        distance = (z - curve.height(y)) * cos
        gentle = np.abs(slope) < _STEEPEST
        middle = np.median(distance[gentle])
        deviation = 1.5 * np.median(np.abs(distance[gentle] - middle))
        used = gentle & (np.abs(distance - middle) <= _CUT * deviation + 1e-9)
        columns = np.column_stack([-sin, cos, y * cos + z * sin])[used]
        step = np.linalg.lstsq(columns, -distance[used], rcond=None)[0]
        motion += step
        if np.max(np.abs(step)) < 1e-9:
            break
    if np.max(np.abs(motion[:2])) > _FARTHEST or abs(motion[2]) > _LARGEST_ANGLE:
        raise ProfileError(
            f"{section.name} and {curve.name} cannot be laid on each other (moved by "
            f"{1e3 * motion[0]:.1f}, {1e3 * motion[1]:.1f} mm, {motion[2]:.2f} rad); give sections "
            "of one wheel or one rail, of the same side"
        )
    return motion


def _moved(section: Profile, motion: FloatArray) -> FloatArray:
    return _turned(np.column_stack([section.y, section.z]), motion)


def _turned(points: FloatArray, motion: FloatArray) -> FloatArray:
    sin, cos = np.sin(motion[2]), np.cos(motion[2])
    return np.asarray(points @ np.array([[cos, sin], [-sin, cos]]) + motion[:2])


def _along(points: FloatArray, curve: Profile) -> FloatArray:
    """Length along the curve of the points' feet on it."""
    grid = np.linspace(*curve.span, 4000)
    height = curve.height(grid)
    length = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(grid), np.diff(height)))))
    y = np.clip(points[:, 0], grid[0], grid[-1])
    alpha = np.arctan(curve.slope(y))
    beside = points[:, 0] - y
    above = points[:, 1] - curve.height(y)
    return np.interp(y, grid, length) + above * np.sin(alpha) + beside * np.cos(alpha)
