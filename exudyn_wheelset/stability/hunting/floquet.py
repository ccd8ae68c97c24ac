"""Floquet multipliers of a periodic orbit from its monodromy matrix, and how far to trust them.

The monodromy matrix M maps a small disturbance over one period. A shift along the orbit comes back
as it was: M e = e for e = x'(0)/|x'(0)|, the trivial multiplier 1. The others are to lie inside
the unit circle for the orbit to be stable.

The computed M has the trivial multiplier nearly only. With M = R diag(mu) R^-1 the direction of
motion is e = R c; the eigenvalue with the largest part |c_k| |r_k| is the trivial one. Near a fold
a second one comes to 1 and both have large parts: then (mu - 1)(mu - m) = mu^2 - (mu_1 + mu_2) mu
+ mu_1 mu_2 gives m = mu_1 + mu_2 - 1, which feels an error of M to the first order, where mu_1
and mu_2 themselves feel its root. What is left of (mu_1 - 1)(mu_2 - 1), zero for an exact M,
measures the error.

A vehicle that nothing holds along the track may stand anywhere along it and run a little faster:
such multipliers are 1 for every orbit and say nothing of hunting; they are told by their
eigenvectors, which move along the track and spin only. Dry friction leaves orbits that are a set as
well: what it holds within its band (a body between the rims of its centre plates) may stand a
little elsewhere and be held there. In a system with holds of friction multipliers that are 1 to
HELD_DISTANCE are those.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.stability.linear.neutral import holds
from exudyn_wheelset.systems.system import DynamicSystem

# Multipliers this near to 1 may be the trivial one, or one of two beside a fold.
NEAR_ONE = 0.5
# Part of the direction of motion, relative to the largest, from which a second one counts.
SECOND_PART = 0.05
# A neutral multiplier is off by its own error, of the order of the trivial one's.
NEUTRAL_DISTANCE = 0.02
NEUTRAL_SHARE = 0.95
# Neutral multipliers of the freight car's friction are off by 1e-5, the next are 0.999 and less.
HELD_DISTANCE = 2.0e-4
_ALONG = re.compile(r"(?:^|: )(?:x \[m\]|vx \[m/s\]|wy \[rad/s\]|pitch \[rad\])$")


@dataclass(frozen=True, eq=False)
class Multipliers:
    """What becomes of disturbances of an orbit over one period.

    values   (k,) complex, by falling size; the trivial and the neutral ones are left out
    error    distance of the trivial multiplier from 1: so far the others may be off, too; more
             where simulated motion has shown them to be (see `measured_growth`)
    neutral  number of multipliers of free motion along the track, and of what friction holds
    """

    values: Array
    error: float
    neutral: int

    def stable(self, margin: float) -> bool | None:
        """Whether all are inside the unit circle, to a margin; None if the error hides it."""
        largest = float(np.max(np.abs(self.values), initial=0.0))
        excess = largest - 1.0 - margin
        if abs(largest - 1.0) < self.error and self.error > margin:
            return None
        return excess < 0.0


def floquet_multipliers(monodromy: Array, along: Array, system: DynamicSystem) -> Multipliers:
    """Multipliers of an orbit; monodromy (n, n) and its direction of motion (n,), in scales."""
    values, vectors = np.linalg.eig(monodromy)
    try:
        parts = np.abs(np.linalg.solve(vectors, along / np.linalg.norm(along)))
    except np.linalg.LinAlgError:
        parts = np.abs(np.linalg.lstsq(vectors, along / np.linalg.norm(along))[0])
    near = np.abs(values - 1.0) < NEAR_ONE
    candidates = np.flatnonzero(near & (parts > SECOND_PART * np.max(parts[near], initial=0.0)))
    if not len(candidates):
        candidates = np.array([int(np.argmin(np.abs(values - 1.0)))])
    candidates = candidates[np.argsort(-parts[candidates], kind="stable")][:2]
    rest = np.delete(np.arange(len(values)), candidates)
    distances = np.abs(values[candidates] - 1.0)
    # Two of 1, one of which friction holds.
    held = len(candidates) == 2 and len(holds(system)) > 0 and distances.max() < HELD_DISTANCE
    if held:
        error, kept = float(distances.max()), values[rest]
    elif len(candidates) == 1:
        error, kept = float(abs(values[candidates[0]] - 1.0)), values[rest]
    else:
        one, two = values[candidates]
        other = complex(one + two - 1.0)
        left = abs((one - 1.0) * (two - 1.0))
        error = float(left / max(abs(other - 1.0), np.sqrt(left), 1e-300))
        kept = np.append(values[rest], other.real if abs(other.imag) < 1e-9 else other)
    along_track = _neutral(values[rest], vectors[:, rest], system)
    neutral = int(np.count_nonzero(along_track)) + int(held)
    kept = np.concatenate([kept[: len(rest)][~along_track], kept[len(rest) :]])
    order = np.argsort(-np.abs(kept), kind="stable")
    return Multipliers(kept[order], error, neutral)


def _neutral(values: Array, vectors: Array, system: DynamicSystem) -> Array:
    """Which multipliers (k,) near 1 belong to motion along the track and spin, or to friction."""
    held = np.zeros(len(values), dtype=bool)
    if len(holds(system)):
        held = np.abs(values - 1.0) < HELD_DISTANCE
    rows = [k for k, name in enumerate(system.state_names) if _ALONG.search(name)]
    if not rows or not system.wheelset_names:
        return held
    sizes = np.linalg.norm(vectors, axis=0)
    share = np.linalg.norm(vectors[rows], axis=0) / np.maximum(sizes, 1e-300)
    return np.asarray(held | ((share > NEUTRAL_SHARE) & (np.abs(values - 1.0) < NEUTRAL_DISTANCE)))
