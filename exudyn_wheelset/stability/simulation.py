"""`simulate` as the package gives it: of whatever the analyses take, a name of the catalogue too.

The catalogue stands above the systems, so that the runner below (systems/simulation.py) knows
vehicles and models only.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.subject import named
from exudyn_wheelset.systems import simulation

Function = TypeVar("Function", bound=Callable[..., Any])


def _by_name(function: Function) -> Function:
    """The function of a vehicle, which takes a name of the catalogue in its place."""

    @wraps(function)
    def call(vehicle: Any, *arguments: Any, **options: Any) -> Any:
        return function(named(vehicle), *arguments, **options)

    # Pickle looks for it where it is.
    call.__module__ = __name__
    return call  # type: ignore[return-value]


simulate = spelt(_by_name(simulation.simulate))
