"""`exudyn-wheelset warm-up`: compile the kernels once, after an installation."""

from __future__ import annotations

import argparse
from typing import Any

from exudyn_wheelset.front.warming import warm_up

ABOUT = (
    "Kernels are compiled at their first use and kept in the user's cache folder\n"
    "(NUMBA_CACHE_DIR names another); later starts load them in a moment."
)
EXAMPLES = ("warm-up",)
SETTINGS = False


def add_options(parser: argparse.ArgumentParser) -> None:
    """None of its own."""


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """Seconds that it took."""
    return {"seconds": warm_up(everything=True, progress=not arguments.json)}


def show(numbers: dict[str, Any]) -> None:
    """Print the time."""
    print(f"kernels ready in {numbers['seconds']:.1f} s")
