"""The kernels as plain Python, and compiled with checked indices, give the compiled forces.

Same sources, three ways to run them: compiled (numba, arithmetic as of real numbers), interpreted
(NUMBA_DISABLE_JIT=1: strict IEEE arithmetic, numpy's own bounds checks) and compiled with
NUMBA_BOUNDSCHECK=1, where an index out of bounds is an IndexError. Tolerance: sums in another
order, through Newton iterations that end at 1e-5 to 1e-6 of the energy model (contact/ritz.py).
"""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

JOBS = (
    ("hertz", "polach"),
    ("hertz", "fastsim"),
    ("hertz", "exact-table"),
    ("hertz-local", "linear"),
    ("virtual-penetration", "shen-hedrick-elkins"),
    ("energy", "polach-kalker"),
    ("strips", "fastsim"),
)
PROGRAM = """
import json, sys
import numpy as np
from exudyn_wheelset import (
    Track, Wheelset, contact_forces, contact_geometry, create_wheelset, creep_force, simulate)
import exudyn as exu
jobs = json.loads(sys.argv[1])
axle = Wheelset(mass=1500, inertia=(800, 110, 800), radius=0.46, wheel="S1002")
track = Track(rail="UIC60")
given = []
for normal, creep in jobs:
    for y in (0.0, 5.6e-3):
        lying = contact_geometry(axle, track, [y], 2e-3)
        pose = (0, y, lying.z[0] - 6e-5, lying.roll[0], 0, 2e-3)
        found = contact_forces(axle, track, pose, (20, 0.01, -0.01, 0, 43, 0), normal, creep)
        given.append([*found.force, *found.moment])
patch = (1e-3, 1e-3, 0.1, 6e-3, 4e-3, 1e5, 0.3, 8e10, 0.28)
given.append([*creep_force("exact", *patch, cells_along=6, cells_across=6), 0, 0, 0])
mbs = exu.SystemContainer().AddSystem()
items = create_wheelset(mbs, axle, track, speed=20, moving_frame=True, yaw=2e-3)
mbs.CreateForce(itemNumber=items.body, loadVector=[0, 0, -1e5])
motion = simulate(mbs, speed=20, duration=6e-3)
given.append([motion.wheel("wheelset", side)[f][-1] for side in ("left", "right")
              for f in ("Q [N]", "Y [N]")] + [0, 0])
print(json.dumps(given))
"""


def forces(**environment: str) -> np.ndarray:
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", PROGRAM, json.dumps(JOBS)],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return np.array(json.loads(done.stdout))


@pytest.fixture(scope="module")
def compiled():
    return forces()


@pytest.mark.parametrize(
    "how",
    [
        {"NUMBA_DISABLE_JIT": "1"},
        pytest.param({"NUMBA_BOUNDSCHECK": "1"}, marks=pytest.mark.slow),
    ],
    ids=["interpreted", "bounds checked"],
)
def test_the_same_forces(compiled, how):
    other = forces(**how)
    scale = np.abs(compiled).max(axis=1, keepdims=True)
    assert scale.min() > 1e3
    assert np.abs(other / scale - compiled / scale).max() < 1e-5
