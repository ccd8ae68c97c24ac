"""How the coordinates of an Exudyn model become the states of an analysis.

Each node's second-order coordinates give positions and velocities, except that the rotation vector
of a rigid body becomes yaw, roll and (without spin) pitch, and cyclic coordinates have no position
in the state (see `reduction`). Names carry the units.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.coupling.registration import named_states
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.systems.reduction import (
    CYCLIC,
    ROTATION,
    expand_state,
    reduce_coordinates,
)

# Typical magnitudes of hunting below the flange: millimetres, milliradians, centimetres a second.
DISPLACEMENT_SCALE = 1.0e-3
VELOCITY_SCALE = 1.0e-2

ROTATION_VECTOR_NODE = "RigidBodyRotVecLG"
_AXES = ("x", "y", "z")
_POSES = ("x [m]", "y [m]", "z [m]", "yaw [rad]", "roll [rad]", "pitch [rad]")
_SPINS = ("wx [rad/s]", "wy [rad/s]", "wz [rad/s]")


@dataclass(frozen=True, eq=False)
class Layout:
    """Tables of `reduction` and the names of the states.

    positions          number of position states, which come first
    position_of        (nq) state of each second-order coordinate, CYCLIC or ROTATION
    rotations          (k, 3) first coordinate, state of yaw, 1 if it spins, by rotation vector
    reference          (k, 3) reference rotation vectors [rad]
    steady_velocities  (second-order coordinate, velocity per forward speed) in steady running
    names, scales      of all states
    wheelsets          position x [m] of the spinning bodies by their label in the names
    """

    positions: int
    position_of: Array
    rotations: Array
    reference: Array
    steady_velocities: tuple[tuple[int, float], ...]
    names: tuple[str, ...]
    scales: tuple[float, ...]

    wheelsets: Mapping[str, float]

    def wheelset_states(self, indices: Sequence[int]) -> tuple[int, int, int, int]:
        """States of y, z, yaw and roll of a spinning body with these coordinates.

        Displacements are CYCLIC where they were declared so.
        """
        row = int(np.flatnonzero(self.rotations[:, 0] == indices[3])[0])
        yaw = int(self.rotations[row, 1])
        return int(self.position_of[indices[1]]), int(self.position_of[indices[2]]), yaw, yaw + 1

    def expand(self, state: Array) -> tuple[Array, Array, Array]:
        """Coordinates, velocities (nq,), (nq,) and first-order coordinates (n1,) of a state (n,).

        Cyclic coordinates and spin angles come out as zero.
        """
        size = len(self.position_of)
        coordinates, velocities = np.zeros(size), np.zeros(size)
        first_order = np.zeros(len(self.names) - self.positions - size)
        expand_state(
            np.ascontiguousarray(state, dtype=float),
            self.position_of,
            self.rotations,
            self.reference,
            coordinates,
            velocities,
            first_order,
        )
        return coordinates, velocities, first_order

    def reduce(self, coordinates: Array, velocities: Array, first_order: Array) -> Array:
        """States (m, n) of m coordinates, velocities (m, nq) and first-order ones (m, n1)."""
        states = np.zeros((len(coordinates), len(self.names)))
        for row, state in enumerate(states):
            reduce_coordinates(
                np.ascontiguousarray(coordinates[row], dtype=float),
                np.ascontiguousarray(velocities[row], dtype=float),
                np.ascontiguousarray(first_order[row], dtype=float),
                self.position_of,
                self.rotations,
                self.reference,
                state,
            )
        return states


def lay_out(
    mbs: Any,
    nodes: Sequence[int],
    spinning: Mapping[int, float],
    cyclic: Mapping[int, float],
    name: str,
) -> Layout:
    """Layout of an assembled Exudyn system with the given nodes.

    `spinning` maps nodes to rolling radii [m] (0: unknown), `cyclic` second-order coordinates to
    their velocity per forward speed. First-order states are called and scaled as their object
    says (`name_states`), else "state k [1]". Raises AnalysisError, which begins with `name`, for
    entries that the model does not have or that cannot be cyclic.
    """
    data = mbs.systemData
    indices_of = {node: [int(index) for index in data.GetNodeLTGODE2(node)] for node in nodes}
    size = sum(map(len, indices_of.values()))
    _check_entries("spinning_nodes", spinning, indices_of, name)
    _check_entries("cyclic", cyclic, range(size), name)
    moving = sum(len(indices) > 0 for indices in indices_of.values())

    position_of = np.full(size, CYCLIC, dtype=np.int64)
    position_names: list[str] = []
    velocity_names = [""] * size
    first_order: dict[int, tuple[str, float]] = {}
    labels = _labels(mbs, nodes)
    named = named_states(mbs)
    rotations: list[tuple[int, int, int]] = []
    reference: list[Array] = []
    steady = list(cyclic.items())
    wheelsets: dict[str, float] = {}
    for node, indices in indices_of.items():
        description = mbs.GetNode(node)
        kind = description["nodeType"]
        label = labels[node]
        prefix = f"{label}: " if moving > 1 else ""
        rigid, spins = kind == ROTATION_VECTOR_NODE, node in spinning
        if spins:
            wheelsets[label if moving > 1 else ""] = description["referenceCoordinates"][0]
        if spins and not rigid:
            raise AnalysisError(
                f"{name}: node {node} ({kind}) cannot spin; create the body with "
                "NodeType.RotationRotationVector"
            )
        for local, index in enumerate(indices):
            position, velocity = _names(kind, local)
            velocity_names[index] = prefix + velocity
            if rigid and local >= 3:
                if index in cyclic:
                    raise AnalysisError(
                        f"{name}: coordinate {index} in cyclic is part of the rotation vector of "
                        f"node {node}; name the node in spinning_nodes instead"
                    )
                position_of[index] = ROTATION
            elif index not in cyclic:
                position_of[index] = len(position_names)
                position_names.append(prefix + position)
        if rigid:
            rotations.append((indices[3], len(position_names), int(spins)))
            reference.append(np.array(description["referenceCoordinates"])[3:6])
            position_names += [prefix + angle for angle in _POSES[3 : 5 if spins else 6]]
            if spins and spinning[node]:
                steady.append((indices[4], 1.0 / spinning[node]))
        for local, index in enumerate(data.GetNodeLTGODE1(node)):
            text, scale = f"state {local} [1]", VELOCITY_SCALE
            if (node, local) in named:
                own = named[node, local]
                text, scale = f"{own.name} [{own.unit}]", own.scale
            first_order[int(index)] = (f"{label}: {text}", scale)
    return Layout(
        positions=len(position_names),
        position_of=position_of,
        rotations=np.array(rotations, dtype=np.int64).reshape(-1, 3),
        reference=np.array(reference, dtype=float).reshape(-1, 3),
        steady_velocities=tuple(steady),
        names=(
            *position_names,
            *velocity_names,
            *(first_order[index][0] for index in sorted(first_order)),
        ),
        scales=(
            *(DISPLACEMENT_SCALE for _ in position_names),
            *(VELOCITY_SCALE for _ in velocity_names),
            *(first_order[index][1] for index in sorted(first_order)),
        ),
        wheelsets=wheelsets,
    )


def _labels(mbs: Any, nodes: Sequence[int]) -> dict[int, str]:
    """The nodes' names, numbered where several are called the same."""
    labels: dict[int, str] = {}
    for node in nodes:
        name = label = mbs.GetNode(node)["name"].removeprefix("Node:")
        number = 1
        while label in labels.values():
            number += 1
            label = f"{name} {number}"
        labels[node] = label
    return labels


def _names(kind: str, local: int) -> tuple[str, str]:
    """Names of position and velocity of a node's coordinate."""
    if local < 3 and (kind.startswith("RigidBody") or kind == "Point"):
        return f"{_AXES[local]} [m]", f"v{_AXES[local]} [m/s]"
    if kind == ROTATION_VECTOR_NODE:
        return _POSES[local], _SPINS[local - 3]
    if kind.startswith("RigidBody"):
        return f"rotation {local - 3} [rad]", f"rotation {local - 3}' [rad/s]"
    return f"q{local} [1]", f"q{local}' [1/s]"


def _check_entries(what: str, entries: Mapping[int, float], known: Any, name: str) -> None:
    for entry in entries:
        if entry not in known:
            raise AnalysisError(
                f"{name}: {what} names {entry}, the model has {', '.join(map(str, known))}"
            )
