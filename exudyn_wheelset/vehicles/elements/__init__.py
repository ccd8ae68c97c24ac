"""The connections of vehicles, one element a module, all behind one protocol (protocol.py)."""

from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.vehicles.elements.air_spring import AirSpring
from exudyn_wheelset.vehicles.elements.anti_roll_bar import AntiRollBar
from exudyn_wheelset.vehicles.elements.axle_box import AxleBox
from exudyn_wheelset.vehicles.elements.bump_stop import BumpStop
from exudyn_wheelset.vehicles.elements.centre_plate import CentrePlate
from exudyn_wheelset.vehicles.elements.coil_nest import CoilNest
from exudyn_wheelset.vehicles.elements.coil_spring import CoilSpring
from exudyn_wheelset.vehicles.elements.damper import Damper, MaxwellDamper
from exudyn_wheelset.vehicles.elements.friction_damper import FrictionDamper
from exudyn_wheelset.vehicles.elements.friction_wedge import FrictionWedge
from exudyn_wheelset.vehicles.elements.leaf_spring import LeafSpring
from exudyn_wheelset.vehicles.elements.link_suspension import LinkSuspension
from exudyn_wheelset.vehicles.elements.protocol import Element, End, Law
from exudyn_wheelset.vehicles.elements.side_bearer import SideBearer
from exudyn_wheelset.vehicles.elements.spring import Bushing, Spring
from exudyn_wheelset.vehicles.elements.traction_rod import TractionRod

__all__ = [
    "AirSpring",
    "AntiRollBar",
    "AxleBox",
    "BumpStop",
    "Bushing",
    "CentrePlate",
    "CoilNest",
    "CoilSpring",
    "Damper",
    "Element",
    "End",
    "FrictionDamper",
    "FrictionWedge",
    "Law",
    "LeafSpring",
    "LinkSuspension",
    "MaxwellDamper",
    "SideBearer",
    "Spring",
    "TractionRod",
]

for _name in __all__:
    if _name not in ("Element", "End", "Law"):
        spelt_class(globals()[_name])
