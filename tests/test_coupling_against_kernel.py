"""The loads, sensors and motion of a wheelset in Exudyn against the contact kernel alone.

A pose is turned into Exudyn's coordinates by scipy's rotations: nothing here is shared with the
coupling's own kinematics. States are set in an assembled system and the loads are asked for as a
solver does, one by one and in any order.
"""

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import LoadForceVector
from scipy.spatial.transform import Rotation

from exudyn_wheelset import Track, Wheelset, contact_forces, create_wheelset
from exudyn_wheelset.coupling.create import SENSOR_VALUES

SPEED = 20.0
RADIUS = 0.46
HEIGHT = RADIUS - 2.8e-4
WHEELSET = Wheelset(mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=RADIUS, wheel="S1002")
TRACK = Track(rail="UIC60")
OPTIONS = {"friction": 0.35, "damping": 2.0, "shear_modulus": 80e9, "poisson": 0.27}


class Model:
    """An assembled system with wheelsets; states are set in it and loads asked for."""

    def __init__(self, places=((0.0, 0.0),), load=0.0, **options):
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.items = [
            create_wheelset(
                self.mbs, WHEELSET, TRACK, position=place, speed=SPEED, show=False,
                name=f"wheelset {k}", **{**OPTIONS, **options},
            )
            for k, place in enumerate(places)
        ]  # fmt: skip
        for item in self.items:
            self.mbs.AddLoad(LoadForceVector(markerNumber=item.marker, loadVector=[0, 0, -load]))
        self.mbs.Assemble()

    def set(self, pose, velocity, index=0, turns=0):
        """Put a wheelset into a pose and velocity of the track frame, over the ground.

        turns: whole revolutions about its axis of rotation added to the rotation vector.
        """
        x, y, z, roll, pitch, yaw = pose
        turn = Rotation.from_euler("ZXY", [yaw, roll, pitch])
        vector = turn.as_rotvec()
        if turns:
            vector *= 1.0 + 2.0 * np.pi * turns / np.linalg.norm(vector)
        node = self.items[index].node
        reference = np.array(self.mbs.GetNodeParameter(node, "referenceCoordinates"))
        data = self.mbs.systemData
        place = np.array(data.GetNodeLTGODE2(node))
        q, v = data.GetODE2Coordinates(), data.GetODE2Coordinates_t()
        q[place] = [*(np.array([x, y, RADIUS + z]) - reference[:3]), *vector]
        v[place] = [*velocity[:3], *turn.inv().apply(velocity[3:])]
        v[place[0]] -= self.items[index].contact.rail_speed
        data.SetODE2Coordinates(q)
        data.SetODE2Coordinates_t(v)

    def force(self, index=0):
        return np.array(self.mbs.GetLoadValues(self.items[index].force_load))

    def torque(self, index=0):
        return np.array(self.mbs.GetLoadValues(self.items[index].torque_load))


POSES = [
    (0.0, 0.0, -2.8e-4, 0.0, 0.0, 0.0),
    (1.3, 0.004, -1.6e-4, 3e-4, 0.4, 0.006),
    (-0.2, -0.0065, 2.9e-3, -4.4e-3, -2.1, 0.02),
    (0.0, 0.007, 4.5e-3, 6.4e-3, 3.0, 0.017),
    (0.0, 0.001, 0.01, 0.0, 1.0, 0.0),
]
VELOCITIES = [
    (SPEED, 0.0, 0.0, 0.0, SPEED / RADIUS, 0.0),
    (SPEED, 0.05, -0.01, 0.02, 1.001 * SPEED / RADIUS, -0.1),
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (15.0, -0.2, 0.003, -0.1, 40.0, 0.3),
]


def kernel_forces(pose, velocity):
    return contact_forces(WHEELSET, TRACK, pose, velocity, **OPTIONS)


def near(values, forces):
    """Equal to rounding of the pose (1e-16 of a metre of radius, times the contact stiffness)."""
    return pytest.approx(np.array(values), rel=1e-7, abs=1e-6 * (1.0 + np.abs(forces.force).max()))


SPUN = [(pose, 0) for pose in POSES] + [(pose, turns) for pose in POSES[1:] for turns in (3, 400)]


