"""Records of the contact kernels: what each holds, and how it lies in a flat array of numbers.

From Python the kernels take two flat float64 arrays, the table of a wheelset on its track
(tables.py) and the result, and view them as records inside (`side_of`, `array.view(RESULT)[0]`):
one array is the cheapest thing to hand over (docs/decisions/kernels-with-records.md).

    SIDE        one wheel and its rail: curves, nodes of the scan, grid of the first guess
    PARAMETERS  what `contact_parameters` makes
    CANDIDATE   a node of the scan where a lobe may be, before it is refined
    LOBE        a maximum of the penetration: its place, its territory, moments of its zone
    LOAD        a semi-ellipsoid of pressure (ritz.py)
    GROUP       lobes as one gap, VALLEY what lies between them (energy.py)
    SHARE       what a patch's creep force needs besides PATCH while lobes merge
    STRIP       a strip of a patch along the rolling direction (strips.py)
    PATCH       the fields of `Patch`, in their order
    RESULT      wrench, patches of either wheel, and WORK, the room that an evaluation needs

Scalars that belong together travel between kernels as named tuples: Axle, Velocity, Material,
Creepage, Slip, Traction, Ellipse, Zone. A kernel must not view an array that it has made itself: a
record does not keep its array alive.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.normal_models import NORMAL_MODELS

MOST_LOBES = 4
# A wheel carries on one ellipse a lobe and one more where a patch is far from elliptic.
MOST_ELLIPSES = MOST_LOBES + 1
# Sets of loads between which the energy is blended (ritz.py).
LOBES, ONE_MORE, MERGED = range(3)
SETS = 3
MOST_PATCHES = MOST_LOBES
MOST_LINES = 640
STRIPS_A_LOBE = 20
MOST_NODES = 320
ENERGY = NORMAL_MODELS["energy"]
HERTZ_LOCAL = NORMAL_MODELS["hertz-local"]
RITZ = NORMAL_MODELS["ritz"]
STRIPS = NORMAL_MODELS["strips"]
VIRTUAL_PENETRATION = NORMAL_MODELS["virtual-penetration"]


@dataclass(frozen=True)
class Patch:
    """One contact patch; positions and angle count towards the field side of its own wheel.

    wheel_y [m] from the tape circle, rail_y [m] from the rail's highest point, angle [rad],
    radius [m] rolling radius, normal_force [N], creep_x, creep_y [-], spin [1/m], fx, fy [N] creep
    force on the wheel along x and the lateral tangent (right-handed triad, y to the left on both
    sides), mz [N m] about the normal, a, b [m] semi-axes along rolling and lateral, penetration
    [m], position (3) [m] from the wheelset's centre and normal (3), track frame; energy [J]
    elastic energy stored; peak_pressure [Pa]; twist [N m] moment about the normal of the normal
    pressures alone, for a patch whose parts stand at different leads (yaw), counted as on the
    left wheel: on the right one it turns the other way; friction [-] coefficient, at its slip.
    """

    wheel_y: float
    rail_y: float
    angle: float
    radius: float
    normal_force: float
    creep_x: float
    creep_y: float
    spin: float
    fx: float
    fy: float
    mz: float
    a: float
    b: float
    penetration: float
    position: tuple[float, float, float]
    normal: tuple[float, float, float]
    energy: float
    peak_pressure: float
    twist: float
    friction: float


def _record(*columns: tuple[Any, ...]) -> np.dtype:
    """Record of 8-byte fields; numpy.record, so that kernels run uncompiled as well."""
    return np.dtype((np.record, list(columns)))


def _numbers(*names: str) -> np.dtype:
    return _record(*((name, "f8") for name in names))


# Offsets are places in the table. A curve has so many segments of a length `spacing` [m],
# per_spacing is its inverse, last the number of the last one. A block is `count` columns of rows,
# one row after the other.
CURVE = _record(
    ("offset", "i8"), ("segments", "i8"), ("spacing", "f8"), ("per_spacing", "f8"), ("last", "f8")
)
BLOCK = _record(("offset", "i8"), ("count", "i8"))
NODE_ARC, NODE_LATERAL, NODE_RADIUS, NODE_SLOPE, NODE_FLATNESS = range(5)
GRID_HEIGHT, GRID_ARC = range(2)
# Of a line of force: place, tangent and curvature of the rail; then what is sampled on it:
# penetration [m], arc length of the wheel [m], and what gap_spline.py makes of them.
LINE_Y, LINE_Z, LINE_TANGENT_Y, LINE_TANGENT_Z, LINE_BEND = range(5)
GAP_DEPTH, GAP_ARC, GAP_COEFFICIENT, GAP_FIRST, GAP_SECOND, GAP_THIRD = range(6)
# tape [m]: tape circle from the axle's centre; radius [m] there; datum [m]: lateral position of
# the rail's highest point; grid_start, grid_step [m]: lateral positions of the grid; rail_low,
# rail_high [m]: lateral positions between which the rail carries; lines: of force, at places of
# the rail from line_start [m] on in steps of line_spacing [m].
SIDE = _record(
    ("radius", "f8"), ("tape", "f8"), ("datum", "f8"),
    ("wheel", CURVE), ("rail", CURVE),
    ("nodes", BLOCK), ("fine_nodes", BLOCK),
    ("grid", BLOCK), ("grid_start", "f8"), ("grid_step", "f8"),
    ("rail_low", "f8"), ("rail_high", "f8"),
    ("lines", BLOCK), ("line_start", "f8"), ("line_spacing", "f8"),
)  # fmt: skip
HEADER = 2 * SIDE.itemsize // 8

# friction: by rail and zone, ratio and decay with slip: friction.py; law: number of the creep law,
# law_parameters: its own; normal: HERTZ and so on; rail_speed [m/s]: at which the rails run
# backwards, in a model that stands in a moving frame.
PARAMETERS = _record(
    ("friction", "f8", (2, 3)), ("friction_ratio", "f8"), ("friction_decay", "f8"),
    ("shear_modulus", "f8"), ("poisson", "f8"), ("damping", "f8"),
    ("law", "f8"), ("normal", "f8"), ("rail_speed", "f8"), ("law_parameters", "f8", (8,)),
)  # fmt: skip

# Depths [m] at the node, before and behind it; valley: node of the valley before it.
CANDIDATE = _record(
    ("node", "i8"), ("valley", "i8"), ("depth", "f8"), ("before", "f8"), ("after", "f8")
)
# Moments of a zone, as in the named tuple Zone.
ZONE = _numbers("total", "arc", "foot", "normal_y", "normal_z")
# arc: wheel arc length of the maximum, foot: rail arc length [m]; curvature: 2 B [1/m]; left,
# right: ends of the territory in wheel arc; separation from the next lobe, 0 to 1; sunk [m]: in
# the fields of the others; own: moments of its zone, merged: as a part of a merged patch whose
# greatest penetration is merged_depth; node of the scan next to it; range of lines around it, its
# first and last cell and the ends of its zone in numbers of lines (gap_spline.py).
LOBE = _record(
    ("arc", "f8"), ("foot", "f8"), ("penetration", "f8"), ("curvature", "f8"),
    ("left", "f8"), ("right", "f8"), ("separation", "f8"), ("sunk", "f8"),
    ("own", ZONE), ("merged", ZONE), ("merged_depth", "f8"),
    ("node", "i8"), ("range", "i8"), ("low", "i8"), ("high", "i8"), ("begin", "f8"), ("end", "f8"),
)  # fmt: skip
# Place in wheel and rail arc, width, half length along x, penetration along the normal [m]; peak
# pressure [Pa]; half curvature along x [1/m]; normal from rail into wheel;
# x, y, z [m] from the wheelset's centre.
STRIP = _numbers(
    "arc", "foot", "width", "half_length", "depth", "pressure", "curvature",
    "normal_y", "normal_z", "x", "y", "z",
)  # fmt: skip
ELLIPSE = _numbers("force", "a", "b")
# A patch of separation s is s times `own` and (1 - s) share times `merged`, which it shares with
# the patch of lobe `partner`; damping: the factor that damping puts on elastic normal forces;
# place, arc: of the rail and of the wheel in the load's middle [m]; shift_y, shift_z: from the mean
# of both patches' places to that of `merged` [m], whose creepage along x is so much `faster`;
# first_strip, strip_count: its strips, if any.
SHARE = _record(
    ("lobe", "i8"), ("last_lobe", "i8"), ("partner", "i8"), ("separation", "f8"), ("share", "f8"),
    ("own", ELLIPSE), ("merged", ELLIPSE), ("damping", "f8"), ("place", "f8"), ("arc", "f8"),
    ("shift_y", "f8"), ("shift_z", "f8"), ("faster", "f8"),
    ("first_strip", "i8"), ("strip_count", "i8"),
)  # fmt: skip
_SHAPES: dict[str, tuple[int, ...]] = {"float": (), "tuple[float, float, float]": (3,)}
PATCH = _record(*((field.name, "f8", _SHAPES[str(field.type)]) for field in fields(Patch)))
# place: rail arc length of the centre [m], b: lateral semi-axis [m], t = ln(B/A): what the energy
# is stationary in. Averages of the penetration over the load and derivatives by place and by ln b
# (gap_spline.py); what `fill` says (ellipsoids.py); low, high: first and last cell of its range.
LOAD = _record(
    ("place", "f8"), ("b", "f8"), ("t", "f8"),
    ("average", "f8"), ("slope", "f8"), ("spread", "f8"),
    ("bend", "f8"), ("slope_spread", "f8"), ("spread_spread", "f8"),
    ("along", "f8"), ("relative", "f8"), ("force", "f8"), ("lateral", "f8"),
    ("a", "f8"), ("approach", "f8"), ("width", "f8"), ("own", "f8"), ("work", "f8"),
    ("force_by_t", "f8"), ("force_by_tt", "f8"), ("own_by_t", "f8"),
    ("ratio_by_t", "f8"), ("ratio_by_tt", "f8"),
    ("sunk", "f8"), ("lobe", "i8"), ("low", "i8"), ("high", "i8"),
)  # fmt: skip
# Lobes first to last as one gap (energy.py), on lines from begin to before end: the level and its
# slope by the depth of the valley on either side; moments, their places in lines from begin; the
# parabola's height [m] and half curvature [1/m], its depth; A and its relative slope; slope of
# ln N by ln B; skew: (c_5 - c_3) B/H; energy [J] alone, and sunk by others, what is left of it.
GROUP = _record(
    ("first", "i8"), ("last", "i8"), ("begin", "i8"), ("end", "i8"),
    ("level", "f8"), ("by_left", "f8"), ("by_right", "f8"),
    ("k3", "f8"), ("k4", "f8"), ("k5", "f8"), ("c3", "f8"), ("c5", "f8"),
    ("height", "f8"), ("lateral", "f8"), ("depth", "f8"), ("place", "f8"), ("along", "f8"),
    ("relative", "f8"), ("slope", "f8"), ("skew", "f8"), ("energy", "f8"), ("sunk", "f8"),
    ("load", "f8"), ("by_place", "f8"), ("flatter", "f8"),
)  # fmt: skip
# Between two lobes: its line; the separation and its derivatives by the depths of the valley and
# of the lobe on either side; the level beside it and its slope; gain [J]: dU by the separation;
# weight: dU by its depth through the levels [N].
VALLEY = _numbers(
    "place", "arc", "depth", "separation", "by_valley", "by_one", "by_two", "level", "level_slope",
    "gain", "weight",
)  # fmt: skip
# First and last node of a range in which the penetration has been sampled.
RANGE = _record(("first", "i8"), ("last", "i8"))
# A set of loads: how many, the energy [J] and the weight of its forces.
SET = _record(("count", "i8"), ("energy", "f8"), ("weight", "f8"))
# The loads of a lobe together: force [N], energy; shaping: force of those of positive weight, its
# sums of place (from the lobe's foot), of second moments, a^2 and depth; weight of their sets, with
# it the peak pressure [Pa]; the lines on which they press, first to before end, and the cells of
# their range.
WHOLE = _record(
    ("count", "i8"), ("force", "f8"), ("place", "f8"), ("second", "f8"), ("along", "f8"),
    ("depth", "f8"), ("energy", "f8"), ("weight", "f8"), ("peak", "f8"),
    ("first", "i8"), ("end", "i8"), ("low", "i8"), ("high", "i8"), ("shaping", "f8"),
)  # fmt: skip
# Lines of force of the separation x of two lobes: rail place, wheel arc and dx/dp.
LINE = _numbers("place", "arc", "weight")
COUPLING = _numbers(
    "total", "r", "l1", "t1", "l2", "t2", "rr", "rl1", "rt1", "rl2", "rt2",
    "l1l1", "l1t1", "t1t1", "l2l2", "l2t2", "t2t2", "l1l2", "l1t2", "t1l2", "t1t2",
)  # fmt: skip
# pair: first of two lobes that merge, or -1, pair_share: its part of what they carry.
WORK = _record(
    ("candidates", CANDIDATE, (MOST_LOBES,)), ("lobes", LOBE, (MOST_LOBES,)),
    ("shares", SHARE, (MOST_PATCHES,)), ("depths", "f8", (MOST_NODES,)),
    ("strips", STRIP, (MOST_LOBES * STRIPS_A_LOBE,)),
    ("loads", LOAD, (SETS, MOST_ELLIPSES)), ("sets", SET, (SETS,)),
    ("kept", LOAD, (MOST_ELLIPSES,)), ("trial", LOAD, (MOST_ELLIPSES,)),
    ("pair", "i8"), ("pair_share", "f8"),
    ("coupling", COUPLING), ("merging", LINE, (3,)), ("wrenches", "f8", (2, 5)),
    ("matrix", "f8", (3 * MOST_ELLIPSES, 3 * MOST_ELLIPSES + 1)),
    ("first_node", "i8"), ("final_node", "i8"), ("ranges", RANGE, (MOST_LOBES,)),
    ("gap", "f8", (6, MOST_LINES)), ("parts", "f8", (3, MOST_LINES)),
    ("whole", WHOLE), ("groups", GROUP, (MOST_LOBES,)), ("valleys", VALLEY, (MOST_LOBES,)),
)  # fmt: skip
RESULT = _record(
    ("force", "f8", (3,)), ("moment", "f8", (3,)),
    ("count", "i8", (2,)), ("patches", PATCH, (2, MOST_PATCHES)), ("work", WORK),
)  # fmt: skip
PARAMETER_COUNT = PARAMETERS.itemsize // 8
# Shifts, velocities and slopes of both rails (forces.py).
RAIL_MOTION = 12
RESULT_SIZE = RESULT.itemsize // 8


class Axle(NamedTuple):
    """Centre (y, z) [m] and unit vector (lx, ly, lz) towards the left wheel, track frame.

    For the right side mirrored, so that both sides are computed as the left one.
    """

    y: float
    z: float
    lx: float
    ly: float
    lz: float


class Velocity(NamedTuple):
    """Velocity of the wheelset's centre [m/s] and angular velocity [rad/s], track frame."""

    x: float
    y: float
    z: float
    about_x: float
    about_y: float
    about_z: float


