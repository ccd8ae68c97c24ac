"""Every public name, called wrongly: an error of the package or a warning, never one of Python's.

The names and their arguments are read from the package, so that a new one is covered by itself; it
needs a value in `GOOD` or `POOL` for each argument that it cannot do without. Each argument is
spoilt in turn, the others stay good: text for a number, not a number, infinity, True, a list, an
object, an array of another shape, a number below zero where none belongs.
"""

import inspect
import math
import warnings
from functools import cache

import exudyn as exu
import numpy as np
import pytest

import exudyn_wheelset as ew
from exudyn_wheelset import WheelsetError, WheelsetWarning


def oscillator(state, speed):
    x, rate = state
    return np.array([rate, -x + (speed - 3.0) * rate - x * x * rate])


@cache
def pool():
    """A good value by the name of an argument."""
    axle = ew.Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    track = ew.Track("UIC60")
    springs = ew.Suspension(1.0, (1e6, 1e6, 1e6))
    system = ew.FunctionSystem("oscillator", oscillator, ["y [m]", "v [m/s]"], [1, 1])
    wedge = ew.FrictionWedge(35.0, 0.3, 1e4, 1e5)
    y = np.linspace(-0.02, 0.02, 81)
    return {
        "wheelset": axle, "track": track, "vehicle": system, "wheel": "S1002", "rail": "UIC60",
        "wheelsets": (), "connections": (),
        "primary": springs, "secondary": springs, "suspension": springs, "wedge": wedge,
        "stiffness": (1e6, 1e6, 1e6), "direction": (0.0, 1.0, 0.0), "damping": 1e4,
        "mass": 1500.0, "inertia": (800.0, 110.0, 800.0), "radius": 0.46, "half_distance": 1.0,
        "frame_mass": 3e3, "frame_inertia": (2e3, 2e3, 3e3), "half_wheelbase": 1.25,
        "car_load": 1.5e5, "axle_load": 1e5, "friction": 0.3, "length": 100.0, "start": 10.0,
        "speed": 2.0, "low": 1.0, "high": 5.0, "speeds": (1.0, 4.0), "name": "mine",
        "kind": "wheel",
        "y": y, "z": 0.05 * y, "elements": [ew.Straight(100.0)], "spring_set": 1,
        "pose": (0, 0, -1e-4, 0, 0, 0), "velocity": (20, 0, 0, 0, 43, 0), "mbs": None,
        "frame": ew.TrackFrame(), "bodies": [], "profile": ew.load_profile("S1002"),
        "name_or_path": "S1002", "source": None, "path": "nowhere", "outcome": finished(),
        "time": np.zeros(1), "columns": {}, "ending": ew.Ending.FINISHED, "duration": 0.01,
        "sections": [ew.load_profile("S1002")] * 2, "distance": np.arange(4.0),
        "shifts": np.zeros((4, 4)), "scales": [1.0], "state_names": ["y [m]"],
        "derivative_function": oscillator, "disturbance": 0.1, "largest": 0.1,
        "rolling_radius_difference": 0.1 * y, "amplitudes": 3e-3, "parameter": "friction",
        "limits": (0.1, 0.3), "first": "speed", "function": len, "cls": ew.Spring,
        "wanted": {"linear_critical_speed": 2.0}, "vary": ["friction"], "executor": 1,
        "cases": [{"x": 1.0}], "motion": ew.Motion(np.zeros(1), {}, finished(), 20.0),
    }  # fmt: skip


@cache
def car():
    return ew.catalogue.vehicle("dtu_car")


def finished():
    return ew.Outcome(ew.Ending.FINISHED)


# What the pool has no single value for.
GOOD = {
    "AirSpring": {"stiffness": (1e5, 1e5, 4e5), "surge_stiffness": 2e5, "surge_damping": 2e4},
    "AntiRollBar": {"stiffness": 1e6},
    "BumpStop": {"table": [(0, 0), (0.01, 1e4), (0.02, 1e5)]},
    "CentrePlate": {"radius": 0.15},
    "Curve": {"radius": 500.0},
    "FrictionDamper": {"force": 5e3, "stiffness": 1e7},
    "FrictionWedge": {"angle": 35.0, "column_force": 1e4, "spring": 1e5},
    "LinkSuspension": {"stiffness": 1e6, "length": (0.3, 0.3), "friction": (0.02, 0.02)},
    "MaxwellDamper": {"stiffness": 1e6},
    "SideBearer": {"gap": 0.006, "stiffness": 1e6},
    "Spectrum": {"edition": "here", "formula": "A", "amplitude": 1e-7, "power": 2, "poles": (0.8,)},
    "TractionRod": {"stiffness": 5e6},
    "creep_force": {
        "law": "polach", "creep_x": 1e-3, "creep_y": 0.0, "spin": 0.0, "a": 5e-3, "b": 5e-3,
        "normal_force": 8e4, "shear_modulus": 8e10, "poisson": 0.28,
    },
    "contact_geometry": {"y": 0.0},
    "limit_cycles": {"start": [0.1, 0.0], "start_speed": 3.5},
    "create_wheelset": {"speed": 20.0},
}  # fmt: skip
OF_A_VEHICLE = {
    "save_vehicle", "static_equilibrium", "steady_curve", "with_free_lengths", "design", "film",
}  # fmt: skip
# No call makes sense of these: abstract classes and an enumeration.
NOT_CALLED = {"DynamicSystem", "Element", "Ending"}
# Called wrongly only: what the package makes by itself, and what takes such a thing.
RESULTS = {"Branch", "SteadyCurve", "Study", "WheelRailContact", "WheelsetItems", "switch_branch"}
# Arguments that are of any kind: names and words, what is only kept, what tells itself what it is.
FREE = {
    "name", "description", "record", "source", "remarks", "law_parameters", "progress", "edition",
    "formula", "unit", "detail", "columns", "settings", "executor", "cases", "state_file", "path",
    "coordinates", "everything", "figure", "file", "smoothing", "solver_type", "initial",
}  # fmt: skip
# Numbers that may well be below zero.
SIGNED = {
    "y", "z", "yaw", "inclination", "creep_x", "creep_y", "spin", "radius of Curve", "start",
    "station", "shift_y", "shift_z", "lateral_offset", "height", "axle_drop", "secondary_rise",
    "low", "speed", "start_speed", "speeds", "guess", "normal_force", "cant", "gradient",
    "offset", "position", "shifts", "distance", "direction", "pose", "velocity", "time", "limits",
    "rolling_radius_difference", "state", "table", "rail_motion", "rail_slope", "widening", "watch",
    "along", "radius",
}  # fmt: skip
# Takes as many numbers as it is given.
ANY_LENGTH = {"speeds", "poles", "amplitudes", "y", "scales", "time", "large_starts_at", "distance"}