@pytest.mark.parametrize("velocity", VELOCITIES)
@pytest.mark.parametrize(("pose", "turns"), SPUN)
def test_loads_are_the_forces_of_the_pose(pose, turns, velocity):
    model = Model()
    model.set(pose, velocity, turns=turns)
    forces = kernel_forces(pose, velocity)
    assert model.force() == near(forces.force, forces)
    assert model.torque() == near(forces.moment, forces)
    if pose is POSES[-1]:
        assert not np.any(model.force())
    else:
        assert np.linalg.norm(forces.force) > 1e3


def test_no_stale_evaluation_between_force_and_torque():
    """During numerical Jacobians each load is asked for alone, at a state of its own."""
    model = Model()
    first, second = kernel_forces(POSES[1], VELOCITIES[1]), kernel_forces(POSES[3], VELOCITIES[3])
    slower = (*VELOCITIES[1][:5], 0.2)
    third = kernel_forces(POSES[1], slower)
    model.set(POSES[1], VELOCITIES[1])
    assert model.force() == near(first.force, first)
    model.set(POSES[3], VELOCITIES[3])
    assert model.torque() == near(second.moment, second)
    assert model.force() == near(second.force, second)
    model.set(POSES[1], slower)
    assert model.force() == near(third.force, third)
    model.set(POSES[1], VELOCITIES[1])
    assert model.torque() == near(first.moment, first)
    # A tenth of a picometre counts.
    data = model.mbs.systemData
    q = data.GetODE2Coordinates()
    before = model.force()[2]
    q[2] -= 1e-13
    data.SetODE2Coordinates(q)
    assert model.force()[2] != before


def test_changed_speed_and_parameters_are_seen_at_the_same_state():
    model = Model(moving_frame=True)
    model.set(POSES[1], VELOCITIES[1])
    before = model.torque()
    model.items[0].contact.set_speed(0.5 * SPEED)
    velocity = (VELOCITIES[1][0] - 0.5 * SPEED, *VELOCITIES[1][1:])
    forces = kernel_forces(POSES[1], velocity)
    assert model.torque() == near(forces.moment, forces)
    assert np.abs(model.torque() - before).max() > 1.0


def test_two_wheelsets_do_not_disturb_each_other():
    model = Model(places=((0.0, 0.0), (-2.5, 0.0)))
    poses = [POSES[1], (-2.5, *POSES[3][1:])]
    for index in range(2):
        model.set(poses[index], VELOCITIES[index], index)
    expected = [kernel_forces(poses[k], VELOCITIES[k]) for k in range(2)]
    order = [(0, "force"), (1, "torque"), (0, "torque"), (1, "force"), (0, "force")]
    for index, part in order:
        value = expected[index].force if part == "force" else expected[index].moment
        assert getattr(model, part)(index) == near(value, expected[index])
    model.set(POSES[4], VELOCITIES[0], 0)
    assert not np.any(model.force(0))
    assert model.force(1) == near(expected[1].force, expected[1])


def simulate(model, duration=0.2, step=2e-4):
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.numberOfSteps = round(duration / step)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    assert model.mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)


def test_two_wheelsets_run_as_one_does():
    alone = Model(lateral_offset=2e-3)
    pair = Model(places=((0.0, 0.0), (-3.0, 0.0)), lateral_offset=2e-3)
    simulate(alone)
    simulate(pair)
    q, both = (m.mbs.systemData.GetODE2Coordinates() for m in (alone, pair))
    # The same numbers in the same order: equal to the last bits of a body shifted by 3 m.
    assert both[:6] == pytest.approx(q, rel=1e-9, abs=1e-12)
    assert both[6:] == pytest.approx(q, rel=1e-9, abs=1e-12)


def test_moving_frame_is_the_same_motion():
    """Galilei: rails that run backwards under a wheelset that stands, or the other way round."""
    ground = Model(lateral_offset=2e-3, yaw=1e-3)
    frame = Model(lateral_offset=2e-3, yaw=1e-3, moving_frame=True)
    duration = 0.2
    for model in (ground, frame):
        simulate(model, duration)
    q, standing = (m.mbs.systemData.GetODE2Coordinates() for m in (ground, frame))
    v, rates = (m.mbs.systemData.GetODE2Coordinates_t() for m in (ground, frame))
    standing[0] += SPEED * duration
    rates[0] += SPEED
    assert standing == pytest.approx(q, rel=1e-8, abs=1e-10)
    assert rates == pytest.approx(v, rel=1e-8, abs=1e-8)
    assert abs(q[1] - 2e-3) > 1e-4


