"""What an analysis says of its creep law: additivity along the mode, slope beside the exact law."""

import warnings

import numba
import numpy as np
import pytest

from exudyn_wheelset import (
    FunctionSystem,
    WheelsetWarning,
    hopf_points,
    linear_critical_speed,
    linearise,
    register_creep_law,
)
from exudyn_wheelset.catalogue.by_name import vehicle_system
from exudyn_wheelset.creep import CREEP_LAWS, creep_law, kalker_coefficients
from exudyn_wheelset.creep.slopes import CreepPatch, creep_slopes
from exudyn_wheelset.stability.linear import law_checks
from exudyn_wheelset.stability.linear.law_checks import (
    ADDITIVITY_LIMIT,
    LawCheck,
    additivity,
    check_law,
    warn_of_law,
)

TURN = np.array([[0.0, 1.0], [-1.0, 0.0]])


def homogeneous(size):
    """x' = TURN x + size |x| e2: homogeneous of degree one, linear for size 0 only."""
    return FunctionSystem(
        "homogeneous",
        lambda x, _: TURN @ x + size * np.hypot(*x) * np.array([0.0, 1.0]),
        ("y [m]", "y' [m/s]"),
        (1.0, 1.0),
    )


@pytest.mark.parametrize("size", [0.0, 0.01, 0.2])
def test_additivity_in_closed_form(size):
    """a and b are orthogonal unit vectors: size (2 - sqrt 2) over |sqrt 2 u + sqrt 2 size e2|."""
    got = additivity(homogeneous(size), np.zeros(2), 0.0, np.array([1.0, 1j]))
    least = size * (2.0 - np.sqrt(2.0)) / (np.sqrt(2.0) * (1.0 + size))
    most = size * (2.0 - np.sqrt(2.0)) / (np.sqrt(2.0) * (1.0 - size))
    assert least - 1e-12 <= got <= most + 1e-12
    # six phases pass the direction of e2 within a twelfth of pi
    assert got >= 0.96 * most


def test_a_smooth_law_is_additive_at_small_amplitude():
    """Curvature of order one is taken out by two amplitudes; rounding over 1e-4 of the scales."""
    curved = FunctionSystem(
        "curved", lambda x, _: TURN @ x + np.array([0.0, x[0] ** 2]), ("y", "v"), (1.0, 1.0)
    )
    assert additivity(curved, np.zeros(2), 0.0, np.array([1.0, 1j])) < 1e-10


def oscillator(speed_of_growth, roughness):
    """Growth rate (V - speed_of_growth)/10 of an oscillator at 1 rad/s, and a cone beside it."""

    def rate(x, speed):
        growth = 0.2 * (speed - speed_of_growth)
        return np.array([x[1], -x[0] + growth * x[1] + roughness * np.hypot(*x)])

    return FunctionSystem("rough oscillator", rate, ("y [m]", "y' [m/s]"), (1.0, 1.0))


def test_warning_has_number_limit_and_mend():
    with pytest.warns(WheelsetWarning, match=r"limit 2 %.*creep=\"polach-kalker\"") as caught:
        point = linear_critical_speed(oscillator(10.0, 0.2), 5.0, 15.0)
    (warning,) = caught
    assert warning.filename == __file__
    assert f"{100 * point.additivity:.1f} %" in str(warning.message)
    assert "rough oscillator at" in str(warning.message)
    assert point.slope_ratio is None
    with pytest.warns(WheelsetWarning, match="not linear") as caught:
        hopf_points(oscillator(10.0, 0.2), 5.0, 15.0)
    assert [w.filename for w in caught] == [__file__]
    with pytest.warns(WheelsetWarning, match="not linear") as caught:
        linearise(oscillator(10.0, 0.2), 9.0)
    assert [w.filename for w in caught] == [__file__]


def test_no_warning_for_linear_equations():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert linear_critical_speed(oscillator(10.0, 0.0), 5.0, 15.0).additivity < 1e-6


def test_laws_without_a_derivative_say_what_linear_means():
    system = vehicle_system("s1002", creep="polach")
    with pytest.warns(WheelsetWarning, match="'polach' is not linear.*'linear' means the slopes"):
        point = linear_critical_speed(system, 30.0, 80.0)
    assert point.additivity > ADDITIVITY_LIMIT
    assert any("'linear' means the slopes along x and along y" in r for r in point.remarks)
    quiet = vehicle_system("paper-lateral-1", creep="polach")
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message=".*not linear")
        point = linear_critical_speed(quiet, 30.0, 50.0)
    assert point.additivity < ADDITIVITY_LIMIT
    assert any("'linear' means" in remark for remark in point.remarks)
    without = [law.name for law in CREEP_LAWS.values() if law.when_linearised]
    assert without == ["polach", "polach-2005"]


PATCH = {
    "creep_x": 0.0,
    "creep_y": 0.0,
    "spin": 0.0,
    "a": 4.3e-3,
    "b": 12.1e-3,
    "normal_force": 66.66e3,
    "friction": 0.15,
    "shear_modulus": 82e9,
    "poisson": 0.27,
}


