"""The paper's lateral model of a wheelset on springs to a frame, in its three codes.

- `mohan`: small angles, Vermeulen-Johnson creep, cone on knife-edge rails;
- `idealized`: large angles, Polach creep, cone on knife-edge rails;
- `profiled`: large angles, Polach creep, real wheel and rail profiles.

Springs k_x, k_y on either side at half distance b: lateral stiffness 2 k_y, yaw stiffness
2 k_x b^2. Source: the paper's section 2.5, Table 1 and section 3; docs/table2.md gives what the
paper leaves out and why it is set as it is.
"""

from __future__ import annotations

from copy import copy
from dataclasses import asdict
from functools import cached_property
from typing import Any

import numpy as np

from exudyn_wheelset.catalogue import lateral_kernel as kernel
from exudyn_wheelset.catalogue import lateral_motion as motion
from exudyn_wheelset.catalogue.lateral_parameters import LateralParameters
from exudyn_wheelset.checking import positive, unknown
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.contact.hertz import hertz_from_load
from exudyn_wheelset.contact.patch_curvature import patch_half_curvatures
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.coupling.guidance import guidance
from exudyn_wheelset.creep import creep_law, creep_parameters
from exudyn_wheelset.creep.slopes import CreepPatch
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.geometry.piecewise import REPRESENTATIONS, piecewise_geometry, with_short_cells
from exudyn_wheelset.geometry.rigid import contact_geometry
from exudyn_wheelset.profiles import Profile, load_profile, shapes
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.systems.system import FASTEST, DynamicSystem, SimulationError

CODES = ("mohan", "idealized", "profiled")


