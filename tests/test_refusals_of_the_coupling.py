"""What create_wheelset and ExudynSystem refuse: value, unit or kind, range, mend."""

import exudyn as exu
import numpy as np
import pytest

from exudyn_wheelset import (
    Contact,
    ExudynSystem,
    Track,
    Wheelset,
    WheelsetError,
    create_wheelset,
    wheelsets_of,
)

WHEELSET = Wheelset(mass=1500.0, inertia=(900.0, 100.0, 900.0), radius=0.46, wheel="S1002")
TRACK = Track("UIC60")
CONTAINER = exu.SystemContainer()


@pytest.fixture
def mbs():
    return CONTAINER.AddSystem()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"speed": "30"}, r"speed = '30' is no number: give a number in m/s"),
        ({"speed": 300.0}, r"speed = 300.0 m/s: give a number from -200 to 200 m/s; .*in m/s\?"),
        ({"speed": float("nan")}, r"speed = nan m/s"),
        (
            {"lateral_offset": 2.0},
            r"lateral_offset = 2.0 m: give a number from -0.02.*in metres\?",
        ),
        ({"lateral_offset": "2e-3"}, r"lateral_offset = '2e-3' is no number"),
        ({"position": (0.0, 0.75)}, r"position y \+ lateral_offset = 0.75 m: give"),
        ({"position": (0.0,)}, r"position \(x, y\) = \[0.0\] has 1 entries: give 2 numbers"),
        ({"position": "00"}, r"position \(x, y\) = '00': give 2 numbers"),
        ({"yaw": 2.0}, r"yaw = 2.0 rad: give a number from -0.1 to 0.1 rad; .*in radians\?"),
        ({"height": 0.46}, r"height = 0.46 m: give a number from -0.1 to 0.1 m; it counts from"),
        ({"gravity": True}, r"gravity = True is no number: give a number in m/s\^2"),
        ({"moving_frame": "no"}, r"moving_frame = 'no': give True or False"),
        ({"sensors": 2}, r"sensors = 2: give True or False"),
        ({"frition": 0.4}, r"frition.*did you mean 'friction'"),
        ({"moving_fram": True}, r"moving_fram.*did you mean 'moving_frame'"),
        ({"contact": 0.4}, r"contact = 0.4: give a Contact\(friction=0.4\)"),
        ({"contact": Contact(), "friction": 0.4}, r"friction = 0.4 is given beside a contact"),
        ({"friction": -0.1}, r"friction = -0.1: give a number from 0 to 5"),
        ({"rail_elasticity": 2e7}, r"rail_elasticity = 20000000.0: give a RailElasticity"),
        ({"irregularity": 1e-3}, "irregularity = 0.001: give an Irregularity, from_psd"),
    ],
)
def test_create_wheelset_refuses(mbs, options, words):
    with pytest.raises(WheelsetError, match=words):
        create_wheelset(mbs, WHEELSET, TRACK, **options)
    # Nothing half-made is left in the system.
    assert mbs.systemData.NumberOfNodes() == mbs.systemData.NumberOfObjects() == 0


def test_swapped_arguments_are_named(mbs):
    for arguments, words in (
        (
            (WHEELSET, mbs, TRACK),
            r"wheelset is a MainSystem: give a Wheelset.*order is create_wheelset\(mbs, wheelset, ",
        ),
        ((mbs, TRACK, WHEELSET), r"wheelset is a Track: give a Wheelset"),
        ((mbs, WHEELSET, "UIC60"), r"track = 'UIC60': give a Track\(\"UIC60\"\)"),
        ((CONTAINER, WHEELSET, TRACK), r"mbs is a SystemContainer"),
    ):
        with pytest.raises(WheelsetError, match=words):
            create_wheelset(*arguments)
    with pytest.raises(WheelsetError, match="mbs is a SystemContainer"):
        wheelsets_of(CONTAINER)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"step": "1e-4"}, r"step = '1e-4' is no number: give a number in s"),
        ({"step": 0.0}, r"step = 0.0 s: give a positive number in s"),
        ({"step": 20.0}, r"step = 20.0 s is out of proportion"),
        ({"solver_type": "RK45"}, r"unknown solver type 'RK45'.*did you mean 'RK44'"),
        (
            {"settings": {"endTime": 2.0}},
            r"settings = \{'endTime': 2.0\}: give exudyn.Sim",
        ),
        ({"name": 3}, r"name = 3: give a text"),
        ({"state_names": ["y [m]"]}, r"state_names has 1 entries, the system has 11 states: x \[m"),
        ({"state_names": "yaw"}, r"state_names has a text"),
        ({"scales": [1.0] * 3}, r"scales has 3 entries, the system has 11 states"),
        ({"scales": [1e-3] * 10 + ["1"]}, r"scale of wz \[rad/s\] = '1' is no number"),
        ({"scales": [1e-3] * 10 + [0.0]}, r"scale of wz \[rad/s\] = 0.0 SI: give a positive"),
        (
            {"displacement_indices": ["y [m]"]},
            r"displacement_indices holds 'y \[m\]': give",
        ),
        ({"displacement_indices": [11]}, r"displacement_indices holds 11: give 0 to 10"),
        ({"spinning_nodes": [7]}, r"spinning_nodes names 7, the model has 0"),
        ({"spining_nodes": [0]}, r"unknown option 'spining_nodes'.*did you mean 'spinning_nodes'"),
        ({"cyclic": [4]}, r"part of the rotation vector of node 0.*spinning_nodes instead"),
    ],
)
def test_exudyn_system_refuses(mbs, options, words):
    create_wheelset(mbs, WHEELSET, TRACK, moving_frame=True, sensors=False, show=False)
    with pytest.raises(WheelsetError, match=words):
        ExudynSystem(mbs, CONTAINER, **options)


def test_exudyn_system_in_the_wrong_order(mbs):
    with pytest.raises(WheelsetError, match=r"mbs is a SystemContainer.*ExudynSystem\(mbs, SC\)"):
        ExudynSystem(CONTAINER, mbs)
    create_wheelset(mbs, WHEELSET, TRACK, moving_frame=True)
    with pytest.raises(WheelsetError, match=r"SC is a .*MainSystem"):
        ExudynSystem(mbs, mbs)


def test_what_is_possible_is_taken(mbs):
    """Numbers of numpy, places at the edge of what the rails hold."""
    items = create_wheelset(
        mbs, WHEELSET, TRACK, speed=np.float64(30.0), position=np.array([1.0, 0.0]), height=0.0,
        yaw=np.int64(0), lateral_offset=-0.022, moving_frame=np.bool_(True),
    )  # fmt: skip
    assert items.reference[0] == 1.0
