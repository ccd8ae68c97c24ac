"""Loading profiles by name or from a file, and saving them.

A bare name ("S1002", "UIC60", "AAR_1_20", "knife_edge", "cone_1_20", "cone_0.05" and cones of any
conicity) is one of the profiles that come with the package; anything else is a path.
"""

from __future__ import annotations

import importlib.resources
import os
import re
from pathlib import Path

import numpy as np

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles import shapes
from exudyn_wheelset.profiles.formats import two_column
from exudyn_wheelset.profiles.profile import Profile

BUNDLED = ("S1002", "UIC60", "AAR_1_20", "cone_1_20", "knife_edge")
_UNITS = {"mm": 1e-3, "m": 1.0, "cm": 1e-2, "inch": 0.0254, "in": 0.0254}


def load_profile(
    name_or_path: str | os.PathLike[str] | Profile,
    *,
    kind: str | None = None,
    unit: str | None = None,
    smoothing: float = 0.0,
) -> Profile:
    """A profile by its name or from a file; a Profile passes through.

    kind: "wheel" or "rail" where the file does not say; unit: "mm", "m", "cm" or "inch" likewise;
    smoothing: rms distance of the points to the curve [m].
    Raises ProfileError, which names the file, the line and the mend.
    """
    if isinstance(name_or_path, Profile):
        return name_or_path.smoothed(smoothing) if smoothing else name_or_path
    bundled = _bundled(os.fspath(name_or_path))
    if bundled is not None:
        return bundled.smoothed(smoothing) if smoothing else bundled
    path = Path(name_or_path)
    if not path.is_file():
        raise ProfileError(
            f"{path}: no such file, and no profile of that name; names are {', '.join(BUNDLED)} "
            "and cone_<conicity>"
        )
    return _parse(path.read_text(), str(path), kind, unit, smoothing)


def save_profile(profile: Profile, path: str | os.PathLike[str], format: str | None = None) -> Path:
    """Write the profile as a two-column text file; returns the path."""
    target = Path(path)
    target.write_text(two_column.write(profile))
    return target


def _bundled(name: str) -> Profile | None:
    plain = re.sub(r"[\s_-]+", "", name).lower()
    cone = re.fullmatch(r"cone(?:1[:/]?(\d+)|(\d*\.\d+))", plain)
    if cone:
        conicity = 1.0 / float(cone[1]) if cone[1] else float(cone[2])
        return shapes.cone(conicity)
    for stem in BUNDLED:
        if plain == stem.replace("_", "").lower():
            resource = importlib.resources.files("exudyn_wheelset.profile_files") / f"{stem}.txt"
            return _parse(resource.read_text(encoding="utf-8"), stem, None, None, 0.0)
    return None


def _parse(text: str, label: str, kind: str | None, unit: str | None, smoothing: float) -> Profile:
    header = dict(re.findall(r"^# (name|kind|unit|source): (.*)$", text, flags=re.MULTILINE))
    rows = [line.split() for line in text.splitlines() if line.strip() and line[0] != "#"]
    factor = _UNITS[unit or header.get("unit", "mm")]
    points = np.array(rows, dtype=np.float64) * factor
    return Profile(
        header.get("name", label),
        kind or header.get("kind", "wheel"),
        points[:, 0],
        points[:, 1],
        source=header.get("source", ""),
        smoothing=smoothing,
    )
