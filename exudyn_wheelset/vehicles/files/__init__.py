"""Vehicles as TOML files: what `VehicleBuilder` puts together, written down in SI units.

    name = "hopper car"             preload = "drawing", gravity = 9.81 may follow
    [track]                         fields of Track
    rail = "UIC60"
    [contact]                       arguments of Contact
    friction = 0.4
    [[wheelset]]                    fields of Wheelset, with name, x, driven
    name = "leading"
    x = 0.9
    mass = 1120.0
    inertia = [420.0, 100.0, 420.0]
    radius = 0.4572
    wheel = "AAR_1_20"
    [[wheelset]]
    name = "trailing"
    like = "leading"                every entry of "leading" that is not given here
    x = -0.9
    [[body]]                        fields of Body
    name = "frame"
    ...
    [[connection]]                  name (as in VehicleBuilder.connect if left out), preload, offset
    type = "friction_wedge"         class of the element in snake_case, then its fields
    between = ["leading", "frame"]  lower and upper body; "ground" may be the upper one
    at = [0.9, 0.99, 0.4572]
    angle = 32.0
    [[load]]                        fields of Load

A profile is a name of the package, a file beside the vehicle file, a table with `file` and options
of `load_profile` ({file = "worn.whl", smoothing = "auto"}), or the name of a `[[profile]]` with
name, kind and points [y, z] in metres. Layout and irregularity of the track: track_entries.py.
Units: units.py.
"""

from exudyn_wheelset.vehicles.files.element_types import register_element
from exudyn_wheelset.vehicles.files.reading import load_vehicle
from exudyn_wheelset.vehicles.files.writing import save_vehicle

__all__ = ["load_vehicle", "register_element", "save_vehicle"]
