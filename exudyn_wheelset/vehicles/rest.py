"""A vehicle at rest against the track while its wheelsets roll straight ahead.

The wheelsets stand where their rails carry the wheels' loads (rail_support.py). A vehicle that is
drawn loaded stands as drawn, its connections loaded by what balances the bodies (balance.py). One
that is drawn by free lengths settles from there: Newton's method on the forces of the simulation's
own kernels.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import ContactError, WheelsetError
from exudyn_wheelset.vehicles import kernel, layout
from exudyn_wheelset.vehicles.balance import balance, given_preloads, inertias_of, weights
from exudyn_wheelset.vehicles.description import Axle, Vehicle
from exudyn_wheelset.vehicles.rail_support import (
    AxleRest,
    RailWrench,
    level_contact,
    rest_on_rails,
    shape_of,
)
from exudyn_wheelset.vehicles.struts import Strut, block_of, strokes_at, struts_of

_NEWTON_STEPS = 120
# Accelerations [m/s^2, rad/s^2] that are rounding.
_AT_REST = 1.0e-7


@dataclass(frozen=True)
class Rest:
    """What assembling a vehicle needs of its equilibrium.

    struts; preloads (m, 6): their forces in the drawing; centres (n, 3) [m]: reference positions
    of the parts; pose (n, 6): their displacement and rotation vector at rest; drawn (n, 6): the
    same where the struts have their preloads; axles: of each wheelset; pull [N]: forward force on
    the heaviest part that keeps a vehicle going whose wheels drive or brake (driven axles, wheels
    that touch in two places, steering wheelsets) and that no connection to the ground holds.
    """

    struts: list[Strut]
    preloads: Array
    centres: Array
    pose: Array
    drawn: Array
    axles: list[AxleRest]
    pull: float = 0.0


def find_rest(vehicle: Vehicle, near: Rest | None = None) -> Rest:
    """The vehicle at rest; near: that of a vehicle of little other numbers, to begin with.

    Raises WheelsetError for a vehicle that cannot stand, with the body, the direction and the
    newtons, and ContactError for a wheelset that its rails do not carry.
    """
    centres = np.array([part.centre for part in vehicle.parts])
    count = len(vehicle.wheelsets)
    for k, axle in enumerate(vehicle.wheelsets):
        height = near.axles[k].height if near is not None else _touching(vehicle, axle)
        centres[k, 2] = axle.wheelset.radius + height
    guesses: list[AxleRest | None] = [None] * count
    if near is not None:
        guesses[:] = near.axles
    # The heights of the axles depend on their loads and shift the points of the connections.
    for _ in range(3):
        struts = struts_of(vehicle, centres)
        given = given_preloads(vehicle, struts)
        forces, supports, sunk = balance(vehicle, struts, centres, given)
        axles = [
            _stand(vehicle, axle, support, guess)
            for axle, support, guess in zip(vehicle.wheelsets, supports, guesses, strict=True)
        ]
        guesses[:] = axles
        moved = [
            axle.wheelset.radius + found.height
            for axle, found in zip(vehicle.wheelsets, axles, strict=True)
        ]
        change = np.abs(centres[:count, 2] - moved).max()
        centres[:count, 2] = moved
        if change < 1e-12:
            break
    struts = struts_of(vehicle, centres)
    pose = np.zeros((len(centres), 6))
    if vehicle.preload == "free":
        pose = sunk.copy()
        drawn = Rest(struts, given, centres, pose, np.zeros_like(pose), axles)
        _place_axles(pose, axles)
        return _settle(vehicle, drawn)
    _place_axles(pose, axles)
    rest = Rest(struts, forces, centres, pose, pose, axles)
    if np.abs(accelerations(vehicle, rest)).max() < _AT_REST:
        return rest
    # Unlike wheels or loads: rolling radii differ, so the wheelsets steer until springs hold them.
    # Driven wheels and those that touch in two places pull or brake.
    try:
        return _settle(vehicle, rest)
    except WheelsetError:
        return rest


def accelerations(vehicle: Vehicle, rest: Rest) -> Array:
    """Accelerations (n, 6) [m/s^2, rad/s^2] left at rest, by the kernels of the simulation."""
    forces = StaticForces(vehicle, rest.struts, rest.preloads, rest.centres, rest.drawn)(rest.pose)
    forces[heaviest_part(vehicle), 0] += rest.pull
    _add_rails(vehicle, forces, rest.axles)
    return np.asarray(forces / inertias_of(vehicle))


def heaviest_part(vehicle: Vehicle) -> int:
    """Number of the part that is pulled."""
    return int(np.argmax(inertias_of(vehicle)[:, 0]))


def _add_rails(vehicle: Vehicle, forces: Array, axles: list[AxleRest]) -> None:
    """Add the rails' wrenches to forces (n, 6); a drive takes the moment about its axle."""
    for k, (axle, at_rest) in enumerate(zip(vehicle.wheelsets, axles, strict=True)):
        forces[k] += at_rest.wrench
        if axle.driven:
            forces[k, 4] = 0.0


def rolls_freely(struts: list[Strut], parts: int) -> bool:
    """Whether no connection to the ground holds the vehicle along the track."""
    return not any(strut.upper == parts and strut.stiffness[0, 0] > 0.0 for strut in struts)


def _place_axles(pose: Array, axles: list[AxleRest]) -> None:
    """Put the wheelsets where they stand into a pose (n, 6)."""
    for k, found in enumerate(axles):
        pose[k, 1:] = found.shift, 0.0, found.roll, 0.0, 0.0


