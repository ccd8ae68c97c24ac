"""Points far off the curve through their neighbours, left out at a tolerance or by the noise."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles.curve import chord_length, distance_to_neighbours
from exudyn_wheelset.profiles.formats.raw import fault, listed
from exudyn_wheelset.profiles.mending import CLOSEST
from exudyn_wheelset.profiles.noise import normal_noise

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Spikes: this many deviations of the noise and this far [m] off, while the points beside one lie
# three times nearer to the curve without it (a corner's neighbours do not).
_DEVIATIONS = 8.0
_LEAST_SPIKE = 2e-5
_NEIGHBOURS = 1.0 / 3.0


def without_spikes(points: FloatArray, lines: IntArray, remarks: list[str]) -> IntArray:
    """Indices without single points that stand out of the noise of all others."""
    keep = np.arange(len(points))
    dropped: list[int] = []
    limit = max(_DEVIATIONS * normal_noise(points), _LEAST_SPIKE)
    while len(keep) > 20 and len(dropped) < 0.02 * len(points):
        distance = distance_to_neighbours(points[keep])
        worst = int(np.argmax(distance))
        if distance[worst] <= limit:
            break
        around = keep[max(worst - 6, 0) : worst + 7]
        rest = points[around[around != keep[worst]]]
        if np.max(distance_to_neighbours(rest)) > _NEIGHBOURS * distance[worst]:
            break
        dropped.append(int(keep[worst]))
        keep = np.delete(keep, worst)
    if dropped:
        words = [str(line) for line in sorted(lines[dropped])]
        remarks.append(
            f"{len(dropped)} single points beyond {1e6 * limit:.3g} micrometres left out, "
            f"lines {listed(words, 10)}"
        )
    return keep


def without_outliers(
    points: FloatArray, tolerance: float, lines: IntArray, label: str, remarks: list[str]
) -> IntArray:
    """Indices of the points within `tolerance` [m] of the curve through their neighbours."""
    if not tolerance > 0.0:
        raise ProfileError(f"{label}: outlier_tolerance = {tolerance:g} m; use a positive distance")
    keep = np.arange(len(points))
    t = chord_length(points)
    keep = keep[np.concatenate(([True], np.diff(t) > CLOSEST))]
    doubled = len(points) - len(keep)
    if doubled:
        remarks.append(f"{doubled} doubled points left out")
    dropped: list[int] = []
    while len(keep) >= 8:
        distance = distance_to_neighbours(points[keep])
        worst = np.flatnonzero(distance > tolerance)
        if not len(worst):
            break
        gone = np.zeros(len(keep) + 4, dtype=bool)
        for i in worst[np.argsort(-distance[worst])]:
            if not np.any(gone[max(i - 2, 0) : i + 3]):
                gone[i] = True
        dropped += [int(lines[i]) for i in keep[gone[: len(keep)]]]
        keep = keep[~gone[: len(keep)]]
    if 5 * len(dropped) > len(points) or len(keep) < 8:
        raise fault(
            label,
            min(dropped),
            f"more than a fifth of the points lie farther than {tolerance:g} m from their "
            f"neighbours; raise outlier_tolerance to {_usual_distance(points):.2g} or more, or "
            "leave it out and give smoothing='auto'",
        )
    if dropped:
        words = [str(line) for line in sorted(dropped)]
        remarks.append(
            f"{len(dropped)} outliers beyond {1e6 * tolerance:g} micrometres left out, "
            f"lines {listed(words, 10)}"
        )
    return keep


def _usual_distance(points: FloatArray) -> float:
    """A tolerance [m] that few points exceed."""
    return 2.0 * float(np.quantile(distance_to_neighbours(points), 0.98)) + 1e-9
