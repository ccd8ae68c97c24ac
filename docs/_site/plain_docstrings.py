"""The package's docstrings, which are plain text, as reStructuredText that says the same.

Sentences are escaped; paragraphs laid out in columns or indented keep their lines as they are;
examples stay what they are.
"""

from __future__ import annotations

import re
from typing import Any

_EXAMPLES = re.compile(r"^Examples$")
_COLUMNS = re.compile(r"\S {2,}\S")
_SPECIAL = re.compile(r"([\\*|_])")


def _escaped(line: str) -> str:
    """A line of prose; what stands between backticks becomes code."""
    parts = line.split("`")
    if len(parts) % 2 == 0:
        return _SPECIAL.sub(r"\\\1", line.replace("`", "'"))
    return "".join(
        f"``{part}``" if k % 2 and part.strip() else _SPECIAL.sub(r"\\\1", part)
        for k, part in enumerate(parts)
    )


def plain(lines: list[str]) -> list[str]:
    """Docstring lines as reStructuredText."""
    made: list[str] = []
    paragraphs: list[list[str]] = [[]]
    rest: list[str] = []
    for k, line in enumerate(lines):
        if _EXAMPLES.match(line) and k + 1 < len(lines) and set(lines[k + 1]) == {"-"}:
            rest = lines[k:]
            break
        if line.strip():
            paragraphs[-1].append(line.rstrip())
        elif paragraphs[-1]:
            paragraphs.append([])
    for paragraph in filter(None, paragraphs):
        shaped = any(line.startswith(" ") or _COLUMNS.search(line) for line in paragraph)
        if shaped:
            made += [f"| {_escaped(line)}" for line in paragraph]
        else:
            # A line that begins like a list is none.
            made += [re.sub(r"^([-+*#]|\d+[.)]) ", r"\\\1 ", _escaped(line)) for line in paragraph]
        made.append("")
    return made + rest


def _process(app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    if what == "module" or not name.startswith("exudyn_wheelset"):
        return
    lines[:] = plain(lines)


def setup(app: Any) -> dict[str, Any]:
    """Run before numpydoc, which takes the examples."""
    app.connect("autodoc-process-docstring", _process, priority=100)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
