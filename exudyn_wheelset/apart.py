"""Kernels compiled apart from what calls them.

What a compiled function calls is optimised anew with each function that calls it (whole_code.py),
and is compiled whether it is ever called or not. A function compiled apart is a C function,
compiled and kept once, at its first use: compiled callers load its address from a cell that they
know by a symbol, so that they can be kept on disk as well, and the call costs a nanosecond. Until
`ready`, the cell holds the address of a function of Python that makes it ready and goes on.

Callers do not depend on what the function is made of: import it from a module whose name ends with
_apart, and they are not compiled anew when it changes (compilation.py).
"""

from __future__ import annotations

import ctypes
import hashlib
from collections.abc import Callable
from typing import Any

import llvmlite.binding
import numpy as np
from llvmlite import ir
from numba import float64, int64, types, void
from numba.core import cgutils
from numba.extending import intrinsic

from exudyn_wheelset.compilation import OPTIONS, SWITCHED_OFF, keep
from exudyn_wheelset.whole_code import Callback


class Apart:
    """A function that compiled code calls by `call((argument, ...))`.

    kinds: "i" for each argument that is an integer, "f" for each float; results: how many floats it
    gives, which the function writes to the address that it takes as one argument more. Where numba
    is switched off, the function itself is called.
    """

    def __init__(self, function: Callable[..., None], kinds: str, results: int = 0) -> None:
        self._function = function
        if results:
            kinds += "i"
        self._signature = void(*(int64 if kind == "i" else float64 for kind in kinds))
        self._cell = np.zeros(1, dtype=np.int64)
        self._compiled: Any = None
        self._in_c = ctypes.CFUNCTYPE(
            None, *(ctypes.c_int64 if kind == "i" else ctypes.c_double for kind in kinds)
        )
        self._first = self._in_c(self._get_ready_and_call)
        self._cell[0] = ctypes.cast(self._first, ctypes.c_void_p).value or 0
        digest = hashlib.sha256(kinds.encode()).hexdigest()
        symbol = f"{function.__module__}.{function.__name__}.{digest[:16]}"
        llvmlite.binding.add_symbol(symbol, self._cell.ctypes.data)
        self.call: Any = _caller(symbol, function, results)

    def ready(self) -> None:
        """Compile the function, or load what was kept, if that was not done yet."""
        if self._compiled is None and not SWITCHED_OFF:
            made = Callback(
                self._function,
                (self._signature.args, self._signature.return_type),
                dict(OPTIONS),
            )
            keep(made, self._function)
            made.compile()
            self._cell[0] = int(made.address)
            self._compiled = made

    def _get_ready_and_call(self, *arguments: float) -> None:
        self.ready()
        self._in_c(self._compiled.address)(*arguments)


def _caller(symbol: str, function: Callable[..., None], results: int) -> Any:
    """What compiled code calls the function at the cell of a symbol with."""
    if SWITCHED_OFF:
        return lambda arguments: _called(function, arguments, results)

    @intrinsic
    def call(typing_context: Any, arguments: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            numbers = cgutils.unpack_tuple(builder, values[0], len(arguments))
            kinds = [context.get_value_type(kind) for kind in arguments]
            if results:
                room = cgutils.alloca_once(builder, ir.DoubleType(), size=results)
                numbers.append(builder.ptrtoint(room, ir.IntType(64)))
                kinds.append(ir.IntType(64))
            known = builder.module.globals
            cell = known.get(symbol) or ir.GlobalVariable(builder.module, ir.IntType(64), symbol)
            cell.linkage = "external"
            of_it = ir.FunctionType(ir.VoidType(), kinds).as_pointer()
            builder.call(builder.inttoptr(builder.load(cell), of_it), numbers)
            if not results:
                return context.get_dummy_value()
            places = [builder.gep(room, [ir.IntType(64)(k)]) for k in range(results)]
            given = [builder.load(place) for place in places]
            return context.make_tuple(builder, signature.return_type, given)

        result = types.UniTuple(types.float64, results) if results else types.void
        return result(arguments), code

    return call


def _called(function: Callable[..., None], arguments: tuple[Any, ...], results: int) -> Any:
    if not results:
        return function(*arguments)
    room = np.zeros(results)
    function(*arguments, int(room.__array_interface__["data"][0]))
    return tuple(room.tolist())
