"""Rigid contact of a pair in numbers: at rest, its jumps, its polynomials, the cost of finding it.

SI units, angles in rad; lists over the shifts y [m], positive to the left.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.geometry.piecewise import COLUMNS, PiecewiseGeometry
from exudyn_wheelset.geometry.rigid import METHODS, ContactGeometry, contact_geometry

# Two contacts nearer than this [m] to touching together count as touching.
TOUCHING = 1.0e-6
COMPARED_SHIFTS = 41


def geometry_numbers(
    wheelset: Wheelset, track: Track, geometry: ContactGeometry, pieces: PiecewiseGeometry
) -> dict[str, Any]:
    """Numbers of a pair from its contact over shifts centred on y = 0, and its polynomials.

    Where the paper's Figure 3 has curves: height, contact angle and place of contact at rest, half
    the slope of r_left - r_right there; shifts of jumps and of contact at two points; degrees,
    breaks and residuals of the polynomials.
    """
    y, centre = geometry.y, len(geometry.y) // 2
    slope = np.gradient(geometry.rolling_radius_difference, y)
    residuals = {name: pieces.residuals[:, k].tolist() for k, name in enumerate(COLUMNS)}
    return {
        "gauge": track.gauge,
        "inclination": track.inclination,
        "radius": wheelset.radius,
        "tape_half_distance": wheelset.tape_half_distance,
        "height_at_rest": geometry.z[centre],
        "contact_angle_at_rest": geometry.left.angle[centre],
        "wheel_contact_at_rest": geometry.left.wheel_y[centre],
        "half_slope_of_radius_difference_at_rest": 0.5 * slope[centre],
        "jumps": pieces.jumps.tolist(),
        "double_point_contact": y[geometry.double_point_contact(tolerance=TOUCHING)].tolist(),
        "polynomials": {
            "degrees": list(pieces.degrees),
            "breaks": pieces.breaks.tolist(),
            "residuals": residuals,
        },
    }


def compare_methods(wheelset: Wheelset, track: Track, half_range: float) -> dict[str, Any]:
    """Time and agreement of the bracketed root and of the paper's Nelder-Mead minimisation.

    At 41 shifts up to half_range [m]. Both have run once before the clock starts: what is compiled
    or loaded then does not count.
    """
    y = np.linspace(-half_range, half_range, COMPARED_SHIFTS)
    for method in METHODS:
        contact_geometry(wheelset, track, y[:2], method=method)
    found: dict[str, ContactGeometry] = {}
    seconds = {}
    for method, repeats in (("root", 5), ("nelder-mead", 1)):
        taken = []
        for _ in range(repeats):
            start = time.perf_counter()
            found[method] = contact_geometry(wheelset, track, y, method=method)
            taken.append(time.perf_counter() - start)
        seconds[method] = min(taken)
    exact, minimised = found["root"], found["nelder-mead"]
    return {
        "shifts": len(y),
        "root_seconds": seconds["root"],
        "nelder_mead_seconds": seconds["nelder-mead"],
        "times_faster": seconds["nelder-mead"] / seconds["root"],
        "largest_roll_difference": float(np.abs(exact.roll - minimised.roll).max()),
        "largest_height_difference": float(np.abs(exact.z - minimised.z).max()),
    }


def telling_shifts(pieces: PiecewiseGeometry, reach: float) -> list[float]:
    """Centred, half-way to the flange, and the flange contact after the last jump, within reach."""
    jumps = pieces.jumps[pieces.jumps > 0.0]
    edge = float(jumps[-1]) if len(jumps) else reach
    return [0.0, 0.5 * edge, min(edge + 2.0e-4, reach)]
