"""Piecewise contact geometry judged where it was not fitted; the search behind it by brute force.

Nothing here knows how the pieces were made: at random shifts, and close beside every jump, the
deviation from the contact search is at most the residual stated for that piece, and the residual is
within the tolerance asked for. The search itself must be the function that the definition says: the
least vertical distance of all points, and the first roll angle, from the centre outwards, at which
both sides agree (section 2.2 of the paper; a steep flange may agree at several).
"""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
from shared_reference import reference_folder

from exudyn_wheelset import Profile, Track, Wheelset, contact_geometry, piecewise_geometry
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.layout import side_of
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.errors import WheelsetWarning
from exudyn_wheelset.geometry.gap import gap_difference, least_gap
from exudyn_wheelset.geometry.piecewise import TOLERANCE_FACTORS, geometry_columns
from exudyn_wheelset.profiles import load_profile

REFERENCE = reference_folder()
TOLERANCE = 2.0e-6
MEASURED = [("worn7216.prw", "siteb.prr"), ("worn7813.prw", "siteb.prr"), ("worn7216.prw", "UIC60")]
PAIRS = [("S1002", "UIC60"), ("AAR_1_20", "UIC60"), ("hollow", "UIC60"), *MEASURED]


def hollow_wheel() -> Profile:
    """S1002 with 1.5 mm worn off the tread about y = 2 mm and 0.8 mm off the throat."""
    new = load_profile("S1002")
    y = new.y
    worn = 1.5e-3 * np.exp(-(((y - 2e-3) / 14e-3) ** 2))
    worn += 0.8e-3 * np.exp(-(((y + 33e-3) / 5e-3) ** 2))
    return Profile("hollow", "wheel", y, new.z + worn)


def profile(name: str) -> Profile:
    if name == "hollow":
        return hollow_wheel()
    if "." not in name:
        return load_profile(name)
    path = REFERENCE / "profiles" / name
    if not path.is_file():
        pytest.skip("measured profiles not found: set EXUDYN_WHEELSET_REFERENCE")
    return load_profile(path)


def pair(wheel: str, rail: str) -> tuple[Wheelset, Track, float]:
    """Wheelset, track and half range [m]; the paper's gauge and radius for its wheel."""
    paper = wheel == "AAR_1_20"
    wheelset = Wheelset(1.0e3, (600.0, 100.0, 600.0), 0.3556 if paper else 0.46, profile(wheel))
    inclination = 0.0 if rail.endswith(".prr") else 1.0 / 40.0
    track = Track(profile(rail), 1.432 if paper else 1.435, inclination=inclination)
    return wheelset, track, 0.012 if paper else 0.008


@pytest.mark.parametrize("representation", ["polynomial", "cubic"])
@pytest.mark.parametrize(("wheel", "rail"), PAIRS)
def test_stated_residual_holds_between_the_samples(wheel, rail, representation) -> None:
    wheelset, track, half_range = pair(wheel, rail)
    pieces = piecewise_geometry(
        wheelset, track, half_range, representation=representation, tolerance=TOLERANCE
    )
    # The contact search itself ends within 1e-12 m and 1e-13 rad; angles are slopes of that.
    rounding = 1.0e-10
    assert np.all(pieces.residuals <= TOLERANCE * TOLERANCE_FACTORS + rounding)

    random = np.random.default_rng(20).uniform(-half_range, half_range, 2500)
    beside = pieces.jumps[:, None] + np.outer([-1, 1], [1e-10, 1e-9, 1e-8, 1e-7]).ravel()
    y = np.concatenate([random, beside.ravel()])
    miss = np.abs(pieces(y) - geometry_columns(contact_geometry(wheelset, track, y)))
    piece = np.searchsorted(pieces.breaks, y, side="right") - 1
    assert np.all(miss <= pieces.residuals[piece] + rounding)


@pytest.mark.parametrize(("wheel", "rail"), PAIRS[:2])
def test_a_finer_tolerance_takes_more_pieces_and_is_met(wheel, rail) -> None:
    wheelset, track, half_range = pair(wheel, rail)
    coarse, fine = (
        piecewise_geometry(
            wheelset, track, half_range, representation="polynomial", tolerance=tolerance
        )
        for tolerance in (1.0e-4, 1.0e-7)
    )
    assert len(coarse.degrees) < len(fine.degrees)
    y = np.random.default_rng(21).uniform(-half_range, half_range, 2000)
    miss = np.abs(fine(y) - geometry_columns(contact_geometry(wheelset, track, y)))
    assert np.all(miss <= 1.0e-7 * TOLERANCE_FACTORS + 1.0e-10)


