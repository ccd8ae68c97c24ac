"""Profiled wheels on profiled rails for the multibody engine Exudyn.

from exudyn_wheelset import Track, Wheelset, create_wheelset
items = create_wheelset(mbs, Wheelset(...), Track(rail="UIC60"), speed=30)
"""

from importlib import metadata

try:
    __version__ = metadata.version("exudyn-wheelset")
except metadata.PackageNotFoundError:
    __version__ = "0+source"

_PLACES = {
    "AirSpring": "vehicles.elements",
    "AnalysisError": "errors",
    "AntiRollBar": "vehicles.elements",
    "AxleBox": "vehicles.elements",
    "Branch": "stability.hunting.branch",
    "BumpStop": "vehicles.elements",
    "Bushing": "vehicles.elements",
    "CentrePlate": "vehicles.elements",
    "CoilNest": "vehicles.elements",
    "CoilSpring": "vehicles.elements",
    "Contact": "contact.descriptions",
    "ContactError": "errors",
    "Damper": "vehicles.elements",
    "DynamicSystem": "systems.system",
    "Element": "vehicles.elements",
    "ExudynSystem": "systems.exudyn_system",
    "FrictionDamper": "vehicles.elements",
    "FrictionWedge": "vehicles.elements",
    "FunctionSystem": "systems.function_system",
    "LateralParameters": "catalogue.lateral_parameters",
    "LateralWheelset": "catalogue.lateral_wheelset",
    "LeafSpring": "vehicles.elements",
    "LinkSuspension": "vehicles.elements",
    "Ending": "results.endings",
    "MaxwellDamper": "vehicles.elements",
    "Motion": "results.motion",
    "Outcome": "results.endings",
    "Profile": "profiles",
    "ProfileError": "errors",
    "RailElasticity": "coupling.elastic_rails",
    "RailSection": "contact.rail_section",
    "SettingsError": "errors",
    "SideBearer": "vehicles.elements",
    "Spring": "vehicles.elements",
    "Suspension": "catalogue.wheelset_on_frame",
    "Track": "contact.descriptions",
    "TractionRod": "vehicles.elements",
    "Truck": "catalogue.truck",
    "Vehicle": "vehicles.description",
    "VehicleBuilder": "vehicles.builder",
    "VehicleError": "errors",
    "WheelRailContact": "coupling.wheel_rail",
    "Wheelset": "contact.descriptions",
    "WheelsetError": "errors",
    "WheelsetWarning": "errors",
    "WheelsetItems": "coupling.registration",
    "WheelsetOnFrame": "catalogue.wheelset_on_frame",
    "Curve": "track.layout",
    "Straight": "track.layout",
    "Transition": "track.layout",
    "Layout": "track.layout",
    "Irregularity": "track.irregularity",
    "Spectrum": "track.spectra",
    "basin": "stability.maps.basins",
    "citation": "front.citation",
    "contact_energy": "contact.wheelset_contact",
    "contact_forces": "contact.wheelset_contact",
    "contact_geometry": "geometry.rigid",
    "contact_view": "front.contact_view",
    "create_wheelset": "coupling.create",
    "creep_force": "creep",
    "critical_disturbance": "stability.hunting.disturbance",
    "design": "stability.design",
    "dtu_truck": "catalogue.truck",
    "equivalent_conicity": "geometry.conicity",
    "film": "front.film",
    "hopf_points": "stability.linear.crossings",
    "limit_cycles": "stability.hunting.limit_cycles",
    "linear_critical_speed": "stability.linear.critical_speed",
    "linearise": "stability.linear.linearisation",
    "load_profile": "profiles",
    "load_vehicle": "vehicles.files",
    "load_settings": "front.settings",
    "mean_profile": "profiles",
    "nonlinear_critical_speed": "stability.hunting.nonlinear",
    "paper_parameters": "catalogue.lateral_parameters",
    "piecewise_geometry": "geometry.piecewise",
    "profile_report": "front.profile_report",
    "rolling_radius_curve": "geometry.rolling_radius",
    "quasi_static_descent": "stability.hunting.descent",
    "register_creep_law": "creep",
    "register_element": "vehicles.files",
    "root_locus": "stability.linear.linearisation",
    "save_profile": "profiles",
    "save_vehicle": "vehicles.files",
    "simulate": "stability.simulation",
    "stability_map": "stability.maps.stability_map",
    "all_branches": "stability.hunting.all_branches",
    "switch_branch": "stability.hunting.branch_switching",
    "Study": "studies",
    "study": "studies",
    "SteadyCurve": "systems.steady_curve",
    "steady_curve": "systems.steady_curve",
    "add_frame_loads": "coupling.moving_frame",
    "TrackFrame": "coupling.track_frame",
    "static_equilibrium": "vehicles.statics",
    "warm_up": "front.warming",
    "wheelsets_of": "coupling.registration",
    "with_free_lengths": "vehicles.statics",
}

_FOLDERS = ("catalogue", "studies")

__all__ = sorted([*_PLACES, *_FOLDERS, "__version__"])


def __getattr__(name: str) -> object:
    # Names load on first use: reading a profile need not import Exudyn and the compiler.
    from importlib import import_module

    if name in _FOLDERS:
        return import_module(f"exudyn_wheelset.{name}")
    if name in _PLACES:
        value = getattr(import_module(f"exudyn_wheelset.{_PLACES[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'exudyn_wheelset' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
