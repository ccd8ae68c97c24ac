"""Run the comparisons with other codes and published figures, and write docs/comparisons.md.

    python docs/figures/make_comparisons.py [TITLE ...]

Titles, or words in them, choose what is run; without any, everything: a quarter of a minute. What
needs files that are no part of the project (EXUDYN_WHEELSET_REFERENCE, or shared/reference beside
or above the repository) is left as it stands on the page, with a word, where they are absent.
"""

import re
import sys
from collections.abc import Sequence
from datetime import date

from comparison_rows import REPOSITORY, outside
from comparisons import COMPARISONS, Comparison

from exudyn_wheelset.results.versions import versions

PAGE = REPOSITORY / "docs" / "comparisons.md"
VERSIONS = ("exudyn_wheelset", "exudyn", "numpy", "scipy", "numba")
INTRODUCTION = """\
# Comparisons

Other programs and published figures beside this package, as the last run of
`python docs/figures/make_comparisons.py` found them. Of many points the one with the largest
difference stands here, and where it is. Tests hold the differences within bounds that have their
reasons there. Files named here lie under `tests/reference`; others are not part of the project.
"""


def section(comparison: Comparison) -> str:
    """Run a comparison: its part of the page."""
    rows = comparison.rows()
    found = versions()
    run = ", ".join(f"{name} {found[name]}" for name in VERSIONS)
    lines = [f"## {comparison.title}", "", f"Theirs: {comparison.source}.", ""]
    lines += [f"Run {date.today().isoformat()} with {run}.", ""]
    lines += ["| what | theirs | ours | difference |", "|---|---:|---:|---|"]
    lines += [f"| {r.what} | {r.theirs} | {r.ours} | {r.difference} |" for r in rows]
    return "\n".join(lines) + "\n"


def sections_of(page: str) -> dict[str, str]:
    """Parts of a page by their titles."""
    parts = re.split(r"^(?=## )", page, flags=re.M)[1:]
    return {part.splitlines()[0].removeprefix("## "): part.strip() + "\n" for part in parts}


def main(words: Sequence[str]) -> None:
    """Run the comparisons that the words choose, and write the page."""
    kept = sections_of(PAGE.read_text(encoding="utf-8")) if PAGE.exists() else {}
    made = []
    for one in COMPARISONS:
        wanted = not words or any(word.lower() in one.title.lower() for word in words)
        if wanted and one.file and not outside(one.file).exists():
            print(f"{one.title}: {one.file} not at hand, left as it is", file=sys.stderr)
            wanted = False
        if wanted:
            print(one.title, file=sys.stderr)
            made.append(section(one))
        elif one.title in kept:
            made.append(kept[one.title])
    PAGE.write_text("\n".join([INTRODUCTION, *made]), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
