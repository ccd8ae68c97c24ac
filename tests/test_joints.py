"""Exudyn models with joints, in independent coordinates, against closed forms and against the same
models in minimal coordinates."""

from __future__ import annotations

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import (
    InertiaCuboid,
    MarkerBodyPosition,
    MarkerNodeCoordinate,
    Node1D,
    NodeGenericData,
    NodePointGround,
    ObjectConnectorCoordinateSpringDamperExt,
    ObjectMass1D,
    RigidBodyInertia,
)
from exudyn.utilities import ObjectConnectorCartesianSpringDamper as SpringDamper
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from exudyn_wheelset import (
    AnalysisError,
    ExudynSystem,
    Track,
    Wheelset,
    create_wheelset,
    limit_cycles,
    linear_critical_speed,
    linearise,
    root_locus,
    simulate,
)
from exudyn_wheelset.results.endings import Ending

exu.config.suppressWarnings = True
ROTATION = exu.NodeType.RotationRotationVector
GRAVITY = 9.81
FRAME_MASS, FRAME_HEIGHT = 2500.0, 0.8


def nothing(mbs, speed):
    """A model that does not know the speed."""


def body(mbs, inertia, place, node_type=ROTATION, **options):
    return mbs.CreateRigidBody(
        inertia=inertia,
        referencePosition=list(place),
        nodeType=node_type,
        returnDict=True,
        **options,
    )


def model():
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    return container, mbs, mbs.CreateGround()


def pendulum(node_type=ROTATION, **options) -> ExudynSystem:
    """A bar of 1 m on a hinge about x at its upper end."""
    container, mbs, ground = model()
    inertia = InertiaCuboid(1000.0, [0.1, 0.1, 1.0])
    bar = body(mbs, inertia, (0, 0, -0.5), node_type, gravity=[0, 0, -GRAVITY])
    mbs.CreateRevoluteJoint(
        itemNumbers=[ground, bar["bodyNumber"]], position=[0, 0, 0], axis=[1, 0, 0]
    )
    return ExudynSystem(mbs, container, set_speed=nothing, **options)


def beam(parts: int) -> ExudynSystem:
    """A body of 400 kg on two springs, in one piece or of two rigidly joined halves."""
    container, mbs, ground = model()
    half = np.array([1.0, 5.0, 5.0])
    if parts == 1:
        # Parallel axes: both halves 0.5 m off.
        inertia = 2.0 * (half + 200.0 * 0.5**2 * np.array([0.0, 1.0, 1.0]))
        places, numbers = (
            [0.0],
            [body(mbs, RigidBodyInertia(400.0, np.diag(inertia)), (0, 0, 0))["bodyNumber"]],
        )
    else:
        places = [0.5, -0.5]
        numbers = [
            body(mbs, RigidBodyInertia(200.0, np.diag(half)), (x, 0, 0))["bodyNumber"]
            for x in places
        ]
        mbs.CreateGenericJoint(
            itemNumbers=numbers, position=[0, 0, 0.3], constrainedAxes=[1, 1, 1, 1, 1, 1]
        )
    for k, at in ((0, [0.7, 0.1, 0.0]), (-1, [-0.9, -0.1, 0.2])):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, numbers[k]], localPosition0=at,
            localPosition1=[at[0] - places[k], *at[1:]],
            stiffness=[1e5, 2e5, 3e5], damping=[10, 20, 30],
        )  # fmt: skip
    return ExudynSystem(mbs, container, set_speed=nothing)


def test_two_halves_rigidly_joined_are_one_body():
    one, two = (np.sort_complex(linearise(beam(parts), 1.0).eigenvalues) for parts in (1, 2))
    assert two == pytest.approx(one, abs=1e-5)


# Moments of inertia of the bar about its hinge over its mass, and over its weight's lever.
HINGE = (1.0 + 0.01) / 12.0 + 0.25
SMALL = np.sqrt(GRAVITY * 0.5 / HINGE)


@pytest.mark.parametrize("node_type", [ROTATION, exu.NodeType.RotationRxyz])
def test_a_hinged_bar_swings_with_its_frequency(node_type):
    system = pendulum(node_type)
    assert system.size == 2
    found = linearise(system, 1.0).eigenvalues
    assert sorted(found.imag) == pytest.approx([-SMALL, SMALL], rel=1e-7)
    assert np.abs(found.real).max() < 1e-6


