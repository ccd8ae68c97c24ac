"""Mutation run: does the test suite notice when a kernel is wrong?

    python tools/mutation_run.py                     all groups, as docs/mutation.md has them
    python tools/mutation_run.py creep hertz --count 10 --seed 3
    python tools/mutation_run.py --table             only print what has been found so far

Each mutant is one change of one place of one module (mutants.py). It is written into a copy of the
repository and the tests of its group run on it; a mutant that no test notices has survived. Places
are drawn by a seed. Results are kept after each mutant (--results; by default docs/mutation.json,
from which the tables of docs/mutation.md are made), so that a run can be broken off and taken up
again; a mutant is known by its module, line and change. An entry of the results may say under
"equivalent" why the change cannot alter a result; the tables count it with and without those.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import re
import shutil
import signal
import sys
import tempfile
import time
from dataclasses import asdict
from pathlib import Path

import exudyn  # noqa: F401
import hypothesis  # noqa: F401
import matplotlib
import numba
import pytest
import scipy.integrate
import scipy.interpolate
import scipy.optimize
import scipy.special  # noqa: F401
from mutants import Mutant, mutants_in, mutated
from mutation_upper import UPPER_GROUPS, Group
from numba.misc.appdirs import AppDirs

matplotlib.use("Agg")

REPOSITORY = Path(__file__).resolve().parents[1]
PACKAGE = "exudyn_wheelset"
PAGE = REPOSITORY / "docs" / "mutation.md"
# In the copy: the test that noticed.
FAILED = "failed-test.txt"

_ENERGY = tuple(
    f"contact/{name}.py"
    for name in (
        "ellipsoids", "energy", "gap", "gap_spline", "load_sets", "loads", "load_patches",
        "energy_side",
    )
)  # fmt: skip
GROUPS = {
    "creep": Group(
        (
            "creep/linear.py",
            "creep/kalker.py",
            "creep/saturation.py",
            "creep/vermeulen_johnson.py",
            "creep/shen_hedrick_elkins.py",
            "creep/polach.py",
            "creep/polach_2005.py",
            "creep/polach_kalker.py",
        ),
        (
            "test_creep_saturation.py",
            "test_kalker_table.py",
            "test_creep_polach_paper.py",
            "test_creep_polach_kalker.py",
            "test_creep_curves_contact.py",
            "test_creep_properties.py",
        ),
        compiled=False,
        deselected="exact or fastsim or continuity or adhere or bound",
    ),
    "slopes": Group(
        ("creep/slopes.py",), ("test_creep_slopes.py",), compiled=False, deselected="hundredth"
    ),
    "fastsim": Group(
        ("creep/fastsim.py", "creep/fastsim_rows.py"),
        (
            "test_creep_saturation.py",
            "test_creep_fastsim_theory.py",
            "test_creep_curves_contact.py",
        ),
        compiled=False,
        deselected="exact",
    ),
    "hertz": Group(("contact/hertz.py",), ("test_hertz_elliptic_integrals.py",), compiled=False),
    "locus": Group(
        ("contact/locus.py", "contact/creepage.py"),
        ("test_contact_locus_of_a_turned_wheel.py",),
        compiled=False,
    ),
    "reduction": Group(
        ("systems/reduction.py",), ("test_reduction_by_rotation_matrices.py",), compiled=False
    ),
    "rigid": Group(
        ("geometry/gap.py", "geometry/rigid.py"),
        ("test_contact_geometry_against_CONTACT.py", "test_piecewise_geometry_between_samples.py"),
        compiled=False,
        deselected="pieces or residual or tolerance or figure_3 or noise or mirror or between_the",
    ),
    "conicity": Group(
        ("geometry/conicity.py", "geometry/rolling_radius.py"),
        ("test_conicity_closed_forms.py", "test_conicity_of_unlike_pairs.py"),
    ),
    "piecewise": Group(("geometry/piecewise.py",), ("test_piecewise_geometry_between_samples.py",)),
    "contact": Group(
        ("contact/search.py", "contact/patches.py", "contact/forces.py"),
        (
            "test_contact_scan.py",
            "test_wrench_of_the_patches.py",
            "test_contact_against_CONTACT.py",
            "test_patches_of_a_sliding_wheelset.py",
        ),
        compiled=False,
    ),
    "energy": Group(
        _ENERGY,
        (
            "test_pieces_of_the_stored_energy.py",
            "test_lines_of_force.py",
            "test_equations_of_the_loads.py",
        ),
        compiled=False,
    ),
    "energy-of-wheels": Group(
        _ENERGY,
        ("test_contact_energy.py",),
        compiled=False,
        deselected="loops or stiffness or half_space or worn",
    ),
    "strips": Group(
        tuple(f"contact/strip{name}.py" for name in ("s", "_creep", "_patches", "_side")),
        ("test_creep_saturation.py", "test_strips_against_half_space.py"),
    ),
    "tables": Group(
        tuple(f"contact/{name}.py" for name in ("tables", "curve", "rail_section", "layout")),
        (
            "test_contact_scan.py",
            "test_contact_locus_of_a_turned_wheel.py",
            "test_lines_of_force.py",
            "test_equations_of_the_loads.py",
            "test_wheel_values_by_hand.py",
        ),
        compiled=False,
    ),
    "friction": Group(("contact/friction.py",), ("test_friction_by_rail_zone_and_slip.py",)),
    "changing-rails": Group(("contact/changing_rails.py",), ("test_rails_that_change.py",)),
    "local": Group(
        ("contact/virtual_penetration.py", "contact/patch_curvature.py", "contact/sides_apart.py"),
        ("test_virtual_penetration.py",),
        compiled=False,
    ),
    "exact": Group(
        tuple(f"creep/{name}.py" for name in ("exact", "exact_nodes", "cerruti", "exact_apart")),
        ("test_creep_exact_theory.py",),
    ),
    "exact-table": Group(("creep/exact_table.py",), ("test_creep_exact_table.py",)),
    "laws": Group(
        tuple(f"creep/{name}.py" for name in ("kernel", "kernel_apart", "own", "registry")),
        ("test_creep_own_law.py", "test_creep_properties.py"),
    ),
}
GROUPS |= UPPER_GROUPS


def mutants_of(module: str) -> list[Mutant]:
    """All mutants of a module."""
    return mutants_in(module, (REPOSITORY / PACKAGE / module).read_text(encoding="utf-8"))


def chosen(group: Group, count: int, seed: int) -> list[Mutant]:
    """`count` mutants of the group's modules, drawn by the seed."""
    places = [mutant for module in group.modules for mutant in mutants_of(module)]
    return random.Random(seed).sample(places, min(count, len(places)))


