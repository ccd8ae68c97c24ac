"""One wheelset on the track: from pose and velocity to patches and wrench, by the public names.

    wheelset = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
    track = Track(rail="UIC60")
    pose = (0, 0.003, -2.0e-4, 2e-4, 0, 0)
    forces = contact_forces(wheelset, track, pose, velocity=(20, 0, 0, 0, 20 / 0.46, 0))
    forces.left[0].normal_force

Track frame: x forward, y left, z up.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from exudyn_wheelset.contact import layout as kernel
from exudyn_wheelset.contact.descriptions import (
    CONTACT_NUMBERS,
    NORMAL_MODELS,
    Contact,
    Track,
    Wheelset,
    check_contact_names,
)
from exudyn_wheelset.contact.forces_apart import FORCES, wheelset_forces
from exudyn_wheelset.contact.friction import frictions
from exudyn_wheelset.contact.layout import Axle, Patch, Velocity
from exudyn_wheelset.contact.sides_apart import (
    ENERGY_SIDE,
    RITZ_SIDE,
    STRIP_SIDE,
    STRIP_TRACTION,
)
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.creep import creep_law, creep_parameters
from exudyn_wheelset.creep.exact_apart import EXACT_LAW
from exudyn_wheelset.creep.kernel_apart import CREEP
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.spelling import spelt


@brief
@dataclass(frozen=True)
class ContactForces:
    """Forces of the rails on a wheelset, track frame.

    force (3) [N]; moment (3) [N m] about the wheelset's centre; left, right: patches of either
    wheel, from the flange outwards, an empty tuple where a wheel has lifted off.
    """

    force: np.ndarray
    moment: np.ndarray
    left: tuple[Patch, ...]
    right: tuple[Patch, ...]


def contact_parameters(
    contact: Contact | None = None,
    *,
    normal: str = Contact.normal,
    creep: Any = Contact.creep,
    friction: float = Contact.friction,
    shear_modulus: float = Contact.shear_modulus,
    poisson: float = Contact.poisson,
    damping: float = Contact.damping,
    **law_parameters: float,
) -> np.ndarray:
    """Return the kernels' parameter array of a contact, or of one given by keywords (`Contact`).

    Raises WheelsetError for unknown names and impossible values, and where a contact and its
    numbers are both given.
    """
    chosen = one_contact(
        contact,
        normal=normal,
        creep=creep,
        friction=friction,
        shear_modulus=shear_modulus,
        poisson=poisson,
        damping=damping,
        **law_parameters,
    )
    parameters = np.zeros(kernel.PARAMETER_COUNT)
    record = parameters.view(kernel.PARAMETERS)[0]
    for name in ("shear_modulus", "poisson", "damping"):
        record[name] = getattr(chosen, name)
    record["friction"] = frictions(chosen)
    record["friction_ratio"], record["friction_decay"] = chosen.falling_friction
    _get_ready(chosen)
    record["law"] = creep_law(chosen.creep).number
    record["normal"] = NORMAL_MODELS[chosen.normal]
    values = creep_parameters(chosen.creep, **dict(chosen.law_parameters))
    record["law_parameters"][: len(values)] = values
    return parameters


def _get_ready(contact: Contact) -> None:
    """Compile what a contact needs: whoever runs the kernels comes by for their parameters."""
    FORCES.ready()
    CREEP.ready()
    if contact.normal == "ritz":
        RITZ_SIDE.ready()
    if contact.normal == "energy":
        ENERGY_SIDE.ready()
    if contact.normal == "strips":
        STRIP_SIDE.ready()
        STRIP_TRACTION.ready()
    if contact.creep == "exact":
        EXACT_LAW.ready()


def one_contact(contact: Contact | None, **given: Any) -> Contact:
    """The contact, or the one of the keywords `given`; WheelsetError where they contradict."""
    if contact is None:
        return Contact(**given)
    if not isinstance(contact, Contact):
        raise WheelsetError(
            f"contact = {contact!r}: give a Contact, such as Contact(friction=0.4), or its numbers "
            "by keyword"
        )
    for name, value in given.items():
        if name not in CONTACT_NUMBERS or value != getattr(Contact, name):
            raise WheelsetError(
                f"{name} = {value!r} is given beside a contact: put it into the contact, "
                f"Contact({name}={value!r}, ...)"
            )
    return contact


@spelt
def contact_forces(
    wheelset: Wheelset,
    track: Track,
    pose: Sequence[float],
    velocity: Sequence[float],
    normal: str = Contact.normal,
    creep: Any = Contact.creep,
    friction: float = Contact.friction,
    shear_modulus: float = Contact.shear_modulus,
    poisson: float = Contact.poisson,
    damping: float = Contact.damping,
    rail_motion: Sequence[float] | None = None,
    rail_slope: Sequence[float] | None = None,
    contact: Contact | None = None,
    **law_parameters: float,
) -> ContactForces:
    """Return the forces of `track` on `wheelset` in a pose with a velocity.

    pose (x, y, z, roll, pitch, yaw) [m, rad] in the track frame, z from `radius` above the plane
    of the rail tops, orientation Rz(yaw) Rx(roll) Ry(pitch); velocity (vx, vy, vz, wx, wy, wz)
    [m/s, rad/s] of the centre and angular, in track axes; rail_motion (8): lateral and vertical
    shift [m] of the left and of the right rail, then their velocities [m/s], of rails that really
    move (a shaker, elastic rails): crooked rails are at rest. rail_slope (4): lateral and vertical
    slope [-] along the track of the left and of the right rail (contact/forces.py); patches are
    given in axes that follow it. contact: a Contact, or its numbers by keyword.
    Raises WheelsetError for numbers that are not finite, of the wrong count, or unknown names.

    Examples
    --------
    >>> from exudyn_wheelset import Track, Wheelset, contact_forces, contact_geometry
    >>> axle, track = Wheelset(1500, (800, 110, 800), 0.46, "S1002"), Track("UIC60")
    >>> z = contact_geometry(axle, track, 0.0).z[0] - 1e-4  # pressed in by 0.1 mm
    >>> rolling = (20, 0, 0, 0, 20 / 0.46, 0)
    >>> found = contact_forces(axle, track, (0, 0, z, 0, 0, 0), rolling)
    >>> round(found.force[2] / 1e3)  # [kN]
    295
    """
    _, y, z, roll, _, yaw = _numbers("pose (x, y, z, roll, pitch, yaw)", pose, 6)
    motion_of_centre = _numbers("velocity (vx, vy, vz, wx, wy, wz)", velocity, 6)
    motion = np.zeros(12)
    if rail_motion is not None:
        motion[:8] = _numbers("rail_motion", rail_motion, 8)
    if rail_slope is not None:
        motion[8:] = _numbers("rail_slope", rail_slope, 4)
    check_contact_names(creep, law_parameters, ("rail_motion", "rail_slope", "contact"))
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
    cosine = math.cos(roll)
    axle = Axle(y, z, -math.sin(yaw) * cosine, math.cos(yaw) * cosine, math.sin(roll))
    result = kernel.new_result()
    table = contact_tables(wheelset, track)
    wheelset_forces(table, axle, Velocity(*motion_of_centre), motion, parameters, result)
    return read_result(result)


@spelt
def contact_energy(
    wheelset: Wheelset,
    track: Track,
    pose: Sequence[float],
    shear_modulus: float = Contact.shear_modulus,
    poisson: float = Contact.poisson,
    normal: str = "energy",
) -> float:
    """Return the elastic energy [J] that the rails store in a pose, by "energy" or "ritz".

    pose, shear_modulus [Pa], poisson: as in `contact_forces`, whose normal forces with
    that `normal` are minus the gradient of this energy; other normal models have none, a
    WheelsetError. Source: contact/energy.py, contact/ritz.py.

    Examples
    --------
    >>> from exudyn_wheelset import Track, Wheelset, contact_energy, contact_geometry
    >>> axle, track = Wheelset(1500, (800, 110, 800), 0.46, "S1002"), Track("UIC60")
    >>> z = contact_geometry(axle, track, 0.0).z[0]
    >>> round(contact_energy(axle, track, (0, 0, z - 1e-4, 0, 0, 0)))  # pressed in by 0.1 mm [J]
    12
    """
    if normal not in ("energy", "ritz"):
        raise WheelsetError(
            f'normal = {normal!r}: its forces are no gradient; give "energy" or "ritz"'
        )
    forces = contact_forces(
        wheelset, track, pose, (0.0,) * 6, normal=normal, friction=0.0,
        shear_modulus=shear_modulus, poisson=poisson,
    )  # fmt: skip
    return sum(patch.energy for patch in (*forces.left, *forces.right))


def read_result(result: np.ndarray) -> ContactForces:
    """Turn the kernel's result array into named forces and patches."""
    record = result.view(kernel.RESULT)[0]
    left, right = (
        tuple(_patch(patch) for patch in record["patches"][hand, : record["count"][hand]])
        for hand in range(2)
    )
    return ContactForces(record["force"].copy(), record["moment"].copy(), left, right)


def _patch(record: np.record) -> Patch:
    values = {name: np.asarray(record[name]).tolist() for name in kernel.PATCH.names or ()}
    for name in ("position", "normal"):
        values[name] = tuple(values[name])
    return Patch(**values)


def _numbers(what: str, values: Sequence[float], count: int) -> np.ndarray:
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        array = np.zeros(0)
    if array.shape != (count,) or not np.all(np.isfinite(array)):
        raise WheelsetError(f"{what} = {values!r}: give {count} finite numbers, SI and radians")
    return array