def test_a_hinged_bar_swings_far_with_its_period():
    """Period at an amplitude of 1 rad: 4 K(sin^2(1/2))/omega, with the joint's accelerations."""
    system = pendulum()
    layout, pose = system.layout, 1.0
    coordinates = np.array([0.0, 0.5 * np.sin(pose), 0.5 * (1 - np.cos(pose)), pose, 0.0, 0.0])
    start = layout.reduce(coordinates[None], np.zeros((1, 6)), np.zeros((1, 0)))[0]
    assert np.abs(layout.expand(start)[0] - coordinates).max() < 1e-10

    def passes(t, x):
        return x[0]

    passes.direction = -1.0
    solved = solve_ivp(
        lambda t, x: system.derivative(x, 1.0),
        (0.0, 2.2),
        start,
        rtol=1e-9,
        atol=1e-11,
        events=passes,
    )
    quarter = solved.t_events[0][0]
    assert 4.0 * quarter == pytest.approx(4.0 * ellipk(np.sin(0.5) ** 2) / SMALL, rel=1e-6)


def test_exudyn_follows_with_generalised_alpha():
    system = pendulum(step=2e-3)
    moved = {system.state_names[0]: 0.02}
    motion = simulate(system, 1.0, 2.0, start=moved)
    expected = 0.02 * np.cos(SMALL * motion.time)
    assert motion.outcome.ending is Ending.FINISHED
    # The amplitude's own correction of the period is 6e-5 at 0.04 rad.
    assert motion[system.state_names[0]] == pytest.approx(expected, abs=3e-4)
    with pytest.raises(AnalysisError, match=r"joints.*RK44 does not solve"):
        pendulum(solver_type="RK44")


def test_a_ball_joint_leaves_three_rotations():
    """A bar hung on a ball: it swings both ways as on a hinge, and turns about itself freely."""
    container, mbs, ground = model()
    inertia = InertiaCuboid(1000.0, [0.1, 0.1, 1.0])
    bar = body(mbs, inertia, (0, 0, -0.5), gravity=[0, 0, -GRAVITY])
    mbs.CreateSphericalJoint(itemNumbers=[ground, bar["bodyNumber"]], position=[0, 0, 0])
    system = ExudynSystem(mbs, container, set_speed=nothing)
    assert system.size == 6
    found = np.sort(np.abs(linearise(system, 1.0).eigenvalues.imag))
    assert found == pytest.approx([0.0, 0.0, *4 * [SMALL]], abs=1e-3)
    assert found[2:] == pytest.approx(4 * [SMALL], rel=1e-6)


def test_joints_that_repeat_others_are_one():
    """Two hinges on one axis, as every door has them."""
    container, mbs, ground = model()
    inertia = InertiaCuboid(1000.0, [0.1, 0.1, 1.0])
    bar = body(mbs, inertia, (0, 0, -0.5), gravity=[0, 0, -GRAVITY])
    for x in (-0.05, 0.05):
        mbs.CreateRevoluteJoint(
            itemNumbers=[ground, bar["bodyNumber"]], position=[x, 0, 0], axis=[1, 0, 0]
        )
    found = linearise(ExudynSystem(mbs, container, set_speed=nothing), 1.0).eigenvalues
    assert sorted(found.imag) == pytest.approx([-SMALL, SMALL], rel=1e-6)


def test_joints_that_leave_nothing_or_do_not_close_are_refused():
    container, mbs, ground = model()
    bar = body(mbs, InertiaCuboid(1000.0, [0.1, 0.1, 1.0]), (0, 0, 0))
    mbs.CreateGenericJoint(
        itemNumbers=[ground, bar["bodyNumber"]], position=[0, 0, 0], constrainedAxes=[1] * 6
    )
    with pytest.raises(AnalysisError, match="leave the model nothing to move"):
        ExudynSystem(mbs, container, set_speed=nothing)
    system = link()
    beyond = system.initial_state(1.0)
    beyond[0] = 0.9
    with pytest.raises(AnalysisError, match="cannot be closed"):
        system.derivative(beyond, 1.0)
    container, mbs, ground = model()
    inertia = InertiaCuboid(1000.0, [0.1, 0.1, 1.0])
    bar = body(mbs, inertia, (0, 0, 0), initialDisplacement=[0.0, 0.3, 0.0])
    mbs.CreateSphericalJoint(itemNumbers=[ground, bar["bodyNumber"]], position=[0, 0, 0.5])
    with pytest.raises(AnalysisError, match=r"open by 0\.3"):
        ExudynSystem(mbs, container, set_speed=nothing)


