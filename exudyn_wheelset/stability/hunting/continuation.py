"""Continuation: a branch of periodic orbits followed through folds, from stable to unstable.

The orbit, its period T and the forward speed V are one unknown X. From a known X0 with the unit
tangent t the next point is predicted at X0 + ds t and corrected on the plane across the tangent,

    collocation equations (X) = 0,   <X - X0, t> = ds                                  (1)

(Keller's pseudo-arclength), so that a fold, where V turns back, is a point like any other. On a
branch born at a Hopf point the first predictor is the eigenvector: x0 + e Re(v exp(2 pi i s)),
T = 2 pi/omega, t = (Re(v exp(2 pi i s)), 0, 0).

The Jacobians at a converged point give its tangent and its Floquet multipliers, and are used
again for the corrector of the next point. Folds are roots of the tangent's speed component.

Wheels on rails are not smooth (flange, saturated creep, lift-off): there the tangent turns on a
short length, so a step is also refused when the tangent turns by more than `turn`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.stability.hunting.aligned import Point, fold_at, point_at
from exudyn_wheelset.stability.hunting.collocation import Collocation
from exudyn_wheelset.stability.hunting.condensed import Condensed, Direction, Functional
from exudyn_wheelset.stability.hunting.continuation_settings import ContinuationSettings
from exudyn_wheelset.stability.hunting.corrector import solve_orbit, speed_row
from exudyn_wheelset.stability.hunting.folds import (
    Base,
    base_at,
    extremum_among,
    fold_between,
    parts,
    solve_from,
    unit,
)
from exudyn_wheelset.stability.hunting.orbit import Orbit, OrbitError, balanced_mesh
from exudyn_wheelset.stability.linear.crossings import CriticalPoint

# The first orbit's speed is to lie this near to the Hopf point's, relative to it.
FIRST_SPEED = 5e-3


def hopf_start(
    equations: Collocation, hopf: CriticalPoint, settings: ContinuationSettings
) -> tuple[Orbit, Condensed, Direction]:
    """First small orbit off a Hopf point, the equations near it and the tangent of growth.

    The amplitude is halved until Newton converges near the point, and further while the speed is
    not near the point's, so that a fold close to it is not stepped over. Raises OrbitError.
    """
    system = equations.system
    frequency = abs(hopf.eigenvalue.imag)
    mode = np.asarray(hopf.mode)
    if hopf.eigenvalue.imag < 0.0:
        mode = mode.conj()
    displacements = list(system.displacement_indices)
    mode = mode / np.abs((mode / equations.scales)[displacements]).max()
    mirror = equations.mirror
    intervals = settings.intervals if mirror is None else (settings.intervals + 1) // 2
    count = intervals * settings.degree
    turn = 2j * np.pi if mirror is None else 1j * np.pi
    cycle = np.real(mode[None, :] * np.exp(turn * np.arange(count + 1) / count)[:, None])
    mesh = np.linspace(0.0, 1.0, intervals + 1)
    amplitude = settings.first_amplitude
    failure = "Newton converged to another motion"
    good: tuple[Orbit, Condensed, Direction] | None = None
    for _ in range(10):
        states = hopf.state + amplitude * cycle
        states[-1] = states[0] if mirror is None else mirror * states[0]
        guess = Orbit(mesh, states, 2.0 * np.pi / frequency, float(hopf.speed), mirror)
        resting = replace(guess, states=np.tile(hopf.state, (count + 1, 1)))
        tangent = unit(equations, mesh, equations.difference(guess, resting))
        row = equations.inner(mesh, tangent)
        try:
            found = solve_orbit(
                equations,
                guess,
                row,
                tolerance=settings.tolerance,
                roughness=settings.roughness,
            )
        except OrbitError as error:
            failure = str(error)
        else:
            orbit = found.orbit
            near = abs(orbit.speed - hopf.speed) < 0.03 * max(1.0, abs(hopf.speed))
            kept = 0.3 < equations.size(orbit) / equations.size(guess) < 3.0
            if near and kept and 0.8 < orbit.period / guess.period < 1.25:
                good = orbit, found.condensed, tangent
                if abs(orbit.speed - hopf.speed) < FIRST_SPEED * max(1.0, abs(hopf.speed)):
                    return good
        amplitude *= 0.5
    if good is not None:
        return good
    raise OrbitError(
        f"no small orbit was found next to the Hopf point at {float(hopf.speed):.4f} m/s: {failure}"
    )


def follow(
    equations: Collocation,
    orbit: Orbit,
    heading: Direction | float,
    speeds: tuple[float, float],
    settings: ContinuationSettings,
    report: Callable[[Point], None] | None = None,
) -> tuple[list[Point], Outcome]:
    """Points of the branch through `orbit`, starting with it, and how it ends.

    `heading` is a direction of growth, or +1.0 or -1.0 to set out to higher or lower speed. The
    branch ends where it leaves `speeds` (low, high) [m/s], at an amplitude limit, where the model
    loses contact, where Newton fails at the smallest step, back at its start, at an equilibrium
    (Hopf point), after the largest number of points, or on a keyboard interrupt. Nothing that
    was found is lost. Each point goes to `report`.
    """
    follower = _Follower(equations, speeds, settings, report)
    try:
        follower.begin(orbit, heading)
        outcome = None
        while outcome is None:
            outcome = follower.advance()
    except OrbitError as error:
        if not follower.points:
            raise
        outcome = _failure(error)
    except KeyboardInterrupt:
        outcome = Outcome(Ending.INTERRUPTED)
    return follower.points, outcome


class _Follower:
    def __init__(
        self,
        equations: Collocation,
        speeds: tuple[float, float],
        settings: ContinuationSettings,
        report: Callable[[Point], None] | None,
    ) -> None:
        self.equations = equations
        self.low, self.high = speeds
        self.settings = settings
        self.report = report
        self.points: list[Point] = []
        names = equations.system.state_names
        self.limits = [(names.index(name), limit) for name, limit in settings.amplitude_limits]

    def begin(self, orbit: Orbit, heading: Direction | float) -> None:
        condensed = self.equations.condense(orbit)
        size = len(self.equations.scales)
        if isinstance(heading, Direction):
            row = self.equations.inner(orbit.mesh, heading)
        else:
            row = speed_row(orbit, size)
            row = Functional(row.orbit, 0.0, float(heading))
        self.base = base_at(self.equations, orbit, condensed, row)
        self.first, self.away = self.base, False
        self.behind: Base | None = None
        self._keep(point_at(self.equations, self.base))
        self.step = 0.3 * self._largest_step()
        self.size = self.equations.size(orbit)

    def advance(self) -> Outcome | None:
        """One step along the branch; an outcome if the branch ends with it."""
        settings = self.settings
        if len(self.points) >= settings.maximum_points:
            return Outcome(Ending.MAXIMUM_POINTS, f"{settings.maximum_points}")
        largest = self._largest_step()
        self.step = min(self.step, largest)
        while True:
            try:
                return self._try_step()
            except OrbitError as error:
                if self.step < settings.smallest_step * largest:
                    return _failure(error)
                self.step *= 0.4

    def _try_step(self) -> Outcome | None:
        equations, settings, base = self.equations, self.settings, self.base
        length, tangent = self.step, base.tangent
        row = equations.inner(base.orbit.mesh, tangent)
        guess = equations.moved(base.orbit, tangent, length)
        end = self._end_passed(guess.speed)
        if end is None:
            found = solve_from(equations, settings, guess, row, base)
            end = self._end_passed(found.orbit.speed)
        if end is not None:
            length *= (end - base.orbit.speed) / (guess.speed - base.orbit.speed)
            if not length > 0.0:
                return self._left(end)
            guess = equations.moved(base.orbit, tangent, length)
            found = solve_from(
                equations, settings, guess, speed_row(base.orbit, len(equations.scales)), base
            )
        orbit = found.orbit
        size = equations.size(orbit)
        if not 0.4 < size / equations.size(guess) < 2.5:
            raise OrbitError("Newton left the branch: the orbit changed its size")
        if not 0.67 < orbit.period / guess.period < 1.5:
            raise OrbitError("Newton left the branch: the orbit changed its period")
        if self._turns_back(orbit):
            raise OrbitError("the orbits lead back along the branch")
        condensed = equations.condense(orbit)
        new = base_at(equations, orbit, condensed, equations.inner(orbit.mesh, tangent))
        cosine = equations.inner(orbit.mesh, tangent)(*parts(new.tangent))
        # At a corner of the branch (a contact that sets in) every step turns by as much: the
        # smallest ones are let through.
        large = self.step > settings.corner * self._largest_step()
        if large and cosine < np.cos(settings.turn):
            raise OrbitError("the branch turns more sharply than a step may")
        # On a straight tread the branch is vertical, and its speed rises and falls by rounding.
        excursion = 0.25 * length * max(abs(tangent.speed), abs(new.tangent.speed))
        visible = excursion * equations.speed_unit > settings.fold_visible * max(1.0, orbit.speed)
        if visible and new.tangent.speed * tangent.speed < 0.0:
            fold = fold_between(equations, settings, base, new, length)
            turned = (fold.orbit.speed - base.orbit.speed) * (orbit.speed - fold.orbit.speed) <= 0.0
            if turned:
                self._keep(fold_at(equations, fold, base.orbit.speed))
        self._keep(point_at(self.equations, new))
        self._look_back(new)
        self.behind, self.base = base, new
        if end is not None:
            return self._left(end)
        outcome = self._over_limits(orbit, size)
        if outcome is not None:
            return outcome
        effort = found.iterations + 3 * found.refreshed
        self.step *= 1.5 if effort <= 10 else 1.0 if effort <= 15 else 0.7
        intervals = self._intervals_wanted(self.points[-1].multipliers.error)
        if len(self.points) % settings.adapt_every == 0 or intervals > len(orbit.mesh) - 1:
            self._adapt(intervals)
        return None

    def _look_back(self, new: Base) -> None:
        """Insert a fold that the last three orbits show and the tangents have not."""
        if self.behind is None or any(point.is_fold for point in self.points[-3:]):
            return
        found = extremum_among(self.equations, self.settings, (self.behind, self.base, new))
        if found is not None:
            fold, before_middle = found
            place = len(self.points) - (2 if before_middle else 1)
            self.points.insert(place, point_at(self.equations, fold, is_fold=True))

    def _intervals_wanted(self, error: float) -> int:
        settings, count = self.settings, len(self.base.orbit.mesh) - 1
        parts = 1 if self.equations.mirror is None else 2
        if error > settings.accuracy:
            return max(count, min(count + count // 2, settings.maximum_intervals // parts))
        if error < 0.02 * settings.accuracy:
            return max((settings.intervals + parts - 1) // parts, count - count // 4)
        return count

    def _turns_back(self, orbit: Orbit) -> bool:
        """Whether a step to an orbit goes against the last one: at a jump of f it may."""
        if self.behind is None:
            return False
        equations, here = self.equations, self.base.orbit
        last = equations.difference(here, self.behind.orbit.on_mesh(here.mesh))
        new = equations.difference(orbit, here)
        lengths = equations.norm(here.mesh, last) * equations.norm(here.mesh, new)
        return equations.inner(here.mesh, last)(*parts(new)) < -0.5 * lengths

    def _largest_step(self) -> float:
        """Arclength in which the orbit changes by `growth` or the speed by a step of the range."""
        equations, base = self.equations, self.base
        part = Direction(base.tangent.orbit, base.tangent.period, 0.0)
        change = equations.norm(base.orbit.mesh, part)
        by_size = self.settings.growth * equations.size(base.orbit) / max(change, 1e-12)
        step = (self.high - self.low) / self.settings.speed_steps / equations.speed_unit
        by_speed = step / max(abs(base.tangent.speed), 1e-12)
        return min(by_size, by_speed)

    def _keep(self, point: Point) -> None:
        self.points.append(point)
        if self.report is not None:
            self.report(point)

    def _adapt(self, intervals: int) -> None:
        """Move the base to a mesh that spreads the error, with its Jacobians interpolated."""
        equations, base = self.equations, self.base
        mesh = balanced_mesh(base.orbit, equations.scales, intervals)
        orbit = base.orbit.on_mesh(mesh)
        ahead = equations.moved(base.orbit, base.tangent, 1.0).on_mesh(mesh)
        tangent = unit(equations, mesh, equations.difference(ahead, orbit))
        gradients = base.condensed.gradients.on_mesh(mesh, equations.basis(orbit.degree).nodes)
        self.base = Base(orbit, equations.assemble(orbit, gradients), tangent)

    def _over_limits(self, orbit: Orbit, size: float) -> Outcome | None:
        settings = self.settings
        if self.limits:
            amplitude = orbit.half_peak_to_peak()
            for index, limit in self.limits:
                if amplitude[index] > limit:
                    name = self.equations.system.state_names[index]
                    return Outcome(Ending.AMPLITUDE_LIMIT, f"{name} {amplitude[index]:.4g}")
        if size < 0.3 * self.size and size < 0.7 * settings.first_amplitude:
            return Outcome(Ending.EQUILIBRIUM, f"near {orbit.speed:.4f} m/s")
        if self._is_back(orbit):
            return Outcome(Ending.CLOSED)
        return None

    def _is_back(self, orbit: Orbit) -> bool:
        """Whether the branch, after it went away, is next to its start and goes the same way."""
        first, unit = self.first.orbit, self.equations.speed_unit
        here = orbit.half_peak_to_peak() / self.equations.scales
        there = first.half_peak_to_peak() / self.equations.scales
        change = float(np.linalg.norm(here - there) / np.linalg.norm(there))
        distance = abs(orbit.speed - first.speed) / unit
        self.away = self.away or change > 0.1 or distance > 0.1
        passed = (orbit.speed - first.speed) * self.first.tangent.speed > 0.0
        same_way = self.base.tangent.speed * self.first.tangent.speed > 0.0
        near = change < 0.03 and distance < 2.0 / self.settings.speed_steps
        return self.away and passed and same_way and near

    def _end_passed(self, speed: float) -> float | None:
        """The end of the speed range that lies between the base and `speed`, if there is one."""
        if speed > self.high and speed > self.base.orbit.speed:
            return self.high
        if speed < self.low and speed < self.base.orbit.speed:
            return self.low
        return None

    def _left(self, end: float) -> Outcome:
        side = Ending.LOWER_END if end == self.low else Ending.UPPER_END
        return Outcome(side, f"{end:g} m/s")


def _failure(error: OrbitError) -> Outcome:
    return Outcome(Ending.CONTACT_LOST if error.contact_lost else Ending.ORBIT_LOST, str(error))
