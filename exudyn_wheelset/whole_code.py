"""Kernels whose code is optimised once, with all that they call.

numba optimises every compiled function on its own and makes machine code of it, then links it into
its callers and does the same with the whole again: a kernel at the bottom of six calls is paid six
times, and most of the functions are never called from Python. Here a function that compiled code
calls is typed and translated only (`Part`); what Python calls (`Kernel`), or what is called by its
address (apart.py), links all parts that it needs and is optimised as one unit.
"""

from __future__ import annotations

from typing import Any

from llvmlite.binding import Linkage
from numba.core import ccallback, compiler, dispatcher, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Flags
from numba.core.registry import CPUDispatcher


class Library(JITCodeLibrary):
    """Code of one function, and from `finalize` on of all parts that it calls."""

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self._linkable: Any = None
        self._names: list[str] = []
        self._parts: list[Library] = []

    def add_linking_library(self, library: Any) -> None:
        if isinstance(library, Library):
            self._parts.append(library)
        else:
            super().add_linking_library(library)

    def _part(self) -> Any:
        """Code of this function alone, as it is linked into others.

        Taken before the rest is linked in: what a function is compiled to must not depend on which
        others have been compiled before it.
        """
        if self._linkable is None:
            module = self._final_module.clone()
            for function in module.functions:
                if not function.is_declaration and function.linkage == Linkage.external:
                    function.linkage = Linkage.linkonce_odr
                    self._names.append(function.name)
            self._linkable = module
        return self._linkable

    def finalize(self) -> None:
        self._part()
        inner = []
        seen = {self}
        waiting = self._parts[::-1]
        while waiting:
            library = waiting.pop()
            if library in seen:
                continue
            seen.add(library)
            self._final_module.link_in(library._part(), preserve=True)
            inner += library._names
            waiting += library._parts[::-1]
            self._linking_libraries += library._linking_libraries
        for name in inner:
            self._final_module.get_function(name).linkage = Linkage.internal
        self._linking_libraries = list(dict.fromkeys(self._linking_libraries))
        super().finalize()


_FunctionCompiler: Any = dispatcher._FunctionCompiler  # type: ignore[attr-defined]
_CallbackCompiler: Any = ccallback._CFuncCompiler  # type: ignore[attr-defined]
_NumbaCallback: Any = ccallback.CFunc


class _Whole(_FunctionCompiler):
    """As numba's, but into a `Library`."""

    def _compile_core(self, args: Any, return_type: Any) -> Any:
        flags = Flags()
        self.targetdescr.options.parse_as_flags(flags, self.targetoptions)
        flags = self._customize_flags(flags)
        context = self.targetdescr.target_context
        library = Library(context.codegen(), self.py_func.__qualname__)
        library.enable_object_caching()
        return compiler.compile_extra(
            self.targetdescr.typing_context,
            context,
            self.py_func,
            args=args,
            return_type=return_type,
            flags=flags,
            locals=self.locals,
            library=library,
            pipeline_class=self.pipeline_class,
        )


class _WholeCallback(_Whole, _CallbackCompiler):
    pass


class Callback(_NumbaCallback):
    """A function as C calls it."""

    def __init__(self, function: Any, signature: Any, options: Any) -> None:
        super().__init__(function, signature, {}, options)
        self._compiler = _WholeCallback(function, self._targetdescr, options, {}, compiler.Compiler)


class _Alone(_Whole):
    def _customize_flags(self, flags: Any) -> Any:
        flags.no_cpython_wrapper = True
        flags.no_cfunc_wrapper = True
        flags.no_compile = True
        return flags


class Part(CPUDispatcher):
    """A function as compiled code calls it."""

    def __init__(self, py_func: Any, targetoptions: Any) -> None:
        super().__init__(py_func, targetoptions=targetoptions)
        self._compiler = _Alone(
            py_func, self.targetdescr, targetoptions, self.locals, compiler.Compiler
        )

    def add_overload(self, cres: Any) -> None:
        # numba finds a function by what Python would call; of a part any other object will do.
        result = cres._replace(entry_point=object())
        code = cres._asdict()["library"]
        self.targetctx.insert_user_function(result.entry_point, cres.fndesc, [code])
        self.overloads[tuple(cres.signature.args)] = result


class Kernel(CPUDispatcher):
    """A function as Python calls it; compiled callers get its `part`."""

    def __init__(
        self,
        py_func: Any,
        locals: Any = None,
        targetoptions: Any = None,
        pipeline_class: Any = compiler.Compiler,
    ) -> None:
        super().__init__(py_func, locals or {}, targetoptions or {}, pipeline_class)
        self._compiler = _Whole(
            py_func, self.targetdescr, self.targetoptions, self.locals, pipeline_class
        )
        self._part: Any = None

    @property
    def part(self) -> Any:
        if self._part is None:
            self._part = Part(self.py_func, self.targetoptions)
        return self._part

    def get_call_template(self, args: Any, kws: Any) -> Any:
        # One specialisation for all literal numbers.
        args = tuple(types.unliteral(kind) for kind in args)
        kws = {name: types.unliteral(kind) for name, kind in kws.items()}
        return self.part.get_call_template(args, kws)

    def get_overload(self, sig: Any) -> Any:
        return self.part.get_overload(sig)
