"""A dynamic system from a plain function: equations of one's own, as the analyses take them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import finite_array, whole
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.systems.system import DynamicSystem


@spelt_class
class FunctionSystem(DynamicSystem):
    """A system from a plain Python or numba function derivative_function(state, speed) -> (n,).

    `jacobian_function(state, speed) -> (n, n)` and the vectorised `derivatives_function` and
    `jacobians_function` (states (m, n), speed) replace the defaults where they are given.
    `displacement_indices` defaults to the first half of the states.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_wheelset import FunctionSystem, linear_critical_speed
    >>> def pendulum(state, speed):  # damped below 30 m/s, driven above
    ...     x, rate = state
    ...     return np.array([rate, -40.0 * x + (speed - 30.0) * rate])
    ...
    >>> system = FunctionSystem("pendulum", pendulum, ["x [m]", "rate [m/s]"], [1e-3, 1e-2])
    >>> round(linear_critical_speed(system, 20, 40).speed, 3)
    30.0
    """

    def __init__(
        self,
        name: str,
        derivative_function: Callable[[Array, float], Array],
        state_names: Sequence[str],
        scales: Sequence[float] | Array,
        *,
        displacement_indices: Sequence[int] | None = None,
        jacobian_function: Callable[[Array, float], Array] | None = None,
        derivatives_function: Callable[[Array, float], Array] | None = None,
        jacobians_function: Callable[[Array, float], Array] | None = None,
        parameters: Mapping[str, Any] | None = None,
    ) -> None:
        self.name = name
        self.state_names = tuple(state_names)
        size = len(self.state_names)
        self.scales = finite_array(f"{name}: scales", scales, "the unit of each state")
        if self.scales.shape != (size,) or not np.all(self.scales > 0.0):
            raise AnalysisError(
                f"{name}: scales must be {size} positive numbers, one a state, got "
                f"{self.scales.tolist()}"
            )
        if displacement_indices is None:
            displacement_indices = range(max(1, size // 2))
        self.displacement_indices = tuple(
            whole(f"{name}: one of displacement_indices", index, 0, size - 1)
            for index in displacement_indices
        )
        self.parameters = dict(parameters or {})
        self._derivative = derivative_function
        self._jacobian = jacobian_function
        self._derivatives = derivatives_function
        self._jacobians = jacobians_function

    def derivative(self, state: Array, speed: float) -> Array:
        return np.asarray(self._derivative(np.asarray(state, dtype=float), float(speed)))

    def jacobian(self, state: Array, speed: float) -> Array:
        if self._jacobian is None:
            return super().jacobian(state, speed)
        return np.asarray(self._jacobian(np.asarray(state, dtype=float), float(speed)))

    def derivatives(self, states: Array, speed: float) -> Array:
        if self._derivatives is None:
            return super().derivatives(states, speed)
        return np.asarray(self._derivatives(np.asarray(states, dtype=float), float(speed)))

    def jacobians(self, states: Array, speed: float) -> Array:
        if self._jacobians is None:
            return super().jacobians(states, speed)
        return np.asarray(self._jacobians(np.asarray(states, dtype=float), float(speed)))

    def measures(self) -> dict[str, Any]:
        return {**super().measures(), "parameters": self.parameters}
