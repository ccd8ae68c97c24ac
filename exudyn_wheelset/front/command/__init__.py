"""The console command: `exudyn-wheelset TASK`, one task a module.

A task's module has ABOUT (one line), EXAMPLES (shown by --help), SETTINGS (whether it takes
Exudyn's solver settings), `add_options(parser)`, `compute(arguments)`, which returns the numbers
and writes files only where --out names a folder, and `show(numbers)`, which prints them for people.
The scripts in models/ use the same functions.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any

PROG = "exudyn-wheelset"
TASKS = {
    "geometry": "rigid contact of wheels and rails over the lateral shift",
    "conicity": "equivalent conicity by EN 15302 over the amplitude",
    "creep": "creep forces of one or several laws over creepage or spin",
    "stability": "wheel loads, modes, linear critical speeds",
    "hunt": "bifurcation diagram: limit cycles, folds, the nonlinear critical speed",
    "map": "critical speeds over speed and a number of the vehicle",
    "study": "critical speeds and conicity of many vehicles, on all cores",
    "simulate": "a motion in time: shifts, wheel forces, how it ends",
    "film": "a simulated motion as a film, or the vehicle as a picture",
    "info": "versions and names; or what a vehicle, profile or creep law is",
    "warm-up": "compile the kernels now, once",
}
_DESCRIPTION = "Profiled wheels on profiled rails: contact, creep and hunting of railway vehicles."


def task_parser(task: str) -> argparse.ArgumentParser:
    """The options of one task."""
    module = _module(task)
    from exudyn_wheelset.front.script import add_common_options

    examples = "\n".join(f"  {PROG} {line}" for line in module.EXAMPLES)
    parser = argparse.ArgumentParser(
        prog=f"{PROG} {task}",
        description=f"{TASKS[task][0].upper()}{TASKS[task][1:]}.\n\n{module.ABOUT}",
        epilog=f"examples:\n{examples}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add_common_options(parser, settings=module.SETTINGS)
    module.add_options(parser)
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run a task of the command line `argv`; the exit status.

    0; 2 for what cannot be done, said in one line; 130 after Ctrl-C.
    """
    words = list(sys.argv[1:] if argv is None else argv)
    parser = argparse.ArgumentParser(
        prog=PROG,
        description=_DESCRIPTION,
        epilog="tasks:\n"
        + "\n".join(f"  {task:10} {about}" for task, about in TASKS.items())
        + f"\n\n`{PROG} TASK --help` shows the options of a task, with examples.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="store_true", help="print the version")
    parser.add_argument("task", nargs="?", choices=TASKS, metavar="TASK", help="what to do")
    arguments = parser.parse_args(words[:1])
    if arguments.version:
        from exudyn_wheelset.results.versions import versions

        print(f"{PROG} {versions()['exudyn_wheelset']}")
        return 0
    if arguments.task is None:
        parser.print_help()
        return 2
    from exudyn_wheelset.front.script import run_parsed

    options = task_parser(arguments.task)
    module = _module(arguments.task)
    return run_parsed(module.compute, options.parse_args(words[1:]), options.prog, module.show)


def _module(task: str) -> Any:
    return import_module(f"{__name__}.{task.replace('-', '_')}")
