"""FASTSIM against Kalker's simplified theory solved by other means, and its order."""

import numpy as np
import pytest
from creep_reference import PATCH, spin_set
from fastsim_strip_by_strip import fastsim
from scipy.integrate import quad

from exudyn_wheelset.creep import creep_force, creep_parameters, kalker_coefficients
from exudyn_wheelset.creep.fastsim import slip_step
from exudyn_wheelset.creep.fastsim_rows import fastsim_rows
from exudyn_wheelset.errors import WheelsetError

ELLIPSES = [(5.5e-3, 5.5e-3), (3e-3, 9e-3), (8e-3, 2e-3)]


def test_no_slip_or_no_load_no_force():
    assert creep_force("fastsim", 0.0, 0.0, 0.0, **PATCH) == (0.0, 0.0, 0.0)
    for nothing in ({"normal_force": 0.0}, {"friction": 0.0}):
        assert creep_force("fastsim", 1e-3, 0.0, 0.0, **(PATCH | nothing)) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("change", [-50.0, 0.0, 50.0])
def test_a_traction_that_turns_fast_ends_against_the_slip_of_the_steps_end(change):
    """rise_y is the slip at the middle of the step and falls by `change` over it.

    The direction lags by one turn's length, 1/(2 * 125/(0.5 + 0.5)) of the step: 0.4 % of change.
    """
    rise = np.array([100.0, 75.0])
    traction = slip_step(0.1, 0.2, *rise, change, 0.5, 0.5)
    at_end = rise - [0.0, 0.5 * change]
    expected = -0.5 * at_end / np.hypot(*at_end)
    assert np.hypot(*traction) == pytest.approx(0.5, rel=1e-12)
    np.testing.assert_allclose(traction, expected, atol=3e-3)


def strips_in_closed_form(creep, a, b):
    """Pure longitudinal creep: each strip sticks up to k from its trailing edge, then slips."""
    c11 = kalker_coefficients(a, b, 0.28)[0]
    soft = 8 * a / (3 * 82e9 * c11)
    bound = 2 * 24e3 / (np.pi * a * b) / a**2
    slip_length = creep / (soft * bound)

    def strip(y):
        half = a * np.sqrt(max(1 - (y / b) ** 2, 0.0))
        k = min(slip_length, 2 * half)
        stick = creep / soft * (2 * half - k) ** 2 / 2
        return stick + bound * (half * k**2 - k**3 / 3)

    end = b * np.sqrt(max(1 - (slip_length / (2 * a)) ** 2, 0.0))
    return -2 * (quad(strip, 0, end, epsrel=1e-10)[0] + quad(strip, end, b, epsrel=1e-10)[0])


def cut_back_to_the_bound(creep_x, creep_y, spin, a, b, cells):
    """Kalker's 1982 scheme on a fine grid, all strips at once: of first order, but simple."""
    c11, c22, c23, _ = kalker_coefficients(a, b, 0.28)
    soft_x, soft_y = 8 * a / (3 * 82e9 * c11), 8 * a / (3 * 82e9 * c22)
    soft_z = np.pi * a**2 / (4 * 82e9 * np.sqrt(a * b) * c23)
    zeta = 3 * np.pi * a * spin / 32
    weighted = creep_x**2 / soft_x + creep_y**2 / soft_y + zeta**2 / soft_z
    soft = (creep_x**2 + creep_y**2 + zeta**2) / weighted
    y = b * ((np.arange(cells) + 0.5) * 2 / cells - 1)
    half = a * np.sqrt(1 - (y / b) ** 2)
    step = 2 * half / cells
    p = np.zeros((2, cells))
    total = np.zeros(3)
    for cell in range(cells):
        x = half - (cell + 0.5) * step
        p -= np.array([creep_x - spin * y, creep_y + spin * x]) * step / soft
        bound = 2 * 24e3 / (np.pi * a * b) * (1 - (x / a) ** 2 - (y / b) ** 2)
        p *= np.minimum(1.0, bound / np.maximum(np.hypot(*p), 1e-300))
        area = step * 2 * b / cells
        total += [(p[0] * area).sum(), (p[1] * area).sum(), ((x * p[1] - y * p[0]) * area).sum()]
    return total


