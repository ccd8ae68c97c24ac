"""What is read off wheel forces and accelerations, against sines, sorted samples, hand sums."""

import math

import numpy as np
import pytest

from exudyn_wheelset import AnalysisError, Ending, Motion, Outcome
from exudyn_wheelset.results import comfort, en14363, limits
from exudyn_wheelset.results import running_safety as safety

TIME = np.arange(0.0, 40.0, 0.002)


def sine(frequency, amplitude=1.0):
    return amplitude * np.sin(2.0 * math.pi * frequency * TIME)


def rms(values):
    return math.sqrt(np.mean(values**2))


def test_nadal_and_the_limit_of_the_sum_of_y():
    # 70 degrees, friction 0.36: the 0.8 of EN 14363's 70 degree flange... tan 70 = 2.7475.
    assert safety.nadal_limit(math.radians(70.0), 0.36) == pytest.approx(
        (2.7474774 - 0.36) / (1 + 0.36 * 2.7474774), rel=1e-6
    )
    assert safety.nadal_limit(math.radians(70.0), 0.0) == pytest.approx(2.7474774, rel=1e-6)
    assert safety.sum_of_y_limit(200e3) == pytest.approx(76.6667e3, rel=1e-5)
    assert safety.sum_of_y_limit(200e3, freight=True) == pytest.approx(65.1667e3, rel=1e-5)


def test_quotient_counts_towards_the_field_side():
    # The rail pushes the left wheel to the right by 10 kN: the wheel pushes outwards.
    lateral = np.array([[[-10e3, 5e3]]])
    vertical = np.array([[[50e3, 0.0]]])
    found = safety.guiding_quotient(lateral, vertical)
    assert found[0, 0, 0] == pytest.approx(0.2) and np.isnan(found[0, 0, 1])


def test_acceleration_of_a_point_of_a_body_that_sways_and_yaws():
    """y = A sin(w t) at the centre and a yaw B sin(w t): at 5 m ahead A + 5 B, twice derived."""
    omega, sway, yaw = 6.0, 0.01, 2e-3
    rate = omega * np.cos(omega * TIME)
    columns = {f"body: v{axis} [m/s]": sway * rate * (axis == "y") for axis in "xyz"}
    columns |= {f"body: w{axis} [rad/s]": yaw * rate * (axis == "z") for axis in "xyz"}
    motion = Motion(TIME, columns, Outcome(Ending.FINISHED), 20.0)
    found = motion.acceleration("body", (5.0, 0.0, 0.0))
    known = -(sway + 5.0 * yaw) * omega**2 * np.sin(omega * TIME)
    # Central differences: (w h)^2/6 of it.
    assert found[1:-1, 1] == pytest.approx(known[1:-1], abs=1e-4 * np.abs(known).max())
    assert np.all(found[:, [0, 2]] == 0.0)
    assert motion.distance == pytest.approx(20.0 * TIME)


def test_sliding_mean_of_a_line_and_of_a_step():
    distance = np.linspace(0.0, 10.0, 1001)
    centres, means = safety.sliding_mean(distance, 3.0 * distance, 2.0, 0.5)
    assert centres == pytest.approx(np.arange(1.0, 9.01, 0.5))
    assert means == pytest.approx(3.0 * centres, rel=1e-12)
    step = (distance > 5.0).astype(float)
    _, means = safety.sliding_mean(distance, step, 2.0, 0.5)
    # The step is a ramp from 5.00 to 5.01 m.
    assert means == pytest.approx(np.clip((centres + 1.0 - 5.005) / 2.0, 0.0, 1.0), abs=1e-9)
    with pytest.raises(AnalysisError, match="needs as long a way, the motion has 1 m"):
        safety.sliding_mean(np.array([0.0, 1.0]), np.zeros(2), 2.0, 0.5)


@pytest.mark.parametrize("frequency", [2.0, 10.0, 20.0, 40.0])
def test_low_pass_by_its_formula(frequency):
    found = en14363.low_pass(TIME, sine(frequency))[5000:-5000]
    cut = 20.0 / (math.sqrt(2.0) - 1.0) ** 0.25
    # Frequencies as 500 samples a second bend them.
    bent = math.tan(math.pi * frequency / 500.0) / math.tan(math.pi * cut / 500.0)
    gain = 1.0 / (1.0 + bent**4)
    assert gain == pytest.approx(1.0 / (1.0 + (frequency / cut) ** 4), rel=0.06)
    # No phase: the sine itself, smaller.
    assert found == pytest.approx(gain * sine(frequency)[5000:-5000], abs=1e-6)


