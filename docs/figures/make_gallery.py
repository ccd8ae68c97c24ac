"""Make the pictures of docs/gallery.md by the code that stands beside them there.

Run `python docs/figures/make_gallery.py`; pictures land in docs/figures/gallery/.
"""

from __future__ import annotations

import os
import re
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "gallery.md"
FOLDER = HERE / "gallery"


def pictures() -> list[str]:
    """Names of the pictures of the page that its own code makes."""
    return re.findall(r"\]\(figures/gallery/([\w.]+)\)", PAGE.read_text(encoding="utf-8"))


def draw(folder: Path) -> None:
    """Run the blocks of the page one after the other in a folder."""
    names = {"__name__": "gallery"}
    before = Path.cwd()
    os.chdir(folder)
    try:
        for block in re.findall(r"^```python\n(.*?)^```", PAGE.read_text("utf-8"), re.S | re.M):
            exec(compile(block, str(PAGE), "exec"), names)
    finally:
        os.chdir(before)


def main() -> None:
    """Draw all of them, and keep those that the page shows."""
    with tempfile.TemporaryDirectory() as folder:
        draw(Path(folder))
        FOLDER.mkdir(exist_ok=True)
        for name in pictures():
            (FOLDER / name).write_bytes((Path(folder) / name).read_bytes())


if __name__ == "__main__":
    main()
