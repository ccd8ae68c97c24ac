"""Derivatives of critical speeds against differences of critical speeds computed anew.

Differences are central, with steps that move the speed by 1e-4 of itself: their own error of second
order is below 1e-6 where speeds are smooth, and below 1e-2 next to the flange, which sinks in by
micrometres at the fold of the bogie.
"""

import pickle
from dataclasses import dataclass, replace

import numpy as np
import pytest

from exudyn_wheelset import AnalysisError, design, nonlinear_critical_speed
from exudyn_wheelset.catalogue import vehicle
from exudyn_wheelset.stability.gradients import differentiate
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.condensed import Direction
from exudyn_wheelset.stability.hunting.fold_points import fold_near, prepared
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.crossings import hopf_points
from exudyn_wheelset.stability.numbers import number_of, vehicle_numbers
from exudyn_wheelset.stability.subject import as_system, changed, description_of
from exudyn_wheelset.systems.changed_vehicle import ChangedVehicles
from exudyn_wheelset.systems.function_system import FunctionSystem


@dataclass(frozen=True)
class NormalForm:
    """r' = (mu - shift + quadratic r^2 - quartic r^4) r: Hopf at shift, fold quadratic^2/4 quartic
    below it (Strogatz, Nonlinear Dynamics and Chaos, section 8.2)."""

    shift: float = 2.0
    quadratic: float = 1.0
    quartic: float = 1.0
    turn: float = 3.0

    def replace(self, path, value):
        return replace(self, **{path: value})

    def dynamic_system(self):
        def rates(states, mu):
            x, y = states.T
            square = x**2 + y**2
            growth = mu - self.shift + self.quadratic * square - self.quartic * square**2
            return np.stack([growth * x - self.turn * y, self.turn * x + growth * y], axis=1)

        return FunctionSystem(
            "normal form",
            lambda state, mu: rates(state[None], mu)[0],
            ("x [m]", "y [m]"),
            (1.0, 1.0),
            displacement_indices=(0,),
            derivatives_function=rates,
        )


@dataclass(frozen=True)
class Stiffness:
    """A spring that is not there yet [N/m]."""

    stiffness: float = 0.0

    def replace(self, path, value):
        return replace(self, **{path: value})

    def dynamic_system(self):
        parameters = {"stiffness": self.stiffness}
        return FunctionSystem(
            "spring", lambda state, speed: -state, ("x [m]",), (1.0,), parameters=parameters
        )


def test_normal_form_in_closed_form():
    form = NormalForm(quadratic=0.8, quartic=1.3)
    (hopf,) = hopf_points(form, 1.0, 3.0)
    gradient = hopf.gradient()
    expected = {"shift": 1.0, "quadratic": 0.0, "quartic": 0.0, "turn": 0.0}
    # The Jacobian is that of central differences.
    assert dict(gradient) == pytest.approx(expected, abs=1e-6)
    (fold,) = limit_cycles(form, hopf, (1.5, 2.5)).folds
    gradient = fold.gradient()
    assert fold == pytest.approx(2.0 - 0.8**2 / (4.0 * 1.3), abs=1e-6)
    expected |= {"quadratic": -0.8 / (2.0 * 1.3), "quartic": 0.8**2 / (4.0 * 1.3**2)}
    # Collocation of a circle on 30 intervals: 1e-6.
    assert dict(gradient) == pytest.approx(expected, abs=1e-5)
    assert gradient.influence["quadratic"] == pytest.approx(-(0.8**2) / 2.6 / float(fold), rel=1e-4)
    copy = pickle.loads(pickle.dumps(gradient))
    assert dict(copy) == dict(gradient) and copy.influence == gradient.influence


def test_hopf_point_of_the_bogie_by_every_number():
    bogie = vehicle("cooperrider")
    hopf = linear_critical_speed("cooperrider", 20.0, 120.0)
    gradient = hopf.gradient()
    assert len(gradient) == 25 and gradient.left_out == {}
    for name, number in gradient.numbers.items():
        speeds = [
            linear_critical_speed(
                bogie.replace(name, factor * number.value), 20.0, 120.0, guess=hopf, tolerance=1e-9
            )
            for factor in (1.001, 0.999)
        ]
        difference = (speeds[0].speed - speeds[1].speed) / 2e-3
        # Speeds are roots to 1e-9 m/s of growth rates that differences blur by 1e-8.
        expected = pytest.approx(difference, rel=1e-3, abs=1e-4)
        assert gradient[name] * number.value == expected, name
    assert gradient.numbers["conicity"].unit == "-"
    assert gradient.units["primary_lateral_stiffness"] == "(m/s)/(N/m)"


@pytest.fixture(scope="module")
def bogie_speed():
    return nonlinear_critical_speed("cooperrider", check=False)


