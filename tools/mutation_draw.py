"""Fresh draws of mutants, folder by folder: the honest score of the tests.

    python -m coverage run --rcfile=tools/coverage.ini -m pytest -m "not slow" --durations=0 \
        --durations-min=0.02 > tests.log
    python tools/mutation_draw.py systems --count 40 --seed 301 --coverage cov.data --log tests.log

Mutants (mutants.py) are drawn evenly over all places of a folder. Where a line runs as Python, the
tests that run it are known from the coverage (dynamic_context = test_function): the quickest of
them are run, up to SECONDS. Kernels leave no trace there: theirs are the groups of mutation_run.py.
Results, with the seed of each, go to --results (and the tables to docs/mutation.md); --again runs
the survivors once more and notes under "since" the test that notices now.
"""

from __future__ import annotations

import argparse
import ast
import json
import random
import re
import shutil
import tempfile
from collections import defaultdict
from dataclasses import asdict, replace
from pathlib import Path

import coverage
from mutants import Mutant, mutated
from mutation_run import FAILED, GROUPS, PACKAGE, REPOSITORY, _seed, mutants_of, run_tests
from mutation_upper import Group

# Tests of a mutant, by the log's durations [s]; a test alone may take longer.
SECONDS = 30.0
MOST_TESTS = 60
# A run that takes longer than this has lost its way [s].
LIMIT = 90.0
# What is drawn on a screen is looked at, and not drawn from.
DISPLAY = ("vehicles/shapes.py", "vehicles/links.py", "stability/hunting/branch_plot.py")
PAGE = REPOSITORY / "docs" / "mutation-draws.json"
_DURATION = re.compile(r"^([\d.]+)s (?:call|setup) +(tests/\w+\.py)::(\w+)", re.MULTILINE)


def durations(log: Path) -> dict[str, float]:
    """Seconds of each test function, its parameters together, by file::name."""
    found: dict[str, float] = defaultdict(float)
    for seconds, file, name in _DURATION.findall(log.read_text(encoding="utf-8")):
        found[f"{file}::{name}"] += float(seconds)
    return found


class Coverage:
    """Which test functions run a line of the package as Python."""

    def __init__(self, file: Path, log: Path) -> None:
        self.data = coverage.CoverageData(str(file))
        self.data.read()
        self.seconds = durations(log)
        self.files = {
            name.split(f"/{PACKAGE}/", 1)[1]: name
            for name in self.data.measured_files()
            if f"/{PACKAGE}/" in name
        }

    def tests_of(self, mutant: Mutant, source: str) -> list[str]:
        """Quickest test functions that run the statement of a mutant."""
        name = self.files.get(mutant.module)
        if name is None:
            return []
        by_line = self.data.contexts_by_lineno(name)
        contexts = {c for line in _statement(source, mutant.line) for c in by_line.get(line, ())}
        by_file: dict[str, list[tuple[float, str]]] = defaultdict(list)
        for context in contexts:
            file, _, test = context.rpartition(".")
            node = f"tests/{file}.py::{test}"
            if file.startswith("test_") and "." not in file:
                by_file[file].append((self.seconds.get(node, 0.02), node))
        # Files that name the module first; of each the quickest, then the second ones.
        stem = Path(mutant.module).stem
        found = []
        for file, tests in by_file.items():
            text = (REPOSITORY / "tests" / f"{file}.py").read_text(encoding="utf-8")
            apart = stem not in text
            found += [(apart, k, *test) for k, test in enumerate(sorted(tests))]
        chosen, total = [], 0.0
        for _, _, seconds, node in sorted(found)[:MOST_TESTS]:
            if chosen and total + seconds > SECONDS:
                continue
            total += seconds
            chosen.append(node)
        return chosen


def _statement(source: str, line: int) -> range:
    """Lines of the innermost statement at a line, of a compound one its head."""
    best = range(line, line + 1)
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.stmt) and node.lineno <= line <= node.end_lineno:
            body = getattr(node, "body", None)
            end = body[0].lineno - 1 if body else node.end_lineno
            if line <= max(end, node.lineno) and not isinstance(node, ast.ClassDef):
                best = range(node.lineno, max(end, node.lineno) + 1)
    return best


def groups_of(module: str) -> list[Group]:
    return [replace(group) for group in GROUPS.values() if module in group.modules]


def survivors(folder: str, seed: int, results: dict) -> list[tuple[str, Mutant]]:
    """Mutants of a draw that nothing has noticed, where their lines are still there."""
    found = []
    for key, entry in results.items():
        if (entry["folder"], entry["seed"], entry["status"]) != (folder, seed, "survived"):
            continue
        for mutant in mutants_of(entry["module"]):
            source = (REPOSITORY / PACKAGE / mutant.module).read_text(encoding="utf-8")
            same = all(getattr(mutant, n) == entry[n] for n in ("column", "before", "after"))
            if same and source.splitlines()[mutant.line - 1].strip() == entry["source"]:
                found.append((key, mutant))
                break
    return found


def drawn(folder: str, arguments: argparse.Namespace) -> list[Mutant]:
    """Mutants of all modules in a folder, drawn by the seed."""
    paths = sorted((REPOSITORY / PACKAGE / folder).rglob("*.py"))
    names = [path.relative_to(REPOSITORY / PACKAGE).as_posix() for path in paths]
    places = [mutant for name in names if name not in DISPLAY for mutant in mutants_of(name)]
    count = min(arguments.count, len(places))
    return random.Random(arguments.seed).sample(places, count)