class Material(NamedTuple):
    """Shear modulus [Pa] and Poisson number of wheel and rail."""

    shear_modulus: float
    poisson: float


class Creepage(NamedTuple):
    """Creepages [-] along x and the lateral tangent, and spin [1/m]."""

    x: float
    y: float
    spin: float


class Traction(NamedTuple):
    """Creep force on a patch in its triad (x, lateral tangent, normal): forces [N], moments [N m].

    Moments about the patch's position. A plane patch has no force along its normal, and no moment
    but the one about it.
    """

    x: float
    lateral: float
    normal: float
    moment_x: float
    moment_lateral: float
    moment_normal: float


class Slip(NamedTuple):
    """Velocity of a wheel over its rail: of the wheelset's centre [m/s], angular [rad/s], V [m/s].

    For the right side mirrored.
    """

    x: float
    y: float
    z: float
    about_x: float
    about_y: float
    about_z: float
    speed: float


class Ellipse(NamedTuple):
    """Normal force [N] on an elliptic patch, semi-axes a along rolling and b lateral [m]."""

    force: float
    a: float
    b: float


class Zone(NamedTuple):
    """Integrals over a zone of the lobe, each weighted with penetration minus level.

    total [m^2]; arc, foot: of wheel and rail arc length [m^3]; normal_y, normal_z: of the mean of
    the wheel's and the rail's normal, from rail into wheel [m^2].
    """

    total: float
    arc: float
    foot: float
    normal_y: float
    normal_z: float


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def side_of(table, hand):
    """Return the SIDE record of a wheelset's table: hand 0 is left, 1 right."""
    return table[:HEADER].view(SIDE)[hand]


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def block_row(table, block, row):
    """Return one row of a block of the table."""
    start = block.offset + row * block.count
    return table[start : start + block.count]


def new_result() -> np.ndarray:
    """Array that the kernels write into; one for each wheelset."""
    return np.zeros(RESULT_SIZE)
