"""A two-axle wagon with leaf springs on links (the UIC's double links), empty and loaded.

Wheelbase, journals 2 m apart, wheels of 0.92 m and the play of the axle guards are those of common
European wagons; the structure of the suspension (pendulums that grow with the load, beside dry
friction of links and leaves that grows with it as well) is that of J. Piotrowski, Archive of
Applied Mechanics 73 (2003) 517-532, and of M. Hoffmann, H. True, The dynamics of European two-axle
railway freight wagons with UIC standard suspension, Vehicle System Dynamics 46 Suppl. (2008)
225-236. The numbers are rounded and illustrative: lengths of the pendulums, frictions and masses of
no wagon in particular.
"""

from __future__ import annotations

from typing import Any

from exudyn_wheelset.catalogue.changes import Changes
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.vehicles.builder import VehicleBuilder
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.elements import BumpStop, LinkSuspension

HALF_WHEELBASE, JOURNAL_HALF_DISTANCE = 5.0, 1.0
# Mass, inertia, height of the centre of the body.
LOADED_BODY = (40.0e3, (5.5e4, 7.0e5, 7.0e5), 1.80)
EMPTY_BODY = (11.0e3, (2.0e4, 2.2e5, 2.2e5), 1.40)
SUSPENSION = LinkSuspension(
    stiffness=1.2e6,
    length=(0.40, 0.25),
    friction=(0.10, 0.06),
    leaf_friction=0.07,
)
# Axle guards: free way [m], then 2 kN/mm and more.
LONGITUDINAL_PLAY, LATERAL_PLAY = 22.0e-3, 20.0e-3
GUARD = ((0.0, 0.0), (1.0e-3, 2.0e3), (5.0e-3, 5.0e4), (10.0e-3, 2.0e5))


def two_axle_wagon(loaded: bool = True, **changes: Any) -> Vehicle:
    """The two-axle wagon, S1002 on UIC60 1:40 at 1435 mm; `changes` are those of `Changes`.

    loaded: or empty. Raises WheelsetError for an unknown change and for impossible values.
    """
    if not isinstance(loaded, bool):
        raise WheelsetError(f"loaded = {loaded!r}: give True or False")
    asked = Changes.of("two_axle_wagon", **changes)
    wheelset = asked.wheelset(
        mass=1350.0, inertia=(700.0, 110.0, 700.0), radius=0.46, wheel="S1002"
    )
    track = asked.track(rail="UIC60", gauge=1.435, inclination=1.0 / 40.0)
    contact = asked.contact(creep="exact-table", friction=0.4)
    mass, inertia, height = LOADED_BODY if loaded else EMPTY_BODY
    name = f"{'loaded' if loaded else 'empty'} two-axle wagon"
    wagon = VehicleBuilder(name, track, contact)
    body = wagon.body("body", mass=mass, inertia=inertia, centre=(0.0, 0.0, height))
    for which, x in (("leading", HALF_WHEELBASE), ("trailing", -HALF_WHEELBASE)):
        axle = wagon.wheelset(which, wheelset, x=x)
        for side, sign in (("left", 1.0), ("right", -1.0)):
            place = (axle.x, sign * JOURNAL_HALF_DISTANCE, axle.z)
            wagon.connect(SUSPENSION, axle, body, at=place, name=f"{which} {side} suspension")
            for word, direction, play in (
                ("longitudinal", (1, 0, 0), LONGITUDINAL_PLAY),
                ("lateral", (0, 1, 0), LATERAL_PLAY),
            ):
                guard = BumpStop(direction, table=GUARD, play=play)
                wagon.connect(guard, axle, body, at=place, name=f"{which} {side} {word} guard")
    return wagon.finish()
