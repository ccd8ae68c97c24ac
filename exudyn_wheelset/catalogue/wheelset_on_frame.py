"""The full wheelset: six degrees of freedom on springs and dampers to a frame that moves at V.

The model stands in the moving frame (Galilean: the laws of motion are those over the ground), so
the frame is Exudyn's ground and the rails run backwards. At either end of the axle, at half
distance b, a spring and damper in x, y and z; a vertical force at the springs carries the load
beyond the wheelset's own weight.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import LoadForceVector, MarkerBodyRigid, ObjectConnectorCartesianSpringDamper

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.coupling.create import create_wheelset
from exudyn_wheelset.coupling.registration import WheelsetItems
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.vehicles.spin_drive import DRIVEN_STEP, create_spin_drive

GRAVITY = 9.81


@dataclass(frozen=True)
class Suspension:
    """Springs and dampers between one end of an axle and the frame.

    half_distance b [m] from the axle's centre; stiffness (x, y, z) [N/m] and damping (x, y, z)
    [N s/m] of one end.
    """

    half_distance: float
    stiffness: tuple[float, float, float]
    damping: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not 0.0 < self.half_distance < 3.0:
            raise WheelsetError(f"half_distance = {self.half_distance!r} m: give 0 to 3 m")
        for what in ("stiffness", "damping"):
            values = np.asarray(getattr(self, what), dtype=float)
            if values.shape != (3,) or not np.all(np.isfinite(values)) or np.any(values < 0.0):
                raise WheelsetError(f"{what} = {values.tolist()}: give three numbers >= 0 (SI)")


@dataclass(frozen=True)
class WheelsetOnFrame:
    """A wheelset with its suspension, load and contact, ready to be built at any speed.

    axle_load [N]: what both wheels carry, the wheelset's weight included; contact: keyword
    arguments of `contact_parameters` (normal, creep, friction, shear_modulus, poisson, damping);
    driven: the spin is held at V/radius (spin_drive.py), otherwise the wheelset rolls freely.
    """

    wheelset: Wheelset
    track: Track
    suspension: Suspension
    axle_load: float
    contact: dict[str, Any] = field(default_factory=dict)
    driven: bool = False
    name: str = "wheelset on frame"

    def __post_init__(self) -> None:
        weight = self.wheelset.mass * GRAVITY
        if not np.isfinite(self.axle_load) or self.axle_load < weight:
            raise WheelsetError(
                f"axle_load = {self.axle_load!r} N is less than the wheelset's own weight "
                f"{weight:.0f} N: give the load of both wheels on the rails, weight included"
            )

    def create(self, mbs: Any, speed: float, **options: Any) -> WheelsetItems:
        """Add wheelset, springs and load to `mbs`, in the frame that moves at `speed` [m/s].

        options: of `create_wheelset` (lateral_offset, yaw, show, name, ...).
        """
        items = create_wheelset(
            mbs,
            self.wheelset,
            self.track,
            speed=speed,
            moving_frame=True,
            gravity=GRAVITY,
            **{**self.contact, **options},
        )
        ground = mbs.CreateGround()
        height = mbs.GetNodeParameter(items.node, "referenceCoordinates")[2]
        half = self.suspension.half_distance
        spare = self.axle_load - self.wheelset.mass * GRAVITY
        for side in (half, -half):
            end = mbs.AddMarker(MarkerBodyRigid(bodyNumber=items.body, localPosition=[0, side, 0]))
            frame = mbs.AddMarker(
                MarkerBodyRigid(bodyNumber=ground, localPosition=[0.0, side, height])
            )
            mbs.AddObject(
                ObjectConnectorCartesianSpringDamper(
                    markerNumbers=[frame, end],
                    stiffness=list(self.suspension.stiffness),
                    damping=list(self.suspension.damping),
                )
            )
            mbs.AddLoad(LoadForceVector(markerNumber=end, loadVector=[0.0, 0.0, -0.5 * spare]))
        if self.driven:
            create_spin_drive(mbs, items, self.wheelset.radius)
        return items

    def build(self, speed: float, **options: Any) -> tuple[Any, Any, WheelsetItems]:
        """Return (SC, mbs, items) of a new, not yet assembled Exudyn system with this wheelset."""
        container = exu.SystemContainer()
        mbs = container.AddSystem()
        return container, mbs, self.create(mbs, speed, **options)

    def dynamic_system(self, **options: Any) -> ExudynSystem:
        """The model as a system for all analyses; options are those of ExudynSystem."""
        if self.driven and options.get("settings") is None and options.get("step") is None:
            options = {**options, "step": DRIVEN_STEP}
        container, mbs, items = self.build(20.0, sensors=False, show=False)
        return ExudynSystem(
            mbs,
            container,
            spinning_nodes={items.node: self.wheelset.radius} if self.driven else {},
            name=self.name,
            parameters=self.parameters(),
            **options,
        )

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
