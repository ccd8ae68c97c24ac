"""The law "exact-table": forces of the exact law interpolated over normalised states.

With the coordinates of `exact_nodes`, n = (v_x, v_y, w)/rho, s = rho/(1 + rho), forces in units of
mu N and the moment of mu N sqrt(a b):
    F_x = -n_x (s + s^2 H_x),
    F_y = -(s (n_y + C23/S n_w) + s^2 H_y),
    M_z = -(s (C33/S n_w - C32/C22 n_y) + s^2 H_m).
s ~ rho at small creepage, so the first part is linear theory; what remains begins with its square.
H, finite from none to full sliding, comes from a table over lg(a/b), sigma, theta, psi by quadratic
B-splines through the table's nodes: slopes are continuous. Beyond the ends of theta and psi stand
    (-v_x, v_y, w): (-F_x, F_y, M_z)    and    (v_x, -v_y, -w): (F_x, -F_y, -M_z),
and the law is evaluated for xi_x, phi >= 0, so mirror images are exact to the last bit.

Coefficients: C above are those of the cells the table was solved on, within 1 to 2 % of Kalker's.
Kalker's hold at zero creepage:
    v = v_cells + (v_Kalker - v_cells)/(1 + (rho/NEAR)^2),
at his axis ratios as tabulated and between them by a cubic spline of ln C over lg(a/b), which the
complete theory confirms to 1 %. (`kalker_coefficients`, like CONTACT, is linear there and up to
6 % high in C11 and C22, 16 % in C23 at b/a = 0.15, 11 % in C33 at a/b = 0.15.)
Poisson's number nu enters by them alone: C(nu) = C(0.28) C_Kalker(nu)/C_Kalker(0.28), and beyond
saturation, rho > BETWEEN, where the direction of slip decides and stiffness does not, the ratios of
v_x, v_y, w become those of 0.28.
Friction enters by mu N alone, the same all over the patch: for friction that falls with speed give
the law the mu of that speed. Beyond a/b = 0.1 and 10 the table is that of the end, at the same
(v_x, v_y, w) of the patch, its moment stretched with the long axis over sqrt(a b).

Limit: a size f above 1 - ROUND of the force in units of mu N becomes
    1 - ROUND exp(-(f - 1 + ROUND)/ROUND),
below 1 and with a continuous slope; the table holds sizes put through the inverse. Frames and signs
as in exudyn_wheelset.creep.kalker.
"""

from __future__ import annotations

import hashlib
import math
from pathlib import Path
from typing import Any

import llvmlite.binding
import numpy as np
from llvmlite import ir
from numba import carray, config, types
from numba.extending import intrinsic
from numpy.typing import NDArray

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.exact_nodes import (
    AXIS_RATIOS,
    POISSON,
    PSIS,
    RADII,
    ROUND,
    SHAPES,
    THETAS,
    WARP,
    sigma_at,
    turn_scale,
)
from exudyn_wheelset.creep.kalker import kalker_coefficients
from exudyn_wheelset.creep.law import CreepLaw
from exudyn_wheelset.creep.saturation import LEAST_FRICTION_FORCE, bounded

LAW = CreepLaw("exact-table", 7, "Kalker 1990, complete theory, interpolated")

FILE = Path(__file__).with_name("exact_table.npy")
SHA256 = "45c70977c7fa95d73732a229c8998f1a29121fd73f7077ceef9b74a8a25d669b"
NEAR = 0.25
BETWEEN = 1.5
LEAST_RATIO = 0.1
SMALLEST = 1e-60
LARGEST = 1e30

# one more coefficient on each side of every axis, two before the first sigma
TABLE_SHAPE = (SHAPES + 2, RADII + 3, THETAS + 2, PSIS + 2, 3)
_ROW = 3 * (PSIS + 2)
_RATIOS = 5 * (SHAPES + 2)
_COEFFICIENTS = _RATIOS + 4 * (AXIS_RATIOS + 2)
SIZE = _COEFFICIENTS + math.prod(TABLE_SHAPE)
_SYMBOL = f"exudyn_wheelset_exact_table_{SHA256[:16]}"


def load() -> NDArray:
    """Read the table; raises ImportError if the file is not the one this code was made for."""
    content = FILE.read_bytes()
    if hashlib.sha256(content).hexdigest() != SHA256:
        raise ImportError(f"{FILE} is damaged: its hash is not that of the table; install anew")
    table = np.load(FILE)
    table.flags.writeable = False
    return table


# Compiled code refers to the table by a symbol, so that kept kernels hold in every process.
_table = load()
llvmlite.binding.add_symbol(_SYMBOL, _table.ctypes.data)


