"""models/car.py through its numbers: loads against the weight, signs of damping against the Hopf
points, what it writes, wrong input in one line."""

import csv
import importlib.util
import json
from pathlib import Path

import pytest

from exudyn_wheelset import catalogue

SCRIPT = Path(__file__).parents[1] / "models" / "car.py"


def _script():
    spec = importlib.util.spec_from_file_location("car", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


car = _script()


@pytest.fixture(scope="module")
def numbers(tmp_path_factory):
    out = tmp_path_factory.mktemp("car")
    car.HUNT = 0.5
    return car.run("dtu_car", descent=False, out=out), out


def test_wheel_loads_carry_the_weight(numbers):
    numbers, _ = numbers
    vehicle = catalogue.dtu_car()
    masses = [body.mass for body in vehicle.bodies]
    masses += [axle.wheelset.mass for axle in vehicle.wheelsets]
    total = sum(map(sum, numbers["wheel_loads"].values()))
    assert total == pytest.approx(9.81 * sum(masses), rel=1e-6)


def test_hunting_is_undamped_between_its_hopf_points(numbers):
    numbers, _ = numbers
    critical = numbers["linear_critical_speed"]
    assert numbers["hopf"][0] == pytest.approx(critical, abs=1e-5)
    assert numbers["mode_name"].endswith("hunting") or "trucks" in numbers["mode_name"]
    for speed, damping in numbers["damping"].items():
        crossed = sum(point < float(speed) for point in numbers["hopf"])
        # pairs cross one by one: after an even number that came and went the run is straight
        if crossed == 1:
            assert damping < 0.0
    assert numbers["damping"]["60"] < 0.0


def test_files_are_written_and_the_motion_is_a_plain_table(numbers):
    numbers, out = numbers
    names = sorted(path.name for path in out.iterdir())
    assert names == ["car_dtu_car.json", "car_dtu_car.png", "car_dtu_car_hunt.csv"]
    with open(out / "car_dtu_car_hunt.csv", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[0][0] == "t [s]" and len({len(row) for row in rows}) == 1
    assert all(float(cell) is not None for cell in rows[1])


def test_unknown_vehicle_is_one_line(capsys):
    assert car.main(["--vehicle", "dtu_cart", "--json"]) == 2
    assert "dtu_car" in capsys.readouterr().err


def test_json_has_the_promised_keys(capsys):
    assert car.main(["--vehicle", "three_axle_truck", "--json", "--no-descent"]) == 0
    printed = json.loads(capsys.readouterr().out)
    promised = {"linear_critical_speed", "frequency_hz", "mode_name", "damping", "hopf", "by_truck"}
    assert promised <= set(printed)
