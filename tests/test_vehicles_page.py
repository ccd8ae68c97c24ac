"""The page docs/vehicles.md: its code runs as it stands, its critical speeds are those of now."""

import re
from pathlib import Path

import pytest

from exudyn_wheelset import catalogue, linear_critical_speed

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


@pytest.mark.filterwarnings("ignore::exudyn_wheelset.WheelsetWarning")
@pytest.mark.parametrize(
    "name", ["dtu_car", "manchester_coach", "cooperrider_bogie_3d", "three_axle_truck"]
)
def test_law_and_critical_speed_of_the_table(name):
    row = next(r for r in PAGE.read_text("utf-8").splitlines() if r.startswith(f"| `{name}`"))
    law, said = (cell.strip() for cell in row.strip("|").split("|")[-2:])
    speed, frequency = map(float, re.match(r"([\d.]+) m/s, ([\d.]+) Hz", said).groups())
    vehicle = catalogue.vehicle(name)
    found = linear_critical_speed(vehicle, *catalogue.entry(name).searched)
    assert law == f"`{vehicle.contact.creep}`"
    assert (found.speed, found.frequency) == pytest.approx((speed, frequency), abs=0.02)
