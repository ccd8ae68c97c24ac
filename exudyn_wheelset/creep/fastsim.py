"""FASTSIM: Kalker's simplified theory, its flexibilities and the step of a cell that slips.

The traction field of the patch is marched strip by strip, all abreast, in fastsim_rows.py.

Source: J. J. Kalker, A fast algorithm for the simplified theory of rolling contact, Vehicle System
Dynamics 11 (1982). The surface is a bed of springs of flexibility L, u = L p. Material enters at
the leading edge x = a_y = a sqrt(1 - (y/b)^2) unloaded and moves towards -x; while it sticks
    dp_x/dx = (xi_x - phi y)/L,       dp_y/dx = (xi_y + phi x)/L,
and |p| is held at the bound mu p_0 (1 - (x/a)^2 - (y/b)^2), p_0 = 2 N/(pi a b), where it would
exceed it (parabolic, so that stick ends at the trailing edge as in the exact theory). Forces and
moment are the integrals of p.
    L_1 = 8 a/(3 G C11),  L_2 = 8 a/(3 G C22),  L_3 = pi a^2/(4 G sqrt(a b) C23)
With `flexibilities` = 1, plain FASTSIM, one L serves all, by the weighting of the program CONTACT:
    L = (xi_x^2 + xi_y^2 + zeta^2)/(xi_x^2/L_1 + xi_y^2/L_2 + zeta^2/L_3),  zeta = 3 pi a phi/32.
The older weighting by magnitudes, (|xi_x| L_1 + |xi_y| L_2 + c |phi| L_3)/hypot, makes the bed up
to 1.4 times too soft when creepages combine; it is not used. With `flexibilities` = 3 each of
xi_x, xi_y, phi has its own L. "blended" (2), the default, goes from three to one as creepage
grows, as CONTACT's modified FASTSIM does (E. A. H. Vollebregt, CONTACT user guide):
    w = min(1, f/3),  f = hypot(xi_x, xi_y)/hypot(u_1, u_2),  u_i = mu N/(a b G C_ii),
    L_i <- (1 - w) L_i + w L.
Three are exact in the linear range, one is nearer to the full theory where most of the patch
slips: slanted creepage without spin, a/b 0.2 to 5, 50 cells: one 9.6, three 7.0, blended at most
4.6 % of mu N from full CONTACT.

Grid: every strip has the same number of cells, so cells shrink with the strip as in the original.
Strips stand at y = -b cos(theta), theta at the middle of equal steps, and the bound is averaged
over each cell: the sum of the bound is then exact on every grid, so full sliding gives mu N.
A cell that reaches the bound sticks up to it and slips for the rest; during slip the direction n
of p turns towards that of the rigid slip w,  d(angle)/dx = |w| sin(angle)/(L |p|),  solved in
closed form for a cell. So the error falls with the square of the cell size, where cutting p back
to the bound cell by cell leaves an error of first order (spin of 0.5 to 2 1/m alone, 10 x 10
cells: 0.1 to 1.2 % against 1.3 to 6.7 %). Strips +y and -y run together, so mirrored
input gives mirrored output bit by bit.

Smoothness: continuous. One flexibility: L is smooth but at the origin; with spin present the
slope of F over xi at xi = 0 is that of L_3, so Kalker's linear limit holds for one creepage at a
time. Three and blended: the linear limit is exact, and blended has a first derivative at zero
creepage (w grows with |xi|, so the second jumps there; the first jumps at f = 3). Slopes jump
slightly as cells change from stick to slip.
Frames and signs as in exudyn_wheelset.creep.kalker.
"""

from __future__ import annotations

import math

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.kalker import kalker_coefficients
from exudyn_wheelset.creep.law import CreepLaw, CreepParameter

ONE, BLENDED, THREE = 1.0, 2.0, 3.0
# creepage over saturation by the linear theory at which the blend has become one flexibility
_ONE_FROM = 3.0
# traction that a cell's slip would build up, over the bound: its fourth power stays finite
LARGEST = 1e60

LAW = CreepLaw(
    "fastsim",
    5,
    "Kalker 1982",
    (
        CreepParameter("cells_along", 10.0, 2.0, 1000.0, "cells of a strip along x", whole=True),
        CreepParameter("cells_across", 10.0, 3.0, 1000.0, "strips across y", whole=True),
        CreepParameter(
            "flexibilities",
            BLENDED,
            ONE,
            THREE,
            "1: one for all, 3: one each for xi_x, xi_y, phi, 2: from three to one",
            whole=True,
            words=(("one", ONE), ("blended", BLENDED), ("three", THREE)),
        ),
    ),
    {"grid": ("cells_along", "cells_across")},
)


