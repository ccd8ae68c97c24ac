"""Where an entry stands in the text of a TOML file, for messages."""

from __future__ import annotations

import re

_HEADER = re.compile(r"^\s*\[(\[?)\s*([^\[\]]+?)\s*\]\]?\s*(#.*)?$")


def line_of(text: str, table: str, number: int = 0, key: str = "") -> int | None:
    """Line (from 1) of a key of a table, of the table itself where the key is not found.

    table: name of the header, "" for the top of the file; number: of a [[table]], from 0; None for
    what is not found, such as a table that is written inline.
    """
    name = key.split(".")[0]
    found = None if table else 1
    count, inside = -1, not table
    for place, line in enumerate(text.splitlines(), start=1):
        header = _HEADER.match(line)
        if header:
            of = header[2].strip("\"' ")
            if of == table:
                count += 1
                inside = count == number
                found = place if inside else found
            elif inside and name and of == f"{table}.{name}":
                return place
            elif not of.startswith(f"{table}."):
                inside = False
        elif inside and name and re.match(rf"""\s*["']?{re.escape(name)}["']?\s*[.=]""", line):
            return place
    return found
