"""Rails whose profile changes along the track: shapes on the way from one section to the next.

Over the length of a blend, about the station where a section begins, the rail goes from the shape A
before to the shape B behind it by t = x^2 (3 - 2 x), x the part of the blend that is behind: smooth
in the arc length, with no step in its slope at the ends. Half-way shapes move every point of A,
placed in the track, towards the nearest point of B,

    P(t) = A + t (B_nearest - A),

which are a hundredth of a wheel's width apart where rails wear, and so along the normal of both;
points of A beyond an end of B are left out. Shapes are made at LEVELS equal steps of t; between two
of them, j <= t LEVELS < j + 1, forces are those on both, weighted with the distance in t: exact in
the first order of their difference, LEVELS^-2 of the square of that of A and B is left. Outside of
blends, and where both shapes are one, a rail is that of its section to the last bit.

Frame: track frame, the left rail; the right one is mirrored as everywhere.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from exudyn_wheelset.contact.descriptions import RailPlacement, Track
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.profiles import Profile

LEVELS = 8
# Points of A are taken this far [m] apart. Faces steeper than this slope of y over arc never carry.
_SPACING, _STEEPEST = 0.25e-3, 0.06
# Origin of half-way profiles [m] from the track's centre: any place on the head.
_ORIGIN = 0.75


def rails_change(track: Track) -> bool:
    """Whether a section of the track has other rails than the one before."""
    before = track
    for section in track.sections:
        behind = replace(before, rail=section.rail, right_rail=section.right_rail)
        if not _same(before, behind):
            return True
    return False


def rail_levels(track: Track) -> tuple[list[tuple[float, float]], list[Track]]:
    """Blends (first station, length) [m], and the tracks of one profile each on the way.

    Track 0 is before the first blend; blend k goes from track k LEVELS to (k + 1) LEVELS.
    """
    tracks = [replace(track, sections=())]
    blends = []
    for section in track.sections:
        before = tracks[-1]
        behind = replace(before, rail=section.rail, right_rail=section.right_rail)
        if _same(before, behind):
            continue
        blends.append((section.start - 0.5 * track.blend, track.blend))
        tracks += [_between(before, behind, j / LEVELS) for j in range(1, LEVELS)]
        tracks.append(behind)
    return blends, tracks


def _same(one: Track, other: Track) -> bool:
    return all(
        a.coefficients.shape == b.coefficients.shape
        and np.array_equal(a.coefficients, b.coefficients)
        for a, b in (
            (one.left_placement, other.left_placement),
            (one.right_placement, other.right_placement),
        )
    )


def _between(one: Track, other: Track, t: float) -> Track:
    """The track of shapes between those of two."""
    left = _shape(one.left_placement, other.left_placement, t)
    right = left
    if one.right_rail is not None or other.right_rail is not None:
        right = _shape(one.right_placement, other.right_placement, t)
    return replace(
        one,
        rail=left,
        right_rail=None if right is left else right,
        inclination=0.0,
        datum_half_distance=None,
        origin_half_distance=_ORIGIN,
    )


def _shape(one: RailPlacement, other: RailPlacement, t: float) -> Profile:
    step = max(round(_SPACING / one.spacing), 1)
    rows = one.coefficients[::step]
    rows = rows[rows[:, 1] > _STEEPEST]
    points = rows[:, [0, 4]]
    nearest, inside = _nearest(other, points)
    mixed = points + t * (nearest - points)
    mixed = mixed[inside]
    # Nearest points of neighbours may change places where a sharp corner lies between.
    rising = np.concatenate([[True], np.diff(mixed[:, 0]) > 0.05 * step * one.spacing])
    mixed = mixed[rising]
    if len(mixed) < 40:
        raise WheelsetError("two sections of rails do not lie above one another: check the gauge")
    return Profile(
        name=f"between rails ({t:g})", kind="rail", y=mixed[:, 0] - _ORIGIN, z=mixed[:, 1]
    )


def _nearest(rail: RailPlacement, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) of a rail nearest to others, and which are not beyond its ends."""
    rows = rail.coefficients
    _, index = cKDTree(rows[:, [0, 4]]).query(points)
    arc = index * rail.spacing
    last = len(rows) * rail.spacing
    for _ in range(6):
        place, tangent = _curve(rail, arc)
        ahead = ((points - place) * tangent).sum(axis=1) / (tangent**2).sum(axis=1)
        arc = np.clip(arc + ahead, 0.0, last)
    place, _ = _curve(rail, arc)
    return place, (arc > 0.0) & (arc < last)


def _curve(rail: RailPlacement, arc: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and tangents (n, 2) of a rail at arc lengths (n,) [m]."""
    index = np.minimum((arc / rail.spacing).astype(int), len(rail.coefficients) - 1)
    u = (arc - index * rail.spacing)[:, None]
    cubics = rail.coefficients[index].reshape(-1, 2, 4)
    c0, c1, c2, c3 = (cubics[:, :, k] for k in range(4))
    return c0 + u * (c1 + u * (c2 + u * c3)), c1 + u * (2.0 * c2 + 3.0 * u * c3)
