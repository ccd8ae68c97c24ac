"""Wedge, centre plate, side bearer, leaf spring, links against the statics of their faces.

The wedge's forces come from its two equations of equilibrium, solved here as a linear system; the
plate's from sums over its face; both over quasi-static motion of millimetres.
"""

from __future__ import annotations

import numpy as np
import pytest
from driven_element import DrivenElement, along, ramp

from exudyn_wheelset import (
    CentrePlate,
    CoilNest,
    FrictionWedge,
    LeafSpring,
    LinkSuspension,
    SideBearer,
)

SLOW = np.linspace(0.0, 1.0, 1001)


def wedge_by_newton(angle, friction, slope_friction, spring_force, loading):
    """Forces [N] of a wedge without mass: of the column (normal, friction on the wedge, up).

    Unknown are the normal forces of slope and column. The wedge narrows upward, its slope faces the
    bolster above; the bolster's normal force on it points to the column and down. In loading the
    wedge slides down the column, whose friction points up, and tends up into its pocket, so that
    the slope's friction points down along the slope; in unloading both are reversed.
    """
    a = np.radians(angle)
    normal, down = np.array([np.cos(a), -np.sin(a)]), np.array([-np.sin(a), -np.cos(a)])
    sign = 1.0 if loading else -1.0
    slope = normal + sign * slope_friction * down
    column = np.array([-1.0, sign * friction])
    _, pressed = np.linalg.solve(np.column_stack([slope, column]), [0.0, -spring_force])
    return pressed, sign * friction * pressed


@pytest.mark.parametrize("angle", [28.0, 32.0, 45.0])
@pytest.mark.parametrize("friction", [0.2, 0.4])
@pytest.mark.parametrize("slope_friction", [None, 0.1])
@pytest.mark.parametrize("spring", [0.0, 6e5])
def test_wedge_loading_and_unloading(angle, friction, slope_friction, spring):
    wedge = FrictionWedge(angle, friction, 2.0e4, spring=spring, slope_friction=slope_friction)
    start = 2.0e4 * np.tan(np.radians(angle))
    for speed in (-5e-3, 5e-3):
        driven = DrivenElement(wedge)
        force = driven.drive(ramp(2, speed), SLOW)[-1, 2]
        spring_force = start - spring * speed
        slope = friction if slope_friction is None else slope_friction
        loading = speed < 0.0
        _, rubbing = wedge_by_newton(angle, friction, slope, spring_force, loading)
        carried = spring_force if spring else 0.0
        assert force - carried == pytest.approx(rubbing, rel=0.01)
        slip = wedge.slip_forces(-speed)[0 if loading else 1]
        assert slip == pytest.approx(abs(rubbing), rel=1e-9)


def test_wedge_against_the_patent_of_its_kind():
    """Column friction of a pair of wedges going down, US patent 6269752:

    2 mu_1 P (cos t - mu_2 sin t)/(-mu_1 cos t + mu_1 mu_2 sin t + mu_2 cos t + sin t).
    """
    t, column, slope = np.radians(37.5), 0.45, 0.2
    wedge = FrictionWedge(37.5, column, 1.0e4, slope_friction=slope)
    top = 2.0 * column * wedge.spring_force * (np.cos(t) - slope * np.sin(t))
    below = -column * np.cos(t) + column * slope * np.sin(t) + slope * np.cos(t) + np.sin(t)
    assert 2.0 * wedge.slip_forces()[0] == pytest.approx(top / below, rel=1e-12)


def test_wedge_lifts_off_with_its_spring():
    """Unloaded by more than its compression the spring presses no more: no force at all."""
    driven = DrivenElement(FrictionWedge(32.0, 0.4, 2.0e4, spring=6e5))
    lifted = 2.0e4 * np.tan(np.radians(32.0)) / 6e5
    assert driven.drive(ramp(2, 1.2 * lifted), SLOW)[-1] == pytest.approx(np.zeros(6), abs=1e-9)


def test_column_force_at_any_hold_balances_the_wedge():
    """At part of the friction on both faces: S + mu h N = R sin(a + atan(mu_s h)), N its cosine."""
    driven = DrivenElement(FrictionWedge(32.0, 0.4, 2.0e4))
    for hold in (-0.8, -0.3, 0.0, 0.5):
        driven.holds[:] = 0.0, hold
        rubbing = -driven.force(*along(2, 0.0, 0.0))[0][2]
        loading, spring_force = -hold, 2.0e4 * np.tan(np.radians(32.0))
        normal = spring_force / (
            np.tan(np.radians(32.0) + np.arctan(0.4 * loading)) - 0.4 * loading
        )
        assert rubbing == pytest.approx(0.4 * hold * normal, rel=1e-12)