def run_tests(copy: Path, group: Group, cache: Path, limit: float) -> tuple[str, float]:
    """Whether the tests pass on the copy ("passed", "failed", "timeout"), and the seconds.

    In a fork of this process, in which the libraries are loaded and the package is not.
    """
    (copy / FAILED).unlink(missing_ok=True)
    before, start = set(cache.iterdir()), time.monotonic()
    child = os.fork()
    if child == 0:
        os._exit(_test_here(copy, group, cache))
    code = None
    while code is None and time.monotonic() - start < limit:
        found, status = os.waitpid(child, os.WNOHANG)
        if found:
            code = os.waitstatus_to_exitcode(status)
        else:
            time.sleep(0.05)
    if code is None:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
    if group.compiled and before:
        for folder in set(cache.iterdir()) - before:
            shutil.rmtree(folder, ignore_errors=True)
    outcome = "timeout" if code is None else "passed" if code == 0 else "failed"
    return outcome, time.monotonic() - start


def _test_here(copy: Path, group: Group, cache: Path) -> int:
    """Exit status of pytest in this process, on the copy."""
    quiet = os.open(os.devnull, os.O_WRONLY)
    os.dup2(quiet, 1)
    os.dup2(quiet, 2)
    os.chdir(copy)
    sys.path[:0] = [str(copy), str(copy / "tests")]
    numba.config.CACHE_DIR = str(cache)
    numba.config.DISABLE_JIT = 0 if group.compiled else 1
    options = ["-x", "-q", "-n0", "-p", "no:cacheprovider", "-p", "no:randomly"]
    if group.deselected:
        options += ["-k", f"not ({group.deselected})"]
    tests = [str(copy / "tests" / name) for name in group.tests]
    try:
        return int(pytest.main([*options, *tests], plugins=[_Failure(copy / FAILED)]))
    except BaseException:
        return 1


