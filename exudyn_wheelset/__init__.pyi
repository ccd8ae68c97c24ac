from exudyn_wheelset import catalogue as catalogue
from exudyn_wheelset import studies as studies
from exudyn_wheelset.catalogue.lateral_parameters import LateralParameters as LateralParameters
from exudyn_wheelset.catalogue.lateral_parameters import paper_parameters as paper_parameters
from exudyn_wheelset.catalogue.lateral_wheelset import LateralWheelset as LateralWheelset
from exudyn_wheelset.catalogue.truck import Truck as Truck
from exudyn_wheelset.catalogue.truck import dtu_truck as dtu_truck
from exudyn_wheelset.catalogue.wheelset_on_frame import Suspension as Suspension
from exudyn_wheelset.catalogue.wheelset_on_frame import WheelsetOnFrame as WheelsetOnFrame
from exudyn_wheelset.contact.descriptions import Contact as Contact
from exudyn_wheelset.contact.descriptions import Track as Track
from exudyn_wheelset.contact.descriptions import Wheelset as Wheelset
from exudyn_wheelset.contact.rail_section import RailSection as RailSection
from exudyn_wheelset.contact.wheelset_contact import contact_energy as contact_energy
from exudyn_wheelset.contact.wheelset_contact import contact_forces as contact_forces
from exudyn_wheelset.coupling.create import create_wheelset as create_wheelset
from exudyn_wheelset.coupling.elastic_rails import RailElasticity as RailElasticity
from exudyn_wheelset.coupling.moving_frame import add_frame_loads as add_frame_loads
from exudyn_wheelset.coupling.registration import WheelsetItems as WheelsetItems
from exudyn_wheelset.coupling.registration import wheelsets_of as wheelsets_of
from exudyn_wheelset.coupling.track_frame import TrackFrame as TrackFrame
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact as WheelRailContact
from exudyn_wheelset.creep import creep_force as creep_force
from exudyn_wheelset.creep import register_creep_law as register_creep_law
from exudyn_wheelset.errors import AnalysisError as AnalysisError
from exudyn_wheelset.errors import ContactError as ContactError
from exudyn_wheelset.errors import ProfileError as ProfileError
from exudyn_wheelset.errors import SettingsError as SettingsError
from exudyn_wheelset.errors import VehicleError as VehicleError
from exudyn_wheelset.errors import WheelsetError as WheelsetError
from exudyn_wheelset.errors import WheelsetWarning as WheelsetWarning
from exudyn_wheelset.front.citation import citation as citation
from exudyn_wheelset.front.contact_view import contact_view as contact_view
from exudyn_wheelset.front.film import film as film
from exudyn_wheelset.front.profile_report import profile_report as profile_report
from exudyn_wheelset.front.settings import load_settings as load_settings
from exudyn_wheelset.front.warming import warm_up as warm_up
from exudyn_wheelset.geometry.conicity import equivalent_conicity as equivalent_conicity
from exudyn_wheelset.geometry.piecewise import piecewise_geometry as piecewise_geometry
from exudyn_wheelset.geometry.rigid import contact_geometry as contact_geometry
from exudyn_wheelset.geometry.rolling_radius import rolling_radius_curve as rolling_radius_curve
from exudyn_wheelset.profiles import Profile as Profile
from exudyn_wheelset.profiles import load_profile as load_profile
from exudyn_wheelset.profiles import mean_profile as mean_profile
from exudyn_wheelset.profiles import save_profile as save_profile
from exudyn_wheelset.results.endings import Ending as Ending
from exudyn_wheelset.results.endings import Outcome as Outcome
from exudyn_wheelset.results.motion import Motion as Motion
from exudyn_wheelset.stability.design import design as design
from exudyn_wheelset.stability.hunting.all_branches import all_branches as all_branches
from exudyn_wheelset.stability.hunting.branch import Branch as Branch
from exudyn_wheelset.stability.hunting.branch_switching import switch_branch as switch_branch
from exudyn_wheelset.stability.hunting.descent import quasi_static_descent as quasi_static_descent
from exudyn_wheelset.stability.hunting.disturbance import critical_disturbance as critical_disturbance
from exudyn_wheelset.stability.hunting.limit_cycles import limit_cycles as limit_cycles
from exudyn_wheelset.stability.hunting.nonlinear import nonlinear_critical_speed as nonlinear_critical_speed
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed as linear_critical_speed
from exudyn_wheelset.stability.linear.crossings import hopf_points as hopf_points
from exudyn_wheelset.stability.linear.linearisation import linearise as linearise
from exudyn_wheelset.stability.linear.linearisation import root_locus as root_locus
from exudyn_wheelset.stability.maps.basins import basin as basin
from exudyn_wheelset.stability.maps.stability_map import stability_map as stability_map
from exudyn_wheelset.stability.simulation import simulate as simulate
from exudyn_wheelset.studies import Study as Study
from exudyn_wheelset.studies import study as study
from exudyn_wheelset.systems.exudyn_system import ExudynSystem as ExudynSystem
from exudyn_wheelset.systems.function_system import FunctionSystem as FunctionSystem
from exudyn_wheelset.systems.steady_curve import SteadyCurve as SteadyCurve
from exudyn_wheelset.systems.steady_curve import steady_curve as steady_curve
from exudyn_wheelset.systems.system import DynamicSystem as DynamicSystem
from exudyn_wheelset.track.irregularity import Irregularity as Irregularity
from exudyn_wheelset.track.layout import Curve as Curve
from exudyn_wheelset.track.layout import Layout as Layout
from exudyn_wheelset.track.layout import Straight as Straight
from exudyn_wheelset.track.layout import Transition as Transition
from exudyn_wheelset.track.spectra import Spectrum as Spectrum
from exudyn_wheelset.vehicles.builder import VehicleBuilder as VehicleBuilder
from exudyn_wheelset.vehicles.description import Vehicle as Vehicle
from exudyn_wheelset.vehicles.elements import AirSpring as AirSpring
from exudyn_wheelset.vehicles.elements import AntiRollBar as AntiRollBar
from exudyn_wheelset.vehicles.elements import AxleBox as AxleBox
from exudyn_wheelset.vehicles.elements import BumpStop as BumpStop
from exudyn_wheelset.vehicles.elements import Bushing as Bushing
from exudyn_wheelset.vehicles.elements import CentrePlate as CentrePlate
from exudyn_wheelset.vehicles.elements import CoilNest as CoilNest
from exudyn_wheelset.vehicles.elements import CoilSpring as CoilSpring
from exudyn_wheelset.vehicles.elements import Damper as Damper
from exudyn_wheelset.vehicles.elements import Element as Element
from exudyn_wheelset.vehicles.elements import FrictionDamper as FrictionDamper
from exudyn_wheelset.vehicles.elements import FrictionWedge as FrictionWedge
from exudyn_wheelset.vehicles.elements import LeafSpring as LeafSpring
from exudyn_wheelset.vehicles.elements import LinkSuspension as LinkSuspension
from exudyn_wheelset.vehicles.elements import MaxwellDamper as MaxwellDamper
from exudyn_wheelset.vehicles.elements import SideBearer as SideBearer
from exudyn_wheelset.vehicles.elements import Spring as Spring
from exudyn_wheelset.vehicles.elements import TractionRod as TractionRod
from exudyn_wheelset.vehicles.files import load_vehicle as load_vehicle
from exudyn_wheelset.vehicles.files import register_element as register_element
from exudyn_wheelset.vehicles.files import save_vehicle as save_vehicle
from exudyn_wheelset.vehicles.statics import static_equilibrium as static_equilibrium
from exudyn_wheelset.vehicles.statics import with_free_lengths as with_free_lengths

