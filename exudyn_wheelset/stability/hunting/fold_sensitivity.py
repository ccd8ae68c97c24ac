"""The speed of a fold as a linear functional of changes of the equations: its left null vector.

Collocation's equations G(X; p) = 0 of an orbit X = (x, T, V) have at a fold a tangent t without
speed. Across it they are regular, and a change dG of them moves the fold by

    G_X dX = -dG,   <t, dX> = 0,   phase condition;      dV = the speed of dX = <w, dG>       (1)

with one vector w for all changes, from the transposed equations. dG at a node is -h T df, h the
width of its interval: what a number of the vehicle costs is f along the orbit with it changed.

On an orbit that is its own mirror image, the part of df that is not has no influence of first
order: the mirrored vehicle has the same folds. The weights of the second half are those of the
first, mirrored.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.stability.hunting.fold_points import Slope


@dataclass(frozen=True, eq=False)
class FoldSensitivity:
    """What a change of f along the orbit of a fold does to its speed.

    speed    [m/s] of the fold
    states   (k, n) at the nodes of the whole period, SI units
    weights  (k, n) [m/s] for a change of f there by one unit
    """

    speed: float
    states: Array
    weights: Array

    def change(self, rates: Array) -> float:
        """Change of the fold's speed [m/s] with a change (k, n) of f at `states`."""
        return float(np.sum(self.weights * rates))


def sensitivity_at(fold: Slope) -> FoldSensitivity:
    """The sensitivity of a fold's speed."""
    equations, orbit = fold.equations, fold.orbit
    rows = [equations.phase(orbit), equations.inner(orbit.mesh, fold.tangent)]
    weights = fold.condensed.speed_weights(rows) * equations.speed_unit
    widths = np.diff(orbit.mesh)[:, None, None]
    weights = (-widths * orbit.duration * weights).reshape(-1, len(equations.scales))
    weights /= equations.scales
    states = equations.node_states(orbit)
    if orbit.mirror is not None:
        states = np.concatenate([states, orbit.mirror * states])
        weights = 0.5 * np.concatenate([weights, orbit.mirror * weights])
    return FoldSensitivity(orbit.speed, states, weights)
