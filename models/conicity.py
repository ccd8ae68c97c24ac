"""Equivalent conicity of a wheelset on its track, with the figure of its contact geometry.

Run `python models/conicity.py --wheel S1002 --rail UIC60 --gauge 1.435`; wheel and rail are names
or profile files. It prints the conicity over the amplitude, and keeps under runs/out/ (or --out)

    conicity_<wheel>_<rail>.png   rolling-radius difference, equivalent conicity, contact angle,
                                  contact positions and the contact-point connection plot
    conicity_<wheel>_<rail>_shifts.csv      contact over the lateral shift, every 0.02 mm
    conicity_<wheel>_<rail>_amplitudes.csv  conicity over the amplitude, every 0.1 mm

All shifts are taken at rail level, where the wheels stand; `--shift axle` takes those of the axle's
centre, `--shift level` leaves roll out. `--json` prints the numbers only: conicity by amplitude in
mm, the value at 3 mm, the position of rest and the shifts at which the flanges touch.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from exudyn_wheelset.front.command.conicity import add_options, compute, run, show
from exudyn_wheelset.front.script import run_script, script_parser

__all__ = ["main", "run", "show"]


def main(argv: Sequence[str] | None = None) -> int:
    """Run from the command line; exit status."""
    parser = script_parser(str(__doc__).splitlines()[0], settings=False)
    add_options(parser)
    return run_script(compute, parser, argv, show)


if __name__ == "__main__":
    sys.exit(main())
