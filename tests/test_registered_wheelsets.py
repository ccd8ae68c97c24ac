"""What ExudynSystem finds by itself in a model against the same things said by hand."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import (
    MarkerBodyRigid,
    NodeGenericData,
    ObjectConnectorCartesianSpringDamper,
    RigidBodyInertia,
)

from exudyn_wheelset import (
    AnalysisError,
    ExudynSystem,
    RailElasticity,
    Track,
    Wheelset,
    contact_geometry,
    create_wheelset,
    linearise,
    wheelsets_of,
)
from exudyn_wheelset.catalogue.paper_wheelset import paper_wheelset
from exudyn_wheelset.stability.hunting.watching import watched_index

WHEELSET = Wheelset(mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=0.46, wheel="S1002")
TRACK = Track(rail="UIC60")


def add_body(mbs, name, height):
    body = mbs.CreateRigidBody(
        name=name,
        inertia=RigidBodyInertia(mass=3000.0, inertiaTensor=np.diag([1500.0, 2500.0, 2500.0])),
        nodeType=exu.NodeType.RotationRotationVector,
        referencePosition=[0.0, 0.0, height],
        gravity=[0.0, 0.0, -9.81],
        returnDict=True,
    )
    return body["bodyNumber"]


def spring(mbs, below, at_below, above, at_above, load):
    markers = [
        mbs.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=place))
        for body, place in ((below, at_below), (above, at_above))
    ]
    mbs.AddObject(
        ObjectConnectorCartesianSpringDamper(
            markerNumbers=markers,
            stiffness=[5e6, 2e6, 1e6],
            damping=[1e3, 1e3, 2e4],
            offset=[0.0, 0.0, load / 1e6],
        )
    )


def build(axles=(1.2, -1.2), moving_frame=True, **options):
    """A frame, added before its wheelsets, on springs between it and their axle boxes."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    frame = add_body(mbs, "frame", 0.6)
    for x in axles:
        items = create_wheelset(
            mbs, WHEELSET, TRACK, position=(x, 0.0), moving_frame=moving_frame, show=False,
            **{"friction": 0.4, "damping": 0.0, **options},
        )  # fmt: skip
        rise = items.reference[2] - 0.6
        for side in (1.0, -1.0):
            load = 3000.0 * 9.81 / (2 * len(axles))
            spring(mbs, items.body, [0, side, 0], frame, [x, side, rise], load)
    return container, mbs


def by_hand(axles=(1.2, -1.2)):
    container, mbs = build(axles)
    contacts = [items.contact for items in wheelsets_of(mbs)]

    def set_speed(_, speed):
        for contact in contacts:
            contact.set_speed(speed)

    radius = contact_geometry(WHEELSET, TRACK, [0.0]).left.radius[0]
    nodes = {items.node: radius for items in wheelsets_of(mbs)}
    return ExudynSystem(mbs, container, set_speed=set_speed, spinning_nodes=nodes)


def test_a_found_model_is_the_model_said_by_hand():
    container, mbs = build()
    found, told = ExudynSystem(mbs, container), by_hand()
    assert found.state_names == told.state_names
    for speed in (20.0, 55.0):
        state = told.equilibrium(speed)
        # Newton's tolerance, in the scales.
        apart = (found.equilibrium(speed) - state) / told.scales
        assert np.abs(apart).max() < 1e-6
        state = state + found.scales * np.linspace(-1.0, 1.0, found.size)
        assert np.array_equal(found.derivative(state, speed), told.derivative(state, speed))


def test_the_speed_reaches_the_rails():
    """Creep damping falls as 1/V: the roots of a wheelset are not those of another speed."""
    container, mbs = build()
    system = ExudynSystem(mbs, container)
    slow, fast = (linearise(system, speed).eigenvalues for speed in (20.0, 60.0))
    assert abs(np.sort(slow.real)[0]) > 2.0 * abs(np.sort(fast.real)[0])
    assert [contact.rail_speed for contact in system.contacts] == [60.0, 60.0]


