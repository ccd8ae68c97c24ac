"""The scan for lobes, node by node, against the surface of revolution turned by rotation matrices.

What the scan finds is refined afterwards, so that an error of its own shows only as a lobe that is
missed: here it is held by itself. The point of a circle of the wheel that faces the rail is found
by setting the x of the turned surface's normal to zero with a root finder.
"""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

from exudyn_wheelset import Track, Wheelset
from exudyn_wheelset.contact import patches, search
from exudyn_wheelset.contact.layout import (
    GRID_HEIGHT,
    NODE_FLATNESS,
    NODE_LATERAL,
    NODE_RADIUS,
    NODE_SLOPE,
    Axle,
    block_row,
    side_of,
)
from exudyn_wheelset.contact.tables import contact_tables


@pytest.fixture(scope="module")
def table():
    wheelset = Wheelset(1500.0, (800.0, 110.0, 800.0), 0.46, "S1002")
    return contact_tables(wheelset, Track("UIC60"))


def turned(y, z, yaw, roll):
    """Axle record and rotation matrix of a wheelset turned about z and then x."""
    about_z = np.array(
        [[math.cos(yaw), -math.sin(yaw), 0], [math.sin(yaw), math.cos(yaw), 0], [0, 0, 1.0]]
    )
    about_x = np.array(
        [[1.0, 0, 0], [0, math.cos(roll), -math.sin(roll)], [0, math.sin(roll), math.cos(roll)]]
    )
    rotation = about_z @ about_x
    return Axle(y, z, *rotation[:, 1]), rotation


def facing_point(w, radius, slope, rotation):
    """y and z, from the axle's centre, of the lower point of a circle whose normal has no x."""

    def normal_x(angle):
        outward = np.array([math.sin(angle), -slope, -math.cos(angle)])
        return (rotation @ outward)[0]

    angle = brentq(normal_x, -0.5 * math.pi + 0.1, 0.5 * math.pi - 0.1, xtol=1e-15)
    point = np.array([radius * math.sin(angle), w, -radius * math.cos(angle)])
    return (rotation @ point)[1:]


POSES = [
    (0.0, 0.46, 0.0, 0.0),
    (4e-3, 0.4603, 0.012, 0.002),
    (-6e-3, 0.4598, -0.03, -0.003),
    (6e-3, 0.459, 0.03, 0.004),
]


def scanned(table, axle):
    """Depths of all nodes of the left wheel by the scan, and the rows it reads."""
    side = side_of(table, 0)
    rows = [
        np.array(block_row(table, side.nodes, row))
        for row in (NODE_LATERAL, NODE_RADIUS, NODE_SLOPE, NODE_FLATNESS)
    ]
    heights = np.array(block_row(table, side.grid, GRID_HEIGHT))
    depths = np.empty(len(rows[0]))
    search._scan(
        *rows,
        heights,
        depths,
        axle,
        side.rail_low,
        side.rail_high,
        side.grid_start,
        1.0 / side.grid_step,
    )
    return side, rows, heights, depths


@pytest.mark.parametrize("pose", POSES)
def test_depth_of_every_node(table, pose):
    """Vertical gap times the cosine of the wheel's angle; -1 beside the rail.

    Two terms of the root leave r x^3/16, x the square of yaw times the slope: 1e-12 m on the
    tread, 3 micrometres where the flange is steepest (slope 2.7) at 30 mrad.
    """
    axle, rotation = turned(*pose)
    side, (lateral, radii, slopes, _), heights, depths = scanned(table, axle)
    grid = side.grid_start + side.grid_step * np.arange(len(heights))
    seen = 0
    for k in range(len(depths)):
        point = facing_point(lateral[k], radii[k], slopes[k], rotation)
        y, z = pose[0] + point[0], pose[1] + point[1]
        if side.rail_low + 1e-6 < y < side.rail_high - 1e-6:
            gap = (np.interp(y, grid, heights) - z) / math.hypot(1.0, slopes[k])
            x = (rotation[0, 1] * math.hypot(1.0, slopes[k])) ** 2
            assert depths[k] == pytest.approx(gap, abs=radii[k] * x**3 / 8 + 1e-10)
            seen += 1
        elif not side.rail_low - 1e-6 < y < side.rail_high + 1e-6:
            assert depths[k] == -1.0
    assert seen > 20


@pytest.mark.parametrize("pose", POSES)
def test_no_node_over_the_rail_is_left_out(table, pose):
    """The range may hold more than the rail's width, never less; some 3 mm more on each side."""
    axle, rotation = turned(*pose)
    side, (lateral, *_), _, depths = scanned(table, axle)
    first, final = search._range_over_rail(table, side, axle)
    over = np.flatnonzero(depths > -1.0)
    assert first <= over[0] and final > over[-1]
    # lead of a flange contact in yaw moves a node by r t yaw^2 < 1.2 mm; 8 nodes end the halving
    beyond = lateral * rotation[1, 1] + pose[0]
    allowed = 3e-3 + 9 * np.max(np.diff(lateral)) + 0.01
    assert beyond[first] > side.rail_low - allowed
    assert beyond[final - 1] < side.rail_high + allowed


@pytest.mark.parametrize("peak", [-0.4, -0.1, 0.0, 0.3, 0.5])
def test_first_guess_of_a_lobe_is_the_vertex_of_its_parabola(peak):
    """Three depths of c - (x - peak)^2, steps of 1 around an arc length of 10."""
    depth = [2.0 - (x - peak) ** 2 for x in (-1.0, 0.0, 1.0)]
    candidate = SimpleNamespace(before=depth[0], depth=depth[1], after=depth[2])
    vertex = getattr(search._vertex, "py_func", search._vertex)
    assert vertex(9.0, 10.0, 11.0, candidate) == pytest.approx(10.0 + peak, abs=1e-14)


@pytest.mark.parametrize(
    "separations, partners",
    [
        ((0.3, 0.1), [(0.3, 1), (0.1, 2), (0.1, 1)]),
        ((0.1, 0.3), [(0.1, 1), (0.1, 0), (0.3, 1)]),
        ((0.2, 1.0), [(0.2, 1), (0.2, 0), (1.0, 1)]),
    ],
)
def test_partner_of_a_lobe_among_three(separations, partners):
    """A lobe merges with the neighbour it is less separated from; the last has the one before."""
    lobes = [SimpleNamespace(separation=value) for value in (*separations, math.inf)]
    partner = getattr(
        patches._less_separated_neighbour, "py_func", patches._less_separated_neighbour
    )
    assert [partner(lobes, k) for k in range(3)] == partners
