"""The README's script against statics: its wheelset, left alone on straight track, runs centred."""

import contextlib
import io
import re
from pathlib import Path

import pytest

README = Path(__file__).parents[1] / "README.md"


def test_script_of_the_readme(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (script,) = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), flags=re.S)
    names: dict = {}
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(script, names)
    # 1500 kg and 100 kN on two wheels. After two seconds the hunting has died down; the bounce on
    # the undamped contact, 1.9 times the load when it is let go, has not quite.
    half = 0.5 * (1500 * 9.81 + 100e3)
    left = names["left"]
    assert left[-250:].mean() == pytest.approx(half, rel=1e-3)
    assert left[-1] == pytest.approx(half, rel=0.01)
    assert printed.getvalue() == (
        f"left wheel: {left[-1] / 1e3:.1f} kN; the planned end was reached\n"
    )
    assert list(tmp_path.iterdir()) == []
