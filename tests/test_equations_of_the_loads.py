"""Equations of several loads by Ritz's method, against the energy written down here.

They are its difference quotients. What they find is the greatest energy near by.
"""

import math

import numpy as np
import pytest
from rail_lines import LEFT, MODULUS, PLACES, TABLE, plain

from exudyn_wheelset.contact import ritz
from exudyn_wheelset.contact.ellipsoids import mean_distance
from exudyn_wheelset.contact.gap_spline import _primitives
from exudyn_wheelset.contact.layout import (
    GAP_COEFFICIENT,
    GAP_DEPTH,
    GAP_FIRST,
    GAP_SECOND,
    GAP_THIRD,
    LOAD,
    RESULT,
    new_result,
)

# Two shallow lobes 7 mm apart on the head, and what is written down of their energy.
MIDDLE = PLACES[2]


def depth_of_two(s):
    x = s - MIDDLE
    return 9e-5 - 2.2 * np.minimum((x + 3e-3) ** 2, 1.3 * (x - 4e-3) ** 2 + 1e-5 / 2.2)


def room(depth=depth_of_two):
    work = new_result().view(RESULT)[0].work
    count = 140
    start = round((MIDDLE - LEFT.line_start) / LEFT.line_spacing) - 70
    at = slice(start, start + count)
    work.gap[GAP_DEPTH, at] = depth(
        LEFT.line_start + LEFT.line_spacing * np.arange(start, start + count)
    )
    plain(_primitives)(
        work.gap[GAP_DEPTH, at], work.gap[GAP_COEFFICIENT, at], work.gap[GAP_FIRST, at],
        work.gap[GAP_SECOND, at], work.gap[GAP_THIRD, at],
    )  # fmt: skip
    return work, start + 2, start + count - 4


