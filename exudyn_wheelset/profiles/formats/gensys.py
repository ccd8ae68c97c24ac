"""GENSYS wheel (.wheel) and rail (.rail) profiles: two columns in millimetres, comments after "#".

Convention (user's manual of the program KPF): y towards the centre of the track on both sides, z
down; wheel: y = 0 at the nominal running circle; rail: y = 0 on top of the rail, 32.5 mm from the
gauge measuring point. So both signs are turned here. The manual states the direction of y for
wheels; rails are read alike.
"""

from __future__ import annotations

from exudyn_wheelset.profiles.formats import two_column
from exudyn_wheelset.profiles.formats.raw import RawProfile

NAME = "GENSYS"


def read(lines: list[str], label: str) -> RawProfile:
    """Read a GENSYS profile; the kind comes from the suffix or from the caller."""
    raw = two_column.read(lines, label)
    raw.format = NAME
    raw.y = [-value for value in raw.y]
    raw.z = [-value for value in raw.z]
    raw.unit = raw.unit or "mm"
    raw.trusted = False
    suffix = label.lower().rsplit(".", 1)[-1]
    if raw.kind is None and suffix in ("wheel", "rail"):
        raw.kind = suffix
    raw.remarks.append("GENSYS: y turned to the field side, z turned up")
    return raw
