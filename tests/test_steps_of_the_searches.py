"""Single steps of the searches for critical speeds and folds, on functions with known roots.

Stand-ins take the place of the system: what a step returns follows from the function by algebra.
"""

import inspect
from types import SimpleNamespace

import numpy as np
import pytest

from exudyn_wheelset.stability.hunting import corners, fold_points, folds
from exudyn_wheelset.stability.hunting.continuation_settings import ContinuationSettings
from exudyn_wheelset.stability.linear import critical_speed, crossings


class Excess:
    """Real part of the least damped pair over speed."""

    def __init__(self, function):
        self.function, self.asked = function, []

    def lateral_excess(self, speed):
        self.asked.append(speed)
        return self.function(speed)


def test_a_peak_before_the_last_speed_is_looked_at_from_before_it():
    """1e-3 - (V - 11.8)^2 grows between stable speeds 10 and 12: 12 is scanned again after it."""
    scanned = [8.0, 10.0, 12.0]
    found = critical_speed._peak_before(Excess(lambda v: 1e-3 - (v - 11.8) ** 2), scanned, 14.0)
    assert found == (pytest.approx(11.8, abs=0.03), 12.0)
    assert scanned == [8.0, 10.0]


def test_a_peak_after_the_last_speed_comes_next():
    scanned = [8.0, 10.0, 12.0]
    found = critical_speed._peak_before(Excess(lambda v: 1e-3 - (v - 12.2) ** 2), scanned, 14.0)
    assert found == (pytest.approx(12.2, abs=0.03),) and scanned == [8.0, 10.0, 12.0]


@pytest.mark.parametrize("damping", [lambda v: -1.0, lambda v: -1.0 - 0.01 * (v - 12.0) ** 2])
def test_no_peak_is_looked_for_where_it_stays_damped(damping):
    flat = Excess(damping)
    assert critical_speed._peak_before(flat, [10.0, 12.0], 14.0) == ()
    assert flat.asked == [10.0, 12.0, 14.0]


@pytest.mark.parametrize(("other", "counts"), [(-1.0, True), (0.2, False)])
def test_a_critical_speed_is_one_where_no_other_pair_grows(other, counts, monkeypatch):
    """The pair itself does not count, though a coarse tolerance leaves it a little above zero."""
    own, point = 1e-3 + 10.0j, SimpleNamespace(slope=1.0)
    spectra = SimpleNamespace(lateral_pairs=lambda speed: np.array([own, other + 5.0j]))
    monkeypatch.setattr(critical_speed, "polish", lambda *values: (50.0, own))
    monkeypatch.setattr(critical_speed, "hopf_point", lambda *values: point)
    found = critical_speed._critical_speed_near(spectra, 10.0, 100.0, 49.0, 1e-2)
    assert found is (point if counts else None)


def test_hopf_and_divergence_points_are_those_of_one_scan():
    """They are parts of all changes of stability: the same speeds are looked at by default."""
    names = ("stability_changes", "hopf_points", "divergence_points")
    defaults = [
        {one.name: one.default for one in inspect.signature(function).parameters.values()}
        for function in (getattr(crossings, name) for name in names)
    ]
    for default in defaults:
        assert default["points"] == defaults[0]["points"]
        assert default["tolerance"] == defaults[0]["tolerance"]


def test_false_position_stays_off_the_ends_of_its_bracket(monkeypatch):
    """A twentieth of the bracket is kept at its ends, though the root lies nearer; then the root
    is found to the tolerance in speed."""
    width, root, tolerance, places = 2.0, 1.98, 1e-9, []

    def at(place):
        return SimpleNamespace(slope=root - place, tangent=None, place=place)

    def on_plane(system, place, tangent, start, align):
        assert align == 3
        places.append(place)
        return at(place)

    monkeypatch.setattr(fold_points, "distance_between", lambda one, other: width)
    monkeypatch.setattr(fold_points, "along", lambda point, move: point.place + move)
    monkeypatch.setattr(fold_points, "orbit_on_plane", on_plane)
    found = fold_points._between(None, at(0.0), at(width), tolerance, 3)
    lower, upper = 0.0, width
    for place in places:
        kept = 0.05 * (upper - lower)
        assert lower + kept <= place * (1 + 1e-12) and place <= (upper - kept) * (1 + 1e-12)
        lower, upper = (place, upper) if place < root else (lower, place)
    assert abs(found.slope) * (upper - lower) < tolerance


def test_the_values_of_a_corner_are_those_at_both_ends_of_its_gap(monkeypatch):
    """A Jacobian that jumps in the last gap: from 1 before it to 3 behind."""
    phases = np.linspace(0.0, 1.0, 21)
    entries = np.ones((21, 2, 2))
    entries[20, 1, 0] = 3.0
    monkeypatch.setattr(corners, "_with_touches", lambda *values: (phases, entries))
    monkeypatch.setattr(corners, "_halved", lambda equations, orbit, *found: found)
    ends, values, rows, columns = corners.corners_of(None, None, None)
    assert ends.ravel().tolist() == phases[-2:].tolist()
    assert values.ravel().tolist() == [1.0, 3.0]
    assert (rows.tolist(), columns.tolist()) == ([1], [0])


def test_a_fold_is_visible_by_the_relative_change_of_speed():
    """`fold_visible` is relative: at 100 m/s half of 100 times it is no fold, at a metre a second
    and below it is the change itself."""
    settings = ContinuationSettings()
    change = 50.0 * settings.fold_visible
    around = tuple(
        SimpleNamespace(orbit=SimpleNamespace(speed=100.0 + more)) for more in (0.0, change, 0.0)
    )
    # No equations: what is not visible is not looked at.
    assert folds.extremum_among(None, settings, around) is None