@pytest.mark.parametrize("load", [3.0e4, 3.9e5])
def test_centre_plate_turns_against_two_thirds_mu_n_r(load):
    plate = DrivenElement(CentrePlate(radius=0.178, friction=0.3), (0, 0, load, 0, 0, 0))
    moment = plate.drive(ramp(5, 0.03), SLOW)[-1, 5]
    assert moment == pytest.approx(-2.0 / 3.0 * 0.3 * load * 0.178, rel=0.01)


def test_turning_moment_of_uniform_pressure_over_the_face():
    """The sum of mu p r over the face is 2/3 mu N R, which the element's row of yaw has."""
    radius = 0.178
    middle = (np.arange(400) + 0.5) / 400 * radius
    rings = 2.0 * np.pi * middle * radius / 400
    pressure = 1.0 / (np.pi * radius**2)
    assert np.sum(0.3 * pressure * middle * rings) == pytest.approx(0.2 * radius, rel=1e-5)


def plate_by_points(sink, tilt, radius, stiffness, count=700):
    """Force and moments (Mx, My) of a bed that only pushes, by a sum over points of a disc."""
    grid = (np.arange(count) + 0.5) / count * 2.0 - 1.0
    x, y = (radius * v.ravel() for v in np.meshgrid(grid, grid))
    inside = x**2 + y**2 < radius**2
    x, y = x[inside], y[inside]
    pressed = stiffness / len(x) * np.maximum(0.0, sink + tilt[1] * x - tilt[0] * y)
    return pressed.sum(), (y * pressed).sum(), (-x * pressed).sum()


@pytest.mark.parametrize("tilt", [(1e-4, 0.0), (2e-3, -1e-3), (0.0, 6e-3), (-3e-2, 1e-2)])
def test_plate_rocks_and_lifts_as_a_bed_that_only_pushes(tilt):
    load, radius = 3.9e5, 0.178
    element = CentrePlate(radius=radius, friction=0.0)
    plate = DrivenElement(element, (0, 0, load, 0, 0, 0))
    for sink in (0.0, -2e-4, 1e-4):
        place = np.array([0.0, 0.0, sink, *tilt, 0.0])
        force = plate.force(place, np.zeros(6))[0]
        total = load / element.stiffness - sink
        expected = plate_by_points(total, tilt, radius, element.stiffness)
        assert force[2:5] == pytest.approx(expected, rel=2e-3, abs=2e-3 * load * radius)
    # Rocking on the edge: never more than N R.
    moment = np.hypot(*plate.force(np.array([0, 0, 0, *tilt, 0.0]), np.zeros(6))[0][3:5])
    force = plate.force(np.array([0, 0, 0, *tilt, 0.0]), np.zeros(6))[0][2]
    assert moment <= force * radius


def test_plate_lifts_off():
    plate = DrivenElement(CentrePlate(radius=0.178, friction=0.3), (0, 0, 3e5, 0, 0, 0))
    assert plate.force(*along(2, 4e-4, 0.0))[0] == pytest.approx(np.zeros(6), abs=1e-9)


def test_rim_of_the_bowl_stops_after_its_play():
    element = CentrePlate(radius=0.178, friction=0.0, play=3e-3, stop=5e7)
    plate = DrivenElement(element, (0, 0, 3e5, 0, 0, 0))
    places = np.linspace(0.0, 8e-3, 801)
    force = np.array([-plate.force(*along(1, y, 0.0))[0][1] for y in places])
    assert np.all(force[places < 2.999e-3] == 0.0)
    assert np.all(np.diff(force[places > 3e-3]) > 0.0)
    # Neither force nor slope jumps: a step changes the slope by no more than stop/onset allows.
    assert np.abs(np.diff(force, 2)).max() < 1.01 * 5e7 / 1.5e-3 * 1e-5**2
    assert np.diff(force)[-1] == pytest.approx(5e7 * 1e-5, rel=1e-6)


def test_side_bearer_closes_its_gap_without_a_jump():
    bearer = DrivenElement(SideBearer(gap=6e-3, stiffness=2e7, friction=0.3))
    sinking = np.linspace(0.0, 9e-3, 901)
    force = np.array([bearer.force(*along(2, -z, 0.0))[0][2] for z in sinking])
    assert np.all(force[sinking < 5.999e-3] == 0.0)
    assert np.all(np.diff(force) >= 0.0)
    assert np.abs(np.diff(force, 2)).max() < 1.01 * 2e7 / 6e-4 * 1e-5**2
    assert force[-1] == pytest.approx(2e7 * (3e-3 - 3e-4), rel=1e-6)

    def sliding(t):
        place, rate = along(0, 5e-3 * t, 5e-3)
        place[2] = -9e-3
        return place, rate

    assert bearer.drive(sliding, SLOW)[-1, 0] == pytest.approx(-0.3 * force[-1], rel=1e-3)


