"""Lateral curvature of the gap between wheel and rail, averaged over a patch under load.

For models that hold the rigid contact geometry over y: the wheelset is lowered by the approach of
the two bodies from its rigid position, and the zone of virtual penetration gives the half
curvature B that Hertz's theory needs (contact/search.py). The true curvature at the contact point
jumps at every junction of arcs; this one is smooth over the shift.
"""

import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.search import (
    LOBE_ARC,
    LOBE_CURVATURE,
    LOBE_FOOT,
    LOBE_LEFT,
    LOBE_PENETRATION,
    LOBE_RIGHT,
    LOBE_WIDTH,
    MOST_LOBES,
    VIRTUAL,
    find_lobes,
    zone_moments,
)
from exudyn_wheelset.contact.tables import HEADER, MOST_NODES, RADIUS


@compiled
def patch_half_curvatures(table, y, roll, z, approach):
    """Return B (n, 2) [1/m] of the deepest patch, left and right, for rigid poses at yaw zero.

    y [m], roll [rad], z [m]: (n) rigid positions; approach [m] > 0 in the direction of z.
    """
    curvatures = np.empty((len(y), 2))
    lobes = np.zeros((MOST_LOBES, LOBE_WIDTH))
    depths = np.zeros(MOST_NODES)
    for k in range(len(y)):
        ly, lz = np.cos(roll[k]), np.sin(roll[k])
        for hand in range(2):
            mirror = 1.0 - 2.0 * hand
            side = hand * HEADER
            cy = mirror * y[k]
            cz = table[RADIUS] + z[k] - approach
            found = find_lobes(table, side, cy, cz, 0.0, ly, mirror * lz, lobes, depths)
            deepest = 0
            for j in range(1, found):
                if lobes[j, LOBE_PENETRATION] > lobes[deepest, LOBE_PENETRATION]:
                    deepest = j
            lobe = lobes[deepest]
            depth = lobe[LOBE_PENETRATION]
            extent = VIRTUAL * depth
            zone = zone_moments(
                table, side, lobe[LOBE_ARC], lobe[LOBE_FOOT], depth, lobe[LOBE_CURVATURE],
                lobe[LOBE_LEFT], lobe[LOBE_RIGHT], depth - extent, cy, cz, 0.0, ly, mirror * lz,
            )[0]  # fmt: skip
            curvatures[k, hand] = 16.0 / 9.0 * extent**3 / zone**2 if found > 0 else np.nan
    return curvatures
