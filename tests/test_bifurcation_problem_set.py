"""Bifurcations of textbook systems with known answers, on the interface that vehicles have.

Langford's torus (W. F. Langford, SIAM J. Appl. Math. 37 (1979) 22), in cylindrical coordinates

    r' = (z - b) r,   theta' = d,   z' = c + a z - z^3/3 - r^2 (1 + e z);                  (1)

Lur'e's feedback control x''' + alpha x'' + beta x' + x - x^2 = 0 (Yu. A. Kuznetsov, Elements of
Applied Bifurcation Theory, Springer, example 5.4; the period doubling by MATCONT's manual);
Roessler's band (O. E. Roessler, Phys. Lett. A 57 (1976) 397); an isola, r' = r (rho^2 - mu^2 -
(r^2 - 1)^2) (M. Golubitsky and D. Schaeffer, Singularities and Groups in Bifurcation Theory I,
Springer 1985, section III.6); an oscillator that is driven against a spring stop (S. W. Shaw and
P. J. Holmes, J. Sound Vib. 90 (1983) 129), linear on either side of it. Cusp and Bautin point:
test_stability_maps.py; subcritical Hopf point with a fold: test_normal_form_hopf_fold.py.
"""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq, fsolve

from exudyn_wheelset import AnalysisError, all_branches
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.hunting.branch_switching import switch_branch
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles
from exudyn_wheelset.stability.hunting.orbit import orbit_from_samples
from exudyn_wheelset.stability.hunting.same_branch import is_known, lies_on
from exudyn_wheelset.stability.linear.crossings import hopf_points
from exudyn_wheelset.systems.function_system import FunctionSystem


def system_of(name, rates, names, scales=None, displacements=(0,)):
    return FunctionSystem(
        name,
        lambda state, parameter: rates(state[None], parameter)[0],
        names,
        np.ones(len(names)) if scales is None else scales,
        displacement_indices=displacements,
        derivatives_function=rates,
    )


# -- Langford's torus

A, C, D, E = 0.95, 0.6, 3.5, 0.25


def langford(states, b):
    x, y, z = states.T
    # Measured from near the rest that is looked for: (1) has others.
    z = z + 2.0
    square = x**2 + y**2
    return np.stack(
        [
            (z - b) * x - D * y,
            D * x + (z - b) * y,
            C + A * z - z**3 / 3.0 - square * (1.0 + E * z),
        ],
        axis=1,
    )


def langford_square(b):
    """r^2 of the cycle z = b of (1)."""
    return (C + A * b - b**3 / 3.0) / (1.0 + E * b)


def test_langford_torus():
    # At rest on the axis z; there the cycle shrinks to it.
    axis = brentq(lambda z: C + A * z - z**3 / 3.0, 1.0, 3.0)
    system = system_of("Langford", langford, ("x", "y", "z"))
    point = min(
        hopf_points(system, axis - 0.4, axis + 0.4), key=lambda hopf: abs(hopf.speed - axis)
    )
    assert point.speed == pytest.approx(axis, abs=1e-6)
    branch = limit_cycles(system, point, (0.5, axis + 0.1))
    np.testing.assert_allclose(branch.amplitude["x"] ** 2, langford_square(branch.speed), rtol=1e-5)
    for b, found in zip(branch.speed, branch.multipliers, strict=True):
        square = langford_square(b)
        # Of (1) in (r, z) at r' = z' = 0.
        slope = A - b**2 - E * square
        plane = np.array([[0.0, np.sqrt(square)], [-2.0 * np.sqrt(square) * (1 + E * b), slope]])
        expected = np.exp(2.0 * np.pi / D * np.linalg.eigvals(plane))
        # Collocation on 30 intervals of degree 4: 1e-6 here.
        np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(expected), atol=2e-5)
    torus = brentq(lambda b: A - b**2 - E * langford_square(b), 0.5, 1.5)
    (change,) = branch.changes
    assert change.kind == "torus"
    # Interpolated between two points of the branch.
    assert change.speed == pytest.approx(torus, abs=2e-3)


# -- Period doublings


def lure(states, alpha):
    x, y, z = states.T
    return np.stack([y, z, -alpha * z - y - x + x**2], axis=1)


