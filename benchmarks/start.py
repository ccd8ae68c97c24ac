"""How long a program waits before it works: imports, and the first critical speed.

    python benchmarks/start.py [--json] [--cold]

Each in a process of its own, CPU time beyond that of an empty one, the least of several. --cold
compiles the kernels anew in an empty cache folder, as after an installation.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile

SPEED = "from exudyn_wheelset import linear_critical_speed; linear_critical_speed({!r}, 15, 150)"
PROGRAMS = {
    "import numpy, scipy, numba, exudyn": "import numpy, scipy, numba, exudyn",
    "import exudyn_wheelset": "import exudyn_wheelset",
    "create_wheelset imported": "from exudyn_wheelset import create_wheelset",
    "critical speed of the truck": SPEED.format("truck"),
    "critical speed of the DTU car": SPEED.format("dtu_car"),
}
COLD = "critical speed of the truck"
TURNS = 5


def seconds(program: str, turns: int = TURNS, **environment: str) -> float:
    """Least CPU time [s] of a program in a process of its own, its children's included."""
    least = float("inf")
    for _ in range(turns):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [sys.executable, "-W", "ignore", "-c", program]
        subprocess.run(command, check=True, env={**os.environ, **environment}, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        least = min(least, used)
    return least


def measure(cold: bool = False) -> dict[str, float]:
    """CPU seconds by name, and those over the imports of the packages that everything rests on."""
    empty = seconds("pass")
    # Whatever is not compiled yet is compiled now.
    seconds(PROGRAMS["critical speed of the DTU car"], 1)
    found = {name: seconds(program) - empty for name, program in PROGRAMS.items()}
    if cold:
        with tempfile.TemporaryDirectory() as folder:
            found[f"{COLD}, kernels compiled"] = seconds(PROGRAMS[COLD], 1, XDG_CACHE_HOME=folder)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--cold", action="store_true", help="compile everything once more")
    arguments = parser.parse_args()
    found = measure(arguments.cold)
    base = next(iter(found.values()))
    if arguments.json:
        print(json.dumps(found))
        return
    for name, used in found.items():
        print(f"{name:48s}{used:8.3f} s{used / base:8.1f} of the first")


if __name__ == "__main__":
    main()
