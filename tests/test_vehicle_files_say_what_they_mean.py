"""What stands in a vehicle file: profiles by name, tables within what dampers and stops have."""

from dataclasses import replace

import pytest

from exudyn_wheelset import (
    BumpStop,
    Damper,
    Spring,
    Track,
    VehicleBuilder,
    VehicleError,
    Wheelset,
    catalogue,
    load_vehicle,
    save_vehicle,
)
from exudyn_wheelset.profiles import shapes
from exudyn_wheelset.vehicles.files.element_types import _own, snake_case

AXLE = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")


def test_profiles_of_the_package_stand_by_their_names(tmp_path):
    text = save_vehicle(catalogue.dtu_car(), tmp_path / "car.toml").read_text(encoding="utf-8")
    assert 'wheel = "S1002"' in text and 'rail = "UIC60"' in text
    assert "[[profile]]" not in text
    cone = catalogue.dtu_car().replace(
        "wheelsets.*.wheel", catalogue.Changes(conicity=0.05).tread("S1002")
    )
    text = save_vehicle(cone, tmp_path / "cone.toml").read_text(encoding="utf-8")
    assert "[[profile]]" in text


def test_a_profile_of_ones_own_under_a_shipped_name_stays_ones_own(tmp_path):
    """A cone that calls itself S1002: the file must not mean the package's S1002 by it."""
    cone = replace(shapes.cone(0.04), name="S1002")
    car = catalogue.dtu_car(wheel=cone)
    again = load_vehicle(save_vehicle(car, tmp_path / "car.toml"))
    assert again == car
    assert again.wheelsets[0].wheelset.wheel.height(0.02) == pytest.approx(cone.height(0.02))


def wagon(element):
    made = VehicleBuilder("wagon", Track("UIC60"))
    body = made.body("body", mass=20e3, inertia=(20e3, 80e3, 80e3), centre=(0, 0, 1.5))
    for number, x in enumerate((4.0, -4.0)):
        axle = made.wheelset(f"axle {number}", AXLE, x=x)
        for y in (1.0, -1.0):
            made.connect(Spring((5e6, 4e6, 1e6), (1e4, 1e4, 1e4)), axle, body, at=(x, y, axle.z))
            made.connect(element, axle, body, at=(x, y, axle.z))
    return made.finish()


@pytest.mark.parametrize(
    ("element", "before", "after", "unit"),
    [
        (Damper((0, 1, 0), table=((0, 0), (0.1, 1e4), (0.6, 1.6e4))), "0.6", "600.0", "m/s"),
        (Damper((0, 1, 0), table=((0, 0), (0.1, 1e4), (0.6, 1.6e4))), "16000.0", "16e9", "N"),
        (
            Damper((0, 1, 0), table=((0, 0), (0.1, 1e4), (0.6, 1.6e4)), series_stiffness=5e6),
            "0.6", "600.0", "m/s",
        ),
        (BumpStop((0, 1, 0), table=((0, 0), (0.02, 2e4), (0.03, 9e4))), "0.03", "30.0", "m"),
        (BumpStop((0, 1, 0), table=((0, 0), (0.02, 2e4), (0.03, 9e4))), "90000.0", "9e12", "N"),
    ],
)  # fmt: skip
def test_the_last_point_of_a_table_is_within_what_there_is(element, before, after, unit, tmp_path):
    path = save_vehicle(wagon(element), tmp_path / "wagon.toml")
    assert load_vehicle(path) == wagon(element)
    text = path.read_text(encoding="utf-8")
    assert before in text
    path.write_text(text.replace(before, after), encoding="utf-8")
    with pytest.raises(VehicleError, match=rf"table.*{unit}"):
        load_vehicle(path)


def test_types_are_the_elements_in_snake_case_and_the_base_is_none_of_them():
    assert snake_case("MaxwellDamper") == "maxwell_damper" and snake_case("Spring") == "spring"
    known = _own()
    assert known["friction_wedge"].__name__ == "FrictionWedge"
    assert "element" not in known
