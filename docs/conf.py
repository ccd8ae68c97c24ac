"""The site: `sphinx-build -W docs site` (see `.ci/run`); it opens from a folder, offline."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_site"))

from api_pages import write_api_pages  # noqa: E402

from exudyn_wheelset import __version__  # noqa: E402

project = "exudyn_wheelset"
author = "the exudyn_wheelset authors"
release = version = __version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.viewcode",
    "plain_docstrings",
    "numpydoc",
    "offline_math",
]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["_site", "figures/*.py"]
html_theme = "furo"
html_title = "exudyn_wheelset"
html_static_path: list[str] = []
html_show_sourcelink = False
html_copy_source = False
# Formulas become MathML, which browsers draw themselves: no script is loaded from anywhere.
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4
myst_dmath_double_inline = True
numpydoc_show_class_members = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_default_options = {"members": True, "undoc-members": False}
default_role = "code"
nitpicky = False
# The first lines of a code fence of commands.
highlight_language = "python"
# Links to files and folders of the repository are held by tests/test_docs_code.py.
suppress_warnings = ["myst.header", "myst.xref_missing"]

write_api_pages(HERE / "api")
