"""Cost of a wheelset's contact inside compiled code: on one patch, and on the motion of a car.

The motion is that of the catalogue's DTU car on S1002 and UIC60, released 2 mm beside the middle at
40 m/s (vehicles.py): poses and velocities of its four wheelsets in every step. CPU time, the least
of some turns; ratios within one run. Run `python benchmarks/contact_kernel.py`; --json prints the
numbers only.
"""

from __future__ import annotations

import argparse
import json
import time

import exudyn as exu
import numpy as np
from numba import njit
from scipy.spatial.transform import Rotation
from vehicles import SPEED, settings, vehicle

from exudyn_wheelset import Track, Wheelset, contact_geometry
from exudyn_wheelset.contact.forces_apart import wheelset_forces
from exudyn_wheelset.contact.layout import RESULT, Axle, Velocity, new_result, side_of
from exudyn_wheelset.contact.search import find_lobes
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.contact.wheelset_contact import contact_parameters
from exudyn_wheelset.coupling.registration import wheelsets_of

TURNS = 12


@njit
def evaluations(table, rows, repeats, rail_motion, parameters, result):
    """Evaluate at all rows (n, 11) of axle and velocity; return patches and lobes in total."""
    patches = 0
    for _ in range(repeats):
        for k in range(len(rows)):
            row = rows[k]
            wheelset_forces(
                table, Axle(row[0], row[1], row[2], row[3], row[4]),
                Velocity(row[5], row[6], row[7], row[8], row[9], row[10]),
                rail_motion, parameters, result,
            )  # fmt: skip
            count = result.view(RESULT)[0].count
            patches += count[0] + count[1]
    return patches


@njit
def searches(table, rows, repeats, result):
    """The search for lobes alone; return their number."""
    work = result.view(RESULT)[0].work
    radius = side_of(table, 0).radius
    lobes = 0
    for _ in range(repeats):
        for k in range(len(rows)):
            row = rows[k]
            for hand in range(2):
                sign = 1.0 - 2.0 * hand
                axle = Axle(sign * row[0], radius + row[1], sign * row[2], row[3], sign * row[4])
                lobes += find_lobes(table, side_of(table, hand), axle, work)
    return lobes


def motion_of_a_car(steps: int = 1500) -> tuple[np.ndarray, np.ndarray]:
    """Table of its wheelsets and rows (n, 11) of axle and velocity."""
    _container, mbs = vehicle("dtu_car")
    contacts = [items.contact for items in wheelsets_of(mbs)]
    rows = []

    def note(mbs, t):
        for contact in contacts:
            memory, reference = contact._memory, contact.reference
            turned = Rotation.from_rotvec(memory[3:6])
            rows.append([
                reference[1] + memory[1], reference[2] + memory[2] - contact.wheelset.radius,
                *turned.apply([0.0, 1.0, 0.0]), SPEED, *memory[7:9], *turned.apply(memory[9:12]),
            ])  # fmt: skip
        return True

    mbs.SetPreStepUserFunction(note)
    mbs.Assemble()
    mbs.SolveDynamic(settings(steps), solverType=exu.DynamicSolverType.RK44)
    return contacts[0].table, np.array(rows[4 * len(contacts) :])


def one_patch() -> tuple[np.ndarray, np.ndarray]:
    """A wheelset of S1002 on UIC60 at y = 3 mm, lowered by 60 um."""
    wheelset = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
    track = Track(rail="UIC60")
    pose = contact_geometry(wheelset, track, [0.003])
    row = [0.003, float(pose.z[0]) - 6e-5, 0.0, 1.0, float(pose.roll[0])]
    rows = np.tile([*row, 20.0, 0.0, 0.0, 0.0, 43.5, 0.0], (1000, 1))
    return contact_tables(wheelset, track), rows


def least_us(work, calls: int) -> float:
    best = np.inf
    for _ in range(TURNS):
        start = time.process_time()
        work()
        best = min(best, time.process_time() - start)
    return 1e6 * best / calls


def measure() -> dict[str, float]:
    numbers: dict[str, float] = {}
    result, at_rest = new_result(), np.zeros(12)
    for name, (table, rows) in (("one patch", one_patch()), ("car", motion_of_a_car())):
        repeats = max(6000 // len(rows), 1)
        calls = repeats * len(rows)
        for creep in ("shen-hedrick-elkins", "polach"):
            parameters = contact_parameters(creep=creep)
            patches = evaluations(table, rows, 1, at_rest, parameters, result)
            numbers[f"{name}, {creep}: us"] = least_us(
                lambda t=table, r=rows, n=repeats, p=parameters: evaluations(
                    t, r, n, at_rest, p, result
                ),
                calls,
            )
        lobes = searches(table, rows, 1, result)
        numbers[f"{name}, search alone: us"] = least_us(
            lambda t=table, r=rows, n=repeats: searches(t, r, n, result), calls
        )
        numbers[f"{name}, lobes"] = lobes / len(rows)
        numbers[f"{name}, patches"] = patches / len(rows)
    return numbers


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    numbers = measure()
    if arguments.json:
        print(json.dumps(numbers))
    else:
        for name, value in numbers.items():
            print(f"{name:36s}{value:10.3f}")


if __name__ == "__main__":
    main()