@pytest.mark.parametrize("moving_frame", [False, True])
def test_accelerations_are_those_of_newton_and_euler(moving_frame):
    """Exudyn's equations at a state against the kernel's wrench, the weight and Euler's terms."""
    model = Model(moving_frame=moving_frame, gravity=9.81)
    settings = exu.SimulationSettings()
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    solver = exu.MainSolverImplicitSecondOrder()
    solver.InitializeSolver(model.mbs, settings)
    pose, velocity = POSES[1], VELOCITIES[1]
    model.set(pose, velocity)
    solver.ComputeODE2RHS(model.mbs)
    solver.ComputeMassMatrix(model.mbs)
    rates = np.linalg.solve(solver.GetSystemMassMatrix(), solver.GetSystemResidual())
    forces = kernel_forces(pose, velocity)
    acceleration = forces.force / WHEELSET.mass - [0.0, 0.0, 9.81]
    turn = Rotation.from_euler("ZXY", [pose[5], pose[3], pose[4]])
    inertia = np.diag(WHEELSET.inertia)
    spin = turn.inv().apply(velocity[3:])
    moment = turn.inv().apply(forces.moment)
    angular = np.linalg.solve(inertia, moment - np.cross(spin, inertia @ spin))
    assert rates[:3] == pytest.approx(acceleration, rel=1e-6, abs=1e-6)
    assert rates[3:] == pytest.approx(angular, rel=1e-6, abs=1e-6)


def test_sensors_and_current_forces():
    model = Model()
    model.set(POSES[3], VELOCITIES[1])
    forces = kernel_forces(POSES[3], VELOCITIES[1])
    current = model.items[0].contact.current(model.mbs)
    assert current.force == near(forces.force, forces)
    assert current.moment == near(forces.moment, forces)
    for side in ("left", "right"):
        wanted, found = getattr(forces, side), getattr(current, side)
        assert len(found) == len(wanted) > 0
        for one, other in zip(found, wanted, strict=True):
            for name, value in vars(other).items():
                assert getattr(one, name) == pytest.approx(value, rel=1e-6, abs=1e-9), name
    assert model.items[0].contact.elastic_energy(model.mbs) == pytest.approx(
        sum(patch.energy for patch in (*forces.left, *forces.right)), rel=1e-6
    )


def test_recorded_sensors_are_the_patches_of_the_last_state():
    model = Model(load=180e3, lateral_offset=1e-4, moving_frame=True)
    simulate(model, 0.2)
    current = model.items[0].contact.current(model.mbs)
    numbers = (model.items[0].left_sensor, model.items[0].right_sensor)
    for number, patches in zip(numbers, (current.left, current.right), strict=True):
        stored = model.mbs.GetSensorStoredData(number)
        values = dict(zip(SENSOR_VALUES, stored[-1, 1:], strict=True))
        assert stored.shape[1] == 1 + len(SENSOR_VALUES)
        total = sum(patch.normal_force for patch in patches)
        assert total > 1e3
        assert values["patches"] == len(patches)
        assert values["normal_force"] == pytest.approx(total, rel=1e-9)
        assert values["fx"] == pytest.approx(sum(p.fx for p in patches), rel=1e-9)
        assert values["fy"] == pytest.approx(sum(p.fy for p in patches), rel=1e-9)
        # Everything else is a mean, weighted with the normal force.
        for name in ("creep_x", "creep_y", "spin", "wheel_y", "rail_y", "angle", "radius"):
            mean = sum(getattr(p, name) * p.normal_force for p in patches) / total
            assert values[name] == pytest.approx(mean, rel=1e-9, abs=1e-15)


def test_a_wheelset_that_rolls_straight_carries_its_load():
    """Settled on damped contact the rails push with the weight and the load on the axle."""
    model = Model(load=80e3, gravity=9.81, moving_frame=True)
    simulate(model, 0.5)
    force = model.items[0].contact.current(model.mbs).force
    assert force[2] == pytest.approx(1813.0 * 9.81 + 80e3, rel=1e-4)
    assert abs(force[1]) < 1e-3
