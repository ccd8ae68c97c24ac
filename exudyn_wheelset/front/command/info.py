"""`exudyn-wheelset info`: what is installed and known; what a vehicle, profile or creep law is."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from exudyn_wheelset.catalogue.by_name import CATALOGUE
from exudyn_wheelset.checking import unknown
from exudyn_wheelset.contact.descriptions import NORMAL_MODELS
from exudyn_wheelset.creep import CREEP_LAWS
from exudyn_wheelset.front.output import write_figure, write_json
from exudyn_wheelset.front.profile_report import profile_report
from exudyn_wheelset.front.script import smoothing_of
from exudyn_wheelset.front.tables import print_rows
from exudyn_wheelset.front.vehicle_options import FILE_SUFFIX, ChosenVehicle
from exudyn_wheelset.profiles import load_profile
from exudyn_wheelset.profiles.files import BUNDLED
from exudyn_wheelset.results.versions import versions
from exudyn_wheelset.stability.numbers import vehicle_numbers
from exudyn_wheelset.stability.subject import description_of

ABOUT = (
    "Without a name: versions, vehicles, profiles, creep laws, contact models. A vehicle's\n"
    "numbers have the paths that --set, --vary and --over take. With --out: a profile's report."
)
EXAMPLES = (
    "info",
    "info dtu_car",
    "info polach-2005",
    "info measured/axle3.whl --smoothing auto --out figures",
)
SETTINGS = False


def add_options(parser: argparse.ArgumentParser) -> None:
    """What is asked about."""
    words = "a vehicle, a creep law, a profile: its name or file"
    parser.add_argument("name", nargs="?", metavar="NAME", help=words)
    words = "of a profile from a file: 'auto', or the rms distance of points to curve [m]"
    parser.add_argument("--smoothing", type=smoothing_of, default=0.0, help=words)


def compute(arguments: argparse.Namespace) -> dict[str, Any]:
    """What is known of the name, or all names."""
    name, out = arguments.name, arguments.out
    if name is None:
        found = overview()
    elif name in CREEP_LAWS:
        found = law_info(name)
    elif name in CATALOGUE or Path(name).suffix == FILE_SUFFIX:
        found = vehicle_info(name)
    elif name in BUNDLED or Path(name).exists():
        return profile_info(arguments)
    else:
        known = [*CATALOGUE, *BUNDLED, *CREEP_LAWS]
        raise unknown("vehicle, profile, creep law or file", name, known)
    if out is not None:
        stem = "info" if name is None else f"info_{Path(name).stem}"
        found["files"] = [str(write_json(out / f"{stem}.json", found))]
    return found


def overview() -> dict[str, Any]:
    """Versions and names with a line each."""
    return {
        "versions": versions(),
        "vehicles": {name: entry.description for name, entry in CATALOGUE.items()},
        "profiles": list(BUNDLED),
        "creep_laws": {name: law.source for name, law in CREEP_LAWS.items()},
        "normal_contact": list(NORMAL_MODELS),
    }


def law_info(name: str) -> dict[str, Any]:
    """Source and parameters of a creep law."""
    law = CREEP_LAWS[name]
    return {
        "creep_law": name,
        "source": law.source,
        "parameters": {
            p.name: {"default": p.default, "low": p.low, "high": p.high, "meaning": p.meaning}
            for p in law.parameters
        },
    }


def vehicle_info(word: str) -> dict[str, Any]:
    """Parts of a vehicle and its numbers by path."""
    chosen = ChosenVehicle(word)
    made = chosen.vehicle()
    description = description_of(word if word in CATALOGUE else made)
    numbers = vehicle_numbers(description)
    found: dict[str, Any] = {
        "vehicle": chosen.name,
        "description": CATALOGUE[word].description if word in CATALOGUE else made.name,
        "searched_speeds": list(chosen.searched),
    }
    if hasattr(description, "wheelsets"):
        found["mass"] = description.mass
        found["wheelsets"] = [axle.name for axle in description.wheelsets]
        found["bodies"] = [body.name for body in description.bodies]
        contact = description.contact
        found["contact"] = {"normal": contact.normal, "creep": str(contact.creep)}
    found["numbers"] = {name: [one.value, one.unit] for name, one in numbers.items()}
    return found


def profile_info(arguments: argparse.Namespace) -> dict[str, Any]:
    """The report on a profile; with --out, its figure."""
    smoothing = arguments.smoothing if Path(arguments.name).is_file() else 0.0
    profile = load_profile(arguments.name, smoothing=smoothing)
    report = profile_report(profile)
    found: dict[str, Any] = {
        "profile": profile.name,
        "kind": profile.kind,
        "text": report.text,
        "profile_numbers": report.numbers,
    }
    if arguments.out is not None:
        path = arguments.out / f"info_{Path(arguments.name).stem}.png"
        found["files"] = [str(write_figure(path, report.figure))]
    return found


def show(numbers: dict[str, Any]) -> None:
    """Print what is known."""
    for name, value in numbers.items():
        if name in ("files", "profile_numbers"):
            continue
        if name == "parameters":
            for own, of in value.items():
                text = f"{of['default']:g} ({of['low']:g} to {of['high']:g}): {of['meaning']}"
                print_rows([(f"    {own}", text)], 28)
        elif name == "numbers":
            print("numbers, by the path that --set takes:")
            for path, (size, unit) in value.items():
                print_rows([(f"    {path}", f"{size:g} {unit}".strip())], 60)
        elif isinstance(value, dict):
            print(f"{name.replace('_', ' ')}:")
            print_rows([(f"    {key}", str(entry)) for key, entry in value.items()], 28)
        elif isinstance(value, list):
            print_rows([(name.replace("_", " "), ", ".join(map(str, value)))], 28)
        else:
            print_rows([(name.replace("_", " "), str(value))], 28)
    print(*numbers.get("files", ()), sep="\n")