def test_leaf_spring_between_its_two_lines():
    """Loaded slowly k c (1 + e), unloaded k c (1 - e)."""
    leaf = LeafSpring((0.0, 0.0, 1.0e6), friction=0.08)
    for speed, sign in ((-0.02, 1.0), (0.02, -1.0)):
        driven = DrivenElement(leaf, (0, 0, 6e4, 0, 0, 0))
        force = driven.drive(ramp(2, speed), SLOW)[-1, 2]
        assert force == pytest.approx((6e4 - 1e6 * speed) * (1.0 + 0.08 * sign), rel=1e-3)


def test_links_are_pendulums_with_friction():
    """N/L beside the slip force of the links; the swung body rises, as on a pendulum."""
    element = LinkSuspension(1.0e6, length=(0.4, 0.25), friction=(0.03, 0.02), leaf_friction=0.0)
    load = 6.0e4
    for axis, length, friction in ((0, 0.4, 0.03), (1, 0.25, 0.02)):
        driven = DrivenElement(element, (0, 0, load, 0, 0, 0))
        forces = driven.drive(ramp(axis, 0.02), SLOW)[-1]
        deeper = 0.02**2 / (2.0 * length)
        carried = load + 1.0e6 * deeper
        assert forces[2] == pytest.approx(carried, rel=1e-6)
        assert -forces[axis] == pytest.approx(carried * (0.02 / length + friction), rel=1e-3)
        # A body that keeps its load rises by L (1 - cos) of the swing, to second order.
        assert deeper == pytest.approx(length * (1.0 - np.cos(0.02 / length)), rel=2e-3)


@pytest.mark.parametrize(
    "element",
    [
        CentrePlate(0.178, 0.0, play=1e-3),
        SideBearer(1e-3, 2e7, 0.0),
        LinkSuspension(1e6, (0.4, 0.25), (0.0, 0.0), leaf_friction=0.0),
        FrictionWedge(32.0, 0.0, 2e4, spring=6e5),
    ],
)
def test_pressures_are_derivatives_of_their_potential(element):
    """Without friction: force on the body = -dU, with gaps that open and close."""
    driven = DrivenElement(
        element, (0, 0, 1e5, 0, 0, 0) if element.static_stiffness()[2, 2] else (0,) * 6
    )
    random = np.random.default_rng(5)
    for _ in range(20):
        place = random.uniform(-1.0, 1.0, 6) * [2e-3, 2e-3, 2e-3, 0.0, 0.0, 0.0]
        force = driven.force(place, np.zeros(6))[0]
        for axis in range(3):
            small = along(axis, 1e-8, 0.0)[0]
            energies = []
            for sign in (1.0, -1.0):
                driven.force(place + sign * small, np.zeros(6))
                energies.append(driven.energy)
            slope = (energies[0] - energies[1]) / 2e-8
            assert force[axis] == pytest.approx(-slope, rel=1e-4, abs=1.0)


def test_links_stay_plumb_below_a_body_that_rolls():
    """Turned about the ends of its links the body feels its load along the vertical, no more."""
    element = LinkSuspension(1.0e6, length=(0.4, 0.25), friction=(0.03, 0.02))
    driven = DrivenElement(element, (0, 0, 6e4, 0, 0, 0))
    rolled = driven.force(*along(3, 0.05, 0.0))[0]
    assert rolled == pytest.approx([0, 0, 6e4, 0, 0, 0], abs=1e-6)


def test_coil_nest_is_its_coils_and_two_wedges():
    """One part: the coils' stiffness, twice the wedges' slip force, and a moment against warp."""
    wedge = FrictionWedge(32.0, 0.4, 2.0e4)
    driven = DrivenElement(CoilNest((1.8e6, 1.8e6, 4.2e6), wedge, spacing=0.4))
    down = driven.drive(ramp(2, -5e-3), SLOW)[-1, 2]
    assert down == pytest.approx(4.2e6 * 5e-3 + 2.0 * wedge.slip_forces()[0], rel=1e-6)
    driven = DrivenElement(CoilNest((1.8e6, 1.8e6, 4.2e6), wedge, spacing=0.4))
    warp = driven.drive(ramp(5, 0.02), SLOW)[-1, 5]
    assert warp == pytest.approx(-2.0 * 0.2 * 0.4 * 2.0e4, rel=1e-3)
