"""Write the vehicles of the catalogue as files into the package: catalogue/files/*.toml.

Run `python tools/write_vehicle_files.py` after a change of a maker; tests/test_vehicle_files.py
holds that every file gives what its maker makes.
"""

from __future__ import annotations

import argparse
import inspect
from pathlib import Path

import exudyn_wheelset
from exudyn_wheelset.catalogue import CATALOGUE, vehicle
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.files import save_vehicle

FOLDER = Path(exudyn_wheelset.__file__).parent / "catalogue" / "files"


def main() -> None:
    """Write one file for each name that stands for a Vehicle, one more where it can be empty."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=FOLDER)
    folder = parser.parse_args().out
    for name, entry in CATALOGUE.items():
        made = vehicle(name)
        if isinstance(made, Vehicle):
            print(save_vehicle(made, folder / f"{name}.toml", description=entry.description))
            if "loaded" in inspect.signature(entry.make).parameters:
                empty = vehicle(name, loaded=False)
                print(save_vehicle(empty, folder / f"{name}_empty.toml", description=empty.name))


if __name__ == "__main__":
    main()
