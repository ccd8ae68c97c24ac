"""Where a critical speed moves: its derivative by every number of the vehicle.

Hopf point. With A(p, V) the Jacobian at the equilibrium, v and w its right and left eigenvector of
the root lambda that crosses, d lambda = w^H dA v/(w^H v), and Re(lambda) stays zero along

    dV/dp = -Re(w^H (dA/dp) v / w^H v)/Re(w^H (dA/dV) v / w^H v)                           (1)

dA/dp holds the shift of the equilibrium: A is taken at the equilibria on either side.

Fold of limit cycles. Its speed is a linear functional of changes of f along its orbit, one vector
for all numbers (see `fold_sensitivity`); each costs f along the orbit with it changed.

Derivatives stand in m/s per unit of the number (SI); the influence is dV/V over dp/p.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError, WheelsetError
from exudyn_wheelset.stability.hunting.aligned import sensitivity_near
from exudyn_wheelset.stability.hunting.fold_points import Side
from exudyn_wheelset.stability.hunting.fold_sensitivity import FoldSensitivity
from exudyn_wheelset.stability.hunting.orbit import Orbit
from exudyn_wheelset.stability.numbers import Number, number_of, vehicle_numbers
from exudyn_wheelset.stability.subject import as_system, changed, description_of
from exudyn_wheelset.systems.changed_vehicle import ChangedVehicles
from exudyn_wheelset.systems.system import DIFFERENCE_STEP, DynamicSystem
from exudyn_wheelset.systems.vehicle_system import VehicleSystem
from exudyn_wheelset.vehicles.description import Vehicle

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# Right-hand sides are exact to rounding, Jacobians are differences themselves: the former bear a
# hundredth of the step, and need it, where a flange sinks in by some micrometres.
RATE_STEP = 0.01


class Gradient(Mapping[str, float]):
    """Derivative of a critical speed by every number of the vehicle: name -> (m/s)/unit.

    Names are paths of `replace`; parts that are alike are listed together. Any other path, of one
    part alone, may be asked for and is computed then.

    speed      [m/s] that it is the derivative of
    numbers    value and unit of each number, by name
    left_out   numbers that could not be changed, with the reason
    """

    def __init__(
        self,
        speed: float,
        description: Any,
        derivative: Callable[[Number], float],
        what: str,
        names: Sequence[str] | None = None,
    ) -> None:
        self.speed = float(speed)
        self.what = what
        self.numbers: dict[str, Number] = {}
        self.left_out: dict[str, str] = {}
        self._description, self._derivative = description, derivative
        self._values: dict[str, float] = {}
        wanted = vehicle_numbers(description)
        if names is not None:
            wanted = {name: number_of(description, name) for name in names}
        for name, number in wanted.items():
            try:
                self._values[name] = derivative(number)
            except WheelsetError as error:
                self.left_out[name] = str(error)
            else:
                self.numbers[name] = number

    def __getitem__(self, name: str) -> float:
        if name not in self._values:
            number = number_of(self._description, name)
            if number.name not in self._values:
                self._values[name] = self._derivative(number)
                self.numbers[name] = number
                return self._values[name]
            return self._values[number.name]
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __contains__(self, name: object) -> bool:
        return name in self._values

    @property
    def units(self) -> dict[str, str]:
        """Unit of each derivative."""
        return {name: f"(m/s)/({self.numbers[name].unit})" for name in self}

    @property
    def influence(self) -> dict[str, float]:
        """Per cent of speed for one per cent of each number, by falling size."""
        values = {n: self[n] * self.numbers[n].value / self.speed for n in self}
        return dict(sorted(values.items(), key=lambda entry: -abs(entry[1])))

    def __repr__(self) -> str:
        lines = [f"{self.what} {self.speed:.3f} m/s: change for 1 % of"]
        for name, share in list(self.influence.items())[:20]:
            number = self.numbers[name]
            lines.append(f"  {share:+8.4f} %  {name} = {number.value:g} {number.unit}")
        return "\n".join(lines)

    def __reduce__(self) -> tuple[Any, ...]:
        state = (self.speed, self.what, self.numbers, self.left_out, dict(self._values))
        return _restored, state

    def plot(self, ax: Axes | None = None, most: int = 15, change: float = 10.0) -> Axes:
        """Tornado diagram: speed [m/s] won or lost by `change` per cent more of the `most`
        influential numbers; returns the axes."""
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.subplots(figsize=(8.0, 0.5 + 0.3 * min(most, len(self))))[1]
        rows = list(self.influence.items())[:most][::-1]
        sizes = np.array([share * self.speed * change / 100.0 for _, share in rows])
        ax.barh(range(len(rows)), sizes, color=np.where(sizes > 0.0, "C0", "C3").tolist())
        labels = []
        for name, _ in rows:
            number = self.numbers[name]
            labels.append(f"{name.replace('_', ' ')}  {number.value:.4g} {number.unit}")
        ax.set_yticks(range(len(rows)), labels, fontsize=8)
        ax.axvline(0.0, color="k", lw=0.8)
        ax.set_xlabel(f"change of {self.what} {self.speed:.2f} m/s by {change:g} % more [m/s]")
        return ax


def _restored(
    speed: float,
    what: str,
    numbers: dict[str, Number],
    left_out: dict[str, str],
    values: dict[str, float],
) -> Gradient:
    """A gradient from a file: its numbers, without the vehicle to ask for more."""
    gradient = Gradient(speed, None, lambda number: np.nan, what)
    gradient.numbers, gradient.left_out, gradient._values = numbers, left_out, values
    return gradient


def source_of(source: Any, vehicle: Any) -> Any:
    """The vehicle that is given, or else the description of a result's source; AnalysisError."""
    if vehicle is not None:
        return vehicle
    if source is None or source.description is None:
        raise AnalysisError(
            "the analysis was given a system, whose numbers have no names: give the vehicle, "
            "gradient(vehicle=...), or analyse a description or a name of the catalogue"
        )
    return source.description


