"""What is usually changed of a ready-made vehicle: profiles, track, contact."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

from exudyn_wheelset.checking import number, unknown
from exudyn_wheelset.contact.descriptions import Contact, Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.profiles import Profile, load_profile, shapes
from exudyn_wheelset.vehicles.description import Vehicle


@dataclass(frozen=True)
class Changes:
    """What may be changed of a vehicle; None leaves the vehicle's own value.

    friction [-]; creep: name of a law; gauge [m] between the rails, which sets the flange
    clearance; wheel, rail: profile, name or path; conicity [-] of the tread: an AAR wheel of that
    taper takes the wheel's place; inclination [-] of the rails; gauge_depth [m] below their tops at
    which the gauge is measured; damping [s/m] of the normal contact, which takes up the energy of
    flange impacts; shear_modulus [Pa], poisson [-] of wheel and rail; normal: contact model;
    tape_half_distance, radius [m] of the wheelsets; law_parameters: those of the creep law, by
    name.
    """

    friction: float | None = None
    creep: str | None = None
    gauge: float | None = None
    wheel: Profile | str | None = None
    rail: Profile | str | None = None
    conicity: float | None = None
    inclination: float | None = None
    damping: float | None = None
    gauge_depth: float | None = None
    shear_modulus: float | None = None
    poisson: float | None = None
    normal: str | None = None
    tape_half_distance: float | None = None
    radius: float | None = None
    law_parameters: Mapping[str, float] | None = None

    @classmethod
    def of(cls, vehicle: str, **changes: Any) -> Changes:
        """Changes by keyword; WheelsetError, which names the vehicle, for an unknown one."""
        known = [entry.name for entry in fields(cls)]
        for name in changes:
            if name not in known:
                raise unknown(f"change of {vehicle}:", name, known)
        return cls(**changes)

    def __post_init__(self) -> None:
        if self.wheel is not None and self.conicity is not None:
            raise WheelsetError("give a wheel or a conicity, not both")
        if self.friction is not None:
            number("friction", self.friction, "-", 0.0, 1.0)

    def tread(self, own: str) -> Profile:
        """The wheel profile to take where the vehicle's own is `own`."""
        if self.conicity is not None:
            return shapes.aar_1_20(taper=self.conicity)
        return load_profile(own if self.wheel is None else self.wheel)

    def given(self, *names: str) -> dict[str, Any]:
        """Those of `names` that are changed, by name."""
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}

    def wheelset(self, **own: Any) -> Wheelset:
        """The vehicle's wheelset with its changes; `own` as for Wheelset."""
        changed = self.given("tape_half_distance", "radius")
        return Wheelset(**{**own, "wheel": self.tread(own["wheel"]), **changed})

    def track(self, **own: Any) -> Track:
        """The vehicle's track with its changes; a gauge replaces rails placed by their tops."""
        changed = self.given("rail", "gauge", "gauge_depth", "inclination")
        if "gauge" in changed:
            own.pop("datum_half_distance", None)
            own.pop("origin_half_distance", None)
        return Track(**{**own, **changed})

    def contact(self, **own: Any) -> Contact:
        """The vehicle's contact with its changes."""
        names = ("friction", "creep", "shear_modulus", "poisson", "normal", "damping")
        return Contact(**{**own, **self.given(*names, "law_parameters")})

    def applied_to(self, vehicle: Vehicle) -> Vehicle:
        """A described vehicle with these changes, on all its wheelsets."""
        contact = _arguments_of(vehicle.contact)
        if self.creep is not None:
            del contact["law_parameters"]
        changed = vehicle.on(self.track(**_arguments_of(vehicle.track)))
        changed = replace(changed, contact=self.contact(**contact))
        if self.wheel is not None or self.conicity is not None:
            changed = changed.replace("wheelsets.*.wheel", self.tread(""))
        for name, value in self.given("tape_half_distance", "radius").items():
            changed = changed.replace(f"wheelsets.*.{name}", value)
        return changed


def _arguments_of(description: Any) -> dict[str, Any]:
    return {entry.name: getattr(description, entry.name) for entry in fields(description)}
