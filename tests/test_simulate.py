"""`simulate`: one runner for vehicles, models and systems, against what is known of each motion."""

import inspect
import pickle
import signal

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import LoadForceVector, NodeGenericData
from scipy.spatial.transform import Rotation

from exudyn_wheelset import (
    AnalysisError,
    Ending,
    FunctionSystem,
    Track,
    Wheelset,
    WheelsetError,
    catalogue,
    create_wheelset,
    dtu_truck,
    simulate,
    wheelsets_of,
)
from exudyn_wheelset.coupling.create import SENSOR_VALUES
from exudyn_wheelset.coupling.derailment import DerailmentWatch
from exudyn_wheelset.coupling.running import run_solver
from exudyn_wheelset.results.growth import measure_growth

WHEELSET = Wheelset(mass=1500.0, inertia=(900.0, 100.0, 900.0), radius=0.46, wheel="S1002")
SPEED = 25.0
# A system dies with its container.
CONTAINERS = []


def model(moving_frame=True, sensors=False, load=60e3, speed=SPEED, **options):
    """A wheelset under a load, without springs: they would tell the two frames apart."""
    container = exu.SystemContainer()
    CONTAINERS.append(container)
    mbs = container.AddSystem()
    items = create_wheelset(
        mbs, WHEELSET, Track("UIC60"), speed=speed, moving_frame=moving_frame, show=False,
        sensors=sensors, **{"friction": 0.35, "damping": 1.0, "lateral_offset": 1e-3, **options},
    )  # fmt: skip
    mbs.AddLoad(LoadForceVector(markerNumber=items.marker, loadVector=[0.0, 0.0, -load]))
    return container, mbs


@pytest.fixture(scope="module")
def truck():
    return dtu_truck().dynamic_system()


def test_steady_running_carries_the_weight(truck):
    motion = simulate(truck, 30.0, 0.2)
    assert motion.outcome.ending is Ending.FINISHED
    assert motion.time == pytest.approx(np.linspace(0.0, 0.2, 101))
    assert len(motion.wheels) == 4
    loads = sum(motion.wheel(*wheel)["Q [N]"] for wheel in motion.wheels)
    assert loads == pytest.approx(dtu_truck().weight, rel=1e-6)
    # Nothing moves, so the lateral forces of each wheelset and of all cancel.
    sideways = sum(motion.wheel(*wheel)["Y [N]"] for wheel in motion.wheels)
    assert np.abs(sideways).max() < 1.0
    assert np.abs(motion["truck frame: y"]).max() < 1e-9
    assert motion.record["versions"]["exudyn"]


def test_a_start_beside_the_middle_stays_on_both_rails(truck):
    motion = simulate(truck, 30.0, 0.05, start=3e-3)
    for name in ("truck leading wheelset", "truck trailing wheelset"):
        assert motion[f"{name}: y"][0] == pytest.approx(3e-3, abs=1e-6)
        loads = [motion.wheel(name, side)["Q [N]"][0] for side in ("left", "right")]
        # Static loads of 66.7 kN; the shift itself changes them by the secondary roll, below 10 %.
        assert loads == pytest.approx([66.7e3] * 2, rel=0.2)


def test_the_same_motion_as_the_analyses_see(truck):
    state = truck.equilibrium(40.0)
    state[truck.lateral_indices[0]] += 1e-3
    times = np.linspace(0.0, 0.3, 151)
    known = truck.simulate(state, 40.0, times)
    for start in (state, lambda system, speed: state, {"truck leading wheelset: y": 1e-3}):
        motion = simulate(truck, 40.0, 0.3, start=start)
        found = np.column_stack([motion[name] for name in truck.state_names])
        np.testing.assert_allclose(found, known, rtol=0.0, atol=1e-12)


def test_growth_of_the_motion_is_the_eigenvalue(truck):
    """The least damped of the modes in which the leading wheelset moves sideways."""
    from exudyn_wheelset import linearise

    speed = 35.0
    linear = linearise(truck, speed)
    lateral = truck.lateral_indices[0]
    moves = np.abs(linear.eigenvectors[lateral]) > 1e-3 * np.abs(linear.eigenvectors).max(axis=0)
    hunting = np.flatnonzero(moves & (linear.eigenvalues.imag > 1.0))
    which = hunting[np.argmax(linear.eigenvalues[hunting].real)]
    root, mode = linear.eigenvalues[which], linear.eigenvectors[:, which]
    mode = 2e-5 * np.real(mode / mode[lateral])
    motion = simulate(truck, speed, 2.0, start=linear.state + mode)
    growth = measure_growth(motion.time, motion["truck leading wheelset: y"])
    assert growth.rate == pytest.approx(root.real, abs=2e-3 * abs(root))
    assert 2.0 * np.pi * growth.frequency == pytest.approx(root.imag, rel=2e-3)


