"""Vehicles by name, with the settings that an influence on hunting is usually asked of.

`vehicle(name, ...)` gives a vehicle for every analysis; `CATALOGUE` says what each name stands for
and between which speeds its Hopf point is looked for. Friction, creep law, gauge, wheel (or the
conicity of a conical one), rail and its inclination may be changed where the vehicle has them.
Lengths in m, forces in N, speeds in m/s.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import exudyn as exu

from exudyn_wheelset.catalogue import paper_wheelset as paper
from exudyn_wheelset.catalogue.changes import Changes
from exudyn_wheelset.catalogue.cooperrider_bogie import CooperriderBogie
from exudyn_wheelset.catalogue.cooperrider_bogie_3d import cooperrider_bogie_3d
from exudyn_wheelset.catalogue.dtu_car import dtu_car
from exudyn_wheelset.catalogue.freight_car import freight_car
from exudyn_wheelset.catalogue.lateral_parameters import paper_parameters
from exudyn_wheelset.catalogue.lateral_wheelset import LateralWheelset
from exudyn_wheelset.catalogue.manchester_coach import manchester_coach
from exudyn_wheelset.catalogue.three_axle_truck import three_axle_truck
from exudyn_wheelset.catalogue.truck import Truck, dtu_truck
from exudyn_wheelset.catalogue.two_axle_wagon import two_axle_wagon
from exudyn_wheelset.catalogue.wheelset_on_frame import Suspension, WheelsetOnFrame
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.profiles import Profile
from exudyn_wheelset.systems import vehicle_system as systems
from exudyn_wheelset.systems.system import DynamicSystem
from exudyn_wheelset.vehicles.description import Vehicle


@dataclass(frozen=True)
class Entry:
    """A name of the catalogue.

    description    one line
    searched       speeds [m/s] between which the first Hopf point lies
    make           the vehicle with changes, by keyword where `changeable` is None
    changeable     what of `Changes` it has; None: all, and what `make` has of its own
    """

    description: str
    searched: tuple[float, float]
    make: Callable[..., Any]
    changeable: tuple[str, ...] | None = None


def vehicle(name: str, **changes: Any) -> Any:
    """The vehicle of a name of `CATALOGUE`, with `changes` (see Changes); for every analysis.

    Raises WheelsetError for an unknown name, with the nearest one, and for a change that the
    vehicle does not have.
    """
    known = entry(name)
    if known.changeable is None:
        return known.make(**changes)
    asked = Changes.of(name, **changes)
    for what in changes:
        if getattr(asked, what) is not None and what not in known.changeable:
            raise WheelsetError(
                f"{name} has no {what} to change; it has {', '.join(known.changeable) or 'none'}"
            )
    return known.make(asked)


def vehicle_system(
    name: str, settings: exu.SimulationSettings | None = None, **changes: Any
) -> DynamicSystem:
    """The vehicle as a system; `settings` are Exudyn's, for its simulations.

    Raises WheelsetError as `vehicle`, and for settings of a vehicle that is not in Exudyn.
    """
    return system_of(vehicle(name, **changes), settings)


def system_of(vehicle: Any, settings: exu.SimulationSettings | None = None) -> DynamicSystem:
    """A vehicle, of the catalogue or a description, as a system with these solver settings.

    Raises WheelsetError for settings of a vehicle that is not in Exudyn.
    """
    if isinstance(vehicle, Vehicle):
        return systems.vehicle_system(vehicle, settings=settings)
    if not isinstance(vehicle, DynamicSystem):
        system: DynamicSystem = vehicle.dynamic_system(settings=settings)
        return system
    if settings is not None:
        raise WheelsetError(f"{vehicle.name} is not built in Exudyn: leave the solver settings out")
    return vehicle


def entry(name: str) -> Entry:
    """What a name stands for; raises WheelsetError for an unknown one, with the nearest."""
    if name in CATALOGUE:
        return CATALOGUE[name]
    near = difflib.get_close_matches(name, CATALOGUE, n=1, cutoff=0.0)
    raise WheelsetError(
        f"vehicle {name!r} is unknown; the nearest is {near[0]!r} of {', '.join(CATALOGUE)}"
    )


def s1002_wheelset(
    wheel: Profile | str = "S1002",
    *,
    longitudinal_stiffness: float = 1.6e6,
    lateral_stiffness: float = 4.0e5,
    **contact: Any,
) -> WheelsetOnFrame:
    """One wheelset of the Manchester benchmark coach, S1002 on UIC60, sprung softly to a frame.

    Mass, inertia, radius, load, place, vertical stiffness and damping of the axle boxes are those
    of vehicle 1 of the Manchester benchmarks (S. Iwnicki, Vehicle System Dynamics 30 (1998)
    295-313). Its horizontal stiffnesses (31.4e6 and 3.9e6 N/m) steer a bogie, and hold a single
    wheelset on a frame that does not move so firmly that it is stable up to 400 m/s; those
    given here [N/m a side] are chosen for a critical speed of the order of a train's. contact:
    arguments of `contact_parameters`. The creep law is Shen-Hedrick-Elkins', which is smooth at
    zero creep. The contact damping of 10 s/m takes up flange impacts of 0.1 m/s in one blow, as a
    track on ballast does; with 1 s/m the wheelset rebounds between the flanges and hunts there
    with few regular motions.
    """
    body, frame, wheelset = 32000.0, 2615.0, 1813.0
    return WheelsetOnFrame(
        wheelset=Wheelset(wheelset, (1120.0, 112.0, 1120.0), radius=0.46, wheel=wheel),
        track=Track("UIC60", gauge=1.435, inclination=1.0 / 40.0),
        suspension=Suspension(
            half_distance=1.0,
            stiffness=(longitudinal_stiffness, lateral_stiffness, 1.22e6),
            damping=(15.0e3, 2.0e3, 4.0e3),
        ),
        axle_load=GRAVITY * (0.25 * body + 0.5 * frame + wheelset),
        contact={"creep": "shen-hedrick-elkins", "friction": 0.3, "damping": 10.0, **contact},
        name="S1002 wheelset on UIC60",
    )


_OnSprings = TypeVar("_OnSprings", WheelsetOnFrame, Truck)


def _on_track(made: _OnSprings, changes: Changes) -> _OnSprings:
    """A vehicle with its track and its wheelsets changed."""
    track = made.track
    changed = {name: getattr(track, name) for name in _TRACK} | changes.given(*_TRACK)
    wheelset = replace(made.wheelset, **changes.given("tape_half_distance", "radius"))
    return replace(made, track=Track(changes.rail or track.rail, **changed), wheelset=wheelset)


def _paper(spring_set: int) -> Callable[[Changes], Any]:
    def make(changes: Changes) -> WheelsetOnFrame:
        made = paper.paper_wheelset(
            spring_set,
            driven=False,
            wheel=changes.tread(paper.WHEEL),
            **changes.given(*_CONTACT),
        )
        return _on_track(made, changes)

    return make


def _paper_lateral(spring_set: int) -> Callable[[Changes], Any]:
    def make(changes: Changes) -> LateralWheelset:
        return paper.paper_lateral_wheelset(
            "profiled",
            spring_set,
            free_spin=True,
            parameters=paper_parameters(spring_set, **changes.given(*_LATERAL_NUMBERS)),
            wheel=changes.tread(paper.WHEEL),
            **changes.given("creep", "rail", "tape_half_distance", *_TRACK),
        )

    return make


def _s1002(changes: Changes) -> WheelsetOnFrame:
    made = s1002_wheelset(wheel=changes.tread("S1002"), **changes.given(*_CONTACT))
    return _on_track(made, changes)


def _cooperrider(changes: Changes) -> CooperriderBogie:
    bogie = CooperriderBogie()
    for name, value in changes.given("conicity", "friction").items():
        bogie = bogie.replace(name, value)
    return bogie


def _truck(changes: Changes) -> Truck:
    made = dtu_truck(wheel=changes.tread("S1002"), **changes.given(*_CONTACT))
    return _on_track(made, changes)


_TRACK = ("gauge", "gauge_depth", "inclination")
_LATERAL_NUMBERS = ("friction", "shear_modulus", "poisson", "radius")
_LATERAL = ("creep", *_LATERAL_NUMBERS, *_TRACK, "wheel", "rail", "conicity", "tape_half_distance")
_BESIDES = ("damping", "normal", "law_parameters")
_CONTACT = ("friction", "creep", "shear_modulus", "poisson", *_BESIDES)
_ON_PROFILES = (*_LATERAL, *_BESIDES)
_PAPER_SEARCHED = {1: (10.0, 100.0), 2: (40.0, 200.0), 3: (100.0, 320.0)}

CATALOGUE: dict[str, Entry] = {
    **{
        f"paper-{k}": Entry(
            f"the paper's wheelset, spring set {k}, six degrees of freedom, free spin",
            _PAPER_SEARCHED[k],
            _paper(k),
            _ON_PROFILES,
        )
        for k in (1, 2, 3)
    },
    **{
        f"paper-lateral-{k}": Entry(
            f"the paper's lateral model on profiles, spring set {k}, rolling freely",
            _PAPER_SEARCHED[k],
            _paper_lateral(k),
            _LATERAL,
        )
        for k in (1, 2, 3)
    },
    "s1002": Entry(
        "a wheelset S1002 on UIC60 1:40, gauge 1435 mm, on soft springs to a frame",
        (10.0, 150.0),
        _s1002,
        _ON_PROFILES,
    ),
    "cooperrider": Entry(
        "Kaas-Petersen's bogie of Cooperrider",
        (20.0, 120.0),
        _cooperrider,
        ("friction", "conicity"),
    ),
    "truck": Entry(
        "two wheelsets S1002 on UIC60 1:40 and a frame, a truck of the DTU car",
        (15.0, 150.0),
        _truck,
        _ON_PROFILES,
    ),
    "dtu_car": Entry(
        "the DTU passenger car on two of Kaas-Petersen's bogies, S1002 on UIC60 1:40",
        (15.0, 150.0),
        dtu_car,
    ),
    "manchester_coach": Entry(
        "vehicle 1 of the Manchester benchmarks, a coach, S1002 on UIC60 1:40",
        (20.0, 150.0),
        manchester_coach,
    ),
    "cooperrider_bogie_3d": Entry(
        "Kaas-Petersen's bogie of Cooperrider in three dimensions, cones on UIC60 heads",
        (20.0, 120.0),
        cooperrider_bogie_3d,
    ),
    "three_axle_truck": Entry(
        "a truck with three axles below a body that runs straight, S1002 on UIC60 1:40",
        (20.0, 200.0),
        three_axle_truck,
    ),
    "freight_car": Entry(
        "a freight car on two three-piece trucks (loaded=False: empty), AAR 1:20 on UIC60 1:40",
        (10.0, 80.0),
        freight_car,
    ),
    "two_axle_wagon": Entry(
        "a wagon with leaf springs on links (loaded=False: empty), S1002 on UIC60 1:40",
        (8.0, 80.0),
        two_axle_wagon,
    ),
}