def test_lure_period_doubling():
    system = system_of("Lur'e", lure, ("x", "y", "z"))
    (hopf,) = hopf_points(system, 0.8, 1.3)
    # alpha beta = 1 with beta = 1, at the frequency sqrt(beta).
    assert hopf.speed == pytest.approx(1.0, abs=1e-6)
    assert 2.0 * np.pi * hopf.frequency == pytest.approx(1.0, abs=1e-6)
    branch = limit_cycles(system, hopf, (0.55, 1.1), speed_steps=60)
    change = next(change for change in branch.changes if change.kind == "period doubling")
    assert change.speed == pytest.approx(0.6303020, abs=2e-4)
    assert branch.period[change.index] == pytest.approx(6.364071, rel=2e-3)
    assert branch.stable[change.index - 1] and not branch.stable[change.index]
    double = switch_branch(system, branch, change)
    assert double.record["leaves_at"] == pytest.approx(0.6303020, abs=2e-4)
    # The first orbit is a tenth of its size away.
    assert double.period[0] == pytest.approx(2.0 * 6.364071, rel=5e-3)
    # It leaves to the unstable side of the first one, stable, and two rounds of it differ.
    assert np.all(double.speed[:3] < 0.6303) and np.all(double.stable[:3])
    orbit = double.orbits[3]
    states = orbit.evaluate(np.array([0.0, 0.5]))
    assert np.abs(states[1] - states[0]).max() > 0.01
    again = system.simulate(orbit.states[0], orbit.speed, np.array([0.0, 5.0 * orbit.period]))
    np.testing.assert_allclose(again[1], orbit.states[0], atol=1e-4)


def roessler(states, c):
    x, y, z = states.T
    return np.stack([-y - z, x + 0.2 * y, 0.2 + z * (x - c)], axis=1)


def test_roessler_period_doubling():
    system = system_of("Roessler", roessler, ("x", "y", "z"))
    branch = limit_cycles(system, [3.0, 0.0, 0.0], (2.2, 3.2), start_speed=2.4)
    change = next(change for change in branch.changes if change.kind == "period doubling")
    # a = b = 0.2: one round up to c = 2.83, two beyond.
    assert change.speed == pytest.approx(2.832, abs=5e-3)


# -- Symmetry


def pitchfork(states, mu):
    """r' = (1 + mu - r^2) r, theta' = 2, z' = (mu - z^2) z; states x, y, (2 + x^2) z, all odd."""
    x, y, bent = states.T
    z = bent / (2.0 + x**2)
    growth = 1.0 + mu - x**2 - y**2
    by_x = growth * x - 2.0 * y
    rate = (mu - z**2) * z * (2.0 + x**2) + 2.0 * z * x * by_x
    return np.stack([by_x, growth * y + 2.0 * x, rate], axis=1)


@pytest.mark.parametrize("mirror", [True, False])
def test_broken_symmetry(mirror):
    system = system_of("pitchfork", pitchfork, ("x", "y", "z"), displacements=(0, 1, 2))
    hopf = min(hopf_points(system, -1.3, -0.7))
    branch = limit_cycles(system, hopf, (-1.1, 0.5), mirror=mirror)
    change = next(change for change in branch.changes if change.kind == "branch point")
    other = switch_branch(system, branch, change)
    # The multiplier exp(mu pi) is brought to 1 within 1e-3.
    assert other.record["leaves_at"] == pytest.approx(0.0, abs=1e-3)
    z = other.states[:, 2] / (2.0 + other.states[:, 0] ** 2)
    np.testing.assert_allclose(z**2, other.speed, atol=1e-6)
    np.testing.assert_allclose(np.hypot(*other.states[:, :2].T) ** 2, 1.0 + other.speed, rtol=1e-5)
    expected = np.exp(-2.0 * np.pi * np.minimum(other.speed, 1.0 + other.speed))
    np.testing.assert_allclose(np.abs(other.multipliers[:, 0]), expected, rtol=1e-4)
    assert np.all(other.stable[1:]) and other.speed.max() == pytest.approx(0.5)


