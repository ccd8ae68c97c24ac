"""Friction under cyclic motion against the closed form of its law, "elastic, then slipping".

F' = k (v - |v| F/F_slip) has, over the amplitude A, the loop 4 F_slip A - 4 (F_slip^2/k)
tanh(k A/F_slip) and the largest force F_slip tanh(k A/F_slip): derived in
vehicles/elements/friction_damper.py. Asked to 1 %, at any step and any frequency.
"""

from __future__ import annotations

import numpy as np
import pytest
from driven_element import DrivenElement, along, oscillation, ramp

from exudyn_wheelset import CentrePlate, FrictionDamper, FrictionWedge, SideBearer, WheelsetError

FORCE, STIFFNESS = 8.0e3, 2.0e7
PRESLIDING = 2.5e-4


def loop(element, axis, amplitude, frequency, step, preload=(0.0,) * 6):
    """Work [J] over one cycle of what is left after the first, and the largest force [N]."""
    driven = DrivenElement(element, preload)
    per_cycle = round(1.0 / (frequency * step))
    times = np.arange(2 * per_cycle + 1) / (frequency * per_cycle)
    motion = oscillation(axis, amplitude, frequency)
    forces = driven.drive(motion, times)[per_cycle:, axis]
    rates = np.array([motion(t)[1][axis] for t in times[per_cycle:]])
    # The rule of trapezia is at its best over a whole period.
    work = -float(np.sum((forces * rates)[1:])) / (frequency * per_cycle)
    return work, float(np.abs(forces).max())


def closed_form(slip, stiffness, amplitude):
    """Work and largest force of a cycle."""
    reached = np.tanh(stiffness * amplitude / slip)
    return 4.0 * slip * amplitude - 4.0 * slip**2 / stiffness * reached, slip * reached


@pytest.mark.parametrize("amplitude", [2e-4, 4e-4, 2e-3, 8e-3])
@pytest.mark.parametrize(
    ("frequency", "step"), [(0.5, 1e-3), (2.0, 1e-3), (8.0, 1e-3), (8.0, 1e-4), (20.0, 1e-4)]
)
def test_loop_of_a_friction_damper(amplitude, step, frequency):
    element = FrictionDamper((0, 1, 0), force=FORCE, stiffness=STIFFNESS)
    work, force = loop(element, 1, amplitude, frequency, step)
    expected_work, expected_force = closed_form(FORCE, STIFFNESS, amplitude)
    assert work == pytest.approx(expected_work, rel=0.01)
    assert force == pytest.approx(expected_force, rel=0.01)


@pytest.mark.parametrize(
    ("element", "axis", "preload", "slip"),
    [
        # The column's force stays in lateral motion: mu N.
        (FrictionWedge(32.0, 0.4, 2.0e4, spring=6e5), 1, 0.0, 8.0e3),
        (CentrePlate(radius=0.178, friction=0.3, play=0.02), 1, 3.0e5, 9.0e4),
        (SideBearer(gap=0.0, stiffness=2e7, friction=0.3, force=3e4), 0, 0.0, 9.0e3),
    ],
)
@pytest.mark.parametrize("frequency", [0.5, 2.0])
def test_loop_of_a_loaded_element(element, axis, preload, slip, frequency):
    """At a constant load k = mu N/presliding; the hold's own damping stays below the 1 %."""
    work, force = loop(element, axis, 2e-3, frequency, 2e-4, (0, 0, preload, 0, 0, 0))
    expected_work, expected_force = closed_form(slip, slip / PRESLIDING, 2e-3)
    assert work == pytest.approx(expected_work, rel=0.01)
    assert force == pytest.approx(expected_force, rel=0.01)


def test_a_coupled_contact_slips_on_a_circle():
    """Whatever the direction in the plane: same force, against the motion."""
    plate = DrivenElement(CentrePlate(radius=0.178, friction=0.3, play=0.05), (0, 0, 3e5, 0, 0, 0))
    for angle in (0.3, 1.1, 2.5):
        plate.holds[:] = 0.0
        c, s = np.cos(angle), np.sin(angle)

        def motion(t, c=c, s=s):
            place, rate = np.zeros(6), np.zeros(6)
            place[:2], rate[:2] = [0.01 * c * t, 0.01 * s * t], [0.01 * c, 0.01 * s]
            return place, rate

        forces = plate.drive(motion, np.linspace(0.0, 0.5, 501))[-1]
        assert forces[:2] == pytest.approx([-9e4 * c, -9e4 * s], abs=1e-3 * 9e4)


def test_motion_after_a_turn_leaves_the_old_direction_over_the_presliding():
    """From full slip along x, motion along y: h_y' = (1 - h_y)/delta, h_x' = -h_x/delta."""
    plate = DrivenElement(
        CentrePlate(radius=0.178, friction=0.3, play=0.05, damping_time=0.0), (0, 0, 3e5, 0, 0, 0)
    )
    plate.holds[:] = 1.0, 0.0, 0.0
    plate.drive(ramp(1, 0.01), np.linspace(0.0, 0.05, 501))
    way = 0.01 * 0.05 / PRESLIDING
    assert plate.holds == pytest.approx([np.exp(-way), 1.0 - np.exp(-way), 0.0], abs=1e-6)


def test_statics_take_the_hold_of_a_straight_way():
    """The closed form of statics is what RK4 finds on the way there."""
    for element, place in (
        (FrictionDamper((0, 1, 0), FORCE, STIFFNESS), (0, 3e-4, 0, 0, 0, 0)),
        (FrictionWedge(32.0, 0.4, 2e4, spring=6e5), (0, 2e-4, -1e-4, 0, 0, 0)),
        (CentrePlate(0.178, 0.3), (1e-4, 2e-4, 0, 0, 0, 2e-3)),
    ):
        driven = DrivenElement(element)
        place = np.array(place)
        driven.drive(lambda t, place=place: (place * t, place), np.linspace(0.0, 1.0, 201))
        assert driven.holds == pytest.approx(driven.held_after(place), abs=1e-8)


def test_no_rate_no_change_of_the_hold():
    """The kink of |v| is left: what stands still keeps its force, to the last digit."""
    driven = DrivenElement(FrictionDamper((0, 1, 0), FORCE, STIFFNESS))
    driven.holds[:] = 0.7
    force, rates = driven.force(*along(1, 0.0, 0.0))
    assert rates[0] == 0.0
    assert force[1] == pytest.approx(-0.7 * FORCE, rel=1e-14)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: FrictionDamper((0, 1, 0), -1.0, 1e6), "force = -1"),
        (lambda: FrictionDamper((0, 1, 0), 1e3, 0.0), "positive"),
        (lambda: FrictionWedge(0.5, 0.4, 2e4), "in degrees"),
        (lambda: FrictionWedge(20.0, 0.4, 2e4, slope_friction=0.0), "locks"),
        (lambda: FrictionWedge(32.0, -0.1, 2e4), "not negative"),
        (lambda: SideBearer(6e-3, 2e7, 0.3, force=1e3), "gap=0"),
        (lambda: CentrePlate(178.0, 0.3), "metres"),
    ],
)
def test_what_no_friction_is_is_refused(make, said):
    with pytest.raises(WheelsetError, match=said):
        make()
