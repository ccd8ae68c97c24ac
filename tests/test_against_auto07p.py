"""Hopf points, folds and curves of both in two parameters against AUTO-07p, on smooth problems.

AUTO-07p (E. J. Doedel et al., Concordia University, 2012) through bifpy, which is optional and
compiles it: without it these tests are skipped. Problems: the bogie at rest (Hopf points, which do
not see its flange), and x'' - (mu + a x^2 - b x^4) x' + x = 0, whose cycles have a fold below a
subcritical Hopf point (a = 0: a Bautin point).
"""

import numpy as np
import pytest

from exudyn_wheelset import linear_critical_speed, stability_map
from exudyn_wheelset.catalogue.cooperrider_bogie import SCALES, CooperriderBogie
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.linear.crossings import hopf_points
from exudyn_wheelset.systems.function_system import FunctionSystem

auto = pytest.importorskip("bifpy.auto")

COMMON = {
    "npar": 2,
    "iad": 3,
    "ilp": 1,
    "isp": 2,
    "iads": 1,
    "itmx": 9,
    "itnw": 7,
    "nwtn": 3,
    "jac": 0,
    "a0": -1e300,
    "a1": 1e300,
    "epsl": 1e-7,
    "epsu": 1e-7,
    "epss": 1e-5,
}


def first(result, kind):
    return next(p for b in result.branches for p in b.points if p.point_type == kind)


def bogie_rates(state, parameters):
    bogie = CooperriderBogie(conicity=float(parameters[1]))
    states = np.array([[state[k] for k in range(14)]]) * SCALES
    # In milliseconds, so that rates are of the order of the states.
    return list(1e-3 * bogie.derivatives(states, float(parameters[0]))[0] / SCALES)


def bogie_start(state, parameters, phase):
    for k in range(14):
        state[k] = 0.0
    parameters[0], parameters[1] = 60.0, 0.05


@pytest.mark.slow
def test_hopf_points_of_the_bogie_over_speed_and_conicity():
    settings = {
        **COMMON,
        "ips": auto.IPS_EQUILIBRIUM,
        "ndim": 14,
        "nmx": 60,
        "ntst": 5,
        "ncol": 4,
        "ds": 0.5,
        "dsmin": 1e-3,
        "dsmax": 2.0,
        "rl0": 20.0,
        "rl1": 80.0,
    }
    found = auto.run(bogie_rates, bogie_start, settings, icu=[1])
    hopf = first(found, auto.PointType.HOPF_BIFURCATION)
    ours = linear_critical_speed("cooperrider", 20.0, 120.0)
    # Jacobians of either side are differences.
    assert hopf.all_parameters[0] == pytest.approx(ours.speed, abs=1e-4)
    locus = auto.restart(bogie_rates, {**settings, "nmx": 12}, icu=[1, 2], restart_point=hopf)
    points = [point.parameters[:2] for point in locus.branches[0].points]
    assert len(points) > 5 and np.ptp([conicity for _, conicity in points]) > 1e-3
    for speed, conicity in points[::3]:
        ours = linear_critical_speed(CooperriderBogie(conicity=conicity), 15.0, 150.0)
        assert speed == pytest.approx(ours.speed, abs=1e-3)


# A speed is mu and this: the search for branches is in shares of the Hopf point's.
SHIFT = 2.0


def oscillator(a):
    def rates(states, speed):
        x, v = states.T
        return np.stack([v, (speed - SHIFT + a * x**2 - x**4) * v - x], axis=1)

    return FunctionSystem(
        "quintic",
        lambda state, speed: rates(state[None], speed)[0],
        ("x", "v"),
        (1.0, 1.0),
        displacement_indices=(0,),
        derivatives_function=rates,
    )


def oscillator_rates(state, parameters):
    x, v = state[0], state[1]
    return [v, (parameters[0] + parameters[1] * x**2 - x**4) * v - x]


@pytest.mark.slow
def test_fold_of_cycles_over_two_parameters():
    start = 1.0
    system = oscillator(start)
    (hopf,) = hopf_points(system, 1.5, 2.5)
    assert hopf.speed == pytest.approx(SHIFT, abs=1e-6)
    branch = limit_cycles(system, hopf, (1.5, 2.3))
    (fold,) = branch.folds
    large = branch.orbits[int(np.argmax(branch.amplitude["x"]))]

    def begin(state, parameters, phase):
        here = large.evaluate(np.array([phase]))[0]
        state[0], state[1] = here
        parameters[0], parameters[1] = large.speed - SHIFT, start
        parameters[auto.PERIOD_INDEX - 1] = large.period

    settings = {
        **COMMON,
        "ips": auto.IPS_PERIODIC_ORBIT,
        "ndim": 2,
        "nmx": 200,
        "ntst": 40,
        "ncol": 4,
        "ds": -0.01,
        "dsmin": 1e-4,
        "dsmax": 0.05,
        "rl0": -0.6,
        "rl1": 0.35,
        "mxbf": 0,
    }
    found = auto.run(oscillator_rates, begin, settings, icu=[1, auto.PERIOD_INDEX])
    theirs = first(found, auto.PointType.FOLD)
    assert fold - SHIFT == pytest.approx(theirs.all_parameters[0], abs=1e-6)
    # The first restart makes the data of the extended equations only, the second follows.
    for steps in (5, 15):
        locus = auto.restart(
            oscillator_rates,
            {**settings, "nmx": steps, "ds": 0.01},
            icu=[1, 2, auto.PERIOD_INDEX],
            restart_point=theirs,
        )
        theirs = locus.branches[0].points[-1]
    points = [point.parameters[:2] for point in locus.branches[0].points]
    values = [a for _, a in points]
    assert np.ptp(values) > 0.02
    limits = (min(values) - 0.05, max(values) + 0.05)
    ours = stability_map(oscillator, "speed", "a", limits, speeds=(1.4, 2.3), starts=1)
    for mu, a in points[::3]:
        (speed,) = ours.folds[0].speeds_at(a)
        # Places on the curve are right to 1e-3 in speed at most (see fold_curves).
        assert speed - SHIFT == pytest.approx(mu, abs=1e-3)
