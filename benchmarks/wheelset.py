"""Cost of the wheelset's contact, of a step through Exudyn, and of a linear critical speed.

All ratios are taken within one run, since machines are shared; microseconds are of the machine at
hand. Run `python benchmarks/wheelset.py`; --json prints the numbers only.

(a) one contact evaluation of a wheelset (both wheels: search, Hertz, Polach) against an empty
    compiled function of the same signature called from Python;
(b) one step of the profiled wheelset through Exudyn against the same body on native springs
    only, and against the same with two empty user-function loads (RK44: five evaluations a step);
(c) rigid contact geometry by bracketed root against Nelder-Mead;
(d) linear critical speed from a warm start; compilation and loading of the kernels.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable

import exudyn as exu
import numpy as np
from numba import njit

from exudyn_wheelset import Track, Wheelset, contact_geometry, linear_critical_speed
from exudyn_wheelset.catalogue.paper_wheelset import paper_wheelset
from exudyn_wheelset.contact import layout
from exudyn_wheelset.contact.forces_apart import wheelset_forces
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.contact.wheelset_contact import contact_parameters
from exudyn_wheelset.coupling.create import create_wheelset
from exudyn_wheelset.front.warming import warm_up


@njit(cache=True)
def empty(table, axle, velocity, rail_motion, parameters, result):
    pass


@njit(cache=True)
def repeated(count, table, y, z, lz, speed, rail_motion, parameters, result):
    """Evaluations from compiled code, without Python's call."""
    for _ in range(count):
        axle = layout.Axle(y, z, 0.0, 1.0, lz)
        velocity = layout.Velocity(speed, 0.0, 0.0, 0.0, speed / 0.46, 0.0)
        wheelset_forces(table, axle, velocity, rail_motion, parameters, result)


def least_time(work: Callable[[], object], calls: int, repeats: int = 15) -> float:
    """Shortest time of one of `calls` [s] over some repeats."""
    best = np.inf
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return best / calls


def contact_evaluation() -> dict[str, float]:
    wheelset = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
    track = Track(rail="UIC60")
    table = contact_tables(wheelset, track)
    parameters, result, motion = contact_parameters(), layout.new_result(), np.zeros(12)
    numbers: dict[str, float] = {}
    for name, shift in (("one_patch", 0.003), ("two_patches", 0.0)):
        pose = contact_geometry(wheelset, track, [shift])
        z, lz = float(pose.z[0]) - 6e-5, float(pose.roll[0])
        axle = layout.Axle(shift, z, 0.0, 1.0, lz)
        velocity = layout.Velocity(20.0, 0.0, 0.0, 0.0, 43.5, 0.0)
        arguments = (table, axle, velocity, motion, parameters, result)

        def from_python(function, arguments=arguments):
            for _ in range(1000):
                function(*arguments)

        wheelset_forces(*arguments)
        empty(*arguments)
        repeated(1, table, shift, z, lz, 20.0, motion, parameters, result)
        bare = least_time(lambda: from_python(empty), 1000)
        call = least_time(lambda: from_python(wheelset_forces), 1000)
        inside = least_time(
            lambda shift=shift, z=z, lz=lz: repeated(
                1000, table, shift, z, lz, 20.0, motion, parameters, result
            ),
            1000,
        )
        numbers[f"{name}_patches"] = float(result.view(layout.RESULT)[0]["count"].sum())
        numbers[f"{name}_us"] = 1e6 * inside
        numbers[f"{name}_called_from_python_us"] = 1e6 * call
        numbers["empty_call_us"] = 1e6 * bare
        numbers[f"{name}_over_empty_call"] = call / bare
    return numbers


def _interleaved_steps(systems: list, steps: int = 4000, rounds: int = 25) -> list[float]:
    """Shortest time of an RK44 step [s] of each system, taken in turn: noise comes in spells."""
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = steps * 1e-4
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    for mbs in systems:
        mbs.Assemble()
    best = [np.inf] * len(systems)
    for _ in range(rounds):
        for k, mbs in enumerate(systems):
            start = time.perf_counter()
            mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
            best[k] = min(best[k], (time.perf_counter() - start) / steps)
    return best


def exudyn_step() -> dict[str, float]:
    model = paper_wheelset(1, driven=False)
    containers = []
    container, mbs, _ = model.build(30.0, sensors=False, show=False)
    containers.append(container)

    def springs_only(with_loads: bool):
        system = exu.SystemContainer()
        containers.append(system)
        other = system.AddSystem()
        items = create_wheelset(
            other, model.wheelset, model.track, speed=30.0, moving_frame=True, gravity=0.0,
            sensors=False, show=False,
        )  # fmt: skip

        def nothing(mbs, t, load):
            return [0.0, 0.0, 0.0]

        for number in (items.force_load, items.torque_load):
            other.SetLoadParameter(number, "loadVectorUserFunction", nothing if with_loads else 0)
        ground = other.CreateGround()
        for side in (0.61, -0.61):
            other.CreateCartesianSpringDamper(
                itemNumbers=[ground, items.body],
                localPosition0=[0.0, side, 0.3556],
                localPosition1=[0.0, side, 0.0],
                stiffness=[2.85e5, 1.84e5, 1e6],
                damping=[0.0, 0.0, 1e3],
            )
        return other

    profiled, native, loads = _interleaved_steps([mbs, springs_only(False), springs_only(True)])
    # RK44 evaluates the loads five times a step (counted).
    pair = (loads - native) / 5.0
    return {
        "step_profiled_us": 1e6 * profiled,
        "step_native_us": 1e6 * native,
        "step_empty_loads_us": 1e6 * loads,
        "profiled_over_native": profiled / native,
        "evaluation_over_pair_of_empty_loads": (profiled - native) / 5.0 / pair,
    }


def rigid_geometry() -> dict[str, float]:
    wheelset = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
    track = Track(rail="UIC60")
    y = np.linspace(-0.008, 0.008, 33)
    root = contact_geometry(wheelset, track, y)
    search = contact_geometry(wheelset, track, y, method="nelder-mead")
    fast = least_time(lambda: contact_geometry(wheelset, track, y), len(y))
    slow = least_time(
        lambda: contact_geometry(wheelset, track, y, method="nelder-mead"), len(y), repeats=3
    )
    return {
        "root_us": 1e6 * fast,
        "nelder_mead_us": 1e6 * slow,
        "nelder_mead_over_root": slow / fast,
        "largest_difference_of_roll_rad": float(np.abs(root.roll - search.roll).max()),
    }


def critical_speed() -> dict[str, float]:
    system = paper_wheelset(1, driven=False).dynamic_system()
    known = linear_critical_speed(system, 10.0, 100.0)
    cold = least_time(lambda: linear_critical_speed(system, 10.0, 100.0), 1, repeats=5)
    warm = least_time(lambda: linear_critical_speed(system, 10.0, 100.0, guess=known), 1, repeats=5)
    return {"cold_ms": 1e3 * cold, "warm_ms": 1e3 * warm}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    numbers = {"kernels_ready_s": warm_up()}
    for part in (contact_evaluation, exudyn_step, rigid_geometry, critical_speed):
        numbers.update(part())
    if arguments.json:
        print(json.dumps(numbers))
    else:
        for name, value in numbers.items():
            print(f"{name:42s}{value:12.4g}")


if __name__ == "__main__":
    main()
