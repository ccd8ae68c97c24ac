"""Rates of a vehicle with other numbers, without a model of its own in Exudyn.

A number of the vehicle changes masses, laws, contacts and where all parts stand at rest, not which
states there are: the compiled equations (`compiled_vehicle`) are made anew from those, with the
states of the system at hand. That costs a fifth of a model in Exudyn, and is what a gradient asks
for, number by number.
"""

from __future__ import annotations

from dataclasses import dataclass

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.contact.wheelset_contact import contact_parameters
from exudyn_wheelset.coupling.track_frame import TrackFrame
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
from exudyn_wheelset.systems.compiled_vehicle import CompiledVehicle
from exudyn_wheelset.systems.vehicle_system import VehicleSystem, vehicle_system
from exudyn_wheelset.vehicles.assemble import Connectors
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.rail_support import shape_of
from exudyn_wheelset.vehicles.rest import Rest, find_rest
from exudyn_wheelset.vehicles.struts import block_of


@dataclass(frozen=True)
class _Parts:
    """What the compiled equations are made from."""

    contacts: list[WheelRailContact]
    connectors: Connectors
    frame: TrackFrame
    drawbar: None = None


class ChangedVehicles:
    """Rates of vehicles that differ from one in some numbers.

    vehicle: the one; system: its system. Vehicles that pull themselves along, on tracks that are
    not plain or with items of their own in Exudyn are made anew as whole systems.
    """

    def __init__(self, vehicle: Vehicle, system: VehicleSystem) -> None:
        self._system = system
        self._rest: Rest | None = None
        items = system.vehicle_items
        if system.compiled is not None and items.drawbar is None and items.frame.is_plain:
            self._rest = find_rest(vehicle)

    def rates(self, vehicle: Vehicle, states: Array, speed: float) -> Array:
        """f (k, n) of another vehicle at states (k, n) and a speed [m/s].

        Raises WheelsetError for a vehicle that cannot stand.
        """
        if self._rest is not None:
            rest = find_rest(vehicle, self._rest)
            frame = TrackFrame.of(vehicle.track)
            if rest.pull == 0.0 and frame.is_plain:
                return self._compiled(vehicle, rest, frame, speed).rates(states)
        return vehicle_system(vehicle).derivatives(states, speed)

    def _compiled(
        self, vehicle: Vehicle, rest: Rest, frame: TrackFrame, speed: float
    ) -> CompiledVehicle:
        parameters = contact_parameters(vehicle.contact)
        contacts = []
        for axle, centre in zip(vehicle.wheelsets, rest.centres, strict=False):
            contact = WheelRailContact(
                shape_of(axle.wheelset), vehicle.track, parameters, speed, frame, None, axle.name
            )
            contact.reference[:] = centre
            contacts.append(contact)
        block, states = block_of(vehicle, rest.struts, rest.preloads, rest.drawn, rest.centres)
        connectors = Connectors(block, range(len(rest.centres)), len(states))
        parts = _Parts(contacts, connectors, frame)
        system = self._system
        compiled = CompiledVehicle(vehicle, parts, system.layout, system.scales)
        compiled.use_speed(speed)
        return compiled
