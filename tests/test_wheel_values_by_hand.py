"""What is read off a wheel, against force times creepage and the sums of its patches by hand."""

import math

import metro_car
import numpy as np
import pytest

from exudyn_wheelset import Profile, Track, Wheelset, contact_geometry, creep_force
from exudyn_wheelset.contact import layout as kernel
from exudyn_wheelset.contact.descriptions import Contact
from exudyn_wheelset.contact.forces_apart import wheelset_forces
from exudyn_wheelset.contact.layout import Axle, Velocity
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.contact.wheelset_contact import contact_parameters, read_result
from exudyn_wheelset.coupling.wheel_forces import WHEEL_VALUES, wheel_values
from exudyn_wheelset.results import running_safety as safety

SPEED, RADIUS = 20.0, 0.46
INERTIA = (900.0, 100.0, 900.0)
CONE = Wheelset(1500.0, INERTIA, RADIUS, "cone_1_20")
TRACK = Track("UIC60")
NAMES = [name for name, _ in WHEEL_VALUES]


def look(wheelset, track, y=0.0, slip=0.0, aside=0.0, contact=None):
    """Patches (left, right) and values by name of both wheels, 0.1 mm deep in the rails.

    slip: the spin is so much faster than rolling on the radius in the middle; aside: lateral
    velocity over the forward one.
    """
    contact = contact or Contact(damping=0.0)
    rigid = contact_geometry(wheelset, track, [y])
    radius = 0.5 * (rigid.left.radius[0] + rigid.right.radius[0])
    roll = float(rigid.roll[0])
    axle = Axle(y, float(rigid.z[0]) - 1e-4, 0.0, math.cos(roll), math.sin(roll))
    spin = (1.0 + slip) * SPEED / radius
    velocity = Velocity(SPEED, aside * SPEED, 0.0, 0.0, spin * axle.ly, spin * axle.lz)
    result = kernel.new_result()
    wheelset_forces(
        contact_tables(wheelset, track), axle, velocity, np.zeros(12), contact_parameters(contact),
        result,
    )  # fmt: skip
    forces = read_result(result)
    found = []
    for hand in range(2):
        values = np.empty(len(NAMES))
        wheel_values(result, hand, values)
        found.append(dict(zip(NAMES, values, strict=True)))
    return (forces.left, forces.right), found


@pytest.mark.parametrize(("slip", "aside"), [(0.0, 0.0), (4e-3, 0.0), (0.0, 3e-3), (2e-3, -1e-3)])
@pytest.mark.parametrize("law", ["fastsim", "exact-table"])
def test_wear_number_is_force_times_creepage(slip, aside, law):
    """Pure spin (of a cone, 0.1 1/m), pure slip along and across: forces from the law itself."""
    contact = Contact(creep=law, damping=0.0)
    sides, values = look(CONE, TRACK, 0.0, slip, aside, contact)
    for patches, found in zip(sides, values, strict=True):
        (patch,) = patches
        # The patch lies some hundredths of a millimetre inside the wheel: 1e-5 of 0.46 m each.
        assert patch.creep_x == pytest.approx(-slip, abs=4e-5)
        assert abs(patch.spin) == pytest.approx(0.05 / RADIUS, rel=0.05)
        fx, fy, mz = creep_force(
            law, patch.creep_x, patch.creep_y, patch.spin, patch.a, patch.b, patch.normal_force,
            0.3, Contact.shear_modulus, Contact.poisson,
        )  # fmt: skip
        known = abs(fx * patch.creep_x) + abs(fy * patch.creep_y) + abs(mz * patch.spin)
        assert found["wear_number"] == pytest.approx(known, rel=1e-6)
        if aside == 0.0 and slip > 0.0:
            assert found["wear_number"] == pytest.approx(abs(fx * slip), rel=0.02)


def test_q_and_y_are_sums_over_patches_and_the_flange_has_its_part():
    points = metro_car.wheel_points()
    wheel = Profile(name="metro", kind="wheel", y=points[:, 0], z=points[:, 1])
    wheelset = Wheelset(1200.0, (700.0, 90.0, 700.0), metro_car.RADIUS, wheel)
    seen = False
    for y in np.linspace(-0.0064, -0.0058, 13):
        sides, values = look(wheelset, TRACK, float(y))
        for patches, found in zip(sides, values, strict=True):
            vertical = [p.normal[2] * p.normal_force - p.normal[1] * p.fy for p in patches]
            lateral = [p.normal[2] * p.fy + p.normal[1] * p.normal_force for p in patches]
            flange = [abs(p.angle) > 0.5 for p in patches]
            assert found["Q"] == pytest.approx(sum(vertical), rel=1e-12)
            assert found["Y"] == pytest.approx(sum(lateral), rel=1e-12)
            assert found["flange_Q"] == pytest.approx(np.dot(vertical, flange), abs=1e-6)
            assert found["flange_Y"] == pytest.approx(np.dot(lateral, flange), abs=1e-6)
            assert found["patches"] == len(patches)
            seen = seen or (any(flange) and not all(flange))
    # On tread and flange at once.
    assert seen


def test_unloading_and_load_transfer_by_hand():
    """(Q0 - Q)/Q0; of a quasi-static curve the two sides are off by the same part."""
    rest = np.array([[50e3, 50e3]])
    loads = np.array([[[40e3, 60e3]], [[50e3, 50e3]]])
    found = safety.unloading(loads, rest)
    assert found[:, 0].tolist() == [[0.2, -0.2], [0.0, 0.0]]
