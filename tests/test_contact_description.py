"""`Contact`: one place for a contact's numbers, the same by keyword, and refusals with a mend."""

import inspect
import pickle

import numpy as np
import pytest

from exudyn_wheelset import Contact, Track, Wheelset, WheelsetError, contact_forces, create_wheelset
from exudyn_wheelset.contact.descriptions import CONTACT_NUMBERS
from exudyn_wheelset.contact.wheelset_contact import contact_parameters

GIVEN = {"creep": "fastsim", "friction": 0.4, "damping": 2.0, "cells_along": 12}
WHEELSET = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
TRACK = Track(rail="UIC60")
POSE, VELOCITY = (0, 1e-3, -2.8e-4, 0, 0, 0), (20, 0.02, 0, 0, 20 / 0.46, 0)


@pytest.mark.parametrize("function", [contact_parameters, contact_forces, create_wheelset])
@pytest.mark.parametrize("name", CONTACT_NUMBERS)
def test_every_spelling_has_the_defaults_of_contact(function, name):
    assert inspect.signature(function).parameters[name].default == getattr(Contact(), name)


def test_contact_and_keywords_are_the_same():
    parameters = list(inspect.signature(Contact).parameters)
    assert parameters[: len(CONTACT_NUMBERS)] == list(CONTACT_NUMBERS)
    given = {**GIVEN}
    assert np.array_equal(contact_parameters(Contact(**given)), contact_parameters(**given))
    one = contact_forces(WHEELSET, TRACK, POSE, VELOCITY, contact=Contact(**given))
    other = contact_forces(WHEELSET, TRACK, POSE, VELOCITY, **given)
    assert np.array_equal(one.force, other.force)


def test_equal_after_a_round_trip_and_hashable():
    contact = Contact(**GIVEN)
    again = pickle.loads(pickle.dumps(contact))
    assert again == contact == Contact(creep="fastsim", friction=0.4, damping=2.0,
                                       law_parameters={"cells_along": 12})  # fmt: skip
    assert hash(again) == hash(contact)
    assert contact != Contact()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"frition": 0.4}, "frition.*mean 'friction'"),
        ({"shear_modulos": 8e10}, "mean 'shear_modulus'"),
        ({"creep": "fastsim", "cells_alng": 12}, "mean 'cells_along'"),
        ({"friction": "0.4"}, "friction = '0.4' is no number"),
        ({"friction": -0.1}, "friction = -0.1: give a number from 0 to 5"),
        ({"friction": True}, "friction = True is no number"),
        ({"shear_modulus": 82.0}, "shear_modulus = 82.0 Pa.*82e9 Pa"),
        ({"poisson": 0.7}, "poisson = 0.7.*from 0 to 0.5"),
        ({"damping": float("nan")}, "damping = nan s/m"),
        ({"normal": "herz"}, "mean 'hertz'"),
        ({"creep": "polack"}, "mean 'polach'"),
    ],
)
def test_impossible_contacts_are_refused_with_a_mend(given, words):
    with pytest.raises(WheelsetError, match=words):
        Contact(**given)
    with pytest.raises(WheelsetError, match=words):
        contact_forces(WHEELSET, TRACK, POSE, VELOCITY, **given)


def test_misspelt_options_of_a_function_are_offered_as_well():
    with pytest.raises(WheelsetError, match="mean 'lateral_offset'"):
        create_wheelset(None, WHEELSET, TRACK, lateral_ofset=1e-3)
    with pytest.raises(WheelsetError, match="mean 'rail_motion'"):
        contact_forces(WHEELSET, TRACK, POSE, VELOCITY, rail_moton=np.zeros(8))


def test_a_contact_and_its_numbers_at_once_are_refused():
    with pytest.raises(WheelsetError, match=r"put it into the contact, Contact\(friction=0.5"):
        contact_forces(WHEELSET, TRACK, POSE, VELOCITY, contact=Contact(), friction=0.5)
    with pytest.raises(WheelsetError, match="give a Contact"):
        contact_forces(WHEELSET, TRACK, POSE, VELOCITY, contact={"friction": 0.5})
