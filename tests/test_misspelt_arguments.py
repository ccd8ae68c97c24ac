"""A misspelt argument offers the near name, a missing one is named; text is no number."""

import warnings

import numpy as np
import pytest

import exudyn_wheelset as package
from exudyn_wheelset import FunctionSystem, WheelsetError, catalogue

SYSTEM = FunctionSystem(
    "two modes", lambda x, v: [x[1], -x[0] + (v - 3.0) * x[1]], ["y [m]", "v [m/s]"], [1, 1]
)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda p: p.linear_critical_speed(SYSTEM, lo=1, high=6), "'lo'.*did you mean 'low'"),
        (lambda p: p.hopf_points(SYSTEM, low=1, hihg=6), "'hihg'.*did you mean 'high'"),
        (lambda p: p.linearise(SYSTEM, sped=1.0), "'sped'.*did you mean 'speed'"),
        (lambda p: p.root_locus(SYSTEM, speds=[1.0]), "'speds'.*did you mean 'speeds'"),
        (lambda p: p.nonlinear_critical_speed(SYSTEM, metod="descent"), "did you mean 'method'"),
        (lambda p: p.critical_disturbance(SYSTEM, 5.0), "missing a required argument: 'largest'"),
        (lambda p: p.Spring(stifness=(1e6, 1e6, 1e6)), "'stifness'.*did you mean 'stiffness'"),
        (lambda p: p.Damper((1, 0, 0), dampning=1e4), "'dampning'.*did you mean 'damping'"),
        (lambda p: p.AirSpring((1e6, 1e6, 1e6)), "missing a required argument"),
        (lambda p: p.MaxwellDamper((1, 0, 0), 1e6, 1e4, 5), "too many positional arguments"),
        (lambda p: p.linear_critical_speed(SYSTEM, "1", 6), "low = '1' is no number"),
        (lambda p: p.hopf_points(SYSTEM, 1, None), "high = None is no number"),
        (lambda p: p.linearise(SYSTEM, "40"), "speed = '40' is no number.*in m/s"),
        (lambda p: p.linearise(SYSTEM, [40.0]), r"speed = \[40.0\] is no number"),
        (lambda p: p.root_locus(SYSTEM, ["a"]), "one of speeds = 'a' is no number"),
        (lambda p: p.root_locus(SYSTEM, []), "give one speed"),
        (lambda p: p.limit_cycles(SYSTEM, [1, 0], 60), r"speeds \(low, high\) = 60: give 2"),
        (lambda p: p.limit_cycles(SYSTEM, "hopf", (1, 6)), "'hopf': give 2 numbers"),
        (lambda p: p.limit_cycles(SYSTEM, [1, 0, 0], (1, 6)), "has 3 entries: give 2"),
        (lambda p: p.nonlinear_critical_speed(SYSTEM, low="1"), "low = '1' is no number"),
        (
            lambda p: p.static_equilibrium("dtu_car"),
            "= .dtu_car.: give a Vehicle.*vehicle",
        ),
        (lambda p: p.with_free_lengths(5), "vehicle = 5: give a Vehicle"),
        (lambda p: p.dtu_truck(frition=0.3), "'frition'.*friction"),
        (lambda p: p.paper_parameters(1, masss=5.0), "'masss'.*did you mean 'mass'"),
        (lambda p: p.VehicleBuilder("v", p.Track("UIC60")).body("b", mas=5), "mean 'mass'"),
        (lambda p: p.VehicleBuilder("v", p.Track("UIC60")).connect(naem="a"), "mean 'name'"),
    ],
)
def test_the_near_name_is_offered(call, words):
    with pytest.raises(WheelsetError, match=words):
        call(package)


def test_a_right_call_is_not_touched():
    assert package.linear_critical_speed(SYSTEM, 1.0, high=6.0).speed == pytest.approx(3.0)
    assert package.root_locus(SYSTEM, 2.0).speeds == pytest.approx([2.0])
    assert package.Spring((1e6, 1e6, 1e6)) == package.Spring(stiffness=(1e6, 1e6, 1e6))
    assert package.linear_critical_speed.__name__ == "linear_critical_speed"


def test_an_error_inside_is_not_taken_for_a_wrong_call():
    broken = FunctionSystem("broken", lambda x, v: x + None, ["y [m]", "v [m/s]"], [1, 1])
    with pytest.raises(TypeError, match="NoneType"):
        package.linearise(broken, 2.0)


def test_warnings_still_name_the_line_of_the_caller():
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        package.linear_critical_speed(catalogue.dtu_car(), 30.0, 60.0)
    laws = [one for one in told if "creep law" in str(one.message)]
    assert laws and all(one.filename == __file__ for one in laws)
    assert np.all([one.lineno > 0 for one in laws])
