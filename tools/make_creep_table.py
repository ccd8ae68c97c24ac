"""Make the table of the creep law "exact-table" from the law "exact".

    python tools/make_creep_table.py [folder of parts]

Parts, three a shape, are kept in the folder (default build/creep_table); a second run makes those
that are missing. Then all are put together as exudyn_wheelset/creep/exact_table.npy, and its hash
is written into exudyn_wheelset/creep/exact_table.py. About six minutes of one core.
"""

import hashlib
import io
import math
import re
import sys
import time
from pathlib import Path

import numpy as np

from exudyn_wheelset.creep.exact_nodes import (
    POWER,
    PSIS,
    RADII,
    ROUND,
    SHAPES,
    THETAS,
    WARP,
    cell_coefficients,
    forces_at_nodes,
    size_at,
    turn_scale,
)

TABLE = Path(__file__).parents[1] / "exudyn_wheelset" / "creep" / "exact_table.npy"
# half the range of sigma around saturation by spin that is solved twice as finely, half the range
# of theta around pure spin that is solved there, and the equal parts of theta elsewhere
REFINED = 0.14
LEVEL = math.radians(22)
COARSE = 18


def solved(
    file: Path, shape: int, sigmas: np.ndarray, thetas: np.ndarray, psis: np.ndarray
) -> dict[str, np.ndarray]:
    """Forces of one shape at those states, from the file or made and kept there."""
    if not file.exists():
        start = time.process_time()
        ratio = 10 ** (2 * shape / (SHAPES - 1) - 1)
        coefficients = cell_coefficients(ratio)
        forces = [forces_at_nodes(ratio, coefficients, theta, sigmas, psis) for theta in thetas]
        unfinished = file.with_name("unfinished.npz")
        np.savez(unfinished, ratio=ratio, coefficients=coefficients, forces=np.stack(forces, 1))
        unfinished.rename(file)
        print(f"{file.name}: {time.process_time() - start:.0f} s", flush=True)
    with np.load(file) as found:
        return dict(found)


def part(folder: Path, shape: int) -> tuple[np.ndarray, np.ndarray]:
    """The cells' coefficients of one shape, and H at its nodes.

    Solved are every second sigma at COARSE equal steps of theta, all sigma near saturation by spin,
    and there the table's own theta near pure spin: the slope over lateral creepage falls by half
    within a tenth of that spin. The other nodes are read off the splines through those.
    """
    psis = 0.5 * np.pi * (np.arange(PSIS) + 0.5) / PSIS
    even = np.pi * (np.arange(COARSE) + 0.5) / COARSE
    coarse = np.arange(2, RADII + 1, 2)
    found = solved(folder / f"shape_{shape:02d}.npz", shape, coarse / RADII, even, psis)
    ratio, c = float(found["ratio"]), found["coefficients"]
    values = remainder(ratio, c, found["forces"], coarse / RADII, even, psis)
    spline = extrapolated(open_coefficients(values, 0), 0, 1, 1)
    all_values = np.empty((RADII, *values.shape[1:]))
    all_values[1::2] = values
    # half way between nodes two splines are one half each; the first stands before the first node
    all_values[2::2] = 0.5 * (spline[1:-2] + spline[2:-1])
    all_values[0] = 0.5 * (spline[0] + spline[1])
    spin = (turn_scale(c[0], c[2], 1 / np.sqrt(ratio)) / c[2]) ** POWER
    near = abs(np.arange(1, RADII + 1) / RADII - spin / (1 + spin)) <= REFINED
    fine = 1 + np.flatnonzero(near)
    odd = fine[fine % 2 == 1]
    found = solved(folder / f"fine_{shape:02d}.npz", shape, odd / RADII, even, psis)
    all_values[odd - 1] = remainder(ratio, c, found["forces"], odd / RADII, even, psis)

    thetas = node_thetas()
    wide = mirrored_coefficients(all_values)[:, :, 1:-1]
    place = thetas / np.pi * COARSE - 0.5
    node = np.minimum(np.floor(place + 0.5).astype(int), COARSE - 1)
    t = (place - node)[:, None, None]
    resampled = 0.5 * (0.5 - t) ** 2 * wide[:, node] + (0.75 - t * t) * wide[:, node + 1]
    resampled = resampled + 0.5 * (0.5 + t) ** 2 * wide[:, node + 2]
    resampled = smoothed_psi(resampled)
    level = np.flatnonzero(abs(thetas - 0.5 * np.pi) < LEVEL)
    spinning = np.arange(3)
    states = fine / RADII, thetas[level], psis[spinning]
    found = solved(folder / f"spin_{shape:02d}.npz", shape, *states)
    resampled[np.ix_(fine - 1, level, spinning)] = remainder(ratio, c, found["forces"], *states)
    return c, resampled


def node_thetas() -> np.ndarray:
    """The table's theta: theta - WARP/2 sin 2 theta at the middles of equal parts, by Newton."""
    wanted = np.pi * (np.arange(THETAS) + 0.5) / THETAS
    theta = wanted.copy()
    for _ in range(60):
        slope = 1 - WARP * np.cos(2 * theta)
        theta -= (theta - 0.5 * WARP * np.sin(2 * theta) - wanted) / slope
    return theta


