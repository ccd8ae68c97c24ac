"""Wrong studies, settings and analyses: refused, naming value and mend."""

import math

import numpy as np
import pytest
from wrong_inputs import check, rows

import exudyn_wheelset as ew
from exudyn_wheelset.studies import files, grid, latin_hypercube, study, table_rows


def spiral(state, speed):
    x, y = state
    growth = speed - 1 + (x * x + y * y) - (x * x + y * y) ** 2
    return np.array([growth * x - 6 * y, 6 * x + growth * y])


def descent(high=0.9, low=0.6, **options):
    system = ew.FunctionSystem("spiral", spiral, ["x [m]", "y [m]"], [1e-2, 1e-2])
    return ew.quasi_static_descent(system, high, low, **options)


def basin(speeds=0.9, disturbance=1e-3, **options):
    system = ew.FunctionSystem("spiral", spiral, ["x [m]", "y [m]"], [1e-2, 1e-2])
    return ew.basin(system, speeds, disturbance, **options)


def film(vehicle="s1002", motion=None, *arguments, **options):
    if motion is None:
        motion = ew.Motion(np.zeros(1), {}, ew.Outcome(ew.Ending.FINISHED), 20.0)
    return ew.film(vehicle, motion, *arguments, **options)


STUDIES = {
    "empty grid": (lambda: grid({}), ["at least one"]),
    "grid of a word": (lambda: grid(creep="polach"), ["polach", "list"]),
    "grid of a number": (lambda: grid(friction=0.3), ["0.3", "list"]),
    "range upside down": (lambda: latin_hypercube(5, friction=(0.5, 0.1)), ["0.5", "low below"]),
    "range of three": (lambda: latin_hypercube(5, friction=(0.1, 0.2, 0.3)), ["0.3", "low"]),
    "no cases": (lambda: latin_hypercube(0, friction=(0.1, 0.5)), ["0", "at least one"]),
    "count a fraction": (lambda: latin_hypercube(2.5, friction=(0.1, 0.5)), ["2.5"]),
    "missing table": (lambda: table_rows("no_table.csv"), ["no_table.csv"]),
    "columns of two lengths": (lambda: table_rows({"a": [1, 2], "b": [1]}), ["lengths"]),
    "empty folder": (lambda: files("/dev", "*.whl"), ["*.whl", "/dev"]),
    "no folder": (lambda: files("/no/where", "*.whl"), ["/no/where"]),
    "function a number": (lambda: study(3, [{"x": 1}], 1), ["3", "function"]),
    "no case": (lambda: study(len, [], 1), ["at least one"]),
    "cases a number": (lambda: study(len, 5, 1), ["5", "list"]),
    "processes of a lambda": (lambda: study(lambda case: 1, [{"x": 1}] * 2, 2), ["executor=1"]),
    "minus two processes": (lambda: study(len, [{"x": 1}], -2), ["-2"]),
    "executor a word": (lambda: study(len, [{"x": 1}], "many"), ["many"]),
    "cases missing": (lambda: study(len), ["cases", "missing"]),
    "executor misspelt": (lambda: study(len, [{"x": 1}], exectuor=1), ["exectuor", "'executor'"]),
    "settings a word": (lambda: study(len, [{"x": 1}], 1, settings="a"), ["'a'", "mapping"]),
    "a case with an object": (lambda: study(len, [{"x": object()}], 1), ["x", "numbers, texts"]),
}


def settings(entries):
    return lambda: ew.load_settings(entries)


SETTINGS = {
    "unknown name": (settings({"timeIntegration.endtime": 1.0}), ["endTime"]),
    "a word for a number": (settings({"timeIntegration.endTime": "2"}), ["'2'", "float"]),
    "a word of another enum": (settings({"timeIntegration.solverType": "RK45"}), ["RK45", "RK44"]),
    "infinite": (settings({"timeIntegration.endTime": math.inf}), ["inf", "finite"]),
    "negative steps": (settings({"timeIntegration.numberOfSteps": -5}), ["-5"]),
    "a number too long": (settings({"timeIntegration.endTime": 10**400}), ["401 digits"]),
    "name a number": (settings({3: 1.0}), ["3", "words"]),
    "missing file": (settings("nowhere.json"), ["nowhere.json"]),
    "a number": (settings(5), ["5", "file"]),
    "settings of simulate": (
        lambda: ew.simulate("s1002", 20.0, 0.1, settings={"endTime": 1}),
        ["endTime", "load_settings"],
    ),
}
ANALYSES = {
    "eigenvalues at rest": (lambda: ew.linearise("s1002", 0.0), ["0.0 m/s", "other than 0"]),
    "motion of equations divided by the speed": (
        lambda: ew.simulate(ew.LateralWheelset(), 0.0, 0.1),
        ["0.0 m/s", "other than 0"],
    ),
    "root locus from rest": (lambda: ew.root_locus("s1002", [0, 20]), ["0.0 m/s", "other than 0"]),
    "descent by a word": (lambda: descent(step="small"), ["step", "small", "in m/s"]),
    "descent upwards": (lambda: descent(0.6, 0.9), ["0.6", "0.9", "above"]),
    "descent from a negative disturbance": (
        lambda: descent(disturbance=-1),
        ["disturbance", "-1", "positive"],
    ),
    "descent from three states": (lambda: descent(state=[0.1] * 3), ["(3,)", "2 states"]),
    "descent, misspelt": (lambda: descent(stepp=0.1), ["stepp", "'step'"]),
    "descent without end": (lambda: ew.quasi_static_descent("s1002", 60.0), ["low", "missing"]),
    "basin without disturbance": (lambda: ew.basin("s1002", 60.0), ["disturbance", "missing"]),
    "basin at a word": (lambda: basin("60"), ["speeds", "'60'", "m/s"]),
    "basin of a word": (lambda: basin(disturbance="much"), ["disturbance", "much", "in m"]),
    "basin of half a sample": (lambda: basin(samples=1.5), ["samples", "1.5", "whole"]),
    "basin upside down": (lambda: basin(disturbance={"x": (1.0, 0.0)}), ["(1.0, 0.0)", "below"]),
    "motion of an unknown name": (
        lambda: ew.simulate("dtu_cra", 20.0, 0.1),
        ["dtu_cra", "dtu_car"],
    ),
    "motion without duration": (lambda: ew.simulate("s1002", 20.0), ["duration", "missing"]),
    "motion without vehicle": (lambda: ew.simulate(speed=20.0), ["vehicle", "missing"]),
    "film of a number": (lambda: film(motion=3.0), ["motion", "3.0", "simulate"]),
    "film to a number": (lambda: film("s1002", None, 7), ["path", "7", ".mp4"]),
    "film of one size": (lambda: film(size=640), ["size", "640", "2 numbers"]),
    "film seen by a number": (lambda: film(view=2), ["view", "2", "wheel"]),
    "film at a word": (lambda: film(rate="fast"), ["rate", "fast"]),
    "film, misspelt": (lambda: film(seconds=1, veiw="wheel"), ["veiw", "'view'"]),
}
TABLE = rows(studies=STUDIES, settings=SETTINGS, analyses=ANALYSES)


@pytest.mark.parametrize("name", TABLE)
def test_a_wrong_input_is_refused_with_value_and_mend(name):
    check(TABLE[name])
