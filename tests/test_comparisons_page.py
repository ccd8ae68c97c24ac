"""docs/comparisons.md against the script that writes it: every comparison, dated, still true."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs" / "figures"))
import make_comparisons as script  # noqa: E402
from comparisons import OWN  # noqa: E402

SECTIONS = script.sections_of(script.PAGE.read_text(encoding="utf-8"))
# The others take seconds: half-space solutions of 475 states, nine searches for a speed.
QUICK = [
    one
    for one in script.COMPARISONS
    if one.title not in ("Creep with spin on five shapes of patch", "Table 2 of the paper")
]


def rows_of(section):
    lines = [line for line in section.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines[1:]]


def test_every_comparison_has_its_section_and_no_other_is_there():
    assert list(SECTIONS) == [one.title for one in script.COMPARISONS]


@pytest.mark.parametrize("one", script.COMPARISONS, ids=lambda one: one.title)
def test_a_section_has_source_date_versions_and_rows(one):
    section = SECTIONS[one.title]
    assert one.source in section
    assert re.search(r"Run \d{4}-\d\d-\d\d with ", section)
    for name in script.VERSIONS:
        assert re.search(rf"{name} [\d.]+", section), name
    rows = rows_of(section)
    assert rows and all(len(row) == 4 and all(row) for row in rows)


def test_every_reference_file_of_the_project_is_compared_with():
    sources = " ".join(one.source for one in script.COMPARISONS)
    assert [p.name for p in OWN.glob("*.csv") if p.name not in sources] == []


@pytest.mark.parametrize("one", QUICK, ids=lambda one: one.title)
def test_the_page_says_what_the_package_gives_now(one):
    """Where the largest difference is may change sides between machines: then only the words."""
    if one.file and not script.outside(one.file).exists():
        pytest.skip(f"{one.file} not at hand")
    for row, (what, theirs, ours, _) in zip(one.rows(), rows_of(SECTIONS[one.title]), strict=True):
        assert row.what.split(" at ")[0] == what.split(" at ")[0]
        if row.what == what and re.fullmatch(r"[-+.\de]+", ours):
            assert (float(row.theirs), float(row.ours)) == pytest.approx(
                (float(theirs), float(ours)), rel=1e-3
            )


def test_what_is_not_at_hand_stays_as_it_is(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("EXUDYN_WHEELSET_REFERENCE", str(tmp_path))
    monkeypatch.setattr(script, "PAGE", tmp_path / "page.md")
    old = "\n## Equivalent conicity\n\nas it was\n"
    script.PAGE.write_text(old, encoding="utf-8")
    script.main(["conicity", "weightings"])
    assert "en15302 not at hand" in capsys.readouterr().err
    made = script.sections_of(script.PAGE.read_text(encoding="utf-8"))
    assert made["Equivalent conicity"].split() == old.split()
    assert "Frequency weightings of ride comfort" in made
