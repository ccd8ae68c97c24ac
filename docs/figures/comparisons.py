"""Comparisons with other codes and published figures: what is computed, beside what source."""

import math
import sys
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from comparison_rows import REPOSITORY, Row, outside, plain, table, vectors, worst

from exudyn_wheelset import (
    FunctionSystem,
    Track,
    Wheelset,
    WheelsetWarning,
    contact_forces,
    contact_geometry,
    creep_force,
    equivalent_conicity,
    limit_cycles,
    linear_critical_speed,
    load_profile,
    rolling_radius_curve,
)
from exudyn_wheelset.catalogue.cooperrider_bogie import cooperrider_system
from exudyn_wheelset.creep import kalker_coefficients
from exudyn_wheelset.geometry.rolling_radius import rolling_radius_difference
from exudyn_wheelset.results.comfort import WEIGHTINGS
from exudyn_wheelset.track.spectra import spectra

OWN = REPOSITORY / "tests" / "reference"
MATERIAL = {"friction": 0.3, "shear_modulus": 82e9, "poisson": 0.28}


@dataclass(frozen=True)
class Comparison:
    """A section of the page; file: of the reference folder, if `rows` needs one from there."""

    title: str
    source: str
    rows: Callable[[], list[Row]]
    file: str = ""


def rigid_geometry() -> list[Row]:
    known = table(OWN / "contact_geometry_S1002_UIC60.csv")
    wheelset = Wheelset(1813.0, (1120.0, 112.0, 1120.0), 0.46, "S1002")
    found = contact_geometry(wheelset, Track("UIC60"), known["y_m"])
    left = np.array(known["side"]) == "left"
    columns = {
        "roll [rad]": (known["roll_rad"], found.roll),
        "height of the axle [m]": (known["z_m"], found.z),
    }
    for words, name, theirs in (
        ("place on the wheel [m]", "wheel_y", "wheel_y_m"),
        ("place on the rail [m]", "rail_y", "rail_y_m"),
        ("contact angle [rad]", "angle", "contact_angle_rad"),
        ("rolling radius [m]", "radius", "rolling_radius_m"),
    ):
        ours = np.where(left, getattr(found.left, name), getattr(found.right, name))
        columns[words] = (known[theirs], ours)
    places = [f"y = {1e3 * y:g} mm {s}" for y, s in zip(known["y_m"], known["side"], strict=True)]
    # At y = 0 contact lies flat on flat, where a micrometre of height moves it by tenths of a mm.
    off = np.flatnonzero(known["y_m"])
    names = [places[k] for k in off]
    rows = [worst(words, a[off], b[off], names) for words, (a, b) in columns.items()]
    theirs, ours = columns["place on the wheel [m]"]
    return [*rows, worst("place on the wheel [m] at y = 0, flat on flat", theirs[:1], ours[:1], ())]


def elastic_contact() -> list[Row]:
    known = table(OWN / "contact_forces_manchester_A22.csv")
    wheelset = Wheelset(1813.0, (1120.0, 112.0, 1120.0), 0.46, "S1002")
    wanted = np.array(
        [
            known["force_on_wheel_x_N"],
            known["force_on_wheel_lateral_tangent_toward_field_N"],
        ]
    )

    def solved(**options: Any) -> tuple[list[Any], Any]:
        """Patches of the left wheel, and creep forces (2, n), row by row."""
        patches = []
        for y, yaw, roll, z, spin in zip(
            *(known[n] for n in ("y_m", "yaw_rad", "roll_rad", "z_m", "spin_rad_per_s")),
            strict=True,
        ):
            axle = np.array([-math.sin(yaw), math.cos(yaw), 0.0]) * math.cos(roll)
            axle[2] = math.sin(roll)
            velocity = (2.0, 0.0, 0.0, *(spin * axle))
            pose = (0.0, y, z, roll, 0.0, yaw)
            patches.append(contact_forces(wheelset, Track("UIC60"), pose, velocity, **options).left)
        sums = [[sum(p.fx for p in row), sum(p.fy for p in row)] for row in patches]
        return patches, np.array(sums).T

    places = [f"y = {1e3 * y:g} mm" for y in known["y_m"]]
    # Flat on flat at 0, two patches in one at 5 mm: no ellipses, rows of their own.
    elliptic = np.flatnonzero((known["y_m"] != 0.0) & (known["y_m"] != 5e-3))
    names = [places[k] for k in elliptic]
    rows = []
    load = known["normal_force_N"]
    for normal in ("hertz", "virtual-penetration", "strips", "energy"):
        patches, _ = solved(normal=normal)
        ours = np.array([sum(p.normal_force for p in row) for row in patches])
        what = f'normal force [N], `normal="{normal}"`'
        rows.append(worst(what, load[elliptic], ours[elliptic], names, load[elliptic]))
        if normal in ("hertz", "strips"):
            rows.append(worst(f"{what}, flat on flat at y = 0", load[0], ours[0], (), load[0]))
        if normal == "hertz":
            for words, name, theirs in (
                ("longitudinal creepage [-]", "creep_x", "creep_x"),
                ("lateral creepage [-]", "creep_y", "creep_y_toward_field"),
                ("spin [1/m]", "spin", "spin_creep_per_m"),
            ):
                a = known[theirs][elliptic]
                b = np.array([getattr(patches[k][0], name) for k in elliptic])
                rows.append(worst(words, a, b, names))
    sizes = np.hypot(*wanted)[elliptic]
    for law in ("exact-table", "fastsim", "polach"):
        _, ours = solved(creep=law)
        what = f"creep force [N], `{law}`"
        rows.append(vectors(what, wanted[:, elliptic], ours[:, elliptic], names, sizes, "its size"))
    return rows


