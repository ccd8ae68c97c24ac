"""An axle that is driven: its spin is held at V/r0 by a strong rotational damper.

The paper's equations (2) and (4) take the spin to be V/r0 whatever radius the wheels roll on. A
free wheelset finds its own spin, with zero mean longitudinal creepage; a driven one whose wheels
roll beside the tape circle slips a little all the time. This drive makes the six-degree-of-freedom
model comparable with the paper's.
"""

from __future__ import annotations

from typing import Any

from exudyn.utilities import LoadTorqueVector

from exudyn_wheelset.coupling.registration import WheelsetItems

# Time step [s] of RK44 for a driven axle: the drive's rate of some 8e3 1/s is beyond 5e-4 s.
DRIVEN_STEP = 1.0e-4
# Of the drive about the axle [N m s/rad]: a creep force of 10 kN on the rim changes the spin by
# 4 mrad/s.
DRIVE_DAMPING = 1.0e6


def create_spin_drive(
    mbs: Any, items: WheelsetItems, radius: float, damping: float = DRIVE_DAMPING
) -> int:
    """Hold the spin of a wheelset at (speed of its moving frame)/radius; return the load number.

    radius r0 [m]; damping [N m s/rad] of the drive about the axle, body axes.
    """
    contact = items.contact

    def torque_of(mbs: Any, t: float, load: Any) -> list[float]:
        if contact.first < 0:
            contact.place(mbs)
        spin = mbs.systemData.GetODE2Coordinates_t()[contact.first + 4]
        return [0.0, damping * (contact.rail_speed / radius - spin), 0.0]

    # Exudyn's stub files know their own callback classes only.
    torque: Any = torque_of
    load = LoadTorqueVector(
        name=f"{items.name} spin drive",
        markerNumber=items.marker,
        bodyFixed=True,
        loadVectorUserFunction=torque,
    )
    return int(mbs.AddLoad(load))
