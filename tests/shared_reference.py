"""Where the reference files are that are not part of the project, for the tests that read them."""

from __future__ import annotations

import os
from pathlib import Path

_MISSING = Path("reference files not found")


def reference_folder() -> Path:
    """EXUDYN_WHEELSET_REFERENCE, or the nearest shared/reference beside or above the repository."""
    given = os.environ.get("EXUDYN_WHEELSET_REFERENCE")
    if given:
        return Path(given)
    for folder in Path(__file__).resolve().parents[2:]:
        if (folder / "shared" / "reference").is_dir():
            return folder / "shared" / "reference"
    return _MISSING
