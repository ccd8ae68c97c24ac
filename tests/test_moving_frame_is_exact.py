"""Bodies in a frame that follows the track against their free motion in space.

A free body moves straight and keeps its angular momentum, whatever the frame does from which it is
looked at. The equations of motion are put together here from the loads of the frame alone and
solved by an adaptive method of order eight, stopped where the track's functions have a kink in a
derivative; positions in space are those of an integral along the track done here as well.
"""

from itertools import pairwise

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import RigidBodyInertia
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from exudyn_wheelset import Curve, Layout, Straight, TrackFrame, Transition, add_frame_loads
from exudyn_wheelset.coupling import moving_frame as loads
from exudyn_wheelset.coupling import track_kernel

LAYOUTS = {
    "curves and gradient": Layout(
        [
            Straight(60),
            Transition(50, shape="bloss"),
            Curve(radius=-300, cant=0.12, length=150, widening=0.01),
            Transition(80, shape="clothoid"),
            Curve(radius=400, cant=0.1, length=100),
            Transition(60, shape="helmert"),
            Straight(400),
        ],
        gradient=[(0, 0.0), (100, 0.0), (200, 0.02), (300, 0.02), (400, -0.01)],
    ),
    "the other way": Layout(
        [Straight(20), Transition(90, "cubic"), Curve(radius=900, cant=0.05, length=700)]
    ),
    "straight": Layout([Straight(1000)]),
}
SPEED, DURATION = 12.0, 60.0
MASS = 1813.0
# No axis of symmetry, and products of inertia.
INERTIA = np.array([[1120.0, 30.0, -50.0], [30.0, 400.0, 20.0], [-50.0, 20.0, 1300.0]])
PLACE, VELOCITY = np.array([2.0, -1.0, 1.5]), np.array([0.3, -0.2, 0.1])
TURN, SPIN = Rotation.from_rotvec([0.2, -0.1, 0.3]), np.array([0.4, 2.5, -0.3])


def axes_at(layout, s, heading):
    slope = np.arctan(float(layout.gradient_at(s)))
    roll = float(layout.roll(s))
    return Rotation.from_euler("ZYX", [heading, -slope, roll]).as_matrix()


def frame_in_space(layout, station):
    """Axes and origin [m] of the frame at a station, by Gauss' rule over half metres."""
    nodes, weights = np.polynomial.legendre.leggauss(6)
    breaks = np.unique(np.append(layout.table[0], np.arange(0.0, station, 0.5)))
    breaks = np.append(breaks[(breaks >= 0.0) & (breaks < station)], station)
    heading, origin = 0.0, np.zeros(3)
    for a, b in pairwise(breaks):
        at = a + 0.5 * (b - a) * (1.0 + nodes)
        part = []
        for s in at:
            inner = a + 0.5 * (s - a) * (1.0 + nodes)
            part.append(heading + 0.5 * (s - a) * weights @ layout.curvature(inner))
        slope = np.arctan(layout.gradient_at(at))
        way = [np.cos(slope) * np.cos(part), np.cos(slope) * np.sin(part), np.sin(slope)]
        origin += 0.5 * (b - a) * np.array(way) @ weights
        heading += 0.5 * (b - a) * weights @ layout.curvature(at)
    return axes_at(layout, station, heading), origin


def turning(layout, station, step=1e-3):
    """Angular velocity by arc length [1/m] of the frame, in its axes, by differences."""
    middle = frame_in_space(layout, station)[0]
    ahead = axes_from(layout, station, step)
    behind = axes_from(layout, station, -step)
    spin = middle.T @ (ahead - behind) / (2.0 * step)
    return np.array([spin[2, 1], spin[0, 2], spin[1, 0]])


def axes_from(layout, station, step):
    return frame_in_space(layout, station + step)[0]


def seen(layout, gravity):
    """Motion in space of a body that is thrown at station 0 and followed along a layout."""
    frame = TrackFrame(layout)
    frame.set_speed(SPEED)
    frame.set_live(True)
    row = np.zeros(loads.BODY)
    row[loads.MASS] = MASS
    row[loads.INERTIA : loads.CENTRE] = [*np.diag(INERTIA), *INERTIA[[0, 0, 1], [1, 2, 2]]]
    inverse = np.linalg.inv(INERTIA)
    motion, force = np.zeros(loads.MOTION), np.zeros(6)

    def rate(t, state):
        rotation = state[6:15].reshape(3, 3)
        omega = state[15:18]
        q = np.concatenate([state[:3], Rotation.from_matrix(rotation).as_rotvec()])
        v = np.concatenate([state[3:6], omega])
        force[:] = 0.0
        loads.frame_motion(frame.array, t, gravity, motion)
        loads.add_body_loads(motion, row, q, v, 0, force)
        acceleration = force[:3] / MASS - [0.0, 0.0, gravity]
        cross = np.cross(np.eye(3), omega)
        turned = inverse @ (force[3:] - np.cross(omega, INERTIA @ omega))
        return np.concatenate([state[3:6], acceleration, (rotation @ cross).ravel(), turned])

    axes, _ = frame_in_space(layout, 0.0)
    omega = np.array(track_kernel.frame_turning(frame.array, 0.0)[:3]) * SPEED
    place, turn = axes.T @ PLACE, axes.T @ TURN.as_matrix()
    velocity = axes.T @ VELOCITY - SPEED * np.array([1.0, 0.0, 0.0]) - np.cross(omega, place)
    state = np.concatenate([place, velocity, turn.ravel(), SPIN - turn.T @ omega])
    kinks = layout.table[0] / SPEED
    stops = np.append(0.0, kinks[(kinks > 0.0) & (kinks < DURATION)])
    for a, b in zip(stops, np.append(stops[1:], DURATION), strict=True):
        # Strictly inside a piece, whose ends belong to one of two pieces only.
        found = solve_ivp(rate, (a, b), state, method="DOP853", rtol=1e-12, atol=1e-13)
        state = found.y[:, -1]
    axes, origin = frame_in_space(layout, SPEED * DURATION)
    omega = np.array(track_kernel.frame_turning(frame.array, SPEED * DURATION)[:3]) * SPEED
    rotation = state[6:15].reshape(3, 3)
    position = origin + axes @ state[:3]
    speed = axes @ (state[3:6] + np.cross(omega, state[:3]) + SPEED * np.array([1.0, 0.0, 0.0]))
    spin = state[15:18] + rotation.T @ omega
    return position, speed, axes @ rotation @ INERTIA @ spin, axes @ rotation


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_a_free_body_moves_as_in_space(name, gravity):
    position, velocity, momentum, _ = seen(LAYOUTS[name], gravity)
    fall = np.array([0.0, 0.0, -gravity])
    thrown = PLACE + VELOCITY * DURATION + 0.5 * fall * DURATION**2
    # Ways of 700 m; 1e-9 of them.
    assert position == pytest.approx(thrown, abs=1e-9 * SPEED * DURATION * (1 + gravity * 25))
    assert velocity == pytest.approx(VELOCITY + fall * DURATION, abs=1e-9 * (SPEED + 60 * gravity))
    expected = TURN.as_matrix() @ INERTIA @ SPIN
    assert momentum == pytest.approx(expected, abs=1e-9 * np.linalg.norm(expected))


