"""The balance of all bodies of a vehicle as a linear problem of springs, K u = w.

All connections and wheels are springs against loads that stay, the weights w act at the bodies'
centres. What comes out are forces that balance every body; where balance leaves them open (four
legs of a table), they are shared by stiffness. A direction without stiffness must be without load.
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.vehicles.description import Axle, Vehicle
from exudyn_wheelset.vehicles.rail_support import level_contact
from exudyn_wheelset.vehicles.struts import Strut

# Of a wheel on its rail [N/m], for the sharing of loads: some 100 kN on 0.1 mm.
WHEEL_STIFFNESS = 1.0e9
# Part of the weight that may be out of balance: rounding.
_IMBALANCE = 1.0e-7
# A vehicle that sinks by more has no springs in that direction [m].
_DEEPEST = 1.0
# A turn by an angle counts as much as its arc at this distance [m].
_LEVER = 2.0
_DIRECTIONS = ("x", "y", "z", "roll", "pitch", "yaw")


def inertias_of(vehicle: Vehicle) -> Array:
    rows = []
    for part in vehicle.parts:
        solid = part.wheelset if isinstance(part, Axle) else part
        rows.append([solid.mass] * 3 + list(solid.inertia))
    return np.array(rows)


def weights(vehicle: Vehicle, centres: Array) -> Array:
    """Weights and loads (n, 6) on all parts about their centres."""
    loads = np.zeros((len(centres), 6))
    loads[:, 2] = -vehicle.gravity * inertias_of(vehicle)[:, 0]
    number = {part.name: k for k, part in enumerate(vehicle.parts)}
    for load in vehicle.loads:
        k = number[load.body]
        force = np.array(load.force)
        loads[k, :3] += force
        loads[k, 3:] += np.cross(np.array(load.at) - centres[k], force)
    return loads


def given_preloads(vehicle: Vehicle, struts: list[Strut]) -> Array:
    """Forces (m, 6) of the struts in the drawing that are known: preloads given, free lengths."""
    given = np.zeros((len(struts), 6))
    for k, strut in enumerate(struts):
        if strut.connection.preload is not None:
            shares = sum(other.connection is strut.connection for other in struts)
            given[k, :3] = np.array(strut.connection.preload) / shares
        elif strut.known is not None:
            given[k, :3] = strut.known
        elif vehicle.preload == "free":
            given[k, :3] = strut.stiffness[:3, :3] @ strut.connection.offset
    return given


def balance(
    vehicle: Vehicle, struts: list[Strut], centres: Array, given: Array, tapes: bool = False
) -> tuple[Array, Array, Array]:
    """Forces (m, 6) of the struts and loads (k, 2) [N] of the wheels that balance all bodies.

    given (m, 6): forces of the struts in the drawing; tapes: wheels stand on their tape circles, to
    some millimetres. Also returns how the parts sink (n, 6).
    """
    count = len(centres)
    levers = [strut.lever(centres) for strut in struts]
    is_given = [strut.known is not None for strut in struts]
    stiffness = np.zeros((6 * count, 6 * count))
    loads = weights(vehicle, centres).ravel()
    for lever, strut, preload, known in zip(levers, struts, given, is_given, strict=True):
        loads += lever.T @ preload
        if not known:
            stiffness += lever.T @ strut.stiffness @ lever
    wheels = np.zeros((2 * len(vehicle.wheelsets), 6 * count))
    for k, axle in enumerate(vehicle.wheelsets):
        half = axle.wheelset.tape_half_distance
        places = (half, -half)
        if not tapes:
            geometry = level_contact(axle.wheelset, vehicle.track)
            places = (half + geometry.left.wheel_y[0], -half - geometry.right.wheel_y[0])
        for hand, y in enumerate(places):
            wheels[2 * k + hand, 6 * k + 2] = 1.0
            wheels[2 * k + hand, 6 * k + 3] = y
    stiffness += WHEEL_STIFFNESS * wheels.T @ wheels
    inverse = np.linalg.pinv(stiffness, rcond=1e-11, hermitian=True)
    sunk = inverse @ loads
    preloads = given
    for _ in range(4):
        forces = [
            preload - (0.0 if known else strut.stiffness @ (lever @ sunk))
            for lever, strut, preload, known in zip(levers, struts, given, is_given, strict=True)
        ]
        preloads = np.array(forces).reshape(-1, 6)
        supports = -WHEEL_STIFFNESS * wheels @ sunk
        left = weights(vehicle, centres).ravel() + wheels.T @ supports
        for lever, preload in zip(levers, preloads, strict=True):
            left += lever.T @ preload
        sunk = sunk + inverse @ left
    _check_balance(vehicle, left.reshape(-1, 6), sunk.reshape(-1, 6))
    return preloads, supports.reshape(-1, 2), sunk.reshape(-1, 6)


def _check_balance(vehicle: Vehicle, left: Array, sunk: Array) -> None:
    """Raise WheelsetError for what no spring balances, or what sinks out of sight."""
    # What is left is a motion m without stiffness times a number; m scaled to 1 in a direction
    # makes m . w the load in that direction. A turn about a far axis also moves the centre.
    reach = np.abs(left) * np.array([1.0, 1.0, 1.0, _LEVER, _LEVER, _LEVER])
    worst, direction = np.unravel_index(np.argmax(reach), left.shape)
    weight = vehicle.mass * max(vehicle.gravity, 1.0)
    if abs(left[worst, direction]) > _IMBALANCE * weight:
        load = float((left**2).sum() / left[worst, direction])
        unit = "N" if direction < 3 else "N m"
        raise WheelsetError(
            f"{vehicle.name} cannot stand: {vehicle.parts[worst].name!r} is out of balance by "
            f"{load:.4g} {unit} in {_DIRECTIONS[direction]}, against which it "
            "has no spring: add one, or give the preload that balances it"
        )
    deepest = int(np.argmax(np.abs(sunk[:, 2])))
    if abs(sunk[deepest, 2]) > _DEEPEST:
        raise WheelsetError(
            f"{vehicle.name} cannot stand: {vehicle.parts[deepest].name!r} sinks by "
            f"{-sunk[deepest, 2]:.3g} m under its load (at most {_DEEPEST:g} m): are the vertical "
            "stiffnesses below it given in N/m? 1 kN/mm is 1e6 N/m"
        )