def run_draw(
    folder: str,
    seed: int,
    pending: list[tuple[str, Mutant]],
    lines: Coverage,
    results: dict,
    file: Path,
) -> None:
    """Run mutants by their keys in the results; write the file after each."""
    with tempfile.TemporaryDirectory() as place:
        copy, cache = Path(place, "repository"), Path(place, "kernels")
        _seed(cache)
        ignored = shutil.ignore_patterns(".git", ".venv", "*.egg-info", "__pycache__", "out")
        shutil.copytree(REPOSITORY, copy, ignore=ignored)
        shared = REPOSITORY.parent / "shared"
        if shared.exists():
            Path(place, "shared").symlink_to(shared.resolve())
        standing: dict[str, bool] = {}
        for key, mutant in pending:
            path = copy / PACKAGE / mutant.module
            source = path.read_text(encoding="utf-8")
            tests = lines.tests_of(mutant, source)
            mine = groups_of(mutant.module)
            stages = [group for group in mine if not group.compiled]
            if tests:
                stages.append(Group((), tuple(t.removeprefix("tests/") for t in tests)))
            stages = stages or mine
            path.write_text(mutated(source, mutant), encoding="utf-8")
            outcome, spent = "no test", 0.0
            for stage in stages:
                outcome, seconds = run_tests(copy, stage, cache, LIMIT)
                spent += seconds
                if outcome != "passed":
                    break
            path.write_text(source, encoding="utf-8")
            by = _noticed(copy)
            if outcome == "failed" and not _stands(copy, by, stage, cache, standing):
                outcome = "no test"
            status = "survived" if outcome in ("passed", "no test") else "killed"
            line = source.splitlines()[mutant.line - 1].strip()
            if key in results:
                results[key]["since"] = f"`{by}`" if status == "killed" else ""
            else:
                results[key] = {
                    **asdict(mutant), "folder": folder, "seed": seed, "status": status,
                    "how": outcome, "by": by, "seconds": round(spent, 1), "source": line,
                }  # fmt: skip
            file.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
            print(f"  {status:9s}{spent:6.1f} s {outcome:8s}{mutant.key}   | {line}", flush=True)


def _noticed(copy: Path) -> str:
    file = copy / FAILED
    return file.read_text(encoding="utf-8") if file.exists() else ""


def _stands(copy: Path, by: str, stage: Group, cache: Path, standing: dict[str, bool]) -> bool:
    """Whether the test that noticed (or all, if none could run) passes without the mutant."""
    tests = (by.removeprefix("tests/"),) if by else stage.tests
    name = " ".join(tests)
    if name not in standing:
        standing[name] = run_tests(copy, replace(stage, tests=tests), cache, LIMIT)[0] == "passed"
    return standing[name]


def table(results: dict) -> str:
    """Score of every draw, then the survivors."""
    rows = ["| folder | seed | drawn | killed | equivalent | score | without these | since |"]
    rows += ["|---|---|---|---|---|---|---|---|"]
    draws = sorted({(e["folder"], e["seed"]) for e in results.values()})
    for folder, seed in draws:
        mine = [e for e in results.values() if (e["folder"], e["seed"]) == (folder, seed)]
        killed = sum(e["status"] == "killed" for e in mine)
        same = sum(bool(e.get("equivalent")) for e in mine)
        score, able = 100 * killed / len(mine), 100 * killed / max(len(mine) - same, 1)
        since = sum(bool(e.get("since")) for e in mine)
        cells = (folder, seed, len(mine), killed, same, f"{score:.0f} %", f"{able:.0f} %", since)
        rows.append(f"| {' | '.join(map(str, cells))} |")
    rows += ["", "| survivor | change | line | why, or the test since |", "|---|---|---|---|"]
    for entry in results.values():
        if entry["status"] == "survived":
            why = entry.get("equivalent") or entry.get("since") or entry.get("why", "")
            line = entry["source"].replace("|", "/")
            rows.append(
                f"| {entry['module']}:{entry['line']} | `{entry['before']}` to `{entry['after']}` "
                f"| `{line}` | {why} |"
            )
    return "\n".join(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--coverage", type=Path)
    parser.add_argument("--log", type=Path)
    parser.add_argument("--results", type=Path, default=PAGE)
    parser.add_argument("--table", action="store_true", help="print the tables only")
    parser.add_argument("--again", action="store_true", help="run the survivors once more")
    arguments = parser.parse_args()
    file = arguments.results
    results = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    if not arguments.table:
        lines = Coverage(arguments.coverage, arguments.log)
        for folder in arguments.folders:
            print(folder, flush=True)
            places = [(f"{arguments.seed} {m.key}", m) for m in drawn(folder, arguments)]
            pending = [(key, mutant) for key, mutant in places if key not in results]
            if arguments.again:
                pending = survivors(folder, arguments.seed, results)
            run_draw(folder, arguments.seed, pending, lines, results, file)
    print(table(results))
    if file.resolve() == PAGE:
        page = PAGE.with_name("mutation.md")
        block = f"<!-- draws -->\n{table(results)}\n<!-- end of draws -->"
        text = page.read_text(encoding="utf-8")
        text = re.sub("<!-- draws -->.*<!-- end of draws -->", lambda _: block, text, flags=re.S)
        page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
