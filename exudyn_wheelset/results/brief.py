"""Short words for results: a line that says what is in them, and how large."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from enum import Enum
from typing import Any, TypeVar

import numpy as np

Class = TypeVar("Class", bound=type)
_LONGEST_TEXT = 60
_LONGEST = 400


def brief(cls: Class) -> Class:
    """Give a dataclass a repr of one line: numbers to six digits, arrays by their shape."""

    def text(self: Any) -> str:
        parts = [
            f"{field.name}={_words(getattr(self, field.name))}"
            for field in fields(self)
            if field.repr
        ]
        line = f"{type(self).__name__}({', '.join(parts)})"
        return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 4]}...)"

    cls.__repr__ = text  # type: ignore[method-assign, assignment]
    return cls


def _words(value: Any) -> str:
    if isinstance(value, bool | np.bool_) or value is None:
        return str(value)
    if type(value) in (float, np.float64):
        return f"{value:.6g}"
    if isinstance(value, complex | np.complexfloating):
        return f"{value.real:.6g}{value.imag:+.6g}j"
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, str):
        return repr(value if len(value) <= _LONGEST_TEXT else f"{value[: _LONGEST_TEXT - 3]}...")
    if isinstance(value, np.ndarray):
        return f"<{' x '.join(map(str, value.shape))}>" if value.size > 1 else str(value)
    if isinstance(value, Mapping):
        return f"<{len(value)} entries>"
    if isinstance(value, tuple | list):
        if len(value) > 4 or any(isinstance(entry, np.ndarray) for entry in value):
            return f"<{len(value)} of {type(value[0]).__name__}>"
        return f"({', '.join(_words(entry) for entry in value)})"
    if isinstance(value, float):
        # A result that is its own number.
        return f"<{type(value).__name__} {float(value):.6g}>"
    return repr(value)