def smoothed_psi(coefficients: np.ndarray) -> np.ndarray:
    """Values at the nodes of psi from coefficients (..., theta, psi, 3), by the mirrors."""
    signs = np.array([1.0, -1.0, -1.0])
    before = np.concatenate([coefficients[..., :1, :], coefficients[..., :-1, :]], axis=-2)
    turned = signs * coefficients[..., ::-1, -1:, :]
    after = np.concatenate([coefficients[..., 1:, :], turned], axis=-2)
    return (before + 6 * coefficients + after) / 8


def extrapolated(values: np.ndarray, axis: int, low: int, high: int) -> np.ndarray:
    """More values before and after along an axis, third differences zero."""
    values = np.moveaxis(values, axis, 0)
    for _ in range(low):
        values = np.concatenate([(3 * values[0] - 3 * values[1] + values[2])[None], values])
    for _ in range(high):
        values = np.concatenate([values, (3 * values[-1] - 3 * values[-2] + values[-3])[None]])
    return np.moveaxis(values, 0, axis)


def open_coefficients(values: np.ndarray, axis: int) -> np.ndarray:
    """Coefficients of the quadratic B-spline through values at 0, 1, 2 ..., ends extrapolated."""
    count = values.shape[axis]
    matrix = np.zeros((count, count))
    for column in range(count):
        unit = extrapolated(np.eye(count)[column], 0, 1, 1)
        matrix[:, column] = (unit[:-2] + 6 * unit[1:-1] + unit[2:]) / 8
    solved = np.tensordot(np.linalg.inv(matrix), values, (1, axis))
    return np.moveaxis(solved, 0, axis)


def mirrored(values: np.ndarray) -> np.ndarray:
    """One more value on each side of theta and psi, (..., theta, psi, 3), by symmetry."""
    signs = np.array([1.0, -1.0, -1.0])
    # psi below 0: -v_x; above pi/2: -w, with theta turned round by v_y
    values = np.concatenate(
        [values[..., :1, :], values, signs * values[..., ::-1, -1:, :]], axis=-2
    )
    # theta below 0 and above pi: -v_x and -w, which is -v_y with all signs turned
    return np.concatenate(
        [signs * values[..., -1:, :, :], values, signs * values[..., :1, :, :]], axis=-3
    )


def mirrored_coefficients(values: np.ndarray) -> np.ndarray:
    """Coefficients over theta and psi, with those beyond the ends; by iteration to rounding."""
    found = values.copy()
    for _ in range(300):
        wide = mirrored(found)
        smooth = (wide[..., :-2, :, :] + 6 * wide[..., 1:-1, :, :] + wide[..., 2:, :, :]) / 8
        smooth = (smooth[..., :-2, :] + 6 * smooth[..., 1:-1, :] + smooth[..., 2:, :]) / 8
        found += values - smooth
    # at the poles theta = 0, pi the value is the mean of two rows, and the same for every psi
    signs = np.array([1.0, -1.0, -1.0])
    pole = 0.5 * (found[..., :1, :, :] + signs * found[..., -1:, :, :])
    uneven = pole.mean(axis=-2, keepdims=True) - pole
    found[..., :1, :, :] += uneven
    found[..., -1:, :, :] += signs * uneven
    return mirrored(found)


def remainder(
    ratio: float,
    c: np.ndarray,
    forces: np.ndarray,
    sigmas: np.ndarray,
    thetas: np.ndarray,
    psi: np.ndarray,
) -> np.ndarray:
    """H of the module exact_table at states of a shape: (sigmas, thetas, psi, 3)."""
    rho = np.array([size_at(sigma) for sigma in sigmas])
    s = (rho / (1 + rho))[:, None, None]
    theta = thetas[:, None]
    n_x, n_w = np.sin(theta) * np.sin(psi), np.sin(theta) * np.cos(psi)
    n_y = np.cos(theta)
    scale = turn_scale(c[0], c[2], 1 / np.sqrt(ratio))
    # the inverse of `rounded`, up to an eighth of its range below 1
    size = np.hypot(forces[..., 0], forces[..., 1])
    gap = np.maximum(1 - size, ROUND / 8)
    grown = np.where(gap < ROUND, 1 - ROUND - ROUND * np.log(gap / ROUND), size) / size
    h_x = (forces[..., 0] * grown / n_x - s) / s**2
    h_y = (forces[..., 1] * grown - s * (n_y + c[2] / scale * n_w)) / s**2
    h_m = (forces[..., 2] - s * (c[4] / scale * n_w - c[3] / c[1] * n_y)) / s**2
    return np.stack([h_x, h_y, h_m], axis=-1)


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "build/creep_table")
    folder.mkdir(parents=True, exist_ok=True)
    parts = [part(folder, shape) for shape in range(SHAPES)]
    table = mirrored_coefficients(np.stack([values for _, values in parts]))
    table = extrapolated(open_coefficients(table, 1), 1, 2, 1)
    table = extrapolated(open_coefficients(table, 0), 0, 1, 1)
    cells = np.stack([coefficients for coefficients, _ in parts])
    cells = extrapolated(open_coefficients(cells, 0), 0, 1, 1)
    content = io.BytesIO()
    np.save(content, np.concatenate([cells.ravel(), table.ravel()]).astype(np.float32))
    TABLE.write_bytes(content.getvalue())
    digest = hashlib.sha256(content.getvalue()).hexdigest()
    code = TABLE.with_suffix(".py")
    code.write_text(re.sub('SHA256 = "[0-9a-f]*"', f'SHA256 = "{digest}"', code.read_text()))
    print(f"{TABLE.name}: {len(content.getvalue())} bytes, shape {table.shape}, {digest}")


if __name__ == "__main__":
    main()
