"""What an analysis is asked about: a system, a description of a vehicle, or a catalogue name.

A system knows the description it was made from (`source`), so that analyses which change the
vehicle, gradients, maps, designs, can make it anew with other numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.systems import system as systems
from exudyn_wheelset.systems.system import DynamicSystem


@dataclass(frozen=True)
class Entry:
    """A name of the catalogue that stands for a system, with changes of it by name and value."""

    name: str
    changes: tuple[tuple[str, Any], ...] = ()

    def replace(self, path: str, value: Any) -> Entry:
        """The entry with one more change, as `catalogue.vehicle` takes them."""
        return Entry(self.name, (*self.changes, (path, value)))

    def dynamic_system(self, **options: Any) -> DynamicSystem:
        """The system of the vehicle."""
        from exudyn_wheelset.catalogue import by_name

        return systems.as_system(by_name.vehicle(self.name, **dict(self.changes)), **options)


def named(vehicle: Any) -> Any:
    """The vehicle itself, or that of the catalogue where it is a name: "s1002", "dtu_car"."""
    if not isinstance(vehicle, str):
        return vehicle
    from exudyn_wheelset.catalogue import by_name

    return by_name.vehicle(vehicle)


def as_system(vehicle: Any, **options: Any) -> DynamicSystem:
    """The DynamicSystem of a vehicle: a system, a description, or a name of the catalogue.

    options: of ExudynSystem, for what is built here. Raises AnalysisError for anything else and
    WheelsetError for an unknown name.
    """
    return systems.as_system(named(vehicle), **options)


def description_of(vehicle: Any) -> Any:
    """The description that an analysis can change: of a name, a description, or a system's own.

    A maker of vehicles (a wheelset on its frame, a truck) is taken as the `Vehicle` it makes.
    Raises AnalysisError for a system that was not made from a description.
    """
    given = named(vehicle)
    if isinstance(given, DynamicSystem) and not hasattr(given, "replace"):
        if isinstance(vehicle, str):
            return Entry(vehicle)
        if given.source is None or given.source.description is None:
            raise AnalysisError(
                f"{given.name} does not know the description it was made from: give the vehicle, "
                "or a name of the catalogue, in place of its system"
            )
        given = given.source.description
    maker = getattr(given, "vehicle", None)
    return maker() if callable(maker) else given


def changed(description: Any, path: str, value: float) -> Any:
    """The description with one number changed: `path` as for its `replace`, or a short name.

    friction, gauge, gauge_depth and inclination of all rails, conicity (an AAR wheel of that taper
    on all wheelsets), creep and shear_modulus are understood of every `Vehicle`. A function is
    called with the value, whatever the path. Raises WheelsetError for what is not there.
    """
    from exudyn_wheelset.vehicles.description import Vehicle

    if isinstance(description, Vehicle):
        if path == "conicity":
            from exudyn_wheelset.profiles import shapes

            return description.replace("wheelsets.*.wheelset.wheel", shapes.aar_1_20(taper=value))
        return description.replace(_SHORT.get(path, path), value)
    if hasattr(description, "replace"):
        return description.replace(path, value)
    if callable(description):
        return description(value)
    raise WheelsetError(
        f"{type(description).__name__} has no {path!r} to change: give a Vehicle, an object with "
        "replace(path, value), or a function of the value"
    )


_SHORT = {
    "friction": "contact.friction",
    "creep": "contact.creep",
    "shear_modulus": "contact.shear_modulus",
    "gauge": "track.gauge",
    "gauge_depth": "track.gauge_depth",
    "inclination": "track.inclination",
}
