"""Friction by rail and zone, falling with slip: mu_0 ((1 - A) exp(-B w) + A) and Nadal's limit.

O. Polach, Wear 258 (2005) for the fall; M. J. Nadal, Locomotives a vapeur, 1908, for the limit.
"""

import math

import numpy as np
import pytest
from test_derailment import LOAD, TRACK, WHEELSET, build, run

from exudyn_wheelset import (
    Contact,
    VehicleBuilder,
    WheelsetError,
    catalogue,
    contact_forces,
    contact_geometry,
    creep_force,
    load_vehicle,
    save_vehicle,
    steady_curve,
)
from exudyn_wheelset.contact.friction import frictions
from exudyn_wheelset.results.endings import Ending

SPEED = 20.0
# Both wheels sliding to the left at 8 m/s.
SLIDING = (SPEED, 8.0, 0.0, 0.0, SPEED / WHEELSET.radius, 0.0)


def patches(y=0.0071, **contact):
    """Patches of a wheelset 0.1 mm deep in its rails, its left wheel on tread and flange."""
    rigid = contact_geometry(WHEELSET, TRACK, [y])
    pose = (0.0, y, rigid.z[0] - 1.0e-4, rigid.roll[0], 0.0, 0.0)
    given = {"normal": "hertz", "damping": 0.0, **contact}
    forces = contact_forces(WHEELSET, TRACK, pose, SLIDING, **given)
    return forces.left, forces.right


@pytest.mark.parametrize(
    "law",
    [
        "vermeulen-johnson", "shen-hedrick-elkins", "polach", "polach-2005", "fastsim",
        "exact-table", "polach-kalker",
    ],
)  # fmt: skip
def test_in_full_slip_every_law_gives_the_friction_of_its_slip(law):
    """Creepage is 0.4, far beyond saturation; laws that only tend to mu N are 0.5 % from it."""
    left, right = patches(
        creep=law, friction=0.5, friction_ratio=0.4, friction_decay=0.6, right_friction=0.3
    )
    assert left
    assert right
    for mu, found in ((0.5, left), (0.3, right)):
        for patch in found:
            slip = SPEED * math.hypot(patch.creep_x, patch.creep_y)
            known = mu * (0.6 * math.exp(-0.6 * slip) + 0.4)
            assert patch.friction == pytest.approx(known, rel=1e-12)
            force = math.hypot(patch.fx, patch.fy)
            assert force == pytest.approx(known * patch.normal_force, rel=6e-3)


def test_polach_2005_in_a_contact_knows_its_speed():
    for patch in patches(creep="polach-2005", friction=0.55)[0]:
        known = creep_force(
            "polach-2005", patch.creep_x, patch.creep_y, patch.spin, patch.a, patch.b,
            patch.normal_force, 0.55, Contact.shear_modulus, Contact.poisson, speed=SPEED,
        )  # fmt: skip
        assert (patch.fx, patch.fy, patch.mz) == pytest.approx(known, rel=1e-9)
    with pytest.raises(WheelsetError, match=r"speed = 20\.0 .*leave it out"):
        Contact(creep="polach-2005", speed=20.0)


def test_zones_of_one_friction_are_one_friction_to_the_last_bit():
    one = patches(friction=0.35)
    zones = patches(
        friction=0.35, flange_friction=0.35, top_friction=0.35, right_friction=0.35,
        friction_ratio=1.0, friction_decay=3.0,
    )  # fmt: skip
    assert one == zones


def test_zones_are_told_by_the_contact_angle():
    """Tread of 0.03 rad is top of rail, the flank of 70 degrees flange; ramps join between."""
    given = {"friction": 0.3, "flange_friction": 0.1, "top_friction": 0.2, "right_friction": 0.4}
    left, right = patches(right_flange_friction=0.5, **given)
    flank = max(left, key=lambda patch: patch.angle)
    assert flank.angle > 0.5
    assert flank.friction == 0.1
    assert abs(right[0].angle) < 0.1
    assert right[0].friction == 0.2
    seen = []
    for y in np.linspace(0.003, 0.0073, 87):
        for patch in patches(y, **given)[0]:
            d = abs(patch.angle)
            t, f = np.clip([(d - 0.1) / 0.1, (d - 0.3) / 0.2], 0.0, 1.0)
            t, f = t * t * (3 - 2 * t), f * f * (3 - 2 * f)
            known = 0.2 + 0.1 * t - 0.2 * f
            assert patch.friction == pytest.approx(known, abs=1e-12)
            seen.append(d)
    assert min(seen) < 0.1
    assert max(seen) > 0.5


