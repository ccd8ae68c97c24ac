"""Adding wheelsets to an Exudyn system: functions that take `mbs` first and return item numbers."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import (
    LoadForceVector,
    LoadTorqueVector,
    MarkerBodyRigid,
    NodeGenericODE1,
    ObjectGenericODE1,
    RigidBodyInertia,
    SensorUserFunction,
)

from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.contact.descriptions import Contact, Track, Wheelset, check_contact_names
from exudyn_wheelset.contact.wheelset_contact import contact_parameters
from exudyn_wheelset.coupling.create_checks import (
    check_kinds,
    check_motion,
    check_place,
    check_rails,
    warn_of_depth,
)
from exudyn_wheelset.coupling.elastic_rails import RailElasticity
from exudyn_wheelset.coupling.guidance import guidance
from exudyn_wheelset.coupling.registration import (
    FirstOrderState,
    WheelsetItems,
    name_states,
    register_wheelset,
    unused_name,
)
from exudyn_wheelset.coupling.track_frame import TrackFrame
from exudyn_wheelset.coupling.wheel_forces import WHEEL_VALUES, wheel_values
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
from exudyn_wheelset.coupling.wheelset_shapes import wheelset_graphics
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.track.irregularity import Irregularity

SENSOR_VALUES = tuple(name for name, _ in WHEEL_VALUES)


@spelt
def create_wheelset(
    mbs: Any,
    wheelset: Wheelset,
    track: Track,
    *,
    position: Sequence[float] = (0.0, 0.0),
    speed: float = 20.0,
    moving_frame: bool = False,
    height: float | None = None,
    lateral_offset: float = 0.0,
    yaw: float = 0.0,
    gravity: float = GRAVITY,
    contact: Contact | None = None,
    normal: str = Contact.normal,
    creep: Any = Contact.creep,
    friction: float = Contact.friction,
    shear_modulus: float = Contact.shear_modulus,
    poisson: float = Contact.poisson,
    damping: float = Contact.damping,
    irregularity: Irregularity | None = None,
    frame: TrackFrame | None = None,
    rail_elasticity: RailElasticity | None = None,
    sensors: bool = True,
    show: bool = True,
    name: str = "wheelset",
    **law_parameters: float,
) -> WheelsetItems:
    """Add a wheelset on profiled rails to `mbs` and return its item numbers.

    position (x, y) [m] of the centre in the reference configuration; speed V [m/s]: it starts
    rolling with the spin V/radius; moving_frame: the model stands in a frame that moves at V
    (springs to Exudyn's ground are then springs to that frame), otherwise the body runs at V
    along x. height [m] of the centre above `radius` over the rail tops (default: 0.1 mm into the
    rails' rigid contact, about the static penetration); lateral_offset [m] and yaw [rad]: initial
    displacement. gravity [m/s^2] downwards. contact: a Contact, or its numbers by keyword
    (normal, creep, friction, shear_modulus, poisson, damping and the law's own parameters).
    irregularity: of the rails, in place of the track's; frame: a TrackFrame that several wheelsets
    share, as those of a vehicle; rail_elasticity: springs and dampers under each rail
    (coupling/elastic_rails.py). name: a number is added to it if the model has such a wheelset
    already.
    Raises WheelsetError for impossible values, ContactError where the wheelset does not meet the
    rails.

    Examples
    --------
    >>> import exudyn as exu
    >>> from exudyn_wheelset import Track, Wheelset, create_wheelset
    >>> mbs = exu.SystemContainer().AddSystem()
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    >>> items = create_wheelset(mbs, axle, Track("UIC60"), speed=40, moving_frame=True)
    >>> items.name, items.body
    ('wheelset', 0)
    """
    check_contact_names(creep, law_parameters, _OWN_OPTIONS)
    check_kinds(mbs, wheelset, track, contact)
    check_motion(speed, gravity, {"moving_frame": moving_frame, "sensors": sensors, "show": show})
    check_place(guidance(wheelset, track), position, height, lateral_offset, yaw)
    check_rails(irregularity, rail_elasticity, track)
    if irregularity is not None:
        track = replace(track, irregularity=irregularity)
    name = unused_name(mbs, name)
    parameters = contact_parameters(
        contact,
        normal=normal,
        creep=creep,
        friction=friction,
        shear_modulus=shear_modulus,
        poisson=poisson,
        damping=damping,
        **law_parameters,
    )
    rails = WheelRailContact(
        wheelset,
        track,
        parameters,
        speed if moving_frame else 0.0,
        frame,
        rail_elasticity,
        name,
    )
    if height is None:
        height = _rest_height(wheelset, track) - 1.0e-4
    warn_of_depth(wheelset, track, position[1] + lateral_offset, height, yaw)
    inertia = RigidBodyInertia(mass=wheelset.mass, inertiaTensor=np.diag(wheelset.inertia))
    cosine, sine = np.cos(yaw), np.sin(yaw)
    spin = speed / wheelset.radius
    created = mbs.CreateRigidBody(
        name=name,
        inertia=inertia,
        nodeType=exu.NodeType.RotationRotationVector,
        referencePosition=[position[0], position[1], wheelset.radius + height],
        initialDisplacement=[0.0, lateral_offset, 0.0],
        initialVelocity=[0.0 if moving_frame else speed, 0.0, 0.0],
        initialRotationMatrix=np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0, 0, 1.0]]),
        initialAngularVelocity=[-spin * sine, spin * cosine, 0.0],
        gravity=[0.0, 0.0, -gravity],
        graphicsDataList=wheelset_graphics(wheelset) if show else [],
        returnDict=True,
    )
    marker = mbs.AddMarker(MarkerBodyRigid(name=f"{name} centre", bodyNumber=created["bodyNumber"]))
    rails.attach(mbs, created["nodeNumber"])
    # Exudyn's stub files know their own callback classes only.
    force_function: Any = rails.load_function(0)
    torque_function: Any = rails.load_function(1)
    force = mbs.AddLoad(
        LoadForceVector(
            name=f"{name} rail force",
            markerNumber=marker,
            loadVectorUserFunction=force_function,
        )
    )
    torque = mbs.AddLoad(
        LoadTorqueVector(
            name=f"{name} rail torque",
            markerNumber=marker,
            loadVectorUserFunction=torque_function,
        )
    )
    if rail_elasticity is not None:
        _create_rails(mbs, rails, name)
    side_sensors: list[int | None] = [None, None]
    if sensors:
        for hand, side in enumerate(("left", "right")):
            side_sensors[hand] = int(
                mbs.AddSensor(
                    SensorUserFunction(
                        name=f"{name} {side} wheel",
                        sensorNumbers=[],
                        factors=[],
                        sensorUserFunction=_sensor(rails, hand),
                        storeInternal=True,
                        writeToFile=False,
                    )
                )
            )
    items = WheelsetItems(
        int(created["nodeNumber"]),
        int(created["bodyNumber"]),
        int(marker),
        int(force),
        int(torque),
        side_sensors[0],
        side_sensors[1],
        rails,
        name,
        moving_frame,
    )
    register_wheelset(force_function, items)
    return items


_OWN_OPTIONS = tuple(
    option
    for option in inspect.signature(create_wheelset).parameters
    if option not in ("mbs", "wheelset", "track", "law_parameters")
)


def _create_rails(mbs: Any, contact: WheelRailContact, name: str) -> None:
    """Add the elastic rails' shifts as first-order coordinates."""
    rails = mbs.AddNode(
        NodeGenericODE1(
            name=f"{name} rails",
            referenceCoordinates=[0.0] * 4,
            initialCoordinates=[0.0] * 4,
            numberOfODE1Coordinates=4,
        )
    )
    rates: Any = contact.rail_function()

    # A rail gives way by a tenth of a millimetre under a wheel.
    name_states(
        rates,
        [
            FirstOrderState(f"{side} {axis}", "m", 1.0e-4)
            for side in ("left", "right")
            for axis in "yz"
        ],
    )
    contact.attach_rails(
        mbs.AddObject(
            ObjectGenericODE1(name=f"{name} rails", nodeNumbers=[rails], rhsUserFunction=rates)
        )
    )


def _rest_height(wheelset: Wheelset, track: Track) -> float:
    from exudyn_wheelset.geometry.rigid import contact_geometry

    return float(contact_geometry(wheelset, track, [0.0]).z[0])


def _sensor(contact: WheelRailContact, hand: int) -> Any:
    """Sensor function of one wheel: SENSOR_VALUES."""
    row = np.empty(len(SENSOR_VALUES))

    def values(mbs: Any, t: float, numbers: Any, factors: Any, configuration: Any) -> list[float]:
        wheel_values(contact.evaluate(mbs, configuration), hand, row)
        return row.tolist()

    return values
