"""Cost of a whole bifurcation diagram, against the descent that finds the same fold.

    python benchmarks/bifurcation.py [--vehicles bogie reference wheelset] [--json]

For each vehicle, in one run and after compilation: Hopf point and branch of limit cycles through
the fold to 1.3 times the linear critical speed (points, seconds, right-hand sides); quasi-static
descent from 1.05 times the linear speed that resolves the jump to 0.1 m/s, once in steps of 0.1
m/s all the way and once in larger steps with bisection; the ratios of their times. Then two
branches of the bogie with different conicity, one after the other and in two processes: ratio of
throughput. Aims: wheelset 10 s and 40 points, bogie 20 s, ratio 10 to the descent in steps,
throughput 1.8. On a shared machine the ratios carry, not the seconds.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

# Before numpy is loaded, here and in the worker processes: the matrices are small.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

from concurrent.futures import ProcessPoolExecutor  # noqa: E402
from multiprocessing import get_context  # noqa: E402

from exudyn_wheelset.catalogue.cooperrider_bogie import (  # noqa: E402
    CooperriderBogie,
    cooperrider_system,
)
from exudyn_wheelset.catalogue.cooperrider_reference import (  # noqa: E402
    cooperrider_reference_system,
)
from exudyn_wheelset.catalogue.wheelset_on_frame import Suspension, WheelsetOnFrame  # noqa: E402
from exudyn_wheelset.contact.descriptions import Track, Wheelset  # noqa: E402
from exudyn_wheelset.stability.hunting.descent import quasi_static_descent  # noqa: E402
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles  # noqa: E402
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed  # noqa: E402
from exudyn_wheelset.systems.system import DynamicSystem  # noqa: E402

RESOLUTION = 0.1


def _wheelset() -> DynamicSystem:
    """New S1002 wheels on UIC60 rails 1:40, 12 t axle load, soft springs to the frame."""
    vehicle = WheelsetOnFrame(
        Wheelset(mass=1500.0, inertia=(800.0, 120.0, 800.0), radius=0.46, wheel="S1002"),
        Track(rail="UIC60"),
        Suspension(half_distance=1.0, stiffness=(4e5, 4e5, 1e5), damping=(2e3, 2e3, 1e3)),
        axle_load=120e3,
        contact={"damping": 1.0, "friction": 0.3},
    )
    # Flange impacts ask for shorter steps than the tread, in simulation alone.
    return vehicle.dynamic_system(step=2e-4)


VEHICLES: dict[str, Callable[[], DynamicSystem]] = {
    "bogie": cooperrider_system,
    "reference": cooperrider_reference_system,
    "wheelset": _wheelset,
}
SEARCHED = {"bogie": (20.0, 120.0), "reference": (20.0, 120.0), "wheelset": (15.0, 80.0)}


def measure_vehicle(name: str) -> dict[str, Any]:
    """Times of diagram and descents of one vehicle, and what they found."""
    system = VEHICLES[name]()
    hopf = linear_critical_speed(system, *SEARCHED[name])
    speeds = (0.5 * hopf.speed, 1.3 * hopf.speed)
    limit_cycles(system, hopf, speeds, maximum_points=2)
    begun = time.perf_counter()
    linear_critical_speed(system, *SEARCHED[name])
    branch = limit_cycles(system, hopf, speeds)
    seconds = time.perf_counter() - begun
    result: dict[str, Any] = {
        "hopf": hopf.speed,
        "folds": [fold.speed for fold in branch.folds],
        "reason": branch.reason,
        "points": len(branch),
        "diagram_seconds": seconds,
        "right_hand_sides": branch.record["cost"]["right_hand_sides"],
        "microseconds_per_right_hand_side": _right_hand_side(system, hopf),
    }
    # From the cycle that ends at the lowest fold, a little above the linear speed.
    lowest = min(branch.folds).index if branch.folds else 0
    later = [i for i in range(lowest, len(branch)) if branch.stable[i]]
    start = branch.orbits[min(later, key=lambda i: abs(branch.speed[i] - 1.05 * hopf.speed))]
    for label, step in (("steps", RESOLUTION), ("bisection", 0.01 * hopf.speed)):
        begun = time.perf_counter()
        descent = quasi_static_descent(
            system,
            float(start.speed),
            0.7 * hopf.speed,
            step=step,
            tolerance=RESOLUTION,
            state=start.states[0],
        )
        result[f"descent_by_{label}_seconds"] = time.perf_counter() - begun
        result[f"descent_by_{label}_speed"] = descent.speed
        result[f"descent_by_{label}_reason"] = descent.reason
        result[f"descent_by_{label}_simulated_seconds"] = descent.time
        result[f"ratio_to_descent_by_{label}"] = result[f"descent_by_{label}_seconds"] / seconds
    return result


def _right_hand_side(system: DynamicSystem, hopf: Any, calls: int = 2000) -> float:
    begun = time.perf_counter()
    for _ in range(calls):
        system.derivative(hopf.state, hopf.speed)
    return (time.perf_counter() - begun) / calls * 1e6


def bogie_branch(conicity: float) -> tuple[float, float]:
    """Fold of the bogie with a conicity, and the time of its branch [s]."""
    begun = time.perf_counter()
    system = cooperrider_system(replace(CooperriderBogie(), conicity=conicity))
    hopf = linear_critical_speed(system, 20.0, 150.0)
    branch = limit_cycles(system, hopf, (0.7 * hopf.speed, 1.3 * hopf.speed))
    return float(branch.folds[0]), time.perf_counter() - begun


def measure_processes(branches: int = 4) -> dict[str, Any]:
    """Throughput of independent branches in two processes over that in one."""
    conicities = [0.045 + 0.002 * index for index in range(branches)]
    seconds = {}
    for workers in (1, 2):
        # Fresh interpreters: Exudyn's global state and numpy's threads are not forked.
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            list(pool.map(bogie_branch, [0.05] * workers * 2))
            begun = time.perf_counter()
            list(pool.map(bogie_branch, conicities))
            seconds[workers] = time.perf_counter() - begun
    return {
        "branches": branches,
        "one_process_seconds": seconds[1],
        "two_processes_seconds": seconds[2],
        "throughput_ratio": seconds[1] / seconds[2],
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--vehicles", nargs="*", choices=VEHICLES, default=list(VEHICLES))
    parser.add_argument("--processes", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("--json", action="store_true", help="print only numbers, as JSON")
    arguments = parser.parse_args()
    results: dict[str, Any] = {name: measure_vehicle(name) for name in arguments.vehicles}
    if arguments.processes:
        results["processes"] = measure_processes()
    if arguments.json:
        print(json.dumps(results))
        return
    for name, result in results.items():
        print(name)
        for key, value in result.items():
            shown = f"{value:.4g}" if isinstance(value, float) else value
            print(f"    {key.replace('_', ' '):40} {shown}")


if __name__ == "__main__":
    main()
