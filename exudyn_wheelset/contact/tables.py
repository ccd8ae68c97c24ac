"""One flat table with everything the contact kernels know about a wheelset on its track.

The kernels take one float64 array instead of many, because unpacking an array costs a call from
Python more than the work on a patch. Each side has a header of HEADER numbers (left at 0, right at
HEADER); the right side is stored mirrored to the left, so that both sides run the same code.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from exudyn_wheelset.contact.descriptions import RailPlacement, Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.profiles import Profile

TAPE, RADIUS, DATUM = 0, 1, 2
WHEEL, WHEEL_SPACING, WHEEL_SEGMENTS = 3, 4, 5
RAIL, RAIL_SPACING, RAIL_SEGMENTS = 6, 7, 8
NODES, NODE_COUNT = 9, 10
GRID, GRID_START, GRID_STEP, GRID_COUNT = 11, 12, 13, 14
RAIL_LOW, RAIL_HIGH = 15, 16
FINE_NODES, FINE_COUNT = 17, 18
HEADER = 24
MOST_NODES = 320

# Two nodes a pair of millimetres see every patch: the sharpest curvatures in use (12 mm flange tip
# on a 13 mm gauge corner) sag 0.08 mm over a millimetre, less than SCAN_MARGIN in search.py; lobes
# closer together than two nodes merge anyway (benchmarks/scan_spacing.py). Rigid contact, which has
# no patches that merge, is scanned with twice as many nodes (FINE_NODES).
NODE_SPACING = 2.0e-3
GRID_SPACING = 0.25e-3
# Steeper parts (flange back, web side of the head) never carry a wheel; without them height is a
# function of the lateral position.
STEEPEST_SLOPE = 14.0


def contact_tables(wheelset: Wheelset, track: Track) -> np.ndarray:
    """Return the flat table of `wheelset` on `track`; read-only, built once for each pair."""
    return _contact_tables(_Identity(wheelset), _Identity(track))


class _Identity:
    """Hashes by identity: profiles hold arrays, which have no hash."""

    def __init__(self, what: object) -> None:
        self.what = what

    def __hash__(self) -> int:
        return id(self.what)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Identity) and other.what is self.what


@lru_cache(maxsize=64)
def _contact_tables(wheelset_key: _Identity, track_key: _Identity) -> np.ndarray:
    wheelset: Wheelset = wheelset_key.what  # type: ignore[assignment]
    track: Track = track_key.what  # type: ignore[assignment]
    blocks: list[np.ndarray] = []
    size = 2 * HEADER
    headers = np.zeros((2, HEADER))
    sides = [(wheelset.wheel, wheelset.radius, track.left_placement)]
    right_wheel = wheelset.right_wheel or wheelset.wheel
    right_radius = wheelset.right_radius or wheelset.radius
    sides.append((right_wheel, right_radius, track.right_placement))
    for header, (wheel, radius, rail) in zip(headers, sides, strict=True):
        header[TAPE] = wheelset.tape_half_distance
        header[RADIUS] = radius
        header[DATUM] = rail.datum_y
        for block, place in _side_blocks(header, wheel, radius, rail, wheelset.tape_half_distance):
            header[place] = size
            blocks.append(block.ravel())
            size += block.size
    table = np.concatenate([headers.ravel(), *blocks])
    table.setflags(write=False)
    return table


def _side_blocks(header, wheel: Profile, radius: float, rail: RailPlacement, tape: float):
    wheel_table = wheel.arc_table()
    wheel_curve = _gentle_part(wheel_table.coefficients, wheel.name)
    rail_curve = _gentle_part(rail.coefficients, "rail")
    header[WHEEL_SPACING] = wheel_table.ds
    header[WHEEL_SEGMENTS] = len(wheel_curve)
    header[RAIL_SPACING] = rail.spacing
    header[RAIL_SEGMENTS] = len(rail_curve)
    # A knife-edge is narrower than the usual spacing: nodes that do not step over it.
    node_spacing = min(NODE_SPACING, (rail_curve[-1, 0] - rail_curve[0, 0]) / 4.0)
    coarsest = wheel_table.ds * -(-len(wheel_curve) // MOST_NODES)
    nodes = _nodes(wheel_curve, wheel_table.ds, max(node_spacing, coarsest), radius, tape)
    fine = _nodes(wheel_curve, wheel_table.ds, 0.5 * node_spacing, radius, tape)
    header[NODE_COUNT] = nodes.shape[1]
    header[FINE_COUNT] = fine.shape[1]
    grid, start = _grid(rail_curve, rail.spacing)
    header[GRID_START] = start
    header[GRID_STEP] = GRID_SPACING
    header[GRID_COUNT] = grid.shape[1]
    header[RAIL_LOW] = start + GRID_SPACING
    header[RAIL_HIGH] = start + (grid.shape[1] - 2) * GRID_SPACING
    return [
        (wheel_curve, WHEEL),
        (rail_curve, RAIL),
        (nodes, NODES),
        (grid, GRID),
        (fine, FINE_NODES),
    ]


def _gentle_part(coefficients: np.ndarray, name: str) -> np.ndarray:
    gentle = np.abs(coefficients[:, 5]) <= STEEPEST_SLOPE * coefficients[:, 1]
    middle = int(np.argmin(np.abs(coefficients[:, 0] - np.mean(coefficients[:, 0]))))
    if not gentle[middle]:
        middle = int(np.flatnonzero(gentle)[len(np.flatnonzero(gentle)) // 2])
    first = middle
    while first > 0 and gentle[first - 1]:
        first -= 1
    last = middle
    while last + 1 < len(gentle) and gentle[last + 1]:
        last += 1
    if last - first < 20:
        raise WheelsetError(f"profile {name!r}: no usable running surface is left")
    return np.ascontiguousarray(coefficients[first : last + 1])


def _nodes(
    curve: np.ndarray, spacing: float, node_spacing: float, radius: float, tape: float
) -> np.ndarray:
    """Rows: arc length, distance from the axle's centre, radius, dr/dy, 1/sqrt(1 + (dr/dy)^2)."""
    step = max(round(node_spacing / spacing), 1)
    picked = np.arange(0, len(curve), step)
    rows = curve[picked]
    slope = -rows[:, 5] / rows[:, 1]
    return np.array(
        [
            picked * spacing,
            tape + rows[:, 0],
            radius - rows[:, 4],
            slope,
            1.0 / np.sqrt(1.0 + slope * slope),
        ]
    )


def _grid(curve: np.ndarray, spacing: float) -> tuple[np.ndarray, float]:
    """Rows: rail height and arc length on a uniform lateral grid."""
    start = float(curve[0, 0])
    count = int((curve[-1, 0] - start) / GRID_SPACING)
    lateral = start + GRID_SPACING * np.arange(count)
    arc = np.interp(lateral, curve[:, 0], spacing * np.arange(len(curve)))
    height = np.interp(lateral, curve[:, 0], curve[:, 4])
    return np.array([height, arc]), start