def test_coordinates_that_no_analysis_treats_are_refused_with_a_mend():
    with pytest.raises(AnalysisError, match=r"Euler parameters.*RotationRotationVector"):
        pendulum(exu.NodeType.RotationEulerParameters)
    container, mbs, _ = model()
    node = mbs.AddNode(Node1D(referenceCoordinates=[0.0]))
    mbs.AddObject(ObjectMass1D(physicsMass=1.0, nodeNumber=node))
    memory = mbs.AddNode(
        NodeGenericData(numberOfDataCoordinates=3, initialCoordinates=[1.0, 0.0, 0.0])
    )
    markers = [
        mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=n, coordinate=0))
        for n in (mbs.AddNode(NodePointGround()), node)
    ]
    mbs.AddObject(
        ObjectConnectorCoordinateSpringDamperExt(
            markerNumbers=markers, nodeNumber=memory, stiffness=100.0, fDynamicFriction=5.0,
            stickingStiffness=1e4,
        )
    )  # fmt: skip
    with pytest.raises(AnalysisError, match=r"data coordinates.*first-order coordinates"):
        ExudynSystem(mbs, container, set_speed=nothing)


def link() -> ExudynSystem:
    """A mass on a pendulum link of 0.7 m."""
    container, mbs, ground = model()
    ball = mbs.CreateMassPoint(
        physicsMass=50.0, referencePosition=[0, 0, -0.7], gravity=[0, 0, -GRAVITY], returnDict=True
    )
    mbs.CreateDistanceConstraint(itemNumbers=[ground, ball["bodyNumber"]], distance=0.7)
    return ExudynSystem(mbs, container, set_speed=nothing)


def test_a_mass_on_a_link_swings_both_ways():
    """Along and across the track with sqrt(g/l)."""
    found = linearise(link(), 1.0).eigenvalues
    assert len(found) == 4
    assert np.abs(found.imag) == pytest.approx(np.full(4, np.sqrt(GRAVITY / 0.7)), rel=1e-7)


def rotor(jointed: bool) -> ExudynSystem:
    """A spinning rotor on springs; its housing on a bearing, or in the rotor's own mass."""
    container, mbs, ground = model()
    own = RigidBodyInertia(mass=60.0, inertiaTensor=np.diag([3.0, 4.0, 3.0]))
    whole = RigidBodyInertia(mass=100.0, inertiaTensor=np.diag([5.0, 4.0, 5.5 - 0.5]))
    spun = body(mbs, own if jointed else whole, (0, 0, 0))
    held = spun["bodyNumber"]
    if jointed:
        housing = RigidBodyInertia(mass=40.0, inertiaTensor=np.diag([2.0, 1.0, 2.0]))
        held = body(mbs, housing, (0, 0, 0))["bodyNumber"]
        mbs.CreateRevoluteJoint(
            itemNumbers=[held, spun["bodyNumber"]], position=[0, 0, 0], axis=[0, 1, 0]
        )
    for y, k in ((0.5, 2e5), (-0.4, 3e5)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, held], localPosition0=[0, y, 0], localPosition1=[0, y, 0],
            stiffness=[k, 4e5, 1.3 * k], damping=[20, 30, 40],
        )  # fmt: skip
    return ExudynSystem(mbs, container, set_speed=nothing, spinning_nodes={spun["nodeNumber"]: 0.4})


def test_a_rotor_in_a_bearing_is_a_rotor_with_the_mass_of_its_housing():
    """The gyroscopic modes are those of one body; the housing's pitch is free."""
    one, two = (linearise(rotor(jointed), 60.0).eigenvalues for jointed in (False, True))
    assert len(two) == len(one) + 2
    for root in one:
        assert np.abs(two - root).min() < 1e-5 * max(1.0, abs(root))


