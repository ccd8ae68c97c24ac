"""Eigenvalues against the growth of simulated small motion, law by law, vehicle by vehicle.

What an eigenvalue is worth depends on the creep law: it is a growth rate where the law has a
derivative at the equilibrium. Each vehicle starts in its hunting mode, 0.03 mm large, and is
simulated by Exudyn for four periods; a two-term recursion fitted to one displacement gives growth
and frequency. Allowed is a difference of 2 % of the frequency, at five speeds around the critical
one. Laws without a derivative are warned of (tests/test_law_checks.py); what becomes of them stands
here.
"""

import warnings

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import (
    MarkerBodyRigid,
    ObjectConnectorCartesianSpringDamper,
    RigidBodyInertia,
)

from exudyn_wheelset import (
    ExudynSystem,
    Track,
    Wheelset,
    WheelsetWarning,
    create_wheelset,
    linear_critical_speed,
    linearise,
)
from exudyn_wheelset.catalogue.by_name import vehicle, vehicle_system
from exudyn_wheelset.creep import CREEP_LAWS
from exudyn_wheelset.stability.linear.law_checks import ADDITIVITY_LIMIT
from exudyn_wheelset.systems.system import as_system

RATIOS = (0.85, 0.95, 1.0, 1.05, 1.15)
# Exudyn's rotation vectors lose their digits below some 1e-6 rad; above 0.1 mm the curvature of
# S1002 shows.
START = 3.0e-5
ALLOWED = 0.02
# What RK44 at 0.5 ms and the amplitude leave: up to 0.05 % of the frequency, 0.25 % for FASTSIM,
# whose slope jumps as cells turn from stick to slip.
LEFT = 0.003

GRAVITY = 9.81


def three_axle_truck(creep, friction=0.3):
    """A locomotive's truck from `create_wheelset` and Exudyn's own springs, S1002 on UIC60 1:40.

    Three axles 1.8 m apart under a frame of 12 t, which carries 30 t; soft primary springs, so that
    it hunts at a train's speed.
    """
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    wheelset = Wheelset(mass=2000.0, inertia=(1100.0, 150.0, 1100.0), radius=0.5, wheel="S1002")
    track = Track("UIC60")
    frame_mass, load = 12.0e3, 30.0e3 * GRAVITY
    axles = (1.8, 0.0, -1.8)
    wheelsets = [
        create_wheelset(
            mbs,
            wheelset,
            track,
            position=(x, 0.0),
            speed=20.0,
            moving_frame=True,
            sensors=False,
            show=False,
            name=f"wheelset {k + 1}",
            gravity=GRAVITY,
            creep=creep,
            friction=friction,
        )
        for k, x in enumerate(axles)
    ]
    height = float(mbs.GetNodeParameter(wheelsets[0].node, "referenceCoordinates")[2])
    frame = mbs.CreateRigidBody(
        name="frame",
        inertia=RigidBodyInertia(mass=frame_mass, inertiaTensor=np.diag([8.0e3, 3.0e4, 3.5e4])),
        nodeType=exu.NodeType.RotationRotationVector,
        referencePosition=[0.0, 0.0, height],
        gravity=[0.0, 0.0, -GRAVITY],
        returnDict=True,
    )["bodyNumber"]
    ground = mbs.CreateGround()

    def connect(lower, upper, stiffness, damping, carried=0.0):
        markers = [
            mbs.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=place))
            for body, place in (lower, upper)
        ]
        mbs.AddObject(
            ObjectConnectorCartesianSpringDamper(
                markerNumbers=markers,
                stiffness=stiffness,
                damping=damping,
                offset=[0.0, 0.0, carried / stiffness[2] if stiffness[2] else 0.0],
            )
        )

    for items, x in zip(wheelsets, axles, strict=True):
        for y in (1.0, -1.0):
            connect(
                (items.body, [0.0, y, 0.0]),
                (frame, [x, y, 0.0]),
                [5.0e6, 2.5e6, 1.2e6],
                [0.0, 0.0, 2.0e4],
                (frame_mass * GRAVITY + load) / 6.0,
            )
    for y in (1.1, -1.1):
        connect((frame, [0.0, y, 0.5]), (ground, [0.0, y, height + 0.5]),
                [0.2e6, 0.2e6, 0.6e6], [0.0, 4.0e4, 4.0e4], 0.5 * load)  # fmt: skip
        connect((frame, [0.0, y, 0.0]), (ground, [0.0, y, height]),
                [0.0, 0.0, 0.0], [2.0e5, 0.0, 0.0])  # fmt: skip
    return ExudynSystem(mbs, container, name="three-axle truck")


MAKERS = {
    "AAR wheelset": lambda law: vehicle_system("paper-1", creep=law),
    "AAR wheelset, lateral": lambda law: vehicle_system("paper-lateral-1", creep=law),
    "S1002 wheelset": lambda law: vehicle_system("s1002", creep=law),
    "truck": lambda law: vehicle_system("truck", creep=law),
    "three-axle truck": three_axle_truck,
}