def two_trucks(states, mu):
    """Two oscillators side by side that begin at 1.0 and 1.2, as the trucks of a car do."""
    parts = []
    for pair, begin, turn in ((states[:, :2], 1.0, 2.0), (states[:, 2:], 1.2, 3.0)):
        x, y = pair.T
        growth = mu - begin - x**2 - y**2
        parts += [growth * x - turn * y, growth * y + turn * x]
    return np.stack(parts, axis=1)


def test_branches_of_both_trucks():
    system = system_of("two trucks", two_trucks, ("a", "b", "c", "d"), displacements=(0, 2))
    found = all_branches(system, (0.8, 1.6), switch=False)
    one, two = found.branches
    np.testing.assert_allclose(one.amplitude["a"] ** 2, one.speed - 1.0, atol=1e-5)
    np.testing.assert_allclose(two.amplitude["c"] ** 2, two.speed - 1.2, atol=1e-5)
    assert one.amplitude["c"].max() < 1e-6 and two.amplitude["a"].max() < 1e-6
    # The first truck alone is stable until the second begins, and the second alone never.
    assert np.all(one.stable[one.speed < 1.199]) and not np.any(two.stable)


def test_branches_that_leave_and_motions_on_known_ones():
    system = system_of("pitchfork", pitchfork, ("x", "y", "z"), displacements=(0, 1, 2))
    # A motion on the branch of broken symmetry, with its mirror image, adds none.
    starts = [(0.3, np.array([1.1, 0.0, sign])) for sign in (1.5, -1.5)]
    found = all_branches(system, (-1.1, 0.5), starts=starts)
    assert [branch.record["begins"].split(" at")[0] for branch in found.branches] == [
        "Hopf point",
        "branch point",
    ]


def test_a_torus_is_not_a_branch_of_cycles():
    system = system_of("Langford", langford, ("x", "y", "z"))
    hopf = min(hopf_points(system, 1.7, 2.2))
    branch = limit_cycles(system, hopf, (0.5, 2.2))
    with pytest.raises(AnalysisError, match="simulate it"):
        switch_branch(system, branch, branch.changes[0])


# -- Isola


@pytest.mark.parametrize("radius", [0.3, 0.8])
def test_isola(radius):
    def rates(states, mu):
        x, y = states.T
        square = x**2 + y**2
        growth = radius**2 - mu**2 - (square - 1.0) ** 2
        return np.stack([growth * x - 3.0 * y, 3.0 * x + growth * y], axis=1)

    system = system_of("isola", rates, ("x", "y"), displacements=(0, 1))
    assert hopf_points(system, -0.95, 0.95) == []
    branch = limit_cycles(system, [np.sqrt(1.0 + radius), 0.0], (-1.5, 1.5), start_speed=0.0)
    assert branch.outcome.ending is Ending.CLOSED
    square = np.sum(branch.states**2, axis=1)
    np.testing.assert_allclose(branch.speed**2 + (square - 1.0) ** 2, radius**2, atol=1e-6)
    assert sorted(float(fold) for fold in branch.folds) == pytest.approx(
        [-radius, radius], abs=1e-5
    )
    # Multiplier exp(-4 r^2 (r^2 - 1) T): stable on the upper half.
    assert np.all(branch.stable[square > 1.01]) and not np.any(branch.stable[square < 0.99])


# -- A stop that is grazed

STIFFNESS, DAMPING, DRIVE, GAP = 20.0, 0.05, 0.8, 1.0


def stopped(states, force):
    """x'' + 2 DAMPING x' + x = force cos(phase) - STIFFNESS (x - GAP)+, the phase by a circle."""
    u, v, x, velocity = states.T
    growth = 1.0 - u**2 - v**2
    stop = STIFFNESS * np.maximum(x - GAP, 0.0)
    return np.stack(
        [
            growth * u - DRIVE * v,
            growth * v + DRIVE * u,
            velocity,
            force * u - 2.0 * DAMPING * velocity - x - stop,
        ],
        axis=1,
    )


def grazing_force():
    return GAP * abs(1.0 - DRIVE**2 + 2j * DAMPING * DRIVE)


