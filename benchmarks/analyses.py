"""Cost of the analyses of whole vehicles, in CPU time of one run, and ratios.

Run `python benchmarks/analyses.py`; --json prints the numbers only, --descent adds the slow one.

(a) right-hand side and Jacobian of each vehicle: compiled equations against Exudyn's, and the
    Jacobian body by body against dense differences;
(b) linear critical speed from the description (model built anew each time) and from a guess;
(c) bifurcation diagrams of the S1002 wheelset, the truck and the DTU car: seconds, orbits;
(d) motion of the DTU car: compiled equations and Exudyn's solver, times faster than real time;
(e) the DTU car in one Exudyn object against Exudyn's loads;
(f) with --descent, the DTU car at falling speed in steps of 0.5 m/s.

Every figure but (c) and (f) is the least of some turns, since machines are shared.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from collections.abc import Callable
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import NodeGenericODE2, ObjectGenericODE2

from exudyn_wheelset import (
    ExudynSystem,
    WheelsetWarning,
    catalogue,
    hopf_points,
    limit_cycles,
    linear_critical_speed,
    quasi_static_descent,
)
from exudyn_wheelset.coupling.running import copied_settings
from exudyn_wheelset.systems.system import DynamicSystem, as_system

VEHICLES = ("cooperrider_bogie_3d", "three_axle_truck", "dtu_car", "manchester_coach")
LAWS = ("polach", "exact-table", "fastsim")
SPEED = 35.0


def least(work: Callable[[], Any], turns: int = 5, times: int = 1) -> float:
    """Least CPU time [s] of a call."""
    best = np.inf
    for _ in range(turns):
        begun = time.process_time()
        for _ in range(times):
            work()
        best = min(best, (time.process_time() - begun) / times)
    return best


def evaluations(name: str) -> dict[str, float]:
    """Time [us] of rates and Jacobians at states that change, by compiled equations and Exudyn."""
    system = as_system(catalogue.vehicle(name))
    start = system.initial_state(SPEED)
    noise = np.random.default_rng(1).standard_normal((50, system.size))
    states = start + 0.1 * system.scales * noise

    def rates(of: Callable[..., Any]) -> Callable[[], None]:
        def work() -> None:
            for state in states:
                of(system, state, SPEED)

        return work

    kind = type(system)
    compiled = least(rates(kind.derivative)) / len(states)
    exudyn = least(rates(ExudynSystem.derivative)) / len(states)
    jacobian = least(lambda: system.jacobian(start, SPEED), times=3)
    dense = least(lambda: DynamicSystem.jacobian(system, start, SPEED), turns=2)
    return {
        "states": system.size,
        "rates_us": 1e6 * compiled,
        "exudyn_over_compiled": exudyn / compiled,
        "jacobian_us": 1e6 * jacobian,
        "dense_over_jacobian": dense / jacobian,
        "jacobian_over_rates": jacobian / compiled,
    }


def critical_speeds(name: str) -> dict[str, float]:
    """Time [ms] of a linear critical speed from the description, and from a guess."""
    vehicle = catalogue.vehicle(name)
    found = linear_critical_speed(vehicle, 20.0, 150.0)
    system = as_system(vehicle)
    return {
        "speed": found.speed,
        "cold_ms": 1e3 * least(lambda: linear_critical_speed(vehicle, 20.0, 150.0)),
        "guess_ms": 1e3 * least(lambda: linear_critical_speed(system, 20.0, 150.0, guess=found)),
    }


def diagram(name: str) -> dict[str, float]:
    """Seconds and orbits of a diagram to 1.3 times the Hopf point, Shen-Hedrick-Elkins."""
    system = as_system(catalogue.vehicle(name, creep="shen-hedrick-elkins"))
    first = min(point for point in hopf_points(system, 20.0, 80.0) if point.slope > 0.0)
    begun = time.process_time()
    branch = limit_cycles(system, first, (0.5 * first.speed, 1.3 * first.speed))
    return {"seconds": time.process_time() - begun, "orbits": len(branch.speed)}


def motion(law: str) -> dict[str, float]:
    """How many times faster than real time the DTU car hunts, by both engines."""
    vehicle = catalogue.dtu_car(creep=law)
    times = np.linspace(0.0, 1.0, 251)
    result = {}
    for engine, options in (("compiled", {}), ("exudyn", {"solver_type": "RK44"})):
        system = as_system(vehicle, step=5e-4, **options)
        start = system.initial_state(45.0)
        start[list(system.lateral_indices)] += 2e-3

        def run(system: Any = system, start: Any = start) -> None:
            system.simulate(start, 45.0, times)

        result[engine] = 1.0 / least(run, turns=3)
    return {**result, "compiled_over_exudyn": result["compiled"] / result["exudyn"]}


def one_object(law: str) -> dict[str, float]:
    """The DTU car by Exudyn's loads, and by one object of Exudyn that computes all its forces.

    The object is a generic one of as many coordinates, whose function evaluates the whole car by
    its compiled equations at states of its motion, and hands back zeros: the cost without the car.
    """
    vehicle, step, duration = catalogue.dtu_car(creep=law), 5e-4, 0.5
    loads = as_system(vehicle, step=step, solver_type="RK44")
    whole = as_system(vehicle, step=step)
    start = whole.initial_state(45.0)
    start[list(whole.lateral_indices)] += 2e-3
    states = whole.simulate(start, 45.0, np.arange(1001) * step)
    count = sum(len(loads.mbs.systemData.GetNodeLTGODE2(node)) for node in loads.runner.nodes)
    calls = iter(range(10**9))

    def force(mbs: Any, t: float, item: int, q: Any, q_t: Any) -> Any:
        return 0.0 * whole.compiled.rate(states[next(calls) % 1000])[-count:]

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    zeros = [0.0] * count
    node = mbs.AddNode(
        NodeGenericODE2(
            numberOfODE2Coordinates=count,
            referenceCoordinates=zeros,
            initialCoordinates=zeros,
            initialCoordinates_t=zeros,
        )
    )
    masses = 1e3 * np.eye(count)
    mbs.AddObject(ObjectGenericODE2(nodeNumbers=[node], massMatrix=masses, forceUserFunction=force))
    mbs.Assemble()
    settings = copied_settings(None)
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.numberOfSteps = round(duration / step)

    def run_object() -> None:
        mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)

    times = np.linspace(0.0, duration, 126)
    by_loads = least(lambda: loads.simulate(start, 45.0, times), turns=4)
    compiled = least(lambda: whole.simulate(start, 45.0, times), turns=4)
    return {
        "loads_over_object": by_loads / least(run_object, turns=4),
        "loads_over_compiled": by_loads / compiled,
    }


def descent() -> dict[str, float]:
    """CPU time of descents of the DTU car: through twenty speeds, and to the end of its hunting.

    Tolerances of the step and of the brackets: the first does not bracket jumps any closer.
    """
    system = as_system(catalogue.dtu_car(creep="shen-hedrick-elkins"))
    result = {}
    for name, low, tolerance in (("twenty_speeds", 40.5, 0.5), ("both_jumps", 38.0, 0.05)):
        begun = time.process_time()
        found = quasi_static_descent(system, 50.0, low, step=0.5, tolerance=tolerance)
        result[f"{name}_seconds"] = time.process_time() - begun
        result[f"{name}_kept"] = len(found.speeds)
        result[f"{name}_simulated"] = found.time
        result |= {f"{name}_{truck}": speed for truck, speed in found.by_truck.items()}
    return result


def measure(with_descent: bool = False) -> dict[str, Any]:
    warnings.simplefilter("ignore", WheelsetWarning)
    numbers: dict[str, Any] = {
        "evaluations": {name: evaluations(name) for name in VEHICLES},
        "critical_speeds": {name: critical_speeds(name) for name in VEHICLES},
        "diagrams": {name: diagram(name) for name in ("s1002", "truck", "dtu_car")},
        "motion_of_the_car": {law: motion(law) for law in LAWS},
        "car_in_one_object": {law: one_object(law) for law in LAWS},
    }
    if with_descent:
        numbers["descent_of_the_car"] = {"dtu_car": descent()}
    return numbers


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="print the numbers only")
    parser.add_argument("--descent", action="store_true", help="add a descent: minutes")
    arguments = parser.parse_args()
    numbers = measure(arguments.descent)
    if arguments.json:
        print(json.dumps(numbers))
        return
    for group, rows in numbers.items():
        print(group)
        for name, values in rows.items():
            print(f"    {name:24s}", "  ".join(f"{key} {v:.4g}" for key, v in values.items()))


if __name__ == "__main__":
    main()
