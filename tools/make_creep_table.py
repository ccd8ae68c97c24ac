"""Make the table of the creep law "exact-table" from the law "exact".

    python tools/make_creep_table.py [folder of parts]

Parts, eight a shape, are kept in the folder (default build/creep_table); a second run makes those
that are missing. Then all are put together as exudyn_wheelset/creep/exact_table.npy, and its hash
is written into exudyn_wheelset/creep/exact_table.py. Half an hour of one core.
"""

import hashlib
import io
import math
import re
import sys
import time
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from exudyn_wheelset.creep.exact_nodes import (
    AXIS_RATIOS,
    POISSON,
    PSIS,
    RADII,
    ROUND,
    SHAPES,
    THETAS,
    WARP,
    cell_coefficients,
    cells_of,
    forces_at_nodes,
    size_at,
    turn_scale,
)
from exudyn_wheelset.creep.kalker import kalker_coefficients

TABLE = Path(__file__).parents[1] / "exudyn_wheelset" / "creep" / "exact_table.npy"
# equal parts of theta that are solved at every second sigma
COARSE = 18
# around saturation by spin: rho_e where all sigma are solved, at how many parts of theta on each
# side of pure spin and how many psi; half the range of theta where the table's own theta are
KNEE_FROM, KNEE_TO = 0.5, 1.75
AROUND, NEAR_SPIN = 4, 4
LEVEL, LEVEL_PSIS = math.radians(22), 3
# where creepage acts against spin the lateral force turns its sign within a few tenths of either:
# there the table's own theta and all sigma up to that rho_e
AGAINST, AGAINST_PSIS, AGAINST_TO = math.radians(152), 6, 3.2
# in place of psi = 0, where F_x is zero and F_x over n_x is wanted: on a wide patch the slip along
# x then turns round well within the strips of cells beside y = 0
SMALL_PSI = math.radians(0.5)
# of the change of tractions in a sweep: 2e-4 and 3e-5 of mu N
TOLERANCE, FINE_TOLERANCE = 2e-3, 3e-4


def solved(
    file: Path,
    shape: int,
    sigmas: np.ndarray,
    thetas: np.ndarray,
    psis: np.ndarray,
    tolerance: float = TOLERANCE,
) -> dict[str, np.ndarray]:
    """Forces of one shape at those states, from the files or made and kept there.

    The first psi has a file and a tolerance of its own.
    """
    first = _solved(file, shape, sigmas, thetas, psis[:1], FINE_TOLERANCE)
    others = file.with_name(f"others_{file.name}")
    rest = _solved(others, shape, sigmas, thetas, psis[1:], tolerance)
    return {**first, "forces": np.concatenate([first["forces"], rest["forces"]], axis=2)}


def _solved(
    file: Path,
    shape: int,
    sigmas: np.ndarray,
    thetas: np.ndarray,
    psis: np.ndarray,
    tolerance: float,
) -> dict[str, np.ndarray]:
    if not file.exists():
        start = time.process_time()
        ratio = 10 ** (2 * shape / (SHAPES - 1) - 1)
        cells = cells_of(ratio)
        coefficients = cell_coefficients(ratio, *cells)
        sizes = np.array([size_at(sigma) for sigma in sigmas])
        forces = [
            forces_at_nodes(ratio, *cells, coefficients, theta, sizes, psis, tolerance)
            for theta in thetas
        ]
        unfinished = file.with_name("unfinished.npz")
        np.savez(unfinished, ratio=ratio, coefficients=coefficients, forces=np.stack(forces, 1))
        unfinished.rename(file)
        print(f"{file.name}: {time.process_time() - start:.0f} s", flush=True)
    with np.load(file) as found:
        return dict(found)


def part(folder: Path, shape: int) -> tuple[np.ndarray, np.ndarray]:
    """The cells' coefficients of one shape, and H at its nodes.

    Solved are every second sigma at COARSE equal steps of theta; all sigma near saturation by spin
    in the directions around it; and there the table's own theta near pure spin, where the slope
    over lateral creepage falls by half within a tenth of that spin, and where creepage acts against
    spin. The other nodes are read off the
    splines through those.
    """
    psis = 0.5 * np.pi * np.arange(PSIS) / (PSIS - 1)
    psis[0] = SMALL_PSI
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
    sizes = np.array([size_at(i / RADII) for i in range(1, RADII + 1)])
    fine = 1 + np.flatnonzero((sizes > KNEE_FROM) & (sizes < KNEE_TO))
    odd = fine[fine % 2 == 1]
    around = np.arange(COARSE // 2 - AROUND, COARSE // 2 + AROUND)
    near = np.arange(NEAR_SPIN)
    states = odd / RADII, even[around], psis[near]
    found = solved(folder / f"fine_{shape:02d}.npz", shape, *states)
    all_values[np.ix_(odd - 1, around, near)] = remainder(ratio, c, found["forces"], *states)

    thetas = node_thetas()
    wide = mirrored_coefficients(all_values)[:, :, 1:-1]
    place = thetas / np.pi * COARSE - 0.5
    node = np.minimum(np.floor(place + 0.5).astype(int), COARSE - 1)
    t = (place - node)[:, None, None]
    resampled = 0.5 * (0.5 - t) ** 2 * wide[:, node] + (0.75 - t * t) * wide[:, node + 1]
    resampled = resampled + 0.5 * (0.5 + t) ** 2 * wide[:, node + 2]
    resampled = smoothed_psi(resampled)
    level = np.flatnonzero(abs(thetas - 0.5 * np.pi) < LEVEL)
    against = np.flatnonzero((thetas > 0.5 * np.pi) & (thetas < AGAINST))
    opposed = 1 + np.flatnonzero((sizes > KNEE_FROM) & (sizes < AGAINST_TO))
    spinning = np.arange(AGAINST_PSIS)
    states = opposed / RADII, thetas[against], psis[spinning]
    found = solved(folder / f"against_{shape:02d}.npz", shape, *states)
    of_states = remainder(ratio, c, found["forces"], *states)
    # beyond the knee both sides of pure spin come from the same solutions: their slope meets there
    used = (thetas[against] > 0.5 * np.pi + LEVEL) | (sizes[opposed - 1] < KNEE_TO)[:, None]
    block = np.ix_(opposed - 1, against, spinning)
    resampled[block] = np.where(used[:, :, None, None], of_states, resampled[block])
    spinning = np.arange(LEVEL_PSIS)
    states = fine / RADII, thetas[level], psis[spinning]
    found = solved(folder / f"spin_{shape:02d}.npz", shape, *states, FINE_TOLERANCE)
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
    before = np.concatenate([coefficients[..., 1:2, :], coefficients[..., :-1, :]], axis=-2)
    turned = signs * coefficients[..., ::-1, -2:-1, :]
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
        [values[..., 1:2, :], values, signs * values[..., ::-1, -2:-1, :]], axis=-2
    )
    # theta below 0 and above pi: -v_x and -w, which is -v_y with all signs turned
    return np.concatenate(
        [signs * values[..., -1:, :, :], values, signs * values[..., :1, :, :]], axis=-3
    )


