"""Adding a vehicle to an Exudyn system: its bodies, its wheelsets, its connections in one call.

All laws of a vehicle are evaluated by one compiled call a state (kernel.py). Exudyn sees them as
one ObjectGenericODE2 over the nodes of all parts, whose force is theirs, and one ObjectGenericODE1
with the strokes of dampers in series. The model stands in the frame that moves at V, like all
vehicles of this package: Exudyn's ground is what moves along.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import (
    MarkerBodyRigid,
    NodeGenericODE1,
    ObjectGenericODE1,
    ObjectGenericODE2,
    RigidBodyInertia,
)

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import number
from exudyn_wheelset.coupling.create import create_wheelset
from exudyn_wheelset.coupling.moving_frame import add_frame_loads
from exudyn_wheelset.coupling.registration import (
    FirstOrderState,
    WheelsetItems,
    name_states,
)
from exudyn_wheelset.coupling.track_frame import TrackFrame
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
from exudyn_wheelset.vehicles import kernel, layout
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.drawbar import Drawbar, add_drawbar
from exudyn_wheelset.vehicles.elements.protocol import End
from exudyn_wheelset.vehicles.links import add_links
from exudyn_wheelset.vehicles.rest import Rest, find_rest
from exudyn_wheelset.vehicles.shapes import body_graphics
from exudyn_wheelset.vehicles.spin_drive import create_spin_drive
from exudyn_wheelset.vehicles.struts import block_of, strokes_at

_CURRENT = exu.ConfigurationType.Current


class Connectors:
    """The compiled connections of one vehicle in an Exudyn system."""

    def __init__(self, block: Array, nodes: Sequence[int], states: int) -> None:
        self.block = block
        self._nodes = tuple(nodes)
        self._states = states
        self._object: int | None = None
        self._data: Any = None
        start = int(block[layout.H_FORCES])
        self._forces = block[start : start + 6 * len(nodes)]
        start = int(block[layout.H_RATES])
        self._rates = block[start : start + states]
        self._none = np.zeros(1)

    def attach_states(self, number_of_object: int) -> None:
        """Bind the object that holds the strokes of the dampers in series."""
        self._object = number_of_object

    def place(self, mbs: Any) -> None:
        """Look up where the coordinates stand in the assembled system."""
        self._data = mbs.systemData
        start = int(self.block[layout.H_BODY_ROWS])
        for k, node in enumerate(self._nodes):
            first = int(self._data.GetNodeLTGODE2(node)[0])
            self.block[start + k * layout.BODY + layout.FIRST] = first
        if self._object is not None:
            first = int(self._data.GetObjectLTGODE1(self._object)[0])
            self.block[layout.H_FIRST_STATE] = first
        layout.forget(self.block)

    def functions(self) -> tuple[Callable[..., Array], Callable[..., Array]]:
        """User functions of the ObjectGenericODE2 (forces) and the ObjectGenericODE1 (rates).

        Closures over the system's own vectors, which are read before anything can change them.
        """
        block, forces, rates, none = self.block, self._forces, self._rates, self._none
        evaluate = kernel.connection_forces
        coordinates: Any = None
        velocities: Any = None
        first_order: Any = None

        def bind(mbs: Any) -> None:
            nonlocal coordinates, velocities, first_order
            self.place(mbs)
            coordinates = self._data.GetODE2Coordinates
            velocities = self._data.GetODE2Coordinates_t
            first_order = self._data.GetODE1Coordinates

        def forces_of(mbs: Any, t: float, item: int, q: Any, q_t: Any) -> Array:
            if coordinates is None:
                bind(mbs)
            strokes = first_order(_CURRENT, False) if self._states else none
            evaluate(coordinates(_CURRENT, False), velocities(_CURRENT, False), strokes, block)
            return forces

        def rates_of(mbs: Any, t: float, item: int, q: Any) -> Array:
            if coordinates is None:
                bind(mbs)
            strokes = first_order(_CURRENT, False)
            evaluate(coordinates(_CURRENT, False), velocities(_CURRENT, False), strokes, block)
            return rates

        return forces_of, rates_of

    def energy(self, mbs: Any) -> tuple[float, float]:
        """Potential energy [J] and power taken by the dampers [W] at the current state."""
        if self._data is None:
            self.place(mbs)
        data = mbs.systemData
        strokes = np.array(data.GetODE1Coordinates()) if self._states else self._none
        kernel.connection_forces(
            np.array(data.GetODE2Coordinates()),
            np.array(data.GetODE2Coordinates_t()),
            strokes,
            self.block,
        )
        return float(self.block[layout.H_ENERGY]), float(self.block[layout.H_POWER])


@dataclass(frozen=True)
class BodyItems:
    """Item numbers of a body: its node and the body itself."""

    node: int
    body: int


@dataclass(frozen=True)
class VehicleItems:
    """Item numbers of a vehicle in an Exudyn system, by the names of its parts.

    bodies; wheelsets; connections: what elements that add items of their own have returned;
    connector: object with all other connections (None without any), connectors: what is behind
    it; states: object of first-order coordinates, or None; name: of the vehicle in this system;
    radii: rolling radius V/spin [m] of each wheelset, by node; drawbar: None where nothing has to
    be pulled; frame: that all parts stand in; loads [N] of the left and the right wheel at rest.
    """

    name: str
    bodies: Mapping[str, BodyItems]
    wheelsets: Mapping[str, WheelsetItems]
    connections: Mapping[str, Any]
    connector: int | None
    connectors: Connectors
    states: int | None
    radii: Mapping[int, float]
    drawbar: Drawbar | None = None
    frame: TrackFrame = field(default_factory=TrackFrame)
    loads: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @property
    def contacts(self) -> tuple[WheelRailContact, ...]:
        """Contacts of the wheelsets, in the order of the vehicle."""
        return tuple(items.contact for items in self.wheelsets.values())

    def node(self, name: str) -> int:
        """Node of a body or wheelset by name."""
        items: dict[str, Any] = {**self.bodies, **self.wheelsets}
        return int(items[name].node)


def add_vehicle(
    mbs: Any,
    vehicle: Vehicle,
    speed: float,
    *,
    position: Sequence[float] = (0.0, 0.0),
    ground_body: int | None = None,
    show: bool = True,
    sensors: bool = True,
    **options: Any,
) -> VehicleItems:
    """Add a vehicle to `mbs`, in the frame that moves at `speed` [m/s]; return its item numbers.

    position (x, y) [m]: where the drawing's origin is put; ground_body: rigid body of `mbs`, with a
    node of NodeType.RotationRotationVector, that connections to the ground stand on; options: of
    `create_wheelset` (irregularity, rail_elasticity, lateral_offset, ...), for all wheelsets. The
    vehicle stands in its equilibrium, its wheelsets rolling. Names that the system has already
    get a number. Raises WheelsetError for a vehicle that cannot stand (see `static_equilibrium`).
    """
    number("speed", speed, "m/s")
    rest = find_rest(vehicle)
    track = vehicle.track
    if options.get("irregularity") is not None:
        track = replace(track, irregularity=options.pop("irregularity"))
    travelling = TrackFrame.of(track)
    shift = np.array([position[0], position[1], 0.0])
    name = _unused_name(mbs, vehicle)
    prefix = "" if name == vehicle.name else f"{name} "
    if ground_body is None:
        ground = BodyItems(-1, int(mbs.CreateGround()))
    else:
        ground = BodyItems(int(mbs.GetObject(ground_body)["nodeNumber"]), int(ground_body))
    wheelsets: dict[str, WheelsetItems] = {}
    bodies: dict[str, BodyItems] = {}
    radii: dict[int, float] = {}
    for k, (axle, at_rest) in enumerate(zip(vehicle.wheelsets, rest.axles, strict=True)):
        centre = rest.centres[k] + shift
        items = create_wheelset(
            mbs,
            axle.wheelset,
            track,
            position=(float(centre[0]), float(centre[1])),
            height=float(centre[2]) - axle.wheelset.radius,
            speed=speed,
            moving_frame=True,
            gravity=vehicle.gravity,
            contact=vehicle.contact,
            sensors=sensors,
            show=show,
            name=prefix + axle.name,
            frame=travelling,
            **options,
        )
        _put_at_rest(mbs, items.node, rest.pose[k], speed / at_rest.radius)
        if axle.driven:
            create_spin_drive(mbs, items, axle.wheelset.radius)
        wheelsets[axle.name] = items
        radii[items.node] = at_rest.radius
    for k, body in enumerate(vehicle.bodies, start=len(wheelsets)):
        created = mbs.CreateRigidBody(
            name=prefix + body.name,
            inertia=RigidBodyInertia(mass=body.mass, inertiaTensor=np.diag(body.inertia)),
            nodeType=exu.NodeType.RotationRotationVector,
            referencePosition=(rest.centres[k] + shift).tolist(),
            gravity=[0.0, 0.0, -vehicle.gravity],
            graphicsDataList=body_graphics(vehicle, body) if show else [],
            returnDict=True,
        )
        bodies[body.name] = BodyItems(int(created["nodeNumber"]), int(created["bodyNumber"]))
        _put_at_rest(mbs, bodies[body.name].node, rest.pose[k], None)
    parts: list[Any] = [*wheelsets.values(), *bodies.values()]
    nodes = [items.node for items in parts]
    if show:
        names = [part.name for part in vehicle.parts]
        add_links(mbs, vehicle, dict(zip(names, nodes, strict=True)), name)
    drawbar = add_drawbar(mbs, rest, vehicle, travelling, parts, name)
    if travelling.is_curved:
        solids: list[Any] = [getattr(part, "wheelset", part) for part in vehicle.parts]
        masses = [(node, one.mass, one.inertia) for node, one in zip(nodes, solids, strict=True)]
        add_frame_loads(mbs, travelling, masses, vehicle.gravity, f"{name} in its frame")
    connections = _own_items(mbs, rest, [*parts, ground], shift, len(wheelsets))
    centres = rest.centres + shift
    moved = Rest(rest.struts, rest.preloads, centres, rest.pose, rest.drawn, rest.axles)
    connectors, connector, states = _compiled_items(mbs, vehicle, moved, shift, nodes, ground, name)
    frozen = MappingProxyType
    return VehicleItems(
        name,
        frozen(bodies),
        frozen(wheelsets),
        frozen(connections),
        connector,
        connectors,
        states,
        frozen(radii),
        drawbar,
        travelling,
        frozen(
            {
                axle.name: at.wheel_loads
                for axle, at in zip(vehicle.wheelsets, rest.axles, strict=True)
            }
        ),
    )


def _compiled_items(
    mbs: Any,
    vehicle: Vehicle,
    rest: Rest,
    shift: Array,
    nodes: list[int],
    ground: BodyItems,
    name: str,
) -> tuple[Connectors, int | None, int | None]:
    """Add the objects with all compiled laws; the connectors and the numbers of both objects."""
    carrier = None
    if ground.node >= 0:
        carrier = _reference(mbs, ground.node)
        nodes = [*nodes, ground.node]
    struts = [strut.moved(shift) for strut in rest.struts]
    block, states = block_of(vehicle, struts, rest.preloads, rest.drawn, rest.centres, carrier)
    connectors = Connectors(block, nodes, len(states))
    if not int(block[layout.H_LAWS]):
        return connectors, None, None
    forces_of, rates_of = connectors.functions()
    connector = mbs.AddObject(
        ObjectGenericODE2(
            name=f"{name} connections", nodeNumbers=nodes, forceUserFunction=forces_of
        )
    )
    if not states:
        return connectors, int(connector), None
    pose = np.vstack([rest.pose, np.zeros((len(nodes) - len(rest.pose), 6))])
    strokes = strokes_at(block, pose.ravel()).tolist()
    node = mbs.AddNode(
        NodeGenericODE1(
            name=f"{name} dampers",
            referenceCoordinates=[0.0] * len(states),
            initialCoordinates=strokes,
            numberOfODE1Coordinates=len(states),
        )
    )
    named = [
        FirstOrderState(f"{connection} {state.name}", state.unit, state.scale)
        for connection, state in states
    ]
    number_of_object = mbs.AddObject(
        ObjectGenericODE1(
            name=f"{name} dampers",
            nodeNumbers=[node],
            rhsUserFunction=name_states(rates_of, named),
        )
    )
    connectors.attach_states(int(number_of_object))
    return connectors, int(connector), int(number_of_object)


def _own_items(mbs: Any, rest: Rest, parts: list[Any], shift: Array, axles: int) -> dict[str, Any]:
    """Let elements that are not compiled add their items; what they return, by connection."""
    made: dict[str, Any] = {}
    for strut, preload in zip(rest.struts, rest.preloads, strict=True):
        if strut.law is not None:
            continue
        ends = []
        for place, point in zip((strut.lower, strut.upper), strut.points, strict=True):
            items = parts[place]
            centre = np.zeros(3) if items.node < 0 else _reference(mbs, items.node)
            point = point + shift
            marker = mbs.AddMarker(
                MarkerBodyRigid(bodyNumber=items.body, localPosition=(point - centre).tolist())
            )
            node = None if items.node < 0 else items.node
            x, y, z = (float(value) for value in point)
            ends.append(End(items.body, int(marker), node, (x, y, z), place < axles))
        made[strut.connection.name] = strut.connection.element.create(mbs, tuple(ends), preload)
    return made


def _reference(mbs: Any, node: int) -> Array:
    """Reference position (3) [m] of a rigid body's node."""
    return np.array(mbs.GetNodeParameter(node, "referenceCoordinates"), dtype=float)[:3]


def _put_at_rest(mbs: Any, node: int, pose: Array, spin: float | None) -> None:
    """Start a node from its place at rest, over what it starts from already; spin [rad/s]."""
    start = np.array(mbs.GetNodeParameter(node, "initialCoordinates"), dtype=float)
    mbs.SetNodeParameter(node, "initialCoordinates", (start + pose).tolist())
    if spin is not None:
        rates = np.array(mbs.GetNodeParameter(node, "initialVelocities"), dtype=float)
        rates[4] = spin
        mbs.SetNodeParameter(node, "initialVelocities", rates.tolist())


def _unused_name(mbs: Any, vehicle: Vehicle) -> str:
    """The vehicle's name, with a number where one of its parts' names is taken in the system."""
    data = mbs.systemData
    taken = {
        mbs.GetNode(node)["name"].removeprefix("Node:") for node in range(data.NumberOfNodes())
    }
    own = {part.name for part in vehicle.parts}
    number_of_it, prefix = 1, ""
    while any(prefix + part in taken for part in own):
        number_of_it += 1
        prefix = f"{vehicle.name} {number_of_it} "
    return prefix.rstrip() or vehicle.name
