"""The quasi-static curve: a vehicle that runs steadily through a circular curve.

    curve = steady_curve(coach, radius=300, cant=0.1, speed=20.0)
    curve.y, curve.yaw          (wheelsets,) on the track at each wheelset [m, rad]
    curve.Q, curve.Y            (wheelsets, 2) left and right [N]
    curve.patches["front leading", "left"]
    simulate(coach.on(track), 20.0, 10.0, start=..., initial=curve.state)

Found by continuation from straight track (curving.py).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import number
from exudyn_wheelset.contact.layout import Patch
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.results.records import describe
from exudyn_wheelset.systems.fitting import check_curves
from exudyn_wheelset.systems.simulation import motion_of
from exudyn_wheelset.systems.system import DynamicSystem
from exudyn_wheelset.systems.vehicle_system import VehicleSystem, vehicle_system
from exudyn_wheelset.track.layout import BASE, Curve, Layout
from exudyn_wheelset.vehicles.description import Vehicle


@brief
@dataclass(frozen=True)
class SteadyCurve:
    """Steady running in a curve of a radius [m] (to the left where positive) at a speed [m/s].

    state (n,): of the vehicle's system, where a motion may begin; motion: its one sample as data,
    with all that is read off a motion; patches: by wheelset and side, in the axes of the track at
    the wheelset; system: name, states and settings.

    Examples
    --------
    >>> from exudyn_wheelset import catalogue, steady_curve
    >>> curve = steady_curve(catalogue.vehicle("manchester_coach"), radius=300, cant=0.12, speed=18)
    >>> curve.radius, curve.cant
    (300.0, 0.12)
    """

    radius: float
    cant: float
    speed: float
    state: Array
    motion: Motion
    patches: Mapping[tuple[str, str], tuple[Patch, ...]]
    system: DynamicSystem = field(repr=False)

    @property
    def wheelsets(self) -> tuple[str, ...]:
        """Names of the wheelsets."""
        return self.motion.wheelsets

    @property
    def y(self) -> Array:
        """Lateral shift (wheelsets,) [m] against the track's centre line at each wheelset."""
        return self.motion.y[0]

    @property
    def yaw(self) -> Array:
        """Yaw (wheelsets,) [rad] against the track's direction: the angle of attack."""
        return self.motion.yaw[0]

    @property
    def Q(self) -> Array:
        """Vertical forces (wheelsets, 2) [N] of the rails on left and right wheels."""
        return self.motion.Q[0]

    @property
    def Y(self) -> Array:
        """Lateral forces (wheelsets, 2) [N] of the rails on the wheels, to the left."""
        return self.motion.Y[0]

    def guiding_quotient(self) -> Array:
        """Y/Q (wheelsets, 2), Y the wheel's force on the rail towards its field side."""
        return self.motion.guiding_quotient()[0]

    def sum_of_y(self) -> Array:
        """Sum of both rails' lateral forces (wheelsets,) [N], to the left."""
        return self.motion.sum_of_y()[0]

    def unloading(self, static_loads: Array | None = None) -> Array:
        """(Q0 - Q)/Q0 (wheelsets, 2); Q0 (wheelsets, 2) [N] defaults to the loads at rest."""
        return self.motion.unloading(static_loads)[0]

    def wear_number(self) -> Array:
        """T-gamma (wheelsets, 2) [N]: |F_x xi_x| + |F_y xi_y| + |M_z phi| over all patches."""
        return self.motion.wear_number()[0]

    def friction_use(self) -> dict[tuple[str, str], tuple[float, ...]]:
        """Creep force over friction times normal force of every patch, by wheelset and side."""
        return {
            wheel: tuple(
                float(np.hypot(patch.fx, patch.fy) / (patch.friction * patch.normal_force))
                for patch in patches
            )
            for wheel, patches in self.patches.items()
        }

    def __getitem__(self, name: str) -> float:
        return float(self.motion[name][0])


def steady_curve(
    vehicle: Vehicle | VehicleSystem,
    radius: float,
    cant: float = 0.0,
    speed: float = 20.0,
    *,
    gradient: float = 0.0,
    widening: float = 0.0,
    base: float = BASE,
) -> SteadyCurve:
    """Steady running of a vehicle in a curve: radius [m], positive to the left, cant [m] of the
    outer rail over the distance `base` [m], at a speed [m/s].

    gradient: rise a metre [-]; widening [m] of the gauge. Raises AnalysisError where there is no
    steady running, with how much of the curve was reached, and WheelsetError for impossible values.

    Examples
    --------
    >>> from exudyn_wheelset import catalogue, steady_curve
    >>> curve = steady_curve(catalogue.vehicle("manchester_coach"), radius=300, cant=0.12, speed=18)
    >>> curve.motion.y.shape  # samples and wheelsets
    (1, 4)
    """
    if not isinstance(vehicle, Vehicle):
        raise AnalysisError(
            f"{type(vehicle).__name__} cannot be put into a curve: give a Vehicle, such as "
            'catalogue.vehicle("manchester_coach")'
        )
    speed = number("speed", speed, "m/s", -200.0, 200.0)
    grades = ((0.0, gradient),) if gradient else ()
    layout = Layout([Curve(radius, 1.0, cant, widening)], grades, base)
    track = replace(vehicle.track, layout=layout, irregularity=None)
    system = vehicle_system(vehicle.on(track))
    check_curves(system.name, system.wheelsets)
    state = system.equilibrium(speed)
    record = describe(system, "steady curve", {"radius": radius, "cant": cant, "speed": speed})
    raw = tuple(row[None, :] for row in system.layout.expand(state))
    outcome = Outcome(Ending.FINISHED)
    motion = motion_of(system, np.zeros(1), raw, outcome, speed, 0.0, record)
    return SteadyCurve(
        float(radius),
        float(cant),
        speed,
        state,
        motion,
        MappingProxyType(_patches(system, state)),
        system,
    )


def _patches(system: VehicleSystem, state: Array) -> dict[tuple[str, str], tuple[Patch, ...]]:
    coordinates, velocities, _ = system.layout.expand(state)
    data: Any = system.mbs.systemData
    data.SetODE2Coordinates(coordinates)
    data.SetODE2Coordinates_t(velocities)
    found = {}
    for items in system.wheelsets:
        forces = items.contact.current(system.mbs)
        found[items.name, "left"], found[items.name, "right"] = forces.left, forces.right
    return found
