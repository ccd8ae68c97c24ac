"""A truck with three axles, as under a heavy locomotive, below a body that runs straight.

No vehicle of a source: round numbers of the size that such trucks have. The middle axle is held
more softly to the side, so that it does not guide in curves. Coils of some height carry the body,
dampers in series with their mounts its yaw. SI units.
"""

from __future__ import annotations

from typing import Any

from exudyn_wheelset.catalogue.changes import Changes
from exudyn_wheelset.vehicles.builder import VehicleBuilder
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.elements import MaxwellDamper, Spring

WHEELBASE = 1.85
FRAME_HEIGHT, SECONDARY_HEIGHT, YAW_HEIGHT = 0.75, 1.05, 0.75
PRIMARY_HALF_DISTANCE, SECONDARY_HALF_DISTANCE, YAW_HALF_DISTANCE = 1.05, 1.05, 1.35
BODY_LOAD = 380.0e3


def three_axle_truck(**changes: Any) -> Vehicle:
    """The truck, S1002 on UIC60 1:40 at 1435 mm; `changes` are those of `Changes`.

    Raises WheelsetError for an unknown change and for impossible values.
    """
    asked = Changes.of("three_axle_truck", **changes)
    wheelset = asked.wheelset(
        mass=2600.0, inertia=(1500.0, 320.0, 1500.0), radius=0.55, wheel="S1002"
    )
    track = asked.track(rail="UIC60", gauge=1.435, inclination=1.0 / 40.0)
    truck = VehicleBuilder("three-axle truck", track, asked.contact(friction=0.3))
    frame = truck.body(
        "frame", mass=7500.0, inertia=(5200.0, 15500.0, 19500.0), centre=(0.0, 0.0, FRAME_HEIGHT)
    )
    for which, x, lateral in (
        ("leading", WHEELBASE, 5.0e6),
        ("middle", 0.0, 1.2e6),
        ("trailing", -WHEELBASE, 5.0e6),
    ):
        axle = truck.wheelset(which, wheelset, x=x)
        for side, sign in (("left", 1.0), ("right", -1.0)):
            truck.connect(
                Spring((12.0e6, lateral, 1.4e6), (10.0e3, 5.0e3, 15.0e3)),
                axle,
                frame,
                at=(x, sign * PRIMARY_HALF_DISTANCE, axle.z),
                name=f"{which} {side} primary",
            )
    for side, sign in (("left", 1.0), ("right", -1.0)):
        truck.connect(
            Spring((0.3e6, 0.3e6, 1.6e6), (0.0, 40.0e3, 40.0e3)),
            frame,
            truck.ground,
            at=(0.0, sign * SECONDARY_HALF_DISTANCE, SECONDARY_HEIGHT),
            name=f"{side} secondary",
            preload=(0.0, 0.0, 0.5 * BODY_LOAD),
        )
        truck.connect(
            MaxwellDamper((1.0, 0.0, 0.0), stiffness=8.0e6, damping=400.0e3),
            frame,
            truck.ground,
            at=(0.0, sign * YAW_HALF_DISTANCE, YAW_HEIGHT),
            name=f"{side} yaw damper",
        )
    return truck.finish()
