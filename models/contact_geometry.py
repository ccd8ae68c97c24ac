"""Rigid contact geometry of a wheelset over its lateral shift: Figure 3 of the paper.

Run `python models/contact_geometry.py` for AAR 1:20 wheels on UIC60 rails at the paper's gauge of
1432 mm and S1002 wheels at 1435 mm, or give a pair: `--wheel my_wheel.txt --rail UIC60
--gauge 1.435`. For each pair under runs/out/: roll angle, height, contact angles and rolling radii
with their piecewise polynomials (figure and CSV), the profiles in contact at a few shifts, and a
comparison of the two ways to find the roll angle.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import Any

from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.command.geometry import (
    Pair,
    add_pair_options,
    examine,
    kept,
    pair,
    results,
    show,
)
from exudyn_wheelset.front.plots import pair_name
from exudyn_wheelset.front.script import profiles_from, run_script, script_parser

__all__ = ["Pair", "default_pairs", "examine", "main", "pair", "run"]
OPTIONS_OF_A_PAIR = ("radius", "tape_half_distance", "half_range")


def default_pairs() -> list[Pair]:
    """The paper's pair and the European one."""
    return [
        pair("AAR_1_20", gauge=1.432, radius=0.3556, half_range=0.012),
        pair("S1002", gauge=1.435, radius=0.46, half_range=0.008),
    ]


def run(pairs: Sequence[Pair] | None = None, progress: bool = False) -> dict[str, Any]:
    """Numbers of each pair by its name: jumps, polynomials, comparison of methods (SI)."""
    found = results(default_pairs() if pairs is None else pairs, progress)
    return {pair_name(one.pair.wheelset, one.pair.track): one.numbers for one in found}


def pairs_from(arguments: argparse.Namespace, parser: argparse.ArgumentParser) -> list[Pair]:
    """The pair that the options name, the script's own pairs where they name none."""
    given = profiles_from(arguments).changes
    own = {name: getattr(arguments, name) for name in OPTIONS_OF_A_PAIR}
    if "wheel" in given:
        return [pair(**given, **own)]
    changed = [*given, *(name for name, value in own.items() if value != parser.get_default(name))]
    if changed:
        options = ", ".join(f"--{name.replace('_', '-')}" for name in changed)
        raise WheelsetError(f"{options} needs a wheel: give --wheel as well")
    return default_pairs()


def main(argv: Sequence[str] | None = None) -> int:
    """Run from the command line; exit status."""
    parser = script_parser(str(__doc__).splitlines()[0], settings=False)
    add_pair_options(parser, defaults=False)

    def work(arguments: argparse.Namespace) -> dict[str, Any]:
        return kept(pairs_from(arguments, parser), arguments)

    return run_script(work, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
