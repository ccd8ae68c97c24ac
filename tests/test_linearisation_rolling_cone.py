"""Linearised against simulated hunting of a rolling coned wheelset in Exudyn.

A wheelset of conicity 0.05 on springs to a frame that moves at V, with vertical contact springs
and saturating creep as user-function loads, written here in a few lines. Exudyn's integration of
the full spinning body knows nothing of the reduced state, so equal growth rates confirm the
reduction, the gyroscopic terms and the derivative of the loads at once. Klingel's formula gives
the frequency of a free wheelset, omega = V sqrt(lambda/(r0 e)).
"""

import math

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import Force, MarkerBodyRigid, RigidBodyInertia, Torque
from numba import njit

from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.linearisation import linearise
from exudyn_wheelset.systems.exudyn_system import ExudynSystem

RADIUS, CONICITY, HALF_GAUGE, LOAD, FRICTION = 0.45, 0.05, 0.75, 8.0e4, 0.3
CREEP_STIFFNESS, CONTACT_STIFFNESS, CONTACT_DAMPING = 1.0e7, 5.0e8, 1.0e4


@njit
def add_wheel(side, position, axle, velocity, spin, speed, wrench):
    """Add force and moment of one wheel (side 1 left, -1 right) in the moving track frame."""
    along = side * HALF_GAUGE - position[1]
    radius = RADIUS - CONICITY * (side * along - HALF_GAUGE)
    arm = np.array([along * axle[0], side * HALF_GAUGE - position[1], along * axle[2] - radius])
    point = velocity + np.cross(spin, arm)
    normal = max(0.0, LOAD - CONTACT_STIFFNESS * (position[2] + arm[2] + RADIUS))
    creep_x, creep_y = (point[0] + speed) / speed, point[1] / speed
    creep = math.hypot(creep_x, creep_y)
    limit = FRICTION * normal + 1e-9
    u = CREEP_STIFFNESS * creep / limit
    ratio = CREEP_STIFFNESS * (1.0 - u / 3.0 + u * u / 27.0) if u < 3.0 else limit / creep
    force = np.array([-ratio * creep_x, -ratio * creep_y, normal - CONTACT_DAMPING * point[2]])
    force[1] -= side * CONICITY * normal
    wrench[:3] += force
    wrench[3:] += np.cross(arm, force)


@pytest.fixture(scope="module")
def wheelset():
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    body = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=1250.0, inertiaTensor=np.diag([700.0, 100.0, 700.0])),
        nodeType=exu.NodeType.RotationRotationVector,
        returnDict=True,
    )
    ground = mbs.CreateGround()
    for side in (-1.0, 1.0):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body["bodyNumber"]],
            localPosition0=[0.0, side, 0.0],
            localPosition1=[0.0, side, 0.0],
            stiffness=[2e5, 1e5, 1e5],
            damping=[5e2, 5e2, 1e3],
        )
    node, types = body["nodeNumber"], exu.OutputVariableType
    wrench = np.zeros(6)

    def evaluate():
        axle = mbs.GetNodeOutput(node, types.RotationMatrix).reshape(3, 3)[:, 1].copy()
        wrench[:] = (0.0, 0.0, -2.0 * LOAD, 0.0, 0.0, 0.0)
        for side in (1.0, -1.0):
            add_wheel(
                side,
                mbs.GetNodeOutput(node, types.Displacement),
                axle,
                mbs.GetNodeOutput(node, types.Velocity),
                mbs.GetNodeOutput(node, types.AngularVelocity),
                mbs.variables["speed"],
                wrench,
            )

    def force(mbs, t, load):
        evaluate()
        return wrench[:3]

    def torque(mbs, t, load):
        evaluate()
        return wrench[3:]

    def set_speed(mbs, speed):
        mbs.variables["speed"] = speed

    marker = mbs.AddMarker(MarkerBodyRigid(bodyNumber=body["bodyNumber"]))
    mbs.AddLoad(Force(markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=force))
    mbs.AddLoad(Torque(markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=torque))
    return ExudynSystem(
        mbs, container, set_speed=set_speed, spinning_nodes={node: RADIUS}, name="coned wheelset"
    )


@pytest.fixture(scope="module")
def critical(wheelset):
    return linear_critical_speed(wheelset, 5.0, 120.0)


def test_critical_speed_and_klingels_frequency(wheelset, critical):
    klingel = critical.speed * math.sqrt(CONICITY / (RADIUS * HALF_GAUGE)) / (2.0 * math.pi)
    # Springs and inertia against creep shift the free wheelset's frequency by some per cent.
    assert critical.frequency == pytest.approx(klingel, rel=0.05)
    assert critical.state[wheelset.state_names.index("wy [rad/s]")] == pytest.approx(
        critical.speed / RADIUS, rel=1e-9
    )
    warm = linear_critical_speed(wheelset, 5.0, 120.0, guess=1.05 * critical)
    assert warm.speed == pytest.approx(critical.speed, abs=1e-5)
    assert warm.evaluations < critical.evaluations / 2


@pytest.mark.parametrize("ratio", [0.85, 0.95, 1.0, 1.05, 1.15])
def test_growth_rate_of_simulated_motion(wheelset, critical, ratio):
    speed = ratio * critical.speed
    linear = linearise(wheelset, speed)
    expected = 2j * math.pi * critical.frequency * ratio
    index = int(np.argmin(np.abs(linear.eigenvalues - expected)))
    root, mode = linear.eigenvalues[index], linear.eigenvectors[:, index]
    start = linear.state + 1e-2 * (mode / np.abs(mode / wheelset.scales).max()).real
    times = np.linspace(0.0, 1.0, 201)
    motion = wheelset.simulate(start, speed, times) - linear.state
    amplitude = motion @ np.linalg.inv(linear.eigenvectors)[index]
    growth = np.polyfit(times, np.log(np.abs(amplitude)), 1)[0]
    frequency = np.polyfit(times, np.unwrap(np.angle(amplitude)), 1)[0]
    # Amplitudes of 10 micrometres: the creep law's curvature leaves less than 1e-4.
    assert growth == pytest.approx(root.real, abs=1e-4 * root.imag)
    assert frequency == pytest.approx(root.imag, rel=1e-4)
