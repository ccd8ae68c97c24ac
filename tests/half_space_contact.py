"""Normal contact of two elastic bodies on a grid: an authority for the strips, not a test.

The half-space by Boussinesq on rectangles (A. E. H. Love 1929; Johnson 1985, equation 3.25), over
the gap of a wheel on its rail along the local normals of their common surface (conformal contact:
displacement along the normal where the pressure acts, projected on the normal where it is felt).
p >= 0 by conjugate gradients with projection (Polonsky and Keer 1999) at a given approach, products
by FFT: cos(a - b) = cos a cos b + sin a sin b splits into two of them.
"""

import math

import numpy as np

from exudyn_wheelset.contact.layout import HEADER, SIDE, Axle
from exudyn_wheelset.contact.locus import rail_foot, wheel_point
from exudyn_wheelset.contact.search import grid_foot
from exudyn_wheelset.contact.tables import contact_tables


def gap_of_left_wheel(wheelset, track, y, z, roll, spacing=2.5e-5):
    """Arc length, penetration, normal (y, z) and half curvature along x of the left wheel."""
    table = contact_tables(wheelset, track)
    side = table[:HEADER].view(SIDE)[0]
    axle = Axle(y, side["radius"] + z, 0.0, math.cos(roll), math.sin(roll))
    rows = []
    for arc in np.arange(0.0, side["wheel"]["segments"] * side["wheel"]["spacing"], spacing):
        _, py, pz, ny, nz, radius, _, _ = wheel_point(table, side, arc, axle)
        if not side["rail_low"] < py < side["rail_high"]:
            continue
        foot = grid_foot(table, side, arc, axle)
        for _ in range(3):
            foot, ty, tz, _, height = rail_foot(table, side, py, pz, foot)
        normal = np.array([-tz - ny, ty - nz])
        normal /= np.hypot(*normal)
        rows.append((arc, -height, *normal, 0.5 * normal[1] / radius))
    return np.array(rows).T


def _displacement_of_a_rectangle(x, y, dx, dy):
    """Integral of 1/distance over a rectangle dx by dy, seen from (x, y) of its middle."""

    def corner(x, y):
        x = np.where(x == 0.0, 1e-30, x)
        y = np.where(y == 0.0, 1e-30, y)
        return x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))

    right, left, up, down = x + 0.5 * dx, x - 0.5 * dx, y + 0.5 * dy, y - 0.5 * dy
    return corner(right, up) - corner(left, up) - corner(right, down) + corner(left, down)


def half_space_contact(gap, shear_modulus=82e9, poisson=0.28, along=64, across=128, steeper=0.0):
    """Contact of a gap from `gap_of_left_wheel`.

    Returns the load, its force (y, z) [N], the peak pressure [Pa], and the load where the contact
    angle is greater than `steeper` [rad].
    """
    arc, penetration = gap[:2]
    inside = arc[penetration > 0.0]
    ds = (inside[-1] - inside[0] + 6e-5) / across
    s = inside[0] - 3e-5 + ds * (np.arange(across) + 0.5)
    depth, ny, nz, curvature = (np.interp(s, arc, row) for row in gap[1:])
    end = math.sqrt(np.max(np.maximum(depth, 0.0) / curvature))
    dx = 2.0 * end / along
    x = -end + dx * (np.arange(along) + 0.5)
    wanted = depth[None, :] - curvature[None, :] * x[:, None] ** 2
    unit = (1.0 - poisson) / (math.pi * shear_modulus)
    steps_x = np.fft.fftfreq(2 * along, 1.0 / (2 * along))[:, None] * dx
    steps_s = np.fft.fftfreq(2 * across, 1.0 / (2 * across))[None, :] * ds
    kernel = np.fft.rfft2(unit * _displacement_of_a_rectangle(steps_x, steps_s, dx, ds))

    def planar(pressure):
        padded = np.zeros((2 * along, 2 * across))
        padded[:along, :across] = pressure
        return np.fft.irfft2(np.fft.rfft2(padded) * kernel, s=padded.shape)[:along, :across]

    def displacement(pressure):
        return nz * planar(nz * pressure) + ny * planar(ny * pressure)

    pressure = np.where(wanted > 0.0, 1e8, 0.0)
    step = np.zeros_like(pressure)
    keep, before = 0.0, 1.0
    for turn in range(500):
        rest = displacement(pressure) - wanted
        touching = pressure > 0.0
        size = np.sum(rest[touching] ** 2)
        step = np.where(touching, rest + keep * size / before * step, 0.0)
        before, keep = size, 1.0
        pulled = displacement(step)
        length = np.sum((rest * step)[touching]) / np.sum((pulled * step)[touching])
        pressure = np.maximum(pressure - length * step, 0.0)
        entering = (pressure == 0.0) & (rest < 0.0)
        if entering.any():
            pressure[entering] -= length * rest[entering]
            keep = 0.0
        elif turn > 5 and math.sqrt(size / touching.sum()) < 1e-6 * depth.max():
            break
    else:
        raise AssertionError("the half-space solution has not converged")
    load = pressure.sum(0) * dx * ds
    beyond = np.arctan2(-ny, nz) > steeper
    return load.sum(), load @ ny, load @ nz, pressure.max(), load[beyond].sum()
