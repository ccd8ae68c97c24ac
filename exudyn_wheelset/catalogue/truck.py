"""A truck (bogie): two wheelsets and a frame, on springs under a car body that runs straight at V.

The frame is a rigid body with six degrees of freedom. Springs and dampers join it to the axle
boxes (primary) and to the car body (secondary, and in yaw); they act along the axes of the frame,
at the height of the axles (primary) and of the secondary springs, the yaw springs at the frame's
centre. The model stands in the frame that moves at V, so a car body that runs straight is
Exudyn's ground; a body that moves may be given in its place.

The vertical springs carry the static load from the start: they are preloaded by it. Its points of
application move with the frame, so the load of the car above the frame's centre tips the frame a
little, as in the real truck.

    y, z      left wheel     o======o  frame      half_wheelbase b ahead of and behind the centre
              axle box       |  o   |             axle_drop h1 of the axles below the centre
                             o======o             secondary_rise h2 of the secondary springs above

`dtu_truck` is a truck of the DTU passenger car, whose masses, stiffnesses and dimensions are those
of Kaas-Petersen's bogie (C. Kaas-Petersen, Acta Mechanica 61 (1986) 89-107).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import exudyn as exu
import numpy as np
from scipy.optimize import brentq

from exudyn_wheelset.catalogue.wheelset_on_frame import (
    Suspension,
    WheelsetOnFrame,
    split_contact,
)
from exudyn_wheelset.checking import moments_of_inertia, number, positive
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.contact.descriptions import Contact, Track, Wheelset
from exudyn_wheelset.contact.wheelset_contact import contact_forces
from exudyn_wheelset.coupling.registration import WheelsetItems
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.geometry.rigid import contact_geometry
from exudyn_wheelset.spelling import spelt, spelt_class
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.vehicle_system import vehicle_system
from exudyn_wheelset.vehicles.assemble import VehicleItems, add_vehicle
from exudyn_wheelset.vehicles.builder import VehicleBuilder
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.elements import Spring


@dataclass(frozen=True)
class TruckItems:
    """Item numbers of a truck in an Exudyn system.

    node, body: the frame; wheelsets: leading first; vehicle: all items by name.
    """

    node: int
    body: int
    wheelsets: tuple[WheelsetItems, ...]
    vehicle: VehicleItems

    @property
    def contacts(self) -> tuple[WheelRailContact, ...]:
        """Contacts of the wheelsets, leading first."""
        return tuple(items.contact for items in self.wheelsets)


@spelt_class
@dataclass(frozen=True)
class Truck:
    """A two-axle truck, ready to be built at any speed.

    wheelset: both of them; frame_mass [kg], frame_inertia (Ix, Iy, Iz) [kg m^2] about its centre;
    half_wheelbase b, axle_drop h1, secondary_rise h2 [m]; primary: one axle box, half_distance
    from the centre line; secondary: one side, with the dampers beside the springs; yaw: springs
    and dampers of one side at the height of the frame's centre; car_load [N]: weight that rests on
    the secondary springs; contact: keyword arguments of `contact_parameters`; driven: the spins
    are held at V/radius.
    Raises WheelsetError for impossible values.

    Examples
    --------
    >>> from exudyn_wheelset import Truck, dtu_truck
    >>> truck = dtu_truck()
    >>> isinstance(truck, Truck), round(2 * truck.half_wheelbase, 3)
    (True, 2.148)
    """

    wheelset: Wheelset
    track: Track
    frame_mass: float
    frame_inertia: tuple[float, float, float]
    half_wheelbase: float
    primary: Suspension
    secondary: Suspension
    car_load: float
    yaw: Suspension | None = None
    axle_drop: float = 0.0
    secondary_rise: float = 0.0
    contact: dict[str, Any] = field(default_factory=dict)
    driven: bool = False
    name: str = "truck"

    def __post_init__(self) -> None:
        Contact(**self.contact)
        positive(f"{self.name}: frame_mass", self.frame_mass, "kg", 1e5)
        inertia = moments_of_inertia(
            f"{self.name}: frame_inertia", self.frame_inertia, self.frame_mass
        )
        object.__setattr__(self, "frame_inertia", inertia)
        positive(
            f"{self.name}: half_wheelbase", self.half_wheelbase, "m", 10.0, "is it given in metres?"
        )
        positive(f"{self.name}: car_load", self.car_load, "N", 1e7)
        for what, value in (("axle_drop", self.axle_drop), ("secondary_rise", self.secondary_rise)):
            number(f"{self.name}: {what}", value, "m", -10.0, 10.0, "is it given in metres?")
        for what, suspension in (("primary", self.primary), ("secondary", self.secondary)):
            if suspension.stiffness[2] <= 0.0:
                raise WheelsetError(
                    f"{self.name}: the {what} suspension carries the load: give it a vertical "
                    "stiffness above 0 N/m"
                )

    @property
    def weight(self) -> float:
        """What all wheels together carry [N]."""
        own = self.frame_mass + 2.0 * self.wheelset.mass
        return self.car_load + own * GRAVITY

    @property
    def axle_load(self) -> float:
        """What the two wheels of one wheelset carry [N]."""
        return 0.5 * self.weight

    def create(
        self,
        mbs: Any,
        speed: float,
        *,
        position: Sequence[float] = (0.0, 0.0),
        car_body: int | None = None,
        car_centre: Sequence[float] | None = None,
        show: bool = True,
        name: str = "truck",
        **options: Any,
    ) -> TruckItems:
        """Add the truck to `mbs`, in the frame that moves at `speed` [m/s]; return its items.

        position (x, y) [m] of the frame's centre; car_body: a rigid body that stands on the
        secondary springs in place of the ground, where its node has it (car_centre (x, y, z) [m] is
        compared with that if given); options: of `create_wheelset` (irregularity, sensors,
        lateral_offset, ...), for both wheelsets.
        """
        if car_body is not None and car_centre is not None:
            node = int(mbs.GetObject(car_body)["nodeNumber"])
            real = mbs.GetNodeParameter(node, "referenceCoordinates")[:3]
            if not np.allclose(real, car_centre, rtol=0.0, atol=1e-6):
                raise WheelsetError(
                    f"{name}: car_centre = {tuple(car_centre)} m, but the car body's reference "
                    f"position is {tuple(real)} m: leave car_centre out"
                )
        contact, options = split_contact(self.contact, options)
        items = add_vehicle(
            mbs,
            replace(self, contact=contact).vehicle(name),
            speed,
            position=position,
            ground_body=car_body,
            show=show,
            **options,
        )
        frame = items.bodies[f"{name} frame"]
        return TruckItems(frame.node, frame.body, tuple(items.wheelsets.values()), items)

    def vehicle(self, name: str = "truck") -> Vehicle:
        """The truck as a description; its parts' names begin with `name`."""
        contact = Contact(**self.contact)
        made = VehicleBuilder(name, self.track, contact)
        height = self.wheelset.radius + self.rest_height() + self.axle_drop
        frame = made.body(f"{name} frame", self.frame_mass, self.frame_inertia, (0.0, 0.0, height))
        primary, secondary = self.primary, self.secondary
        for which, ahead in (
            ("leading", self.half_wheelbase),
            ("trailing", -self.half_wheelbase),
        ):
            axle = made.wheelset(
                f"{name} {which} wheelset", self.wheelset, x=ahead, driven=self.driven
            )
            for side, sign in (("left", 1.0), ("right", -1.0)):
                made.connect(
                    Spring(primary.stiffness, primary.damping),
                    axle,
                    frame,
                    at=(ahead, sign * primary.half_distance, axle.z),
                    name=f"{which} {side} primary",
                )
        joints = [("secondary", secondary, self.secondary_rise, 0.5 * self.car_load)]
        if self.yaw is not None:
            joints.append(("yaw", self.yaw, 0.0, 0.0))
        for word, suspension, rise, load in joints:
            for side, sign in (("left", 1.0), ("right", -1.0)):
                made.connect(
                    Spring(suspension.stiffness, suspension.damping),
                    frame,
                    made.ground,
                    at=(0.0, sign * suspension.half_distance, height + rise),
                    name=f"{side} {word}",
                    preload=(0.0, 0.0, load),
                )
        return made.finish()

    def wheelset_alone(self) -> WheelsetOnFrame:
        """One of the wheelsets on its primary springs to a frame that does not yield."""
        return WheelsetOnFrame(
            self.wheelset,
            self.track,
            self.primary,
            self.axle_load,
            self.contact,
            self.driven,
            name=f"wheelset of the {self.name}",
        )

    def rest_height(self) -> float:
        """Height [m] of the axles above `radius` over the rail tops where the rails carry the load.

        The springs are without force beyond their preload only there.
        """
        radius = self.wheelset.radius
        touching = float(contact_geometry(self.wheelset, self.track, [0.0]).z[0])
        options = {name: value for name, value in self.contact.items() if name != "damping"}

        def excess(penetration: float) -> float:
            pose = (0.0, 0.0, touching - penetration, 0.0, 0.0, 0.0)
            rolling = (10.0, 0.0, 0.0, 0.0, 10.0 / radius, 0.0)
            found = contact_forces(self.wheelset, self.track, pose, rolling, **options)
            return float(found.force[2]) - self.axle_load

        highest = 1.0e-4
        while excess(highest) < 0.0:
            highest *= 2.0
            if highest > 0.01:
                raise WheelsetError(
                    f"{self.name}: the rails do not carry {self.axle_load:.0f} N of one wheelset: "
                    "check car_load, masses and shear_modulus"
                )
        return touching - float(brentq(excess, 0.0, highest, xtol=1e-13))

    def build(self, speed: float, **options: Any) -> tuple[Any, Any, TruckItems]:
        """Return (SC, mbs, items) of a new, not yet assembled Exudyn system with this truck."""
        container = exu.SystemContainer()
        mbs = container.AddSystem()
        return container, mbs, self.create(mbs, speed, **options)

    def dynamic_system(self, **options: Any) -> ExudynSystem:
        """The model as a system for all analyses; options are those of ExudynSystem."""
        given = {"name": self.name, "parameters": self.parameters(), **options}
        return vehicle_system(self.vehicle(), **given)

    def parameters(self) -> dict[str, Any]:
        """All numbers and names behind the model, for records."""
        wheelset, track = self.wheelset, self.track
        return {
            "wheelset_mass": wheelset.mass,
            "wheelset_inertia": list(wheelset.inertia),
            "radius": wheelset.radius,
            "wheel": wheelset.wheel.name,
            "tape_half_distance": wheelset.tape_half_distance,
            "rail": track.rail.name,
            "gauge": track.gauge,
            "inclination": track.inclination,
            "frame_mass": self.frame_mass,
            "frame_inertia": list(self.frame_inertia),
            "half_wheelbase": self.half_wheelbase,
            "axle_drop": self.axle_drop,
            "secondary_rise": self.secondary_rise,
            "primary": asdict(self.primary),
            "secondary": asdict(self.secondary),
            "yaw": None if self.yaw is None else asdict(self.yaw),
            "car_load": self.car_load,
            "contact": dict(self.contact),
            "driven": self.driven,
        }


