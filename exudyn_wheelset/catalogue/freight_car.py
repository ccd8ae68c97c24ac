"""A freight car on two three-piece trucks, held together by dry friction, empty and loaded.

Dimensions are those of the Association of American Railroads' standard trucks of the 70-ton class:
wheels of 36 in, wheelbase 70 in, journals 78 in apart, centre plate of 14 in, side bearers 50 in
apart with 1/4 in clearance, wedges of 32 degrees on springs of the side frame (variable damping).
Masses and stiffnesses are rounded numbers of such trucks as published models have them (F. Xia, H.
True, The dynamics of the three-piece-freight truck, Vehicle System Dynamics 41 Suppl. (2004)
212-221; S. Iwnicki, S. Stichel, A. Orlova, M. Hecht, Dynamics of railway freight vehicles, Vehicle
System Dynamics 53 (2015) 995-1033). They are illustrative: no car of that drawing exists. Body:
a hopper; inertias and heights from plausible radii of gyration.

Each coil nest shares its load with the springs of its wedges by stiffness, so that the column force
grows with the load; friction is relaxed as the car is drawn. The wedges hold bolster and side
frames along the track and resist warp: the bolster yaws with its wheelsets, against the friction of
the centre plate. Stiffness of the column faces: with their half width it gives a truck a warp
stiffness of 1e6 N m/rad.
"""

from __future__ import annotations

import math
from typing import Any

from exudyn_wheelset.catalogue.changes import Changes
from exudyn_wheelset.checking import number
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.vehicles.builder import VehicleBuilder
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.elements import (
    Bushing,
    CentrePlate,
    FrictionWedge,
    SideBearer,
    Spring,
)

HALF_PIVOT_DISTANCE, HALF_WHEELBASE = 6.17, 0.889
FRAME_HALF_DISTANCE, BEARER_HALF_DISTANCE, WEDGE_HALF_DISTANCE = 0.99, 0.635, 0.20
BOLSTER_MASS, FRAME_MASS, WHEELSET_MASS = 465.0, 447.0, 1120.0
# Mass, inertia, height of the centre of the body.
LOADED_BODY = (80.0e3, (1.1e5, 1.3e6, 1.3e6), 2.20)
EMPTY_BODY = (16.0e3, (2.7e4, 3.4e5, 3.4e5), 1.60)
COILS, WEDGE_SPRING, WEDGE_ANGLE = (1.8e6, 1.8e6, 4.2e6), 6.0e5, 32.0
# Stiffness of a column's face [N/m] and half its width [m].
FACE_STIFFNESS, FACE_RADIUS = 1.0e8, 0.1
# The seat of the side frame on the adapter is 0.18 m wide: against roll 1e8 (0.18 m)^2/12.
ADAPTER = Bushing(
    stiffness=(2.0e7, 1.0e7, 1.0e8, 2.7e5, 0.0, 0.0),
    damping=(1.0e4, 1.0e4, 1.0e4, 0.0, 0.0, 0.0),
)


def freight_car(
    loaded: bool = True,
    *,
    wedge_friction: float = 0.4,
    plate_friction: float = 0.3,
    **changes: Any,
) -> Vehicle:
    """The freight car, AAR 1:20 on UIC60 1:40 at 1435 mm; `changes` are those of `Changes`.

    loaded: or empty; wedge_friction, plate_friction [-]: of the wedges, of centre plates and side
    bearers. Raises WheelsetError for an unknown change and for impossible values.
    """
    if not isinstance(loaded, bool):
        raise WheelsetError(f"loaded = {loaded!r}: give True or False")
    number("wedge_friction", wedge_friction, "-", 0.0)
    asked = Changes.of("freight_car", **changes)
    wheelset = asked.wheelset(
        mass=WHEELSET_MASS, inertia=(420.0, 100.0, 420.0), radius=0.4572, wheel="AAR_1_20"
    )
    track = asked.track(rail="UIC60", gauge=1.435, inclination=1.0 / 40.0)
    contact = asked.contact(creep="exact-table", friction=0.4)
    mass, inertia, height = LOADED_BODY if loaded else EMPTY_BODY
    nest_load = GRAVITY * (0.5 * mass + BOLSTER_MASS) / 2.0
    nest_stiffness = COILS[2] + 2.0 * WEDGE_SPRING
    # The car is drawn as it stands: empty it stands higher.
    full_load = GRAVITY * (0.5 * LOADED_BODY[0] + BOLSTER_MASS) / 2.0
    rise = (full_load - nest_load) / nest_stiffness
    column_force = nest_load * WEDGE_SPRING / nest_stiffness / math.tan(math.radians(WEDGE_ANGLE))
    wedges = {
        ahead: FrictionWedge(
            WEDGE_ANGLE,
            wedge_friction,
            column_force,
            spring=WEDGE_SPRING,
            along=FACE_STIFFNESS,
            radius=FACE_RADIUS,
            ahead=ahead,
        )
        for ahead in (True, False)
    }
    axle_height = wheelset.radius
    bolster_height = axle_height + 0.09 + rise
    car = VehicleBuilder(f"{'loaded' if loaded else 'empty'} freight car", track, contact)
    body = car.body("body", mass=mass, inertia=inertia, centre=(0.0, 0.0, height + rise))
    for truck, x in (("front", HALF_PIVOT_DISTANCE), ("rear", -HALF_PIVOT_DISTANCE)):
        bolster = car.body(
            f"{truck} bolster",
            mass=BOLSTER_MASS,
            inertia=(175.0, 10.0, 175.0),
            centre=(x, 0.0, bolster_height),
        )
        car.connect(
            CentrePlate(radius=0.178, friction=plate_friction),
            bolster,
            body,
            at=(x, 0.0, bolster_height + 0.17),
            name=f"{truck} centre plate",
        )
        for side, sign in (("left", 1.0), ("right", -1.0)):
            car.connect(
                SideBearer(gap=6.35e-3, stiffness=2.0e7, friction=plate_friction),
                bolster,
                body,
                at=(x, sign * BEARER_HALF_DISTANCE, bolster_height + 0.19),
                name=f"{truck} {side} side bearer",
            )
        axles = [
            car.wheelset(f"{truck} {which}", wheelset, x=x + ahead)
            for which, ahead in (("leading", HALF_WHEELBASE), ("trailing", -HALF_WHEELBASE))
        ]
        for side, sign in (("left", 1.0), ("right", -1.0)):
            y = sign * FRAME_HALF_DISTANCE
            frame = car.body(
                f"{truck} {side} frame",
                mass=FRAME_MASS,
                inertia=(100.0, 116.0, 100.0),
                centre=(x, y, axle_height),
            )
            for axle in axles:
                place = (axle.x, y, axle.z)
                car.connect(ADAPTER, axle, frame, at=place, name=f"{axle.name} {side} adapter")
            nest = (x, y, axle_height - 0.06)
            car.connect(Spring(COILS), frame, bolster, at=nest, name=f"{truck} {side} coils")
            for which, ahead in (("front", True), ("rear", False)):
                out = WEDGE_HALF_DISTANCE if ahead else -WEDGE_HALF_DISTANCE
                place = (x + out, y, bolster_height)
                name = f"{truck} {side} {which} wedge"
                car.connect(wedges[ahead], frame, bolster, at=place, name=name)
    return car.finish()
