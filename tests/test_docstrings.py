"""Every public name has a docstring with an example, and the example prints what it says."""

import doctest
import inspect

import pytest

import exudyn_wheelset as ew

NAMES = [name for name in ew.__all__ if name != "__version__" and name not in ew._FOLDERS]
FINDER = doctest.DocTestFinder(recurse=False)


def examples(name):
    """The examples of a public name, an empty list where it has none."""
    found = FINDER.find(getattr(ew, name), name, globs={})
    return [test for test in found if test.examples]


def test_every_public_name_has_an_example():
    assert [name for name in NAMES if not examples(name)] == []


def test_every_public_name_says_what_it_is():
    """A sentence first; functions with arguments say more than that."""
    for name in NAMES:
        text = inspect.getdoc(getattr(ew, name)) or ""
        first = text.partition("\n\n")[0]
        assert first.rstrip().endswith((".", ":")), (name, first)


@pytest.mark.parametrize("name", NAMES)
def test_example_prints_what_it_says(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    said = []
    for test in examples(name):
        runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
        runner.run(test, out=said.append)
        assert runner.failures == 0, "".join(said)
