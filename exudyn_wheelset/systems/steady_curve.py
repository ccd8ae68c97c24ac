"""The quasi-static curve: a vehicle that runs steadily through a circular curve.

    curve = steady_curve(coach, radius=300, cant=0.1, speed=20.0)
    curve.y, curve.yaw          (wheelsets,) on the track at each wheelset [m, rad]
    curve.Q, curve.Y            (wheelsets, 2) left and right [N]
    curve.patches["front leading", "left"]
    simulate(coach.on(track), 20.0, 10.0, start=..., initial=curve.state)

Found by continuation from straight track, and where that ends by driving into the curve over a
transition (curving.py). A vehicle with dry friction has many states in which all balances, for its
faces hold whatever they have come to; the one that is given is where a drive over a transition
leaves it.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import number, warn
from exudyn_wheelset.contact.layout import Patch
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.results.records import describe
from exudyn_wheelset.spelling import spelt, spelt_class
from exudyn_wheelset.systems.curving import DRIVE, driven_in
from exudyn_wheelset.systems.fitting import check_curves, radial_steering_index
from exudyn_wheelset.systems.simulation import motion_of
from exudyn_wheelset.systems.system import DynamicSystem
from exudyn_wheelset.systems.vehicle_system import VehicleSystem, has_friction, vehicle_system
from exudyn_wheelset.track.layout import (
    BASE,
    Curve,
    Layout,
    Straight,
    TrackElement,
    Transition,
)  # fmt: skip
from exudyn_wheelset.vehicles.description import Vehicle

# Transition [m], and seconds on it, by which a vehicle is driven into a curve where continuation
# ends, and the straight before it [m], longer than half a vehicle.
_TRANSITION, _RAMP, _STRAIGHT = 60.0, 3.0, 20.0
# Seconds in a curve after which faces that rub have crept to within 0.1 mm of where they stay.
_CREEP = 24.0
# Radius [m] below which railways widen the gauge, by 5 to 20 mm.
_NARROW = 175.0


@spelt_class
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
        return np.asarray(self.motion.y[0])

    @property
    def yaw(self) -> Array:
        """Yaw (wheelsets,) [rad] against the track's direction: the angle of attack."""
        return np.asarray(self.motion.yaw[0])

    @property
    def Q(self) -> Array:
        """Vertical forces (wheelsets, 2) [N] of the rails on left and right wheels."""
        return np.asarray(self.motion.Q[0])

    @property
    def Y(self) -> Array:
        """Lateral forces (wheelsets, 2) [N] of the rails on the wheels, to the left."""
        return np.asarray(self.motion.Y[0])

    def guiding_quotient(self) -> Array:
        """Y/Q (wheelsets, 2), Y the wheel's force on the rail towards its field side."""
        return np.asarray(self.motion.guiding_quotient()[0])

    def sum_of_y(self) -> Array:
        """Sum of both rails' lateral forces (wheelsets,) [N], to the left."""
        return np.asarray(self.motion.sum_of_y()[0])

    def unloading(self, static_loads: Array | None = None) -> Array:
        """(Q0 - Q)/Q0 (wheelsets, 2); Q0 (wheelsets, 2) [N] defaults to the loads at rest."""
        return np.asarray(self.motion.unloading(static_loads)[0])

    def wear_number(self) -> Array:
        """T-gamma (wheelsets, 2) [N]: |F_x xi_x| + |F_y xi_y| + |M_z phi| over all patches."""
        return np.asarray(self.motion.wear_number()[0])

    def steering_index(self) -> Array:
        """q_E (wheelsets,): rolling radius difference needed over available (fitting.py)."""
        contacts = self.system.contacts  # type: ignore[attr-defined]
        return np.array(
            [radial_steering_index(one.wheelset, one.track, self.radius) for one in contacts]
        )

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


@spelt
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
    way = max(_TRANSITION, _RAMP * abs(speed))

    def drive(duration: float) -> tuple[Array, float]:
        entry: list[TrackElement] = [
            Straight(_STRAIGHT), Transition(way), Curve(radius, 1.0, cant, widening)
        ]  # fmt: skip
        on_it = replace(track, layout=Layout(entry, grades, base), irregularity=None)
        return driven_in(
            system, vehicle_system(vehicle.on(on_it)), speed, way + 2.0 * _STRAIGHT, duration
        )

    state = None
    if speed > 0.0 and has_friction(vehicle):
        with suppress(AnalysisError):
            state, system.unsteadiness = drive(_CREEP)
    if state is None:
        try:
            state = system.equilibrium(speed)
        except AnalysisError as error:
            if speed <= 0.0:
                raise
            try:
                state, system.unsteadiness = drive(DRIVE)
            except AnalysisError as other:
                raise AnalysisError(f"{error}; {other}") from error
    record = describe(system, "steady curve", {"radius": radius, "cant": cant, "speed": speed})
    motion = _at(system, np.zeros(1), state[None, :], speed, record)
    if system.unsteadiness > 0.0:
        warn(
            f"{system.name} in R = {radius:g} m at {speed:g} m/s moves by "
            f"{1e3 * system.unsteadiness:.2g} mm or mrad for ever: what is given is the mean of a "
            f"second; {_why(vehicle, radius, widening)}"
        )
        times = np.linspace(0.0, 1.0, 501)
        samples, _ = system.carry_on(state, speed, times)
        whole = _at(system, times[: len(samples)], samples, speed, record)
        means = {name: values.mean(keepdims=True) for name, values in whole.columns.items()}
        motion = replace(motion, columns=means)
    return SteadyCurve(
        float(radius),
        float(cant),
        speed,
        state,
        motion,
        MappingProxyType(_patches(system, state)),
        system,
    )


def _why(vehicle: Vehicle, radius: float, widening: float) -> str:
    if has_friction(vehicle):
        return "faces that rub creep under it"
    jump = "it runs on a jump of its contact forces, where patches of a wheel merge"
    if abs(radius) < _NARROW and widening <= 0.0:
        jump += "; so narrow curves have a wider gauge: give widening=0.015, which takes it off"
    return jump


def _at(
    system: VehicleSystem, times: Array, states: Array, speed: float, record: Mapping[str, Any]
) -> Motion:
    """States (m, n) of the frozen curve as a motion."""
    rows = [system.layout.expand(row) for row in states]
    raw = tuple(np.array([row[k] for row in rows]) for k in range(3))
    return motion_of(system, times, raw, Outcome(Ending.FINISHED), speed, 0.0, record)


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
