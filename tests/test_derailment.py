"""Derailment: limits from the drawings of wheel and rail, Nadal's limit, one ending everywhere.

M. J. Nadal, Locomotives a vapeur, 1908: a flange of angle d under full slip climbs where the ratio
of lateral to vertical force on its wheel exceeds (tan d - mu)/(1 + mu tan d).
"""

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import LoadForceVector, LoadTorqueVector

from exudyn_wheelset import ExudynSystem, Track, Wheelset, create_wheelset, wheelsets_of
from exudyn_wheelset.catalogue.paper_wheelset import paper_lateral_wheelset
from exudyn_wheelset.coupling.derailment import DerailmentWatch
from exudyn_wheelset.coupling.guidance import guidance
from exudyn_wheelset.coupling.running import run_solver
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.systems.system import SimulationError

WHEELSET = Wheelset(mass=1500.0, inertia=(900.0, 100.0, 900.0), radius=0.46, wheel="S1002")
TRACK = Track("UIC60")
LOAD = 100e3
SPEED = 10.0
# A system dies with its container.
CONTAINERS = []


def build(lateral=0.0, roll_moment=0.0, wheelset=WHEELSET, yaw=0.0, push_rate=0.0, **options):
    """A loaded wheelset pushed to the left, its yaw held by strong springs to the moving frame."""
    container = exu.SystemContainer()
    CONTAINERS.append(container)
    mbs = container.AddSystem()
    items = create_wheelset(
        mbs, wheelset, TRACK, speed=SPEED, moving_frame=True, show=False, sensors=False, yaw=yaw,
        **{"damping": 1.0, "friction": 0.3, **options},
    )  # fmt: skip
    ground = mbs.CreateGround()
    for side in (1.0, -1.0):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, items.body],
            localPosition0=[-side * np.sin(yaw), side * np.cos(yaw), items.reference[2]],
            localPosition1=[0.0, side, 0.0],
            stiffness=[2e7, 0.0, 0.0],
            damping=[2e4, 2e4, 0.0],
        )
    mbs.AddLoad(LoadForceVector(markerNumber=items.marker, loadVector=[0.0, lateral, -LOAD]))
    mbs.AddLoad(LoadTorqueVector(markerNumber=items.marker, loadVector=[roll_moment, 0.0, 0.0]))
    if push_rate:
        # At the height of the rails' tops: the push itself does not turn the wheelset over.
        mbs.AddLoad(
            LoadForceVector(
                markerNumber=items.marker,
                loadVectorUserFunction=lambda mbs, t, load: [0.0, push_rate * t, 0.0],
            )
        )
        mbs.AddLoad(
            LoadTorqueVector(
                markerNumber=items.marker,
                loadVectorUserFunction=lambda mbs, t, load: [push_rate * t * 0.46, 0.0, 0.0],
            )
        )
    return container, mbs


def run(mbs, duration=2.0, step=2e-4):
    """Outcome of a simulation and where the wheelset stood at its end."""
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(duration / step)
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.verboseMode = 0
    (items,) = wheelsets_of(mbs)
    outcome = run_solver(mbs, settings, exu.DynamicSolverType.RK44, [items.contact])
    return outcome, items.contact.stance(), mbs.systemData.GetTime()


def test_limits_are_those_of_the_drawings():
    """S1002: flange 28 mm below the tape circle, its tip 55 mm inside; gauge face at 717.5 mm."""
    limits = guidance(WHEELSET, TRACK)
    assert limits.rise == pytest.approx((0.014, 0.014), abs=1e-5)
    assert limits.drop == pytest.approx((0.014, 0.014), abs=1e-5)
    assert limits.shift == pytest.approx((0.7175 - 0.695,) * 2, abs=1e-4)
    wide = guidance(WHEELSET, Track("UIC60", gauge=1.455))
    assert wide.shift == pytest.approx(np.array(limits.shift) + 0.010, abs=1e-9)
    mixed = Wheelset(1e3, (500, 100, 500), 0.46, "S1002", right_wheel="cone_1_20")
    cone = guidance(mixed, TRACK)
    assert cone.rise[0] == limits.rise[0]
    assert np.isinf(cone.rise[1])


@pytest.mark.parametrize("friction", [0.2, 0.4])
def test_a_flange_climbs_above_nadals_limit(friction):
    """A push that grows by 30 kN/s, at the height of the rails, so that the loads stay half each.

    The flank of S1002 has 70 degrees. The right wheel, on its tread, slips sideways and adds mu
    times its load to the push: at the limit push = (Nadal - mu) load/2. Nadal's friction points
    straight up the flank; here slip is never quite full and some of it is along the rail, so his
    limit is a lower one, reached from above as the angle of attack grows: twice the angle leaves
    less than half of what is missing of full slip. With contact damping enough that the wheel does
    not hop on the flank, where it would climb by chance; four times as much changes nothing.
    """
    tangent = np.tan(np.radians(70.0))
    nadal = (tangent - friction) / (1.0 + friction * tangent)
    limit = (nadal - friction) * 0.5 * LOAD
    pushes = []
    for yaw in (0.03, 0.06):
        model = build(
            push_rate=30e3, yaw=yaw, friction=friction, creep="shen-hedrick-elkins", gravity=0.0,
            normal="energy", damping=5.0,
        )  # fmt: skip
        outcome, place, time = run(model[1], 4.0)
        assert outcome.ending is Ending.WHEEL_CLIMB
        assert place[2] > 0.014
        assert place[4] > 0
        pushes.append(30e3 * time)
    assert limit < pushes[1] < 1.15 * limit
    assert pushes[1] - limit < 0.5 * (pushes[0] - limit)


