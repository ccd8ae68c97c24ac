"""A soft drawbar that keeps a vehicle at its speed against what drives, brakes or resists it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from exudyn.utilities import (
    LoadForceVector,
    MarkerBodyRigid,
    ObjectConnectorCartesianSpringDamper,
)

from exudyn_wheelset.coupling.track_frame import TrackFrame
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.rest import Rest, heaviest_part, rolls_freely

# Angular frequency [rad/s] of a vehicle on its drawbar, critically damped: slow beside all else.
_DRAWBAR = 0.5


@dataclass(frozen=True)
class Drawbar:
    """What keeps a vehicle at its speed that is driven, braked or on a track that is not plain.

    part: number of the pulled part; pull [N]; stiffness [N/m] and damping [N s/m] along the track.
    """

    part: int
    pull: float
    stiffness: float
    damping: float


def add_drawbar(
    mbs: Any, rest: Rest, vehicle: Vehicle, frame: TrackFrame, parts: list[Any], name: str
) -> Drawbar | None:
    """Let a vehicle keep its speed whose wheels drive or brake, or whose track is not plain.

    Beside the pull a soft drawbar to what moves along: the pull at another speed differs a little,
    and curves, gradients and rough rails resist.
    """
    if rest.pull == 0.0 and (frame.is_plain or not rolls_freely(rest.struts, len(rest.centres))):
        return None
    part = heaviest_part(vehicle)
    bar = Drawbar(part, rest.pull, vehicle.mass * _DRAWBAR**2, 2.0 * vehicle.mass * _DRAWBAR)
    items = parts[part]
    marker = mbs.AddMarker(MarkerBodyRigid(name=f"{name} pulled", bodyNumber=items.body))
    ahead = mbs.AddMarker(
        MarkerBodyRigid(
            name=f"{name} drawbar",
            bodyNumber=mbs.CreateGround(),
            localPosition=mbs.GetNodeParameter(items.node, "referenceCoordinates")[:3],
        )
    )
    mbs.AddObject(
        ObjectConnectorCartesianSpringDamper(
            name=f"{name} drawbar",
            markerNumbers=[ahead, marker],
            stiffness=[bar.stiffness, 0.0, 0.0],
            damping=[bar.damping, 0.0, 0.0],
        )
    )
    mbs.AddLoad(
        LoadForceVector(name=f"{name} pull", markerNumber=marker, loadVector=[bar.pull, 0.0, 0.0])
    )
    return bar