def test_two_layouts_give_the_same_motion_in_space():
    first, second = (seen(LAYOUTS[name], 0.0) for name in ("curves and gradient", "the other way"))
    assert first[0] == pytest.approx(second[0], abs=1e-6)
    # Which way a tumbling body points after 25 turns.
    assert first[3] == pytest.approx(second[3], abs=1e-8)


@pytest.mark.parametrize("station", [30.0, 75.0, 180.0, 300.0, 410.0, 480.0])
def test_kernel_turns_as_the_frame_in_space_does(station):
    layout = LAYOUTS["curves and gradient"]
    frame = TrackFrame(layout)
    frame.set_live(True)
    found = np.array(track_kernel.frame_turning(frame.array, station)[:3])
    assert found == pytest.approx(turning(layout, station), abs=1e-8)


@pytest.mark.parametrize(
    ("a", "b"), [(50.0, 70.0), (70.0, 50.0), (255.0, 270.0), (390.0, 375.0), (-20.0, 15.0)]
)
def test_pose_between_two_stations_is_that_in_space(a, b):
    layout = LAYOUTS["curves and gradient"]
    frame = TrackFrame(layout)
    frame.set_live(True)
    pose = np.zeros(12)
    track_kernel.relative_pose(frame.array, a, b, pose)
    if a < 0.0:
        assert pose[9:] == pytest.approx([b - a, 0.0, 0.0], abs=1e-12)
        return
    (axes, origin), (other, there) = frame_in_space(layout, a), frame_in_space(layout, b)
    assert pose[:9].reshape(3, 3) == pytest.approx(axes.T @ other, abs=1e-11)
    assert pose[9:] == pytest.approx(axes.T @ (there - origin), abs=1e-10)


def test_a_thousand_kilometres_ahead_the_same_curve_is_the_same():
    """Nothing is summed up from the track's beginning."""
    near, far = (
        Layout([Straight(way), Transition(50, "bloss"), Curve(-300, 100, cant=0.1)])
        for way in (50.0, 1.0e6)
    )
    poses = []
    for layout, before in ((near, 50.0), (far, 1.0e6)):
        frame = TrackFrame(layout)
        frame.set_live(True)
        poses.append(np.zeros(12))
        track_kernel.relative_pose(frame.array, before + 45.0, before + 60.0, poses[-1])
    # Stations near 1e6 m are told apart by 1e-10 m.
    assert poses[0] == pytest.approx(poses[1], abs=1e-9)


def test_exudyn_is_given_these_loads():
    """A body thrown in an Exudyn model, looked at from a frame in a curve on a gradient."""
    layout = Layout([Curve(radius=-300, cant=0.12, length=100)], gradient=[(0.0, 0.01)])
    frame = TrackFrame(layout)
    frame.set_speed(SPEED)
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    body = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=MASS, inertiaTensor=INERTIA),
        nodeType=exu.NodeType.RotationRotationVector,
        referencePosition=[3.0, -1.0, 1.0],
        initialVelocity=[0.3, -0.2, 0.1],
        initialAngularVelocity=[0.2, 1.5, -0.3],
        gravity=[0.0, 0.0, -9.81],
        returnDict=True,
    )
    add_frame_loads(mbs, frame, [(body["nodeNumber"], MASS, INERTIA)])
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = 2.0
    settings.timeIntegration.numberOfSteps = 4000
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    data = mbs.systemData
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44, showHints=False)
    place = np.array([3.0, -1.0, 1.0]) + np.array(data.GetODE2Coordinates())[:3]
    axes, _ = frame_in_space(layout, 0.0)
    omega = SPEED * np.array(track_kernel.frame_turning(frame.array, 0.0)[:3])
    start = axes @ np.array([3.0, -1.0, 1.0])
    thrown = axes @ (
        np.array([0.3 + SPEED, -0.2, 0.1]) + np.cross(omega, np.array([3.0, -1.0, 1.0]))
    )
    later, origin = frame_in_space(layout, 2.0 * SPEED)
    expected = start + 2.0 * thrown + [0.0, 0.0, -0.5 * 9.81 * 4.0]
    # RK44 at 0.5 ms.
    assert origin + later @ place == pytest.approx(expected, abs=1e-8)
