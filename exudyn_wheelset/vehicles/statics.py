"""How a vehicle stands on its rails: wheel loads, preloads of its connections, places of all parts.

In a vehicle that is drawn loaded (`preload="drawing"`) the preloads at the drawn positions balance
every body (balance.py); with `preload="free"` the connections are without force in the drawing, but
for their offset, and the place of all bodies is found (rest.py).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import warn
from exudyn_wheelset.errors import VehicleError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.rest import accelerations, find_rest

# Acceleration [m/s^2, rad/s^2] from which a vehicle does not stand.
NOT_AT_REST = 1.0e-3


class WheelLoads(NamedTuple):
    """Vertical forces of the rails [N] on the left and the right wheel."""

    left: float
    right: float


@brief
@dataclass(frozen=True)
class StaticEquilibrium:
    """A vehicle at rest against the track while its wheelsets roll straight ahead.

    wheel_loads: of each wheelset by name; residual: greatest acceleration left of any part
    [m/s^2, rad/s^2], from forces summed anew by the kernels of the simulation; preloads: force
    [N] and moment [N m] (6) of each connection on its upper body, track frame, by name; positions:
    centres (x, y, z) [m] and rotations: rotation vectors (3) [rad] of all parts by name; radii:
    rolling radius V/spin [m] of each wheelset; pull [N]: forward force on the heaviest part that
    keeps the speed of a vehicle that rolls freely and whose wheels drive or brake, else 0.
    """

    wheel_loads: Mapping[str, WheelLoads]
    residual: float
    preloads: Mapping[str, tuple[float, ...]]
    positions: Mapping[str, tuple[float, float, float]]
    rotations: Mapping[str, tuple[float, float, float]]
    radii: Mapping[str, float]
    pull: float = 0.0


@spelt
def static_equilibrium(vehicle: Vehicle) -> StaticEquilibrium:
    """How the vehicle stands: wheel loads, preloads, places of all parts.

    Raises WheelsetError for a vehicle that cannot stand, with the body, the direction and the
    newtons, and ContactError for a wheelset that its rails do not carry. A vehicle that does not
    come to rest (flanges that rest on rails without play, wheelsets that steer away) is told of by
    a WheelsetWarning.

    Examples
    --------
    >>> from exudyn_wheelset import catalogue, static_equilibrium
    >>> rest = static_equilibrium(catalogue.vehicle("dtu_car"))
    >>> [round(load / 1e3, 1) for load in rest.wheel_loads["front leading"]]  # [kN]
    [66.6, 66.6]
    """
    check_described(vehicle)
    rest = find_rest(vehicle)
    parts = vehicle.parts
    left = np.abs(accelerations(vehicle, rest))
    if left.max() > NOT_AT_REST:
        worst = parts[int(np.argmax(left.max(axis=1)))].name
        warn(
            f"{vehicle.name}: {worst!r} is left with {left.max():.3g} m/s^2 (or rad/s^2) where it "
            f"is drawn (limit {NOT_AT_REST:g}), and no place of rest was found nearby: check the "
            "play of the flanges (gauge, tape_half_distance) and bodies beside the middle"
        )
    preloads: dict[str, Array] = {}
    moved = (rest.pose - rest.drawn).ravel()
    for strut, drawn in zip(rest.struts, rest.preloads, strict=True):
        name = strut.connection.name
        force = drawn.copy()
        if strut.known is None or vehicle.preload == "free":
            force -= strut.stiffness @ strut.lever(rest.centres) @ moved
        preloads[name] = preloads.get(name, np.zeros(6)) + force
    places = rest.centres + rest.pose[:, :3]
    frozen = MappingProxyType
    return StaticEquilibrium(
        wheel_loads=frozen(
            {
                axle.name: WheelLoads(*at_rest.wheel_loads)
                for axle, at_rest in zip(vehicle.wheelsets, rest.axles, strict=True)
            }
        ),
        residual=float(left.max()),
        preloads=frozen({name: tuple(map(float, value)) for name, value in preloads.items()}),
        positions=frozen({part.name: _three(p) for part, p in zip(parts, places, strict=True)}),
        rotations=frozen(
            {part.name: _three(p[3:]) for part, p in zip(parts, rest.pose, strict=True)}
        ),
        radii=frozen(
            {
                axle.name: at_rest.radius
                for axle, at_rest in zip(vehicle.wheelsets, rest.axles, strict=True)
            }
        ),
        pull=rest.pull,
    )


@spelt
def with_free_lengths(vehicle: Vehicle) -> Vehicle:
    """The same vehicle described by free lengths: it settles to where it was drawn.

    Each connection's offset [m] becomes its preload [N] over its stiffness, where it has any.
    Raises WheelsetError for a vehicle that does not stand.

    Examples
    --------
    >>> from exudyn_wheelset import catalogue, with_free_lengths
    >>> with_free_lengths(catalogue.vehicle("dtu_car")).preload
    'free'
    """
    check_described(vehicle)
    rest = find_rest(vehicle)
    offsets: dict[str, Array] = {}
    for strut, preload in zip(rest.struts, rest.preloads, strict=True):
        if strut.known is None and strut.stiffness[:3, :3].any():
            offset = np.linalg.lstsq(strut.stiffness[:3, :3], preload[:3], rcond=1e-12)[0]
            offsets[strut.connection.name] = offset
    connections = tuple(
        replace(one, offset=_three(offsets.get(one.name, np.zeros(3))))
        for one in vehicle.connections
    )
    return replace(vehicle, connections=connections, preload="free")


def check_described(vehicle: Any) -> None:
    """Raise VehicleError for what is no description of a vehicle."""
    if not isinstance(vehicle, Vehicle):
        raise VehicleError(
            f"{vehicle!r:.80} is no Vehicle: give one from VehicleBuilder, load_vehicle(path), "
            "catalogue.vehicle(name), or a truck's own by truck.vehicle()"
        )


def _three(values: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return (x, y, z)
