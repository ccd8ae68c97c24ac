"""The one interface that every stability analysis works on: x' = f(x; speed).

The system is autonomous and of first order. Cyclic coordinates (the forward position, the spin
angle of a wheelset) are already removed, so that a steady run is an equilibrium and hunting is a
periodic orbit. A vehicle in Exudyn, a reduced lateral model and a textbook equation look the same
from here: linearisation, continuation, descent and disturbance runs are written once.

States are in SI units and radians. `speed` is the forward speed in m/s; for a system that has no
forward speed it is any bifurcation parameter.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import MappingProxyType
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.creep.slopes import CreepPatch
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.results.versions import versions
from exudyn_wheelset.systems.source import Source
from exudyn_wheelset.vehicles.description import Vehicle

# Relative step of central differences: the cube root of the rounding unit balances the cut-off
# error O(h^2) against the rounding error O(1/h).
DIFFERENCE_STEP = 6.0e-6
# A motion that leaves this many scales has run away; integrators then only shorten their steps.
RUNAWAY = 1.0e9


class SimulationError(AnalysisError):
    """A simulation that ended early.

    times (m,) and states (m, n) hold what was computed before; outcome says how it ended.
    """

    def __init__(self, message: str, times: Array, states: Array, outcome: Outcome) -> None:
        super().__init__(message)
        self.times = times
        self.states = states
        self.outcome = outcome

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.times, self.states, self.outcome)


# Above any rail vehicle [m/s]: a speed beyond it is one in another unit.
FASTEST = 500.0


class DynamicSystem(ABC):
    """An autonomous system x' = f(x; speed) of n first-order equations.

    A subclass sets the four attributes and writes `derivative`; everything else has a default
    that may be overridden by a faster method.

    name                  what the system is, for records and plots
    state_names           (n) "y [m]", "yaw [rad]", ..., then the velocities; units in brackets
    scales                (n) typical magnitude of each state, for norms and difference steps
    displacement_indices  entries whose amplitude (half of peak to peak) is reported
    lateral_indices, yaw_indices  lateral displacement and yaw of each wheelset, in their order,
                          where the system knows its wheelsets
    lateral_limit         [m] beyond which a wheelset has left its track (`simulate` ends there)
    speeds                [m/s] between which the equations hold, 0 left out; infinite ones: any
    stiff                 whether it has oscillations far faster than its motion: elastic contact
    wheelset_names        labels of the wheelsets in the state names ("leading" of "leading: y
                          [m]"); empty where every body with y and yaw may be one
    trucks                labels of the wheelsets of each truck, by its name; empty for one truck
    source                the description that `as_system` made it from

    Examples
    --------
    >>> from exudyn_wheelset import DynamicSystem
    >>> from exudyn_wheelset.catalogue import vehicle_system
    >>> bogie = vehicle_system("cooperrider")
    >>> isinstance(bogie, DynamicSystem), bogie.size
    (True, 14)
    """

    name: str
    state_names: tuple[str, ...]
    scales: Array
    displacement_indices: tuple[int, ...]
    lateral_indices: tuple[int, ...] = ()
    yaw_indices: tuple[int, ...] = ()
    lateral_limit: float = math.inf
    speeds: tuple[float, float] = (-math.inf, math.inf)
    stiff: bool = False
    wheelset_names: tuple[str, ...] = ()
    trucks: Mapping[str, tuple[str, ...]] = MappingProxyType({})
    source: Source | None = None

    @property
    def size(self) -> int:
        """Number of states n."""
        return len(self.state_names)

    @property
    def step(self) -> float:
        """Largest time step of `simulate` [s]; 0 where it chooses its steps itself."""
        return 0.0

    @abstractmethod
    def derivative(self, state: Array, speed: float) -> Array:
        """Rate of change of a state (n,) at a forward speed [m/s]; shape (n,)."""

    def jacobian(self, state: Array, speed: float) -> Array:
        """Jacobian df_i/dx_j (n, n) at a state, by central differences over `scales`."""
        state = np.asarray(state, dtype=float)
        size = len(state)
        matrix = np.empty((size, size))
        shifted = state.copy()
        for column in range(size):
            step = DIFFERENCE_STEP * float(self.scales[column])
            shifted[column] = state[column] + step
            upper = np.array(self.derivative(shifted, speed))
            shifted[column] = state[column] - step
            matrix[:, column] = (upper - self.derivative(shifted, speed)) / (2.0 * step)
            shifted[column] = state[column]
        return matrix

    def derivatives(self, states: Array, speed: float) -> Array:
        """Rates of change (m, n) of m states (m, n)."""
        result = np.empty(np.shape(states))
        for row, state in enumerate(states):
            result[row] = self.derivative(state, speed)
        return result

    def jacobians(self, states: Array, speed: float) -> Array:
        """Jacobians (m, n, n) at m states (m, n)."""
        rows, size = np.shape(states)
        result = np.empty((rows, size, size))
        for row, state in enumerate(states):
            result[row] = self.jacobian(state, speed)
        return result

    def rough(self) -> DynamicSystem:
        """The same equations whose motion is only as accurate as settling amplitudes need.

        Itself, unless it has a cheaper way of simulating.
        """
        return self

    def speed_derivative(self, state: Array, speed: float) -> Array:
        """Derivative df/dspeed (n,) at a state, by central differences."""
        step = DIFFERENCE_STEP * max(1.0, abs(speed))
        upper = np.array(self.derivative(state, speed + step))
        return np.asarray((upper - self.derivative(state, speed - step)) / (2.0 * step))

    def equilibrium(self, speed: float, guess: Array | None = None) -> Array:
        """Steady state (n,) at a forward speed [m/s], f(x; speed) = 0, near `guess` (default 0).

        Damped Newton; a singular Jacobian (a state that the equations leave free) is met by the
        least-norm step, so such a state stays where the guess puts it. Raises AnalysisError with
        the reason if no steady state is found.
        """
        return newton_equilibrium(self, speed, guess)

    def carry_over(self, state: Array, speed: float, new_speed: float) -> Array:
        """Guess (n,) of a state at `new_speed` from a like state at `speed` [m/s].

        The default is the state itself. A system whose steady velocities (the spin of a wheelset)
        follow the speed shifts them: without that a wheelset would begin with gross sliding.
        """
        return state

    def held(self, states: Array, speed: float) -> Array:
        """The last of the states (m, n) of a motion, its mean speed over them made `speed` [m/s].

        What runs free along the track loses speed to creep as it hunts, a car some 1e-3 m/s in a
        second. The default, for systems without forward motion, is the last state itself.
        """
        return np.array(states[-1], dtype=float)

    @contextmanager
    def coarser(self, factor: float) -> Iterator[bool]:
        """Within it the time step of `simulate` is `factor` times as long.

        Gives whether it is: where the system chooses its steps itself nothing changes.
        """
        yield False

    def simulate(self, state: Array, speed: float, times: Array) -> Array:
        """Motion from `state` (n,) at times[0], sampled at `times` (m,) [s]; shape (m, n).

        Raises SimulationError, which keeps the samples computed so far, if it ends early.
        """
        times = np.asarray(times, dtype=float)
        lateral = list(self.lateral_indices)

        def in_range(_: float, x: Array) -> float:
            return RUNAWAY - float(np.max(np.abs(x) / self.scales))

        def on_track(_: float, x: Array) -> float:
            return self.lateral_limit - float(np.max(np.abs(x[lateral])))

        in_range.terminal = on_track.terminal = True  # type: ignore[attr-defined]
        watched = lateral and math.isfinite(self.lateral_limit)
        solution = solve_ivp(
            lambda _, x: self.derivative(x, speed),
            (times[0], times[-1]),
            np.asarray(state, dtype=float),
            method="LSODA",
            t_eval=times,
            events=[in_range, on_track] if watched else [in_range],
            rtol=1e-8,
            atol=1e-9 * np.asarray(self.scales),
        )
        states = solution.y.T
        finite = int(np.argmin([*np.all(np.isfinite(states), axis=1), False]))
        if finite < len(times):
            outcome = Outcome(Ending.NO_CONVERGENCE, solution.message)
            if solution.status == 1:
                outcome = Outcome(Ending.RAN_AWAY)
                if len(solution.t_events) > 1 and len(solution.t_events[1]):
                    limit = f"|y| = {1e3 * self.lateral_limit:.1f} mm"
                    outcome = Outcome(
                        Ending.LOST_GAUGE, f"{limit} at {solution.t_events[1][0]:.3f} s"
                    )
            raise SimulationError(
                f"{self.name}: the motion at {speed:g} m/s ended at sample {finite} of "
                f"{len(times)}: {outcome}",
                times[:finite],
                states[:finite],
                outcome,
            )
        return np.asarray(states)

    def creep_patches(self, state: Array, speed: float) -> tuple[CreepPatch, ...]:
        """Loaded contact patches with their creep laws at a state; empty for equations without."""
        return ()

    def measures(self) -> dict[str, Any]:
        """Settings, parameters and versions, for the record kept with every result."""
        return {
            "system": self.name,
            "state_names": list(self.state_names),
            "scales": [float(value) for value in self.scales],
            "versions": versions(),
        }

    def norm(self, state: Array) -> float:
        """Root mean square of a state measured in `scales`."""
        return float(np.sqrt(np.mean((np.asarray(state) / self.scales) ** 2)))


def newton_equilibrium(
    system: DynamicSystem,
    speed: float,
    guess: Array | None = None,
    tolerance: float = 1e-9,
    steps: int = 50,
) -> Array:
    """Steady state (n,) by damped Newton from `guess`, to `tolerance` in units of the scales.

    Converged when a full Newton step is below the tolerance. Raises AnalysisError.
    """
    scales = np.asarray(system.scales, dtype=float)
    state = np.zeros(system.size) if guess is None else np.array(guess, dtype=float)
    rate = np.array(system.derivative(state, speed))
    if not np.all(np.isfinite(rate)):
        raise AnalysisError(
            f"{system.name}: the equations give no finite value at the guess for the equilibrium "
            f"at {speed:g} m/s; start from a state within the range of the model"
        )
    for _ in range(steps):
        # Rows and columns are measured in the scales, so that the rank decision of the least
        # squares is one of physics and not of units.
        matrix = system.jacobian(state, speed) * scales[None, :] / scales[:, None]
        step = -np.linalg.lstsq(matrix, rate / scales, rcond=1e-11)[0]
        length = float(np.sqrt(np.mean(step**2)))
        residual = float(np.linalg.norm(rate / scales))
        if length < tolerance:
            return state
        factor = 1.0
        while factor > 1e-4:
            trial = state + factor * scales * step
            trial_rate = np.array(system.derivative(trial, speed))
            if np.linalg.norm(trial_rate / scales) < (1.0 - 0.25 * factor) * residual:
                break
            factor *= 0.5
        else:
            # Rounding is the floor of a stiff system: a step this small is an answer all the same.
            if length < 1e3 * tolerance:
                return state
            raise AnalysisError(
                f"{system.name}: no equilibrium at {speed:g} m/s: the residual stays at "
                f"{residual:.3g} (in units of the scales per second); give a nearer guess"
            )
        state, rate = trial, trial_rate
    raise AnalysisError(
        f"{system.name}: no equilibrium at {speed:g} m/s within {steps} Newton steps, the last "
        f"step was {length:.3g} of the scales; give a nearer guess"
    )


def as_system(vehicle: Any, **options: Any) -> DynamicSystem:
    """The DynamicSystem of a vehicle: itself, built from its description, or what the method
    `dynamic_system()` of an object gives. options: of ExudynSystem, for what is built here.

    Raises AnalysisError for anything else.
    """
    if isinstance(vehicle, DynamicSystem):
        return vehicle
    if isinstance(vehicle, Vehicle):
        # Exudyn is loaded only where a model is built in it.
        from exudyn_wheelset.systems.vehicle_system import vehicle_system

        made: DynamicSystem = vehicle_system(vehicle, **options)
        made.source = Source(vehicle)
        return made
    maker = getattr(vehicle, "dynamic_system", None)
    if callable(maker):
        system = maker(**options)
        if isinstance(system, DynamicSystem):
            system.source = Source(vehicle)
            return system
    raise AnalysisError(
        f"{type(vehicle).__name__} cannot be analysed: pass a DynamicSystem (FunctionSystem for "
        "equations, ExudynSystem for an Exudyn model) or an object whose method dynamic_system() "
        "returns one"
    )
