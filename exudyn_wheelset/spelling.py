"""Calls with a misspelt or a missing argument: an error of the package that offers the near name.

Python's own TypeError says that a keyword is unexpected, not which one was meant. The functions
and classes marked here cost nothing more where the call is right.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, TypeVar

from exudyn_wheelset.checking import refuse_options
from exudyn_wheelset.errors import WheelsetError

Function = TypeVar("Function", bound=Callable[..., Any])
Class = TypeVar("Class", bound=type)


def spelt(function: Function) -> Function:
    """The function, whose callers are told of an argument that it does not have or that they miss.

    Raises WheelsetError with the nearest name, or with the names of what is missing.
    """

    @wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        try:
            return function(*arguments, **named)
        except TypeError:
            _refuse(function, function.__name__, arguments, named)
            raise

    return call  # type: ignore[return-value]


def spelt_class(cls: Class) -> Class:
    """The class, whose callers are told as those of a function by `spelt`."""
    made: Any = cls
    make = made.__init__

    @wraps(make)
    def __init__(self: Any, *arguments: Any, **named: Any) -> None:
        try:
            make(self, *arguments, **named)
        except TypeError:
            _refuse(make, cls.__name__, (self, *arguments), named)
            raise

    made.__init__ = __init__
    return cls


def _refuse(
    function: Callable[..., Any], name: str, arguments: tuple[Any, ...], named: Mapping[str, Any]
) -> None:
    """Raise WheelsetError if the arguments do not fit the function."""
    signature = inspect.signature(function)
    kinds = [parameter.kind for parameter in signature.parameters.values()]
    if inspect.Parameter.VAR_KEYWORD not in kinds:
        refuse_options(function, [key for key in named if key not in signature.parameters])
    try:
        signature.bind(*arguments, **named)
    except TypeError as error:
        takes = ", ".join(key for key in signature.parameters if key not in ("self", "cls"))
        raise WheelsetError(f"{name}: {error}; it takes {takes}") from None
