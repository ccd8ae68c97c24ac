"""Does a vehicle hunt at a speed if it is thrown hard enough? Large starts of several kinds.

A large cycle, at the flange, may have a narrow basin beside that of the straight run: a motion
that is too small dies out, and so may one that is too large or has the wrong phase. So the vehicle
starts from its equilibrium with

- lateral velocities of all wheelsets, as a blow gives them, which meet the flange at their own
  depth without a start inside the rail;
- its hunting mode, which has the right phase between wheelsets and yaw;
- lateral displacements of all wheelsets, alternating from one to the next, where there are several;
- an orbit that is known at a higher speed: hunting that goes on where the branch of that orbit ends
  or loses its stability, in another shape, lives where no motion from rest may lead.

Starts from which the vehicle derails are passed over, and told of. Displacements in scales
(millimetres), velocities in m/s.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.descent import mode_disturbance
from exudyn_wheelset.stability.hunting.orbit import Orbit
from exudyn_wheelset.stability.hunting.settling import Settling, WatchedMotion
from exudyn_wheelset.stability.hunting.watching import typical_period, watched_trucks
from exudyn_wheelset.stability.linear.linearisation import linearised
from exudyn_wheelset.systems.system import DynamicSystem

# Flange clearances are 5 to 12 mm; a blow of 0.5 m/s set off the S1002 wheelset's flange cycle
# (docs/hunting.md), and 1 m/s carries a wheelset across the clearance in a tenth of its period.
BLOWS = (0.6, 1.0, 0.3)
MODES = (5.0, 10.0)
SHIFTS = (6.0,)


def large_starts(system: DynamicSystem, speed: float) -> Iterator[tuple[str, Array]]:
    """What each start is, in words, and its state (n,)."""
    linear = linearised(system, speed)
    rest = linear.state
    lateral = list(system.lateral_indices)
    found = [_rate_of(linear.jacobian, index) for index in lateral]
    rates = [index for index in found if index is not None]
    kinds = [("mode", size) for size in MODES] + [("shift", size) for size in SHIFTS]
    if lateral and len(rates) == len(lateral):
        kinds = [
            ("blow", BLOWS[0]),
            ("mode", MODES[0]),
            *(("blow", size) for size in BLOWS[1:]),
            *kinds[1:],
        ]
    for kind, size in kinds:
        state = rest.copy()
        if kind == "blow":
            state[rates] += size
            yield f"a blow of {size:g} m/s", state
        elif kind == "mode":
            yield (
                f"the hunting mode, {size:g} scales large",
                mode_disturbance(system, speed, size),
            )
        elif len(lateral) > 1:
            signs = (-1.0) ** np.arange(len(lateral))
            state[lateral] += size * system.scales[lateral] * signs
            yield f"shifts of {size:g} scales to either side", state


def hunting_at(
    system: DynamicSystem,
    speed: float,
    settling: Settling,
    smallest: float,
    orbits: Sequence[Orbit] = (),
    lost: list[str] | None = None,
) -> tuple[str, WatchedMotion] | None:
    """The first large start whose motion goes on hunting, and that motion; None if none does.

    smallest: amplitude, in scales, from which a motion is called hunting; orbits: whose motions,
    brought to the speed [m/s], are starts as well, the first ones; lost: takes in words the starts
    from which the vehicle derails.
    """
    lost = [] if lost is None else lost
    watched = watched_trucks(system)
    try:
        period = typical_period(system, speed)
        slowed = [
            (
                f"the orbit at {orbit.speed:.4g} m/s",
                system.carry_over(orbit.states[0], orbit.speed, speed),
            )
            for orbit in orbits
        ]
        starts = [*slowed, *large_starts(system, speed)]
    except AnalysisError as error:
        lost.append(f"none could be tried at {speed:.4g} m/s: {error}")
        return None
    settling = replace(settling, rest=max(settling.rest, smallest))
    system = system.rough()
    for words, state in starts:
        motion = WatchedMotion(system, speed, state, period, watched, settling)
        verdict = motion.decide()
        if verdict is Ending.CONTACT_LOST:
            hunted = f" after hunting for {motion.time:.2g} s" if motion.cycles else ""
            lost.append(f"{words} ends in {verdict.sentence} at {speed:.4g} m/s{hunted}")
        if verdict in (Ending.DIED_OUT, Ending.CONTACT_LOST):
            continue
        sizes = motion.truck_amplitudes()
        if any(sizes[k] >= smallest * system.scales[index] for k, index in watched.items()):
            return words, motion
    return None


def _rate_of(jacobian: Array, index: int) -> int | None:
    """The state that is the rate of state `index`: x_i' = x_j, if there is one."""
    others = np.flatnonzero(np.abs(jacobian[index]) > 1e-6 * np.abs(jacobian[index]).max())
    if len(others) == 1 and abs(jacobian[index, others[0]] - 1.0) < 1e-6:
        return int(others[0])
    return None
