"""Orbits on a plane across their branch, and the fold as the root of the slope along it.

At a fixed vehicle the orbits near a fold are a curve s -> X(s), V(s), regular where V turns back.
The slope h = dV/ds comes from the same linear equations as Newton's correction (the speed
component of the unit tangent), so that a fold is a root of h, and the speed at it is known to the
square of the root's error: V_fold = V - h^2/(2 h'). Corners of f have a mesh point each (see
`corners`), so that h is smooth.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.condensed import Condensed, Direction
from exudyn_wheelset.stability.hunting.corners import corners_of, mesh_on, on_mesh, rotated
from exudyn_wheelset.stability.hunting.corrector import solve_orbit
from exudyn_wheelset.stability.hunting.folds import base_at, parts
from exudyn_wheelset.stability.hunting.orbit import Orbit, balanced_mesh
from exudyn_wheelset.stability.hunting.symmetry import mirror_of_orbit
from exudyn_wheelset.systems.system import DynamicSystem

# The mesh follows the corners so many times.
ALIGN = 3
# Corners count as met when they lie this near to their mesh points, in phase.
MET = 1e-5
# The first step along the branch that shows the change of slope, as a share of the orbit's size.
FIRST_STEP = 0.01
# The fold of a diagram is looked for so far from its orbit, as a share of the orbit's size.
FARTHEST = 0.5
# Share of the mesh that follows the error of the orbit, where corners have points of their own.
BALANCE = 0.5
# Wheels on rails: with 60 intervals a fold of the S1002 wheelset is off by 8e-3 m/s and its
# gradient by 3 %, with 90 by 1e-3 m/s and 0.2 %.
STIFF_INTERVALS = 90
TOLERANCE = 1e-9

Side = Literal["lowest", "highest"]
ROUGHNESS = 1e-3


@dataclass(frozen=True, eq=False)
class Slope:
    """An orbit with the unit tangent of its branch; slope: its speed component [m/s]; base: its
    mesh without the points on corners."""

    equations: Collocation
    orbit: Orbit
    condensed: Condensed
    tangent: Direction
    base: Array

    @property
    def slope(self) -> float:
        return self.tangent.speed * self.equations.speed_unit

    @property
    def size(self) -> float:
        """Distance of the orbit from its mean, in scales."""
        return self.equations.size(self.orbit)


def prepared(
    system: DynamicSystem,
    orbit: Orbit,
    intervals: int | None = None,
    others: Sequence[DynamicSystem] = (),
) -> Orbit:
    """An orbit of a diagram, as its own mirror image where it is one, on a balanced mesh, begun
    away from the corners of f.

    others: systems that have to be symmetric too for that.
    """
    mirror = mirror_of_orbit(system, orbit)
    for other in others:
        signs = mirror_of_orbit(other, orbit)
        if mirror is None or signs is None or not np.array_equal(signs, mirror):
            mirror = None
    whole = orbit.whole()
    part = whole if mirror is None else whole.halved(mirror)
    equations = Collocation(system, part.period, 1.0, mirror)
    part = rotated(part, corners_of(equations, part, equations.gradients(part)))
    if intervals is None:
        intervals = max(len(whole.mesh) - 1, STIFF_INTERVALS if system.stiff else 0)
    if mirror is not None:
        intervals = (intervals + 1) // 2
    return part.on_mesh(balanced_mesh(part, system.scales, intervals, BALANCE))


def orbit_on_plane(
    system: DynamicSystem,
    guess: Orbit,
    way: Direction | None = None,
    start: Slope | None = None,
    align: int = ALIGN,
) -> Slope:
    """The orbit on the plane across `way` through `guess`, its mesh on the corners of f.

    way: a direction along the branch on the guess's mesh; None: that of growth. start: equations
    of a neighbour on the same mesh, to begin Newton's method with; align: how often at most the
    mesh follows the corners. Raises OrbitError.
    """
    equations = Collocation(system, guess.period, 1.0, guess.mirror)
    base = guess.mesh if start is None else start.base
    condensed = None
    if start is not None and np.array_equal(start.orbit.mesh, guess.mesh):
        condensed = start.condensed
    if way is None:
        windows = equations.windows(guess)
        way = Direction(windows - windows.mean(axis=(0, 1)), 0.0, 0.0)
    for left in range(align, -1, -1):
        row = equations.inner(guess.mesh, way)
        found = solve_orbit(
            equations, guess, row, condensed=condensed, tolerance=TOLERANCE, roughness=ROUGHNESS
        )
        orbit = found.orbit
        condensed = equations.condense(orbit)
        corners = corners_of(equations, orbit, condensed.gradients)
        mesh = mesh_on(base, corners)
        if not left or (len(mesh) == len(orbit.mesh) and np.abs(mesh - orbit.mesh).max() < MET):
            break
        way = on_mesh(equations, orbit, way, mesh)
        guess, condensed = orbit.on_mesh(mesh), None
    assert condensed is not None
    base_point = base_at(equations, orbit, condensed, equations.inner(orbit.mesh, way))
    return Slope(equations, orbit, condensed, base_point.tangent, base)


def along(point: Slope, distance: float) -> Orbit:
    """The orbit's first-order neighbour at a distance along its branch."""
    return point.equations.moved(point.orbit, point.tangent, distance)


