"""The bogie of Cooperrider with the parameters of Kaas-Petersen, the classic of nonlinear hunting.

Two conical wheelsets and a frame run under a car body that moves straight ahead; seven
coordinates, all about the track frame (x forward, y left, z up, yaw positive to the left):

    q1, q2   lateral displacement [m] and yaw [rad] of the leading wheelset
    q3, q4   the same of the trailing wheelset
    q5..q7   lateral displacement [m], yaw [rad] and roll [rad] of the frame

The springs and dampers are linear, the creep forces saturate (cubic of Vermeulen and Johnson), and
beyond a dead band the flange meets a linear spring without damping; the force there has a corner,
which is kept.

    m_w q1'' + A1 + 2 F_y1 + F_T(q1) = 0        I_w q2'' + A2 + 2 a F_x1 = 0   (3, 4 alike)
    m_f q5'' - A1 - A3 + A5 = 0                 I_f q6'' - b (A1 - A3) - A2 - A4 + A6 = 0
    I_fr q7'' - h1 (A1 + A3) - h2 A5 + A7 = 0

    A1 = 2 k1 (q1 - q5 - b q6 - h1 q7)          A3 = 2 k1 (q3 - q5 + b q6 - h1 q7)
    A2 = 2 k2 d1^2 (q2 - q6)                    A4 = 2 k2 d1^2 (q4 - q6)
    A5 = 2 D2 (q5' - h2 q7') + 2 k4 (q5 - h2 q7)               A6 = k6 q6
    A7 = 2 D1 d2^2 q7' + 2 k5 d2^2 q7 + 4 k3 d1^2 q7

Creep, at speed V: xi_x = lambda q1/r0 + a q2'/V, xi_y = q1'/V - q2. Forces are those on the wheel
with the sign turned (they stand on the left-hand side).

Source: C. Kaas-Petersen, Chaos in a railway bogie, Acta Mechanica 61 (1986) 89-107. SI units.
Published linear critical speed: 68.64 m/s at 4.00 Hz.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property
from typing import Any, NamedTuple

import exudyn as exu
import numpy as np
from exudyn.utilities import NodeGenericODE2, ObjectGenericODE2

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import unknown
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.system import DIFFERENCE_STEP, FASTEST

STATE_NAMES = (
    "q1 leading wheelset y [m]",
    "q2 leading wheelset yaw [rad]",
    "q3 trailing wheelset y [m]",
    "q4 trailing wheelset yaw [rad]",
    "q5 frame y [m]",
    "q6 frame yaw [rad]",
    "q7 frame roll [rad]",
    "q1' leading wheelset [m/s]",
    "q2' leading wheelset [rad/s]",
    "q3' trailing wheelset [m/s]",
    "q4' trailing wheelset [rad/s]",
    "q5' frame [m/s]",
    "q6' frame [rad/s]",
    "q7' frame roll [rad/s]",
)
# A few millimetres and milliradians at about 4 Hz (25 rad/s).
SCALES = np.array([1e-3] * 7 + [2.5e-2] * 7)

# Kalker's coefficients of the source divide the creepages.
LONGITUDINAL_CREEP_FACTOR = 0.60252
LATERAL_CREEP_FACTOR = 0.54219
# Load [N] of a wheel with which the source's friction of 0.15 gives its 10 kN.
WHEEL_LOAD = 10.0e3 / 0.15


@dataclass(frozen=True)
class CooperriderBogie:
    """Parameters of the bogie; the defaults are those of Kaas-Petersen.

    Each stiffness, damping and creep parameter counts one side, as in the source. Raises
    WheelsetError for a parameter that is not a finite number of the right sign.
    """

    wheelset_mass: float = 1022.0  # m_w [kg]
    wheelset_yaw_inertia: float = 678.0  # I_w [kg m2]
    frame_mass: float = 2918.0  # m_f [kg]
    frame_yaw_inertia: float = 6780.0  # I_f [kg m2]
    frame_roll_inertia: float = 6780.0  # I_fr [kg m2]
    primary_lateral_stiffness: float = 1.823e6  # k1 [N/m]
    primary_longitudinal_stiffness: float = 3.646e6  # k2 [N/m]
    primary_vertical_stiffness: float = 3.646e6  # k3 [N/m]
    secondary_lateral_stiffness: float = 0.1823e6  # k4 [N/m]
    secondary_vertical_stiffness: float = 0.3333e6  # k5 [N/m]
    secondary_yaw_stiffness: float = 2.710e6  # k6 [N m/rad]
    secondary_vertical_damping: float = 20.0e3  # D1 [N s/m]
    secondary_lateral_damping: float = 29.2e3  # D2 [N s/m]
    contact_half_distance: float = 0.7163  # a [m]
    half_wheelbase: float = 1.074  # b [m]
    primary_height: float = 0.0762  # h1 [m], wheelset centres below the frame's centre
    secondary_height: float = 0.6584  # h2 [m], secondary springs above the frame's centre
    primary_half_distance: float = 0.620  # d1 [m]
    secondary_half_distance: float = 0.680  # d2 [m]
    conicity: float = 0.05  # lambda [1]
    wheel_radius: float = 0.4572  # r0 [m]
    flange_stiffness: float = 14.60e6  # k0 [N/m]
    flange_clearance: float = 9.1e-3  # dead band on either side [m]
    friction_force: float = 10.0e3  # mu N [N] a wheel
    creep_stiffness: float = 6.563e6  # G pi a_e b_e [N] a wheel

    def __post_init__(self) -> None:
        may_vanish = ("damping", "stiffness", "height", "conicity", "clearance")
        for field in fields(self):
            value = getattr(self, field.name)
            zero_allowed = any(word in field.name for word in may_vanish)
            zero_allowed = zero_allowed and field.name != "creep_stiffness"
            if not math.isfinite(value) or value < 0.0 or (value == 0.0 and not zero_allowed):
                bound = "zero or positive" if zero_allowed else "positive"
                raise WheelsetError(
                    f"CooperriderBogie: {field.name} = {value} must be a {bound} number in SI units"
                )

    def replace(self, name: str, value: float) -> CooperriderBogie:
        """The bogie with one number changed, by its name, or "friction" [-], the coefficient that
        with WHEEL_LOAD makes `friction_force`. Raises WheelsetError."""
        if name == "friction":
            name, value = "friction_force", value * WHEEL_LOAD
        known = [field.name for field in fields(self)]
        if name not in known:
            raise unknown("number of the bogie:", name, known)
        return replace(self, **{name: float(value)})

    def dynamic_system(self, **options: Any) -> ExudynSystem:
        """The bogie as a system for all analyses; options are those of ExudynSystem."""
        return cooperrider_system(self, **options)

    def mass_matrix(self) -> Array:
        """Mass matrix (7, 7), diagonal [kg, kg m2]."""
        wheelset = [self.wheelset_mass, self.wheelset_yaw_inertia]
        frame = [self.frame_mass, self.frame_yaw_inertia, self.frame_roll_inertia]
        return np.diag([*wheelset, *wheelset, *frame])

    def stiffness_matrix(self) -> Array:
        """Stiffness matrix (7, 7) of the suspension, without creep and flange [N/m, N m/rad].

        The sum of k g g^T over the springs, g the elongation by each coordinate.
        """
        b, h1, h2 = self.half_wheelbase, self.primary_height, self.secondary_height
        d1, d2 = self.primary_half_distance, self.secondary_half_distance
        springs: list[tuple[float, list[float]]] = [
            (2.0 * self.primary_lateral_stiffness, [1, 0, 0, 0, -1, -b, -h1]),
            (2.0 * self.primary_lateral_stiffness, [0, 0, 1, 0, -1, b, -h1]),
            (2.0 * self.primary_longitudinal_stiffness * d1**2, [0, 1, 0, 0, 0, -1, 0]),
            (2.0 * self.primary_longitudinal_stiffness * d1**2, [0, 0, 0, 1, 0, -1, 0]),
            (2.0 * self.secondary_lateral_stiffness, [0, 0, 0, 0, 1, 0, -h2]),
            (self.secondary_yaw_stiffness, [0, 0, 0, 0, 0, 1, 0]),
            (2.0 * self.secondary_vertical_stiffness * d2**2, [0, 0, 0, 0, 0, 0, 1]),
            (4.0 * self.primary_vertical_stiffness * d1**2, [0, 0, 0, 0, 0, 0, 1]),
        ]
        return _sum_of_springs(springs)

    def damping_matrix(self) -> Array:
        """Damping matrix (7, 7) of the suspension, without creep [N s/m, N m s/rad]."""
        h2, d2 = self.secondary_height, self.secondary_half_distance
        dampers: list[tuple[float, list[float]]] = [
            (2.0 * self.secondary_lateral_damping, [0, 0, 0, 0, 1, 0, -h2]),
            (2.0 * self.secondary_vertical_damping * d2**2, [0, 0, 0, 0, 0, 0, 1]),
        ]
        return _sum_of_springs(dampers)

    def derivatives(self, states: Array, speed: float) -> Array:
        """Rates (m, 14) of states (m, 14) at a speed [m/s], without Exudyn."""
        states = np.ascontiguousarray(states, dtype=float)
        rates = np.empty_like(states)
        bogie_rates(states, float(speed), *self._equations, rates)
        return rates

    @cached_property
    def _equations(self) -> tuple[Array, Array, Array]:
        """M^-1 (7,), -M^-1 (K, D) (7, 14) and the parameters of the contact."""
        inverse = 1.0 / np.diagonal(self.mass_matrix())
        linear = np.hstack([self.stiffness_matrix(), self.damping_matrix()])
        return inverse, -inverse[:, None] * linear, self.contact_parameters()

    def contact_parameters(self) -> Array:
        """Parameters (6,) of `contact_forces`: lambda/r0, a, mu N, G pi a_e b_e, k0, clearance."""
        return np.array(
            [
                self.conicity / self.wheel_radius,
                self.contact_half_distance,
                self.friction_force,
                self.creep_stiffness,
                self.flange_stiffness,
                self.flange_clearance,
            ]
        )


def _sum_of_springs(springs: list[tuple[float, list[float]]]) -> Array:
    matrix = np.zeros((7, 7))
    for stiffness, elongation in springs:
        direction = np.array(elongation, dtype=float)
        matrix += stiffness * np.outer(direction, direction)
    return matrix


@compiled
def contact_forces(
    coordinates: Array, velocities: Array, speed: float, parameters: Array, forces: Array
) -> None:
    """Generalised forces (7,) of creep and flanges on the bogie, written in place [N, N m].

    coordinates, velocities (7,) as in the module's header; speed V [m/s]; parameters from
    `CooperriderBogie.contact_parameters`.
    """
    rolling, arm, friction_force, creep_stiffness, flange, clearance = parameters
    forces[:] = 0.0
    for first in (0, 2):
        lateral, yaw = coordinates[first], coordinates[first + 1]
        creep_x = (
            rolling * lateral + arm * velocities[first + 1] / speed
        ) / LONGITUDINAL_CREEP_FACTOR
        creep_y = (velocities[first] / speed - yaw) / LATERAL_CREEP_FACTOR
        creep = math.hypot(creep_x, creep_y)
        saturation = creep_stiffness * creep / friction_force
        if saturation < 3.0:
            # Force over creep, finite at zero creep.
            ratio = creep_stiffness * (1.0 - saturation / 3.0 + saturation * saturation / 27.0)
        else:
            ratio = friction_force / creep
        forces[first] = -2.0 * ratio * creep_y
        forces[first + 1] = -2.0 * arm * ratio * creep_x
        if lateral > clearance:
            forces[first] -= flange * (lateral - clearance)
        elif lateral < -clearance:
            forces[first] -= flange * (lateral + clearance)


@compiled
def bogie_rates(
    states: Array, speed: float, inverse: Array, linear: Array, parameters: Array, rates: Array
) -> None:
    """Rates (m, 14) of states (m, 14), in place; inverse masses (7,), linear (7, 14) the
    accelerations by states without creep and flanges, parameters those of `contact_forces`."""
    forces = np.empty(7)
    for row in range(states.shape[0]):
        state, rate = states[row], rates[row]
        contact_forces(state[:7], state[7:], speed, parameters, forces)
        for i in range(7):
            rate[i] = state[7 + i]
            total = inverse[i] * forces[i]
            for j in range(14):
                total += linear[i, j] * state[j]
            rate[7 + i] = total


@compiled
def bogie_jacobians(
    states: Array,
    speed: float,
    inverse: Array,
    linear: Array,
    parameters: Array,
    steps: Array,
    matrices: Array,
) -> None:
    """Jacobians (m, 14, 14) of `bogie_rates`, in place; those of the contact by central
    differences with `steps` (14,)."""
    upper, lower = np.empty(7), np.empty(7)
    for row in range(states.shape[0]):
        state, matrix = states[row].copy(), matrices[row]
        matrix[:] = 0.0
        for i in range(7):
            matrix[i, 7 + i] = 1.0
            matrix[7 + i] = linear[i]
        for j in (0, 1, 2, 3, 7, 8, 9, 10):
            kept = state[j]
            state[j] = kept + steps[j]
            contact_forces(state[:7], state[7:], speed, parameters, upper)
            state[j] = kept - steps[j]
            contact_forces(state[:7], state[7:], speed, parameters, lower)
            state[j] = kept
            for i in range(4):
                matrix[7 + i, j] += inverse[i] * (upper[i] - lower[i]) / (2.0 * steps[j])


class BogieItems(NamedTuple):
    """Item numbers of a Cooperrider bogie in an Exudyn system."""

    node: int
    suspension: int


def create_cooperrider_bogie(
    mbs: exu.MainSystem,
    bogie: CooperriderBogie | None = None,
    *,
    speed: float | None = None,
    initial_coordinates: Sequence[float] | Array | None = None,
    name: str = "",
) -> BogieItems:
    """Add the bogie to an Exudyn system and return its item numbers.

    The seven coordinates are one generic node; the suspension is an ObjectGenericODE2 whose user
    function adds creep and flange forces at the forward speed `mbs.variables["speed"]` [m/s],
    which is read at every evaluation and set here if `speed` is given. Several bogies may be
    added; a `name`, if given, must be a new one in the system.
    """
    bogie = bogie or CooperriderBogie()
    parameters, forces = bogie.contact_parameters(), np.zeros(7)
    variables = mbs.variables
    if speed is not None:
        variables["speed"] = float(speed)

    def contact(mbs: Any, t: float, item: int, q: Any, q_t: Any) -> Array:
        contact_forces(np.asarray(q), np.asarray(q_t), variables["speed"], parameters, forces)
        return forces

    node = mbs.AddNode(
        NodeGenericODE2(
            referenceCoordinates=[0.0] * 7,
            initialCoordinates=list(
                np.zeros(7) if initial_coordinates is None else initial_coordinates
            ),
            initialCoordinates_t=[0.0] * 7,
            numberOfODE2Coordinates=7,
            name=name,
        )
    )
    force: Any = contact
    suspension = mbs.AddObject(
        ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=bogie.mass_matrix(),
            stiffnessMatrix=bogie.stiffness_matrix(),
            dampingMatrix=bogie.damping_matrix(),
            forceUserFunction=force,
            name=f"{name}: suspension, creep and flanges" if name else "",
        )
    )
    return BogieItems(node=int(node), suspension=int(suspension))


class CooperriderSystem(ExudynSystem):
    """The bogie alone in an Exudyn system; rates and Jacobians come from the compiled equations,
    which are Exudyn's to rounding, motions from Exudyn's solver."""

    bogie: CooperriderBogie
    speeds = (0.0, FASTEST)

    def derivative(self, state: Array, speed: float) -> Array:
        return self.derivatives(np.asarray(state)[None], speed)[0]

    def derivatives(self, states: Array, speed: float) -> Array:
        return self.bogie.derivatives(states, speed)

    def jacobian(self, state: Array, speed: float) -> Array:
        return self.jacobians(np.asarray(state)[None], speed)[0]

    def jacobians(self, states: Array, speed: float) -> Array:
        states = np.ascontiguousarray(states, dtype=float)
        matrices = np.empty((*states.shape, 14))
        step = DIFFERENCE_STEP * SCALES
        bogie_jacobians(states, float(speed), *self.bogie._equations, step, matrices)
        return matrices


def cooperrider_system(bogie: CooperriderBogie | None = None, **options: Any) -> CooperriderSystem:
    """The bogie alone in an Exudyn system, ready for the analyses; `options` go to ExudynSystem."""
    bogie = bogie or CooperriderBogie()
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    create_cooperrider_bogie(mbs, bogie, speed=1.0)

    def set_speed(mbs: exu.MainSystem, speed: float) -> None:
        mbs.variables["speed"] = speed

    defaults: dict[str, Any] = {
        "name": "Cooperrider bogie",
        "state_names": STATE_NAMES,
        "scales": SCALES,
        "parameters": asdict(bogie),
    }
    system = CooperriderSystem(mbs, container, set_speed=set_speed, **{**defaults, **options})
    system.bogie = bogie
    return system