def test_two_tones_are_told_apart():
    both = sine(6.0, 2.0) + sine(30.0, 5.0)
    banded = en14363.band_pass(TIME, both, 6.0)[5000:-5000]
    assert rms(banded) == pytest.approx(2.0 / math.sqrt(2.0), rel=5e-3)


def test_percentiles_are_those_of_sorted_samples():
    values = np.random.default_rng(1).normal(size=20000)
    distance = np.linspace(0.0, 200.0, 20001)[:-1]
    found = en14363.section_percentiles(distance, values, 100.0)
    assert found.shape == (2, 3)
    for row, part in enumerate((values[:10000], values[10000:])):
        ordered = np.sort(part)
        for column, share in enumerate((0.0015, 0.5, 0.9985)):
            place = share * 9999
            low = int(place)
            known = ordered[low] + (place - low) * (ordered[low + 1] - ordered[low])
            assert found[row, column] == pytest.approx(known, abs=1e-12)


def test_maximum_values_by_hand():
    sections = np.array([1.0, 2.0, 3.0, 4.0])
    # Mean 2.5, s = sqrt(5/3).
    assert en14363.maximum_value(sections) == pytest.approx(2.5 + 3.0 * math.sqrt(5.0 / 3.0))
    x = np.array([0.0, 1.0, 2.0])
    y = np.array([0.0, 1.0, 2.6])
    # Line: slope 1.3, mean 1.2; residuals 0.1, -0.2, 0.1; t of one degree at 0.75 is 1.
    value, limit = en14363.maximum_at(x, y, 3.0, confidence=0.75)
    assert value == pytest.approx(1.2 + 1.3 * 2.0)
    s = math.sqrt(0.06 / 1.0)
    assert limit == pytest.approx(value + s * math.sqrt(1.0 + 1.0 / 3.0 + 4.0 / 2.0))


def test_instability_of_a_sine_is_its_root_mean_square():
    distance = 30.0 * TIME
    centres, found = en14363.instability(TIME, distance, sine(5.0, 8e3)[:, None], 5.0)
    assert np.diff(centres) == pytest.approx(10.0)
    assert found[5:-5, 0] == pytest.approx(8e3 / math.sqrt(2.0), rel=5e-3)


GAINS = {
    "Wd": {1: 1.011, 2: 0.890, 4: 0.512, 8: 0.253},
    "Wk": {1: 0.482, 2: 0.531, 4: 0.967, 8: 1.036, 16: 0.769},
    "Wb": {1: 0.391, 4: 0.822, 8: 1.056, 16: 0.918},
}


@pytest.mark.parametrize("name", GAINS)
def test_weightings_have_the_standard_s_gains(name):
    for frequency, gain in GAINS[name].items():
        response = comfort.WEIGHTINGS[name].response(np.array([float(frequency)]))[0]
        assert abs(response) == pytest.approx(gain, abs=6e-4)
        found = comfort.weighted(TIME, sine(frequency), name)
        assert rms(found) * math.sqrt(2.0) == pytest.approx(gain, rel=5e-3)


def test_mean_comfort_of_three_sines_by_hand():
    x, y, z = sine(1.0, 0.1), sine(2.0, 0.2), sine(8.0, 0.3)
    parts = [0.1 * 1.011, 0.2 * 0.890, 0.3 * 1.056]
    known = 6.0 * math.sqrt(sum(part**2 / 2.0 for part in parts))
    assert comfort.mean_comfort(TIME, x, y, z) == pytest.approx(known, rel=5e-3)


def test_two_tones_add_by_their_squares():
    both = comfort.weighted(TIME, sine(1.0) + sine(8.0), "Wd")
    assert rms(both) == pytest.approx(math.sqrt((1.011**2 + 0.253**2) / 2.0), rel=5e-3)