__version__: str
__all__ = [
    "AirSpring",
    "AnalysisError",
    "AntiRollBar",
    "AxleBox",
    "Branch",
    "BumpStop",
    "Bushing",
    "CentrePlate",
    "CoilNest",
    "CoilSpring",
    "Contact",
    "ContactError",
    "Curve",
    "Damper",
    "DynamicSystem",
    "Element",
    "Ending",
    "ExudynSystem",
    "FrictionDamper",
    "FrictionWedge",
    "FunctionSystem",
    "Irregularity",
    "LateralParameters",
    "LateralWheelset",
    "Layout",
    "LeafSpring",
    "LinkSuspension",
    "MaxwellDamper",
    "Motion",
    "Outcome",
    "Profile",
    "ProfileError",
    "RailElasticity",
    "RailSection",
    "SettingsError",
    "SideBearer",
    "Spectrum",
    "Spring",
    "SteadyCurve",
    "Straight",
    "Study",
    "Suspension",
    "Track",
    "TrackFrame",
    "TractionRod",
    "Transition",
    "Truck",
    "Vehicle",
    "VehicleBuilder",
    "VehicleError",
    "WheelRailContact",
    "Wheelset",
    "WheelsetError",
    "WheelsetItems",
    "WheelsetOnFrame",
    "WheelsetWarning",
    "__version__",
    "add_frame_loads",
    "all_branches",
    "basin",
    "catalogue",
    "citation",
    "contact_energy",
    "contact_forces",
    "contact_geometry",
    "contact_view",
    "create_wheelset",
    "creep_force",
    "critical_disturbance",
    "design",
    "dtu_truck",
    "equivalent_conicity",
    "film",
    "hopf_points",
    "limit_cycles",
    "linear_critical_speed",
    "linearise",
    "load_profile",
    "load_settings",
    "load_vehicle",
    "mean_profile",
    "nonlinear_critical_speed",
    "paper_parameters",
    "piecewise_geometry",
    "profile_report",
    "quasi_static_descent",
    "register_creep_law",
    "register_element",
    "rolling_radius_curve",
    "root_locus",
    "save_profile",
    "save_vehicle",
    "simulate",
    "stability_map",
    "static_equilibrium",
    "steady_curve",
    "studies",
    "study",
    "switch_branch",
    "warm_up",
    "wheelsets_of",
    "with_free_lengths",
]