def creep_curves() -> list[Row]:
    known = table(OWN / "creep_curves_ab1_nu0.28.csv")
    patch = {"a": 5.5e-3, "b": 5.5e-3, "normal_force": 80e3, **MATERIAL}
    states = [known[name] for name in ("creep_x", "creep_y", "spin_per_m")]
    sets = np.array(known["set"])
    places = [f"{s} {x:.2g}, {y:.2g}, {w:.2g}" for s, x, y, w in zip(sets, *states, strict=True)]

    def against(column: str, words: str, law: str, chosen: Any, per: Any, of: str, **more: Any):
        theirs = np.array([known[f"F{axis}{column}_N"] for axis in "xy"])
        ours = np.array(creep_force(law, *states, **patch, **more)[:2])
        k = np.flatnonzero(chosen)
        share = per if np.isscalar(per) else per[k]
        return vectors(words, theirs[:, k], ours[:, k], [places[i] for i in k], share, of)

    limit = 0.3 * 80e3
    pure, every = np.isin(sets, ["lon", "lat"]), np.ones(len(sets), bool)
    rows = []
    for law in (
        "exact-table",
        "fastsim",
        "polach",
        "polach-kalker",
        "shen-hedrick-elkins",
        "vermeulen-johnson",
    ):
        more = {"grid": 50} if law == "fastsim" else {}
        rows.append(against("", f"`{law}`, pure creep [N]", law, pure, limit, "mu N", **more))
        rows.append(against("", f"`{law}`, with spin [N]", law, ~pure, limit, "mu N", **more))
    plain_fastsim = {"grid": 50, "flexibilities": "one"}
    words = '`fastsim`, `flexibilities="one"`, beside its FASTSIM [N]'
    rows.append(against("_fastsim", words, "fastsim", every, limit, "mu N", **plain_fastsim))
    size = np.hypot(known["Fx_linear_N"], known["Fy_linear_N"])
    words = "`linear` beside its linear theory [N]"
    return [*rows, against("_linear", words, "linear", every, size, "its size")]


def creep_with_spin() -> list[Row]:
    known = table(outside("creep_spin_contact.csv"))
    names = ("creep_x", "creep_y", "spin_per_m", "a_m", "b_m", "normal_force_N")
    states = [known[name] for name in names]
    theirs = np.array([known["Fx_N"], known["Fy_N"]])
    limit = MATERIAL["friction"] * states[-1]
    places = [f"a/b = {known['a_over_b'][k]:g}" for k in range(len(limit))]
    rows = []
    for law, more in (
        ("exact", {"cells_along": 40, "cells_across": 40}),
        ("exact-table", {}),
        ("fastsim", {"grid": 50}),
        ("polach", {}),
        ("shen-hedrick-elkins", {}),
    ):
        found = creep_force(law, *states, *MATERIAL.values(), **more)
        rows.append(vectors(f"`{law}` [N]", theirs, np.array(found[:2]), places, limit, "mu N"))
        if law.startswith("exact"):
            arm = limit * np.sqrt(known["a_m"] * known["b_m"])
            moment = worst(f"`{law}`, moment [N m]", known["Mz_Nm"], found[2], places, arm)
            said = f"{moment.difference} of mu N sqrt(ab)"
            rows.append(Row(moment.what, moment.theirs, moment.ours, said))
    return rows


