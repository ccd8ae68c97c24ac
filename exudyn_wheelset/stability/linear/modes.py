"""What moves in a mode: its name, and whether it is hunting.

A mode is an eigenvector over the states of a system. Displacements are compared in metres, angles
as the displacement they make at one metre. Hunting is a mode in which the wheelsets move
sideways and yaw: its share is

    share = max(|y|, |yaw| 1 m) over the wheelsets / the largest displacement of any body,

1 for a wheelset alone on its rails, 0.5 to 1 in the hunting modes of trucks and cars, below 0.15
in the sway of a body or of frames on their springs, and zero in the longitudinal, vertical and
pitching modes, which a straight symmetric track separates from it. HUNTING_SHARE lies between.

Names come from the labels of the states ("front frame: roll [rad]"). A body sways about an axis
above or below its centre: a point s above the centre moves sideways by y - roll s, so the axis is
at s = y/roll: lower sway if it lies below, upper sway above.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.systems.system import DynamicSystem

# Between the hunting modes (above 0.5) and the lateral modes of bodies on springs (below 0.15)
# of the wheelsets, trucks and cars in the tests.
HUNTING_SHARE = 0.25
# Wheels bounce on the stiffness of their contact at 100 Hz and more, vehicles on springs below 30.
CONTACT_FREQUENCY = 60.0
# A body takes part in the name of a mode if it moves at least this share of the largest motion.
NAMED_SHARE = 0.7
# A truck hunts alone if the others move less than this share of its motion.
ALONE = 0.5

# What is said of a system whose states do not tell bodies and directions.
NAMELESS = "oscillation"

_STATE = re.compile(r"^(?:(?P<body>.*): )?(?P<what>x|y|z|yaw|roll|pitch) \[(?:m|rad)\]$")
_WORDS = {"x": "longitudinal", "z": "bounce", "pitch": "pitch", "yaw": "yaw"}


def displacements(system: DynamicSystem) -> dict[tuple[str, str], int]:
    """Place of each displacement state by (body, what); what is x, y, z, yaw, roll or pitch.

    The body of a system with one body is "". Empty for systems whose names say nothing of it.
    """
    return _places(tuple(system.state_names))


@lru_cache(maxsize=64)
def _places(names: tuple[str, ...]) -> dict[tuple[str, str], int]:
    found: dict[tuple[str, str], int] = {}
    for index, name in enumerate(names):
        match = _STATE.match(name)
        if match:
            found[match["body"] or "", match["what"]] = index
    return found


def wheelset_labels(system: DynamicSystem) -> tuple[str, ...]:
    """Labels of the wheelsets; all bodies that have y and yaw where the system names none."""
    if system.wheelset_names:
        return system.wheelset_names
    places = displacements(system)
    return tuple(body for body, what in places if what == "y" and (body, "yaw") in places)


def hunting_share(system: DynamicSystem, mode: Array) -> float:
    """Share (0 to 1) of the wheelsets' lateral and yaw motion in a mode (n,).

    1 for a system whose states do not say which are wheelsets: a textbook equation.
    """
    places = displacements(system)
    wheelsets = set(wheelset_labels(system))
    hunting = [
        index
        for (body, what), index in places.items()
        if body in wheelsets and what in ("y", "yaw")
    ]
    if not hunting:
        return 1.0
    largest = float(np.max(np.abs(mode[list(places.values())])))
    return float(np.max(np.abs(mode[hunting]))) / largest if largest > 0.0 else 0.0


def is_lateral(system: DynamicSystem, mode: Array) -> bool:
    """Whether bodies move sideways, yaw and roll in a mode (n,), rather than along, up or pitch.

    On a symmetric vehicle a mode is one or the other. Creep feeds energy into the lateral ones
    only, so a lateral mode that grows is hunting whatever body moves most in it.
    """
    places = displacements(system)
    lateral = [i for (_, what), i in places.items() if what in ("y", "yaw", "roll")]
    others = [i for (_, what), i in places.items() if what not in ("y", "yaw", "roll")]
    if not lateral or not others:
        return True
    return float(np.max(np.abs(mode[lateral]))) >= float(np.max(np.abs(mode[others])))


def truck_motion(system: DynamicSystem, mode: Array) -> dict[str, float]:
    """Largest lateral or yaw motion (m or rad at 1 m) of each truck's wheelsets in a mode (n,)."""
    places = displacements(system)
    return {
        truck: max(
            float(np.abs(mode[places[body, what]]))
            for body in wheelsets
            for what in ("y", "yaw")
            if (body, what) in places
        )
        for truck, wheelsets in system.trucks.items()
    }


def lateral_shape(state_names: Sequence[str], mode: Array) -> dict[str, dict[str, float]]:
    """Size [mm, mrad] and phase [deg] of the lateral motions y, yaw and roll in a mode (n,)."""
    return {
        name.split(" [")[0]: {
            "size": float(1e3 * abs(value)),
            "phase": float(np.degrees(np.angle(value))),
        }
        for name, value in zip(state_names, mode, strict=True)
        if name.split(": ")[-1] in ("y [m]", "yaw [rad]", "roll [rad]")
    }


def mode_name(system: DynamicSystem, mode: Array, frequency: float) -> str:
    """Name of a mode (n,) by what moves; frequency [Hz], 0 for a bare real root."""
    places = displacements(system)
    if not places:
        return NAMELESS if frequency > 0.0 else "divergence"
    if hunting_share(system, mode) >= HUNTING_SHARE:
        return _hunting_name(truck_motion(system, mode), len(wheelset_labels(system)))
    motion = {key: abs(mode[index]) for key, index in places.items()}
    largest = max(motion.values())
    (_, leading), _ = max(motion.items(), key=lambda item: item[1])
    bodies = [
        body
        for (body, what), size in motion.items()
        if what == leading and size >= NAMED_SHARE * largest
    ]
    wheelsets = set(wheelset_labels(system))
    on_contact = frequency > CONTACT_FREQUENCY and wheelsets.issuperset(bodies)
    if on_contact and leading in ("z", "roll"):
        return "contact bounce" if leading == "z" else "contact roll"
    word = _WORDS.get(leading) or _sway(mode, places, bodies[0])
    if len(bodies) > 2:
        return f"{'wheelsets' if wheelsets.issuperset(bodies) else 'vehicle'} {word}"
    return f"{' and '.join(bodies)} {word}".strip()


def _sway(mode: Array, places: Mapping[tuple[str, str], int], body: str) -> str:
    if (body, "y") not in places or (body, "roll") not in places:
        return "lateral" if (body, "y") in places else "roll"
    lateral, roll = mode[places[body, "y"]], mode[places[body, "roll"]]
    return "lower sway" if np.real(lateral * np.conj(roll)) < 0.0 else "upper sway"


def _hunting_name(trucks: Mapping[str, float], wheelsets: int) -> str:
    if len(trucks) < 2:
        return "hunting" if wheelsets < 2 else "truck hunting"
    largest = max(trucks.values())
    moving = [name for name, size in trucks.items() if size >= ALONE * largest]
    if len(moving) == len(trucks):
        return "hunting of all trucks"
    return f"{' and '.join(moving)} truck hunting"