def differentiate(
    description: Any,
    number: Number,
    result: Callable[[DynamicSystem], Array],
) -> Array:
    """Derivative by a number of what `result` says of the system; central where both sides exist.

    Raises WheelsetError where the vehicle takes neither side.
    """
    sides = []
    for step in (number.step, -number.step):
        try:
            if number.value + step < 0.0 <= number.value:
                raise WheelsetError(f"{number.name} is zero or positive")
            system = as_system(changed(description, number.name, number.value + step))
            sides.append((step, result(system)))
        except WheelsetError as error:
            failure = error
    if not sides:
        raise failure
    if len(sides) == 1:
        sides.append((0.0, result(as_system(description))))
    (one, above), (other, below) = sides
    return np.asarray((above - below) / (one - other))


def hopf_gradient(
    vehicle: Any,
    speed: float,
    eigenvalue: complex,
    state: Array,
    names: Sequence[str] | None = None,
) -> Gradient:
    """Gradient of the speed [m/s] at which the root near `eigenvalue` [1/s] crosses.

    vehicle: description or name; state (n,): the equilibrium there; names: of the numbers, None
    for all. Raises AnalysisError.
    """
    description = description_of(vehicle)
    system = as_system(description)
    scales = np.asarray(system.scales)

    def matrix(other: DynamicSystem, at: float = speed) -> Array:
        start = other.carry_over(np.asarray(state), speed, at)
        rest = other.equilibrium(at, start)
        return np.asarray(np.asarray(other.jacobian(rest, at)) * scales[None, :] / scales[:, None])

    values, right = np.linalg.eig(matrix(system))
    place = int(np.argmin(np.abs(values - eigenvalue)))
    mode = right[:, place]
    left = np.linalg.inv(right)[place]

    def rate(change: Array) -> float:
        return float(np.real(left @ change @ mode))

    step = 10.0 * DIFFERENCE_STEP * max(1.0, abs(speed))
    by_speed = rate((matrix(system, speed + step) - matrix(system, speed - step)) / (2.0 * step))
    if by_speed == 0.0:
        raise AnalysisError(f"{system.name}: the root does not move with speed at {speed:g} m/s")

    def derivative(number: Number) -> float:
        return -rate(differentiate(description, number, matrix)) / by_speed

    return Gradient(speed, description, derivative, "linear critical speed", names)


def fold_gradient(
    vehicle: Any,
    orbit: Orbit,
    side: Side,
    names: Sequence[str] | None = None,
    sensitivity: FoldSensitivity | None = None,
) -> Gradient:
    """Gradient of the speed of the fold next to `orbit`, the "lowest" or the "highest" there.

    Without its sensitivity the fold is found anew with a mesh point on each corner of f (see
    `corners`); `speed` of the gradient is that fold's. vehicle: description or name; names: of the
    numbers, None for all. Raises AnalysisError where it is not found.
    """
    description = description_of(vehicle)
    if sensitivity is None:
        sensitivity = sensitivity_near(as_system(description), orbit, side)
    fold = sensitivity
    rates_of = _rates_of(description, fold)
    start = rates_of(description)

    def derivative(number: Number) -> float:
        for step in (RATE_STEP * number.step, -RATE_STEP * number.step):
            try:
                other = changed(description, number.name, number.value + step)
                return fold.change(rates_of(other) - start) / step
            except WheelsetError as error:
                failure = error
        raise failure

    return Gradient(fold.speed, description, derivative, "speed of the fold", names)


def _rates_of(description: Any, fold: FoldSensitivity) -> Callable[[Any], Array]:
    """What gives f (k, n) along the orbit of a fold for descriptions with other numbers.

    A description may know it without a model.
    """
    vehicles: ChangedVehicles | None = None
    if isinstance(description, Vehicle):
        system = as_system(description)
        if isinstance(system, VehicleSystem):
            vehicles = ChangedVehicles(description, system)

    def rates_of(other: Any) -> Array:
        if vehicles is not None:
            rates = vehicles.rates(other, fold.states, fold.speed)
        else:
            known = getattr(other, "derivatives", None)
            derivatives = known if callable(known) else as_system(other).derivatives
            rates = np.asarray(derivatives(fold.states, fold.speed))
        if not np.all(np.isfinite(rates)):
            raise AnalysisError("the equations are not finite along the orbit of the fold")
        return rates

    return rates_of
