"""What every model script shares: --json, --out, --settings, plain errors."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.output import _plain

DEFAULT_OUT = Path("runs") / "out"


def script_parser(description: str, *, settings: bool = True) -> argparse.ArgumentParser:
    """Argument parser with the options common to all model scripts."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.ArgumentDefaultsHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print only the numbers, as JSON")
    parser.add_argument(
        "--out", type=Path, default=DEFAULT_OUT, help="directory for figures and data"
    )
    if settings:
        parser.add_argument(
            "--settings", type=Path, default=None, help="Exudyn solver settings file (JSON)"
        )
    return parser


def run_script(
    run: Callable[[argparse.Namespace], dict[str, Any]],
    parser: argparse.ArgumentParser,
    argv: Sequence[str] | None = None,
    show: Callable[[dict[str, Any]], None] | None = None,
) -> int:
    """Run a script's `run`, print its numbers, turn our errors into one line; exit status.

    show prints the numbers for people; with --json they are printed as one JSON object.
    """
    arguments = parser.parse_args(argv)
    try:
        numbers = run(arguments)
    except WheelsetError as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f"{parser.prog}: interrupted; finished results are kept", file=sys.stderr)
        return 130
    if arguments.json:
        print(json.dumps(numbers, default=_plain))
    elif show is not None:
        show(numbers)
    return 0
