"""The eigenvalue that motion of a finite amplitude sees: closed forms, and simulated motion."""

import warnings

import numpy as np
import pytest
from shared_reference import reference_folder

from exudyn_wheelset import FunctionSystem, catalogue, linearise, load_profile
from exudyn_wheelset.stability.linear.amplitudes import eigenvalue_at, farthest_off
from exudyn_wheelset.stability.linear.law_checks import LawWarning
from exudyn_wheelset.stability.subject import as_system

DAMPING, STIFFNESS = 0.4, 9.0
JACOBIAN = np.array([[0.0, 1.0], [-STIFFNESS, -DAMPING]])
AMPLITUDE = 0.02


def oscillator(force):
    """y'' + DAMPING y' + STIFFNESS y + force(y) = 0, y [m] of one wheelset."""
    system = FunctionSystem(
        "oscillator",
        lambda x, _: np.array([x[1], -DAMPING * x[1] - STIFFNESS * x[0] - force(x[0])]),
        ("y [m]", "y' [m/s]"),
        (1e-3, 1e-2),
    )
    system.lateral_indices = (0,)
    return system


def seen_by(force, amplitude=AMPLITUDE):
    """Eigenvalue, the second entry of its left vector, and what motion of an amplitude sees.

    The mode is (1, lambda), the left vector (-conj(lambda), 1)/(lambda - conj(lambda)).
    """
    eigenvalue = complex(-0.5 * DAMPING, np.sqrt(STIFFNESS - 0.25 * DAMPING**2))
    mode = np.array([1.0, eigenvalue])
    seen = eigenvalue_at(oscillator(force), np.zeros(2), 1.0, mode, JACOBIAN, amplitude)
    return eigenvalue, 1.0 / (2j * eigenvalue.imag), seen


def test_linear_equations_show_the_eigenvalue_at_every_amplitude():
    for amplitude in (1e-6, 1.0):
        eigenvalue, _, seen = seen_by(lambda y: 0.0, amplitude)
        assert seen == pytest.approx(eigenvalue, rel=1e-8)


def test_a_cubic_spring():
    """The first harmonic of cos^3 is 3/4: lambda(A) = lambda - l_2 (3/4) e A^2."""
    eigenvalue, left, seen = seen_by(lambda y: 500.0 * y**3)
    assert seen - eigenvalue == pytest.approx(-left * 0.75 * 500.0 * AMPLITUDE**2, rel=1e-6)


def test_a_force_that_steps():
    """The first harmonic of sign(cos) is 4/pi; sixteen phases know it to 0.7 %."""
    eigenvalue, left, seen = seen_by(lambda y: 0.01 * np.sign(y))
    expected = -left * 4.0 / np.pi * 0.01 / AMPLITUDE
    assert abs(seen - eigenvalue - expected) < 0.01 * abs(expected)


def test_a_system_without_wheelsets_is_not_judged():
    system = oscillator(lambda y: y**3)
    system.lateral_indices = ()
    assert farthest_off(system, np.zeros(2), 1.0, np.array([1.0, 3j]), JACOBIAN) == (0.0, 0.0)


def measured_truck(normal):
    """A three-axle truck on a measured wheel and rail."""
    folder = reference_folder() / "profiles"
    if not folder.is_dir():
        pytest.skip("no measured profiles here")
    wheel = load_profile(folder / "Car7422_0001r.whl", smoothing="auto")
    rail = load_profile(folder / "fr_ol.csv", smoothing="auto")
    return catalogue.vehicle("three_axle_truck", wheel=wheel, rail=rail, normal=normal)


@pytest.mark.parametrize(("normal", "holds"), [("hertz", False), ("energy", True)])
def test_simulated_motion_of_ten_micrometres_sides_with_the_warning(normal, holds):
    """Hertz's forces step 3 to 10 um beside the equilibrium of this pair, energy's do not."""
    system = as_system(measured_truck(normal))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        linear = linearise(system, 25.0)
    told = [str(one.message) for one in caught if issubclass(one.category, LawWarning)]
    assert any("um sees an eigenvalue" in message for message in told) is not holds
    row = linear.hunting_row
    eigenvalue, mode = linear.eigenvalues[row], linear.eigenvectors[:, row]
    scales = system.scales
    values, vectors = np.linalg.eig(linear.jacobian * scales[None, :] / scales[:, None])
    left = np.linalg.inv(vectors)[np.argmin(np.abs(values - eigenvalue))] / scales
    mode = mode * (1e-5 / np.max(np.abs(mode[list(system.lateral_indices)])))
    times = np.linspace(0.0, 3.0 / abs(eigenvalue.real), 200)
    motion = system.simulate(linear.state + mode.real, 25.0, times) - linear.state
    growth = np.polyfit(times, np.log(np.abs(motion @ left)), 1)[0]
    assert bool(abs(growth - eigenvalue.real) < 0.02 * abs(eigenvalue.imag)) is holds