@pytest.mark.parametrize(
    ("given", "flange", "other"),
    [
        ({"friction": 0.3, "flange_friction": 0.15}, 0.15, 0.3),
        ({"friction": 0.4, "right_friction": 0.2}, 0.4, 0.2),
    ],
)
def test_a_flange_climbs_by_its_own_friction_and_slips_against_the_other_rails(
    given, flange, other
):
    """As test_derailment has it for one friction: push = (Nadal(mu flange) - mu tread) load/2.

    From above, for slip on the flank is never quite full and some of it is along the rail.
    """
    tangent = math.tan(math.radians(70.0))
    limit = ((tangent - flange) / (1.0 + flange * tangent) - other) * 0.5 * LOAD
    model = build(
        push_rate=30e3, yaw=0.06, creep="shen-hedrick-elkins", gravity=0.0, normal="energy",
        damping=5.0, **given,
    )  # fmt: skip
    outcome, _, time = run(model[1], 4.0)
    assert outcome.ending is Ending.WHEEL_CLIMB
    assert limit < 30e3 * time < 1.1 * limit


def test_a_greased_flange_in_a_curve_rubs_and_wears_less():
    """Coach in R = 300 m: the outer flange, in full slip, holds mu N of its own friction."""
    coach = catalogue.vehicle("manchester_coach")
    greased = coach.replace("contact.flange_friction", 0.1)
    dry, wet = (steady_curve(one, 300.0, 0.1, 18.0) for one in (coach, greased))
    for curve, mu in ((dry, 0.3), (wet, 0.1)):
        (flange,) = (p for p in curve.patches["front leading", "right"] if abs(p.angle) > 0.5)
        assert flange.friction == mu
        assert curve.friction_use()["front leading", "right"][-1] <= 1.0 + 1e-9
        force = math.hypot(flange.fx, flange.fy)
        assert 0.9 * mu * flange.normal_force < force <= mu * flange.normal_force * (1 + 1e-9)
    assert wet.wear_number()[0, 1] < 0.6 * dry.wear_number()[0, 1]
    others = [p for p in wet.patches["front leading", "left"] if abs(p.angle) < 0.3]
    assert others
    assert all(patch.friction == 0.3 for patch in others)


def test_mirrored_contacts_and_vehicle_files_keep_zones(tmp_path):
    contact = Contact(
        friction=0.4, right_friction=0.3, flange_friction=0.15, right_top_friction=0.2,
        friction_ratio=0.5, friction_decay=0.7,
    )  # fmt: skip
    assert frictions(contact).tolist() == [[0.4, 0.15, 0.4], [0.3, 0.15, 0.2]]
    assert frictions(contact.mirrored()).tolist() == [[0.3, 0.15, 0.2], [0.4, 0.15, 0.4]]
    builder = VehicleBuilder("wheelset", TRACK, contact)
    builder.wheelset("axle", WHEELSET, 0.0)
    vehicle = builder.finish()
    save_vehicle(vehicle, tmp_path / "one.toml")
    assert load_vehicle(tmp_path / "one.toml").contact == contact


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"flange_friction": -0.1}, r"flange_friction = -0\.1"),
        ({"top_friction": "dry"}, "top_friction = 'dry' is no number"),
        ({"friction_ratio": 1.5, "friction_decay": 0.6}, r"friction_ratio = 1\.5.*from 0 to 1"),
        ({"friction_ratio": 0.4}, "give both"),
        ({"flang_friction": 0.1}, "did you mean 'flange_friction'"),
    ],
)
def test_impossible_frictions_are_refused(given, words):
    with pytest.raises(WheelsetError, match=words):
        Contact(**given)