@pytest.mark.parametrize(("a", "b"), ELLIPSES)
@pytest.mark.parametrize("creep", [2e-4, 1e-3, 4e-3, 0.1])
def test_closed_form_of_pure_creep(a, b, creep):
    state = PATCH | {"a": a, "b": b}
    force_x, force_y, moment = creep_force(
        "fastsim", creep, 0.0, 0.0, **state, cells_along=200, cells_across=200
    )
    # second order: 200 cells leave 1e-4 of the force
    assert force_x == pytest.approx(strips_in_closed_form(creep, a, b), rel=2e-4)
    assert force_y == 0.0
    assert abs(moment) < 1e-9


@pytest.mark.parametrize(("a", "b"), ELLIPSES)
@pytest.mark.parametrize(
    ("creep_x", "creep_y", "spin"),
    [(1e-3, 5e-4, 0.3), (0.0, 2e-3, -0.8), (3e-3, -3e-3, 1.5), (0.0, 0.0, 2.5)],
)
def test_scheme_of_1982(a, b, creep_x, creep_y, spin):
    state = PATCH | {"a": a, "b": b}
    cells = {"cells_along": 100, "cells_across": 100, "flexibilities": "one"}
    fine = np.array(creep_force("fastsim", creep_x, creep_y, spin, **state, **cells))
    # first order: 400 and 800 cells, extrapolated, leave less than 0.2 % of the force
    coarse = cut_back_to_the_bound(creep_x, creep_y, spin, a, b, 400)
    reference = 2 * cut_back_to_the_bound(creep_x, creep_y, spin, a, b, 800) - coarse
    size = np.hypot(*reference[:2])
    np.testing.assert_allclose(fine[:2], reference[:2], atol=2e-3 * size)
    assert fine[2] == pytest.approx(reference[2], abs=2e-3 * size * max(a, b))


@pytest.mark.parametrize(
    ("creep_x", "creep_y", "spin"),
    [
        (1e-3, 0.0, 0.0),
        (1e-3, -2e-3, 0.0),
        (0.0, 0.0, 0.76),
        (0.0, 0.0, 2.0),
        (1e-3, 1e-3, 0.5),
        (3e-3, -2e-3, 1.0),
        (0.0, -3e-3, 1.0),
    ],
)
@pytest.mark.parametrize("flexibilities", ["one", "blended", "three"])
def test_order_of_convergence(flexibilities, creep_x, creep_y, spin):
    def forces(cells):
        grid = {"cells_along": cells, "cells_across": cells, "flexibilities": flexibilities}
        return np.array(creep_force("fastsim", creep_x, creep_y, spin, **PATCH, **grid))[:2]

    limit = forces(800)
    grids = np.array([10, 16, 25, 40, 64, 100])
    errors = [np.hypot(*(forces(cells) - limit)) for cells in grids]
    order = -np.polyfit(np.log(grids), np.log(errors), 1)[0]
    # asked: one; the closed form of the slip zone makes it about two (less where the grid
    # happens to fit the zones)
    assert order > 1.4


def test_grid_sets_cells_along_and_across():
    state = (1e-3, 5e-4, 0.2, 5e-3, 4e-3, 6e4, 0.3, 82e9, 0.28)
    both = creep_force("fastsim", *state, cells_along=24, cells_across=24)
    assert creep_force("fastsim", *state, grid=24) == both
    finer_along = creep_force("fastsim", *state, cells_along=30, cells_across=24)
    assert creep_force("fastsim", *state, grid=24, cells_along=30) == finer_along


@pytest.mark.parametrize("flexibilities", ["blended", "three"])
@pytest.mark.parametrize(("a", "b"), ELLIPSES)
@pytest.mark.parametrize(
    "direction", [(1, 0, 0), (1, 1, 0), (1, -2, 80), (0, 1, -100), (-1, 1, 50)]
)
def test_linear_limit_in_every_direction(flexibilities, a, b, direction):
    state = PATCH | {"a": a, "b": b}
    creepages = 1e-7 * np.array(direction)
    # below 20 cells the marched tractions of the linear range are short by the cells' second order
    force = creep_force("fastsim", *creepages, **state, grid=80, flexibilities=flexibilities)
    linear = creep_force("linear", *creepages, **state)
    np.testing.assert_allclose(force[:2], linear[:2], atol=2e-3 * np.hypot(*linear[:2]))


