"""A creep law of one's own: a compiled function of the common signature, called by its address.

    @numba.njit
    def my_law(creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson,
               parameters):
        ...
        return force_x, force_y, moment

Compiled code that calls a function by reference cannot be kept on disk, and the kernels of this
package are kept there. So the function is wrapped as a C function, whose address stands as a
float64 (exact below 2^53; user space ends at 2^47) in front of the law's own parameters, and the
kernel calls what is at that address. Kept kernels stay valid, and a law built into the package pays
one comparison.

An address holds in the process that made it, and as long as the function lives: every law is kept
for the life of the process. Descriptions hold the function, never the address; arrays that hold
the address must be made anew in another process (`creep_parameters` there).
"""

from __future__ import annotations

import inspect
from typing import Any

import numba
from llvmlite import ir
from numba import carray, types
from numba.core import cgutils
from numba.core.dispatcher import Dispatcher
from numba.core.errors import NumbaError
from numba.extending import intrinsic

from exudyn_wheelset.errors import WheelsetError

OWN_LAW = 9

_FLOATS = (types.float64,) * 9
_C_SIGNATURE = types.void(
    *_FLOATS, types.CPointer(types.float64), types.intp, types.CPointer(types.float64)
)
# By the function given: the C function, which must stay alive as long as its address is in use.
_kept: dict[Any, Any] = {}


def compiled_law(law: Any) -> Dispatcher:
    """The numba function of a law given as one, as a numba.cfunc or as a plain Python function.

    Raises WheelsetError for anything else.
    """
    if isinstance(law, Dispatcher):
        return law
    function = getattr(law, "_pyfunc", law)
    if not inspect.isfunction(function):
        raise WheelsetError(
            f"creep law {law!r}: give the name of a law or a function compiled by numba.njit"
        )
    return numba.njit(function)


def address_of(law: Any) -> int:
    """Address of the C function of a law; it stays valid for the life of this process.

    Raises WheelsetError for what is no function of the common signature, with numba's reason.
    """
    if law not in _kept:
        _kept[law] = _c_function(compiled_law(law))
    return int(_kept[law].address)


def law_at(address: int) -> Any:
    """The function that `address_of` was given for an address; None for an unknown address."""
    return next((law for law, kept in _kept.items() if kept.address == address), None)


def _c_function(law: Dispatcher) -> Any:
    def call(
        creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson,
        parameters, count, forces,
    ):  # fmt: skip
        force_x, force_y, moment = law(
            creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson,
            carray(parameters, (count,)),
        )  # fmt: skip
        forces[0] = force_x
        forces[1] = force_y
        forces[2] = moment

    try:
        return numba.cfunc(_C_SIGNATURE)(call)
    except NumbaError as error:
        raise WheelsetError(
            f"creep law {law.py_func.__name__!r} cannot be compiled as law(creep_x, creep_y, "
            "spin, a, b, normal_force, friction, shear_modulus, poisson, parameters) -> "
            f"(force_x, force_y, moment), all numbers but the array parameters: {error}"
        ) from error


@intrinsic
def call_law(
    typingctx, creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson,
    parameters,
):  # fmt: skip
    """(F_x, F_y, M_z) by the law at the address parameters[0]; parameters[1:] are its own.

    NaN where the law ends with an exception.
    """
    result = types.UniTuple(types.float64, 3)
    signature = result(*_FLOATS, parameters)

    def code(context, builder, signature, arguments):
        array = context.make_array(signature.args[-1])(context, builder, arguments[-1])
        number, pointer = ir.DoubleType(), ir.DoubleType().as_pointer()
        size = context.get_value_type(types.intp)
        forces = cgutils.alloca_once(builder, number, size=3)
        places = [builder.gep(forces, [size(k)]) for k in range(3)]
        for place in places:
            builder.store(number(float("nan")), place)
        address = builder.fptosi(builder.load(array.data), size)
        of_law = ir.FunctionType(ir.VoidType(), [number] * 9 + [pointer, size, pointer])
        builder.call(
            builder.inttoptr(address, of_law.as_pointer()),
            [
                *arguments[:-1],
                builder.gep(array.data, [size(1)]),
                builder.sub(array.nitems, size(1)),
                forces,
            ],
        )
        values = [builder.load(place) for place in places]
        return context.make_tuple(builder, signature.return_type, values)

    return signature, code
