"""Elements by the name that a vehicle file calls them: their class in snake_case.

Classes that derive from `Element` are known as soon as they are defined; others are made known by
`register_element`. The package's own come first, so that a user's class of the same name has to be
registered under another one.
"""

from __future__ import annotations

import re
from typing import Any

from exudyn_wheelset.checking import unknown
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.vehicles import elements
from exudyn_wheelset.vehicles.elements.protocol import Element

_REGISTERED: dict[str, type] = {}


@spelt
def register_element(cls: type, name: str | None = None) -> type:
    """Make a class of elements known to vehicle files as `name`; snake_case of its own if left out.

    Returns the class, so that it can be a decorator. Raises WheelsetError for a name that another
    class of the package has.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> from exudyn_wheelset import Spring, register_element
    >>> @register_element
    ... @dataclass(frozen=True)
    ... class SoftSpring(Spring):
    ...     pass
    ...
    >>> SoftSpring.__name__
    'SoftSpring'
    """
    if not isinstance(cls, type):
        raise WheelsetError(f"{cls!r} is no class: give the class of the element")
    chosen = snake_case(cls.__name__) if name is None else name
    if _own().get(chosen, cls) is not cls:
        raise WheelsetError(
            f"element {chosen!r} is one of this package: register {cls.__name__} by another name"
        )
    _REGISTERED[chosen] = cls
    return cls


def element_types() -> dict[str, type]:
    """All classes of elements that files know, by their names."""
    found = {}
    for cls in _below(Element):
        found[snake_case(cls.__name__)] = cls
    return {**found, **_own(), **_REGISTERED}


def element_type(name: Any) -> type:
    """The class of a name; WheelsetError, with the nearest, for an unknown one."""
    known = element_types()
    if not isinstance(name, str) or name not in known:
        raise unknown("type of connection", name, sorted(known))
    return known[name]


def type_name(cls: type) -> str:
    """The name under which a class is found; WheelsetError for a class that is not."""
    for name, known in element_types().items():
        if known is cls:
            return name
    raise WheelsetError(
        f"{cls.__name__} is not known to vehicle files: derive it from Element, or call "
        f"register_element({cls.__name__})"
    )


def snake_case(name: str) -> str:
    """ "MaxwellDamper" as "maxwell_damper"."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


def _own() -> dict[str, type]:
    classes = [getattr(elements, name) for name in elements.__all__]
    return {
        snake_case(cls.__name__): cls
        for cls in classes
        if issubclass(cls, Element) and cls is not Element
    }


def _below(cls: Any) -> list[type]:
    found: list[type] = []
    for child in cls.__subclasses__():
        found += [child, *_below(child)]
    return found
