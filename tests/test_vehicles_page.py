"""The page docs/vehicles.md: its code runs as it stands."""

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[1] / "docs" / "vehicles.md"


def test_the_wagon_of_the_page(capsys):
    (code,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    names: dict = {}
    exec(compile(code, str(PAGE), "exec"), names)
    loads, critical = capsys.readouterr().out.strip().splitlines()
    assert loads.startswith("WheelLoads(left=")
    assert "hunting" in critical
    weight = (20e3 + 2 * 1500) * 9.81
    left, right = map(float, re.findall(r"=([\d.]+)", loads))
    assert (left, right) == pytest.approx((weight / 4, weight / 4), rel=1e-6)
    softer = names["softer"].connections
    assert [one.element.stiffness[1] for one in softer if "spring" in one.name] == [0.3e6] * 4
