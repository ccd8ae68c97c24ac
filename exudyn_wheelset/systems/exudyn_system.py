"""An assembled Exudyn system as x' = f(x; speed), with the cyclic coordinates removed.

The right-hand side is that of Exudyn's own solver: system coordinates are set, generalised forces
(loads and their user functions included) and mass matrix are computed, and the accelerations are
turned into rates of the reduced state (see `reduction`). Exudyn's ComputeLinearizedSystem and
ComputeODE2Eigenvalues are not used: they leave the derivatives of loads out and perturb a
spinning body in its spinning frame.

Rigid bodies with NodeType.RotationRotationVector have global translational velocities and angular
velocities in body components as generalised velocities. All other nodes keep their coordinates.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import refuse_options
from exudyn_wheelset.coupling.registration import wheelsets_of
from exudyn_wheelset.coupling.running import QuietExudyn, copied_settings, failure_words
from exudyn_wheelset.coupling.wheel_rail import WheelRailContact
from exudyn_wheelset.creep.slopes import CreepPatch
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.systems.axisymmetry import check_spin, inverse_mass
from exudyn_wheelset.systems.checks import check_arguments, check_states
from exudyn_wheelset.systems.constraints import JointedLayout, follow_joints, jointed_layout
from exudyn_wheelset.systems.described import described
from exudyn_wheelset.systems.exudyn_layout import Layout, lay_out
from exudyn_wheelset.systems.exudyn_running import Runner, sampled
from exudyn_wheelset.systems.exudyn_wheelsets import (
    check_speed_is_a_parameter,
    patches_of,
    rolling_radii,
)
from exudyn_wheelset.systems.reduction import expand_state, state_rate
from exudyn_wheelset.systems.system import FASTEST, DynamicSystem, SimulationError
from exudyn_wheelset.systems.trucks import trucks_by_distance

# Forward speed [m/s] while the model is taken over, before any analysis sets its own.
FIRST_SPEED = 10.0


@spelt_class
class ExudynSystem(DynamicSystem):
    """A complete Exudyn model as an autonomous system over the forward speed.

    The wheelsets of `create_wheelset` are found in the model (`wheelsets`, `contacts`): their
    speed, cyclic spin, steady spin and the lateral displacements to watch follow by themselves.

    mbs             the MainSystem; sensors of the nodes are added and it is assembled here, so
                    nothing may be added to it afterwards
    SC              its SystemContainer, which is kept alive
    set_speed       called as set_speed(mbs, speed) before the first evaluation at a speed [m/s],
                    and once here; if left out, the speed is that of all wheelsets
    spinning_nodes  further nodes of axisymmetric bodies that spin about their own y axis, whose
                    spin angle is cyclic; as a mapping node -> rolling radius [m] the steady spin
                    speed/radius is where the search for the equilibrium starts. A wheelset's node
                    may be named to give it another radius than that of its rigid contact
    cyclic          second-order coordinates (indices in the system) whose position has no
                    influence and is left out; their velocity stays a state. As a mapping
                    index -> velocity per forward speed it gives the steady velocity to start from
    scales          typical magnitude of each state; 1e-3 for positions and 1e-2 for velocities if
                    left out
    state_names     names with units in brackets; from the nodes if left out
    displacement_indices  states whose amplitude is reported; all positions if left out
    settings        exudyn.SimulationSettings for `simulate`; times and output are set here
    solver_type     solver of `simulate`: a member of exudyn.DynamicSolverType or its name; that of
                    the settings if they are given, else RK44
    step            largest time step of `simulate` [s]; that of the settings (endTime -
                    startTime)/numberOfSteps if they are given, else 5e-4

    Joints and constraints are taken in independent coordinates (constraints.py): the states are
    those that are left, motions are computed by generalised alpha unless said otherwise.

    Raises AnalysisError for nodes with Euler parameters, data coordinates (hidden states), nodes
    that cannot spin, wheelsets that run over the ground (their speed is no parameter of the model)
    and a model that has neither wheelsets nor `set_speed`.

    Examples
    --------
    >>> import exudyn as exu
    >>> from exudyn_wheelset import ExudynSystem, Track, Wheelset, create_wheelset
    >>> SC = exu.SystemContainer()
    >>> mbs = SC.AddSystem()
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    >>> items = create_wheelset(mbs, axle, Track("UIC60"), moving_frame=True, name="axle")
    >>> load = mbs.CreateForce(itemNumber=items.body, loadVector=[0, 0, -1e5])
    >>> frame = mbs.CreateGround()
    >>> for y in (1.0, -1.0):
    ...     spring = mbs.CreateCartesianSpringDamper(
    ...         itemNumbers=[frame, items.body], stiffness=[2e6, 1e6, 0],
    ...         localPosition0=[0, y, 0.46], localPosition1=[0, y, 0])
    ...
    >>> ExudynSystem(mbs, SC).state_names[:2]
    ('x [m]', 'y [m]')
    """

    def __init__(
        self,
        mbs: exu.MainSystem,
        SC: exu.SystemContainer | None = None,
        *,
        set_speed: Callable[[exu.MainSystem, float], None] | None = None,
        spinning_nodes: Sequence[int] | Mapping[int, float] = (),
        cyclic: Sequence[int] | Mapping[int, float] = (),
        name: str = "Exudyn system",
        scales: Sequence[float] | Array | None = None,
        state_names: Sequence[str] | None = None,
        displacement_indices: Sequence[int] | None = None,
        solver_type: exu.DynamicSolverType | str | None = None,
        step: float | None = None,
        settings: exu.SimulationSettings | None = None,
        parameters: Mapping[str, Any] | None = None,
        **others: Any,
    ) -> None:
        refuse_options(ExudynSystem.__init__, others)
        check_arguments(mbs, SC, name, settings)
        self.name = name
        # Exudyn's stub files miss `self` and accept lists only where arrays are taken too.
        self.mbs: Any = mbs
        self.parameters = dict(parameters or {})
        self._container = SC
        self.wheelsets = wheelsets_of(mbs)
        self._set_speed = set_speed or self._set_contact_speeds
        if set_speed is None:
            check_speed_is_a_parameter(name, self.wheelsets)
        self._speed: float | None = None
        self.runner = Runner(self.mbs, name, settings, solver_type, step)
        # Exudyn evaluates the loads when a solver begins, so that they need some speed by then.
        self._set_speed(mbs, FIRST_SPEED)
        mbs.Assemble()
        self._data: Any = mbs.systemData
        self._initialise_solver()
        spinning = _as_mapping(spinning_nodes)
        unknown = [items for items in self.wheelsets if items.node not in spinning]
        whole = lay_out(
            mbs,
            self.runner.nodes,
            {**rolling_radii(unknown), **spinning},
            _as_mapping(cyclic),
            name,
        )
        layout: Layout | JointedLayout = whole
        if self._solver.GetAEsize():
            wheelset_nodes = [items.node for items in self.wheelsets]
            layout = jointed_layout(name, mbs, self._solver, whole, wheelset_nodes)
            follow_joints(self.runner, name, settings is None and solver_type is None)
        self.layout: Any = layout
        self._positions = layout.positions
        self._position_of = whole.position_of
        self._rotations = whole.rotations
        self._reference = whole.reference
        self._steady_velocities = layout.steady_velocities
        self.wheelset_names = tuple(layout.wheelsets)
        self.stiff = bool(self.wheelsets)
        if self.wheelsets:
            self.speeds = (-FASTEST, FASTEST)
        self.trucks = trucks_by_distance(layout.wheelsets)
        self._coordinates = np.zeros(self._order2)
        self._velocities = np.zeros(self._order2)
        self._first_order = np.zeros(self._order1)

        names = layout.names if state_names is None else state_names
        if scales is None:
            scales = layout.scales
        if displacement_indices is None:
            displacement_indices = range(self._positions)
        self.displacement_indices = tuple(displacement_indices)
        self.scales = check_states(name, layout.names, names, scales, self.displacement_indices)
        self.state_names = tuple(names)
        places = [
            layout.wheelset_states([int(k) for k in self._data.GetNodeLTGODE2(items.node)])
            for items in self.wheelsets
        ]
        known = [place for place in places if place[0] >= 0 and place[2] >= 0]
        self.lateral_indices = tuple(place[0] for place in known)
        self.yaw_indices = tuple(place[2] for place in known)
        # Lateral and vertical displacement and roll of each wheelset.
        self.pose_indices = tuple((place[0], place[1], place[3]) for place in places)
        self._inverse_mass, self._constant_mass = inverse_mass(
            name, whole, np.array(whole.scales), whole.names, self._mass_matrix
        )
        check_spin(name, whole, np.array(whole.scales), whole.names, self._force)

    @property
    def contacts(self) -> tuple[WheelRailContact, ...]:
        """Contacts of the wheelsets, in the order of their creation."""
        return tuple(items.contact for items in self.wheelsets)

    @property
    def step(self) -> float:
        """Largest time step of `simulate` [s]."""
        return self.runner.step

    def derivative(self, state: Array, speed: float) -> Array:
        """Rate of change of a state (n,) at a forward speed [m/s]; shape (n,).

        Raises AnalysisError with the words of a user function that gave up.
        """
        self.use_speed(speed)
        state = np.ascontiguousarray(state, dtype=float)
        if isinstance(self.layout, JointedLayout):
            return self._jointed_rate(self.layout, state)
        expand_state(
            state,
            self._position_of,
            self._rotations,
            self._reference,
            self._coordinates,
            self._velocities,
            self._first_order,
        )
        force = self._right_hand_side(self._coordinates, self._velocities, self._first_order)
        rate = np.empty(self.scales.shape[0])
        state_rate(state, force, self._inverse_mass, self._position_of, self._rotations, rate)
        return rate

    def _jointed_rate(self, layout: JointedLayout, state: Array) -> Array:
        whole, jacobian = layout.complete(state)
        coordinates, velocities, first_order = layout.whole.expand(whole)
        bent = layout.joints.bend(coordinates, velocities)
        rates = np.array(self._right_hand_side(coordinates, velocities, first_order))
        rates = rates[: self._order2 + self._order1]
        rates[: self._order2] = layout.joints.accelerations(
            jacobian, bent, rates[: self._order2], self._inverse_mass
        )
        return layout.rate(whole, rates)

    def _right_hand_side(self, coordinates: Array, velocities: Array, first_order: Array) -> Array:
        """Generalised forces and rates (nq + n1), with the inverse of the mass matrix there."""
        data, solver, mbs = self._data, self._solver, self.mbs
        data.SetODE2Coordinates(coordinates)
        data.SetODE2Coordinates_t(velocities)
        try:
            if self._order1:
                data.SetODE1Coordinates(first_order)
            solver.ComputeODE2RHS(mbs)
            if self._order1:
                solver.ComputeODE1RHS(mbs)
            force = solver.GetSystemResidual()
            if not self._constant_mass:
                solver.ComputeMassMatrix(mbs)
                self._inverse_mass = np.linalg.inv(solver.GetSystemMassMatrix())
        except Exception as error:
            raise AnalysisError(f"{self.name}: {failure_words(error)}") from error
        return np.asarray(force)

    def creep_patches(self, state: Array, speed: float) -> tuple[CreepPatch, ...]:
        """Contact patches with their creep laws at a state, by wheelset and wheel."""
        ExudynSystem.derivative(self, state, speed)
        return tuple(patch for items in self.wheelsets for patch in patches_of(self.mbs, items))

    def expand(self, state: Array) -> tuple[Array, Array]:
        """Second-order coordinates and their velocities (nq,), (nq,) of a state.

        Cyclic coordinates and spin angles come out as zero. Coordinates are measured from the
        reference configuration, as Exudyn's are.
        """
        coordinates, velocities, _ = self.layout.expand(state)
        return coordinates, velocities

    def reduce(
        self, coordinates: Array, velocities: Array, first_order: Array | None = None
    ) -> Array:
        """State (n,) of Exudyn's coordinates and velocities (nq,), (nq,)."""
        if first_order is None:
            first_order = np.zeros(self._order1)
        rows = (np.atleast_2d(values) for values in (coordinates, velocities, first_order))
        return np.asarray(self.layout.reduce(*rows)[0])

    def initial_state(self, speed: float) -> Array:
        """State of the model's initial values, with the steady spin and forward velocities."""
        self.use_speed(speed)
        initial = exu.ConfigurationType.Initial
        state = self.reduce(
            self._data.GetODE2Coordinates(initial),
            self._data.GetODE2Coordinates_t(initial),
            self._data.GetODE1Coordinates(initial),
        )
        for index, ratio in self._steady_velocities:
            state[self._positions + index] = ratio * speed
        return state

    def equilibrium(self, speed: float, guess: Array | None = None) -> Array:
        """Steady state (n,) at a forward speed [m/s]; the guess defaults to `initial_state`."""
        return super().equilibrium(speed, self.initial_state(speed) if guess is None else guess)

    def carry_over(self, state: Array, speed: float, new_speed: float) -> Array:
        """The state with the steady spin and forward velocities moved on to `new_speed`."""
        state = np.array(state, dtype=float)
        for index, ratio in self._steady_velocities:
            state[self._positions + index] += ratio * (new_speed - speed)
        return state

    def simulate(self, state: Array, speed: float, times: Array) -> Array:
        """Motion from `state` (n,) at times[0] by Exudyn's own solver, at `times` (m,) [s].

        Times at equal distances are met exactly by a whole number of steps, others are
        interpolated by splines. Returns (m, n). Raises SimulationError, which keeps the samples
        before, if the solver or a user function gives up or the motion is no longer finite.
        """
        times = np.asarray(times, dtype=float)
        if times.ndim != 1 or len(times) < 2 or np.any(np.diff(times) <= 0.0):
            raise AnalysisError(f"{self.name}: times must be at least two and rising")
        self.use_speed(speed)
        interval = (times[-1] - times[0]) / (len(times) - 1)
        uniform = bool(np.allclose(np.diff(times), interval, rtol=1e-9))
        if uniform:
            per_sample = max(1, int(np.ceil(interval / self.runner.step - 1e-9)))
            steps = per_sample * (len(times) - 1)
        else:
            steps = int(np.ceil((times[-1] - times[0]) / self.runner.step))
        duration = float(times[-1] - times[0])
        outcome = self.runner.run(self.layout.expand(state), steps, duration)
        stored, raw = self.runner.recorded()
        samples = sampled(stored, self.layout.reduce(*raw), times - times[0])
        finite = len(samples)
        if outcome.ending is Ending.INTERRUPTED:
            raise KeyboardInterrupt(str(outcome))
        if outcome.ending is Ending.FINISHED and finite < len(times):
            outcome = Outcome(Ending.NOT_FINITE)
        if outcome.ending is not Ending.FINISHED:
            raise SimulationError(
                f"{self.name}: the motion at {speed:g} m/s ended after "
                f"{times[max(finite - 1, 0)]:.6g} s: {outcome}",
                times[:finite],
                samples,
                outcome,
            )
        return samples

    def __reduce__(self) -> tuple[Any, ...]:
        # Exudyn's model cannot be pickled: a stored result keeps its names.
        return described(self).__reduce__()

    def measures(self) -> dict[str, Any]:
        record = super().measures()
        return {
            **record,
            "parameters": self.parameters,
            "solver": str(self.runner.solver_type).split(".")[-1],
            "step": self.runner.step,
        }

    def _initialise_solver(self) -> None:
        settings = copied_settings(self.runner.settings)
        settings.solution.sensors.active = False
        solver: Any = exu.MainSolverImplicitSecondOrder()
        try:
            with QuietExudyn():
                solver.InitializeSolver(self.mbs, settings)
        except Exception as error:
            raise AnalysisError(
                f"{self.name}: the model cannot be evaluated in its initial configuration at "
                f"{FIRST_SPEED:g} m/s: {failure_words(error)}"
            ) from error
        self._solver = solver
        self._order2 = solver.GetODE2size()
        self._order1 = solver.GetODE1size()

    def _set_contact_speeds(self, mbs: Any, speed: float) -> None:
        for contact in self.contacts:
            contact.set_speed(speed)

    def _mass_matrix(self, coordinates: Array) -> Array:
        self._data.SetODE2Coordinates(coordinates)
        self._solver.ComputeMassMatrix(self.mbs)
        return np.array(self._solver.GetSystemMassMatrix())

    def _force(self, coordinates: Array, velocities: Array, first_order: Array) -> Array:
        """Generalised forces (nq,) at coordinates and velocities (nq,), (nq,) and states (n1,)."""
        self._data.SetODE2Coordinates(coordinates)
        self._data.SetODE2Coordinates_t(velocities)
        if self._order1:
            self._data.SetODE1Coordinates(first_order)
        self._solver.ComputeODE2RHS(self.mbs)
        return np.array(self._solver.GetSystemResidual())[: self._order2]

    def use_speed(self, speed: float) -> None:
        """Set the forward speed [m/s] in the model."""
        if speed != self._speed:
            self._set_speed(self.mbs, float(speed))
            self._speed = speed


def _as_mapping(entries: Sequence[int] | Mapping[int, float]) -> Mapping[int, float]:
    """Entries with a number each, 0 where none is given."""
    if isinstance(entries, Mapping):
        return {int(key): float(value) for key, value in entries.items()}
    return {int(key): 0.0 for key in entries}
