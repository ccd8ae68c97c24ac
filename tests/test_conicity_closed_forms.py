"""Equivalent conicity against oscillations whose wavelength is known in closed form.

With k = Delta_r/(e r0) the motion is y'' = -k(y). Unless a test says otherwise e r0 = 1 m^2 in its
formulas and tan(gamma_e) = 2 (pi/lambda)^2. Delta_r is given by points and taken as straight
between them: where it is, the result is exact to rounding; else the error is of second order.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipk

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.errors import ContactError, WheelsetError
from exudyn_wheelset.geometry.conicity import equivalent_conicity, kinematic_oscillation
from exudyn_wheelset.geometry.rolling_radius import contact_range, rolling_radius_difference
from exudyn_wheelset.profiles import Profile, load_profile, shapes

AMPLITUDES = np.array([1.0, 2.0, 3.0, 5.0, 8.0]) * 1e-3
GRID = np.linspace(-0.012, 0.012, 2401)
ROUNDING = 1e-9


def of_wavelength(wavelength: np.ndarray | float) -> np.ndarray | float:
    return 2.0 * (math.pi / wavelength) ** 2


def test_cone_keeps_its_conicity() -> None:
    conicity = equivalent_conicity(GRID, 2.0 * 0.05 * GRID, AMPLITUDES)
    np.testing.assert_allclose(conicity, 0.05, rtol=ROUNDING)


def test_two_points_and_the_zero_are_enough_for_a_cone() -> None:
    y = np.array([-0.01, 0.004, 0.01])
    for method in ("integration", "linear-regression", "harmonic"):
        conicity = equivalent_conicity(y, 0.4 * y, AMPLITUDES, method=method)
        np.testing.assert_allclose(conicity, 0.2, rtol=ROUNDING)


def test_klingel_wavelength() -> None:
    """Klingel: lambda = 2 pi sqrt(e r0/(2 gamma))."""
    motion = kinematic_oscillation(GRID, 0.05 * GRID, 4e-3, contact_spacing=1.5, radius=0.46)
    assert motion.wavelength == pytest.approx(2 * math.pi * math.sqrt(1.5 * 0.46 / 0.05), rel=1e-9)
    assert (motion.lowest, motion.highest) == pytest.approx((-4e-3, 4e-3), rel=1e-9)


def cubic(y: np.ndarray) -> np.ndarray:
    return 0.2 * y + 4e3 * y**3


def cubic_conicity(amplitude: np.ndarray) -> np.ndarray:
    """y'' = -(alpha y + beta y^3): lambda = 4 K(m)/sqrt(alpha + beta A^2)."""
    alpha, beta = 0.2, 4e3
    total = alpha + beta * amplitude**2
    return of_wavelength(4.0 * ellipk(0.5 * beta * amplitude**2 / total) / np.sqrt(total))


def test_cubic_by_elliptic_integral() -> None:
    """Straight lines over h: a relative error of about (h/A)^2 at amplitude A."""
    conicity = equivalent_conicity(GRID, cubic(GRID), AMPLITUDES)
    np.testing.assert_allclose(conicity, cubic_conicity(AMPLITUDES), rtol=1e-4)


def test_error_is_of_second_order_in_the_spacing() -> None:
    errors = []
    for points in (31, 61, 121, 241):
        y = np.linspace(-0.012, 0.012, points)
        errors.append(
            abs(equivalent_conicity(y, cubic(y), 8e-3) / cubic_conicity(np.float64(8e-3)) - 1)
        )
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert np.all(np.abs(orders - 2.0) < 0.1)


def quadratic_conicity(amplitude: float, alpha: float, beta: float) -> tuple[float, float]:
    """y'' = -(alpha y + beta y^2): conicity and lower turning point.

    Energy: (y')^2/2 = (beta/3)(y_max - y)(y - y_min)(y - y_3), y_3 = -3 alpha/(2 beta) - y_min -
    y_max, gives lambda = 4 sqrt(3/(2 beta)) K(m)/sqrt(y_max - y_3), m = 2 A/(y_max - y_3).
    """

    def level(y: float) -> float:
        return 0.5 * alpha * y**2 + beta * y**3 / 3.0

    lowest = brentq(lambda y: level(y) - level(y + 2 * amplitude), -1.5 * amplitude, 0, xtol=1e-16)
    highest = lowest + 2 * amplitude
    span = highest + 1.5 * alpha / beta + lowest + highest
    wavelength = 4.0 * math.sqrt(1.5 / beta) * ellipk(2 * amplitude / span) / math.sqrt(span)
    return float(of_wavelength(wavelength)), lowest


def test_quadratic_swings_farther_to_the_soft_side() -> None:
    alpha, beta, amplitude = 0.3, 20.0, 4e-3
    y = np.linspace(-0.006, 0.006, 2401)
    difference = alpha * y + beta * y**2
    wanted, lowest = quadratic_conicity(amplitude, alpha, beta)
    motion = kinematic_oscillation(y, difference, amplitude)
    assert lowest < -amplitude
    assert motion.lowest == pytest.approx(lowest, rel=1e-6)
    assert motion.conicity == pytest.approx(wanted, rel=1e-5)


def test_pendulum() -> None:
    """y'' = -B sin(k y): lambda = 4 K(sin^2(k A/2))/sqrt(B k)."""
    strength, k = 2e-3, 150.0
    conicity = equivalent_conicity(GRID, strength * np.sin(k * GRID), AMPLITUDES)
    wavelength = 4.0 * ellipk(np.sin(0.5 * k * AMPLITUDES) ** 2) / math.sqrt(strength * k)
    np.testing.assert_allclose(conicity, of_wavelength(wavelength), rtol=1e-4)


def test_two_slopes() -> None:
    """Half a period of each: lambda = pi/sqrt(s_1) + pi/sqrt(s_2), y_min^2 s_1 = y_max^2 s_2."""
    left, right = 0.1, 0.6
    difference = np.where(GRID < 0.0, left, right) * GRID
    motion = kinematic_oscillation(GRID, difference, 5e-3, contact_spacing=1.0, radius=1.0)
    wavelength = math.pi * (left**-0.5 + right**-0.5)
    assert motion.wavelength == pytest.approx(wavelength, rel=ROUNDING)
    assert -motion.lowest / motion.highest == pytest.approx(math.sqrt(right / left), rel=ROUNDING)


def test_dead_band_is_crossed_at_constant_speed() -> None:
    """Delta_r = 0 within +-d, slope s beyond: lambda = 2 pi/sqrt(s) + 4 d/(sqrt(s) (A - d))."""
    d, s = 2e-3, 0.8
    difference = s * (np.maximum(GRID - d, 0.0) + np.minimum(GRID + d, 0.0))
    amplitudes = np.array([2.5, 4.0, 8.0]) * 1e-3
    wavelength = (2.0 * math.pi + 4.0 * d / (amplitudes - d)) / math.sqrt(s)
    conicity = equivalent_conicity(GRID, difference, amplitudes)
    np.testing.assert_allclose(conicity, of_wavelength(wavelength), rtol=1e-8)
    np.testing.assert_array_equal(equivalent_conicity(GRID, difference, [1e-3, 1.9e-3]), 0.0)


def test_dead_band_with_noise_has_no_conicity() -> None:
    rng = np.random.default_rng(1)
    difference = np.where(np.abs(GRID) < 4e-3, 1e-9 * rng.standard_normal(len(GRID)), GRID)
    conicity = equivalent_conicity(GRID, difference, [1e-3, 2e-3, 3e-3])
    assert np.all((conicity >= 0.0) & (conicity < 1e-5))


def test_jump_alone_falls_freely() -> None:
    """Delta_r = D sign(y): lambda = 4 sqrt(2 A/D); the jump given within one micrometre."""
    y = np.array([-0.01, -5e-7, 5e-7, 0.01])
    conicity = equivalent_conicity(y, 1e-3 * np.sign(y), AMPLITUDES)
    np.testing.assert_allclose(
        conicity, of_wavelength(4.0 * np.sqrt(2.0 * AMPLITUDES / 1e-3)), rtol=1e-3
    )


def test_jump_beside_the_position_of_rest_against_time_integration() -> None:
    """A cone with a jump at 2 mm, as at a wheel's second contact: y'' integrated by Runge-Kutta."""
    jump = np.array([-0.01, -0.0021, -0.0020, 0.0015, 0.00151, 0.01])
    height = np.array([-0.0060, -0.0040, -0.0003, 0.0002, 0.0018, 0.0045])
    motion = kinematic_oscillation(jump, height, 4e-3, contact_spacing=1.0, radius=1.0)

    def accelerate(_: float, state: np.ndarray) -> list[float]:
        return [state[1], -float(np.interp(state[0], jump, height))]

    def turn(_: float, state: np.ndarray) -> float:
        return float(state[1])

    turn.terminal, turn.direction = 1, -1.0  # type: ignore[attr-defined]
    # max_step keeps the solver from stepping over the jump; its error there is the tolerance.
    run = solve_ivp(
        accelerate,
        (0.0, 20.0),
        [motion.highest, -1e-12],
        events=turn,
        rtol=1e-10,
        atol=1e-14,
        max_step=2e-3,
    )
    assert run.y[0].min() == pytest.approx(motion.lowest, abs=1e-8)
    assert run.t_events[0][-1] == pytest.approx(motion.wavelength, rel=1e-5)


def test_linear_regression_and_harmonic_of_a_cubic() -> None:
    """Delta_r = a y + b y^3: regression a + 3/5 b A^2, first harmonic a + 3/4 b A^2."""
    for method, share in (("linear-regression", 0.6), ("harmonic", 0.75)):
        conicity = equivalent_conicity(GRID, cubic(GRID), AMPLITUDES, method=method)
        wanted = 0.5 * (0.2 + share * 4e3 * AMPLITUDES**2)
        np.testing.assert_allclose(conicity, wanted, rtol=1e-4)


def test_first_harmonic_of_a_jump() -> None:
    """Describing function of a relay: 4 D/(pi A)."""
    y = np.array([-0.01, -1e-9, 1e-9, 0.01])
    conicity = equivalent_conicity(y, 1e-3 * np.sign(y), AMPLITUDES, method="harmonic")
    np.testing.assert_allclose(conicity, 0.5 * 4e-3 / (math.pi * AMPLITUDES), rtol=1e-5)


def test_falling_difference_has_no_oscillation_but_a_negative_slope() -> None:
    with pytest.raises(WheelsetError, match="runs away"):
        equivalent_conicity(GRID, -0.1 * GRID, AMPLITUDES)
    for method in ("linear-regression", "harmonic"):
        conicity = equivalent_conicity(GRID, -0.1 * GRID, AMPLITUDES, method=method)
        np.testing.assert_allclose(conicity, -0.05, rtol=ROUNDING)


def test_two_wells_leave_a_gap_of_amplitudes() -> None:
    """Delta_r = -a y + b y^3, wells at +-sqrt(a/b) = 5 mm.

    A well holds widths below sqrt(2 a/b) = 7.07 mm (from the hump to the outer turning point), the
    motion around both begins at twice that: between the amplitudes of 3.54 and 7.07 mm nothing
    oscillates. Small in a well: stiffness 2 a.
    """
    a, b = 0.2, 8e3
    difference = -a * GRID + b * GRID**3
    conicity = equivalent_conicity(GRID, difference, [2e-4, 3.5e-3, 3.6e-3, 7.0e-3, 7.2e-3, 9e-3])
    np.testing.assert_array_equal(np.isnan(conicity), [False, False, True, True, False, False])
    assert conicity[0] == pytest.approx(a, rel=5e-3)


def test_amplitude_at_the_ends_of_the_data() -> None:
    y = np.linspace(-8e-3, 8e-3, 161)
    conicity = equivalent_conicity(y, cubic(y), [8e-3])
    assert conicity[0] == pytest.approx(cubic_conicity(np.float64(8e-3)), rel=1e-3)


def test_shape_follows_the_amplitudes() -> None:
    assert equivalent_conicity(GRID, GRID, 3e-3).shape == ()
    assert equivalent_conicity(GRID, GRID, [[1e-3, 2e-3]]).shape == (1, 2)
    assert equivalent_conicity(GRID, GRID, []).shape == (0,)


@pytest.mark.parametrize(
    ("y", "difference", "amplitudes", "message"),
    [
        (GRID, GRID, [13e-3], "beyond the data"),
        (GRID, GRID - 0.011, [5e-3], "farther to the left"),
        (GRID, GRID + 0.011, [5e-3], "farther to the right"),
        (GRID, GRID + 0.02, [1e-3], "never zero"),
        (GRID[::-1], GRID, [1e-3], "sort the pairs"),
        (np.repeat(GRID, 2), np.repeat(GRID, 2), [1e-3], "remove double ones"),
        (GRID, np.where(GRID > 0.01, np.nan, GRID), [1e-3], "leave out shifts without contact"),
        (np.where(GRID > 0.01, np.inf, GRID), GRID, [1e-3], "finite"),
        (GRID, GRID[:-1], [1e-3], "equal length"),
        (GRID[:2], GRID[:2], [1e-3], "three values"),
        (GRID * 1e3, GRID * 1e3, [1.0], "given in m"),
        (GRID, GRID, [0.0], "positive"),
        (GRID, GRID, [-1e-3], "positive"),
        (GRID, GRID, [np.nan], "positive"),
    ],
)
def test_impossible_input_is_refused(y, difference, amplitudes, message) -> None:
    with pytest.raises(WheelsetError, match=message):
        equivalent_conicity(y, difference, amplitudes)


def test_unknown_method_and_lengths_are_refused() -> None:
    for wrong in ({"method": "klingel"}, {"contact_spacing": 1500.0}, {"radius": 0.0}):
        with pytest.raises(WheelsetError):
            equivalent_conicity(GRID, GRID, AMPLITUDES, **wrong)


@st.composite
def rising(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray]:
    """A polygon that rises throughout, with its zero in the middle third."""
    count = draw(st.integers(5, 40))
    steps = draw(st.lists(st.floats(0.1, 1.0), min_size=count, max_size=count))
    rises = draw(st.lists(st.floats(1e-3, 1.0), min_size=count, max_size=count))
    y = np.concatenate(([0.0], np.cumsum(steps)))
    y = 0.03 * (y / y[-1] - 0.5)
    height = np.concatenate(([0.0], np.cumsum(rises)))
    zero = np.interp(draw(st.floats(-0.005, 0.005)), y, height)
    return y, 1e-3 * (height - zero)


@settings(deadline=None, max_examples=60)
@given(curve=rising(), factor=st.floats(0.1, 10.0), stretch=st.floats(0.2, 2.0))
def test_scaling(curve: tuple[np.ndarray, np.ndarray], factor: float, stretch: float) -> None:
    """Conicity is proportional to Delta_r and to 1/y; e and r0 cancel in it."""
    y, difference = curve
    amplitude = 2e-3
    base = equivalent_conicity(y, difference, amplitude)
    higher = equivalent_conicity(y, factor * difference, amplitude, 1.3, 0.6)
    wider = equivalent_conicity(stretch * y, difference, stretch * amplitude)
    assert higher == pytest.approx(factor * base, rel=1e-8)
    assert wider == pytest.approx(base / stretch, rel=1e-8)


@settings(deadline=None, max_examples=60)
@given(curve=rising(), shift=st.floats(-0.1, 0.1), share=st.floats(0.05, 1.0))
def test_mirror_shift_and_bounds(
    curve: tuple[np.ndarray, np.ndarray], shift: float, share: float
) -> None:
    """The mirrored and the shifted wheelset oscillate alike, within half the extreme slopes."""
    y, difference = curve
    amplitude = share * 5e-3
    for method in ("integration", "linear-regression", "harmonic"):
        base = equivalent_conicity(y, difference, amplitude, method=method)
        mirrored = equivalent_conicity(-y[::-1], -difference[::-1], amplitude, method=method)
        shifted = equivalent_conicity(y + shift, difference, amplitude, method=method)
        # Shifted by up to 0.1 m, steps of a millimetre keep about 13 digits.
        assert mirrored == pytest.approx(base, rel=1e-8)
        assert shifted == pytest.approx(base, rel=1e-7)
        slopes = np.diff(difference) / np.diff(y)
        assert 0.5 * slopes.min() * (1 - 1e-9) <= base <= 0.5 * slopes.max() * (1 + 1e-9)


@settings(deadline=None, max_examples=40)
@given(curve=rising(), share=st.floats(0.05, 1.0), seed=st.integers(0, 1000))
def test_further_points_on_the_lines_change_nothing(
    curve: tuple[np.ndarray, np.ndarray], share: float, seed: int
) -> None:
    y, difference = curve
    finer = np.unique(np.concatenate((y, np.random.default_rng(seed).uniform(y[0], y[-1], 200))))
    base = equivalent_conicity(y, difference, share * 5e-3)
    more = equivalent_conicity(finer, np.interp(finer, y, difference), share * 5e-3)
    assert more == pytest.approx(base, rel=1e-7)


CONE, TAPE, RAIL_ARC, RADIUS = 0.05, 0.75, 0.08, 0.46


def arc_rail() -> Profile:
    """A rail head that is one arc of 80 mm radius."""
    angle = np.linspace(-0.45, 0.45, 901)
    return Profile("arc", "rail", RAIL_ARC * np.sin(angle), RAIL_ARC * (np.cos(angle) - 1.0))


def cone_on_arcs() -> tuple[Wheelset, Track]:
    wheelset = Wheelset(1000.0, (600.0, 100.0, 600.0), RADIUS, shapes.cone(CONE), TAPE)
    return wheelset, Track(arc_rail(), inclination=0.0, origin_half_distance=TAPE)


def test_cone_with_level_axle() -> None:
    """Delta_r = 2 gamma y on any rail: the contact stays at one place of the arc."""
    y = np.linspace(-8e-3, 8e-3, 41)
    difference = rolling_radius_difference(*cone_on_arcs(), y, neglect_roll=True)
    np.testing.assert_allclose(difference, 2.0 * CONE * y, atol=1e-9)


def test_cone_with_roll_by_plane_geometry() -> None:
    """A straight wheel profile touches a circle where its distance to the centre is R.

    In the axle's frame the left line is z = -r0 + gamma (y - b), the right one its mirror image;
    the centres of the rails' circles must lie R below. For small shifts the conicity becomes
    gamma b/(b - gamma (r0 + R)) (Wickens for a knife edge: R = 0).
    """
    cosine, sine = math.cos(math.atan(CONE)), math.sin(math.atan(CONE))

    def foot(side: int, y: float, roll: float) -> tuple[float, float]:
        """Height of the circle's centre over the axle's that makes them touch, and the radius."""
        across, c, s = side * TAPE - y, math.cos(roll), math.sin(roll)
        wanted = -RAIL_ARC / cosine - RADIUS + across * s + CONE * (side * across * c - TAPE)
        up = wanted / (c - CONE * side * s)
        y_axle = side * (across * c + up * s)
        return up, RADIUS - CONE * (y_axle - RAIL_ARC * sine - TAPE)

    shifts = np.linspace(-8e-3, 8e-3, 17)
    wanted = []
    for y in shifts:
        roll = brentq(lambda x, y=y: foot(1, y, x)[0] - foot(-1, y, x)[0], -0.01, 0.01, xtol=1e-15)
        wanted.append(foot(1, y, roll)[1] - foot(-1, y, roll)[1])
    wheelset, track = cone_on_arcs()
    difference = rolling_radius_difference(wheelset, track, shifts)
    np.testing.assert_allclose(difference, wanted, atol=2e-9)

    fine = np.linspace(-1e-3, 1e-3, 101)
    conicity = equivalent_conicity(
        fine, rolling_radius_difference(wheelset, track, fine), [1e-4, 1e-3]
    )
    effective = CONE * TAPE / (TAPE - CONE * (RADIUS + RAIL_ARC))
    # The contact lies R sin(atan gamma) = 4 mm beside the tape circle: 0.5 % of b, squared gamma.
    np.testing.assert_allclose(conicity, effective, rtol=1e-3)


def test_contact_range_ends_where_contact_does() -> None:
    wheelset = Wheelset(1000.0, (600.0, 100.0, 600.0), RADIUS, load_profile("S1002"))
    track = Track("UIC60")
    assert contact_range(wheelset, track, 5e-3) == (-5e-3, 5e-3)
    low, high = contact_range(wheelset, track, 0.09)
    assert low == pytest.approx(-high, abs=1.1e-4)
    rolling_radius_difference(wheelset, track, [low, high])
    with pytest.raises(ContactError):
        rolling_radius_difference(wheelset, track, high + 2e-4)
