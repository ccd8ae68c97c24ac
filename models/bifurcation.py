"""Bifurcation diagram of a vehicle: hunting amplitude over speed, stable and unstable.

Run `python models/bifurcation.py --vehicle s1002`; names are those of the catalogue.
It is the command `exudyn-wheelset hunt` as a script: what it prints with `--json`, what `--descent`
and `--disturbance` add and what lands under `--out` stand in exudyn_wheelset/front/command/hunt.py.
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
