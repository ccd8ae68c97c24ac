"""Vehicle files: what is written is read as an equal vehicle, what is wrong is refused in words.

The source of truth is the vehicle in memory (equal by all digits), the text of the file (its line
numbers) and the list of what a file must not get past: unknown keys, negative masses, connections
that are missing, wrong types, units off by a thousand.
"""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import tomlkit
from test_random_vehicles import random_vehicle
from vehicle_mutations import mutated

import exudyn_wheelset
from exudyn_wheelset import (
    Element,
    Profile,
    Track,
    Vehicle,
    VehicleBuilder,
    VehicleError,
    Wheelset,
    WheelsetError,
    catalogue,
    load_profile,
    load_vehicle,
    register_element,
    save_profile,
    save_vehicle,
)
from exudyn_wheelset.front.vehicle_options import named_vehicle
from exudyn_wheelset.profiles import shapes
from exudyn_wheelset.track.files import write_layout
from exudyn_wheelset.track.irregularity import Irregularity
from exudyn_wheelset.track.layout import Curve, Layout, Straight, Transition
from exudyn_wheelset.vehicles import elements
from exudyn_wheelset.vehicles.files.element_types import snake_case
from exudyn_wheelset.vehicles.files.reading import vehicle_of

SHIPPED = Path(exudyn_wheelset.__file__).parent / "catalogue" / "files"
VEHICLES = {name: {} for name, one in catalogue.CATALOGUE.items() if one.changeable is None}
VEHICLES |= {f"{name}_empty": {"loaded": False} for name in ("freight_car", "two_axle_wagon")}
# One of each element of the package, with entries of every kind that a file has.
EXAMPLES = [
    elements.AirSpring((1.2e5, 1.3e5, 4e5), 8e5, 4e4),
    elements.AntiRollBar(9.4e5),
    elements.BumpStop((0, 1, 0), ((0.0, 0.0), (0.01, 600.0), (0.03, 5e3)), play=0.02),
    elements.Bushing((1e7, 2e7, 3e7, 1e4, 0, 0)),
    elements.CentrePlate(radius=0.178, friction=0.3),
    elements.CoilNest((1.8e6, 1.8e6, 4.2e6), elements.FrictionWedge(32.0, 0.4, 2e4, 6e5)),
    elements.CoilSpring((5e5, 5e5, 8e5), bending=1e4),
    elements.Damper((0.6, 0.8, 1.1), table=((0.0, 0.0), (0.1, 4e3), (0.3, 6e3))),
    elements.Damper((1, 0, 0), 2e5, series_stiffness=6e6),
    elements.FrictionDamper((1, 2, 3), 4e3, 5e6),
    elements.FrictionWedge(32.0, 0.4, 2e4),
    elements.LeafSpring((4e6, 1e6, 1.3e6)),
    elements.LinkSuspension(1.1e6, (0.3, 0.4), (0.2, 0.25)),
    elements.MaxwellDamper((0.1, 0.2, 0.3), 5e6, 3e4),
    elements.SideBearer(6e-3, 2e7, 0.3),
    elements.Spring(np.diag([1e6, 2e6, 3e6, 4e4, 5e4, 6e4]), (1e3, 2e3, 3e3)),
    elements.TractionRod(5e6, 2e4),
]


def wagon(*connected, wheel="S1002", rail="UIC60") -> Vehicle:
    """A body on two axles with springs, and further elements between body and ground."""
    made = VehicleBuilder("wagon", Track(rail))
    body = made.body("body", 2e4, (1.5e4, 1e5, 1e5), (0, 0, 1.4))
    for name, x in (("leading", 4.0), ("trailing", -4.0)):
        axle = made.wheelset(name, Wheelset(1200, (700, 90, 700), 0.46, wheel), x)
        for y in (1.0, -1.0):
            made.connect(
                elements.Spring((5e6, 3e6, 1e6), (1e4, 1e4, 2e4)), axle, body, (x, y, 0.46)
            )
    for one in connected:
        made.connect(one, body, made.ground, (0.0, 0.5, 0.9))
    return made.finish()


def written(vehicle: Vehicle, tmp_path: Path) -> tuple[str, Path]:
    """The text of a vehicle's file, and its path."""
    path = save_vehicle(vehicle, tmp_path / "vehicle.toml")
    return path.read_text(encoding="utf-8"), path


