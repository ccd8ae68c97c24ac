"""Small functions of the analyses, each against its own statement worked out by hand."""

from dataclasses import FrozenInstanceError, replace
from types import SimpleNamespace

import numpy as np
import pytest

from exudyn_wheelset import (
    AnalysisError,
    AxleBox,
    CoilNest,
    FrictionWedge,
    FunctionSystem,
    Irregularity,
    LeafSpring,
    LinkSuspension,
    catalogue,
    simulate,
    steady_curve,
)
from exudyn_wheelset.stability.linear.law_checks import PHASES, additivity
from exudyn_wheelset.stability.linear.modes import lateral_shape
from exudyn_wheelset.stability.linear.neutral import neutral_name
from exudyn_wheelset.stability.linear.simulated_growth import mode_start, nearest_row
from exudyn_wheelset.systems.axisymmetry import check_spin, inverse_mass

NAMES = ("front: y [m]", "rear: y [m]", "rear: yaw [rad]", "rear: vy [m/s]")


def test_a_start_in_a_mode_has_its_largest_lateral_displacement_at_the_peak():
    """Of the mode (0.5, 2i, 7, 1) the rear y is the largest; divided by 2i it is 1, real."""
    mode = np.array([0.5, 2.0j, 7.0, 1.0])
    linear = SimpleNamespace(state=np.full(4, 0.25), eigenvectors=np.column_stack([mode, mode * 3]))
    start = mode_start(SimpleNamespace(state_names=NAMES), linear, 1, 1e-3)
    assert start == pytest.approx(0.25 + 1e-3 * np.array([0.0, 1.0, 0.0, 0.0]), abs=1e-12)


def test_the_nearest_oscillation_is_one_that_oscillates():
    """Of a pair the root above the axis; real roots and conjugates are none."""
    values = np.array([-0.1 - 5j, -0.1 + 5j, 3.0, -1.0 + 9j])
    near = SimpleNamespace(eigenvalue=0.2 - 5.2j)
    assert nearest_row(SimpleNamespace(eigenvalues=values), near) == 1
    assert nearest_row(SimpleNamespace(eigenvalues=values), SimpleNamespace(eigenvalue=8j)) == 3


def test_lateral_shapes_are_in_millimetres_and_degrees():
    shape = lateral_shape(NAMES, np.array([1e-3j, 2e-3, -3e-3, 5.0]))
    assert list(shape) == ["front: y", "rear: y", "rear: yaw"]
    assert shape["front: y"] == {"size": pytest.approx(1.0), "phase": pytest.approx(90.0)}
    assert shape["rear: yaw"] == {"size": pytest.approx(3.0), "phase": pytest.approx(180.0)}


def test_a_neutral_mode_strains_one_hold_alone():
    system = SimpleNamespace(
        state_names=("y [m]", "truck: wedge hold [-]", "truck: plate hold [-]")
    )
    alone, both = np.array([0.3, 2.0, 0.16]), np.array([0.3, 0.5, 0.1])
    assert neutral_name(system, 0.0, alone) == "neutral: wedge"
    assert neutral_name(system, 0.0, both) is None
    assert neutral_name(system, 1e-3, alone) is None
    assert neutral_name(SimpleNamespace(state_names=("y [m]",)), 0.0, alone[:1]) is None


@pytest.mark.parametrize("scale", [1.0, 1e-3])
def test_additivity_of_a_corner_by_hand(scale):
    """f = (v, -|y| + y^2): along d the one-sided slope is (d_v, -|d_y|), whatever y^2 does."""
    system = FunctionSystem(
        "corner",
        lambda x, _: [x[1], -abs(x[0]) + x[0] ** 2 / scale],
        ["y [m]", "v [m/s]"],
        [scale, 1.0],
    )
    mode = np.array([scale, 0.5j])

    def slope(d):
        return np.array([d[1] / scale, -abs(d[0])])

    worst = 0.0
    for phase in np.pi * np.arange(PHASES) / PHASES:
        turned = mode * np.exp(1j * phase)
        one, other = slope(turned.real), slope(turned.imag)
        both = slope(turned.real + turned.imag)
        whole = max(np.linalg.norm(part) for part in (one, other, both))
        worst = max(worst, np.linalg.norm(both - one - other) / whole)
    found = additivity(system, np.zeros(2), 20.0, mode)
    # The second-order one-sided difference leaves nothing of y^2.
    assert found == pytest.approx(worst, rel=1e-6)
    smooth = FunctionSystem(
        "smooth", lambda x, _: [x[1], -x[0]], ["y [m]", "v [m/s]"], [scale, 1.0]
    )
    assert additivity(smooth, np.zeros(2), 20.0, mode) < 1e-9


