"""Parts of the continuation alone: corners of a known orbit, meshes, multipliers, lowest speeds."""

from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pytest

from exudyn_wheelset import FunctionSystem
from exudyn_wheelset.results.columns import NamedColumns
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.stability.hunting.branch import Branch, Fold, StabilityChange
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.corners import corners_of, mesh_on, rotated
from exudyn_wheelset.stability.hunting.floquet import floquet_multipliers
from exudyn_wheelset.stability.hunting.orbit import balanced_mesh, orbit_from_samples

STIFF = 10.0


def circle(intervals=12, degree=4, period=2.0 * np.pi):
    """x = sin, v = cos: no orbit of the equations below, but corners are those along it."""
    phases = np.linspace(0.0, 2.0 * np.pi, intervals * degree + 1)
    states = np.column_stack([np.sin(phases), np.cos(phases)])
    return orbit_from_samples(states, period, 1.0, intervals, degree)


def oscillator(force):
    return FunctionSystem(
        "o", lambda x, _: [x[1], -x[0] - force(x[0])], ["y [m]", "v [m/s]"], [1, 1]
    )


@pytest.mark.parametrize("gap", [0.3, 0.5])
def test_a_flange_spring_has_its_corners_where_the_orbit_passes_its_gap(gap):
    """sin(2 pi phase) = gap twice, found by halving one in a hundred of the orbit 12 times."""
    system = oscillator(lambda x: STIFF * max(x - gap, 0.0))
    equations, orbit = Collocation(system, 2.0 * np.pi, 1.0), circle()
    found = corners_of(equations, orbit, equations.gradients(orbit))
    first = np.arcsin(gap) / (2.0 * np.pi)
    np.testing.assert_allclose(found, [first, 0.5 - first], atol=1e-4)


def test_a_steep_but_smooth_spring_has_none():
    system = oscillator(lambda x: STIFF * 0.05 * np.logaddexp(0.0, (x - 0.4) / 0.05))
    equations, orbit = Collocation(system, 2.0 * np.pi, 1.0), circle()
    assert len(corners_of(equations, orbit, equations.gradients(orbit))) == 0


def test_a_mesh_has_a_point_on_each_corner_and_none_close_to_it():
    base, corners = np.linspace(0.0, 1.0, 11), np.array([0.2003, 0.55])
    mesh = mesh_on(base, corners)
    assert set(corners) <= set(mesh) and 0.2 not in mesh
    assert mesh[0] == 0.0 and mesh[-1] == 1.0
    # Of 0.1 wide intervals a fifth stays free about a corner.
    assert np.diff(mesh).min() > 0.2 * 0.1


def test_a_rotated_orbit_begins_in_the_widest_piece_without_a_corner():
    """Corners at 0.1 and 0.3: the widest piece is from 0.3 to 1.1, its middle 0.7."""
    orbit = rotated(circle(), np.array([0.1, 0.3]))
    # Interpolation of a sine by polynomials of degree 4 on twelve intervals.
    assert orbit.states[0] == pytest.approx([np.sin(1.4 * np.pi), np.cos(1.4 * np.pi)], abs=1e-4)


def test_a_balanced_mesh_is_even_where_nothing_varies_and_dense_where_much_does():
    still = circle()
    still.states[:] = 1.0
    np.testing.assert_allclose(balanced_mesh(still, np.ones(2)), np.linspace(0, 1, 13), atol=1e-12)
    phases = np.linspace(0.0, 1.0, 49)
    peak = np.exp(-(((phases - 0.5) / 0.05) ** 2))
    steep = orbit_from_samples(np.column_stack([peak, 0 * peak]), 1.0, 1.0, 12, 4)
    widths = np.diff(balanced_mesh(steep, np.ones(2)))
    assert widths[4:8].max() < 0.7 * widths[[0, 1, -2, -1]].min()
    # Which unit the motion is in does not matter.
    small = orbit_from_samples(np.column_stack([1e-6 * peak, 0 * peak]), 1.0, 1.0, 12, 4)
    np.testing.assert_allclose(np.diff(balanced_mesh(small, np.ones(2))), widths, rtol=1e-9)


def named(*names, wheelsets=()):
    return SimpleNamespace(state_names=names, wheelset_names=wheelsets, scales=np.ones(len(names)))


