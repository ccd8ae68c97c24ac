"""Vehicles as descriptions: round trips, changes by path, and refusals that name the mend."""

import pickle
import warnings

import numpy as np
import pytest

from exudyn_wheelset import (
    AntiRollBar,
    AxleBox,
    BumpStop,
    Bushing,
    Contact,
    Damper,
    MaxwellDamper,
    Spring,
    Track,
    TractionRod,
    Vehicle,
    VehicleBuilder,
    Wheelset,
    WheelsetError,
    static_equilibrium,
)

AXLE = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
PRIMARY = Spring(stiffness=(31.391e6, 3.884e6, 1.22e6), damping=(15e3, 2e3, 4e3))


def builder(**options) -> VehicleBuilder:
    return VehicleBuilder("wagon", track=Track("UIC60"), contact=Contact(friction=0.4), **options)


def wagon(wheelset: Wheelset = AXLE, track: Track | None = None, mass: float = 20e3) -> Vehicle:
    """Two wheelsets under a body."""
    made = VehicleBuilder("wagon", track=track or Track("UIC60"))
    body = made.body("body", mass=mass, inertia=(20e3, 80e3, 80e3), centre=(0, 0, 1.5))
    for name, x in (("leading", 4.0), ("trailing", -4.0)):
        axle = made.wheelset(name, wheelset, x=x)
        for side, y in (("left", 1.0), ("right", -1.0)):
            made.connect(PRIMARY, axle, body, at=(x, y, axle.z), name=f"{name} {side} spring")
            made.connect(MaxwellDamper((0, 0, 1), 1e6, 4e3), axle, body, at=(x, y, axle.z))
    return made.finish()


def test_equal_after_a_round_trip_and_hashable():
    vehicle = wagon()
    again = pickle.loads(pickle.dumps(vehicle))
    assert again == vehicle
    assert hash(again) == hash(vehicle)
    assert vehicle != vehicle.replace("bodies.body.mass", 20001.0)
    assert len({vehicle, again, wagon()}) == 1


def test_any_number_of_the_tree_can_be_replaced():
    vehicle = wagon()
    assert vehicle.replace("bodies.body.mass", 1e4).bodies[0].mass == 1e4
    assert vehicle.replace("contact.friction", 0.1).contact.friction == 0.1
    assert vehicle.replace("contact", Contact(creep="linear")).contact.creep == "linear"
    assert vehicle.replace("track.gauge", 1.433).track.gauge == 1.433
    smaller = vehicle.replace("wheelsets.*.radius", 0.45)
    assert [axle.wheelset.radius for axle in smaller.wheelsets] == [0.45, 0.45]
    assert all(one.at[2] == pytest.approx(0.45) for one in smaller.connections)
    ahead = vehicle.replace("wheelsets.leading.x", 4.1).connections
    assert [one.at[0] for one in ahead] == pytest.approx([4.1] * 4 + [-4.0] * 4)
    changed = vehicle.replace("connections.leading left spring.stiffness.y", 1e6)
    assert changed.connections[0].element.stiffness == (31.391e6, 1e6, 1.22e6)
    assert changed.connections[2:] == vehicle.connections[2:]
    dampers = vehicle.replace("connections.trailing maxwell damper.damping", 5e3).connections
    assert [one.element.damping for one in dampers if "damper" in one.name] == [4e3, 4e3, 5e3, 4e3]
    springs = vehicle.replace("connections.spring.damping", (0, 0, 0)).connections
    assert all(one.element.damping == (0, 0, 0) for one in springs if "spring" in one.name)


def test_a_change_is_validated_like_the_whole():
    with pytest.raises(WheelsetError, match="mass = -1"):
        wagon().replace("bodies.body.mass", -1.0)
    with pytest.raises(WheelsetError, match="mean 'mass'"):
        wagon().replace("bodies.body.mas", 1.0)
    with pytest.raises(WheelsetError, match="mean 'body'"):
        wagon().replace("bodies.bdy.mass", 1.0)
    with pytest.raises(WheelsetError, match="mean 'damping'"):
        wagon().replace("connections.spring.dampin", (1, 1, 1))


def test_default_names_are_made_unique():
    names = [one.name for one in wagon().connections]
    assert len(set(names)) == len(names)
    assert "leading maxwell damper 2" in names


def connected(change):
    """A wagon whose builder `change` works on before it is finished."""
    made = builder()
    body = made.body("body", mass=20e3, inertia=(20e3, 80e3, 80e3), centre=(0, 0, 1.5))
    axle = made.wheelset("axle", AXLE, x=0.0)
    change(made, axle, body)
    return made.finish()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda b, a, o: b.body("c", -5, (1, 1, 1), (0, 0, 1)), "'c': mass = -5 kg: give a pos"),
        (lambda b, a, o: b.body("c", "5", (1, 1, 1), (0, 0, 1)), "mass = '5' is no number"),
        (lambda b, a, o: b.body("c", 5, (1, 9, 1), (0, 0, 1)), "Iy = 9 .* sum 2 .*check the three"),
        (lambda b, a, o: b.body("c", 5, (1, 1), (0, 0, 1)), "has 2 entries: give 3"),
        (lambda b, a, o: b.body("body", 5, (1, 1, 1), (0, 0, 1)), "two parts are named 'body'"),
        (lambda b, a, o: b.body("c.d", 5, (1, 1, 1), (0, 0, 1)), "leave out the dot"),
        (lambda b, a, o: b.body("c", 5, (1, 1, 1), (0, 0, 1800)), "1800 m.*metres"),
        (lambda b, a, o: b.body("lost", 5, (1, 1, 1), (0, 0, 1)), "nothing holds.*'lost'"),
        (lambda b, a, o: b.connect(PRIMARY, a, "bdy", (0, 1, a.z)), "mean 'body'"),
        (lambda b, a, o: b.connect(PRIMARY, o, a, (0, 1, a.z)), "give the wheelset first"),
        (lambda b, a, o: b.connect(PRIMARY, a, o, (0, 1, 0.9)), "off the axle.*z = 0.46"),
        (lambda b, a, o: b.connect(Spring, a, o, (0, 1, a.z)), r"give Spring\(...\)"),
        (lambda b, a, o: b.connect(1e6, a, o, (0, 1, a.z)), "is no element"),
        (lambda b, a, o: b.connect(PRIMARY, a, o, (0, 1)), "give 3 numbers"),
        (lambda b, a, o: b.connect(PRIMARY, o, o, (0, 1, 1)), "to itself"),
    ],
)  # fmt: skip
def test_impossible_vehicles_are_refused_with_a_mend(change, words):
    def with_springs(made, axle, body):
        for y in (1.0, -1.0):
            made.connect(PRIMARY, axle, body, at=(0, y, axle.z))
        change(made, axle, body)

    with pytest.raises(WheelsetError, match=words):
        connected(with_springs)


