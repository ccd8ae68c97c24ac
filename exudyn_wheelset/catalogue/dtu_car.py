"""The DTU passenger car: a body on two of Kaas-Petersen's bogies, with yaw dampers.

Masses, stiffnesses and dimensions of the bogies are those of C. Kaas-Petersen, Acta Mechanica 61
(1986) 89-107; car body, yaw dampers and profiles those of the car that H. True and his students at
the Technical University of Denmark have studied. Shear modulus: steel; their program has 1.438e11
Pa, from E/(2 (1 - nu)), a slip of sign. SI units; heights follow from the axles as they stand.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from exudyn_wheelset.catalogue.changes import Changes
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.vehicles.builder import VehicleBuilder
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.elements import Spring
from exudyn_wheelset.vehicles.rail_support import rest_on_rails

BODY_MASS, FRAME_MASS, WHEELSET_MASS = 44388.0, 2918.9, 1022.0
HALF_PIVOT_DISTANCE, HALF_WHEELBASE = 7.5, 1.074
AXLE_DROP, SECONDARY_RISE, BODY_RISE = 0.0762, 0.6584, 1.5584
PRIMARY_HALF_DISTANCE, SECONDARY_HALF_DISTANCE, YAW_HALF_DISTANCE = 0.620, 0.680, 1.5
PRIMARY = Spring(stiffness=(3.646e6, 1.823e6, 3.646e6))
SECONDARY = Spring(stiffness=(0.0, 182.3e3, 333.3e3), damping=(0.0, 29.2e3, 20.0e3))
YAW = Spring(stiffness=(903350.0, 0.0, 0.0), damping=(166669.0, 0.0, 0.0))


def dtu_car(**changes: Any) -> Vehicle:
    """The DTU car, S1002 on UIC60 1:40 at 1435 mm; `changes` are those of `Changes`.

    Raises WheelsetError for an unknown change and for impossible values.
    """
    asked = Changes.of("dtu_car", **changes)
    wheelset = asked.wheelset(
        mass=WHEELSET_MASS, inertia=(678.0, 80.0, 678.0), radius=0.425, wheel="S1002"
    )
    track = asked.track(rail="UIC60", gauge=1.435, inclination=1.0 / 40.0)
    contact = asked.contact(
        creep="shen-hedrick-elkins",
        friction=0.15,
        shear_modulus=2.1e11 / (2.0 * 1.27),
        poisson=0.27,
    )
    wheel_load = GRAVITY * (BODY_MASS + 2.0 * FRAME_MASS + 4.0 * WHEELSET_MASS) / 8.0
    standing = rest_on_rails(wheelset, track, contact, np.array([wheel_load, wheel_load]))
    frame_height = wheelset.radius + standing.height + AXLE_DROP
    car = VehicleBuilder("DTU car", track, contact)
    body = car.body(
        "body",
        mass=BODY_MASS,
        inertia=(2.80e5, 5.0e5, 5.0e5),
        centre=(0.0, 0.0, frame_height + BODY_RISE),
    )
    for truck, x in (("front", HALF_PIVOT_DISTANCE), ("rear", -HALF_PIVOT_DISTANCE)):
        frame = car.body(
            f"{truck} frame",
            mass=FRAME_MASS,
            inertia=(6780.0, 6780.0, 6780.0),
            centre=(x, 0.0, frame_height),
        )
        for which, ahead in (("leading", HALF_WHEELBASE), ("trailing", -HALF_WHEELBASE)):
            axle = car.wheelset(f"{truck} {which}", wheelset, x=x + ahead)
            for side, sign in (("left", 1.0), ("right", -1.0)):
                car.connect(
                    PRIMARY,
                    axle,
                    frame,
                    at=(axle.x, sign * PRIMARY_HALF_DISTANCE, axle.z),
                    name=f"{truck} {which} {side} primary",
                )
        for side, sign in (("left", 1.0), ("right", -1.0)):
            place = (x, sign * SECONDARY_HALF_DISTANCE, frame_height + SECONDARY_RISE)
            car.connect(SECONDARY, frame, body, at=place, name=f"{truck} {side} secondary")
            place = (x, sign * YAW_HALF_DISTANCE, frame_height)
            car.connect(YAW, frame, body, at=place, name=f"{truck} {side} yaw damper")
    return car.finish()
