"""One wheelset on its rails under given loads of both wheels, rolling straight ahead.

The rails' wrench about the wheelset's centre, with its creep forces at steady rolling, must carry
the loads: F_z and M_x as asked, F_y = 0 (no spring pushes sideways), M_y = 0 (a free axle is
neither driven nor braked). Four equations for height, roll, shift and spin; on like wheels under
like loads shift and roll vanish and two are left.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.optimize import brentq

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.contact.descriptions import Contact, Track, Wheelset
from exudyn_wheelset.contact.forces_apart import wheelset_forces
from exudyn_wheelset.contact.layout import Axle, Velocity, new_result
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.contact.wheelset_contact import contact_parameters
from exudyn_wheelset.coupling.wheel_forces import wheel_force
from exudyn_wheelset.errors import ContactError
from exudyn_wheelset.geometry.rigid import ContactGeometry, contact_geometry
from exudyn_wheelset.profiles import Profile

# Creepages, and so the forces of a wheelset in steady rolling, do not depend on the speed.
_SPEED = 10.0
_DEEPEST = 0.01
_STEPS = np.array([1e-8, 1e-8, 1e-6, 1e-7])


@dataclass(frozen=True)
class AxleRest:
    """A wheelset at rest beside its rolling.

    height [m] of the centre above the radius over the rail tops; shift y [m] and roll [rad];
    radius [m]: V over the spin; wrench (6) [N, N m] of the rails; wheel_loads (2) [N]: vertical,
    left and right.
    """

    height: float
    shift: float
    roll: float
    radius: float
    wrench: Array
    wheel_loads: tuple[float, float]


class RailWrench:
    """Wrench of the rails on a wheelset that rolls straight ahead, over its pose."""

    def __init__(self, wheelset: Wheelset, track: Track, contact: Contact) -> None:
        self._table = contact_tables(wheelset, track)
        self._parameters = contact_parameters(contact)
        self._result = new_result()
        self._motion = np.zeros(12)

    def __call__(self, pose: Array, yaw: float = 0.0) -> tuple[Array, tuple[float, float]]:
        """Wrench (6) and vertical wheel loads (2) at (height, roll, shift, radius) [m, rad]."""
        height, roll, shift, radius = pose.tolist()
        spin, level = _SPEED / radius, math.cos(roll)
        axis = (-math.sin(yaw) * level, math.cos(yaw) * level, math.sin(roll))
        velocity = Velocity(_SPEED, 0.0, 0.0, spin * axis[0], spin * axis[1], spin * axis[2])
        result = self._result
        axle = Axle(shift, height, *axis)
        wheelset_forces(self._table, axle, velocity, self._motion, self._parameters, result)
        loads = [float(wheel_force(result, hand)[1]) for hand in range(2)]
        return result[:6].copy(), (loads[0], loads[1])


def level_contact(wheelset: Wheelset, track: Track) -> ContactGeometry:
    """Rigid contact of a wheelset in the middle; raises ContactError where there is none."""
    return _level_contact(shape_of(wheelset), track)


def shape_of(wheelset: Wheelset) -> Wheelset:
    """A wheelset of the same shape, one for all masses: tables of contact are built once for it."""
    return _shape(
        _Same(wheelset.wheel),
        wheelset.radius,
        wheelset.tape_half_distance,
        _Same(wheelset.right_wheel),
        wheelset.right_radius,
    )


@lru_cache(maxsize=64)
def _level_contact(wheelset: Wheelset, track: Track) -> ContactGeometry:
    return contact_geometry(wheelset, track, [0.0])


class _Same:
    """A profile as the key of a cache: the same object."""

    def __init__(self, profile: Profile | None) -> None:
        self.profile = profile

    def __hash__(self) -> int:
        return id(self.profile)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and other.profile is self.profile


@lru_cache(maxsize=64)
def _shape(
    wheel: _Same, radius: float, tape: float, right: _Same, right_radius: float | None
) -> Wheelset:
    assert wheel.profile is not None
    inertia = (1.0, 1.0, 1.0)
    return Wheelset(1.0, inertia, radius, wheel.profile, tape, right.profile, right_radius)


def rest_on_rails(
    wheelset: Wheelset,
    track: Track,
    contact: Contact,
    loads: Array,
    driven: bool = False,
    near: AxleRest | None = None,
) -> AxleRest:
    """Where the wheelset rolls straight ahead under vertical loads (left, right) [N].

    A driven one has the spin V/radius of its drive. Where no shift balances unlike loads (cones),
    it stays in the middle. near: a like wheelset at rest, to begin with. Raises ContactError where
    the rails do not carry it.
    """
    wheelset = shape_of(wheelset)
    geometry = _level_contact(wheelset, track)
    half = wheelset.tape_half_distance
    arms = (half + geometry.left.wheel_y[0], -half - geometry.right.wheel_y[0])
    weight = float(loads[0] + loads[1])
    tipping = float(loads[0] * arms[0] + loads[1] * arms[1])
    if weight <= 0.0 or min(loads) < 0.0:
        raise ContactError(
            f"the wheels carry {loads[0]:.0f} N and {loads[1]:.0f} N: a wheel cannot pull at its "
            "rail; check masses, places and loads"
        )
    radius = 0.5 * (geometry.left.radius[0] + geometry.right.radius[0])
    if driven:
        radius = wheelset.radius
    touching = float(geometry.z[0])

    rails = RailWrench(wheelset, track, contact)
    if near is None:
        depth = _depth(rails, touching, radius, weight)
        pose = np.array([touching - depth, 0.0, 0.0, radius])
    else:
        pose = np.array([near.height, near.roll, near.shift, near.radius])
    wrench, _ = rails(pose)
    scale = np.array([weight, weight * half, weight, weight * radius])
    asked = np.array([weight, tipping, 0.0, 0.0])

    def left(trial: Array) -> Array:
        found, _ = rails(trial)
        return np.asarray((found[[2, 3, 1, 4]] - asked) / scale)

    free = [0, 1, 2, 3]
    lopsided = abs(wrench[3] - tipping) > 1e-9 * weight * half or abs(wrench[1]) > 1e-9 * weight
    if not lopsided:
        free = [0, 3]
    if driven:
        free.remove(3)
    solved = _newton(left, pose, free)
    if solved is None and lopsided:
        solved = _newton(left, pose, [k for k in free if k != 2])
    if solved is not None:
        pose = solved
    wrench, wheel_loads = rails(pose)
    height, roll, shift, radius = (float(value) for value in pose)
    return AxleRest(height, shift, roll, radius, wrench, wheel_loads)


def _depth(rails: RailWrench, touching: float, radius: float, weight: float) -> float:
    """How far [m] a wheelset in the middle sinks in under its weight [N] from where it touches."""

    def excess(penetration: float) -> float:
        pose = np.array([touching - penetration, 0.0, 0.0, radius])
        return float(rails(pose)[0][2]) - weight

    # Where one wheel is the larger, it presses alone before both touch.
    lowest, highest = 0.0, 1.0e-4
    while excess(lowest) > 0.0:
        lowest = 2.0 * lowest - 1.0e-4
    while excess(highest) < 0.0:
        highest *= 2.0
        if highest > _DEEPEST:
            raise ContactError(
                f"the rails do not carry {weight:.0f} N of one wheelset: check loads and "
                "shear_modulus"
            )
    return float(brentq(excess, lowest, highest, xtol=1e-14))


def _newton(left: Callable[[Array], Array], pose: Array, free: list[int]) -> Array | None:
    """Root over the entries `free` of a pose, None where there is none nearby."""
    pose = pose.copy()
    if not free:
        return pose
    for _ in range(40):
        value = left(pose)[free]
        slope = np.empty((len(free), len(free)))
        for column, entry in enumerate(free):
            shifted = pose.copy()
            shifted[entry] += _STEPS[entry]
            upper = left(shifted)[free]
            shifted[entry] -= 2.0 * _STEPS[entry]
            slope[:, column] = (upper - left(shifted)[free]) / (2.0 * _STEPS[entry])
        try:
            step = -np.linalg.solve(slope, value)
        except np.linalg.LinAlgError:
            return None
        largest = np.max(np.abs(step) / np.array([1e-4, 1e-3, 1e-3, 1e-3])[free])
        pose[free] += step * min(1.0, 1.0 / largest) if largest > 0.0 else 0.0
        if abs(pose[2]) > 0.01 or not np.all(np.isfinite(pose)):
            return None
        if largest < 1e-9:
            break
    return pose if np.max(np.abs(left(pose)[free])) < 1e-8 else None
