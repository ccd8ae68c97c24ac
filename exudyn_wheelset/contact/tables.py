"""One flat table with everything the contact kernels know about a wheelset on its track.

The kernels take one float64 array instead of many, because unpacking an array costs a call from
Python more than the work on a patch. It begins with two records SIDE (layout.py), left and right,
which say where curves, nodes and grids lie in the rest; the right side is stored mirrored to the
left, so that both sides run the same code.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from exudyn_wheelset.contact.descriptions import RailPlacement, Track, Wheelset
from exudyn_wheelset.contact.layout import HEADER, MOST_LINES, MOST_NODES, SIDE
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.profiles import Profile

# Two nodes a pair of millimetres see every patch: the sharpest curvatures in use (12 mm flange tip
# on a 13 mm gauge corner) sag 0.08 mm over a millimetre, less than SCAN_MARGIN in search.py; lobes
# closer together than two nodes merge anyway (benchmarks/scan_spacing.py). Rigid contact, which has
# no patches that merge, is scanned with twice as many nodes (FINE_NODES).
NODE_SPACING = 2.0e-3
GRID_SPACING = 0.25e-3
# Lines of force of contact/gap_spline.py, and how many more go on straight beyond the rail's ends.
LINE_SPACING = 0.2e-3
LINES_BEYOND = 24
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
    table = np.zeros(HEADER)
    right_wheel = wheelset.right_wheel or wheelset.wheel
    right_radius = wheelset.right_radius or wheelset.radius
    sides = [
        (wheelset.wheel, wheelset.radius, track.left_placement),
        (right_wheel, right_radius, track.right_placement),
    ]
    tape = wheelset.tape_half_distance
    for hand, (wheel, radius, rail) in enumerate(sides):
        side = np.zeros(1, SIDE)[0]
        for name, block in _side_blocks(side, wheel, radius, rail, tape):
            side[name]["offset"] = table.size
            table = np.append(table, block)
        table[:HEADER].view(SIDE)[hand] = side
    table.setflags(write=False)
    return table


def _side_blocks(
    side: np.record, wheel: Profile, radius: float, rail: RailPlacement, tape: float
) -> list[tuple[str, np.ndarray]]:
    """Fill a SIDE record but for the offsets; return its curves, nodes and grid by field."""
    wheel_table = wheel.arc_table()
    wheel_curve = _gentle_part(wheel_table.coefficients, wheel.name)
    rail_curve = _gentle_part(rail.coefficients, "rail")
    # A knife-edge is narrower than the usual spacing: nodes that do not step over it.
    node_spacing = min(NODE_SPACING, (rail_curve[-1, 0] - rail_curve[0, 0]) / 4.0)
    coarsest = wheel_table.ds * -(-len(wheel_curve) // MOST_NODES)
    nodes = _nodes(wheel_curve, wheel_table.ds, max(node_spacing, coarsest), radius, tape)
    fine = _nodes(wheel_curve, wheel_table.ds, 0.5 * node_spacing, radius, tape)
    grid, start = _grid(rail_curve, rail.spacing)
    side["radius"], side["tape"], side["datum"] = radius, tape, rail.datum_y
    for curve, rows, spacing in (
        ("wheel", wheel_curve, wheel_table.ds),
        ("rail", rail_curve, rail.spacing),
    ):
        side[curve]["segments"], side[curve]["last"] = len(rows), len(rows) - 1
        side[curve]["spacing"], side[curve]["per_spacing"] = spacing, 1.0 / spacing
    lines, side["line_start"], side["line_spacing"] = _lines(rail_curve, rail.spacing)
    blocks = [("nodes", nodes), ("grid", grid), ("fine_nodes", fine), ("lines", lines)]
    for name, block in blocks:
        side[name]["count"] = block.shape[1]
    side["grid_start"], side["grid_step"] = start, GRID_SPACING
    side["rail_low"] = start + GRID_SPACING
    side["rail_high"] = start + (grid.shape[1] - 2) * GRID_SPACING
    return [("wheel", wheel_curve), ("rail", rail_curve), *blocks]


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
    """Rows NODE_...: arc length, distance from the axle's centre, radius, dr/dy, flatness.

    flatness: 1/sqrt(1 + (dr/dy)^2).
    """
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
    """Rows GRID_...: rail height and arc length on a uniform lateral grid."""
    start = float(curve[0, 0])
    count = int((curve[-1, 0] - start) / GRID_SPACING)
    lateral = start + GRID_SPACING * np.arange(count)
    arc = np.interp(lateral, curve[:, 0], spacing * np.arange(len(curve)))
    height = np.interp(lateral, curve[:, 0], curve[:, 4])
    return np.array([height, arc]), start


def _lines(curve: np.ndarray, spacing: float) -> tuple[np.ndarray, float, float]:
    """Rows LINE_... at places of the rail, the first place and the step between them [m]."""
    step = min(max(round(LINE_SPACING / spacing), 1), len(curve) // 20)
    most = MOST_LINES - 2 * LINES_BEYOND
    step = max(step, -(-len(curve) // most))
    rows = curve[::step]
    tangents = rows[:, [1, 5]]
    bend = 2.0 * (rows[:, 1] * rows[:, 6] - rows[:, 5] * rows[:, 2])
    lines = np.column_stack([rows[:, [0, 4]], tangents, bend])
    steps = step * spacing * np.arange(1, LINES_BEYOND + 1)[:, None]
    before, after = (np.repeat(lines[[end]], LINES_BEYOND, axis=0) for end in (0, -1))
    before[:, :2] -= steps[::-1] * before[:, 2:4]
    after[:, :2] += steps * after[:, 2:4]
    before[:, 4] = after[:, 4] = 0.0
    start = -LINES_BEYOND * step * spacing
    return np.vstack([before, lines, after]).T, start, step * spacing
