"""What tangential tractions on rectangular cells move: two half-spaces of the same material.

Source: K. L. Johnson, Contact Mechanics, 1985, section 3.6 (Cerruti's half-space). With
u = u_wheel - u_rail, both bodies together, traction p on the wheel in a cell of sides h, k gives
    u_x = (X p_x + Z p_y)/(pi G),   u_y = (Z p_x + Y p_y)/(pi G),
    X = A + (1 - nu) B,   Y = (1 - nu) A + B,   Z = -nu R,   each a sum over the cell's corners of
    A = y ln(x + r),      B = x ln(y + r),      R = r        with signs + - - +,
x and y from the corner to the point of observation (Cerruti's 1/r, x^2/r^3, x y/r^3 integrated).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.compilation import compiled


@compiled
def influence(
    along: int, across: int, step_x: float, step_y: float, poisson: float
) -> tuple[NDArray, NDArray, NDArray]:
    """Give pi G u_x from p_x, u_x from p_y (and u_y from p_x), u_y from p_y, for unit tractions.

    Arrays (across, 2 along + 1): row j is the distance j step_y >= 0, column i + along the
    distance i step_x between the cell that is loaded and the middle where u is.
    """
    columns = 2 * along + 1
    of_a = np.empty((across + 1, columns + 1))
    of_b = np.empty((across + 1, columns + 1))
    of_r = np.empty((across + 1, columns + 1))
    for j in range(across + 1):
        y = (j - 0.5) * step_y
        for i in range(columns + 1):
            x = (i - along - 0.5) * step_x
            r = math.sqrt(x * x + y * y)
            # ln(x + r) without cancellation
            log_x = math.log(x + r) if x > 0.0 else math.log(y * y / (r - x))
            log_y = math.log(y + r) if y > 0.0 else math.log(x * x / (r - y))
            of_a[j, i] = y * log_x
            of_b[j, i] = x * log_y
            of_r[j, i] = r
    xx = np.empty((across, columns))
    xy = np.empty((across, columns))
    yy = np.empty((across, columns))
    for j in range(across):
        for i in range(columns):
            value_a = of_a[j + 1, i + 1] - of_a[j + 1, i] - of_a[j, i + 1] + of_a[j, i]
            value_b = of_b[j + 1, i + 1] - of_b[j + 1, i] - of_b[j, i + 1] + of_b[j, i]
            value_r = of_r[j + 1, i + 1] - of_r[j + 1, i] - of_r[j, i + 1] + of_r[j, i]
            xx[j, i] = value_a + (1.0 - poisson) * value_b
            yy[j, i] = (1.0 - poisson) * value_a + value_b
            xy[j, i] = -poisson * value_r
    return xx, xy, yy
