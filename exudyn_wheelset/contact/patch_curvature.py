"""Lateral curvature of the gap between wheel and rail, averaged over a patch under load.

For models that hold the rigid contact geometry over y: the wheelset is lowered by the approach of
the two bodies from its rigid position, and the zone of virtual penetration gives the half
curvature B that Hertz's theory needs (contact/search.py). The true curvature at the contact point
jumps at every junction of arcs; this one is smooth over the shift.
"""

import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.layout import RESULT, Axle, new_result, side_of
from exudyn_wheelset.contact.search import VIRTUAL, find_lobes, zone_moments


def patch_half_curvatures(
    table: np.ndarray, y: np.ndarray, roll: np.ndarray, z: np.ndarray, approach: float
) -> np.ndarray:
    """Return B (n, 2) [1/m] of the deepest patch, left and right, for rigid poses at yaw zero.

    y [m], roll [rad], z [m]: (n) rigid positions; approach [m] > 0 in the direction of z.
    """
    curvatures = np.full((len(y), 2), np.nan)
    _fill_half_curvatures(table, y, roll, z, approach, new_result(), curvatures)
    return curvatures


@compiled
def _fill_half_curvatures(table, y, roll, z, approach, result, curvatures):
    work = result.view(RESULT)[0].work
    radius = side_of(table, 0).radius
    for k in range(len(y)):
        for hand in range(2):
            mirror = 1.0 - 2.0 * hand
            side = side_of(table, hand)
            axle = Axle(
                mirror * y[k], radius + z[k] - approach, 0.0, np.cos(roll[k]),
                mirror * np.sin(roll[k]),
            )  # fmt: skip
            found = find_lobes(table, side, axle, work)
            if found == 0:
                continue
            deepest = 0
            for j in range(1, found):
                if work.lobes[j].penetration > work.lobes[deepest].penetration:
                    deepest = j
            lobe = work.lobes[deepest]
            extent = VIRTUAL * lobe.penetration
            zone = zone_moments(table, side, lobe, lobe.penetration - extent, axle)
            curvatures[k, hand] = 16.0 / 9.0 * extent**3 / zone.total**2