@spelt
def dtu_truck(wheel: Any = "S1002", rail: Any = "UIC60", **contact: Any) -> Truck:
    """A truck of the DTU passenger car with half the car's weight on it.

    The source computes the shear modulus with a slip of sign (1.438e11 Pa); here it is
    E/(2 (1 + nu)) = 8.27e10 Pa. contact: changes to the arguments of `contact_parameters`.
    Raises WheelsetError for profiles and contact numbers that cannot be.

    Examples
    --------
    >>> from exudyn_wheelset import dtu_truck
    >>> round(dtu_truck(friction=0.3).weight / 1e3, 1)  # [kN]
    266.4
    """
    return Truck(
        wheelset=Wheelset(mass=1022.0, inertia=(678.0, 80.0, 678.0), radius=0.425, wheel=wheel),
        track=Track(rail, gauge=1.435, inclination=1.0 / 40.0),
        frame_mass=2918.9,
        frame_inertia=(6780.0, 6780.0, 6780.0),
        half_wheelbase=1.074,
        axle_drop=0.0762,
        secondary_rise=0.6584,
        primary=Suspension(0.620, stiffness=(3.646e6, 1.823e6, 3.646e6)),
        secondary=Suspension(
            0.680, stiffness=(0.0, 182.3e3, 333.3e3), damping=(0.0, 29.2e3, 20.0e3)
        ),
        yaw=Suspension(1.5, stiffness=(903350.0, 0.0, 0.0), damping=(166669.0, 0.0, 0.0)),
        car_load=0.5 * 44388.0 * GRAVITY,
        contact={
            "creep": "shen-hedrick-elkins",
            "friction": 0.15,
            "shear_modulus": 2.1e11 / (2.0 * 1.27),
            "poisson": 0.27,
            **contact,
        },
        name="truck of the DTU car",
    )
