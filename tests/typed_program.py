"""A program of a user's as `mypy --strict` sees it: names, arguments and results of the package.

It is checked against the installed package in continuous integration (.ci/run) and never run.
"""

from __future__ import annotations

from pathlib import Path

import exudyn as exu
import numpy as np

import exudyn_wheelset as xw
from exudyn_wheelset import (
    Contact,
    Motion,
    Track,
    Vehicle,
    VehicleBuilder,
    Wheelset,
    catalogue,
    contact_forces,
    contact_geometry,
    create_wheelset,
    creep_force,
    equivalent_conicity,
    limit_cycles,
    linear_critical_speed,
    load_profile,
    load_vehicle,
    nonlinear_critical_speed,
    root_locus,
    simulate,
    stability_map,
    study,
    warm_up,
    wheelsets_of,
)


def conicity_of(wheel: Path, rail: Path) -> float:
    wheelset = Wheelset(
        mass=1500.0, inertia=(800.0, 110.0, 800.0), radius=0.46, wheel=load_profile(wheel)
    )
    track = Track(rail=load_profile(rail), gauge=1.435)
    geometry = contact_geometry(wheelset, track, np.linspace(-5e-3, 5e-3, 11))
    radii: np.ndarray = geometry.left.radius - geometry.right.radius
    assert radii.shape == (11,)
    return float(equivalent_conicity(geometry.y, radii, [3e-3])[0])


def critical_speeds(vehicle: Vehicle) -> tuple[float, float]:
    linear = linear_critical_speed(vehicle, 10.0, 100.0)
    frequency: float = linear.frequency
    name: str = linear.mode_name
    print(name, frequency)
    branch = limit_cycles(vehicle, linear, (10.0, 80.0))
    print(branch.speed.max())
    return linear.speed, nonlinear_critical_speed(vehicle, low=10.0, high=100.0).speed


def distances(vehicle: Vehicle) -> Motion:
    motion = simulate(vehicle, speed=40.0, duration=2.0)
    left: np.ndarray = motion.wheel("wheelset", "left")["Q [N]"]
    print(left.max(), motion.outcome, motion.time[-1])
    return motion


def in_a_model() -> None:
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    wheelset = Wheelset(mass=1500.0, inertia=(800.0, 110.0, 800.0), radius=0.46, wheel="S1002")
    contact = Contact(creep="fastsim", friction=0.3)
    items = create_wheelset(mbs, wheelset, Track(rail="UIC60"), speed=40.0, contact=contact)
    print(items.body, len(wheelsets_of(mbs)))


def my_vehicle() -> Vehicle:
    builder = VehicleBuilder("mine", track=Track(rail="UIC60"))
    return builder.finish()


def main() -> None:
    seconds: float = warm_up(progress=True)
    print(xw.__version__, seconds)
    car = catalogue.dtu_car()
    print(critical_speeds(car), distances(load_vehicle("car.toml")))
    wheelset, track = Wheelset(1e3, (5e2, 1e2, 5e2), 0.46, "S1002"), Track(rail="UIC60")
    forces = contact_forces(wheelset, track, (0, 0, 0, 0, 0, 0), (20, 0, 0, 0, 43, 0))
    print(forces.force, [patch.normal_force for patch in forces.left])
    print(creep_force("polach", 1e-3, 0.0, 0.0, 5e-3, 5e-3, 1e5, 0.3, 8e10, 0.28))
    print(root_locus(car, [10.0, 20.0]))
    print(stability_map, study)
