"""Rail profiles that change along the track: the same where alike, and what lies between."""

from dataclasses import replace

import numpy as np
import pytest

from exudyn_wheelset import (
    Irregularity,
    Profile,
    RailElasticity,
    RailSection,
    Track,
    VehicleBuilder,
    Wheelset,
    WheelsetError,
    load_profile,
    load_vehicle,
    save_vehicle,
    simulate,
)
from exudyn_wheelset.contact.changing_rails import LEVELS, rail_levels, rails_change
from exudyn_wheelset.vehicles.elements import Spring

NEW = load_profile("UIC60")
# Zero everywhere, so that a run on one profile is one over stations too.
EVEN = Irregularity.from_points([-100.0, 500.0], vertical=0.0)
PLAIN = Track("UIC60", irregularity=EVEN)


def worn():
    """A new rail with up to 1.5 mm off its gauge corner, as in the outer rail of a curve."""
    off = np.clip((-0.010 - NEW.y) / 0.0255, 0.0, 1.0)
    wear = 1.5e-3 * off**2 * (3.0 - 2.0 * off)
    return Profile(name="worn", kind="rail", y=NEW.y, z=NEW.z - wear)


WORN = worn()


def wagon(track):
    wheelset = Wheelset(1500.0, (900.0, 100.0, 900.0), 0.46, "S1002")
    builder = VehicleBuilder("wagon", track)
    body = builder.body("body", 20e3, (30e3, 2e5, 2e5), (0.0, 0.0, 1.5))
    for name, x in (("leading", 3.0), ("trailing", -3.0)):
        axle = builder.wheelset(name, wheelset, x)
        for y in (1.0, -1.0):
            builder.connect(Spring((2e6, 1e6, 1e6), (2e4, 2e4, 2e4)), axle, body, (x, y, 0.46))
    return builder.finish()


def same(one, other):
    for name in one.names:
        assert np.array_equal(one[name], other[name]), name


def test_a_profile_twice_is_the_profile_to_the_last_bit():
    twice = replace(PLAIN, sections=[RailSection(10.0, "UIC60"), RailSection(20.0, NEW)])
    assert not rails_change(twice)
    runs = [simulate(wagon(track), 20.0, 1.0, initial=2e-3) for track in (PLAIN, twice)]
    same(*runs)


def test_before_and_behind_a_blend_a_rail_is_that_of_its_section_to_the_last_bit():
    """Before it as on the first rail alone, behind it as where the rails changed long ago.

    On the second rail alone the vehicle is at rest some micrometres lower, and all else is as well.
    """
    track = replace(PLAIN, sections=[RailSection(100.0, WORN)], blend=20.0)
    before = {"start": 0.0, "initial": {"leading: y": 2e-3}}
    behind = {"start": 120.0, "initial": {"leading: y": 2e-3}}
    same(*(simulate(wagon(one), 20.0, 1.0, **before) for one in (PLAIN, track)))
    long_ago = replace(PLAIN, sections=[RailSection(-1000.0, WORN)])
    here, there = (simulate(wagon(one), 20.0, 1.0, **behind) for one in (track, long_ago))
    same(here, there)
    alone = simulate(wagon(Track(WORN, irregularity=EVEN)), 20.0, 1.0, **behind)
    assert here.y == pytest.approx(alone.y, abs=1e-7)
    assert pytest.approx(alone.Q, rel=1e-4) == here.Q


def test_shapes_between_lie_between_by_their_part_of_the_wear():
    """Wear of w(y) down and little else: at t the rail is lower by t w, to the second order in w'.

    The nearest point of the worn rail lies w' aside for each w of height: some micrometres.
    """
    track = Track("UIC60", inclination=0.0, sections=[RailSection(100.0, WORN)])
    blends, tracks = rail_levels(track)
    assert blends == [(97.5, 5.0)]
    assert len(tracks) == LEVELS + 1
    new, old = tracks[0].left_placement, tracks[-1].left_placement
    y = np.linspace(0.735, 0.775, 81)

    def height(placement):
        rows = placement.coefficients
        return np.interp(y, rows[:, 0], rows[:, 4])

    wear = height(new) - height(old)
    assert wear.max() > 3e-4
    for j in (2, 4, 6):
        found = height(new) - height(tracks[j].left_placement)
        assert found == pytest.approx(j / LEVELS * wear, abs=0.02 * wear.max())
        # The gauge stays where it is measured, up to what the face's slope makes of it.
        assert tracks[j].left_placement.datum_y == pytest.approx(new.datum_y, abs=0.015)


def test_a_wheelset_goes_over_from_one_rail_to_the_other_without_a_step():
    """Steady on both: y, wheel loads as on each rail alone; between, no jump of a wheel's load."""
    right_worn = [RailSection(40.0, NEW, WORN)]
    track = replace(PLAIN, sections=right_worn, blend=10.0)
    run = simulate(wagon(track), 10.0, 9.0, start=20.0)
    end = simulate(wagon(Track(NEW, right_rail=WORN, irregularity=EVEN)), 10.0, 4.0)
    assert run.y[-1] == pytest.approx(end.y[-1], abs=2e-5)
    assert run.y[0] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert np.abs(run.y[-1]).max() > 5e-5
    assert run.Q[-1] == pytest.approx(end.Q[-1], rel=1e-3)
    steps = np.abs(np.diff(run.Q, axis=0)).max(axis=0)
    assert steps.max() < 0.01 * run.Q[0].mean()
    weight = run.Q[0].sum()
    assert run.Q.sum(axis=(1, 2)) == pytest.approx(weight, rel=0.02)


def test_files_and_mirrors_keep_sections(tmp_path):
    track = Track("UIC60", sections=[RailSection(100.0, WORN, NEW)], blend=8.0)
    car = wagon(track)
    save_vehicle(car, tmp_path / "car.toml")
    again = load_vehicle(tmp_path / "car.toml")
    assert again.track.blend == 8.0
    (section,) = again.track.sections
    assert section.start == 100.0
    assert np.array_equal(section.rail.z, WORN.z)
    (mirrored,) = car.mirrored().track.sections
    assert mirrored.rail.name == "UIC60"
    assert mirrored.right_rail.name == "worn"


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: RailSection(np.nan, "UIC60"), "start = nan"),
        (lambda: RailSection(0.0, "S1002"), "a rail profile is needed"),
        (lambda: Track("UIC60", sections=["UIC60"]), "give RailSection"),
        (
            lambda: Track("UIC60", sections=[RailSection(0, NEW), RailSection(2, WORN)]),
            "2 m follows 0 m, where the rails change over 5 m",
        ),
        (lambda: Track("UIC60", blend=0.0), "blend = 0"),
    ],
)
def test_impossible_sections_are_refused(make, words):
    with pytest.raises(WheelsetError, match=words):
        make()


def test_elastic_rails_that_change_are_refused():
    import exudyn as exu

    from exudyn_wheelset import create_wheelset

    container = exu.SystemContainer()
    track = Track("UIC60", sections=[RailSection(100.0, WORN)])
    with pytest.raises(WheelsetError, match="elastic rails or sections"):
        create_wheelset(
            container.AddSystem(), wagon(track).wheelsets[0].wheelset, track, speed=10.0,
            moving_frame=True, rail_elasticity=RailElasticity(),
        )  # fmt: skip