def _stand(vehicle: Vehicle, axle: Axle, support: Array, near: AxleRest | None) -> AxleRest:
    try:
        return rest_on_rails(
            axle.wheelset, vehicle.track, vehicle.contact, support, axle.driven, near
        )
    except ContactError as error:
        raise ContactError(f"{vehicle.name}: wheelset {axle.name!r}: {error}") from error


def _touching(vehicle: Vehicle, axle: Axle) -> float:
    """Height [m] of the centre above the radius where both wheels just touch their rails."""
    try:
        return float(level_contact(axle.wheelset, vehicle.track).z[0])
    except ContactError as error:
        raise ContactError(f"{vehicle.name}: wheelset {axle.name!r}: {error}") from error


class StaticForces:
    """Forces and moments of connections, weights and loads on all parts, in any pose."""

    def __init__(
        self, vehicle: Vehicle, struts: list[Strut], preloads: Array, centres: Array, drawn: Array
    ) -> None:
        self._block, states = block_of(vehicle, struts, preloads, drawn, centres)
        self._strokes = np.zeros(max(len(states), 1))
        self._weights = weights(vehicle, centres)
        self._drawn = drawn
        # Elements that add their own items are known by their stiffness alone.
        self._linear = [
            (strut.lever(centres), strut.stiffness, preload)
            for strut, preload in zip(struts, preloads, strict=True)
            if strut.law is None
        ]

    def __call__(self, pose: Array) -> Array:
        """Forces (n, 6) in a pose (n, 6) that lasts: moments in the parts' own axes."""
        count = len(pose)
        flat = np.ascontiguousarray(pose).ravel()
        if int(self._block[layout.H_STATES]):
            self._strokes[:] = strokes_at(self._block, flat)
        kernel.connection_forces(flat, np.zeros(6 * count), self._strokes, self._block)
        start = int(self._block[layout.H_FORCES])
        forces = self._block[start : start + 6 * count].reshape(count, 6) + self._weights
        for lever, stiffness, preload in self._linear:
            strain = lever @ (pose - self._drawn).ravel()
            forces += (lever.T @ (preload - stiffness @ strain)).reshape(-1, 6)
        return np.asarray(forces)


def _settle(vehicle: Vehicle, rest: Rest) -> Rest:
    """The vehicle where it comes to rest, from the guess of `rest`; raises WheelsetError."""
    centres = rest.centres
    radii = [found.radius for found in rest.axles]
    forces_of = StaticForces(vehicle, rest.struts, rest.preloads, centres, rest.drawn)
    inertias = inertias_of(vehicle)
    spins = len(vehicle.wheelsets)
    pulled, weight = heaviest_part(vehicle), float(inertias[:, 0].sum()) * max(vehicle.gravity, 1.0)
    rails = [
        RailWrench(shape_of(axle.wheelset), vehicle.track, vehicle.contact)
        for axle in vehicle.wheelsets
    ]
    free = rolls_freely(rest.struts, len(centres))

    def split(unknown: Array) -> tuple[Array, list[AxleRest]]:
        """Pose and wheelsets; a wheelset's pitch stands for the change of its rolling radius."""
        trial = unknown[:-1].reshape(-1, 6).copy()
        axles = []
        for k, axle in enumerate(vehicle.wheelsets):
            yaw, roll = trial[k, 5], trial[k, 3]
            height = centres[k, 2] + trial[k, 2] - axle.wheelset.radius
            radius = radii[k] * (1.0 + (0.0 if axle.driven else trial[k, 4]))
            at = np.array([height, roll, trial[k, 1], radius])
            wrench, loads = rails[k](at, yaw)
            axles.append(AxleRest(height, float(trial[k, 1]), roll, float(radius), wrench, loads))
            trial[k, 3:] = Rotation.from_euler("ZX", [yaw, roll]).as_rotvec()
        return trial, axles

    def left(unknown: Array) -> Array:
        trial, axles = split(unknown)
        forces = forces_of(trial)
        forces[pulled, 0] += weight * unknown[-1]
        _add_rails(vehicle, forces, axles)
        return np.asarray((forces / inertias).ravel())

    unknown = np.append(rest.pose.ravel(), rest.pull / weight)
    steps = np.full(unknown.size, 1e-7)
    residual = left(unknown)
    for _ in range(_NEWTON_STEPS):
        slope = np.zeros((residual.size, unknown.size))
        for column in range(unknown.size if free else residual.size):
            ahead, behind = unknown.copy(), unknown.copy()
            ahead[column] += steps[column]
            behind[column] -= steps[column]
            slope[:, column] = (left(ahead) - left(behind)) / (2.0 * steps[column])
        step = -np.linalg.lstsq(slope, residual, rcond=1e-12)[0]
        # A wheel lifts off or digs in where a step leaves the thin layer of its penetration.
        wheels = np.abs(step[:-1].reshape(-1, 6)[:spins, [2, 3]]).max(initial=0.0)
        step *= min(1.0, 5e-5 / wheels if wheels > 0.0 else 1.0)
        size = np.linalg.norm(residual)
        for factor in 0.5 ** np.arange(8):
            residual = left(unknown + factor * step)
            if np.linalg.norm(residual) < size:
                break
        unknown = unknown + factor * step
        if np.abs(step).max() < 1e-14 or np.abs(residual).max() < _AT_REST:
            break
    if not np.abs(residual).max() < 1e-5:
        worst = vehicle.parts[int(np.argmax(np.abs(residual))) // 6].name
        raise WheelsetError(
            f"{vehicle.name}: no equilibrium from its free lengths: {worst!r} is left with "
            f"{np.abs(residual).max():.3g} m/s^2; draw it nearer to its place or check the offsets"
        )
    trial, axles = split(unknown)
    return replace(rest, pose=trial, axles=axles, pull=float(weight * unknown[-1]))
