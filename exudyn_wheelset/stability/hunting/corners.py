"""Corners of the equations along an orbit, and meshes with a point on each of them.

A flange spring behind a dead band, a bump stop, a wheel that leaves its rail: f is continuous there
and its Jacobian jumps. Within one interval a polynomial cannot follow that: the error is of second
order in the interval instead of eighth, and moves to and fro while nodes pass over the corner, so
that speeds of folds carry a noise (Cooperrider's bogie: 2e-3 m/s on 30 intervals) and their
derivatives more (60 % for the flange clearance). With a mesh point on every corner f is smooth
inside all intervals, the order is back, and derivatives by any number are those of the exact fold:
what a moving corner adds is the jump of f itself, which is none.

Corners are found from the Jacobians at the nodes: where an entry changes between two neighbours by
a large part of its range, the gap is halved again and again after the larger change. What is left
of the change at the end is a corner's; a steep but smooth entry has nothing left.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.stability.hunting.collocation import FORWARD_STEP, Collocation
from exudyn_wheelset.stability.hunting.condensed import Direction, Gradients
from exudyn_wheelset.stability.hunting.orbit import Orbit

# An entry that changes between two nodes by this part of its range is looked into.
SUSPECT = 0.3
# Entries whose range is below this part of the largest one's do not bend the orbit.
MINOR = 1e-3
# The gap is halved so many times; what is left of the change over so many times the last width is
# all of it at a corner, an eighth where it goes with the root of a depth.
HALVINGS, APART, LEFT = 12, 32.0, 0.4
# Mesh points nearer to a corner than this share of the intervals about it are taken out.
NEAREST = 0.2
# Points between nodes at which the Jacobian is taken: those where f departs from the orbit's slope
# by so many times the median, at most so many.
DEPARTURE, TOUCHES = 5.0, 8
# Gaps looked into at most, the largest changes first: contact patches may come and go in numbers.
MOST = 12


def corners_of(equations: Collocation, orbit: Orbit, gradients: Gradients) -> Array:
    """Phases (k,) of the stored part, rising, at which the Jacobian of f jumps.

    gradients: at the nodes of the orbit.
    """
    phases, entries = _with_touches(equations, orbit, gradients)
    ranges = np.ptp(entries, axis=0)
    counted = ranges > MINOR * ranges.max(initial=0.0)
    changes = np.abs(np.diff(entries, axis=0)) / np.where(counted, ranges, np.inf)
    worst = changes.reshape(len(changes), -1).max(axis=1)
    gaps = np.flatnonzero(worst > SUSPECT)
    gaps = np.sort(gaps[np.argsort(-worst[gaps], kind="stable")][:MOST])
    if not len(gaps):
        return np.empty(0)
    places = changes[gaps].reshape(len(gaps), -1).argmax(axis=1)
    rows, columns = np.unravel_index(places, ranges.shape)
    ends = np.stack([phases[gaps], phases[gaps + 1]])
    values = np.stack([entries[gaps, rows, columns], entries[gaps + 1, rows, columns]])
    return _halved(equations, orbit, ends, values, rows, columns)


def _with_touches(
    equations: Collocation, orbit: Orbit, gradients: Gradients
) -> tuple[Array, Array]:
    """Phases and Jacobians at the nodes and at those points between them where f departs most."""
    basis = equations.basis(orbit.degree)
    middles = 0.5 * (gradients.phases[1:] + gradients.phases[:-1])
    interval = np.clip(np.searchsorted(orbit.mesh, middles) - 1, 0, len(orbit.mesh) - 2)
    widths = np.diff(orbit.mesh)[interval]
    local = (middles - orbit.mesh[interval]) / widths
    powers = np.arange(orbit.degree + 1)
    slopes = powers * local[:, None] ** np.maximum(powers - 1, 0)
    weights = slopes @ np.linalg.inv(np.vander(basis.points, increasing=True))
    windows = equations.windows(orbit)[interval]
    moving = np.einsum("kj,kjn->kn", weights, windows) / (widths * orbit.duration)[:, None]
    states = orbit._inside(middles)
    departure = np.abs(moving - equations._rates(states, orbit.speed))
    departure /= np.maximum(np.ptp(gradients.rates, axis=0), 1e-300)
    size = departure.max(axis=1)
    most = np.argsort(-size)[:TOUCHES]
    most = np.sort(most[size[most] > DEPARTURE * np.median(size)])
    if not len(most):
        return gradients.phases, gradients.by_state
    if equations._differences:
        rates = equations._rates(states[most], orbit.speed)
        extra = equations._forward_differences(states[most], orbit.speed, rates)
    else:
        extra = equations._jacobians(states[most], orbit.speed)
    phases = np.append(gradients.phases, middles[most])
    order = np.argsort(phases)
    return phases[order], np.concatenate([gradients.by_state, extra])[order]


def _halved(
    equations: Collocation, orbit: Orbit, ends: Array, values: Array, rows: Array, columns: Array
) -> Array:
    """Phases at which entries (rows, columns) of the Jacobian jump between two ends (2, k); those
    that do not are left out."""
    left, right = ends.copy()
    below, above = values.copy()
    whole = np.abs(above - below)
    count = np.arange(len(left))

    def entries(phases: Array) -> Array:
        states = orbit._inside(np.concatenate([phases, phases]))
        states[len(count) + count, columns] += FORWARD_STEP * equations.scales[columns]
        rates = equations._rates(states, orbit.speed)
        change: Array = rates[len(count) + count, rows] - rates[count, rows]
        return change / FORWARD_STEP

    for _ in range(HALVINGS):
        middle = 0.5 * (left + right)
        value = entries(middle)
        lower = np.abs(value - below) > np.abs(above - value)
        right, above = np.where(lower, middle, right), np.where(lower, value, above)
        left, below = np.where(lower, left, middle), np.where(lower, below, value)
    middle = 0.5 * (left + right)
    # Beside the corner by more than what the differences smear.
    beside = APART * (right - left)
    left, right = np.maximum(middle - beside, ends[0]), np.minimum(middle + beside, ends[1])
    return np.asarray(middle[np.abs(entries(right) - entries(left)) > LEFT * whole])


def mesh_on(base: Array, corners: Array) -> Array:
    """A mesh (N + 1,) with a point on each corner and those of `base` that are not next to one."""
    mesh = np.array(base)
    for corner in corners:
        gaps = np.diff(mesh)
        place = int(np.clip(np.searchsorted(mesh, corner) - 1, 0, len(gaps) - 1))
        room = NEAREST * gaps[max(place - 1, 0) : place + 2].min()
        if room < min(corner, 1.0 - corner):
            kept = np.abs(mesh - corner) > room
            kept[0] = kept[-1] = True
            mesh = np.sort(np.append(mesh[kept], corner))
    return mesh


def rotated(orbit: Orbit, corners: Array) -> Orbit:
    """The same motion begun in the middle of the widest piece without a corner."""
    if not len(corners):
        return orbit
    gaps = np.diff(np.append(corners, corners[0] + 1.0))
    widest = int(np.argmax(gaps))
    share = 1.0 if orbit.mirror is None else 0.5
    shift = share * float(corners[widest] + 0.5 * gaps[widest])
    count = (len(orbit.mesh) - 1) * orbit.degree
    states = orbit.evaluate(share * np.arange(count + 1) / count + shift)
    states[-1] = states[0] if orbit.mirror is None else orbit.mirror * states[0]
    return replace(orbit, mesh=np.linspace(0.0, 1.0, len(orbit.mesh)), states=states)


def on_mesh(equations: Collocation, orbit: Orbit, way: Direction, mesh: Array) -> Direction:
    """A direction at an orbit, on another mesh."""
    ahead = equations.moved(orbit, way, 1.0).on_mesh(mesh)
    return equations.difference(ahead, replace(orbit.on_mesh(mesh), speed=orbit.speed))
