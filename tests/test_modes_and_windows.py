"""Modes told by what moves, and critical speeds told from other instabilities, in linear systems
whose eigenvalues and modes are prescribed: what is found must be what was put in."""

from types import SimpleNamespace

import numpy as np
import pytest

from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.linearisation import linearise
from exudyn_wheelset.stability.linear.modes import hunting_share, mode_name
from exudyn_wheelset.systems.function_system import FunctionSystem
from exudyn_wheelset.systems.trucks import trucks_by_distance

NAMES = (
    "front leading: y [m]",
    "front leading: yaw [rad]",
    "rear leading: y [m]",
    "rear leading: yaw [rad]",
    "body: x [m]",
    "body: z [m]",
    "body: y [m]",
    "body: roll [rad]",
)


def prescribed(*modes, names=NAMES, wheelsets=("front leading", "rear leading"), trucks=True):
    """x' = P B(V) P^-1 x: each mode (shape over names, growth(V), frequency) a 2 x 2 block."""
    size = len(names)
    states = (*names, *(name.replace(" [", "' [") for name in names))
    shapes = np.array([shape for shape, _, _ in modes], dtype=float).T
    rest = np.linalg.svd(shapes)[0][:, len(modes) :]
    base = np.hstack([shapes, rest])
    inverse = np.linalg.inv(base)

    def derivative(state, speed):
        q, velocity = state[:size], state[size:]
        growth = np.full(size, -50.0)
        square = np.full(size, 100.0**2)
        for k, (_, rate, frequency) in enumerate(modes):
            growth[k] = rate(speed)
            square[k] = growth[k] ** 2 + (2.0 * np.pi * frequency) ** 2
        force = 2.0 * growth * (inverse @ velocity) - square * (inverse @ q)
        return np.concatenate([velocity, base @ force])

    system = FunctionSystem("prescribed", derivative, states, np.ones(2 * size))
    system.wheelset_names = wheelsets
    if trucks:
        system.trucks = {"front": ("front leading",), "rear": ("rear leading",)}
    return system


def shape(**moves):
    places = {"fy": 0, "fyaw": 1, "ry": 2, "ryaw": 3, "x": 4, "z": 5, "y": 6, "roll": 7}
    vector = np.zeros(len(NAMES))
    for name, value in moves.items():
        vector[places[name]] = value
    return vector


def grows_from(speed, slope=0.1):
    return lambda v: slope * (v - speed)


@pytest.mark.parametrize(
    ("moves", "frequency", "name"),
    [
        ({"fy": 1.0, "fyaw": 0.5, "ry": 0.1}, 2.0, "front truck hunting"),
        ({"fy": 0.1, "ry": 1.0, "y": 0.9}, 2.0, "rear truck hunting"),
        ({"fy": 1.0, "ry": -0.9}, 2.0, "hunting of all trucks"),
        ({"y": 1.0, "roll": -0.5, "fy": 0.05}, 0.6, "body lower sway"),
        ({"y": 1.0, "roll": 0.5, "fy": 0.05}, 0.9, "body upper sway"),
        ({"z": 1.0}, 1.0, "body bounce"),
        ({"x": 1.0}, 1.5, "body longitudinal"),
    ],
)
def test_a_mode_is_named_by_what_moves_in_it(moves, frequency, name):
    system = prescribed((shape(**moves), lambda v: -0.1, frequency))
    found = linearise(system, 10.0)
    row = np.argmin(np.abs(found.eigenvalues - (-0.1 + 2j * np.pi * frequency)))
    assert found.mode_names[row] == name


