"""Sets of cases: each case is a plain mapping of names to values.

    grid(friction=[0.1, 0.3], gauge=np.linspace(1.432, 1.437, 6))     12 cases
    latin_hypercube(200, seed=1, friction=(0.1, 0.5), conicity=(0.02, 0.2))
    table_rows("vehicles.csv")                                         one case a row
    files("measured/wheels", "*.whl", name="wheel")                    one case a file

Values are numbers, texts, truth values, None or lists of them: what a file of text can hold and
give back to the last bit.
"""

from __future__ import annotations

import csv
import itertools
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset.errors import WheelsetError

Case = dict[str, Any]


def grid(values: Mapping[str, Iterable[Any]] | None = None, **more: Iterable[Any]) -> list[Case]:
    """Every combination of the values of each name; the last name changes fastest."""
    axes = {name: _axis(name, entries) for name, entries in {**dict(values or {}), **more}.items()}
    if not axes:
        raise WheelsetError("a grid needs at least one name with its values")
    return [dict(zip(axes, combination, strict=True)) for combination in _product(axes)]


def latin_hypercube(
    count: int,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    *,
    seed: int = 0,
    **more: tuple[float, float],
) -> list[Case]:
    """`count` cases spread over ranges (low, high): each range is cut into `count` equal parts,
    and each part of it holds one case. The same `seed` gives the same cases.

    Source: M. McKay, R. Beckman, W. Conover, Technometrics 21 (1979) 239; scipy.stats.qmc.
    """
    # All of scipy's statistics, half a second to load.
    from scipy.stats import qmc

    bounds = {**dict(ranges or {}), **more}
    whole = isinstance(count, int | np.integer) and not isinstance(count, bool)
    if not bounds or not whole or count < 1:
        raise WheelsetError(
            f"count = {count!r}: give a whole number, at least one case, and one range (low, high)"
        )
    for name, ends in bounds.items():
        try:
            low, high = map(float, ends)
        except (TypeError, ValueError):
            raise WheelsetError(
                f"{name} = {ends!r}: give two numbers (low, high), low below high"
            ) from None
        if not (np.isfinite(low) and np.isfinite(high) and low < high):
            raise WheelsetError(f"{name} = ({low!r}, {high!r}): give (low, high), low below high")
    unit = qmc.LatinHypercube(len(bounds), rng=np.random.default_rng(seed)).random(count)
    low, high = np.array(list(bounds.values()), dtype=float).T
    return [dict(zip(bounds, map(float, row), strict=True)) for row in low + unit * (high - low)]


def table_rows(table: Any) -> list[Case]:
    """One case a row of a table: a CSV file with a line of names, a mapping of columns, a list of
    mappings, or a pandas DataFrame.

    Texts of a CSV file that spell numbers become numbers. Raises WheelsetError.
    """
    if isinstance(table, str | Path):
        path = Path(table)
        try:
            with path.open(encoding="utf-8-sig", newline="") as stream:
                rows = list(csv.DictReader(stream))
        except OSError as error:
            raise WheelsetError(f"{path} cannot be read: {error.strerror or error}") from error
        if not rows:
            raise WheelsetError(f"{path} has no rows below its line of names")
        return [{name.strip(): _number(text) for name, text in row.items()} for row in rows]
    if hasattr(table, "to_dict") and hasattr(table, "columns"):
        return [normal_case(row) for row in table.to_dict("records")]
    if isinstance(table, Mapping):
        columns = {name: _axis(name, entries) for name, entries in table.items()}
        lengths = {name: len(column) for name, column in columns.items()}
        if len(set(lengths.values())) != 1:
            raise WheelsetError(f"columns of different lengths: {lengths}")
        return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    return [normal_case(row) for row in table]


def files(folder: str | Path, pattern: str = "*", *, name: str = "file") -> list[Case]:
    """One case a file of a folder that fits `pattern`, by its path as text, in alphabetic order."""
    found = sorted(path for path in Path(folder).glob(pattern) if path.is_file())
    if not found:
        raise WheelsetError(f"no file {pattern!r} in {folder}")
    return [{name: str(path)} for path in found]


def listed(cases: Any) -> list[Case]:
    """Cases as a list of mappings: a mapping of names to values is a grid, other things than
    mappings in a list become {"case": thing}."""
    if isinstance(cases, Mapping):
        return grid(cases)
    if isinstance(cases, str | Path) or hasattr(cases, "columns"):
        return table_rows(cases)
    if not isinstance(cases, Iterable):
        raise WheelsetError(f"cases = {cases!r}: give a list of cases, a grid, or a table")
    found = [normal_case(case if isinstance(case, Mapping) else {"case": case}) for case in cases]
    if not found:
        raise WheelsetError("there is no case to study: give at least one")
    return found


def normal_case(case: Mapping[str, Any]) -> Case:
    """A case with plain Python values."""
    return {str(name): plain_value(str(name), value) for name, value in case.items()}


def plain_value(name: str, value: Any) -> Any:
    """A value that a file of text gives back to the last bit; WheelsetError for another one."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, Path):
        return str(value)
    if value is None or isinstance(value, bool | str):
        return value
    if isinstance(value, int):
        return int(value)
    if isinstance(value, float):
        return float(value)
    if isinstance(value, tuple | list):
        return [plain_value(name, entry) for entry in value]
    raise WheelsetError(
        f"{name} = {value!r}: a case and its results hold numbers, texts, truth values and lists "
        "of them; name what is larger, and build it inside the function"
    )


def _axis(name: str, entries: Iterable[Any]) -> list[Any]:
    if isinstance(entries, str) or not isinstance(entries, Iterable):
        raise WheelsetError(f"{name} = {entries!r}: give a list of values")
    return [plain_value(name, entry) for entry in entries]


def _product(axes: Mapping[str, list[Any]]) -> Iterable[tuple[Any, ...]]:
    return itertools.product(*axes.values())


def _number(text: str | None) -> Any:
    if text is None:
        return None
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text.strip()
