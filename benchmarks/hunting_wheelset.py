"""Cost of a wheelset's whole bifurcation diagram, beside the descent that finds the same fold.

    python benchmarks/hunting_wheelset.py [--vehicle s1002] [--profile] [--json]

One run, after compilation. Diagram: Hopf point, branch through its folds to 1.3 times the linear
critical speed. Descents: from the diagram's upper end, where hunting is simulated from a large
disturbance, down to the jump at the lowest fold, known to 0.1 m/s in the end; in steps of 0.1 m/s
all the way, and in steps of 1 % of the linear speed with bisection of the jump. Two processes:
four branches with different friction, one after the other and two at a time.
`--profile` lists where the diagram's time goes. Aims: 40 orbits, 10 s, ratio to the descent 10,
throughput 1.8. On a shared machine the ratios carry, not the seconds.
"""

from __future__ import annotations

import argparse
import cProfile
import json
import os
import pstats
import time
from typing import Any

# Before numpy is loaded, here and in the worker processes: the matrices are small.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

from concurrent.futures import ProcessPoolExecutor  # noqa: E402
from multiprocessing import get_context  # noqa: E402

from exudyn_wheelset.catalogue.by_name import entry, vehicle_system  # noqa: E402
from exudyn_wheelset.stability.hunting.branch import Branch  # noqa: E402
from exudyn_wheelset.stability.hunting.descent import quasi_static_descent  # noqa: E402
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles  # noqa: E402
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed  # noqa: E402
from exudyn_wheelset.stability.linear.crossings import CriticalPoint  # noqa: E402
from exudyn_wheelset.systems.system import DynamicSystem  # noqa: E402

RESOLUTION = 0.1
FRICTIONS = (0.30, 0.32, 0.34, 0.36)
# Disturbance that starts hunting at the flange, in millimetres of the critical mode.
LARGE = 6.5


def diagram(name: str, system: DynamicSystem) -> tuple[CriticalPoint, Branch]:
    """Hopf point and branch of a vehicle."""
    hopf = linear_critical_speed(system, *entry(name).searched)
    return hopf, limit_cycles(system, hopf, (0.5 * hopf.speed, 1.3 * hopf.speed))


def measure_diagram(name: str, system: DynamicSystem) -> tuple[dict[str, Any], Branch]:
    """Time and counts of the diagram, after a first run that compiles."""
    hopf = linear_critical_speed(system, *entry(name).searched)
    limit_cycles(system, hopf, (0.5 * hopf.speed, 1.3 * hopf.speed), maximum_points=2)
    begun = time.perf_counter()
    hopf, branch = diagram(name, system)
    seconds = time.perf_counter() - begun
    calls = branch.record["cost"]["right_hand_sides"]
    single = _microseconds(system, branch)
    return {
        "hopf": hopf.speed,
        "folds": [fold.speed for fold in branch.folds],
        "reason": branch.reason,
        "points": len(branch),
        "seconds": seconds,
        "derivative_calls": calls,
        "microseconds_per_derivative": single,
        "share_of_derivatives": calls * single * 1e-6 / seconds,
    }, branch


def _microseconds(system: DynamicSystem, branch: Branch, rounds: int = 3) -> float:
    """Time of a derivative [us] over the states of the largest orbit, best of some rounds."""
    orbit = branch.orbits[-1]
    taken = []
    for _ in range(rounds):
        begun = time.perf_counter()
        for _ in range(10):
            system.derivatives(orbit.states, orbit.speed)
        taken.append((time.perf_counter() - begun) / (10 * len(orbit.states)) * 1e6)
    return min(taken)


def measure_descents(system: DynamicSystem, branch: Branch, hopf: float) -> dict[str, Any]:
    """Times of the descents that know the jump at the lowest fold to 0.1 m/s."""
    fold = min((fold for fold in branch.folds if fold.side == "lowest"), key=float)
    found: dict[str, Any] = {"fold": fold.speed}
    for label, step in (("bisection", 0.01 * hopf), ("steps", RESOLUTION)):
        begun = time.perf_counter()
        descent = quasi_static_descent(
            system,
            1.3 * hopf,
            0.9 * fold.speed,
            step=step,
            tolerance=RESOLUTION,
            disturbance=LARGE,
        )
        found[f"by_{label}_seconds"] = time.perf_counter() - begun
        found[f"by_{label}_speed"] = descent.speed
        found[f"by_{label}_speeds_run"] = len(descent.speeds)
        found[f"by_{label}_simulated_seconds"] = descent.time
    return found


def branch_with_friction(arguments: tuple[str, float]) -> int:
    """Number of orbits on the branch of a vehicle with a friction: the work of one process."""
    name, friction = arguments
    system = vehicle_system(name, friction=friction)
    return len(diagram(name, system)[1])


def measure_processes(name: str) -> dict[str, Any]:
    """Throughput of independent branches in two processes over that in one."""
    work = [(name, friction) for friction in FRICTIONS]
    seconds, orbits = {}, {}
    for workers in (1, 2):
        # Fresh interpreters: Exudyn's global state and numpy's threads are not forked.
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            list(pool.map(_ready, [name] * (2 * workers)))
            begun = time.perf_counter()
            orbits[workers] = list(pool.map(branch_with_friction, work))
            seconds[workers] = time.perf_counter() - begun
    return {
        "orbits": orbits[2],
        "one_process_seconds": seconds[1],
        "two_processes_seconds": seconds[2],
        "throughput_ratio": seconds[1] / seconds[2],
        "load": os.getloadavg()[0],
    }


def _ready(name: str) -> None:
    """Load the compiled kernels."""
    system = vehicle_system(name)
    system.derivative(system.equilibrium(20.0), 20.0)


def profile(name: str, system: DynamicSystem, lines: int = 20) -> None:
    """Print where the diagram's time goes, by each function's own time."""
    watch = cProfile.Profile()
    watch.runcall(diagram, name, system)
    pstats.Stats(watch).strip_dirs().sort_stats("tottime").print_stats(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--vehicle", default="s1002", help="name in the catalogue")
    parser.add_argument("--descents", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("--processes", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("--profile", action="store_true", help="list where the time goes")
    parser.add_argument("--json", action="store_true", help="print only numbers, as JSON")
    arguments = parser.parse_args()
    system = vehicle_system(arguments.vehicle)
    results: dict[str, Any] = {}
    results["diagram"], branch = measure_diagram(arguments.vehicle, system)
    if arguments.descents:
        found = measure_descents(system, branch, results["diagram"]["hopf"])
        for label in ("bisection", "steps"):
            ratio = found[f"by_{label}_seconds"] / results["diagram"]["seconds"]
            found[f"by_{label}_ratio_to_diagram"] = ratio
        results["descents"] = found
    if arguments.processes:
        results["processes"] = measure_processes(arguments.vehicle)
    if arguments.json:
        print(json.dumps(results))
    else:
        for part, numbers in results.items():
            print(part)
            for key, value in numbers.items():
                shown = f"{value:.4g}" if isinstance(value, float) else value
                print(f"    {key.replace('_', ' '):40} {shown}")
    if arguments.profile:
        profile(arguments.vehicle, system)


if __name__ == "__main__":
    main()
