"""At which speed does each truck of a vehicle stop hunting? By descent, and by continuation.

The descent judges every truck by itself and takes motion that beats, as two trucks do whose
frequencies differ. The branch of limit cycles from the Hopf point holds the motion that is
periodic: one truck that hunts while the other is carried along, or both in step. A truck's speed
is that of the fold of the periodic motion in which it hunts, where the descent comes to the same
speed, to AGREEMENT: the fold is exact, a descent lingers beside it, and shows that motion stays on
the orbit where multipliers leave that open. Where the descent goes on below, hunting that beats
outlives the periodic one, and its number stays. Speeds in m/s.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.descent_result import Descent
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.nonlinear import nonlinear_critical_speed
from exudyn_wheelset.stability.linear.crossings import CriticalPoint
from exudyn_wheelset.stability.linear.modes import ALONE, truck_motion
from exudyn_wheelset.systems.system import DynamicSystem

Method = Literal["descent", "continuation"]

# Ends of the branch in Hopf speeds, and orbits on it.
RANGE, POINTS = (0.9, 1.1), 90
AGREEMENT = 5e-3


@dataclass(frozen=True, eq=False)
class TruckSpeeds:
    """Speeds [m/s] at which trucks stop hunting; under "" for a vehicle without trucks.

    speeds    by truck
    methods   which of the two gave each
    descents  by descent alone, by truck
    folds     lowest speed of periodic motion in which a truck hunts, by truck, if any
    how       in words, by method
    descent   simulated down to the last jump
    branch    from the Hopf point; None where there is none
    """

    speeds: dict[str, float]
    methods: dict[str, Method]
    descents: dict[str, float]
    folds: dict[str, float]
    how: dict[str, str]
    descent: Descent
    branch: Branch | None

    def numbers(self) -> dict[str, Any]:
        """by_truck [m/s], by_truck_method, the speeds of both methods, and how, for a script."""
        return {
            "by_truck": self.speeds,
            "by_truck_method": self.methods,
            "by_truck_descent": self.descents,
            "by_truck_continuation": self.folds,
            **self.how,
        }


def truck_speeds(
    system: DynamicSystem, hopf: CriticalPoint, *, progress: bool = False
) -> TruckSpeeds:
    """Speeds at which each truck stops hunting, by descent and by the branch of the Hopf point.

    Raises AnalysisError where hunting has no lower end in the descent's range.
    """
    found = nonlinear_critical_speed(system, "descent", hopf=hopf, progress=progress)
    descent = found.branch
    assert isinstance(descent, Descent)
    descents = dict(found.by_truck or {"": found.speed})
    how = {"descent": found.how}
    folds: dict[str, float] = {}
    branch = None
    ends = (RANGE[0] * hopf.speed, RANGE[1] * hopf.speed)
    try:
        branch = limit_cycles(system, hopf, ends, maximum_points=POINTS, progress=progress)
        folds = lowest_by_truck(system, branch)
        how["continuation"] = f"a branch of {len(branch)} orbits, which ends: {branch.reason}"
    except AnalysisError as error:
        how["continuation"] = f"no branch of limit cycles: {error}"
    speeds, methods = dict(descents), dict.fromkeys(descents, "descent")
    for truck, speed in descents.items():
        fold = folds.get(truck, np.inf)
        if abs(fold - speed) <= AGREEMENT * speed:
            speeds[truck], methods[truck] = fold, "continuation"
    return TruckSpeeds(speeds, methods, descents, folds, how, descent, branch)  # type: ignore[arg-type]


def lowest_by_truck(system: DynamicSystem, branch: Branch) -> dict[str, float]:
    """Lowest speed [m/s] of an orbit of the branch in which a truck hunts, by truck.

    A truck hunts that moves at least half as much as the one that moves most. Orbits that are
    unstable for certain are left out; where the orbit lies beside a fold, the fold counts. Under ""
    for a system without trucks; trucks that hunt nowhere are left out.
    """
    found: dict[str, tuple[float, int]] = {}
    for index in map(int, np.flatnonzero(branch.stable | branch.uncertain)):
        motion = truck_motion(system, branch.orbits[index].half_peak_to_peak()) or {"": 1.0}
        largest = max(motion.values())
        for truck, size in motion.items():
            speed = float(branch.speed[index])
            if size >= ALONE * largest and speed < found.get(truck, (np.inf, 0))[0]:
                found[truck] = speed, index
    lowest = {}
    for truck, (speed, index) in found.items():
        beside = [float(f) for f in branch.folds if abs(f.index - index) <= 1 and f <= speed]
        lowest[truck] = min([speed, *beside])
    return lowest