NAMES = [
    name
    for name in ew.__all__
    if callable(found := getattr(ew, name))
    and name not in NOT_CALLED
    and not (inspect.isclass(found) and issubclass(found, BaseException))
]
VARIABLE = (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)


def parameters(name):
    found = inspect.signature(getattr(ew, name)).parameters.items()
    return {key: one for key, one in found if one.kind not in VARIABLE}


def good(name):
    """Arguments that fit, for what the name cannot do without."""
    made = {}
    for key, parameter in parameters(name).items():
        if key in GOOD.get(name, ()):
            made[key] = GOOD[name][key]
        elif parameter.default is inspect.Parameter.empty:
            assert key in pool(), f"{name}: put a good value of {key!r} into GOOD or pool()"
            made[key] = pool()[key]
    if name in OF_A_VEHICLE:
        made["vehicle"] = car()
    if name == "Vehicle":
        made |= {key: getattr(car(), key) for key in made}
    if "mbs" in made:
        made["mbs"] = exu.SystemContainer().AddSystem()
    return made


def outcome(name, arguments):
    """ "refused", "warned", or the result; fails for an error that is not the package's."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            getattr(ew, name)(**arguments)
        except WheelsetError as error:
            assert len(str(error)) > 20
            return "refused"
        except Exception as error:
            pytest.fail(f"{name}({arguments!r:.300}): {type(error).__name__}: {error}")
    return "warned" if any(issubclass(w.category, WheelsetWarning) for w in caught) else "taken"


def is_number(value):
    return isinstance(value, int | float) and not isinstance(value, bool)


def spoilt(key, parameter, value):
    """Wrong values of an argument by what is wrong about them."""
    takes = str(parameter.annotation)
    if is_number(value) or (value is None and takes in ("float | None", "int | None")):
        wrong = {
            "a text": "much", "not a number": math.nan, "infinite": math.inf, "True": True,
            "a list": [[1.0, 2.0], [3.0]], "an object": object(),
        }  # fmt: skip
        if key not in SIGNED:
            wrong["negative"] = -(abs(value) if value else 1.0)
        return wrong
    flat = isinstance(value, tuple | list | np.ndarray) and np.ndim(value) == 1
    if flat and len(value) and is_number(np.asarray(value, dtype=object)[0]):
        numbers = [float(one) for one in value]
        wrong = {
            "a text": "much", "an object": object(), "a matrix": [[[1.0]]],
            "text in it": ["much", *numbers[1:]], "not a number in it": [math.nan, *numbers[1:]],
            "infinite in it": [math.inf, *numbers[1:]],
        }  # fmt: skip
        if key not in ANY_LENGTH:
            wrong |= {"one number": 1.0, "too long": [*numbers, 1.0], "too short": numbers[:-1]}
        return wrong
    if isinstance(value, bool):
        return {"a text": "much", "a number": 5.0}
    return {"an object": object(), "a number": 5.0}


@pytest.mark.parametrize("name", NAMES)
def test_missing_and_misspelt_arguments_are_named(name):
    required = [
        key for key, one in parameters(name).items() if one.default is inspect.Parameter.empty
    ]
    if required:
        with pytest.raises(WheelsetError, match=required[0]):
            getattr(ew, name)()
    arguments = {} if name in RESULTS else good(name)
    words = "missing" if name == "switch_branch" else "nonsens"
    with pytest.raises(WheelsetError, match=words):
        getattr(ew, name)(**arguments, nonsens=1)


@pytest.mark.parametrize("name", [name for name in NAMES if name not in RESULTS])
def test_a_spoilt_argument_is_refused_or_warned_of(name):
    silent = []
    for key, parameter in parameters(name).items():
        if key in FREE:
            continue
        value = good(name).get(key, parameter.default)
        for what, wrong in spoilt(key, parameter, value).items():
            if outcome(name, {**good(name), key: wrong}) == "taken":
                silent.append(f"{key}: {what}")
    assert not silent
