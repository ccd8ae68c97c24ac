"""The half-space's answer to normal contact on a penetration p(s) - A x^2: a judge for faster ones.

Pressure, constant on the cells of a regular grid (x along rolling, s across), fulfils
    pressure >= 0,  u >= p(s) - A x^2,  pressure (u - p + A x^2) = 0,
    u(x, s) = 1/(pi E*) int int pressure/distance,  1/E* = (1 - nu)/G for two bodies alike,
by conjugate gradients on the cells in contact (Polonsky and Keer 1999); u of a cell by Love's
closed form (K. L. Johnson, Contact Mechanics, 1985, equation 3.25), sums by FFT. Where the contact
surface bends across the patch (conformal contact), pressure acts along the local normal and its
displacement is felt by its part along the normal there: cos(a - b) = cos a cos b + sin a sin b.

The solution makes W = int pressure (p - A x^2) - 1/2 int pressure u the greatest, so the stored
energy is U = 1/2 int pressure (p - A x^2), a rise dp(s) of the penetration does the work
int n(s) dp(s) ds with n the load of a strip, and any other pressure gives a smaller W.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.contact.layout import HEADER, SIDE, Axle
from exudyn_wheelset.contact.locus import rail_foot, wheel_point
from exudyn_wheelset.contact.search import grid_foot
from exudyn_wheelset.contact.tables import contact_tables


@dataclass(frozen=True)
class HalfSpace:
    """load [N], energy [J], line_load (n) [N/m] at s (n) [m], peak pressure [Pa].

    pressure (n, cells) [Pa] on cells dx [m] long, even in x.
    """

    s: np.ndarray
    line_load: np.ndarray
    load: float
    energy: float
    peak_pressure: float
    pressure: np.ndarray
    dx: float

    @property
    def place(self) -> float:
        """Load-weighted mean of s [m]."""
        return float(self.line_load @ self.s / self.line_load.sum())

    def share_beyond(self, s: float) -> float:
        """Share of the load at places greater than s."""
        return float(self.line_load[self.s > s].sum() / self.line_load.sum())


def _square_root_sum(x, y):
    """int int dx dy/sqrt(x^2 + y^2): x ln(y + r) + y ln(x + r)."""
    r = np.hypot(x, y)
    return x * np.log(y + r) + y * np.log(x + r)


def influence(across: int, along: int, ds: float, dx: float) -> np.ndarray:
    """pi E* u at cells (i, j) from unit pressure on cell (0, 0); shape (across, along)."""
    s = (np.arange(across) - 0.5) * ds
    x = (np.arange(along) - 0.5) * dx
    s = np.r_[s, s[-1] + ds][:, None]
    x = np.r_[x, x[-1] + dx][None, :]
    corners = _square_root_sum(s, x)
    return corners[1:, 1:] - corners[1:, :-1] - corners[:-1, 1:] + corners[:-1, :-1]


def half_space_contact(
    s,
    penetration,
    half_curvature,
    shear_modulus,
    poisson,
    along=40,
    tolerance=1e-7,
    normal=(0.0, 1.0),
):
    """Solve on the grid of s (uniform) [m] where penetration [m] is given; return a HalfSpace.

    half_curvature A [1/m], a number or one for each s; along: cells over the half length of the
    overlap along rolling (the pressure is even in x); normal (ny, nz): of the surface, numbers or
    one for each s.
    """
    s, penetration = np.asarray(s), np.asarray(penetration)
    curvature = np.broadcast_to(half_curvature, s.shape)
    reach = np.sqrt(np.maximum(penetration, 0.0) / curvature).max() * 1.01
    ds, dx = s[1] - s[0], reach / along
    x = (np.arange(-along, along) + 0.5) * dx
    gap = penetration[:, None] - curvature[:, None] * x**2
    near = influence(len(s), len(x), ds, dx) * (1.0 - poisson) / (np.pi * shear_modulus)
    shape = (2 * len(s), 2 * len(x))
    kernel = np.zeros(shape)
    kernel[: len(s), : len(x)] = near
    kernel[len(s) + 1 :] = kernel[1 : len(s)][::-1]
    kernel[:, len(x) + 1 :] = kernel[:, 1 : len(x)][:, ::-1]
    transformed = np.fft.rfft2(kernel)

    def planar(pressure):
        return np.fft.irfft2(np.fft.rfft2(pressure, shape) * transformed, shape)[: len(s), : len(x)]

    parts = [np.broadcast_to(part, s.shape)[:, None] for part in normal if np.any(part)]

    def displaced(pressure):
        return sum(part * planar(part * pressure) for part in parts)

    pressure = np.maximum(gap, 0.0)
    pressure *= (pressure * gap).sum() / (pressure * displaced(pressure)).sum()
    step = np.zeros_like(pressure)
    norm_before, fresh = 1.0, True
    for _ in range(2000):
        residual = gap - displaced(pressure)
        active = pressure > 0.0
        norm = (residual[active] ** 2).sum()
        step = np.where(active, residual + (0.0 if fresh else norm / norm_before) * step, 0.0)
        norm_before, fresh = norm, False
        length = (residual[active] @ step[active]) / (step * displaced(step)).sum()
        pressure = pressure + length * step
        pressure[pressure < 0.0] = 0.0
        missing = (pressure == 0.0) & (residual > 0.0)
        if missing.any():
            pressure[missing] = length * residual[missing]
            fresh = True
        elif np.sqrt(norm / active.sum()) < tolerance * gap.max():
            break
    line = pressure.sum(axis=1) * dx
    return HalfSpace(
        s,
        line,
        float(line.sum() * ds),
        float(0.5 * (pressure * gap).sum() * ds * dx),
        float(pressure.max()),
        pressure,
        float(dx),
    )


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


def contact_of_gap(gap, shear_modulus=82e9, poisson=0.28, along=32, across=128, steeper=0.0):
    """Contact of a gap from `gap_of_left_wheel`, as it bends, on a grid of 2 along x across cells.

    Returns the load, its force (y, z) [N], the peak pressure [Pa], and the load where the contact
    angle is greater than `steeper` [rad].
    """
    arc, penetration = gap[:2]
    inside = arc[penetration > 0.0]
    spacing = (inside[-1] - inside[0] + 6e-5) / across
    s = inside[0] - 3e-5 + spacing * (np.arange(across) + 0.5)
    depth, ny, nz, curvature = (np.interp(s, arc, row) for row in gap[1:])
    found = half_space_contact(
        s, depth, curvature, shear_modulus, poisson, along, 1e-6, normal=(ny, nz)
    )
    load = found.line_load * spacing
    beyond = np.arctan2(-ny, nz) > steeper
    return load.sum(), load @ ny, load @ nz, found.peak_pressure, load[beyond].sum()
