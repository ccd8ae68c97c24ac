"""Planar curves over arc length for the kernels: piecewise cubics on a uniform grid.

A curve (CURVE in layout.py) is a part of a flat float64 array: n segments of eight coefficients, y
and z [m] as a0 + a1 u + a2 u^2 + a3 u^3 with u [m] from the segment's start. Beyond its ends a
curve goes on straight, so that no pose gives anything but finite numbers.
"""

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def curve_point(data, curve, arc):
    """Return (y, y', y'', z, z', z'') [m, -, 1/m] of the curve at arc length `arc` [m]."""
    index = int(min(max(arc * curve.per_spacing, 0.0), curve.last))
    from_start = arc - index * curve.spacing
    u = min(max(from_start, 0.0), curve.spacing)
    beyond = from_start - u
    base = curve.offset + 8 * index
    b2 = data[base + 2]
    b3 = data[base + 3]
    c2 = data[base + 6]
    c3 = data[base + 7]
    y1 = data[base + 1] + u * (2.0 * b2 + 3.0 * u * b3)
    z1 = data[base + 5] + u * (2.0 * c2 + 3.0 * u * c3)
    y = data[base] + u * (data[base + 1] + u * (b2 + u * b3)) + beyond * y1
    z = data[base + 4] + u * (data[base + 5] + u * (c2 + u * c3)) + beyond * z1
    bent = 2.0 if beyond == 0.0 else 0.0
    return y, y1, bent * (b2 + 3.0 * u * b3), z, z1, bent * (c2 + 3.0 * u * c3)
