"""Compiled kernels on disk: dropped when any source changes, warmed up on demand.

numba keeps compiled code beside the sources and looks only at the file of the function itself; a
kernel that calls a changed function of another file would stay as it was. So the compiled files
of this package carry a stamp over all its sources, and go when it no longer fits.
"""

from __future__ import annotations

import hashlib
import sys
import time
from pathlib import Path

PACKAGE = Path(__file__).parent
STAMP = PACKAGE / "__pycache__" / "kernels.stamp"


def drop_stale_kernels() -> bool:
    """Delete the package's compiled kernels if a source has changed; True if any went.

    A place that cannot be written to is left alone: numba then compiles in memory or elsewhere.
    """
    digest = hashlib.sha256()
    for path in sorted(PACKAGE.rglob("*.py")):
        state = path.stat()
        digest.update(f"{path.relative_to(PACKAGE)} {state.st_size} {state.st_mtime_ns}".encode())
    stamp = digest.hexdigest()
    try:
        if STAMP.exists() and STAMP.read_text(encoding="ascii") == stamp:
            return False
        stale = [*PACKAGE.rglob("*.nbi"), *PACKAGE.rglob("*.nbc")]
        for path in stale:
            path.unlink(missing_ok=True)
        STAMP.parent.mkdir(exist_ok=True)
        STAMP.write_text(stamp, encoding="ascii")
    except OSError:
        return False
    return bool(stale)


def warm_up() -> float:
    """Load or compile the kernels of a wheelset on its rails; return the seconds it took.

    Compiling happens once after installation, with a word on the error stream; loading takes a
    few tenths of a second.
    """
    start = time.perf_counter()
    if not any((PACKAGE / "contact").rglob("*.nbi")):
        print("compiling the kernels, once: half a minute or so", file=sys.stderr, flush=True)
    from exudyn_wheelset.contact.descriptions import Track, Wheelset
    from exudyn_wheelset.contact.rigid import contact_geometry
    from exudyn_wheelset.contact.wheelset_contact import contact_forces

    wheelset = Wheelset(mass=1e3, inertia=(500, 100, 500), radius=0.46, wheel="S1002")
    track = Track(rail="UIC60")
    height = contact_geometry(wheelset, track, [1e-3]).z[0] - 5e-5
    contact_forces(wheelset, track, (0, 1e-3, height, 0, 0, 0), (20, 0, 0, 0, 43, 0))
    return time.perf_counter() - start
