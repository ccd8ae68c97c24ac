"""Formulas as MathML, made when the site is built: nothing is fetched when it is read."""

from __future__ import annotations

import html
import re
from typing import Any

from latex2mathml.converter import convert

_TAG = re.compile(r"\\tag\{([^}]*)\}")


def _mathml(formula: str, display: str) -> str:
    # Letters with subscripts of several letters are words.
    return convert(formula, display=display)


def visit_inline(self: Any, node: Any) -> None:
    """Write a formula in a line."""
    from docutils import nodes

    self.body.append(f'<span class="math">{_mathml(node.astext(), "inline")}</span>')
    raise nodes.SkipNode


def visit_block(self: Any, node: Any) -> None:
    """Write a formula of its own, its number at the end."""
    from docutils import nodes

    text = node.astext()
    tag = _TAG.search(text)
    number = f'<span style="float:right">({html.escape(tag[1])})</span>' if tag else ""
    parts = _mathml(_TAG.sub("", text), "block")
    self.body.append(f'<div class="math" style="overflow-x:auto">{number}{parts}</div>')
    raise nodes.SkipNode


def setup(app: Any) -> dict[str, Any]:
    """Make the renderer known under the name "mathml"."""
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
