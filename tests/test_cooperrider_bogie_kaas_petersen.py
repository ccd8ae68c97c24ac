"""The bogie in Exudyn against Kaas-Petersen's figures and against its equations written out.

Kaas-Petersen, Acta Mechanica 61 (1986): linear critical speed 68.64 m/s with 4.00 Hz (68.66 m/s by
another author with the same parameters).
"""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCuboid
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.integrate import solve_ivp

from exudyn_wheelset.catalogue.cooperrider_bogie import (
    SCALES,
    CooperriderBogie,
    cooperrider_system,
    create_cooperrider_bogie,
)
from exudyn_wheelset.catalogue.cooperrider_reference import cooperrider_reference_system
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.linear.crossings import divergence_points, hopf_points
from exudyn_wheelset.stability.linear.linearisation import linearise
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.system import DynamicSystem

EXUDYN = cooperrider_system()
REFERENCE = cooperrider_reference_system()

# States within 20 mm and 20 mrad: both flanges, full saturation of the creep forces.
states = arrays(float, 14, elements=st.floats(-20.0, 20.0)).map(lambda x: x * SCALES)


@pytest.mark.parametrize("system", [EXUDYN, REFERENCE], ids=["exudyn", "reference"])
def test_linear_critical_speed(system):
    hopf = linear_critical_speed(system, 20.0, 120.0)
    assert hopf.speed == pytest.approx(68.64, abs=0.02)
    assert hopf.frequency == pytest.approx(4.00, abs=0.01)
    assert hopf.direction == "loses stability"
    points = hopf_points(system, 20.0, 120.0)
    assert [float(point) for point in points] == pytest.approx([hopf.speed], abs=1e-5)
    assert divergence_points(system, 20.0, 120.0) == []


def test_a_near_guess_gives_the_same_speed_with_fewer_evaluations():
    hopf = linear_critical_speed(EXUDYN, 20.0, 120.0)
    changed = cooperrider_system(replace(CooperriderBogie(), conicity=0.051))
    cold = linear_critical_speed(changed, 20.0, 120.0)
    warm = linear_critical_speed(changed, 20.0, 120.0, guess=hopf)
    assert warm.speed == pytest.approx(cold.speed, abs=1e-5)
    assert warm.evaluations < cold.evaluations / 3


@settings(deadline=None, max_examples=200)
@given(state=states, speed=st.floats(5.0, 150.0))
def test_exudyn_and_the_written_out_equations_agree(state, speed):
    rates = REFERENCE.derivative(state, speed)
    # Subnormal numbers have fewer digits: below 1e-300 nothing is compared.
    floor = 1e-11 * np.abs(rates).max() + 1e-300
    for found in (ExudynSystem.derivative(EXUDYN, state, speed), EXUDYN.derivative(state, speed)):
        np.testing.assert_allclose(found, rates, rtol=1e-12, atol=floor)


@settings(deadline=None, max_examples=100)
@given(state=states, speed=st.floats(5.0, 150.0))
def test_exact_jacobian(state, speed):
    """Against central differences, away from the corner of the flange spring."""
    if np.any(np.abs(np.abs(state[[0, 2]]) - 9.1e-3) < 1e-7):
        return
    exact = REFERENCE.jacobian(state, speed)
    differences = DynamicSystem.jacobian(REFERENCE, state, speed)
    # Rounding of the forces over a step of 6e-9 m, and the curvature of the creep law at zero.
    for found in (differences, EXUDYN.jacobian(state, speed)):
        np.testing.assert_allclose(found, exact, rtol=1e-4, atol=1e-5 * np.abs(exact).max())


def test_vectorised_forms():
    rows = np.random.default_rng(1).standard_normal((7, 14)) * SCALES * 5.0
    for system in (EXUDYN, REFERENCE):
        rates = system.derivatives(rows, 70.0)
        matrices = system.jacobians(rows, 70.0)
        for row, rate, matrix in zip(rows, rates, matrices, strict=True):
            np.testing.assert_array_equal(rate, system.derivative(row, 70.0))
            np.testing.assert_array_equal(matrix, system.jacobian(row, 70.0))