class _Failure:
    """Writes the name of the test that failed to a file."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.file.write_text(report.nodeid, encoding="utf-8")


def run_group(name: str, count: int, seed: int, results: dict, file: Path) -> None:
    """Run the group's mutants that are not in `results` yet; write the file after each."""
    group = GROUPS[name]
    pending = [m for m in chosen(group, count, seed) if m.key not in results]
    if not pending:
        return
    with tempfile.TemporaryDirectory() as folder:
        copy, cache = Path(folder, "repository"), Path(folder, "kernels")
        _seed(cache)
        ignored = shutil.ignore_patterns(".git", ".venv", "*.egg-info", "__pycache__", "out")
        shutil.copytree(REPOSITORY, copy, ignore=ignored)
        outcome, usual = run_tests(copy, group, cache, 3600.0)
        if outcome != "passed":
            raise SystemExit(f"{name}: the tests do not pass without a mutation ({outcome})")
        print(f"{name}: {len(pending)} mutants, tests take {usual:.0f} s", flush=True)
        for mutant in pending:
            path = copy / PACKAGE / mutant.module
            source = path.read_text(encoding="utf-8")
            path.write_text(mutated(source, mutant), encoding="utf-8")
            outcome, seconds = run_tests(copy, group, cache, 30.0 + 2.0 * usual)
            path.write_text(source, encoding="utf-8")
            status = "survived" if outcome == "passed" else "killed"
            line = source.splitlines()[mutant.line - 1].strip()
            results[mutant.key] = {
                **asdict(mutant), "group": name, "status": status, "how": outcome,
                "seconds": round(seconds, 1), "source": line,
            }  # fmt: skip
            file.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
            print(f"  {status:9s}{seconds:6.1f} s  {mutant.key}   | {line}", flush=True)


def _seed(cache: Path) -> None:
    """Begin with the user's compiled kernels, as links: they are kept by content."""
    kept = Path(AppDirs(PACKAGE, appauthor=False).user_cache_dir)
    try:
        shutil.copytree(kept, cache, copy_function=os.link)
    except OSError:
        shutil.rmtree(cache, ignore_errors=True)
        cache.mkdir()


def table(results: dict) -> str:
    """Score by module, and the survivors."""
    rows = ["| module | mutants | killed | score |", "|---|---|---|---|"]
    modules = sorted({entry["module"] for entry in results.values()})
    for module in [*modules, "all"]:
        mine = [e for e in results.values() if module in (e["module"], "all")]
        killed = sum(entry["status"] == "killed" for entry in mine)
        rows.append(f"| {module} | {len(mine)} | {killed} | {100 * killed / len(mine):.0f} % |")
    able = [entry for entry in results.values() if not entry.get("equivalent")]
    killed = sum(entry["status"] == "killed" for entry in able)
    score = 100 * killed / max(len(able), 1)
    rows.append(f"| without equivalents | {len(able)} | {killed} | {score:.0f} % |")
    rows += ["", "| survivor | change | line | why nothing can change |", "|---|---|---|---|"]
    for entry in results.values():
        if entry["status"] == "survived":
            change = f"`{entry['before']}` to `{entry['after']}`"
            place = f"{entry['module']}:{entry['line']}"
            line = entry["source"].replace("|", "/")
            rows.append(f"| {place} | {change} | `{line}` | {entry.get('equivalent', '')} |")
    return "\n".join(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("groups", nargs="*", help=f"of {', '.join(GROUPS)}; default: all")
    parser.add_argument("--count", type=int, default=20, help="mutants drawn of each group")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--results", type=Path, default=PAGE.with_suffix(".json"))
    parser.add_argument(
        "--again", action="store_true", help="run the survivors of those groups once more"
    )
    parser.add_argument("--table", action="store_true", help="print the results so far only")
    arguments = parser.parse_args()
    file = arguments.results
    results = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    if arguments.again:
        chosen = {m for name in arguments.groups or GROUPS for m in GROUPS[name].modules}
        results = {
            key: e
            for key, e in results.items()
            if e["status"] == "killed" or e.get("equivalent") or e["module"] not in chosen
        }
    if not arguments.table:
        file.parent.mkdir(parents=True, exist_ok=True)
        for name in arguments.groups or GROUPS:
            run_group(name, arguments.count, arguments.seed, results, file)
    print(table(results))
    if file.resolve() == PAGE.with_suffix(".json"):
        text = PAGE.read_text(encoding="utf-8")
        block = f"<!-- results -->\n{table(results)}\n<!-- end of results -->"
        text = re.sub(
            "<!-- results -->.*<!-- end of results -->", lambda _: block, text, flags=re.S
        )
        PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
