"""Wrong descriptions, geometry and creep: refused, or warned of, naming value and mend."""

import math

import exudyn as exu
import numpy as np
import pytest
from wrong_inputs import check, rows

import exudyn_wheelset as ew
from exudyn_wheelset import Track, Wheelset, WheelsetError, WheelsetWarning, load_profile
from exudyn_wheelset.geometry.conicity import equivalent_conicity, kinematic_oscillation
from exudyn_wheelset.geometry.rolling_radius import rolling_radius_curve
from exudyn_wheelset.profiles import shapes

INERTIA = (600.0, 100.0, 600.0)
Y = np.linspace(-0.01, 0.01, 201)
FLAT = {"a": 5e-3, "b": 5e-3, "normal_force": 8e4, "friction": 0.3, "shear_modulus": 8e10}
PATCH = {**FLAT, "poisson": 0.28}


def wheelset(**changes):
    return Wheelset(
        **{"mass": 1e3, "inertia": INERTIA, "radius": 0.46, "wheel": "S1002", **changes}
    )


def force(law="polach", creep_x=1e-3, creep_y=0.0, spin=0.0, **changes):
    return ew.creep_force(law, creep_x, creep_y, spin, **{**PATCH, **changes})


def report(**options):
    return ew.profile_report("S1002", **options)


def psd(*arguments, **options):
    return ew.Irregularity.from_psd("ERRI B176 low", *arguments, **options)


def created(**options):
    mbs = exu.SystemContainer().AddSystem()
    return ew.create_wheelset(mbs, wheelset(), Track("UIC60"), **options)


def profile(**changes):
    y = np.linspace(-0.02, 0.02, 81)
    return ew.Profile(**{"name": "mine", "kind": "wheel", "y": y, "z": 0.05 * y, **changes})


