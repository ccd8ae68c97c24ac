"""models/simple_truck.py: loads against the weight, growth against eigenvalues, its output."""

from __future__ import annotations

import json

import numpy as np
import pytest
from model_scripts import call, load, printed_numbers


@pytest.fixture(scope="module")
def truck_numbers() -> dict:
    return load("simple_truck").run()[0]


def test_simple_truck_wheel_loads(truck_numbers):
    """All weight on the rails, a quarter on each wheel: 66.6 kN, as the DTU car is given."""
    loads = dict(truck_numbers["wheel_loads"])
    total = loads.pop("sum")
    assert total == pytest.approx(truck_numbers["weight"], rel=1e-6)
    assert len(loads) == 4
    assert list(loads.values()) == pytest.approx([66.66e3] * 4, rel=2e-3)


def test_simple_truck_growth(truck_numbers):
    """Simulated growth beside the eigenvalue's, on both sides of the critical speed."""
    below, above = truck_numbers["runs"]
    assert below["growth_rate_eigenvalue"] < 0.0 < above["growth_rate_eigenvalue"]
    for run in (below, above):
        scale = 2.0 * np.pi * run["frequency_eigenvalue"]
        assert run["event"] is None
        assert run["growth_rate_simulated"] == pytest.approx(
            run["growth_rate_eigenvalue"], abs=0.002 * scale
        )
        assert run["frequency_simulated"] == pytest.approx(run["frequency_eigenvalue"], rel=0.002)


def test_simple_truck_critical_speed_is_below_that_of_its_wheelsets(truck_numbers):
    """The frame that swings on soft secondary springs guides less than one that stands still."""
    alone = truck_numbers["critical_speed_of_a_wheelset_on_a_fixed_frame"]
    assert 15.0 < truck_numbers["critical_speed"] < alone


def test_simple_truck_output(tmp_path, capsys):
    assert call("simple_truck", "--duration=0.6", "--json", f"--out={tmp_path}") == 0
    numbers = printed_numbers(capsys)
    names = {file.name for file in tmp_path.iterdir()}
    speeds = [f"simple_truck_{run['speed']:.2f}.csv" for run in numbers["runs"]]
    assert names == {
        "simple_truck.json",
        "simple_truck.png",
        *speeds,
    }
    record = json.loads((tmp_path / "simple_truck.json").read_text())
    assert record["numbers"] == numbers
    assert record["settings"]["timeIntegration.solverType"] == "RK44"
    assert "exudyn" in record["versions"]
