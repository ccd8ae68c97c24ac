"""models/freight_car.py through its numbers: weights, friction that raises the critical speed, what
it writes, wrong input in one line."""

import pytest
from model_scripts import call, load, table_of

from exudyn_wheelset import catalogue

freight_car = load("freight_car")


@pytest.fixture(scope="module")
def numbers(tmp_path_factory):
    out = tmp_path_factory.mktemp("freight_car")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(freight_car, "HUNT", 1.0)
        patch.setattr(freight_car, "FRICTIONS", (0.0, 0.2))
        return freight_car.run(out=out), out


@pytest.mark.parametrize("loaded", ["empty", "loaded"])
def test_wheels_carry_the_weight(numbers, loaded):
    car = catalogue.freight_car(loaded == "loaded")
    total = sum(map(sum, numbers[0]["wheel_loads"][loaded].values()))
    assert total == pytest.approx(9.81 * car.mass, rel=1e-6)


@pytest.mark.parametrize("loaded", ["empty", "loaded"])
def test_wedges_that_hold_firmer_raise_the_linear_critical_speed(numbers, loaded):
    """Stiffness in grows with friction: between frictionless and rigid wedges speed rises."""
    speeds = list(numbers[0]["critical"][loaded].values())
    assert speeds == sorted(speeds)
    assert speeds[-1] > 1.3 * speeds[0]


def test_every_hold_is_counted_and_named_modes_are_damped_below_the_critical_speed(numbers):
    for loaded in ("empty", "loaded"):
        assert numbers[0]["neutral"][loaded] == 30
        assert numbers[0]["critical"][loaded]["0.4"] > freight_car.MODES_AT
        assert all(damping > 0.0 for _, _, damping in numbers[0]["modes"][loaded])


def test_holds_stay_within_the_slip_force(numbers):
    for hunt in numbers[0]["hunt"].values():
        assert 0.1 < hunt["greatest_hold"] <= 1.0 + 1e-6


def test_files_are_written(numbers):
    _, out = numbers
    assert sorted(path.name for path in out.iterdir()) == [
        "freight_car.json",
        "freight_car.png",
        "freight_car_empty_hunt.csv",
        "freight_car_loaded_hunt.csv",
    ]
    motion = table_of(out / "freight_car_empty_hunt.csv")
    assert any("wedge vertical hold" in name for name in motion)


def test_impossible_friction_is_one_line(capsys):
    assert call("freight_car", "--json", "--wedge-friction", "-0.1") == 2
    assert "wedge_friction" in capsys.readouterr().err