@pytest.mark.slow
def test_fold_of_the_bogie_by_every_number(bogie_speed):
    bogie = vehicle("cooperrider")
    gradient = bogie_speed.gradient()
    system = as_system(bogie)
    fold = fold_near(system, prepared(system, bogie_speed.branch.folds[0].orbit), "lowest", 1e-7)
    assert gradient.speed == pytest.approx(fold.orbit.speed, abs=1e-6)
    for name, number in gradient.numbers.items():
        # The trailing flange sinks in by 3.5 um at the fold, and its stiffness hardly moves it:
        # folds are known to 2e-7 m/s.
        step = {"flange_clearance": 2e-7, "flange_stiffness": 1e-3 * number.value}.get(
            name, 1e-4 * number.value
        )
        speeds = [
            fold_near(
                as_system(bogie.replace(name, number.value + sign * step)),
                fold.orbit,
                "lowest",
                1e-8,
            ).orbit.speed
            for sign in (1.0, -1.0)
        ]
        difference = (speeds[0] - speeds[1]) / (2.0 * step)
        assert gradient[name] == pytest.approx(difference, rel=0.01), name


def test_fold_of_the_bogie_by_whole_diagrams(bogie_speed):
    # Diagrams place a fold to 3e-3 m/s; two per cent of the conicity move it by 1.4 m/s.
    bogie = vehicle("cooperrider")
    gradient = bogie_speed.gradient(["conicity", "half_wheelbase"])
    assert sorted(gradient) == ["conicity", "half_wheelbase"]
    for name in gradient:
        value = gradient.numbers[name].value
        speeds = [
            nonlinear_critical_speed(bogie.replace(name, factor * value), check=False).speed
            for factor in (1.02, 0.98)
        ]
        assert gradient[name] == pytest.approx((speeds[0] - speeds[1]) / (0.04 * value), rel=0.01)


def test_tornado_names_the_largest(bogie_speed):
    import matplotlib.pyplot as plt

    gradient = bogie_speed.gradient()
    axes = gradient.plot(most=5)
    widths = [bar.get_width() for bar in axes.patches]
    largest = list(gradient.influence.items())[:5]
    # Ten per cent of a number change the speed by a tenth of its influence, the largest on top.
    expected = [0.1 * share * gradient.speed for _, share in largest[::-1]]
    assert widths == pytest.approx(expected)
    plt.close("all")


@pytest.mark.slow
def test_s1002_wheelset():
    wheelset = description_of("s1002")
    found = nonlinear_critical_speed(wheelset, check=False)
    steps = {
        "track.gauge": 2e-5,
        "contact.friction": 1e-3,
        "wheelsets.wheelset.mass": 2.0,
        "connections.spring.stiffness.x": 4e3,
        "connections.spring.damping.x": 50.0,
    }
    gradient = found.gradient(list(steps))
    system = as_system(wheelset)
    fold = next(fold for fold in found.branch.folds if fold == found)
    # On so many intervals a mesh point more or less moves the fold by 2e-4 m/s, on the 90 of the
    # gradient by 3e-3, which is 3 % of what the gauge does.
    begin = prepared(system, fold.orbit, 240)
    for name, step in steps.items():
        value = gradient.numbers[name].value
        speeds = [
            fold_near(as_system(changed(wheelset, name, value + way)), begin, "lowest", 1e-6)
            for way in (step, -step)
        ]
        difference = (speeds[0].orbit.speed - speeds[1].orbit.speed) / (2.0 * step)
        assert gradient[name] == pytest.approx(difference, rel=0.03), name
    # Both rails move apart by half of the gauge, both wheels by the tape circle's distance.
    tape = gradient["wheelsets.wheelset.tape_half_distance"]
    assert tape == pytest.approx(-2.0 * gradient["gauge"], rel=0.01)
    # One spring of two: half of what both do, on a symmetric orbit.
    both = gradient["connections.spring.stiffness.x"]
    assert gradient["connections.left spring.stiffness.x"] == pytest.approx(0.5 * both, rel=1e-3)


def test_hopf_point_of_a_truck():
    truck = description_of("truck")
    hopf = linear_critical_speed(truck, 20.0, 80.0)
    gradient = hopf.gradient(["track.gauge", "bodies.frame.mass", "wheelsets.*.inertia.xz"])
    for name, step in (("track.gauge", 1e-5), ("bodies.frame.mass", 3.0)):
        value = gradient.numbers[name].value
        speeds = [
            linear_critical_speed(truck.replace(name, value + way), 20.0, 80.0, guess=hopf).speed
            for way in (step, -step)
        ]
        assert gradient[name] == pytest.approx((speeds[0] - speeds[1]) / (2.0 * step), rel=0.01)
    assert gradient["wheelsets.*.inertia.xz"] < 0.0


def test_numbers_are_those_that_replace_writes():
    """By the same paths: with parts of names, and with and without the word for the holder."""
    truck = description_of("truck")
    for path in (
        "wheelsets.*.mass",
        "wheelsets.leading wheelset.wheelset.mass",
        "connections.left primary.stiffness.y",
        "connections.left primary.element.stiffness.y",
        "bodies.frame.inertia.z",
    ):
        found = number_of(truck, path).value
        assert number_of(truck.replace(path, 1.5 * found), path).value == 1.5 * found, path


