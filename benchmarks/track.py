"""Cost of a track that is not straight and smooth, and of rails that give way.

CPU time, RK44 at 0.5 ms, compiled motion of a coach; every figure is the least of some turns taken
in rotation, since machines are shared. Run `python benchmarks/track.py`; --json prints the numbers
only.

(a) the Manchester coach with Polach's law, FASTSIM and the exact law's table: on plain straight
    track, in R = 300 m, out of it over a transition, on rough track, on both, and over a change of
    rails: seconds simulated per second of CPU, and the time over that of plain straight track;
(b) a wheelset on its springs in Exudyn: a step on elastic rails over one on rigid rails.
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import replace
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_wheelset import (
    Curve,
    Irregularity,
    Layout,
    Profile,
    RailElasticity,
    RailSection,
    Straight,
    Transition,
    catalogue,
)
from exudyn_wheelset.catalogue.paper_wheelset import paper_wheelset
from exudyn_wheelset.profiles import shapes
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.systems.curving import follow_rails, stand_at
from exudyn_wheelset.systems.vehicle_system import vehicle_system

SPEED, DURATION = 18.0, 1.5
# Station [m] at which the whole coach stands in the curve.
START = 45.0
STEP = 5.0e-4


def tracks(plain: Any) -> dict[str, Any]:
    """The tracks of (a) by name."""
    curve = Layout([Straight(5.0), Transition(20.0), Curve(300.0, 150.0, 0.12)])
    leaving = Layout([Curve(300.0, START + 15.0, 0.12), Transition(20.0), Straight(50.0)])
    rough = Irregularity.from_psd("ERRI B176 low", 1, length=150.0, fade_in=10.0)
    new = shapes.uic60()
    off = np.clip((-0.010 - new.y) / 0.0255, 0.0, 1.0)
    worn = Profile(name="worn", kind="rail", y=new.y, z=new.z - 1.0e-3 * off**2)
    return {
        "straight": plain,
        "curve": replace(plain, layout=curve),
        "transition": replace(plain, layout=leaving),
        "rough": replace(plain, irregularity=rough),
        "rough curve": replace(plain, layout=curve, irregularity=rough),
        "change of rails": replace(plain, sections=[RailSection(START + 20.0, worn)], blend=20.0),
    }


def coaches(law: str) -> dict[str, Any]:
    """Seconds simulated per second of CPU by track."""
    coach = catalogue.vehicle("manchester_coach", creep=law)
    systems = {name: vehicle_system(coach.on(track)) for name, track in tracks(coach.track).items()}
    starts = {}
    for name, system in systems.items():
        stand_at(system.wheelsets, START, False)
        starts[name] = follow_rails(system, system.equilibrium(SPEED), SPEED, START)
        stand_at(system.wheelsets, START, True)
    best = dict.fromkeys(systems, np.inf)
    times = np.linspace(0.0, DURATION, 101)
    for _ in range(4):
        for name, system in systems.items():
            begin = time.process_time()
            _, outcome = system.carry_on(starts[name], SPEED, times)
            assert outcome.ending is Ending.FINISHED, outcome
            best[name] = min(best[name], time.process_time() - begin)
    return {name: DURATION / cpu for name, cpu in best.items()}


def elastic_rails(steps: int = 1000) -> dict[str, float]:
    """CPU time [us] of a step on rigid and on elastic rails."""
    model = paper_wheelset(1, driven=False)
    run = exu.SimulationSettings()
    run.timeIntegration.numberOfSteps = steps
    run.timeIntegration.endTime = steps * STEP
    run.timeIntegration.verboseMode = 0
    run.timeIntegration.explicit.computeEndOfStepAccelerations = False
    run.solution.file.write = False
    built = {
        name: model.build(30.0, sensors=False, show=False, rail_elasticity=elasticity)
        for name, elasticity in (("rigid", None), ("elastic", RailElasticity()))
    }
    best = dict.fromkeys(built, np.inf)
    for _, mbs, _ in built.values():
        mbs.Assemble()
    for _ in range(5):
        for name, (_, mbs, _) in built.items():
            begin = time.process_time()
            mbs.SolveDynamic(run, solverType=exu.DynamicSolverType.RK44)
            best[name] = min(best[name], 1e6 * (time.process_time() - begin) / steps)
    return best


def measure() -> dict[str, Any]:
    """All numbers."""
    laws = ("polach", "fastsim", "exact-table")
    return {"coach": {law: coaches(law) for law in laws}, "rails": elastic_rails()}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--json", action="store_true", help="print the numbers only")
    found = measure()
    if parser.parse_args().json:
        print(json.dumps(found, indent=2))
        return
    for law, speeds in found["coach"].items():
        for name, speed in speeds.items():
            more = speeds["straight"] / speed
            print(f"{law:12} {name:16} {speed:5.2f} times real time, {more:.2f}")
    rails = found["rails"]
    ratio = rails["elastic"] / rails["rigid"]
    print(f"step: {rails['rigid']:.1f} us rigid, {rails['elastic']:.1f} us elastic: {ratio:.2f}")


if __name__ == "__main__":
    main()