def loads_at(x, bounds):
    loads = np.zeros(len(x) // 3, LOAD)
    for k in range(len(loads)):
        loads[k].t, loads[k].b, loads[k].place = x[3 * k], math.exp(x[3 * k + 1]), x[3 * k + 2]
        loads[k].low, loads[k].high = bounds
    return loads


def written_down(x, work, bounds):
    """Equation (1): what the loads gain in the gap less what they and their fields take."""
    loads = loads_at(x, bounds)
    total = 0.0
    for load in loads:
        plain(ritz._look)(TABLE, LEFT, load, work, MODULUS)
        total += load.force * (load.average - load.work)
    for k, one in enumerate(loads):
        for two in loads[k + 1 :]:
            apart = two.place - one.place
            mean = plain(mean_distance)(apart, one.a**2, one.b**2, two.a**2, two.b**2, MODULUS)
            total -= one.force * two.force * mean
    return total


def equations(x, work, bounds):
    """Energy, matrix, right side; the loads as they are then."""
    loads = loads_at(x, bounds)
    for load in loads:
        plain(ritz._look)(TABLE, LEFT, load, work, MODULUS)
    total = plain(ritz._equations)(loads, len(loads), MODULUS, work)
    size = 3 * len(loads)
    return total, work.matrix[:size, :size].copy(), work.matrix[:size, size].copy(), loads


GUESSES = {
    "one": [0.4, math.log(4.1e-3), MIDDLE - 2.3e-3],
    "two": [0.4, math.log(3.1e-3), MIDDLE - 3.2e-3, 0.9, math.log(2.4e-3), MIDDLE + 4.3e-3],
    "two that overlap": [
        -0.5, math.log(3.1e-3), MIDDLE - 1.2e-3, 0.7, math.log(2.4e-3), MIDDLE + 2.3e-3,
    ],
    "three": [
        0.4, math.log(3.1e-3), MIDDLE - 3.2e-3, 0.9, math.log(1.4e-3), MIDDLE + 4.3e-3,
        0.2, math.log(1.8e-3), MIDDLE + 1.1e-3,
    ],
}  # fmt: skip


def steps_of(loads):
    """Steps for (t, ln b, place) of each load, in that order, load by load."""
    return np.array([[1e-4, 1e-4, 1e-4 * load.b] for load in loads]).ravel()


def by_kind(values):
    """From load by load to the kernels' order: all t, all ln b, all places."""
    return np.asarray(values).reshape(-1, 3).T.ravel()


@pytest.mark.parametrize("name", GUESSES)
def test_right_side_is_the_gradient_of_the_energy(name):
    x = np.array(GUESSES[name])
    work, *bounds = room()
    total, _, right, loads = equations(x, work, bounds)
    assert total == pytest.approx(written_down(x, work, bounds), rel=1e-12)
    gradient = []
    for k, step in enumerate(steps_of(loads)):
        ahead, behind = x.copy(), x.copy()
        ahead[k] += step
        behind[k] -= step
        rise = written_down(ahead, work, bounds) - written_down(behind, work, bounds)
        scale = loads[k // 3].force * (step if k % 3 < 2 else step / loads[k // 3].b)
        gradient.append(rise / (2.0 * scale))
    # The steps' error; a change of A along the rail twice over is left out.
    np.testing.assert_allclose(right, -by_kind(gradient), atol=2e-10)


@pytest.mark.parametrize("name", GUESSES)
def test_matrix_is_the_derivative_of_the_right_side(name):
    """Each row as it stands, over the load of its own; b in front of the third kind is kept."""
    x = np.array(GUESSES[name])
    work, *bounds = room()
    _, matrix, _, loads = equations(x, work, bounds)
    count = len(loads)
    columns = []
    for k, step in enumerate(steps_of(loads)):
        rows = []
        for sign in (1.0, -1.0):
            moved = x.copy()
            moved[k] += sign * step
            _, _, side, now = equations(moved, work, bounds)
            for j in range(count):
                side[2 * count + j] *= loads[j].b / now[j].b
            rows.append(side)
        unit = step if k % 3 < 2 else step / loads[k // 3].b
        columns.append(-(rows[0] - rows[1]) / (2.0 * unit))
    found = np.array(columns).reshape(count, 3, -1).transpose(1, 0, 2).reshape(3 * count, -1).T
    size = np.sqrt(np.abs(np.outer(np.diag(found), np.diag(found))))
    # Places of the quadrature held constant, and the change of A's own change: 2 % of the diagonal.
    assert np.all(np.abs(matrix - found) < 0.02 * size + 1e-9)


def test_elimination_solves_a_matrix_that_is_negative_and_leads_uphill_otherwise():
    rng = np.random.default_rng(8)
    loads = np.zeros(2, LOAD)
    for load in loads:
        load.force_by_t, load.own_by_t, load.width = 1e-3, 1e-3, 1e-3
    for trial in range(20):
        full = rng.normal(size=(6, 6))
        matrix = -(full @ full.T) - 0.1 * np.eye(6)
        right = rng.normal(size=6)
        work = np.column_stack([matrix, right])
        plain(ritz._solve)(loads, 2, work)
        np.testing.assert_allclose(work[:, 6], np.linalg.solve(matrix, right), rtol=1e-9)
        # The last column is minus the gradient: a step uphill has a product below zero with it.
        saddle = matrix + (trial % 4 + 1) * np.eye(6)
        work = np.column_stack([saddle, right])
        plain(ritz._solve)(loads, 2, work)
        assert work[:, 6] @ right < 0.0


@pytest.mark.parametrize("name", ["one", "two"])
def test_loads_are_found_where_the_energy_is_greatest(name):
    work, *bounds = room()
    best = None
    rng = np.random.default_rng(9)
    for _ in range(3):
        x = np.array(GUESSES[name])
        x += rng.uniform(-0.15, 0.15, x.size) * np.tile([1.0, 1.0, 2e-3], x.size // 3)
        loads = loads_at(x, bounds)
        found, total = plain(ritz.stationary)(TABLE, LEFT, loads, len(loads), MODULUS, work)
        assert found == len(loads)
        place = np.array([[load.t, math.log(load.b), load.place] for load in loads]).ravel()
        assert total == pytest.approx(written_down(place, work, bounds), rel=1e-6)
        _, _, right, _ = equations(place, work, bounds)
        assert np.abs(right).max() < 3e-5 * max(load.approach for load in loads)
        for _ in range(12):
            aside = rng.uniform(-1.0, 1.0, place.size) * np.tile([0.1, 0.05, 2e-4], len(loads))
            assert written_down(place + aside, work, bounds) < total
        best = total if best is None else best
        assert total == pytest.approx(best, rel=1e-6)


def test_one_load_in_a_parabola_takes_two_fifths_of_force_times_depth():
    """U = 2/5 N delta, its ellipse Hertz's of that parabola, at its top."""
    bend, deep, top = 2.7, 7e-5, MIDDLE + 0.4e-3
    work, *bounds = room(lambda s: deep - bend * (s - top) ** 2)
    loads = loads_at(np.array([0.1, math.log(4e-3), MIDDLE]), bounds)
    found, total = plain(ritz.stationary)(TABLE, LEFT, loads, 1, MODULUS, work)
    (load,) = loads
    assert found == 1
    assert load.lateral == pytest.approx(bend, rel=1e-4)
    assert load.approach == pytest.approx(deep, rel=1e-4)
    # A changes along the rail and moves the place by a little: a^2 A'/(10 B).
    assert load.place == pytest.approx(top, abs=1e-5)
    assert total == pytest.approx(0.4 * load.force * deep, rel=1e-4)


def test_a_load_that_has_nothing_to_carry_is_taken_out():
    work, *bounds = room()
    x = np.array([0.4, math.log(3.1e-3), MIDDLE - 3.2e-3, 0.9, math.log(1e-5), MIDDLE + 9e-3])
    loads = loads_at(x, bounds)
    found, total = plain(ritz.stationary)(TABLE, LEFT, loads, 2, MODULUS, work)
    alone = loads_at(x[:3], bounds)
    assert found == 1
    expected = plain(ritz.stationary)(TABLE, LEFT, alone, 1, MODULUS, work)[1]
    assert total == pytest.approx(expected, rel=1e-6)
