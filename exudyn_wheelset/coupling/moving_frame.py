"""What a frame that follows the track does to the bodies that stand in it.

A body's centre of mass is at r in the frame, with the velocity v and the angular velocity W (body
axes) relative to it; w is the frame's angular velocity, w' its rate, a0 the acceleration of its
origin (track_kernel.py). Newton's and Euler's laws over the ground are those in the frame with

    force   -m [a0 + g (n - e_z) + w' x r + w x (w x r) + 2 w x v],
    torque  -[I w' + w x I (W + w) + W x I w]                           in body axes,

w' there being the rate of w as the body's axes see it, R^T w' - W x w. n is the ground's vertical
in the frame: the model's own weights point along -e_z, and are turned by the second term. For a
wheelset the spin is part of W, so the gyroscopic moment of a curve is in it. On straight track all
is zero.

Derivation: x = r0 + A r gives A^T x'' = a0 + w' x r + w x (w x r) + 2 w x v + r''; with the angular
momentum I (W + w) in body axes, torque = I (W' + (w)') + (W + w) x I (W + w), of which
I W' + W x I W is what the model has.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import ObjectGenericODE2

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import finite_array, number, positive
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.coupling.track_frame import TrackFrame
from exudyn_wheelset.coupling.track_kernel import CURVED, LIVE, SPEED, START, frame_turning
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt

_CURRENT = exu.ConfigurationType.Current
# Motion of a frame: w [rad/s], w' [rad/s^2], a0 + g (n - e_z) [m/s^2], all in its axes.
MOTION = 9
# Row of a body: its first coordinate, mass [kg], Ixx, Iyy, Izz, Ixy, Ixz, Iyz [kg m^2], x, y, z [m]
# of the centre in the reference configuration.
FIRST, MASS, INERTIA, CENTRE = 0, 1, 2, 8
BODY = 11


@compiled
def frame_motion(track, t, gravity, motion):
    """Fill the motion (9) of a frame at time t [s] under gravity [m/s^2]; 0 on straight track."""
    if track[CURVED] == 0.0:
        motion[:] = 0.0
        return
    speed = track[SPEED]
    here = track[START]
    if track[LIVE] != 0.0:
        here += speed * t
    wx, wy, wz, rx, ry, rz, nx, ny, nz = frame_turning(track, here)
    square = speed * speed
    motion[0], motion[1], motion[2] = speed * wx, speed * wy, speed * wz
    motion[3], motion[4], motion[5] = square * rx, square * ry, square * rz
    motion[6] = gravity * nx
    motion[7] = square * wz + gravity * ny
    motion[8] = -square * wy + gravity * (nz - 1.0)


@compiled(inline="always")
def _cross(ax, ay, az, bx, by, bz):
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@compiled(inline="always")
def _inertia_times(row, x, y, z):
    ixx, iyy, izz = row[INERTIA], row[INERTIA + 1], row[INERTIA + 2]
    ixy, ixz, iyz = row[INERTIA + 3], row[INERTIA + 4], row[INERTIA + 5]
    return ixx * x + ixy * y + ixz * z, ixy * x + iyy * y + iyz * z, ixz * x + iyz * y + izz * z


@compiled(inline="always")
def _into_body(s, c, tx, ty, tz, x, y, z):
    """Components in body axes: R^T m = m - s theta x m + c theta x (theta x m)."""
    ux, uy, uz = _cross(tx, ty, tz, x, y, z)
    vx, vy, vz = _cross(tx, ty, tz, ux, uy, uz)
    return x - s * ux + c * vx, y - s * uy + c * vy, z - s * uz + c * vz


@compiled
def add_body_loads(motion, row, q, v, first, force):
    """Add the loads of the frame's motion on one body to force (6), torque in body axes.

    row (BODY) of the body, whose six coordinates begin at `first` of q and v.
    """
    mass = row[MASS]
    x, y, z = row[CENTRE] + q[first], row[CENTRE + 1] + q[first + 1], row[CENTRE + 2] + q[first + 2]
    wx, wy, wz = motion[0], motion[1], motion[2]
    ex, ey, ez = motion[3], motion[4], motion[5]
    ux, uy, uz = _cross(wx, wy, wz, x, y, z)
    ux += 2.0 * v[first]
    uy += 2.0 * v[first + 1]
    uz += 2.0 * v[first + 2]
    ax, ay, az = _cross(wx, wy, wz, ux, uy, uz)
    bx, by, bz = _cross(ex, ey, ez, x, y, z)
    force[0] -= mass * (motion[6] + ax + bx)
    force[1] -= mass * (motion[7] + ay + by)
    force[2] -= mass * (motion[8] + az + bz)
    tx, ty, tz = q[first + 3], q[first + 4], q[first + 5]
    square = tx * tx + ty * ty + tz * tz
    if square > 1.0e-10:
        angle = math.sqrt(square)
        s = math.sin(angle) / angle
        c = (1.0 - math.cos(angle)) / square
    else:
        s = 1.0 - square / 6.0
        c = 0.5 - square / 24.0
    wx, wy, wz = _into_body(s, c, tx, ty, tz, wx, wy, wz)
    ex, ey, ez = _into_body(s, c, tx, ty, tz, ex, ey, ez)
    ox, oy, oz = v[first + 3], v[first + 4], v[first + 5]
    # The rate as the body's axes see it.
    dx, dy, dz = _cross(ox, oy, oz, wx, wy, wz)
    mx, my, mz = _inertia_times(row, ex - dx, ey - dy, ez - dz)
    hx, hy, hz = _inertia_times(row, ox + wx, oy + wy, oz + wz)
    gx, gy, gz = _cross(wx, wy, wz, hx, hy, hz)
    kx, ky, kz = _inertia_times(row, wx, wy, wz)
    lx, ly, lz = _cross(ox, oy, oz, kx, ky, kz)
    force[3] -= mx + gx + lx
    force[4] -= my + gy + ly
    force[5] -= mz + gz + lz


@compiled
def frame_loads(track, t, gravity, bodies, q, v, motion, forces):
    """Fill forces (6 n) on n bodies (n, BODY) that stand in the frame."""
    frame_motion(track, t, gravity, motion)
    for b in range(bodies.shape[0]):
        force = forces[6 * b : 6 * b + 6]
        force[:] = 0.0
        add_body_loads(motion, bodies[b], q, v, int(bodies[b, FIRST]), force)


@spelt
def add_frame_loads(
    mbs: Any,
    frame: TrackFrame,
    bodies: Iterable[tuple[int, float, Any]],
    gravity: float = GRAVITY,
    name: str = "moving frame",
) -> int:
    """Add the loads that a frame's motion puts on the bodies of a model; return the object.

    bodies: (node, mass [kg], inertia (3) or (3, 3) [kg m^2] about the centre of mass, which is the
    node's position) of each, nodes of NodeType.RotationRotationVector with the identity as their
    reference orientation; gravity [m/s^2]: of the weights that the model has along -z. Exudyn's
    ground becomes the frame: origin on the track's centre line, x along it, z canted.
    Raises WheelsetError for nodes of other kinds.

    Examples
    --------
    >>> import exudyn as exu
    >>> from exudyn.utilities import InertiaCuboid
    >>> from exudyn_wheelset import Curve, Layout, TrackFrame, add_frame_loads
    >>> mbs = exu.SystemContainer().AddSystem()
    >>> body = mbs.CreateRigidBody(
    ...     inertia=InertiaCuboid(density=500, sideLengths=[1, 1, 1]), referencePosition=[0, 0, 1],
    ...     nodeType=exu.NodeType.RotationRotationVector, returnDict=True)
    >>> frame = TrackFrame(Layout([Curve(radius=300, length=500)]))
    >>> loads = add_frame_loads(mbs, frame, [(body["nodeNumber"], 500.0, (83.0, 83.0, 83.0))])
    >>> mbs.GetObject(loads)["name"]
    'moving frame'
    """
    if not hasattr(mbs, "GetNode"):
        raise WheelsetError(f"mbs = {mbs!r}: give Exudyn's system, SC.AddSystem()")
    number("gravity", gravity, "m/s^2", 0.0, 100.0)
    nodes, rows = [], []
    for node, mass, inertia in bodies:
        positive("mass of a body", mass, "kg", 1e7)
        item = mbs.GetNode(node)
        reference = np.array(item["referenceCoordinates"], dtype=float)
        if item["nodeType"] != "RigidBodyRotVecLG" or np.any(reference[3:6]):
            raise WheelsetError(
                f"{item['name']} ({item['nodeType']}): create the body with "
                "NodeType.RotationRotationVector and no reference rotation to put it in a frame "
                "that moves"
            )
        tensor = finite_array("inertia of a body", inertia, "kg m^2")
        if tensor.shape == (3,):
            tensor = np.diag(tensor)
        row = np.zeros(BODY)
        row[MASS] = mass
        row[INERTIA:CENTRE] = [*np.diag(tensor), tensor[0, 1], tensor[0, 2], tensor[1, 2]]
        row[CENTRE:] = reference[:3]
        nodes.append(int(node))
        rows.append(row)
    function = _load_function(frame, np.array(rows), nodes, gravity)
    return int(
        mbs.AddObject(ObjectGenericODE2(name=name, nodeNumbers=nodes, forceUserFunction=function))
    )


def _load_function(
    frame: TrackFrame, rows: Array, nodes: list[int], gravity: float
) -> Callable[..., Array]:
    """User function of the object: a closure over the system's own vectors."""
    forces, motion, track = np.zeros(6 * len(rows)), np.zeros(MOTION), frame.array
    coordinates: Any = None
    velocities: Any = None
    size: Any = None
    known = -1

    def forces_of(mbs: Any, t: float, item: int, q: Any, q_t: Any) -> Array:
        nonlocal coordinates, velocities, size, known
        if known < 0 or size() != known:
            data = mbs.systemData
            for row, node in zip(rows, nodes, strict=True):
                row[FIRST] = int(data.GetNodeLTGODE2(node)[0])
            coordinates, velocities = data.GetODE2Coordinates, data.GetODE2Coordinates_t
            size = data.ODE2Size
            known = size()
        frame_loads(
            track, t, gravity, rows, coordinates(_CURRENT, False), velocities(_CURRENT, False),
            motion, forces,
        )  # fmt: skip
        return forces

    return forces_of
