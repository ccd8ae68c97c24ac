"""What `create_wheelset` refuses: each with the value, its range and the mend."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_wheelset.checking import number, numbers, warn
from exudyn_wheelset.contact.changing_rails import rails_change
from exudyn_wheelset.contact.descriptions import Contact, Track, Wheelset
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.coupling.elastic_rails import RailElasticity
from exudyn_wheelset.coupling.guidance import Guidance
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.geometry.gap import least_gap
from exudyn_wheelset.track.irregularity import Irregularity

# Rail vehicles run up to 160 m/s.
FASTEST = 200.0
# Flanges touch their rails some 0.1 m before and behind the middle of the contact: with a play of
# 7 mm on either side a wheelset cannot yaw by more than 0.07 rad between its rails.
LARGEST_YAW = 0.1
# Vertical depth [m] of a wheel in its rail: 1 mm across a flank of 70 degrees, which presses with
# some thirty times a wheel load of 80 kN; on a tread more than any wheel has.
DEEPEST = 3.0e-3


def check_kinds(mbs: Any, wheelset: Any, track: Any, contact: Any) -> None:
    """Raise WheelsetError where an argument is not of its kind, or two have changed places."""
    wanted = (
        ("mbs", mbs, exu.MainSystem, "Exudyn's system, SC.AddSystem()"),
        (
            "wheelset",
            wheelset,
            Wheelset,
            "a Wheelset(mass=..., wheel=..., ...)",
        ),
        ("track", track, Track, 'a Track("UIC60")'),
        ("contact", contact, Contact | None, "a Contact(friction=0.4), or its numbers by keyword"),
    )
    for what, value, kind, example in wanted:
        if not isinstance(value, kind):
            raise WheelsetError(
                f"{what} is a {type(value).__name__}: give {example}; the order is "
                "create_wheelset(mbs, wheelset, track, ...)"
            )


def check_place(
    guidance: Guidance, position: Any, height: float | None, lateral_offset: Any, yaw: Any
) -> None:
    """Raise WheelsetError for a place that is not on the rails, and for what is no number."""
    _, y = numbers("position (x, y)", position, 2, "m")
    low, high = -guidance.shift[1], guidance.shift[0]
    mend = "beyond, its flange is no longer inside the rail; is it given in metres?"
    number("lateral_offset", lateral_offset, "m", low, high, mend)
    number("position y + lateral_offset", y + lateral_offset, "m", low, high, mend)
    number(
        "yaw", yaw, "rad", -LARGEST_YAW, LARGEST_YAW,
        "a wheelset cannot yaw farther between its rails; is it given in radians?",
    )  # fmt: skip
    if height is not None:
        number("height", height, "m", -0.1, 0.1, "it counts from `radius` above the rails' tops")


def warn_of_depth(wheelset: Wheelset, track: Track, y: float, height: float, yaw: float) -> None:
    """Warn of a level wheelset at y, `height` above its radius [m], that begins inside a rail."""
    table = contact_tables(wheelset, track)
    across, along = np.sin(yaw), np.cos(yaw)
    for hand, (side, sign) in enumerate((("left", 1.0), ("right", -1.0))):
        gap = least_gap(table, hand, sign * y, -sign * across, along, 0.0)[0]
        depth = -gap - wheelset.radius - height
        if np.isfinite(depth) and depth > DEEPEST:
            warn(
                f"{1e3 * y:g} mm aside the {side} wheel begins {1e3 * depth:.1f} mm inside its "
                f"rail (more than {1e3 * DEEPEST:g} mm), which throws the wheelset off: give a "
                "smaller lateral_offset, or a height at which it is free of the rails"
            )


def check_motion(speed: Any, gravity: Any, switches: Mapping[str, Any]) -> None:
    """Raise WheelsetError for speeds and weights out of range, and for switches that are none."""
    number("speed", speed, "m/s", -FASTEST, FASTEST, "is it given in m/s?")
    number("gravity", gravity, "m/s^2", 0.0, 100.0, "positive is downwards")
    for what, value in switches.items():
        if not isinstance(value, bool | np.bool_):
            raise WheelsetError(f"{what} = {value!r}: give True or False")


def check_rails(irregularity: Any, rail_elasticity: Any, track: Track) -> None:
    """Raise WheelsetError for rails that do not say how they lie."""
    if not isinstance(rail_elasticity, RailElasticity | None):
        raise WheelsetError(
            f"rail_elasticity = {rail_elasticity!r}: give a RailElasticity(...) or leave it out"
        )
    if rail_elasticity is not None and rails_change(track):
        raise WheelsetError(
            "rail_elasticity on rails that change along the track: give one of the two, elastic "
            "rails or sections"
        )
    if not isinstance(irregularity, Irregularity | None):
        raise WheelsetError(
            f"irregularity = {irregularity!r}: give an Irregularity, from_psd, from_points or "
            "from_functions"
        )