def test_a_wheelset_of_impossible_inertia_is_refused():
    """Ix and Iy exchanged: Iy 1120 above 112 + 112."""
    with pytest.raises(WheelsetError, match=r"inertia Iy = 1120 kg m.*more than the sum 224"):
        Wheelset(1813, (112, 1120, 112), 0.46, "S1002")


def test_a_wheelset_off_the_track_is_refused():
    narrow = Wheelset(1813, (1120, 112, 1120), 0.46, "S1002", tape_half_distance=0.6)
    with pytest.raises(WheelsetError, match=r"not on its rail.*0.6 m.*check gauge"):
        wagon(narrow)
    with pytest.raises(WheelsetError, match="not on its rail"):
        wagon().replace("track.gauge", 1.6)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Spring(stiffness=(1e6, -1e6, 1e6)), "stiffness y = -1000000.0 N/m"),
        (lambda: Spring(stiffness="stiff"), "stiffness = 'stiff'"),
        (lambda: Spring(stiffness=(1e6, 1e6)), "give three"),
        (lambda: Spring(stiffness=np.diag([1e6] * 5 + [-1.0])), "eigenvalue -1"),
        (lambda: Bushing(stiffness=(1e6, 1e6)), "give three"),
        (lambda: MaxwellDamper((0, 0, 0), 1e6, 4e3), "vector of some length"),
        (lambda: MaxwellDamper((0, 0, 1), 0.0, 4e3), "stiffness = 0.0 N/m: give a positive"),
        (lambda: Damper((0, 1, 0)), "give damping"),
        (lambda: Damper((0, 1, 0), table=((0, 0), (0.1, 5e3), (0.2, 4e3))), "do not fall"),
        (lambda: Damper((0, 1, 0), table=((0, 0), (0.1, 0.0), (0.2, 4e3)), series_stiffness=1e6),
         "must rise"),
        (lambda: BumpStop((0, 1, 0), table=((0.02, 0), (0.1, 5e3))), r"begin with \(0, 0\)"),
        (lambda: TractionRod(5e6, length=0.0), "length = 0.0 m"),
        (lambda: AntiRollBar("940e3"), "stiffness = '940e3' is no number"),
        (lambda: AxleBox(spacing=200.0), "200.0 m is out of proportion"),
    ],
)  # fmt: skip
def test_impossible_elements_are_refused(make, words):
    with pytest.raises(WheelsetError, match=words):
        make()


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Spring(stiffness=(31.391, 3.884, 1.22)), "31.391e6"),
        (lambda: AntiRollBar(stiffness=940.0), "940e3"),
        (lambda: MaxwellDamper((0, 0, 1), stiffness=4e3, damping=1e6), "exchanged"),
        (lambda: builder().body("body", 32.0, (56.8e3, 1.97e6, 1.97e6), (0, 0, 1.8)), "248 m.*kg"),
        (lambda: Wheelset(1.8, (1120, 112, 1120), 0.46, "S1002"), "24.9 m.*kg"),
    ],
)
def test_other_units_and_exchanged_numbers_are_warned_of(make, words):
    with pytest.warns(UserWarning, match=words):
        make()


def test_a_vehicle_that_cannot_stand_says_where_and_by_how_much():
    made = builder()
    body = made.body("body", mass=20e3, inertia=(20e3, 80e3, 80e3), centre=(0, 0, 1.5))
    axle = made.wheelset("axle", AXLE, x=0.0)
    for y in (1.0, -1.0):
        made.connect(Spring(stiffness=(1e6, 1e6, 0)), axle, body, at=(0, y, axle.z))
    with pytest.raises(WheelsetError, match=r"cannot stand: 'body' is out of balance by .* N in z"):
        static_equilibrium(made.finish())
    made = builder()
    body = made.body("body", mass=20e3, inertia=(20e3, 80e3, 80e3), centre=(0.5, 0, 1.5))
    axle = made.wheelset("axle", AXLE, x=0.0)
    for y in (1.0, -1.0):
        made.connect(PRIMARY, axle, body, at=(0, y, axle.z))
    # 20 t at 0.5 m before the only axle: m g 0.5 m = 98.1 kN m of pitch.
    with pytest.raises(WheelsetError, match=r"'body' is out of balance by 9.81e\+04 N m in pitch"):
        static_equilibrium(made.finish())


def test_stiffness_in_kn_per_mm_cannot_carry_a_wagon():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        soft = wagon().replace("connections.spring.stiffness", (31.391, 3.884, 1.22))
    with pytest.raises(WheelsetError, match=r"sinks by .* m under its load.*1 kN/mm is 1e6 N/m"):
        static_equilibrium(soft)
