"""Neutral states: friction that holds with any force, so equilibria that are a set.

At rest the rate of each hold of friction (a first-order state named "... hold [-]") is zero
whatever the hold is: a system with m of them has m zero roots, whose modes are any combinations.
Told apart they say more: the mode of one hold is that hold strained, all others relaxed, with all
bodies where that leaves them. Such a mode neither grows nor dies; its equilibrium is the one that
loading left behind (`vehicles.struts.strokes_at`).
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.systems.system import DynamicSystem

_HOLD = " hold [-]"
# Roots below it [1/s] are zero but for rounding.
_ZERO = 1.0e-6
_NEUTRAL = "neutral: "
# Part of the largest strain that another hold may have by rounding.
_ALONE = 0.1


def holds(system: DynamicSystem) -> Array:
    """Indices (m) of the states that are holds of friction."""
    named = [k for k, name in enumerate(system.state_names) if name.endswith(_HOLD)]
    return np.array(named, dtype=int)


def separated(system: DynamicSystem, values: Array, modes: Array) -> Array:
    """Modes (n, n) with those of zero roots replaced by one a hold, as far as they are neutral."""
    strained = holds(system)
    zero = np.flatnonzero(np.abs(values) < _ZERO)
    if not len(strained) or len(zero) < len(strained):
        return modes
    basis, _ = np.linalg.qr(modes[:, zero] / system.scales[:, None])
    # Columns that strain one hold each, by least squares in the space of the zero roots.
    left, sizes, right = np.linalg.svd(basis[strained], full_matrices=True)
    if sizes[-1] < 1e-9 * sizes[0]:
        return modes
    rank = len(strained)
    single = basis @ (right[:rank].conj().T @ (left.conj().T / sizes[:, None]))
    free = basis @ right[rank:].conj().T
    changed = modes.astype(complex)
    changed[:, zero] = system.scales[:, None] * np.hstack([single, free])
    return changed


def neutral_name(system: DynamicSystem, value: complex, mode: Array) -> str | None:
    """Name of a mode (n) of a zero root that strains one hold; None for any other."""
    strained = holds(system)
    if not len(strained) or abs(value) >= _ZERO:
        return None
    sizes = np.abs(mode[strained])
    if np.sort(sizes)[-2:-1].sum() > _ALONE * sizes.max():
        return None
    name: str = system.state_names[strained[int(np.argmax(sizes))]]
    return _NEUTRAL + name.rpartition(": ")[2].removesuffix(_HOLD)
