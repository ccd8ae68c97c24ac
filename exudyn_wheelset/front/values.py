"""Numbers and ranges as words of the command line: "0.3", "0.1,0.3", "0:0.01:21"."""

from __future__ import annotations

import argparse
import glob
import math
from typing import Any

import numpy as np

MOST_VALUES = 100_000


def values_of(text: str) -> list[float]:
    """Numbers from one of them, several with commas between, or LOW:HIGH:COUNT."""
    parts = text.split(":")
    try:
        if len(parts) == 3:
            low, high, count = float(parts[0]), float(parts[1]), int(parts[2])
            if not 2 <= count <= MOST_VALUES:
                raise ValueError
            found = [float(value) for value in np.linspace(low, high, count)]
        elif len(parts) == 1:
            found = [float(part) for part in text.split(",")]
        else:
            raise ValueError
    except ValueError:
        found = []
    if not found or not all(map(math.isfinite, found)):
        raise argparse.ArgumentTypeError(
            f"{text!r}; give a number, several such as 0.1,0.3, or a range LOW:HIGH:COUNT, finite "
            f"and with 2 to {MOST_VALUES} numbers"
        )
    return found


def range_of(text: str) -> tuple[str, tuple[float, float]]:
    """A name and its range from NAME=LOW:HIGH."""
    name, given, ends = text.partition("=")
    try:
        low, high = map(float, ends.split(":"))
        right = bool(given) and bool(name.strip()) and -math.inf < low < high < math.inf
    except ValueError:
        right = False
    if not right:
        raise argparse.ArgumentTypeError(
            f"{text!r}; give a name and its range, the lower end first: conicity=0.02:0.2"
        )
    return name.strip(), (low, high)


def axis_of(text: str) -> tuple[str, list[Any]]:
    """A name and its values: NAME=0.1,0.3, NAME=LOW:HIGH:COUNT, words, files NAME=FOLDER/*.whl."""
    name, given, words = text.partition("=")
    if not given or not name.strip() or not words.strip():
        raise argparse.ArgumentTypeError(
            f"{text!r}; give a name and its values: friction=0.1,0.3 or gauge=1.432:1.438:7"
        )
    if any(sign in words for sign in "*?["):
        found: list[Any] = sorted(glob.glob(words))
        if not found:
            raise argparse.ArgumentTypeError(f"{text!r}; no file is named like that")
        return name.strip(), found
    try:
        return name.strip(), list(values_of(words))
    except argparse.ArgumentTypeError:
        if ":" in words or any(sign.isdigit() for sign in words.split(",")[0][:1]):
            raise
        return name.strip(), [word.strip() for word in words.split(",")]
