"""Points of a branch with mesh points on the corners of the equations.

A corner of f inside an interval costs the orbit an error of second order and its multipliers one of
first: the trivial one is off by 0.1 where a flange is hit (Cooperrider's bogie at 90 m/s on 30
intervals), by 1e-3 or less with a mesh point there. So points with
corners are computed once more on them, and folds that have any are found there.

On elastic contact corners are not alone: forces of Hertz's formulas jump, and rapid motion between
wheel and rail asks for finer meshes; its points stay as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.corners import corners_of, mesh_on, on_mesh
from exudyn_wheelset.stability.hunting.corrector import solve_orbit
from exudyn_wheelset.stability.hunting.floquet import Multipliers
from exudyn_wheelset.stability.hunting.fold_points import BALANCE, Side, Slope, fold_near, prepared
from exudyn_wheelset.stability.hunting.fold_sensitivity import FoldSensitivity, sensitivity_at
from exudyn_wheelset.stability.hunting.folds import Base
from exudyn_wheelset.stability.hunting.orbit import Orbit, OrbitError, balanced_mesh
from exudyn_wheelset.systems.system import DynamicSystem

# Error of the trivial multiplier above which more intervals are tried: so many times the branch's.
ERROR = 1e-3
REFINED = (1, 2, 3)
# Of the orbit there, relative to its size: Newton's last step is a hundredth of it.
TOLERANCE = 1e-5
# Of the speed of a fold at a corner [m/s]: beside a flange that only just touches, the slope of the
# branch is steep, and for its derivatives the orbit has to be the fold's.
FOLD_TOLERANCE = 1e-7
# On elastic contact [m/s]: two intervals more or less move the speed by 1e-3, and derivatives by
# 0.5 %.
STIFF_FOLD_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class Point:
    """A converged orbit of a branch.

    multipliers     Floquet multipliers
    slope           speed component of the unit tangent; its sign changes at a fold
    is_fold         whether the speed has its extremum along the branch here
    sensitivity     of a fold's speed, where its orbit has mesh points on its corners
    """

    orbit: Orbit
    multipliers: Multipliers
    slope: float
    is_fold: bool = False
    sensitivity: FoldSensitivity | None = None


def point_at(equations: Collocation, base: Base, is_fold: bool = False) -> Point:
    """The point of a base, on the corners of f.

    The trivial multiplier alone does not tell of them: a driven motion has it right all the same.
    """
    multipliers = equations.multipliers(base.orbit, base.condensed)
    point = Point(base.orbit, multipliers, base.tangent.speed, is_fold)
    if equations.system.stiff:
        return point
    corners = corners_of(equations, base.orbit, base.condensed.gradients)
    for factor in REFINED if len(corners) else ():
        orbit, mesh = point.orbit, base.orbit.mesh
        if factor > 1:
            count = factor * (len(base.orbit.mesh) - 1)
            mesh = balanced_mesh(orbit, equations.scales, count, BALANCE)
        mesh = mesh_on(mesh, corners)
        row = equations.inner(mesh, on_mesh(equations, base.orbit, base.tangent, mesh))
        try:
            orbit = solve_orbit(equations, orbit.on_mesh(mesh), row, tolerance=TOLERANCE).orbit
            condensed = equations.condense(orbit)
        except OrbitError:
            break
        multipliers = equations.multipliers(orbit, condensed)
        if multipliers.error < max(point.multipliers.error, ERROR):
            point = Point(orbit, multipliers, base.tangent.speed, is_fold)
        if multipliers.error < ERROR:
            break
        corners = corners_of(equations, orbit, condensed.gradients)
    return point


def fold_at(equations: Collocation, fold: Base, beside: float) -> Point:
    """The point of a fold, with its sensitivity; `beside`: a speed of the branch near it [m/s]."""
    system = equations.system
    if system.stiff:
        return point_at(equations, fold, is_fold=True)
    found = Slope(equations, fold.orbit, fold.condensed, fold.tangent, np.asarray(fold.orbit.mesh))
    if len(corners_of(equations, fold.orbit, fold.condensed.gradients)):
        side: Side = "lowest" if beside > fold.orbit.speed else "highest"
        try:
            found = fold_near(system, prepared(system, fold.orbit), side, FOLD_TOLERANCE)
        except WheelsetError:
            return point_at(equations, fold, is_fold=True)
    multipliers = found.equations.multipliers(found.orbit, found.condensed)
    return Point(found.orbit, multipliers, 0.0, True, sensitivity_at(found))


def sensitivity_near(system: DynamicSystem, orbit: Orbit, side: Side) -> FoldSensitivity:
    """The sensitivity of the fold next to an orbit, found anew with mesh points on corners.

    Raises WheelsetError where it is not found.
    """
    tolerance = STIFF_FOLD_TOLERANCE if system.stiff else FOLD_TOLERANCE
    return sensitivity_at(fold_near(system, prepared(system, orbit), side, tolerance))
