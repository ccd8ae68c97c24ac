"""Coefficient of friction of a patch: that of its rail and zone, falling with slip.

    mu = mu_0 ((1 - A) exp(-B w) + A),     w = V hypot(xi_x, xi_y) [m/s],

w the slip velocity in the patch without spin, as in Polach 2005 (creep/polach_2005.py), whatever
the creep law: mu is one number for a patch, the limit mu N of each law. A = 1 is constant friction.

Zones are told by the contact angle d, which is the one thing that top, gauge corner and flange
differ in on every pair of profiles:

    top of rail   |d| up to 0.1 rad: the running band, where friction modifiers lie
    tread         from 0.2 to 0.3 rad: towards the gauge corner, and all that is not said otherwise
    flange        from 0.5 rad on: flange and throat on the gauge face, which lubricators wet

with cubic ramps between, so that forces have no step where a patch wanders from one to the next.
A rail of one coefficient has it everywhere, to the last bit.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled

TREAD, FLANGE, TOP = 0, 1, 2
# Angles [rad] between which the friction goes over from top to tread, and from tread to flange.
TOP_TO, TREAD_FROM = 0.1, 0.2
TREAD_TO, FLANGE_FROM = 0.3, 0.5


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _ramp(x, low, high):
    """From 0 at low to 1 at high without a step in the slope."""
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def patch_friction(parameters, hand, angle, slip_velocity):
    """Coefficient of a patch of contact angle [rad] that slips [m/s]; hand 0 is left, 1 right."""
    of_rail = parameters.friction[hand]
    friction = of_rail[TREAD]
    if of_rail[TOP] != friction:
        friction += (1.0 - _ramp(abs(angle), TOP_TO, TREAD_FROM)) * (of_rail[TOP] - friction)
    if of_rail[FLANGE] != of_rail[TREAD]:
        share = _ramp(abs(angle), TREAD_TO, FLANGE_FROM)
        friction += share * (of_rail[FLANGE] - friction)
    ratio = parameters.friction_ratio
    if ratio < 1.0:
        friction *= (1.0 - ratio) * math.exp(-parameters.friction_decay * slip_velocity) + ratio
    return friction


def frictions(contact: Any) -> np.ndarray:
    """Coefficients (2, 3) of a Contact at no slip: left and right rail; tread, flange, top."""
    left = [contact.friction] * 3
    right = [contact.friction if contact.right_friction is None else contact.right_friction] * 3
    for zone, both, own in (
        (FLANGE, contact.flange_friction, contact.right_flange_friction),
        (TOP, contact.top_friction, contact.right_top_friction),
    ):
        if both is not None:
            left[zone] = right[zone] = both
        if own is not None:
            right[zone] = own
    return np.array([left, right])
