"""Each layer of the package knows only those below it: the imports of all its files, read as text.

The layers, from the bottom up; what stands in one row may know each other. docs/theory.md and the
folders' own headers say what each of them is for.
"""

import ast
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "exudyn_wheelset"
LAYERS = (
    (
        "errors",
        "arrays",
        "constants",
        "checking",
        "kinds",
        "spelling",
        "locking",
        "compilation",
        "addresses",
        "apart",
        "whole_code",
    ),
    ("track",),
    ("creep", "profiles", "results", "studies"),
    ("contact",),
    ("geometry",),
    ("coupling",),
    ("vehicles",),
    ("systems",),
    ("stability", "catalogue"),
    ("front",),
)
HEIGHT = {name: height for height, row in enumerate(LAYERS) for name in row}


def imported(path: Path) -> set[str]:
    """Folders and modules of the package that a file imports, anywhere in it."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom) and node.module:
            assert node.level == 0, f"{path}: import by the whole name"
            modules = [node.module]
            if node.module == PACKAGE.name:
                names_of_it = [alias.name for alias in node.names]
                modules = [f"{node.module}.{name}" for name in names_of_it if name != "__all__"]
        names |= {
            module.split(".")[1] for module in modules if module.startswith(f"{PACKAGE.name}.")
        }
    return names


def test_every_file_knows_only_the_layers_below():
    wrong = []
    for path in sorted(PACKAGE.rglob("*.py")):
        place = path.relative_to(PACKAGE)
        layer = place.parts[0].removesuffix(".py")
        if layer == "__init__":
            continue
        for name in imported(path):
            if HEIGHT[name] > HEIGHT[layer]:
                wrong.append(f"{place} imports {name}, which stands above it")
    assert wrong == []