@intrinsic
def _table_pointer(_context: Any) -> Any:
    def generate(_context: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        known = builder.module.globals
        if _SYMBOL in known:
            return known[_SYMBOL]
        symbol = ir.GlobalVariable(builder.module, ir.FloatType(), _SYMBOL)
        symbol.linkage = "external"
        return symbol

    return types.CPointer(types.float32)(), generate


if config.DISABLE_JIT:  # type: ignore[attr-defined]
    _doubles = _table.astype(np.float64)

    def _data() -> NDArray:
        return _doubles

else:

    @compiled(inline="always")
    def _data() -> NDArray:
        return carray(_table_pointer(), (SIZE,))  # type: ignore[call-arg]


@compiled(inline="always")
def _weights(place: float) -> tuple[float, float, float]:
    """Weights of the quadratic B-splines before, at and after the nearest node, |place| <= 1/2."""
    before = 0.5 - place
    after = 0.5 + place
    return 0.5 * before * before, 0.75 - place * place, 0.5 * after * after


@compiled
def rounded(size: float) -> float:
    """Factor that brings a force of that size, in units of mu N, below 1."""
    over = size - (1.0 - ROUND)
    if over <= 0.0:
        return 1.0
    return (1.0 - ROUND * math.exp(-over / ROUND)) / size


@compiled(fastmath={"reassoc", "contract", "nsz"})
def _interpolated(
    table: NDArray,
    x_shape: float,
    x_sigma: float,
    x_theta: float,
    x_psi: float,
) -> tuple[float, float, float]:
    """H_x, H_y, H_m at a place given in steps between nodes."""
    i = min(max(math.floor(x_shape + 0.5), 0), SHAPES - 1)
    j = min(max(math.floor(x_sigma + 0.5), -1), RADII - 1)
    k = min(max(math.floor(x_theta + 0.5), 0), THETAS - 1)
    m = min(max(math.floor(x_psi + 0.5), 0), PSIS - 1)
    of_shape = _weights(x_shape - i)
    of_sigma = _weights(x_sigma - j)
    of_theta = _weights(x_theta - k)
    before, at, after = _weights(x_psi - m)
    h_x = 0.0
    h_y = 0.0
    h_m = 0.0
    for di in range(3):
        for dj in range(3):
            outer = of_shape[di] * of_sigma[dj]
            place = (((i + di) * TABLE_SHAPE[1] + j + 1 + dj) * TABLE_SHAPE[2] + k) * _ROW + 3 * m
            for dk in range(3):
                row = table[place : place + 9]
                place += _ROW
                weight = outer * of_theta[dk]
                h_x += weight * (before * row[0] + at * row[3] + after * row[6])
                h_y += weight * (before * row[1] + at * row[4] + after * row[7])
                h_m += weight * (before * row[2] + at * row[5] + after * row[8])
    return h_x, h_y, h_m


@compiled
def _cells_over_kalker(
    of_cells: NDArray, x_shape: float
) -> tuple[float, float, float, float, float]:
    """Coefficients C11, C22, C23, C32, C33 of the cells over Kalker's."""
    i = min(max(int(x_shape + 0.5), 0), SHAPES - 1)
    w0, w1, w2 = _weights(x_shape - i)
    one = of_cells[i]
    two = of_cells[i + 1]
    three = of_cells[i + 2]
    return (
        w0 * one[0] + w1 * two[0] + w2 * three[0],
        w0 * one[1] + w1 * two[1] + w2 * three[1],
        w0 * one[2] + w1 * two[2] + w2 * three[2],
        w0 * one[3] + w1 * two[3] + w2 * three[3],
        w0 * one[4] + w1 * two[4] + w2 * three[4],
    )


@compiled
def _smooth_kalker(coefficients: NDArray, place: float) -> tuple[float, float, float, float]:
    """Kalker's coefficients at the table's Poisson's number, at a place in steps between nodes."""
    i = min(max(int(place + 0.5), 0), AXIS_RATIOS - 1)
    w0, w1, w2 = _weights(place - i)
    one = coefficients[i]
    two = coefficients[i + 1]
    three = coefficients[i + 2]
    return (
        w0 * one[0] + w1 * two[0] + w2 * three[0],
        w0 * one[1] + w1 * two[1] + w2 * three[1],
        w0 * one[2] + w1 * two[2] + w2 * three[2],
        w0 * one[3] + w1 * two[3] + w2 * three[3],
    )


@compiled
def exact_table(
    creep_x: float,
    creep_y: float,
    spin: float,
    a: float,
    b: float,
    normal_force: float,
    friction: float,
    shear_modulus: float,
    poisson: float,
    parameters: NDArray,
) -> tuple[float, float, float]:
    """Give (F_x, F_y, M_z) on the wheel from the table of the complete theory; no parameters."""
    limit = friction * normal_force
    if not (limit > LEAST_FRICTION_FORCE and a > 0.0 and b > 0.0):
        return 0.0, 0.0, 0.0
    length = math.sqrt(a) * math.sqrt(b)
    unit = shear_modulus * a * b / limit
    turned = spin < 0.0 or (spin == 0.0 and creep_y < 0.0)
    state_x = unit * abs(bounded(creep_x))
    state_y = unit * bounded(creep_y)
    state_w = unit * length * abs(bounded(spin))
    if turned:
        state_y = -state_y
    factor = 1.0
    largest = max(state_x, abs(state_y), state_w)
    if largest > LARGEST:
        factor = LARGEST / largest
    elif largest < SMALLEST:
        if largest == 0.0:
            return 0.0, 0.0, 0.0
        factor = SMALLEST / largest
    state_x *= factor
    state_y *= factor
    state_w *= factor

    data = _data()
    table = data[_COEFFICIENTS:]
    ratio = min(max(a / b, LEAST_RATIO), 1.0 / LEAST_RATIO)
    place = 0.5 * (math.log10(ratio) + 1.0)
    x_shape = (SHAPES - 1) * place
    r11, r22, r23, r32, r33 = _cells_over_kalker(data[:_RATIOS].reshape((SHAPES + 2, 5)), x_shape)
    t11, t22, t23, t33 = _smooth_kalker(
        data[_RATIOS:_COEFFICIENTS].reshape((AXIS_RATIOS + 2, 4)), (AXIS_RATIOS - 1) * place
    )
    table_scale = turn_scale(t11 * r11, t23 * r23, 1.0 / math.sqrt(ratio))
    of_spin = t23 * r23 / table_scale
    of_y = t23 * r32 / (t22 * r22)
    of_w = t33 * r33 / table_scale
    inside = ratio == a / b and poisson == POISSON
    c11, c22, c23, c33, scale = t11, t22, t23, t33, table_scale
    softer = 1.0
    twist = 1.0
    if not inside:
        here = kalker_coefficients(a, b, poisson)
        there = kalker_coefficients(ratio, 1.0, POISSON)
        c11 *= here[0] / there[0]
        c22 *= here[1] / there[1]
        c23 *= here[2] / there[2]
        c33 *= here[3] / there[3]
        scale = turn_scale(c11 * r11, c23 * r23, b / length)
        if poisson != POISSON:
            steel = kalker_coefficients(a, b, POISSON)
            common = here[1] / steel[1]
            softer = common * steel[0] / here[0]
            steel_11 = c11 * steel[0] / here[0]
            steel_23 = c23 * steel[2] / here[2]
            twist = common * turn_scale(steel_11 * r11, steel_23 * r23, b / length) / scale
    v_x = state_x * c11 * r11
    v_y = state_y * c22 * r22
    w = state_w * scale
    rough = v_x * v_x + v_y * v_y + w * w
    far = rough / (BETWEEN * BETWEEN + rough)
    v_x *= 1.0 + far * (softer - 1.0)
    w *= 1.0 + far * (twist - 1.0)
    near = 1.0 / (1.0 + (v_x * v_x + v_y * v_y + w * w) / (NEAR * NEAR))
    v_x *= 1.0 + near * (1.0 / r11 - 1.0)
    v_y *= 1.0 + near * (1.0 / r22 - 1.0)
    w *= 1.0 + near * (1.0 / r23 - 1.0)
    side = math.sqrt(v_x * v_x + w * w)
    rho = math.sqrt(side * side + v_y * v_y)
    h_x, h_y, h_m = _interpolated(
        table,
        x_shape,
        RADII * sigma_at(rho * (1.0 - (1.0 - of_spin) * (w / rho) * (w / rho))) - 1.0,
        THETAS / math.pi * (math.atan2(side, v_y) - WARP * (side / rho) * (v_y / rho)) - 0.5,
        2.0 * (PSIS - 1) / math.pi * math.atan2(v_x, w),
    )
    s = rho / (1.0 + rho)
    ahead = s / rho
    square = s * s
    stretch = 1.0
    beyond = 0.0
    if not inside:
        stretch = math.sqrt(max(ratio / (a / b), a / b / ratio))
        beyond = near * (c23 * state_w - of_spin * w)
    force_x = ahead * v_x * (1.0 + s * h_x)
    force_y = ahead * (v_y + of_spin * w) + square * h_y + beyond
    linear = of_w * w - of_y * v_y
    moment = stretch * (ahead * linear + square * h_m)
    # Kalker's linear moment in place of the cells'
    moment += near * near * (c33 * state_w - c23 * state_y - stretch * linear)
    size = math.sqrt(force_x * force_x + force_y * force_y)
    force = -limit * rounded(size)
    moment *= -limit * length
    if factor > 1.0:
        force /= factor
        moment /= factor
    force_x *= force
    force_y *= force
    if creep_y == 0.0 and spin == 0.0:
        force_y = moment = 0.0
    if creep_x < 0.0:
        force_x = -force_x
    if turned:
        force_y = -force_y
        moment = -moment
    return force_x, force_y, moment