def test_wheels_are_those_of_the_sensors():
    _container, mbs = model(sensors=True)
    motion = simulate(mbs, SPEED, 0.1, interval=1e-3, step=5e-4)
    (items,) = wheelsets_of(mbs)
    for side, sensor in (("left", items.left_sensor), ("right", items.right_sensor)):
        stored = mbs.GetSensorStoredData(sensor)
        rows = np.searchsorted(stored[:, 0], motion.time - 1e-9)
        for k, name in enumerate(SENSOR_VALUES):
            wheel = motion[f"wheelset {side}: {name}"]
            assert wheel == pytest.approx(stored[rows, 1 + k], rel=1e-9, abs=1e-12), name
    current = items.contact.current(mbs)
    total = sum(motion.wheel(*wheel)["Y [N]"][-1] for wheel in motion.wheels)
    assert total == pytest.approx(current.force[1], rel=1e-6, abs=1e-6)


def test_over_the_ground_and_in_the_moving_frame():
    ground, frame = (
        simulate(model(moving_frame=moving)[1], SPEED, 0.3) for moving in (False, True)
    )
    assert ground.names == frame.names
    for name in ("y [m]", "z [m]", "yaw [rad]", "vy [m/s]"):
        one, other = (motion[f"wheelset: {name}"] for motion in (ground, frame))
        assert one == pytest.approx(other, abs=1e-10)
    x = ground["wheelset: x"] - frame["wheelset: x"]
    assert x == pytest.approx(SPEED * ground.time, abs=1e-9)
    assert ground["wheelset left: Y"] == pytest.approx(frame["wheelset left: Y"], abs=1e-3)
    with pytest.raises(AnalysisError, match=r"over the ground at 25 m/s, not at 30.*speed=30"):
        simulate(model(moving_frame=False)[1], 30.0, 0.1)


def test_a_model_of_the_moving_frame_takes_another_speed():
    """The spin follows: rolling at 40 m/s from a model that was made for 25 m/s."""
    other = simulate(model()[1], 40.0, 0.2)
    made = simulate(model(speed=40.0)[1], 40.0, 0.2)
    for name in made.names:
        assert other[name] == pytest.approx(made[name], rel=1e-9, abs=1e-9), name


def test_simulating_twice_adds_nothing():
    _container, mbs = model()
    first = simulate(mbs, SPEED, 0.1)
    sensors = mbs.systemData.NumberOfSensors()
    second = simulate(mbs, SPEED, 0.1)
    assert mbs.systemData.NumberOfSensors() == sensors
    assert np.array_equal(first["wheelset: y"], second["wheelset: y"])


def test_a_model_with_a_constraint_runs_as_it_is():
    """A pendulum on a rigid rod beside the wheelset, all of its coordinates in the motion."""
    _container, mbs = model()
    ball = mbs.CreateMassPoint(physicsMass=2.0, referencePosition=[0.0, 3.0, -1.0], returnDict=True)
    ground = mbs.CreateGround()
    mbs.CreateDistanceConstraint(
        itemNumbers=[ground, ball["bodyNumber"]], localPosition0=[0.0, 3.0, 0.0], distance=1.0
    )
    motion = simulate(mbs, SPEED, 0.05, solver_type="GeneralizedAlpha")
    assert motion.outcome.ending is Ending.FINISHED
    assert len(motion["wheelset: y"]) == len(motion)


def test_a_model_with_memory_of_its_own_runs_as_it_is():
    """Data coordinates (of a friction element of Exudyn's, say) are neither states nor refused."""
    _container, mbs = model()
    mbs.AddNode(NodeGenericData(initialCoordinates=[0.0], numberOfDataCoordinates=1))
    assert simulate(mbs, SPEED, 0.01).outcome.ending is Ending.FINISHED
    with pytest.raises(AnalysisError, match="data coordinates"):
        simulate(mbs, SPEED, 0.01, initial=0.0)


@pytest.mark.parametrize("initial", [None, 1e-3])
def test_samples_are_where_they_were_asked_for(initial):
    motion = simulate(model()[1], SPEED, 0.06, initial=initial, interval=3e-3)
    assert motion.time == pytest.approx(np.linspace(0.0, 0.06, 21), abs=1e-12)
    settings = motion.record["settings"]
    assert settings["interval"] == pytest.approx(3e-3) and settings["speed"] == SPEED
    assert settings["duration"] == pytest.approx(0.06)


def test_drawn_wheels_have_turned_by_their_way_over_the_radius():
    """The axle's line stays as the states have it; about it the wheels roll off V t/r."""
    motion = simulate(dtu_truck(), 20.0, 0.5, initial=2e-3)
    name = "truck leading wheelset"
    turned = Rotation.from_rotvec(motion.coordinates[:, 3:6])
    axle, spoke = turned.apply([0.0, 1.0, 0.0]), turned.apply([1.0, 0.0, 0.0])
    np.testing.assert_allclose(axle[:, 0], -motion[f"{name}: yaw"], atol=1e-6)
    np.testing.assert_allclose(axle[:, 2], motion[f"{name}: roll"], atol=1e-6)
    rolled = np.unwrap(np.arctan2(-spoke[:, 2], spoke[:, 0]))
    # Radii over the treads differ by the conicity times 2 mm: below 1 %.
    way = 20.0 * motion.time / dtu_truck().wheelset.radius
    np.testing.assert_allclose(rolled, way, rtol=1e-2, atol=1e-3)
    assert way[-1] > 3.0 * np.pi


