"""A file held by one process at a time; the system lets go of it when the process ends."""

from __future__ import annotations

import os
import time
from pathlib import Path
from types import TracebackType

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]
    import msvcrt

_PAUSE = 0.02


class FileLock:
    """An exclusive hold on the file at `path`, which is made if it is not there.

    `acquire` waits up to `patience` [s] and tells whether it got the lock; `release` gives it
    back. As a context manager it waits and goes on in either case. A killed process holds nothing.
    """

    def __init__(self, path: str | Path, patience: float = 0.0) -> None:
        self.path = Path(path)
        self.patience = patience
        self._handle: int | None = None

    def acquire(self) -> bool:
        """Wait for the lock; False where another process still holds it, or no file can be made."""
        try:
            handle = os.open(self.path, os.O_RDWR | os.O_CREAT, 0o666)
        except OSError:
            return False
        latest = time.monotonic() + self.patience
        while True:
            try:
                if fcntl is not None:
                    fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                else:
                    msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined]
            except OSError:
                if time.monotonic() >= latest:
                    os.close(handle)
                    return False
                time.sleep(_PAUSE)
            else:
                self._handle = handle
                return True

    def release(self) -> None:
        """Let go of the lock; nothing happens where it is not held."""
        if self._handle is not None:
            os.close(self._handle)
            self._handle = None

    def __enter__(self) -> FileLock:
        self.acquire()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.release()
