"""A freight car written by hand, with friction as connections like any other: it stands, sways,
stays on its rails."""

from __future__ import annotations

import numpy as np
import pytest

from exudyn_wheelset import (
    Bushing,
    CentrePlate,
    CoilNest,
    Contact,
    FrictionWedge,
    SideBearer,
    Spring,
    Track,
    VehicleBuilder,
    Wheelset,
    linearise,
    simulate,
    static_equilibrium,
)
from exudyn_wheelset.systems.vehicle_system import vehicle_system

WEDGE = FrictionWedge(angle=32.0, friction=0.4, column_force=2.0e4, spring=6e5)


def hopper(nest=False):
    """The car; nest: coils and wedges of a side as one part."""
    car = VehicleBuilder(
        "hopper car", track=Track("UIC60"), contact=Contact(creep="fastsim", friction=0.4)
    )
    axle = Wheelset(mass=1120, inertia=(420, 100, 420), radius=0.4572, wheel="AAR_1_20")
    body = car.body("body", mass=80e3, inertia=(1.1e5, 1.3e6, 1.3e6), centre=(0, 0, 2.20))
    for truck, x in (("front", 6.17), ("rear", -6.17)):
        bolster = car.body(
            f"{truck} bolster", mass=465, inertia=(175, 10, 175), centre=(x, 0, 0.55)
        )
        car.connect(CentrePlate(radius=0.178, friction=0.3), bolster, body, at=(x, 0, 0.72))
        for y in (0.635, -0.635):
            bearer = SideBearer(gap=6e-3, stiffness=2e7, friction=0.3)
            car.connect(bearer, bolster, body, at=(x, y, 0.74))
        axles = [
            car.wheelset(f"{truck} {w}", axle, x=x + d)
            for w, d in (("leading", 0.889), ("trailing", -0.889))
        ]
        for side, y in (("left", 0.99), ("right", -0.99)):
            frame = car.body(
                f"{truck} {side} frame", mass=447, inertia=(100, 116, 100), centre=(x, y, 0.46)
            )
            for one in axles:
                adapter = Bushing(stiffness=(2e7, 1e7, 1e8), damping=(1e4, 1e4, 1e4))
                car.connect(adapter, one, frame, at=(one.x, y, one.z))
            coils = (1.8e6, 1.8e6, 4.2e6)
            if nest:
                car.connect(CoilNest(coils, WEDGE, spacing=0.4), frame, bolster, at=(x, y, 0.55))
                continue
            car.connect(Spring(stiffness=coils), frame, bolster, at=(x, y, 0.55))
            for d in (0.2, -0.2):
                car.connect(WEDGE, frame, bolster, at=(x + d, y, 0.55))
    return car.finish()


def test_it_stands_and_its_wedges_have_the_force_they_were_given():
    car = hopper()
    found = static_equilibrium(car)
    assert found.residual < 1e-6
    total = sum(map(sum, found.wheel_loads.values()))
    assert total == pytest.approx(9.81 * car.mass, rel=1e-6)
    wedges = [force for name, force in found.preloads.items() if "wedge" in name]
    assert len(wedges) == 8
    for force in wedges:
        assert force[2] == pytest.approx(2.0e4 * np.tan(np.radians(32.0)), rel=1e-9)


def test_one_part_of_coils_and_wedges_is_the_same_car():
    parts, nests = (linearise(hopper(nest), 20.0).eigenvalues for nest in (False, True))
    assert np.sort_complex(nests) == pytest.approx(np.sort_complex(parts), abs=1e-5)


def test_it_runs_on_its_rails():
    motion = simulate(hopper(), 15.0, 0.5, start=2e-3)
    assert motion.time[-1] == pytest.approx(0.5)
    assert np.abs(motion["front leading: y"]).max() < 6e-3
    plates = [name for name in vehicle_system(hopper()).state_names if "centre plate" in name]
    assert len(plates) == 6