def test_multipliers_without_the_trivial_one_and_without_what_is_free_along_the_track():
    """x along the track does not matter to a wheelset: a second multiplier 1, left out and counted.

    The others, 0.5 and -0.2, stay as they are; the direction of motion is the first one.
    """
    values = np.array([1.0, 1.0, 0.5, -0.2])
    names = ("axle: y [m]", "axle: x [m]", "axle: yaw [rad]", "axle: vy [m/s]")
    along = np.array([1.0, 0.0, 0.0, 0.0])
    system = named(*names, wheelsets=("axle",))
    found = floquet_multipliers(np.diag(values), along, system)
    assert found.values.real == pytest.approx([0.5, -0.2]) and found.neutral == 1
    assert found.error < 1e-12 and found.stable(1e-5) is True
    # A system that knows no wheelsets has no track to be free along.
    plain = floquet_multipliers(np.diag(values), along, named(*names))
    assert plain.values.real == pytest.approx([1.0, 0.5, -0.2]) and plain.neutral == 0
    wild = floquet_multipliers(np.diag([1.0, 0.3, 1.4, -0.2]), along, system)
    assert wild.stable(1e-5) is False


def branch(speeds, stable, folds=(), changes=(), hopf=None):
    count = len(speeds)
    empty = np.zeros(count)
    orbits = [circle()] * count
    return Branch(
        np.array(speeds), empty + 1.0, NamedColumns(np.ones((count, 1)), ["y [m]"]),
        np.array(stable), np.zeros(count, dtype=bool), np.zeros((count, 1)), empty, list(folds),
        list(changes), hopf, Outcome(Ending.UPPER_END), orbits,
    )  # fmt: skip


def test_the_lowest_stable_speed_is_a_fold_or_a_change_of_stability_that_counts():
    speeds, stable = [50.0, 48.0, 46.0, 47.0, 49.0], [False, False, False, True, True]
    fold = Fold(45.9, {}, 0.2, 2, "lowest")
    assert branch(speeds, stable, [fold]).lowest_stable()[0] == 45.9
    assert branch(speeds, stable).lowest_stable()[0] == 47.0
    torus = StabilityChange(46.5, "torus", 3)
    found = branch(speeds, stable, [], [torus]).lowest_stable()
    assert found == (46.5, "a torus of the limit cycle")
    # Beside a cycle that is too small to count neither a fold nor a change counts.
    large = [True, True, False, False, True]
    assert branch(speeds, stable, [fold], [torus]).lowest_stable(large)[0] == 49.0
    # A change above the lowest stable cycle is not the lowest speed.
    above = StabilityChange(48.0, "torus", 4)
    assert branch(speeds, stable, [], [above]).lowest_stable()[0] == 47.0
    # Where one unstable cycle becomes another of more unstable multipliers, none is stable.
    unstable = StabilityChange(46.2, "branch point", 2)
    assert branch(speeds, stable, [], [unstable]).lowest_stable()[0] == 47.0


def test_a_fold_whose_neighbours_are_uncertain_goes_by_the_orbits_further_on():
    """Near a fold a multiplier is near 1, and its error may hide on which side of 1 it lies."""
    speeds = [50.0, 48.0, 46.0, 46.1, 47.0, 49.0]
    fold = Fold(45.9, {}, 0.2, 2, "lowest")
    for beyond, lowest in ((True, 45.9), (False, 49.0)):
        found = branch(speeds, [False, False, False, False, beyond, True], [fold])
        found.uncertain[3] = True
        assert found.lowest_stable()[0] == lowest
    # Beyond another fold things are otherwise.
    another = Fold(46.1, {}, 0.2, 3, "highest")
    found = branch(speeds, [False, False, False, False, True, True], [fold, another])
    found.uncertain[3] = True
    assert found.lowest_stable()[0] == 47.0


def test_a_supercritical_branch_begins_at_its_hopf_point():
    found = branch([40.0, 41.0], [True, True], hopf=(39.99, 1.0)).lowest_stable()
    assert found == (39.99, "the Hopf point, which is supercritical")


def test_a_drawn_branch_tells_uncertain_orbits_from_unstable_ones():
    """Stable solid, unstable dashed, uncertain dash-dotted with a word in the legend."""
    found = branch([40.0, 41.0, 42.0, 43.0, 44.0], [True, True, False, False, False])
    found.uncertain[3] = True
    assert [found.stability_after(k) for k in range(4)] == [True, False, None, None]
    axes = found.plot()
    pieces = {
        line.get_linestyle(): line.get_xdata() for line in axes.lines if len(line.get_xdata())
    }
    assert pieces["-"].tolist() == [40.0, 41.0]
    assert pieces["--"].tolist() == [41.0, 42.0]
    assert pieces["-."].tolist() == [42.0, 43.0, 44.0]
    assert axes.get_legend_handles_labels()[1] == ["stability uncertain"]
    plt.close(axes.figure)
