"""docs/gallery.md: its blocks run, and make the pictures that stand beside them."""

import re
import sys
import warnings
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

from exudyn_wheelset import WheelsetWarning

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs" / "figures"))
import make_gallery  # noqa: E402


def test_every_picture_is_made_by_a_block_below_it():
    """Between a picture of the gallery's own and the next, the block that writes it."""
    text = make_gallery.PAGE.read_text(encoding="utf-8")
    names = make_gallery.pictures()
    assert len(names) >= 15 and len(set(names)) == len(names)
    for part in re.split(r"^(?=!\[)", text, flags=re.M)[1:]:
        found = re.match(r"!\[[^]]+\]\(figures/gallery/([\w.]+)\)", part)
        if found:
            assert f'"{found[1]}"' in part, found[1]


def test_pictures_in_the_folder_are_those_of_the_page():
    kept = {path.name for path in make_gallery.FOLDER.glob("*.png")}
    assert kept == set(make_gallery.pictures())


@pytest.mark.slow
def test_the_blocks_of_the_page_make_its_pictures(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", WheelsetWarning)
        make_gallery.draw(tmp_path)
    plt.close("all")
    for name in make_gallery.pictures():
        picture = plt.imread(tmp_path / name)
        # Something is drawn: not all of one colour.
        assert picture[..., :3].std() > 0.01, name
