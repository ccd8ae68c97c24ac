"""What every creep law must keep: friction limit, dissipation, mirror symmetry, no NaN."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exudyn_wheelset.creep import CREEP_LAWS, creep_force, creep_law, creep_parameters
from exudyn_wheelset.errors import WheelsetError

BOUNDED = [name for name in CREEP_LAWS if name != "linear"]
DEFAULT = ("a", "b", "normal_force", "friction", "shear_modulus", "poisson")
STEEL = (82e9, 0.28)
COARSE = {"cells_along": 8, "cells_across": 6}

creep = st.floats(-0.1, 0.1)
spin = st.floats(-3.0, 3.0)
axis = st.floats(1e-3, 2e-2)
load = st.floats(1e2, 3e5)
friction = st.floats(0.01, 0.8)


def options(law):
    """Every law also with its spin moment switched on; coarse cells where they cost much."""
    if law == "exact":
        return [COARSE]
    return [{}, {"spin_moment": 1}] if "spin_moment" in parameter_names(law) else [{}]


def parameter_names(law):
    return [p.name for p in creep_law(law).parameters]


@pytest.mark.parametrize("law", BOUNDED)
@settings(deadline=None, max_examples=200)
@given(creep, creep, spin, axis, axis, load, friction)
def test_friction_limit(law, sx, sy, psi, a, b, force, mu):
    fx, fy, mz = creep_force(law, sx, sy, psi, a, b, force, mu, *STEEL, **options(law)[0])
    assert math.hypot(fx, fy) <= mu * force * (1 + 1e-14)
    # no traction field within the friction bound has more moment than the long axis allows
    assert abs(mz) <= mu * force * max(a, b)


@settings(deadline=None, max_examples=200)
@given(creep, creep, spin, axis, axis, load, friction)
def test_linear_law_has_no_limit_unless_asked(sx, sy, psi, a, b, force, mu):
    fx, fy, _ = creep_force("linear", sx, sy, psi, a, b, force, mu, *STEEL, cap=1)
    assert math.hypot(fx, fy) <= mu * force * (1 + 1e-14)
    plain = creep_force("linear", sx, sy, psi, a, b, force, mu, *STEEL)
    twice = creep_force("linear", 2 * sx, 2 * sy, 2 * psi, a, b, force / 3, mu / 5, *STEEL)
    # Denormal spins keep fewer digits.
    np.testing.assert_allclose(twice, 2 * np.array(plain), rtol=1e-12, atol=1e-290)


@pytest.mark.parametrize("law", list(CREEP_LAWS))
@settings(deadline=None, max_examples=200)
@given(creep, creep, axis, axis, load, friction)
def test_dissipation_without_spin(law, sx, sy, a, b, force, mu):
    fx, fy, _ = creep_force(law, sx, sy, 0.0, a, b, force, mu, *STEEL, **options(law)[0])
    assert -(fx * sx + fy * sy) >= 0.0


@pytest.mark.parametrize("flexibilities", ["one", "blended", "three"])
@settings(deadline=None, max_examples=300)
@given(creep, creep, spin, axis, axis, load, friction)
def test_dissipation_of_fastsim_with_spin(flexibilities, sx, sy, psi, a, b, force, mu):
    fx, fy, mz = creep_force(
        "fastsim", sx, sy, psi, a, b, force, mu, *STEEL, flexibilities=flexibilities
    )
    power = -(fx * sx + fy * sy + mz * psi)
    scale = mu * force * (math.hypot(sx, sy) + abs(psi) * max(a, b))
    # one bed of springs gives back what it stored and no more; three stiffnesses for the parts
    # of one slip are no such bed, and the theory itself then gains up to 0.3 % on slender patches
    assert power >= -(1e-15 if flexibilities == "one" else 5e-3) * scale


@pytest.mark.parametrize("law", list(CREEP_LAWS))
@settings(deadline=None, max_examples=100)
@given(creep, creep, spin, axis, axis, load, friction)
def test_mirror_symmetry(law, sx, sy, psi, a, b, force, mu):
    for option in options(law):
        rest = (a, b, force, mu, *STEEL)
        fx, fy, mz = creep_force(law, sx, sy, psi, *rest, **option)
        # across the vertical plane of rolling: exact, the same operations in the same order
        assert creep_force(law, sx, -sy, -psi, *rest, **option) == (fx, -fy, -mz)
        # braking and driving: FASTSIM's grid has no preference either
        other = creep_force(law, -sx, sy, psi, *rest, **option)
        tolerance = 1e-12 * (abs(fx) + abs(fy) + mu * force)
        np.testing.assert_allclose(other[:2], (-fx, fy), atol=tolerance)
        np.testing.assert_allclose(other[2], mz, atol=tolerance * 0.1)


wild = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from([0.0, -0.0, 5e-324, -5e-324, 1e-308, 1e308, -1e308, 1e-160, 1e160]),
    st.floats(-0.01, 0.01),
)


@pytest.mark.parametrize("law", list(CREEP_LAWS))
@settings(deadline=None, max_examples=300)
@given(
    wild,
    wild,
    wild,
    st.floats(1e-6, 0.1),
    st.floats(1e-3, 1e3),
    st.floats(0.0, 1e9),
    st.floats(0.0, 10.0),
    st.floats(0.0, 0.5),
)
def test_always_finite(law, sx, sy, psi, a, ratio, force, mu, poisson):
    for option in options(law):
        result = creep_force(law, sx, sy, psi, a, a / ratio, force, mu, 82e9, poisson, **option)
        assert all(math.isfinite(value) for value in result)
        if law != "linear":
            assert math.hypot(*result[:2]) <= mu * force * (1 + 1e-12)


@pytest.mark.parametrize("law", list(CREEP_LAWS))
def test_finite_for_all_that_is_accepted(law):
    """Every argument over its whole range, by the decade: no product of them overflows."""
    random = np.random.default_rng(11)
    count = {"exact": 300, "fastsim": 5000}.get(law, 20000)
    patch = {
        name: 10 ** random.uniform(*decades, count)
        for name, decades in {
            "a": (-60, 9),
            "b": (-60, 9),
            "normal_force": (-300, 60),
            "friction": (-300, 6),
            "shear_modulus": (-60, 24),
        }.items()
    }
    creepages = 10 ** random.uniform(-300, 308, (3, count))
    creepages *= random.choice([-1, 0, 1], (3, count), p=[0.4, 0.1, 0.5])
    choices = [{"flexibilities": n} for n in (1, 2, 3)] if law == "fastsim" else options(law)
    for option in choices:
        poisson = random.uniform(0, 0.5, count)
        result = np.array(creep_force(law, *creepages, **patch, poisson=poisson, **option))
        assert np.all(np.isfinite(result))
        if law != "linear":
            limit = patch["friction"] * patch["normal_force"]
            assert np.all(np.hypot(*result[:2]) <= limit * (1 + 1e-12))


def test_fastsim_slides_alike_however_fast():
    """At 1e20 and 1e200 times saturation the direction of slip decides alone."""
    patch = (5e-3, 4e-3, 8e4, 1e-103, *STEEL)
    slow = creep_force("fastsim", 1e-80, -2e-80, 3e-77, *patch)
    fast = creep_force("fastsim", 1e40, -2e40, 3e43, *patch)
    np.testing.assert_allclose(fast, slow, rtol=1e-9)


@pytest.mark.parametrize("law", list(CREEP_LAWS))
def test_nothing_from_nothing(law):
    patch = (5e-3, 4e-3)
    assert creep_force(law, 0.0, 0.0, 0.0, *patch, 8e4, 0.3, *STEEL) == (0.0, 0.0, 0.0)
    assert creep_force(law, 1e-3, 1e-3, 0.1, *patch, 0.0, 0.3, *STEEL) == (0.0, 0.0, 0.0)
    assert creep_force(law, 1e-3, 1e-3, 0.1, *patch, -5.0, 0.3, *STEEL) == (0.0, 0.0, 0.0)
    if law != "linear":
        assert creep_force(law, 1e-3, 1e-3, 0.1, *patch, 8e4, 0.0, *STEEL) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("law", list(CREEP_LAWS))
@pytest.mark.parametrize("along", ["creep_x", "creep_y", "spin"])
def test_continuity(law, along):
    """Forces along lines through the creepages, also where zones, signs and limits change."""
    values = np.linspace(-6e-3, 6e-3, 20001 if law != "exact" else 1501)
    for other in (0.0, 3e-4, 2e-3):
        line = {"creep_x": other, "creep_y": -other, "spin": 100 * other}
        line[along] = values if along != "spin" else 200 * values
        patch = dict(zip(DEFAULT, PATCH, strict=True))
        fx, fy, _ = creep_force(law, **line, **patch, **options(law)[0])
        # stiffness G a b C < 2e7 N (per 200 1/m of spin: 3e7 N) times the step
        assert np.abs(np.diff(fx)).max() < 3e7 * (values[1] - values[0])
        assert np.abs(np.diff(fy)).max() < 3e7 * (values[1] - values[0])


PATCH = (6e-3, 4e-3, 8e4, 0.3, *STEEL)


def test_arrays_broadcast():
    sx = np.linspace(-1e-3, 1e-3, 5)
    psi = np.array([[0.0], [0.2]])
    fx, fy, mz = creep_force("polach", sx, 0.0, psi, *PATCH)
    assert fx.shape == fy.shape == mz.shape == (2, 5)
    assert fx[1, 3] == creep_force("polach", sx[3], 0.0, 0.2, *PATCH)[0]
    fast = creep_force("polach-2005", 0.01, 0.0, 0.0, *PATCH, speed=np.array([0.0, 30.0]))[0]
    assert abs(fast[1]) < abs(fast[0])


def test_unknown_law_names_the_nearest():
    with pytest.raises(WheelsetError, match=r"'fastsin'.*polach-2005.*did you mean 'fastsim'"):
        creep_force("fastsin", 0.0, 0.0, 0.0, *PATCH)
    with pytest.raises(WheelsetError, match="unknown creep law"):
        creep_parameters("")


@pytest.mark.parametrize(
    ("law", "parameters", "message"),
    [
        ("polach", {"speed": 3.0}, "unknown parameter of creep law 'polach' 'speed'"),
        ("fastsim", {"cells_along": 1}, "from 2 to 1000"),
        ("fastsim", {"cells_across": 7.5}, "whole number"),
        ("polach-2005", {"speed": -1.0}, "speed"),
        ("polach-2005", {"speed": math.nan}, "finite"),
        ("polach-2005", {"adhesion_reduction": 0.2}, "k_S <= k_A"),
    ],
)
def test_parameters_out_of_range(law, parameters, message):
    with pytest.raises(WheelsetError, match=message):
        creep_force(law, 0.0, 0.0, 0.0, *PATCH, **parameters)
    with pytest.raises(WheelsetError, match=message):
        creep_parameters(law, **parameters)


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        (3, 0.0, "a = 0 .m.; it must be positive"),
        (4, -1e-3, "b = -0.001"),
        (6, -0.1, "friction"),
        (7, 0.0, "shear_modulus"),
        (8, 0.6, "poisson = 0.6 .-.; it must be from 0 to 0.5"),
        (0, math.nan, "creep_x must be finite"),
        (2, "much", "spin must be a number"),
    ],
)
def test_states_out_of_range(place, value, message):
    state = [0.0, 0.0, 0.0, *PATCH]
    state[place] = value
    with pytest.raises(WheelsetError, match=message):
        creep_force("polach", *state)