def distance_between(point: Slope, other: Slope) -> float:
    """How far another orbit lies along the branch from a point of it."""
    moved = point.equations.difference(other.orbit.on_mesh(point.orbit.mesh), point.orbit)
    return point.equations.inner(point.orbit.mesh, point.tangent)(*parts(moved))


def fold_near(system: DynamicSystem, orbit: Orbit, side: Side, tolerance: float = 1e-5) -> Slope:
    """The fold near an orbit: the least speed of its branch, or the highest, by `side`.

    On elastic contact the mesh is held after the first orbit: there corners come and go from orbit
    to orbit, and with them mesh points and the speed, by some 1e-3 m/s.

    tolerance: of the fold's speed [m/s]. Raises OrbitError where no orbit, and AnalysisError where
    no fold is found.
    """
    sign = 1.0 if side == "lowest" else -1.0
    point = orbit_on_plane(system, orbit)
    align = 0 if system.stiff else ALIGN
    step = FIRST_STEP * point.size
    for _ in range(12):
        # A step with this slope would not change the speed by more.
        if abs(point.slope) * step <= tolerance:
            return point
        move = -sign * np.sign(point.slope) * step
        other = orbit_on_plane(system, along(point, move), point.tangent, point, align)
        if other.slope * point.slope <= 0.0:
            return _between(system, point, other, tolerance, align)
        point, step = other, 2.0 * step
        if step > FARTHEST * point.size:
            break
    raise AnalysisError(
        f"{system.name}: the speed has no extremum along the branch near {orbit.speed:.4f} m/s"
    )


def _between(
    system: DynamicSystem, first: Slope, second: Slope, tolerance: float, align: int
) -> Slope:
    """The point of vanishing slope between two, by false position with halved weights."""
    width = distance_between(first, second)
    lower, upper = 0.0, width
    below, above = first.slope, second.slope
    best, place = (first, 0.0) if abs(below) < abs(above) else (second, width)
    side = 0
    for _ in range(25):
        # The speed changes by less than the slope at its end over what is left.
        if abs(best.slope) * abs(upper - lower) < tolerance:
            break
        where = (lower * above - upper * below) / (above - below)
        # Not next to an end of the bracket: a slope that grows with a root is nearly a step.
        where = float(
            np.clip(where, *np.sort([0.95 * lower + 0.05 * upper, 0.05 * lower + 0.95 * upper]))
        )
        new = orbit_on_plane(system, along(best, where - place), best.tangent, best, align)
        best, place = new, where
        if new.slope * below > 0.0:
            lower, below = where, new.slope
            above *= 0.5 if side == 1 else 1.0
            side = 1
        else:
            upper, above = where, new.slope
            below *= 0.5 if side == -1 else 1.0
            side = -1
    return best