@settings(deadline=None, max_examples=50)
@given(state=states, speed=st.floats(5.0, 150.0))
def test_mirror_symmetry(state, speed):
    """Left and right are alike: f(-x) = -f(x)."""
    np.testing.assert_array_equal(
        REFERENCE.derivative(-state, speed), -REFERENCE.derivative(state, speed)
    )


def test_simulated_motion_against_an_independent_integrator():
    """Exudyn's RK44 and scipy on the other writing, from 12 mm, with blows of both flanges."""
    start = np.zeros(14)
    start[0] = 12e-3
    times = np.linspace(0.0, 1.0, 201)
    simulated = cooperrider_system(step=1e-4).simulate(start, 72.0, times)
    reference = solve_ivp(
        lambda _, x: REFERENCE.derivative(x, 72.0),
        (0.0, 1.0),
        start,
        method="DOP853",
        t_eval=times,
        rtol=1e-10,
        atol=1e-13,
        max_step=1e-3,
    ).y.T
    # The corner of the flange spring takes RK44 to second order: (h/time of contact)^2 ~ 1e-5.
    assert np.abs((simulated - reference) / np.abs(reference).max(axis=0)).max() < 2e-4


@pytest.mark.parametrize("speed", [60.0, 66.0, 68.64, 71.0, 76.0])
def test_growth_rate_of_simulated_motion(speed):
    """Motion of micrometres grows as the eigenvalue says: within 0.1 % of the frequency."""
    linear = linearise(EXUDYN, speed)
    index = np.argmax(np.where(linear.eigenvalues.imag > 1.0, linear.eigenvalues.real, -np.inf))
    root, mode = linear.eigenvalues[index], linear.eigenvectors[:, index]
    start = (mode / np.abs(mode[0]) * 1e-6).real
    times = np.linspace(0.0, 2.0, 401)
    states = EXUDYN.simulate(start, speed, times)
    # The left eigenvector picks the amplitude of this mode out of the motion.
    left = np.linalg.inv(linear.eigenvectors)[index]
    amplitude = states @ left
    measured = np.polyfit(times, np.log(np.abs(amplitude)), 1)[0]
    frequency = np.polyfit(times, np.unwrap(np.angle(amplitude)), 1)[0]
    assert measured == pytest.approx(root.real, abs=1e-3 * root.imag)
    assert frequency == pytest.approx(root.imag, rel=1e-3)


def test_bogies_join_an_existing_system():
    """Two bogies beside a body of the user's own move as a bogie alone does."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    mbs.CreateRigidBody(
        inertia=InertiaCuboid(1000.0, [1, 1, 1]),
        nodeType=exu.NodeType.RotationRotationVector,
    )
    items = [create_cooperrider_bogie(mbs, speed=70.0, name=name) for name in ("front", "")]
    system = ExudynSystem(mbs, container, set_speed=lambda mbs, speed: None)
    alone = np.random.default_rng(2).standard_normal(14) * SCALES
    for item in items:
        first = mbs.GetNodeODE2Index(item.node)
        entries = np.r_[first : first + 7, system.size // 2 + first : system.size // 2 + first + 7]
        state = np.zeros(system.size)
        state[entries] = alone
        rate = system.derivative(state, 70.0)
        np.testing.assert_allclose(rate[entries], EXUDYN.derivative(alone, 70.0), rtol=1e-12)
        assert np.all(np.delete(rate, entries) == 0.0)


@pytest.mark.parametrize(
    "change", [{"frame_mass": 0.0}, {"creep_stiffness": -1.0}, {"conicity": float("nan")}]
)
def test_bad_parameters_are_named(change):
    with pytest.raises(WheelsetError, match=next(iter(change))):
        CooperriderBogie(**change)
