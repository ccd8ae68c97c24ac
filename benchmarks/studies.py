"""Cost of studies: critical speeds of a truck, one process beside two, and what the study adds.

    python benchmarks/studies.py [--cases 100] [--json]

throughput       of two processes over that of one, from CPU time: 2 x CPU of one/CPU of two, what
                 two free cores give; starting the processes counts
overhead         CPU of the study beyond that of its cases, in one process, relative to them
seconds_a_case   CPU of one linear critical speed of the two-axle truck, the vehicle made anew
ten_thousand     [s] such cases on two cores, from the cases that were run, without the start
Aims: throughput 1.8, overhead 5 %, 10^4 in 240 s.
"""

from __future__ import annotations

import argparse
import json
import resource
import sys
import time
import warnings
from typing import Any

from exudyn_wheelset import linear_critical_speed, study
from exudyn_wheelset.stability.subject import description_of
from exudyn_wheelset.studies import latin_hypercube

RANGES = {"friction": (0.15, 0.5), "stiffness": (0.5, 2.0)}
_TRUCK = description_of("truck")


def truck(case: dict[str, Any]) -> dict[str, float]:
    """Critical speed [m/s] of the truck with a friction and a factor of its stiffnesses along."""
    begun = time.process_time()
    primary = next(c.name for c in _TRUCK.connections if hasattr(c.element, "stiffness"))
    path = f"connections.{primary}.stiffness.x"
    value = next(c for c in _TRUCK.connections if c.name == primary).element.stiffness[0]
    changed = _TRUCK.replace("contact.friction", case["friction"])
    changed = changed.replace(path, case["stiffness"] * value)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = linear_critical_speed(changed, 10.0, 120.0)
    return {"speed": found.speed, "cpu": time.process_time() - begun}


def cpu() -> float:
    """CPU time [s] of this process and its finished children."""
    parts = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(part.ru_utime + part.ru_stime for part in parts)


def run(cases: int) -> dict[str, float]:
    """The figures above."""
    truck({"friction": 0.3, "stiffness": 1.0})
    rows = latin_hypercube(cases, RANGES, seed=1)
    begun = cpu()
    alone = study(truck, rows, executor=1, progress=False)
    one = cpu() - begun
    begun = cpu()
    study(truck, rows, executor=2, progress=False)
    two = cpu() - begun
    inside = float(sum(alone.table["cpu"]))
    return {
        "cases": cases,
        "failed": len(alone.failed),
        "throughput": 2.0 * one / two,
        "overhead": one / inside - 1.0,
        "seconds_a_case": inside / cases,
        "ten_thousand": 1e4 * inside / cases / 2.0,
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    figures = run(options.cases)
    if options.json:
        json.dump(figures, sys.stdout)
    else:
        for name, value in figures.items():
            print(f"{name:16} {value:.4g}")
