"""A wheelset that slides: every patch has the friction of its own normal force, against the slip.

Coulomb's law needs no creep theory: where creepages are of the order of one, all of a patch slips.
(Its direction where it slips askew is a law's own affair; along the track there is but one.) That
holds for each patch by itself, also while two of them are parts of one merged patch and share its
creep force, at every depth and degree of merging.
"""

import math

import numpy as np
import pytest

from exudyn_wheelset import Track, Wheelset, contact_forces, contact_geometry

WHEELSET = Wheelset(1813.0, (1120.0, 112.0, 1120.0), 0.46, "S1002")
TRACK = Track("UIC60")
FRICTION = 0.3


def patches_at(shift, depth, velocity):
    height = contact_geometry(WHEELSET, TRACK, [shift]).z[0] - depth
    roll = contact_geometry(WHEELSET, TRACK, [shift]).roll[0]
    found = contact_forces(
        WHEELSET, TRACK, (0.0, shift, height, roll, 0.0, 0.0), velocity,
        creep="shen-hedrick-elkins", friction=FRICTION,
    )  # fmt: skip
    return [*found.left, *found.right]


@pytest.mark.parametrize("across", [0.0, 3.0])
def test_each_patch_slides_against_its_slip(across):
    """Skidding at 5 m/s along the track and `across` it, not turning."""
    several = 0
    for shift in [*np.linspace(-6e-4, 6e-4, 25), *np.linspace(4.6e-3, 5.0e-3, 9)]:
        for depth in (2e-5, 6e-5, 1.2e-4):
            patches = patches_at(shift, depth, (5.0, across, 0.0, 0.0, 0.0, 0.0))
            several += len(patches) > 2
            for patch in patches:
                limit = FRICTION * patch.normal_force
                force = math.hypot(patch.fx, patch.fy)
                # Two parts of a merged patch lie in planes some hundredths apart, and forces of
                # different direction make less than their sum.
                assert 0.999 * limit < force < (1.0 + 1e-12) * limit
                if across == 0.0:
                    assert patch.fx / force == pytest.approx(-1.0, abs=1e-3)
    assert several > 30
