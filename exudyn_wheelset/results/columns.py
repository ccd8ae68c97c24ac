"""Columns of numbers that are found by name, and by the first words of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError


class NamedColumns(np.ndarray):
    """An array (points, columns) whose columns are also reached by name: table["y [m]"].

    The first words of a name do, its unit left out, if no other name begins so. Names survive
    pickle and copies.
    """

    names: tuple[str, ...]

    def __new__(cls, values: Array, names: Sequence[str]) -> NamedColumns:
        table = np.array(values, dtype=float).view(cls)
        table.names = tuple(names)
        return table

    def __array_finalize__(self, source: Any) -> None:
        self.names = getattr(source, "names", ())

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, str):
            return np.asarray(self)[:, column_index(self.names, key)]
        return np.asarray(self)[key]

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (np.asarray(self), self.names)

    def __repr__(self) -> str:
        return f"<{self.shape[0]} points of {', '.join(self.names)}>"

    def keys(self) -> tuple[str, ...]:
        return self.names


def column_index(names: Sequence[str], name: str) -> int:
    """Position of a name; its first words do if they tell it from the others ("y", "q1").

    Raises AnalysisError if no name or more than one fits.
    """
    if not isinstance(name, str):
        raise AnalysisError(
            f"{name!r} is no name of a column: give one of {', '.join(names)}; samples are rows of "
            "what it gives"
        )
    if name in names:
        return list(names).index(name)
    for ending in (" [", " "):
        fitting = [index for index, known in enumerate(names) if known.startswith(name + ending)]
        if len(fitting) == 1:
            return fitting[0]
    raise AnalysisError(f"{name!r} is not one of {', '.join(names)}")