def near(one, other):
    """Whether two tables agree: heights at rest are roots, whose last digit is the machine's."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(near(one[key], other[key]) for key in one)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(near, one, other))
    return (
        one == pytest.approx(other, rel=1e-12, abs=1e-12)
        if isinstance(one, float)
        else one == other
    )


@pytest.mark.parametrize("name", VEHICLES)
def test_shipped_files_are_what_their_makers_make(name, tmp_path):
    made = catalogue.vehicle(name.removesuffix("_empty"), **VEHICLES[name])
    text, _ = written(made, tmp_path)
    shipped, by_name = load_vehicle(SHIPPED / f"{name}.toml"), load_vehicle(name)
    assert shipped == by_name
    again, _ = written(shipped, tmp_path)
    assert near(tomlkit.parse(again).unwrap(), tomlkit.parse(text).unwrap())


@pytest.mark.parametrize(
    "changes",
    [
        {"friction": 0.4, "creep": "polach", "damping": 5.0},
        {"gauge": 1.44, "inclination": 0.05},
        {"wheel": "AAR_1_20", "radius": 0.44},
        {"conicity": 0.1, "tape_half_distance": 0.752},
    ],
)
def test_changes_of_a_file_are_those_of_the_maker(changes):
    path = str(SHIPPED / "manchester_coach.toml")
    made = catalogue.vehicle("manchester_coach", **changes)
    of_file = named_vehicle(path, **changes)
    if "radius" in changes:
        # The maker draws its frames by the axles' height.
        assert of_file.wheelsets == made.wheelsets
    else:
        assert of_file == made


def test_every_shipped_file_has_a_maker():
    assert sorted(path.stem for path in SHIPPED.glob("*.toml")) == sorted(VEHICLES)


def test_one_of_every_element_is_tried():
    classes = {type(one).__name__ for one in EXAMPLES} | {"AxleBox"}
    own = {name for name in elements.__all__ if issubclass(getattr(elements, name), Element)}
    assert own - {"Element"} == classes


@pytest.mark.parametrize("element", EXAMPLES, ids=lambda one: type(one).__name__)
def test_elements_come_back_equal(element, tmp_path):
    vehicle = wagon(element)
    text, path = written(vehicle, tmp_path)
    assert load_vehicle(path) == vehicle
    assert f'type = "{snake_case(type(element).__name__)}"' in text


@pytest.mark.parametrize("seed", range(8))
def test_random_vehicles_come_back_equal(seed, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        vehicle = random_vehicle(seed)
        assert load_vehicle(written(vehicle, tmp_path)[1]) == vehicle


def test_loads_preloads_and_free_lengths_come_back_equal(tmp_path):
    made = VehicleBuilder("sprung", Track("UIC60", gauge=1.4321), preload="free", gravity=9.78)
    frame = made.body("frame", 3e3, (2e3, 3e3, 4e3), (0, 0, 0.6))
    axle = made.wheelset("axle", Wheelset(1200, (700, 90, 700), 0.46, "AAR_1_20"), driven=True)
    spring = elements.Spring((5e6, 3e6, 1e6))
    for y in (1.0, -1.0):
        made.connect(spring, axle, frame, (0, y, 0.46), offset=(0, 0, 0.0147))
    made.connect(elements.Spring((1e6, 1e6, 0)), frame, made.ground, (0, 0, 1), preload=(1, 2, 0))
    made.load(frame, (0, 0, -1e4), (0.1, 0, 1))
    vehicle = made.finish()
    assert load_vehicle(written(vehicle, tmp_path)[1]) == vehicle


def test_curves_and_rough_rails_come_back_equal(tmp_path):
    layout = Layout(
        [Straight(50), Transition(50, shape="bloss"), Curve(radius=-300, cant=0.12, length=500)],
        gradient=[(0.0, 0.0), (100.0, 0.01)],
    )
    distance = np.linspace(0.0, 30.0, 61)
    rough = Irregularity.from_points(distance, 1e-3 * np.sin(distance), gauge=2e-4)
    vehicle = wagon().on(Track("UIC60", layout=layout, irregularity=rough))
    text, path = written(vehicle, tmp_path)
    assert load_vehicle(path) == vehicle
    path.write_text(text.replace('kind = "bloss"', 'kind = "x"').replace('"curve"', '"curwe"'))
    with pytest.raises(VehicleError, match=r"line \d+: \[track\]: layout.*did you mean 'curve'"):
        load_vehicle(path)
    write_layout(layout, tmp_path / "line.toml")
    plain = save_vehicle(wagon(), path).read_text()
    path.write_text(plain.replace("[track]", '[track]\nlayout = "line.toml"'))
    assert load_vehicle(path).track.layout == layout


def test_profiles_of_ones_own_come_back_equal(tmp_path):
    s1002 = load_profile("S1002")
    worn = Profile("S1002", "wheel", s1002.y, s1002.z + 2e-5 * np.cos(90 * s1002.y), "a test")
    rail = load_profile("UIC60").smoothed(1e-5)
    vehicle = wagon(wheel=worn, rail=rail)
    assert load_vehicle(written(vehicle, tmp_path)[1]) == vehicle


def test_a_cone_whose_name_is_that_of_another_comes_back_equal(tmp_path):
    """Names have six digits: cone_0.062147 is shipped, and so is what "cone_0.062147 2" means."""
    vehicle = wagon(wheel=shapes.cone(0.0621470123))
    _, path = written(vehicle, tmp_path)
    assert load_vehicle(path) == vehicle


def test_profile_files_are_found_beside_the_vehicle_file(tmp_path, monkeypatch):
    text, path = written(wagon(), tmp_path)
    (tmp_path / "profiles").mkdir()
    save_profile(load_profile("S1002"), tmp_path / "profiles" / "measured.prw")
    path.write_text(text.replace('wheel = "S1002"', 'wheel = "profiles/measured.prw"'))
    monkeypatch.chdir("/")
    wheel = load_vehicle(path).wheelsets[0].wheelset.wheel
    assert np.allclose(wheel.z, load_profile("S1002").z, atol=1e-9)
    options = 'wheel = {file = "profiles/measured.prw", smoothing = 1e-5}'
    path.write_text(text.replace('wheel = "S1002"', options))
    assert load_vehicle(path).wheelsets[0].wheelset.wheel.smoothing == 1e-5


@dataclass(frozen=True)
class RopeOfMine(Element):
    """An element of a user's own, which derives from Element."""

    stiffness: float
    at: tuple[float, float] = (0.0, 1.0)

    def laws(self):
        return elements.Spring((self.stiffness, self.stiffness, 0.0)).laws()


