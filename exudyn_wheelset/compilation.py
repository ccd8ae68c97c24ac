"""Compiled kernels: the decorator that makes them, and the cache that keeps them.

numba keeps compiled code under the content of the function's own file. A kernel that calls a
changed function of another file would then be used as it was. Here a kernel is kept under the
content of its file and of every file of the package that it imports, directly or not, with the
versions of numba and numpy: changed callees are compiled anew, nothing has to be deleted, and two
versions of the package side by side do not disturb each other. (numba adds the processor's name.)

Processes that start together with an empty cache do not compile the same kernel side by side: the
first one to miss it holds a lock file beside its place until it is kept there; the others wait and
load it.

Place: NUMBA_CACHE_DIR if set, otherwise the user's cache folder; where neither can be written,
kernels are compiled in memory at every start.
"""

from __future__ import annotations

import hashlib
import logging
import re
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numba
from numba.core import caching, config, event
from numba.core.cpu import CPUTargetOptions
from numba.core.options import _mapping
from numba.misc.appdirs import AppDirs

from exudyn_wheelset.locking import FileLock
from exudyn_wheelset.whole_code import Kernel

PACKAGE = Path(__file__).parent
# For options `fastmath`: sums and products as of real numbers, in any order and fused; infinities
# and not-a-number stay what they are. A quarter faster where a kernel is all geometry.
AS_REAL_NUMBERS = {"contract", "reassoc", "nsz", "arcp"}
# Longer than the largest kernel takes to compile on a busy machine [s]; then it is compiled twice.
PATIENCE = 300.0
# Variables of the environment by which numba makes other code of the same sources.
_COMPILER_SETTINGS = ("BOUNDSCHECK", "OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "DEBUGINFO_DEFAULT")
# Option `noalias`: a promise that no two arrays among the arguments share memory, without which a
# loop that reads one by computed places and writes another is not vectorised. numba makes it for
# its own loops only, and has no option for it.
CPUTargetOptions.noalias = _mapping("noalias")
# All are said: what a function leaves out numba takes from whoever calls it first, and its bits
# would depend on what the process compiled before.
OPTIONS = {
    "boundscheck": None,
    "error_model": "numpy",
    "fastmath": False,
    "forceinline": False,
}
# By NUMBA_DISABLE_JIT: kernels then are the plain functions.
SWITCHED_OFF = bool(getattr(config, "DISABLE_JIT", False))
_log = logging.getLogger(__name__)
_IMPORT = re.compile(
    rf"^(?:from ({PACKAGE.name}[\w.]*) import (\([^)]*\)|[^\n]*)|import ({PACKAGE.name}[\w.]*))",
    re.MULTILINE,
)


def _file_of(module: str) -> Path | None:
    path = PACKAGE.joinpath(*module.split(".")[1:])
    for candidate in (path.with_suffix(".py"), path / "__init__.py"):
        if candidate.exists():
            return candidate
    return None


@cache
def _source(path: Path) -> tuple[bytes, tuple[Path, ...]]:
    """Content of a file of the package, and the files of the package that it imports."""
    text = path.read_text(encoding="utf-8")
    names: list[str] = []
    for package, members, module in _IMPORT.findall(text):
        names.append(package or module)
        names += [f"{package}.{member}" for member in re.findall(r"\w+", members) if package]
    files = {file for name in names if name != PACKAGE.name and (file := _file_of(name))}
    return text.encode(), tuple(sorted(files))


@cache
def source_digest(path: Path) -> str:
    """Digest of what compiled code of the file at `path` depends on.

    Of a module whose name ends with _apart callers know the symbols only (apart.py): not what it
    imports.
    """
    found = {path}
    waiting = [path]
    while waiting:
        for file in _source(waiting.pop())[1]:
            if file not in found:
                found.add(file)
                if not file.stem.endswith("_apart"):
                    waiting.append(file)
    digest = hashlib.sha256(f"numba {numba.__version__} numpy {version('numpy')}".encode())
    digest.update(str([getattr(config, name, None) for name in _COMPILER_SETTINGS]).encode())
    for file in sorted(found):
        digest.update(f"\n{file.relative_to(PACKAGE).as_posix()}\n".encode())
        digest.update(_source(file)[0])
    return digest.hexdigest()


class _Locator(caching._CacheLocator):
    """Tells numba where a kernel of this package is kept."""

    def __init__(self, function: Any, file: str) -> None:
        self._line = function.__code__.co_firstlineno
        self._digest = source_digest(Path(file))
        given: str = getattr(config, "CACHE_DIR", "")
        folder = given or AppDirs("exudyn_wheelset", appauthor=False).user_cache_dir
        self._folder = str(Path(folder, f"{Path(file).stem}-{self._digest[:20]}"))

    def get_cache_path(self) -> str:
        return self._folder

    def get_source_stamp(self) -> str:
        return self._digest

    def get_disambiguator(self) -> str:
        return str(self._line)

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> _Locator | None:
        if PACKAGE not in Path(py_file).parents:
            return None
        locator = cls(py_func, py_file)
        try:
            locator.ensure_cache_path()
        except OSError:
            return None
        return locator


_Implementation: Any = caching.FunctionCache._impl_class


class _Kept(_Implementation):
    _locator_classes = (_Locator,)


class _Cache(caching.FunctionCache):
    _impl_class = _Kept
    _said = False

    def __init__(self, function: Any) -> None:
        super().__init__(function)
        place = Path(self._cache_path, f"{self._impl.filename_base}.lock")
        self._lock = FileLock(place)
        self._name = f"{function.__module__}.{function.__name__}".removeprefix(f"{PACKAGE.name}.")
        self._depth = 0

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        kept = super().load_overload(sig, target_context)
        if kept is None and self._depth == 0 and self._hold():
            # Another process may have kept it meanwhile.
            kept = super().load_overload(sig, target_context)
            if kept is not None:
                self._lock.release()
        if kept is None:
            self._depth += 1
            if not _Cache._said:
                _Cache._said = True
                _log.warning("compiling kernels, once (kept in %s)", Path(self._cache_path).parent)
            _log.info("compiling %s", self._name)
        return kept

    def _hold(self) -> bool:
        """Hold the lock, after whoever has it."""
        self._lock.patience = 0.0
        if self._lock.acquire():
            return True
        _log.warning("waiting for another process that compiles %s", self._name)
        self._lock.patience = PATIENCE
        return self._lock.acquire()

    def save_overload(self, sig: Any, data: Any) -> None:
        super().save_overload(sig, data)
        self.compiled()

    def compiled(self) -> None:
        """A compilation that `load_overload` has missed is over, kept or failed."""
        self._depth = max(0, self._depth - 1)
        if self._depth == 0:
            self._lock.release()


class _Failures(event.Listener):
    """Gives back the lock of a kernel whose compilation has failed."""

    def on_start(self, event: Any) -> None:
        pass

    def on_end(self, event: Any) -> None:
        cache = getattr(event.data["dispatcher"], "_cache", None)
        # `is_failed` of numba 0.60 to 0.68 is true where there is no exception.
        if event._exc_details is not None and isinstance(cache, _Cache):
            cache.compiled()


event.register("numba:compile", _Failures())


def compiled(function: Any = None, **options: Any) -> Any:
    """Compile a function of this package with numba, division by zero as in numpy, and keep it.

    Used bare or with options of numba.njit; inline="always" is left to LLVM, which is spared the
    typing of a copy at every call. A function has its own fastmath, not its caller's.
    """
    if function is None:
        return lambda function: compiled(function, **options)
    if SWITCHED_OFF:
        return function
    if options.pop("inline", "never") == "always":
        options["forceinline"] = True
    kernel = Kernel(function, targetoptions={"nopython": True, **OPTIONS, **options})
    keep(kernel, function)
    return kernel


def keep(compiling: Any, function: Any) -> None:
    """Let numba keep what it compiles of a function where this package keeps its kernels."""
    try:
        compiling._cache = _Cache(function)
    except RuntimeError:
        _log.info("no folder to keep compiled kernels in: they are compiled at every start")
