"""Where a branch of periodic orbits turns back: the extremum of the speed along it.

At a fold the speed component of the branch's tangent passes zero. Where f is smooth, that is the
root of a smooth function of the arclength and found by false position (`fold_between`). Jumps and
corners of f (a contact that changes place) are not in the Jacobians, and the tangent may not tell
of a turn that the orbits themselves make; there the fold is the extremum of V over the arclength s,
from parabolas through three orbits (`extremum_among`), which needs no derivative.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.condensed import Condensed, Direction, Functional
from exudyn_wheelset.stability.hunting.continuation_settings import ContinuationSettings
from exudyn_wheelset.stability.hunting.corrector import Solution, solve_orbit
from exudyn_wheelset.stability.hunting.orbit import Orbit, OrbitError


@dataclass(frozen=True, eq=False)
class Base:
    """A point to step from: the orbit, the equations there and the unit tangent."""

    orbit: Orbit
    condensed: Condensed
    tangent: Direction


def base_at(equations: Collocation, orbit: Orbit, condensed: Condensed, row: Functional) -> Base:
    """The base at an orbit, with its tangent on the side on which `row` grows."""
    shape = (len(orbit.mesh) - 1, orbit.degree, len(equations.scales))
    tangent = condensed.solve(np.zeros(shape), [equations.phase(orbit), row], [0.0, 1.0])
    return Base(orbit, condensed, unit(equations, orbit.mesh, tangent))


def solve_from(
    equations: Collocation,
    settings: ContinuationSettings,
    guess: Orbit,
    row: Functional,
    base: Base,
) -> Solution:
    """The orbit near `guess` on the plane of `row`, by the equations kept from a base."""
    return solve_orbit(
        equations,
        guess,
        row,
        condensed=base.condensed,
        reference=base.orbit,
        tolerance=settings.tolerance,
        roughness=settings.roughness,
    )


def unit(equations: Collocation, mesh: Array, direction: Direction) -> Direction:
    """A direction of length 1."""
    return direction * (1.0 / equations.norm(mesh, direction))


def parts(direction: Direction) -> tuple[Array, float, float]:
    """Orbit, period and speed of a direction, the arguments of a functional."""
    return direction.orbit, direction.period, direction.speed


def fold_between(
    equations: Collocation,
    settings: ContinuationSettings,
    left: Base,
    right: Base,
    length: float,
) -> Base:
    """The point between two bases, `length` apart, where the tangent's speed component vanishes.

    False position with halved weights (Illinois): the speed at the root is known to the
    square of the root's error where f is smooth, to the width of the bracket at a corner.
    """
    row = equations.inner(left.orbit.mesh, left.tangent)
    lower, upper = 0.0, length
    below, above = left.tangent.speed, right.tangent.speed
    start, best = left, left if abs(below) < abs(above) else right
    weights = [below, above]
    goal = settings.fold_tolerance * max(1.0, abs(left.orbit.speed))
    last_side = 0
    quiet, last_speed, last_slope = 0, np.inf, np.inf
    for _ in range(20):
        where = (lower * weights[1] - upper * weights[0]) / (weights[1] - weights[0])
        guess = equations.moved(left.orbit, left.tangent, where)
        if start is not left:
            way = equations.difference(start.orbit, left.orbit)
            shift = (where - row(*parts(way))) / row(*parts(start.tangent))
            guess = equations.moved(start.orbit, start.tangent, shift)
        try:
            found = solve_from(equations, settings, guess, row, start)
            condensed = equations.condense(found.orbit)
            start = base_at(equations, found.orbit, condensed, row)
        except OrbitError:
            break
        best, slope = start, start.tangent.speed
        # Where f has corners the slope jumps about zero, but the speed settles all the same.
        slow = abs(slope) > 0.2 * abs(last_slope)
        quiet = quiet + 1 if slow and abs(best.orbit.speed - last_speed) < goal else 0
        last_speed, last_slope = best.orbit.speed, slope
        if abs(slope) < 1e-6 * (abs(below) + abs(above)) or quiet > 1:
            break
        if slope * below > 0.0:
            lower, weights[0] = where, slope
            weights[1] *= 0.5 if last_side == 1 else 1.0
            last_side = 1
        else:
            upper, weights[1] = where, slope
            weights[0] *= 0.5 if last_side == -1 else 1.0
            last_side = -1
        if upper - lower < 1e-9 * length:
            break
    return best


def extremum_among(
    equations: Collocation, settings: ContinuationSettings, around: tuple[Base, Base, Base]
) -> tuple[Base, bool] | None:
    """The orbit of extreme speed near the middle one of three along a branch.

    Returns it and whether it lies before the middle one; None if the speed has no extremum there
    that is visible (`fold_visible`), or if no orbit is found.
    """
    first, middle, last = (base.orbit for base in around)
    turn = min(abs(middle.speed - first.speed), abs(middle.speed - last.speed))
    if (middle.speed - first.speed) * (last.speed - middle.speed) >= 0.0:
        return None
    if turn < settings.fold_visible * max(1.0, abs(middle.speed)):
        return None
    before = equations.difference(first.on_mesh(middle.mesh), middle)
    after = equations.difference(last.on_mesh(middle.mesh), middle)
    size = equations.norm(middle.mesh, before) + equations.norm(middle.mesh, after)
    way = Direction(
        after.orbit - before.orbit, after.period - before.period, after.speed - before.speed
    )
    row = equations.inner(middle.mesh, way * (1.0 / size))
    places = [row(*parts(before)), 0.0, row(*parts(after))]
    speeds = [first.speed, middle.speed, last.speed]
    if not places[0] < 0.0 < places[2]:
        return None
    best, start, where = around[1], around[1], 0.0
    goal = settings.fold_tolerance * max(1.0, abs(middle.speed))
    for _ in range(6):
        curve = np.polyfit(places, speeds, 2)
        top = float(-0.5 * curve[1] / curve[0]) if curve[0] else np.inf
        if not places[0] < top < places[2]:
            break
        side, share = (before, top / places[0]) if top < 0.0 else (after, top / places[2])
        guess = equations.moved(middle, side, share) if start is around[1] else start.orbit
        try:
            if start is not around[1]:
                guess = equations.moved(
                    guess, start.tangent, (top - where) / row(*parts(start.tangent))
                )
            found = solve_from(equations, settings, guess, row, start).orbit
            start = base_at(equations, found, equations.condense(found), row)
        except OrbitError:
            break
        where = row(*parts(equations.difference(found, middle)))
        if abs(found.speed - best.orbit.speed) < goal:
            best = start
            break
        sign = np.sign(speeds[1] - speeds[0])
        if sign * (found.speed - best.orbit.speed) < 0.0:
            break
        keep = 0 if where < places[1] else 2
        other = places[1], speeds[1]
        places[2 - keep], speeds[2 - keep] = other
        places[1], speeds[1] = where, found.speed
        best = start
    if best is around[1]:
        return None
    return best, row(*parts(equations.difference(best.orbit, middle))) < 0.0
