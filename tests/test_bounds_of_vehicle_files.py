"""Bounds that are written down for vehicle files, from both sides, and names within a file."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from test_vehicle_files import wagon

from exudyn_wheelset import WheelsetError, load_profile, load_vehicle, save_vehicle
from exudyn_wheelset.vehicles import elements
from exudyn_wheelset.vehicles.balance import _check_balance
from exudyn_wheelset.vehicles.files.units import Implausible, check_vehicle


@pytest.mark.parametrize(("relaxation", "fits"), [(0.95, True), (1.05, False)])
def test_a_damper_in_series_relaxes_within_a_second(relaxation, fits):
    """c/k up to 1 s (the list of bounds in vehicles/files/units.py)."""
    stiffness = 1e6
    damper = elements.Damper((1, 0, 0), relaxation * stiffness, series_stiffness=stiffness)
    if fits:
        check_vehicle(wagon(damper))
        return
    with pytest.raises(Implausible, match=rf"relax in {relaxation} s \(at most 1 s\)"):
        check_vehicle(wagon(damper))


def test_a_shipped_profile_and_ones_own_of_its_name_stand_beside_each_other(tmp_path):
    """Of two wheelsets the one runs on the package's S1002, the other on one worn by a little."""
    own = load_profile("S1002").smoothed(1e-5)
    vehicle = wagon().replace("wheelsets.trailing.wheel", replace(own, name="S1002"))
    assert len({axle.wheelset.wheel.name for axle in vehicle.wheelsets}) == 1
    assert load_vehicle(save_vehicle(vehicle, tmp_path / "two.toml")) == vehicle


@pytest.mark.parametrize(("turn", "direction"), [(0.45, "z"), (0.55, "roll")])
def test_a_turn_counts_as_its_arc_at_two_metres(turn, direction):
    """What is out of balance is named by its greatest motion: 1 m up, or an arc of 2 m x turn."""
    vehicle = SimpleNamespace(
        name="car", mass=1e-3, gravity=9.81, parts=[SimpleNamespace(name="body")]
    )
    left = np.array([[0.0, 0.0, 1.0, turn, 0.0, 0.0]])
    with pytest.raises(WheelsetError, match=f" in {direction}, against"):
        _check_balance(vehicle, left, np.zeros((1, 6)))