def test_a_wheelset_beside_its_track_is_off_at_once():
    """Put down with its flanges above the rails."""
    for shift, ending in ((0.018, Ending.LIFT_OFF), (0.030, Ending.LOST_GAUGE)):
        mbs = build(height=0.030, gravity=0.0)[1]
        (items,) = wheelsets_of(mbs)
        mbs.SetNodeParameter(items.node, "initialCoordinates", [0.0, shift, 0.0, 0.0, 0.0, 0.0])
        outcome, place, time = run(mbs, 0.01)
        assert outcome.ending is ending
        assert place[0] == pytest.approx(shift, abs=1e-4)
        assert time < 0.003


def test_a_cone_runs_off_where_its_tread_ends():
    cone = Wheelset(1500.0, (900.0, 100.0, 900.0), 0.46, "cone_1_20")
    limit = guidance(cone, TRACK).shift[0]
    outcome, place, _ = run(build(80e3, wheelset=cone)[1], 4.0)
    assert outcome.ending is Ending.LOST_GAUGE
    # At most one look, 2 ms, at a metre a second.
    assert limit < place[0] < limit + 0.01


def test_a_hovering_wheel_has_left_its_rail():
    """A moment turns the wheelset over its right wheel: m g b/2 and the load hold against it."""
    holding = (LOAD + 1500.0 * 9.81) * 0.75
    stays, hovers = (run(build(roll_moment=f * holding, gravity=9.81)[1], 2.0) for f in (0.8, 1.02))
    assert stays[0].ending is Ending.FINISHED
    outcome, place, time = hovers
    assert outcome.ending is Ending.LIFT_OFF
    assert place[4] == 0 and place[5] > 0
    assert time * SPEED < 8.0


def test_the_analyses_end_the_same_way_and_keep_what_was_before():
    container, mbs = build(150e3, yaw=0.03)
    direct, _, end = run(build(150e3, yaw=0.03)[1])
    system = ExudynSystem(mbs, container, step=2e-4)
    times = np.linspace(0.0, 2.0, 1001)
    with pytest.raises(SimulationError) as caught:
        system.simulate(system.initial_state(SPEED), SPEED, times)
    assert direct.ending.derailed
    assert caught.value.outcome.ending is direct.ending
    assert caught.value.times[-1] == pytest.approx(end, abs=6e-3)
    y = caught.value.states[:, system.lateral_indices[0]]
    assert np.all(np.isfinite(caught.value.states))
    assert np.abs(y).max() < guidance(WHEELSET, TRACK).shift[0] + 0.01


class Placed:
    """A contact that stands where it is told: stance and guidance are all that a watch asks for."""

    name = "wheelset"
    guidance = guidance(WHEELSET, TRACK)

    def __init__(self):
        self.place = np.array([0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 20.0])

    def stance(self):
        return self.place

    def station(self, time):
        return 20.0 * time


@pytest.mark.parametrize("hand", [0, 1])
def test_hops_are_forgiven_and_hovering_is_not(hand):
    """5 m in the air, a touch, 5 m in the air; then on and on. Looks every 2 ms at 20 m/s."""
    contact = Placed()
    watch = DerailmentWatch([contact])
    time = 0.0
    for way, touches in ((5.0, 0), (0.1, 1), (5.0, 0), (0.1, 1)):
        contact.place[4 + hand] = touches
        for _ in range(round(way / 0.04)):
            time += 0.002
            assert watch.look(time) is None
    contact.place[4 + hand] = 0
    begun = time
    while (outcome := watch.look(time)) is None:
        time += 0.002
    assert outcome.ending is Ending.LIFT_OFF
    assert 5.5 < 20.0 * (time - begun) < 6.5


@pytest.mark.parametrize(
    ("change", "ending"),
    [
        ({0: 0.022, 1: 0.022}, None),
        ({0: 0.023, 1: 0.023}, Ending.LOST_GAUGE),
        ({0: -0.022, 1: -0.022}, None),
        ({0: -0.023, 1: -0.023}, Ending.LOST_GAUGE),
        ({2: 0.0135}, None),
        ({2: 0.0145}, Ending.WHEEL_CLIMB),
        ({3: 0.0145}, Ending.WHEEL_CLIMB),
        ({2: 0.0145, 4: 0.0}, Ending.LIFT_OFF),
        ({2: -0.0135}, None),
        ({2: -0.0145}, Ending.LOST_GAUGE),
        ({3: -0.0145, 5: 0.0}, Ending.LOST_GAUGE),
        # Rails that move apart from each other are each looked at by themselves.
        ({0: 0.0, 1: -0.023}, Ending.LOST_GAUGE),
        ({0: np.nan}, None),
    ],
)
def test_each_limit_ends_the_motion_where_the_drawings_say(change, ending):
    contact = Placed()
    for index, value in change.items():
        contact.place[index] = value
    outcome = DerailmentWatch([Placed(), contact]).look(0.002)
    assert (outcome and outcome.ending) is ending


def test_the_lateral_model_ends_where_its_tread_does():
    """The paper's cone has no flange: above its critical speed it runs off its rails, not away.

    Knife edges stand under the tape circles, the tread ends 60 mm outside of them.
    """
    model = paper_lateral_wheelset("idealized", 1)
    state = np.array([5e-3, 0.0, 0.0, 0.0])
    with pytest.raises(SimulationError) as caught:
        model.simulate(state, 60.0, np.linspace(0.0, 5.0, 2001))
    assert caught.value.outcome.ending is Ending.LOST_GAUGE
    assert 0.04 < np.abs(caught.value.states[:, 0]).max() < 0.06
