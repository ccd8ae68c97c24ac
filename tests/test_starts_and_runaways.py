"""Where a motion begins and where one counts as lost, by symmetry, by hand and by exp(t)."""

import exudyn as exu
import numpy as np
import pytest

from exudyn_wheelset import (
    ExudynSystem,
    Suspension,
    Track,
    Wheelset,
    WheelsetOnFrame,
    create_wheelset,
)
from exudyn_wheelset.systems.starts import shifted_state, wheel_loads
from exudyn_wheelset.systems.system import DynamicSystem, SimulationError
from exudyn_wheelset.systems.vehicle_system import SHORTEST_STEP, vehicle_system

WHEELSET = Wheelset(mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=0.46, wheel="S1002")
SPEED, SHIFT = 20.0, 2e-3


def one_wheelset(beside: float) -> ExudynSystem:
    """A wheelset in the middle of its track, its reference `beside` it."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    create_wheelset(
        mbs, WHEELSET, Track(rail="UIC60"), position=(0.0, beside), lateral_offset=-beside,
        moving_frame=True, show=False,
    )  # fmt: skip
    system = ExudynSystem(mbs, container)
    # Free of suspension, and loaded as it stands.
    system.equilibrium = system.initial_state
    return system


@pytest.mark.parametrize("beside", [0.004, -0.003, 0.02])
def test_a_start_does_not_know_where_the_reference_of_a_wheelset_lies(beside):
    """The same place on the rails, counted from beside the track's middle."""
    plain, other = one_wheelset(0.0), one_wheelset(beside)
    steady, states = [], []
    for system in (plain, other):
        steady.append(system.initial_state(SPEED))
        states.append(shifted_state(system, SPEED, SHIFT))
        loads = [wheel_loads(system, system.wheelsets[0], x) for x in (steady[-1], states[-1])]
        assert loads[0].min() > 1e3
        assert loads[1] == pytest.approx(loads[0], rel=1e-5)
    lateral = plain.pose_indices[0][0]
    assert states[0][lateral] - steady[0][lateral] == pytest.approx(SHIFT, abs=1e-15)
    # Loads to 1e-6 of some 50 kN are heights to some 1e-10 m.
    assert states[1] - steady[1] == pytest.approx(states[0] - steady[0], abs=1e-9)


@pytest.mark.parametrize("held", [0, 1, 2])
def test_a_wheelset_that_a_joint_holds_is_not_moved(held, monkeypatch):
    """-1 stands for a place that is no state: it follows what is moved."""
    system = one_wheelset(0.0)
    pose = [-1 if k == held else place for k, place in enumerate(system.pose_indices[0])]
    monkeypatch.setattr(system, "pose_indices", (tuple(pose),))
    assert np.array_equal(shifted_state(system, SPEED, SHIFT), system.initial_state(SPEED))


@pytest.mark.parametrize("speed", [-1.25, -1.0, 1.0])
def test_a_motion_begins_at_any_speed_forwards_and_backwards(speed):
    """Creep damps a wheelset at f/(m |V|), so the step to follow it is that of the speed forwards
    (5 ms of it are the same to 1 %: normal forces turn no other way with the speed)."""
    suspension = Suspension(1.0, (1e6, 1e6, 1e6))
    vehicle = WheelsetOnFrame(WHEELSET, Track(rail="UIC60"), suspension, 1e5).vehicle()
    system = vehicle_system(vehicle)
    state = system.initial_state(speed)
    step = system._stable_at(state, speed)
    forwards = vehicle_system(vehicle)
    expected = forwards._stable_at(forwards.initial_state(abs(speed)), abs(speed))
    assert step == pytest.approx(expected, rel=0.01) and step > SHORTEST_STEP
    times = np.array([0.0, 5e-3])
    assert np.all(np.isfinite(system.simulate(state, speed, times)))


class Growing(DynamicSystem):
    """x' = x in units of 1 mm."""

    name, size, state_names = "growing", 1, ("x [m]",)
    scales = np.array([1e-3])

    def derivative(self, state, speed):
        return np.array(state)

    def jacobian(self, state, speed):
        return np.eye(1)


@pytest.mark.parametrize(("scales", "lost"), [(0.9e9, False), (1.1e9, True)])
def test_a_motion_has_run_away_at_a_thousand_million_scales(scales, lost):
    times = np.log([1.0, 10.0, scales])
    if not lost:
        assert Growing().simulate([1e-3], 1.0, times)[-1, 0] == pytest.approx(
            1e-3 * scales, rel=1e-5
        )
        return
    with pytest.raises(SimulationError, match="ended at sample 2 of 3") as caught:
        Growing().simulate([1e-3], 1.0, times)
    assert caught.value.times == pytest.approx(times[:2])