@spelt_class
class LateralWheelset(DynamicSystem):
    """The lateral model as a system of four states: y [m], yaw [rad] and their rates.

    code: "mohan", "idealized" or "profiled". wheel, rail: profiles, names or paths, used by
    `profiled` only, with gauge [m], gauge_depth [m], inclination and tape_half_distance [m].
    creep: a law's name or a function of one's own; None takes that of the code. gyroscopic,
    inertial: False leaves out the spin's gyroscopic terms, or m z'' and I_x phi'' in (3) and (4).
    representation: "cubic" or "polynomial" contact geometry (contact/piecewise.py).
    Raises WheelsetError for an unknown code, ContactError for profiles that do not meet.

    Examples
    --------
    >>> from exudyn_wheelset import LateralWheelset, linear_critical_speed
    >>> model = LateralWheelset("idealized")
    >>> round(linear_critical_speed(model, 10, 100).speed, 1)
    36.6
    """

    state_names = ("y [m]", "yaw [rad]", "y' [m/s]", "yaw' [rad/s]")
    displacement_indices = (0, 1)
    lateral_indices = (0,)
    yaw_indices = (1,)
    speeds = (0.0, FASTEST)

    def __init__(
        self,
        code: str = "profiled",
        parameters: LateralParameters | None = None,
        *,
        wheel: Profile | str = "AAR_1_20",
        rail: Profile | str = "UIC60",
        gauge: float = 1.432,
        gauge_depth: float = 0.014,
        inclination: float = 1.0 / 40.0,
        tape_half_distance: float = 0.75,
        creep: Any = None,
        gyroscopic: bool = True,
        inertial: bool | None = None,
        representation: str = "cubic",
        free_spin: bool = False,
        half_range: float = 0.012,
        **law_parameters: float,
    ) -> None:
        if code not in CODES:
            raise WheelsetError(f"code {code!r} is unknown: use one of {', '.join(CODES)}")
        if representation not in REPRESENTATIONS:
            raise unknown("representation", representation, REPRESENTATIONS)
        self.code = code
        self.parameters = parameters or LateralParameters()
        self.name = f"lateral wheelset, {code}"
        self.scales = np.array([1e-3, 1e-3, 2e-2, 2e-2])
        law = creep_law(creep or ("vermeulen-johnson" if code == "mohan" else "polach"))
        self.creep = law.name
        given = self.parameters
        if code == "profiled":
            wheel_profile, rail_profile = load_profile(wheel), load_profile(rail)
            self.track = Track(rail_profile, gauge, gauge_depth, inclination)
        else:
            wheel_profile, rail_profile = shapes.cone(given.conicity), shapes.knife_edge()
            tape_half_distance = given.contact_half_distance
            self.track = Track(
                rail_profile, inclination=0.0, datum_half_distance=given.contact_half_distance
            )
        self.wheelset = Wheelset(
            mass=given.mass,
            inertia=(given.roll_inertia, given.spin_inertia, given.yaw_inertia),
            radius=given.radius,
            wheel=wheel_profile,
            tape_half_distance=tape_half_distance,
        )
        self.lateral_limit = min(guidance(self.wheelset, self.track).shift)
        self.representation = representation
        self.half_range = positive("half_range", half_range, "m", 0.1)
        p = np.zeros(kernel.PARAMETER_COUNT)
        p[kernel.MASS] = given.mass
        p[kernel.ROLL_INERTIA] = given.roll_inertia
        p[kernel.SPIN_INERTIA] = given.spin_inertia
        p[kernel.YAW_INERTIA] = given.yaw_inertia
        p[kernel.NOMINAL_RADIUS] = self._rolling_radius() if free_spin else given.radius
        p[kernel.TAPE_HALF_DISTANCE] = tape_half_distance
        p[kernel.AXLE_LOAD] = given.axle_load
        p[kernel.LATERAL_STIFFNESS] = 2.0 * given.lateral_stiffness
        p[kernel.YAW_STIFFNESS] = 2.0 * given.longitudinal_stiffness * given.spring_half_distance**2
        p[kernel.LATERAL_DAMPING] = 2.0 * given.lateral_damping
        p[kernel.YAW_DAMPING] = 2.0 * given.longitudinal_damping * given.spring_half_distance**2
        p[kernel.FRICTION] = given.friction
        p[kernel.SHEAR_MODULUS] = given.shear_modulus
        p[kernel.POISSON] = given.poisson
        p[kernel.LAW] = law.number
        p[kernel.GYROSCOPIC] = float(gyroscopic)
        p[kernel.INERTIAL] = float(code != "mohan" if inertial is None else inertial)
        p[kernel.CONICITY] = given.conicity
        if code != "profiled":
            p[kernel.FIXED_LATERAL_CURVATURE] = 0.5 / given.rail_head_radius
        self._law, self._law_parameters = law, law_parameters
        self._p = p
        self._put_law_parameters()
        self._sides = np.zeros((2, 12))
        self._pair = motion.ACCURATE

    def _put_law_parameters(self) -> None:
        values = creep_parameters(self._law, **self._law_parameters)
        self._p[kernel.LAW_PARAMETERS : kernel.LAW_PARAMETERS + len(values)] = values

    def __setstate__(self, state: dict[str, Any]) -> None:
        # The address of a law of one's own holds in the process that made it only.
        self.__dict__.update(state)
        self._put_law_parameters()

    def _rolling_radius(self) -> float:
        """Radius [m] on which the centred wheelset rolls: its spin is V over this radius.

        Off the tape circle it differs from the nominal radius, and a spin of V/r0 would then
        drag both wheels along with a creepage that no free wheelset has.
        """
        if self.code == "mohan":
            return self.parameters.radius
        return float(contact_geometry(self.wheelset, self.track, [0.0]).left.radius[0])

    @cached_property
    def _geometry(self) -> tuple[np.ndarray, np.ndarray]:
        """Breaks and coefficients of the kernel's columns over y."""
        pieces = piecewise_geometry(
            self.wheelset,
            self.track,
            half_range=self.half_range,
            representation=self.representation,
        )
        curves = with_short_cells(pieces.curves, 1.0e-4)
        cells = len(curves.x) - 1
        table = np.zeros((curves.c.shape[0], cells, kernel.COLUMN_COUNT))
        table[:, :, 0:2] = curves.c[:, :, 0:2]
        width = np.diff(curves.x)
        at = curves(curves.x)
        half_curvatures = self._half_curvatures(curves.x, at[:, 0], at[:, 1])
        for hand, start in enumerate((2, 6)):
            base = 2 + kernel.SIDE_COLUMNS * hand
            wheel_y, radius = curves.c[:, :, start], curves.c[:, :, start + 3]
            table[:, :, base] = wheel_y
            table[:, :, base + 1] = radius
            # Within a cell of 0.1 mm slope and curvature are straight lines.
            ends = curves(np.stack([curves.x[:-1], curves.x[1:]]))
            slopes = -self.wheelset.wheel.slope(ends[:, :, start])
            table[-1, :, base + 2] = slopes[0]
            table[-2, :, base + 2] = (slopes[1] - slopes[0]) / width
            table[-1, :, base + 3] = half_curvatures[:-1, hand]
            table[-2, :, base + 3] = np.diff(half_curvatures[:, hand]) / width
        return np.ascontiguousarray(curves.x), np.ascontiguousarray(table)

    def _half_curvatures(self, y: np.ndarray, roll: np.ndarray, z: np.ndarray) -> np.ndarray:
        """B (n, 2) [1/m] averaged over a patch under the static load, left and right."""
        given = self.parameters
        approach = hertz_from_load(
            0.5 / given.radius,
            0.5 / given.rail_head_radius,
            0.5 * given.axle_load,
            given.shear_modulus,
            given.poisson,
        )[2]
        return patch_half_curvatures(
            contact_tables(self.wheelset, self.track), y, roll, z, approach
        )

    def derivative(self, state: np.ndarray, speed: float) -> np.ndarray:
        state = np.ascontiguousarray(state, dtype=float)
        self._sides[:, 0] = 0.0
        if self.code == "mohan":
            accelerations = kernel.small_angle_accelerations(state, speed, self._p, self._sides)
        else:
            breaks, coefficients = self._geometry
            accelerations = kernel.lateral_accelerations(
                state, speed, self._p, breaks, coefficients, self._sides
            )
        return np.array([state[2], state[3], *accelerations])

    @property
    def _tables(self) -> tuple[np.ndarray, np.ndarray]:
        """Breaks and coefficients of the geometry; empty ones for the code that has none."""
        return (np.zeros(2), np.zeros((1, 1, 1))) if self.code == "mohan" else self._geometry

    def derivatives(self, states: np.ndarray, speed: float) -> np.ndarray:
        states = np.ascontiguousarray(states, dtype=float)
        rates = np.empty_like(states)
        small = self.code == "mohan"
        motion.lateral_rates(states, float(speed), self._p, *self._tables, small, rates)
        return rates

    def simulate(self, state: np.ndarray, speed: float, times: np.ndarray) -> np.ndarray:
        times = np.ascontiguousarray(times, dtype=float)
        samples = np.empty((len(times), motion.STATES))
        ending, filled, reached = motion.lateral_motion(
            np.array(state, dtype=float),
            float(speed),
            self._p,
            *self._tables,
            self.code == "mohan",
            times,
            self.scales,
            float(self.lateral_limit),
            self._pair,
            samples,
        )
        if ending == motion.FINISHED:
            return samples
        outcome = Outcome(Ending.NO_CONVERGENCE, f"no step is small enough at {reached:.3f} s")
        if ending == motion.LEFT_TRACK:
            limit = f"|y| = {1e3 * self.lateral_limit:.1f} mm"
            outcome = Outcome(Ending.LOST_GAUGE, f"{limit} at {reached:.3f} s")
        raise SimulationError(
            f"{self.name}: the motion at {speed:g} m/s ended at sample {filled} of "
            f"{len(times)}: {outcome}",
            times[:filled],
            samples[:filled],
            outcome,
        )

    def rough(self) -> LateralWheelset:
        made = copy(self)
        made._pair = motion.ROUGH
        return made

    def contact_state(self, state: np.ndarray, speed: float) -> dict[str, np.ndarray]:
        """Forces, creepages and patches (left, right) at a state, by name."""
        self.derivative(state, speed)
        names = (
            "normal_force",
            "fx",
            "fy",
            "mz",
            "creep_x",
            "creep_y",
            "spin",
            "a",
            "b",
            "angle",
            "radius",
            "wheel_y",
        )
        return {name: self._sides[:, k].copy() for k, name in enumerate(names)}

    def creep_patches(self, state: np.ndarray, speed: float) -> tuple[CreepPatch, ...]:
        """The patches of both wheels with the creep law at a state (4,), left first."""
        at = self.contact_state(state, speed)
        given = self.parameters
        return tuple(
            CreepPatch(
                law=self._law,
                **{
                    name: float(at[name][hand])
                    for name in ("creep_x", "creep_y", "spin", "a", "b", "normal_force")
                },
                friction=given.friction,
                shear_modulus=given.shear_modulus,
                poisson=given.poisson,
                parameters=self._law_parameters,
                where=f"{side} wheel",
            )
            for hand, side in enumerate(("left", "right"))
        )

    def measures(self) -> dict[str, Any]:
        settings = {
            "code": self.code,
            "creep": self.creep,
            "representation": self.representation,
            "wheel": self.wheelset.wheel.name,
            "rail": self.track.rail.name,
            "gauge": self.track.gauge,
            "inclination": self.track.inclination,
        }
        return {**super().measures(), "parameters": {**asdict(self.parameters), **settings}}
