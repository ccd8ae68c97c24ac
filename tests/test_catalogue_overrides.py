"""Every vehicle of the catalogue takes every change, and the change is in the vehicle it makes.

What a change does to motion is the business of other tests; here it must arrive where the contact
reads it, on every wheelset, and the vehicle must still stand or run straight.
"""

import inspect

import numpy as np
import pytest

from exudyn_wheelset import (
    Contact,
    Vehicle,
    WheelsetError,
    catalogue,
    contact_forces,
    create_wheelset,
    load_profile,
    static_equilibrium,
)
from exudyn_wheelset.contact.wheelset_contact import contact_parameters
from exudyn_wheelset.profiles import shapes
from exudyn_wheelset.systems.system import as_system

CONE = shapes.cone(0.04)
CHANGES = {
    "shear_modulus": 7.9e10,
    "poisson": 0.3,
    "friction": 0.25,
    "creep": "polach-kalker",
    "wheel": CONE,
    "wheel name": "AAR_1_20",
    "wheel path": None,
    "rail": load_profile("UIC60"),
    "rail path": None,
    "gauge": 1.437,
    "gauge_depth": 0.0145,
    "inclination": 0.05,
    "tape_half_distance": 0.7505,
    "radius": 0.45,
    "damping": 2.0,
    "normal": "hertz-local",
}
DESCRIBED = [name for name, entry in catalogue.CATALOGUE.items() if entry.changeable is None]
ON_PROFILES = ("paper-2", "paper-lateral-2", "s1002", "truck")


def profile_file(path, profile):
    """A file of y [mm] and z [mm] on the profile's curve, z up."""
    y = np.linspace(*profile.span, 241)
    points = np.column_stack([1e3 * y, 1e3 * profile.height(y)])
    np.savetxt(path, points, header=f"kind: {profile.kind}")
    return path


def found_in(made, what):
    """The values of a change in a vehicle, one a wheelset or one of all."""
    if what in ("wheel", "radius", "tape_half_distance"):
        sets = (
            [axle.wheelset for axle in made.wheelsets]
            if isinstance(made, Vehicle)
            else [made.wheelset]
        )
        return [getattr(one, what) for one in sets]
    if what in ("rail", "gauge", "gauge_depth", "inclination"):
        return [getattr(made.track, what)]
    if isinstance(made, Vehicle):
        return [getattr(made.contact, what)]
    if hasattr(made, "contact"):
        return [made.contact[what]]
    return [made.creep if what == "creep" else getattr(made.parameters, what)]


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", [*DESCRIBED, *ON_PROFILES])
def test_a_change_is_in_the_vehicle(name, change, tmp_path):
    what = change.split(" ")[0]
    value = CHANGES[change]
    if value is None:
        value = profile_file(
            tmp_path / f"{what}.txt", CONE if what == "wheel" else load_profile("UIC60")
        )
    if name == "paper-lateral-2" and what in ("damping", "normal"):
        with pytest.raises(WheelsetError, match=f"has no {what} to change"):
            catalogue.vehicle(name, **{what: value})
        return
    made = catalogue.vehicle(name, **{what: value})
    expected = load_profile(value) if what in ("wheel", "rail") else value
    for found in found_in(made, what):
        if what in ("wheel", "rail"):
            y = np.linspace(-0.01, 0.02, 31)
            np.testing.assert_allclose(found.height(y), expected.height(y), atol=1e-7)
        else:
            assert found == expected
    if isinstance(made, Vehicle):
        assert static_equilibrium(made).residual < 1e-6
    elif change in ("creep", "wheel path", "radius"):
        assert np.all(np.isfinite(as_system(made).equilibrium(15.0)))


@pytest.mark.parametrize("name", [*DESCRIBED, *ON_PROFILES])
def test_contact_damping_has_one_default(name):
    """Steel's (docs/decisions/contact-damping.md), but for s1002, which says why (by_name.py)."""
    if name == "paper-lateral-2":
        return
    made = catalogue.vehicle(name)
    contact = made.contact if isinstance(made, Vehicle) else Contact(**made.contact)
    assert contact.damping == (10.0 if name == "s1002" else Contact.damping)


@pytest.mark.parametrize("function", [create_wheelset, contact_forces, contact_parameters, Contact])
def test_contact_damping_has_one_default_in_functions(function):
    parameters = inspect.signature(function).parameters
    if "damping" in parameters:
        assert parameters["damping"].default == Contact.damping
