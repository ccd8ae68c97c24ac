"""Make HERTZ_OVER_STRIPS of contact/strips.py: what a finite number of strips misses of an ellipse.

A parabolic gap A x^2 + B y^2 is pressed together by the strips as they are, without the factor, and
the force is compared with Hertz's. Run `python tools/make_strip_factors.py`, put the numbers there.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_wheelset.contact import strips as module
from exudyn_wheelset.contact.hertz import hertz_from_approach
from exudyn_wheelset.contact.layout import STRIP, STRIPS_A_LOBE, Material

STEEL = Material(82.0e9, 0.28)


@njit
def force_of_strips(numbers, depth, along, lateral):
    """Normal force [N] of a parabolic gap; numbers: room for the strips."""
    strips = numbers.view(STRIP)
    end = np.sqrt(depth / lateral)
    for k in range(STRIPS_A_LOBE):
        strip = strips[k]
        strip.width = 2.0 * end / STRIPS_A_LOBE
        strip.arc = -end + (k + 0.5) * strip.width
        strip.depth = depth - lateral * strip.arc * strip.arc
        strip.curvature = along
        strip.normal_y = 0.0
        strip.normal_z = 1.0
    locality = np.empty(1)
    locality[0] = module.begin_with_ellipse(strips, depth, along, lateral, STEEL)
    module.press_strips(strips, locality, STEEL)
    force = 0.0
    for k in range(STRIPS_A_LOBE):
        force += 0.5 * np.pi * strips[k].pressure * strips[k].half_length * strips[k].width
    return force


def factors(log_ratios: np.ndarray) -> np.ndarray:
    """Force of Hertz over that of the strips at ln(B/A)."""
    room = np.zeros(STRIPS_A_LOBE * STRIP.itemsize // 8)
    found = []
    for ratio in np.exp(log_ratios):
        wanted = hertz_from_approach(1.0, ratio, 5e-5, *STEEL)[0]
        found.append(wanted / force_of_strips(room, 5e-5, 1.0, ratio))
    return np.array(found)


if __name__ == "__main__":
    places = module.FACTOR_START + module.FACTOR_STEP * np.arange(len(module.HERTZ_OVER_STRIPS))
    print(", ".join(f"{factor:.5f}" for factor in factors(places)))
    between = places[:-1] + 0.5 * module.FACTOR_STEP
    miss = factors(between) / np.interp(between, places, module.HERTZ_OVER_STRIPS) - 1.0
    print(f"largest error between them: {np.abs(miss).max():.1e}")
