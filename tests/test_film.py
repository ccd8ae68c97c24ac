"""Pictures and films of vehicles: true profiles and sections, wheels that turn, one picture an
instant, rendered without a display."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation

from exudyn_wheelset import Track, WheelsetError, WheelsetWarning, catalogue, film, simulate
from exudyn_wheelset.coupling.wheelset_shapes import wheelset_graphics
from exudyn_wheelset.front import film as films
from exudyn_wheelset.front.animation import rail_graphics
from exudyn_wheelset.results.motion import Motion
from exudyn_wheelset.vehicles.links import links_of
from exudyn_wheelset.vehicles.shapes import kind_of

SMALL = (96, 54)


@pytest.fixture(scope="module")
def car():
    return catalogue.freight_car(loaded=False)


@pytest.fixture(scope="module")
def motion(car):
    return simulate(car, speed=20.0, duration=0.1, start=3e-3)


def points_of(item) -> np.ndarray:
    return np.array(item["points"]).reshape(-1, 3)


def test_wheels_are_turned_from_their_profile(car):
    wheelset = car.wheelsets[0].wheelset
    points = points_of(wheelset_graphics(wheelset)[0])
    y = points[:, 1] - wheelset.tape_half_distance
    outside = np.hypot(points[:, 0], points[:, 2])
    low, high = wheelset.wheel.span
    # Between the side faces, where the profile is.
    on_rim = (y > low + 5e-3) & (y < high - 5e-3)
    assert on_rim.sum() > 1000
    dense = np.linspace(low, high, 4000)
    curve = np.column_stack([dense, wheelset.radius - wheelset.wheel.height(dense)])
    drawn = np.unique(np.column_stack([y, outside])[on_rim].round(7), axis=0)
    off = np.linalg.norm(drawn[:, None] - curve[None], axis=2).min(axis=1)
    # Chords of 2.5 mm are 0.13 mm off a throat of 6 mm radius; their ends lie on the curve.
    assert off.max() < 2e-4
    assert (off < 4e-5).sum() >= 0.5 * len(off)


def test_rails_have_their_section():
    track = Track("UIC60")
    points = np.vstack([points_of(item) for item in rail_graphics(track, -1.0, 1.0)[::3][:1]])
    head = points[points[:, 2] > -0.012]
    placed = track.left_placement.coefficients[:, [0, 4]]
    nearest = np.linalg.norm(head[:, None, 1:] - placed[None], axis=2).min(axis=1)
    assert len(head) > 40
    assert nearest.max() < 1e-6


def test_parts_look_like_what_they_are_connected_with(car):
    kinds = {body.name: kind_of(car, body) for body in car.bodies}
    assert kinds["body"] == "car body"
    assert kinds["front bolster"] == "bolster"
    assert kinds["rear left frame"] == "side frame"
    coach = catalogue.manchester_coach()
    assert kind_of(coach, coach.bodies[0]) in ("car body", "frame")
    assert {link.kind for link in links_of(coach)} >= {"coil", "damper", "rod"}


def test_a_picture_an_instant_and_nothing_but_the_wheels_turns(car, motion, tmp_path):
    path = film(car, motion, tmp_path / "car.gif", seconds=0.08, view="truck", size=SMALL)
    with Image.open(path) as shown:
        assert shown.n_frames == 3
        assert shown.size == SMALL
    # Two instants of the same vehicle that differ in the wheels' spin alone.
    places = np.repeat(motion.coordinates[:1], 2, axis=0)
    for first in range(0, 24, 6):
        turn = Rotation.from_rotvec(places[1, first + 3 : first + 6])
        spun = turn * Rotation.from_euler("Y", 0.7)
        places[1, first + 3 : first + 6] = spun.as_rotvec()
    columns = {name: np.repeat(values[:1], 2) for name, values in motion.columns.items()}
    still = Motion(np.array([0.0, 0.03]), columns, motion.outcome, 20.0, {}, places)
    container, mbs, _ = films._on_rails(car, still, cut=True)
    pictures = []
    for row in places:
        mbs.systemData.SetODE2Coordinates(row)
        mbs.SendRedrawSignal()
        pictures.append(films.render(container, films.camera_of(car, "truck"), (240, 135), 1))
    changed = np.abs(pictures[0].astype(int) - pictures[1].astype(int)).max(axis=2) > 8
    assert 20 < changed.sum() < 0.1 * changed.size


def test_columns_give_the_places_that_were_recorded(car, motion):
    """Positions and axle directions, from columns by Euler angles, as in Exudyn's coordinates."""
    without = Motion(motion.time, motion.columns, motion.outcome, motion.speed)
    _, mbs, _ = films._on_rails(car, motion, cut=False)
    of_columns = films._coordinates(mbs, car, without)
    recorded = films._coordinates(mbs, car, motion)
    for row in (0, 17, len(motion) - 1):
        ours, theirs = of_columns(row).reshape(-1, 6), recorded(row).reshape(-1, 6)
        assert ours[:, 1:3] == pytest.approx(theirs[:, 1:3], abs=1e-12)
        axles = [Rotation.from_rotvec(part[:, 3:]).apply([0, 1, 0]) for part in (ours, theirs)]
        assert axles[0] == pytest.approx(axles[1], abs=1e-9)


def test_mp4_where_ffmpeg_is_there_else_a_gif(car, motion, tmp_path, monkeypatch):
    taken = []

    def writer(path, pictures, rate):
        taken.extend(pictures)
        path.write_bytes(b"film")

    options = {"seconds": 0.04, "size": SMALL}
    monkeypatch.setattr(films, "mp4_writer", lambda: writer)
    assert film(car, motion, tmp_path / "one.mp4", **options).suffix == ".mp4"
    assert len(taken) == 2
    assert taken[0].shape == (54, 96, 3)
    monkeypatch.setattr(films, "mp4_writer", lambda: None)
    with pytest.warns(WheelsetWarning, match=r"imageio-ffmpeg"):
        assert film(car, motion, tmp_path / "two.mp4", **options).suffix == ".gif"


def test_what_cannot_be_filmed_is_refused(car, motion, tmp_path):
    path = tmp_path / "no.gif"
    with pytest.raises(WheelsetError, match="give the vehicle that was simulated"):
        film(catalogue.dtu_car(), motion, path, size=SMALL)
    with pytest.raises(WheelsetError, match="did you mean 'truck'"):
        film(car, motion, path, view="trick")
    with pytest.raises(WheelsetError, match="has no track"):
        film(3.0, motion, path)
    with pytest.raises(WheelsetError, match=r"\.mp4 or \.gif"):
        film(car, motion, tmp_path / "no.avi", seconds=0.01, size=SMALL)
    with pytest.raises(WheelsetError, match="behind the motion's end"):
        film(car, motion, path, start=5.0)
