"""Compiling kernels before they are needed."""

from __future__ import annotations

import time
from collections.abc import Callable

from tqdm import tqdm

from exudyn_wheelset.spelling import spelt


@spelt
def warm_up(everything: bool = False, progress: bool = False) -> float:
    """Load or compile the kernels of a wheelset on its rails; return the seconds [s] it took.

    everything: those of the normal models "energy", "ritz" and "strips", of the creep law "exact"
    and of vehicles and their analyses as well; otherwise they are compiled at their first use.
    progress: shows a bar. Kernels are compiled once after an installation and kept in the user's
    cache folder (NUMBA_CACHE_DIR names another); loading them takes a few tenths of a second.

    Examples
    --------
    >>> from exudyn_wheelset import warm_up
    >>> warm_up() > 0.0
    True
    """
    start = time.perf_counter()
    steps: dict[str, Callable[[], None]] = {"contact of a wheelset": _contact}
    if everything:
        steps |= {
            "energies": _energies,
            "strips": _strips,
            "exact creep law": _exact,
            "creep laws": _creep_laws,
            "elastic rails": _elastic_rails,
            "vehicles": _vehicles,
        }
    with tqdm(steps.items(), disable=not progress, unit="kernel") as bar:
        for name, step in bar:
            bar.set_description(name)
            step()
    return time.perf_counter() - start


def _contact() -> None:
    _forces("hertz")


def _energies() -> None:
    _forces("energy")
    _forces("ritz")


def _forces(normal: str) -> None:
    from exudyn_wheelset.contact.descriptions import Track, Wheelset
    from exudyn_wheelset.contact.wheelset_contact import contact_forces
    from exudyn_wheelset.geometry.rigid import contact_geometry

    wheelset = Wheelset(mass=1e3, inertia=(500, 100, 500), radius=0.46, wheel="S1002")
    track = Track(rail="UIC60")
    height = contact_geometry(wheelset, track, [1e-3]).z[0] - 5e-5
    motion = (20, 0, 0, 0, 43, 0)
    contact_forces(wheelset, track, (0, 1e-3, height, 0, 0, 0), motion, normal=normal)


def _strips() -> None:
    from exudyn_wheelset.contact.sides_apart import STRIP_SIDE, STRIP_TRACTION

    STRIP_SIDE.ready()
    STRIP_TRACTION.ready()


def _exact() -> None:
    from exudyn_wheelset.creep.exact_apart import EXACT_LAW

    EXACT_LAW.ready()


def _creep_laws() -> None:
    from exudyn_wheelset.creep import creep_force

    creep_force("polach", 1e-3, 0.0, 0.0, 5e-3, 5e-3, 1e5, 0.3, 8e10, 0.28)


def _elastic_rails() -> None:
    from exudyn_wheelset.coupling.elastic_apart import ELASTIC

    ELASTIC.ready()


def _vehicles() -> None:
    from exudyn_wheelset.catalogue.truck import dtu_truck
    from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
    from exudyn_wheelset.systems.simulation import simulate

    truck = dtu_truck()
    linear_critical_speed(truck, 20.0, 90.0)
    simulate(truck, 30.0, 0.01)