class PlainOne:
    """An element that derives from nothing and is no dataclass."""

    def __init__(self, stiffness, words=("a",)):
        self.stiffness, self.words = stiffness, words

    def __eq__(self, other):
        return isinstance(other, PlainOne) and vars(self) == vars(other)

    def __hash__(self):
        return hash(self.stiffness)

    def places(self, at):
        return tuple(at), tuple(at)

    def static_stiffness(self):
        return np.diag([self.stiffness, 0, 0, 0, 0, 0])

    def create(self, mbs, ends, preload):
        return None


def test_elements_of_ones_own(tmp_path):
    vehicle = wagon(RopeOfMine(2e6, at=(0.25, 0.5)))
    text, path = written(vehicle, tmp_path)
    assert 'type = "rope_of_mine"' in text
    assert load_vehicle(path) == vehicle
    plain = wagon(PlainOne(2e6))
    with pytest.raises(VehicleError, match="register_element"):
        save_vehicle(plain, path)
    register_element(PlainOne)
    assert load_vehicle(save_vehicle(plain, path)) == plain
    with pytest.raises(WheelsetError, match="another name"):
        register_element(PlainOne, "spring")


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("mass = 20000.0", "maas = 20000.0", "maas", "did you mean 'mass'"),
        ("[contact]", "[contcat]", "[contcat]", "did you mean 'contact'"),
        ("stiffness = [5000000.0", "stifness = [5000000.0", "stifness", "'stiffness'"),
        ("friction = 0.3", "fricton = 0.3", "fricton", "did you mean 'friction'"),
        ("mass = 20000.0", "mass = -20000.0", "-20000.0", "give a positive number in kg"),
        ('"body"]', '"bodi"]', '"bodi"]', "did you mean 'body'"),
        ('type = "spring"', 'type = "sprig"', "sprig", "did you mean 'spring'"),
        ("mass = 20000.0", 'mass = "heavy"', "heavy", "no number"),
        ("x = 4.0", "x = true", "x = true", "no number"),
        ("at = [4.0, 1.0, 0.46]", "at = [4.0, 1.0]", "at = [4.0, 1.0]", "give 3 numbers"),
        ("radius = 0.46", "radius = 460.0", "radius = 460.0", "given in m"),
        ("radius = 0.46", "radius = 0.00046", "0.00046", "give it in m"),
        ("gauge = 1.435", "gauge = 1435.0", "gauge = 1435.0", "given in m"),
        ("mass = 20000.0", "mass = 20.0", "inertia = [15000.0", "give kg and kg m"),
        ("mass = 20000.0", "mass = 2.0e7", "2.0e7", "in kg"),
        ("15000.0, 100000.0, 100000.0", "15.0, 100.0, 100.0", "15.0, 100.0", "kg m"),
        ("5000000.0, 3000000.0, 1000000.0", "5000.0, 3000.0, 1000.0", "[5000.0", "N/m"),
        ("[10000.0, 10000.0, 20000.0]", "[10.0, 10.0, 20.0]", "[10.0", "N s/m"),
        ("shear_modulus = 82000000000.0", "shear_modulus = 82000.0", "82000.0", "Pa"),
        ("centre = [0.0, 0.0, 1.4]", "centre = [0.0, 0.0, 1400.0]", "1400.0", "metres"),
        ("centre = [0.0, 0.0, 1.4]", "centre = [0.0, 0.0, 14.0]", "14.0", "give metres"),
        ("[4.0, 1.0, 0.46]", "[4.0, 1000.0, 0.46]", "1000.0", "metres"),
        ('wheel = "S1002"', 'wheel = "S1003"', "S1003", "no such file"),
        ('like = "leading"', 'like = "leadin"', '"leadin"', "did you mean 'leading'"),
    ],
)
def test_what_is_wrong_is_refused_with_line_value_and_mend(old, new, line, words, tmp_path):
    text, path = written(wagon(), tmp_path)
    assert old in text
    text = text.replace(old, new, 1)
    path.write_text(text, encoding="utf-8")
    number = next(k for k, one in enumerate(text.splitlines(), start=1) if line in one)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(VehicleError, match=words) as caught:
            load_vehicle(path)
    message = str(caught.value)
    assert message.startswith(f"{path}, line {number}: "), message


