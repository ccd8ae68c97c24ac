"""Run a function over cases on any executor, and keep each result as soon as it is there.

Nothing here schedules anything: cases are handed to a `concurrent.futures.Executor`, processes of
this machine by default, and rows are taken as they come. Every case is computed by itself, from
its own values, so that the order and the place of the work do not show in the result.
"""

from __future__ import annotations

import hashlib
import json
import multiprocessing
import os
import pickle
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor, Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import asdict, is_dataclass
from functools import partial
from pathlib import Path
from typing import Any

from tqdm import tqdm

from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.results.versions import versions
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.studies.cases import Case, listed, plain_value
from exudyn_wheelset.studies.journal import Journal, Row
from exudyn_wheelset.studies.tables import Study

# Libraries that compute on all cores would take them from the other workers; set before they load.
_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
# A float that is more than its number (a critical speed) is stored as this column.
VALUE = "value"


@spelt
def study(
    function: Callable[..., Any],
    cases: Any,
    executor: Executor | int | None = None,
    file: str | Path | None = None,
    *,
    settings: Mapping[str, Any] | None = None,
    progress: bool | None = None,
) -> Study:
    """Results of `function` for every case, as a table, in the order of the cases.

    function  takes a case, a mapping of names to values, and returns a number, a mapping of names
              to values, or a dataclass of them. The same function is a `parameterFunction` of
              Exudyn's ParameterVariation. It is named in the file, so give it a name at the top of
              its module; an exception is a row with its `reason`.
    cases     a mapping of names to lists of values (their grid), a list of mappings, a table or the
              path of a CSV file; see `grid`, `latin_hypercube`, `table_rows`, `files`
    executor  any concurrent.futures.Executor: Dask's `client.get_executor()`,
              `mpi4py.futures.MPIPoolExecutor()`, joblib's or submitit's; a number of processes of
              this machine, 1 for none beside this one; None: as many as it has cores
    file      where each case is kept as soon as it is done: a killed study goes on from there when
              it is called again, to the same bytes
    settings  further keyword arguments of `function`, the same for all cases; kept with the result
    progress  whether to show a bar with the time left; None: in a terminal

    Processes are started anew, not forked: a script that calls this needs
    `if __name__ == "__main__":`. Raises WheelsetError for a function that cannot be sent to
    another process, for a file of another study and where a process dies.

    Examples
    --------
    >>> from exudyn_wheelset import linear_critical_speed, study
    >>> from exudyn_wheelset.catalogue import vehicle
    >>> def critical(case):
    ...     return linear_critical_speed(vehicle("cooperrider", **case), 20, 120)
    ...
    >>> found = study(critical, {"conicity": [0.05, 0.1]}, executor=1, progress=False)
    >>> [round(float(speed), 1) for speed in found.table["value"]]
    [68.6, 47.5]
    """
    if not callable(function):
        raise WheelsetError(f"function = {function!r}: give a function of a case")
    if isinstance(executor, int):
        known = executor >= 1 and not isinstance(executor, bool)
    else:
        known = executor is None or hasattr(executor, "submit")
    if not known:
        raise WheelsetError(
            f"executor = {executor!r}: give a number of processes from 1, None for one a core, or "
            "a concurrent.futures.Executor"
        )
    if not isinstance(settings, Mapping | None):
        raise WheelsetError(f"settings = {settings!r}: give a mapping of names to values")
    if not isinstance(file, str | Path | None):
        raise WheelsetError(f"file = {file!r}: give a path, or leave it out")
    rows = listed(cases)
    given = {name: plain_value(name, value) for name, value in (settings or {}).items()}
    record: dict[str, Any] = {
        "kind": "study",
        "function": _name_of(function),
        "settings": given,
        "cases": len(rows),
        "digest": hashlib.sha256(json.dumps(rows, ensure_ascii=False).encode()).hexdigest(),
        "versions": versions(),
    }
    journal = None if file is None else Journal(file, record)
    done: dict[int, Row] = {} if journal is None else journal.rows
    try:
        waiting = [number for number in range(len(rows)) if number not in done]
        call = partial(_run, function, given)
        with tqdm(
            total=len(rows),
            initial=len(rows) - len(waiting),
            unit="case",
            desc=record["function"].rpartition(".")[2],
            disable=None if progress is None else not progress,
        ) as bar:
            for number, row in _results(call, rows, waiting, executor):
                if journal is None:
                    done[number] = row
                else:
                    journal.add(number, row)
                bar.update()
        if journal is not None:
            journal.finish()
    finally:
        if journal is not None:
            journal.close()
    return Study(record, [{"case": rows[number], **done[number]} for number in range(len(rows))])