@pytest.mark.parametrize(
    ("moves", "frequency", "name"),
    [
        ("z", 120.0, "contact bounce"),
        ("roll", 120.0, "contact roll"),
        ("z", 30.0, "axle bounce"),
        ("pitch", 120.0, "axle pitch"),
        ("x", 120.0, "axle longitudinal"),
    ],
)
def test_a_wheelset_bounces_on_its_contact_above_what_springs_can_do(moves, frequency, name):
    directions = ("x", "y", "z", "yaw", "roll", "pitch")
    states = [f"axle: {what} [{'m' if len(what) == 1 else 'rad'}]" for what in directions]
    system = SimpleNamespace(state_names=states, wheelset_names=("axle",), trucks={})
    mode = np.array([float(what == moves) for what in directions])
    assert mode_name(system, mode, frequency) == name


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e3])
def test_the_share_of_hunting_does_not_know_how_large_a_mode_is(size):
    """The wheelsets move 0.4 where the largest displacement, the body's, is 1."""
    mode = size * np.array(shape(fyaw=-0.4, y=1.0))
    system = prescribed((shape(y=1.0), lambda _: -1.0, 1.0))
    assert hunting_share(system, np.r_[mode, 0.0 * mode]) == pytest.approx(0.4)
    assert hunting_share(system, np.zeros(2 * len(mode))) == 0.0


def test_hunting_is_found_beside_a_longitudinal_mode_that_grows():
    system = prescribed(
        (shape(x=1.0), lambda v: 0.01, 1.5),
        (shape(fy=1.0, fyaw=0.8), grows_from(40.0), 3.0),
        (shape(ry=1.0, ryaw=0.8), grows_from(45.0), 3.1),
    )
    found = linear_critical_speed(system, 10.0, 80.0)
    assert found.speed == pytest.approx(40.0, abs=1e-5)
    assert found.mode_name == "front truck hunting"
    assert any("longitudinal" in remark and "lower end" in remark for remark in found.remarks)
    assert linearise(system, 42.0).growth_rate == pytest.approx(0.2, rel=1e-6)


def test_the_growth_rate_is_that_of_hunting_not_of_the_least_damped_mode():
    system = prescribed((shape(x=1.0), lambda v: -0.01, 1.5), (shape(fy=1.0), lambda v: -2.0, 3.0))
    assert linearise(system, 20.0).growth_rate == pytest.approx(-2.0, rel=1e-6)


@pytest.mark.parametrize("centre", [31.0, 31.8, 32.9, 33.3])
def test_an_unstable_window_between_two_scanned_speeds_is_seen(centre):
    half = 0.3
    window = (shape(fy=1.0), lambda v: 0.05 * (half**2 - (v - centre) ** 2), 3.0)
    system = prescribed(window)
    found = linear_critical_speed(system, 10.0, 88.0, points=40)
    assert found.speed == pytest.approx(centre - half, abs=1e-4)


def test_a_divergence_below_the_critical_speed_is_named():
    system = prescribed((shape(fy=1.0), grows_from(50.0), 3.0))
    inner = system.derivative

    def with_divergence(state, speed):
        return np.append(inner(state[:-1], speed), 0.01 * (speed - 30.0) * state[-1])

    whole = FunctionSystem(
        "diverging", with_divergence, (*system.state_names, "s [1]"), np.ones(system.size + 1)
    )
    found = linear_critical_speed(whole, 10.0, 80.0)
    assert found.speed == pytest.approx(50.0, abs=1e-5)
    assert any("diverges" in remark for remark in found.remarks)


def test_axles_close_together_make_a_truck():
    car = {"front leading": 9.8, "front trailing": 7.2, "rear leading": -7.2, "rear trailing": -9.8}
    assert trucks_by_distance(car) == {
        "front": ("front leading", "front trailing"),
        "rear": ("rear leading", "rear trailing"),
    }
    assert trucks_by_distance({"a": 1.5, "b": 0.1, "c": -1.5}) == {}
    assert trucks_by_distance({"a": 4.5, "b": -4.5}) == {}
    six = {f"axle {k}": x for k, x in enumerate((9.0, 7.5, 6.0, -6.0, -7.5, -9.0))}
    assert list(trucks_by_distance(six)) == ["front", "rear"]
