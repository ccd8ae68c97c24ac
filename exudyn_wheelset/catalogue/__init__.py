"""Ready-made vehicles, by name or by the function of that name.

    from exudyn_wheelset import catalogue
    car = catalogue.dtu_car(friction=0.3)
    car = catalogue.vehicle("dtu_car", friction=0.3)

`CATALOGUE` says what each name stands for, `Changes` what can be changed of it.
"""

from exudyn_wheelset.catalogue.by_name import CATALOGUE, Entry, entry, vehicle, vehicle_system
from exudyn_wheelset.catalogue.changes import Changes
from exudyn_wheelset.catalogue.cooperrider_bogie_3d import cooperrider_bogie_3d
from exudyn_wheelset.catalogue.dtu_car import dtu_car
from exudyn_wheelset.catalogue.freight_car import freight_car
from exudyn_wheelset.catalogue.manchester_coach import manchester_coach
from exudyn_wheelset.catalogue.three_axle_truck import three_axle_truck
from exudyn_wheelset.catalogue.two_axle_wagon import two_axle_wagon

__all__ = [
    "CATALOGUE",
    "Changes",
    "Entry",
    "cooperrider_bogie_3d",
    "dtu_car",
    "entry",
    "freight_car",
    "manchester_coach",
    "three_axle_truck",
    "two_axle_wagon",
    "vehicle",
    "vehicle_system",
]
