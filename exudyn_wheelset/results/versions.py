"""Versions of everything that a number may depend on."""

from __future__ import annotations

import platform
from functools import cache
from importlib import metadata


@cache
def _installed() -> dict[str, str]:
    found = {"python": platform.python_version()}
    for name, package in (
        ("exudyn_wheelset", "exudyn-wheelset"),
        ("exudyn", "exudyn"),
        ("numpy", "numpy"),
        ("scipy", "scipy"),
        ("numba", "numba"),
    ):
        try:
            found[name] = metadata.version(package)
        except metadata.PackageNotFoundError:
            found[name] = "not installed"
    return found


def versions() -> dict[str, str]:
    """Versions by name: python, exudyn_wheelset, exudyn, numpy, scipy, numba."""
    return dict(_installed())