@compiled
def slip_step(
    p_x: float,
    p_y: float,
    rise_x: float,
    rise_y: float,
    change: float,
    before: float,
    bound: float,
) -> tuple[float, float]:
    """Give the traction after a step in which p meets the bound: stick up to it, slip after it.

    The step adds -(rise_x, rise_y) while it sticks, rise_y at its middle and falling by `change`
    over it; the bound goes from `before` to `bound`.
    """
    growth = bound - before
    speed_squared = rise_x * rise_x + rise_y * rise_y
    slope = -(p_x * rise_x + p_y * rise_y) - before * growth
    rest = p_x * p_x + p_y * p_y - before * before
    left = 1.0
    size = before
    if slope < 0.0 or rest < -1e-14 * before * before:
        rest = min(rest, 0.0)
        square = speed_squared - growth * growth
        root = math.sqrt(max(slope * slope - square * rest, 0.0))
        if slope > 0.0:
            stick = -rest / (slope + root)
        else:
            stick = (root - slope) / square if square > 0.0 else 0.0
        stick = min(max(stick, 0.0), 1.0)
        p_x -= stick * rise_x
        p_y -= stick * rise_y
        size = math.sqrt(p_x * p_x + p_y * p_y)
        left = 1.0 - stick
    turn = 2.0 * math.sqrt(speed_squared) * left / (size + bound)
    if turn > 20.0:
        rise_y += change * (left / turn - 0.5)
        scale = -bound / math.sqrt(rise_x * rise_x + rise_y * rise_y + 1e-200)
        return scale * rise_x, scale * rise_y
    decay = math.exp(-turn)
    # where in the step the slip direction counts: its middle if slow, its end if fast
    place = 0.5 + turn / 12.0
    if turn > 1e-3:
        place = (turn - 1.0 + decay) / (turn * (1.0 - decay))
    rise_y += change * (left * (1.0 - place) - 0.5)
    per_speed = -1.0 / math.sqrt(rise_x * rise_x + rise_y * rise_y + 1e-200)
    drive_x = rise_x * per_speed
    drive_y = rise_y * per_speed
    along = max((p_x * drive_x + p_y * drive_y) / size, -1.0)
    back = (1.0 - along) * decay * decay
    scale = bound / (1.0 + along + back)
    share = scale * (1.0 + along - back - 2.0 * decay * along)
    keep = scale * 2.0 * decay / size
    return share * drive_x + keep * p_x, share * drive_y + keep * p_y


@compiled
def flexibilities(
    creep_x: float,
    creep_y: float,
    spin: float,
    a: float,
    b: float,
    limit: float,
    shear_modulus: float,
    poisson: float,
    kind: float,
) -> tuple[float, float, float]:
    """Give (L_x, L_y, L_spin) [m/Pa] of an ellipse; limit: mu N [N]; kind: ONE, BLENDED or THREE.

    All zero without creepage.
    """
    c11, c22, c23, _ = kalker_coefficients(a, b, poisson)
    size = math.sqrt(a * b)
    largest = max(abs(creep_x), abs(creep_y), abs(spin) * a)
    if not largest > 1e-200:
        return 0.0, 0.0, 0.0
    soft_x = 8.0 * a / (3.0 * shear_modulus * c11)
    soft_y = 8.0 * a / (3.0 * shear_modulus * c22)
    soft_spin = math.pi * a * a / (4.0 * shear_modulus * size * c23)
    if kind < THREE:
        share_x = creep_x / largest
        share_y = creep_y / largest
        share_spin = 3.0 * math.pi / 32.0 * a * spin / largest
        share_x, share_y, share_spin = share_x * share_x, share_y * share_y, share_spin * share_spin
        soft = (share_x + share_y + share_spin) / (
            share_x / soft_x + share_y / soft_y + share_spin / soft_spin
        )
        blend = 1.0
        if kind == BLENDED:
            saturation = limit / (a * b * shear_modulus)
            fullness = math.sqrt(creep_x * creep_x + creep_y * creep_y)
            fullness /= saturation * math.sqrt(1.0 / (c11 * c11) + 1.0 / (c22 * c22))
            blend = min(1.0, fullness / _ONE_FROM)
        if blend < 1.0:
            soft_x += blend * (soft - soft_x)
            soft_y += blend * (soft - soft_y)
            soft_spin += blend * (soft - soft_spin)
        else:
            soft_x = soft_y = soft_spin = soft
    return soft_x, soft_y, soft_spin
