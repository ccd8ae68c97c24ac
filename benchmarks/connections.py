"""Cost of a vehicle's connections, CPU time in one run, turns taken in rotation.

Run `python benchmarks/connections.py`; --json prints the numbers only.

(a) one evaluation of the equations of the DTU car with its connections compiled, over the same car
    on Exudyn's Cartesian springs;
(b) of the Manchester coach with its 16 dampers in series, over the coach without series springs;
(c) seconds simulated per second of CPU, RK44 at 0.5 ms, Polach's law, from a lateral push.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from dataclasses import dataclass, replace
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import ObjectConnectorCartesianSpringDamper

from exudyn_wheelset import Element, catalogue
from exudyn_wheelset.systems.vehicle_system import vehicle_system

EVALUATIONS, TURNS = 4000, 7
SPEED, STEP, STEPS = 40.0, 5.0e-4, 2000


@dataclass(frozen=True)
class ExudynSpring(Element):
    """Exudyn's own spring in place of a compiled one."""

    stiffness: tuple[float, float, float]
    damping: tuple[float, float, float]

    def static_stiffness(self) -> np.ndarray:
        return np.diag([*self.stiffness, 0.0, 0.0, 0.0])

    def create(self, mbs: Any, ends: Any, preload: Any) -> int:
        offset = [f / k if k else 0.0 for f, k in zip(preload[:3], self.stiffness, strict=True)]
        return mbs.AddObject(
            ObjectConnectorCartesianSpringDamper(
                markerNumbers=[end.marker for end in ends],
                stiffness=list(self.stiffness),
                damping=list(self.damping),
                offset=offset,
            )
        )


def on_exudyn_springs(vehicle: Any) -> Any:
    swapped = [
        replace(one, element=ExudynSpring(one.element.stiffness, one.element.damping))
        for one in vehicle.connections
    ]
    return replace(vehicle, connections=tuple(swapped))


def evaluation_time(vehicles: dict[str, Any]) -> dict[str, float]:
    """Least CPU time [s] of one evaluation of each."""
    systems = {name: vehicle_system(vehicle) for name, vehicle in vehicles.items()}
    best = dict.fromkeys(systems, np.inf)
    for _ in range(TURNS):
        for name, system in systems.items():
            state = system.initial_state(SPEED)
            start = time.process_time()
            for _ in range(EVALUATIONS):
                state[1] += 1e-12
                system.derivative(state, SPEED)
            best[name] = min(best[name], (time.process_time() - start) / EVALUATIONS)
    return best


def times_real_time(vehicle: Any) -> float:
    """Seconds simulated per second of CPU by Exudyn's RK44."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    vehicle.create(mbs, SPEED, show=False, sensors=False, lateral_offset=1e-3)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = STEPS
    settings.timeIntegration.endTime = STEPS * STEP
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.explicit.computeEndOfStepAccelerations = False
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    best = np.inf
    for _ in range(3):
        start = time.process_time()
        mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44, showHints=False)
        best = min(best, time.process_time() - start)
    return STEPS * STEP / best


def measure() -> dict[str, float]:
    car = catalogue.dtu_car(creep="polach")
    coach = catalogue.manchester_coach(creep="polach")
    plain = catalogue.manchester_coach(series_stiffness=False, creep="polach")
    times = evaluation_time(
        {"car": car, "springs": on_exudyn_springs(car), "coach": coach, "plain": plain}
    )
    return {
        "car, compiled over Exudyn's springs": times["car"] / times["springs"],
        "coach, dampers in series over plain": times["coach"] / times["plain"],
        "car, times real time": times_real_time(car),
        "coach, times real time": times_real_time(coach),
        "coach without series springs, times real time": times_real_time(plain),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="print the numbers only")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    figures = measure()
    if arguments.json:
        print(json.dumps(figures))
        return
    for name, value in figures.items():
        print(f"{name:50s}{value:8.2f}")


if __name__ == "__main__":
    main()