def test_only_what_spins_has_one_inertia_about_x_and_z():
    truck = description_of("truck")
    numbers = vehicle_numbers(truck)
    about = {name: number.value for name, number in numbers.items() if ".inertia." in name}
    axle, frame = truck.wheelsets[0].wheelset.inertia, truck.bodies[0].inertia
    assert axle[0] == axle[2] and frame[0] == frame[2]
    assert about == {
        **{f"bodies.frame.inertia.{axis}": value for axis, value in zip("xyz", frame, strict=True)},
        "wheelsets.*.inertia.xz": axle[0],
        "wheelsets.*.inertia.y": axle[1],
    }


def test_a_number_that_is_zero_is_never_made_negative():
    """Its derivative is that of the side that exists: +1 of |k| at 0."""
    form = Stiffness()
    number = number_of(form, "stiffness")
    tried = []

    def result(system):
        tried.append(system.parameters["stiffness"])
        return np.array([abs(tried[-1])])

    assert differentiate(form, number, result) == pytest.approx(1.0)
    assert number.value == 0.0 and min(tried) == 0.0 and max(tried) == number.step


def test_systems_without_a_description_say_so():
    hopf = hopf_points(NormalForm().dynamic_system(), 1.0, 3.0)[0]
    with pytest.raises(AnalysisError, match="give the vehicle"):
        hopf.gradient()
    assert hopf.gradient(vehicle=NormalForm())["shift"] == pytest.approx(1.0, abs=1e-6)


def test_design_reaches_what_is_wanted():
    form = NormalForm()
    found = design(
        form, {"nonlinear_critical_speed": 1.9}, vary=["quadratic"], low=1.0, high=3.0, check=False
    )
    # 2 - q^2/4 = 1.9
    assert found.vehicle.quadratic == pytest.approx(np.sqrt(0.4), rel=0.01)
    assert found.reached["nonlinear_critical_speed"] == pytest.approx(1.9, rel=1e-3)
    bogie = design(
        "cooperrider",
        {"linear_critical_speed": 72.0},
        vary=["primary_longitudinal_stiffness", "half_wheelbase"],
    )
    again = linear_critical_speed(bogie.vehicle, 20.0, 120.0)
    assert again.speed == pytest.approx(72.0, rel=1e-3)
    before, after = bogie.changes["half_wheelbase"]
    assert before == 1.074 and 1.0 < after / before < 1.2
    with pytest.raises(AnalysisError, match="did not bring"):
        design(form, {"linear_critical_speed": 3.0}, vary=["quadratic"], low=1.0, high=3.0, steps=2)
    with pytest.raises(AnalysisError, match="cannot be asked for"):
        design(form, {"comfort": 3.0}, vary=["quadratic"])


@pytest.mark.parametrize("mirrored", [False, True])
def test_left_null_vector_is_the_transposed_solution(mirrored):
    """<w, defects> is the speed that the equations themselves give for any defects."""
    system = NormalForm().dynamic_system()
    (hopf,) = hopf_points(system, 1.0, 3.0)
    (fold,) = limit_cycles(system, hopf, (1.5, 2.5)).folds
    orbit = fold.orbit.halved(-np.ones(2)) if mirrored else fold.orbit
    equations = Collocation(system, orbit.period, 1.0, orbit.mirror)
    condensed = equations.condense(orbit)
    windows = equations.windows(orbit)
    rows = [equations.phase(orbit), equations.inner(orbit.mesh, Direction(windows, 0.0, 0.0))]
    weights = condensed.speed_weights(rows)
    random = np.random.default_rng(3)
    for _ in range(3):
        defects = random.normal(size=weights.shape)
        speed = condensed.solve(defects, rows, [0.0, 0.0]).speed
        assert np.sum(weights * defects) == pytest.approx(speed, rel=1e-9)


@pytest.mark.parametrize("name", ["s1002", "truck"])
def test_rates_of_changed_vehicles_are_those_of_models_made_anew(name):
    """Two ways from the same description to f: without Exudyn and through a whole model in it.

    Both search the place at rest to 1e-9 of the penetration, which is 1e-7 of f in its scales.
    """
    description = description_of(name)
    system = as_system(description)
    vehicles = ChangedVehicles(description, system)
    shifts = np.random.default_rng(1).normal(size=(5, system.size)) * np.asarray(system.scales)
    states = system.equilibrium(30.0) + shifts
    before = system.derivatives(states, 30.0)
    for number in list(vehicle_numbers(description).values())[::2]:
        other = changed(description, number.name, number.value + number.step)
        anew = as_system(other).derivatives(states, 30.0)
        size = np.abs((anew - before) / system.scales).max()
        apart = np.abs((vehicles.rates(other, states, 30.0) - anew) / system.scales).max()
        assert apart < 1e-5 * size + 1e-6, number.name
