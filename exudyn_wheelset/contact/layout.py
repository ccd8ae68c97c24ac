"""Places of numbers in the kernels' parameter and result arrays, and of a patch in its row."""

import numpy as np

from exudyn_wheelset.contact.descriptions import NORMAL_MODELS
from exudyn_wheelset.contact.search import LOBE_WIDTH, MOST_LOBES
from exudyn_wheelset.contact.tables import MOST_NODES

FRICTION, SHEAR_MODULUS, POISSON, DAMPING, LAW, NORMAL, RAIL_SPEED = 0, 1, 2, 3, 4, 5, 6
LAW_PARAMETERS = 8
PARAMETER_COUNT = 16

(
    PATCH_WHEEL_Y,
    PATCH_RAIL_Y,
    PATCH_ANGLE,
    PATCH_RADIUS,
    PATCH_NORMAL_FORCE,
    PATCH_CREEP_X,
    PATCH_CREEP_Y,
    PATCH_SPIN,
    PATCH_FX,
    PATCH_FY,
    PATCH_MZ,
    PATCH_A,
    PATCH_B,
    PATCH_PENETRATION,
    PATCH_X,
    PATCH_Y,
    PATCH_Z,
    PATCH_NORMAL_Y,
    PATCH_NORMAL_Z,
    PATCH_ENERGY,
    PATCH_SEPARATION,
    PATCH_OWN_FORCE,
    PATCH_OWN_A,
    PATCH_OWN_B,
    PATCH_SHARE,
    PATCH_MERGED_FORCE,
    PATCH_MERGED_A,
    PATCH_MERGED_B,
    PATCH_LOBE,
    PATCH_PARTNER,
) = range(30)
PATCH_WIDTH = 30

# Result array: wrench (6), numbers of patches left and right, then the patches of either side.
COUNT_LEFT, COUNT_RIGHT, PATCHES = 6, 7, 8
RESULT_SIZE = PATCHES + 2 * MOST_LOBES * PATCH_WIDTH
HERTZ = NORMAL_MODELS["hertz"]
HERTZ_LOCAL = NORMAL_MODELS["hertz-local"]
VIRTUAL_PENETRATION = NORMAL_MODELS["virtual-penetration"]
DEPTHS = RESULT_SIZE + MOST_LOBES * LOBE_WIDTH
FACTORS = DEPTHS + MOST_NODES


def new_result() -> np.ndarray:
    """Array that the kernels write into; one for each wheelset."""
    return np.zeros(FACTORS + MOST_LOBES)