def kalkers_coefficients() -> list[Row]:
    """Slopes of the exact law at a hundredth of saturation, nu = 0.25, on 40 x 40 cells."""
    known = table(OWN / "kalker_coefficients.csv")
    ratios = {"a/b=0.2": (1e-3, 5e-3), "a/b=0.5": (2e-3, 4e-3), "a/b=1.0": (4e-3, 4e-3)}
    ratios["b/a=0.5"] = (4e-3, 2e-3)
    rows = []
    for name, k in (("C11", 0), ("C22", 1), ("C23", 2)):
        theirs, slopes, table_slopes = [], [], []
        for ratio, (a, b) in ratios.items():
            theirs.append(known[f"{name}_nu025"][list(known["axis_ratio"]).index(ratio)])
            length = 82e9 * a * b * (math.sqrt(a * b) if k == 2 else 1.0)
            step = 0.01 * 0.3 * 80e3 / (length * theirs[-1])
            creep = np.zeros(3)
            creep[k] = step
            for law, found in (("exact", slopes), ("exact-table", table_slopes)):
                force = creep_force(law, *creep, a, b, 80e3, 0.3, 82e9, 0.25)
                found.append(-float(force[min(k, 1)]) / (length * step))
        for law, found in (("exact", slopes), ("exact-table", table_slopes)):
            scale = np.array(theirs)
            rows.append(worst(f"{name}, slope of `{law}`", theirs, found, list(ratios), scale))
    between = [float(c) for c in kalker_coefficients(4e-3, 4e-3, 0.25)[:3]]
    round_patch = list(known["axis_ratio"]).index("a/b=1.0")
    nodes = [known[f"{name}_nu025"][round_patch] for name in ("C11", "C22", "C23")]
    return [*rows, worst("the package's table, a = b", nodes, between, ("C11", "C22", "C23"))]


def conicity() -> list[Row]:
    folder = outside("en15302")
    track = Track(load_profile(folder / "SUIC519A.dat"), origin_half_distance=0.75, inclination=0.0)
    level = 2e-5 * np.arange(-450, 451)
    rows = []
    for case, letter in {"E1": "A", "E2": "B", "E3": "H", "E4": "I"}.items():
        wheel = load_profile(folder / f"RUIC519{letter}.dat")
        wheelset = Wheelset(1000.0, (600.0, 100.0, 600.0), 0.46, wheel)
        known = np.loadtxt(folder / f"ben_{case}.dat")
        amplitude, theirs, upper, lower = 1e-3 * known[:, 0], known[:, 1], known[:, 4], known[:, 5]
        # Differences only: the values are the standard's.
        rolling = rolling_radius_curve(wheelset, track, 9e-3)
        for words, y, difference in (
            ("level axle", level, rolling_radius_difference(wheelset, track, level, True)),
            ("rolling, y at rail level", rolling.y, rolling.rolling_radius_difference),
        ):
            ours = equivalent_conicity(y, difference, amplitude)
            off = ours - theirs
            k, rms = int(np.argmax(np.abs(off))), np.sqrt(np.mean(off**2))
            inside = int(np.sum((ours <= upper) & (ours >= lower)))
            said = f"rms {rms:.4f}, largest {off[k]:+.3f} at {known[k, 0]:g} mm"
            count = f"{len(known)} amplitudes"
            rows.append(Row(f"{case}, {words}", count, f"{inside} within the widened limits", said))
    return rows


def kaas_petersen() -> list[Row]:
    system = cooperrider_system()
    hopf = linear_critical_speed(system, 20.0, 120.0)
    branch = limit_cycles(system, hopf, (55.0, 71.0), intervals=80)
    (fold,) = [one for one in branch.folds if one.side == "lowest"]
    return [
        plain("linear critical speed [m/s], Kaas-Petersen", 68.64, hopf.speed, 3),
        plain("its frequency [Hz], Kaas-Petersen", 4.00, hopf.frequency, 3),
        plain("linear critical speed [m/s], AUTO-07p", 68.6444, hopf.speed, 4),
        plain("fold of the limit cycles [m/s], AUTO-07p, 40 x 4 points", 66.6604, fold.speed, 4),
    ]


def table_2() -> list[Row]:
    sys.path.insert(0, str(REPOSITORY / "models"))
    import table2

    with warnings.catch_warnings():
        # That Polach's law and the cubic one are stiff beside the exact one is known there.
        warnings.simplefilter("ignore", WheelsetWarning)
        found = table2.run(tuple(table2.PUBLISHED))
    return [
        plain(f"`{name}`, set {k + 1} [m/s]", published[k], found[name][k], 1)
        for name, published in table2.PUBLISHED.items()
        for k in range(3)
    ]


