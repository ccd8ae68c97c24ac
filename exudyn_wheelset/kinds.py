"""Which values an argument can take, read from the annotations of its function.

A class, a yes or no, a function is told from anything else by its kind: such arguments are
checked before the call (`OBJECTS` and classes). Numbers have units and ranges, texts are names
among others, which an annotation does not know: the functions check those by themselves
(checking.py), and `PLAIN` is asked only where a call has ended in an error of Python's. An
annotation with a part that is not understood here takes everything.
"""

from __future__ import annotations

import math
import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any

import numpy as np

Test = Callable[[Any], bool]


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def _is_whole(value: Any) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool)


def _are_numbers(value: Any) -> bool:
    try:
        array = np.asarray(value)
    except ValueError:
        return False
    return array.dtype.kind in "iuf" and bool(np.isfinite(array).all())


def _are_rows(value: Any) -> bool:
    return np.ndim(value) > 0 and _are_numbers(value)


def _is_row(value: Any) -> bool:
    return isinstance(value, Iterable) and not isinstance(value, str | bytes)


# Text of an annotation, up to its bracket -> what a reader is told, and the test.
OBJECTS: dict[str, tuple[str, Test]] = {
    "None": ("None", lambda value: value is None),
    "bool": ("True or False", lambda value: isinstance(value, bool | np.bool_)),
    "Callable": ("a function", callable),
}
# What a class is made by, or where one comes from.
_MADE_BY = {
    "Camera": "a Camera(...)",
    "Contact": "a Contact(friction=0.4)",
    "CriticalPoint": "a CriticalPoint, as hopf_points gives them",
    "Irregularity": "an Irregularity, from_psd, from_points or from_functions",
    "LateralParameters": "a LateralParameters(...), or paper_parameters(1)",
    "Layout": "a Layout([Straight(...), ...])",
    "MainSystem": "Exudyn's system, SC.AddSystem()",
    "Motion": "a Motion, as simulate gives it",
    "RailElasticity": "a RailElasticity(...)",
    "SimulationSettings": "exudyn.SimulationSettings(), or load_settings(...)",
    "Suspension": "a Suspension(half_distance, stiffness)",
    "SystemContainer": "the SystemContainer of the system",
    "Track": 'a Track("UIC60")',
    "Vehicle": "a Vehicle, as VehicleBuilder.finish() or catalogue.vehicle(name) gives it",
    "Wheelset": "a Wheelset(mass=..., wheel=..., ...)",
}
_FLOATS = re.compile(r"(Sequence|Iterable|list|tuple)\[float(, (float|\.\.\.))*\]")
_ROWS = ("Sequence", "Iterable", "list", "tuple")
PLAIN: dict[str, tuple[str, Test]] = {
    "float": ("a finite number", _is_number),
    "int": ("a whole number", _is_whole),
    "str": ("a text", lambda value: isinstance(value, str)),
    "Path": ("a path", lambda value: isinstance(value, str | os.PathLike)),
    "PathLike": ("a path", lambda value: isinstance(value, str | os.PathLike)),
    "os.PathLike": ("a path", lambda value: isinstance(value, str | os.PathLike)),
    "Mapping": ("values by name", lambda value: isinstance(value, Mapping)),
    "dict": ("values by name", lambda value: isinstance(value, Mapping)),
    "Vector": ("three finite numbers", _are_numbers),
    "Array": ("finite numbers", _are_numbers),
    "FloatArray": ("finite numbers", _are_numbers),
    "ArrayLike": ("finite numbers", _are_numbers),
    **dict.fromkeys(_ROWS, ("a list", _is_row)),
}


@dataclass(frozen=True)
class Kind:
    """What one parameter takes: in words, and by tests of which one has to hold."""

    words: str
    tests: tuple[Test, ...]
    is_plain: bool

    def fits(self, value: Any) -> bool:
        """Whether a value is of this kind."""
        return any(test(value) for test in self.tests)


def kind_of(annotation: Any, module: str) -> Kind | None:
    """The kind of an annotation of `module`; None where it takes everything."""
    if not isinstance(annotation, str):
        return None
    words: list[str] = []
    tests: list[Test] = []
    is_plain = False
    for part in _alternatives(annotation):
        found = OBJECTS.get(part.partition("[")[0])
        if found is None:
            found = _plain(part)
            is_plain = is_plain or found is not None
        if found is None:
            found = _of_class(part, module)
        if found is None:
            return None
        if found[0] not in words:
            words.append(found[0])
        tests.append(found[1])
    return Kind(" or ".join(words), tuple(tests), is_plain)


def _plain(part: str) -> tuple[str, Test] | None:
    if _FLOATS.fullmatch(part):
        return "a list of finite numbers", _are_rows
    return PLAIN.get(part.partition("[")[0])


def _of_class(part: str, module: str) -> tuple[str, Test] | None:
    """A class that the module knows by this name."""
    found: Any = sys.modules.get(module)
    for name in part.split("."):
        found = getattr(found, name, None)
    if found is Any or not isinstance(found, type) or getattr(found, "_is_protocol", False):
        return None
    wanted: type = found
    article = "an" if wanted.__name__[0] in "AEIOU" else "a"
    words = _MADE_BY.get(wanted.__name__, f"{article} {wanted.__name__}")
    return words, lambda value: isinstance(value, wanted)


def _alternatives(annotation: str) -> list[str]:
    """The parts of a union, split where no bracket is open."""
    parts, depth, start = [], 0, 0
    for place, letter in enumerate(annotation):
        depth += (letter in "[(") - (letter in "])")
        if letter == "|" and not depth:
            parts.append(annotation[start:place].strip())
            start = place + 1
    return [*parts, annotation[start:].strip()]