def test_equations_without_exudyn():
    system = FunctionSystem("oscillator", lambda x, _: [x[1], -x[0]], ["y [m]", "v [m/s]"], [1, 1])
    motion = simulate(system, 1.0, 3.0, start=0.5, interval=0.1)
    # LSODA's tolerance.
    assert motion["y"] == pytest.approx(0.5 * np.cos(motion.time), abs=1e-6)


def test_a_derailment_ends_the_motion_and_keeps_it():
    _container, mbs = model(lateral_offset=0.0)
    (items,) = wheelsets_of(mbs)
    mbs.AddLoad(LoadForceVector(markerNumber=items.marker, loadVector=[0.0, 250e3, 0.0]))
    motion = simulate(mbs, SPEED, 2.0)
    assert motion.outcome.ending.derailed
    assert 0.0 < motion.time[-1] < 1.0
    assert all(np.all(np.isfinite(motion[name])) for name in motion.names)
    assert "wheelset at" in str(motion.outcome)


def test_ctrl_c_keeps_what_was_computed(monkeypatch):
    look = DerailmentWatch.look

    def interrupt(self, time):
        if time > 0.05:
            signal.raise_signal(signal.SIGINT)
        return look(self, time)

    monkeypatch.setattr(DerailmentWatch, "look", interrupt)
    handler = signal.getsignal(signal.SIGINT)
    motion = simulate(model()[1], SPEED, 1.0)
    assert motion.outcome.ending is Ending.INTERRUPTED
    assert 0.05 < motion.time[-1] < 0.06
    assert signal.getsignal(signal.SIGINT) is handler


def test_the_models_own_function_before_each_step_is_called_and_kept():
    _container, mbs = model()
    calls = []
    mbs.SetPreStepUserFunction(lambda mbs, t: calls.append(t) is None)
    simulate(mbs, SPEED, 0.01)
    assert len(calls) == 20
    assert mbs.GetPreStepUserFunction() != 0


def test_no_folder_is_left_behind(tmp_path, monkeypatch, truck):
    monkeypatch.chdir(tmp_path)
    simulate(truck, 30.0, 0.01)
    simulate(model()[1], SPEED, 0.01)
    simulate(model()[1], SPEED, 0.01, settings=exu.SimulationSettings(), step=5e-4)
    _container, mbs = model()
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.endTime = 0.01
    settings.timeIntegration.verboseModeFile = 2
    settings.solution.restart.write = True
    simulate(dtu_truck(), 30.0, 0.01, settings=settings)
    run_solver(mbs, settings, exu.DynamicSolverType.RK44)
    assert settings.solution.file.write and settings.timeIntegration.verboseModeFile == 2
    assert list(tmp_path.iterdir()) == []
    settings.solution.file.name = "mine"
    run_solver(mbs, settings, exu.DynamicSolverType.RK44)
    assert [file.stem for file in tmp_path.iterdir()] == ["mine"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"speed": "40"}, "speed = '40' is no number: give a number in m/s"),
        ({"speed": 400.0}, "speed = 400.0 m/s: give a number from -200 to 200"),
        ({"duration": -1.0}, "duration = -1.0 s: give a positive number"),
        ({"interval": 5.0}, "interval = 5.0 s is out of proportion"),
        ({"start": 0.03}, r"shift of truck leading wheelset = 0.03 m: give .* in metres"),
        ({"start": np.zeros(3)}, r"shape \(3,\).*give 34 numbers"),
        ({"start": {"front: y": 1e-3}}, "'front: y' is not one of"),
        ({"intervall": 1e-3}, "unknown option 'intervall'.*did you mean 'interval'"),
        ({"step": 1e-4}, "a system has a solver and a step of its own"),
    ],
)
def test_impossible_values_are_refused(truck, change, words):
    arguments = {"speed": 40.0, "duration": 0.1, **change}
    with pytest.raises(WheelsetError, match=words):
        simulate(truck, arguments.pop("speed"), arguments.pop("duration"), **arguments)


def test_a_name_of_the_catalogue_runs_as_its_vehicle():
    """The same equations from the same start give the same numbers to the bit."""
    by_name = simulate("s1002", speed=20.0, duration=0.05, initial=1e-3)
    same = simulate(vehicle=catalogue.vehicle("s1002"), speed=20.0, duration=0.05, initial=1e-3)
    assert np.array_equal(by_name.coordinates, same.coordinates)
    assert pickle.loads(pickle.dumps(simulate)) is simulate
    assert list(inspect.signature(simulate).parameters)[:3] == ["vehicle", "speed", "duration"]
