"""Vehicle 1 of the Manchester benchmarks, a passenger coach.

S. Iwnicki (ed.), The Manchester Benchmarks for Rail Vehicle Simulation, Vehicle System Dynamics 31
Supplement (1999), in the numbers of masses, springs, dampers and dimensions that agree in later
uses of it. The dampers work in series with springs, or without them. Not of the source are two
numbers: the height of the secondary suspension, 1.1 m, and damping and length of the traction
rods. SI units.
"""

from __future__ import annotations

from typing import Any

from exudyn_wheelset.catalogue.changes import Changes
from exudyn_wheelset.vehicles.builder import Part, VehicleBuilder
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.elements import (
    AntiRollBar,
    BumpStop,
    Bushing,
    Damper,
    MaxwellDamper,
    Spring,
    TractionRod,
)

HALF_PIVOT_DISTANCE, HALF_WHEELBASE, HALF_SPACING = 9.5, 1.28, 1.0
BODY_HEIGHT, FRAME_HEIGHT, SECONDARY_HEIGHT = 1.8, 0.6, 1.1
PRIMARY_SERIES, SECONDARY_SERIES = 1.0e6, 6.0e6
PRIMARY_VERTICAL_DAMPING = 4.0e3
SECONDARY_LATERAL_DAMPING, SECONDARY_VERTICAL_DAMPING = 32.0e3, 20.0e3
BENDING = 10.5e3
BUMP_STOP = (
    (0.0, 0.0),
    (0.025, 0.0),
    (0.030, 600.0),
    (0.035, 1760.0),
    (0.040, 3730.0),
    (0.045, 6870.0),
    (0.050, 11580.0),
    (0.055, 17170.0),
    (0.060, 29200.0),
    (0.065, 230000.0),
)


def manchester_coach(series_stiffness: bool = True, **changes: Any) -> Vehicle:
    """The coach, S1002 on UIC60 1:40 at 1435 mm; `changes` are those of `Changes`.

    series_stiffness: whether the dampers have their springs in series, or work without them.
    Raises WheelsetError for an unknown change and for impossible values.
    """
    asked = Changes.of("manchester_coach", **changes)
    wheelset = asked.wheelset(
        mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=0.46, wheel="S1002"
    )
    track = asked.track(rail="UIC60", gauge=1.435, inclination=1.0 / 40.0)
    coach = VehicleBuilder("Manchester coach", track, asked.contact(friction=0.3))

    def damper(
        axis: str, stiffness: float, damping: float, lower: Part, upper: Part, at: Any, name: str
    ) -> None:
        direction = tuple(float(axis == one) for one in "xyz")
        element: Any = Damper(direction, damping)  # type: ignore[arg-type]
        if series_stiffness:
            element = MaxwellDamper(direction, stiffness, damping)  # type: ignore[arg-type]
        coach.connect(element, lower, upper, at=at, name=name)

    body = coach.body(
        "body", mass=32.0e3, inertia=(56.8e3, 1.97e6, 1.97e6), centre=(0.0, 0.0, BODY_HEIGHT)
    )
    for truck, x in (("front", HALF_PIVOT_DISTANCE), ("rear", -HALF_PIVOT_DISTANCE)):
        frame = coach.body(
            f"{truck} frame",
            mass=2615.0,
            inertia=(1722.0, 1476.0, 3067.0),
            centre=(x, 0.0, FRAME_HEIGHT),
        )
        for which, ahead in (("leading", HALF_WHEELBASE), ("trailing", -HALF_WHEELBASE)):
            axle = coach.wheelset(f"{truck} {which}", wheelset, x=x + ahead)
            for side, sign in (("left", 1.0), ("right", -1.0)):
                at = (axle.x, sign * HALF_SPACING, axle.z)
                name = f"{truck} {which} {side} primary"
                spring = Spring((31.391e6, 3.884e6, 1.22e6), (15.0e3, 2.0e3, 0.0))
                coach.connect(spring, axle, frame, at=at, name=name)
                damper(
                    "z", PRIMARY_SERIES, PRIMARY_VERTICAL_DAMPING, axle, frame, at, f"{name} damper"
                )
        for side, sign in (("left", 1.0), ("right", -1.0)):
            at = (x, sign * HALF_SPACING, SECONDARY_HEIGHT)
            name = f"{truck} {side} secondary"
            spring = Bushing((0.16e6, 0.16e6, 0.43e6, BENDING, BENDING, 0.0))
            coach.connect(spring, frame, body, at=at, name=name)
            for axis, damping in (
                ("y", SECONDARY_LATERAL_DAMPING),
                ("z", SECONDARY_VERTICAL_DAMPING),
            ):
                word = "lateral" if axis == "y" else "vertical"
                name = f"{truck} {side} secondary {word} damper"
                damper(axis, SECONDARY_SERIES, damping, frame, body, at, name)
        centre = (x, 0.0, SECONDARY_HEIGHT)
        coach.connect(
            BumpStop((0, 1, 0), BUMP_STOP), frame, body, centre, name=f"{truck} bump stop"
        )
        coach.connect(AntiRollBar(940.0e3), frame, body, centre, name=f"{truck} anti-roll bar")
        rod = TractionRod(5.0e6, damping=25.0e3, length=0.8)
        coach.connect(rod, frame, body, (x, 0.0, FRAME_HEIGHT), name=f"{truck} traction rod")
    return coach.finish()
