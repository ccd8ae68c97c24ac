"""The code of README and docs runs, and their links lead somewhere.

The Python blocks of a page run one after the other, in an empty folder with the measured files that
pages speak of. Lines of the command are understood by it, TOML blocks are vehicles. A block that
cannot run has `<!-- not run: reason -->` above it.
"""

import contextlib
import io
import re
import shlex
import warnings
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
from test_profile_formats import miniprof

from exudyn_wheelset import WheelsetWarning, load_profile, load_vehicle, save_profile
from exudyn_wheelset.front.command import PROG, TASKS, task_parser

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
BLOCK = re.compile(
    r"(?:<!-- (not run: [^\n]*?) -->\n)?^```(\w*)\n(.*?)^```\n(?:\n((?:    [^\n]*\n)+))?",
    flags=re.S | re.M,
)
# Run, with more asked of it, by a test of its own.
ELSEWHERE = {
    "your-own-vehicle.md": "tests/test_your_own_vehicle.py",
    "gallery.md": "tests/test_gallery.py",
}
# Diagrams and maps of whole pages.
SLOW = {"stability-maps.md", "track.md"}


def blocks(page, language):
    """Blocks of a language on a page, without those that say why they are not run, each with the
    lines set in below it: what it prints, or commands."""
    found = BLOCK.findall(page.read_text(encoding="utf-8") + "\n")
    return [
        (code, [line.strip() for line in below.splitlines() if not line.strip().startswith(PROG)])
        for reason, kind, code, below in found
        if kind == language and not reason
    ]


def name(page):
    return page.relative_to(ROOT).as_posix()


def with_code(language):
    pages = [page for page in PAGES if blocks(page, language) and page.name not in ELSEWHERE]
    marks = {True: [pytest.mark.slow], False: []}
    return [pytest.param(page, id=name(page), marks=marks[page.name in SLOW]) for page in pages]


def measured_files():
    """What the pages call measured: the package's profiles in the dress of an instrument."""
    folder = Path("measured")
    folder.mkdir()
    wheel, rail = load_profile("S1002"), load_profile("UIC60")
    for file in ("axle3.whl", *(f"wheel_17_section_{k}.whl" for k in range(1, 10))):
        (folder / file).write_text(miniprof(wheel), encoding="utf-8")
    (folder / "rail_0412.ban").write_text(miniprof(rail), encoding="utf-8")
    save_profile(wheel, "worn.prw")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    measured_files()
    yield tmp_path
    plt.close("all")


@pytest.mark.parametrize("page", with_code("python"))
def test_python_of_a_page_runs(page, folder):
    names = {"__name__": page.stem}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", WheelsetWarning)
        for code, expected in blocks(page, "python"):
            with contextlib.redirect_stdout(io.StringIO()) as printed:
                exec(compile(code, name(page), "exec"), names)
            said = [line.strip() for line in printed.getvalue().splitlines()]
            assert [line for line in expected if line not in said] == [], said


@pytest.mark.parametrize("page", with_code("toml"))
def test_toml_of_a_page_is_a_vehicle(page, folder):
    for code, _ in blocks(page, "toml"):
        path = folder / "vehicle.toml"
        path.write_text(code, encoding="utf-8")
        load_vehicle(path, check=False)


def test_lines_of_the_command_are_understood():
    seen = 0
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        lines = re.findall(rf"`({PROG} [^`\n]*)`", text)
        lines += re.findall(rf"^(?:    )?({PROG} [^`\n]*)$", text, flags=re.M)
        for line in lines:
            _, task, *rest = shlex.split(line, comments=True)
            if task in TASKS and not {"TASK", "VEHICLE"} & {task, *rest}:
                try:
                    task_parser(task).parse_args(rest)
                except SystemExit:
                    pytest.fail(f"{name(page)}: {line}")
                seen += 1
    assert seen >= 20


def test_every_link_to_a_file_resolves():
    missing = []
    for page in PAGES:
        text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        for target in re.findall(r"\]\(([^)#\s]+)(?:#[\w-]*)?\)", text):
            if not re.match(r"[a-z]+:", target) and not (page.parent / target).exists():
                missing.append(f"{name(page)}: {target}")
    assert missing == []


def test_every_link_to_a_heading_resolves():
    """GitHub's names of headings: small letters, hyphens for spaces, no other signs."""

    def headings(page):
        found = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), flags=re.M)
        return {re.sub(r"[^\w\- ]", "", title).strip().lower().replace(" ", "-") for title in found}

    missing = []
    for page in PAGES:
        for target, place in re.findall(
            r"\]\(([^)#\s]*)#([\w-]+)\)", page.read_text(encoding="utf-8")
        ):
            there = page if not target else page.parent / target
            if there.suffix == ".md" and place not in headings(there):
                missing.append(f"{name(page)}: {target}#{place}")
    assert missing == []
