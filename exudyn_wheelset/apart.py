"""Kernels compiled apart from what calls them.

numba links what a compiled function calls into it and optimises the whole again: a contact kernel
of six seconds is paid once more by each of the dozen functions that end in it. A function compiled
apart is a C function, compiled and kept once. Compiled callers load its address from a cell that
they know by a symbol, so that they can be kept on disk as well, and the call costs a nanosecond.
The cell is filled by `ready`, which Python calls before any compiled caller can run.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any

import llvmlite.binding
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils, sigutils
from numba.extending import intrinsic

from exudyn_wheelset.compilation import SWITCHED_OFF, keep, source_digest
from exudyn_wheelset.whole_code import Callback


class Apart:
    """A function that compiled code calls by `call((argument, ...))`, all numbers, no result.

    function: as for numba; signature: of numba, void of int64 and float64. Inside Python, and where
    numba is switched off, the function itself is called.
    """

    def __init__(self, function: Callable[..., None], signature: Any) -> None:
        self._function = function
        self._signature = signature
        self._cell = np.zeros(1, dtype=np.int64)
        self._compiled: Any = None
        digest = source_digest(Path(inspect.getfile(function)))
        symbol = f"{function.__module__}.{function.__name__}.{digest[:16]}"
        llvmlite.binding.add_symbol(symbol, self._cell.ctypes.data)
        self.call: Any = _caller(symbol, function)

    def ready(self) -> None:
        """Compile the function, or load what was kept, if that was not done yet."""
        if self._compiled is None and not SWITCHED_OFF:
            made = Callback(
                self._function,
                sigutils.normalize_signature(self._signature),
                {"error_model": "numpy"},
            )
            keep(made, self._function)
            made.compile()
            self._cell[0] = made.address
            self._compiled = made


def _caller(symbol: str, function: Callable[..., None]) -> Any:
    """What compiled code calls the function at the cell of a symbol with."""
    if SWITCHED_OFF:
        return lambda arguments: function(*arguments)

    @intrinsic
    def call(typing_context: Any, arguments: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            numbers = cgutils.unpack_tuple(builder, values[0], len(arguments))
            known = builder.module.globals
            cell = known.get(symbol) or ir.GlobalVariable(builder.module, ir.IntType(64), symbol)
            cell.linkage = "external"
            kinds = [context.get_value_type(kind) for kind in arguments]
            of_it = ir.FunctionType(ir.VoidType(), kinds).as_pointer()
            builder.call(builder.inttoptr(builder.load(cell), of_it), numbers)
            return context.get_dummy_value()

        return types.void(arguments), code

    return call
