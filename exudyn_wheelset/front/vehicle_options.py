"""The vehicle that a script's options name: one of the catalogue, or a file, with what is changed.

add_vehicle_options(parser, "dtu_car")
chosen = chosen_vehicle(arguments)      # --vehicle truck --friction 0.3 --wheel mine.txt
chosen.vehicle(), chosen.system(settings), chosen.searched, chosen.stem("car")
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import exudyn as exu

from exudyn_wheelset.catalogue.by_name import CATALOGUE, entry, system_of
from exudyn_wheelset.catalogue.by_name import vehicle as vehicle_of_name
from exudyn_wheelset.catalogue.changes import Changes
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.script import add_profile_options, script_profile
from exudyn_wheelset.systems.system import DynamicSystem
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.files import load_vehicle

# Options that change a vehicle, as `Changes` calls them.
CHANGES = (
    "friction",
    "creep",
    "gauge",
    "gauge_depth",
    "wheel",
    "rail",
    "conicity",
    "inclination",
    "damping",
)
FILE_SUFFIX = ".toml"
# Speeds [m/s] searched for the Hopf points of a vehicle from a file.
SEARCHED = (10.0, 150.0)


def named_vehicle(word: str, **changes: Any) -> Any:
    """The vehicle of a word: a name of the catalogue, or the path of a vehicle's file (.toml).

    changes: see `catalogue.Changes`. Raises WheelsetError for an unknown name, with the nearest,
    for a file that cannot be read and for a change that the vehicle does not have.
    """
    if Path(word).suffix != FILE_SUFFIX:
        return vehicle_of_name(word, **changes)
    return Changes.of(word, **changes).applied_to(load_vehicle(word))


@dataclass(frozen=True)
class ChosenVehicle:
    """A vehicle by its word, with changes.

    word     name of the catalogue or path of a file
    changes  as `catalogue.Changes` takes them, profiles loaded
    options  the same in the words of the command line, for titles and records
    """

    word: str
    changes: dict[str, Any] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The catalogue's name, or that of the file without its folder and suffix."""
        return Path(self.word).stem if Path(self.word).suffix == FILE_SUFFIX else self.word

    @property
    def searched(self) -> tuple[float, float]:
        """Speeds [m/s] between which its first Hopf point is looked for."""
        return SEARCHED if Path(self.word).suffix == FILE_SUFFIX else entry(self.word).searched

    def vehicle(self) -> Any:
        """The vehicle; errors as of `named_vehicle`."""
        return named_vehicle(self.word, **self.changes)

    def system(self, settings: exu.SimulationSettings | None = None) -> DynamicSystem:
        """The vehicle as a system for all analyses; settings of Exudyn's solver."""
        return system_of(self.vehicle(), settings)

    def description(self) -> Vehicle:
        """The vehicle as a description of bodies, wheelsets and connections.

        Raises WheelsetError for a vehicle of the catalogue that is equations alone.
        """
        found = self.vehicle()
        if isinstance(found, Vehicle):
            return found
        if not hasattr(found, "vehicle"):
            raise WheelsetError(f"{self.word} is equations alone: it has no bodies on rails")
        return found.vehicle()

    def stem(self, script: str) -> str:
        """Name of a file of this vehicle's results: script, vehicle and what is changed of it."""
        return "_".join([script, self.name, *(f"{k}_{_plain(v)}" for k, v in self.options.items())])

    def title(self, system: str) -> str:
        """What stands above a figure: the system's name and what is changed of it."""
        return titled(system, self.options)

    def about(self) -> dict[str, Any]:
        """Word and options, for records."""
        return {"vehicle": self.word, "options": {k: str(v) for k, v in self.options.items()}}


def add_vehicle_options(parser: argparse.ArgumentParser, default: str) -> None:
    """Add --vehicle and what may be changed of one."""
    parser.add_argument(
        "--vehicle",
        default=default,
        help=f"a file ({FILE_SUFFIX}) or one of {', '.join(CATALOGUE)}",
    )
    add_change_options(parser)


def add_change_options(parser: argparse.ArgumentParser) -> None:
    """Add what may be changed of a vehicle: contact, profiles and track."""
    parser.add_argument("--friction", type=float, help="coefficient of friction")
    parser.add_argument("--creep", help="creep law")
    parser.add_argument("--conicity", type=float, help="taper of the tread of an AAR wheel")
    parser.add_argument("--damping", type=float, help="damping of the normal contact [s/m]")
    add_profile_options(parser, defaults=False)


def chosen_changes(arguments: argparse.Namespace) -> dict[str, Any]:
    """The changes of the options that `add_change_options` has added, for `catalogue.Changes`.

    Raises ProfileError for a profile that cannot be read.
    """
    changes = {name: getattr(arguments, name) for name in CHANGES}
    changes = {name: value for name, value in changes.items() if value is not None}
    for kind in ("wheel", "rail"):
        if kind in changes:
            changes[kind] = script_profile(changes[kind], kind, arguments.smoothing)
    return changes


def chosen_vehicle(arguments: argparse.Namespace) -> ChosenVehicle:
    """The vehicle of the options that `add_vehicle_options` has added; errors as chosen_changes."""
    changes = chosen_changes(arguments)
    options = {name: getattr(arguments, name) for name in changes}
    if arguments.smoothing and not {"wheel", "rail"}.isdisjoint(options):
        options["smoothing"] = arguments.smoothing
    return ChosenVehicle(arguments.vehicle, changes, options)


def titled(system: str, options: dict[str, Any]) -> str:
    """A system's name followed by what is changed of it."""
    return ", ".join([system, *(f"{name} {value}" for name, value in options.items())])


def _plain(value: Any) -> str:
    if isinstance(value, str):
        return Path(value).stem if Path(value).is_file() else value
    return f"{value:g}"
