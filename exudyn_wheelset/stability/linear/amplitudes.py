"""The eigenvalue that a motion of small but finite amplitude sees: where linear equations end.

About an equilibrium x0 with the mode v and its left vector l (l J = lambda l, l.v = 1) the motion
x0 + Re(z v), z = A exp(i phi), has l.(x - x0) = z/2, because l is orthogonal to the conjugate mode,
and z' = 2 l.(f(x0 + Re(z v)) - f(x0)). Over A exp(i phi), in the mean over phi,

    lambda(A) = (2/(n A)) sum_k l.(f(x0 + A Re(v exp(i phi_k))) - f(x0)) exp(-i phi_k),

is the eigenvalue itself for linear f, and to the first order of averaging what a motion of the
amplitude A grows and turns by: the describing function. A smooth law moves it with A^2; contact
forces that step where patches merge, a few micrometres beside the equilibrium, move it at once.

On vehicles with S1002 wheels it moves by less than 0.05 % of the frequency up to A = 0.1 mm. For a
three-axle truck on a measured wheel and rail with normal="hertz" it is 78 % off at 3 um and 201 %
at 10 um where the eigenvalue holds to 2e-4 % at 1 um; simulated motion from 3 um agrees with the
eigenvalue and from 10 um does not.

Lengths in m, eigenvalues in 1/s.
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.systems.system import DynamicSystem

# Amplitudes [m] of the wheelset that moves most: a tenth of the least that matters on a track, and
# what the finish of a rail leaves.
AMPLITUDES = (3.0e-6, 1.0e-5)
PHASES = 16


def eigenvalue_at(
    system: DynamicSystem,
    state: Array,
    speed: float,
    mode: Array,
    jacobian: Array,
    amplitude: float,
) -> complex:
    """lambda(A) [1/s] of a mode (n,) about an equilibrium (n,) at a speed [m/s].

    jacobian (n, n): at the equilibrium; amplitude A [m]: lateral, of the wheelset that moves most.
    NaN where the mode is no single one or moves no wheelset.
    """
    scales = np.asarray(system.scales)
    lateral = list(system.lateral_indices)
    largest = float(np.max(np.abs(mode[lateral]))) if lateral else 0.0
    if largest == 0.0:
        return complex(np.nan)
    mode = np.asarray(mode) / largest
    left = _left_vector(jacobian * scales[None, :] / scales[:, None], mode / scales) / scales
    if not np.all(np.isfinite(left)):
        return complex(np.nan)
    rest = np.array(system.derivative(state, speed))
    # Half a step beside the turning points, where a corner at the equilibrium would be met.
    turns = np.exp(2j * np.pi * (np.arange(PHASES) + 0.5) / PHASES)
    states = state + amplitude * np.real(turns[:, None] * mode)
    rates = (system.derivatives(states, speed) - rest) / amplitude
    return complex(2.0 / PHASES * np.sum((rates @ left) / turns))


def farthest_off(
    system: DynamicSystem, state: Array, speed: float, mode: Array, jacobian: Array
) -> tuple[float, float]:
    """|lambda(A) - lambda| over the frequency |Im lambda|, where greatest, and that A [m].

    (0, 0) for what has no wheelset, or no such mode.
    """
    scales = np.asarray(system.scales)
    scaled = np.asarray(mode) / scales
    eigenvalue = np.vdot(scaled, (jacobian @ mode) / scales) / np.vdot(scaled, scaled)
    worst, at = 0.0, 0.0
    for amplitude in AMPLITUDES:
        seen = eigenvalue_at(system, state, speed, mode, jacobian, amplitude)
        off = abs(seen - eigenvalue) / max(abs(eigenvalue.imag), 1e-12)
        if np.isfinite(off) and off > worst:
            worst, at = float(off), amplitude
    return worst, at


def _left_vector(matrix: Array, mode: Array) -> Array:
    """l of a mode (n,) of a matrix (n, n), l.mode = 1, by inverse iteration; else NaN."""
    eigenvalue = np.vdot(mode, matrix @ mode) / np.vdot(mode, mode)
    shifted = (matrix - (eigenvalue + 1e-9 * (1.0 + abs(eigenvalue))) * np.eye(len(mode))).T
    left = np.conj(mode)
    for _ in range(3):
        left = np.linalg.solve(shifted, left)
        left = left / np.linalg.norm(left)
    product = left @ mode
    if abs(product) < 1e-6 * np.linalg.norm(mode):
        return np.full(len(mode), np.nan)
    return np.asarray(left / product)