def test_slopes_are_kalkers_without_creepage():
    patches = [CreepPatch(creep_law("linear"), **PATCH)]
    c11, c22, _, _ = kalker_coefficients(PATCH["a"], PATCH["b"], PATCH["poisson"])
    kalker = PATCH["shear_modulus"] * PATCH["a"] * PATCH["b"] * np.array([c11, c22])
    np.testing.assert_allclose(creep_slopes(patches)[0], kalker, rtol=1e-9)
    # the curvature of a law over a hundredth of saturation
    np.testing.assert_allclose(creep_slopes(patches, "polach-kalker")[0], kalker, rtol=2e-4)
    np.testing.assert_allclose(
        creep_slopes(patches, "fastsim", cells_along=80, cells_across=80)[0], kalker, rtol=3e-3
    )


@pytest.fixture
def half_as_stiff(monkeypatch):
    """A law that stands for the exact one: half of Kalker's slope along x, all of it across."""

    @numba.njit
    def half(cx, cy, spin, a, b, normal_force, friction, shear_modulus, poisson, parameters):
        c11, c22, c23, _ = kalker_coefficients(a, b, poisson)
        area = shear_modulus * a * b
        return -0.5 * area * c11 * cx, -area * (c22 * cy + c23 * (a * b) ** 0.5 * spin), 0.0

    before = dict(CREEP_LAWS)
    register_creep_law("half as stiff", half)
    monkeypatch.setattr(law_checks, "EXACT_LAWS", ("half as stiff",))
    yield
    CREEP_LAWS.clear()
    CREEP_LAWS.update(before)


@pytest.mark.parametrize("name", ["paper-lateral-1", "s1002"])
def test_slopes_are_compared_with_the_exact_law(half_as_stiff, name):
    system = vehicle_system(name, creep="linear")
    state = system.equilibrium(30.0)
    check = check_law(system, state, 30.0, np.ones(system.size), system.jacobian(state, 30.0))
    assert check.law == "linear"
    assert check.slope_ratio == pytest.approx(2.0, rel=1e-6)
    assert (check.direction, check.slope) == ("x", pytest.approx(2.0 * check.exact_slope))
    assert "wheel" in check.where
    with pytest.warns(WheelsetWarning, match=r"-dFx/dxi = .*MN.*exact law.*\+100 % .limit 10 %"):
        linearise(system, 30.0)


def test_patches_of_a_system_are_those_of_its_contacts():
    system = vehicle_system("truck", creep="fastsim", friction=0.2)
    patches = system.creep_patches(system.equilibrium(30.0), 30.0)
    assert len(patches) >= 4
    assert {patch.law.name for patch in patches} == {"fastsim"}
    assert {patch.friction for patch in patches} == {0.2}
    assert all(patch.parameters["cells_along"] == 10.0 for patch in patches)
    # the truck of the DTU car carries 66.66 kN a wheel
    assert sum(patch.normal_force for patch in patches) == pytest.approx(4 * 66.66e3, rel=0.01)


def test_worst_check_is_warned_of():
    small, large = LawCheck(0.001, law="a"), LawCheck(0.3, law="b")
    steep = LawCheck(0.0, law="c", slope_ratio=1.5, slope=15e6, exact_slope=10e6, direction="y")
    with pytest.warns(WheelsetWarning) as caught:
        warn_of_law("car", [(10.0, small), (20.0, large), (30.0, steep)])
    first, second = (str(warning.message) for warning in caught)
    assert first.startswith("car at 20 m/s: the creep law 'b' is not linear")
    assert second.startswith("car at 30 m/s: the creep law 'c' has the slope -dFy/dxi = 15 MN")
    assert "+50 % (limit 10 %)" in second


@pytest.mark.parametrize(
    ("spin", "contact", "shen"),
    [(0.0, (14.98, None), 14.6), (-0.04, (12.42, None), 14.5), (-0.083, (9.70, 9.9), 14.1)],
)
def test_slopes_against_full_contact(spin, contact, shen):
    """The truck's patch at rest by the program CONTACT: -dFx/dxi, -dFy/dxi [MN]; nu 0.28.

    Figures of the same patch, to three digits of its axes; CONTACT's and this package's grids have
    1 % and more between them at zero spin.
    """
    patch = CreepPatch(creep_law("exact"), **PATCH | {"spin": spin, "poisson": 0.28})
    exact, by_shen = creep_slopes([patch])[0], creep_slopes([patch], "shen-hedrick-elkins")[0]
    for got, expected in zip(exact, contact, strict=True):
        if expected is not None:
            assert got == pytest.approx(1e6 * expected, rel=0.04)
    assert by_shen[0] == pytest.approx(1e6 * shen, rel=0.055)


def test_the_exact_law_tells_the_truck_from_its_fast_law():
    """Shen-Hedrick-Elkins is half again too stiff along x on the truck's patches."""
    system = vehicle_system("truck", creep="shen-hedrick-elkins")
    with pytest.warns(WheelsetWarning, match="'shen-hedrick-elkins' has the slope -dFx"):
        point = linear_critical_speed(system, 35.0, 50.0)
    assert point.slope_ratio == pytest.approx(14.1 / 9.70, rel=0.05)
    assert point.law.direction == "x"
