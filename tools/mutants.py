"""Changes of one place of a module's source, each of which its tests should notice.

A sign, an arithmetic operator, a constant, a comparison turned around, `and` for `or`, sin for cos,
min for max. Left alone: docstrings, annotations, imports, messages of errors, ranges in which a
parameter is accepted, `strict` of zip, which only checks, and constants up to 1e-3 in size, which
are tolerances and steps of differences: a quarter more of them changes no result.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass

ARITHMETIC = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.Pow: "*"}
SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
COMPARISONS = {
    ast.Lt: ("<", ">="),
    ast.LtE: ("<=", ">"),
    ast.Gt: (">", "<="),
    ast.GtE: (">=", "<"),
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
}
SWAPPED = {
    "sin": "cos",
    "cos": "sin",
    "max": "min",
    "min": "max",
    "atan": "tanh",
    "maximum": "minimum",
}
RANGES = ("CreepParameter", "number", "numbers", "positive")
LEAST_CONSTANT = 1.1e-3


@dataclass(frozen=True)
class Mutant:
    """One change: `before` at a place of a module becomes `after`."""

    module: str
    line: int
    column: int
    before: str
    after: str

    @property
    def key(self) -> str:
        return f"{self.module}:{self.line}:{self.column} {self.before} -> {self.after}"


class _Places(ast.NodeVisitor):
    """Collects the mutants of a module's source."""

    def __init__(self, module: str, source: str) -> None:
        self.module, self.found = module, []
        self.lines = source.splitlines(keepends=True)
        self.visit(ast.parse(source))

    def _add(self, line: int, column: int, before: str, after: str) -> None:
        if self.lines[line - 1][column:].startswith(before):
            self.found.append(Mutant(self.module, line, column, before, after))

    def _between(self, left: ast.AST, right: ast.AST, sign: str, after: str) -> None:
        """An operator between two operands; those on a line of their own are left out."""
        if left.end_lineno != right.lineno:
            return
        text = self.lines[left.end_lineno - 1][left.end_col_offset : right.col_offset]
        if sign in text:
            column = left.end_col_offset + text.index(sign)
            self._add(left.end_lineno, column, sign, after)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        if type(node.op) in ARITHMETIC:
            self._between(node.left, node.right, SIGNS[type(node.op)], ARITHMETIC[type(node.op)])
        self.generic_visit(node)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        if type(node.op) in ARITHMETIC:
            sign, after = SIGNS[type(node.op)], ARITHMETIC[type(node.op)]
            self._between(node.target, node.value, sign + "=", after + "=")
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.USub):
            self._add(node.lineno, node.col_offset, "-", "+")
        self.generic_visit(node)

    def visit_Compare(self, node: ast.Compare) -> None:
        left = node.left
        for operator, right in zip(node.ops, node.comparators, strict=True):
            if type(operator) in COMPARISONS:
                self._between(left, right, *COMPARISONS[type(operator)])
            left = right
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        words = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
        for left, right in zip(node.values[:-1], node.values[1:], strict=True):
            self._between(left, right, *words)
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        value = node.value
        text = ast.unparse(node)
        here = self.lines[node.lineno - 1][node.col_offset : node.end_col_offset]
        if isinstance(value, bool):
            self._add(node.lineno, node.col_offset, text, str(not value))
        elif isinstance(value, int):
            self._add(node.lineno, node.col_offset, here, str(value + 1))
        elif isinstance(value, float) and (value == 0.0 or abs(value) >= LEAST_CONSTANT):
            self._add(node.lineno, node.col_offset, here, repr(1.25 * value or 1.0))

    def visit_Call(self, node: ast.Call) -> None:
        name = node.func.attr if isinstance(node.func, ast.Attribute) else None
        if isinstance(node.func, ast.Name):
            name = node.func.id
        if name in RANGES:
            return
        if name in SWAPPED:
            self._add(
                node.func.end_lineno, node.func.end_col_offset - len(name), name, SWAPPED[name]
            )
        self.generic_visit(node)

    def visit_keyword(self, node: ast.keyword) -> None:
        if node.arg != "strict":
            self.generic_visit(node)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        for part in [*node.args.defaults, *node.args.kw_defaults, *node.body]:
            if part is not None:
                self.visit(part)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.visit(node.value)

    def visit_Raise(self, node: ast.Raise) -> None:
        pass

    visit_Import = visit_ImportFrom = visit_JoinedStr = visit_Raise


def mutants_in(module: str, source: str) -> list[Mutant]:
    """All mutants of a module's source, in its order of places."""
    return _Places(module, source).found


def mutated(source: str, mutant: Mutant) -> str:
    """The source with the mutant's change."""
    lines = source.splitlines(keepends=True)
    line = lines[mutant.line - 1]
    end = mutant.column + len(mutant.before)
    lines[mutant.line - 1] = line[: mutant.column] + mutant.after + line[end:]
    return "".join(lines)