def bogie(jointed: bool, **options) -> ExudynSystem:
    """A wheelset below a frame that moves across the track alone: prismatic joint, or 1 coordinate.

    The springs between both have no length, so that the frame carries no moment.
    """
    container, mbs, ground = model()
    wheelset = Wheelset(1200.0, (700.0, 90.0, 700.0), 0.46, "S1002")
    items = create_wheelset(
        mbs, wheelset, Track("UIC60"), speed=20.0, moving_frame=True, name="wheelset", damping=5.0,
        creep="shen-hedrick-elkins",
    )  # fmt: skip
    mbs.CreateForce(itemNumber=items.body, loadVector=[0, 0, -90e3])
    height = float(mbs.GetNode(items.node)["referenceCoordinates"][2])
    if jointed:
        inertia = RigidBodyInertia(mass=FRAME_MASS, inertiaTensor=np.diag([1e3, 2e3, 3e3]))
        frame = body(mbs, inertia, (0, 0, FRAME_HEIGHT), name="frame")["bodyNumber"]
        mbs.CreatePrismaticJoint(
            itemNumbers=[ground, frame], position=[0, 0, FRAME_HEIGHT], axis=[0, 1, 0]
        )
    else:
        node = mbs.AddNode(Node1D(referenceCoordinates=[0.0], name="frame"))
        turn = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
        frame = mbs.AddObject(
            ObjectMass1D(
                physicsMass=FRAME_MASS, nodeNumber=node, referencePosition=[0, 0, FRAME_HEIGHT],
                referenceRotation=turn,
            )
        )  # fmt: skip

    def spring(first, second, stiffness, damping):
        markers = [
            mbs.AddMarker(MarkerBodyPosition(bodyNumber=number, localPosition=place))
            for number, place in (first, second)
        ]
        mbs.AddObject(SpringDamper(markerNumbers=markers, stiffness=stiffness, damping=damping))

    for y in (1.0, -1.0):
        # In the axes of the coordinate's body x lies along -y, y along x.
        place = [0, y, height - FRAME_HEIGHT] if jointed else [y, 0, height - FRAME_HEIGHT]
        spring((frame, place), (items.body, [0, y, 0]), [3e6, 1.5e6, 0], [3e3, 5e3, 0])
    spring((ground, [0, 0, FRAME_HEIGHT]), (frame, [0, 0, 0]), [0, 4e5, 0], [0, 2e4, 0])
    return ExudynSystem(mbs, container, name="bogie", **options)


@pytest.fixture(scope="module")
def bogies():
    return bogie(True, step=5e-4), bogie(False)


def test_a_frame_on_a_prismatic_joint_is_a_coordinate(bogies):
    jointed, minimal = bogies
    assert jointed.size == minimal.size
    assert "frame: y [m]" in jointed.state_names
    for speed in (15.0, 60.0):
        found = [np.sort_complex(linearise(one, speed).eigenvalues) for one in bogies]
        assert found[0] == pytest.approx(found[1], rel=1e-5, abs=1e-4)


def test_its_critical_speed_and_its_roots_over_speed(bogies):
    speeds = [linear_critical_speed(one, 10.0, 150.0).speed for one in bogies]
    assert speeds[0] == pytest.approx(speeds[1], rel=1e-7)
    loci = [root_locus(one, np.array([20.0, 40.0])) for one in bogies]
    assert loci[0].eigenvalues.shape == loci[1].eigenvalues.shape


@pytest.mark.slow
def test_its_limit_cycles(bogies):
    """The continuation goes the same way from orbit to orbit."""
    branches = []
    for one in bogies:
        hopf = linear_critical_speed(one, 10.0, 150.0)
        branches.append(limit_cycles(one, hopf, (0.997 * hopf.speed, 1.0002 * hopf.speed)))
    jointed, minimal = branches
    assert len(jointed) == len(minimal) > 3
    assert jointed.speed == pytest.approx(minimal.speed, rel=1e-6)
    assert jointed.period == pytest.approx(minimal.period, rel=1e-6)


def test_its_motion(bogies):
    motions = [simulate(one, 30.0, 0.5, start=2e-3) for one in bogies]
    for motion in motions:
        assert motion.outcome.ending is Ending.FINISHED
    a, b = (motion["wheelset: y"] for motion in motions)
    # Generalised alpha against RK44, both at 0.5 ms.
    assert a == pytest.approx(b, abs=3e-5)
    # What the joint holds is recorded too.
    assert np.abs(motions[0]["frame: z"]).max() < 1e-9
