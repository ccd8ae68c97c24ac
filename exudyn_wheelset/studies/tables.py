"""What a study has found: a table that opens as pandas or xarray and draws itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.results.files import write_atomically
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.studies.journal import Row, read_lines

if TYPE_CHECKING:
    from matplotlib.axes import Axes

REASON = "reason"
_MOST_SHOWN = 20


class Table(Mapping[str, np.ndarray]):
    """Columns by name, all of one length: numbers as float arrays (nan where a case has none),
    everything else as arrays of objects."""

    def __init__(self, columns: Mapping[str, list[Any]]) -> None:
        self._columns = {name: _column(values) for name, values in columns.items()}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._columns:
            raise WheelsetError(f"no column {name!r}; there are {', '.join(self._columns)}")
        return self._columns[name]

    def __contains__(self, name: object) -> bool:
        return name in self._columns

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> list[dict[str, Any]]:
        """Each case as a mapping."""
        names = list(self._columns)
        return [
            dict(zip(names, row, strict=True)) for row in zip(*self._columns.values(), strict=True)
        ]

    def __repr__(self) -> str:
        shown = [[_text(value) for value in self[name][:_MOST_SHOWN]] for name in self]
        widths = [max(map(len, [name, *column])) for name, column in zip(self, shown, strict=True)]
        lines = ["  ".join(name.rjust(w) for name, w in zip(self, widths, strict=True))]
        for row in zip(*shown, strict=True):
            lines.append("  ".join(text.rjust(w) for text, w in zip(row, widths, strict=True)))
        count = len(next(iter(self._columns.values()), []))
        if count > _MOST_SHOWN:
            lines.append(f"... {count} cases")
        return "\n".join(lines)


@spelt_class
@dataclass(frozen=True, eq=False)
class Study:
    """Cases and their results, in the order of the cases.

    record  name of the function, settings, versions
    rows    for each case a mapping of `case`, `result` and `reason` ("" where it has a result)

    Examples
    --------
    >>> from exudyn_wheelset import study
    >>> found = study(len, [{"a": 1}, {"a": 1, "b": 2}], executor=1)
    >>> len(found), found.table["value"].tolist()
    (2, [1.0, 2.0])
    """

    record: dict[str, Any]
    rows: list[Row]

    def __len__(self) -> int:
        return len(self.rows)

    def __repr__(self) -> str:
        failed = len(self.failed)
        without = f", {failed} without a result" if failed else ""
        return f"Study({self.record['function']}: {len(self)} cases{without})"

    @classmethod
    def load(cls, path: str | Path) -> Study:
        """The cases of a study's file that are done; WheelsetError for a file that is none."""
        record, rows, _ = read_lines(Path(path))
        return cls(record, [rows[number] for number in sorted(rows)])

    @property
    def names(self) -> tuple[str, ...]:
        """Names of what distinguishes the cases."""
        return tuple(dict.fromkeys(name for row in self.rows for name in row["case"]))

    @property
    def results(self) -> tuple[str, ...]:
        """Names of the results."""
        return tuple(dict.fromkeys(name for row in self.rows for name in row["result"]))

    @property
    def failed(self) -> list[Row]:
        """Rows without a result."""
        return [row for row in self.rows if row[REASON]]

    @property
    def table(self) -> Table:
        """Columns of the cases, of the results and `reason`, why a case has none."""
        columns: dict[str, list[Any]] = {
            name: [row["case"].get(name) for row in self.rows] for name in self.names
        }
        for name in self.results:
            label = name if name not in columns else f"{name} (result)"
            columns[label] = [row["result"].get(name) for row in self.rows]
        columns[REASON] = [row[REASON] for row in self.rows]
        return Table(columns)

    def to_pandas(self) -> Any:
        """The table as a pandas DataFrame, the record in its `attrs`."""
        import pandas

        frame = pandas.DataFrame(dict(self.table))
        frame.attrs.update(self.record)
        return frame

    def to_xarray(self) -> Any:
        """The results as an xarray Dataset: over the axes of the grid where the cases are all
        combinations of their values, else over `case`."""
        import xarray

        table = self.table
        axes = self.axes()
        others = [name for name in table if name not in axes]
        flat = {name: text(values) for name, values in self.record.items()}
        if axes:
            shape = tuple(map(len, axes.values()))
            order = np.lexsort([_ranks(table[name]) for name in reversed(axes)])
            variables = {name: (tuple(axes), table[name][order].reshape(shape)) for name in others}
            return xarray.Dataset(variables, coords=axes, attrs=flat)
        variables = {name: (("case",), table[name]) for name in table}
        return xarray.Dataset(variables, attrs=flat)

    def axes(self) -> dict[str, np.ndarray]:
        """Values of each name, rising, where the cases are all their combinations; else none."""
        table = self.table
        if any(isinstance(v, list) for name in self.names for v in table[name]):
            return {}
        values = {name: np.array(_rising(table[name])) for name in self.names}
        if int(np.prod([len(axis) for axis in values.values()])) != len(self):
            return {}
        distinct = {tuple(row["case"].get(name) for name in values) for row in self.rows}
        return values if len(distinct) == len(self) else {}

    def _first_result(self) -> str:
        if not self.results:
            why = next((row[REASON] for row in self.rows if row.get(REASON)), "it has no cases")
            raise WheelsetError(f"a study without results cannot be drawn: {why}")
        return self.results[0]

    def save_csv(self, path: str | Path) -> Path:
        """Write the table as CSV, atomically; returns the path."""
        import csv

        def write(part: Path) -> None:
            with part.open("w", encoding="utf-8", newline="") as stream:
                writer = csv.DictWriter(stream, list(self.table))
                writer.writeheader()
                writer.writerows(self.table.rows)

        return write_atomically(path, write)

    def plot(
        self,
        x: str | None = None,
        y: str | None = None,
        by: str | None = None,
        ax: Axes | None = None,
    ) -> Axes:
        """Draw the result `y` over `x`, a line for each value of `by`; returns the axes.

        Default: the first result over the first name, one line for each value of the second name.
        """
        ax = _axes(ax)
        x, y = x or self.names[0], y or self._first_result()
        if by is None and len(self.names) == 2:
            by = next(name for name in self.names if name != x)
        table = self.table
        groups = _rising(table[by]) if by is not None else [None]
        for group in groups:
            chosen = np.ones(len(self), dtype=bool) if by is None else table[by] == group
            order = np.argsort(_ranks(table[x][chosen]), kind="stable")
            label = None if by is None else f"{by} {_text(group)}"
            ax.plot(table[x][chosen][order], table[y][chosen][order], "o-", ms=3, label=label)
        ax.set_xlabel(x)
        ax.set_ylabel(y)
        if by is not None:
            ax.legend(fontsize=8)
        return ax

    def map(
        self,
        x: str | None = None,
        y: str | None = None,
        value: str | None = None,
        ax: Axes | None = None,
    ) -> Axes:
        """Draw the result `value` as colour over two names: fields where they are a grid, points
        where not; returns the axes."""
        ax = _axes(ax)
        names = self.names
        if len(names) < 2 and None in (x, y):
            raise WheelsetError(f"a map needs two names; the cases have {', '.join(names)}")
        x, y, value = x or names[0], y or names[1], value or self._first_result()
        table, axes = self.table, self.axes()
        if set(axes) == {x, y}:
            order = np.lexsort([_ranks(table[x]), _ranks(table[y])])
            field = table[value][order].reshape(len(axes[y]), len(axes[x]))
            places = [_places(axes[name]) for name in (x, y)]
            drawn: Any = ax.pcolormesh(*places, field, shading="nearest")
            for name, place, ticks, label in (
                (x, places[0], ax.set_xticks, ax.set_xticklabels),
                (y, places[1], ax.set_yticks, ax.set_yticklabels),
            ):
                if axes[name].dtype.kind not in "if":
                    ticks(place)
                    label([Path(str(entry)).stem for entry in axes[name]], rotation=45, fontsize=7)
        else:
            drawn = ax.scatter(table[x], table[y], c=table[value])
        ax.figure.colorbar(drawn, ax=ax, label=value)
        ax.set_xlabel(x)
        ax.set_ylabel(y)
        return ax

    def draw_table(self, ax: Axes | None = None, most: int = 30) -> Axes:
        """Draw the table itself, at most so many rows; returns the axes."""
        ax = _axes(ax)
        ax.axis("off")
        table = self.table
        names = [name for name in table if name != REASON or self.failed]
        cells = [[_text(row[name]) for name in names] for row in table.rows[:most]]
        drawn = ax.table(cellText=cells, colLabels=names, loc="center")
        drawn.auto_set_font_size(False)
        drawn.set_fontsize(7)
        return ax


def text(value: Any) -> str:
    """An entry of the record as xarray's attributes can hold it."""
    return value if isinstance(value, str) else str(value)


def _column(values: list[Any]) -> np.ndarray:
    if all(isinstance(v, int | float) or v is None for v in values):
        if values and all(isinstance(v, bool) for v in values):
            return np.array(values)
        return np.array([np.nan if v is None else v for v in values], dtype=float)
    column = np.empty(len(values), dtype=object)
    for place, value in enumerate(values):
        column[place] = value
    return column


def _rising(values: np.ndarray) -> list[Any]:
    return sorted(
        set(values.tolist()), key=lambda v: (isinstance(v, str), str(v) if v is None else v)
    )


def _ranks(values: np.ndarray) -> np.ndarray:
    place = {value: rank for rank, value in enumerate(_rising(values))}
    return np.array([place[value] for value in values.tolist()])


def _places(axis: np.ndarray) -> np.ndarray:
    return axis if axis.dtype.kind in "if" else np.arange(len(axis), dtype=float)


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _axes(ax: Axes | None) -> Axes:
    if ax is None:
        import matplotlib.pyplot as plt

        return plt.subplots()[1]
    return ax