PROFILES = {
    "unknown name": (lambda: load_profile("S1003"), ["S1003", "S1002"]),
    "missing file": (lambda: load_profile("no/where.whl"), ["no/where.whl", "names are"]),
    "a folder": (lambda: load_profile("/"), ["/"]),
    "a number": (lambda: load_profile(3.0), ["3.0", "give"]),
    "None": (lambda: load_profile(None), ["None", "give"]),
    "wrong kind": (lambda: load_profile("S1002", kind="rail"), ["S1002", "rail"]),
    "unknown kind": (lambda: load_profile("S1002", kind="weel"), ["weel", "wheel"]),
    "unknown unit": (lambda: load_profile("S1002", unit="mile"), ["mile", "mm"]),
    "unknown format": (lambda: load_profile("S1002", format="xls"), ["xls", "miniprof"]),
    "unknown side": (lambda: load_profile("S1002", side="middle"), ["middle", "left"]),
    "negative smoothing": (lambda: load_profile("S1002", smoothing=-1e-6), ["-1e-06"]),
    "smoothing in mm": (lambda: load_profile("S1002", smoothing=0.05), ["0.05"]),
    "smoothing a word": (lambda: load_profile("S1002", smoothing="much"), ["much", "auto"]),
    "NaN in points": (lambda: profile(z=np.full(81, np.nan)), ["mine", "nan", "remove"]),
    "y and z of two lengths": (lambda: profile(z=np.zeros(5)), ["81", "5"]),
    "y going back": (lambda: profile(y=np.tile([0.0, 0.01, 0.005], 27)), ["mine"]),
    "three points": (lambda: profile(y=[0, 0.01, 0.02], z=[0, 0, 0]), ["3", "points"]),
    "points in mm": (lambda: profile(y=np.linspace(-60, 60, 81), z=np.zeros(81)), ["mm"]),
    "points as a word": (lambda: profile(y="abc"), ["mine"]),
    "cone upside down": (lambda: shapes.cone(-0.05), ["-0.05"]),
    "cone of 56 degrees": (lambda: load_profile("cone_1.5"), ["1.5", "0 to 1"]),
    "cone of a word": (lambda: load_profile("cone_steep"), ["cone_steep"]),
    "AAR taper": (lambda: shapes.aar_1_20(taper=2.0), ["use"]),
    "height outside": (lambda: load_profile("S1002").height(0.2), ["0.2", "reaches from"]),
    "height of NaN": (lambda: load_profile("S1002").height(math.nan), ["nan"]),
    "resampled at zero": (lambda: load_profile("S1002").resampled(0.0), ["0"]),
    "rotated upside down": (lambda: load_profile("UIC60").rotated(3.0), ["3"]),
    "outliers at zero": (lambda: load_profile("UIC60").with_outliers_removed(0.0), ["0"]),
    "report of a pair of wheels": (
        lambda: ew.profile_report(load_profile("S1002"), "S1002"),
        ["S1002", "give"],
    ),
    "report of a number": (lambda: ew.profile_report(3.0), ["3.0", "give"]),
    "report at a gauge of a word": (lambda: report(gauge="wide"), ["gauge", "wide", "in m"]),
    "report with half a sample": (lambda: report(samples=0.5), ["samples", "0.5", "whole"]),
    "report, misspelt": (lambda: report(gage=1.435), ["gage", "gauge"]),
    "save as pdf": (
        lambda: ew.save_profile(load_profile("S1002"), "/dev/null/x", format="pdf"),
        ["pdf", "simpack"],
    ),
    "save a wheel as a rail": (
        lambda: ew.save_profile(load_profile("S1002"), "/dev/null/x.prr"),
        ["prr"],
    ),
    "save nowhere": (
        lambda: ew.save_profile(load_profile("S1002"), "/dev/null/x.prw"),
        ["/dev/null"],
    ),
}
DESCRIPTIONS = {
    "mass in tonnes": (lambda: wheelset(mass=1.5), ["1.5", "kg"]),
    "mass zero": (lambda: wheelset(mass=0), ["mass = 0", "positive", "kg"]),
    "mass negative": (lambda: wheelset(mass=-3), ["-3", "kg"]),
    "mass a word": (lambda: wheelset(mass="1500"), ["'1500'", "number in kg"]),
    "radius in mm": (lambda: wheelset(radius=460), ["460", "m"]),
    "radius NaN": (lambda: wheelset(radius=math.nan), ["nan", "m"]),
    "two moments of inertia": (lambda: wheelset(inertia=(1, 2)), ["2", "3 numbers"]),
    "inertia no body has": (lambda: wheelset(inertia=(1, 1, 900)), ["900", "sum"]),
    "a rail as a wheel": (lambda: wheelset(wheel="UIC60"), ["UIC60", "give a wheel"]),
    "gauge in mm": (lambda: Track("UIC60", gauge=1435), ["1435", "m"]),
    "gauge of a tram of ants": (lambda: Track("UIC60", gauge=-1.0), ["-1.0", "m"]),
    "gauge depth in mm": (lambda: Track("UIC60", gauge_depth=14), ["14", "m"]),
    "inclination as 40": (lambda: Track("UIC60", inclination=40), ["40", "1/40"]),
    "inclination a word": (lambda: Track("UIC60", inclination="1:40"), ["1:40", "number"]),
    "a wheel as a rail": (lambda: Track("S1002"), ["S1002", "give a rail"]),
    "two ways to place rails": (
        lambda: Track("UIC60", datum_half_distance=0.75, origin_half_distance=0.75),
        ["not both"],
    ),
    "friction of 30": (lambda: ew.Contact(friction=30), ["30", "5"]),
    "friction negative": (lambda: ew.Contact(friction=-0.3), ["-0.3"]),
    "modulus in GPa": (lambda: ew.Contact(shear_modulus=82), ["82", "82e9"]),
    "poisson of 0.7": (lambda: ew.Contact(poisson=0.7), ["0.7", "0.5"]),
    "mass misspelt": (lambda: wheelset(masss=3), ["masss", "'mass'"]),
    "a wheelset of its mass": (lambda: Wheelset(1500.0), ["Wheelset", "inertia", "missing"]),
    "gauge misspelt": (lambda: Track("UIC60", gage=1.435), ["gage", "'gauge'"]),
    "a track of nothing": (lambda: Track(), ["Track", "rail", "missing"]),
    "length of roughness a word": (lambda: psd(1, "long"), ["length", "long", "in m"]),
    "start of roughness a word": (lambda: psd(1, start="0"), ["start", "'0'", "in m"]),
    "kind of roughness": (lambda: psd(1, kinds=["aligment"]), ["aligment", "'alignment'"]),
    "seed misspelt": (lambda: psd(sed=1), ["sed", "'seed'"]),
    "roughness of a number": (lambda: ew.Irregularity.from_psd(5, 1), ["5", "ERRI B176 low"]),
    "springs of a letter": (lambda: ew.Suspension("a"), ["Suspension", "stiffness", "missing"]),
    "half distance a letter": (lambda: ew.Suspension("a", (1, 1, 1)), ["half_distance", "in m"]),
    "two stiffnesses": (lambda: ew.Suspension(1.0, (1e6, 1e6)), ["stiffness", "3 numbers"]),
    "stiffness negative": (lambda: ew.Suspension(1.0, (1e6, -1.0, 0)), ["-1.0", "N/m"]),
    "stiffness misspelt": (lambda: ew.Suspension(1.0, stifness=1), ["stifness", "'stiffness'"]),
    "a frame without a track": (
        lambda: ew.WheelsetOnFrame(wheelset(), "UIC60", ew.Suspension(1.0, (1, 1, 1)), 1e5),
        ["track", "UIC60", "Track"],
    ),
    "20 mm aside": (lambda: created(lateral_offset=0.02), ["20 mm", "inside", "lateral_offset"]),
    "20 mm aside in mm": (lambda: created(lateral_offset=20), ["20", "metres"]),
    "unknown law": (lambda: ew.Contact(creep="pollach"), ["pollach", "polach"]),
    "unknown normal": (lambda: ew.Contact(normal="herz"), ["herz", "hertz"]),
    "unknown option": (lambda: ew.Contact(frictoin=0.3), ["frictoin", "friction"]),
}
GEOMETRY = {
    "shift in mm": (lambda: ew.contact_geometry(wheelset(), Track("UIC60"), 3.0), ["3"]),
    "shift NaN": (lambda: ew.contact_geometry(wheelset(), Track("UIC60"), math.nan), ["finite"]),
    "shift a word": (lambda: ew.contact_geometry(wheelset(), Track("UIC60"), "left"), ["left"]),
    "shift a figure in quotes": (
        lambda: ew.contact_geometry(wheelset(), Track("UIC60"), "0"),
        ["'0'", "numbers in m"],
    ),
    "yaw misspelt": (
        lambda: ew.contact_geometry(wheelset(), Track("UIC60"), 0.0, yow=0.0),
        ["yow", "'yaw'"],
    ),
    "reach misspelt": (
        lambda: rolling_radius_curve(wheelset(), Track("UIC60"), reech=5e-3),
        ["reech", "'reach'"],
    ),
    "reach a word": (
        lambda: rolling_radius_curve(wheelset(), Track("UIC60"), "far"),
        ["reach", "far", "in m"],
    ),
    "unknown method": (
        lambda: ew.contact_geometry(wheelset(), Track("UIC60"), 0.0, method="newton"),
        ["newton", "root"],
    ),
    "shapes that do not fit": (
        lambda: ew.contact_geometry(wheelset(), Track("UIC60"), [0.0, 0.001], [0.0, 0.0, 0.0]),
        ["shape"],
    ),
    "a truck for a wheelset": (
        lambda: ew.contact_geometry("S1002", Track("UIC60"), 0.0),
        ["S1002"],
    ),
    "a profile for a track": (lambda: ew.contact_geometry(wheelset(), "UIC60", 0.0), ["UIC60"]),
    "half range in mm": (
        lambda: ew.piecewise_geometry(wheelset(), Track("UIC60"), half_range=12),
        ["12", "m"],
    ),
    "unknown representation": (
        lambda: ew.piecewise_geometry(wheelset(), Track("UIC60"), representation="spline"),
        ["spline", "cubic"],
    ),
    "reach in mm": (lambda: rolling_radius_curve(wheelset(), Track("UIC60"), 15), ["15", "m"]),
    "unknown shift": (
        lambda: rolling_radius_curve(wheelset(), Track("UIC60"), shift="top"),
        ["top", "rail"],
    ),
    "spacing zero": (
        lambda: rolling_radius_curve(wheelset(), Track("UIC60"), spacing=0.0),
        ["0"],
    ),
    "wheels between the rails": (
        lambda: ew.contact_geometry(wheelset(tape_half_distance=0.6), Track("UIC60"), 0.0),
        ["tape_half_distance"],
    ),
    "pose of five numbers": (
        lambda: ew.contact_forces(wheelset(), Track("UIC60"), (0,) * 5, (20, 0, 0, 0, 43, 0)),
        ["give 6"],
    ),
    "velocity of words": (
        lambda: ew.contact_forces(wheelset(), Track("UIC60"), (0,) * 6, "fast"),
        ["fast"],
    ),
}
CONICITY = {
    "amplitude in mm": (lambda: equivalent_conicity(Y, 0.1 * Y, 3.0), ["3", "amplitude"]),
    "amplitude zero": (lambda: equivalent_conicity(Y, 0.1 * Y, 0.0), ["0", "positive"]),
    "amplitude NaN": (lambda: equivalent_conicity(Y, 0.1 * Y, math.nan), ["nan"]),
    "amplitude a word": (lambda: equivalent_conicity(Y, 0.1 * Y, "large"), ["large"]),
    "y falling": (lambda: equivalent_conicity(-Y, 0.1 * Y, 3e-3), ["sort"]),
    "lengths": (lambda: equivalent_conicity(Y, Y[:-1], 3e-3), ["201", "200"]),
    "one point": (lambda: equivalent_conicity([0.0], [0.0], 3e-3), ["1"]),
    "NaN in radii": (lambda: equivalent_conicity(Y, Y * math.nan, 3e-3), ["finite"]),
    "unknown method": (
        lambda: equivalent_conicity(Y, 0.1 * Y, 3e-3, method="klingel"),
        ["klingel", "integration"],
    ),
    "spacing in mm": (lambda: equivalent_conicity(Y, 0.1 * Y, 3e-3, 1500), ["1500", "m"]),
    "radius negative": (lambda: kinematic_oscillation(Y, 0.1 * Y, 3e-3, radius=-1), ["-1", "m"]),
    "no position of rest": (lambda: equivalent_conicity(Y, 0.1 * Y + 1.0, 3e-3), ["proportion"]),
}
CREEP = {
    "unknown law": (lambda: force("fast-sim"), ["fast-sim", "fastsim"]),
    "law a number": (lambda: force(3), ["3"]),
    "creepage NaN": (lambda: force(creep_x=math.nan), ["creep_x", "finite"]),
    "creepage a word": (lambda: force(creep_y="small"), ["creep_y", "small"]),
    "semi-axis negative": (lambda: force(a=-5e-3), ["-0.005", "a"]),
    "semi-axis in mm": (lambda: force(b=5.0), ["5", "b"]),
    "semi-axis zero": (lambda: force(b=0.0), ["b", "0"]),
    "friction negative": (lambda: force(friction=-0.1), ["-0.1", "friction"]),
    "modulus in GPa": (lambda: force(shear_modulus=82), ["82", "shear_modulus"]),
    "poisson of 1": (lambda: force(poisson=1.0), ["1", "poisson"]),
    "parameter of another law": (lambda: force(kA=0.3), ["kA", "polach"]),
    "parameter out of range": (
        lambda: force("polach-2005", slip_reduction=3.0),
        ["slip_reduction", "3"],
    ),
    "arguments missing": (lambda: ew.creep_force("polach", 1e-3), ["creep_y", "missing", "spin"]),
    "creepage in quotes": (lambda: force(creep_x="1e-3"), ["creep_x", "'1e-3'"]),
    "half a cell": (lambda: force("fastsim", grid=2.5), ["2.5"]),
    "shapes that do not fit": (lambda: force(creep_x=[1e-3, 2e-3], spin=[0.0] * 3), ["shape"]),
    "register a taken name": (lambda: ew.register_creep_law("polach", force), ["polach", "name"]),
    "register no function": (lambda: ew.register_creep_law("mine", 3), ["3"]),
    "register another function": (
        lambda: ew.register_creep_law("mine", lambda creep: 0.0),
        ["compiled", "creep_x"],
    ),
}
TABLE = rows(
    profiles=PROFILES, descriptions=DESCRIPTIONS, geometry=GEOMETRY, conicity=CONICITY, creep=CREEP
)


@pytest.mark.parametrize("name", TABLE)
def test_a_wrong_input_is_refused_with_value_and_mend(name):
    check(TABLE[name])


@pytest.mark.parametrize(
    "call",
    [
        lambda: wheelset(inertia=(1e6, 1e5, 1e6)),
        lambda: force(b=5.0),
        lambda: created(lateral_offset=0.02),
    ],
)
def test_a_warning_points_at_the_line_of_the_user(call):
    with pytest.warns(WheelsetWarning) as caught:
        call()
    assert {warning.filename for warning in caught} == {__file__}


@pytest.mark.parametrize(
    ("name", "missing"),
    [
        ("all_branches", "vehicle"),
        ("contact_view", "wheelset"),
        ("create_wheelset", "mbs"),
        ("design", "vehicle"),
        ("equivalent_conicity", "y"),
        ("piecewise_geometry", "wheelset"),
        ("stability_map", "vehicle"),
        ("steady_curve", "vehicle"),
        ("switch_branch", "vehicle"),
    ],
)
def test_a_missing_argument_is_named(name, missing):
    with pytest.raises(WheelsetError, match=f"{name}: missing .*'{missing}'; it takes {missing}"):
        getattr(ew, name)()
