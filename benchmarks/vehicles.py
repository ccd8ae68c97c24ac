"""Cost of simulating vehicles: times faster than real time, and how it grows with the wheelsets.

CPU time, RK44 at 0.5 ms, hunting motion of a few millimetres; every figure is the least of some
turns taken in rotation, since machines are shared. Run `python benchmarks/vehicles.py`; --json
prints the numbers only.

(a) bogie, three-axle truck, DTU car and Manchester coach (its dampers in series with springs) with
    Polach's law, polach-kalker and FASTSIM: seconds simulated per second of CPU;
(b) 1, 2, 4, 8, 16 wheelsets under one body: time of an evaluation over that of one wheelset;
(c) a step of the car without contacts: what Exudyn and the connections need of it.
"""

from __future__ import annotations

import argparse
import json
import time
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_wheelset import catalogue, wheelsets_of
from exudyn_wheelset.catalogue.paper_wheelset import paper_wheelset
from exudyn_wheelset.vehicles.assemble import add_vehicle

STEP = 5.0e-4
SPEED = 40.0


def settings(steps: int) -> exu.SimulationSettings:
    result = exu.SimulationSettings()
    result.timeIntegration.numberOfSteps = steps
    result.timeIntegration.endTime = steps * STEP
    result.timeIntegration.verboseMode = 0
    result.timeIntegration.explicit.computeEndOfStepAccelerations = False
    result.solution.file.write = False
    result.solution.sensors.active = False
    return result


def vehicle(name: str, contacts: bool = True, **changes: Any) -> tuple[Any, Any]:
    """A vehicle of the catalogue in a system of its own, its wheelsets beside the middle."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    described = catalogue.vehicle(name, **changes)
    add_vehicle(mbs, described, SPEED, show=False, sensors=False, lateral_offset=2e-3)
    if not contacts:
        for items in wheelsets_of(mbs):
            for load in (items.force_load, items.torque_load):
                mbs.SetLoadParameter(load, "loadVectorUserFunction", 0)
    return container, mbs


def wheelsets(count: int) -> tuple[Any, Any]:
    """Paper wheelsets on their own springs, side by side in one system."""
    model = paper_wheelset(1, driven=False)
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    for _ in range(count):
        model.create(mbs, SPEED, sensors=False, show=False, lateral_offset=1e-3)
    return container, mbs


def cpu_of_a_step(models: dict[str, tuple[Any, Any]], steps: int, turns: int) -> dict[str, float]:
    """Least CPU time [s] of a step of each model, in rotation."""
    best = dict.fromkeys(models, np.inf)
    run = settings(steps)
    for _, mbs in models.values():
        mbs.Assemble()
    for _ in range(turns):
        for name, (_, mbs) in models.items():
            start = time.process_time()
            mbs.SolveDynamic(run, solverType=exu.DynamicSolverType.RK44)
            best[name] = min(best[name], (time.process_time() - start) / steps)
    return best


def measure(steps: int = 1000, turns: int = 5) -> dict[str, Any]:
    laws = ("polach", "polach-kalker", "fastsim")
    names = ("cooperrider_bogie_3d", "three_axle_truck", "dtu_car", "manchester_coach")
    models = {f"{name}, {law}": vehicle(name, creep=law) for name in names for law in laws}
    models["dtu_car without contacts"] = vehicle("dtu_car", contacts=False)
    counts = (1, 2, 4, 8, 16)
    models |= {f"{count} wheelsets": wheelsets(count) for count in counts}
    steps_of = cpu_of_a_step(models, steps, turns)
    return {
        "times_real_time": {
            name: STEP / value for name, value in steps_of.items() if "wheelsets" not in name
        },
        "over_one_wheelset": {
            str(count): steps_of[f"{count} wheelsets"] / steps_of["1 wheelsets"] for count in counts
        },
        "wheelset_evaluation_in_a_car_us": 1e6
        * (steps_of["dtu_car, polach"] - steps_of["dtu_car without contacts"])
        / 16.0,
        "step_us": {name: 1e6 * value for name, value in steps_of.items()},
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="print the numbers only")
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--turns", type=int, default=5)
    arguments = parser.parse_args()
    numbers = measure(arguments.steps, arguments.turns)
    if arguments.json:
        print(json.dumps(numbers))
        return
    for group, values in numbers.items():
        print(group)
        for name, value in values.items() if isinstance(values, dict) else [("", values)]:
            print(f"    {name:32s} {value:10.3f}")


if __name__ == "__main__":
    main()