def critical(system):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", WheelsetWarning)
        return linear_critical_speed(system, 10.0, 180.0, points=35)


def hunting_root(system, speed, point):
    """The root that crosses zero at the critical speed, its mode, and the equilibrium."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", WheelsetWarning)
        linear = linearise(system, speed)
    expected = 2j * np.pi * point.frequency * speed / point.speed
    row = int(np.argmin(np.abs(linear.eigenvalues - expected)))
    return complex(linear.eigenvalues[row]), linear.eigenvectors[:, row], linear.state


def root_of_oscillation(times, signal):
    """Growth rate and angular frequency of samples of one oscillation, as a complex root.

    s[k+1] = b s[k] - c s[k-1] with b, c by least squares: its poles are exp(root dt).
    """
    before, here, after = signal[:-2], signal[1:-1], signal[2:]
    (b, minus_c), *_ = np.linalg.lstsq(np.column_stack([here, before]), after, rcond=None)
    root = np.log(complex(np.roots([1.0, -b, -minus_c])[0])) / (times[1] - times[0])
    return complex(root.real, abs(root.imag))


def simulated_root(system, speed, point, periods=4.0):
    """Root of simulated small motion that starts in the hunting mode, and the eigenvalue."""
    root, mode, state = hunting_root(system, speed, point)
    shown = list(system.displacement_indices)
    leading = shown[int(np.argmax(np.abs(mode[shown]) / system.scales[shown]))]
    start = state + (mode * (START / mode[leading])).real
    times = np.linspace(0.0, periods * 2.0 * np.pi / root.imag, 40 * int(periods) + 1)
    motion = (system.simulate(start, speed, times) - state)[:, leading]
    return root_of_oscillation(times[20:], motion[20:]), root


SMOOTH = [
    law
    for law in CREEP_LAWS
    # no derivative; the exact law by its table, which costs a ten-thousandth
    if not law.startswith("polach-2005") and law not in ("polach", "exact")
]
FAST = {
    ("AAR wheelset", "polach-kalker"),
    ("AAR wheelset, lateral", "fastsim"),
    ("S1002 wheelset", "fastsim"),
    ("truck", "polach-kalker"),
    ("three-axle truck", "shen-hedrick-elkins"),
    *((vehicle, "exact-table") for vehicle in MAKERS),
}
# Whole vehicles of the catalogue; every law on them stands in docs/hunting.md.
WHOLE = {
    "bogie in 3-D": lambda law: vehicle_system("cooperrider_bogie_3d", creep=law),
    "DTU car": lambda law: vehicle_system("dtu_car", creep=law),
    "Manchester coach": lambda law: vehicle_system("manchester_coach", creep=law),
}
CASES = [
    pytest.param(vehicle, law, marks=() if (vehicle, law) in FAST else pytest.mark.slow)
    for vehicle in MAKERS
    for law in SMOOTH
] + [(vehicle, "exact-table") for vehicle in WHOLE]
MAKERS = MAKERS | WHOLE


@pytest.mark.parametrize(("vehicle", "law"), CASES)
def test_growth_rate(vehicle, law):
    system = MAKERS[vehicle](law)
    point = critical(system)
    assert point.additivity < ADDITIVITY_LIMIT
    for ratio in RATIOS:
        measured, root = simulated_root(system, ratio * point.speed, point)
        assert abs(measured.real - root.real) < min(LEFT, ALLOWED) * root.imag
        assert measured.imag == pytest.approx(root.imag, rel=LEFT)
        # the sign is what an analysis of stability is for, where it is no matter of tolerance
        if abs(root.real) > LEFT * root.imag:
            assert (measured.real > 0.0) == (root.real > 0.0)


def test_an_eigenvalue_of_polachs_law_misses_by_more_than_is_allowed():
    """On the catalogue's three-axle truck it is zero at 92.4 m/s, growth of motion at 102 m/s."""
    system = as_system(vehicle("three_axle_truck", creep="polach"))
    point = critical(system)
    measured, root = simulated_root(system, point.speed, point)
    assert point.additivity > 5 * ADDITIVITY_LIMIT
    assert abs(root.real) < 1e-3 * root.imag
    assert measured.real < -ALLOWED * root.imag


def test_an_eigenvalue_of_polachs_law_is_no_growth_rate():
    """On a truck small motion dies out at 51 m/s where the eigenvalue has grown since 44.7 m/s."""
    system = MAKERS["truck"]("polach")
    point = critical(system)
    assert point.additivity > 5 * ADDITIVITY_LIMIT
    measured, root = simulated_root(system, 1.15 * point.speed, point)
    assert root.real > LEFT * root.imag
    assert measured.real < -0.5 * LEFT * root.imag
