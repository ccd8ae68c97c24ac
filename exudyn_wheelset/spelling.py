"""Calls that do not fit: a misspelt or missing argument, or one that is not of its kind.

Python's own TypeError says that a keyword is unexpected, not which one was meant; and a text where
a track is wanted ends in an error somewhere inside. The functions and classes marked here say which
argument it is, what was given and what is taken: an error of the package, whatever Python's was.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property, wraps
from typing import Any, TypeVar

from exudyn_wheelset.checking import refuse_options
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.kinds import Kind, kind_of

Function = TypeVar("Function", bound=Callable[..., Any])
Class = TypeVar("Class", bound=type)


def spelt(function: Function) -> Function:
    """The function, whose callers are told of an argument that it cannot take or that they miss.

    Raises WheelsetError with the nearest name, with the names of what is missing, or with the value
    and the kind that is taken. An error inside of a call that fits stays what it is.
    """
    face = _Face(function, function.__name__, function.__module__)

    @wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        face.check_objects(arguments, named)
        try:
            return function(*arguments, **named)
        except WheelsetError:
            raise
        except Exception:
            face.check_all(arguments, named)
            raise

    return call  # type: ignore[return-value]


def spelt_class(cls: Class) -> Class:
    """The class, whose callers are told as those of a function by `spelt`."""
    made: Any = cls
    make = made.__init__
    face = _Face(make, cls.__name__, cls.__module__)

    @wraps(make)
    def __init__(self: Any, *arguments: Any, **named: Any) -> None:
        face.check_objects((self, *arguments), named)
        try:
            make(self, *arguments, **named)
        except WheelsetError:
            raise
        except Exception:
            face.check_all((self, *arguments), named)
            raise

    made.__init__ = __init__
    return cls


class _Face:
    """What a function takes, read at its first call: its module then knows all names."""

    def __init__(self, function: Callable[..., Any], name: str, module: str) -> None:
        self._function, self._name, self._module = function, name, module

    def check_objects(self, arguments: tuple[Any, ...], named: Mapping[str, Any]) -> None:
        """Raise WheelsetError for an argument that is not of its kind, plain ones apart."""
        self._check(arguments, named, self._objects)

    def check_all(self, arguments: tuple[Any, ...], named: Mapping[str, Any]) -> None:
        """Raise WheelsetError if the arguments do not fit the function, plain ones too."""
        self._check_names(arguments, named)
        self._check(arguments, named, self._kinds)

    def _check_names(self, arguments: tuple[Any, ...], named: Mapping[str, Any]) -> None:
        signature = self._signature
        kinds = [parameter.kind for parameter in signature.parameters.values()]
        if inspect.Parameter.VAR_KEYWORD not in kinds:
            refuse_options(
                self._function, [key for key in named if key not in signature.parameters]
            )
        try:
            signature.bind(*arguments, **named)
        except TypeError as error:
            takes = ", ".join(key for key in signature.parameters if key not in ("self", "cls"))
            raise WheelsetError(f"{self._name}: {error}; it takes {takes}") from None

    def _check(
        self, arguments: tuple[Any, ...], named: Mapping[str, Any], kinds: Mapping[str, Kind]
    ) -> None:
        wrong = [
            (name, value, kinds[name].words)
            for name, value in self._by_name(arguments, named)
            if name in kinds and not kinds[name].fits(value) and value is not self._defaults[name]
        ]
        if not wrong:
            return
        self._check_names(arguments, named)
        name, value, words = wrong[0]
        order = ""
        if name not in named:
            takes = ", ".join(one for one in self._places if one != "self")
            order = f"; the order is {self._name}({takes})"
        raise WheelsetError(f"{self._name}: {name} {_shown(value)}: give {words}{order}")

    def _by_name(
        self, arguments: tuple[Any, ...], named: Mapping[str, Any]
    ) -> Iterator[tuple[str, Any]]:
        yield from zip(self._places, arguments, strict=False)
        yield from named.items()

    @cached_property
    def _signature(self) -> inspect.Signature:
        return inspect.signature(self._function)

    @cached_property
    def _places(self) -> list[str]:
        positional = (
            inspect.Parameter.POSITIONAL_ONLY,
            inspect.Parameter.POSITIONAL_OR_KEYWORD,
        )
        given = self._signature.parameters.items()
        return [name for name, parameter in given if parameter.kind in positional]

    @cached_property
    def _defaults(self) -> dict[str, Any]:
        return {name: one.default for name, one in self._signature.parameters.items()}

    @cached_property
    def _kinds(self) -> dict[str, Kind]:
        variable = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
        found = {
            name: kind_of(parameter.annotation, self._module)
            for name, parameter in self._signature.parameters.items()
            if parameter.kind not in variable
        }
        return {name: kind for name, kind in found.items() if kind is not None}

    @cached_property
    def _objects(self) -> dict[str, Kind]:
        return {name: kind for name, kind in self._kinds.items() if not kind.is_plain}


def _shown(value: Any) -> str:
    text = repr(value)
    if isinstance(value, str | float | int | list | tuple | dict | None) and len(text) < 80:
        return f"= {text}"
    return f"is a {type(value).__name__}"
