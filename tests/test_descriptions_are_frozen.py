"""What describes and what results cannot be changed behind the back of what was made of it."""

import dataclasses
import importlib
import pkgutil

import exudyn_wheelset

# They fill up while they work.
IN_WORK = {"WheelRailContact", "ContactView", "RawProfile", "Table", "_System", "_Slopes"}


def test_dataclasses_are_frozen():
    found = {}
    for module in pkgutil.walk_packages(exudyn_wheelset.__path__, "exudyn_wheelset."):
        if ".models" in module.name or module.name.endswith("__main__"):
            continue
        for name, what in vars(importlib.import_module(module.name)).items():
            if isinstance(what, type) and dataclasses.is_dataclass(what):
                found[name] = what
    changing = {name for name, what in found.items() if not what.__dataclass_params__.frozen}
    assert changing <= IN_WORK
    assert len(found) > 100