def test_a_steady_curve_sums_its_own_forces():
    """Sum of Y over both wheels; Y/Q with Y on the rail, towards each wheel's field side."""
    curve = steady_curve(catalogue.three_axle_truck(), 1500.0, 0.05, 25.0)
    assert curve.sum_of_y() == pytest.approx(curve.Y.sum(axis=1), rel=1e-12)
    outwards = np.array([-1.0, 1.0]) * curve.Y / curve.Q
    assert curve.guiding_quotient() == pytest.approx(outwards, rel=1e-12)
    with pytest.raises(FrozenInstanceError):
        curve.motion = None


def test_a_run_backwards_needs_an_irregularity_that_begins_early_enough():
    """4 s at -20 m/s from station 30 m: the place 80 m behind its start."""
    truck = catalogue.three_axle_truck()
    rough = Irregularity.from_psd("ERRI B176 low", 1, length=60.0)
    truck = truck.on(replace(truck.track, irregularity=rough))
    front = max(axle.x for axle in truck.wheelsets)
    with pytest.raises(AnalysisError, match=rf"runs back to {30.0 - 80.0 + front:g} m"):
        simulate(truck, -20.0, 4.0, start=30.0)


@pytest.mark.parametrize(
    "element",
    [
        LinkSuspension(3e6, (0.4, 0.3), (0.0, 0.0), leaf_friction=0.0),
        CoilNest((3e6, 2e6, 1e6), FrictionWedge(32.0, 0.0, 50e3, spring=2e6)),
        LeafSpring((3e6, 2e6, 1e6), friction=0.0),
    ],
    ids=lambda element: type(element).__name__,
)
def test_damping_that_is_left_out_is_none(element):
    assert element.damping == (0.0, 0.0, 0.0)


def test_an_axle_box_has_the_damping_that_its_page_says():
    """Stiff bearings of a box would ring for ever: 20 kN s/m along each axis."""
    assert AxleBox().damping == (2.0e4, 2.0e4, 2.0e4)


def test_the_mass_matrix_is_that_of_the_place_of_rest():
    """One coordinate whose mass grows with its place: at rest 4 kg, and not constant."""
    layout = SimpleNamespace(
        position_of=np.array([0]), positions=1, rotations=[],
        reduce=lambda q, v, s: np.zeros((1, 2)), expand=lambda x: (x[:1], x[1:2], x[2:]),
    )  # fmt: skip
    scales, names = np.array([1e-3, 1e-2]), ("y [m]", "vy [m/s]")
    found, constant = inverse_mass(
        "m", layout, scales, names, lambda q: np.array([[4.0 * (1.0 + 100.0 * abs(q[0]))]])
    )
    assert found == pytest.approx(np.array([[0.25]])) and not constant
    found, constant = inverse_mass("m", layout, scales, names, lambda q: np.array([[4.0]]))
    assert found == pytest.approx(np.array([[0.25]])) and constant


def test_a_spinning_body_s_forces_must_not_know_its_angle():
    """One fixed in space is seen turned by the body's axes; one fixed in the body is refused."""
    layout = SimpleNamespace(
        positions=5,
        rotations=[(3, 3, True)],
        expand=lambda x: (np.zeros(6), np.zeros(6), np.zeros(0)),
    )
    names = tuple(f"axle: {what}" for what in ("x", "y", "z", "yaw", "roll"))

    def in_space(q, v, s):
        """Moment (0, 0, 1) in axes that do not turn, in the body's own after a spin of q[4]."""
        return np.array([5.0, 0.0, 0.0, -np.sin(q[4]), 0.0, np.cos(q[4])])

    check_spin("m", layout, np.full(5, 1e-3), names, in_space)
    with pytest.raises(AnalysisError, match="'axle', which spins"):
        check_spin("m", layout, np.full(5, 1e-3), names, lambda q, v, s: np.arange(6.0))
