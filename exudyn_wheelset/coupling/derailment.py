"""When has a wheelset left its rails? Three endings of a motion, the same in every simulation.

Off the rails contact forces mean nothing any more and may even feed energy into the motion. What a
wheelset may do follows from the drawings of its wheels and rails:

    wheel climb  a wheel in contact has risen by half the height of its flange. On S1002 and 60E1
                 the steep part of the flange (70 degrees) ends 20 mm below the tape circle and the
                 rail's corner is steep 9 mm below its top: beyond a rise of 11 mm the rounding of
                 the tip runs on the rail, whose angle falls as the wheel rises, so that nothing
                 brings it back; half a flange of 28 mm is 14 mm.
    lift-off     a wheel without contact has risen as far, and its flange guides no more; or it has
                 been without contact for LIFT_OFF_WAY. 49 CFR 213.333 lets a wheel be unloaded for
                 5 ft (1.5 m). Hunting wheels hop farther: up to 3 m (S1002 wheelset at 150 m/s) and
                 4.2 m (DTU truck at 120 m/s) in motions that go on; a wheel that hovers over four
                 times the 5 ft does not come back by itself.
    lost gauge   the tip of a flange has passed the gauge face of its rail, 22 mm beside the middle
                 for S1002 on 60E1 at 1435 mm, or a wheel has dropped below its rail by half a
                 flange.

guidance.py computes these limits. Places are measured from the rails where they move. Track frame,
SI.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from exudyn_wheelset.coupling.guidance import Guidance
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
from exudyn_wheelset.results.endings import Ending, Outcome

LIFT_OFF_WAY = 6.0


class DerailmentWatch:
    """Looks at wheelsets during a simulation."""

    def __init__(self, contacts: Iterable[WheelRailContact]) -> None:
        self._contacts = list(contacts)
        self.begin(0.0)

    def begin(self, time: float) -> None:
        """Start anew at a time [s]: what was off its rail before does not count."""
        self._time = time
        self._ways = np.zeros((len(self._contacts), 2))

    def look(self, time: float) -> Outcome | None:
        """How the motion ends where a wheelset has left the rails by `time` [s]; else None."""
        elapsed, self._time = time - self._time, time
        for contact, ways in zip(self._contacts, self._ways, strict=True):
            place = contact.stance()
            ending = _judge(place, contact.guidance)
            for hand in range(2):
                touches = place[4 + hand] > 0.0
                ways[hand] = 0.0 if touches else ways[hand] + elapsed * abs(place[6])
            if ending is None and ways.max() > LIFT_OFF_WAY:
                ending = Ending.LIFT_OFF
            if ending is not None:
                return Outcome(ending, _words(contact.name, place, time, contact.station(time)))
        return None


def _judge(place: np.ndarray, limits: Guidance) -> Ending | None:
    if not np.all(np.isfinite(place[:4])):
        return None
    for hand, side in enumerate((1.0, -1.0)):
        shift, rise, touches = side * place[hand], place[2 + hand], place[4 + hand] > 0.0
        if shift > limits.shift[hand] or rise < -limits.drop[hand]:
            return Ending.LOST_GAUGE
        if rise > limits.rise[hand]:
            return Ending.WHEEL_CLIMB if touches else Ending.LIFT_OFF
    return None


def _words(name: str, place: np.ndarray, time: float, station: float) -> str:
    return (
        f"{name} at {time:.3f} s, {station:.1f} m along the track, stands at y = "
        f"{place[0] * 1e3:.1f} mm, its left wheel {place[2] * 1e3:.1f} mm and its "
        f"right wheel {place[3] * 1e3:.1f} mm above the rails, "
        f"with {place[4]:.0f} patches on the left and {place[5]:.0f} on the right"
    )