def pieces(force):
    """Phases at which the stop is met and left, and the orbit's multipliers, from the linear
    solutions on either side."""
    matrices = [np.array([[0.0, 1.0], [-1.0 - k, -2.0 * DAMPING]]) for k in (0.0, STIFFNESS)]

    def steady(k, phase):
        """Particular solution: force at DRIVE and the stop's constant."""
        part = force / (1.0 + k - DRIVE**2 + 2j * DAMPING * DRIVE) * np.exp(1j * phase)
        return np.array([part.real + k * GAP / (1.0 + k), (1j * DRIVE * part).real])

    def flow(which, start, first, last):
        k = (0.0, STIFFNESS)[which]
        map_ = expm(matrices[which] * (last - first) / DRIVE)
        return map_ @ (start - steady(k, first)) + steady(k, last)

    def closing(unknown):
        met, left, velocity = unknown
        off = flow(1, np.array([GAP, velocity]), met, left)
        back = flow(0, off, left, met + 2.0 * np.pi)
        return [off[0] - GAP, back[0] - GAP, back[1] - velocity]

    amplitude = force / (1.0 - DRIVE**2 + 2j * DAMPING * DRIVE)
    peak = -np.angle(amplitude)
    met, left, _ = fsolve(closing, [peak - 0.3, peak + 0.1, 0.3], xtol=1e-13)
    contact, free = (left - met) / DRIVE, (2.0 * np.pi - left + met) / DRIVE
    return met, left, np.linalg.eigvals(expm(matrices[0] * free) @ expm(matrices[1] * contact))


def test_impact_oscillator_grazes_and_strikes():
    system = system_of("stop", stopped, ("u", "v", "x", "vx"), displacements=(2,))
    graze = grazing_force()
    start = np.array([1.0, 0.0, 0.5, 0.0])
    branch = limit_cycles(system, start, (0.5 * graze, 2.0 * graze), start_speed=0.6 * graze)
    below = branch.speed < graze
    # Linear: the amplitude is the force's response, its peak GAP at the grazing force.
    np.testing.assert_allclose(
        branch.amplitude["x"][below], GAP * branch.speed[below] / graze, rtol=1e-4
    )
    assert np.all(branch.amplitude["x"][~below] < GAP * branch.speed[~below] / graze)
    assert np.count_nonzero(below) > 3 and np.count_nonzero(~below) > 3
    assert branch.trivial_error.max() < 1e-3
    circle = np.exp(-2.0 * 2.0 * np.pi / DRIVE)
    for force, found in zip(branch.speed[~below], branch.multipliers[~below], strict=True):
        if force < 1.1 * graze:
            continue
        expected = np.append(pieces(force)[2], circle)
        order = np.argsort(-np.abs(expected), kind="stable")
        np.testing.assert_allclose(np.abs(found), np.abs(expected[order]), rtol=1e-3, atol=1e-3)


def test_orbits_of_a_branch_lie_on_it_and_those_beside_it_do_not():
    """Cycles of the Hopf normal form, r^2 = mu: between the branch's points, and before its first;
    with other amplitudes at the same speed they lie elsewhere."""

    def rates(x, mu):
        growth = mu - x[0] ** 2 - x[1] ** 2
        return np.array([growth * x[0] - 3.0 * x[1], 3.0 * x[0] + growth * x[1]])

    system = FunctionSystem("normal form", rates, ("y", "v"), (1.0, 1.0))
    (hopf,) = hopf_points(system, -0.5, 0.5)
    branch = limit_cycles(system, hopf, (-0.5, 0.5))
    phases = np.linspace(0.0, 2.0 * np.pi, 121)
    for speed in (1e-3 * branch.speed[0], 0.111, 0.3):
        for size, known in ((1.0, True), (0.9, False), (1.1, False)):
            radius = size * np.sqrt(speed)
            states = radius * np.column_stack([np.cos(phases), np.sin(phases)])
            orbit = orbit_from_samples(states, 2.0 * np.pi / 3.0, speed, 30)
            if speed > branch.speed[0]:
                assert lies_on(system, branch, orbit) is known
            elif known:
                assert lies_on(system, branch, orbit)
    assert is_known(system, [branch], branch) and not is_known(system, [], branch)
