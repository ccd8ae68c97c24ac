"""The full wheelset: six degrees of freedom on springs and dampers to a frame that moves at V.

The model stands in the moving frame (Galilean: the laws of motion are those over the ground), so
the frame is Exudyn's ground and the rails run backwards. At either end of the axle, at half
distance b, a spring and damper in x, y and z; a vertical force at the springs carries the load
beyond the wheelset's own weight, with no force of the springs beside it where the wheelset stands.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import exudyn as exu

from exudyn_wheelset.checking import number, numbers, positive
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.contact.descriptions import CONTACT_NUMBERS, Contact, Track, Wheelset
from exudyn_wheelset.coupling.registration import WheelsetItems
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.vehicle_system import vehicle_system
from exudyn_wheelset.vehicles.assemble import add_vehicle
from exudyn_wheelset.vehicles.builder import VehicleBuilder
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.elements import Spring


@spelt_class
@dataclass(frozen=True)
class Suspension:
    """Springs and dampers between one end of an axle and the frame.

    half_distance b [m] from the axle's centre; stiffness (x, y, z) [N/m] and damping (x, y, z)
    [N s/m] of one end.

    Examples
    --------
    >>> from exudyn_wheelset import Suspension
    >>> Suspension(half_distance=1.0, stiffness=(1.6e6, 4e5, 1.2e6)).damping
    (0.0, 0.0, 0.0)
    """

    half_distance: float
    stiffness: tuple[float, float, float]
    damping: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        positive("half_distance", self.half_distance, "m", 3.0)
        for what, unit in (("stiffness", "N/m"), ("damping", "N s/m")):
            values = numbers(f"{what} (x, y, z)", getattr(self, what), 3, unit, 0.0)
            object.__setattr__(self, what, values)


@spelt_class
@dataclass(frozen=True)
class WheelsetOnFrame:
    """A wheelset with its suspension, load and contact, ready to be built at any speed.

    axle_load [N]: what both wheels carry, the wheelset's weight included; contact: keyword
    arguments of `contact_parameters` (normal, creep, friction, shear_modulus, poisson, damping);
    driven: the spin is held at V/radius (spin_drive.py), otherwise the wheelset rolls freely.

    Examples
    --------
    >>> from exudyn_wheelset import Suspension, Track, Wheelset, WheelsetOnFrame
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    >>> springs = Suspension(1.0, (1.6e6, 4e5, 1.2e6))
    >>> model = WheelsetOnFrame(axle, Track("UIC60"), springs, axle_load=120e3)
    >>> model.vehicle().mass
    1500.0
    """

    wheelset: Wheelset
    track: Track
    suspension: Suspension
    axle_load: float
    contact: dict[str, Any] = field(default_factory=dict)
    driven: bool = False
    name: str = "wheelset on frame"

    def __post_init__(self) -> None:
        for what, kind in (("wheelset", Wheelset), ("track", Track), ("suspension", Suspension)):
            if not isinstance(getattr(self, what), kind):
                raise WheelsetError(f"{what} = {getattr(self, what)!r}: give a {kind.__name__}")
        if not isinstance(self.contact, Mapping):
            raise WheelsetError(
                f"contact = {self.contact!r}: give a mapping of the names of Contact to values, "
                "such as {'friction': 0.3}"
            )
        Contact(**self.contact)
        weight = self.wheelset.mass * GRAVITY
        if number("axle_load", self.axle_load, "N") < weight:
            raise WheelsetError(
                f"axle_load = {self.axle_load!r} N is less than the wheelset's own weight "
                f"{weight:.0f} N: give the load of both wheels on the rails, weight included"
            )

    def vehicle(self, name: str = "wheelset") -> Vehicle:
        """The wheelset as a description of one part of that name."""
        made = VehicleBuilder(self.name, self.track, Contact(**self.contact))
        axle = made.wheelset(name, self.wheelset, driven=self.driven)
        spare = self.axle_load - self.wheelset.mass * GRAVITY
        spring = Spring(self.suspension.stiffness, self.suspension.damping)
        for side, sign in (("left", 1.0), ("right", -1.0)):
            made.connect(
                spring,
                axle,
                made.ground,
                at=(0.0, sign * self.suspension.half_distance, axle.z),
                name=f"{side} spring",
                preload=(0.0, 0.0, 0.5 * spare),
            )
        return made.finish()

    def create(self, mbs: Any, speed: float, **options: Any) -> WheelsetItems:
        """Add wheelset and springs, which carry the load, to `mbs`, in the frame that moves at
        `speed` [m/s].

        options: of `create_wheelset` (lateral_offset, yaw, show, name, ...).
        """
        contact, options = split_contact(self.contact, options)
        name = options.pop("name", "wheelset")
        items = add_vehicle(mbs, replace(self, contact=contact).vehicle(name), speed, **options)
        return items.wheelsets[name]

    def build(self, speed: float, **options: Any) -> tuple[Any, Any, WheelsetItems]:
        """Return (SC, mbs, items) of a new, not yet assembled Exudyn system with this wheelset."""
        container = exu.SystemContainer()
        mbs = container.AddSystem()
        return container, mbs, self.create(mbs, speed, **options)

    def dynamic_system(self, **options: Any) -> ExudynSystem:
        """The model as a system for all analyses; options are those of ExudynSystem."""
        given = {"name": self.name, "parameters": self.parameters(), **options}
        return vehicle_system(self.vehicle(), **given)

    def parameters(self) -> dict[str, Any]:
        """All numbers and names behind the model, for records."""
        return {
            "mass": self.wheelset.mass,
            "inertia": list(self.wheelset.inertia),
            "radius": self.wheelset.radius,
            "wheel": self.wheelset.wheel.name,
            "tape_half_distance": self.wheelset.tape_half_distance,
            "rail": self.track.rail.name,
            "gauge": self.track.gauge,
            "inclination": self.track.inclination,
            "suspension": asdict(self.suspension),
            "axle_load": self.axle_load,
            "contact": dict(self.contact),
            "driven": self.driven,
        }


def split_contact(
    own: dict[str, Any], options: dict[str, Any]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """A vehicle's own contact with what `options` change of it, and the other options."""
    changes = {name: options[name] for name in options if name in CONTACT_NUMBERS}
    return {**own, **changes}, {k: v for k, v in options.items() if k not in changes}