def _name_of(function: Any) -> str:
    inner = function.func if isinstance(function, partial) else function
    name = getattr(inner, "__qualname__", type(inner).__qualname__)
    module = getattr(inner, "__module__", "")
    # A script is the same module whether it is run or imported.
    if module == "__main__":
        module = Path(getattr(inner, "__globals__", {}).get("__file__", module)).stem
    return f"{module.rpartition('.')[2]}.{name}"


def _run(function: Callable[..., Any], settings: Mapping[str, Any], case: Case) -> Row:
    """The row of one case: its results, or the reason why there are none."""
    try:
        result = function(dict(case), **settings)
        return {"case": case, "result": _columns(result), "reason": ""}
    except Exception as error:
        return {"case": case, "result": {}, "reason": f"{type(error).__name__}: {error}"}


def _columns(result: Any) -> dict[str, Any]:
    if is_dataclass(result) and not isinstance(result, type | float):
        result = asdict(result)
    if hasattr(result, "_asdict"):
        result = result._asdict()
    if not isinstance(result, Mapping):
        result = {VALUE: result}
    return {str(name): plain_value(str(name), value) for name, value in result.items()}


def _results(
    call: Callable[[Case], Row],
    rows: list[Case],
    waiting: list[int],
    executor: Executor | int | None,
) -> Iterator[tuple[int, Row]]:
    """Rows by number, as they are done."""
    if not waiting:
        return
    count = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    if isinstance(executor, int):
        count = executor
    elif executor is not None:
        yield from _submitted(executor, call, rows, waiting)
        return
    if (count or 1) <= 1:
        for number in waiting:
            yield number, call(rows[number])
        return
    try:
        pickle.dumps(call)
    except Exception as error:
        raise WheelsetError(
            f"the function cannot be sent to another process ({error}): define it at the top of a "
            "module, or give executor=1"
        ) from error
    context = multiprocessing.get_context("spawn")
    workers = min(count or 1, len(waiting))
    with (
        _one_thread_each(),
        ProcessPoolExecutor(max_workers=workers, mp_context=context) as pool,
    ):
        yield from _submitted(pool, call, rows, waiting)


def _submitted(
    executor: Executor, call: Callable[[Case], Row], rows: list[Case], waiting: list[int]
) -> Iterator[tuple[int, Row]]:
    numbers: dict[Future[Row], int] = {}
    try:
        for number in waiting:
            numbers[executor.submit(call, rows[number])] = number
        for future in _completed(numbers):
            # A future that is kept would keep its result.
            yield numbers.pop(future), future.result()
    except BrokenProcessPool as error:
        raise WheelsetError(
            "a process of the study has died (no memory left, or no `if __name__ == "
            '"__main__":` around the call of study in a script); call it again to go on from its '
            "file"
        ) from error
    finally:
        for future in numbers:
            future.cancel()


def _completed(futures: Mapping[Future[Row], int]) -> Iterator[Future[Row]]:
    """Futures as they are done, of any library: Dask's are not those of the standard library."""
    if all(isinstance(future, Future) for future in futures):
        yield from as_completed(list(futures))
        return
    yield from list(futures)


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """Environment for processes that share the machine: one thread each, unless it says so."""
    added = [name for name in _ONE_THREAD if name not in os.environ]
    os.environ.update(dict.fromkeys(added, "1"))
    try:
        yield
    finally:
        for name in added:
            os.environ.pop(name, None)