def test_the_first_wheelset_is_watched_though_the_frame_came_first():
    container, mbs = build()
    system = ExudynSystem(mbs, container)
    assert system.state_names[0] == "frame: x [m]"
    assert system.state_names[watched_index(system)] == "wheelset: y [m]"
    assert [system.state_names[k] for k in system.lateral_indices] == [
        "wheelset: y [m]",
        "wheelset 2: y [m]",
    ]
    assert [system.state_names[k] for k in system.yaw_indices] == [
        "wheelset: yaw [rad]",
        "wheelset 2: yaw [rad]",
    ]
    assert len(set(system.state_names)) == system.size


def test_several_systems_and_a_reset_do_not_mix():
    (_, first), (_, second) = build(axles=(2.0, 0.0, -2.0)), build(axles=(0.0,))
    assert [items.reference[0] for items in wheelsets_of(first)] == [2.0, 0.0, -2.0]
    assert [items.name for items in wheelsets_of(second)] == ["wheelset"]
    shared = {items.contact for items in wheelsets_of(first)} & {
        items.contact for items in wheelsets_of(second)
    }
    assert not shared
    first.Reset()
    assert wheelsets_of(first) == ()
    items = create_wheelset(first, WHEELSET, TRACK, moving_frame=True, show=False)
    assert wheelsets_of(first) == (items,)
    container = exu.SystemContainer()
    two = [container.AddSystem() for _ in range(2)]
    for mbs in two:
        create_wheelset(mbs, WHEELSET, TRACK, show=False)
    assert [len(wheelsets_of(mbs)) for mbs in two] == [1, 1]


def test_wheelsets_over_the_ground_are_refused():
    container, mbs = build(moving_frame=False)
    with pytest.raises(
        AnalysisError, match=r"wheelset, wheelset 2 run over the ground.*moving_frame=True"
    ):
        ExudynSystem(mbs, container)


def test_a_model_without_anything_that_depends_on_speed_is_refused():
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    add_body(mbs, "mass", 1.0)
    with pytest.raises(AnalysisError, match=r"no wheelset.*set_speed\(mbs, speed\)"):
        ExudynSystem(mbs, container)


def test_data_coordinates_are_refused_by_name():
    container, mbs = build(axles=(0.0,))
    mbs.AddNode(
        NodeGenericData(name="dry friction", initialCoordinates=[0.0], numberOfDataCoordinates=1)
    )
    with pytest.raises(AnalysisError, match=r"data coordinates.*dry friction.*leave them out"):
        ExudynSystem(mbs, container)


def test_first_order_states_have_names_units_and_scales():
    container, mbs = build(rail_elasticity=RailElasticity())
    system = ExudynSystem(mbs, container)
    rails = list(system.state_names[-8:])
    sides = ("left y [m]", "left z [m]", "right y [m]", "right z [m]")
    assert rails == [f"wheelset{n} rails: {side}" for n in ("", " 2") for side in sides]
    assert np.all(system.scales[-8:] == 1e-4)


@pytest.mark.parametrize("given", [{}, {"settings": None}, {"settings": None, "step": None}])
def test_a_driven_wheelset_steps_as_its_drive_needs(given):
    """RK44 is stable to 2.8 over the drive's rate, 1e6 N m s/rad over some 110 kg m^2."""
    model = paper_wheelset(1, driven=True)
    rate = 1e6 / model.wheelset.inertia[1]
    assert model.dynamic_system(**given).step < 2.7 / rate


def test_a_spring_beside_the_axle_is_refused_by_name():
    """0.2 mm off the axle a spring of 5e6 N/m goes round with the wheels."""
    container, mbs = build(axles=(1.2,))
    (items,) = wheelsets_of(mbs)
    ground = mbs.CreateGround()
    spring(mbs, items.body, [0, 1.0, 2e-4], ground, [1.2, 1.0, items.reference[2]], 0.0)
    with pytest.raises(AnalysisError, match=r"'wheelset', which spins.*on the axle itself"):
        ExudynSystem(mbs, container)
