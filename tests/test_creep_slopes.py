"""Slopes of creep forces over creepage against the laws' derivatives in closed form.

Linear law: G a b C11 and G a b C22 everywhere. Vermeulen and Johnson's: |F| = mu N f(u),
f = u - u^2/3 + u^3/27 along the linear force of size u mu N; so in the direction of that force the
slope is the linear one times f'(u) = (1 - u/3)^2, across it the linear one times f(u)/u. Central
differences over h = 0.01 of saturation (creep/slopes.py) add h^2 f'''/6 = h^2/27 to f' = 1, and
leave 1 % of what a law has of cubes of a saturation.
"""

import math
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from exudyn_wheelset.creep import creep_force, creep_law, kalker_coefficients
from exudyn_wheelset.creep.slopes import CreepPatch, creep_slopes

A, B, LOAD, FRICTION, SHEAR, POISSON = 5e-3, 3e-3, 70e3, 0.3, 82e9, 0.28
C11, C22, _, _ = kalker_coefficients(A, B, POISSON)
LINEAR = SHEAR * A * B * np.array([C11, C22])
UNIT = FRICTION * LOAD / LINEAR


def patch(law, creep_x=0.0, creep_y=0.0, spin=0.0, **parameters):
    return CreepPatch(
        creep_law(law), creep_x, creep_y, spin, A, B, LOAD, FRICTION, SHEAR, POISSON, parameters
    )


@pytest.mark.parametrize("at", [(0.0, 0.0, 0.0), (3e-4, -5e-4, 0.7), (-2e-3, 1e-3, -0.2)])
def test_linear_law(at):
    np.testing.assert_allclose(creep_slopes([patch("linear", *at)]), [LINEAR], rtol=1e-9)


@pytest.mark.parametrize("u", [0.0, 0.5, 1.2, 2.4])
@pytest.mark.parametrize("axis", [0, 1])
def test_along_and_across_the_creepage(axis, u):
    creepage = [0.0, 0.0]
    creepage[axis] = u * UNIT[axis]
    along, across = (1.0 - u / 3.0) ** 2, 1.0 - u / 3.0 + u * u / 27.0
    wanted = np.full(2, across)
    wanted[axis] = along
    found = creep_slopes([patch("vermeulen-johnson", *creepage)])[0] / LINEAR
    # at zero creepage the curve has a kink of the second order: h/3 of the slope
    np.testing.assert_allclose(found, wanted, rtol=3e-4 if u else 3.4e-3)


def test_several_patches_have_a_row_each():
    patches = [patch("vermeulen-johnson", u * UNIT[0]) for u in (0.3, 0.9, 1.5)]
    found = creep_slopes(patches)
    assert found.shape == (3, 2)
    np.testing.assert_allclose(
        found[:, 0], LINEAR[0] * (1.0 - np.array([0.3, 0.9, 1.5]) / 3.0) ** 2, rtol=3e-4
    )


def test_another_law_on_the_same_patches():
    """With its own parameters, not those of the patch's law."""
    own = patch("fastsim", 0.6 * UNIT[0], 0.0, 0.3, cells_along=12, flexibilities="one")
    np.testing.assert_allclose(creep_slopes([own], "linear"), [LINEAR], rtol=1e-9)
    one = creep_slopes([own])[0, 0]
    step = 0.01 * UNIT[0]
    forces = creep_force(
        "fastsim", own.creep_x + np.array([step, -step]), 0.0, 0.3, A, B, LOAD, FRICTION, SHEAR,
        POISSON, cells_along=12, flexibilities="one",
    )[0]  # fmt: skip
    assert one == pytest.approx(-(forces[0] - forces[1]) / (2.0 * step), rel=1e-9)
    three = creep_slopes([own], "fastsim", cells_along=12, flexibilities="three")[0, 0]
    assert abs(three / one - 1.0) > 0.01


def cube(creep_x, creep_y, spin, a, b, load, friction, shear, poisson, parameters):
    return -(creep_x**3), -2.0 * creep_y**3, 0.0


def test_step_is_a_hundredth_of_saturation():
    """A cube's central difference at zero is the step's square."""
    numba = pytest.importorskip("numba")
    found = creep_slopes([patch(numba.njit(cube))])[0]
    np.testing.assert_allclose(
        found, [(0.01 * UNIT[0]) ** 2, 2.0 * (0.01 * UNIT[1]) ** 2], rtol=1e-6
    )


def test_slope_of_spin_and_creepage_together_is_of_one_axis():
    """Only the creepage of its own axis is moved: on a linear law with spin nothing else enters."""
    spin = 0.5 * UNIT[1] / math.sqrt(A * B)
    found = creep_slopes([patch("linear", 2.0 * UNIT[0], -UNIT[1], spin)])
    np.testing.assert_allclose(found, [LINEAR], rtol=1e-9)


def test_a_patch_is_not_changed_behind_its_back():
    one = patch("linear")
    with pytest.raises(FrozenInstanceError):
        one.spin = 1.0