@pytest.mark.parametrize("vertical", [False, True])
def test_sperling_of_a_sine_by_its_formula(vertical):
    f, amplitude = 4.0, 0.5
    above = (1 - 0.277 * f**2) ** 2 + (1.563 * f - 0.0368 * f**3) ** 2
    weight = math.sqrt((1.911 * f**2 + (0.25 * f**2) ** 2) / above) * (0.588 if vertical else 0.737)
    known = 4.42 * (weight * amplitude / math.sqrt(2.0)) ** 0.3
    assert comfort.sperling(TIME, sine(f, amplitude), vertical) == pytest.approx(known, rel=1e-3)


def test_methods_of_a_motion_are_these_formulas_of_its_own_columns():
    """A body that sways and a wheelset whose rails push by sines: every figure by hand.

    0.5 % for the ends of the record, which the filters see and the closed forms do not.
    """
    frequency, sway, push, hunting = 2.0, 0.01, 4e3, 6.0
    omega = 2.0 * math.pi * frequency
    columns = {f"body: v{axis} [m/s]": np.zeros_like(TIME) for axis in "xyz"}
    columns |= {f"body: w{axis} [rad/s]": np.zeros_like(TIME) for axis in "xyz"}
    columns["body: vy [m/s]"] = sway * omega * np.cos(omega * TIME)
    for side in ("left", "right"):
        columns[f"axle {side}: Q [N]"] = np.full_like(TIME, 50e3)
        columns[f"axle {side}: Y [N]"] = 0.5 * sine(hunting, push)
    motion = Motion(TIME, columns, Outcome(Ending.FINISHED), 20.0)
    acceleration = sway * omega**2 / math.sqrt(2.0)
    weight = abs(comfort.WEIGHTINGS["Wd"].response(np.array([frequency]))[0])
    assert motion.continuous_comfort("body")[:, 1] == pytest.approx(acceleration * weight, rel=5e-3)
    assert motion.mean_comfort("body") == pytest.approx(6.0 * acceleration * weight, rel=5e-3)
    assert motion.sperling("body") == comfort.sperling(TIME, motion.acceleration("body")[:, 1])
    _, found = motion.instability(hunting)
    assert found[2:-2, 0] == pytest.approx(push / math.sqrt(2.0), rel=5e-3)
    # Of a sine through zero the middle is none, and 99.85 % of it are below 0.99998 of its top.
    sections = motion.percentiles(motion.sum_of_y())
    assert sections[:, 1, 0] == pytest.approx(0.0, abs=5e-3 * push)
    assert sections[:, 2, 0] == pytest.approx(push, rel=5e-3)


def test_limits_of_49_cfr_213_333_by_hand():
    """75 degrees: (3.732 - 0.5)/(1 + 1.866) = 1.128; an axle of 50 kips: 0.4 + 5/50 = 0.5."""
    assert limits.single_wheel_limit(math.radians(75.0)) == pytest.approx(1.1277, abs=1e-4)
    assert limits.net_axle_limit(50.0 * 4448.2216) == pytest.approx(0.5, rel=1e-9)
    for limit in (*limits.EN_14363.values(), *limits.CFR_213_333.values(), *limits.COMFORT_STEPS):
        assert limit.edition and limit.unit and limit.formula


def test_peak_to_peak_and_detrended_rms_of_a_sine_on_a_slope():
    """A sine of amplitude a on a line: peak to peak 2 a without it, RMS_t a/sqrt(2) with it.

    Over a whole number of periods; what the sine has in common with the line is 3 a/(pi n) at most
    in the line's share, its square 0.9 % of the mean square for n = 4 periods.
    """
    a, frequency = 0.3, 5.0
    wave = sine(frequency, a)
    assert limits.peak_to_peak(TIME, wave, 1.0) == pytest.approx(2.0 * a, rel=1e-3)
    slow = wave + 0.7 * TIME - 2.0
    assert limits.detrended_rms(TIME, slow, 4.0) == pytest.approx(a / math.sqrt(2.0), rel=5e-3)
    assert limits.detrended_rms(TIME, 0.7 * TIME, 2.0) == pytest.approx(0.0, abs=1e-6)
    with pytest.raises(AnalysisError, match="run longer"):
        limits.peak_to_peak(TIME[:10], wave[:10], 1.0)
