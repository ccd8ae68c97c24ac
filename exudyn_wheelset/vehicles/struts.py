"""The laws of all connections of a vehicle with their ends on the bodies: what statics and kernel
work on.

A strut joins a point of a lower body to a point of an upper one. Its points are those of the
drawing; at a wheelset both are moved along by as much as its axle really stands beside the drawn
place, so a spring on an axle box of no size still begins with no length.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.vehicles import layout
from exudyn_wheelset.vehicles.description import GROUND, Axle, Connection, Vehicle
from exudyn_wheelset.vehicles.elements.protocol import Law
from exudyn_wheelset.vehicles.frames import place_frames, rotation_between
from exudyn_wheelset.vehicles.friction_kernel import monotone_hold


@dataclass(frozen=True)
class Strut:
    """One law between two bodies.

    connection; law: None for an element that adds its own items; lower, upper: numbers of the
    bodies among the vehicle's parts, their count for the ground; axes: layout.OF_LOWER, ...;
    points (2, 3) [m]: of both ends at rest, track frame; stiffness (6, 6): against loads that stay,
    track axes.
    """

    connection: Connection
    law: Law | None
    lower: int
    upper: int
    axes: int
    points: Array
    stiffness: Array

    def lever(self, centres: Array) -> Array:
        """(6, 6 (n + 1)) from displacements and rotations of all bodies to its strain."""
        count = len(centres)
        matrix = np.zeros((6, 6 * (count + 1)))
        for sign, body, point in zip(
            (-1.0, 1.0), (self.lower, self.upper), self.points, strict=True
        ):
            arm = np.zeros(3) if body == count else point - centres[body]
            place = matrix[:, 6 * body : 6 * body + 6]
            place[:3, :3] += sign * np.eye(3)
            place[:3, 3:] -= sign * cross_matrix(arm)
            place[3:, 3:] += sign * np.eye(3)
        return matrix[:, : 6 * count]

    @property
    def known(self) -> Array | None:
        """Force (3) [N] on the upper body in the drawing where it is given: by the connection, or
        by the law itself, which knows its load.
        """
        if self.connection.preload is not None:
            return np.array(self.connection.preload)
        load = None if self.law is None else self.law.load
        return None if load is None else np.array([0.0, 0.0, load])

    def moved(self, shift: Array) -> Strut:
        """The strut of a vehicle that is put elsewhere by `shift` (3) [m]."""
        return replace(self, points=self.points + shift)


def cross_matrix(vector: Array) -> Array:
    """Matrix of the cross product from the left."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def struts_of(vehicle: Vehicle, centres: Array) -> list[Strut]:
    """All struts; centres (n, 3) [m]: where the parts really are at rest."""
    number = {part.name: k for k, part in enumerate(vehicle.parts)}
    number[GROUND] = len(number)
    axles = {k for k, part in enumerate(vehicle.parts) if isinstance(part, Axle)}
    found = []
    for one in vehicle.connections:
        ends = (number[one.lower], number[one.upper])
        points = np.array(one.element.places(one.at))
        moved = next((end for end in ends if end in axles), None)
        if moved is not None:
            # Onto the axle: places off it by rounding, and the wheelset's real height.
            own = points[ends.index(moved)].copy()
            points[:, [0, 2]] += (centres[moved] - own)[[0, 2]]
        axes = _axes(*ends, axles, len(centres))
        if not hasattr(one.element, "laws"):
            stiffness = np.array(one.element.static_stiffness(), dtype=float)
            found.append(Strut(one, None, *ends, axes, points, stiffness))
            continue
        for law in one.element.laws():
            at = points + np.array(law.shift)
            line = at[1] - at[0]
            length = float(np.linalg.norm(line))
            stiffness = law.static_stiffness(line / length if length > 0.0 else line)
            own_axes = layout.OF_MIDDLE if law.middle else axes
            own_axes = layout.OF_TRACK if law.upright else own_axes
            found.append(Strut(one, law, *ends, own_axes, at, stiffness))
    return found


def _axes(lower: int, upper: int, axles: set[int], ground: int) -> int:
    if lower not in axles:
        return layout.OF_LOWER
    if upper == ground:
        return layout.OF_TRACK
    return layout.OF_LOWER if upper in axles else layout.OF_UPPER


