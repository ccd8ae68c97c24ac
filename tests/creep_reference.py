"""The creep curves that the program CONTACT computed for one patch, as arrays.

Hertz ellipse a = b = 5.5 mm, N = 80 kN, mu = 0.3, G = 82 GPa, nu = 0.28. Full CONTACT (error about
0.5 %), FASTSIM with one flexibility and parabolic bound, Kalker's linear theory.
"""

import csv
from pathlib import Path

import numpy as np

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