def test_a_missing_connection_is_refused(tmp_path):
    text, path = written(wagon(), tmp_path)
    tables = text.split("\n\n")
    left = [one for one in tables if '"trailing", "body"' not in one]
    assert len(left) == len(tables) - 2
    path.write_text("\n\n".join(left))
    with pytest.raises(VehicleError, match=r"wheelset 'trailing' is not connected.*connection"):
        load_vehicle(path)
    path.write_text("\n\n".join(one for one in tables if "connection" not in one))
    with pytest.raises(VehicleError, match="nothing holds the body 'body': connect it"):
        load_vehicle(path)


@pytest.mark.filterwarnings("ignore::exudyn_wheelset.WheelsetWarning")
def test_what_is_meant_can_be_loaded(tmp_path):
    light = wagon().replace("bodies.body.mass", 20.0)
    text, path = written(light, tmp_path)
    assert "check = false" in text
    assert load_vehicle(path) == light
    path.write_text(text.replace("check = false\n", ""))
    with pytest.raises(VehicleError, match="check=False"):
        load_vehicle(path)
    assert load_vehicle(path, check=False) == light


def test_no_file_no_text_no_vehicle(tmp_path):
    path = tmp_path / "vehicle.toml"
    with pytest.raises(VehicleError, match="no such file"):
        load_vehicle(path)
    path.write_bytes(b"name = 'a'\nx = '\xff'\n")
    with pytest.raises(VehicleError, match="line 2: no UTF-8"):
        load_vehicle(path)
    with pytest.raises(VehicleError, match="give the path"):
        load_vehicle(5)
    with pytest.raises(VehicleError, match="register_creep_law"):
        save_vehicle(_with_own_law(), path)


def _with_own_law() -> Vehicle:
    made = wagon()
    object.__setattr__(made.contact, "creep", test_no_file_no_text_no_vehicle)
    return made


def test_spoilt_files_give_a_vehicle_or_a_vehicle_error():
    texts = [path.read_text(encoding="utf-8") for path in sorted(SHIPPED.glob("*.toml"))]
    load_vehicle("dtu_car")
    slowest = 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for seed in range(300):
            text = mutated(texts[seed % len(texts)], seed)
            begun = time.process_time()
            try:
                assert isinstance(vehicle_of(text, "spoilt.toml", SHIPPED), Vehicle)
            except VehicleError as error:
                assert str(error).startswith("spoilt.toml")
            slowest = max(slowest, time.process_time() - begun)
    assert slowest < 1.0