def weightings() -> list[Row]:
    gains = {
        "Wd": {1: 1.011, 2: 0.890, 4: 0.512, 8: 0.253},
        "Wk": {1: 0.482, 2: 0.531, 4: 0.967, 8: 1.036, 16: 0.769},
        "Wb": {1: 0.391, 4: 0.822, 8: 1.056, 16: 0.918},
    }
    rows = []
    for name, known in gains.items():
        ours = np.abs(WEIGHTINGS[name].response(np.array(list(known), dtype=float)))
        places = [f"{f} Hz" for f in known]
        rows.append(worst(f"{name}, gain", list(known.values()), ours, places))
    return rows


def irregularity() -> list[Row]:
    band = 2 * math.pi / 25.0, 2 * math.pi / 3.0
    rows = []
    for level, known in {
        "low": {"vertical": (5.477, 0.984), "alignment": (3.970, 0.714)},
        "high": {"vertical": (8.964, 1.611), "alignment": (6.750, 1.213)},
    }.items():
        own = spectra(f"ERRI B176 {level}")
        for kind, (whole, part) in known.items():
            for words, theirs, limits in (("all wavelengths", whole, ()), ("3-25 m", part, band)):
                ours = 1e3 * math.sqrt(own[kind].variance(*limits))
                rows.append(plain(f"{level}, {kind}, {words} [mm]", theirs, ours, 3))
    return rows


def van_der_pol() -> list[Row]:
    def rates(states: Any, mu: float) -> Any:
        x, v = states.T
        return np.stack([v, mu * (1.0 - x**2) * v - x], axis=1)

    system = FunctionSystem(
        "van der Pol",
        lambda state, mu: rates(state[None], mu)[0],
        ("x", "v"),
        (1.0, 1.0),
        derivatives_function=rates,
    )
    branch = limit_cycles(system, [2.0, 0.0], (0.9, 1.0), start_speed=0.9, intervals=60)
    last = branch.orbits[int(np.argmax(branch.speed))]
    return [plain("period at mu = 1 [s]", 6.6632868593, last.period, 10)]


CONTACT = "the program CONTACT (E. A. H. Vollebregt), full half-space solution"
COMPARISONS = (
    Comparison(
        "Rigid contact of S1002 on UIC60",
        "the program CONTACT at 1 N a wheel, the rigid limit; `contact_geometry_S1002_UIC60.csv`",
        rigid_geometry,
    ),
    Comparison(
        "Elastic contact: Manchester benchmark A-2.2",
        f"{CONTACT}, 10 kN a wheel, 2 m/s, yaw 2.4 mrad a mm; `contact_forces_manchester_A22.csv`",
        elastic_contact,
    ),
    Comparison(
        "Creep curves of a round patch",
        f"{CONTACT}, its FASTSIM and linear theory, places are set, creepages, spin [1/m]; "
        "`creep_curves_ab1_nu0.28.csv`",
        creep_curves,
    ),
    Comparison(
        "Creep with spin on five shapes of patch",
        f"{CONTACT}, 40 x 40 cells, to twice saturation; not part of the project",
        creep_with_spin,
        "creep_spin_contact.csv",
    ),
    Comparison(
        "Kalker's coefficients",
        "J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, 1990, table E.3, "
        "nu = 0.25; `kalker_coefficients.csv`",
        kalkers_coefficients,
    ),
    Comparison(
        "Equivalent conicity",
        "EN 15302, cases E1 to E4, reference values without roll; not part of the project",
        conicity,
        "en15302",
    ),
    Comparison(
        "Bogie of Kaas-Petersen",
        "C. Kaas-Petersen, Acta Mechanica 61 (1986) 89-107; AUTO-07p on the same equations",
        kaas_petersen,
    ),
    Comparison(
        "Table 2 of the paper",
        "linear critical speeds as published ([what the paper leaves out](table2.md))",
        table_2,
    ),
    Comparison(
        "Frequency weightings of ride comfort",
        "ISO 2631-1:1997 and EN 12299:2009, tabulated gains",
        weightings,
    ),
    Comparison(
        "Track irregularity, root mean squares",
        "ERRI B176: constants on which three independent codes agree, integrated",
        irregularity,
    ),
    Comparison(
        "Van der Pol's limit cycle",
        "C. M. Andersen and J. F. Geer, SIAM J. Appl. Math. 42 (1982) 678-693",
        van_der_pol,
    ),
)
