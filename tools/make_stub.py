"""Writes exudyn_wheelset/__init__.pyi: the public names as type checkers and editors see them.

The package loads them at their first use (`_PLACES` in __init__.py), which no static tool follows.
Run `python tools/make_stub.py` after a change of the names; a test holds both equal.
"""

from __future__ import annotations

from pathlib import Path

import exudyn_wheelset

STUB = Path(exudyn_wheelset.__file__).with_suffix(".pyi")


def stub() -> str:
    """Text of the stub: one import for each module that has public names."""
    modules: dict[str, list[str]] = {}
    for name, place in exudyn_wheelset._PLACES.items():
        modules.setdefault(f"exudyn_wheelset.{place}", []).append(name)
    lines = [f"from exudyn_wheelset import {name} as {name}" for name in exudyn_wheelset._FOLDERS]
    for module in sorted(modules):
        lines += [f"from {module} import {name} as {name}" for name in sorted(modules[module])]
    names = "".join(f'    "{name}",\n' for name in exudyn_wheelset.__all__)
    return "\n".join([*lines, "", "__version__: str", f"__all__ = [\n{names}]", ""])


if __name__ == "__main__":
    STUB.write_text(stub(), encoding="utf-8")
    print(STUB)