def test_flexibilities_by_word_and_by_number():
    state = (4e-4, 5e-4, 0.2, 3e-3, 9e-3, 6e4, 0.3, 82e9, 0.28)
    for word, number in (("one", 1), ("blended", 2), ("three", 3)):
        by_word = creep_force("fastsim", *state, flexibilities=word)
        assert by_word == creep_force("fastsim", *state, flexibilities=number)
        values = creep_parameters("fastsim", flexibilities=word)
        assert values.tolist() == [10.0, 10.0, number]
    assert creep_force("fastsim", *state) == creep_force("fastsim", *state, flexibilities="blended")
    with pytest.raises(WheelsetError, match=r"'two'.*one of 'one', 'blended', 'three'"):
        creep_force("fastsim", *state, flexibilities="two")
    with pytest.raises(WheelsetError, match=r"'many'.*give a number"):
        creep_force("fastsim", *state, cells_along="many")


def test_blend_lies_between_three_and_one():
    """Three at no creepage, one from three times saturation on; by the equations of the header."""
    a, b = 3e-3, 9e-3
    state = PATCH | {"a": a, "b": b}
    c11, c22, _, _ = kalker_coefficients(a, b, 0.28)
    saturation = 24e3 / (a * b * 82e9) * np.hypot(1 / c11, 1 / c22)

    def force(flexibilities, size, spin=0.3):
        creepages = size * saturation * np.array([0.8, 0.6])
        return np.array(
            creep_force("fastsim", *creepages, spin, **state, flexibilities=flexibilities)
        )

    np.testing.assert_array_equal(force("blended", 0.0), force("three", 0.0))
    for size in (3.0 + 1e-9, 4.0):
        np.testing.assert_array_equal(force("blended", size), force("one", size))
    # a weight of 1e-9 towards one
    np.testing.assert_allclose(force("blended", 3e-9), force("three", 3e-9), rtol=1e-8)
    one, three = force("one", 1.0)[:2], force("three", 1.0)[:2]
    assert np.hypot(*(force("blended", 1.0)[:2] - three)) < np.hypot(*(one - three))


def test_combined_creep_against_full_contact():
    """Without spin, a/b 0.2 to 5: what the blend is for (one flexibility: 9.6 % of mu N)."""
    states, forces = spin_set()
    worst = {}
    without = states["spin"] == 0.0
    limit = states["friction"] * states["normal_force"]
    for flexibilities in ("one", "blended", "three"):
        fx, fy, _ = creep_force("fastsim", **states, grid=50, flexibilities=flexibilities)
        error = np.hypot(fx - forces[0], fy - forces[1]) / limit
        worst[flexibilities] = error[without].max()
        worst[f"{flexibilities}, rms"] = np.sqrt(np.mean(error**2))
    # the simplified theory's own distance, 4.6 % of mu N at a/b 0.2
    assert worst["blended"] < 0.047
    assert worst["blended"] < min(worst["one"], worst["three"])
    assert worst["blended, rms"] < min(worst["one, rms"], worst["three, rms"])


def test_all_strips_abreast_give_the_numbers_of_one_after_the_other():
    """The march of the law's paper, strip by strip, against the one that laws are called with."""
    random = np.random.default_rng(1)
    for _ in range(400):
        creep_x, creep_y, spin = random.normal(size=3) * 10.0 ** random.uniform(-6.0, 0.0, 3)
        a, b = 10.0 ** random.uniform(-3.3, -1.7, 2)
        rest = (a, b, 10.0 ** random.uniform(2.0, 6.0), random.uniform(0.05, 0.6), 82e9, 0.28)
        grid = [random.integers(2, 40), random.integers(3, 40), random.integers(1, 4)]
        parameters = np.array(grid, dtype=float)
        one = np.array(fastsim(creep_x, creep_y, spin, *rest, parameters))
        other = np.array(fastsim_rows(creep_x, creep_y, spin, *rest, parameters))
        mirrored = np.array(fastsim_rows(creep_x, -creep_y, -spin, *rest, parameters))
        np.testing.assert_array_equal(mirrored, other * [1.0, -1.0, -1.0])
        # The place in a step at which spin counts loses ten digits to differences in slow turns.
        limit = rest[2] * rest[3] * np.array([1.0, 1.0, np.sqrt(a * b)])
        np.testing.assert_array_less(np.abs(one - other), 1e-8 * limit)