def mirrored_coefficients(values: np.ndarray) -> np.ndarray:
    """Coefficients over theta and psi, with those beyond the ends; by iteration to rounding."""
    signs = np.array([1.0, -1.0, -1.0])
    values = values.copy()
    without_spin = values[..., -1, :]
    values[..., -1, :] = 0.5 * (without_spin + signs * without_spin[..., ::-1, :])
    found = values.copy()
    for _ in range(300):
        wide = mirrored(found)
        smooth = (wide[..., :-2, :, :] + 6 * wide[..., 1:-1, :, :] + wide[..., 2:, :, :]) / 8
        smooth = (smooth[..., :-2, :] + 6 * smooth[..., 1:-1, :] + smooth[..., 2:, :]) / 8
        found += values - smooth
    # at the poles theta = 0, pi the value is the mean of two rows, and the same for every psi
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
    theta = thetas[:, None]
    n_x, n_w = np.sin(theta) * np.sin(psi), np.sin(theta) * np.cos(psi)
    n_y = np.cos(theta)
    scale = turn_scale(c[0], c[2], 1 / np.sqrt(ratio))
    sizes = np.array([size_at(sigma) for sigma in sigmas])[:, None, None]
    rho = sizes / (1 - (1 - c[2] / scale) * n_w**2)
    s = rho / (1 + rho)
    # the inverse of `rounded`, up to an eighth of its range below 1
    size = np.hypot(forces[..., 0], forces[..., 1])
    gap = np.maximum(1 - size, ROUND / 8)
    grown = np.where(gap < ROUND, 1 - ROUND - ROUND * np.log(gap / ROUND), size) / size
    h_x = (forces[..., 0] * grown / n_x - s) / s**2
    h_y = (forces[..., 1] * grown - s * (n_y + c[2] / scale * n_w)) / s**2
    h_m = (forces[..., 2] - s * (c[4] / scale * n_w - c[3] / c[1] * n_y)) / s**2
    return np.stack([h_x, h_y, h_m], axis=-1)


def smooth_kalker(lg_ratio: np.ndarray) -> np.ndarray:
    """Kalker's C11, C22, C23, C33: ln C by a cubic spline over lg(a/b) through his axis ratios."""
    ratios = np.array([*np.arange(1, 10) / 10, 1.0, *10 / np.arange(9, 0, -1)])
    nodes = [kalker_coefficients(ratio, 1.0, POISSON) for ratio in ratios]
    return np.exp(CubicSpline(np.log10(ratios), np.log(nodes))(lg_ratio))


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "build/creep_table")
    folder.mkdir(parents=True, exist_ok=True)
    parts = [part(folder, shape) for shape in range(SHAPES)]
    table = mirrored_coefficients(np.stack([values for _, values in parts]))
    table = extrapolated(open_coefficients(table, 1), 1, 2, 1)
    table = extrapolated(open_coefficients(table, 0), 0, 1, 1)
    # C11, C22, C23, C32, C33 of the cells over Kalker's
    kalker = smooth_kalker(np.linspace(-1, 1, SHAPES))[:, [0, 1, 2, 2, 3]]
    cells = np.stack([coefficients for coefficients, _ in parts]) / kalker
    cells = extrapolated(open_coefficients(cells, 0), 0, 1, 1)
    kalker = smooth_kalker(np.linspace(-1, 1, AXIS_RATIOS))
    kalker = extrapolated(open_coefficients(kalker, 0), 0, 1, 1)
    content = io.BytesIO()
    everything = [cells.ravel(), kalker.ravel(), table.ravel()]
    np.save(content, np.concatenate(everything).astype(np.float32))
    TABLE.write_bytes(content.getvalue())
    digest = hashlib.sha256(content.getvalue()).hexdigest()
    code = TABLE.with_suffix(".py")
    code.write_text(re.sub('SHA256 = "[0-9a-f]*"', f'SHA256 = "{digest}"', code.read_text()))
    print(f"{TABLE.name}: {len(content.getvalue())} bytes, shape {table.shape}, {digest}")


if __name__ == "__main__":
    main()