def block_of(
    vehicle: Vehicle,
    struts: list[Strut],
    preloads: Array,
    rest: Array,
    centres: Array,
    carrier: Array | None = None,
) -> tuple[Array, list[Any]]:
    """The kernel's block of a vehicle, and the (connection, first-order state) of each state.

    preloads (m, 6): force and moment of each strut on its upper body at rest, track axes;
    rest (n, 6): displacement and rotation vector of the parts at rest against `centres` (n, 3).
    carrier (3) [m]: centre of a further body that takes the ground's place, as the last one.
    Places in the system are put in later; they are those of the vehicle alone here.
    """
    if carrier is not None:
        rest, centres = np.vstack([rest, np.zeros(6)]), np.vstack([centres, carrier])
    count = len(centres)
    bodies = np.zeros((count, layout.BODY))
    bodies[:, layout.FIRST] = 6 * np.arange(count)
    bodies[:, layout.POSITION] = centres
    for k, part in enumerate(vehicle.parts):
        bodies[k, layout.SPINS] = float(isinstance(part, Axle))
    frames = np.zeros((count + 1, layout.FRAME))
    place_frames(rest.ravel(), np.zeros(6 * count), bodies, frames)
    rows: list[Array] = []
    pool: list[Array] = []
    states: list[Any] = []
    size = 0
    for strut, preload in zip(struts, preloads, strict=True):
        law = strut.law
        if law is None:
            continue
        row = np.zeros(layout.ROW)
        row[[layout.KIND, layout.LOWER, layout.UPPER]] = law.kind, strut.lower, strut.upper
        row[layout.AXES] = strut.axes
        row[[layout.STATE, layout.POOL, layout.STOP, layout.BLOW_OFF]] = -1.0
        turned = []
        for body, point, place in zip(
            (strut.lower, strut.upper),
            strut.points,
            (layout.POINT_LOWER, layout.POINT_UPPER),
            strict=True,
        ):
            axes = frames[body, layout.F_AXES].reshape(3, 3)
            row[place] = axes.T @ (point - frames[body, layout.F_CENTRE])
            turned.append(axes)
        line = strut.points[1] - strut.points[0]
        own = turned[1] if strut.axes == layout.OF_UPPER else turned[0]
        if strut.axes == layout.OF_TRACK:
            own = np.eye(3)
        row[layout.REFERENCE][:3] = own.T @ line
        theta = np.zeros(3)
        rotation_between(turned[0].ravel(), turned[1].ravel(), theta)
        row[layout.REFERENCE][3:] = theta
        parts: list[tuple[int, Array]] = []
        turning = own.T @ preload[3:]
        row[layout.FORCE] = preload[:3]
        if law.friction is not None:
            left = np.concatenate([own.T @ preload[:3], turning])
            parts.append((layout.POOL, law.friction.pool(left)))
            row[layout.FORCE], turning = own @ left[:3], left[3:]
        row[layout.MOMENT] = turning
        row[layout.STIFFNESS], row[layout.DAMPING] = law.stiffness, law.damping
        row[layout.DIRECTION] = law.direction
        if law.kind == layout.ROD:
            row[layout.LENGTH] = np.linalg.norm(line)
            row[layout.TENSION] = -preload[:3] @ line / row[layout.LENGTH]
        if law.states:
            row[layout.STATE] = len(states)
            states += [(strut.connection.name, state) for state in law.states]
        if law.matrices is not None:
            both = np.concatenate([matrix.ravel() for matrix in law.matrices])
            parts.append((layout.POOL, both))
        for entry, curve in ((layout.STOP, law.stop), (layout.BLOW_OFF, law.blow_off)):
            if curve is not None:
                parts.append((entry, curve.pool()))
        for entry, content in parts:
            row[entry] = size
            size += len(content)
            pool.append(content)
        rows.append(row)
    laws = np.array(rows).reshape(-1, layout.ROW)
    block = layout.new_block(bodies, laws, np.concatenate([*pool, np.zeros(1)]), len(states))
    return block, states


def strokes_at(block: Array, pose: Array) -> Array:
    """First-order coordinates (k,) in a pose (6 n) that lasts.

    Strokes [m] at which no damper in series pulls, holds of friction after a straight way from the
    drawing, where they are relaxed.
    """
    count, laws = int(block[layout.H_BODIES]), int(block[layout.H_LAWS])
    start = int(block[layout.H_BODY_ROWS])
    bodies = block[start : start + count * layout.BODY].reshape(count, layout.BODY)
    start = int(block[layout.H_LAW_ROWS])
    rows = block[start : start + laws * layout.ROW].reshape(laws, layout.ROW)
    frames = np.zeros((count + 1, layout.FRAME))
    place_frames(pose, np.zeros(6 * count), bodies, frames)
    strokes = np.zeros(int(block[layout.H_STATES]))
    for row in rows:
        if row[layout.STATE] < 0:
            continue
        ends, turned = [], []
        for body, place in (
            (row[layout.LOWER], layout.POINT_LOWER),
            (row[layout.UPPER], layout.POINT_UPPER),
        ):
            axes = frames[int(body), layout.F_AXES].reshape(3, 3)
            ends.append(frames[int(body), layout.F_CENTRE] + axes @ row[place])
            turned.append(axes)
        own = turned[1] if row[layout.AXES] == layout.OF_UPPER else turned[0]
        if row[layout.AXES] == layout.OF_TRACK:
            own = np.eye(3)
        along = own.T @ (ends[1] - ends[0]) - row[layout.REFERENCE][:3]
        if row[layout.KIND] == layout.FRICTION:
            theta = np.zeros(3)
            rotation_between(turned[0].ravel(), turned[1].ravel(), theta)
            strain = np.concatenate([along, theta - row[layout.REFERENCE][3:]])
            data = int(block[layout.H_POOL]) + int(row[layout.POOL])
            monotone_hold(block, data, strain, strokes, int(row[layout.STATE]))
            continue
        strokes[int(row[layout.STATE])] = along @ row[layout.DIRECTION]
    return strokes
