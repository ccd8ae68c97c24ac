"""A page for every public name, grouped as the layers of the package are."""

from __future__ import annotations

import inspect
from pathlib import Path

import exudyn_wheelset as package

GROUPS = (
    ("Profiles", ("profiles", "front.profile_report")),
    ("Contact and creep", ("contact", "creep")),
    ("Geometry and conicity", ("geometry",)),
    ("Wheelsets in Exudyn models", ("coupling",)),
    ("Track", ("track",)),
    (
        "Vehicles",
        ("vehicles.builder", "vehicles.description", "vehicles.files", "vehicles.statics"),
    ),
    ("Connections", ("vehicles",)),
    ("Ready-made vehicles", ("catalogue",)),
    ("Systems and simulation", ("systems",)),
    ("Stability", ("stability",)),
    ("Results and studies", ("results", "studies")),
    ("Front and settings", ("front",)),
    ("Errors and warnings", ("errors",)),
)
LAST = "Others"


def group_of(place: str) -> str:
    """The group of a module's path."""
    for title, places in GROUPS:
        if any(place == one or place.startswith(f"{one}.") for one in places):
            return title
    return LAST


def write_api_pages(folder: Path) -> None:
    """Write a page for each public name, and one that lists them."""
    folder.mkdir(exist_ok=True)
    pages: dict[str, list[str]] = {title: [] for title, _ in GROUPS} | {LAST: []}
    kept = {"index.md"}
    for name, place in sorted(package._PLACES.items(), key=lambda pair: pair[0].lower()):
        pages[group_of(place)].append(name)
        is_class = inspect.isclass(getattr(package, name))
        directive = "autoclass" if is_class else "autofunction"
        members = "   :members:\n" if is_class and place != "errors" else ""
        text = (
            f"{name}\n{'=' * len(name)}\n\n"
            f".. {directive}:: exudyn_wheelset.{name}\n{members}\n"
            f"Defined below ``exudyn_wheelset.{place}``.\n"
        )
        kept.add(f"{name}.rst")
        _write(folder / f"{name}.rst", text)
    lines = ["# Public names", "", "All of them are imported from `exudyn_wheelset` itself."]
    for title, names in pages.items():
        if names:
            lines += ["", f"## {title}", "", ":::{toctree}", ":maxdepth: 1", ""]
            lines += [*names, ":::"]
    _write(folder / "index.md", "\n".join(lines) + "\n")
    for page in folder.iterdir():
        if page.name not in kept:
            page.unlink()


def _write(path: Path, text: str) -> None:
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
