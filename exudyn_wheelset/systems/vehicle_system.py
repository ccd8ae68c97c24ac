"""A vehicle as a system for the analyses: built in Exudyn, alone in its model."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any

import exudyn as exu

from exudyn_wheelset.profiles import Profile
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.vehicles.assemble import VehicleItems, add_vehicle
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.spin_drive import DRIVEN_STEP

_FIRST_SPEED = 20.0


class VehicleSystem(ExudynSystem):
    """The system of a vehicle, with the item numbers of its parts by name."""

    vehicle_items: VehicleItems


def vehicle_system(vehicle: Vehicle, **options: Any) -> VehicleSystem:
    """The vehicle alone in an Exudyn model; options are those of ExudynSystem."""
    given = options.get("settings") is not None or options.get("step") is not None
    if any(axle.driven for axle in vehicle.wheelsets) and not given:
        options["step"] = DRIVEN_STEP
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    items = add_vehicle(mbs, vehicle, _FIRST_SPEED, show=False, sensors=False)
    options.setdefault("spinning_nodes", dict(items.radii))
    options.setdefault("name", vehicle.name)
    options.setdefault("parameters", numbers_of(vehicle))
    system = VehicleSystem(mbs, container, **options)
    system.vehicle_items = items
    return system


def numbers_of(description: Any) -> Any:
    """A description as plain dictionaries, lists and numbers, for records; profiles by name."""
    if isinstance(description, Profile):
        return description.name
    if is_dataclass(description) and not isinstance(description, type):
        entries = [entry for entry in fields(description) if not entry.name.startswith("_")]
        content = {entry.name: numbers_of(getattr(description, entry.name)) for entry in entries}
        return {"kind": type(description).__name__, **content}
    if isinstance(description, tuple | list):
        return [numbers_of(entry) for entry in description]
    return description
