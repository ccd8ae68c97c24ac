"""Normal force by virtual penetration, for patches that are no ellipse.

Source: Kik and Piotrowski (1996); Piotrowski and Chollet (2005), equations 8 to 16. Where the
undeformed bodies, pushed into each other by VIRTUAL = 0.55 of the approach delta, overlap, is
taken for the patch: in the strip at distance y from the deepest point it reaches
    x_l(y) = sqrt((penetration(y) - (1 - VIRTUAL) delta)/A)
to either side, A = 1/(2 R_x). With the pressure semi-elliptical along x and proportional to x_l
across, p ~ sqrt(x_l^2 - x^2), the half-space's displacement at the deepest point gives
    N = pi E* delta I_1/I_2,   I_1 = int pi x_l^2/2 dy,
    I_2 = int int sqrt(x_l^2 - x^2)/sqrt(x^2 + y^2) dx dy = int 2 sqrt(x_l^2 + y^2) (K - E) dy,
K and E the complete elliptic integrals of parameter m = x_l^2/(x_l^2 + y^2) (the inner integral in
closed form). For a circular Hertz patch this is 4.9 % more than Hertz's force: the price of
VIRTUAL being one number for all shapes.

Frame: y along the wheel's contour, x along the track; metres.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.locus import rail_foot, wheel_section
from exudyn_wheelset.contact.search import zone_end

# Gauss's points on (0, 1) for t in y = end t^2: the square takes the logarithm at y = 0 out.
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(7)
_POINTS = 0.5 * (_POINTS + 1.0)
_WEIGHTS = 0.5 * _WEIGHTS


@compiled
def elliptic_k_minus_e(m):
    """K(m) - E(m) by the arithmetic-geometric mean, 0 <= m < 1."""
    a = 1.0
    b = math.sqrt(1.0 - m)
    power = 1.0
    rest = m
    for _ in range(12):
        c = 0.5 * (a - b)
        a, b = 0.5 * (a + b), math.sqrt(a * b)
        power *= 2.0
        rest += power * c * c
        if c < 1.0e-9 * a:
            break
    # E = K (1 - sum 2^(n-1) c_n^2), so K - E = K/2 sum 2^n c_n^2.
    return 0.5 * math.pi / (a + b) * rest


@compiled
def zone_integrals(table, side, lobe, level, origin, along, axle):
    """I_1 [m^3] and I_2 [m^2] over the zone of the lobe deeper than `level`.

    origin: wheel arc of the deepest point of the patch; along: A [1/m].
    """
    first = 0.0
    second = 0.0
    for half in range(2):
        end = zone_end(table, side, lobe, lobe.left if half == 0 else lobe.right, level, axle)
        reach = end - lobe.arc
        for k in range(len(_POINTS)):
            t = _POINTS[k]
            place = lobe.arc + reach * t * t
            py, pz, _, _, _ = wheel_section(table, side, place, axle)
            _, _, _, _, height = rail_foot(table, side, py, pz, lobe.foot + place - lobe.arc)
            square = max(-height - level, 0.0) / along
            weight = _WEIGHTS[k] * 2.0 * t * abs(reach)
            total = square + (place - origin) ** 2
            if square > 0.0:
                first += weight * 0.5 * math.pi * square
                second += (
                    weight
                    * 2.0
                    * math.sqrt(total)
                    * elliptic_k_minus_e(min(square / total, 1.0 - 1e-15))
                )
    return first, second


@compiled
def virtual_penetration_force(first, second, penetration, material):
    """N [N] of the integrals over the whole patch, both bodies of the same material."""
    if second <= 0.0:
        return 0.0
    stiffness = math.pi * material.shear_modulus / (1.0 - material.poisson)
    return stiffness * penetration * first / second
