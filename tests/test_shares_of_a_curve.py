"""How a steady curve is reached: by shares of it between nothing and all, never beyond.

Stand-ins take the place of vehicle and track; the shares, the leaps and the words are looked at.
"""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from exudyn_wheelset import AnalysisError
from exudyn_wheelset.systems import curving, vehicle_system
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.vehicle_system import VehicleSystem

# Curvature 1/m and cant [rad].
TARGET = np.array([1.0 / 300.0, 0.08])


class Way:
    """Records the shares of the curve; Newton's method ends beyond `limit` of it."""

    def __init__(self, monkeypatch, limit=1.0):
        self.shares, self.limit = [], limit
        self.system = SimpleNamespace(
            name="car", wheelsets=(), unsteadiness=0.0, initial_state=lambda speed: np.zeros(2)
        )
        self.frame = SimpleNamespace(frozen=TARGET, freeze=lambda *values: None)
        monkeypatch.setattr(curving, "moved_with_track", self.moved)
        monkeypatch.setattr(curving, "newton_equilibrium", self.newton)
        monkeypatch.setattr(curving, "_off_the_rails", lambda *values: None)

    def moved(self, system, frame, state, before, after):
        if not np.any(before):
            assert after[1] / TARGET[1] == pytest.approx(after[0] / TARGET[0])
            self.shares.append(after[0] / TARGET[0])
        return state

    def newton(self, system, speed, guess, steps=50):
        if self.shares and self.shares[-1] > self.limit:
            raise AnalysisError("no steady state")
        return guess


def test_shares_rise_from_the_straight_to_the_whole_curve(monkeypatch):
    way = Way(monkeypatch)
    curving.curve_equilibrium(way.system, way.frame, 20.0)
    assert way.shares[0] > 0.0
    assert np.all(np.diff(way.shares[:-1]) > 0.0)
    assert max(way.shares) == way.shares[-2] == way.shares[-1] == 1.0


def test_the_radius_of_an_ending_is_that_of_the_share_reached(monkeypatch):
    """A share s of the curvature 1/R has the radius R/s."""
    way = Way(monkeypatch, limit=0.6)
    monkeypatch.setattr(curving, "_beyond", lambda *values: None)
    with pytest.raises(AnalysisError) as caught:
        curving.curve_equilibrium(way.system, way.frame, 20.0)
    words = re.search(r"beyond (\S+) of the curve \(radius (\S+) m\)", str(caught.value))
    share, radius = (float(word) for word in words.groups())
    assert 0.55 < share <= 0.6
    assert radius == pytest.approx(300.0 / share, rel=2e-3)


def test_no_leap_goes_beyond_the_curve(monkeypatch):
    way = Way(monkeypatch)
    found = curving._beyond(way.system, way.frame, 20.0, np.zeros(2), 0.99, TARGET)
    assert found[0] == 1.0


def test_a_vehicle_is_left_to_settle_after_the_shortest_leap(monkeypatch):
    way = Way(monkeypatch, limit=0.5)
    monkeypatch.setattr(curving, "_settled", lambda system, guess, speed: (guess, 0.0))
    found = curving._beyond(way.system, way.frame, 20.0, np.zeros(2), 0.5, TARGET)
    assert found[0] == pytest.approx(0.5 + min(curving._LEAPS), rel=1e-12)


@pytest.mark.parametrize(
    ("guess", "frozen", "way"),
    [(None, TARGET, "curve"), (np.ones(2), TARGET, "guess"), (None, 0.0 * TARGET, "guess")],
)
def test_a_curve_is_entered_from_the_straight_unless_a_state_is_given(
    guess, frozen, way, monkeypatch
):
    """An equilibrium is one near the guess, if there is one (see DynamicSystem.equilibrium)."""
    system = object.__new__(VehicleSystem)
    system.vehicle_items = SimpleNamespace(frame=SimpleNamespace(frozen=frozen))
    monkeypatch.setattr(VehicleSystem, "use_speed", lambda self, speed: None)
    monkeypatch.setattr(ExudynSystem, "equilibrium", lambda *values: "guess", raising=False)
    monkeypatch.setattr(vehicle_system, "curve_equilibrium", lambda *values: "curve")
    assert system.equilibrium(20.0, guess) == way
