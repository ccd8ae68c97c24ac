"""Bifurcation diagram of a vehicle: hunting amplitude over speed, stable and unstable.

Run `python models/bifurcation.py --vehicle s1002`; names are those of the catalogue. From the Hopf
point, where the straight run loses stability, the branch of limit cycles is followed through its
folds (continuation). With `--json` it prints only its numbers:

    hopf                      speeds at which an oscillation loses or regains stability [m/s]
    folds                     speeds at which the branch turns [m/s], in its order
    nonlinear_critical_speed  lowest speed with a stable limit cycle [m/s]; None if there is none
    method                    what made the numbers
    points, seconds, reason   orbits on the branch, time of the continuation, why the branch ends

`--descent` adds hunting simulated at falling speed down to its jump, `--disturbance` the smallest
one-off lateral blow (a velocity) that leads to it; both come onto the same figure. It shows
the unstable branch dashed: a motion that stays below it dies out, one beyond it hunts.

Figure and data land under `--out`, named after the vehicle and what was changed of it. The data
files (.npz) hold settings, parameters, versions and method; `--redraw FILE ...` draws them again.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from exudyn_wheelset.front.command.hunt import add_options, compute, redraw, show
from exudyn_wheelset.front.script import run_script, script_parser

__all__ = ["compute", "main", "parser", "redraw"]


def parser() -> argparse.ArgumentParser:
    """Options of the script."""
    made = script_parser(__doc__.splitlines()[0])
    add_options(made)
    return made


def main(argv: Sequence[str] | None = None) -> int:
    """Run the script; exit status."""
    return run_script(compute, parser(), argv, show)


if __name__ == "__main__":
    sys.exit(main())