@pytest.mark.parametrize(("wheel", "rail"), PAIRS[:3])
def test_pieces_end_at_the_jumps(wheel, rail) -> None:
    """At a jump a contact point moves within 0.2 nm of shift; the wheelset itself does not."""
    wheelset, track, half_range = pair(wheel, rail)
    pieces = piecewise_geometry(wheelset, track, half_range, representation="polynomial")
    assert len(pieces.jumps) >= 2
    assert set(pieces.jumps) <= set(pieces.breaks)
    for jump in pieces.jumps:
        beside = geometry_columns(contact_geometry(wheelset, track, [jump - 1e-10, jump + 1e-10]))
        moved = np.abs(np.diff(beside, axis=0))[0]
        assert moved[[2, 3, 6, 7]].max() > 1.0e-4
        # Both go on with a slope of some units at most.
        assert moved[:2].max() < 2.0e-9


def test_contact_angle_of_figure_3_stays_below_that_of_the_flange() -> None:
    """S1002's flange stands at 70 degrees; roll turns it by up to 0.5 degrees more."""
    wheelset, track, half_range = pair("S1002", "UIC60")
    pieces = piecewise_geometry(wheelset, track, half_range, representation="polynomial")
    angles = np.degrees(pieces(np.linspace(-half_range, half_range, 50001))[:, [4, 8]])
    assert angles.max() < 70.6
    assert angles.min() > 0.0


@pytest.mark.parametrize("noise", [1.0e-7, 1.0e-5])
def test_noise_is_warned_about_and_not_chased(noise) -> None:
    """On points 0.2 mm apart: the geometry at the searched points remains what the search says."""
    new = load_profile("S1002")
    y = np.linspace(new.y[0], new.y[-1], 700)
    z = np.interp(y, new.y, new.z) + noise * np.random.default_rng(0).standard_normal(len(y))
    wheelset, track, _ = pair("S1002", "UIC60")
    wheelset = replace(wheelset, wheel=Profile("noisy", "wheel", y, z))
    with pytest.warns(WheelsetWarning, match="noisy"):
        pieces = piecewise_geometry(wheelset, track, 0.008, representation="polynomial")
    searched = np.linspace(-0.008, 0.008, 321)[1:-1:20]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        exact = geometry_columns(contact_geometry(wheelset, track, searched))
    np.testing.assert_allclose(pieces(searched), exact, atol=1e-9)
    assert np.any(pieces.residuals > TOLERANCE * TOLERANCE_FACTORS)


def points_of(table: np.ndarray, curve, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Many points of a stored curve (wheel or rail): y and z [m]."""
    arcs = np.linspace(0.0, curve.spacing * curve.segments, count)
    found = np.array([curve_point(table, curve, arc) for arc in arcs])
    return found[:, 0], found[:, 3]


@pytest.mark.parametrize(("wheel", "rail"), PAIRS)
def test_least_gap_by_brute_force(wheel, rail) -> None:
    """All points of the wheel over the rail, 1 um apart, at poses on tread, throat and flange."""
    wheelset, track, _ = pair(wheel, rail)
    table = contact_tables(wheelset, track)
    side = side_of(table, 0)
    wheel_y, wheel_z = points_of(table, side.wheel, 120_001)
    rail_y, rail_z = points_of(table, side.rail, 120_001)
    across, down = side.tape + wheel_y, side.radius - wheel_z
    for shift in np.linspace(-0.004, 0.009, 40):
        roll = max(shift - 0.006, 0.0)
        ly, lz = math.cos(roll), math.sin(roll)
        at_y = shift + across * ly + down * lz
        over = (at_y > rail_y[0]) & (at_y < rail_y[-1])
        at_z = (across * lz - down * ly)[over]
        wanted = (at_z - np.interp(at_y[over], rail_y, rail_z)).min()
        # Half a step off the minimum and the rail's sag between its points, at 77 1/m of curvature
        # and a slope of up to 3.5: below 77/8 (1e-6)^2 (1 + 3.5^2)^1.5, twice.
        assert least_gap(table, 0, shift, 0.0, ly, lz)[0] == pytest.approx(wanted, abs=2e-9)


@pytest.mark.parametrize(
    ("wheel", "radius", "half_range"), [("S1002", 0.46, 8e-3), ("AAR_1_20", 0.5, 11.5e-3)]
)
def test_roll_is_the_first_angle_at_which_both_sides_agree(wheel, radius, half_range) -> None:
    """Looked for in steps of 2 urad, from the centre outwards.

    r0 tan(contact angle) of the AAR flange on a wheel of 0.5 m exceeds the rails' distance: there
    the difference of the distances falls with roll, and three angles fit one shift.
    """
    wheelset = Wheelset(1.0e3, (600.0, 100.0, 600.0), radius, wheel)
    track = Track("UIC60", 1.432)
    table = contact_tables(wheelset, track)
    steps = np.arange(0.0, 0.012, 2.0e-6)
    several = 0
    for shift in np.linspace(0.6 * half_range, half_range, 15):
        difference = np.array([gap_difference(table, shift, roll, 0.0)[0] for roll in steps])
        signs = np.sign(difference)
        crossings = np.flatnonzero(signs[:-1] != signs[1:])
        several += len(crossings) > 1
        alone = contact_geometry(wheelset, track, [shift]).roll[0]
        assert steps[crossings[0]] - 1e-9 <= alone <= steps[crossings[0] + 1] + 1e-9
    assert several > 0 or wheel == "S1002"
