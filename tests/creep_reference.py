"""The creep curves that the program CONTACT computed for one patch, as arrays.

Hertz ellipse a = b = 5.5 mm, N = 80 kN, mu = 0.3, G = 82 GPa, nu = 0.28. Full CONTACT (error about
0.5 %), FASTSIM with one flexibility and parabolic bound, Kalker's linear theory.
"""

import csv
import os
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
FOLDER = Path(__file__).parent / "reference"
FRICTION_FORCE = 0.3 * 80e3
PATCH = {
    "a": 5.5e-3,
    "b": 5.5e-3,
    "normal_force": 80e3,
    "friction": 0.3,
    "shear_modulus": 82e9,
    "poisson": 0.28,
}

with (FOLDER / "creep_curves_ab1_nu0.28.csv").open() as _file:
    _ROWS = list(csv.DictReader(_file))


def column(name, of_set=None):
    return np.array([float(r[name]) for r in _ROWS if of_set in (None, r["set"])])


def creepages(of_set=None):
    return {
        "creep_x": column("creep_x", of_set),
        "creep_y": column("creep_y", of_set),
        "spin": column("spin_per_m", of_set),
    }


SETS = list(dict.fromkeys(r["set"] for r in _ROWS))


def spin_set():
    """States of `creep_force` and (Fx, Fy, Mz) of 475 full CONTACT results with spin, as arrays.

    a/b 0.2 to 5, 40 x 40 cells. The file is not part of the project: the test is skipped where
    EXUDYN_WHEELSET_REFERENCE (or shared/reference beside the repository) does not hold it.
    """
    folder = os.environ.get("EXUDYN_WHEELSET_REFERENCE", REPOSITORY.parent / "shared" / "reference")
    path = Path(folder) / "creep_spin_contact.csv"
    if not path.is_file():
        pytest.skip("creep_spin_contact.csv not found: set EXUDYN_WHEELSET_REFERENCE")
    with path.open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    columns = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    names = ("creep_x", "creep_y", "spin_per_m", "a_m", "b_m", "normal_force_N")
    keys = ("creep_x", "creep_y", "spin", "a", "b", "normal_force")
    states = {key: columns[name] for key, name in zip(keys, names, strict=True)}
    steel = {"friction": 0.3, "shear_modulus": 82e9, "poisson": 0.28}
    states |= {name: np.full(len(rows), value) for name, value in steel.items()}
    return states, tuple(columns[name] for name in ("Fx_N", "Fy_N", "Mz_Nm"))
