"""The file of a study: a line for its record, then a line for each case that is done.

JSON in lines of text. While a study runs, a row is added in one write as soon as its case is done,
in the order in which they come; when all are there, the file is written anew in the order of the
cases, in one go. So a killed study loses the cases that were running and nothing else, and ends in
the same bytes as one that was never killed. A half line, of a machine that lost its power, is
taken for not written.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from exudyn_wheelset.errors import FileError, WheelsetError
from exudyn_wheelset.locking import FileLock
from exudyn_wheelset.results.files import write_atomically

Row = dict[str, Any]


def _line(content: Mapping[str, Any]) -> bytes:
    return json.dumps(content, ensure_ascii=False).encode() + b"\n"


class Journal:
    """A study's file, open for rows, locked against a second study in the same place.

    rows  what was done before, by the number of the case
    """

    def __init__(self, path: str | Path, record: Mapping[str, Any]) -> None:
        self.path = Path(path)
        self.record = dict(record)
        self.rows: dict[int, Row] = {}
        self._complete = False
        self._handle: int | None = None
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileError(f"{self.path} cannot be written: {error.strerror or error}") from error
        self._lock = FileLock(self.path.with_name(f".{self.path.name}.lock"))
        if not self._lock.acquire():
            raise FileError(
                f"{self.path}: another study writes there (or the folder cannot be written): give "
                "another file or wait"
            )
        try:
            self._read()
            self._handle = os.open(self.path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
        except OSError as error:
            self.close()
            raise FileError(f"{self.path} cannot be written: {error.strerror or error}") from error
        except BaseException:
            self.close()
            raise

    def _read(self) -> None:
        """Take over the rows of a file of the same study; cut off a half line at its end."""
        if not self.path.exists() or self.path.stat().st_size == 0:
            write_atomically(self.path, lambda part: part.write_bytes(_line(self.record)))
            return
        record, rows, whole = read_lines(self.path)
        wanted = json.loads(_line(self.record))
        differing = [name for name in wanted if record.get(name) != wanted[name]]
        if differing:
            changes = "; ".join(
                f"{name}: {_short(record.get(name))} there, {_short(wanted[name])} now"
                for name in differing
            )
            raise WheelsetError(
                f"{self.path} holds another study ({changes}): give another file or remove it"
            )
        if whole < self.path.stat().st_size:
            os.truncate(self.path, whole)
        self.rows = rows
        self._complete = list(rows) == list(range(record["cases"]))

    def add(self, number: int, row: Row) -> None:
        """Write the row of a case that is done."""
        self.rows[number] = row
        assert self._handle is not None
        try:
            os.write(self._handle, _line({"number": number, **row}))
        except OSError as error:
            raise FileError(f"{self.path} cannot be written: {error.strerror or error}") from error

    def finish(self) -> None:
        """Write the file in the order of the cases, if they are all there."""
        if self._complete or len(self.rows) < self.record["cases"]:
            return
        lines = [_line({"number": number, **self.rows[number]}) for number in sorted(self.rows)]
        content = b"".join([_line(self.record), *lines])
        write_atomically(self.path, lambda part: part.write_bytes(content))
        self._complete = True

    def close(self) -> None:
        """Let another study have the file."""
        if self._handle is not None:
            os.close(self._handle)
            self._handle = None
        self._lock.path.unlink(missing_ok=True)
        self._lock.release()


def read_lines(path: Path) -> tuple[dict[str, Any], dict[int, Row], int]:
    """Record, rows by number, and length [bytes] of the whole lines of a study's file.

    Raises WheelsetError for a file that is none.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise WheelsetError(f"{path} cannot be read: {error.strerror or error}") from error
    whole = content.rfind(b"\n") + 1
    try:
        record, *rows = [json.loads(line) for line in content[:whole].splitlines()]
        numbered = {int(row.pop("number")): row for row in rows}
        if not isinstance(record["cases"], int):
            raise ValueError("no number of cases")
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise WheelsetError(f"{path} is not the file of a study ({error})") from error
    return record, numbered, whole


def _short(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 60 else f"{text[:57]}..."
