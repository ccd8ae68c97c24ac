"""How far a wheelset can go and still be guided by its rails, from the drawings of both.

A flange guides while its tip is inside the gauge face of its rail and below the rail's top. A wheel
without a flange (a cone) cannot climb: it is off where its tread, or that of the other wheel, ends
beside the rail. Track frame, SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.profiles import Profile

# An inner end of a profile that is nowhere steeper than this slope [-] is a tread and no flange:
# flanks have 60 to 75 degrees, the widest cones in tests 0.5.
FLANK_SLOPE = 1.0
# Half a flange [m] where there is none.
PLAIN_DROP = 0.014


@dataclass(frozen=True)
class Guidance:
    """How far a wheelset may go from its place on the rails, left and right.

    shift [m] towards that side; rise [m] of that side's wheel, infinite without a flange; drop
    [m] of that side's wheel below its rail.
    """

    shift: tuple[float, float]
    rise: tuple[float, float]
    drop: tuple[float, float]


@lru_cache(maxsize=64)
def guidance(wheelset: Wheelset, track: Track) -> Guidance:
    """Limits of a wheelset on a track, from their profiles."""
    left = wheelset.wheel
    right = wheelset.right_wheel or left
    half_gauge, tape = 0.5 * track.gauge, wheelset.tape_half_distance
    shifts, rises, drops = [], [], []
    for own, other in ((left, right), (right, left)):
        height, tip = _flange(own)
        if height > 0.0:
            shifts.append(half_gauge - (tape + tip))
            rises.append(0.5 * height)
            drops.append(0.5 * height)
        else:
            # The other wheel's tread drops off its rail inwards, or this one's ends outside.
            head = track.rail.span[1] - track.rail.span[0]
            inner_end, outer_end = own.span[0], other.span[1]
            shifts.append(min(tape + outer_end - half_gauge, half_gauge + head - tape - inner_end))
            rises.append(np.inf)
            drops.append(PLAIN_DROP)
    return Guidance((shifts[0], shifts[1]), (rises[0], rises[1]), (drops[0], drops[1]))


def _flange(wheel: Profile) -> tuple[float, float]:
    """Height [m] of a wheel's flange below the tape circle, 0 without one; where its tip stands."""
    y = np.linspace(wheel.span[0], 0.0, 2001)
    z = wheel.height(y)
    lowest = int(np.argmin(z))
    if np.max(np.gradient(z, y)) < FLANK_SLOPE:
        return 0.0, float(y[lowest])
    return float(-z[lowest]), float(y[lowest])
