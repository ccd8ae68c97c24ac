"""models/car.py through its numbers: loads against the weight, signs of damping against the Hopf
points, what it writes, wrong input in one line."""

import csv
import json

import numpy as np
import pytest
from model_scripts import load

from exudyn_wheelset import FunctionSystem, catalogue
from exudyn_wheelset.results.columns import NamedColumns
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.stability.hunting.branch import Branch, Fold
from exudyn_wheelset.stability.hunting.orbit import Orbit
from exudyn_wheelset.stability.hunting.truck_speeds import lowest_by_truck
from exudyn_wheelset.vehicles.files import save_vehicle

car = load("car")


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


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--vehicle", "dtu_cart"], "dtu_car"),
        (["--vehicle", "no_such_file.toml"], "no_such_file.toml"),
        (["--vehicle", "paper-lateral-1"], "no bodies"),
        (["--friction", "7"], "friction = 7"),
        (["--wheel", "S1003"], "S1002"),
    ],
)
def test_wrong_words_are_one_line(words, said, capsys):
    assert car.main([*words, "--json", "--no-descent"]) == 2
    captured = capsys.readouterr()
    assert captured.out == "" and said in captured.err
    assert len(captured.err.strip().splitlines()) == 1


def test_a_file_is_a_vehicle_like_a_name_and_its_law_is_warned_of_once(tmp_path, capsys):
    """The truck's law has a slope 48 % off the exact one: three analyses find it, one line says."""
    path = save_vehicle(catalogue.three_axle_truck(), tmp_path / "mine.toml")
    numbers = []
    for word in ("three_axle_truck", str(path)):
        options = ("--friction", "0.25", "--creep", "shen-hedrick-elkins", "--json", "--no-descent")
        assert car.main(["--vehicle", word, *options]) == 0
        captured = capsys.readouterr()
        numbers.append(json.loads(captured.out))
        assert captured.err.count("the exact law") == 1
    by_name, by_file = (found["linear_critical_speed"] for found in numbers)
    assert by_file == pytest.approx(by_name, abs=1e-5)


@pytest.fixture
def branch_of_two_trucks():
    """Orbits of a front and a rear truck: the rear hunts alone from a fold on, both from 41.3."""
    names = ["front: y [m]", "front: yaw [rad]", "rear: y [m]", "rear: yaw [rad]"]
    system = FunctionSystem("two trucks", lambda x, v: np.zeros(4), names, np.ones(4))
    system.trucks = {"front": ("front",), "rear": ("rear",)}
    sizes = [(0.02, 1.0), (0.02, 1.25), (0.03, 1.6), (1.3, 1.6), (1.6, 1.8)]
    speeds = np.array([41.0, 40.81, 41.2, 41.37, 41.8])
    turn = np.linspace(0.0, 2.0 * np.pi, 41)
    orbits = [
        Orbit(np.linspace(0, 1, 11), np.outer(np.sin(turn), [1e-3 * f, 0, 1e-3 * r, 0]), 0.2, speed)
        for (f, r), speed in zip(sizes, speeds, strict=True)
    ]
    fold = Fold(40.808, {}, 0.2, 1, "lowest")
    stable = np.array([False, False, True, True, True])
    empty = np.zeros(5)
    branch = Branch(
        speeds, empty, NamedColumns(np.zeros((5, 1)), names[:1]), stable, ~stable & (speeds > 41.3),
        np.zeros((5, 1)), empty, [fold], [], None, Outcome(Ending.UPPER_END), orbits,
    )  # fmt: skip
    return system, branch


def test_each_truck_has_the_lowest_orbit_on_which_it_hunts(branch_of_two_trucks):
    """The rear one the fold beside its first stable orbit, the front one 41.37 m/s."""
    assert lowest_by_truck(*branch_of_two_trucks) == {"rear": 40.808, "front": 41.37}
