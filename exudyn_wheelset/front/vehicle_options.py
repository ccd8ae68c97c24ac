"""The vehicle that a script's options name: one of the catalogue, or a file, with what is changed.

add_vehicle_options(parser, "dtu_car")
chosen = chosen_vehicle(arguments)      # --vehicle truck --friction 0.3 --wheel mine.txt
                                        # --creep fastsim:grid=20 --set track.gauge=1.436
chosen.vehicle(), chosen.system(settings), chosen.searched, chosen.stem("car")
"""

from __future__ import annotations

import argparse
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import exudyn as exu

from exudyn_wheelset.catalogue.by_name import CATALOGUE, entry, system_of
from exudyn_wheelset.catalogue.by_name import vehicle as vehicle_of_name
from exudyn_wheelset.catalogue.changes import Changes
from exudyn_wheelset.creep import CREEP_LAWS
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.front.script import add_profile_options, script_profile
from exudyn_wheelset.stability.subject import changed, description_of
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
    numbers  what is changed by paths of `Vehicle.replace`, after the rest
    """

    word: str
    changes: dict[str, Any] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)
    numbers: tuple[tuple[str, Any], ...] = ()

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
        found = named_vehicle(self.word, **self.changes)
        for path, value in self.numbers:
            found = changed(description_of(found), path, value)
        return found

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
        described: Vehicle = found.vehicle()
        return described

    def stem(self, script: str) -> str:
        """Name of a file of this vehicle's results: script, vehicle and what is changed of it."""
        words = [script, self.name, *(f"{k}_{_plain(v)}" for k, v in self.options.items())]
        return re.sub(r"[^\w.+-]+", "_", "_".join(words))

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
    parser.add_argument(
        "--set",
        dest="paths",
        action="append",
        type=path_and_value,
        default=[],
        metavar="PATH=VALUE",
        help="change any number of the vehicle by its path, such as bodies.body.mass=30e3 or "
        '"connections.front left secondary.damping.y=5e4"; may be given several times, and '
        "`exudyn-wheelset info VEHICLE` lists the paths",
    )


def add_change_options(parser: argparse.ArgumentParser) -> None:
    """Add what may be changed of a vehicle: contact, profiles and track."""
    parser.add_argument("--friction", type=float, help="coefficient of friction")
    add_creep_option(parser)
    parser.add_argument("--conicity", type=float, help="taper of the tread of an AAR wheel")
    parser.add_argument("--damping", type=float, help="damping of the normal contact [s/m]")
    add_profile_options(parser, defaults=False)


def add_creep_option(parser: argparse.ArgumentParser, default: str | None = None) -> None:
    """Add --creep, which takes parameters of the law as well."""
    parser.add_argument(
        "--creep",
        type=law_and_parameters,
        default=default and law_and_parameters(default),
        metavar="LAW[:NAME=VALUE,...]",
        help=f"creep law, such as polach-2005:friction_ratio=0.3; one of {', '.join(CREEP_LAWS)}",
    )


@dataclass(frozen=True)
class CreepWord:
    """A creep law and its parameters as one word of the command line."""

    law: str
    parameters: dict[str, Any]

    def __str__(self) -> str:
        given = ",".join(f"{name}={_plain(value)}" for name, value in self.parameters.items())
        return f"{self.law}:{given}" if given else self.law


def law_and_parameters(text: str) -> CreepWord:
    """A creep law from "fastsim" or "fastsim:grid=20"."""
    law, _, rest = text.partition(":")
    parameters: dict[str, Any] = {}
    for pair in filter(None, rest.split(",")):
        name, _, value = pair.partition("=")
        if not name.strip() or not value.strip():
            raise argparse.ArgumentTypeError(
                f"{text!r}; give a law and its parameters, such as fastsim:cells_along=20"
            )
        try:
            parameters[name.strip()] = float(value)
        except ValueError:
            parameters[name.strip()] = value.strip()
    return CreepWord(law.strip(), parameters)


def path_and_value(text: str) -> tuple[str, Any]:
    """A path and what is to stand there: a number, several with commas between, or a word."""
    path, given, value = text.partition("=")
    if not given or not path.strip() or not value.strip():
        raise argparse.ArgumentTypeError(
            f"{text!r}; give a path and a value, such as track.gauge=1.436"
        )
    try:
        several = tuple(float(part) for part in value.split(","))
    except ValueError:
        return path.strip(), value.strip()
    return path.strip(), several if len(several) > 1 else several[0]


def chosen_changes(arguments: argparse.Namespace) -> dict[str, Any]:
    """The changes of the options that `add_change_options` has added, for `catalogue.Changes`.

    Raises ProfileError for a profile that cannot be read.
    """
    changes = {name: getattr(arguments, name) for name in CHANGES}
    changes = {name: value for name, value in changes.items() if value is not None}
    for kind in ("wheel", "rail"):
        if kind in changes:
            changes[kind] = script_profile(changes[kind], kind, arguments.smoothing)
    if "creep" in changes:
        changes |= law_changes(changes["creep"])
    return changes


def law_changes(word: CreepWord) -> dict[str, Any]:
    """A creep law and, where it has any, its parameters, as `catalogue.Changes` takes them."""
    return {"creep": word.law} | ({"law_parameters": word.parameters} if word.parameters else {})


def chosen_vehicle(arguments: argparse.Namespace) -> ChosenVehicle:
    """The vehicle of the options that `add_vehicle_options` has added; errors as chosen_changes."""
    changes = chosen_changes(arguments)
    options = {name: getattr(arguments, name) for name in changes if name in CHANGES}
    if arguments.smoothing and not {"wheel", "rail"}.isdisjoint(options):
        options["smoothing"] = arguments.smoothing
    options |= dict(arguments.paths)
    return ChosenVehicle(arguments.vehicle, changes, options, tuple(arguments.paths))


def titled(system: str, options: dict[str, Any]) -> str:
    """A system's name followed by what is changed of it."""
    return ", ".join([system, *(f"{name} {value}" for name, value in options.items())])


def _plain(value: Any) -> str:
    if isinstance(value, int | float):
        return f"{value:g}"
    text = str(value)
    return Path(text).stem if Path(text).is_file() else text
